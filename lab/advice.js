// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Which integrator is the cheapest here, as the worker has timed them.

import { IMPLICIT } from "./engine.js";
import { FRAME, NAMES, whole } from "./words.js";

/* global significant */

const CLOSE = 1.2;  // costs within this ratio may change places at the next load
const byId = (id) => document.getElementById(id);

function planName(plan) {
  return NAMES[plan.method] + (plan.method === IMPLICIT ? (plan.gradients ? ", conjugate gradients" : ", sparse Cholesky") : "");
}
const steps = (plan) => (plan.substeps === 1 ? "one step a frame" : `${whole(plan.substeps)} steps a frame`);
const REASONS = { [IMPLICIT]: "Every step is stable, so it takes the whole frame at once." };

/// @param plans  the cheapest first   @returns {best, second, near, close}: none is best where nothing
/// can be chosen; near: two cost about the same; close: and are two methods
export function chosen(plans) {
  const [best, second] = plans;
  const near = Boolean(second) && second.cost < CLOSE * best.cost;
  return { best, second, near, close: near && second.method !== best.method };
}

export const MEASURING = "measuring …";
/// Until a scene's plans are timed, none are shown.
export function awaitAdvice() {
  byId("pick").textContent = MEASURING;
  byId("why").textContent = "";
  byId("bars").replaceChildren();
  byId("use").disabled = true;
}

export function writeAdvice(plans) {
  const { best, second, near, close } = chosen(plans);
  byId("use").disabled = !best;
  byId("bars").replaceChildren();
  if (!best) {
    byId("pick").textContent = "nothing: nothing here can move";
    byId("why").textContent = "";
    return;
  }
  const short = (plan, other) => (NAMES[plan.method] === NAMES[other.method] ? planName(plan) : NAMES[plan.method]);
  byId("pick").textContent = close ? "Too close to call" : `${NAMES[best.method]}, ${steps(best)}`;
  if (close) {
    byId("why").textContent = `${short(best, second)} (${steps(best)}) and ${short(second, best)} (${steps(second)}) cost the same within 20\u00a0% in this browser.`;
  } else {
    const next = near ? "Its two solvers are too close to call." : second ? `The next, ${short(second, best)}, costs ${significant(second.cost / best.cost, 2)} times as much.` : "";
    byId("why").textContent = `${REASONS[best.method] || "At this step its energy cannot rise."} It is the cheapest in this browser. ${next}`;
  }
  byId("bars").replaceChildren(...plans.flatMap((plan) => {
    const row = document.createElement("div");
    const texts = [planName(plan), `${significant(1000 * plan.cost, 2)}\u00a0ms a frame`];
    row.append(...texts.map((text) => Object.assign(document.createElement("span"), { textContent: text })));
    const bar = document.createElement("i");
    bar.style.width = `${(100 * plan.cost) / plans[plans.length - 1].cost}%`;
    if (plan === best || (near && plan === second)) bar.className = "best";
    return [row, bar];
  }));
}

/// s that a frame's steps take, by what the bars say where they speak of these steps, or else as
/// measured on the page. An explicit step costs the same whatever its size.
/// @param measured  s a step
export function frameCost(plans, { method, h }, measured) {
  const same = plans.filter((plan) => plan.method === method && (method !== IMPLICIT || Math.abs(plan.h / h - 1) < 0.01));
  const plan = same.find(({ gradients }) => method !== IMPLICIT || gradients) ?? same[0];
  return (plan ? plan.cost / plan.substeps : measured) * (FRAME / h);
}

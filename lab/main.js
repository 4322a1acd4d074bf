// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

import { STEP, drawBands, drawRinging, standing } from "./charts.js";
import { loadLab } from "./engine.js";
import { ClothView } from "./view.js";

/* global seconds, metres, withPrefix, significant */

const SIDE = 24;
const EDGE = 1 / (SIDE - 1);  // m, between neighbours
const FRAME = 1 / 60;         // s
const BUDGET = 11;            // ms of stepping a frame, so that the page stays in hand
const SLOW = 1.12;            // an unstable vibration grows by at most this in a frame
const SAMPLES = 300;          // frames in the chart
const NAMES = ["Explicit Euler", "Symplectic Euler", "Velocity Verlet", "Implicit Euler", "BDF2", "Graph inertia"];
const GRAVITY = 9.81;         // m/s²
const EXPLICIT = 0, IMPLICIT = 3, INERTIA = 5;

const byId = (id) => document.getElementById(id);
const whole = (n) => n.toLocaleString("en-US");
const between = (low, high, share) => low * (high / low) ** share;
const share = (low, high, value) => Math.log(value / low) / Math.log(high / low);

const lab = await loadLab(await (await fetch("lab.wasm")).arrayBuffer());
const view = new ClothView(byId("view"), SIDE);

// ---- what the reader sets ----

const KNOBS = {
  stiffness: { of: (v) => between(100, 10000, v), at: (v) => share(100, 10000, v), first: 1000, text: (v) => `${significant(v, 3)}\u00a0N/m` },
  mass: { of: (v) => between(0.03, 3, v), at: (v) => share(0.03, 3, v), first: 0.3, text: (v) => `${withPrefix(1000 * v, "g", 3)}` },
  alpha: { of: (v) => (v === 0 ? 0 : between(1e-6, 1e-2, v)), at: (v) => share(1e-6, 1e-2, v), first: 1e-4, text: (v) => (v === 0 ? "none" : seconds(v, 3)) },
  drag: { of: (v) => 3 * v, at: (v) => v / 3, first: 0.4, text: (v) => (v === 0 ? "none" : `${significant(v, 2)}\u00a0/s`) },
};
const settings = { method: 1, h: 0 };
let limits = null;

function readKnobs() {
  for (const [id, knob] of Object.entries(KNOBS)) {
    const input = byId(id);
    settings[id] = knob.of(input.value / input.max);
    document.querySelector(`output[for="${id}"]`).textContent = knob.text(settings[id]);
  }
}
function setStep(h) {
  const input = byId("h");
  input.value = Math.round(input.max * share(STEP.least, STEP.most, h));
  readStep();
}
function readStep() {
  settings.h = between(STEP.least, STEP.most, byId("h").value / byId("h").max);
}

// ---- words ----

function sentence() {
  const { method, h } = settings;
  const where = standing(h, limits);
  const grows = lab.growth(method, h);
  if (method === EXPLICIT && where !== "certified" && where !== "posed") {
    const { alphaLower, alphaUpper } = limits;
    if (settings.alpha === 0 && settings.drag === 0) return `Explicit Euler: ${limits.cause}.`;
    if (!(alphaUpper > 0)) return `At this step no damping α makes explicit Euler stable: take a smaller step, or symplectic or implicit Euler.`;
    return `Explicit Euler needs damping: at this step, α between ${seconds(Math.max(0, alphaLower), 3)} and ${seconds(alphaUpper, 3)} is proved at the starting pose; it is ${settings.alpha > 0 ? seconds(settings.alpha, 3) : "none"}.`;
  }
  if (method === IMPLICIT) return `Implicit Euler’s linearised step is certified at every h, at any pose; what a large step costs is motion, which it damps. A frame in one step is 16.7\u00a0ms.`;
  if (method === INERTIA) return `Graph inertia is certified at every h, linearised, at any pose: springs that would not bear the step become implicit. What a large step costs is inertia, which slows folds and rotation. A frame in one step is 16.7\u00a0ms.`;
  if (where === "certified") return `Proved at any pose, linearised: about no pose that the cloth takes does a small vibration grow. Its energy may rise all the same; Taut’s recipe, a share of this limit with damping, keeps it down: measured, not proved. A frame of 1/60\u00a0s is ${whole(Math.ceil(FRAME / h))} such steps.`;
  if (where === "posed") return method === EXPLICIT ? "Proved at the pose in which the cloth starts, for small motions. Explicit Euler has no limit that holds at every pose." : `Proved at the pose in which the cloth starts, for small motions, up to ${seconds(limits.certified, 3)}; not proved for all poses to come.`;
  if (where === "open") return `Between what is proved, up to ${seconds(limits.certified, 3)}, and what is refuted, from ${seconds(limits.refuted, 3)} on.`;
  return `${significant(h / limits.refuted, 3)} times the refuted step: the limiting vibration grows ${significant(grows, 4)}-fold with every step.`;
}
const STANDING = { certified: "certified at any pose", posed: "certified at the starting pose", open: "not decided", refuted: "refuted" };

function writeStep() {
  const where = standing(settings.h, limits);
  byId("h-value").textContent = seconds(settings.h, 3);
  byId("standing").textContent = STANDING[where];
  byId("standing").className = where;
  byId("sentence").textContent = sentence();
}

// ---- the limits, and what is recommended ----

function analyse() {
  limits = lab.analyse(settings.method, settings.h);
  drawBands(byId("bands"), byId("scale"), limits);
  writeStep();
  forgetGrowth();
}

let advice = null;
let adviceTimer = 0;
function planName(plan) {
  return NAMES[plan.method] + (plan.method === IMPLICIT ? (plan.gradients ? ", conjugate gradients" : ", sparse Cholesky") : "");
}
function recommend() {
  const { plans } = lab.recommend(0.02);
  const [best, second] = plans;
  advice = best;
  const steps = (plan) => (plan.substeps === 1 ? "one step a frame" : `${whole(plan.substeps)} steps a frame`);
  byId("pick").textContent = `${NAMES[best.method]}, ${steps(best)}`;
  const reasons = { [IMPLICIT]: "Every step is stable, so it takes the whole frame at once", [INERTIA]: "It makes only those springs implicit that hold the step down" };
  byId("why").textContent = (reasons[best.method] || "Its step by the recipe is large enough") +
    `, and that is the cheapest: ${NAMES[second.method] === NAMES[best.method] ? planName(second) : NAMES[second.method]} would cost ${significant(second.cost / best.cost, 2)} times as much. Measured in this browser.`;
  byId("bars").replaceChildren(...plans.flatMap((plan) => {
    const row = document.createElement("div");
    row.append(...[planName(plan), `${significant(1000 * plan.cost, 2)}\u00a0ms a frame`].map((text) => Object.assign(document.createElement("span"), { textContent: text })));
    const bar = document.createElement("i");
    bar.style.width = `${(100 * plan.cost) / plans[plans.length - 1].cost}%`;
    if (plan === best) bar.className = "best";
    return [row, bar];
  }));
}
function recommendSoon() {
  clearTimeout(adviceTimer);
  adviceTimer = setTimeout(recommend, 500);
}

// ---- running ----

let blown = false;
let owed = 0;      // s of simulated time that the clock is ahead
let steps = 0;     // since the last reset
let changedAt = 0;  // steps when something was last set
let beyond = 0;    // frames in a row in which the swing was no motion of a cloth
let samples = [];
let anchor = null;  // where the growth that is predicted begins: {ringing, step}
let rising = 0;
let grown = false;  // past small amplitudes, for which alone a multiplier speaks
let last = performance.now();
let pace = 1;
let frames = 0;

function forgetGrowth() {
  changedAt = steps;
  beyond = 0;
  anchor = null;
  rising = 0;
  grown = false;
  for (const sample of samples) sample.predicted = NaN;
  byId("growth-words").textContent = "";
}

function reset() {
  lab.start(SIDE, settings.stiffness, settings.mass, settings.alpha, settings.drag);
  blown = false;
  owed = steps = beyond = 0;
  samples = [];
  byId("verdict").hidden = true;
  forgetGrowth();
}

function blowUp() {
  blown = true;
  const { method, h } = settings;
  const ratio = limits.refuted < Infinity && limits.refuted > 0 ? `, ${significant(h / limits.refuted, 3)} times the refuted step` : "";
  const ringing = samples.length ? samples[samples.length - 1].ringing : Infinity;
  const swing = ringing < 1 ? metres(ringing, 2) : "metres";
  const cure = limits.anyPose > 0 ? `at any pose, linearised, up to ${seconds(limits.anyPose, 3)}` : limits.certified > 0 ? `at the starting pose, up to ${seconds(limits.certified, 3)}` : "no step, with this damping";
  byId("reason").textContent = `${NAMES[method]} at h = ${seconds(h, 3)}${ratio}: after ${whole(steps - changedAt)} steps particles swing by ${swing} from one step to the next. Certified: ${cure}; with implicit Euler, linearised, every step.`;
  byId("verdict").hidden = false;
}

/// Steps what the clock asks for, or as much as fits: an instability is slowed down to be seen.
function advance(elapsed) {
  const { method, h } = settings;
  const growth = lab.growth(method, h);
  const most = growth > 1.0001 ? Math.max(1, Math.floor(Math.log(SLOW) / Math.log(growth))) : Infinity;
  owed = Math.min(owed + elapsed, Math.max(2 * FRAME, h));
  let wanted = Math.floor(owed / h);
  const slowed = wanted > most;
  wanted = Math.min(wanted, most);
  const begin = performance.now();
  let taken = 0;
  let chunk = Math.min(wanted, 8);
  while (taken < wanted && !blown) {
    if (lab.step(method, h, chunk) !== 0) blowUp();
    taken += chunk;
    steps += chunk;
    if (performance.now() - begin > BUDGET) break;
    chunk = Math.min(wanted - taken, 2 * chunk);
  }
  if (taken < Math.floor(owed / h)) owed = 0;
  else owed -= taken * h;
  pace += 0.1 * ((taken * h) / Math.max(elapsed, 1e-3) - pace);
  byId("pace").textContent = slowed ? `slow motion: ${taken === 1 ? "one step" : `${taken} steps`} a frame` : pace < 0.9 ? `${significant(pace, 2)} × real time: as fast as this machine steps` : "real time";
  return taken;
}

function observe(taken) {
  if (taken === 0) return;
  const { method, h } = settings;
  const ringing = lab.ringing().reduce((a, b) => Math.max(a, b), 0);
  const growth = lab.growth(method, h);
  const before = samples[samples.length - 1];
  const sample = { ringing, predicted: NaN, steps, state: standing(h, limits) };
  samples.push(sample);
  if (samples.length > SAMPLES) samples.shift();

  const foreseen = growth ** taken;
  grown = grown || ringing > EDGE / 30;
  if (growth > 1.0005 && before) {
    rising = ringing > before.ringing * Math.sqrt(foreseen) && !grown ? rising + 1 : 0;
    if (!anchor && rising >= 4) anchor = { ringing, steps };
    if (anchor) sample.predicted = anchor.ringing * growth ** (steps - anchor.steps);
    if (anchor && !grown && steps > anchor.steps) {
      const measured = (ringing / anchor.ringing) ** (1 / (steps - anchor.steps));
      byId("growth-words").textContent = `Every step multiplies it by ${measured.toFixed(3)}; the limiting vibration’s multiplier says ${growth.toFixed(3)}.`;
    }
  }
  const x = lab.drawnPositions();
  const far = x.reduce((a, b) => Math.max(a, Math.abs(b)), 0);
  // Slow motion swings by h²g/4 and a little more; springs that go taut by more, for a moment.
  beyond = ringing > EDGE / 20 + 2 * GRAVITY * h * h ? beyond + 1 : 0;
  if (!blown && (beyond > 40 || far > 3)) blowUp();
}

function tick(now) {
  const elapsed = Math.min(0.1, (now - last) / 1000);
  last = now;
  if (!blown) observe(advance(elapsed));
  view.draw(lab.drawnPositions(), lab.ringing(), EDGE);
  if (++frames % 3 === 0) drawRinging(byId("chart"), samples, SAMPLES, EDGE);
  requestAnimationFrame(tick);
}

// ---- events ----

function changed() {
  readKnobs();
  lab.change(settings.stiffness, settings.mass, settings.alpha, settings.drag);
  analyse();
  recommendSoon();
}
for (const id of Object.keys(KNOBS)) byId(id).addEventListener("input", changed);
byId("h").addEventListener("input", () => {
  readStep();
  if (settings.method === EXPLICIT) analyse();  // the window of α is that of h
  writeStep();
  forgetGrowth();
});
byId("methods").addEventListener("change", (event) => {
  settings.method = Number(event.target.value);
  analyse();
});
byId("reset").addEventListener("click", reset);
byId("again").addEventListener("click", reset);
byId("use").addEventListener("click", () => {
  if (!advice) return;
  document.querySelector(`input[name="method"][value="${advice.method}"]`).checked = true;
  settings.method = advice.method;
  setStep(advice.h);
  analyse();
});
addEventListener("resize", () => drawBands(byId("bands"), byId("scale"), limits));

for (const [id, knob] of Object.entries(KNOBS)) byId(id).value = Math.round(byId(id).max * knob.at(knob.first));
readKnobs();
reset();
limits = lab.analyse(settings.method, STEP.least);
setStep(0.9 * limits.anyPose);
analyse();
byId("scene").textContent = `A cloth of ${whole(lab.size())} particles and ${whole(lab.springs())} springs, 1\u00a0m wide, hung by two corners. Drag it to look around it, drag h past the limit to break it.`;
recommendSoon();
requestAnimationFrame(tick);

/// What the page's test reads.
window.labState = () => {
  const x = Array.from(lab.positions());
  return { blown, steps, time: lab.time(), settings: { ...settings }, limits, ringing: samples.length ? samples[samples.length - 1].ringing : 0, far: Math.max(...x.map(Math.abs)), x };
};

// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// What the page says about a step.

import { ENERGY_STABLE, EXPLICIT, GUARDED, IMPLICIT } from "./engine.js";
import { standing } from "./charts.js";

/* global seconds, safeSeconds, failingSeconds, metres, percent, significant */

export const FRAME = 1 / 60;  // s
export const NAMES = ["Explicit Euler", "Symplectic Euler", "Velocity Verlet", "Implicit Euler", "BDF2", "Energy-stable Euler", "Guarded"];
export const STANDING = { certified: "certified at any pose", posed: "certified at the starting pose", open: "not decided", refuted: "refuted" };
export const whole = (n) => n.toLocaleString("en-US");
const rounded = (n) => whole(+n.toPrecision(1));
export const counted = (n, one, many = `${one}s`) => `${whole(n)} ${n === 1 ? one : many}`;

const SLOW = 1.02;  // growth a step, up to which it takes a while to be seen
/// How many steps a vibration that grows so slowly needs until it is seen: from a hundred-thousandth
/// of an edge to a twentieth.
function slowly(growth) {
  const steps = Math.log(5e3) / Math.log(growth);
  const by = `The limiting vibration grows by ${percent(growth - 1, 2)} a step`;
  return steps < 1e7 ? `${by}: it becomes visible after some ${rounded(steps)} steps.` : `${by}: too slowly to be seen here.`;
}

/// Explicit Euler at a step that is not certified.
function explicitWords({ alpha, drag }, { cause }, window) {
  if (alpha === 0 && drag === 0) return `Explicit Euler: ${cause}.`;
  if (!(window.upper > 0)) return "No damping α makes explicit Euler stable at this step. Take a smaller step, or symplectic or implicit Euler.";
  return `Explicit Euler needs damping. At this step, α between ${failingSeconds(Math.max(0, window.lower), 3)} and ${safeSeconds(window.upper, 3)} is proved at the starting pose; it is ${alpha > 0 ? seconds(alpha, 3) : "none"}.`;
}

/// At any pose.
function certifiedWords(method) {
  if (method === ENERGY_STABLE) return "Certified: no step adds energy, at any pose and any speed (proved). A large step costs motion, which it damps.";
  return "Certified: about no pose that the mesh takes does a small vibration grow (proved, linearised). Its energy may rise all the same; by energy-stable Euler, at half of this limit, it cannot (proved).";
}

/// @param window  of explicit Euler's α: {lower (−1: 0 is in it), upper}   @param growth  of the limiting vibration
export function sentence({ method, h, alpha, drag }, limits, window, growth) {
  const where = standing(h, limits);
  if (method === EXPLICIT && (where === "open" || where === "refuted")) return explicitWords({ alpha, drag }, limits, window) + (growth > 1 && growth <= SLOW ? ` ${slowly(growth)}` : "");
  if (method === GUARDED) return "Guarded takes h as a frame, however long, in certified steps. It books the energy: what gained more than was done on it goes again, in steps that cannot gain (proved).";
  if (method === IMPLICIT) return `Every step h of implicit Euler is certified, linearised, at any pose. A large step costs motion, which it damps. A frame in one step is ${seconds(FRAME, 3)}.`;
  if (where === "certified") {
    if (limits.anyPose === Infinity) return "Every step is certified: nothing here can vibrate.";
    return `${certifiedWords(method)} A frame of 1/60\u00a0s is ${whole(Math.ceil(FRAME / h))} such steps.`;
  }
  if (where === "posed") {
    const pose = "Certified for small motions about the pose in which the mesh starts";
    return method === EXPLICIT ? `${pose}. Explicit Euler has no limit that holds at every pose.` : `${pose}, up to ${safeSeconds(limits.certified, 3)}. Not proved for all poses to come: that ends at ${safeSeconds(limits.anyPose, 3)}.`;
  }
  if (where === "open") return `Not decided: this step lies between what is proved, up to ${safeSeconds(limits.certified, 3)}, and what is refuted, from ${failingSeconds(limits.refuted, 3)} on.`;
  const times = `Refuted: ${significant(h / limits.refuted, 4)} times the refuted step.`;
  if (growth <= 1) return `${times} A vibration is known that grows.`;
  return growth <= SLOW ? `${times} ${slowly(growth)}` : `${times} The limiting vibration grows ${significant(growth, 4)}-fold with every step.`;
}

/// How a figure is touched.
export function contactWords(method) {
  if (method === GUARDED || method === ENERGY_STABLE) return "Contact is part of the step, and takes nothing off it (proved).";
  return "What comes too near the figure is moved out after each step: no proof speaks of that.";
}

/// Why the scene has blown up.
export function blownWords({ method, h }, limits, steps, swing) {
  const ratio = limits.refuted < Infinity && limits.refuted > 0 ? `, ${significant(h / limits.refuted, 3)} times the refuted step` : "";
  const cure = limits.anyPose > 0 ? `At any pose${method === ENERGY_STABLE ? "" : ", linearised"}, ${safeSeconds(limits.anyPose, 3)} is certified` : limits.certified > 0 ? `At the starting pose ${safeSeconds(limits.certified, 3)} is certified` : "With this damping no step is certified";
  return `${NAMES[method]} at h = ${seconds(h, 3)}${ratio}: after ${counted(steps, "step")} particles swing by ${swing < Infinity ? metres(swing, 2) : "metres"} from one step to the next. ${cure}; with implicit Euler every step is.`;
}

/// Which springs set the limit.
export function blamedWords(shares, springs) {
  if (shares.length === 0) return "No spring sets a limit.";
  const total = shares.reduce((a, b) => a + b, 0);
  let sum = 0;
  let half = 0;
  while (half < shares.length && sum < 0.5) sum += shares[half++];
  if (half > 0.1 * springs || total < 0.5) return "No few springs set the limit: the limiting vibration is spread over the whole mesh.";
  return `${half === 1 ? "One spring holds" : `${whole(half)} of ${whole(springs)} springs hold`} half of the limiting vibration’s energy; the foremost holds ${percent(shares[0], 2)}.`;
}

/// What a scene is.
export function sceneWords(name, size, springs, shape) {
  const span = Math.max(...shape.high.map((h, d) => h - shape.low[d]));
  const parts = [`${name}: ${counted(size, "particle")}, ${counted(springs, "spring")}, ${metres(span, 3)} across, ${shape.pinned === 0 ? "no pins" : counted(shape.pinned, "pin")}.`];
  if (shape.pinned === 0) parts.push("Nothing holds it, so gravity is off.");
  else if (shape.loose > 0) parts.push(`${counted(shape.loose, "particle is", "particles are")} joined to no pin and will fall.`);
  return parts.join(" ");
}

/// How fast the page steps. @param cost  s a frame of 1/60 s of the scene, or NaN
export function paceWords({ slowed, taken, pace, cost }) {
  if (slowed) return `slow motion: ${taken === 1 ? "one step" : `${taken} steps`} a picture, so that the growth can be seen`;
  const stepping = Number.isFinite(cost) ? `stepping a frame of 16.7\u00a0ms takes ${significant(1000 * cost, 2)}\u00a0ms` : "";
  if (pace >= 0.9) return `real time${stepping ? `: ${stepping}` : ""}`;
  const reason = !stepping ? "" : cost > 0.6 * FRAME ? `: ${stepping}, and this page steps for 11\u00a0ms of each` : `: ${stepping}; drawing takes the rest`;
  return `${significant(pace, 2)} × real time${reason}`;
}


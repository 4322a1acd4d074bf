// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
"use strict";

// The charts. Each draws into `box` from the page's data and may be called again at another width.

const LIMITS = [
  ["explicit_euler", "Explicit Euler", "at this pose (linear)"],
  ["symplectic_euler", "Symplectic Euler", "at this pose (linear)"],
  ["any_pose", "Symplectic Euler", "at any pose (linearised)"],
  ["energy_stable", "Energy-stable Euler", "energy (nonlinear)"],
  ["implicit_euler", "Implicit Euler", "at this pose (linear)"],
];

/// The ends of a bracket, s: up to `certified` it is proved, from `refuted` on it fails.
function bracket(limit) {
  const certified = limit.certified === "unbounded" ? Infinity : limit.certified || 0;
  return { certified, refuted: limit.refuted === null ? Infinity : limit.refuted };
}

/// The limits that were asked for; bare matrices have no pose.
function knownLimits(data) {
  const posed = data.findings.particles !== null;
  return LIMITS.filter(([key]) => data.findings[key].cause).map(([key, name, where]) => [key, name, posed ? where : ""]);
}

function drawLimits(box, data) {
  const rows = knownLimits(data);
  const ends = rows.map(([key]) => bracket(data.findings[key]));
  const finite = ends.flatMap((e) => [e.certified, e.refuted]).filter((h) => h > 0 && h < Infinity);
  const narrow = box.clientWidth < 640;
  const pitch = narrow ? 62 : 50;
  const { root, width, height } = drawing(box, rows.length * pitch + 70, "Certified and refuted time steps of each integrator");
  const frame = { left: narrow ? 1 : 210, right: width - 1, top: 22, bottom: height - 44 };
  const low = finite.length ? Math.min(...finite) / 6 : 1e-5;
  const high = Math.max(1 / 20, finite.length ? 6 * Math.max(...finite) : 0);
  const x = logarithmic(low, high, frame.left, frame.right);
  const hatch = hatching(root);
  for (const h of decades(x, narrow ? 5 : 9)) {
    line(root, x(h), frame.top, x(h), frame.bottom, "grid");
    label(root, x(h), frame.bottom + 17, seconds(h, 2), h > high / 1.3 ? "end" : h < low * 1.3 ? "start" : "middle");
  }
  label(root, frame.right, frame.bottom + 36, "time step h, logarithmic", "end");
  rows.forEach(([key, name, where], row) => {
    const limit = data.findings[key];
    const { certified, refuted } = ends[row];
    const top = frame.top + row * pitch + (narrow ? 26 : 10);
    const bar = { y: top, height: 28 };
    const left = certified > 0 ? Math.min(x(Math.min(certified, high)), frame.right) : frame.left;
    let right = refuted < Infinity ? Math.max(refuted > 0 ? x(refuted) : frame.left, left) : frame.right;
    if (refuted < Infinity && certified > 0) right = Math.max(right, left + 2);
    if (narrow) {
      const text = label(root, 0, top - 7, name, "start", "strong");
      if (where) svg("tspan", { dx: 8, style: "font-size: 12px; fill: var(--soft)" }, text, where);
    } else {
      label(root, 0, top + (where ? 13 : 19), name, "start", "strong");
      label(root, 0, top + 29, where);
    }
    svg("rect", { ...bar, x: frame.left, width: left - frame.left, class: "certified" }, root);
    svg("rect", { ...bar, x: left, width: right - left, fill: hatch }, root);
    svg("rect", { ...bar, x: right, width: frame.right - right, class: "refuted" }, root);
    const middle = top + 18.5;
    if (certified === Infinity) label(root, frame.left + 10, middle, "every step certified", "start", "in");
    else if (certified > 0) label(root, left - 8, middle, safeSeconds(certified), "end", "in");
    if (refuted === 0) label(root, frame.left + 10, middle, `every step refuted: ${limit.cause.replace(/_/g, " ")}`, "start", "in");
    else if (refuted < Infinity) label(root, right + 8, middle, failingSeconds(refuted), "start", "in");
  });
  const frameTime = 1 / 60;
  if (frameTime > low && frameTime < high) {
    line(root, x(frameTime), frame.top - 4, x(frameTime), frame.bottom, "mark dash");
    label(root, x(frameTime), frame.top - 8, "a frame, 1/60\u00a0s", x(frameTime) > width - 90 ? "end" : "middle");
  }
}

/// The limiting mode's amplitude after each step of one side's run, as its two multipliers give it:
/// with their sum s = 2 − hd − h²k and product p = 1 − hd, x₁ = (s − p) x₀ + p h v₀ and then
/// xₙ₊₁ = s xₙ − p xₙ₋₁.
function predictedReach(data, side, steps) {
  const { h, limiting } = data.multipliers[side];
  const [[re0, im0], [re1, im1]] = limiting;
  const { kick, speed } = data.runs;
  const sum = re0 + re1;
  const product = re0 * re1 - im0 * im1;
  const x = [kick, (sum - product + product * h * speed) * kick];
  while (x.length <= steps) x.push(sum * x[x.length - 1] - product * x[x.length - 2]);
  return x.map(Math.abs);
}

const REACH = { left: 76, right: 14 };  // margins of the chart of displacements

/// Largest displacement after each step of both runs, with the growth that is predicted.
function drawReach(box, data, step) {
  const { below, above, kick, floor, ceiling } = data.runs;
  const { root, width, height } = drawing(box, 300, "Largest displacement after each step");
  const frame = { left: REACH.left, right: width - REACH.right, top: 32, bottom: height - 46 };
  const all = [...below.reach, ...above.reach].filter((v) => v > 0 && Number.isFinite(v));
  const y = logarithmic(Math.min(kick, ...all) / 3, Math.max(...all) * 3, frame.bottom, frame.top);
  const steps = Math.max(below.steps, above.steps, 1);
  const x = linear(0, steps, frame.left, frame.right);
  axes(root, frame,
    { scale: x, ticks: roundNumbers(0, steps, width < 500 ? 4 : 8), text: String, title: "steps taken" },
    { scale: y, ticks: decades(y, 7), text: (v) => metres(v, 2), title: "largest displacement of a particle" });
  for (let at = frame.top; at < frame.bottom; at += 4) {
    const value = y.from * (y.to / y.from) ** ((frame.bottom - at - 2) / (frame.bottom - frame.top));
    const fill = rampColour(Math.log(value / floor) / Math.log(ceiling / floor), 0.92);
    svg("rect", { x: frame.left, y: at, width: 7, height: Math.min(4.5, frame.bottom - at), fill }, root);
  }
  const predicted = predictedReach(data, "above", steps);
  const end = predicted.findIndex((v) => v > y.to);
  const seen = end < 0 ? predicted : predicted.slice(0, end);
  for (const [run, kind] of [[below, "certified"], [above, "refuted"]]) {
    const points = run.reach.map((v, i) => [x(i), y(v)]).filter(([, v]) => Number.isFinite(v));
    svg("path", { d: path(points), class: `line-${kind}`, "stroke-linejoin": "round" }, root);
  }
  svg("path", { d: path(seen.map((v, i) => [x(i), y(v)])), class: "mark dash", fill: "none" }, root);
  const text = (i, v, words, colour, anchor, dy) => {
    label(root, x(i), y(v) + dy, words, anchor).setAttribute("style", `fill: var(--${colour}); font-weight: 600`);
  };
  text(below.steps, Math.max(...below.reach), "0.99 × certified", "certified", "end", -10);
  text(above.steps, Math.max(...above.reach), "1.01 × refuted", "refuted", "end", -10);
  const middle = Math.round(seen.length / 2);
  text(middle, seen[middle], "predicted", "ink", "start", 22);
  line(root, 0, frame.top, 0, frame.bottom, "mark").dataset.cursor = "";
  moveCursor(box, data, step);
}

/// Moves the line of the step that the meshes show.
function moveCursor(box, data, step) {
  const steps = Math.max(data.runs.below.steps, data.runs.above.steps, 1);
  const { width } = box.querySelector("svg").viewBox.baseVal;
  const at = linear(0, steps, REACH.left, width - REACH.right)(Math.min(step, steps));
  for (const end of ["x1", "x2"]) box.querySelector("[data-cursor]").setAttribute(end, at);
}

const OUTSIDE = 1 + 1e-5;  // the page holds six digits

function drawMultipliers(box, data, side) {
  const { root, width } = drawing(box, Math.min(box.clientWidth, 470), "Multipliers and the unit circle");
  const { others, limiting, radius } = data.multipliers[side];
  const reach = Math.max(1.25, ...["below", "above"].map((s) => 1.12 * data.multipliers[s].radius));
  const height = root.viewBox.baseVal.height;
  const size = Math.min(width - 46, height - 52);
  const frame = { left: 40, right: 40 + size, top: 20, bottom: 20 + size };
  const x = linear(-reach, reach, frame.left, frame.right);
  const y = linear(-reach, reach, frame.bottom, frame.top);
  const ticks = [-1, -0.5, 0, 0.5, 1];
  axes(root, frame, { scale: x, ticks, text: String, title: "real part of μ" }, { scale: y, ticks, text: String, title: "imaginary part of μ" });
  const unit = x(1) - x(0);
  svg("circle", { cx: x(0), cy: y(0), r: unit, style: "fill: var(--certified); fill-opacity: .08; stroke: var(--soft)" }, root);
  for (const [re, im] of others.flat()) {
    const kind = Math.hypot(re, im) > OUTSIDE ? "refuted" : "certified";
    svg("circle", { cx: x(re).toFixed(2), cy: y(im).toFixed(2), r: 1.7, class: kind, "fill-opacity": 0.75 }, root);
  }
  for (const [re, im] of limiting) {
    const kind = Math.hypot(re, im) > OUTSIDE ? "refuted" : "certified";
    svg("circle", { cx: x(re), cy: y(im), r: 6, class: kind, style: "stroke: var(--paper); stroke-width: 1.5" }, root);
  }
  label(root, x(0), y(0.32), `|μ| = ${radius.toFixed(4)}`, "middle", "strong");
  label(root, x(0), y(0.32) + 18, "of the limiting vibration", "middle");
}

function drawWindow(box, data, method) {
  const { h, longest } = data.window;
  const windows = data.window[`${method}_euler`];
  const { root, width, height } = drawing(box, 380, `Damping window of ${method} Euler`);
  const frame = { left: 58, right: width - 12, top: 32, bottom: height - 46 };
  const all = ["explicit_euler", "symplectic_euler"].flatMap((m) => data.window[m]).filter(Boolean);
  const x = logarithmic(h[0], longest * 1.35, frame.left, frame.right);
  const highest = Math.max(...all.map((w) => w[1]).filter(Number.isFinite), longest);
  const y = logarithmic(h[0] / 3, highest, frame.bottom, frame.top);
  axes(root, frame,
    { scale: x, ticks: decades(x, width < 420 ? 4 : 6), text: (v) => seconds(v, 2), title: "time step h" },
    { scale: y, ticks: decades(y, 7), text: (v) => seconds(v, 2), title: "stiffness-proportional damping α" });
  const open = windows.map((w, i) => w && [x(h[i]), w]).filter(Boolean);
  const clamped = (a) => Math.min(frame.bottom, y(Math.max(a, h[0] / 3)));
  if (open.length) {
    const upper = open.map(([at, w]) => [at, clamped(w[1])]);
    const lower = open.map(([at, w]) => [at, clamped(w[0])]).reverse();
    svg("path", { d: path([...upper, ...lower]) + "Z", style: "fill: var(--certified); fill-opacity: .2; stroke: var(--certified); stroke-width: 1.5" }, root);
    const [at, w] = open[Math.round(open.length * 0.3)];
    label(root, at, (clamped(w[0]) + clamped(w[1])) / 2 + 4, "certified", "middle", "strong");
  }
  line(root, x(longest), frame.top, x(longest), frame.bottom, "mark dash");
  label(root, x(longest) - 6, frame.top + 12, "2/√k", "end");
  if (method !== "explicit") return;
  const mark = data.findings.rayleigh_window;
  if (mark.empty || !(mark.h > x.from)) return;
  const [a, b] = [mark.lower, mark.upper === "unbounded" ? y.to : mark.upper].map(clamped);
  svg("line", { x1: x(mark.h), x2: x(mark.h), y1: a, y2: b, class: "mark", "stroke-width": 3 }, root);
  label(root, x(mark.h), b - 20, `h = ${seconds(mark.h, 3)}`, "middle");
}

/// How much of the vibration's energy the first n springs hold together.
function drawShares(box, data) {
  const { share, foremost } = data.mesh;
  const { root, width, height } = drawing(box, 220, "Energy held by the first springs together");
  const frame = { left: 58, right: width - 14, top: 32, bottom: height - 46 };
  const total = data.findings.springs;
  const x = logarithmic(1, Math.max(total, 2), frame.left, frame.right);
  const y = linear(0, 1, frame.bottom, frame.top);
  axes(root, frame,
    { scale: x, ticks: decades(x, width < 500 ? 5 : 12), text: (v) => v.toLocaleString("en-US"), title: `springs, the foremost first, of ${total.toLocaleString("en-US")}` },
    { scale: y, ticks: [0, 0.25, 0.5, 0.75, 1], text: (v) => percent(v), title: "elastic energy of the limiting vibration" });
  let sum = 0;
  const points = share.map((s, i) => [x(i + 1), y(Math.min(1, (sum += foremost * s)))]);
  svg("path", { d: path(points), class: "line-refuted", "stroke-linejoin": "round" }, root);
}

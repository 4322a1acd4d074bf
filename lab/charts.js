// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// The bands behind the slider of h, and the charts of ringing and of coarser networks. Scales and SVG are those of the pages
// of stability_report: examples/report/draw.js, loaded before.

/* global decades, drawing, hatching, label, line, logarithmic, metres, path, percent, seconds, safeSeconds, failingSeconds, svg, axes */

export const STEP = { least: 2e-5, most: 5e-2 };  // s, the slider's ends

/// Ends between which the limits of a scene can be seen.
export function setScale({ anyPose, certified }) {
  const lowest = Math.min(...[anyPose, certified].filter((h) => h > 0 && h < Infinity), 1e-3);
  STEP.least = Math.min(2e-5, 2 * 10 ** Math.floor(Math.log10(lowest / 10)));
}
const FRAME = 1 / 60;
const THUMB = 8;  // px, half the thumb's width: how far its middle stays from the ends

/// What is known of a step, as the bands show it.
export function standing(h, limits) {
  if (h <= limits.anyPose) return "certified";
  if (h <= limits.certified) return "posed";
  return h < limits.refuted ? "open" : "refuted";
}

export function drawBands(bands, scale, limits) {
  const height = 54;
  const { root, width } = drawing(bands, height, "Certified, undecided and refuted steps");
  const x = logarithmic(STEP.least, STEP.most, THUMB, width - THUMB);
  const at = (h) => (h <= STEP.least ? 0 : h >= STEP.most ? width : x(h));
  const top = 15, tall = 32;
  const hatch = hatching(root);
  const a = at(Math.min(limits.anyPose, limits.certified));
  const b = at(limits.certified);
  let c = at(limits.refuted);
  if (c < width) c = Math.max(c, b + 2);
  const rect = (from, to, more) => to > from && svg("rect", { x: from, y: top, width: to - from, height: tall, ...more }, root);
  rect(0, a, { class: "certified" });
  rect(a, b, { class: "posed" });
  rect(b, c, { fill: hatch });
  rect(c, width, { class: "refuted" });
  const middle = top + 20.5;
  if (a >= width) label(root, 14, middle, "every step certified", "start", "in");
  else if (a > 110) label(root, a - 36, middle, safeSeconds(limits.anyPose, 3), "end", "in");
  if (c <= 0) label(root, 14, middle, "every step refuted", "start", "in");
  else if (c < width - 90) label(root, c + 22, middle, failingSeconds(limits.refuted, 3), "start", "in");

  const ruler = drawing(scale, 30, "Scale of the time step").root;
  for (const h of decades(x, width < 640 ? 5 : 11)) {
    line(ruler, x(h), 0, x(h), 5, "axis");
    label(ruler, x(h), 20, seconds(h, 2), h > STEP.most / 1.3 ? "end" : h < STEP.least * 1.3 ? "start" : "middle");
  }
  line(root, x(FRAME), 10, x(FRAME), height, "mark dash");
  label(root, x(FRAME), 6, "a frame, 1/60\u00a0s", "middle");
}

/// Estimated errors against costs; a line from each dot to twice its error.
/// @param levels  whose error is known, the coarsest first   @param found  the answer of resolve
export function drawLevels(box, levels, { goal, fineCost, chosen }) {
  const { root, width, height } = drawing(box, 230, "Estimated error of coarser networks against their cost");
  const frame = { left: 56, right: width - 22, top: 32, bottom: height - 46 };
  const errors = [goal, ...levels.flatMap(({ error }) => [error, 2 * error])].filter((v) => v > 0);
  const x = logarithmic(levels[0].cost / fineCost / 4, 1, frame.left, frame.right);
  const y = logarithmic(Math.min(...errors) / 2.5, 2 * Math.max(...errors), frame.bottom, frame.top);
  const share = (v) => percent(v, 2);
  axes(root, frame,
    { scale: x, ticks: decades(x, width < 640 ? 5 : 10), text: share, title: "cost of the motion, of what all particles cost" },
    { scale: y, ticks: decades(y, 6), text: share, title: "estimated error, of the scene’s size" });
  line(root, frame.left, y(goal), frame.right, y(goal), "mark dash");
  label(root, frame.right - 6, y(goal) - 6, `goal ${share(goal)}`, "end", "strong");
  for (const level of levels) {
    if (!(level.error > 0)) continue;
    const best = level.particles === chosen?.particles;
    const [a, b] = [x(level.cost / fineCost), y(level.error)];
    line(root, a, b, a, y(2 * level.error), best ? "line-certified" : "axis");
    svg("circle", { cx: a, cy: b, r: best ? 6 : 4, class: best ? "certified" : "dot" }, root);
    if (best) label(root, a, y(2 * level.error) - 7, `${level.particles}, chosen`, "middle", "strong");
    else label(root, a, b + 17, level.particles, "middle");  // below, where the chosen one's has none
  }
}

/// @param samples  {ringing, predicted (NaN: nothing), state} for each frame shown, the newest last
export function drawRinging(box, samples, most, edge) {
  const { root, width, height } = drawing(box, 250, "How far particles swing from step to step, over the last frames");
  const frame = { left: 64, right: width - 14, top: 32, bottom: height - 28 };
  const lowest = 10 ** Math.floor(Math.log10(edge) - 7);
  const highest = 10 ** Math.ceil(Math.log10(edge) + 1);
  const y = logarithmic(lowest, highest, frame.bottom, frame.top);
  const x = (i) => frame.right - ((samples.length - 1 - i) / (most - 1)) * (frame.right - frame.left);
  axes(root, frame,
    { scale: (v) => v, ticks: [], text: String, title: "" },
    { scale: y, ticks: decades(y, 6), text: (v) => metres(v, 2), title: "the largest of all particles" });
  label(root, frame.right, frame.bottom + 18, "now", "end");
  label(root, frame.left, frame.bottom + 18, `${most} frames ago`);
  line(root, frame.left, y(edge), frame.right, y(edge), "mark dash");
  label(root, frame.left + 8, y(edge) - 6, `an edge, ${metres(edge, 2)}`);
  const height_ = (v) => y(Math.min(highest, Math.max(lowest, v)));
  for (let start = 0; start + 1 < samples.length;) {  // one line for each stretch of one standing
    let end = start + 1;
    while (end + 1 < samples.length && samples[end].state === samples[start].state) ++end;
    const points = samples.slice(start, end + 1).map((s, i) => [x(start + i), height_(s.ringing)]);
    const bad = samples[start].state === "refuted";
    svg("path", { d: path(points), class: bad ? "line-refuted" : "line-certified", "stroke-linejoin": "round" }, root);
    start = end;
  }
  const predicted = samples.map((s, i) => [x(i), s.predicted]).filter(([, v]) => v > lowest && v < highest).map(([i, v]) => [i, y(v)]);
  if (predicted.length > 1) {
    svg("path", { d: path(predicted), class: "mark dash", fill: "none" }, root);
    const [i, v] = predicted[Math.floor(predicted.length / 2)];
    label(root, i - 10, v - 2, "predicted", "end", "strong");
  }
}

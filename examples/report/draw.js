// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
"use strict";

// Numbers as text, scales and SVG elements.

function significant(value, digits = 4) {
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-3) {
    const [front, power] = value.toExponential(digits - 1).split("e");
    const raised = String(+power).replace(/./g, (c) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[c] || "⁻");
    return `${front}\u00a0×\u00a010${raised}`;
  }
  return size >= 1000 ? Math.round(value).toLocaleString("en-US") : String(+value.toPrecision(digits));
}

/// A value in `unit` with the prefix that keeps it between 1 and 1000.
function withPrefix(value, unit, digits = 4) {
  const prefixes = [[1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"], [1e-12, "p"], [1e-15, "f"]];
  const [size, prefix] = prefixes.find(([s]) => value >= 0.9999 * s) || prefixes[5];
  return `${+(value / size).toPrecision(digits)}\u00a0${prefix}${unit}`;
}
const seconds = (h, digits) => withPrefix(h, "s", digits);
/// Bounds that are proved, as text: nearest is not good enough for them, as half of the steps written so
/// would be larger than the step that is proved. Each is the nearest number of so many digits on its side.
function bounded(value, digits, side) {
  if (!(value > 0 && value < Infinity)) return value;
  const stride = (side * value * 10 ** -digits) / 2; // less than one unit of the last digit
  for (let near = value; ; near += stride) {
    const read = +near.toExponential(digits - 1);
    if (side * (read - value) >= 0) return read;
  }
}
const atMost = (value, digits = 4) => bounded(value, digits, -1);
const atLeast = (value, digits = 4) => bounded(value, digits, 1);
const safeSeconds = (h, digits = 4) => seconds(atMost(h, digits), digits); // of what is certified
const failingSeconds = (h, digits = 4) => seconds(atLeast(h, digits), digits); // of what is refuted
const metres = (l, digits) => withPrefix(l, "m", digits);
const percent = (share, digits = 3) => `${+(100 * share).toPrecision(digits)}\u00a0%`;

function linear(from, to, start, end) {
  const scale = (v) => start + ((v - from) / (to - from)) * (end - start);
  scale.from = from;
  scale.to = to;
  return scale;
}

function logarithmic(from, to, start, end) {
  const inner = linear(Math.log(from), Math.log(to), start, end);
  const scale = (v) => inner(Math.log(v));
  scale.from = from;
  scale.to = to;
  return scale;
}

/// Powers of ten in the scale's range, or 1, 2 and 5 times them where there are few.
function decades(scale, most) {
  const first = Math.floor(Math.log10(scale.from));
  const last = Math.ceil(Math.log10(scale.to));
  const values = (digits) => {
    const list = [];
    for (let p = first; p <= last; ++p) for (const d of digits) list.push(d * 10 ** p);
    return list.filter((v) => v >= scale.from * 0.9999 && v <= scale.to * 1.0001);
  };
  for (const digits of [[1, 2, 5], [1, 3], [1]]) {
    const list = values(digits);
    if (list.length <= most) return list;
  }
  const list = values([1]);
  const every = Math.ceil(list.length / most);
  return list.filter((_, i) => i % every === 0);
}

/// About `count` round numbers in [from, to].
function roundNumbers(from, to, count) {
  const rough = (to - from) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const stride = power * [1, 2, 5, 10].find((d) => d * power >= rough * 0.999);
  const list = [];
  for (let i = Math.ceil(from / stride - 1e-9); i * stride <= to * (1 + 1e-9); ++i) list.push(+(i * stride).toPrecision(12));
  return list;
}

const NS = "http://www.w3.org/2000/svg";

function svg(name, attributes = {}, parent = null, text = null) {
  const element = document.createElementNS(NS, name);
  for (const key in attributes) element.setAttribute(key, attributes[key]);
  if (text !== null) element.textContent = text;
  if (parent) parent.append(element);
  return element;
}

/// An empty drawing as wide as its box, so that text keeps its size at every width.
function drawing(box, height, title) {
  const width = Math.max(240, Math.round(box.clientWidth));
  const root = svg("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": title });
  box.replaceChildren(root);
  return { root, width, height };
}

const path = (points) => points.map(([x, y], i) => `${i ? "L" : "M"}${x.toFixed(2)} ${y.toFixed(2)}`).join("");

function line(root, x1, y1, x2, y2, kind) {
  return svg("line", { x1, y1, x2, y2, class: kind }, root);
}

function label(root, x, y, text, anchor = "start", kind = "") {
  return svg("text", { x, y, "text-anchor": anchor, class: kind }, root, text);
}

/// Ticks, grid lines and titles of both axes of the rectangle {left, right, top, bottom}.
function axes(root, frame, x, y) {
  for (const v of x.ticks) {
    line(root, x.scale(v), frame.top, x.scale(v), frame.bottom, "grid");
    label(root, x.scale(v), frame.bottom + 17, x.text(v), "middle");
  }
  for (const v of y.ticks) {
    line(root, frame.left, y.scale(v), frame.right, y.scale(v), "grid");
    label(root, frame.left - 8, y.scale(v) + 4, y.text(v), "end");
  }
  line(root, frame.left, frame.bottom, frame.right, frame.bottom, "axis");
  line(root, frame.left, frame.top, frame.left, frame.bottom, "axis");
  label(root, frame.right, frame.bottom + 36, x.title, "end");
  label(root, 0, frame.top - 12, y.title);
}

function hatching(root) {
  const id = `hatch${document.querySelectorAll("pattern").length}`;
  const pattern = svg("pattern", { id, width: 5, height: 5, patternUnits: "userSpaceOnUse", patternTransform: "rotate(45)" }, svg("defs", {}, root));
  svg("rect", { width: 2, height: 5, style: "fill: var(--open)" }, pattern);
  return `url(#${id})`;
}

// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
"use strict";

// How few particles would do: error against cost of each level, and the scene beside its coarse network.

/// Estimated error of each level that was compared, against what it costs of the scene itself.
function drawResolution(box, { levels, goal, particles }) {
  const { root, width, height } = drawing(box, 320, "Estimated error against cost for each number of particles");
  const frame = { left: 58, right: width - 14, top: 32, bottom: height - 46 };
  const known = levels.filter(({ error }) => error !== null);
  const errors = [goal, ...known.map(({ error }) => error)];
  const x = logarithmic(Math.min(0.1, ...known.map(({ cost }) => cost)) / 3, 1.5, frame.left, frame.right);
  const y = logarithmic(Math.min(...errors) / 3, 2 * Math.max(...errors), frame.bottom, frame.top);
  axes(root, frame,
    { scale: x, ticks: decades(x, width < 500 ? 4 : 8), text: (v) => `${+v.toPrecision(2)}`, title: "spring-steps, of those of the scene itself" },
    { scale: y, ticks: decades(y, 6), text: (v) => percent(v), title: "estimated error of positions, of the scene’s size" });
  line(root, frame.left, y(goal), frame.right, y(goal), "mark dash");
  label(root, frame.left + 8, y(goal) - 7, `goal ${percent(goal)}`, "start", "strong");
  svg("path", { d: path(known.map(({ cost, error }) => [x(cost), y(error)])), class: "mark", fill: "none" }, root);
  for (const level of known) {
    const chosen = level.particles === particles;
    svg("circle", { cx: x(level.cost), cy: y(level.error), r: chosen ? 7 : 4.5, style: `fill: var(--${chosen ? "certified" : "soft"}); stroke: var(--paper); stroke-width: 1.5` }, root);
    label(root, x(level.cost) + 8, y(level.error) - 9, whole(level.particles), "start", chosen ? "strong" : "");
  }
  line(root, x(1), frame.top, x(1), frame.bottom, "mark dash");
  label(root, x(1) - 6, frame.bottom - 8, "the scene itself", "end");
}

/// Both motions: positions about the middle of all of them, small enough for the mesh at rest's camera.
function decodeFilms({ frames, most, size, fine, coarse, seeds }, mesh, goal) {
  const read = (text) => {
    const view = new DataView(bytesOf(text).buffer);
    return (frame, at) => (most * view.getInt16(2 * (frame * 3 * mesh.count + at), true)) / 32767;
  };
  const [scene, few] = [read(fine), read(coarse)];
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let frame = 0; frame < frames; ++frame) {
    for (let at = 0; at < 3 * mesh.count; ++at) {
      const v = mesh.x[at] + scene(frame, at);
      low[at % 3] = Math.min(low[at % 3], v);
      high[at % 3] = Math.max(high[at % 3], v);
    }
  }
  const middle = low.map((v, d) => (v + high[d]) / 2);
  const shrink = Math.min(1, size / Math.hypot(...high.map((v, d) => v - low[d])));
  const posed = (motion, frame) => Float64Array.from({ length: 3 * mesh.count }, (_, at) => shrink * (mesh.x[at] + motion(frame, at) - middle[at % 3]));
  const apart = (frame) => Uint8Array.from({ length: mesh.count }, (_, i) => {
    const d = Math.hypot(...[0, 1, 2].map((c) => scene(frame, 3 * i + c) - few(frame, 3 * i + c)));
    return Math.min(255, Math.round((255 * d) / (2 * goal * size)));
  });
  return {
    frames, seeds,
    fine: (frame) => ({ x: posed(scene, frame), level: null }),
    coarse: (frame) => ({ x: posed(few, frame), level: apart(frame) }),
  };
}

/// The scene, or its coarse network with its particles, in one frame.
function paintFilm(canvas, mesh, films, side, frame, colours) {
  const { x, level } = films[side](frame);
  paintMesh(canvas, mesh, x, level, colours);
  if (side === "fine") return;
  const context = canvas.getContext("2d");
  const { clientWidth: width, clientHeight: height } = canvas;
  const screen = project(x, [0, 0, 0], fit(mesh, width, height), width, height);
  context.fillStyle = styled("--ink");
  for (const i of films.seeds) {
    context.beginPath();
    context.arc(screen[3 * i], screen[3 * i + 1], 2, 0, 2 * Math.PI);
    context.fill();
  }
}

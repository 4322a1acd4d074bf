// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
"use strict";

// The mesh on canvases: decoding, one camera for all of them, painter's order.

function bytesOf(text) {
  const raw = atob(text);
  const bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) bytes[i] = raw.charCodeAt(i);
  return bytes;
}

function integers(text, width) {
  const bytes = bytesOf(text);
  const view = new DataView(bytes.buffer);
  const count = bytes.length / width;
  const list = new Uint32Array(count);
  for (let i = 0; i < count; ++i) list[i] = width === 2 ? view.getUint16(2 * i, true) : view.getUint32(4 * i, true);
  return list;
}

/// Positions about the middle of the bounding box, m.
function decodeMesh(mesh) {
  const raw = integers(mesh.positions, 2);
  const count = raw.length / 3;
  const x = new Float64Array(raw.length);
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < raw.length; ++i) {
    x[i] = (raw[i] / 65535) * mesh.extent;
    low[i % 3] = Math.min(low[i % 3], x[i]);
    high[i % 3] = Math.max(high[i % 3], x[i]);
  }
  const middle = low.map((l, d) => (l + high[d]) / 2);
  for (let i = 0; i < x.length; ++i) x[i] -= middle[i % 3];
  const radius = Math.hypot(...high.map((h, d) => h - low[d])) / 2;
  const width = mesh.index_bytes;
  const flat = high[mesh.up] - low[mesh.up] < 0.3 * radius;
  camera.up = mesh.up;
  camera.tilt = flat ? 0.62 : 0.22;
  return {
    x, count,
    triangles: integers(mesh.triangles, width),
    pinned: integers(mesh.pinned, width),
    springs: integers(mesh.springs, width),
    share: mesh.share,
  };
}

/// The run's frames: positions, and how far each particle is from its start on a scale of 0 to 255.
function decodeRun(run, runs, mesh, width) {
  const moved = integers(runs.moved, width);
  const bytes = bytesOf(run.displacement);
  const frame = (index) => {
    const x = Float64Array.from(mesh.x);
    const level = new Uint8Array(mesh.count);
    let at = 4 * moved.length * index;
    for (const i of moved) {
      const size = bytes[at + 3];
      level[i] = size;
      if (size > 0) {
        const length = runs.floor * (runs.ceiling / runs.floor) ** ((size - 1) / 254);
        for (let d = 0; d < 3; ++d) x[3 * i + d] += (length * ((bytes[at + d] << 24) >> 24)) / 127;
      }
      at += 4;
    }
    return { x, level };
  };
  return { frames: run.frames, frame };
}

/// `up` is the axis that gravity points down, 1 or 2.
const camera = { turn: -0.55, tilt: 0.22, up: 1 };

/// Screen coordinates and depth of all points; `zoom` in pixels a metre, about `centre`.
function project(x, centre, zoom, width, height) {
  const [ct, st, cp, sp] = [Math.cos(camera.turn), Math.sin(camera.turn), Math.cos(camera.tilt), Math.sin(camera.tilt)];
  const out = new Float64Array(x.length);
  const [rise, near, sign] = camera.up === 1 ? [1, 2, 1] : [2, 1, -1];
  for (let i = 0; i < x.length; i += 3) {
    const a = x[i] - centre[0], b = x[i + rise] - centre[rise], c = sign * (x[i + near] - centre[near]);
    const across = ct * a + st * c;
    const away = -st * a + ct * c;
    out[i] = width / 2 + zoom * across;
    out[i + 1] = height / 2 - zoom * (cp * b - sp * away);
    out[i + 2] = sp * b + cp * away;
  }
  return out;
}

/// From cloth at rest to cloth that has left its place.
const RAMP = {
  light: [[0, 214, 217, 219], [0.2, 168, 201, 205], [0.42, 96, 158, 166], [0.6, 226, 184, 84], [0.78, 210, 92, 48], [1, 128, 26, 24]],
  dark: [[0, 92, 99, 107], [0.2, 82, 122, 130], [0.42, 86, 168, 170], [0.6, 232, 190, 94], [0.78, 226, 104, 62], [1, 176, 44, 44]],
};
const isDark = () => matchMedia("(prefers-color-scheme: dark)").matches;

function rampColour(fraction, shade) {
  const ramp = isDark() ? RAMP.dark : RAMP.light;
  const next = Math.max(1, ramp.findIndex(([at]) => at >= fraction));
  const [a, b] = [ramp[next - 1], ramp[next]];
  const t = Math.min(1, Math.max(0, (fraction - a[0]) / (b[0] - a[0])));
  return `rgb(${[1, 2, 3].map((i) => Math.round(shade * (a[i] + t * (b[i] - a[i])))).join(",")})`;
}

const SHADES = 16;
const LEVELS = 64;
function colourTable() {
  const table = [];
  for (let l = 0; l <= LEVELS; ++l) for (let s = 0; s <= SHADES; ++s) table.push(rampColour(l / LEVELS, 0.66 + (0.34 * s) / SHADES));
  return table;
}

function prepared(canvas) {
  const ratio = Math.min(window.devicePixelRatio || 1, 2);
  const width = canvas.clientWidth, height = canvas.clientHeight;
  if (canvas.width !== Math.round(width * ratio)) canvas.width = Math.round(width * ratio);
  if (canvas.height !== Math.round(height * ratio)) canvas.height = Math.round(height * ratio);
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  context.lineJoin = "round";
  context.lineCap = "round";
  return { context, width, height };
}

/// Pixels a metre that make the mesh at rest fill the canvas, as the camera first saw it.
function fit(mesh, width, height) {
  if (!mesh.span) {
    const screen = project(mesh.x, [0, 0, 0], 1, 0, 0);
    mesh.span = [1e-300, 1e-300];
    for (let i = 0; i < screen.length; i += 3) for (const d of [0, 1]) mesh.span[d] = Math.max(mesh.span[d], 2 * Math.abs(screen[i + d]));
  }
  return 0.84 * Math.min(width / mesh.span[0], height / mesh.span[1]);
}

/// Triangles, and lines on them, from the farthest to the nearest. Triangles are flat shaded; one
/// whose last two corners are the same is a line of the mesh.
/// @param view   context, zoom and the points on the screen
/// @param paint  level of each particle or null, colours, edge (a colour or null), and lines: pairs
///               of particles with `bias`, what they are drawn nearer by, and `stroke(index)`
function paintInOrder(view, triangles, paint) {
  const { context, screen, zoom } = view;
  const { level, colours, edge, lines } = paint;
  const faces = triangles.length / 3;
  const count = faces + (lines ? lines.pairs.length / 2 : 0);
  const depth = new Float64Array(count);
  for (let t = 0; t < faces; ++t) depth[t] = (screen[3 * triangles[3 * t] + 2] + screen[3 * triangles[3 * t + 1] + 2] + screen[3 * triangles[3 * t + 2] + 2]) / 3;
  for (let l = 0; l < count - faces; ++l) depth[faces + l] = (screen[3 * lines.pairs[2 * l] + 2] + screen[3 * lines.pairs[2 * l + 1] + 2]) / 2 + lines.bias;
  const order = Uint32Array.from({ length: count }, (_, t) => t).sort((p, q) => depth[p] - depth[q]);
  for (const t of order) {
    context.beginPath();
    if (t >= faces) {
      const a = 3 * lines.pairs[2 * (t - faces)], b = 3 * lines.pairs[2 * (t - faces) + 1];
      context.moveTo(screen[a], screen[a + 1]);
      context.lineTo(screen[b], screen[b + 1]);
      lines.stroke(t - faces);
      continue;
    }
    const i = 3 * triangles[3 * t], j = 3 * triangles[3 * t + 1], k = 3 * triangles[3 * t + 2];
    const ax = screen[j] - screen[i], ay = screen[j + 1] - screen[i + 1];
    const bx = screen[k] - screen[i], by = screen[k + 1] - screen[i + 1];
    const az = (screen[j + 2] - screen[i + 2]) * zoom, bz = (screen[k + 2] - screen[i + 2]) * zoom;
    const nx = ay * bz - az * by, ny = az * bx - ax * bz, nz = ax * by - ay * bx;
    const size = (nz < 0 ? -1 : 1) * (Math.hypot(nx, ny, nz) || 1);
    const light = Math.max(0, (-0.35 * nx - 0.45 * ny + 0.82 * nz) / size);
    const most = level ? Math.max(level[i / 3], level[j / 3], level[k / 3]) : 0;
    const colour = colours[Math.round((most / 255) * LEVELS) * (SHADES + 1) + Math.min(SHADES, Math.round(light * SHADES))];
    context.fillStyle = colour;
    context.strokeStyle = edge || colour;
    context.lineWidth = j === k ? 1.6 : 0.6;
    context.moveTo(screen[i], screen[i + 1]);
    context.lineTo(screen[j], screen[j + 1]);
    context.lineTo(screen[k], screen[k + 1]);
    context.closePath();
    context.fill();
    context.stroke();
  }
}

const styled = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

function paintPins({ context, screen }, pinned) {
  context.fillStyle = styled("--ink");
  const r = pinned.length > 12 ? 1.6 : 3.2;
  for (const i of pinned) {
    context.beginPath();
    context.arc(screen[3 * i], screen[3 * i + 1], r, 0, 2 * Math.PI);
    context.fill();
  }
}

/// The mesh in one state.
function paintMesh(canvas, mesh, x, level, colours) {
  const { context, width, height } = prepared(canvas);
  const zoom = fit(mesh, width, height);
  const view = { context, zoom, screen: project(x, [0, 0, 0], zoom, width, height) };
  paintInOrder(view, mesh.triangles, { level, colours });
  paintPins(view, mesh.pinned);
}

/// Of the springs that hold nearly as much as the foremost, the one nearest to the viewer; the
/// camera goes to the other side of the mesh if that one is behind it.
function chooseNearest(mesh) {
  const { springs, share, x } = mesh;
  const depth = project(x, [0, 0, 0], 1, 0, 0);
  const nearness = (s) => depth[3 * springs[2 * s] + 2] + depth[3 * springs[2 * s + 1] + 2];
  mesh.nearest = 0;
  for (let s = 1; s < share.length && share[s] > 0.8 * share[0]; ++s) if (nearness(s) > nearness(mesh.nearest)) mesh.nearest = s;
  if (share.length && nearness(mesh.nearest) < 0) camera.turn += Math.PI;
}

/// The mesh at rest in grey with its limiting springs on it, the foremost ones widest.
function paintSprings(canvas, mesh, colours, close) {
  const { context, width, height } = prepared(canvas);
  const { springs, share, x } = mesh;
  const [a, b] = [0, 1].map((end) => 3 * springs[2 * mesh.nearest + end]);
  const length = Math.hypot(x[a] - x[b], x[a + 1] - x[b + 1], x[a + 2] - x[b + 2]);
  const middle = [0, 1, 2].map((d) => (x[a + d] + x[b + d]) / 2);
  const all = fit(mesh, width, height);
  const zoom = close ? Math.max(2 * all, (0.13 * width) / (length || 1)) : all;
  const view = { context, zoom, screen: project(x, close ? middle : [0, 0, 0], zoom, width, height) };
  const red = styled("--refuted");
  const stroke = (s) => {
    const fraction = share[s] / share[0];
    context.globalAlpha = 0.08 + 0.92 * fraction;
    context.strokeStyle = red;
    context.lineWidth = close ? 1 + 3.5 * fraction : 0.6 + 1.6 * fraction;
    context.stroke();
    context.globalAlpha = 1;
  };
  const lines = { pairs: springs, bias: 1.5 * length, stroke };
  paintInOrder(view, mesh.triangles, { level: null, colours, edge: close ? styled("--edge") : null, lines });
  paintPins(view, mesh.pinned);
}

/// Turns the camera with the pointer and calls `redraw`.
function turnable(canvas, redraw) {
  let from = null;
  let pending = 0;
  canvas.addEventListener("pointerdown", (event) => {
    from = [event.clientX, event.clientY];
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!from) return;
    camera.turn += (event.clientX - from[0]) * 0.008;
    camera.tilt = Math.max(-1.5, Math.min(1.5, camera.tilt + (event.clientY - from[1]) * 0.008));
    from = [event.clientX, event.clientY];
    cancelAnimationFrame(pending);
    pending = requestAnimationFrame(redraw);
  });
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, () => (from = null));
}

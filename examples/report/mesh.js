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
  return {
    x, count, radius,
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

const camera = { turn: -0.55, tilt: 0.22 };

/// Screen coordinates and depth of all points; `zoom` in pixels a metre, about `centre`.
function project(x, centre, zoom, width, height) {
  const [ct, st, cp, sp] = [Math.cos(camera.turn), Math.sin(camera.turn), Math.cos(camera.tilt), Math.sin(camera.tilt)];
  const out = new Float64Array(x.length);
  for (let i = 0; i < x.length; i += 3) {
    const a = x[i] - centre[0], b = x[i + 1] - centre[1], c = x[i + 2] - centre[2];
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

/// Triangles from the farthest to the nearest, flat shaded, coloured by `level`.
function paintTriangles(context, screen, triangles, level, colours) {
  const count = triangles.length / 3;
  const depth = new Float64Array(count);
  for (let t = 0; t < count; ++t) depth[t] = screen[3 * triangles[3 * t] + 2] + screen[3 * triangles[3 * t + 1] + 2] + screen[3 * triangles[3 * t + 2] + 2];
  const order = Uint32Array.from({ length: count }, (_, t) => t).sort((p, q) => depth[p] - depth[q]);
  context.lineWidth = 0.6;
  let last = "";
  for (const t of order) {
    const i = 3 * triangles[3 * t], j = 3 * triangles[3 * t + 1], k = 3 * triangles[3 * t + 2];
    const ax = screen[j] - screen[i], ay = screen[j + 1] - screen[i + 1];
    const bx = screen[k] - screen[i], by = screen[k + 1] - screen[i + 1];
    const zoom = context.zoom;
    const az = (screen[j + 2] - screen[i + 2]) * zoom, bz = (screen[k + 2] - screen[i + 2]) * zoom;
    const nx = ay * bz - az * by, ny = az * bx - ax * bz, nz = ax * by - ay * bx;
    const size = Math.hypot(nx, ny, nz) || 1;
    const sign = nz < 0 ? -1 : 1;
    const light = Math.max(0, (sign * (-0.35 * nx - 0.45 * ny + 0.82 * nz)) / size);
    const most = level ? Math.max(level[i / 3], level[j / 3], level[k / 3]) : 0;
    const colour = colours[Math.round((most / 255) * LEVELS) * (SHADES + 1) + Math.min(SHADES, Math.round(light * SHADES))];
    if (colour !== last) context.fillStyle = context.strokeStyle = last = colour;
    context.beginPath();
    context.moveTo(screen[i], screen[i + 1]);
    context.lineTo(screen[j], screen[j + 1]);
    context.lineTo(screen[k], screen[k + 1]);
    context.closePath();
    context.fill();
    context.stroke();
  }
}

function paintPins(context, screen, pinned) {
  context.fillStyle = getComputedStyle(document.documentElement).getPropertyValue("--ink");
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
  context.zoom = (0.47 * Math.min(width, height * 1.05)) / (0.82 * mesh.radius || 1);
  const screen = project(x, [0, 0, 0], context.zoom, width, height);
  paintTriangles(context, screen, mesh.triangles, level, colours);
  paintPins(context, screen, mesh.pinned);
}

/// The mesh at rest in grey, its limiting springs in red over it, the foremost ones widest.
function paintSprings(canvas, mesh, colours, close) {
  const { context, width, height } = prepared(canvas);
  const { springs, share, x } = mesh;
  let centre = [0, 0, 0];
  context.zoom = (0.47 * Math.min(width, height * 1.05)) / (0.82 * mesh.radius || 1);
  if (close && share.length) {
    const ends = [springs[0], springs[1]];
    centre = [0, 1, 2].map((d) => (x[3 * ends[0] + d] + x[3 * ends[1] + d]) / 2);
    const length = Math.hypot(...[0, 1, 2].map((d) => x[3 * ends[0] + d] - x[3 * ends[1] + d]));
    context.zoom = Math.max(context.zoom, (0.085 * width) / (length || 1));
  }
  const screen = project(x, centre, context.zoom, width, height);
  paintTriangles(context, screen, mesh.triangles, null, colours);
  const style = getComputedStyle(document.documentElement);
  if (close) {
    context.strokeStyle = style.getPropertyValue("--paper");
    context.lineWidth = 1;
    context.beginPath();
    for (let t = 0; t < mesh.triangles.length; t += 3) {
      const [i, j, k] = [0, 1, 2].map((c) => 3 * mesh.triangles[t + c]);
      context.moveTo(screen[i], screen[i + 1]);
      context.lineTo(screen[j], screen[j + 1]);
      context.lineTo(screen[k], screen[k + 1]);
    }
    context.stroke();
  }
  context.strokeStyle = style.getPropertyValue("--refuted");
  for (let s = share.length - 1; s >= 0; --s) {
    const fraction = share[0] > 0 ? share[s] / share[0] : 0;
    const a = 3 * springs[2 * s], b = 3 * springs[2 * s + 1];
    context.globalAlpha = 0.06 + 0.94 * fraction;
    context.lineWidth = close ? 0.8 + 3.4 * fraction : 0.5 + 1.7 * fraction;
    context.beginPath();
    context.moveTo(screen[a], screen[a + 1]);
    context.lineTo(screen[b], screen[b + 1]);
    context.stroke();
  }
  context.globalAlpha = 1;
  paintPins(context, screen, mesh.pinned);
}

/// Turns the camera with the pointer and calls `redraw`.
function turnable(canvas, redraw) {
  let from = null;
  canvas.addEventListener("pointerdown", (event) => {
    from = [event.clientX, event.clientY];
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!from) return;
    camera.turn += (event.clientX - from[0]) * 0.008;
    camera.tilt = Math.max(-1.5, Math.min(1.5, camera.tilt + (event.clientY - from[1]) * 0.008));
    from = [event.clientX, event.clientY];
    redraw();
  });
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, () => (from = null));
}

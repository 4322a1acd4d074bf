// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// The scenes that come with the lab, and those that the reader brings.

import { GUARDED } from "./engine.js";
import { bytesOf } from "./files.js";

export const UNITS = { m: 1, cm: 0.01, mm: 0.001, in: 0.0254 };
const MOST_BYTES = 64e6;

const encoded = (lines) => new TextEncoder().encode(lines.join("\n") + "\n");
const grid = (rows, columns, at) => {
  const list = [];
  for (let r = 0; r < rows; ++r) for (let c = 0; c < columns; ++c) list.push(at(r, c));
  return list;
};
const vertex = (...x) => `v ${x.map((v) => +v.toFixed(6)).join(" ")}`;

/// 1.5 m × 0.9 m of triangles, upright, rippled a little; its pole is the column x = 0.
function flag() {
  const [rows, columns] = [25, 41];
  const lines = ["# flag, metres, z up"];
  lines.push(...grid(rows, columns, (r, c) => {
    const x = (1.5 * c) / (columns - 1);
    return vertex(x, 0.03 * x * Math.sin(7 * x + 1.3), 0.9 - (0.9 * r) / (rows - 1));
  }));
  lines.push(...grid(rows - 1, columns - 1, (r, c) => {
    const i = r * columns + c + 1;
    const [a, b, d, e] = [i, i + 1, i + columns, i + columns + 1];
    return (r + c) % 2 ? `f ${a} ${d} ${b}\nf ${b} ${d} ${e}` : `f ${a} ${d} ${e}\nf ${a} ${e} ${b}`;
  }));
  return { text: encoded(lines), pins: Array.from({ length: rows }, (_, r) => r * columns) };
}

/// A net of knots in a diamond pattern, 2 m × 1.2 m, of lines without faces: it hangs by its upper edge.
function net() {
  const [rows, columns] = [19, 25];
  const lines = ["# net, metres, z up"];
  lines.push(...grid(rows, columns, (r, c) => vertex((2 * (c + (r % 2) / 2)) / columns, 0, 1.2 - (1.2 * r) / (rows - 1))));
  const name = (r, c) => r * columns + c + 1;
  for (let r = 0; r + 1 < rows; ++r) {
    for (let c = 0; c < columns; ++c) {
      lines.push(`l ${name(r, c)} ${name(r + 1, c)}`);
      const other = r % 2 ? c + 1 : c - 1;
      if (other >= 0 && other < columns) lines.push(`l ${name(r, c)} ${name(r + 1, other)}`);
    }
  }
  return { text: encoded(lines) };
}

let opened = 0;
const keyed = ({ scale = 1, up = 2, options = 0, ...scene }) => ({ came: { scale, up, options, pins: scene.pins, preset: scene.preset, knobs: undefined }, scale, up, options, ...scene, key: ++opened });

/// @param preset  of knobs.js, to begin with   @param method, h  to begin with, else as they are and
/// a step that is certified
const SHIPPED = {
  cloth: () => ({ name: "Hanging cloth", side: 24, preset: "cotton" }),
  skirt: async () => ({ name: "Skirt", text: new Uint8Array(await bytesOf("skirt.obj")), up: 1, preset: "cotton" }),
  flag: () => ({ name: "Flag", ...flag(), preset: "flag" }),
  net: () => ({ name: "Net", ...net(), preset: "net" }),
  figure: () => ({ name: "Figure in a cape", figure: true, preset: "cape", method: GUARDED, h: 1 / 60 }),
};
export const shipped = async (id) => keyed({ id, ...(await SHIPPED[id]()) });

/// A mesh that was dropped. Throws what is wrong with it as a file.
export async function fromFile(file) {
  if (file.size === 0) throw new Error("The file is empty.");
  if (file.size > MOST_BYTES) throw new Error(`The file has ${Math.round(file.size / 1e6)} MB; the lab takes up to ${MOST_BYTES / 1e6} MB.`);
  const text = new Uint8Array(await file.arrayBuffer());
  return keyed({ id: "file", name: file.name, text, up: 1, preset: "cotton" });
}
/// The same mesh in another unit or with another axis up.
export const changed = (scene, more) => keyed({ ...scene, ...more });
/// The scene as it came.
export const original = (scene) => changed(scene, scene.came);

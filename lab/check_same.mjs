// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// node check_same.mjs lab.wasm native mesh.obj
// The WebAssembly takes the same hundred steps as the native program, by each method, and must end
// within 1e-6 m of it; it finds the same limits of a mesh, within a millionth of each; and resolve()
// chooses the same network, with the same estimated error within a thousandth. What a figure wears is
// where it is natively, to 0.1 mm after a frame and 5 mm (root mean square) after 90, for rounding
// decides how slack threads fold; in ten seconds no particle is 1 mm below the skin at a frame's end.

import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { ANALYSED, GUARDED, METHODS, loadLab } from "./engine.js";

const [wasm, program, mesh] = process.argv.slice(2);
const native = (...words) => execFileSync(program, words, { encoding: "utf8" }).trim().split("\n").map((v) => (v === "inf" ? Infinity : Number(v)));
const lab = await loadLab(readFileSync(wasm));

const positions = native();
let worst = 0;
METHODS.forEach((name, method) => {
  lab.open({ side: 16 });
  lab.knobs({ stiffness: 1000, mass: 0.3, alpha: 2e-4, drag: 0.5 });
  if (lab.step(method, 2e-4, 100) !== 0) throw new Error(`${name}: a step failed`);
  const x = lab.positions();
  if (positions.length !== METHODS.length * x.length) throw new Error(`${positions.length} numbers of the native program, ${x.length} of a method here`);
  const theirs = positions.slice(method * x.length, (method + 1) * x.length);
  const off = Math.max(...theirs.map((v, i) => Math.abs(v - x[i])));
  const moved = Math.max(...theirs.map((v, i) => (i % 3 === 2 ? Math.abs(v) : 0)));
  console.log(`${name.padEnd(19)} fallen ${moved.toExponential(2)} m, native and WebAssembly differ by ${off.toExponential(2)} m`);
  if (!(moved > 1e-4)) throw new Error(`${name}: the cloth has not moved`);
  worst = Math.max(worst, Number.isFinite(off) ? off : Infinity);
});
if (!(worst < 1e-6)) throw new Error(`differs by ${worst} m; at most 1e-6 is allowed`);

lab.open({ text: readFileSync(mesh), scale: 1, up: 1 });
lab.knobs({ stiffness: 1000, mass: 0.3, alpha: 1e-4, drag: 0.4 });
for (const [, act] of lab.parts) act();
const { limits, mode } = lab.found();
const ours = [...ANALYSED.flatMap((method) => [limits[method].anyPose, limits[method].certified, limits[method].refuted]), mode.k, mode.d, mode.kMax];
const theirs = native(mesh);
const [particles, error] = theirs.splice(-2);
if (ours.length !== theirs.length) throw new Error(`${theirs.length} numbers of the native program, ${ours.length} here`);
const apart = (a, b) => (a === b ? 0 : Math.abs(a - b) / Math.abs(b));
const most = Math.max(...ours.map((v, i) => apart(v, theirs[i])));
console.log(`${mesh}: certified ${theirs[4].toExponential(4)} s, refuted ${theirs[5].toExponential(4)} s; native and WebAssembly differ by ${most.toExponential(1)} of each limit`);
if (!(theirs[3] > 0 && theirs[4] > theirs[3] && theirs[5] > theirs[4])) throw new Error("the limits of symplectic Euler are not in order");
if (!(most < 1e-6)) throw new Error(`limits differ by ${most} of themselves; at most 1e-6 is allowed`);

const { chosen, words } = lab.resolve(0.1, 0.05);
console.log(`${words} Natively: ${particles} particles, ${(100 * error).toPrecision(6)} %; here ${(100 * chosen?.error).toPrecision(6)} %`);
if (chosen?.particles !== particles || !(apart(chosen.error, error) < 1e-3)) throw new Error("resolve() answers otherwise natively");

lab.open({ figure: true });
lab.knobs({ stiffness: 1000, mass: 0.4, alpha: 2e-5, drag: 1 });
const worn = native("figure");
const count = 3 * lab.size();
if (worn.length !== 2 * count) throw new Error(`${worn.length} numbers of the native program, twice ${count} here`);
const offAfter = (frames, from) => {
  if (lab.step(GUARDED, 1 / 60, frames) !== 0) throw new Error("Guarded: a frame failed");
  return [...lab.positions()].map((v, i) => v - worn[from + i]);
};
const first = Math.max(...offAfter(1, 0).map(Math.abs));
const square = offAfter(89, count).reduce((sum, v) => sum + v * v, 0);
const last = Math.sqrt(square / lab.size());
let deepest = -Infinity;
const begin = performance.now();
lab.reset();
for (let frame = 1; frame <= 600; ++frame) {
  if (lab.step(GUARDED, 1 / 60, 1) !== 0) throw new Error(`Guarded: frame ${frame} failed`);
  if (frame > 6) deepest = Math.max(deepest, lab.depth());
}
const cost = (performance.now() - begin) / 600;
console.log(`a figure's cape and skirt, ${lab.size()} particles: native and WebAssembly differ by ${first.toExponential(1)} m after a frame, ${last.toExponential(1)} m after 90; in 600 frames of ${cost.toFixed(1)} ms the deepest particle is ${(-1000 * deepest).toFixed(3)} mm above the skin`);
if (!(first < 1e-4) || !(last < 5e-3)) throw new Error("1e-4 m and 5e-3 m are allowed");
if (!(deepest < 1e-3)) throw new Error(`${deepest} m below the skin; less than 1e-3 is allowed`);

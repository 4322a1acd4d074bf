// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// node check_same.mjs lab.wasm positions
// The WebAssembly takes the same hundred steps as the native program `positions`, by each method,
// and must end within 1e-6 m of it.

import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { METHODS, loadLab } from "./engine.js";

const [wasm, program] = process.argv.slice(2);
const native = execFileSync(program, { encoding: "utf8" }).trim().split("\n").map(Number);
const lab = await loadLab(readFileSync(wasm));
let worst = 0;
METHODS.forEach((name, method) => {
  lab.start(16, 1000, 0.3, 2e-4, 0.5);
  if (lab.step(method, 2e-4, 100) !== 0) throw new Error(`${name}: a step failed`);
  const x = lab.positions();
  if (native.length !== METHODS.length * x.length) throw new Error(`${native.length} numbers of the native program, ${x.length} of a method here`);
  const theirs = native.slice(method * x.length, (method + 1) * x.length);
  const off = Math.max(...theirs.map((v, i) => Math.abs(v - x[i])));
  const moved = Math.max(...theirs.map((v, i) => (i % 3 === 2 ? Math.abs(v) : 0)));
  console.log(`${name.padEnd(17)} fallen ${moved.toExponential(2)} m, native and WebAssembly differ by ${off.toExponential(2)} m`);
  if (!(moved > 1e-4)) throw new Error(`${name}: the cloth has not moved`);
  worst = Math.max(worst, Number.isFinite(off) ? off : Infinity);
});
if (!(worst < 1e-6)) throw new Error(`differs by ${worst} m; at most 1e-6 is allowed`);

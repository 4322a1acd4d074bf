// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// node cloth.mjs TAUT.wasm JOLT_FOLDER [SIDE], as jolt_cloth.sh runs it: a second of the hanging
// cloth in frames of 1/60 s by Taut and by the soft body of Jolt Physics, both WebAssembly with
// SIMD on one thread, in float, with the same particles, springs (compliance 1/k), pins and
// gravity, and no damping. Prints Markdown.

import { readFileSync } from "node:fs";
import { join } from "node:path";
import { performance } from "node:perf_hooks";

import { loadJolt, makeWorld } from "./load.mjs";

const frames = 60;
const turns = 5;
const early = 12; // frames whose error is seen: scenes that fold are chaotic

const [wasm, folder, given = "64"] = process.argv.slice(2);
const side = Number(given);
if (!folder || !(Number.isInteger(side) && side >= 2 && side <= 200)) {
  console.error("cloth.mjs TAUT.wasm JOLT_FOLDER [SIDE]");
  process.exit(2);
}
const waits = setInterval(() => {}, 1000); // Jolt's threads do not keep node alive

async function loadTaut() {
  const module = await WebAssembly.compile(readFileSync(wasm));
  const host = {};
  for (const { module: from, name } of WebAssembly.Module.imports(module)) {
    (host[from] ??= {})[name] = () => 0;
  }
  const taut = (await WebAssembly.instantiate(module, host)).exports;
  taut._initialize();
  return taut;
}

const taut = await loadTaut();
const Jolt = await loadJolt(folder);
taut.open_cloth(side);
const count = taut.particles();
const springs = Array.from({ length: taut.springs() }, (_, s) => ({
  a: new Int32Array(taut.memory.buffer, taut.first_ends())[s],
  b: new Int32Array(taut.memory.buffer, taut.second_ends())[s],
  rest: taut.rest_length(s),
  stiffness: taut.stiffness(s),
}));
const tautPositions = () => new Float32Array(taut.memory.buffer, taut.positions(), 3 * count);

/// Largest l/L.
function stretch(x) {
  let largest = 0;
  for (const { a, b, rest } of springs) {
    const l = Math.hypot(
      x[3 * b] - x[3 * a],
      x[3 * b + 1] - x[3 * a + 1],
      x[3 * b + 2] - x[3 * a + 2],
    );
    largest = Math.max(largest, l / rest);
  }
  return largest;
}

const ours = (frame) => ({
  start: () => taut.start(),
  advance: () => taut[frame](),
  positions: tautPositions,
});

const jolt = makeWorld(Jolt, 1);
const bodies = jolt.GetPhysicsSystem().GetBodyInterface();

function sharedCloth() {
  taut.start();
  const x = tautPositions();
  const cloth = new Jolt.SoftBodySharedSettings();
  const vertex = new Jolt.SoftBodySharedSettingsVertex();
  for (let i = 0; i < count; ++i) {
    vertex.mPosition = new Jolt.Float3(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
    vertex.mInvMass = taut.inverse_mass(i);
    cloth.mVertices.push_back(vertex);
  }
  for (const { a, b, stiffness } of springs) {
    const edge = new Jolt.SoftBodySharedSettingsEdge(a, b, 1 / stiffness);
    cloth.mEdgeConstraints.push_back(edge);
    Jolt.destroy(edge);
  }
  cloth.CalculateEdgeLengths();
  cloth.Optimize();
  cloth.AddRef();
  return cloth;
}

const cloth = sharedCloth();

function theirs(iterations) {
  let body;
  const x = new Float32Array(3 * count);
  const end = () => {
    if (!body) return;
    bodies.RemoveBody(body.GetID());
    bodies.DestroyBody(body.GetID());
    body = undefined;
  };
  return {
    end,
    start() {
      end();
      const made = new Jolt.SoftBodyCreationSettings(
        cloth,
        new Jolt.RVec3(0, 0, 0),
        Jolt.Quat.prototype.sIdentity(),
        0,
      );
      made.mNumIterations = iterations;
      made.mLinearDamping = 0;
      made.mUpdatePosition = false;
      made.mAllowSleeping = false;
      body = bodies.CreateSoftBody(made);
      bodies.AddBody(body.GetID(), Jolt.EActivation_Activate);
      Jolt.destroy(made);
    },
    advance() {
      jolt.Step(1 / 60, 1);
      return iterations;
    },
    positions() {
      const moving = Jolt.castObject(body.GetMotionProperties(), Jolt.SoftBodyMotionProperties);
      for (let i = 0; i < count; ++i) {
        const at = moving.GetVertex(i).mPosition;
        x.set([at.GetX(), at.GetY(), at.GetZ()], 3 * i);
      }
      return x;
    },
  };
}

const reference = ours("reference_frame");

/// The first frames of the reference, the pose at the start before them.
const converged = (() => {
  reference.start();
  const poses = [reference.positions().slice()];
  for (let i = 0; i < early; ++i) {
    reference.advance();
    poses.push(reference.positions().slice());
  }
  return poses;
})();

/// Of the particles in two poses, the squares of their distances.
const squares = (x, y) =>
  Array.from(
    { length: count },
    (_, i) =>
      (x[3 * i] - y[3 * i]) ** 2 +
      (x[3 * i + 1] - y[3 * i + 1]) ** 2 +
      (x[3 * i + 2] - y[3 * i + 2]) ** 2,
  );
const way = Math.sqrt(
  Math.max(...converged.map((pose) => Math.max(...squares(pose, converged[0])))),
);

/// A second of a peer: the largest l/L after any frame, and how far it is off in the first frames,
/// root mean square, of the largest way of a particle.
function watch(peer) {
  peer.start();
  let [widest, sum] = [0, 0];
  for (let i = 1; i <= frames; ++i) {
    peer.advance();
    const x = peer.positions();
    widest = Math.max(widest, stretch(x));
    if (i <= early) sum += squares(x, converged[i]).reduce((a, b) => a + b);
  }
  peer.end?.();
  return { ...peer, widest, error: Math.sqrt(sum / early / count) / way };
}

/// The least and the median frame of each, ms; the seconds of the peers take turns.
function times(peers) {
  const all = peers.map(() => []);
  for (let turn = 0; turn < turns; ++turn) {
    for (const [p, peer] of peers.entries()) {
      peer.start();
      for (let i = 0; i < frames; ++i) {
        const start = performance.now();
        peer.steps = peer.advance();
        const time = performance.now() - start;
        if (turn > 0 && i > 0) all[p].push(time); // the first turn warms up, a first frame asks
        if (!peer.steps) throw new Error("a frame failed");
      }
      peer.end?.();
    }
  }
  return all.map((list) => {
    list.sort((a, b) => a - b);
    return { least: list[0], median: list[Math.floor(list.length / 2)] };
  });
}

const rows = [
  watch({ name: "Taut, Guarded", ...ours("guarded_frame") }),
  watch({ name: "Taut, SymplecticEuler, 0.95 of its limit", ...ours("bare_frame") }),
  ...[5, 10, 20, 40, 80, 160, 320, 640].map((n) => watch({ name: "Jolt", ...theirs(n) })),
];
const measured = times(rows);
const { version } = JSON.parse(readFileSync(join(folder, "package.json"), "utf8"));
console.log(
  `## hanging_cloth ${side} in float, by Taut and by the soft body of Jolt Physics, in ` +
    "WebAssembly\n\nA second in frames of 1/60 s, 128-bit SIMD and one thread for both: " +
    `jolt-physics ${version} (npm), node\n${process.versions.node}. Time by the clock on the ` +
    "wall, least (median); ratio: to Guarded. Widest: the largest l/L after any\nframe. Error: " +
    "of the positions in the first 0.2 s, root mean square, of the largest way of a particle." +
    "\n\n| | steps or iterations a frame | frame, ms | ratio | widest | error |\n" +
    "|---|---|---|---|---|---|",
);
for (const [r, { name, steps, widest, error }] of rows.entries()) {
  const [own, base] = [measured[r], measured[0]];
  const pair = (a, b) => `${a.toFixed(2)} (${b.toFixed(2)})`;
  console.log(
    `| ${name} | ${steps} | ${pair(own.least, own.median)} | ` +
      `${pair(own.least / base.least, own.median / base.median)} | ${widest.toFixed(3)} | ` +
      `${(100 * error).toPrecision(2)} % |`,
  );
}
clearInterval(waits);
process.exit(0);

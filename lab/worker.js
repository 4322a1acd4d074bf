// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// What takes long, apart from the page: the analysis of a scene, the timing of integrators, and the
// search for a coarser network. It
// has its own lab.wasm; whoever is tired of waiting ends it and starts another.

import { loadLab } from "./engine.js";

const ROUNDS = 5;        // timings of each plan after a first one that warms up
const SECONDS = 0.012;   // of each
const SAMPLES = 30;      // of a run of resolve
const MANY = 10_000;     // particles of which a motion has 30 pictures a second, not 60
const PATIENCE = 60;     // s for which both motions may be stepped
const TRIAL = 300;       // ms after which that is judged
let lab = null;
let resolving = () => {};  // told how far resolve is
let opened = null;       // the key of the scene that is open
let newest = 0;          // the last task that was asked for

const tell = (id, more) => postMessage({ id, ...more });
const pause = () => new Promise((go) => setTimeout(go));  // lets messages in

/// Acts one after another, telling how far it is. @param parts  [words, act] of each
async function through(id, parts) {
  for (const [part, [words, act]] of parts.entries()) {
    tell(id, { progress: part / parts.length, words });
    await pause();
    act();
  }
}

async function open(id, { scene }) {
  opened = null;
  let words = [];
  await through(id, [
    ["reading the file", () => lab.read(scene)],
    ["joining particles by springs", () => (words = lab.join(scene))],
  ]);
  if (scene.pins) lab.pinOnly(scene.pins);
  opened = scene.key;
  tell(id, { result: { shape: lab.shape(), pinned: lab.pinned(), words } });
}

function prepare({ scene, pins, knobs }) {
  if (opened !== scene.key) lab.open(scene);
  opened = scene.key;
  lab.pinOnly(pins);
  lab.knobs(knobs);
}

async function analyse(id, task) {
  prepare(task);
  await through(id, lab.parts);
  tell(id, { result: lab.found() });
}

/// Rounds over all plans, so that a moment in which the machine is busy hits none of them alone.
/// A plan five times as dear as the cheapest is timed once more, and not again.
async function advise(id, task) {
  prepare(task);
  const plans = [...Array(lab.advise()).keys()];
  for (let round = 0; round <= ROUNDS; ++round) {
    const least = Math.min(...plans.map((i) => lab.plan(i).cost));
    for (const i of plans) {
      if (round > 1 && lab.plan(i).cost > 5 * least) continue;
      lab.timePlan(i, SECONDS);
      await pause();
      if (id !== newest) return tell(id, { result: null });
    }
  }
  const timed = plans.map((i) => lab.plan(i)).filter((plan) => plan.cost < Infinity);
  tell(id, { result: timed.sort((a, b) => a.cost - b.cost) });
}

/// It cannot be interrupted: whoever wants another answer ends this worker.
async function resolve(id, task) {
  prepare(task);
  resolving = (run, sample) => tell(id, { progress: sample / SAMPLES, words: `stepping, run ${run + 1} of a coarser network` });
  tell(id, { result: lab.resolve(task.duration, task.goal) });
}

/// s that both motions would take, judged by their beginning.
function besideTakes(duration, particles) {
  lab.startBeside(particles, duration, true);
  const begin = performance.now();
  for (;;) {
    const time = lab.stepBeside(4);
    const spent = performance.now() - begin;
    if (spent > TRIAL || time > duration / 2) return (spent / 1000) * (duration / time);
  }
}

/// Both motions in pictures for the page, which plays them while more are made.
async function beside(id, task) {
  prepare(task);
  const begin = performance.now();
  const { duration, particles } = task;
  const slow = besideTakes(duration, particles) > PATIENCE;
  lab.startBeside(particles, duration, !slow);
  const h = duration / lab.besideSteps();
  tell(id, { progress: 0, sent: { seeds: lab.besideSeeds(), h, slow } });
  const frame = lab.size() > MANY ? 1 / 30 : 1 / 60;
  let time = 0;
  for (let next = frame; time < duration - h / 2; next += frame) {
    const until = Math.min(next, duration);
    while (time < until - h / 2) time = lab.stepBeside(Math.ceil((until - time) / h - 1e-6));
    const [all, few] = [!slow ? lab.besidePositions(0).slice() : undefined, lab.besidePositions(1).slice()];
    tell(id, { progress: time / duration, sent: { time, all, few, apart: lab.besideApart() } });
  }
  tell(id, { result: (performance.now() - begin) / 1000 });
}

let last = Promise.resolve();
onmessage = ({ data }) => {
  const { id, task } = data;
  newest = Math.max(newest, id);
  last = last.then(async () => {
    try {
      if (task === "load") {
        lab = await loadLab(data.module, (run, sample) => resolving(run, sample));
        tell(id, { result: true });
      } else if (id < newest) tell(id, { result: null });  // somebody wants another thing by now
      else await { open, analyse, advise, resolve, beside }[task](id, data);
    } catch (error) {
      opened = null;
      tell(id, { error: error.message, refused: Boolean(error.refused) });
    }
  });
};

// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

import { MEASURING, awaitAdvice, chosen, frameCost, writeAdvice } from "./advice.js";
import { Analyst } from "./analyst.js";
import { Coarse } from "./coarse.js";
import { STEP, drawBands, drawRinging, setScale, standing } from "./charts.js";
import { GUARDED, SYMPLECTIC, loadLab } from "./engine.js";
import { addressOf, bytesOf } from "./files.js";
import { Knobs, valuesOf } from "./knobs.js";
import { Pair } from "./pair.js";
import { Run, SAMPLES } from "./run.js";
import { SceneBar } from "./scene_bar.js";
import { original, shipped } from "./scenes.js";
import { framing, View } from "./view.js";
import { STANDING, blamedWords, blownWords, contactWords, paceWords, sceneWords, sentence } from "./words.js";

/* global seconds, safeSeconds, failingSeconds */

const byId = (id) => document.getElementById(id);
const between = (low, high, share) => low * (high / low) ** share;
const share = (low, high, value) => Math.log(value / low) / Math.log(high / low);

const module = await WebAssembly.compile(await bytesOf("lab.wasm"));
const lab = await loadLab(module);
const workerAddress = await addressOf("worker.js");
const analyst = new Analyst(workerAddress, module);
const view = new View(byId("view"), 1);
const pair = new Pair(lab);
const settings = { method: SYMPLECTIC, h: STEP.least };
let scene = null;
let mesh = null;   // as it is drawn
let found = null;  // of the analysis
let plans = [];
let stale = false;  // what was found is of other knobs or pins
let staleTimer = 0;

const limits = () => found.limits[settings.method];
const growth = () => lab.growth(settings.method, found.mode, settings.h);

// ---- the step ----

function setStep(h) {
  byId("h").value = Math.round(byId("h").max * share(STEP.least, STEP.most, h));
  readStep();
}
function readStep() {
  settings.h = between(STEP.least, STEP.most, byId("h").value / byId("h").max);
}
function writeStep() {
  if (stale) {
    byId("h-value").textContent = seconds(settings.h, 3);
    byId("standing").textContent = "not known";
    byId("standing").className = "open";
    byId("sentence").textContent = "The limits for these knobs and pins are not known yet; those drawn are the ones from before.";
    return;
  }
  const where = standing(settings.h, limits());
  byId("h-value").textContent = (where === "refuted" ? failingSeconds : safeSeconds)(settings.h, 3);
  byId("standing").textContent = STANDING[where];
  byId("standing").className = where;
  const window = lab.window(settings.h, settings.drag, found.mode);
  byId("sentence").textContent = sentence(settings, limits(), window, growth()) + (run.worn ? ` ${contactWords(settings.method)}` : "");
}
function writeLimits() {
  drawBands(byId("bands"), byId("scale"), limits());
  writeStep();
}

// ---- motion ----

const run = new Run({
  lab, settings, limits, growth,
  blownUp(steps, swing) {
    byId("reason").textContent = blownWords(settings, limits(), steps, swing);
    byId("verdict").hidden = false;
    byId("pace").textContent = "stopped";
  },
});
function startAgain() {
  run.reset();
  byId("verdict").hidden = true;
  byId("growth-words").textContent = "";
}
function forget() {
  run.forget();
  byId("growth-words").textContent = "";
}

// ---- analysis ----

const knobs = new Knobs(() => {
  const values = knobs.values();
  bar.keep({ preset: knobs.preset, knobs: knobs.preset ? undefined : values });
  Object.assign(settings, values);
  lab.knobs(settings);
  forget();
  coarse.clear(CHANGED);
  analyse();
});
let asked = 0;
let adviceTimer = 0;
const task = () => ({ scene, pins: lab.pinned(), knobs: knobs.values() });

/// Limits of the scene as it is set now, from the worker; the last one asked for counts.
async function analyse() {
  const mine = ++asked;
  clearTimeout(adviceTimer);
  clearTimeout(staleTimer);
  const doubt = () => {
    stale = true;
    writeStep();
  };
  staleTimer = setTimeout(doubt, 250);  // at once, it would flicker with every move of a knob
  bar.working(true);
  try {
    const result = await analyst.analyse(task(), (done, words) => bar.progress(done, words));
    if (mine === asked && result) take(result);
  } catch (error) {
    if (mine === asked) {
      bar.complain(error.cancelled ? "Cancelled: the limits are not known." : error.message);
      doubt();
    }
  }
  if (mine === asked) bar.working(false);
}

function take(result) {
  found = result;
  clearTimeout(staleTimer);
  stale = false;
  setScale(found.limits[SYMPLECTIC]);
  setStep(settings.h);
  writeLimits();
  forget();
  const pinned = lab.pinned();
  view.each((model) => {
    model.setPins(pinned, mesh.positions);
    model.setBlamed(found.blamed, found.shares);
  });
  pair.show(mesh, found, pinned);
  byId("blamed").textContent = blamedWords(found.shares, lab.springs());
  if (!run.worn) adviceTimer = setTimeout(advise, 500);
}

async function advise() {
  const mine = asked;
  byId("pick").textContent = MEASURING;
  const result = await analyst.advise(task()).catch((error) => {
    if (mine === asked) byId("pick").textContent = `not measured: ${error.message}`;
  });
  if (mine !== asked || !result) return;
  plans = result;
  writeAdvice(plans);
}

// ---- how coarse it may be ----

const CHANGED = "Knobs or pins have changed: what was found is no longer of this scene. Ask again.";
/// It has a worker of its own, so that no search keeps the limits waiting.
const coarse = new Coarse({ lab, task, mesh: () => mesh, makeAnalyst: () => new Analyst(workerAddress, module) });

// ---- scenes ----

/// Shows a scene once the worker has read and analysed it; until then, and if it cannot, the one
/// before stays. @returns whether it is shown
async function open(next) {
  const mine = ++asked;
  clearTimeout(adviceTimer);
  bar.working(true);
  bar.complain("");
  try {
    const progress = (done, words) => bar.progress(done, words);
    const read = await analyst.open(next, progress);
    if (mine !== asked || !read) return false;
    const values = next.knobs ?? valuesOf(next.preset, read.shape);
    const result = await analyst.analyse({ scene: next, pins: read.pinned, knobs: values }, progress);
    if (mine !== asked || !result) return false;
    lab.open(next);
    lab.pinOnly(read.pinned);
    scene = next;
    bar.show(scene, read.words);
    knobs.take(scene.preset, read.shape, values);
    Object.assign(settings, knobs.values());
    lab.knobs(settings);
    layOut();
    coarse.clear("");
    view.lookAgain();
    byId("verdict").hidden = true;
    found = result;
    plans = [];  // of another scene
    awaitAdvice();
    setScale(found.limits[SYMPLECTIC]);
    if (scene.method !== undefined) choose(scene.method);
    settings.h = scene.h ?? usable();
    take(result);
    return true;
  } catch (error) {
    if (mine === asked) {
      bar.complain(error.cancelled ? "Cancelled: the scene is the one from before." : error.message);
      if (scene) analyse();  // its knobs may have moved since it was
    }
    return false;
  } finally {
    if (mine === asked) bar.working(false);
  }
}
const safe = ({ anyPose, certified }) => [anyPose, certified].find((h) => h > 0 && h < Infinity);
/// A step to begin with: of the method, or else of symplectic Euler.
const usable = () => 0.9 * (safe(limits()) ?? safe(found.limits[SYMPLECTIC]) ?? 1e-3);

/// The scene as it was laid out, drawn anew with the pins that it has.
function layOut() {
  const shape = lab.shape();
  startAgain();
  const positions = lab.drawnPositions().slice();
  mesh = { positions, triangles: lab.triangles(), threads: lab.threads(), edge: shape.edge, ...framing(shape, lab.pinned(), positions) };
  if (run.worn) mesh.size *= 1.15;  // it strides
  view.show(mesh, run.worn && { points: lab.skin(), triangles: lab.skinTriangles() });
  document.body.classList.toggle("worn", run.worn);
  view.each((model) => model.setPins(lab.pinned(), positions));
  byId("scene").textContent = sceneWords(scene.name, lab.size(), lab.springs(), shape);
}
/// @param pins  set by hand; without them the top edge is pinned, wherever it is
function pinsChanged(pins) {
  bar.keep({ pins });
  startAgain();
  byId("scene").textContent = sceneWords(scene.name, lab.size(), lab.springs(), lab.shape());
  view.each((model) => model.setPins(lab.pinned(), mesh.positions));
  coarse.clear(CHANGED);
  analyse();
}

const bar = new SceneBar({
  open,
  cancel: () => analyst.cancel(),
  pinTop: () => (lab.pinTop(), pinsChanged()),
  unpin: () => (lab.unpinAll(), pinsChanged([])),
});
view.onClick((x, y) => {
  const particle = view.particleAt(x, y);
  if (particle < 0) return;
  lab.pin(particle, lab.pinned().includes(particle) ? 0 : 1);
  pinsChanged(lab.pinned());
});

// ---- events ----

function choose(method) {
  settings.method = method;
  document.querySelector(`input[name="method"][value="${method}"]`).checked = true;
}
byId("h").addEventListener("input", () => {
  readStep();
  writeStep();
  forget();
});
byId("methods").addEventListener("change", ({ target }) => {
  choose(Number(target.value));
  writeLimits();
  forget();
});
byId("again").addEventListener("click", () => {
  if (safe(limits()) < settings.h) {
    setStep(usable());
    writeStep();
  }
  startAgain();
});
byId("start-again").addEventListener("click", startAgain);
byId("use").addEventListener("click", () => {
  const { best } = chosen(plans);
  choose(best.method);
  setStep(best.h);
  writeLimits();
  forget();
});
byId("reset").addEventListener("click", async () => {
  choose(SYMPLECTIC);
  byId("blame").checked = true;
  if (await open(original(scene))) byId("reset-words").textContent = "Knobs, integrator, step, pins and camera are as at the start.";
});
addEventListener("input", () => (byId("reset-words").textContent = ""));
addEventListener("resize", () => {
  if (found) drawBands(byId("bands"), byId("scale"), limits());
  coarse.draw();
});

let last = performance.now();
let frames = 0;
function tick(now) {
  const elapsed = Math.min(0.1, (now - last) / 1000);
  last = now;
  if (!run.blown) {
    const { taken, slowed } = run.advance(elapsed);
    const cost = frameCost(plans, settings, run.cost);
    if (!run.blown) byId("pace").textContent = paceWords({ slowed, taken, pace: run.pace, cost });
    if (run.measured) byId("growth-words").textContent = `Every step multiplies it by ${run.measured.toFixed(3)}; the limiting vibration’s multiplier says ${growth().toFixed(3)}.`;
  }
  const swings = run.ringing > mesh.edge / 300;  // its colours say more than the springs at rest
  const swing = lab.ringing();
  if (settings.method === GUARDED) swing.fill(0);  // of a whole frame, which is motion
  view.each((model) => {
    model.showBlamed(byId("blame").checked && !swings);
    model.draw(lab.drawnPositions(), swing, mesh.edge);
    if (run.worn) model.movePins(lab.drawnPositions());
  });
  view.figure?.draw(lab.skin(), lab.place());
  view.render();
  pair.tick();
  coarse.beside.tick(elapsed);
  if (++frames % 3 === 0) drawRinging(byId("chart"), run.samples, SAMPLES, mesh.edge);
  requestAnimationFrame(tick);
}

await open(await shipped("cloth"));
requestAnimationFrame(tick);

/// What the page's test reads.
window.labState = () => ({
  blown: run.blown, depth: run.depth, place: run.worn ? lab.place() : null, steps: run.steps, time: lab.time(), ringing: run.ringing, reach: run.reach(), cost: run.cost,
  settings: { ...settings }, limits: limits(), stale, slider: { ...STEP }, plans, advice: chosen(plans),
  scene: scene.name, busy: bar.busy, size: lab.size(), preset: knobs.preset, ...lab.shape(), pinned: lab.pinned(),
  camera: view.camera.position.toArray(), drawn: view.farthest(), pair: { taken: pair.taken, reach: pair.reach, h: pair.h, kick: found.mode.size },
  coarse: { busy: coarse.busy, found: coarse.found, goal: coarse.goal, duration: coarse.duration, shown: coarse.beside.running, slow: coarse.beside.slow, time: coarse.beside.time, apart: coarse.beside.running ? coarse.beside.frame.apart : NaN, frames: coarse.beside.running ? coarse.beside.frames.length : 0, stepping: coarse.stepping },
});
window.labView = view;


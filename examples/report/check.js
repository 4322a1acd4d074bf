// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
"use strict";

// Put behind the page's own script and painted.js by check_page.cmake: uses the page as a reader would
// and writes what is wrong into <html data-check>. The page's errors are collected in pageErrors.

const wrong = [];
const expect = (holds, words) => holds || wrong.push(words);
const visible = (element) => element.offsetParent !== null;

const picture = (canvas) => canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
const pixels = (canvas) => picture(canvas).data;
const same = (a, b) => a.length === b.length && a.every((v, i) => v === b[i]);

function checkPictures() {
  for (const canvas of document.querySelectorAll("canvas")) {
    if (!visible(canvas)) continue;
    const { share, colours } = painted(picture(canvas));
    expect(share > 0.05 && colours > 8, `canvas ${canvas.dataset.mesh}: ${share} painted, ${colours} colours`);
  }
  for (const box of document.querySelectorAll("[data-plot]")) {
    if (!visible(box)) continue;
    expect(box.querySelectorAll("svg *").length > 12, `plot ${box.dataset.plot} is empty`);
    expect(box.querySelectorAll("text").length > 5, `plot ${box.dataset.plot} has no labels`);
  }
  for (const caption of document.querySelectorAll("figcaption")) {
    if (visible(caption)) expect(caption.textContent.length > 80, `a caption is missing: ${caption.dataset.fill}`);
  }
  expect(!/undefined|NaN|Infinity|null/.test(document.querySelector("main").innerText), "a text holds no value");
  for (const text of document.querySelectorAll("svg text")) expect(!/undefined|NaN|Infinity/.test(text.textContent), `chart text: ${text.textContent}`);
  expect(document.documentElement.scrollWidth <= innerWidth, `wider than the window, ${innerWidth}`);
}

const POWERS = { s: 0, ms: -3, "µs": -6, ns: -9, ps: -12, fs: -15 };
/// What a step of the page reads as: 1.234 ms.
function readStep(text) {
  const [number, unit] = text.split("\u00a0");
  return Number(number.includes("e") ? number : `${number}e${POWERS[unit]}`);
}

/// No text of a certified step is above it, none of a refuted step below: of generated steps, and of the page.
function checkBounds() {
  let seed = 1;
  const random = () => (seed = (seed * 48271) % 2147483647) / 2147483647;
  let moved = 0;
  for (let trial = 0; trial < 4000; ++trial) {
    const h = 10 ** (3 - 16 * random());
    const digits = 2 + (trial % 5);
    const [low, high, near] = [safeSeconds, failingSeconds, seconds].map((text) => readStep(text(h, digits)));
    expect(low <= h && high >= h && (low === near || high === near), `${h} s is written as ${low} and ${high} s`);
    moved += near > h;
  }
  expect(moved > 1000, "to nearest, hardly any step would have been too large");
  const cells = [...document.querySelectorAll("#table tbody td")].map((cell) => parseFloat(cell.textContent));
  knownLimits(data).forEach(([key], row) => {
    const { certified, refuted } = bracket(data.findings[key]);
    expect(!(cells[3 * row] > certified), `${key}: the table certifies ${cells[3 * row]} s, proved is ${certified} s`);
    expect(!(cells[3 * row + 1] < refuted), `${key}: the table refutes ${cells[3 * row + 1]} s, known is ${refuted} s`);
  });
  for (const box of document.querySelectorAll("#facts div")) {
    const [name, value] = [...box.children].map((child) => child.textContent);
    if (!/certified/.test(name) || !/^[0-9]/.test(value)) continue;
    const key = /energy/.test(name) ? "energy_stable" : /any pose/.test(name) ? "any_pose" : "symplectic_euler";
    expect(readStep(value) <= data.findings[key].certified, `${name} ${value}, proved is ${data.findings[key].certified} s`);
  }
}

function scrubTo(frame) {
  byId("scrub").value = frame;
  byId("scrub").dispatchEvent(new Event("input"));
  return ["below", "above"].map((side) => pixels(canvasOf(side)));
}

async function checkRuns() {
  const { below, above, kick } = data.runs;
  expect(Math.max(...below.reach) < 30 * kick, "the run below the limit does not stay near its kick");
  expect(Math.max(...above.reach) > 1000 * kick, "the run above the limit does not grow");
  for (const [side, run] of [["below", below], ["above", above]]) {
    const predicted = predictedReach(data, side, 10);
    const off = predicted.map((v, i) => Math.abs(run.reach[i] - v) / Math.max(...predicted.slice(0, i + 1)));
    expect(Math.max(...off) < 0.02, `${side}: the first ten steps are ${Math.max(...off)} from the prediction`);
  }
  const last = films.above.frames - 1;
  const first = scrubTo(0);
  const end = scrubTo(last);
  expect(!same(first[1], end[1]), "scrubbing leaves the run above the limit as it is");
  scrubTo(0);
  byId("play").click();
  expect(byId("play").textContent === "Pause", "Play does not become Pause");
  await new Promise((resolve) => setTimeout(resolve, 1500));
  expect(shown > 0, "Play does not move on");
  byId("play").click();
  const stopped = shown;
  await new Promise((resolve) => setTimeout(resolve, 500));
  expect(shown === stopped, "Pause does not hold");
  const canvas = canvasOf("whole");
  const before = pixels(canvas);
  camera.turn += 0.5;
  drawMeshes();
  expect(!same(before, pixels(canvas)), "turning leaves the mesh as it is");
}

function checkResolution() {
  const { levels, goal, films } = data.resolution;
  expect(levels.length > 2 && levels.every(({ cost }) => cost > 0 && cost < 1), "levels without a cost");
  expect(plot("resolution").querySelectorAll("circle").length === levels.length - 1, "a level is not drawn");
  expect(byId("resolution").textContent.includes(`goal ${percent(goal)}`), "the goal is not drawn");
  if (!films) return;
  const at = (frame) => {
    byId("instant").value = frame;
    byId("instant").dispatchEvent(new Event("input"));
    return ["fine", "coarse"].map((side) => pixels(canvasOf(`resolution-${side}`)));
  };
  const [first, last] = [at(0), at(films.frames - 1)];
  expect(!same(first[0], last[0]) && !same(first[1], last[1]), "the films stand still");
}

async function check() {
  checkPictures();
  checkBounds();
  if (data.resolution) checkResolution();
  if (data.runs) await checkRuns();
  expect(pageErrors.length === 0, `errors: ${pageErrors.join("; ")}`);
  const hidden = [...document.querySelectorAll("figure")].filter((f) => !visible(f)).map((f) => f.id);
  const numbers = [...document.querySelectorAll("#table td")].map((cell) => cell.textContent);
  document.documentElement.dataset.numbers = `; ${numbers.join("; ")}; `;
  document.documentElement.dataset.hidden = hidden.join(",");
  document.documentElement.dataset.check = wrong.length ? wrong.join(" | ") : "good";
}
check().catch((error) => (document.documentElement.dataset.check = `check.js: ${error.stack}`));

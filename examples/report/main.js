// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
"use strict";

const data = JSON.parse(document.getElementById("data").textContent);
const byId = (id) => document.getElementById(id);
const fill = (name, ...parts) => document.querySelector(`[data-fill="${name}"]`).replaceChildren(...parts);
const plot = (name) => document.querySelector(`[data-plot="${name}"]`);
const canvasOf = (name) => document.querySelector(`[data-mesh="${name}"]`);
const whole = (n) => n.toLocaleString("en-US");

// ---- words ----

function limitSentence(limit) {
  const { certified, refuted } = bracket(limit);
  if (certified === Infinity) return "every step is certified";
  if (certified > 0 && refuted < Infinity) return `steps up to ${safeSeconds(certified)} are certified, from ${failingSeconds(refuted)} on refuted`;
  if (certified > 0) return `steps up to ${safeSeconds(certified)} are certified`;
  return "no step is certified";
}

function writeHead() {
  const { findings } = data;
  document.title = `${data.name}: stability report`;
  fill("name", data.name.split("/").pop());
  const parts = [];
  if (mesh) parts.push(`${whole(findings.particles)} particles, ${mesh.pinned.length ? whole(mesh.pinned.length) : "none"} pinned`, `${whole(findings.springs)} springs`);
  parts.push(`${whole(findings.degrees_of_freedom)} degrees of freedom`);
  fill("scene", [parts.join(", "), data.space && data.space.replaceAll(" x ", " × ").replace("^2", "²")].filter(Boolean).join("; "));
  const fact = (name, limit) => {
    const { certified } = bracket(limit);
    const [value, unit] = certified === Infinity ? ["every step", ""] : certified > 0 ? safeSeconds(certified).split("\u00a0") : ["none", ""];
    return [name, value, unit];
  };
  const facts = [fact(mesh ? "Symplectic Euler, certified at this pose" : "Symplectic Euler, certified", findings.symplectic_euler)];
  if (findings.any_pose.cause) facts.push(fact("Symplectic Euler, certified at any pose", findings.any_pose));
  if (findings.energy_stable.cause) facts.push(fact("Energy-stable Euler, certified for the energy", findings.energy_stable));
  const stiffest = findings.k_max.upper;
  facts.push(["Fastest vibration, at most", ...(stiffest > 0 ? frequency(atLeast(Math.sqrt(stiffest) / (2 * Math.PI))) : ["none", ""])]);
  byId("facts").replaceChildren(
    ...facts.map(([name, value, unit]) => {
      const box = document.createElement("div");
      const dt = document.createElement("dt");
      const dd = document.createElement("dd");
      dt.textContent = name;
      const small = document.createElement("small");
      small.textContent = unit && `\u00a0${unit}`;
      dd.append(value, small);
      box.append(dt, dd);
      return box;
    }),
  );
  const price = bracket(findings.energy_stable.cause ? findings.energy_stable : findings.symplectic_euler);
  const frame = price.certified > 0 && price.certified < Infinity ? Math.ceil(1 / 60 / price.certified) : 0;
  fill(
    "lede",
    `Symplectic Euler: ${limitSentence(findings.symplectic_euler)}.` +
      (frame ? ` At the step certified ${findings.energy_stable.cause ? "for the energy" : "here"}, a frame of 1/60\u00a0s is ${whole(frame)} ${frame === 1 ? "step" : "steps"}.` : "") +
      remedy(findings.want_step),
  );
}

/// What is known of the step of --want-step, and what would make it safe.
function remedy(want) {
  if (!want) return "";
  const asked = ` The step asked for, ${want.standing === "refuted" ? failingSeconds(want.h) : safeSeconds(want.h)},`;
  const grows = want.growth === null ? "" : `: the limiting vibration grows ${significant(want.growth)}-fold with every step`;
  const here = { certified: "certified", undecided: "neither certified nor refuted", refuted: `refuted${grows}` }[want.standing];
  if (!want.any_pose) return `${asked} is ${here}${want.safe ? "" : `.${cures(want)}`}.`;
  const { proved, substeps } = want.any_pose;
  const moving = want.safe ? "certified at any pose" : proved ? "certified at any pose, but above 0.95 of the limit" : "not certified at any pose";
  const instead = want.safe || substeps === null ? "" : `; ${whole(substeps)} steps, each at most 0.95 of the limit, take its place`;
  return `${asked} is ${moving}${instead}. At this pose it is ${here}${want.safe ? "" : `.${cures(want)}`}.`;
}

/// Without the last full stop.
function cures(want) {
  if (!(want.stiffness_scale > 0) || want.mass_scale === null) return " No scale of stiffness or masses is proved to make it safe";
  if (!want.cures_are_near) return ` No other cure is near: stiffness or masses would have to change ${significant(atLeast(want.mass_scale))}-fold`;
  const where = want.cures_hold === "any_pose" ? "any pose, at 0.95 of the limit," : "this pose";
  const added = want.added_mass === null ? "" : `, or ${significant(atLeast(want.added_mass))} kg more on the particles that need it`;
  return ` It is certified at ${where} with all stiffness times ${significant(atMost(want.stiffness_scale))}, or all masses times ${significant(atLeast(want.mass_scale))}${added}`;
}

function frequency(f) {
  const [size, unit] = f >= 1e6 ? [1e6, "MHz"] : f >= 1e3 ? [1e3, "kHz"] : [1, "Hz"];
  return [String(+(f / size).toPrecision(4)), unit];
}

/// What a reader can do something about, once for the integrators that share it.
function causeSentences() {
  const groups = new Map();
  for (const [key, name] of knownLimits(data)) {
    const cause = data.causes[key];
    if (!cause || ["stiffness", "unconditional"].includes(data.findings[key].cause)) continue;
    groups.set(cause, [...(groups.get(cause) || []), name]);
  }
  return [...groups].map(([cause, names]) => ` ${names.join(", ")}: ${cause}.`).join("");
}

/// What the three kinds of promise are; bare matrices have one.
function promises() {
  if (!data.findings.energy_stable.cause) return "";
  return " At this pose: no small vibration about the mesh as it stands grows. At any pose: none grows about any pose that it moves through, but its energy may rise. Energy: no step of EnergyStableEuler raises it by more than the work done from outside, however the mesh moves; above refuted the proof ends, not the scene.";
}

function writeCaptions() {
  const { findings } = data;
  fill("limits", `Each bar is one integrator: steps in its first part are certified, steps in its last part are refuted, and the true limit lies between.${promises()}${causeSentences()}`);
  if (data.multipliers) {
    const { below, above } = data.multipliers;
    for (const side of ["below", "above"])
      for (const place of [side, `multipliers-${side}`]) fill(place, `h = ${(side === "below" ? safeSeconds : failingSeconds)(data.multipliers[side].h)}`);
    const swept = below.others.length ? " The small dots are all softer vibrations." : "";
    fill("multipliers", `A step of symplectic Euler multiplies every vibration by its μ. Inside the unit circle or on it the vibration dies out or goes on ringing; outside it grows at every step. Large dots: the limiting vibration, whose larger |μ| is ${below.radius.toFixed(4)} below the limit and ${above.radius.toFixed(4)} above.${swept}`);
  }
  if (data.runs) {
    const { kick, above, below } = data.runs;
    const grown = +(Math.max(...above.reach) / kick).toPrecision(2);
    const text = document.createElement("small");
    text.textContent = `Both are symplectic Euler with the full nonlinear spring forces, and differ in h alone; the limit is the one at this pose. Gravity is left out, so that the pose is at rest and nothing but the step moves it. Both start with the same kick along the limiting vibration: without it the growth would begin at rounding and take longer to be seen. Dashed: the growth that the multipliers below predict, until the mesh is too far from its pose for a linear prediction. Colour: how far a particle is from its place, as along the chart's upright axis. Every ${ordinal(data.runs.steps_a_frame)} step is shown.`;
    fill("runs", `Below the limit a kick of ${metres(kick, 2)} ${data.multipliers.below.radius < 0.9999 ? "rings, dies out" : "goes on ringing"} and stays within ${metres(Math.max(...below.reach), 2)}; above it, the same kick has grown ${whole(grown)}-fold after ${above.steps} steps.`, text);
  }
  if (data.mesh && data.mesh.share.length) {
    const { share, foremost } = data.mesh;
    let half = 0;
    let sum = 0;
    while (half < share.length && sum < 0.5) sum += foremost * share[half++];
    const held = `${sum < 0.5 ? percent(sum, 2) : "Half"} of that energy is in ${whole(half)} of ${whole(findings.springs)} springs`;
    const blame = half <= 100 ? "softening these, or making their ends heavier, lengthens the step" : "the vibration is spread out, and no few springs are to blame";
    fill("springs", `Red: the springs that take part in the limiting vibration. The more of its elastic energy a spring holds, the stronger its line. ${held}: ${blame}.`);
  }
  if (data.window) {
    const mark = findings.rayleigh_window;
    const none = mark.empty || (mark.upper !== "unbounded" && !(atLeast(mark.lower, 3) < atMost(mark.upper, 3)));
    const at = none ? `At h = ${seconds(mark.h, 3)} none ${mark.empty ? "" : "of three digits "}is left.` : `At h = ${seconds(mark.h, 3)}, the heavy line, explicit Euler needs α between ${failingSeconds(mark.lower, 3)} and ${mark.upper === "unbounded" ? "any length" : safeSeconds(mark.upper, 3)}.`;
    fill("window", `Shaded: the damping α (the damping matrix is α times the stiffness matrix${mark.d0 > 0 ? `, beside d0 = ${significant(mark.d0)} 1/s on the mass` : ""}) for which a step is certified${mesh ? " at this pose" : ""}. ${at} Explicit Euler needs some damping and bears no more than the upper edge; symplectic Euler needs none. Both windows close at h = 2/√k, where k is the proved bound on the stiffest vibration.`);
  }
}

function writeResolution() {
  const told = data.resolution;
  if (!told) return;
  fill("resolution-goal", `${percent(told.goal)} for ${seconds(told.duration)}`);
  const compared = told.levels.length > 1 ? " Each dot is a network of fewer particles in place of the mesh, stepped at its own certified step. Its error is estimated by comparing its motion with that of the finest one that was run: no certificate." : "";
  const measured = told.measured_error === null ? "" : ` The scene itself was run for this page, too: the ${whole(told.particles)} particles, lifted onto its mesh, are off by ${percent(told.measured_error)}.`;
  const text = document.createElement("small");
  text.textContent = resolved ? "Dots: the particles of the coarse network. Colour: how far the mesh that they carry is from the scene’s own motion, up to twice the goal." : "";
  fill("resolution", `${told.why}${compared}${measured}`, text);
}

/// As the program prints it, once rounded to its side.
const printed = (h) => `${h.toExponential(4).replace(/([+-])(\d)$/, "$10$2")} s`;
const ordinal = (n) => (n === 1 ? "" : n === 2 ? "second" : n === 3 ? "third" : `${n}th`);

function writeTable() {
  const rows = knownLimits(data).map(([key, name, where]) => {
    const limit = data.findings[key];
    const { certified, refuted } = bracket(limit);
    return [where ? `${name}, ${where}` : name, certified === Infinity ? "every step" : certified > 0 ? printed(atMost(certified, 5)) : "none", refuted === Infinity ? "none" : refuted > 0 ? printed(atLeast(refuted, 5)) : "every step", limit.cause.replace(/_/g, " ")];
  });
  const table = byId("table");
  const row = (cells, kind) => {
    const tr = document.createElement("tr");
    cells.forEach((text, i) => {
      const cell = document.createElement(kind || (i === 0 ? "th" : "td"));
      if (i > 0) cell.className = "n";
      cell.textContent = text;
      tr.append(cell);
    });
    return tr;
  };
  const head = document.createElement("thead");
  head.append(row(["", "certified", "refuted", "set by"], "th"));
  const body = document.createElement("tbody");
  body.append(...rows.map((cells) => row(cells)));
  table.replaceChildren(head, body);
}

// ---- pictures ----

const mesh = data.mesh && decodeMesh(data.mesh);
if (mesh) chooseNearest(mesh);
const films = mesh && data.runs && {
  below: decodeRun(data.runs.below, data.runs, mesh, data.mesh.index_bytes),
  above: decodeRun(data.runs.above, data.runs, mesh, data.mesh.index_bytes),
};
const resolved = mesh && data.resolution && data.resolution.films && decodeFilms(data.resolution.films, mesh, data.resolution.goal);
let colours = colourTable();
let shown = 0;
let instant = 0;

function drawInstant() {
  for (const side of ["fine", "coarse"]) paintFilm(canvasOf(`resolution-${side}`), mesh, resolved, side, instant, colours);
  byId("instant").value = instant;
  byId("instant-words").textContent = `after ${seconds((instant * data.resolution.duration) / (resolved.frames - 1), 3)}`;
}

function drawFrame() {
  for (const side of ["below", "above"]) {
    const { x, level } = films[side].frame(Math.min(shown, films[side].frames - 1));
    paintMesh(canvasOf(side), mesh, x, level, colours);
  }
  const step = shown * data.runs.steps_a_frame;
  const { above } = data.runs;
  byId("scrub").value = shown;
  byId("when").textContent = `step ${step} of ${(above.frames - 1) * data.runs.steps_a_frame}, ${seconds(step * above.h, 3)}`;
  moveCursor(plot("reach"), data, step);
}

function drawMeshes() {
  if (films) drawFrame();
  if (resolved) drawInstant();
  if (!mesh) return;
  paintSprings(canvasOf("whole"), mesh, colours, false);
  paintSprings(canvasOf("close"), mesh, colours, true);
}

function drawCharts() {
  drawLimits(plot("limits"), data);
  if (data.multipliers) for (const side of ["below", "above"]) drawMultipliers(plot(`multipliers-${side}`), data, side);
  if (data.window) for (const method of ["explicit", "symplectic"]) drawWindow(plot(`window-${method}`), data, method);
  if (data.mesh && data.mesh.share.length) drawShares(plot("shares"), data);
  if (data.resolution && data.resolution.levels.length > 1) drawResolution(plot("resolution"), data.resolution);
  if (films) drawReach(plot("reach"), data, shown * data.runs.steps_a_frame);
}

function drawAll() {
  drawCharts();
  drawMeshes();
}

let timer = 0;
function stop() {
  clearInterval(timer);
  timer = 0;
  byId("play").textContent = "Play";
}

function play() {
  if (timer) return stop();
  const last = films.above.frames - 1;
  if (shown >= last) shown = 0;
  byId("play").textContent = "Pause";
  drawFrame();
  timer = setInterval(() => {
    ++shown;
    drawFrame();
    if (shown >= last) stop();
  }, Math.max(90, 5000 / films.above.frames));
}

function start() {
  byId("runs").hidden = !films;
  byId("multipliers").hidden = !data.multipliers;
  byId("springs").hidden = !(mesh && data.mesh.share.length && data.mesh.extent > 1e-100);
  byId("window").hidden = !data.window;
  byId("resolution").hidden = !data.resolution;
  byId("resolution-films").hidden = !resolved;
  let number = 0;
  for (const mark of document.querySelectorAll("figure:not([hidden]) h2 span")) mark.textContent = ++number;
  writeHead();
  writeCaptions();
  writeResolution();
  writeTable();
  if (resolved) {
    byId("instant").max = instant = resolved.frames - 1;
    byId("instant").addEventListener("input", (event) => {
      instant = +event.target.value;
      drawInstant();
    });
  }
  if (films) {
    const last = films.above.frames - 1;
    byId("scrub").max = last;
    shown = last; // a page that is printed or never played shows the difference
    byId("play").addEventListener("click", play);
    byId("scrub").addEventListener("input", (event) => {
      stop();
      shown = +event.target.value;
      drawFrame();
    });
  }
  for (const canvas of document.querySelectorAll("canvas")) turnable(canvas, drawMeshes);
  drawAll();
  let pending = 0;
  let width = document.body.clientWidth;
  addEventListener("resize", () => {
    if (document.body.clientWidth === width) return;
    width = document.body.clientWidth;
    cancelAnimationFrame(pending);
    pending = requestAnimationFrame(drawAll);
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    colours = colourTable();
    drawAll();
  });
}

start();

// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// The scene beside the coarser network that was chosen for it, moving in the same time. The worker
// steps both, and this plays what it has sent.

import { View } from "./view.js";
import { whole } from "./words.js";

/* global safeSeconds, percent, significant */

const HOLD = 1.5;  // s for which the end is shown before it begins again
const byId = (id) => document.getElementById(id);

export class Beside {
  constructor() {
    this.running = false;
    this.seen = false;
    new IntersectionObserver(([entry]) => (this.seen = entry.isIntersecting)).observe(byId("beside"));
  }

  hide() {
    this.running = false;
    byId("beside").hidden = true;
  }
  /// @param mesh  as MeshModel takes it   @param found  the answer of resolve
  show(mesh, found, pinned) {
    this.mesh = mesh;
    this.found = found;
    this.slow = false;  // whether the scene itself would take too long
    this.pins = pinned.length;  // the first seeds, which are drawn already
    this.count = mesh.positions.length / 3;
    this.still = new Float32Array(this.count);
    this.frames = [{ time: 0, all: mesh.positions, few: mesh.positions, apart: 0 }];
    this.took = NaN;  // s that all of the stepping took; NaN: it goes on
    this.time = 0;
    byId("beside").hidden = false;
    byId("beside").classList.remove("one");
    this.view ??= new View(byId("beside-view"), 2);
    this.view.only = undefined;
    this.view.show(mesh);
    this.view.lookAgain();
    this.view.camera.position.multiplyScalar(1.12);  // what hangs becomes longer
    this.view.each((model) => model.setPins(pinned, mesh.positions));
    byId("all").textContent = `All ${whole(this.count)} particles`;
    byId("few").textContent = `${whole(found.chosen.particles)} particles (pins and dots), at ${safeSeconds(found.chosen.h, 3)}`;
    this.running = true;
    this.draw();
  }
  /// What the worker has stepped. @param sent  {seeds, h, slow} once, then {time, all, few, apart} often
  take(sent) {
    if (sent.seeds) {
      this.view.panes[1].model.setSeeds(sent.seeds.slice(this.pins));
      byId("all").textContent += `, at ${safeSeconds(sent.h, 3)}`;
      this.slow = sent.slow;
      byId("beside").classList.toggle("one", sent.slow);
      this.view.only = sent.slow ? 1 : undefined;
    } else this.frames.push(sent);
  }

  /// @param elapsed  s
  tick(elapsed) {
    if (!this.running || !this.seen) return;
    const last = this.frames[this.frames.length - 1].time;
    this.time += elapsed;
    if (Number.isNaN(this.took)) this.time = Math.min(this.time, last);
    else if (this.time > last + HOLD) this.time = 0;
    this.draw();
  }
  /// The last frame that is due.
  get frame() {
    const next = this.frames.findIndex(({ time }) => time > this.time);
    return this.frames[next < 0 ? this.frames.length - 1 : next - 1];
  }

  draw() {
    const { mesh, still, frame } = this;
    this.view.panes.forEach(({ model }, which) => model.draw((which === 0 && frame.all) || frame.few, still, mesh.edge));
    this.view.render();
    byId("beside-words").textContent = this.words();
  }
  words() {
    const { found, slow, took, frame: { time, apart } } = this;
    const at = `${time.toFixed(2)}\u00a0s of ${found.duration}\u00a0s`;
    if (slow) return `${at}. Stepping all ${whole(this.count)} particles would take more than a minute here, so they are not shown beside it.`;
    if (apart === Infinity) return `${at}. A step failed.`;
    const pace = Number.isNaN(took) ? ", as fast as all particles are stepped here" : `, replayed; stepping both took ${significant(took, 2)}\u00a0s`;
    const measured = apart > 0 ? ` Measured here, both were at most ${percent(apart, 2)} of the scene’s size apart so far; estimated were ${percent(found.chosen.error, 2)} for all of it.` : "";
    return `${at}${pace}.${measured}`;
  }
}

// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// The scene beside the coarser network that was chosen for it, moving in the same time.

import { View } from "./view.js";
import { whole } from "./words.js";

/* global seconds, percent, significant */

const BUDGET = 8;    // ms of stepping a picture
const HOLD = 90;     // pictures for which the end is shown before it begins again
const LARGE = 5000;  // particles of which every step is looked at by the clock
const byId = (id) => document.getElementById(id);

export class Beside {
  constructor(lab) {
    this.lab = lab;
    this.running = false;
    this.seen = false;
    new IntersectionObserver(([entry]) => (this.seen = entry.isIntersecting)).observe(byId("beside"));
  }

  hide() {
    this.running = false;
    byId("beside").hidden = true;
  }
  /// @param mesh  as MeshModel takes it   @param found  the answer of resolve
  /// @param slow  whether the scene itself would take too long
  show(mesh, found, pinned, slow) {
    const { lab } = this;
    this.mesh = mesh;
    this.found = found;
    this.slow = slow;
    this.still = new Float32Array(lab.size());
    byId("beside").hidden = false;
    byId("beside").classList.toggle("one", slow);
    this.view ??= new View(byId("beside-view"), 2);
    this.view.only = slow ? 1 : undefined;
    this.view.show(mesh);
    this.view.lookAgain();
    this.view.each((model) => model.setPins(pinned, mesh.positions));
    lab.startBeside(found.chosen.particles, found.duration, !slow);
    this.view.panes[1].model.setSeeds(lab.besideSeeds());
    byId("all").textContent = slow ? "" : `All ${whole(lab.size())} particles, at ${seconds(found.duration / lab.besideSteps(), 3)}`;
    byId("few").textContent = `${whole(found.chosen.particles)} particles (dots), at ${seconds(found.chosen.h, 3)}`;
    this.running = true;
    this.begin();
    this.draw();
  }
  begin() {
    this.time = 0;
    this.owed = 0;  // s that the clock is ahead
    this.held = 0;
    this.pace = NaN;
  }

  /// @param elapsed  s
  tick(elapsed) {
    if (!this.running || !this.seen) return;
    const { lab, found: { duration } } = this;
    if (this.time < 0.999999 * duration) {
      const from = this.time;
      this.owed = Math.min(this.owed + elapsed, 0.05);
      const start = performance.now();
      while (this.owed > 0 && this.time < 0.999999 * duration && performance.now() - start < BUDGET) {
        const before = this.time;
        this.time = lab.stepBeside(this.still.length > LARGE ? 1 : 8);
        this.owed -= this.time - before;
      }
      const pace = (this.time - from) / Math.max(elapsed, 1e-3);
      this.pace = Number.isNaN(this.pace) ? pace : this.pace + 0.05 * (pace - this.pace);
    } else if (++this.held > HOLD) {
      lab.besideAgain();
      this.begin();
    }
    this.draw();
  }

  draw() {
    const { lab, mesh, still } = this;
    this.view.panes.forEach(({ model }, which) => model.draw(lab.besidePositions(which), still, mesh.edge));
    this.view.render();
    byId("beside-words").textContent = this.words();
  }
  words() {
    const { found, slow } = this;
    const apart = this.lab.besideApart();
    const at = `${seconds(this.time, 2)} of ${seconds(found.duration, 2)}`;
    if (slow) return `${at}. All ${whole(this.lab.size())} particles would take minutes to step here, so they are not shown beside it.`;
    if (apart === Infinity) return `${at}. A step failed.`;
    const pace = this.pace < 0.9 ? `, at ${significant(this.pace, 1)} of real time, which all particles take` : "";
    const measured = apart > 0 ? ` Measured here, both were at most ${percent(apart, 2)} of the scene’s size apart until now; estimated for all of it were ${percent(found.chosen.error, 2)}.` : "";
    return `${at}${pace}.${measured}`;
  }
}

// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// The scene twice, kicked along its limiting mode: stepped just below and just above its limit.

import { SYMPLECTIC } from "./engine.js";
import { View } from "./view.js";

/* global safeSeconds, failingSeconds, metres, significant */

const BELOW = 0.99, ABOVE = 1.01;  // of the certified step, of the refuted one
const STEPS = 2;    // a picture: the limiting mode turns over at every step, and would flicker
const HOLD = 90;    // pictures for which the end is shown before it begins again
const byId = (id) => document.getElementById(id);

export class Pair {
  constructor(lab) {
    this.lab = lab;
    this.running = false;
    this.seen = false;
    new IntersectionObserver(([entry]) => (this.seen = entry.isIntersecting)).observe(byId("pair"));
  }

  /// @param mesh  as MeshModel takes it   @param found  of the analysis
  show(mesh, found, pinned) {
    const { certified, refuted } = found.limits[SYMPLECTIC];
    this.mesh = mesh;
    this.found = found;
    this.running = found.mode.size > 0;
    byId("pair").hidden = !this.running;
    if (!this.running) return;
    this.view ??= new View(byId("pair-view"), 2);
    if (this.drawn !== mesh) {
      this.drawn = mesh;
      this.view.show({ ...mesh, centre: mesh.middle });  // here it does not hang
      this.view.lookAgain(mesh.flat);
    }
    this.view.each((model) => model.setPins(pinned, mesh.positions));
    this.h = [BELOW * certified, ABOVE * refuted];
    const growth = this.lab.growth(SYMPLECTIC, found.mode, this.h[1]);
    byId("below").textContent = `${safeSeconds(this.h[0], 3)}, 1 % below the certified step`;
    byId("above").textContent = `${failingSeconds(this.h[1], 3)}, 1 % above the refuted step: grows ${significant(growth, 3)}-fold a step`;
    this.restart();
    this.draw();
  }
  restart() {
    this.taken = 0;
    this.held = 0;
    this.ended = false;
    this.lab.startPair(this.found.kick, this.found.mode.speed, ...this.h);
    this.reach = this.found.mode.size;
  }

  tick() {
    if (!this.running || !this.seen) return;
    const { lab, mesh } = this;
    if (!this.ended) {
      this.reach = lab.stepPair(STEPS);
      this.taken += STEPS;
      this.ended = !(this.reach < 0.35 * mesh.size) || this.taken >= this.found.mode.steps;
    } else if (++this.held > HOLD) this.restart();
    this.draw();
  }
  draw() {
    const { lab, mesh } = this;
    this.view.panes.forEach(({ model }, which) => model.draw(lab.pairPositions(which), lab.pairMoved(which), mesh.edge));
    this.view.render();
    byId("pair-words").textContent = `Step ${this.taken}. Both began with a kick of ${metres(this.found.mode.size, 2)} along the limiting vibration, without gravity.`;
  }
}

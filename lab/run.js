// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// The scene in motion: how many steps a picture takes, what they do, and whether they still are a
// motion of the scene.

import { standing } from "./charts.js";
import { FRAME } from "./words.js";

const BUDGET = 11;    // ms of stepping a picture, so that the page stays in hand
const SLOW = 1.12;    // an unstable vibration grows by at most this in a picture
const GRAVITY = 9.81;  // m/s²
const ROUGH = 100;     // m/s², of a cloth that is worn
const START = 0.1;     // s, in which what begins inside a body comes out
export const SAMPLES = 300;  // pictures in the chart

export class Run {
  /// @param app  {lab, settings, limits(), growth(), view()} and blownUp(steps, swing)
  constructor(app) {
    this.app = app;
    this.pace = 1;
    this.reset();
  }

  /// The scene as it was laid out, at rest.
  reset() {
    const { lab } = this.app;
    lab.reset();
    this.shape = lab.shape();
    this.worn = lab.worn();
    this.depth = -Infinity;  // of the deepest particle below the skin, m
    this.blown = false;
    this.owed = 0;   // s of simulated time that the clock is ahead
    this.steps = 0;  // since the last reset
    this.samples = [];
    this.forget();
  }
  /// What was seen so far says nothing of the step that is set now.
  forget() {
    this.changedAt = this.steps;
    this.beyond = 0;      // pictures in a row in which the swing was no motion of a cloth
    this.anchor = null;   // where the growth that is predicted begins: {ringing, steps}
    this.rising = 0;
    this.grown = false;   // past small amplitudes, for which alone a multiplier speaks
    this.measured = null;  // growth a step
    this.cost = NaN;      // s a step, the least of late
    for (const sample of this.samples) sample.predicted = NaN;
  }
  get ringing() {
    return this.samples.length ? this.samples[this.samples.length - 1].ringing : 0;
  }

  /// Steps what the clock asks for, or as much as fits: an instability is slowed down to be seen.
  /// @param elapsed  s   @returns {taken, slowed}
  advance(elapsed) {
    const { lab, settings: { method, h } } = this.app;
    const growth = this.app.growth();
    const most = growth > 1.0001 ? Math.max(1, Math.floor(Math.log(SLOW) / Math.log(growth))) : Infinity;
    this.owed = Math.min(this.owed + elapsed, Math.max(2 * FRAME, h));
    const due = Math.floor(this.owed / h);
    const wanted = Math.min(due, most);
    const begin = performance.now();
    const since = lab.time();
    let taken = 0;
    let chunk = Math.min(wanted, lab.size() > 5000 ? 1 : 8);
    while (taken < wanted && !this.blown) {
      if (lab.step(method, h, chunk) !== 0) this.blowUp(Infinity);
      taken += chunk;
      this.steps += chunk;
      if (performance.now() - begin > BUDGET) break;
      chunk = Math.min(wanted - taken, 2 * chunk);
    }
    const spent = (performance.now() - begin) / 1000;
    if (taken > 0 && spent > 0.002) this.cost = Math.min(spent / taken, Number.isFinite(this.cost) ? 1.02 * this.cost : Infinity);
    if (taken < due) this.owed = 0;
    else this.owed -= taken * h;
    this.pace += 0.1 * ((lab.time() - since) / Math.max(elapsed, 1e-3) - this.pace);
    if (taken > 0) this.observe(taken);
    return { taken, slowed: most < due };
  }

  observe(taken) {
    const { lab, settings: { h } } = this.app;
    const { edge } = this.shape;
    const ringing = lab.ringing().reduce((a, b) => Math.max(a, b), 0);
    if (this.worn && lab.time() > START) this.depth = Math.max(this.depth, lab.depth());
    const growth = this.app.growth();
    const before = this.samples[this.samples.length - 1];
    const sample = { ringing, predicted: NaN, state: standing(h, this.app.limits()) };
    this.samples.push(sample);
    if (this.samples.length > SAMPLES) this.samples.shift();

    this.grown = this.grown || ringing > edge / 30;
    if (growth > 1.0005 && before) {
      this.rising = ringing > before.ringing * Math.sqrt(growth ** taken) && !this.grown ? this.rising + 1 : 0;
      if (!this.anchor && this.rising >= 4) this.anchor = { ringing, steps: this.steps };
      if (this.anchor) {
        const since = this.steps - this.anchor.steps;
        sample.predicted = this.anchor.ringing * growth ** since;
        if (!this.grown && since > 0) this.measured = (ringing / this.anchor.ringing) ** (1 / since);
      }
    }
    // Slow motion swings by h²g/4 and a little more; springs that go taut by more, for a moment.
    const violent = ringing > edge / 20 + 2 * (this.worn ? ROUGH : GRAVITY) * h * h;
    this.beyond = violent ? this.beyond + 1 : 0;
    if (this.beyond > 40 || (violent && this.reach() > 2.1)) this.blowUp(ringing);
  }

  /// How far a particle is from the middle of the scene, in diagonals of it.
  reach() {
    const { low, high } = this.shape;
    const x = this.app.lab.drawnPositions();
    const middle = high.map((v, d) => (v + low[d]) / 2);
    let most = 0;
    for (let i = 0; i < x.length; i += 3) most = Math.max(most, Math.hypot(x[i] - middle[0], x[i + 1] - middle[1], x[i + 2] - middle[2]));
    return most / Math.hypot(...high.map((v, d) => v - low[d]));
  }

  blowUp(swing) {
    if (this.blown) return;
    this.blown = true;
    this.app.blownUp(this.steps - this.changedAt, swing);
  }
}

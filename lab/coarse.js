// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// How coarse may it be? The goal that the reader sets, the search for it, and what it found.

import { Beside } from "./beside.js";
import { drawLevels } from "./charts.js";
import { counted, whole } from "./words.js";

/* global seconds, safeSeconds, percent */

const LEAST = 0.005, MOST = 0.2;  // goals, of the scene's size
const LARGE = 5000;     // particles from which on a search begins with the button only
const PAUSE = 250;      // ms for which the slider must rest
const byId = (id) => document.getElementById(id);

/// What a sentence of the library leaves open.
function more({ outcome, chosen }) {
  if (outcome === "coarse") return `The error is an estimate, not a certificate. The step is certified: at ${safeSeconds(chosen.h, 3)} the network’s energy cannot rise.`;
  if (outcome === "fine") return "The errors are estimates, not certificates.";
  if (outcome === "unpredictable") return "That is measured on a coarser network, and no certificate.";
  return "";
}

export class Coarse {
  /// @param app  {lab, task(), mesh(), makeAnalyst()}
  constructor(app) {
    this.app = app;
    this.beside = new Beside();
    this.asked = 0;
    this.busy = false;
    this.stepping = false;  // the worker makes what Beside shows
    this.found = null;
    byId("goal").addEventListener("input", () => this.changed());
    byId("durations").addEventListener("change", () => this.changed());
    byId("find").addEventListener("click", () => this.ask());
    byId("coarse-cancel").addEventListener("click", () => this.analyst.cancel());
    this.write();
  }

  get goal() {
    return +(LEAST * (MOST / LEAST) ** (byId("goal").value / byId("goal").max)).toPrecision(2);
  }
  get duration() {
    return Number(document.querySelector('input[name="duration"]:checked').value);
  }
  write() {
    byId("goal-value").textContent = percent(this.goal, 2);
    const large = this.app.mesh() && this.app.lab.size() > LARGE;
    byId("coarse-large").textContent = large ? `With ${whole(this.app.lab.size())} particles the search may take a minute. It begins only with the button.` : "";
    byId("coarse").classList.toggle("old", Boolean(this.found) && (this.busy || this.found.goal !== this.goal || this.found.duration !== this.duration));
  }
  /// Another goal: a small scene is searched again at once.
  changed() {
    clearTimeout(this.timer);
    this.write();
    if (this.app.lab.size() <= LARGE) this.timer = setTimeout(() => this.ask(), PAUSE);
  }

  /// What was found, or is being searched for, is of a scene that is no more.
  /// @param words  that say so
  clear(words) {
    clearTimeout(this.timer);
    const known = this.busy || this.found;
    this.stop();
    this.drop(known ? words : byId("coarse-words").textContent && words);
  }
  stop() {
    ++this.asked;
    if (this.busy || this.stepping) this.analyst.cancel();
    this.stepping = false;
    this.working(false);
  }
  drop(words) {
    this.found = null;
    this.beside.hide();
    byId("coarse-found").hidden = true;
    byId("coarse-words").textContent = words;
    byId("coarse-more").textContent = "";
    this.write();
  }
  working(on) {
    this.busy = on;
    byId("searching").hidden = !on;
    byId("coarse-progress").value = 0;
    byId("coarse-progress-words").textContent = "opening the scene";
    this.write();
  }

  async ask() {
    clearTimeout(this.timer);
    this.stop();
    const mine = this.asked;
    this.analyst ??= this.app.makeAnalyst();
    this.working(true);
    try {
      const found = await this.analyst.resolve({ ...this.app.task(), goal: this.goal, duration: this.duration }, (done, words) => {
        byId("coarse-progress").value = done;
        byId("coarse-progress-words").textContent = words;
      });
      if (mine === this.asked) this.take(found);
    } catch (error) {
      if (mine === this.asked) this.drop(error.cancelled ? "Cancelled: how coarse it may be is not known." : error.message);
    }
    if (mine === this.asked) this.working(false);
  }

  take(found) {
    const { lab } = this.app;
    this.found = found;
    byId("coarse-words").textContent = found.words.replace(/(\d) (?=%|s\b)/g, "$1\u00a0");
    byId("coarse-more").textContent = more(found);
    byId("coarse-found").hidden = false;
    this.draw();
    if (found.outcome !== "coarse") return this.beside.hide();
    this.beside.show(this.app.mesh(), found, lab.pinned());
    this.step(this.asked, { ...this.app.task(), duration: found.duration, particles: found.chosen.particles });
  }
  async step(mine, what) {
    this.stepping = true;
    try {
      const took = await this.analyst.beside(what, (_done, _words, sent) => mine === this.asked && this.beside.take(sent));
      if (mine === this.asked) this.beside.took = took;
    } catch (error) {
      if (mine === this.asked && !error.cancelled) this.beside.hide();
    }
    if (mine === this.asked) this.stepping = false;
  }
  /// Levels whose error is known, as a chart.
  draw() {
    if (!this.found) return;
    const known = this.found.levels.filter(({ error }) => error < Infinity);
    byId("coarse-chart-box").hidden = known.length === 0;
    if (known.length === 0) return;
    drawLevels(byId("coarse-chart"), known, this.found);
    const finest = this.found.levels[this.found.levels.length - 1];
    byId("coarse-chart-words").textContent = `Each dot is a network with that many particles; ${counted(finest.particles, "particle")}, the most that were run, are what the others are compared with. Of three networks or more, the coarsest is chosen whose line, which reaches to twice the estimate, stays below the goal.`;
  }
}

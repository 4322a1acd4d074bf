// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Where a scene is chosen: the shipped ones, a file that is picked or dropped, its axes, unit and
// pins; and where it is said what is wrong with it.

import { UNITS, changed, fromFile, shipped } from "./scenes.js";

const byId = (id) => document.getElementById(id);
const OPTIONS = ["weld", "by-area", "by-length"];  // the bits of lab_open_mesh
const PATIENCE = 250;  // ms after which progress is shown

export class SceneBar {
  /// @param act  open(scene), cancel(), pinTop(), unpin()
  constructor(act) {
    this.act = act;
    this.scene = null;   // as it is shown
    this.wanted = null;  // as it was asked for last: what the next change begins from
    this.asked = 0;
    this.busy = false;
    byId("scenes").addEventListener("change", async ({ target }) => {
      this.open(() => shipped(target.value));
    });
    byId("file").addEventListener("change", ({ target }) => {
      const [file] = target.files;
      if (file) this.open(() => fromFile(file));
      target.value = "";  // the same file, mended, can be picked again
    });
    byId("up").addEventListener("change", ({ target }) => this.change({ up: Number(target.value) }));
    byId("unit").addEventListener("change", ({ target }) => {
      byId("factor").hidden = target.value !== "factor";
      if (target.value === "factor") byId("factor").focus();
      else this.change({ scale: UNITS[target.value] });
    });
    byId("factor").addEventListener("change", ({ target }) => {
      const scale = Number(target.value);
      if (scale > 0 && scale < Infinity) this.change({ scale });
      else this.complain("A scale is a number above 0: how many metres one unit of the file has.");
    });
    for (const id of OPTIONS) byId(id).addEventListener("change", () => {
      const options = OPTIONS.reduce((sum, name, bit) => sum + (byId(name).checked ? 1 << bit : 0), 0);
      this.change(id === "weld" ? { options, pins: undefined } : { options });  // welding numbers particles anew
    });
    byId("pin-top").addEventListener("click", act.pinTop);
    byId("unpin").addEventListener("click", act.unpin);
    byId("cancel").addEventListener("click", act.cancel);
    this.takeDrops();
  }

  takeDrops() {
    const hasFiles = (event) => [...event.dataTransfer.types].includes("Files");
    let inside = 0;
    const mark = (by) => {
      inside = by === 0 ? 0 : inside + by;
      document.body.classList.toggle("dropping", inside > 0);
    };
    addEventListener("dragenter", (event) => hasFiles(event) && mark(1));
    addEventListener("dragleave", (event) => hasFiles(event) && mark(-1));
    addEventListener("dragover", (event) => event.preventDefault());
    addEventListener("drop", (event) => {
      event.preventDefault();
      mark(0);
      const [file] = event.dataTransfer.files;
      if (file) this.open(() => fromFile(file));
    });
  }

  async open(make) {
    const mine = ++this.asked;
    const back = () => {
      if (mine !== this.asked) return;
      this.wanted = this.scene;
      this.mark();
    };
    try {
      const scene = await make();
      if (mine !== this.asked) return;
      this.wanted = scene;
      if (!(await this.act.open(scene))) back();
    } catch (error) {
      this.complain(error.message);
      back();
    }
  }
  change(more) {
    const scene = this.wanted = changed(this.wanted, more);
    this.open(() => scene);
  }
  /// What the reader set by hand stays with the scene. A scene that was on its way is given up.
  keep(more) {
    ++this.asked;
    this.scene = this.wanted = { ...this.scene, ...more };
    this.mark();
  }

  /// @param words  sentences that are worth knowing
  show(scene, words) {
    this.scene = this.wanted = scene;
    this.mark();
    byId("notes").replaceChildren(...words.map((text) => Object.assign(document.createElement("p"), { textContent: text })));
  }
  /// The controls as the scene has them.
  mark() {
    const { id, name, scale, up, text, options } = this.scene;
    for (const radio of document.getElementsByName("scene")) radio.checked = radio.value === id;
    byId("file-name").textContent = id === "file" ? name : "Your mesh …";
    document.querySelector(".file").classList.toggle("chosen", id === "file");
    byId("invite").hidden = id === "file";
    byId("axes").hidden = byId("options").hidden = !text;
    OPTIONS.forEach((name, bit) => (byId(name).checked = Boolean(options & (1 << bit))));
    byId("up").value = String(up);
    const unit = Object.keys(UNITS).find((name) => UNITS[name] === scale);
    byId("unit").value = unit ?? "factor";
    byId("factor").hidden = Boolean(unit);
    byId("factor").value = String(scale);
  }

  complain(words) {
    byId("wrong").textContent = words;
    byId("wrong").hidden = !words;
  }
  working(on) {
    this.busy = on;
    clearTimeout(this.timer);
    if (!on) byId("working").hidden = true;
    else if (byId("working").hidden) this.timer = setTimeout(() => (byId("working").hidden = false), PATIENCE);
  }
  progress(done, words) {
    byId("progress").value = done;
    byId("progress-words").textContent = words;
  }
}

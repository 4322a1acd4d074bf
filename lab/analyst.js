// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// The page's side of worker.js.

export class Analyst {
  /// @param address  of worker.js   @param module  the WebAssembly.Module of lab.wasm
  constructor(address, module) {
    this.address = address;
    this.module = module;
    this.last = 0;
    this.waiting = new Map();  // id → {resolve, reject, progress}
    this.start();
  }

  start() {
    this.worker = new Worker(this.address);
    this.worker.onmessage = ({ data }) => this.take(data);
    this.worker.onerror = (event) => {
      event.preventDefault();
      this.end(new Error(event.message || "the worker cannot be started"));
    };
    this.ask("load", { module: this.module }).catch(() => {});
  }

  take({ id, result, error, refused, progress, words, sent }) {
    const task = this.waiting.get(id);
    if (!task) return;
    if (progress !== undefined) return task.progress(progress, words, sent);
    this.waiting.delete(id);
    if (error === undefined) return task.resolve(result);
    if (!refused) this.restart(new Error(error));  // what has aborted is of no use any more
    task.reject(Object.assign(new Error(error), { refused }));
  }

  ask(task, more, progress = () => {}) {
    const id = ++this.last;
    return new Promise((resolve, reject) => {
      this.waiting.set(id, { resolve, reject, progress });
      this.worker.postMessage({ id, task, ...more });
    });
  }

  /// Reads a scene. @returns {shape, pinned, words}   @param progress  (share done, words)
  open(scene, progress) {
    return this.ask("open", { scene }, progress);
  }
  /// Limits, limiting mode and blamed springs of {scene, pins, knobs}; nothing where another task
  /// came before its turn.
  analyse(what, progress) {
    return this.ask("analyse", what, progress);
  }
  /// The plans that are stable, the cheapest first, of a scene that has been analysed.
  advise(what) {
    return this.ask("advise", what);
  }

  /// How few particles will do, of {scene, pins, knobs, goal, duration}.
  resolve(what, progress) {
    return this.ask("resolve", what, progress);
  }
  /// Steps {scene, pins, knobs, duration, particles (of the coarser network)}. @param progress  (share done, nothing, what Beside takes)   @returns s it took
  beside(what, progress) {
    return this.ask("beside", what, progress);
  }

  /// Ends whatever is being done.
  cancel() {
    this.restart(Object.assign(new Error("Cancelled."), { cancelled: true }));
  }
  restart(why) {
    this.worker.terminate();
    const { waiting } = this;
    this.waiting = new Map();
    this.start();
    for (const task of waiting.values()) task.reject(why);
  }
  end(why) {
    for (const task of this.waiting.values()) task.reject(why);
    this.waiting.clear();
  }
}

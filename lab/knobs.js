// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// What the reader sets: material, mass, damping.

/* global seconds, withPrefix, significant */

const byId = (id) => document.getElementById(id);
const between = (low, high, share) => low * (high / low) ** share;
const share = (low, high, value) => Math.min(1, Math.max(0, Math.log(value / low) / Math.log(high / low)));

const grams = (v) => (v >= 1 ? `${significant(v, 3)}\u00a0kg` : withPrefix(1000 * v, "g", 3));
const KNOBS = {
  stiffness: { of: (v) => between(10, 1e5, v), at: (v) => share(10, 1e5, v), text: (v) => `${significant(v, 3)}\u00a0N/m` },
  mass: { of: (v) => between(0.001, 100, v), at: (v) => share(0.001, 100, v), text: grams },
  alpha: { of: (v) => (v === 0 ? 0 : between(1e-6, 1e-2, v)), at: (v) => (v === 0 ? 0 : share(1e-6, 1e-2, v)), text: (v) => (v === 0 ? "none" : seconds(v, 3)) },
  drag: { of: (v) => 3 * v, at: (v) => v / 3, text: (v) => (v === 0 ? "none" : `${significant(v, 2)}\u00a0/s`) },
};

/// Plausible, no more: stiffness in N/m, mass in kg a square metre, or a metre where there are no
/// faces, α in s, d0 in 1/s.
export const PRESETS = {
  cotton: { name: "Cotton", stiffness: 1000, mass: 0.3, alpha: 1e-4, drag: 0.4 },
  silk: { name: "Silk", stiffness: 300, area: 0.06, length: 0.002, alpha: 5e-5, drag: 0.8 },
  denim: { name: "Denim", stiffness: 4000, area: 0.45, length: 0.01, alpha: 3e-4, drag: 0.3 },
  net: { name: "Net", stiffness: 2000, area: 0.1, length: 0.008, alpha: 1e-4, drag: 0.3 },
  flag: { name: "Flag", stiffness: 800, area: 0.12, length: 0.004, alpha: 1e-4, drag: 1.2 },
  cape: { name: "Cape", stiffness: 1000, area: 0.25, length: 0.01, alpha: 2e-5, drag: 1 },
  rope: { name: "Rope", stiffness: 20000, area: 1, length: 0.07, alpha: 5e-5, drag: 0.2 },
};

/// A preset's knobs for a scene of this shape.
export function valuesOf(preset, shape) {
  const { stiffness, mass, area, length, alpha, drag } = PRESETS[preset];
  return { stiffness, mass: mass ?? (shape.area > 0 ? area * shape.area : length * shape.length), alpha, drag };
}

export class Knobs {
  /// @param changed  called when the reader has moved one
  constructor(changed) {
    for (const id of Object.keys(KNOBS)) byId(id).addEventListener("input", () => {
      this.exact = {};
      this.mark(null);
      this.write();
      changed();
    });
    this.exact = {};  // what a preset says, finer than a slider's positions
    byId("presets").replaceChildren(...Object.entries(PRESETS).map(([id, { name }]) => {
      const button = Object.assign(document.createElement("button"), { type: "button", textContent: name });
      button.dataset.preset = id;
      return button;
    }));
    byId("presets").addEventListener("click", ({ target }) => {
      if (!target.dataset.preset) return;
      const { preset } = target.dataset;
      this.take(preset, this.shape, valuesOf(preset, this.shape));
      changed();
    });
  }

  /// @param values  a preset's, or what was set by hand and has none
  take(preset, shape, values) {
    this.shape = shape;
    this.exact = { ...values };
    for (const [id, knob] of Object.entries(KNOBS)) byId(id).value = Math.round(byId(id).max * knob.at(this.exact[id]));
    this.mark(preset);
    this.write();
  }
  mark(preset) {
    this.preset = preset;
    for (const button of byId("presets").children) button.setAttribute("aria-pressed", button.dataset.preset === preset);
  }
  values() {
    return Object.fromEntries(Object.entries(KNOBS).map(([id, knob]) => [id, this.exact[id] ?? knob.of(byId(id).value / byId(id).max)]));
  }
  write() {
    for (const [id, value] of Object.entries(this.values())) document.querySelector(`output[for="${id}"]`).textContent = KNOBS[id].text(value);
  }
}

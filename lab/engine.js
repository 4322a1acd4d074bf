// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// lab.wasm with the few calls that it needs of its host, for the page and for node.

export const METHODS = ["explicit_euler", "symplectic_euler", "velocity_verlet", "implicit_euler", "bdf2", "graph_inertia"];

/// @param bytes  of lab.wasm
export async function loadLab(bytes) {
  let memory;
  let said = "";
  const host = {
    env: { emscripten_notify_memory_growth() {} },
    wasi_snapshot_preview1: {
      clock_time_get(_clock, _precision, at) {
        new DataView(memory.buffer).setBigUint64(at, BigInt(Math.round(performance.now() * 1e6)), true);
        return 0;
      },
      fd_write(_file, pieces, count, written) {  // what the library says before it aborts
        const view = new DataView(memory.buffer);
        let total = 0;
        for (let i = 0; i < count; ++i) {
          const [start, length] = [0, 4].map((o) => view.getUint32(pieces + 8 * i + o, true));
          said += new TextDecoder().decode(new Uint8Array(memory.buffer, start, length));
          total += length;
        }
        view.setUint32(written, total, true);
        return 0;
      },
      fd_close: () => 0,
      fd_seek: () => 0,
      proc_exit(code) {
        throw new Error(said.trim() || `lab.wasm ended with ${code}`);
      },
    },
  };
  const { instance } = await WebAssembly.instantiate(bytes, host);
  const wasm = instance.exports;
  memory = wasm.memory;
  wasm._initialize();

  // Memory that grows leaves older views empty, so each is made when it is asked for.
  const floats = (at, count) => new Float32Array(memory.buffer, at, count);
  const doubles = (at, count) => new Float64Array(memory.buffer, at, count);
  const text = (at) => {
    const bytes = new Uint8Array(memory.buffer, at);
    return new TextDecoder().decode(bytes.subarray(0, bytes.indexOf(0)));
  };
  return {
    start: wasm.lab_start,
    change: wasm.lab_change,
    step: wasm.lab_step,
    size: wasm.lab_size,
    springs: wasm.lab_springs,
    time: wasm.lab_time,
    growth: wasm.lab_growth,
    positions: () => doubles(wasm.lab_positions(), 3 * wasm.lab_size()),
    drawnPositions: () => floats(wasm.lab_drawn_positions(), 3 * wasm.lab_size()),
    ringing: () => floats(wasm.lab_ringing(), wasm.lab_size()),
    analyse(method, h) {
      const [anyPose, certified, refuted, alphaLower, alphaUpper] = doubles(wasm.lab_analyse(method, h), 5);
      return { anyPose, certified, refuted, alphaLower, alphaUpper, cause: text(wasm.lab_cause()) };
    },
    recommend(seconds) {
      const why = text(wasm.lab_recommend(seconds));
      const plans = [];
      for (let i = 0; i < wasm.lab_plan_count(); ++i) {
        const [method, gradients, substeps, h, cost] = doubles(wasm.lab_plan(i), 5);
        plans.push({ method, gradients: gradients > 0, substeps, h, cost });
      }
      return { why, plans };
    },
  };
}

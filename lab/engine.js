// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// lab.wasm with the few calls that it needs of its host, for the page, its worker and node.

export const METHODS = ["explicit_euler", "symplectic_euler", "velocity_verlet", "implicit_euler", "bdf2", "energy_stable_euler", "guarded"];
export const EXPLICIT = 0, SYMPLECTIC = 1, IMPLICIT = 3, ENERGY_STABLE = 5, GUARDED = 6;
export const RESOLVED = ["coarse", "fine", "unpredictable", "nothing_moves", "diverged", "cut_short"];
export const ANALYSED = [0, 1, 2, 3, 5];

/// @param memory  called for it   @param said  what the library says before it aborts
/// @param told  as loadLab takes it
function hostOf(memory, said, told) {
  return {
    env: { emscripten_notify_memory_growth() {}, lab_resolving: told },
    wasi_snapshot_preview1: {
      clock_time_get(_clock, _precision, at) {
        new DataView(memory().buffer).setBigUint64(at, BigInt(Math.round(performance.now() * 1e6)), true);
        return 0;
      },
      fd_write(_file, pieces, count, written) {
        const view = new DataView(memory().buffer);
        let total = 0;
        for (let i = 0; i < count; ++i) {
          const [start, length] = [0, 4].map((o) => view.getUint32(pieces + 8 * i + o, true));
          said.text += new TextDecoder().decode(new Uint8Array(memory().buffer, start, length));
          total += length;
        }
        view.setUint32(written, total, true);
        return 0;
      },
      fd_close: () => 0,
      fd_seek: () => 0,
      proc_exit(code) {
        throw new Error(said.text.trim() || `lab.wasm ended with ${code}`);
      },
    },
  };
}

/// @param source  the bytes of lab.wasm, or the WebAssembly.Module made of them
/// @param told  (run, sample): how far resolve() is
export async function loadLab(source, told = () => {}) {
  const module = source instanceof WebAssembly.Module ? source : await WebAssembly.compile(source);
  let memory;
  const instance = await WebAssembly.instantiate(module, hostOf(() => memory, { text: "" }, told));
  const wasm = instance.exports;
  memory = wasm.memory;
  wasm._initialize();

  // Memory that grows leaves older views empty, so each is made when it is asked for.
  const floats = (at, count) => new Float32Array(memory.buffer, at, count);
  const doubles = (at, count) => new Float64Array(memory.buffer, at, count);
  const integers = (at, count) => new Int32Array(memory.buffer, at, count);
  const text = (at) => {
    const bytes = new Uint8Array(memory.buffer, at);
    return new TextDecoder().decode(bytes.subarray(0, bytes.indexOf(0)));
  };
  const words = () => text(wasm.lab_words()).split("\n").filter((line) => line);
  const refused = () => Object.assign(new Error(words().join(" ")), { refused: true });

  return {
    // ---- the scene ----

    /// @param scene  {side} of a cloth, {figure: true}, or {text (bytes of an OBJ file), scale, up,
    ///              options (as lab_open_mesh takes them)}
    /// @returns sentences that are worth knowing. Throws what is wrong with the file
    open(scene) {
      this.read(scene);
      return this.join(scene);
    },
    /// The first half of open(), and the second.
    read(scene) {
      if (!scene.text) return;
      const at = wasm.lab_text(scene.text.length);
      new Uint8Array(memory.buffer, at, scene.text.length).set(scene.text);
      if (!wasm.lab_read()) throw refused();
    },
    join(scene) {
      if (scene.figure) wasm.lab_open_figure();
      else if (scene.side) wasm.lab_open_cloth(scene.side);
      else if (!wasm.lab_open_mesh(scene.scale, scene.up, scene.options ?? 0)) throw refused();
      return words();
    },
    size: wasm.lab_size,
    springs: wasm.lab_springs,
    shape() {
      const all = doubles(wasm.lab_shape(), 11);
      const [edge, area, length, pinned, loose] = all.slice(6);
      return { low: [...all.slice(0, 3)], high: [...all.slice(3, 6)], edge, area, length, pinned, loose };
    },
    triangles: () => integers(wasm.lab_triangles(), 3 * wasm.lab_triangle_count()).slice(),
    threads: () => integers(wasm.lab_threads(), 2 * wasm.lab_thread_count()).slice(),
    pin: wasm.lab_pin,
    pinTop: wasm.lab_pin_top,
    unpinAll: wasm.lab_unpin_all,
    /// The numbers of the pinned particles.
    pinned() {
      const flags = new Uint8Array(memory.buffer, wasm.lab_pinned(), wasm.lab_size());
      return Array.from(flags.keys()).filter((i) => flags[i]);
    },
    pinOnly(particles) {
      wasm.lab_unpin_all();
      for (const i of particles) wasm.lab_pin(i, 1);
    },
    knobs: ({ stiffness, mass, alpha, drag }) => wasm.lab_knobs(stiffness, mass, alpha, drag),

    // ---- motion ----

    reset: wasm.lab_reset,
    step: wasm.lab_step,
    time: wasm.lab_time,
    positions: () => doubles(wasm.lab_positions(), 3 * wasm.lab_size()),
    drawnPositions: () => floats(wasm.lab_drawn_positions(), 3 * wasm.lab_size()),
    ringing: () => floats(wasm.lab_ringing(), wasm.lab_size()),

    /// Whether a figure wears the cloth; what follows is of it alone.
    worn: () => wasm.lab_figure_size() > 0,
    skin: () => floats(wasm.lab_figure_points(), 3 * wasm.lab_figure_size()),
    skinTriangles: () => integers(wasm.lab_figure_triangles(), 3 * wasm.lab_figure_triangle_count()).slice(),
    place: () => [...floats(wasm.lab_figure_place(), 3)],
    depth: wasm.lab_depth,

    startPair(kick, speed, below, above) {
      doubles(wasm.lab_pair_kick(), kick.length).set(kick);
      wasm.lab_pair_start(speed, below, above);
    },
    stepPair: wasm.lab_pair_step,
    pairPositions: (which) => floats(wasm.lab_pair_positions(which), 3 * wasm.lab_size()),
    pairMoved: (which) => floats(wasm.lab_pair_moved(which), wasm.lab_size()),

    // ---- limits and advice ----

    /// The parts of the analysis: what each is about, and its call.
    parts: [["finding the limit at any pose", wasm.lab_analyse_any_pose], ["finding the limit at this pose", wasm.lab_analyse_pose], ["finding the vibration that sets it", wasm.lab_analyse_mode]],
    found() {
      const limits = {};
      for (const method of ANALYSED) {
        const [anyPose, certified, refuted] = doubles(wasm.lab_limits(method), 3);
        limits[method] = { anyPose, certified, refuted, cause: text(wasm.lab_cause(method)) };
      }
      limits[GUARDED] = { anyPose: Infinity, certified: Infinity, refuted: Infinity, cause: "" };  // a frame is no step
      const [k, d, kMax, compression, size, speed, steps] = doubles(wasm.lab_mode(), 7);
      const kick = doubles(wasm.lab_kick(), 3 * wasm.lab_size()).slice();
      const count = wasm.lab_blamed_count();
      const blamed = integers(wasm.lab_blamed(), 2 * count).slice();
      const shares = doubles(wasm.lab_shares(), count).slice();
      return { limits, mode: { k, d, kMax, compression, size, speed, steps }, kick, blamed, shares };
    },
    growth: (method, mode, h) => method === GUARDED ? 1 : wasm.lab_growth(method, mode.k, mode.d, h),
    window(h, drag, mode) {
      const [lower, upper] = doubles(wasm.lab_window(h, drag, mode.kMax, mode.compression), 2);
      return { lower, upper };
    },

    // ---- how few particles will do ----

    /// @param duration  s   @param goal  a share of the scene's size
    /// @returns {outcome (RESOLVED), words, levels, chosen (one of them, or nothing), cheaper, fineCost, searchCost}
    resolve(duration, goal) {
      wasm.lab_resolve(duration, goal);
      const [outcome, chosen, cheaper, fineCost, searchCost] = doubles(wasm.lab_resolution(), 5);
      const levels = Array.from({ length: wasm.lab_level_count() }, (_, i) => {
        const [particles, springs, h, cost, error] = doubles(wasm.lab_level(i), 5);
        return { particles, springs, h, cost, error };
      });
      return { outcome: RESOLVED[outcome], words: text(wasm.lab_resolution_words()), levels, chosen: levels[chosen], cheaper, fineCost, searchCost, goal, duration };
    },
    startBeside: (particles, duration, fine) => wasm.lab_beside_start(particles, duration, fine ? 1 : 0),
    stepBeside: wasm.lab_beside_step,
    besideSteps: wasm.lab_beside_steps,
    besideApart: wasm.lab_beside_apart,
    besidePositions: (which) => floats(wasm.lab_beside_positions(which), 3 * wasm.lab_size()),
    besideSeeds: () => integers(wasm.lab_beside_seeds(), wasm.lab_beside_seed_count()).slice(),

    advise: wasm.lab_advise,
    timePlan: wasm.lab_time_plan,
    plan(i) {
      const [method, gradients, substeps, h, cost] = doubles(wasm.lab_plan(i), 5);
      return { method, gradients: gradients > 0, substeps, h, cost };
    },
  };
}

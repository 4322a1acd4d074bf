// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

import { copyFileSync, mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

/// Jolt Physics from the folder of its npm package. The build with SIMD is the one with threads. As
/// npm has it, 1.1.0, its threads never start under node: `await import(…).workerData` misses a
/// pair of brackets.
export async function loadJolt(folder) {
  const name = "jolt-physics.multithread.wasm";
  const fixed = mkdtempSync(join(tmpdir(), "taut_jolt_"));
  const text = readFileSync(join(folder, "dist", `${name}.js`), "utf8");
  const broken = 'await import("node:worker_threads").workerData';
  writeFileSync(
    join(fixed, `${name}.js`),
    text.replace(broken, '(await import("node:worker_threads")).workerData'),
  );
  writeFileSync(join(fixed, "package.json"), '{"type": "module"}');
  copyFileSync(join(folder, "dist", `${name}.wasm`), join(fixed, `${name}.wasm`));
  const { default: start } = await import(pathToFileURL(join(fixed, `${name}.js`)));
  return start();
}

/// A world of Jolt's with one layer of still and of moving bodies, on this thread.
export function makeWorld(Jolt, layerCount) {
  const settings = new Jolt.JoltSettings();
  const layers = new Jolt.ObjectLayerPairFilterTable(layerCount);
  const broad = new Jolt.BroadPhaseLayerInterfaceTable(layerCount, 1);
  for (let layer = 0; layer < layerCount; ++layer) {
    broad.MapObjectToBroadPhaseLayer(layer, new Jolt.BroadPhaseLayer(0));
    if (layer > 0) layers.EnableCollision(0, layer);
  }
  settings.mObjectLayerPairFilter = layers;
  settings.mBroadPhaseLayerInterface = broad;
  settings.mObjectVsBroadPhaseLayerFilter = new Jolt.ObjectVsBroadPhaseLayerFilterTable(
    broad,
    1,
    layers,
    layerCount,
  );
  settings.mMaxWorkerThreads = 0;
  const jolt = new Jolt.JoltInterface(settings);
  jolt.GetPhysicsSystem().SetGravity(new Jolt.Vec3(0, 0, -9.81));
  return jolt;
}

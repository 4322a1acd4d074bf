// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// node cape.mjs JOLT_FOLDER STEPS ITERATIONS SCENE, as cape_table runs it: the cape by the soft body of
// Jolt Physics on kinematic capsules, in WebAssembly with SIMD on one thread. Reads what
// write_scene wrote (bench/cape/frames.hpp) and writes, for each frame, its milliseconds of
// processor time and the positions, in floats. Its springs push, too.

import { readFileSync, writeSync } from "node:fs";

import { loadJolt, makeWorld } from "./load.mjs";

const [folder, steps, iterations, path] = process.argv.slice(2);
if (!path || !(Number(steps) >= 1) || !(Number(iterations) >= 1)) {
  console.error("cape.mjs JOLT_FOLDER STEPS ITERATIONS SCENE");
  process.exit(2);
}
const [dt, thickness, friction, drag] = [1 / 60, 0.005, 0.3, 1];
const waits = setInterval(() => {}, 1000); // Jolt's threads do not keep node alive

const file = readFileSync(path);
const numbers = new Float32Array(file.buffer, file.byteOffset, file.length / 4);
let at = 0;
const take = (count) => numbers.subarray(at, (at += count));
const [particles, springs, capsules, pinned, frames] = take(5);

const Jolt = await loadJolt(folder);
const jolt = makeWorld(Jolt, 2);
const bodies = jolt.GetPhysicsSystem().GetBodyInterface();

const cloth = new Jolt.SoftBodySharedSettings();
const vertex = new Jolt.SoftBodySharedSettingsVertex();
for (let i = 0; i < particles; ++i) {
  const [x, y, z, inverseMass] = take(4);
  vertex.mPosition = new Jolt.Float3(x, y, z);
  vertex.mInvMass = inverseMass;
  cloth.mVertices.push_back(vertex);
}
for (let s = 0; s < springs; ++s) {
  const [a, b, , stiffness] = take(5);
  const edge = new Jolt.SoftBodySharedSettingsEdge(a, b, 1 / stiffness);
  cloth.mEdgeConstraints.push_back(edge);
  Jolt.destroy(edge);
}
cloth.CalculateEdgeLengths();
cloth.Optimize();
cloth.AddRef();

const shapes = Array.from({ length: capsules }, () => take(7));
const pins = take(pinned);
const place = () => {
  const [x, y, z, i, j, k, w] = take(7);
  return [new Jolt.RVec3(x, y, z), new Jolt.Quat(i, j, k, w)];
};
/// A capsule of Jolt's lies along its y: it is turned and shifted to where the bone has it.
function shapeOf([ax, ay, az, bx, by, bz, radius]) {
  const [dx, dy, dz] = [bx - ax, by - ay, bz - az];
  const length = Math.hypot(dx, dy, dz);
  const turn = Jolt.Quat.prototype.sFromTo(new Jolt.Vec3(0, 1, 0), new Jolt.Vec3(dx, dy, dz));
  const middle = new Jolt.Vec3((ax + bx) / 2, (ay + by) / 2, (az + bz) / 2);
  const capsule = new Jolt.CapsuleShapeSettings(length / 2, radius);
  return new Jolt.RotatedTranslatedShapeSettings(middle, turn, capsule).Create().Get();
}
const moved = shapes.map((shape) => {
  const [position, rotation] = place();
  const made = new Jolt.BodyCreationSettings(
    shapeOf(shape),
    position,
    rotation,
    Jolt.EMotionType_Kinematic,
    1,
  );
  made.mFriction = friction;
  made.mAllowSleeping = false;
  const body = bodies.CreateBody(made);
  bodies.AddBody(body.GetID(), Jolt.EActivation_Activate);
  return body;
});
take(3 * pinned); // where they are at the start

const made = new Jolt.SoftBodyCreationSettings(
  cloth,
  new Jolt.RVec3(0, 0, 0),
  Jolt.Quat.prototype.sIdentity(),
  0,
);
made.mNumIterations = Number(iterations);
made.mLinearDamping = drag;
made.mFriction = friction;
made.mVertexRadius = thickness;
made.mUpdatePosition = false;
made.mAllowSleeping = false;
const body = bodies.CreateSoftBody(made);
bodies.AddBody(body.GetID(), Jolt.EActivation_Activate);
const moving = Jolt.castObject(body.GetMotionProperties(), Jolt.SoftBodyMotionProperties);

const velocity = new Jolt.Vec3(0, 0, 0);
const out = new Float32Array(1 + 3 * particles);
function write() {
  const bytes = new Uint8Array(out.buffer);
  for (let done = 0; done < bytes.length; ) {
    try {
      done += writeSync(1, bytes, done);
    } catch (error) {
      if (error.code === "EPIPE") process.exit(0); // has seen enough
      if (error.code !== "EAGAIN") throw error;
    }
  }
}
for (let f = 0; f < frames; ++f) {
  for (const capsule of moved) {
    const [position, rotation] = place();
    bodies.MoveKinematic(capsule.GetID(), position, rotation, dt);
    Jolt.destroy(position);
    Jolt.destroy(rotation);
  }
  for (const pin of pins) {
    const to = take(3);
    const vertexOf = moving.GetVertex(pin);
    const x = vertexOf.mPosition;
    velocity.Set((to[0] - x.GetX()) / dt, (to[1] - x.GetY()) / dt, (to[2] - x.GetZ()) / dt);
    vertexOf.mVelocity = velocity;
  }
  const start = process.cpuUsage();
  jolt.Step(dt, Number(steps));
  const { user, system } = process.cpuUsage(start);
  out[0] = (user + system) / 1000;
  for (let i = 0; i < particles; ++i) {
    const x = moving.GetVertex(i).mPosition;
    out.set([x.GetX(), x.GetY(), x.GetZ()], 1 + 3 * i);
  }
  write();
}
clearInterval(waits);
process.exit(0);

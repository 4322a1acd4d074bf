// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// One mesh as three.js draws it: triangles, threads, pins, and the springs that set the limit.

import * as THREE from "three";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";

const RAMP = {  // as in the pages of stability_report
  light: [[0, 214, 217, 219], [0.2, 168, 201, 205], [0.42, 96, 158, 166], [0.6, 226, 184, 84], [0.78, 210, 92, 48], [1, 128, 26, 24]],
  dark: [[0, 122, 129, 137], [0.2, 102, 142, 150], [0.42, 86, 168, 170], [0.6, 232, 190, 94], [0.78, 226, 104, 62], [1, 176, 44, 44]],
};
const MOST_BLAMED = 3000;  // springs drawn
const FINE = 8000;         // particles from which on faces are shaded flat
export const dark = matchMedia("(prefers-color-scheme: dark)");

/// 256 colours as linear RGB, three numbers each.
function colourTable() {
  const ramp = dark.matches ? RAMP.dark : RAMP.light;
  const table = new Float32Array(3 * 256);
  for (let i = 0; i < 256; ++i) {
    const at = i / 255;
    const next = Math.max(1, ramp.findIndex(([start]) => start >= at));
    const [a, b] = [ramp[next - 1], ramp[next]];
    const t = (at - a[0]) / (b[0] - a[0]);
    const colour = new THREE.Color().setRGB(...[1, 2, 3].map((c) => (a[c] + t * (b[c] - a[c])) / 255), THREE.SRGBColorSpace);
    colour.toArray(table, 3 * i);
  }
  return table;
}

/// A dot for seeds; a point is a square without.
function disc() {
  const canvas = Object.assign(document.createElement("canvas"), { width: 32, height: 32 });
  const context = canvas.getContext("2d");
  context.fillStyle = "#fff";
  context.arc(16, 16, 15, 0, 2 * Math.PI);
  context.fill();
  return new THREE.CanvasTexture(canvas);
}

export class MeshModel {
  /// @param mesh  {positions (3 × n, at the start), triangles, threads, centre, size, edge}: it is
  ///              drawn with `centre` at the origin and `size` as one
  constructor(mesh) {
    this.mesh = mesh;
    const count = mesh.positions.length / 3;
    const vector = () => new THREE.BufferAttribute(new Float32Array(3 * count), 3).setUsage(THREE.DynamicDrawUsage);
    this.position = vector();
    this.colour = vector();
    this.smooth = count <= FINE;
    this.group = new THREE.Group();

    this.faces = new THREE.BufferGeometry();
    this.faces.setAttribute("position", this.position);
    this.faces.setAttribute("color", this.colour);
    this.faces.setIndex(new THREE.BufferAttribute(Uint32Array.from(mesh.triangles), 1));
    this.cloth = new THREE.MeshStandardMaterial({ vertexColors: true, side: THREE.DoubleSide, roughness: 0.85, flatShading: !this.smooth, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
    const weave = new THREE.BufferGeometry();
    weave.setAttribute("position", this.position);
    weave.setAttribute("color", this.colour);
    weave.setIndex(new THREE.BufferAttribute(Uint32Array.from(mesh.threads), 1));
    this.net = mesh.triangles.length === 0;  // without faces the threads carry the colours
    this.threads = new THREE.LineBasicMaterial({ transparent: true, vertexColors: this.net });
    this.add(new THREE.Mesh(this.faces, this.cloth), new THREE.LineSegments(weave, this.threads));

    this.pinMaterial = new THREE.MeshBasicMaterial();
    this.seedMaterial = new THREE.PointsMaterial({ size: 6, sizeAttenuation: false, alphaTest: 0.5 });
    this.pins = null;
    this.blamed = null;
    this.paint = () => this.takeColours();
    this.paint();
    dark.addEventListener("change", this.paint);
  }

  add(...objects) {
    for (const object of objects) {
      object.frustumCulled = false;  // its bounds change with every frame
      this.group.add(object);
    }
  }

  takeColours() {
    this.table = colourTable();
    this.threads.color.set(this.net ? 0xffffff : dark.matches ? 0x0e1114 : 0x1c1f24);
    this.threads.opacity = this.net ? 1 : (dark.matches ? 0.3 : 0.2) * (this.smooth ? 1 : 0.4);
    this.seedMaterial.color.set(dark.matches ? 0x86b4da : 0x2d5f8b);
    this.pinMaterial.color.set(dark.matches ? 0xe9e6e0 : 0x1c1f24);
  }

  dispose() {
    dark.removeEventListener("change", this.paint);
    this.group.traverse((object) => {
      object.geometry?.dispose();
      object.material?.map?.dispose();
      object.material?.dispose();
    });
  }

  /// A point of the scene as it is drawn; one that flies off stays on a sphere about the scene, and
  /// so does the camera outside of it.
  place(x, i, to, at) {
    const { centre, size } = this.mesh;
    const a = (x[3 * i] - centre[0]) / size, b = (x[3 * i + 1] - centre[1]) / size, c = (x[3 * i + 2] - centre[2]) / size;
    const reach = Math.hypot(a, b, c);
    const scale = reach <= 1.05 ? 1 : reach < Infinity ? 1.05 / reach : 0;  // NaN: 0
    to[at] = scale ? a * scale : 0;
    to[at + 1] = scale ? b * scale : 0;
    to[at + 2] = scale ? c * scale : 0;
  }

  setPins(pinned, positions) {
    if (this.pins) {
      this.group.remove(this.pins);
      this.pins.geometry.dispose();
      this.pins.dispose();
    }
    const radius = pinned.length <= 12 ? 0.012 : pinned.length <= 200 ? 0.006 : 0.003;
    this.pins = new THREE.InstancedMesh(new THREE.SphereGeometry(radius, 16, 12), this.pinMaterial, Math.max(1, pinned.length));
    this.pins.count = pinned.length;
    this.pinned = pinned;
    this.movePins(positions);
    this.add(this.pins);
  }
  movePins(positions) {
    const matrix = new THREE.Matrix4();
    const at = [0, 0, 0];
    this.pinned.forEach((particle, i) => {
      this.place(positions, particle, at, 0);
      this.pins.setMatrixAt(i, matrix.makeTranslation(...at));
    });
    this.pins.instanceMatrix.needsUpdate = true;
  }

  /// Once. @param seeds  particles that are drawn as dots
  setSeeds(seeds) {
    const dots = new THREE.BufferGeometry();
    dots.setAttribute("position", this.position);
    dots.setIndex(new THREE.BufferAttribute(Uint32Array.from(seeds), 1));
    this.seedMaterial.map = disc();
    this.seedMaterial.onBeforeCompile = (shader) => {  // nearer, or the slope that a dot lies on hides half of it
      shader.vertexShader = shader.vertexShader.replace("#include <logdepthbuf_vertex>", "gl_Position.z -= 2e-4 * gl_Position.w;\n#include <logdepthbuf_vertex>");
    };
    this.add(new THREE.Points(dots, this.seedMaterial));
  }

  /// @param blamed  pairs of particles, the foremost first   @param shares  of each
  setBlamed(blamed, shares) {
    if (this.blamed) {
      this.group.remove(this.blamed.lines);
      this.blamed.lines.geometry.dispose();
      this.blamed.lines.material.dispose();
      this.blamed = null;
    }
    let count = 0;
    while (count < Math.min(MOST_BLAMED, shares.length) && shares[count] > 0.05 * shares[0]) ++count;
    if (count === 0) return;
    const pairs = blamed.slice(0, 2 * count);
    const ends = new Float32Array(6 * count);
    const colours = new Float32Array(6 * count);
    for (let s = 0; s < count; ++s) {
      const level = 0.55 + 0.45 * Math.sqrt(shares[s] / shares[0]);  // yellow to dark red
      for (let c = 0; c < 6; ++c) colours[6 * s + c] = this.table[3 * Math.round(255 * Math.min(1, level)) + (c % 3)];
    }
    const geometry = new LineSegmentsGeometry().setPositions(ends).setColors(colours);
    const material = new LineMaterial({ linewidth: count > 300 ? 2 : 3, vertexColors: true, polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -2 });
    const lines = new LineSegments2(geometry, material);
    this.add(lines);
    this.blamed = { pairs, lines, ends: geometry.attributes.instanceStart.data };
  }
  showBlamed(shown) {
    if (this.blamed) this.blamed.lines.visible = shown;
  }

  /// @param positions  3 × n, m   @param swing  n, m   @param full  m, the ramp's far end
  draw(positions, swing, full) {
    const at = this.position.array;
    for (let i = 0; i < swing.length; ++i) this.place(positions, i, at, 3 * i);
    this.position.needsUpdate = true;
    const span = Math.log(1e4);  // the ramp's four decades
    const colours = this.colour.array;
    for (let i = 0; i < swing.length; ++i) {
      const level = swing[i] > 0 ? 1 + Math.log(swing[i] / full) / span : 0;
      const from = 3 * Math.round(255 * Math.min(1, Math.max(0, level)));
      for (let c = 0; c < 3; ++c) colours[3 * i + c] = this.table[from + c];
    }
    this.colour.needsUpdate = true;
    if (this.smooth && !this.net) this.faces.computeVertexNormals();
    if (this.blamed?.lines.visible) {
      const { pairs, ends } = this.blamed;
      for (let e = 0; e < pairs.length; ++e) for (let c = 0; c < 3; ++c) ends.array[3 * e + c] = at[3 * pairs[e] + c];
      ends.needsUpdate = true;
    }
  }
}

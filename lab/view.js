// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// The cloth on a canvas, by three.js.

import * as THREE from "three";
import { OrbitControls } from "./three/OrbitControls.js";

const RAMP = {  // as in the pages of stability_report
  light: [[0, 214, 217, 219], [0.2, 168, 201, 205], [0.42, 96, 158, 166], [0.6, 226, 184, 84], [0.78, 210, 92, 48], [1, 128, 26, 24]],
  dark: [[0, 122, 129, 137], [0.2, 102, 142, 150], [0.42, 86, 168, 170], [0.6, 232, 190, 94], [0.78, 226, 104, 62], [1, 176, 44, 44]],
};
const dark = matchMedia("(prefers-color-scheme: dark)");

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

export class ClothView {
  constructor(canvas, side) {
    this.canvas = canvas;
    this.side = side;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(32, 1, 0.05, 50);
    this.camera.up.set(0, 0, 1);
    this.camera.position.set(1.6, -2.55, 0.75);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.target.set(0.46, -0.1, -0.42);
    this.controls.enablePan = false;
    canvas.style.touchAction = "pan-y";  // a finger must be able to scroll past the cloth
    this.controls.minDistance = 1.2;
    this.controls.maxDistance = 6;

    const sun = new THREE.DirectionalLight(0xffffff, 2.1);
    sun.position.set(0.9, -1.6, 2.2);
    const fill = new THREE.DirectionalLight(0xffffff, 0.6);
    fill.position.set(-2, 1, 0.4);
    this.scene.add(sun, fill, new THREE.AmbientLight(0xffffff, 1.15));

    const count = side * side;
    this.position = new THREE.BufferAttribute(new Float32Array(3 * count), 3).setUsage(THREE.DynamicDrawUsage);
    this.colour = new THREE.BufferAttribute(new Float32Array(3 * count), 3).setUsage(THREE.DynamicDrawUsage);
    const cloth = new THREE.BufferGeometry();
    cloth.setAttribute("position", this.position);
    cloth.setAttribute("color", this.colour);
    const triangles = [];
    const threads = [];
    for (let r = 0; r < side; ++r) {
      for (let c = 0; c < side; ++c) {
        const i = r * side + c;
        if (c + 1 < side) threads.push(i, i + 1);
        if (r + 1 < side) threads.push(i, i + side);
        if (c + 1 < side && r + 1 < side) triangles.push(i, i + 1, i + side + 1, i, i + side + 1, i + side);
      }
    }
    cloth.setIndex(triangles);
    this.geometry = cloth;
    const weave = new THREE.BufferGeometry();
    weave.setAttribute("position", this.position);
    weave.setIndex(threads);
    const material = new THREE.MeshStandardMaterial({ vertexColors: true, side: THREE.DoubleSide, roughness: 0.85, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
    this.threads = new THREE.LineBasicMaterial({ transparent: true });
    this.pins = new THREE.MeshBasicMaterial();
    this.pinned = [0, side - 1].map(() => new THREE.Mesh(new THREE.SphereGeometry(0.014, 20, 14), this.pins));
    const meshes = [new THREE.Mesh(cloth, material), new THREE.LineSegments(weave, this.threads)];
    for (const mesh of meshes) mesh.frustumCulled = false;  // its bounds change with every frame
    this.scene.add(...meshes, ...this.pinned);
    const paint = () => {
      this.table = colourTable();
      this.threads.color.set(dark.matches ? 0x0e1114 : 0x1c1f24);
      this.threads.opacity = dark.matches ? 0.3 : 0.2;
      this.pins.color.set(dark.matches ? 0xe9e6e0 : 0x1c1f24);
    };
    paint();
    dark.addEventListener("change", paint);
  }

  /// @param positions  3 × n, m   @param ringing  n, m   @param full  m, the ramp's far end
  draw(positions, ringing, full) {
    this.position.array.set(positions);
    this.position.needsUpdate = true;
    const span = Math.log(1e4);  // the ramp's four decades
    for (let i = 0; i < ringing.length; ++i) {
      const level = ringing[i] > 0 ? 1 + Math.log(ringing[i] / full) / span : 0;
      const at = 3 * Math.round(255 * Math.min(1, Math.max(0, level)));
      for (let c = 0; c < 3; ++c) this.colour.array[3 * i + c] = this.table[at + c];
    }
    this.colour.needsUpdate = true;
    this.geometry.computeVertexNormals();
    this.pinned.forEach((pin, i) => pin.position.fromArray(positions, 3 * i * (this.side - 1)));
    this.fit();
    this.controls.update();
    this.renderer.render(this.scene, this.camera);
  }

  fit() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const ratio = Math.min(devicePixelRatio || 1, 2);
    const size = this.renderer.getSize(new THREE.Vector2());
    if (size.x === width && size.y === height && this.renderer.getPixelRatio() === ratio) return;
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.fov = width > height ? 32 : 38;  // a narrow picture would cut the cloth off
    this.camera.updateProjectionMatrix();
  }
}

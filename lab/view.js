// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// A canvas with one picture of a mesh, or two beside each other under one camera.

import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { FigureModel } from "./figure_model.js";
import { MeshModel } from "./mesh_model.js";

const START = [0.91, -1.96, 0.76];  // the camera, where the scene's size is one
const ABOVE = [0.75, -1.6, 1.45];   // … and of a scene that lies flat

/// Where the scene is drawn: about its middle, or where it will hang if it lies flat.
export function framing({ low, high }, pinned, positions) {
  const extent = high.map((h, d) => h - low[d]);
  const diagonal = Math.hypot(...extent);
  const middle = high.map((h, d) => (h + low[d]) / 2);
  const centre = [...middle];
  const size = diagonal / Math.SQRT2;
  const flat = extent[2] < 0.01 * diagonal;
  if (flat && pinned.length > 0) {
    for (const d of [0, 1]) centre[d] = pinned.reduce((sum, i) => sum + positions[3 * i + d], 0) / pinned.length;
    centre[0] -= 0.04 * size;
    centre[1] -= 0.1 * size;
    centre[2] -= 0.42 * size;
  }
  return { centre, middle, size, flat };
}

export class View {
  /// @param panes  1 or 2
  constructor(canvas, panes) {
    this.canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.camera = new THREE.PerspectiveCamera(32, 1, 0.02, 20);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enablePan = false;
    canvas.style.touchAction = "pan-y";  // a finger must be able to scroll past the cloth
    this.controls.minDistance = 1.2;  // outside of the sphere that whatever flies off is held in
    this.controls.maxDistance = 6;
    this.panes = Array.from({ length: panes }, () => {
      const scene = new THREE.Scene();
      const sun = new THREE.DirectionalLight(0xffffff, 2.1);
      sun.position.set(0.9, -1.6, 2.2);
      const fill = new THREE.DirectionalLight(0xffffff, 0.6);
      fill.position.set(-2, 1, 0.4);
      scene.add(sun, fill, new THREE.AmbientLight(0xffffff, 1.15));
      return { scene, model: null };
    });
    this.lookAgain();
  }

  /// The camera as at the start.
  lookAgain(fromAbove = false) {
    this.controls.target.set(0, 0, 0);
    this.camera.position.set(...(fromAbove ? ABOVE : START)).multiplyScalar(this.panes.length > 1 ? 0.85 : 1);
    this.controls.update();
  }

  /// @param mesh  as MeshModel takes it   @param skin  as FigureModel does, or nothing
  show(mesh, skin) {
    for (const pane of this.panes) {
      if (pane.model) {
        pane.scene.remove(pane.model.group);
        pane.model.dispose();
      }
      pane.model = new MeshModel(mesh);
      pane.scene.add(pane.model.group);
    }
    if (this.figure) {
      this.panes[0].scene.remove(this.figure.group);
      this.figure.dispose();
    }
    this.figure = skin ? new FigureModel(mesh, skin) : null;
    if (skin) this.panes[0].scene.add(this.figure.group);
  }
  /// The panes that are drawn: all, or the one that `only` names.
  get drawn() {
    return this.only === undefined ? this.panes : [this.panes[this.only]];
  }
  each(act) {
    for (const { model } of this.panes) act(model);
  }

  render() {
    this.fit();
    this.controls.update();
    const { width, height } = this.renderer.getSize(new THREE.Vector2());
    const each = width / this.drawn.length;
    this.renderer.setScissorTest(this.drawn.length > 1);
    this.drawn.forEach(({ scene }, i) => {
      this.renderer.setViewport(i * each, 0, each, height);
      this.renderer.setScissor(i * each, 0, each, height);
      this.renderer.render(scene, this.camera);
    });
  }

  fit() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const ratio = Math.min(devicePixelRatio || 1, 2);
    const size = this.renderer.getSize(new THREE.Vector2());
    const same = size.x === width && size.y === height && this.renderer.getPixelRatio() === ratio;
    if (same && this.fitted === this.drawn.length) return;
    this.fitted = this.drawn.length;
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    const aspect = width / this.drawn.length / height;
    this.camera.aspect = aspect;
    this.camera.fov = aspect > 1 ? 32 : Math.min(60, 38 / Math.max(0.6, aspect));  // a narrow picture would cut the cloth off
    this.camera.updateProjectionMatrix();
  }

  /// The particle drawn nearest to a point of the window, in front; −1 where none is near.
  /// @param x, y  px
  particleAt(x, y) {
    const near = 14;  // px
    const box = this.canvas.getBoundingClientRect();
    const { model } = this.panes[0];
    const at = new THREE.Vector3();
    let best = -1;
    let least = Infinity;
    for (let i = 0; i < model.position.count; ++i) {
      at.fromBufferAttribute(model.position, i);
      const depth = at.distanceTo(this.camera.position);
      at.project(this.camera);
      const off = Math.hypot(box.left + ((at.x + 1) / 2) * box.width - x, box.top + ((1 - at.y) / 2) * box.height - y);
      // Ten pixels count as much as a tenth of the scene in depth: the nearer layer wins.
      if (off < near && off + 100 * depth < least) {
        least = off + 100 * depth;
        best = i;
      }
    }
    return best;
  }

  /// How far from the middle something is drawn, where the scene's size is one.
  farthest() {
    const at = this.panes[0].model.position.array;
    let most = 0;
    for (let i = 0; i < at.length; i += 3) most = Math.max(most, Math.hypot(at[i], at[i + 1], at[i + 2]));
    return most;
  }

  /// Where a particle is drawn in the window, px.
  pointOf(i) {
    const box = this.canvas.getBoundingClientRect();
    const at = new THREE.Vector3().fromBufferAttribute(this.panes[0].model.position, i).project(this.camera);
    return [box.left + ((at.x + 1) / 2) * box.width, box.top + ((1 - at.y) / 2) * box.height];
  }

  /// Calls `act` where the pointer is pressed and let go without having been dragged.
  onClick(act) {
    let from = null;
    this.canvas.addEventListener("pointerdown", ({ clientX, clientY, isPrimary }) => (from = isPrimary ? [clientX, clientY] : null));
    this.canvas.addEventListener("pointerup", ({ clientX, clientY }) => {
      if (from && Math.hypot(clientX - from[0], clientY - from[1]) < 4) act(clientX, clientY);
      from = null;
    });
  }
}

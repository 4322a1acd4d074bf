// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// The figure that wears a cloth, and the ground that passes below it, as three.js draws them.

import * as THREE from "three";
import { dark } from "./mesh_model.js";

const TILE = 0.5;  // m, of the ground
const TILES = 12;

export class FigureModel {
  /// @param mesh  {centre, size}, as MeshModel takes it   @param skin  {points (3 × n, m), triangles}
  constructor({ centre, size }, { points, triangles }) {
    this.group = new THREE.Group();
    this.group.scale.setScalar(1 / size);
    this.group.position.set(...centre).multiplyScalar(-1 / size);
    this.skin = new THREE.BufferGeometry();
    this.skin.setAttribute("position", new THREE.BufferAttribute(points.slice(), 3).setUsage(THREE.DynamicDrawUsage));
    this.skin.setIndex(new THREE.BufferAttribute(Uint32Array.from(triangles), 1));
    const body = new THREE.Mesh(this.skin, new THREE.MeshStandardMaterial({ color: 0xc9a27e, roughness: 0.9, side: THREE.DoubleSide }));
    body.frustumCulled = false;  // its bounds change with every frame
    const colour = dark.matches ? 0x4a5058 : 0xc4c6c8;
    this.ground = new THREE.GridHelper(TILES * TILE, TILES, colour, colour);
    this.ground.rotation.x = Math.PI / 2;
    this.group.add(body, this.ground);
  }

  /// @param points  3 × n, m   @param place  of the figure, m
  draw(points, place) {
    this.skin.attributes.position.array.set(points);
    this.skin.attributes.position.needsUpdate = true;
    this.skin.computeVertexNormals();
    this.ground.position.set(-(place[0] % TILE), -(place[1] % TILE), 0);
  }

  dispose() {
    this.group.traverse((object) => {
      object.geometry?.dispose();
      object.material?.dispose();
    });
  }
}

// SPDX-License-Identifier: Apache-2.0
// One quad an instance: x is 0 at the start and 1 at the end of a line, y -1 and 1 at its sides.
import { BufferAttribute, InstancedBufferGeometry, Mesh, type ShaderMaterial } from "three";

const CORNER = new Float32Array([0, -1, 0, 1, -1, 0, 1, 1, 0, 0, 1, 0]);

export function quads(count: number): InstancedBufferGeometry {
  const g = new InstancedBufferGeometry();
  g.setAttribute("position", new BufferAttribute(CORNER, 3));
  g.setIndex([0, 1, 2, 0, 2, 3]);
  g.instanceCount = count;
  return g;
}
export function object(g: InstancedBufferGeometry, material: ShaderMaterial, order: number): Mesh {
  const m = new Mesh(g, material);
  m.frustumCulled = false;
  m.renderOrder = order;
  return m;
}

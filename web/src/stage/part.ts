// SPDX-License-Identifier: Apache-2.0
// The bodies that stand still: part, initial stock, obstacles, result. Deviation as a heat map.
import { BufferAttribute, BufferGeometry, Color, Group, type LineSegments, Mesh as Object, type ShaderMaterial } from "three";
import { heatRange } from "../colours";
import { Role, type Mesh } from "../scene";
import { Cap } from "./cap";
import type { Context } from "./context";
import { shape } from "./geometry";
import { lineMaterial, lines, NO_VALUE, surfaceMaterial } from "./materials";

interface Body { mesh: Mesh; surface: Object; material: ShaderMaterial; edges: LineSegments | null; edgeMaterial: ShaderMaterial; cap: Cap | null }

/** So much of a cell of the stock's clock its surface may lie within the part. */
const BURIED = 0.8;
const STOCK_OPACITY = 0.16, OBSTACLE_OPACITY = 0.5;

export class Part {
  readonly group = new Group();
  private bodies: Body[] = [];
  constructor(private ctx: Context) {
    for (const mesh of ctx.scene.meshes) if (mesh.index.length > 0) this.bodies.push(this.make(mesh));
    this.recolour();
    this.update();
  }
  private make(mesh: Mesh): Body {
    const shaped = shape(mesh.point, mesh.index), g = new BufferGeometry();
    g.setAttribute("position", new BufferAttribute(shaped.point, 3));
    g.setAttribute("normal", new BufferAttribute(shaped.normal, 3, true));
    g.setIndex(new BufferAttribute(shaped.index, 1));
    if (mesh.value) {
      const value = new Float32Array(shaped.from.length);
      for (let i = 0; i < value.length; ++i) { const v = mesh.value[shaped.from[i]!]!; value[i] = Number.isNaN(v) ? NO_VALUE : v; }
      g.setAttribute("value", new BufferAttribute(value, 1));
    }
    const opacity = mesh.role === Role.stock ? STOCK_OPACITY : mesh.role === Role.obstacle ? OBSTACLE_OPACITY : 1;
    const material = surfaceMaterial(this.ctx, { colour: new Color(), opacity, nearer: mesh.role === Role.result ? 0.5 : 0 });
    const surface = new Object(g, material);
    surface.frustumCulled = false;
    surface.renderOrder = opacity < 1 ? 10 : 0;
    const edgeMaterial = lineMaterial(this.ctx, new Color(), 0.55, 0.0002);
    const edges = shaped.edge.length > 0 && shaped.edge.length < 6 * 200_000 ? lines(shaped.edge, edgeMaterial) : null;
    if (edges) { edges.renderOrder = 1; surface.add(edges); }
    this.group.add(surface);
    const cap = shaped.closed && opacity === 1 ? new Cap(this.ctx, this.bodies.length, material.uniforms["colour"]!.value as Color, 1) : null;
    if (cap) this.group.add(...cap.passes(g), cap.face);
    return { mesh, surface, material, edges, edgeMaterial, cap };
  }
  recolour(): void {
    const { theme } = this.ctx, dark = theme.dark;
    for (const b of this.bodies) {
      const c = b.material.uniforms["colour"]!.value as Color;
      if (b.mesh.role === Role.design) c.copy(theme.part);
      else if (b.mesh.role === Role.obstacle) c.set(dark ? "#b98a4a" : "#d39a45");
      else c.set(dark ? "#8b8574" : "#cfc5ad");
      const e = b.edgeMaterial.uniforms["colour"]!.value as Color;
      e.copy(theme.ink).lerp(theme.part, dark ? 0.5 : 0.25);
    }
  }
  section(): void { for (const b of this.bodies) b.cap?.update(b.surface.visible); }
  update(): void {
    const s = this.ctx.store.state, { stock } = this.ctx.scene, clocked = stock !== null;
    for (const b of this.bodies) {
      const { role } = b.mesh;
      b.surface.visible = role === Role.design ? s.show.part : role === Role.obstacle ? s.show.obstacles : s.show.stock && !clocked;
      b.material.uniforms["heat"]!.value = s.heat && b.mesh.value ? 1 : 0;
      b.cap?.update(b.surface.visible);
      const push = role === Role.design && s.show.stock && stock ? BURIED * stock.step : 0;
      b.material.uniforms["push"]!.value = push;
      if (b.edges) b.edges.visible = push === 0;
      b.material.uniforms["range"]!.value = heatRange(b.mesh, s.heatRange);
    }
  }
  /** What a ray may hit. */
  solid(): Mesh[] { return this.bodies.filter(b => b.surface.visible && b.mesh.role !== Role.stock).map(b => b.mesh); }
  triangles(): number { return this.bodies.reduce((n, b) => n + b.mesh.index.length / 3, 0); }
}

// SPDX-License-Identifier: Apache-2.0
// The tool where it is: cutter, shank, holder as bodies of revolution; a nozzle with its beam for a laser.
import { BufferAttribute, BufferGeometry, Color, GLSL3, Group, Mesh, Points, Quaternion, ShaderMaterial, Vector3 } from "three";
import type { Piece, Tool } from "../scene";
import { type Context, toStage } from "./context";
import { lineMaterial, lines, surfaceMaterial } from "./materials";
import { waysDone } from "./path";
import { poseAt, type Pose } from "./pose";

const AROUND = 56, ALONG_CORNER = 12;
/** Height of a laser's nozzle as a share of the part's size. */
const NOZZLE = 0.1;

/** A profile of (radius, height), smooth between its points; normals across it. */
function revolve(parts: [number, number][][]): BufferGeometry {
  const point: number[] = [], normal: number[] = [], index: number[] = [];
  for (const part of parts) {
    const slope = (i: number, j: number): [number, number] => { const [r0, h0] = part[i]!, [r1, h1] = part[j]!, l = Math.hypot(r1 - r0, h1 - h0) || 1; return [(h1 - h0) / l, (r0 - r1) / l]; };
    for (let i = 0; i < part.length; ++i) {
      const [nr, nh] = slope(Math.max(0, i - 1), Math.min(part.length - 1, i + 1)), base = point.length / 3, [r, h] = part[i]!;
      for (let k = 0; k <= AROUND; ++k) {
        const a = 2 * Math.PI * k / AROUND, c = Math.cos(a), s = Math.sin(a);
        point.push(r * c, r * s, h); normal.push(nr * c, nr * s, nh);
        if (i > 0 && k < AROUND) { const q = base + k, p = q - AROUND - 1; index.push(p, p + 1, q + 1, p, q + 1, q); }
      }
    }
  }
  const g = new BufferGeometry();
  g.setAttribute("position", new BufferAttribute(new Float32Array(point), 3));
  g.setAttribute("normal", new BufferAttribute(new Float32Array(normal), 3));
  g.setIndex(index);
  return g;
}

function profile(p: Piece): [number, number][][] {
  const corner = Math.min(Math.max(0, p.corner), p.radius, Math.max(0, p.high - p.low)), arc: [number, number][] = [];
  for (let i = 0; i <= ALONG_CORNER && corner > 0; ++i) {
    const a = Math.PI / 2 * i / ALONG_CORNER;
    arc.push([p.radius - corner + corner * Math.sin(a), p.low + corner - corner * Math.cos(a)]);
  }
  const parts: [number, number][][] = [];
  if (p.radius > corner) parts.push([[0, p.low], [p.radius - corner, p.low]]);
  if (corner > 0) parts.push(arc);
  parts.push([[p.radius, p.low + corner], [p.radius, p.high]], [[p.radius, p.high], [0, p.high]]);
  return parts;
}

interface Shape { group: Group; holder: Mesh[] }

export class ToolView {
  readonly group = new Group();
  readonly pose: Pose = { tip: new Vector3(), axis: new Vector3(0, 0, 1), tool: 0 };
  private shapes: Shape[];
  private materials: ShaderMaterial[];
  private tip: Points;
  private tipMaterial: ShaderMaterial;
  private axisMaterial: ShaderMaterial;
  constructor(private ctx: Context, size: number) {
    const solid = (shine: number, opacity = 1): ShaderMaterial => {
      const m = surfaceMaterial(ctx, { colour: new Color(), back: false, free: true, shine, opacity });
      m.depthWrite = true;
      return m;
    };
    this.materials = [solid(0.4), solid(0.3), solid(0.2, 0.72), solid(0.1, 0.35)];
    this.axisMaterial = lineMaterial(ctx, new Color(), 0.8);
    this.shapes = ctx.scene.tools.map(t => this.make(t, size));
    for (const s of this.shapes) this.group.add(s.group);
    this.tipMaterial = new ShaderMaterial({ glslVersion: GLSL3, transparent: true, depthTest: false, depthWrite: false, uniforms: { pixel: ctx.shared.pixel, colour: { value: new Color() }, ground: { value: new Color() } },
      vertexShader: "uniform float pixel; void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(0.0, 0.0, 0.0, 1.0); gl_PointSize = 11.0 * pixel; }",
      fragmentShader: `uniform vec3 colour, ground; out vec4 result;
        void main() { float d = length(gl_PointCoord - 0.5) * 11.0; if (d > 5.2) discard; result = vec4(mix(colour, ground, smoothstep(3.4, 4.0, d)), smoothstep(5.2, 4.6, d)); }` });
    const g = new BufferGeometry();
    g.setAttribute("position", new BufferAttribute(new Float32Array(3), 3));
    this.tip = new Points(g, this.tipMaterial);
    this.tip.frustumCulled = false; this.tip.renderOrder = 40;
    this.group.add(this.tip);
    this.recolour();
    this.update();
  }
  private make(tool: Tool, size: number): Shape {
    const group = new Group(), holder: Mesh[] = [];
    const add = (g: BufferGeometry, material: number): Mesh => {
      const m = new Mesh(g, this.materials[material]);
      m.frustumCulled = false; m.renderOrder = material >= 2 ? 21 : 4;
      group.add(m);
      return m;
    };
    for (const p of tool.pieces) if (p.radius > 0 && p.high > p.low) { const m = add(revolve(profile(p)), p.kind); if (p.kind === 2) holder.push(m); }
    let top = Math.max(0, ...tool.pieces.map(p => p.high));
    if (tool.kerf > 0) {
      const h = NOZZLE * size, r = 0.22 * h, waist = tool.kerf / 2;
      top = h * 1.5;
      holder.push(add(revolve([[[0.35 * r, 0.3 * h], [r, h], [r, 1.5 * h]], [[r, 1.5 * h], [0, 1.5 * h]]]), 2));
      add(revolve([[[waist, 0], [0.3 * r + waist, 0.3 * h]]]), 3);
    }
    if (top > 0) {
      const axis = lines(new Float32Array([0, 0, 0, 0, 0, top * 1.1]), this.axisMaterial);
      axis.renderOrder = 22;
      group.add(axis);
    }
    return { group, holder };
  }
  recolour(): void {
    const { theme } = this.ctx, set = (i: number, light: string, dark: string): void => { (this.materials[i]!.uniforms["colour"]!.value as Color).set(theme.dark ? dark : light); };
    set(0, "#e0b13c", "#d9ac3f"); set(1, "#9aa6b4", "#8b98a8"); set(2, "#6f7f93", "#7f90a6"); set(3, "#ff6a2b", "#ff8a4d");
    (this.tipMaterial.uniforms["colour"]!.value as Color).set(theme.dark ? "#ffd24d" : "#d1360a");
    (this.tipMaterial.uniforms["ground"]!.value as Color).copy(theme.sheet);
    (this.axisMaterial.uniforms["colour"]!.value as Color).copy(theme.soft);
  }
  update(): void {
    const { path, center } = this.ctx.scene, { show, trial } = this.ctx.store.state;
    this.group.visible = show.tool && path.count > 0;
    poseAt(path, waysDone(this.ctx), this.pose);
    if (trial) { this.pose.tip.set(...toStage(trial.tip, center)); this.pose.axis.set(...trial.axis); }
    this.group.position.copy(this.pose.tip);
    this.group.quaternion.copy(turn.setFromUnitVectors(up, this.pose.axis));
    this.group.updateMatrixWorld(true);
    this.shapes.forEach((s, k) => { s.group.visible = k === this.pose.tool; for (const h of s.holder) h.visible = show.holder; });
  }
}
const up = new Vector3(0, 0, 1), turn = new Quaternion();

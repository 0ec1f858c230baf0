// SPDX-License-Identifier: Apache-2.0
// What is drawn about the part: findings, the measured distance, the axes of the table, the ground.
import { type Box3, BufferAttribute, BufferGeometry, Color, DoubleSide, GLSL3, Group, Mesh, PlaneGeometry, Points, ShaderMaterial, Vector3 } from "three";
import type { Context } from "./context";
import { toStage } from "./context";
import { lineMaterial, lines } from "./materials";
import { tableMatrix, rotaryAt } from "./pose";
import { waysDone } from "./path";

const MARK = 15; // CSS pixels

/** Points with a place: a triangle for a fault, a diamond for a warning, a disc for the rest; seen through the part, faintly. */
export class Findings {
  readonly group = new Group();
  readonly at: { index: number; place: Vector3 }[] = [];
  private ground = new Color();
  constructor(private ctx: Context) {
    const { findings, center } = ctx.scene;
    findings.forEach((f, index) => { if (f.at) this.at.push({ index, place: new Vector3(...toStage(f.at, center)) }); });
    const g = new BufferGeometry(), point = new Float32Array(3 * this.at.length), level = new Float32Array(this.at.length);
    this.at.forEach((m, i) => { m.place.toArray(point, 3 * i); level[i] = findings[m.index]!.level; });
    g.setAttribute("position", new BufferAttribute(point, 3));
    g.setAttribute("level", new BufferAttribute(level, 1));
    for (const hidden of [true, false]) {
      const p = new Points(g, this.material(hidden));
      p.frustumCulled = false; p.renderOrder = hidden ? 35 : 36;
      if (this.at.length > 0) this.group.add(p);
    }
    this.recolour();
  }
  private material(hidden: boolean): ShaderMaterial {
    return new ShaderMaterial({ glslVersion: GLSL3, transparent: true, depthTest: !hidden, depthWrite: false,
      uniforms: { pixel: this.ctx.shared.pixel, ground: { value: this.ground }, opacity: { value: hidden ? 0.35 : 1 } },
      vertexShader: `in float level; uniform float pixel; out float vLevel;
        void main() { vLevel = level; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); gl_Position.z -= 0.003 * gl_Position.w; gl_PointSize = ${MARK}.0 * pixel; }`,
      fragmentShader: `uniform vec3 ground; uniform float opacity; in float vLevel; out vec4 result;
        void main() {
          vec2 p = (gl_PointCoord - 0.5) * 2.0;
          float d = vLevel > 1.5 ? max(abs(p.x) * 0.87 - p.y * 0.5, p.y) - 0.42 : vLevel > 0.5 ? abs(p.x) + abs(p.y) - 0.85 : length(p) - 0.6;
          if (d > 0.14) discard;
          vec3 c = vLevel > 1.5 ? vec3(0.83, 0.10, 0.13) : vLevel > 0.5 ? vec3(0.93, 0.58, 0.02) : vec3(0.15, 0.47, 0.85);
          result = vec4(mix(c, ground, smoothstep(0.0, 0.05, d)), opacity);
        }` });
  }
  recolour(): void { this.ground.copy(this.ctx.theme.sheet); }
}

/** Two points and what is between them; the numbers are said by the overlay. */
export class Measured {
  readonly group = new Group();
  private material: ShaderMaterial;
  private points: Points;
  private line;
  constructor(private ctx: Context) {
    this.material = lineMaterial(ctx, new Color(), 0.95);
    this.material.depthTest = false; this.material.uniforms["clipOn"] = { value: 0 };
    this.line = lines(new Float32Array(6), this.material);
    this.line.renderOrder = 45;
    const g = new BufferGeometry();
    g.setAttribute("position", new BufferAttribute(new Float32Array(6), 3));
    this.points = new Points(g, new ShaderMaterial({ glslVersion: GLSL3, depthTest: false, transparent: true, uniforms: { pixel: ctx.shared.pixel, colour: this.material.uniforms["colour"]! },
      vertexShader: "uniform float pixel; void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); gl_PointSize = 9.0 * pixel; }",
      fragmentShader: "uniform vec3 colour; out vec4 result; void main() { float d = length(gl_PointCoord - 0.5); if (d > 0.5) discard; result = vec4(d > 0.28 ? colour : vec3(1.0), 1.0); }" }));
    this.points.frustumCulled = false; this.points.renderOrder = 46;
    this.group.add(this.line, this.points);
    this.recolour();
    this.update();
  }
  recolour(): void { (this.material.uniforms["colour"]!.value as Color).copy(this.ctx.theme.hit); }
  update(): void {
    const { measured } = this.ctx.store.state, places = measured.slice(0, 2).map(p => toStage(p, this.ctx.scene.center));
    this.line.visible = places.length === 2; this.points.visible = places.length > 0;
    for (const object of [this.line, this.points]) {
      const attribute = object.geometry.getAttribute("position") as BufferAttribute;
      places.forEach((p, i) => attribute.setXYZ(i, ...p));
      attribute.needsUpdate = true;
    }
    this.points.geometry.setDrawRange(0, places.length);
  }
}

/** Table axes where the machine has them; each is carried by those nearer to the machine. */
export class TableAxes {
  readonly group = new Group();
  readonly labels: { text: string; place: Vector3 }[] = [];
  private axes: { index: number; object: ReturnType<typeof lines>; end: Vector3 }[] = [];
  private material: ShaderMaterial;
  constructor(private ctx: Context, size: number) {
    const { machine, center } = ctx.scene;
    this.material = lineMaterial(ctx, new Color(), 0.8);
    this.material.uniforms["clipOn"] = { value: 0 };
    machine?.axes.forEach((axis, index) => {
      if (!axis.table) return;
      const at = new Vector3(...toStage(axis.point, center)), d = new Vector3(...axis.direction).normalize(), points: number[] = [], DASHES = 41;
      for (let i = 0; i < DASHES; i += 2) points.push(...at.clone().addScaledVector(d, size * (i / DASHES * 1.3 - 0.65)).toArray(), ...at.clone().addScaledVector(d, size * ((i + 1.4) / DASHES * 1.3 - 0.65)).toArray());
      const object = lines(new Float32Array(points), this.material);
      object.matrixAutoUpdate = false;
      this.axes.push({ index, object, end: at.clone().addScaledVector(d, size * 0.68) });
      this.group.add(object);
    });
    this.recolour();
    this.update();
  }
  recolour(): void { (this.material.uniforms["colour"]!.value as Color).set(this.ctx.theme.dark ? "#e0a63a" : "#9a6a00"); }
  update(): void {
    const { scene, store } = this.ctx;
    this.group.visible = store.state.asMachine;
    this.labels.length = 0;
    if (!this.group.visible) return;
    const rotary = rotaryAt(scene.path, waysDone(this.ctx));
    for (const a of this.axes) {
      a.object.matrix.copy(tableMatrix(scene.machine, rotary, scene.center, a.index + 1));
      a.object.updateMatrixWorld(true);
      this.labels.push({ text: `${scene.machine!.axes[a.index]!.letter} ${(rotary[a.index] ?? 0).toFixed(1)}°`, place: a.end.clone().applyMatrix4(a.object.matrix) });
    }
  }
}

/** Lines on the ground, finer where one is nearer. */
export class Ground {
  readonly mesh: Mesh;
  private material: ShaderMaterial;
  constructor(private ctx: Context, box: Box3, private flat: boolean) {
    const size = box.getSize(new Vector3()), c = box.getCenter(new Vector3()), reach = 4 * Math.max(size.x, size.y, size.z, 1);
    const { center } = ctx.scene;
    this.material = new ShaderMaterial({ glslVersion: GLSL3, transparent: true, depthWrite: false, side: DoubleSide,
      uniforms: { colour: { value: new Color() }, cell: { value: 10 }, base: { value: new Vector3(...center) }, middle: { value: c }, reach: { value: reach / 2 }, strength: { value: 1 } },
      vertexShader: "out vec2 vAt; void main() { vec4 p = modelMatrix * vec4(position, 1.0); vAt = p.xy; gl_Position = projectionMatrix * viewMatrix * p; }",
      fragmentShader: `uniform vec3 colour, base, middle; uniform float cell, reach, strength; in vec2 vAt; out vec4 result;
        float grid(float c) { vec2 p = (vAt + base.xy) / c, w = fwidth(p), d = abs(fract(p - 0.5) - 0.5) / max(w, 1e-6); return (1.0 - min(min(d.x, d.y), 1.0)) * (1.0 - smoothstep(0.03, 0.12, max(w.x, w.y))); }
        void main() {
          float far = 1.0 - smoothstep(0.35, 1.0, length(vAt - middle.xy) / reach);
          result = vec4(colour, strength * far * max(0.35 * grid(cell), 0.8 * grid(cell * 10.0)));
        }` });
    this.mesh = new Mesh(new PlaneGeometry(reach, reach), this.material);
    this.mesh.position.set(c.x, c.y, box.min.z - (flat ? 0 : 0.002 * reach / 4));
    this.mesh.frustumCulled = false; this.mesh.renderOrder = -10;
    this.mesh.updateMatrixWorld(true);
    this.recolour();
  }
  recolour(): void { (this.material.uniforms["colour"]!.value as Color).copy(this.ctx.theme.soft).lerp(this.ctx.theme.sheet, 0.35); }
  /** mm a CSS pixel. */
  zoomed(pixel: number): void {
    this.material.uniforms["cell"]!.value = 10 ** Math.ceil(Math.log10(8 * pixel));
    this.material.uniforms["strength"]!.value = this.flat ? 0.5 : 0.7;
  }
}

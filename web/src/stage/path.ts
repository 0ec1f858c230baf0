// SPDX-License-Identifier: Apache-2.0
// The path: one chain of ways whose colours change without the rest; what lies ahead of the time is told apart in the shader,
// so that playing changes one number only. Under a beam the band that it takes away, true to scale.
import { Color, GLSL3, Group, type Line, type Matrix4, type Mesh, NotEqualStencilFunc, ReplaceStencilOp, ShaderMaterial, type Vector3 } from "three";
import { colouring, type Rgb } from "../colours";
import { Kind, type Path } from "../scene";
import type { Context } from "./context";
import { CLIP_FRAGMENT, CLIP_VERTEX } from "./materials";
import { Chain, FETCH, Look, ribbonMaterial, thread } from "./ribbon";

// The band that a beam takes away, true to scale, flat in z. Where bands overlap only the first is painted (stencil).
const BAND_VERTEX = `
${FETCH}
uniform float now, kerf, ahead;
out vec2 vPlace; out vec2 vFrom; out vec2 vTo; out float vLater; ${CLIP_VERTEX}
void main() {
  fetch();
  vec2 d = end.xy - start.xy; float len = length(d);
  d = len > 1e-9 ? d / len : vec2(1.0, 0.0);
  vLater = step(now, float(way) + 0.5);
  vec2 p = (corner.x < 0.5 ? start.xy - d * kerf * 0.5 : end.xy + d * kerf * 0.5) + vec2(-d.y, d.x) * corner.y * kerf * 0.5;
  vPlace = p; vFrom = start.xy; vTo = end.xy; vPart = vec3(p, start.z);
  gl_Position = projectionMatrix * modelViewMatrix * vec4(p, start.z, 1.0);
  if (look < 0.5 || look > 127.5 || (ahead < 0.5 && vLater > 0.5)) gl_Position = NOWHERE;
}`;
const BAND_FRAGMENT = `
uniform float kerf; uniform vec3 colour; ${CLIP_FRAGMENT}
in vec2 vPlace; in vec2 vFrom; in vec2 vTo; in float vLater; out vec4 result;
void main() {
  cut();
  vec2 d = vTo - vFrom; float t = clamp(dot(vPlace - vFrom, d) / max(dot(d, d), 1e-12), 0.0, 1.0);
  if (distance(vPlace, vFrom + t * d) > kerf * 0.5) discard;
  result = vec4(colour, mix(0.42, 0.24, vLater));
}`;

const WIDTH = 1.6, PICKED_WIDTH = 5, HOVER_WIDTH = 4; // CSS pixels
const FADED = 0.3;
/** A share of the depth: lines on a surface are seen. */
const NEARER = 0.0006;
const STEPS = 1024; // of a scale's colours
const COVER = 0.45; // share of the space between lines that they may fill
const LEAST_WIDTH = 0.9, LEAST_OPACITY = 0.4, OVER_HEAT = 0.6;

export class PathLines {
  readonly group = new Group();
  private chain: Chain;
  private ribbon: Mesh;
  private thread: Line;
  private material: ShaderMaterial;
  private bands: { mesh: Mesh; kerf: number; colour: Color } | null = null;
  private hover: Mark;
  private picked: Mark;
  private moving = { value: 0 };
  private ahead = { value: 1 };
  private spacing: number; // mm, about
  private only: number | null = null;

  constructor(private ctx: Context, size: Vector3) {
    const sides = [size.x, size.y, size.z].sort((a, b) => b - a);
    this.spacing = sides[0]! * Math.max(sides[1]!, 0.1 * sides[0]!) / Math.max(cutLength(ctx.scene.path), 1e-6);
    this.chain = new Chain(ctx.scene.path.point);
    this.material = ribbonMaterial(ctx, this.chain, { width: WIDTH, nearer: NEARER, now: this.moving, ahead: this.ahead, faded: FADED, lit: true });
    this.ribbon = this.chain.object([this.material], 3);
    this.thread = thread(ctx, this.chain, this.material, 3);
    this.group.add(this.ribbon, this.thread);
    const kerf = Math.max(0, ...ctx.scene.tools.map(t => t.kerf));
    if (kerf > 0) this.addBands(kerf);
    this.hover = new Mark(ctx, HOVER_WIDTH, 0.6);
    this.picked = new Mark(ctx, PICKED_WIDTH, 0.95);
    this.group.add(this.hover.object, this.picked.object);
    this.recolour();
    this.update();
    this.highlight();
  }
  private addBands(kerf: number): void {
    const { shared } = this.ctx, colour = new Color();
    const material = new ShaderMaterial({ glslVersion: GLSL3, vertexShader: BAND_VERTEX, fragmentShader: BAND_FRAGMENT, transparent: true, depthWrite: false,
      stencilWrite: true, stencilRef: 1, stencilFunc: NotEqualStencilFunc, stencilZPass: ReplaceStencilOp,
      uniforms: { points: { value: this.chain.points }, tints: { value: this.chain.tints }, clip: shared.clip, clipOn: shared.clipOn, now: this.moving, kerf: { value: kerf }, ahead: this.ahead, colour: { value: colour } } });
    const mesh = this.chain.object([material], 2);
    this.bands = { mesh, kerf, colour };
    this.group.add(mesh);
  }

  /** Colours of all ways. */
  recolour(): void {
    const { scene: { path }, store: { state }, theme } = this.ctx, by = colouring(this.ctx.scene, state), { chain } = this;
    // Of names one colour each, of a value STEPS and one for none.
    const known: (Rgb | undefined)[] = [], whole = by.names !== null || by.value === null, step = (by.hi - by.lo || 1) / STEPS;
    for (let i = 0; i < path.count; ++i) {
      const v = by.value ? by.value[i]! : 0, kind = path.kind[i]!;
      // A value says nothing of a rapid.
      const none = !whole && (!Number.isFinite(v) || kind === Kind.rapid);
      const slot = none ? STEPS : whole ? v : Math.min(STEPS - 1, Math.max(0, Math.floor((v - by.lo) / step)));
      const c = known[slot] ??= by.colour(none ? NaN : whole ? v : by.lo + (slot + 0.5) * step, theme.dark);
      chain.paint(i, c[0], c[1], c[2], kind | (state.only !== null && path.group[i] !== state.only ? Look.hidden : 0));
    }
    chain.painted();
    if (state.only !== this.only) { this.only = state.only; chain.forget(); }
    this.bands?.colour.set(theme.dark ? "#ff9d5c" : "#e8590c");
    this.hover.colour(theme.accent); this.picked.colour(theme.hit);
  }
  update(): void {
    const { show, time, playing } = this.ctx.store.state;
    this.group.visible = show.path;
    this.material.uniforms["rapids"]!.value = show.rapids ? 1 : 0;
    this.ahead.value = show.ahead ? 1 : 0;
    // Before anything happened all of it is seen.
    this.moving.value = time === 0 && !playing && show.ahead ? 1e9 : waysDone(this.ctx);
  }
  /** Of the camera: `pixel` mm, `matrix` to clip space, `most` ways that may be ribbons. Lines that lie close get thin and
   *  let the part through; the bands are painted when one is seen. */
  zoomed(pixel: number, matrix: Matrix4, most: number): void {
    if (this.chain.point.length > 3) {
      const few = this.chain.cull(matrix) <= most;
      this.ribbon.visible = few; this.thread.visible = !few;
      if (!few) this.thread.geometry.setIndex(this.chain.thinned(pixel / this.ctx.shared.pixel.value));
    }
    if (this.bands) this.bands.mesh.visible = this.bands.kerf > 1.2 * pixel;
    const { heat, show } = this.ctx.store.state, fits = COVER * this.spacing / pixel, part = show.part && this.ctx.scene.meshes.length > 0;
    this.material.uniforms["width"]!.value = Math.min(WIDTH, Math.max(LEAST_WIDTH, fits));
    this.material.uniforms["opacity"]!.value = (part ? Math.min(1, Math.max(LEAST_OPACITY, fits / LEAST_WIDTH)) : 1) * (heat && part ? OVER_HEAT : 1);
  }
  highlight(): void {
    const { hovered, picked } = this.ctx.store.state, { point, count } = this.ctx.scene.path;
    const set = (mark: Mark, node: number | null): void => mark.set(node !== null && node > 0 && node < count ? point.subarray(3 * node - 3, 3 * node + 3) : null);
    set(this.hover, hovered === picked ? null : hovered);
    set(this.picked, picked);
  }
}

function cutLength(path: Path): number {
  const p = path.point;
  let l = 0;
  for (let i = 1, k = 3; i < path.count; ++i, k += 3) if (path.kind[i] === Kind.feed) l += Math.sqrt((p[k]! - p[k - 3]!) ** 2 + (p[k + 1]! - p[k - 2]!) ** 2 + (p[k + 2]! - p[k - 1]!) ** 2);
  return l;
}

/** How many ways are behind, with the share of the one being made. */
export function waysDone(ctx: Context): number {
  const { path } = ctx.scene, { time, node } = ctx.store.state;
  if (path.count < 2) return 0;
  const i = Math.min(node, path.count - 1), t0 = path.time[i]!, t1 = i + 1 < path.count ? path.time[i + 1]! : t0;
  return i + (t1 > t0 ? Math.min(1, Math.max(0, (time - t0) / (t1 - t0))) : 0);
}

/** One way, drawn thick over everything. */
class Mark {
  readonly object: Mesh;
  private chain = new Chain(new Float32Array(6));
  constructor(ctx: Context, width: number, opacity: number) {
    this.object = this.chain.object(ribbonMaterial(ctx, this.chain, { width, nearer: 0, opacity, onTop: true }), 30);
  }
  colour(c: Color): void { this.chain.paint(1, c.r, c.g, c.b, Look.plain); this.chain.painted(); }
  set(ends: Float32Array | null): void {
    this.object.visible = ends !== null;
    if (ends) this.chain.set(ends);
  }
}

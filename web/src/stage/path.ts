// SPDX-License-Identifier: Apache-2.0
// The path as lines of even width: one buffer of points, read twice (start and end of each way), one of colours.
// What lies ahead of the time is told apart in the shader, so that playing changes one number only.
import { Color, GLSL3, Group, InstancedBufferAttribute, type InstancedBufferGeometry, InstancedInterleavedBuffer, InterleavedBufferAttribute, type Mesh, ShaderMaterial } from "three";
import { colouring } from "../colours";
import { Kind } from "../scene";
import type { Context } from "./context";
import { CLIP_FRAGMENT, CLIP_VERTEX } from "./materials";
import { object, quads } from "./quads";

const VERTEX = `
in vec3 start; in vec3 end; in vec4 tint;
uniform vec2 screen; uniform float pixel, width, now, first, ahead, rapids, nearer;
out vec4 vTint; out float vAt, vAlong; ${CLIP_VERTEX}
void main() {
  float way = first + float(gl_InstanceID), kind = floor(tint.a * 255.0 + 0.5);
  float hidden = (kind < 0.5 ? 1.0 - rapids : 0.0) + (kind > 127.5 ? 1.0 : 0.0) + (ahead < 0.5 && way >= now ? 1.0 : 0.0);
  vec4 a = projectionMatrix * modelViewMatrix * vec4(start, 1.0), b = projectionMatrix * modelViewMatrix * vec4(end, 1.0);
  if (hidden > 0.5) { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); vTint = vec4(0.0); vAt = 0.0; vAlong = 0.0; vPart = start; return; }
  // Ends behind the eye come to the near plane.
  float near = 1e-4, fa = 0.0, fb = 1.0;
  if (a.w < near && b.w > near) fa = (near - a.w) / (b.w - a.w);
  if (b.w < near && a.w > near) fb = (near - a.w) / (b.w - a.w);
  vec4 p = mix(a, b, fa), q = mix(a, b, fb);
  vec2 sp = p.xy / p.w * screen * 0.5, sq = q.xy / q.w * screen * 0.5, d = sq - sp;
  float len = length(d), w = max(1.0, (kind < 0.5 ? 0.7 : 1.0) * width * pixel);
  d = len > 1e-6 ? d / len : vec2(1.0, 0.0);
  vec4 c = position.x < 0.5 ? p : q;
  // Half a width longer at both ends, so that corners close.
  vec2 off = vec2(-d.y, d.x) * position.y * w * 0.5 + d * (position.x - 0.5) * w * 0.7;
  gl_Position = vec4(c.xy + off * 2.0 / screen * c.w, c.z - nearer * c.w, c.w);
  float t = position.x < 0.5 ? fa : fb;
  vTint = vec4(tint.rgb, kind); vAt = way + t; vAlong = position.x * len / pixel; vPart = mix(start, end, t);
}`;
const FRAGMENT = `
uniform float now, ahead, faded, opacity; ${CLIP_FRAGMENT}
in vec4 vTint; in float vAt, vAlong; out vec4 result;
void main() {
  cut();
  if (vTint.a < 0.5 && mod(vAlong, 9.0) > 5.0) discard;
  float later = step(now, vAt);
  if (later * (1.0 - ahead) > 0.5) discard;
  result = vec4(vTint.rgb, opacity * mix(1.0, vTint.a < 0.5 ? 0.25 : faded, later) * (vTint.a < 0.5 ? 0.8 : 1.0));
}`;

// The band that a beam takes away, true to scale, flat in z. All at one depth: where bands overlap only the first is painted.
const BAND_VERTEX = `
in vec3 start; in vec3 end; in vec4 tint;
uniform float now, first, kerf, ahead;
out vec2 vPlace; out vec2 vFrom; out vec2 vTo; out float vLater; ${CLIP_VERTEX}
void main() {
  float way = first + float(gl_InstanceID), kind = floor(tint.a * 255.0 + 0.5);
  vec2 d = end.xy - start.xy; float len = length(d);
  d = len > 1e-9 ? d / len : vec2(1.0, 0.0);
  vLater = step(now, way + 0.5);
  vec2 p = (position.x < 0.5 ? start.xy - d * kerf * 0.5 : end.xy + d * kerf * 0.5) + vec2(-d.y, d.x) * position.y * kerf * 0.5;
  vPlace = p; vFrom = start.xy; vTo = end.xy; vPart = vec3(p, start.z);
  gl_Position = projectionMatrix * modelViewMatrix * vec4(p, start.z, 1.0);
  if (kind < 0.5 || kind > 127.5 || (ahead < 0.5 && vLater > 0.5)) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
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

export class PathLines {
  readonly group = new Group();
  private tint: Uint8Array;
  private tintAttribute: InstancedBufferAttribute;
  private material: ShaderMaterial;
  private main: Mesh;
  private bands: { mesh: Mesh; material: ShaderMaterial } | null = null;
  private marks: { hover: Mark; picked: Mark };
  private moving = { value: 0 };
  private ahead = { value: 1 };

  constructor(private ctx: Context) {
    const { path } = ctx.scene, ways = Math.max(0, path.count - 1);
    this.tint = new Uint8Array(4 * ways);
    const buffer = new InstancedInterleavedBuffer(path.point, 3);
    this.tintAttribute = new InstancedBufferAttribute(this.tint, 4, true);
    const g = quads(ways);
    g.setAttribute("start", new InterleavedBufferAttribute(buffer, 3, 0));
    g.setAttribute("end", new InterleavedBufferAttribute(buffer, 3, 3));
    g.setAttribute("tint", this.tintAttribute);
    this.material = this.lineMaterial(WIDTH, NEARER, 1);
    this.main = object(g, this.material, 3);
    this.main.visible = ways > 0;
    this.group.add(this.main);
    const kerf = Math.max(0, ...ctx.scene.tools.map(t => t.kerf));
    if (kerf > 0 && ways > 0) this.addBands(g, kerf);
    this.marks = { hover: new Mark(this.lineMaterial(HOVER_WIDTH, 2 * NEARER, 0.6)), picked: new Mark(this.lineMaterial(PICKED_WIDTH, 2 * NEARER, 0.95)) };
    this.group.add(this.marks.hover.mesh, this.marks.picked.mesh);
    this.recolour();
    this.update();
    this.highlight();
  }
  private lineMaterial(width: number, nearer: number, opacity: number): ShaderMaterial {
    const { shared } = this.ctx, own = opacity === 1;
    return new ShaderMaterial({
      glslVersion: GLSL3, vertexShader: VERTEX, fragmentShader: FRAGMENT, transparent: true, depthTest: own, depthWrite: own,
      uniforms: { clip: shared.clip, clipOn: shared.clipOn, screen: shared.screen, pixel: shared.pixel, width: { value: width }, now: own ? this.moving : { value: 1e9 }, first: { value: 0 },
        ahead: own ? this.ahead : { value: 1 }, rapids: { value: 1 }, nearer: { value: nearer }, faded: { value: FADED }, opacity: { value: opacity } } });
  }
  private addBands(g: InstancedBufferGeometry, kerf: number): void {
    const { shared } = this.ctx;
    const material = new ShaderMaterial({ glslVersion: GLSL3, vertexShader: BAND_VERTEX, fragmentShader: BAND_FRAGMENT, transparent: true, depthWrite: true,
      uniforms: { clip: shared.clip, clipOn: shared.clipOn, now: this.moving, first: { value: 0 }, kerf: { value: kerf }, ahead: this.ahead, colour: { value: new Color() } } });
    const mesh = object(g, material, 2);
    this.bands = { mesh, material };
    this.group.add(mesh);
  }

  /** Colours of all ways; the high bit of the kind hides one. */
  recolour(): void {
    const { scene: { path }, store: { state }, theme } = this.ctx, by = colouring(this.ctx.scene, state), ways = path.count - 1;
    const STEPS = 1024, whole = by.names !== null || by.value === null, table = new Uint8Array(4 * (whole ? 65536 : STEPS + 1)), known = new Uint8Array(table.length / 4);
    const put = (slot: number, value: number): void => {
      if (!known[slot]) { known[slot] = 1; const c = by.colour(value, theme.dark); for (let k = 0; k < 3; ++k) table[4 * slot + k] = Math.round(255 * c[k]!); }
    };
    for (let i = 0; i < ways; ++i) {
      const v = by.value ? by.value[i + 1]! : 0;
      let slot: number;
      if (whole) { slot = v & 0xffff; put(slot, v); }
      else if (Number.isNaN(v)) { slot = STEPS; put(slot, v); }
      else {
        slot = Math.min(STEPS - 1, Math.max(0, Math.floor((v - by.lo) / (by.hi - by.lo || 1) * STEPS)));
        put(slot, by.lo + (slot + 0.5) / STEPS * (by.hi - by.lo));
      }
      const kind = path.kind[i + 1]!;
      // A value says nothing of a rapid.
      const rapid = kind === Kind.rapid && !whole;
      if (rapid) { slot = STEPS; put(slot, NaN); }
      this.tint[4 * i] = table[4 * slot]!; this.tint[4 * i + 1] = table[4 * slot + 1]!; this.tint[4 * i + 2] = table[4 * slot + 2]!;
      this.tint[4 * i + 3] = kind | (state.only !== null && path.group[i + 1] !== state.only ? 128 : 0);
    }
    this.tintAttribute.needsUpdate = true;
    (this.bands?.material.uniforms["colour"]!.value as Color | undefined)?.set(theme.dark ? "#ff9d5c" : "#e8590c");
    this.marks.hover.colour(theme.accent); this.marks.picked.colour(theme.hit);
  }
  /** `now` counts ways: 2.5 is in the middle of the third. */
  update(): void {
    const { show, time, playing } = this.ctx.store.state;
    this.group.visible = show.path;
    this.material.uniforms["rapids"]!.value = show.rapids ? 1 : 0;
    this.ahead.value = show.ahead ? 1 : 0;
    // Before anything happened all of it is seen.
    this.moving.value = time === 0 && !playing && show.ahead ? 1e9 : waysDone(this.ctx);
  }
  /** The bands are worth their paint when one is seen. */
  zoomed(pixel: number): void {
    if (this.bands) this.bands.mesh.visible = (this.bands.material.uniforms["kerf"]!.value as number) > 1.2 * pixel;
  }
  highlight(): void {
    const { hovered, picked } = this.ctx.store.state, { point, count } = this.ctx.scene.path;
    const set = (mark: Mark, node: number | null): void => mark.set(node !== null && node > 0 && node < count ? point.subarray(3 * node - 3, 3 * node + 3) : null);
    set(this.marks.hover, hovered === picked ? null : hovered);
    set(this.marks.picked, picked);
  }
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
  readonly mesh: Mesh;
  private ends = new InstancedInterleavedBuffer(new Float32Array(6), 6);
  private tint = new InstancedBufferAttribute(new Uint8Array(4), 4, true);
  constructor(material: ShaderMaterial) {
    const g = quads(1);
    g.setAttribute("start", new InterleavedBufferAttribute(this.ends, 3, 0));
    g.setAttribute("end", new InterleavedBufferAttribute(this.ends, 3, 3));
    g.setAttribute("tint", this.tint);
    this.mesh = object(g, material, 30);
    this.mesh.visible = false;
  }
  colour(c: Color): void { const a = this.tint.array; a[0] = 255 * c.r; a[1] = 255 * c.g; a[2] = 255 * c.b; a[3] = Kind.feed; this.tint.needsUpdate = true; }
  set(ends: Float32Array | null): void {
    this.mesh.visible = ends !== null;
    if (ends) { (this.ends.array as Float32Array).set(ends); this.ends.needsUpdate = true; }
  }
}

// SPDX-License-Identifier: Apache-2.0
// Curves of a drawing: the part's edges (coloured by deviation where it is known), other lines thin.
import { BufferAttribute, Color, GLSL3, Group, InstancedBufferAttribute, ShaderMaterial } from "three";
import { divergingColour, heatRange, NONE } from "../colours";
import type { Context } from "./context";
import { object, quads } from "./quads";
import { CLIP_FRAGMENT, CLIP_VERTEX } from "./materials";

const WIDTH_PART = 1.7, WIDTH_OTHER = 1, WIDTH_HEAT = 3.2; // CSS pixels

const VERTEX = `
in vec3 start; in vec3 end; in vec4 tint; in vec4 tintEnd;
uniform vec2 screen; uniform float pixel; out vec3 vTint; ${CLIP_VERTEX}
void main() {
  vec4 a = projectionMatrix * modelViewMatrix * vec4(start, 1.0), b = projectionMatrix * modelViewMatrix * vec4(end, 1.0);
  vec2 d = (b.xy / b.w - a.xy / a.w) * screen; float len = length(d);
  d = len > 1e-6 ? d / len : vec2(1.0, 0.0);
  float w = max(1.0, tint.a * 25.5 * pixel);
  vec4 c = position.x < 0.5 ? a : b;
  vec2 off = vec2(-d.y, d.x) * position.y * w * 0.5 + d * (position.x - 0.5) * w * 0.7;
  gl_Position = vec4(c.xy + off * 2.0 / screen * c.w, c.z - 0.0003 * c.w, c.w);
  vTint = position.x < 0.5 ? tint.rgb : tintEnd.rgb; vPart = position.x < 0.5 ? start : end;
}`;
const FRAGMENT = `${CLIP_FRAGMENT} in vec3 vTint; out vec4 result; void main() { cut(); result = vec4(vTint, 1.0); }`;

export class Outlines {
  readonly group = new Group();
  private start: Uint8Array; // colour, width x 10
  private end: Uint8Array;
  private attributes: InstancedBufferAttribute[];
  constructor(private ctx: Context) {
    const ways = (o: { closed: boolean; point: Float32Array }): number => Math.max(0, o.point.length / 3 - (o.closed ? 0 : 1));
    const n = ctx.scene.outlines.reduce((s, o) => s + ways(o), 0), from = new Float32Array(3 * n), to = new Float32Array(3 * n);
    let at = 0;
    for (const o of ctx.scene.outlines) for (let i = 0, m = o.point.length / 3; i < ways(o); ++i, ++at) {
      from.set(o.point.subarray(3 * i, 3 * i + 3), 3 * at);
      to.set(o.point.subarray(3 * ((i + 1) % m), 3 * ((i + 1) % m) + 3), 3 * at);
    }
    this.start = new Uint8Array(4 * n); this.end = new Uint8Array(4 * n);
    this.attributes = [new InstancedBufferAttribute(this.start, 4, true), new InstancedBufferAttribute(this.end, 4, true)];
    const g = quads(n);
    g.setAttribute("start", new InstancedBufferAttribute(from, 3));
    g.setAttribute("end", new InstancedBufferAttribute(to, 3));
    g.setAttribute("tint", this.attributes[0] as BufferAttribute);
    g.setAttribute("tintEnd", this.attributes[1] as BufferAttribute);
    const { shared } = ctx;
    const material = new ShaderMaterial({ glslVersion: GLSL3, vertexShader: VERTEX, fragmentShader: FRAGMENT, uniforms: { clip: shared.clip, clipOn: shared.clipOn, screen: shared.screen, pixel: shared.pixel } });
    if (n > 0) this.group.add(object(g, material, 1));
    this.update();
  }
  update(): void {
    const { scene, store: { state }, theme } = this.ctx, edge = new Color().copy(theme.ink).lerp(theme.sheet, 0.12), other = new Color().copy(theme.soft).lerp(theme.sheet, 0.3);
    this.group.visible = state.show.part;
    let at = 0;
    for (const o of scene.outlines) {
      const m = o.point.length / 3, n = Math.max(0, m - (o.closed ? 0 : 1)), value = state.heat ? o.value : null;
      const range = value ? heatRange({ value, valueRange: 0 }, state.heatRange) : 1, plain = o.part ? edge : other, width = Math.round(10 * (value ? WIDTH_HEAT : o.part ? WIDTH_PART : WIDTH_OTHER));
      const colour = (i: number): number[] => {
        if (!value) return [plain.r, plain.g, plain.b];
        const v = value[i]!;
        return Number.isNaN(v) ? NONE : divergingColour(v / range, theme.dark);
      };
      for (let i = 0; i < n; ++i, ++at) for (const [to, k] of [[this.start, i], [this.end, (i + 1) % m]] as [Uint8Array, number][]) {
        const c = colour(k);
        for (let e = 0; e < 3; ++e) to[4 * at + e] = Math.round(255 * c[e]!);
        to[4 * at + 3] = width;
      }
    }
    for (const a of this.attributes) a.needsUpdate = true;
  }
}

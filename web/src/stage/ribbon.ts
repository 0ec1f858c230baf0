// SPDX-License-Identifier: Apache-2.0
// Many lines of even width in one draw: points and colours lie in textures, a vertex knows by its number which way and which
// corner it is. (Instances of four vertices are slow on many devices, and a buffer of corners would be four times as large.)
import { Box3, BufferAttribute, BufferGeometry, DataTexture, FloatType, Frustum, GLSL3, Line, type Matrix4, Mesh, NearestFilter, RGBAFormat, type ShaderMaterial, ShaderMaterial as Material, UnsignedByteType, Vector3 } from "three";
import type { Context } from "./context";
import { CLIP_FRAGMENT, CLIP_VERTEX } from "./materials";

const TEXELS = 2048; // a row
const PIECE = 512; // ways that are left out together
const LONGEST = 4, NEAR = 0.3, MOST_SKIPPED = 64; // pixels, nodes: of a thread's chords
const LEVELS = 4; // kept

/** What a way looks like; as path.kind where it is one. */
export const Look = { dashed: 0, plain: 1, thin: 4, hidden: 128 } as const;

/** The vertex shader's beginning: fetch() sets start, end, tint (rgb, look) and corner (0 or 1 along, -1 or 1 across) of this vertex. */
export const FETCH = `
uniform highp sampler2D points, tints;
vec3 start, end; vec4 tint, tintStart; vec2 corner; int way; float look;
vec4 texel(highp sampler2D from, int i) { return texelFetch(from, ivec2(i % ${TEXELS}, i / ${TEXELS}), 0); }
void fetch() {
  way = gl_VertexID / 4; int c = gl_VertexID % 4;
  corner = vec2(c == 1 || c == 2 ? 1.0 : 0.0, c < 2 ? -1.0 : 1.0);
  start = texel(points, way).xyz; end = texel(points, way + 1).xyz; tintStart = texel(tints, way); tint = texel(tints, way + 1);
  look = floor(tint.a * 255.0 + 0.5);
}
const vec4 NOWHERE = vec4(2.0, 2.0, 2.0, 1.0);`;

const VERTEX = `${FETCH}
uniform vec2 screen; uniform float pixel, width, now, ahead, rapids, nearer, smoothly, lit;
out vec3 vTint; out float vAt, vAlong, vLook; ${CLIP_VERTEX}
void main() {
  fetch();
  vTint = vec3(0.0); vAt = 0.0; vAlong = 0.0; vLook = look; vPart = start;
  if (look > 127.5 || (look < 0.5 && rapids < 0.5) || (ahead < 0.5 && float(way) >= now)) { gl_Position = NOWHERE; return; }
  vec4 a = projectionMatrix * modelViewMatrix * vec4(start, 1.0), b = projectionMatrix * modelViewMatrix * vec4(end, 1.0);
  // Ends behind the eye come to the near plane.
  const float near = 1e-4;
  float fa = a.w < near && b.w > near ? (near - a.w) / (b.w - a.w) : 0.0, fb = b.w < near && a.w > near ? (near - a.w) / (b.w - a.w) : 1.0;
  vec4 p = mix(a, b, fa), q = mix(a, b, fb);
  vec2 d = (q.xy / q.w - p.xy / p.w) * screen * 0.5;
  float len = length(d), w = max(1.0, (look < 0.5 ? 0.7 : look > 3.5 ? 0.6 : 1.0) * width * pixel);
  d = len > 1e-6 ? d / len : vec2(1.0, 0.0);
  vec4 c = corner.x < 0.5 ? p : q;
  // A little longer at both ends, so that corners close.
  vec2 off = vec2(-d.y, d.x) * corner.y * w * 0.5 + d * (corner.x - 0.5) * w * 0.7;
  gl_Position = vec4(c.xy + off * 2.0 / screen * c.w, c.z - nearer * c.w, c.w);
  float t = corner.x < 0.5 ? fa : fb;
  vTint = smoothly > 0.5 && corner.x < 0.5 ? tintStart.rgb : tint.rgb;
  // Light on a thin thread: brightest across it, so that dense paths show the shape that they follow.
  vec3 along = mat3(modelViewMatrix) * (end - start);
  float across = dot(normalize(vec3(0.35, 0.55, 0.8)), along) / max(length(along), 1e-9);
  vTint *= 1.0 - lit + lit * (0.62 + 0.48 * sqrt(max(0.0, 1.0 - across * across)));
  vAt = float(way) + t; vAlong = corner.x * len / pixel; vPart = mix(start, end, t);
}`;
const FRAGMENT = `
uniform float now, ahead, faded, opacity; ${CLIP_FRAGMENT}
in vec3 vTint; in float vAt, vAlong, vLook; out vec4 result;
void main() {
  cut();
  if (vLook < 0.5 && mod(vAlong, 9.0) > 5.0) discard;
  float later = step(now, vAt);
  if (later * (1.0 - ahead) > 0.5) discard;
  result = vec4(vTint, opacity * mix(1.0, vLook < 0.5 ? 0.25 : faded, later) * (vLook < 0.5 ? 0.8 : 1.0));
}`;

/** A chain of nodes; what a node says of colour and look is about the way that ends there. */
export class Chain {
  readonly tint: Uint8Array; // 4 a node
  readonly points: DataTexture;
  readonly tints: DataTexture;
  readonly geometry = new BufferGeometry();
  readonly flat: BufferAttribute; // the same colours, for threads
  private boxes: Box3[] = []; // of PIECE ways each
  private levels = new Map<number, BufferAttribute>(); // by the logarithm of a pixel's size
  constructor(readonly point: Float32Array) {
    const n = point.length / 3, rows = Math.max(1, Math.ceil(n / TEXELS)), place = new Float32Array(4 * rows * TEXELS), ways = Math.max(0, n - 1);
    this.tint = new Uint8Array(4 * rows * TEXELS);
    this.flat = new BufferAttribute(this.tint.subarray(0, 4 * n), 4, true);
    this.points = texture(place, rows, FloatType);
    this.tints = texture(this.tint, rows, UnsignedByteType);
    this.set(point);
    const index = new Uint32Array(6 * ways);
    for (let i = 0, k = 0, v = 0; i < ways; ++i, v += 4) { index[k++] = v; index[k++] = v + 1; index[k++] = v + 2; index[k++] = v; index[k++] = v + 2; index[k++] = v + 3; }
    this.geometry.setIndex(new BufferAttribute(index, 1));
  }
  set(point: Float32Array): void {
    const place = this.points.image.data as unknown as Float32Array;
    for (let i = 0, k = 0; i < point.length; i += 3, k += 4) { place[k] = point[i]!; place[k + 1] = point[i + 1]!; place[k + 2] = point[i + 2]!; }
    this.points.needsUpdate = true;
  }
  /** r, g, b from 0 to 1. */
  paint(node: number, r: number, g: number, b: number, look: number): void {
    const t = this.tint, k = 4 * node;
    t[k] = 255 * r + 0.5; t[k + 1] = 255 * g + 0.5; t[k + 2] = 255 * b + 0.5; t[k + 3] = look;
  }
  painted(): void { this.tints.needsUpdate = true; this.flat.needsUpdate = true; }
  /** After looks changed. */
  forget(): void { this.levels.clear(); }
  /** Nodes enough for lines of one pixel where a pixel is `size` mm: ends of looks stay, others are left out while the chord
   *  is shorter than LONGEST pixels and passes each of them within NEAR pixels. */
  thinned(size: number): BufferAttribute {
    const level = Math.floor(Math.log2(size)), kept = this.levels.get(level);
    if (kept) return kept;
    const n = this.point.length / 3, p = this.point, t = this.tint, far = (LONGEST * 2 ** level) ** 2, near = (NEAR * 2 ** level) ** 2, out = new Uint32Array(n);
    let made = n > 0 ? 1 : 0, from = 0;
    for (let i = 1; i < n; ++i) {
      // Whether the chord from `from` may go on to i + 1.
      const last = i + 1 === n || t[4 * i + 3] !== t[4 * i + 7] || i - from >= MOST_SKIPPED;
      let skip = false;
      if (!last) {
        const ax = p[3 * from]!, ay = p[3 * from + 1]!, az = p[3 * from + 2]!, dx = p[3 * i + 3]! - ax, dy = p[3 * i + 4]! - ay, dz = p[3 * i + 5]! - az, dd = dx * dx + dy * dy + dz * dz;
        skip = dd <= far;
        for (let k = from + 1; skip && k <= i; ++k) {
          const x = p[3 * k]! - ax, y = p[3 * k + 1]! - ay, z = p[3 * k + 2]! - az, s = dd > 0 ? Math.min(1, Math.max(0, (x * dx + y * dy + z * dz) / dd)) : 0;
          skip = (x - s * dx) ** 2 + (y - s * dy) ** 2 + (z - s * dz) ** 2 <= near;
        }
      }
      if (!skip) { out[made++] = i; from = i; }
    }
    const index = new BufferAttribute(out.slice(0, made), 1);
    if (this.levels.size >= LEVELS) this.levels.delete(this.levels.keys().next().value!);
    this.levels.set(level, index);
    return index;
  }
  /** Leaves out what `matrix` (to clip space) puts beside the screen. How many ways are left. For objects with materials in a list. */
  cull(matrix: Matrix4): number {
    const ways = Math.max(0, this.point.length / 3 - 1), { geometry } = this;
    if (this.boxes.length === 0) for (let i = 0; i < ways; i += PIECE) {
      const box = new Box3();
      for (let k = i; k <= Math.min(ways, i + PIECE); ++k) box.expandByPoint(corner.fromArray(this.point, 3 * k));
      this.boxes.push(box.expandByScalar(1e-6));
    }
    frustum.setFromProjectionMatrix(matrix);
    geometry.clearGroups();
    let from = -1, seen = 0;
    for (let b = 0; b <= this.boxes.length; ++b) {
      const on = b < this.boxes.length && frustum.intersectsBox(this.boxes[b]!);
      if (on) { if (from < 0) from = b; seen += Math.min(ways, (b + 1) * PIECE) - b * PIECE; }
      else if (from >= 0) { geometry.addGroup(6 * from * PIECE, 6 * (Math.min(ways, b * PIECE) - from * PIECE), 0); from = -1; }
    }
    return seen;
  }
  object(material: ShaderMaterial | ShaderMaterial[], order: number): Mesh {
    const m = new Mesh(this.geometry, material);
    m.frustumCulled = false; m.renderOrder = order;
    m.visible = this.point.length > 3;
    return m;
  }
}
const frustum = new Frustum(), corner = new Vector3();
function texture(data: Float32Array | Uint8Array, rows: number, type: typeof FloatType | typeof UnsignedByteType): DataTexture {
  const t = new DataTexture(data, TEXELS, rows, RGBAFormat, type);
  t.minFilter = t.magFilter = NearestFilter;
  return t;
}

const THREAD_VERTEX = `
in vec4 tint;
uniform float nearer, lit; out float vAt; flat out vec3 vTint; flat out float vLook; ${CLIP_VERTEX}
void main() {
  vLook = floor(tint.a * 255.0 + 0.5); vTint = tint.rgb; vAt = float(gl_VertexID); vPart = position;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  gl_Position.z -= nearer * gl_Position.w;
}`;
const THREAD_FRAGMENT = `
uniform float now, ahead, faded, opacity, rapids, pixel; ${CLIP_FRAGMENT}
in float vAt; flat in vec3 vTint; flat in float vLook; out vec4 result;
void main() {
  cut();
  float later = step(now, vAt);
  if (vLook > 127.5 || (vLook < 0.5 && (rapids < 0.5 || mod(gl_FragCoord.x + gl_FragCoord.y, 9.0 * pixel) > 5.0 * pixel)) || later * (1.0 - ahead) > 0.5) discard;
  result = vec4(vTint, opacity * mix(1.0, vLook < 0.5 ? 0.25 : faded, later));
}`;
/** The same chain as lines of one pixel: an eighth of the work, for so many ways that no more can be told apart. */
export function thread(ctx: Context, chain: Chain, ribbon: ShaderMaterial, order: number): Line {
  const g = new BufferGeometry(), n = chain.point.length / 3;
  g.setAttribute("position", new BufferAttribute(chain.point, 3));
  g.setAttribute("tint", chain.flat);
  const line = new Line(g, new Material({ glslVersion: GLSL3, vertexShader: THREAD_VERTEX, fragmentShader: THREAD_FRAGMENT, transparent: true, uniforms: { ...ribbon.uniforms, pixel: ctx.shared.pixel } }));
  line.frustumCulled = false; line.renderOrder = order; line.visible = n > 1;
  return line;
}

export interface RibbonOptions { width: number; nearer: number; opacity?: number; onTop?: boolean; smooth?: boolean; lit?: boolean; now?: { value: number }; ahead?: { value: number }; faded?: number }

/** Uniforms to set: rapids (0, 1). `now` counts ways: 2.5 is in the middle of the third. */
export function ribbonMaterial(ctx: Context, chain: Chain, o: RibbonOptions): ShaderMaterial {
  const { shared } = ctx;
  return new Material({ glslVersion: GLSL3, vertexShader: VERTEX, fragmentShader: FRAGMENT, transparent: o.now !== undefined || o.opacity !== undefined, depthTest: !o.onTop, depthWrite: !o.onTop,
    uniforms: { points: { value: chain.points }, tints: { value: chain.tints }, clip: shared.clip, clipOn: shared.clipOn, screen: shared.screen, pixel: shared.pixel, width: { value: o.width },
      now: o.now ?? { value: 1e9 }, ahead: o.ahead ?? { value: 1 }, rapids: { value: 1 }, nearer: { value: o.nearer }, smoothly: { value: o.smooth ? 1 : 0 }, lit: { value: o.lit ? 1 : 0 }, faded: { value: o.faded ?? 1 }, opacity: { value: o.opacity ?? 1 } } });
}

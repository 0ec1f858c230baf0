// SPDX-License-Identifier: Apache-2.0
// The cut across a path: which passes cross the plane, the profile each of them sweeps there, what they leave between
// them, and the design's line. docs/viewer-panels.md has the formulas. All points less scene.center.
import type { Mesh, Path, Piece, Vec } from "../scene";
import { Kind } from "../scene";

export const dot = (a: Vec, b: Vec): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a: Vec, b: Vec): Vec => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const sum = (a: Vec, b: Vec, f = 1): Vec => [a[0] + f * b[0], a[1] + f * b[1], a[2] + f * b[2]];
export function unit(a: Vec): Vec | null { const l = Math.hypot(a[0], a[1], a[2]); return l > 1e-12 ? [a[0] / l, a[1] / l, a[2] / l] : null; }

/** The plane: across `feed`; v away from the part, u to the side. */
export interface Frame { origin: Vec; feed: Vec; u: Vec; v: Vec }
const at3 = (a: Float32Array, i: number): Vec => [a[3 * i], a[3 * i + 1], a[3 * i + 2]];
const tipOf = (path: Path, i: number): Vec => at3(path.point, i);
const axisOf = (path: Path, i: number): Vec => path.axis ? at3(path.axis, i) : [0, 0, 1];

/** Direction of the way into the node, else out of it, else of the nearest way that has one. */
export function feedAt(path: Path, node: number): Vec | null {
  for (let d = 0; d < path.count; ++d)
    for (const i of [node - d, node + d + 1]) {
      if (i < 1 || i >= path.count || path.kind[i] !== Kind.feed) continue;
      const f = unit(sum(tipOf(path, i), tipOf(path, i - 1), -1));
      if (f) return f;
      if (d > 1000) return null;
    }
  return null;
}
/** v is the tool axis as far as it lies in the plane; for a plunge any direction will do. */
export function frameAt(path: Path, node: number): Frame | null {
  const feed = feedAt(path, node);
  if (!feed) return null;
  const a = axisOf(path, node);
  let v = unit(sum(a, feed, -dot(a, feed)));
  if (!v || Math.abs(dot(a, feed)) > 0.999) v = unit(cross(feed, Math.abs(feed[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0]))!;
  return { origin: tipOf(path, node), feed, u: cross(v, feed), v };
}
/** The same plane turned so that v is the direction (p, q) of it. */
export function turned(f: Frame, p: number, q: number): Frame {
  const v = unit(sum([f.u[0] * p, f.u[1] * p, f.u[2] * p], f.v, q));
  return v ? { ...f, v, u: cross(v, f.feed) } : f;
}

/** What a tool sweeps of the plane while it goes straight through it: convex, known by its support. */
export class Swept {
  /** Of the plane's directions U and V, brought along the way of the tool (a point x is seen at (x . U, x . V)): the
      products that every question needs; place of the tip. */
  private UU = 0; private UV = 0; private VV = 0; private Ua = 0; private Va = 0; private pu = 0; private pv = 0;
  private constructor(readonly node: number, readonly tip: Vec, readonly axis: Vec, private way: Vec, readonly pieces: Piece[], frame: Frame) { this.see(frame); }
  /** Null when the way runs so flat to the plane that nothing can be said of its profile. */
  static through(node: number, tip: Vec, axis: Vec, way: Vec, pieces: Piece[], frame: Frame): Swept | null {
    const FLATTEST = 0.2;
    return Math.abs(dot(way, frame.feed)) < FLATTEST ? null : new Swept(node, tip, axis, way, pieces, frame);
  }
  /** The plane turned (its feed is as before). */
  see(frame: Frame): void {
    const of = dot(this.way, frame.feed), at = sum(this.tip, frame.origin, -1);
    const U = sum(frame.u, frame.feed, -dot(this.way, frame.u) / of), V = sum(frame.v, frame.feed, -dot(this.way, frame.v) / of);
    this.UU = dot(U, U); this.UV = dot(U, V); this.VV = dot(V, V); this.Ua = dot(U, this.axis); this.Va = dot(V, this.axis);
    this.pu = dot(at, U); this.pv = dot(at, V);
  }
  place(): [number, number] { return [this.pu, this.pv]; }
  axisSeen(): [number, number] { return [this.Ua, this.Va]; }
  /** The outermost point in direction (p, q), as [u, v]. With g = p U + q V: the largest h g.a + r |g - (g.a) a| of the profile (h, r). */
  outermost(p: number, q: number): [number, number] {
    const gU = p * this.UU + q * this.UV, gV = p * this.UV + q * this.VV, gg = p * gU + q * gV, ga = p * this.Ua + q * this.Va;
    const gr = Math.sqrt(Math.max(0, gg - ga * ga)), all = Math.sqrt(gg), down = ga < 0;
    let best = -Infinity, height = 0, radius = 0;
    for (const b of this.pieces) {
      const corner = down && all > 0 ? b.corner : 0;
      const h = down ? b.low + (corner > 0 ? corner * (1 + ga / all) : 0) : b.high, w = b.radius - corner + (corner > 0 ? corner * gr / all : 0), s = h * ga + w * gr;
      if (s > best) { best = s; height = h; radius = w; }
    }
    const f = gr > 1e-15 ? radius / gr : 0;
    return [this.pu + height * this.Ua + f * (gU - ga * this.Ua), this.pv + height * this.Va + f * (gV - ga * this.Va)];
  }
  support(p: number, q: number): number { const [u, v] = this.outermost(p, q); return p * u + q * v; }
  get left(): number { return this.outermost(-1, 0)[0]; }
  get right(): number { return this.outermost(1, 0)[0]; }
  /** Lower boundary at u: the largest of all lines that hold the body from below. Infinity beside it. */
  low(u: number): number {
    if (u < this.left || u > this.right) return Infinity;
    const EDGE = Math.PI / 2 - 1e-7;
    let a = -EDGE, b = EDGE;
    for (let k = 0; k < 46; ++k) {
      const m = (a + b) / 2;
      if (this.outermost(Math.sin(m), -Math.cos(m))[0] < u) a = m; else b = m;
    }
    const m = (a + b) / 2, t = Math.tan(m);
    return Math.abs(m) > EDGE - 1e-6 ? this.outermost(Math.sin(m), -Math.cos(m))[1] : t * u - this.support(t, -1);
  }
  outline(n = 180): [number, number][] {
    const out: [number, number][] = [];
    for (let k = 0; k < n; ++k) { const a = 2 * Math.PI * k / n; out.push(this.outermost(Math.cos(a), Math.sin(a))); }
    return out;
  }
}

export interface Crossing { node: number; tip: Vec; axis: Vec; way: Vec }
/** Cutting ways that go through the plane within `reach` mm of its origin; nearest first, at most `most`. */
export function crossings(path: Path, f: Frame, reach: number, most: number): Crossing[] {
  const { point, kind, count } = path, [fx, fy, fz] = f.feed, o = dot(f.origin, f.feed), out: (Crossing & { d: number })[] = [];
  let before = count > 0 ? point[0] * fx + point[1] * fy + point[2] * fz - o : 0;
  for (let i = 1; i < count; ++i) {
    const s = point[3 * i] * fx + point[3 * i + 1] * fy + point[3 * i + 2] * fz - o, a = before;
    before = s;
    if (kind[i] !== Kind.feed || !((a < 0 && s >= 0) || (a >= 0 && s < 0))) continue;
    const t = a / (a - s), p = tipOf(path, i - 1), q = tipOf(path, i), tip = sum(p, sum(q, p, -1), t), d = Math.hypot(...sum(tip, f.origin, -1));
    if (d > reach) continue;
    const way = unit(sum(q, p, -1)), axis = unit(sum(axisOf(path, i - 1), sum(axisOf(path, i), axisOf(path, i - 1), -1), t));
    if (way && axis) out.push({ node: i, tip, axis, way, d });
  }
  out.sort((p, q) => p.d - q.d);
  return out.slice(0, most);
}

/** Where the plane cuts the triangles within `reach` of the origin: u1 v1 u2 v2 ... */
export function cutMesh(mesh: Pick<Mesh, "point" | "index">, f: Frame, reach: number): Float64Array {
  const { point, index } = mesh, n = point.length / 3, side = new Float32Array(n), out: number[] = [];
  for (let i = 0; i < n; ++i) side[i] = (point[3 * i] - f.origin[0]) * f.feed[0] + (point[3 * i + 1] - f.origin[1]) * f.feed[1] + (point[3 * i + 2] - f.origin[2]) * f.feed[2];
  for (let t = 0; t + 2 < index.length; t += 3) {
    const a = index[t], b = index[t + 1], c = index[t + 2], sa = side[a] >= 0, sb = side[b] >= 0, sc = side[c] >= 0;
    if (sa === sb && sb === sc) continue;
    const ends: number[] = [];
    for (const [p, q, cut] of [[a, b, sa !== sb], [b, c, sb !== sc], [c, a, sc !== sa]] as const) {
      if (!cut) continue;
      const w = side[p] / (side[p] - side[q]), P = sum(at3(point, p), f.origin, -1), x = sum(P, sum(at3(point, q), at3(point, p), -1), w);
      ends.push(dot(x, f.u), dot(x, f.v));
    }
    const [u1, v1, u2, v2] = ends;
    if (Math.min(u1, u2) > reach || Math.max(u1, u2) < -reach || Math.min(v1, v2) > reach || Math.max(v1, v2) < -reach) continue;
    out.push(u1, v1, u2, v2);
  }
  return Float64Array.from(out);
}
/** Normal of the design's line where the body is nearest to it, towards the body; null: nothing near. */
export function normalNear(body: Swept, line: Float64Array, reach: number): [number, number] | null {
  let best = reach * reach, normal: [number, number] | null = null;
  const rim = body.outline(120), [cu, cv] = body.place(), [au, av] = body.axisSeen(), up = Math.max(1e-3, ...body.pieces.map(p => p.radius)), inside: [number, number] = [cu + au * up, cv + av * up];
  for (let k = 0; k + 3 < line.length; k += 4) {
    const du = line[k + 2] - line[k], dv = line[k + 3] - line[k + 1], l2 = du * du + dv * dv;
    if (l2 < 1e-18) continue;
    for (const [pu, pv] of rim) {
      const t = Math.min(1, Math.max(0, ((pu - line[k]) * du + (pv - line[k + 1]) * dv) / l2)), d = (pu - line[k] - t * du) ** 2 + (pv - line[k + 1] - t * dv) ** 2;
      if (d < best) {
        best = d;
        const l = Math.sqrt(l2), s = (inside[0] - line[k]) * -dv + (inside[1] - line[k + 1]) * du >= 0 ? 1 : -1;
        normal = [-dv / l * s, du / l * s];
      }
    }
  }
  return normal;
}

/** Lowest of all bodies on a grid of u, and whose it is (-1: nothing cuts there). */
export interface Envelope { u: Float64Array; v: Float64Array; owner: Int16Array }
export function envelope(bodies: Swept[], from: number, to: number, n: number): Envelope {
  const u = new Float64Array(n), v = new Float64Array(n).fill(Infinity), owner = new Int16Array(n).fill(-1);
  for (let i = 0; i < n; ++i) u[i] = from + (to - from) * i / Math.max(1, n - 1);
  bodies.forEach((b, k) => {
    const l = b.left, r = b.right, bottom = b.outermost(0, -1)[1];
    for (let i = 0; i < n; ++i) if (u[i] >= l && u[i] <= r && bottom < v[i]) { const y = b.low(u[i]); if (y < v[i]) { v[i] = y; owner[i] = k; } }
  });
  return { u, v, owner };
}
/** Slope against the surface from which on two passes are a step and no scallop. */
const STEEPEST = 0.7;
/** A ridge between two passes; height over the line that touches both from below. */
export interface Cusp { u: number; v: number; left: number; right: number; height: number }
export function cusps(bodies: Swept[], e: Envelope): Cusp[] {
  const out: Cusp[] = [];
  for (let i = 1; i < e.u.length; ++i) {
    const a = e.owner[i - 1], b = e.owner[i];
    if (a < 0 || b < 0 || a === b) continue;
    const A = bodies[a], B = bodies[b];
    let lo = e.u[i - 1], hi = e.u[i];
    for (let k = 0; k < 40; ++k) { const m = (lo + hi) / 2; if (A.low(m) < B.low(m)) lo = m; else hi = m; }
    const u = (lo + hi) / 2, v = Math.min(A.low(u), B.low(u));
    const t = tangent(A, B);
    if (Math.abs(t) > STEEPEST) continue;
    const below = t * u - A.support(t, -1);
    out.push({ u, v, left: a, right: b, height: (v - below) / Math.hypot(1, t) });
  }
  return out;
}
/** Slope of the line that touches both from below. The bodies' supports differ in sign at the ends, A to the left. */
function tangent(A: Swept, B: Swept): number {
  const f = (a: number) => A.support(Math.sin(a), -Math.cos(a)) - B.support(Math.sin(a), -Math.cos(a));
  let lo = -1.5, hi = 1.5;
  if (f(lo) < f(hi)) [lo, hi] = [hi, lo];
  if (f(lo) < 0 || f(hi) > 0) return 0;
  for (let k = 0; k < 50; ++k) { const m = (lo + hi) / 2; if (f(m) > 0) lo = m; else hi = m; }
  return Math.tan((lo + hi) / 2);
}
/** Height of the design over u: the piece of its line that is nearest to `near`; NaN: none there. */
export function designAt(line: Float64Array, u: number, near: number): number {
  let best = NaN;
  for (let k = 0; k + 3 < line.length; k += 4) {
    const a = line[k], b = line[k + 2];
    if ((a < u && b < u) || (a > u && b > u) || a === b) continue;
    const v = line[k + 1] + (u - a) / (b - a) * (line[k + 3] - line[k + 1]);
    if (!(Math.abs(v - near) >= Math.abs(best - near))) best = v;
  }
  return best;
}

// SPDX-License-Identifier: Apache-2.0
// The cut of a beam about a node: beam path and edges of the part in the plane across the beam.
import type { Outline, Path, Vec } from "../scene";
import { Kind } from "../scene";
import { cross, dot, sum, unit } from "./section";

export interface Plane { origin: Vec; x: Vec; y: Vec; z: Vec }
/** Across the beam at the node; x and y as the drawing has them when the beam is upright. */
export function beamPlane(path: Path, node: number): Plane {
  const origin: Vec = [path.point[3 * node], path.point[3 * node + 1], path.point[3 * node + 2]];
  const z = (path.axis && unit([path.axis[3 * node], path.axis[3 * node + 1], path.axis[3 * node + 2]])) || [0, 0, 1] as Vec;
  const x = Math.abs(z[0]) < 0.9 ? unit(sum([1, 0, 0], z, -z[0]))! : unit(sum([0, 1, 0], z, -z[1]))!;
  return { origin, x, y: cross(z, x), z };
}
const flat = (p: Plane, a: ArrayLike<number>, i: number): [number, number, number] => {
  const d: Vec = [a[3 * i] - p.origin[0], a[3 * i + 1] - p.origin[1], a[3 * i + 2] - p.origin[2]];
  return [dot(d, p.x), dot(d, p.y), dot(d, p.z)];
};
/** Cutting ways that come within `reach`, as joined lines of x y; `nodes`: of their ends. */
export function beamLines(path: Path, p: Plane, reach: number): { points: number[]; nodes: number[] }[] {
  const out: { points: number[]; nodes: number[] }[] = [];
  let open: { points: number[]; nodes: number[] } | null = null, a = path.count > 0 ? flat(p, path.point, 0) : [0, 0, 0];
  for (let i = 1; i < path.count; ++i) {
    const b = flat(p, path.point, i), near = path.kind[i] === Kind.feed && Math.min(a[0], b[0]) < reach && Math.max(a[0], b[0]) > -reach && Math.min(a[1], b[1]) < reach && Math.max(a[1], b[1]) > -reach && Math.abs(b[2]) < reach;
    if (!near) open = null;
    else {
      if (!open) { open = { points: [a[0], a[1]], nodes: [i - 1] }; out.push(open); }
      open.points.push(b[0], b[1]); open.nodes.push(i);
    }
    a = b;
  }
  return out;
}
/** Ends closer than this are one place: drawings join lines and arcs no better, mm. */
const JOINED = 2e-3;
/** Curves that are drawn piece by piece, joined at their ends: contours whose inside can be told, and what stays open. */
export function joined(curves: Pick<Outline, "point" | "closed">[]): { point: Float32Array; closed: boolean }[] {
  const out: { point: Float32Array; closed: boolean }[] = [], open = curves.filter(c => !c.closed && c.point.length >= 6), used = new Set<number>(), cells = new Map<string, { curve: number; end: 0 | 1 }[]>();
  for (const c of curves) if (c.closed) out.push(c);
  const end = (c: number, e: 0 | 1): number[] => { const p = open[c].point, at = e ? p.length - 3 : 0; return [p[at], p[at + 1], p[at + 2]]; };
  const cell = (p: number[], d: number[]) => p.map((v, k) => Math.floor(v / JOINED) + d[k]).join();
  open.forEach((_, c) => { for (const e of [0, 1] as const) { const k = cell(end(c, e), [0, 0, 0]), l = cells.get(k); if (l) l.push({ curve: c, end: e }); else cells.set(k, [{ curve: c, end: e }]); } });
  const next = (p: number[]) => {
    for (const dx of [0, -1, 1]) for (const dy of [0, -1, 1]) for (const dz of [0, -1, 1]) for (const q of cells.get(cell(p, [dx, dy, dz])) ?? [])
      if (!used.has(q.curve) && Math.hypot(...end(q.curve, q.end).map((v, k) => v - p[k])) < JOINED) return q;
    return null;
  };
  open.forEach((_, c) => {
    if (used.has(c)) return;
    const points: number[] = [];
    const take = (k: number, from: 0 | 1) => { used.add(k); const p = open[k].point, n = p.length / 3; for (let i = 0; i < n; ++i) { const at = 3 * (from === 0 ? i : n - 1 - i); points.push(p[at], p[at + 1], p[at + 2]); } };
    take(c, 0);
    for (let side = 0; side < 2; ++side) { // on from its end, then from its beginning
      for (let q = next(points.slice(-3)); q; q = next(points.slice(-3))) take(q.curve, q.end);
      if (side === 0) { const turned: number[] = []; for (let i = points.length - 3; i >= 0; i -= 3) turned.push(points[i], points[i + 1], points[i + 2]); points.length = 0; for (const v of turned) points.push(v); }
    }
    const n = points.length, closed = n > 9 && Math.hypot(points[0] - points[n - 3], points[1] - points[n - 2], points[2] - points[n - 1]) < JOINED;
    out.push({ point: Float32Array.from(points), closed });
  });
  return out;
}
/** The whole curve when it comes near: its inside is asked for. */
export function flatOutline(o: Pick<Outline, "point">, p: Plane, reach: number): Float64Array | null {
  const n = o.point.length / 3, out = new Float64Array(2 * n);
  let x0 = Infinity, x1 = -Infinity, y0 = Infinity, y1 = -Infinity, deep = Infinity;
  for (let i = 0; i < n; ++i) {
    const [x, y, z] = flat(p, o.point, i);
    out[2 * i] = x; out[2 * i + 1] = y;
    x0 = Math.min(x0, x); x1 = Math.max(x1, x); y0 = Math.min(y0, y); y1 = Math.max(y1, y); deep = Math.min(deep, Math.abs(z));
  }
  return n > 1 && x0 < reach && x1 > -reach && y0 < reach && y1 > -reach && deep < reach ? out : null;
}
/** The place of the lines nearest to (x, y). */
export function nearestOn(lines: { points: ArrayLike<number>; closed: boolean }[], x: number, y: number): { x: number; y: number; distance: number } | null {
  let best: { x: number; y: number; distance: number } | null = null;
  for (const { points, closed } of lines) {
    const n = points.length / 2;
    for (let i = 0; i + (closed ? 0 : 1) < n; ++i) {
      const j = (i + 1) % n, ax = points[2 * i], ay = points[2 * i + 1], dx = points[2 * j] - ax, dy = points[2 * j + 1] - ay, l2 = dx * dx + dy * dy;
      const t = l2 > 0 ? Math.min(1, Math.max(0, ((x - ax) * dx + (y - ay) * dy) / l2)) : 0, px = ax + t * dx, py = ay + t * dy, distance = Math.hypot(px - x, py - y);
      if (!best || distance < best.distance) best = { x: px, y: py, distance };
    }
  }
  return best;
}

// SPDX-License-Identifier: Apache-2.0
// What is under the cursor: a way of the path (nearest on the screen), a point of a surface (first along the ray).
import { Matrix4, Vector3 } from "three";
import { Kind, type Mesh, type Path } from "../scene";
import { BoxTree, growBy } from "./box_tree";

export interface Ray { from: Vector3; direction: Vector3 } // stage coordinates, direction unit
export interface Hit { point: Vector3; distance: number }

/** Triangles in the order of a Morton curve through their centres. */
function mortonOrder(mesh: Mesh): Uint32Array {
  const n = mesh.index.length / 3, box = new Float32Array([Infinity, Infinity, Infinity, -Infinity, -Infinity, -Infinity]);
  for (let i = 0; i < mesh.point.length; i += 3) growBy(box, 0, mesh.point, i);
  const scale = [0, 1, 2].map(c => 1023 / Math.max(1e-9, box[3 + c]! - box[c]!)), key = new Float64Array(n);
  const spread = (v: number): number => { v = (v | v << 16) & 0x030000ff; v = (v | v << 8) & 0x0300f00f; v = (v | v << 4) & 0x030c30c3; return (v | v << 2) & 0x09249249; };
  for (let t = 0; t < n; ++t) {
    let code = 0;
    for (let c = 0; c < 3; ++c) {
      const m = (mesh.point[3 * mesh.index[3 * t]! + c]! + mesh.point[3 * mesh.index[3 * t + 1]! + c]! + mesh.point[3 * mesh.index[3 * t + 2]! + c]!) / 3;
      code |= spread(Math.floor((m - box[c]!) * scale[c]!)) << c;
    }
    key[t] = code * 0x400000 + t; // 30 bits of place, 22 of number; exact in a double
  }
  key.sort();
  return Uint32Array.from(key, k => k % 0x400000);
}

export class Surface {
  private order: Uint32Array;
  private tree: BoxTree;
  constructor(readonly mesh: Mesh) {
    this.order = mortonOrder(mesh);
    const { point, index } = mesh;
    this.tree = new BoxTree(this.order.length, (i, box, at) => { for (let k = 0; k < 3; ++k) growBy(box, at, point, 3 * index[3 * this.order[i]! + k]!); });
  }
  /** First triangle hit before `limit` that `seen` (not cut away) accepts. */
  hit(ray: Ray, limit: number, seen: (p: Vector3) => boolean): Hit | null {
    const { point, index } = this.mesh, o = ray.from, d = ray.direction, ix = 1 / d.x, iy = 1 / d.y, iz = 1 / d.z;
    let best = limit, found: Vector3 | null = null;
    this.tree.visit((b, at) => {
      const x0 = (b[at]! - o.x) * ix, x1 = (b[at + 3]! - o.x) * ix, y0 = (b[at + 1]! - o.y) * iy, y1 = (b[at + 4]! - o.y) * iy, z0 = (b[at + 2]! - o.z) * iz, z1 = (b[at + 5]! - o.z) * iz;
      const near = Math.max(Math.min(x0, x1), Math.min(y0, y1), Math.min(z0, z1)), far = Math.min(Math.max(x0, x1), Math.max(y0, y1), Math.max(z0, z1));
      // A box may be flat: a little slack, relative to the way.
      return far < Math.max(0, near - 1e-6 * Math.abs(near)) || near > best ? Infinity : near;
    }, i => {
      const t = 3 * this.order[i]!;
      a.fromArray(point, 3 * index[t]!); b.fromArray(point, 3 * index[t + 1]!).sub(a); c.fromArray(point, 3 * index[t + 2]!).sub(a);
      p.crossVectors(d, c);
      const det = b.dot(p);
      if (det === 0) return;
      s.subVectors(o, a);
      const u = s.dot(p) / det;
      if (!(u >= 0 && u <= 1)) return;
      q.crossVectors(s, b);
      const v = d.dot(q) / det;
      if (!(v >= 0 && u + v <= 1)) return;
      const w = c.dot(q) / det;
      if (w >= 0 && w < best) { place.copy(o).addScaledVector(d, w); if (seen(place)) { best = w; found = place.clone(); } }
    });
    return found ? { point: found, distance: best } : null;
  }
}
const a = new Vector3(), b = new Vector3(), c = new Vector3(), p = new Vector3(), q = new Vector3(), s = new Vector3(), place = new Vector3();

export interface Screen { matrix: Matrix4; width: number; height: number } // stage -> clip; CSS pixels
export interface WayHit { node: number; pixels: number; depth: number; point: Vector3 }

export class Ways {
  private tree: BoxTree;
  constructor(private path: Path) {
    this.tree = new BoxTree(Math.max(0, path.count - 1), (i, box, at) => { growBy(box, at, path.point, 3 * i); growBy(box, at, path.point, 3 * i + 3); });
  }
  /** Nearest way within `reach` pixels; of those about as near, the one in front. `depth` is in clip space, -1 to 1. */
  nearest(screen: Screen, x: number, y: number, reach: number, seen: (node: number, depth: number, p: Vector3) => boolean): WayHit | null {
    const e = screen.matrix.elements, { point, kind } = this.path, sx = screen.width / 2, sy = screen.height / 2;
    let best: WayHit | null = null, cost = reach;
    const FRONT = 3; // pixels that being in front is worth
    const score = (pixels: number, depth: number): number => pixels + FRONT * (depth + 1) / 2;
    const project = (px: number, py: number, pz: number, out: Float64Array, at: number): boolean => {
      const w = e[3]! * px + e[7]! * py + e[11]! * pz + e[15]!;
      if (w < 1e-6) return false;
      out[at] = ((e[0]! * px + e[4]! * py + e[8]! * pz + e[12]!) / w + 1) * sx;
      out[at + 1] = (1 - (e[1]! * px + e[5]! * py + e[9]! * pz + e[13]!) / w) * sy;
      out[at + 2] = (e[2]! * px + e[6]! * py + e[10]! * pz + e[14]!) / w;
      return true;
    };
    const v = new Float64Array(6);
    this.tree.visit((b, at) => {
      let x0 = Infinity, x1 = -Infinity, y0 = Infinity, y1 = -Infinity;
      for (let k = 0; k < 8; ++k) {
        if (!project(b[at + (k & 1 ? 3 : 0)]!, b[at + (k & 2 ? 4 : 1)]!, b[at + (k & 4 ? 5 : 2)]!, v, 0)) return 0; // beside the eye: look into it
        x0 = Math.min(x0, v[0]!); x1 = Math.max(x1, v[0]!); y0 = Math.min(y0, v[1]!); y1 = Math.max(y1, v[1]!);
      }
      const dx = Math.max(0, x0 - x, x - x1), dy = Math.max(0, y0 - y, y - y1), d = Math.sqrt(dx * dx + dy * dy);
      return d >= cost ? Infinity : d;
    }, i => {
      if (!project(point[3 * i]!, point[3 * i + 1]!, point[3 * i + 2]!, v, 0) || !project(point[3 * i + 3]!, point[3 * i + 4]!, point[3 * i + 5]!, v, 3)) return;
      const dx = v[3]! - v[0]!, dy = v[4]! - v[1]!, dd = dx * dx + dy * dy, t = dd > 0 ? Math.min(1, Math.max(0, ((x - v[0]!) * dx + (y - v[1]!) * dy) / dd)) : 0;
      const px = v[0]! + t * dx - x, py = v[1]! + t * dy - y, pixels = Math.sqrt(px * px + py * py), depth = v[2]! + t * (v[5]! - v[2]!);
      if (pixels > reach) return;
      const s = score(pixels, depth) + (kind[i + 1] === Kind.rapid ? 1.5 : 0);
      if (s >= cost) return;
      place.set(point[3 * i]! + t * (point[3 * i + 3]! - point[3 * i]!), point[3 * i + 1]! + t * (point[3 * i + 4]! - point[3 * i + 1]!), point[3 * i + 2]! + t * (point[3 * i + 5]! - point[3 * i + 2]!));
      if (!seen(i + 1, depth, place)) return;
      cost = s;
      best = { node: i + 1, pixels, depth, point: place.clone() };
    });
    return best;
  }
}

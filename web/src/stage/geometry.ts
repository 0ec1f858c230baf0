// SPDX-License-Identifier: Apache-2.0
// Meshes made ready to be looked at: normals that are smooth but for the creases, the creases and rims as lines.

const CREASE = Math.cos(32 * Math.PI / 180);
const SAME = 0.9995; // cosine of normals that may share a vertex
const MANY = 64; // triangles about one vertex: the middle of a fan, which stays faceted
const TRIED = 12; // vertices already made that one may share

export interface Shaped {
  point: Float32Array; normal: Int16Array; // normalised to 32767
  from: Uint32Array; // vertex of the mesh each came from
  index: Uint32Array;
  edge: Float32Array; // 6 an edge
  closed: boolean;
}

/** Math.hypot guards against overflow and is slow. */
const length = (x: number, y: number, z: number): number => Math.sqrt(x * x + y * y + z * z);

/** For each vertex the first of the same place. */
function weld(point: Float32Array): Uint32Array {
  const n = point.length / 3, bits = new Uint32Array(point.buffer, point.byteOffset, point.length);
  let size = 16;
  while (size < 2 * n) size *= 2;
  const table = new Int32Array(size).fill(-1), same = new Uint32Array(n);
  for (let i = 0; i < n; ++i) {
    let h = (Math.imul(bits[3 * i]!, 73856093) ^ Math.imul(bits[3 * i + 1]!, 19349663) ^ Math.imul(bits[3 * i + 2]!, 83492791)) >>> 0;
    h = (h ^ h >>> 15) & size - 1;
    for (;;) {
      const j = table[h]!;
      if (j < 0) { table[h] = i; same[i] = i; break; }
      if (point[3 * j] === point[3 * i] && point[3 * j + 1] === point[3 * i + 1] && point[3 * j + 2] === point[3 * i + 2]) { same[i] = j; break; }
      h = h + 1 & size - 1;
    }
  }
  return same;
}

/** Normals of the triangles, as long as twice their area. */
function faces(point: Float32Array, index: Uint32Array): Float32Array {
  const out = new Float32Array(index.length);
  for (let t = 0; t < index.length; t += 3) {
    const a = 3 * index[t]!, b = 3 * index[t + 1]!, c = 3 * index[t + 2]!;
    const ux = point[b]! - point[a]!, uy = point[b + 1]! - point[a + 1]!, uz = point[b + 2]! - point[a + 2]!;
    const vx = point[c]! - point[a]!, vy = point[c + 1]! - point[a + 1]!, vz = point[c + 2]! - point[a + 2]!;
    out[t] = uy * vz - uz * vy; out[t + 1] = uz * vx - ux * vz; out[t + 2] = ux * vy - uy * vx;
  }
  return out;
}

/** Corners of the triangles about each welded vertex, one after the other. */
function corners(index: Uint32Array, same: Uint32Array): Corners {
  const start = new Uint32Array(same.length + 1), corner = new Uint32Array(index.length);
  for (let c = 0; c < index.length; ++c) ++start[same[index[c]!]! + 1]!;
  for (let v = 0; v < same.length; ++v) start[v + 1]! += start[v]!;
  const fill = start.slice(0, same.length);
  for (let c = 0; c < index.length; ++c) corner[fill[same[index[c]!]!]!++] = c;
  return { start, corner };
}

/** Edges of one triangle, of three, or between triangles with a crease. Each is found at the lower of its vertices. */
function creases(point: Float32Array, index: Uint32Array, same: Uint32Array, unit: Float32Array, at: Corners): { edge: Float32Array; closed: boolean } {
  const out: number[] = [];
  let closed = index.length > 0;
  const ends: number[] = [], faces: number[] = []; // of the edges at one vertex
  for (let v = 0; v < same.length; ++v) {
    ends.length = faces.length = 0;
    for (let i = at.start[v]!; i < at.start[v + 1]!; ++i) {
      const c = at.corner[i]!, t = c - c % 3;
      for (let k = 1; k < 3; ++k) { const w = same[index[t + (c - t + k) % 3]!]!; if (w > v) { ends.push(w); faces.push(t); } }
    }
    const many = ends.length > 2 * MANY ? new Map<number, number[]>() : null;
    if (many) ends.forEach((w, k) => { const l = many.get(w); if (l) l.push(k); else many.set(w, [k]); });
    for (let k = 0; k < ends.length; ++k) {
      const w = ends[k]!;
      if (w < 0) continue;
      let other = -1, count = 1;
      const meet = (j: number): void => { other = faces[j]!; ++count; ends[j] = -1; };
      if (many) { for (const j of many.get(w)!) if (j > k) meet(j); } else for (let j = k + 1; j < ends.length; ++j) if (ends[j] === w) meet(j);
      const s = faces[k]!;
      if (count === 2 && unit[s]! * unit[other]! + unit[s + 1]! * unit[other + 1]! + unit[s + 2]! * unit[other + 2]! > CREASE) continue;
      closed = closed && count > 1;
      for (const q of [3 * v, 3 * w]) out.push(point[q]!, point[q + 1]!, point[q + 2]!);
    }
  }
  return { edge: new Float32Array(out), closed };
}

interface Corners { start: Uint32Array; corner: Uint32Array }

export function shape(point: Float32Array, index: Uint32Array): Shaped {
  const same = weld(point), face = faces(point, index), at = corners(index, same), { start, corner } = at;
  const unit = new Float32Array(face);
  for (let t = 0; t < unit.length; t += 3) { const l = length(unit[t]!, unit[t + 1]!, unit[t + 2]!) || 1; unit[t]! /= l; unit[t + 1]! /= l; unit[t + 2]! /= l; }
  const normal = new Float32Array(3 * index.length), from = new Uint32Array(index.length), out = new Uint32Array(index.length);
  let made = 0;
  for (let v = 0; v < same.length; ++v) {
    const begin = made;
    for (let i = start[v]!; i < start[v + 1]!; ++i) {
      const c = corner[i]!, t = c - c % 3;
      let x = 0, y = 0, z = 0;
      const many = start[v + 1]! - start[v]! > MANY;
      for (let j = many ? i : start[v]!; j < (many ? i + 1 : start[v + 1]!); ++j) {
        const d = corner[j]!, s = d - d % 3;
        if (unit[t]! * unit[s]! + unit[t + 1]! * unit[s + 1]! + unit[t + 2]! * unit[s + 2]! > CREASE) { x += face[s]!; y += face[s + 1]!; z += face[s + 2]!; }
      }
      const l = length(x, y, z);
      if (l > 0) { x /= l; y /= l; z /= l; } else z = 1;
      let k = Math.max(begin, made - TRIED);
      while (k < made && !(from[k] === index[c] && normal[3 * k]! * x + normal[3 * k + 1]! * y + normal[3 * k + 2]! * z > SAME)) ++k;
      if (k === made) { from[made] = index[c]!; normal[3 * made] = x; normal[3 * made + 1] = y; normal[3 * made + 2] = z; ++made; }
      out[c] = k;
    }
  }
  const place = new Float32Array(3 * made), packed = new Int16Array(3 * made);
  for (let i = 0; i < made; ++i) for (let c = 0; c < 3; ++c) { place[3 * i + c] = point[3 * from[i]! + c]!; packed[3 * i + c] = Math.round(32767 * normal[3 * i + c]!); }
  return { point: place, normal: packed, from: from.slice(0, made), index: out, ...creases(point, index, same, unit, at) };
}

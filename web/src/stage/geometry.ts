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

/** Edges of one triangle, of three, or between triangles with a crease. */
function creases(point: Float32Array, index: Uint32Array, same: Uint32Array, face: Float32Array): { edge: Float32Array; closed: boolean } {
  const n = index.length;
  let size = 16;
  while (size < n * 2) size *= 2; // half of the half edges meet their other half
  const first = new Int32Array(size).fill(-1), second = new Int32Array(size).fill(-1);
  for (let e = 0; e < n; ++e) {
    const a = same[index[e]!]!, b = same[index[e % 3 === 2 ? e - 2 : e + 1]!]!;
    if (a === b) continue;
    const lo = Math.min(a, b), hi = Math.max(a, b);
    let h = (Math.imul(lo, 73856093) ^ Math.imul(hi, 19349663)) >>> 0;
    h = (h ^ h >>> 15) & size - 1;
    for (;;) {
      const f = first[h]!;
      if (f < 0) { first[h] = e; break; }
      const fa = same[index[f]!]!, fb = same[index[f % 3 === 2 ? f - 2 : f + 1]!]!;
      if (Math.min(fa, fb) === lo && Math.max(fa, fb) === hi) { second[h] = second[h] === -1 ? e : -2; break; }
      h = h + 1 & size - 1;
    }
  }
  const out: number[] = [];
  let closed = n > 0;
  for (let h = 0; h < size; ++h) {
    const e = first[h]!, f = second[h]!;
    if (e < 0) continue;
    if (f >= 0) {
      const s = e - e % 3, t = f - f % 3;
      const d = face[s]! * face[t]! + face[s + 1]! * face[t + 1]! + face[s + 2]! * face[t + 2]!;
      const l = Math.hypot(face[s]!, face[s + 1]!, face[s + 2]!) * Math.hypot(face[t]!, face[t + 1]!, face[t + 2]!);
      if (l === 0 || d > CREASE * l) continue;
    } else closed = closed && f !== -1;
    const a = 3 * index[e]!, b = 3 * index[e % 3 === 2 ? e - 2 : e + 1]!;
    out.push(point[a]!, point[a + 1]!, point[a + 2]!, point[b]!, point[b + 1]!, point[b + 2]!);
  }
  return { edge: new Float32Array(out), closed };
}

/** Corners of the triangles about each welded vertex, one after the other. */
function corners(index: Uint32Array, same: Uint32Array): { start: Uint32Array; corner: Uint32Array } {
  const start = new Uint32Array(same.length + 1), corner = new Uint32Array(index.length);
  for (let c = 0; c < index.length; ++c) ++start[same[index[c]!]! + 1]!;
  for (let v = 0; v < same.length; ++v) start[v + 1]! += start[v]!;
  const fill = start.slice(0, same.length);
  for (let c = 0; c < index.length; ++c) corner[fill[same[index[c]!]!]!++] = c;
  return { start, corner };
}

export function shape(point: Float32Array, index: Uint32Array): Shaped {
  const same = weld(point), face = faces(point, index), { start, corner } = corners(index, same);
  const unit = new Float32Array(face);
  for (let t = 0; t < unit.length; t += 3) { const l = Math.hypot(unit[t]!, unit[t + 1]!, unit[t + 2]!) || 1; unit[t]! /= l; unit[t + 1]! /= l; unit[t + 2]! /= l; }
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
      const l = Math.hypot(x, y, z);
      if (l > 0) { x /= l; y /= l; z /= l; } else z = 1;
      let k = Math.max(begin, made - TRIED);
      while (k < made && !(from[k] === index[c] && normal[3 * k]! * x + normal[3 * k + 1]! * y + normal[3 * k + 2]! * z > SAME)) ++k;
      if (k === made) { from[made] = index[c]!; normal[3 * made] = x; normal[3 * made + 1] = y; normal[3 * made + 2] = z; ++made; }
      out[c] = k;
    }
  }
  const place = new Float32Array(3 * made), packed = new Int16Array(3 * made);
  for (let i = 0; i < made; ++i) for (let c = 0; c < 3; ++c) { place[3 * i + c] = point[3 * from[i]! + c]!; packed[3 * i + c] = Math.round(32767 * normal[3 * i + c]!); }
  return { point: place, normal: packed, from: from.slice(0, made), index: out, ...creases(point, index, same, face) };
}

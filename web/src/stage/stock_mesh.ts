// SPDX-License-Identifier: Apache-2.0
// The surface of the stock at a time, brick by brick: surface nets (Gibson, Constrained elastic surface nets, MICCAI 1998)
// over the nodes of the stock clock. Where the clock knows the crossing of the surface with an edge the vertex lies there;
// elsewhere the crossing is that of the blurred material, and the vertex is relaxed within its cell, so that slopes do not
// look like stairs. Runs in a worker; knows nothing of the page.

export interface ClockData { count: [number, number, number]; origin: [number, number, number]; step: number; cut: Uint32Array; crossing: Uint8Array }
export interface Cutter { radius: number; low: number; high: number; corner: number }
/** Solid: cut > limit; of those with cut = limit + 1 what the cutter has not met at the poses (6 numbers: tip, axis). */
export interface StockWish { limit: number; poses: Float32Array; cutter: Cutter[] }
export interface BrickMesh { brick: number; position: Float32Array; normal: Float32Array; tint: Float32Array; index: Uint32Array }

const BRICK = 32; // cells each way
const HALO = 5; // cells beside it that its vertices and normals depend on
const E = BRICK + 2 * HALO; // cells looked at
const N = E + 1; // nodes
const RELAX = 2;
const BLUR = 2; // nodes to either side
const HALF = (2 * BLUR + 1) ** 3 / 2;
const INSET = 0.04; // of a cell: how near a relaxed vertex comes to its walls

/** Corner c of a cell is at (c & 1, c >> 1 & 1, c >> 2); the twelve edges as (corner, direction). */
const EDGES: [number, number][] = [];
for (let d = 0; d < 3; ++d) for (let c = 0; c < 8; ++c) if (!(c >> d & 1)) EDGES.push([c, d]);

export class StockMesher {
  private solid: Uint8Array;
  private order: Uint32Array; // nodes by cut
  private begin: Map<number, number> = new Map(); // of each cut value in order
  private values: Uint32Array; // cut values, rising
  private bricks: [number, number, number];
  private dirty: Uint8Array;
  private limit = 0;
  private nodes = new Uint8Array(N * N * N);
  private vertex = new Int32Array(E * E * E);
  private blurred = new Uint8Array(N * N * N); // sum over the nodes about
  private spare = new Uint8Array(N * N * N);
  private row = new Int32Array(N * N); // how many of a row of nodes are solid

  constructor(private clock: ClockData) {
    const { cut, count } = clock, n = cut.length;
    // Nodes that go at some time, by that time.
    const going: number[] = [];
    this.solid = new Uint8Array(n);
    for (let i = 0; i < n; ++i) { const c = cut[i]!; if (c !== 0) { this.solid[i] = 1; if (c !== 0xffffffff) going.push(i); } }
    const key = new Float64Array(going.length), SHIFT = 2 ** 21; // 2^32 values x 2^21 nodes: exact in a double
    const fits = n <= SHIFT;
    if (fits) { for (let i = 0; i < going.length; ++i) key[i] = cut[going[i]!]! * SHIFT + going[i]!; key.sort(); this.order = Uint32Array.from(key, k => k % SHIFT); }
    else this.order = Uint32Array.from(going.sort((a, b) => cut[a]! - cut[b]! || a - b));
    const values: number[] = [];
    for (let i = 0; i < this.order.length; ++i) { const c = cut[this.order[i]!]!; if (values.length === 0 || values[values.length - 1] !== c) { values.push(c); this.begin.set(c, i); } }
    this.values = Uint32Array.from(values);
    this.bricks = count.map(c => Math.ceil((c + 1) / BRICK)) as [number, number, number];
    this.dirty = new Uint8Array(this.bricks[0] * this.bricks[1] * this.bricks[2]).fill(1);
  }
  get brickCount(): number { return this.dirty.length; }

  private flip(node: number, to: 0 | 1): void {
    if (this.solid[node] === to) return;
    this.solid[node] = to;
    const [nx, ny, nz] = this.clock.count, [bx, by] = this.bricks, i = node % nx, j = Math.floor(node / nx) % ny, k = Math.floor(node / (nx * ny));
    const lo = (v: number): number => Math.max(0, v - HALO) / BRICK | 0, hi = (v: number, n: number): number => Math.min(n, v + 1 + HALO) / BRICK | 0;
    for (let c = lo(k); c <= hi(k, nz); ++c) for (let b = lo(j); b <= hi(j, ny); ++b) for (let a = lo(i); a <= hi(i, nx); ++a) this.dirty[(c * by + b) * bx + a] = 1;
  }
  /** First index of order whose cut is above v. */
  private above(v: number): number {
    let lo = 0, hi = this.values.length;
    while (lo < hi) { const m = lo + hi >> 1; if (this.values[m]! <= v) lo = m + 1; else hi = m; }
    return lo < this.values.length ? this.begin.get(this.values[lo]!)! : this.order.length;
  }
  set(wish: StockWish): void {
    const old = this.above(this.limit), now = this.above(wish.limit);
    // What the last wish had taken of its own move comes back, unless it is gone now.
    const partEnd = this.above(this.limit + 1);
    if (this.limit !== wish.limit) for (let i = Math.max(old, now); i < partEnd; ++i) this.flip(this.order[i]!, 1);
    for (let i = old; i < now; ++i) this.flip(this.order[i]!, 0);
    for (let i = now; i < old; ++i) this.flip(this.order[i]!, 1);
    this.limit = wish.limit;
    const end = this.above(wish.limit + 1);
    for (let i = now; i < end; ++i) { const node = this.order[i]!; this.flip(node, this.met(node, wish) ? 0 : 1); }
  }
  private met(node: number, wish: StockWish): boolean {
    const { count: [nx, ny], origin: o, step } = this.clock, { poses } = wish;
    const x = o[0] + node % nx * step, y = o[1] + Math.floor(node / nx) % ny * step, z = o[2] + Math.floor(node / (nx * ny)) * step;
    for (let p = poses.length - 6; p >= 0; p -= 6) {
      const dx = x - poses[p]!, dy = y - poses[p + 1]!, dz = z - poses[p + 2]!, h = dx * poses[p + 3]! + dy * poses[p + 4]! + dz * poses[p + 5]!, r2 = dx * dx + dy * dy + dz * dz - h * h;
      for (const c of wish.cutter) {
        const slack = 0.5 * step, d = c.low + c.corner - h, r = slack + (d > 0 ? c.radius - c.corner + Math.sqrt(Math.max(0, c.corner * c.corner - d * d)) : c.radius);
        if (h >= c.low - slack && h <= c.high && r2 <= r * r) return true;
      }
    }
    return false;
  }
  /** The bricks that changed since this was asked last. */
  changed(): BrickMesh[] {
    const out: BrickMesh[] = [];
    for (let b = 0; b < this.dirty.length; ++b) if (this.dirty[b]) { this.dirty[b] = 0; out.push(this.mesh(b)); }
    return out;
  }

  private mesh(brick: number): BrickMesh {
    const [bx, by] = this.bricks, at = [brick % bx, Math.floor(brick / bx) % by, Math.floor(brick / (bx * by))];
    const first = at.map(v => v * BRICK - 1 - HALO) as [number, number, number]; // grid index of local node 0
    const some = this.fill(first);
    const none = { brick, position: new Float32Array(0), normal: new Float32Array(0), tint: new Float32Array(0), index: new Uint32Array(0) };
    if (!some) return none;
    this.blur();
    const { place, free, cell } = this.vertices(first);
    this.relax(place, free, cell);
    return this.quads(brick, first, place, cell) ?? none;
  }
  /** Copies the nodes about a brick; false: all the same. */
  private fill(first: [number, number, number]): boolean {
    const [nx, ny, nz] = this.clock.count, { nodes, solid } = this;
    nodes.fill(0); this.row.fill(0);
    let sum = 0;
    for (let k = 0; k < N; ++k) {
      const z = first[2] + k;
      if (z < 0 || z >= nz) continue;
      for (let j = 0; j < N; ++j) {
        const y = first[1] + j;
        if (y < 0 || y >= ny) continue;
        const x0 = Math.max(0, -first[0]), x1 = Math.min(N, nx - first[0]), from = (z * ny + y) * nx + first[0], to = (k * N + j) * N;
        let here = 0;
        for (let i = x0; i < x1; ++i) here += nodes[to + i] = solid[from + i]!;
        this.row[k * N + j] = here; sum += here;
      }
    }
    return sum > 0 && sum < N * N * N;
  }
  /** Sums of the nodes about each node, one direction after the other; beyond the brick the last one counts again. */
  private blur(): void {
    const { nodes, blurred, spare, row } = this;
    const pass = (from: Uint8Array, to: Uint8Array, d: number, along: number, across: number, onlyMixed: boolean): void => {
      for (let a = 0; a < N; ++a) for (let b = 0; b < N; ++b) {
        const at = a * across + b * along;
        if (onlyMixed) { const s = row[a * N + b]!; if (s === 0 || s === N) { to.fill(s === 0 ? 0 : 2 * BLUR + 1, at, at + N); continue; } }
        let sum = 0;
        for (let i = -BLUR; i <= BLUR; ++i) sum += from[at + Math.max(0, i) * d]!;
        for (let i = 0; i < N; ++i) { to[at + i * d] = sum; sum += from[at + Math.min(N - 1, i + BLUR + 1) * d]! - from[at + Math.max(0, i - BLUR) * d]!; }
      }
    };
    pass(nodes, blurred, 1, N, N * N, true);
    pass(blurred, spare, N, 1, N * N, false);
    pass(spare, blurred, N * N, 1, N, false);
  }
  /** Whether this row of cells has no surface: the four rows of nodes about it are all empty or all full. */
  private still(j: number, k: number): boolean {
    const { row } = this, r = k * N + j, s = row[r]!;
    return (s === 0 || s === N) && row[r + 1] === s && row[r + N] === s && row[r + N + 1] === s;
  }
  /** Share of the step from a node at which the surface crosses its edge; -1: not known. */
  private crossing(x: number, y: number, z: number, d: number): number {
    const [nx, ny, nz] = this.clock.count;
    if (x < 0 || y < 0 || z < 0 || x >= nx || y >= ny || z >= nz) return -1;
    const v = this.clock.crossing[3 * ((z * ny + y) * nx + x) + d]!;
    return v === 0 ? -1 : v / 256;
  }
  private vertices(first: [number, number, number]): { place: Float32Array; free: Uint8Array; cell: Int32Array } {
    const { nodes, vertex, blurred } = this, place: number[] = [], free: number[] = [], cells: number[] = [];
    const corner = [0, 1, N, N + 1, N * N, N * N + 1, N * N + N, N * N + N + 1], stride = [1, N, N * N];
    vertex.fill(-1);
    for (let k = 0; k < E; ++k) for (let j = 0; j < E; ++j) {
      if (this.still(j, k)) continue;
      let n = (k * N + j) * N, c = (k * E + j) * E;
      for (let i = 0; i < E; ++i, ++n, ++c) {
        const s = nodes[n]! + nodes[n + 1]! + nodes[n + N]! + nodes[n + N + 1]! + nodes[n + N * N]! + nodes[n + N * N + 1]! + nodes[n + N * N + N]! + nodes[n + N * N + N + 1]!;
        if (s === 0 || s === 8) continue;
        let x = 0, y = 0, z = 0, m = 0, unknown = 0;
        for (const [from, d] of EDGES) {
          const p = n + corner[from]!;
          if (nodes[p] === nodes[p + stride[d]!]) continue;
          const fx = from & 1, fy = from >> 1 & 1, fz = from >> 2;
          let t = this.crossing(first[0] + i + fx, first[1] + j + fy, first[2] + k + fz, d);
          if (t < 0) {
            const b0 = blurred[p]! - HALF, b1 = blurred[p + stride[d]!]! - HALF;
            t = b0 * b1 < 0 ? b0 / (b0 - b1) : Math.abs(b0) < Math.abs(b1) ? INSET : 1 - INSET;
            ++unknown;
          }
          x += fx + (d === 0 ? t : 0); y += fy + (d === 1 ? t : 0); z += fz + (d === 2 ? t : 0); ++m;
        }
        vertex[c] = cells.length;
        cells.push(c); free.push(unknown > 0 ? 1 : 0);
        place.push(i + x / m, j + y / m, k + z / m);
      }
    }
    return { place: Float32Array.from(place), free: Uint8Array.from(free), cell: Int32Array.from(cells) };
  }
  private relax(place: Float32Array, free: Uint8Array, cell: Int32Array): void {
    const { vertex } = this, next = new Float32Array(place.length), steps = [1, -1, E, -E, E * E, -E * E];
    for (let round = 0; round < RELAX; ++round) {
      for (let v = 0; v < cell.length; ++v) {
        const c = cell[v]!, at = [c % E, Math.floor(c / E) % E, Math.floor(c / (E * E))];
        for (let a = 0; a < 3; ++a) next[3 * v + a] = place[3 * v + a]!;
        if (!free[v] || at.some(i => i === 0 || i === E - 1)) continue;
        let x = 0, y = 0, z = 0, m = 0;
        for (const s of steps) { const u = vertex[c + s]!; if (u >= 0) { x += place[3 * u]!; y += place[3 * u + 1]!; z += place[3 * u + 2]!; ++m; } }
        if (m < 2) continue;
        const sum = [x, y, z];
        for (let a = 0; a < 3; ++a) next[3 * v + a] = Math.min(at[a]! + 1 - INSET, Math.max(at[a]! + INSET, sum[a]! / m));
      }
      place.set(next);
    }
  }
  private quads(brick: number, first: [number, number, number], place: Float32Array, cell: Int32Array): BrickMesh | null {
    const { nodes, vertex } = this, normal = new Float32Array(place.length), used = new Int32Array(cell.length).fill(-1), index: number[] = [];
    const node = [1, N, N * N], step = [1, E, E * E];
    let made = 0;
    const lo = HALO - 1, hi = HALO + BRICK + 1;
    for (let k = lo; k < hi; ++k) for (let j = lo; j < hi; ++j) for (let i = this.still(j, k) ? hi : lo; i < hi; ++i) {
      const n = (k * N + j) * N + i, c = (k * E + j) * E + i;
      const core = i >= HALO && j >= HALO && k >= HALO && i < HALO + BRICK && j < HALO + BRICK && k < HALO + BRICK;
      for (let d = 0; d < 3; ++d) {
        const here = nodes[n]!, there = nodes[n + node[d]!]!;
        if (here === there) continue;
        const u = step[(d + 1) % 3]!, w = step[(d + 2) % 3]!;
        let v0 = vertex[c - u - w]!, v1 = vertex[c - w]!, v2 = vertex[c]!, v3 = vertex[c - u]!;
        if (!here) { const t = v1; v1 = v3; v3 = t; }
        this.addNormal(normal, place, v0, v1, v2, v3);
        if (!core) continue;
        for (const v of [v0, v1, v2, v3]) if (used[v]! < 0) used[v] = made++;
        v0 = used[v0]!; v1 = used[v1]!; v2 = used[v2]!; v3 = used[v3]!;
        index.push(v0, v1, v2, v0, v2, v3);
      }
    }
    if (index.length === 0) return null;
    const out = { brick, position: new Float32Array(3 * made), normal: new Float32Array(3 * made), tint: new Float32Array(made), index: Uint32Array.from(index) };
    const { origin, step: size } = this.clock;
    for (let v = 0; v < cell.length; ++v) {
      const u = used[v]!;
      if (u < 0) continue;
      const l = Math.sqrt(normal[3 * v]! ** 2 + normal[3 * v + 1]! ** 2 + normal[3 * v + 2]! ** 2) || 1;
      for (let a = 0; a < 3; ++a) { out.position[3 * u + a] = origin[a]! + (first[a]! + place[3 * v + a]!) * size; out.normal[3 * u + a] = normal[3 * v + a]! / l; }
      out.tint[u] = this.wasCut(cell[v]!, first) ? 1 : 0;
    }
    return out;
  }
  private addNormal(normal: Float32Array, p: Float32Array, v0: number, v1: number, v2: number, v3: number): void {
    // Half the cross product of the diagonals is the area of the quad.
    const ax = p[3 * v2]! - p[3 * v0]!, ay = p[3 * v2 + 1]! - p[3 * v0 + 1]!, az = p[3 * v2 + 2]! - p[3 * v0 + 2]!;
    const bx = p[3 * v3]! - p[3 * v1]!, by = p[3 * v3 + 1]! - p[3 * v1 + 1]!, bz = p[3 * v3 + 2]! - p[3 * v1 + 2]!;
    const x = ay * bz - az * by, y = az * bx - ax * bz, z = ax * by - ay * bx;
    for (const v of [v0, v1, v2, v3]) { normal[3 * v]! += x; normal[3 * v + 1]! += y; normal[3 * v + 2]! += z; }
  }
  /** Whether a node of the cell was material once and is none any more. */
  private wasCut(c: number, first: [number, number, number]): boolean {
    const [nx, ny, nz] = this.clock.count, i = c % E, j = Math.floor(c / E) % E, k = Math.floor(c / (E * E));
    for (let q = 0; q < 8; ++q) {
      const x = first[0] + i + (q & 1), y = first[1] + j + (q >> 1 & 1), z = first[2] + k + (q >> 2);
      if (x < 0 || y < 0 || z < 0 || x >= nx || y >= ny || z >= nz) continue;
      const n = (z * ny + y) * nx + x;
      if (!this.solid[n] && this.clock.cut[n] !== 0) return true;
    }
    return false;
  }
}

// SPDX-License-Identifier: Apache-2.0
// Contour lines of values on the nodes of a grid (marching squares). Cells with a node without value have none.
import { niceStep, ticks } from "./format";

export interface Contour { level: number; points: number[]; closed: boolean } // row, column, row, column ...

/** value: rows x columns, column fastest. Where the middle of a cell decides (a saddle), its mean does. */
export function contours(value: ArrayLike<number>, rows: number, columns: number, levels: number[]): Contour[] {
  const out: Contour[] = [];
  for (const level of levels) out.push(...chained(segments(value, rows, columns, level), columns, value, level));
  return out;
}
/** An edge of the grid by its lower node and direction: 2 * node along the column index, 2 * node + 1 along the row index. */
type Segments = Map<number, number[]>; // edge -> edges joined to it (one or two)
function segments(value: ArrayLike<number>, rows: number, columns: number, level: number): Segments {
  const joined: Segments = new Map(), join = (a: number, b: number) => { for (const [p, q] of [[a, b], [b, a]]) { const l = joined.get(p); if (l) l.push(q); else joined.set(p, [q]); } };
  for (let i = 0; i + 1 < rows; ++i) {
    for (let j = 0; j + 1 < columns; ++j) {
      const k = i * columns + j, a = value[k], b = value[k + 1], c = value[k + columns + 1], d = value[k + columns];
      if (!Number.isFinite(a + b + c + d)) continue;
      const bits = (a >= level ? 1 : 0) | (b >= level ? 2 : 0) | (c >= level ? 4 : 0) | (d >= level ? 8 : 0);
      if (bits === 0 || bits === 15) continue;
      const ab = 2 * k, bc = 2 * (k + 1) + 1, dc = 2 * (k + columns), ad = 2 * k + 1;
      if (bits === 5 || bits === 10) {
        const middle = (a + b + c + d) / 4 >= level;
        if ((bits === 5) === middle) { join(ab, bc); join(ad, dc); } else { join(ab, ad); join(bc, dc); }
        continue;
      }
      const crossed: number[] = [];
      if ((a >= level) !== (b >= level)) crossed.push(ab);
      if ((b >= level) !== (c >= level)) crossed.push(bc);
      if ((d >= level) !== (c >= level)) crossed.push(dc);
      if ((a >= level) !== (d >= level)) crossed.push(ad);
      join(crossed[0], crossed[1]);
    }
  }
  return joined;
}
function chained(joined: Segments, columns: number, value: ArrayLike<number>, level: number): Contour[] {
  const out: Contour[] = [], used = new Set<number>();
  const place = (edge: number, points: number[]) => {
    const k = edge >> 1, along = edge & 1 ? columns : 1, i = Math.floor(k / columns), j = k % columns, f = (level - value[k]) / (value[k + along] - value[k]);
    points.push(edge & 1 ? i + f : i, edge & 1 ? j : j + f);
  };
  const walk = (start: number) => {
    const points: number[] = [];
    let at: number | undefined = start, closed = false;
    while (at !== undefined) {
      used.add(at); place(at, points);
      const next: number[] = joined.get(at)!;
      const on: number | undefined = next.find(e => !used.has(e));
      if (on === undefined && points.length > 4 && next.includes(start)) closed = true;
      at = on;
    }
    out.push({ level, points, closed });
  };
  // Ends first, then what is left is closed.
  for (const [edge, next] of joined) if (next.length === 1 && !used.has(edge)) walk(edge);
  for (const edge of joined.keys()) if (!used.has(edge)) walk(edge);
  return out;
}
/** Round levels for about n lines; over decades when the values are. A few extreme values do not take all of them. */
export function levelsFor(value: ArrayLike<number>, n: number): number[] {
  const all = Array.from(value).filter(v => Number.isFinite(v)).sort((a, b) => a - b);
  if (all.length < 4) return [];
  const lo = all[Math.floor(0.02 * (all.length - 1))], hi = all[Math.ceil(0.97 * (all.length - 1))];
  if (!(hi > lo)) return [];
  if (lo > 0 && hi / lo > 12) {
    const decades = Math.log10(hi / lo), out: number[] = [];
    for (const steps of decades * 9 <= n * 1.3 ? [[1, 1.5, 2, 3, 4, 5, 6, 7, 8]] : decades * 5 <= n * 1.3 ? [[1, 1.5, 2, 3, 5, 7]] : decades * 3 <= n * 1.3 ? [[1, 2, 5]] : [[1]])
      for (let p = Math.floor(Math.log10(lo)); p <= Math.log10(hi); ++p) for (const s of steps) { const v = Number((s * 10 ** p).toPrecision(3)); if (v > lo && v < hi) out.push(v); }
    return out;
  }
  return ticks(lo, hi, 1, niceStep((hi - lo) / n)).filter(v => v > lo && v < hi);
}
/** Between the nodes; NaN when one of them has no value. */
export function bilinear(value: ArrayLike<number>, rows: number, columns: number, row: number, column: number): number {
  const i = Math.min(Math.max(0, rows - 2), Math.max(0, Math.floor(row))), j = Math.min(Math.max(0, columns - 2), Math.max(0, Math.floor(column)));
  const f = rows > 1 ? Math.min(1, Math.max(0, row - i)) : 0, g = columns > 1 ? Math.min(1, Math.max(0, column - j)) : 0;
  let sum = 0;
  for (const [di, wi] of [[0, 1 - f], [1, f]]) for (const [dj, wj] of [[0, 1 - g], [1, g]]) if (wi * wj > 0) sum += wi * wj * value[(i + di) * columns + j + dj];
  return sum;
}

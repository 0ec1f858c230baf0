// SPDX-License-Identifier: Apache-2.0
// Many values on few pixels: of every column the first, the smallest, the largest and the last, so that no peak is lost.
import { lastAtMost } from "./motion";

/** x, y pairs to be joined; NaN, NaN where the line is broken. x does not decrease. */
export function decimate(x: ArrayLike<number>, y: ArrayLike<number>, from: number, to: number, columns: number): Float64Array {
  const n = Math.min(x.length, y.length), out: number[] = [];
  if (n === 0 || !(to > from) || columns < 1) return new Float64Array(0);
  // One more on each side: the line goes on beyond the frame.
  const first = x[0] > from ? 0 : lastAtMost(x, from), end = Math.min(n, lastAtMost(x, to) + 2), width = (to - from) / columns;
  if (end - first <= 4 * columns) {
    for (let i = first; i < end; ++i) push(out, x[i], y[i]);
    return Float64Array.from(out);
  }
  let column = -Infinity, lo = -1, hi = -1, a = -1, b = -1;
  const flush = () => {
    if (a < 0) return;
    const seen = [a, Math.min(lo, hi), Math.max(lo, hi), b];
    for (let k = 0; k < 4; ++k) if (k === 0 || seen[k] !== seen[k - 1]) push(out, x[seen[k]], y[seen[k]]);
    a = -1;
  };
  let broken = false;
  for (let i = first; i < end; ++i) {
    const c = Math.floor((x[i] - from) / width);
    if (c !== column) { flush(); if (broken) push(out, NaN, NaN); broken = false; column = c; }
    if (!Number.isFinite(y[i])) { if (a >= 0) flush(); broken = true; continue; }
    if (broken) { push(out, NaN, NaN); broken = false; }
    if (a < 0) { a = lo = hi = b = i; continue; }
    if (y[i] < y[lo]) lo = i;
    if (y[i] > y[hi]) hi = i;
    b = i;
  }
  flush();
  return Float64Array.from(out);
}
function push(out: number[], x: number, y: number): void {
  if (Number.isFinite(y)) { out.push(x, y); return; }
  if (out.length === 0 || !Number.isNaN(out[out.length - 1])) out.push(NaN, NaN);
}
/** Smallest and largest finite value among those with x from `from` to `to`; null: none. */
export function extent(x: ArrayLike<number>, y: ArrayLike<number>, from: number, to: number): [number, number] | null {
  let lo = Infinity, hi = -Infinity;
  const end = Math.min(y.length, lastAtMost(x, to) + 2);
  for (let i = x[0] > from ? 0 : lastAtMost(x, from); i < end; ++i) {
    const v = y[i];
    if (v < lo) lo = v;
    if (v > hi) hi = v;
  }
  return lo <= hi && Number.isFinite(lo) && Number.isFinite(hi) ? [lo, hi] : null;
}

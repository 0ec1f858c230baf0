// SPDX-License-Identifier: Apache-2.0
// What is asked of a path over time: where it is, how long it is, where passes and moves begin.
import type { Path, Vec } from "../scene";
import { Kind } from "../scene";

/** The last row whose value is at most v; 0 before the first. */
export function lastAtMost(sorted: ArrayLike<number>, v: number): number {
  let lo = 0, hi = sorted.length;
  while (lo < hi) {
    const mid = (lo + hi) >> 1;
    if (sorted[mid] <= v) lo = mid + 1; else hi = mid;
  }
  return Math.max(0, lo - 1);
}

export interface Pose { node: number; part: number; tip: Vec; axis: Vec; length: number; rotary: [number, number] | null }

export class Motion {
  readonly duration: number;
  private lengths: Float64Array | null = null;
  private starts: Uint32Array | null = null;
  constructor(readonly path: Path, private center: Vec) { this.duration = path.count > 0 ? path.time[path.count - 1] : 0; }

  nodeAt(time: number): number { return lastAtMost(this.path.time, time); }

  /** Way of the tip up to each node, mm. */
  get length(): Float64Array {
    if (this.lengths) return this.lengths;
    const { count, point } = this.path, out = new Float64Array(count);
    for (let i = 1; i < count; ++i)
      out[i] = out[i - 1] + Math.hypot(point[3 * i] - point[3 * i - 3], point[3 * i + 1] - point[3 * i - 2], point[3 * i + 2] - point[3 * i - 1]);
    return this.lengths = out;
  }

  tip(i: number): Vec { const p = this.path.point; return [p[3 * i] + this.center[0], p[3 * i + 1] + this.center[1], p[3 * i + 2] + this.center[2]]; }
  axis(i: number): Vec { const a = this.path.axis; return a ? [a[3 * i], a[3 * i + 1], a[3 * i + 2]] : [0, 0, 1]; }

  at(time: number): Pose {
    const { path } = this, n = path.count;
    if (n === 0) return { node: 0, part: 0, tip: [0, 0, 0], axis: [0, 0, 1], length: 0, rotary: null };
    const i = this.nodeAt(time), j = Math.min(n - 1, i + 1), dt = path.time[j] - path.time[i];
    const f = dt > 0 ? Math.min(1, Math.max(0, (time - path.time[i]) / dt)) : 0;
    const mix = (a: number, b: number) => a + f * (b - a);
    const p = this.tip(i), q = this.tip(j), a = this.axis(i), b = this.axis(j);
    const axis: Vec = [mix(a[0], b[0]), mix(a[1], b[1]), mix(a[2], b[2])], l = Math.hypot(...axis) || 1;
    const r = path.rotary;
    return {
      node: i, part: f, tip: [mix(p[0], q[0]), mix(p[1], q[1]), mix(p[2], q[2])], axis: [axis[0] / l, axis[1] / l, axis[2] / l],
      length: mix(this.length[i], this.length[j]), rotary: r ? [mix(r[2 * i], r[2 * j]), mix(r[2 * i + 1], r[2 * j + 1])] : null,
    };
  }

  /** First nodes of passes: the group changes, or cutting begins. */
  get passes(): Uint32Array {
    if (this.starts) return this.starts;
    const { count, group, kind } = this.path, out: number[] = [];
    for (let i = 0; i < count; ++i)
      if (i === 0 || group[i] !== group[i - 1] || (kind[i] === Kind.feed && kind[i - 1] !== Kind.feed)) out.push(i);
    return this.starts = Uint32Array.from(out);
  }

  /** The node a step away; direction -1 or 1. Backwards first to the beginning of what one is in. */
  step(from: number, by: "node" | "move" | "pass", direction: number): number {
    const { count, move } = this.path, last = count - 1;
    if (count === 0) return 0;
    if (by === "node") return Math.min(last, Math.max(0, from + direction));
    if (by === "pass") {
      const k = lastAtMost(this.passes, from), p = this.passes;
      if (direction > 0) return k + 1 < p.length ? p[k + 1] : last;
      return p[k] < from ? p[k] : p[Math.max(0, k - 1)];
    }
    let i = from;
    if (direction > 0) { while (i < last && move[i] === move[from]) ++i; return i; }
    i = Math.max(0, from - 1);
    while (i > 0 && move[i - 1] === move[i]) --i;
    return i;
  }
}

// SPDX-License-Identifier: Apache-2.0
// Boxes about runs of items that already lie near each other in their order: ways of a path, triangles along a Morton curve.

const LEAF = 16, FAN = 8;

export class BoxTree {
  /** levels[0] are the leaves; 6 numbers a box: low, high. */
  readonly levels: Float32Array[] = [];
  constructor(readonly count: number, grow: (item: number, box: Float32Array, at: number) => void) {
    let n = Math.ceil(count / LEAF), boxes = blank(n);
    for (let i = 0; i < count; ++i) grow(i, boxes, 6 * Math.floor(i / LEAF));
    this.levels.push(boxes);
    while (n > 1) {
      const m = Math.ceil(n / FAN), next = blank(m);
      for (let i = 0; i < n; ++i) {
        const a = 6 * i, b = 6 * Math.floor(i / FAN);
        for (let c = 0; c < 3; ++c) { next[b + c] = Math.min(next[b + c]!, boxes[a + c]!); next[b + 3 + c] = Math.max(next[b + 3 + c]!, boxes[a + 3 + c]!); }
      }
      this.levels.push(next);
      boxes = next; n = m;
    }
  }
  /** Items in boxes that `near` wants: the nearest boxes (smallest answer) first; an answer of Infinity leaves one out. */
  visit(near: (box: Float32Array, at: number) => number, item: (i: number) => void): void {
    if (this.count === 0) return;
    const top = this.levels.length - 1;
    const walk = (level: number, i: number): void => {
      if (level === 0) { for (let k = i * LEAF; k < Math.min(this.count, (i + 1) * LEAF); ++k) item(k); return; }
      const boxes = this.levels[level - 1]!, end = Math.min(boxes.length / 6, (i + 1) * FAN), order: { d: number; j: number }[] = [];
      for (let j = i * FAN; j < end; ++j) { const d = near(boxes, 6 * j); if (d < Infinity) order.push({ d, j }); }
      order.sort((a, b) => a.d - b.d);
      // Asked again: what was found meanwhile may be nearer than this box.
      for (const { j } of order) if (near(boxes, 6 * j) < Infinity) walk(level - 1, j);
    };
    if (near(this.levels[top]!, 0) < Infinity) walk(top, 0);
  }
}

function blank(n: number): Float32Array {
  const b = new Float32Array(6 * n);
  for (let i = 0; i < b.length; i += 6) { b[i] = b[i + 1] = b[i + 2] = Infinity; b[i + 3] = b[i + 4] = b[i + 5] = -Infinity; }
  return b;
}
export function growBy(box: Float32Array, at: number, point: Float32Array, p: number): void {
  for (let c = 0; c < 3; ++c) { const v = point[p + c]!; if (v < box[at + c]!) box[at + c] = v; if (v > box[at + 3 + c]!) box[at + 3 + c] = v; }
}

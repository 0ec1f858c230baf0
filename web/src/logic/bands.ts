// SPDX-License-Identifier: Apache-2.0
// A strip along time: of each pixel column the kind of move that takes most of it, and the group.
import type { Path } from "../scene";
import { lastAtMost } from "./motion";

export interface Bands { kind: Uint8Array; group: Uint16Array }
export const NO_KIND = 255;
export function bands(path: Path, from: number, to: number, columns: number): Bands {
  const kind = new Uint8Array(columns).fill(NO_KIND), group = new Uint16Array(columns), share = new Float64Array(4);
  if (path.count < 2 || !(to > from)) return { kind, group };
  const width = (to - from) / columns;
  let i = Math.min(path.count - 1, lastAtMost(path.time, from) + 1); // the way that ends at i
  for (let c = 0; c < columns; ++c) {
    const end = from + (c + 1) * width;
    let at = from + c * width, most = 0;
    share.fill(0);
    for (;;) {
      const stop = Math.min(end, path.time[i]), d = stop - at;
      if (d > 0) {
        const k = path.kind[i] & 3;
        share[k] += d;
        if (d > most) { most = d; group[c] = path.group[i]; }
        at = stop;
      }
      if (path.time[i] > end || i + 1 >= path.count) break;
      ++i;
    }
    let best = -1;
    for (let k = 0; k < 4; ++k) if (share[k] > 0 && (best < 0 || share[k] > share[best])) best = k;
    if (best >= 0) kind[c] = best;
  }
  return { kind, group };
}

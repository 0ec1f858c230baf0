// SPDX-License-Identifier: Apache-2.0
import type { Path } from "../scene";
import { Kind } from "../scene";

/** Of each group: its first node (-1: none), its time, the way it cuts. */
export function groupSums(path: Path, length: Float64Array, groups: number): { first: Int32Array; time: Float64Array; cut: Float64Array } {
  const first = new Int32Array(groups).fill(-1), time = new Float64Array(groups), cut = new Float64Array(groups);
  for (let i = 0; i < path.count; ++i) {
    const g = path.group[i];
    if (g >= groups) continue;
    if (first[g] < 0) first[g] = i;
    if (i === 0) continue;
    time[g] += path.time[i] - path.time[i - 1];
    if (path.kind[i] === Kind.feed) cut[g] += length[i] - length[i - 1];
  }
  return { first, time, cut };
}

// SPDX-License-Identifier: Apache-2.0
import type { Histogram } from "../scene";

/** Shares of the area below, within and above the tolerance; a bar that the limit crosses is divided in proportion. */
export function shares(h: Pick<Histogram, "from" | "step" | "area" | "tolerance">): { below: number; within: number; above: number; sum: number } {
  let below = 0, inside = 0, above = 0;
  h.area.forEach((a, i) => {
    const lo = h.from + i * h.step, hi = lo + h.step, part = (p: number, q: number) => h.step > 0 ? Math.max(0, Math.min(hi, q) - Math.max(lo, p)) / h.step : 0;
    below += a * part(-Infinity, -h.tolerance); inside += a * part(-h.tolerance, h.tolerance); above += a * part(h.tolerance, Infinity);
  });
  const sum = below + inside + above;
  return sum > 0 ? { below: below / sum, within: inside / sum, above: above / sum, sum } : { below: 0, within: 0, above: 0, sum: 0 };
}

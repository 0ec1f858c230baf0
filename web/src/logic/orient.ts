// SPDX-License-Identifier: Apache-2.0
// The tool at other angles of the same contact point (docs/orient.md has the angles): tilt from the surface's normal, yaw about it from the feed.
import type { Vec } from "../scene";
import { cross, dot, sum, unit } from "./section";

export interface Standing { tip: Vec; axis: Vec }
const RADIANS = Math.PI / 180;
/** Feed and axis must fit the angles this well (cosine): else the contact point is not that of this pose. */
const FITS = 0.05;

function pose(contact: Vec, n: Vec, f: Vec, tilt: number, yaw: number, radius: number, corner: number): Standing {
  const t = cross(n, f), d = sum([f[0] * Math.cos(yaw), f[1] * Math.cos(yaw), f[2] * Math.cos(yaw)], t, Math.sin(yaw)), s = Math.sin(tilt), c = Math.cos(tilt), axis = sum([n[0] * c, n[1] * c, n[2] * c], d, s);
  return { axis, tip: sum(sum(sum(sum(contact, n, corner), n, (radius - corner) * s), d, -(radius - corner) * c), axis, -corner) };
}
/** Angles in degrees, [tilt, yaw]; null when the pose at hand does not stand at `chosen`. */
export function standingAt(now: Standing, feed: Vec, chosen: [number, number], wanted: [number, number], radius: number, corner: number): Standing | null {
  const [a, b] = chosen.map(v => v * RADIANS), across = sum(now.axis, feed, -dot(now.axis, feed)), w = unit(across);
  if (!w || Math.abs(dot(now.axis, feed) - Math.sin(a) * Math.cos(b)) > FITS) return null;
  // In the plane across the feed the axis stands at `turn` from the normal, towards n x f.
  const turn = Math.atan2(Math.sin(a) * Math.sin(b), Math.cos(a)), n = sum([w[0] * Math.cos(turn), w[1] * Math.cos(turn), w[2] * Math.cos(turn)], cross(w, feed), -Math.sin(turn));
  const back = pose([0, 0, 0], n, feed, a, b, radius, corner), contact = sum(now.tip, back.tip, -1);
  return pose(contact, n, feed, wanted[0] * RADIANS, wanted[1] * RADIANS, radius, corner);
}

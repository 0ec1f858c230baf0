// SPDX-License-Identifier: Apache-2.0
// Where tool and table are between two nodes.
import { Matrix4, Vector3 } from "three";
import type { Machine, Path, Vec } from "../scene";

export interface Pose { tip: Vector3; axis: Vector3; tool: number }

/** `ways`: 2.5 is in the middle of the way from node 2 to node 3. In the stage's coordinates. */
export function poseAt(path: Path, ways: number, out: Pose = { tip: new Vector3(), axis: new Vector3(), tool: 0 }): Pose {
  const last = path.count - 1;
  if (last < 0) { out.tip.set(0, 0, 0); out.axis.set(0, 0, 1); return out; }
  const i = Math.min(last, Math.max(0, Math.floor(ways))), j = Math.min(last, i + 1), f = Math.min(1, Math.max(0, ways - i)), p = path.point;
  out.tip.set(p[3 * i]!, p[3 * i + 1]!, p[3 * i + 2]!);
  out.tip.x += f * (p[3 * j]! - out.tip.x); out.tip.y += f * (p[3 * j + 1]! - out.tip.y); out.tip.z += f * (p[3 * j + 2]! - out.tip.z);
  out.tool = path.tool[f > 0 ? j : i]!;
  const a = path.axis;
  if (!a) out.axis.set(0, 0, 1);
  else {
    from.set(a[3 * i]!, a[3 * i + 1]!, a[3 * i + 2]!); to.set(a[3 * j]!, a[3 * j + 1]!, a[3 * j + 2]!);
    const angle = Math.acos(Math.min(1, Math.max(-1, from.dot(to)))), s = Math.sin(angle);
    // Next to each other the great circle is the line; opposite there is none.
    if (s < 1e-6) out.axis.copy(from).lerp(to, s === 0 && angle > 1 ? 0 : f);
    else out.axis.copy(from).multiplyScalar(Math.sin((1 - f) * angle) / s).addScaledVector(to, Math.sin(f * angle) / s);
    out.axis.normalize();
  }
  return out;
}
const from = new Vector3(), to = new Vector3();

export function rotaryAt(path: Path, ways: number): [number, number] {
  const r = path.rotary, last = path.count - 1;
  if (!r || last < 0) return [0, 0];
  const i = Math.min(last, Math.max(0, Math.floor(ways))), j = Math.min(last, i + 1), f = Math.min(1, Math.max(0, ways - i));
  return [r[2 * i]! + f * (r[2 * j]! - r[2 * i]!), r[2 * i + 1]! + f * (r[2 * j + 1]! - r[2 * i + 1]!)];
}

/** Of the table axes number `first` and after, in the stage's coordinates: part -> machine. */
export function tableMatrix(machine: Machine | null, rotary: [number, number], center: Vec, first = 0): Matrix4 {
  const m = new Matrix4();
  machine?.axes.forEach((axis, k) => {
    if (!axis.table || k < first || k > 1) return;
    point.set(axis.point[0] - center[0], axis.point[1] - center[1], axis.point[2] - center[2]);
    direction.set(...axis.direction).normalize();
    turn.makeRotationAxis(direction, rotary[k]! * Math.PI / 180);
    shift.makeTranslation(point.x, point.y, point.z);
    m.premultiply(shift.clone().multiply(turn).multiply(back.makeTranslation(-point.x, -point.y, -point.z)));
  });
  return m;
}
const point = new Vector3(), direction = new Vector3(), turn = new Matrix4(), shift = new Matrix4(), back = new Matrix4();

// SPDX-License-Identifier: Apache-2.0
// Going to a time or a node: time, node and picked node change together.
import type { Scene } from "./scene";
import type { Store, View } from "./state";
import { Motion } from "./logic/motion";

const motions = new WeakMap<Scene, Motion>();
/** One a scene: it keeps what was computed. */
export function motionOf(scene: Scene): Motion {
  let m = motions.get(scene);
  if (!m) { m = new Motion(scene.path, scene.center); motions.set(scene, m); }
  return m;
}
export function goTime(scene: Scene, store: Store, time: number): void {
  const m = motionOf(scene), t = Math.min(m.duration, Math.max(0, Number.isFinite(time) ? time : 0));
  store.set({ time: t, node: m.nodeAt(t), picked: null, trial: null });
}
export function goNode(scene: Scene, store: Store, node: number): void {
  if (scene.path.count === 0) return;
  const n = Math.min(scene.path.count - 1, Math.max(0, node));
  store.set({ time: scene.path.time[n], node: n, picked: null, trial: null });
}
/** What panels speak of: the picked node, else the current one. */
export const focus = (store: Store): number => store.state.picked ?? store.state.node;
let serial = 0;
export function lookAt(store: Store, at: [number, number, number], span: number): void { store.set({ lookAt: { at, span, serial: ++serial } }); }
export function setView(store: Store, name: View): void { store.set({ view: { name, serial: ++serial } }); }

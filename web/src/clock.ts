// SPDX-License-Identifier: Apache-2.0
// Time: advances while playing, and says which node of the path it is at.
import type { Scene } from "./scene";
import { motionOf } from "./seek";
import type { Store } from "./state";

/** Longest step of a frame, s: a page that slept does not leap. */
const LONGEST_FRAME = 0.5;

export function startClock(scene: Scene, store: Store): void {
  const motion = motionOf(scene), end = motion.duration;
  let last = 0, running = false;
  const tick = (now: number): void => {
    const s = store.state;
    if (!s.playing) { running = false; return; }
    const dt = Math.min(LONGEST_FRAME, Math.max(0, (now - last) / 1000));
    last = now;
    const time = Math.min(end, s.time + dt * s.speed);
    store.set(time >= end ? { time, playing: false } : { time });
    requestAnimationFrame(tick);
  };
  store.on(["playing"], s => {
    if (!s.playing || running) return;
    if (s.time >= end) store.set({ time: 0 });
    running = true; last = performance.now();
    requestAnimationFrame(tick);
  });
  store.on(["time"], s => {
    const time = Number.isFinite(s.time) ? Math.min(end, Math.max(0, s.time)) : 0;
    // Several nodes may have one time: who went to a node stays there.
    store.set({ time, node: scene.path.time[s.node] === time ? s.node : motion.nodeAt(time) });
  });
}

// SPDX-License-Identifier: Apache-2.0
// Time: advances while playing, and says which node of the path it is at.
import type { Scene } from "./scene";
import type { Store } from "./state";

/** Longest step of a frame, s: a page that slept does not leap. */
const LONGEST_FRAME = 0.5;

/** The last node whose time is not after t. */
export function nodeAt(time: Float64Array, t: number): number {
  let lo = 0, hi = time.length;
  while (lo < hi) { const mid = (lo + hi) >> 1; if (time[mid]! <= t) lo = mid + 1; else hi = mid; }
  return Math.max(0, lo - 1);
}

export function endTime(scene: Scene): number { return scene.path.count > 0 ? scene.path.time[scene.path.count - 1]! : 0; }

export function startClock(scene: Scene, store: Store): void {
  const end = endTime(scene);
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
    store.set({ time, node: nodeAt(scene.path.time, time) });
  });
}

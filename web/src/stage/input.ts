// SPDX-License-Identifier: Apache-2.0
// Mouse, pen, fingers and keys on the canvas -> the camera, clicks, the place under the cursor.
import type { View } from "./view";

export interface Inputs {
  click(x: number, y: number, touch: boolean): void; // CSS pixels of the canvas
  hover(x: number, y: number): void;
  leave(): void;
  /** Before an orbit begins. */
  orbitFrom(x: number, y: number): void;
  changed(): void;
}

const CLICK_PIXELS = 5;
const WHEEL = 0.0015; // per pixel of the wheel
const KEY_PIXELS = 40;

/** A flat job is moved with the left button and turned with the right one, others the other way round. */
export function listen(canvas: HTMLElement, view: View, on: Inputs): void {
  const down = new Map<number, { x: number; y: number }>();
  let start = { x: 0, y: 0 }, moved = false, pan = false;
  const place = (e: PointerEvent | WheelEvent): { x: number; y: number } => { const r = canvas.getBoundingClientRect(); return { x: e.clientX - r.left, y: e.clientY - r.top }; };
  const share = (p: { x: number; y: number }): [number, number] => [2 * p.x / canvas.clientWidth - 1, 1 - 2 * p.y / canvas.clientHeight];
  const middle = (): { x: number; y: number; size: number } => {
    const [a, b] = [...down.values()];
    return { x: (a!.x + b!.x) / 2, y: (a!.y + b!.y) / 2, size: Math.max(1, Math.hypot(a!.x - b!.x, a!.y - b!.y)) };
  };
  canvas.addEventListener("pointerdown", e => {
    canvas.setPointerCapture(e.pointerId);
    const p = place(e);
    down.set(e.pointerId, p);
    if (down.size > 1) { moved = true; return; }
    start = p; moved = false;
    const other = e.button !== 0 || e.shiftKey || e.ctrlKey || e.metaKey;
    pan = view.flat ? !other : other;
  });
  canvas.addEventListener("pointermove", e => {
    const p = place(e), last = down.get(e.pointerId);
    if (!last) { on.hover(p.x, p.y); return; }
    if (down.size >= 2) {
      const before = middle();
      down.set(e.pointerId, p);
      const after = middle();
      view.pan(after.x - before.x, after.y - before.y);
      view.zoom(before.size / after.size, ...share(after));
      on.changed();
      return;
    }
    if (!moved && Math.hypot(p.x - start.x, p.y - start.y) < CLICK_PIXELS) return;
    if (!moved) { moved = true; canvas.classList.add("drag"); if (!pan) on.orbitFrom(start.x, start.y); }
    if (pan) view.pan(p.x - last.x, p.y - last.y); else view.orbit(p.x - last.x, p.y - last.y);
    down.set(e.pointerId, p);
    on.changed();
  });
  const up = (e: PointerEvent): void => {
    const one = down.size === 1 && down.has(e.pointerId);
    down.delete(e.pointerId);
    canvas.classList.remove("drag");
    if (one && !moved && e.type === "pointerup" && e.button === 0) on.click(start.x, start.y, e.pointerType === "touch");
  };
  canvas.addEventListener("pointerup", up);
  canvas.addEventListener("pointercancel", up);
  canvas.addEventListener("pointerleave", () => on.leave());
  canvas.addEventListener("contextmenu", e => e.preventDefault());
  canvas.addEventListener("dblclick", () => { view.fit(); on.changed(); });
  canvas.addEventListener("wheel", e => {
    e.preventDefault();
    const lines = e.deltaMode === 1 ? 16 : e.deltaMode === 2 ? 400 : 1;
    view.zoom(Math.exp(Math.max(-200, Math.min(200, e.deltaY * lines)) * WHEEL * (e.ctrlKey ? 4 : 1)), ...share(place(e)));
    on.changed();
  }, { passive: false });
  // Arrows alone belong to the timeline.
  canvas.addEventListener("keydown", e => {
    const arrow = ({ ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] } as Record<string, [number, number]>)[e.key];
    if (arrow && e.shiftKey) view.orbit(-arrow[0] * KEY_PIXELS, -arrow[1] * KEY_PIXELS);
    else if (arrow && e.altKey) view.pan(-arrow[0] * KEY_PIXELS, -arrow[1] * KEY_PIXELS);
    else if (e.key === "+" || e.key === "=") view.zoom(0.8);
    else if (e.key === "-") view.zoom(1.25);
    else return;
    e.preventDefault(); e.stopPropagation();
    on.changed();
  });
}

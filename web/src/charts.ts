// SPDX-License-Identifier: Apache-2.0
// A value over time, way or nodes: drawn once, the cursor moves over it. Wheel zooms about the pointer, a drag moves,
// a double click shows all; charts of one range move together.
import { decimate, extent } from "./logic/decimate";
import { ANGLE_STEPS, brief, duration, niceStep, stepOf, ticks, TIME_STEPS } from "./logic/format";
import { lastAtMost } from "./logic/motion";
import { el, sheet, themed, within } from "./ui";
import type { Sheet } from "./ui";

/** What part of x is seen, by several charts at once. */
export class Range {
  from: number; to: number;
  private told: (() => void)[] = [];
  constructor(public lo: number, public hi: number) { if (!(hi > lo)) this.hi = lo + 1; this.from = this.lo; this.to = this.hi; }
  on(call: () => void): void { this.told.push(call); }
  reset(lo = this.lo, hi = this.hi): void { this.lo = lo; this.hi = hi > lo ? hi : lo + 1; this.set(this.lo, this.hi); }
  set(from: number, to: number): void {
    const all = this.hi - this.lo, w = Math.min(all, Math.max(all * 1e-6, to - from));
    this.from = Math.min(Math.max(this.lo, from), this.hi - w); this.to = this.from + w;
    for (const t of this.told) t();
  }
  zoom(factor: number, about: number): void {
    const w = Math.min(this.hi - this.lo, (this.to - this.from) * factor), f = (about - this.from) / (this.to - this.from);
    this.set(about - f * w, about - f * w + w);
  }
}
/** step: a value of the way that ends there, not of the place. */
export interface Line { y: ArrayLike<number>; colour: string; dash?: boolean; step?: boolean; name?: string }
export interface ChartOptions {
  name: string; unit: string; range: Range;
  x: () => ArrayLike<number>; xKind: () => "time" | "length" | "node";
  lines: Line[]; zero?: boolean; // 0 belongs on the sheet
  limits?: number[]; // drawn across
  degrees?: boolean;
  at: () => number; // x of the current time
  go: (x: number) => void;
}
export const MARGIN = { left: 52, right: 12, top: 6, bottom: 20 };

export class Chart {
  readonly box: HTMLElement;
  private plot = el("div", { class: "chart plain" }); private cursor = el("i", { class: "cursor" }); private ghost = el("i", { class: "cursor ghost" }); private value = el("span", { class: "nums soft" });
  private again: () => void;
  private hover: number | null = null;
  constructor(private o: ChartOptions) {
    const canvas = el("canvas", { "aria-hidden": "true" });
    this.plot.append(canvas, this.ghost, this.cursor);
    this.plot.tabIndex = 0; this.plot.setAttribute("role", "slider"); this.plot.setAttribute("aria-label", `${o.name} over time`);
    this.box = el("div", {}, el("div", { class: "chart-head" }, ...(o.lines.length > 1 ? o.lines.map(l => { const b = el("b", {}, l.name ?? ""); b.style.color = `var(--${l.colour})`; return b; }) : [el("b", {}, o.name)]), o.unit && el("span", { class: "soft" }, o.unit), this.value), this.plot);
    this.again = sheet(canvas, s => this.draw(s)).again;
    o.range.on(() => { this.again(); this.place(); });
    new ResizeObserver(() => this.place()).observe(this.plot);
    this.input();
  }
  redraw(): void { this.again(); this.place(); }
  private get wide(): number { return Math.max(1, this.plot.clientWidth - MARGIN.left - MARGIN.right); }
  private px(x: number): number { return MARGIN.left + (x - this.o.range.from) / (this.o.range.to - this.o.range.from) * this.wide; }
  private xAt(px: number): number { return this.o.range.from + (px - MARGIN.left) / this.wide * (this.o.range.to - this.o.range.from); }
  /** The row whose way holds x. */
  private rowAt(x: number): number {
    const xs = this.o.x(), i = lastAtMost(xs, x);
    return xs[i] < x && i + 1 < xs.length ? i + 1 : i;
  }
  place(): void {
    if (this.plot.clientWidth === 0) return;
    const x = this.o.at(), p = this.px(x), seen = p >= MARGIN.left - 1 && p <= MARGIN.left + this.wide + 1;
    this.cursor.hidden = !seen; this.cursor.style.transform = `translateX(${p.toFixed(1)}px)`;
    const row = this.rowAt(this.hover ?? x), text = this.o.lines.map(l => brief(l.y[row])).join(", ");
    if (this.value.textContent !== text) this.value.textContent = text;
    this.plot.setAttribute("aria-valuenow", x.toFixed(3)); this.plot.setAttribute("aria-valuetext", `${text} ${this.o.unit}`);
  }
  private draw({ g, w, h }: Sheet): void {
    const { range, lines } = this.o, x = this.o.x(), top = MARGIN.top, bottom = h - MARGIN.bottom, right = w - MARGIN.right;
    let lo = Infinity, hi = -Infinity;
    for (const l of lines) { const e = extent(x, l.y, range.from, range.to); if (e) { lo = Math.min(lo, e[0]); hi = Math.max(hi, e[1]); } }
    g.textAlign = "center"; g.fillStyle = themed("soft");
    if (!(lo <= hi)) { g.fillText("no values here", w / 2, h / 2); return; }
    if (this.o.zero) { lo = Math.min(0, lo); hi = Math.max(0, hi); }
    for (const v of this.o.limits ?? []) if (v > lo - (hi - lo) && v < hi + (hi - lo)) { lo = Math.min(lo, v); hi = Math.max(hi, v); }
    const pad = (hi - lo || Math.abs(hi) * 0.1 || 1) * 0.06;
    if (!(this.o.zero && lo === 0)) lo -= pad;
    hi += pad;
    const sy = (v: number) => bottom - (v - lo) / (hi - lo) * (bottom - top);
    g.lineWidth = 1; g.strokeStyle = themed("grid"); g.textAlign = "right";
    const each = (hi - lo) / ((bottom - top) / 24);
    for (const v of ticks(lo, hi, 1, this.o.degrees ? stepOf(each, ANGLE_STEPS) : niceStep(each))) {
      const y = Math.round(sy(v)) + 0.5;
      g.beginPath(); g.moveTo(MARGIN.left, y); g.lineTo(right, y); g.stroke(); g.fillText(brief(v), MARGIN.left - 6, y);
    }
    xTicks(g, range.from, range.to, this.o.xKind(), this.px.bind(this), bottom, right);
    g.save(); g.beginPath(); g.rect(MARGIN.left, 0, right - MARGIN.left, bottom + 1); g.clip();
    if (lo < 0 && hi > 0) { g.strokeStyle = themed("soft"); g.beginPath(); g.moveTo(MARGIN.left, Math.round(sy(0)) + 0.5); g.lineTo(right, Math.round(sy(0)) + 0.5); g.stroke(); }
    g.setLineDash([5, 4]); g.strokeStyle = themed("warn");
    for (const v of this.o.limits ?? []) { g.beginPath(); g.moveTo(MARGIN.left, sy(v)); g.lineTo(right, sy(v)); g.stroke(); }
    for (const l of lines) {
      g.setLineDash(l.dash ? [4, 3] : []); g.strokeStyle = themed(l.colour); g.lineWidth = 1.4;
      const q = decimate(x, l.y, range.from, range.to, Math.ceil(right - MARGIN.left));
      g.beginPath();
      for (let i = 0, pen = false; i < q.length; i += 2) {
        if (Number.isNaN(q[i + 1])) { pen = false; continue; }
        const px = this.px(q[i]), py = sy(q[i + 1]);
        if (pen) { if (l.step) g.lineTo(this.px(q[i - 2]), py); g.lineTo(px, py); } else { g.moveTo(px, py); if (i + 3 >= q.length || Number.isNaN(q[i + 3])) g.lineTo(px + 1.5, py); } // a lonely value is a dot
        pen = true;
      }
      g.stroke();
    }
    g.restore(); g.setLineDash([]);
    g.strokeStyle = themed("line"); g.lineWidth = 1; g.beginPath(); g.moveTo(MARGIN.left, bottom + 0.5); g.lineTo(right, bottom + 0.5); g.stroke();
  }
  private input(): void {
    const { range } = this.o, p = this.plot;
    let from: { x: number; at: [number, number]; moved: boolean } | null = null;
    p.addEventListener("pointerdown", e => { if (e.button === 0) { p.setPointerCapture(e.pointerId); from = { x: e.clientX, at: [range.from, range.to], moved: false }; } });
    p.addEventListener("pointermove", e => {
      const x = within(e, p).x;
      if (from && Math.abs(e.clientX - from.x) > 4) from.moved = true;
      if (from?.moved) { const d = (from.x - e.clientX) / this.wide * (from.at[1] - from.at[0]); range.set(from.at[0] + d, from.at[1] + d); }
      this.hover = Math.min(range.to, Math.max(range.from, this.xAt(x)));
      this.ghost.classList.add("on"); this.ghost.style.transform = `translateX(${this.px(this.hover).toFixed(1)}px)`;
      this.place();
    });
    p.addEventListener("pointerup", e => { if (from && !from.moved) this.o.go(Math.min(range.hi, Math.max(range.lo, this.xAt(within(e, p).x)))); from = null; });
    p.addEventListener("pointercancel", () => { from = null; });
    p.addEventListener("pointerleave", () => { this.hover = null; this.ghost.classList.remove("on"); this.place(); });
    p.addEventListener("dblclick", () => range.reset());
    p.addEventListener("wheel", e => {
      const sideways = Math.abs(e.deltaX) > Math.abs(e.deltaY) || e.shiftKey;
      e.preventDefault();
      if (sideways) { const d = (e.deltaX || e.deltaY) / this.wide * (range.to - range.from); range.set(range.from + d, range.to + d); }
      else range.zoom(Math.exp(Math.min(300, Math.max(-300, e.deltaY)) * 0.002), Math.min(range.to, Math.max(range.from, this.xAt(within(e, p).x))));
    }, { passive: false });
    p.addEventListener("keydown", e => {
      const w = range.to - range.from, act: Record<string, () => void> = {
        ArrowRight: () => this.o.go(this.o.at() + w / 200), ArrowLeft: () => this.o.go(this.o.at() - w / 200), "+": () => range.zoom(0.7, this.o.at()), "=": () => range.zoom(0.7, this.o.at()), "-": () => range.zoom(1 / 0.7, this.o.at()),
        PageUp: () => range.set(range.from + w * 0.8, range.to + w * 0.8), PageDown: () => range.set(range.from - w * 0.8, range.to - w * 0.8), Home: () => range.reset() };
      if (!act[e.key] || e.ctrlKey || e.altKey || e.metaKey || e.shiftKey) return;
      e.preventDefault(); e.stopPropagation(); act[e.key]();
    });
  }
}
/** Marks below an axis of time ("1:30"), way (mm) or nodes. */
export function xTicks(g: CanvasRenderingContext2D, from: number, to: number, kind: "time" | "length" | "node", px: (x: number) => number, bottom: number, right: number): void {
  g.fillStyle = themed("soft"); g.textAlign = "center";
  const raw = (to - from) / Math.max(1, (right - MARGIN.left) / 74), step = kind === "time" ? stepOf(raw, TIME_STEPS) : undefined, digits = kind === "time" && step! < 1 ? Math.min(3, Math.ceil(-Math.log10(step!))) : 0;
  g.strokeStyle = themed("grid");
  for (const v of step ? ticks(from, to, 1, step) : ticks(from, to, (right - MARGIN.left) / 74)) {
    const x = Math.round(px(v)) + 0.5;
    g.beginPath(); g.moveTo(x, MARGIN.top); g.lineTo(x, bottom); g.stroke();
    if (x > MARGIN.left - 4 && x < right - 14) g.fillText(kind === "time" ? duration(v, digits) : brief(v), x, bottom + 10);
  }
}

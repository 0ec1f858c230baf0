// SPDX-License-Identifier: Apache-2.0
// Tilt and yaw of a contact point: what is free and why not, contours of the effective radius, the angles chosen.
import type { Panel } from "../panels";
import type { CSpace, Scene } from "../scene";
import type { Store } from "../state";
import { isDark } from "../colours";
import { bilinear, contours, levelsFor } from "../logic/contours";
import type { Contour } from "../logic/contours";
import { ANGLE_STEPS, brief, fixed, stepOf, ticks } from "../logic/format";
import { standingAt } from "../logic/orient";
import { feedAt } from "../logic/section";
import { focus, goNode, motionOf } from "../seek";
import { el, haloed, sheet, themed, within } from "../ui";

const LEFT = 44, RIGHT = 12, TOP = 10, BOTTOM = 36;
// Of the causes in their order, the first is "free". Pale: contours and marks stand over them.
const LIGHT = ["#eef6ef", "#e5918c", "#f6c876", "#baaede", "#cfd5dc", "#9fcbe0", "#dcb98c", "#e3a7cd"], DARK = ["#24332b", "#84403f", "#84602a", "#564b80", "#39424e", "#2f5a70", "#6b4f2c", "#71405f"];
const causeColour = (k: number, dark: boolean): string => (dark ? DARK : LIGHT)[k < 8 ? k : 1 + (k - 1) % 7];

/** The map at the node, or the nearest along the path. */
export function nearestMap(sorted: { node: number; index: number }[], node: number): number {
  let k = 0;
  for (let lo = 0, hi = sorted.length; lo < hi;) { const mid = (lo + hi) >> 1; if (sorted[mid].node <= node) { k = mid; lo = mid + 1; } else hi = mid; }
  const a = sorted[k], b = sorted[Math.min(sorted.length - 1, k + 1)];
  return Math.abs(b.node - node) < Math.abs(a.node - node) ? b.index : a.index;
}
const deg = (v: number): string => `${fixed(v, 2)}\u00b0`;

class Map2 {
  readonly box: HTMLElement;
  readonly out = el("div", { class: "readout", "aria-live": "polite" });
  private again: () => void;
  private map: CSpace | null = null; private lines: Contour[] = []; private mark: [number, number] | null = null; private held = false;
  constructor(private scene: Scene, private store: Store) {
    const canvas = el("canvas", { "aria-hidden": "true" });
    this.box = el("div", { class: "map", tabindex: 0, role: "application", "aria-label": "Tilt and yaw of the contact point. Arrow keys move the mark, Escape takes it away" }, canvas);
    this.box.style.cssText = "cursor:crosshair;touch-action:pan-y";
    this.again = sheet(canvas, ({ g, w, h }) => this.draw(g, w, h)).again;
    store.on(["theme"], () => this.again());
    store.on(["trial"], s => { if (!s.trial && this.mark && !this.held) { this.mark = null; this.say(); this.again(); } });
    const take = (e: PointerEvent) => { const p = within(e, this.box); this.put(this.tiltAt(p.x), this.yawAt(p.y)); };
    this.box.addEventListener("pointerdown", e => { if (e.button === 0) { this.held = true; this.box.setPointerCapture(e.pointerId); take(e); } });
    this.box.addEventListener("pointermove", e => { if (this.held) take(e); });
    for (const end of ["pointerup", "pointercancel"]) this.box.addEventListener(end, () => { this.held = false; });
    this.box.addEventListener("keydown", e => {
      const m = this.map, d: Record<string, [number, number]> = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
      if (!m || e.ctrlKey || e.altKey || e.metaKey) return;
      if (e.key === "Escape" && this.mark) this.unmark();
      else if (d[e.key]) { const [t, y] = this.mark ?? m.chosen; this.put(t + d[e.key][0] * (m.tilt[1] - m.tilt[0]) / 100, y + d[e.key][1] * (m.yaw[1] - m.yaw[0]) / 100); }
      else return;
      e.preventDefault(); e.stopPropagation(); this.say(); this.again();
    });
  }
  set(map: CSpace): void {
    if (map === this.map) return;
    this.map = map; this.unmark();
    this.lines = map.radius ? contours(map.radius, map.tilts, map.yaws, levelsFor(map.radius, 9)) : [];
    this.say(); this.again();
  }
  private tiltAt(px: number): number { const m = this.map!; return m.tilt[0] + (px - LEFT) / Math.max(1, this.box.clientWidth - LEFT - RIGHT) * (m.tilt[1] - m.tilt[0]); }
  private yawAt(py: number): number { const m = this.map!; return m.yaw[1] - (py - TOP) / Math.max(1, this.box.clientHeight - TOP - BOTTOM) * (m.yaw[1] - m.yaw[0]); }
  private put(tilt: number, yaw: number): void {
    const m = this.map;
    if (!m) return;
    this.mark = [Math.min(m.tilt[1], Math.max(m.tilt[0], tilt)), Math.min(m.yaw[1], Math.max(m.yaw[0], yaw))];
    this.stand(this.mark);
    this.say(); this.again();
  }
  private unmark(): void { this.mark = null; if (this.store.state.trial) this.store.set({ trial: null }); }
  /** Shows the tool at those angles, when it stands at the point of the map and its shape is known. */
  private stand(angles: [number, number]): void {
    const { scene, store, map: m } = this, n = focus(store), cutter = scene.tools[scene.path.tool[n]]?.pieces.find(p => p.kind === 0);
    if (!m || m.node !== n || !cutter) return;
    const motion = motionOf(scene), feed = feedAt(scene.path, n), at = feed && standingAt({ tip: motion.tip(n), axis: motion.axis(n) }, feed, m.chosen, angles, cutter.radius, cutter.corner);
    store.set({ trial: at || null, playing: false });
  }
  /** Row and column of the grid, with their parts. */
  private grid([tilt, yaw]: [number, number]): [number, number] {
    const m = this.map!, f = (v: number, [a, b]: [number, number], n: number) => b > a && n > 1 ? Math.min(n - 1, Math.max(0, (v - a) / (b - a) * (n - 1))) : 0;
    return [f(tilt, m.tilt, m.tilts), f(yaw, m.yaw, m.yaws)];
  }
  private cause(at: [number, number]): string {
    const m = this.map!, [r, c] = this.grid(at);
    return this.scene.causes[m.cause[Math.round(r) * m.yaws + Math.round(c)]] ?? "?";
  }
  private radius(at: [number, number]): string {
    const m = this.map!;
    if (!m.radius) return "";
    const v = bilinear(m.radius, m.tilts, m.yaws, ...this.grid(at));
    return Number.isFinite(v) ? `, effective radius ${brief(v)} mm` : "";
  }
  private say(): void {
    const m = this.map;
    if (!m) return;
    const line = (name: string, at: [number, number]) => [el("b", {}, name), ` tilt ${deg(at[0])}, yaw ${deg(at[1])}${this.radius(at)}`];
    this.out.replaceChildren(el("div", {}, el("b", {}, m.label || `node ${m.node}`)), el("div", {}, ...line("chosen", m.chosen)));
    if (m.initial) this.out.append(el("div", {}, ...line("initial", m.initial)));
    this.out.append(el("div", { class: this.mark ? "" : "soft" }, ...(this.mark ? [...line("there", this.mark), `: ${this.cause(this.mark)}`] : ["A click shows the angles and the cause there, and the tool when it stands at this point."])));
  }
  private draw(g: CanvasRenderingContext2D, w: number, h: number): void {
    const m = this.map;
    if (!m || m.tilts < 1 || m.yaws < 1) return;
    const right = w - RIGHT, bottom = h - BOTTOM, dark = isDark(this.store.state), wide = right - LEFT, high = bottom - TOP;
    const x = (t: number) => LEFT + (t - m.tilt[0]) / (m.tilt[1] - m.tilt[0] || 1) * wide, y = (v: number) => bottom - (v - m.yaw[0]) / (m.yaw[1] - m.yaw[0] || 1) * high;
    g.save(); g.beginPath(); g.rect(LEFT, TOP, wide, high); g.clip();
    const dx = wide / Math.max(1, m.tilts - 1), dy = high / Math.max(1, m.yaws - 1);
    for (let i = 0; i < m.tilts; ++i) for (let j = 0, begin = 0; j < m.yaws; ++j) {
      if (j + 1 < m.yaws && m.cause[i * m.yaws + j + 1] === m.cause[i * m.yaws + begin]) continue; // one rectangle for what is equal
      g.fillStyle = causeColour(m.cause[i * m.yaws + begin], dark);
      g.fillRect(LEFT + (i - 0.5) * dx - 0.3, bottom - (j + 0.5) * dy - 0.3, dx + 0.6, (j - begin + 1) * dy + 0.6);
      begin = j + 1;
    }
    g.strokeStyle = themed("ink"); g.globalAlpha = 0.75; g.lineWidth = 1;
    const gx = (i: number) => LEFT + i * dx, gy = (j: number) => bottom - j * dy;
    for (const c of this.lines) {
      g.beginPath();
      for (let k = 0; k < c.points.length; k += 2) if (k === 0) g.moveTo(gx(c.points[0]), gy(c.points[1])); else g.lineTo(gx(c.points[k]), gy(c.points[k + 1]));
      if (c.closed) g.closePath();
      g.stroke();
    }
    g.globalAlpha = 1; g.textAlign = "center";
    const labels: [number, number][] = [];
    for (const c of this.lines) {
      const n = c.points.length / 2;
      if (n < 6) continue;
      // The first place along the line, from its middle on, that keeps away from other labels.
      for (let s = 0; s < n; s += 2) {
        const k = (Math.floor(n / 2) + (s & 2 ? s : -s) / 2 + n) % n, px = gx(c.points[2 * k]), py = gy(c.points[2 * k + 1]);
        if (px < LEFT + 16 || px > right - 16 || py < TOP + 9 || py > bottom - 9 || labels.some(q => Math.abs(q[0] - px) < 40 && Math.abs(q[1] - py) < 15)) continue;
        labels.push([px, py]); haloed(g, brief(c.level), px, py, themed("ink"), themed("panel"));
        break;
      }
    }
    g.restore();
    g.strokeStyle = themed("line"); g.lineWidth = 1; g.strokeRect(LEFT + 0.5, TOP + 0.5, wide - 1, high - 1);
    g.fillStyle = themed("soft"); g.strokeStyle = themed("soft");
    for (const t of ticks(m.tilt[0], m.tilt[1], 1, stepOf((m.tilt[1] - m.tilt[0]) / (wide / 46), ANGLE_STEPS))) { g.beginPath(); g.moveTo(x(t), bottom); g.lineTo(x(t), bottom + 4); g.stroke(); g.fillText(`${t}\u00b0`, x(t), bottom + 12); }
    g.fillText("tilt", LEFT + wide / 2, bottom + 27);
    g.textAlign = "right";
    for (const t of ticks(m.yaw[0], m.yaw[1], 1, stepOf((m.yaw[1] - m.yaw[0]) / (high / 32), ANGLE_STEPS))) { g.beginPath(); g.moveTo(LEFT - 4, y(t)); g.lineTo(LEFT, y(t)); g.stroke(); g.fillText(`${t}\u00b0`, LEFT - 6, y(t)); }
    g.save(); g.translate(8, TOP + high / 2); g.rotate(-Math.PI / 2); g.textAlign = "center"; g.fillText("yaw", 0, 0); g.restore();
    if (m.initial) { g.strokeStyle = themed("accent"); g.lineWidth = 2.5; g.beginPath(); g.arc(x(m.initial[0]), y(m.initial[1]), 6, 0, 7); g.stroke(); }
    g.fillStyle = themed("hit"); g.strokeStyle = themed("panel"); g.lineWidth = 1.5; g.beginPath(); g.arc(x(m.chosen[0]), y(m.chosen[1]), 5, 0, 7); g.fill(); g.stroke();
    if (this.mark) {
      const px = x(this.mark[0]), py = y(this.mark[1]);
      g.strokeStyle = themed("ink"); g.lineWidth = 1.2; g.beginPath(); g.moveTo(px - 9, py); g.lineTo(px + 9, py); g.moveTo(px, py - 9); g.lineTo(px, py + 9); g.stroke();
    }
  }
}

export const anglesPanel: Panel = {
  id: "angles", title: "Angles",
  make(scene: Scene, store: Store): HTMLElement | null {
    if (scene.cspaces.length === 0) return null;
    const sorted = scene.cspaces.map((c, index) => ({ node: c.node, index })).sort((a, b) => a.node - b.node), map = new Map2(scene, store);
    const legend = el("div", { class: "keys" }), body = el("tbody"), rows = new Map<number, HTMLElement>();
    const used = new Set<number>();
    for (const c of scene.cspaces.slice(0, 400)) for (const k of c.cause) used.add(k);
    const item = (cls: string, colour: string, name: string) => { const i = el("i", { class: cls }); i.style.color = colour; return el("span", { class: "item" }, i, name); };
    const fillLegend = () => {
      legend.replaceChildren(...[...used].sort((a, b) => a - b).map(k => item("cell", causeColour(k, isDark(store.state)), scene.causes[k] ?? `cause ${k}`)));
      if (scene.cspaces.some(c => c.radius)) legend.append(item("", "var(--ink)", "effective radius, mm"));
      legend.append(item("dot", "var(--hit)", "chosen"));
      if (scene.cspaces.some(c => c.initial)) legend.append(item("ring", "var(--accent)", "initial"));
    };
    let shown = -1, filled = 0;
    const lower = el("div", { class: "lower" }, el("table", { class: "list" }, el("thead", {}, el("tr", {}, ...["point", "tilt", "yaw", "radius mm"].map(t => el("th", {}, t)))), body));
    const more = () => {
      for (const end = Math.min(sorted.length, filled + 200); filled < end; ++filled) {
        const { index } = sorted[filled], c = scene.cspaces[index], span = (a: number, [lo, hi]: [number, number], n: number) => hi > lo ? (a - lo) / (hi - lo) * (n - 1) : 0;
        const radius = c.radius ? bilinear(c.radius, c.tilts, c.yaws, span(c.chosen[0], c.tilt, c.tilts), span(c.chosen[1], c.yaw, c.yaws)) : NaN, go = () => { goNode(scene, store, c.node); store.set({ picked: c.node, playing: false }); };
        const tr = el("tr", { tabindex: 0, onclick: go }, el("td", {}, c.label || `node ${c.node}`), el("td", {}, deg(c.chosen[0])), el("td", {}, deg(c.chosen[1])), el("td", {}, Number.isFinite(radius) ? brief(radius) : "-"));
        tr.addEventListener("keydown", e => { if (e.key === "Enter") go(); });
        rows.set(index, tr); body.append(tr);
      }
    };
    const show = () => {
      const k = nearestMap(sorted, focus(store));
      if (k === shown) return;
      rows.get(shown)?.classList.remove("on");
      shown = k; map.set(scene.cspaces[k]);
      const place = sorted.findIndex(s => s.index === k);
      while (filled <= place && filled < sorted.length) more();
      const tr = rows.get(k);
      tr?.classList.add("on");
      if (tr && lower.clientHeight > 0 && (tr.offsetTop < lower.scrollTop + 30 || tr.offsetTop > lower.scrollTop + lower.clientHeight - 30)) lower.scrollTop = tr.offsetTop - lower.clientHeight / 2;
    };
    lower.addEventListener("scroll", () => { if (lower.scrollTop + lower.clientHeight > lower.scrollHeight - 300) more(); });
    more(); fillLegend(); show();
    store.on(["node", "picked"], show); store.on(["theme"], fillLegend);
    return el("div", { class: "column" }, map.box, legend, map.out, lower);
  },
};

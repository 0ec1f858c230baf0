// SPDX-License-Identifier: Apache-2.0
// Series, feed, heights and rotary axes over time, way or nodes, their cursor at the time.
import { Chart, Range } from "../charts";
import type { Line } from "../charts";
import type { Panel } from "../panels";
import type { Scene } from "../scene";
import type { Store } from "../state";
import { lastAtMost } from "../logic/motion";
import { goTime, motionOf } from "../seek";
import { button, check, choice, el } from "../ui";

/** Of several lines in one chart (style.css). */
const COLOURS = ["accent", "warn", "good", "hit", "soft", "bad"];
interface Source { id: string; name: string; unit: string; zero: boolean; degrees: boolean; on: boolean; lines: () => Line[] }
/** Every `of`-th number from `first` on: a column of rows. */
function column(rows: Float32Array, first: number, of: number, add: number): Float32Array {
  const out = new Float32Array(Math.floor(rows.length / of));
  for (let i = 0; i < out.length; ++i) out[i] = rows[of * i + first] + add;
  return out;
}
function sources(scene: Scene): Source[] {
  const { path } = scene, list: Source[] = [], once = (make: () => Line[]) => { let l: Line[] | null = null; return () => l ??= make(); };
  scene.series.forEach((s, k) => list.push({ id: `series:${k}`, name: s.name, unit: s.unit, zero: s.signed, degrees: false, on: k < 3, lines: () => [{ y: s.value, colour: "accent" }] }));
  if (path.feed.some(f => f > 0)) list.push({ id: "feed", name: "Feed", unit: "mm/min", zero: true, degrees: false, on: list.length < 2, lines: () => [{ y: path.feed, colour: "accent", step: true }] });
  ["X", "Y", "Z"].forEach((n, k) => list.push({ id: n, name: n, unit: "mm", zero: false, degrees: false, on: n === "Z" && list.length < 3, lines: once(() => [{ y: column(path.point, k, 3, scene.center[k]), colour: "accent" }]) }));
  if (path.rotary) for (const k of [0, 1]) list.push({ id: `r${k}`, name: `${scene.machine?.axes[k]?.letter ?? "AC"[k]} axis`, unit: "\u00b0", zero: false, degrees: true, on: list.length < 6, lines: once(() => [{ y: column(path.rotary!, k, 2, 0), colour: "accent" }]) });
  return list;
}

export const chartsPanel: Panel = {
  id: "charts", title: "Charts",
  make(scene: Scene, store: Store): HTMLElement | null {
    const { path } = scene;
    if (path.count < 2) return null;
    const m = motionOf(scene), nodes = new Uint32Array(path.count).map((_, i) => i), all = sources(scene), range = new Range(0, m.duration);
    let kind: "time" | "length" | "node" = "time";
    const x = () => kind === "time" ? path.time : kind === "length" ? m.length : nodes;
    const at = () => { const t = store.state.time; if (kind === "time") return t; const p = m.at(t); return kind === "length" ? p.length : p.node + p.part; };
    const go = (v: number) => {
      store.set({ playing: false });
      if (kind === "time") { goTime(scene, store, v); return; }
      const xs = x(), i = lastAtMost(xs, v), j = Math.min(path.count - 1, i + 1), f = xs[j] > xs[i] ? Math.min(1, (v - xs[i]) / (xs[j] - xs[i])) : 0;
      goTime(scene, store, path.time[i] + f * (path.time[j] - path.time[i]));
    };
    const charts = new Map<string, Chart>(), area = el("div", { class: "charts" }), picks = el("div", { class: "filters" });
    let together = false, shown: Chart[] = [];
    /** One chart each, or one for all of a unit. */
    const sheets = (): Source[][] => {
      const on = all.filter(s => s.on);
      if (!together) return on.map(s => [s]);
      return [...new Set(on.map(s => s.unit))].map(u => on.filter(s => s.unit === u));
    };
    const chartOf = (of: Source[]): Chart => {
      const id = of.map(s => s.id).join();
      let c = charts.get(id);
      if (!c) {
        const lines = of.flatMap((s, k) => s.lines().map(l => ({ ...l, colour: COLOURS[k % COLOURS.length], name: s.name })));
        c = new Chart({ name: of.map(s => s.name).join(", "), unit: of[0].unit, range, x, xKind: () => kind, lines, zero: of.every(s => s.zero), degrees: of[0].degrees, at, go });
        charts.set(id, c);
      }
      return c;
    };
    const fill = () => {
      shown = sheets().map(chartOf);
      area.replaceChildren(...shown.map(c => c.box));
      for (const c of shown) c.redraw();
      if (!area.firstChild) area.append(el("p", { class: "empty" }, "Choose what to draw above."));
    };
    for (const s of all) picks.append(check(s.name, s.on, on => { s.on = on; fill(); }).box);
    const over = choice("Over what the charts are drawn", [["time", "over time"], ["length", "over the way"], ["node", "over nodes"]], kind, v => {
      kind = v as typeof kind;
      range.reset(0, kind === "time" ? m.duration : x()[path.count - 1]);
    });
    const each = (call: (c: Chart) => void) => shown.forEach(call);
    store.on(["time"], () => { if (area.clientHeight > 0) each(c => c.place()); });
    store.on(["theme"], () => each(c => c.redraw()));
    fill();
    return el("div", { class: "column" }, el("div", { class: "filters" }, over, button("fit", "Show all of it", () => range.reset(), { text: "All", class: "" }), all.length > 1 && check("equal units together", together, on => { together = on; fill(); }).box), picks, area);
  },
};

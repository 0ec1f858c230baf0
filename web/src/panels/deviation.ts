// SPDX-License-Identifier: Apache-2.0
// Area of the surface by deviation, with the tolerance; the range of the heat map.
import type { Panel } from "../panels";
import type { Histogram, Scene } from "../scene";
import type { Store } from "../state";
import { css, divergingColour, heated, isDark } from "../colours";
import { brief, fixed, niceStep, ticks } from "../logic/format";
import { shares } from "../logic/histogram";
import { check, el, sheet, themed, within } from "../ui";

const LEFT = 46, RIGHT = 10, TOP = 8, BOTTOM = 34;

function drawing(h: Histogram, store: Store, heat: ReturnType<typeof heated>): HTMLElement {
  const box = el("div", { class: "map", role: "img", "aria-label": `${h.name}: area by value` }), canvas = el("canvas"), out = el("div", { class: "readout" });
  const n = h.area.length, lo = h.from, hi = h.from + n * h.step, s = shares(h);
  let log = false, hover = -1;
  const say = () => {
    if (hover < 0) { out.replaceChildren(el("b", {}, `${fixed(100 * s.within, 2)} %`), ` within \u00b1${brief(h.tolerance)} ${h.unit}; below ${fixed(100 * s.below, 2)} %, above ${fixed(100 * s.above, 2)} %`); return; }
    out.replaceChildren(el("b", {}, `${fixed(h.area[hover], 2)} mm\u00b2`), ` from ${brief(lo + hover * h.step)} to ${brief(lo + (hover + 1) * h.step)} ${h.unit} (${fixed(100 * h.area[hover] / (s.sum || 1), 2)} %)`);
  };
  const drawn = sheet(canvas, ({ g, w, h: high }) => {
    const right = w - RIGHT, bottom = high - BOTTOM, most = Math.max(...h.area, 1e-12), least = Math.max(Math.min(...h.area.filter(a => a > 0), most), most * 1e-6) / 2;
    const x = (v: number) => LEFT + (v - lo) / (hi - lo || 1) * (right - LEFT), y = (a: number) => a <= 0 ? bottom : bottom - (log ? Math.max(0, Math.log(a / least) / Math.log(most / least || 2)) : a / most) * (bottom - TOP);
    const dark = isDark(store.state), range = heat?.range(store.state.heatRange) ?? (h.tolerance * 2 || Math.max(Math.abs(lo), Math.abs(hi)));
    if (h.tolerance > 0) {
      const a = Math.max(LEFT, x(-h.tolerance)), b = Math.min(right, x(h.tolerance));
      if (b > a) { g.fillStyle = themed("good"); g.globalAlpha = 0.1; g.fillRect(a, TOP, b - a, bottom - TOP); g.globalAlpha = 1; }
    }
    g.strokeStyle = themed("grid"); g.fillStyle = themed("soft"); g.textAlign = "right"; g.lineWidth = 1;
    const levels = log ? ticks(Math.log10(least), Math.log10(most), 5, 1).map(v => 10 ** v) : ticks(0, most, (bottom - TOP) / 34);
    for (const a of levels) { const py = Math.round(y(a)) + 0.5; g.beginPath(); g.moveTo(LEFT, py); g.lineTo(right, py); g.stroke(); g.fillText(brief(a), LEFT - 6, py); }
    for (let i = 0; i < n; ++i) {
      if (h.area[i] <= 0) continue;
      const a = x(lo + i * h.step), b = x(lo + (i + 1) * h.step), py = Math.min(y(h.area[i]), bottom - 1);
      g.fillStyle = css(divergingColour((lo + (i + 0.5) * h.step) / range, dark));
      g.fillRect(a + 0.5, py, Math.max(1, b - a - 1), bottom - py);
      g.strokeStyle = i === hover ? themed("ink") : themed("soft"); g.lineWidth = i === hover ? 1.5 : 0.5; g.strokeRect(a + 0.5, py, Math.max(1, b - a - 1), bottom - py);
    }
    g.strokeStyle = themed("good"); g.lineWidth = 1.2; g.setLineDash([4, 3]);
    if (h.tolerance > 0) for (const t of [-h.tolerance, h.tolerance]) if (t > lo && t < hi) { g.beginPath(); g.moveTo(x(t), TOP); g.lineTo(x(t), bottom); g.stroke(); }
    g.setLineDash([]); g.strokeStyle = themed("line"); g.lineWidth = 1; g.beginPath(); g.moveTo(LEFT, bottom + 0.5); g.lineTo(right, bottom + 0.5); g.stroke();
    g.textAlign = "center"; g.fillStyle = themed("soft");
    for (const v of ticks(lo, hi, 1, niceStep((hi - lo) / Math.max(1, (right - LEFT) / 46)))) { const px = x(v); g.fillText(brief(v), Math.min(right - 8, px), bottom + 10); g.fillRect(px - 0.5, bottom, 1, 4); }
    g.fillText(`${h.name}, ${h.unit}   (\u2190 too deep, left standing \u2192)`, (LEFT + right) / 2, bottom + 25);
    g.textAlign = "left"; g.fillText("mm\u00b2", 4, TOP + 2);
  });
  box.append(canvas);
  box.addEventListener("pointermove", e => {
    const p = within(e, box), k = Math.floor((p.x - LEFT) / Math.max(1, box.clientWidth - LEFT - RIGHT) * n), next = k >= 0 && k < n ? k : -1;
    if (next !== hover) { hover = next; say(); drawn.again(); }
  });
  box.addEventListener("pointerleave", () => { hover = -1; say(); drawn.again(); });
  store.on(["theme", "heatRange"], drawn.again);
  say();
  const logarithmic = check("log scale", log, on => { log = on; drawn.again(); });
  return el("div", { class: "column", style: "flex:1 1 20rem;min-height:16rem" }, el("div", { class: "chart-head" }, el("b", {}, h.name), el("span", { class: "nums" }, logarithmic.box)), box, out);
}
export const deviationPanel: Panel = {
  id: "deviation", title: "Deviation",
  make(scene: Scene, store: Store): HTMLElement | null {
    const heat = heated(scene);
    if (scene.histograms.length === 0 && !heat) return null;
    const box = el("div", { class: "column", style: "overflow:auto" });
    if (heat) {
      const on = check("show on the part", store.state.heat, h => store.set({ heat: h })), own = heat.range(0), slider = el("input", { type: "range", min: -2, max: 1, step: 0.05, value: 0, "aria-label": "Range of the colours" }), text = el("span", { class: "nums soft" });
      const say = () => { on.input.checked = store.state.heat; const r = heat.range(store.state.heatRange); text.textContent = `\u00b1${brief(r)} ${heat.unit}`; slider.value = String(Math.log10(r / own)); };
      slider.addEventListener("input", () => store.set({ heat: true, heatRange: Number((own * 10 ** Number(slider.value)).toPrecision(3)) }));
      store.on(["heat", "heatRange"], say); say();
      box.append(el("div", { class: "filters" }, on.box, slider, text));
    }
    for (const h of scene.histograms) if (h.area.length > 0) box.append(drawing(h, store, heat));
    return box;
  },
};

// SPDX-License-Identifier: Apache-2.0
// What the colours mean, under the stage. A group's name isolates it, a ramp's ends can be set.
import type { Scene } from "./scene";
import { Kind, Role } from "./scene";
import type { Store } from "./state";
import { colouring, css, divergingColour, gradient, heated, isDark } from "./colours";
import type { Rgb } from "./colours";
import { brief, ticks } from "./logic/format";
import { openPanel } from "./panels";
import { button, el } from "./ui";

const SHOWN_GROUPS = 10;
export function isolate(store: Store, group: number): void { store.set({ only: store.state.only === group ? null : group }); }

/** A bar of colours with round figures under it. */
function ramp(of: (v: number) => Rgb, lo: number, hi: number, unit: string): HTMLElement {
  const scale = el("div", { class: "ramp-ticks nums" }), bar = el("div", { class: "ramp" }), marks = ticks(lo, hi, 4);
  for (const v of marks.length > 1 ? marks : [lo, hi]) { const t = el("span", {}, brief(v)); t.style.left = `${100 * (v - lo) / (hi - lo)}%`; scale.append(t); }
  bar.style.background = gradient(of, lo, hi);
  return el("div", { class: "ramp-box" }, el("div", { class: "ramp-bar" }, bar, scale), unit && el("small", {}, unit));
}
function limits(text: string, lo: number, hi: number, act: (lo: number, hi: number) => void, reset: (() => void) | null): HTMLElement {
  const field = (name: string, v: number) => el("input", { type: "number", step: "any", class: "num", "aria-label": `${text}: ${name}`, value: brief(v) });
  const a = field("from", lo), b = field("to", hi), change = () => { const p = Number(a.value), q = Number(b.value); if (a.value !== "" && b.value !== "" && q > p) act(p, q); };
  a.addEventListener("change", change); b.addEventListener("change", change);
  return el("details", { class: "limits", "data-of": text }, el("summary", { title: "Set the range of the colours" }, "range"), el("span", {}, a, "to", b, reset && el("button", { type: "button", onclick: reset }, "auto")));
}

export function makeLegend(scene: Scene, store: Store): HTMLElement {
  const box = el("div", { class: "legend", role: "region", "aria-label": "Legend", tabindex: -1 });
  const heat = heated(scene), present = new Uint8Array(4);
  for (const k of scene.path.kind) present[k & 3] = 1;
  const item = (colour: string, name: string, cls = "") => { const i = el("i", { class: cls }); i.style.color = colour; return el("span", { class: "item" }, i, name); };
  const show = () => {
    const { state } = store, dark = isDark(state), c = colouring(scene, state), names = scene.groups, out: (Node | string)[] = [];
    if (state.show.path && scene.path.count > 1) {
      if (state.colour === "kind") c.names?.forEach((n, k) => { if (present[k]) out.push(item(css(c.colour(k, dark)), n, k === Kind.rapid ? "dash" : "")); });
      else if (state.colour === "group") {
        names.slice(0, SHOWN_GROUPS).forEach((n, k) => {
          const mark = el("i"), b = el("button", { type: "button", class: "chip", "aria-pressed": String(state.only === k), title: `Show only ${n}`, onclick: () => isolate(store, k) }, mark, n);
          mark.style.color = css(c.colour(k, dark));
          out.push(b);
        });
        if (names.length > SHOWN_GROUPS) out.push(el("button", { type: "button", class: "chip", onclick: () => openPanel("groups") }, `${names.length - SHOWN_GROUPS} more`));
      } else if (c.value)
        out.push(el("b", {}, c.name), ramp(v => c.colour(v, dark), c.lo, c.hi, c.unit), limits(c.name, c.lo, c.hi, (lo, hi) => store.set({ range: [lo, hi] }), state.range ? () => store.set({ range: null }) : null));
    }
    if (state.only !== null) out.push(state.colour === "group" ? "" : `only ${names[state.only] ?? ""}`, button("close", "Show all groups", () => store.set({ only: null }), { text: "all groups", class: "chip" }));
    if (state.heat && heat) {
      const r = heat.range(state.heatRange);
      out.push(el("b", {}, heat.name), ramp(v => divergingColour(v / r, dark), -r, r, heat.unit), el("small", {}, "\u2212 gouge, + left"),
        limits(`${heat.name} on the part`, -r, r, (lo, hi) => store.set({ heatRange: Math.max(Math.abs(lo), Math.abs(hi)) }), state.heatRange > 0 ? () => store.set({ heatRange: 0 }) : null));
    }
    if (state.show.obstacles && scene.meshes.some(m => m.role === Role.obstacle)) out.push(item("var(--obstacle)", "fixtures", "cell"));
    const open = [...box.querySelectorAll<HTMLElement>("details[open]")].map(d => d.dataset.of);
    box.replaceChildren(...out);
    box.querySelectorAll<HTMLDetailsElement>("details").forEach(d => { d.open = open.includes(d.dataset.of); });
    box.hidden = out.length === 0;
  };
  show();
  store.on(["colour", "range", "heat", "heatRange", "only", "show", "theme"], show);
  return box;
}

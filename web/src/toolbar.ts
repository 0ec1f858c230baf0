// SPDX-License-Identifier: Apache-2.0
// Over the stage: views, section, measuring, what is shown, what the path is coloured by.
import type { Scene } from "./scene";
import { Role } from "./scene";
import type { State, Store, View } from "./state";
import { button, check, choice, el, icon } from "./ui";
import { fixed, niceStep } from "./logic/format";
import { setView } from "./seek";

const VIEWS: [View, string, string][] = [["iso", "Iso", "1"], ["top", "Top", "2"], ["front", "Front", "3"], ["right", "Right", "4"], ["back", "Back", "5"], ["left", "Left", "6"], ["bottom", "Bottom", "7"], ["tool", "Along the tool", "8"]];
export const SHOWN: [keyof State["show"], string, string, (s: Scene) => boolean][] = [
  ["part", "part", "p", s => s.meshes.some(m => m.role === Role.design) || s.outlines.length > 0],
  ["path", "path", "w", s => s.path.count > 1],
  ["rapids", "rapids and links", "r", s => s.path.count > 1],
  ["ahead", "path still to come", "a", s => s.path.count > 1],
  ["tool", "tool", "t", s => s.tools.length > 0],
  ["holder", "shank and holder", "h", s => s.tools.some(t => t.pieces.some(p => p.kind > 0))],
  ["stock", "stock", "k", s => s.stock !== null || s.meshes.some(m => m.role === Role.stock || m.role === Role.result)],
  ["obstacles", "fixtures", "o", s => s.meshes.some(m => m.role === Role.obstacle)],
];
export const turns = (scene: Scene): boolean => scene.path.rotary !== null && (scene.machine?.axes.some(a => a.table) ?? false);
export function toggleSection(scene: Scene, store: Store): void {
  const s = store.state.section, { lo, hi } = scene.box, inside = s.at !== 0 && s.at > lo[s.axis] && s.at < hi[s.axis]; // 0: not chosen yet
  store.set({ section: { ...s, on: !s.on, at: inside ? s.at : (lo[s.axis] + hi[s.axis]) / 2 } });
}
export function toggleMeasuring(store: Store): void { store.set({ measuring: !store.state.measuring, measured: [] }); }
/** What a path can be coloured by. */
export function colourings(scene: Scene): [string, string][] {
  const { path } = scene, list: [string, string][] = [["kind", "kind of move"]];
  if (scene.groups.length > 1) list.push(["group", "group"]);
  if (path.feed.some(f => f > 0)) list.push(["feed", "feed"]);
  scene.series.forEach((s, k) => list.push([`series:${k}`, s.name]));
  list.push(["plain", "one colour"]);
  return list;
}

function toggle(name: string, label: string, key: string, store: Store, on: (s: Readonly<State>) => boolean, keys: (keyof State)[], act: () => void, text = ""): HTMLButtonElement {
  const b = button(name, label, act, { key, text }), set = () => b.setAttribute("aria-pressed", String(on(store.state)));
  set(); store.on(keys, set);
  return b;
}
/** A menu that closes by a click elsewhere or Escape. */
function menu(name: string, text: string, content: HTMLElement): HTMLElement {
  const d = el("details", { class: "menu" }, el("summary", { title: text }, icon(name), el("span", {}, text)), content);
  // The toolbar scrolls sideways on a phone, which would cut the menu off: it is placed on the page.
  d.addEventListener("toggle", () => {
    if (!d.open) return;
    const r = d.getBoundingClientRect();
    content.style.top = `${r.bottom + 4}px`;
    content.style.left = `${Math.max(8, Math.min(r.left, innerWidth - content.offsetWidth - 8))}px`;
  });
  document.addEventListener("pointerdown", e => { if (d.open && !d.contains(e.target as Node)) d.open = false; });
  d.addEventListener("keydown", e => { if (e.key === "Escape" && d.open) { d.open = false; d.querySelector("summary")?.focus(); e.stopPropagation(); } });
  return d;
}
function showMenu(scene: Scene, store: Store): HTMLElement {
  const list = el("div", { class: "sheet" });
  for (const [key, text, letter, there] of SHOWN) {
    if (!there(scene)) continue;
    const { box, input } = check(text, store.state.show[key], on => store.set({ show: { ...store.state.show, [key]: on } }));
    box.append(el("kbd", {}, letter.toUpperCase()));
    store.on(["show"], s => { input.checked = s.show[key]; });
    list.append(box);
  }
  return menu("eye", "Show", list);
}
function viewMenu(store: Store): HTMLElement {
  const list = el("div", { class: "sheet" }), m = menu("iso", "View", list) as HTMLDetailsElement;
  for (const [view, text, key] of VIEWS) list.append(el("button", { type: "button", class: "row", onclick: () => { setView(store, view); m.open = false; } }, text, el("kbd", {}, key)));
  m.classList.add("narrow-only");
  return m;
}

/** A row for the section plane, there while it is on. */
function sectionBar(scene: Scene, store: Store): HTMLElement {
  const { lo, hi } = scene.box, slider = el("input", { type: "range", step: "any", "aria-label": "Place of the section plane" }), number = el("input", { type: "number", class: "num", "aria-label": "Place of the section plane, mm" });
  const set = (change: Partial<State["section"]>) => store.set({ section: { ...store.state.section, ...change } });
  // The corner view sees the faces of a cut across X and Z from their upper side, of one across Y from the lower.
  const axes = (["X", "Y", "Z"] as const).map((letter, k) => el("button", { type: "button", onclick: () => set({ axis: k as 0 | 1 | 2, at: (lo[k] + hi[k]) / 2, flip: k === 1 }), "aria-label": `Section across ${letter}` }, letter));
  slider.addEventListener("input", () => set({ at: Number(slider.value) }));
  number.addEventListener("change", () => set({ at: Number(number.value) }));
  const bar = el("div", { class: "bar sub", role: "group", "aria-label": "Section plane" }, el("span", { class: "soft" }, "Section across"), el("span", { class: "joined" }, ...axes), slider, number, el("span", { class: "soft" }, "mm"),
    button("flip", "Keep the other side", () => set({ flip: !store.state.section.flip })), button("close", "No section", () => set({ on: false })));
  const show = () => {
    const s = store.state.section, a = lo[s.axis], b = hi[s.axis];
    bar.hidden = !s.on;
    axes.forEach((x, k) => x.setAttribute("aria-pressed", String(k === s.axis)));
    slider.min = String(a); slider.max = String(b); slider.value = String(s.at);
    number.step = String(niceStep((b - a) / 1000 || 1));
    if (document.activeElement !== number) number.value = fixed(s.at, 3);
  };
  show(); store.on(["section"], show);
  return bar;
}
/** What was measured. */
function measureBar(store: Store): HTMLElement {
  const text = el("span", { class: "nums", "aria-live": "polite" });
  const bar = el("div", { class: "bar sub", role: "group", "aria-label": "Measuring" }, icon("ruler"), text, button("close", "Stop measuring", () => toggleMeasuring(store)));
  const show = () => {
    const { measuring, measured: m } = store.state;
    bar.hidden = !measuring && m.length === 0;
    if (m.length === 0) { text.textContent = "Choose the first point in the picture"; return; }
    const say = (p: readonly number[]) => p.map(v => fixed(v, 3)).join("  ");
    if (m.length === 1) { text.textContent = `${say(m[0])}, choose the second point`; return; }
    const d = [0, 1, 2].map(k => m[1][k] - m[0][k]);
    text.replaceChildren(el("b", {}, `${fixed(Math.hypot(d[0], d[1], d[2]), 3)} mm`), `  dx ${fixed(d[0], 3)}  dy ${fixed(d[1], 3)}  dz ${fixed(d[2], 3)}  in XY ${fixed(Math.hypot(d[0], d[1]), 3)}`);
  };
  show(); store.on(["measuring", "measured"], show);
  return bar;
}

export function makeToolbar(scene: Scene, store: Store): HTMLElement {
  const views = el("span", { class: "joined wide-only", role: "group", "aria-label": "Views" }, ...VIEWS.slice(0, 4).map(([view, text, key]) => el("button", { type: "button", title: `${text} (${key})`, onclick: () => setView(store, view) }, text)));
  const colour = choice("Colour of the path", colourings(scene), store.state.colour, value => store.set({ colour: value, range: null }));
  store.on(["colour"], s => { colour.value = s.colour; });
  const heat = scene.meshes.some(m => m.value) || scene.outlines.some(o => o.value);
  const row = el("div", { class: "bar", role: "toolbar", "aria-label": "Picture" }, views, viewMenu(store), button("fit", "Show everything", () => setView(store, "fit"), { key: "0" }),
    toggle("perspective", "Perspective", "V", store, s => s.perspective, ["perspective"], () => store.set({ perspective: !store.state.perspective })), el("i", { class: "gap" }),
    toggle("section", "Section plane", "X", store, s => s.section.on, ["section"], () => toggleSection(scene, store)),
    toggle("ruler", "Measure a distance", "M", store, s => s.measuring, ["measuring"], () => toggleMeasuring(store)),
    turns(scene) && toggle("turn", "As the machine does it: table axes turn the part", "J", store, s => s.asMachine, ["asMachine"], () => store.set({ asMachine: !store.state.asMachine })), el("i", { class: "gap" }),
    showMenu(scene, store), el("label", { class: "check" }, el("span", { class: "soft wide-only" }, "Path by"), colour),
    heat && toggle("deviation", "Deviation on the part", "D", store, s => s.heat, ["heat"], () => store.set({ heat: !store.state.heat }), "Heat map"));
  const bar = el("div", { class: "toolbar" }, row, sectionBar(scene, store), measureBar(store));
  const ROOM = 730; // for everything in words
  new ResizeObserver(() => bar.classList.toggle("tight", bar.clientWidth < ROOM)).observe(bar);
  return bar;
}

// SPDX-License-Identifier: Apache-2.0
// The page: header, toolbar, stage, legend, panels at the side (a drawer on a phone), timeline.
import type { Scene } from "./scene";
import type { Store } from "./state";
import "./style.css";
import { button, copy, el, icon, save, tell, themed } from "./ui";
import { count, duration, length } from "./logic/format";
import { makeInspect } from "./inspect";
import { makeKeyboard } from "./keyboard";
import { makeLegend } from "./legend";
import { PANELS } from "./panels";
import { goTime, motionOf } from "./seek";
import { makeTimeline } from "./timeline";
import { makeToolbar } from "./toolbar";

const NEXT_THEME = { system: "light", light: "dark", dark: "system" } as const;

function header(scene: Scene, store: Store, stage: HTMLElement, help: () => void): HTMLElement {
  const m = motionOf(scene), faults = scene.findings.filter(f => f.level === 2).length, warnings = scene.findings.filter(f => f.level === 1).length;
  const sums = el("dl", { class: "sums" });
  const sum = (name: string, value: string, level = "") => sums.append(el("div", { class: level }, el("dt", {}, name), el("dd", {}, value)));
  if (scene.path.count > 1) { sum("time", duration(m.duration, 0)); sum("way", length(m.length[scene.path.count - 1])); sum("nodes", count(scene.path.count), "minor"); }
  if (faults) sum(faults === 1 ? "fault" : "faults", count(faults), "bad");
  if (warnings) sum(warnings === 1 ? "warning" : "warnings", count(warnings), "warn");
  const theme = button("sun", "Theme", () => { store.set({ theme: NEXT_THEME[store.state.theme] }); tell(`Theme: ${store.state.theme}`); }, { key: "Shift+T" });
  return el("header", { class: "top" },
    el("h1", { title: scene.title }, scene.title || "burin"), scene.operation && el("span", { class: "badge" }, scene.operation), sums,
    el("div", { class: "actions" },
      button("link", "Copy a link to this time", () => void copyLink(store), { key: "Shift+L" }),
      button("image", "Save the picture as PNG", () => savePicture(stage, scene, store), { key: "Shift+P" }), theme,
      button("help", "Keys and help", help, { key: "?" })));
}
export function copyLink(store: Store): Promise<void> {
  const url = new URL(location.href);
  url.hash = `t=${store.state.time.toFixed(3)}`;
  try { history.replaceState(null, "", url); } catch { /* not every place of a page lets it */ }
  return copy(url.href, "Link");
}
/** The stage draws when it is told to; its canvas is read before the browser shows the next frame. A caption says what it is. */
export function savePicture(stage: HTMLElement, scene: Scene, store: Store): void {
  const canvas = stage.querySelector("canvas"), out = document.createElement("canvas"), g = out.getContext("2d");
  if (!canvas || !g) { tell("There is no picture to save"); return; }
  stage.dispatchEvent(new CustomEvent("draw-now"));
  const k = canvas.width / Math.max(1, stage.clientWidth), line = 26 * k;
  out.width = canvas.width; out.height = canvas.height + line;
  g.fillStyle = themed("panel"); g.fillRect(0, 0, out.width, out.height);
  g.drawImage(canvas, 0, 0);
  g.fillStyle = themed("ink"); g.font = `${12 * k}px system-ui, sans-serif`; g.textBaseline = "middle";
  g.fillText([scene.title, scene.operation, scene.path.count > 1 ? duration(store.state.time) : ""].filter(t => t).join("   "), 10 * k, canvas.height + line / 2, out.width - 20 * k);
  out.toBlob(b => b ? save(b, `${(scene.title || "burin").replace(/[^\w.-]+/g, "_")}.png`) : tell("The picture could not be made"), "image/png");
}

/** Tabs and their panels. A click on the open tab closes it; a pinned panel stays above the one that is opened next. */
function side(scene: Scene, store: Store): { panels: HTMLElement; rail: HTMLElement } {
  const panels = el("div", { class: "panels" }), rail = el("div", { class: "rail", role: "tablist", "aria-label": "Panels", "aria-orientation": "vertical" });
  const all: { id: string; tab: HTMLButtonElement; box: HTMLElement; pin: HTMLElement }[] = [];
  let open: string | null = null, pinned: string | null = null;
  const show = (id: string | null) => {
    if (id !== null && id === pinned) return;
    open = id;
    for (const p of all) {
      const shown = p.id === open || p.id === pinned;
      p.box.hidden = !shown; p.tab.setAttribute("aria-selected", String(shown)); p.pin.setAttribute("aria-pressed", String(p.id === pinned));
      p.box.style.order = p.id === pinned ? "0" : "1";
      p.tab.tabIndex = p.id === (open ?? pinned ?? all[0].id) ? 0 : -1;
    }
    const none = open === null && pinned === null;
    panels.hidden = none; document.documentElement.classList.toggle("closed", none);
  };
  const close = (id: string) => { if (pinned === id) pinned = null; show(open === id ? null : open); };
  for (const panel of PANELS) {
    const content = panel.make(scene, store);
    if (!content) continue;
    const id = panel.id, faults = id === "findings" ? scene.findings.filter(f => f.level > 0).length : 0;
    const tab = el("button", { type: "button", role: "tab", id: `tab-${id}`, "aria-controls": `panel-${id}`, onclick: () => open === id || pinned === id ? close(id) : show(id) },
      icon(id), el("span", {}, panel.title), faults > 0 && el("b", { class: "badge" }, faults > 999 ? "999+" : String(faults)));
    const pin = button("pin", "Keep it open: the next panel opens below", () => { if (pinned === id) { pinned = null; show(id); } else { const other = pinned; pinned = id; show(open === id ? other : open); } });
    const box = el("section", { class: "panel", role: "tabpanel", id: `panel-${id}`, "aria-labelledby": `tab-${id}` },
      el("div", { class: "panel-head" }, el("h2", {}, panel.title), pin, button("close", "Close the panel", () => close(id))), content);
    all.push({ id, tab, box, pin }); rail.append(tab); panels.append(box);
  }
  rail.addEventListener("keydown", e => {
    const d = e.key === "ArrowDown" || e.key === "ArrowRight" ? 1 : e.key === "ArrowUp" || e.key === "ArrowLeft" ? -1 : 0;
    const at = all.findIndex(p => p.tab === document.activeElement);
    if (d === 0 || at < 0) return;
    e.preventDefault(); e.stopPropagation();
    const next = all[(at + d + all.length) % all.length];
    show(next.id); next.tab.focus();
  });
  document.addEventListener("open-panel", e => { const id = (e as CustomEvent<string>).detail; if (all.some(p => p.id === id)) show(id); });
  show(all.length > 0 && !narrow.matches ? all[0].id : null);
  return { panels, rail };
}
const narrow = matchMedia("(max-width: 760px)");

/** Between stage and panels: drag, or arrow keys. */
function splitter(): HTMLElement {
  let width = 400;
  const s = el("div", { class: "splitter", role: "separator", tabindex: 0, "aria-orientation": "vertical", "aria-label": "Width of the panels", "aria-valuemin": 260 });
  const set = (w: number) => {
    width = Math.round(Math.min(Math.max(260, w), Math.max(260, innerWidth * 0.62)));
    document.documentElement.style.setProperty("--side", `${width}px`); s.setAttribute("aria-valuenow", String(width));
  };
  s.addEventListener("pointerdown", e => {
    s.setPointerCapture(e.pointerId); e.preventDefault();
    const from = e.clientX + width, move = (q: PointerEvent) => set(from - q.clientX);
    s.addEventListener("pointermove", move);
    s.addEventListener("lostpointercapture", () => s.removeEventListener("pointermove", move), { once: true });
  });
  s.addEventListener("keydown", e => {
    const d = e.key === "ArrowLeft" ? 24 : e.key === "ArrowRight" ? -24 : 0;
    if (d !== 0) { set(width + d); e.preventDefault(); e.stopPropagation(); }
  });
  set(innerWidth >= 1600 ? 480 : innerWidth >= 1200 ? 420 : 340);
  return s;
}

function applyTheme(store: Store): void {
  const root = document.documentElement, set = () => {
    if (store.state.theme === "system") root.removeAttribute("data-theme"); else root.dataset.theme = store.state.theme;
  };
  set();
  store.on(["theme"], set);
  // A change of the system's own theme is one of ours as well: canvases are drawn again.
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { if (store.state.theme === "system") { store.set({ theme: "light" }); store.set({ theme: "system" }); } });
}

export function makeLayout(app: HTMLElement, scene: Scene, store: Store): { stage: HTMLElement } {
  applyTheme(store);
  const stage = el("div", { class: "stage" }), keys = makeKeyboard(scene, store, stage), { panels, rail } = side(scene, store);
  stage.append(makeInspect(scene, store));
  const view = el("main", { class: "view", "aria-label": "Part and tool path" }, makeToolbar(scene, store), stage, makeLegend(scene, store));
  app.classList.add("app");
  app.replaceChildren(header(scene, store, stage, keys.help), view, splitter(), panels, rail, makeTimeline(scene, store));
  const follow = () => {
    const t = /[#&]t=([\d.]+)/.exec(location.hash), panel = /[#&]panel=([\w-]+)/.exec(location.hash);
    if (t) goTime(scene, store, Number(t[1]));
    if (panel) document.dispatchEvent(new CustomEvent("open-panel", { detail: panel[1] }));
  };
  follow();
  addEventListener("hashchange", follow);
  return { stage };
}

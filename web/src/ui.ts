// SPDX-License-Identifier: Apache-2.0
// Small helpers of the page: elements, icons, colours of the theme, canvases, a line of news.

type Child = Node | string | null | undefined | false;
type Attributes = Record<string, string | number | boolean | null | undefined | ((e: never) => void)>;
/** Attributes by name; `on...` are listeners; false, null leave it out. */
export function el<K extends keyof HTMLElementTagNameMap>(tag: K, attributes: Attributes = {}, ...children: Child[]): HTMLElementTagNameMap[K] {
  const e = document.createElement(tag);
  for (const [k, v] of Object.entries(attributes)) {
    if (typeof v === "function") e.addEventListener(k.slice(2), v as unknown as EventListener);
    else if (v !== null && v !== undefined && v !== false) e.setAttribute(k, v === true ? "" : String(v));
  }
  e.append(...children.filter((c): c is Node | string => c !== null && c !== undefined && c !== false));
  return e;
}

const ICONS: Record<string, string> = {
  pin: "M5.5 2h5l-.6 4.5 2.1 2.5H4l2.1-2.5zM8 9v5", up: "M3 10l5-5 5 5", down: "M3 6l5 5 5-5",
  play: "M4.5 2.8v10.4l8.6-5.2z", pause: "M4.5 3v10M11.5 3v10", back: "M10 3L5 8l5 5", on: "M6 3l5 5-5 5",
  moveBack: "M12 3L7 8l5 5M7.5 3l-5 5 5 5", moveOn: "M4 3l5 5-5 5M8.5 3l5 5-5 5", passBack: "M12.5 3l-6 5 6 5zM3.5 3v10", passOn: "M3.5 3l6 5-6 5zM12.5 3v10",
  fit: "M2 6V2h4M10 2h4v4M14 10v4h-4M6 14H2v-4M6 6h4v4H6z", iso: "M8 1.8l5.5 3.1v6.2L8 14.2l-5.5-3.1V4.9zM2.5 4.9L8 8l5.5-3.1M8 8v6.2",
  perspective: "M2 4.5l12-2.5v12L2 11.5zM8 3.2v9.6M2 8h12", section: "M2 11l4-7h8l-4 7zM8 1.5v3M8 11v3.5", ruler: "M1.5 10.5l9-9 4 4-9 9zM4 8l1.5 1.5M6.5 5.5L8.5 7.5M9 3l1.5 1.5",
  turn: "M13.5 8A5.5 5.5 0 1 1 11.7 3.9M12 1.5v2.8H9.2", sun: "M8 5a3 3 0 1 0 0 6 3 3 0 0 0 0-6zM8 1v1.5M8 13.5V15M1 8h1.5M13.5 8H15M3 3l1 1M12 12l1 1M13 3l-1 1M4 12l-1 1",
  help: "M5.5 5.8a2.5 2.5 0 1 1 3.6 2.2c-.8.4-1.1.9-1.1 1.7M8 12.3v.4", link: "M6.5 9.5l3-3M7 4.5l1.5-1.5a2.9 2.9 0 0 1 4.2 4.2L11 8.8M9 11.5l-1.5 1.5a2.9 2.9 0 0 1-4.2-4.2L5 7.2",
  image: "M2 3h12v10H2zM2 11l3.5-4 3 3 2-2L14 11M10.8 5.8v.1", eye: "M1.5 8S4 3.8 8 3.8 14.5 8 14.5 8 12 12.2 8 12.2 1.5 8 1.5 8zM8 6.2a1.8 1.8 0 1 0 0 3.6 1.8 1.8 0 0 0 0-3.6z",
  findings: "M8 2l6.5 11.5h-13zM8 6.5v3.5M8 11.8v.2", figures: "M2.5 3h11v10h-11zM2.5 6.3h11M2.5 9.7h11M7 3v10", deviation: "M2 13.5h12M3.5 13.5V11M6 13.5V7.5M8 13.5V3M10 13.5V6M12.5 13.5v-2",
  program: "M3 2.5h10v11H3zM5.5 5.5h5M5.5 8h5M5.5 10.5h3", charts: "M2 2v12h12M4.5 10.5l2.5-4 2.5 2.5 3.5-5.5", angles: "M2 14L13 5M2 14h12M8.5 14a6 6 0 0 0-1.7-4",
  closeup: "M7 2.5a4.5 4.5 0 1 0 0 9 4.5 4.5 0 0 0 0-9zM10.3 10.3L14 14", groups: "M2 4h2M6 4h8M2 8h2M6 8h8M2 12h2M6 12h8", messages: "M2 3h12v8H7l-3 2.5V11H2z",
  copy: "M5.5 5.5h8v8h-8zM10.5 5.5v-3h-8v8h3", close: "M4 4l8 8M12 4l-8 8", flip: "M8 2v12M6 4.5L2.5 8 6 11.5M10 4.5L13.5 8 10 11.5", colour: "M8 2s4.2 4.6 4.2 7.5a4.2 4.2 0 0 1-8.4 0C3.8 6.6 8 2 8 2z", panel: "M2 3h12v10H2zM10 3v10",
};
export function icon(name: string): SVGSVGElement {
  const ns = "http://www.w3.org/2000/svg", s = document.createElementNS(ns, "svg"), p = document.createElementNS(ns, "path");
  s.setAttribute("viewBox", "0 0 16 16"); s.setAttribute("class", "icon"); s.setAttribute("aria-hidden", "true");
  p.setAttribute("d", ICONS[name] ?? ""); s.append(p);
  return s;
}
/** A button with an icon and, when `text` is given, words. `key`: named in its title. */
export function button(name: string, label: string, act: () => void, more: { text?: string; key?: string; class?: string } = {}): HTMLButtonElement {
  return el("button", { type: "button", class: more.class ?? (more.text ? "" : "square"), title: label + (more.key ? ` (${more.key})` : ""), "aria-label": label, onclick: act },
    name in ICONS && icon(name), more.text && el("span", {}, more.text));
}
export function setIcon(b: HTMLElement, name: string, label: string, key = ""): void {
  b.querySelector("svg")?.replaceWith(icon(name));
  b.title = label + (key ? ` (${key})` : ""); b.setAttribute("aria-label", label);
}
export function choice(label: string, options: [string, string][], value: string, act: (value: string) => void): HTMLSelectElement {
  const s = el("select", { "aria-label": label, title: label }, ...options.map(([v, t]) => el("option", { value: v }, t)));
  s.value = value;
  let pointed = false; // chosen with the pointer, the keys are the page's again
  s.addEventListener("pointerdown", () => { pointed = true; });
  s.addEventListener("keydown", () => { pointed = false; });
  s.addEventListener("change", () => { act(s.value); if (pointed) s.blur(); });
  return s;
}
export function check(text: string, on: boolean, act: (on: boolean) => void): { box: HTMLLabelElement; input: HTMLInputElement } {
  const input = el("input", { type: "checkbox" });
  input.checked = on;
  input.addEventListener("change", () => act(input.checked));
  return { box: el("label", { class: "check" }, input, text), input };
}

/** The theme's colour of that name, for canvases. */
export const themed = (name: string): string => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim() || "#888";

export interface Sheet { g: CanvasRenderingContext2D; w: number; h: number }
/** A canvas that fills its box: `draw` gets it empty, in CSS pixels, whenever its size or `again` asks for it, once a frame and only while it is seen. */
export function sheet(canvas: HTMLCanvasElement, draw: (s: Sheet) => void): { again: () => void } {
  let asked = false;
  const now = () => {
    asked = false;
    const box = canvas.parentElement;
    if (!box || box.clientWidth < 2 || box.clientHeight < 2) return;
    const k = Math.min(3, devicePixelRatio || 1), w = box.clientWidth, h = box.clientHeight;
    if (canvas.width !== Math.round(w * k) || canvas.height !== Math.round(h * k)) { canvas.width = Math.round(w * k); canvas.height = Math.round(h * k); }
    const g = canvas.getContext("2d");
    if (!g) return;
    g.setTransform(k, 0, 0, k, 0, 0); g.clearRect(0, 0, w, h);
    g.font = FONT; g.textBaseline = "middle"; g.lineJoin = "round";
    draw({ g, w, h });
  };
  const again = () => { if (!asked) { asked = true; requestAnimationFrame(now); } };
  canvas.classList.add("fill");
  queueMicrotask(() => { if (canvas.parentElement) new ResizeObserver(again).observe(canvas.parentElement); });
  return { again };
}
export const FONT = '11px system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", sans-serif';
/** Text with an edge of the sheet's colour, so that it is read over lines. */
export function haloed(g: CanvasRenderingContext2D, text: string, x: number, y: number, colour: string, sheetColour: string): void {
  g.lineWidth = 3; g.strokeStyle = sheetColour; g.strokeText(text, x, y);
  g.fillStyle = colour; g.fillText(text, x, y);
}

let news: HTMLElement | null = null, hide = 0;
/** A short message that goes away by itself; read aloud. */
export function tell(text: string): void {
  if (!news) { news = el("div", { class: "news", role: "status", "aria-live": "polite" }); document.body.append(news); }
  news.textContent = text; news.classList.add("on");
  clearTimeout(hide);
  hide = window.setTimeout(() => news?.classList.remove("on"), 2600);
}
export async function copy(text: string, what: string): Promise<void> {
  try { await navigator.clipboard.writeText(text); } catch {
    const t = el("textarea", { class: "away" }); // a page opened as a file may not be given the clipboard
    t.value = text; document.body.append(t); t.select(); document.execCommand("copy"); t.remove();
  }
  tell(`${what} copied`);
}
export function save(blob: Blob, name: string): void {
  const a = el("a", { href: URL.createObjectURL(blob), download: name });
  document.body.append(a); a.click(); a.remove();
  setTimeout(() => URL.revokeObjectURL(a.href), 10000);
}
/** Pointer position in CSS pixels of the element. */
export function within(e: MouseEvent, of: HTMLElement): { x: number; y: number } {
  const r = of.getBoundingClientRect();
  return { x: e.clientX - r.left, y: e.clientY - r.top };
}
/** Is the user typing? */
export const typing = (t: EventTarget | null): boolean => t instanceof HTMLInputElement ? !["checkbox", "radio", "button", "range"].includes(t.type) : t instanceof HTMLTextAreaElement || t instanceof HTMLSelectElement;

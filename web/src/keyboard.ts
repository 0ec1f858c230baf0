// SPDX-License-Identifier: Apache-2.0
// Every key of the page in one table: what acts and what the help shows.
import type { Scene } from "./scene";
import type { State, Store, View } from "./state";
import { PANELS, openPanel } from "./panels";
import { goTime, motionOf, setView } from "./seek";
import { changeSpeed, step, togglePlaying } from "./timeline";
import { colourings, SHOWN, toggleMeasuring, toggleSection, turns } from "./toolbar";
import { copyLink, savePicture } from "./layout";
import { el, typing } from "./ui";

interface Key { keys: string[]; shown?: string; text: string; part: string; act: () => void }
const ARROWS: Record<string, string> = { ArrowLeft: "\u2190", ArrowRight: "\u2192", " ": "Space" };
const VIEW_KEYS: [string, View, string][] = [["0", "fit", "show everything"], ["1", "iso", "from a corner"], ["2", "top", "top"], ["3", "front", "front"], ["4", "right", "right"], ["5", "back", "back"], ["6", "left", "left"], ["7", "bottom", "bottom"], ["8", "tool", "along the tool"]];

function table(scene: Scene, store: Store, stage: HTMLElement, help: () => void): Key[] {
  const go = (by: "node" | "move" | "pass", d: number) => () => step(scene, store, by, d), list: Key[] = [];
  const add = (part: string, keys: string[], text: string, act: () => void, shown?: string) => list.push({ keys, text, part, act, shown });
  add("Time", [" "], "play, pause", () => togglePlaying(scene, store));
  add("Time", ["ArrowLeft", ","], "node before", go("node", -1)); add("Time", ["ArrowRight", "."], "next node", go("node", 1));
  add("Time", ["Shift+ArrowLeft", "<"], "move before", go("move", -1), "Shift+\u2190"); add("Time", ["Shift+ArrowRight", ">"], "next move", go("move", 1), "Shift+\u2192");
  add("Time", ["["], "pass before", go("pass", -1)); add("Time", ["]"], "next pass", go("pass", 1));
  add("Time", ["Home"], "begin", () => goTime(scene, store, 0)); add("Time", ["End"], "end", () => goTime(scene, store, motionOf(scene).duration));
  add("Time", ["+", "="], "faster", () => changeSpeed(store, 1), "+"); add("Time", ["-"], "slower", () => changeSpeed(store, -1));
  for (const [key, view, text] of VIEW_KEYS) add("View", [key], text, () => setView(store, view));
  add("View", ["v"], "perspective", () => store.set({ perspective: !store.state.perspective }));
  add("View", ["x"], "section plane", () => toggleSection(scene, store));
  add("View", ["m"], "measure a distance", () => toggleMeasuring(store));
  if (turns(scene)) add("View", ["j"], "as the machine does it", () => store.set({ asMachine: !store.state.asMachine }));
  add("View", ["d"], "deviation on the part", () => store.set({ heat: !store.state.heat }));
  add("View", ["c"], "next colouring of the path", () => {
    const all = colourings(scene).map(([id]) => id);
    store.set({ colour: all[(all.indexOf(store.state.colour) + 1) % all.length], range: null });
  });
  for (const [key, text, letter, there] of SHOWN)
    if (there(scene)) add("Show", [letter], text, () => store.set({ show: { ...store.state.show, [key]: !store.state.show[key as keyof State["show"]] } }));
  PANELS.forEach((p, k) => { if (document.getElementById(`panel-${p.id}`)) add("Panels", [`Alt+${k + 1}`], p.title, () => openPanel(p.id)); });
  add("Panels", ["/"], "search the program", () => { openPanel("program"); document.getElementById("program-search")?.focus(); });
  add("Page", ["Shift+T"], "theme", () => store.set({ theme: store.state.theme === "dark" ? "light" : store.state.theme === "light" ? "system" : "dark" }));
  add("Page", ["Shift+L"], "copy a link to this time", () => void copyLink(store));
  add("Page", ["Shift+P"], "save the picture", () => savePicture(stage, scene, store));
  add("Page", ["Escape"], "let go of what was picked", () => store.set({ picked: null, trial: null, only: null, measuring: false, measured: [] }), "Esc");
  add("Page", ["?"], "this help", help);
  return list;
}
/** "Shift+ArrowLeft", "Alt+1", "?"; letters small unless with Shift. */
function nameOf(e: KeyboardEvent): string {
  if (e.altKey && /^Digit\d$/.test(e.code)) return `Alt+${e.code.slice(5)}`; // with Alt some keyboards write another sign
  const letter = /^[a-z]$/i.test(e.key);
  if (e.shiftKey && (letter || e.key.startsWith("Arrow"))) return `Shift+${letter ? e.key.toUpperCase() : e.key}`;
  return letter ? e.key.toLowerCase() : e.key;
}
const pretty = (k: string): string => ARROWS[k] ?? (k.length === 1 ? k.toUpperCase() : k);

export function makeKeyboard(scene: Scene, store: Store, stage: HTMLElement): { help: () => void } {
  let keys: Key[] = [], dialog: HTMLDialogElement | null = null;
  const all = () => keys.length > 0 ? keys : keys = table(scene, store, stage, help);
  const help = () => {
    if (dialog?.open) { dialog.close(); return; }
    if (!dialog) {
      const parts = [...new Set(all().map(k => k.part))].map(part => el("section", {}, el("h3", {}, part), el("dl", {}, ...all().filter(k => k.part === part).map(k =>
        el("div", {}, el("dt", {}, el("kbd", {}, k.shown ?? k.keys.map(pretty).join(" "))), el("dd", {}, k.text))))));
      const mouse = el("section", {}, el("h3", {}, "Pointer"), el("dl", {}, ...[["drag", "turn"], ["Shift + drag, right button", "move"], ["wheel, two fingers", "zoom"], ["click on the path", "go there"], ["click on a line of the program", "go to its move"], ["wheel on the time strip, on a chart", "zoom; double click: all"]].map(([a, b]) => el("div", {}, el("dt", {}, a), el("dd", {}, b)))));
      dialog = el("dialog", { class: "help", "aria-label": "Keys and help" }, el("form", { method: "dialog" }, el("h2", {}, "Keys"), el("button", { "aria-label": "Close" }, "Close")), el("div", { class: "columns" }, ...parts, mouse));
      dialog.addEventListener("click", e => { if (e.target === dialog) dialog?.close(); });
      document.body.append(dialog);
    }
    dialog.showModal();
  };
  // After a click with the pointer Space plays again, it does not press the button once more.
  document.addEventListener("click", e => { if (e.detail > 0 && e.target instanceof Element) e.target.closest<HTMLElement>("button, summary, input[type=checkbox]")?.blur(); });
  document.addEventListener("keydown", e => {
    if (e.defaultPrevented || e.ctrlKey || e.metaKey || typing(e.target)) return;
    if (dialog?.open && e.key !== "?") return;
    // Enter and Space belong to the button that has the focus.
    if (e.key === " " && e.target instanceof HTMLElement && e.target.closest("button, summary, input, [role=tab], [role=option]")) return;
    const name = nameOf(e), key = all().find(k => k.keys.includes(name));
    if (!key) return;
    e.preventDefault();
    key.act();
  });
  return { help };
}

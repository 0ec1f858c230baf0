// SPDX-License-Identifier: Apache-2.0
// What was found, the worst first. A click shows the place and the time.
import type { Panel } from "../panels";
import type { Finding, Scene } from "../scene";
import type { Store } from "../state";
import { count, duration } from "../logic/format";
import { goNode, lookAt, motionOf } from "../seek";
import { el, icon } from "../ui";

const NAMES = ["note", "warning", "fault"], STEP = 200;
/** How much of the part is seen about a finding, of its longest side. */
const SPAN = 0.12;

export function showFinding(scene: Scene, store: Store, f: Finding): void {
  store.set({ playing: false });
  if (f.node !== null) { goNode(scene, store, f.node); store.set({ picked: f.node }); }
  const { lo, hi } = scene.box, size = Math.max(hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2], 1);
  const at = f.at ?? (f.node !== null && f.node < scene.path.count ? motionOf(scene).tip(f.node) : null);
  if (at) lookAt(store, at, SPAN * size);
}
function row(scene: Scene, store: Store, f: Finding): HTMLElement {
  const there = f.node !== null || f.at !== null, time = f.node !== null && f.node < scene.path.count ? scene.path.time[f.node] : null;
  const content = [icon(f.level > 0 ? "findings" : "messages"), el("b", {}, f.title), time !== null && el("time", {}, duration(time)), f.detail && el("span", { class: "detail" }, f.detail)];
  const b = there ? el("button", { type: "button", class: `finding l${f.level}`, title: "Show the place", onclick: () => {
    b.parentElement?.querySelector("[aria-current]")?.removeAttribute("aria-current");
    b.setAttribute("aria-current", "true"); showFinding(scene, store, f);
  } }, ...content) : el("div", { class: `finding l${f.level}` }, ...content);
  b.setAttribute("aria-label", `${NAMES[f.level]}: ${f.title}`);
  return b;
}

export const findingsPanel: Panel = {
  id: "findings", title: "Findings",
  make(scene: Scene, store: Store): HTMLElement | null {
    const all = scene.findings.map((f, k) => ({ f, k })).filter(q => q.f.level > 0).sort((a, b) => b.f.level - a.f.level || a.k - b.k).map(q => q.f);
    const box = el("div", { class: "column" }), list = el("div", { style: "overflow:auto;flex:1" });
    if (all.length === 0) {
      if (scene.findings.length === 0 && scene.histograms.length === 0) return null;
      box.append(el("p", { class: "empty" }, "No faults, no warnings."));
      return box;
    }
    const levels = new Set([1, 2]), words = el("input", { type: "search", placeholder: "Filter", "aria-label": "Filter the findings" });
    let shown = 0, chosen = all;
    const more = () => { for (const end = Math.min(chosen.length, shown + STEP); shown < end; ++shown) list.append(row(scene, store, chosen[shown])); };
    const fill = () => {
      const q = words.value.trim().toLowerCase();
      chosen = all.filter(f => levels.has(f.level) && (q === "" || `${f.title} ${f.detail}`.toLowerCase().includes(q)));
      shown = 0; list.replaceChildren(); more();
      if (chosen.length === 0) list.append(el("p", { class: "empty" }, "Nothing of that kind."));
    };
    const filters = el("div", { class: "filters" });
    for (const level of [2, 1]) {
      const n = all.filter(f => f.level === level).length;
      if (n === 0) continue;
      const b = el("button", { type: "button", class: "chip", "aria-pressed": "true", onclick: () => { if (!levels.delete(level)) levels.add(level); b.setAttribute("aria-pressed", String(levels.has(level))); fill(); } }, `${count(n)} ${NAMES[level]}${n === 1 ? "" : "s"}`);
      filters.append(b);
    }
    words.addEventListener("input", fill);
    words.style.cssText = "flex:1;min-width:6rem";
    if (all.length > 8) filters.append(words);
    list.addEventListener("scroll", () => { if (list.scrollTop + list.clientHeight > list.scrollHeight - 400) more(); });
    fill(); box.append(filters, list);
    return box;
  },
};

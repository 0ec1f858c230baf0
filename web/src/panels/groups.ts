// SPDX-License-Identifier: Apache-2.0
// Contours, passes or operations: their time and way, one alone, or going there.
import type { Panel } from "../panels";
import type { Scene } from "../scene";
import type { Store } from "../state";
import { css, groupColour, isDark } from "../colours";
import { duration, length } from "../logic/format";
import { groupSums } from "../logic/groups";
import { isolate } from "../legend";
import { goNode, motionOf } from "../seek";
import { button, el } from "../ui";

const STEP = 300;
export const groupsPanel: Panel = {
  id: "groups", title: "Groups",
  make(scene: Scene, store: Store): HTMLElement | null {
    if (scene.groups.length < 2 || scene.path.count < 2) return null;
    const sums = groupSums(scene.path, motionOf(scene).length, scene.groups.length), body = el("tbody"), rows: HTMLTableRowElement[] = [];
    const box = el("div", { class: "scrolls" }, el("table", { class: "list" }, el("thead", {}, el("tr", {}, ...["group", "time", "cut", ""].map(t => el("th", {}, t)))), body));
    const row = (k: number) => {
      const go = () => { if (sums.first[k] >= 0) goNode(scene, store, sums.first[k]); }, swatch = el("i", { class: "swatch" });
      swatch.style.color = css(groupColour(k, isDark(store.state)));
      const only = button("eye", `Show only ${scene.groups[k]}`, () => isolate(store, k), { class: "small" });
      only.addEventListener("click", e => e.stopPropagation());
      const tr = el("tr", { tabindex: 0, title: "Go to its beginning", onclick: go }, el("td", {}, swatch, ` ${scene.groups[k]}`), el("td", {}, duration(sums.time[k], 1)), el("td", {}, length(sums.cut[k])), el("td", {}, only));
      tr.addEventListener("keydown", e => { if (e.key === "Enter" && e.target === tr) go(); });
      rows[k] = tr;
      return tr;
    };
    const more = () => { for (const end = Math.min(scene.groups.length, rows.length + STEP); rows.length < end;) body.append(row(rows.length)); mark(); };
    const mark = () => {
      const { node, only } = store.state, now = scene.path.group[node];
      rows.forEach((r, k) => { r.classList.toggle("on", k === now); r.querySelector("button")?.setAttribute("aria-pressed", String(only === k)); });
    };
    let last = -1;
    store.on(["node", "only"], (s, changed) => { const g = scene.path.group[s.node]; if (g !== last || changed.has("only")) { last = g; mark(); } });
    store.on(["theme"], s => rows.forEach((r, k) => { const i = r.querySelector<HTMLElement>("i"); if (i) i.style.color = css(groupColour(k, isDark(s))); }));
    box.addEventListener("scroll", () => { if (box.scrollTop + box.clientHeight > box.scrollHeight - 500) more(); });
    more();
    return box;
  },
};

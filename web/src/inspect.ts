// SPDX-License-Identifier: Apache-2.0
// Over a corner of the stage: what is known of the node under the pointer, else of the picked one.
import type { Scene } from "./scene";
import type { Store } from "./state";
import { KINDS } from "./colours";
import { brief, duration, fixed } from "./logic/format";
import { motionOf } from "./seek";
import { el } from "./ui";

const MOST_SERIES = 6;
export function makeInspect(scene: Scene, store: Store): HTMLElement {
  const { path } = scene, box = el("div", { class: "inspect nums", hidden: true }), m = motionOf(scene);
  const row = (name: string, value: string) => el("div", {}, el("dt", {}, name), el("dd", {}, value));
  const show = () => {
    const n = store.state.hovered ?? store.state.picked;
    box.hidden = n === null || n >= path.count;
    if (n === null || n >= path.count) return;
    const list = el("dl", {}, row("at", m.tip(n).map(v => fixed(v, 3)).join("  ")));
    if (path.axis) list.append(row("axis", m.axis(n).map(v => fixed(v, 4)).join("  ")));
    list.append(row("way", `${KINDS[path.kind[n]] ?? ""}${path.feed[n] > 0 ? `, ${brief(path.feed[n])} mm/min` : ""}`), row("time", duration(path.time[n])));
    if (path.line[n] > 0) list.append(row("line", String(path.line[n])));
    if (scene.groups.length > 1) list.append(row("in", scene.groups[path.group[n]] ?? "-"));
    for (const s of scene.series.slice(0, MOST_SERIES)) if (Number.isFinite(s.value[n])) list.append(row(s.name, `${brief(s.value[n])} ${s.unit}`));
    box.replaceChildren(el("b", {}, `node ${n}${store.state.hovered === null ? "" : store.state.hovered === store.state.picked ? ", picked" : ""}`), list);
  };
  store.on(["hovered", "picked"], show);
  return box;
}

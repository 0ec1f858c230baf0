// SPDX-License-Identifier: Apache-2.0
// Figures of the result, by group; what is drawn; the command that made the page.
import type { Panel } from "../panels";
import type { Figure, Scene } from "../scene";
import { brief, count } from "../logic/format";
import { button, copy, el } from "../ui";

/** As a spreadsheet takes it. */
export const asText = (list: Figure[]): string => list.map(f => `${f.group}\t${f.name}\t${f.value}`).join("\n");

/** Numbers with more digits than are read are cut here; what is copied has all of them. */
const shown = (value: string): string => value.replace(/-?\d+\.\d{5,}/g, v => String(Number(Number(v).toPrecision(6))));
function drawn(scene: Scene): Figure[] {
  const list: Figure[] = [], group = "Drawn", add = (name: string, value: string) => list.push({ group, name, value });
  if (scene.path.count > 1) add("path nodes", count(scene.path.count));
  for (const m of scene.meshes) add(m.name || "mesh", `${count(m.triangles)}${m.of > m.triangles ? ` of ${count(m.of)}` : ""} triangles`);
  if (scene.outlines.length) add("curves", count(scene.outlines.length));
  if (scene.stock) add("stock grid", `${scene.stock.count.join(" \u00d7 ")}, ${brief(scene.stock.step)} mm`);
  if (scene.program.lines) add(scene.program.name || "program", `${count(scene.program.lines)} lines${scene.program.cut ? ", cut" : ""}`);
  scene.tools.forEach(t => list.push({ group: "Tools", name: `T${t.number}`, value: t.name }));
  if (scene.machine) list.push({ group: "Machine", name: scene.machine.name, value: scene.machine.axes.map(a => `${a.letter} (${a.table ? "table" : "head"})`).join(", ") || "no rotary axes" });
  return list;
}

export const figuresPanel: Panel = {
  id: "figures", title: "Figures",
  make(scene: Scene): HTMLElement | null {
    const own = [...scene.figures, ...drawn(scene)];
    if (own.length === 0 && !scene.command) return null;
    const box = el("div", { class: "scrolls figures", tabindex: 0, "aria-label": "Figures" });
    for (const group of new Set(own.map(f => f.group))) {
      const rows = own.filter(f => f.group === group);
      box.append(el("h3", {}, group || "Result", button("copy", `Copy ${group || "the figures"}`, () => void copy(asText(rows), group || "Figures"), { class: "small" })),
        el("table", {}, el("tbody", {}, ...rows.map(f => el("tr", {}, el("td", {}, f.name), el("td", { title: f.value }, shown(f.value)))))));
    }
    if (scene.command) box.append(el("h3", {}, "Command", button("copy", "Copy the command", () => void copy(scene.command, "Command"), { class: "small" })), el("p", { class: "cmd" }, scene.command));
    return box;
  },
};

// SPDX-License-Identifier: Apache-2.0
// Notes that are no fault: what was left out or thinned, what the operation had to say.
import type { Panel } from "../panels";
import type { Scene } from "../scene";
import { count } from "../logic/format";
import { showFinding } from "./findings";
import { el, icon } from "../ui";

export function notes(scene: Scene): string[] {
  const out: string[] = [];
  for (const m of scene.meshes) if (m.of > m.triangles) out.push(`${m.name || "A mesh"} is drawn with ${count(m.triangles)} of its ${count(m.of)} triangles; figures are those of the whole.`);
  if (scene.program.cut) out.push(`The listing ends after ${count(scene.program.lines)} lines: the file is longer.`);
  if (scene.path.count === 0) out.push("There is no tool path in this page.");
  return out;
}
export const messagesPanel: Panel = {
  id: "messages", title: "Messages",
  make(scene, store): HTMLElement | null {
    const own = scene.findings.filter(f => f.level === 0), page = notes(scene);
    if (own.length + page.length === 0) return null;
    const box = el("div", { style: "overflow:auto" });
    for (const f of own.slice(0, 2000)) {
      const content = [icon("messages"), el("b", {}, f.title), f.detail && el("span", { class: "detail" }, f.detail)];
      box.append(f.at || f.node !== null ? el("button", { type: "button", class: "finding l0", onclick: () => showFinding(scene, store, f) }, ...content) : el("div", { class: "finding l0" }, ...content));
    }
    if (own.length > 2000) page.push(`${count(own.length - 2000)} more messages are not listed.`);
    for (const t of page) box.append(el("div", { class: "finding l0" }, icon("messages"), el("span", {}, t)));
    return box;
  },
};

// SPDX-License-Identifier: Apache-2.0
// A place of the path seen closely: what passes leave between them (scallops), or the cut of a beam (kerf).
import type { Panel } from "../panels";
import type { Scene } from "../scene";
import type { Store } from "../state";
import { focus } from "../seek";
import { el } from "../ui";
import { kerfView } from "./kerf";
import { scallopView } from "./scallop";

/** One of the views of this panel: told the node, only while it is seen. */
export interface CloseUp { box: HTMLElement; show: (node: number) => void }
/** Shortest time between two pictures while it plays, ms. */
const PAUSE = 160;

export const closeupPanel: Panel = {
  id: "closeup", title: "Close-up",
  make(scene: Scene, store: Store): HTMLElement | null {
    if (scene.path.count < 2) return null;
    const beam = scene.tools.some(t => t.kerf > 0), cutter = scene.tools.some(t => t.pieces.some(p => p.kind === 0));
    if (!beam && !cutter) return null;
    const view: CloseUp = beam ? kerfView(scene, store) : scallopView(scene, store), box = el("div", { class: "column" }, view.box);
    let last = 0, waiting = 0, shown = -1;
    const now = () => { waiting = 0; last = performance.now(); const n = focus(store); if (box.clientHeight > 0 && n !== shown) { shown = n; view.show(n); } };
    const ask = () => { if (!waiting && box.clientHeight > 0) waiting = window.setTimeout(now, Math.max(0, last + (store.state.playing ? PAUSE : 30) - performance.now())); };
    store.on(["node", "picked"], ask);
    new ResizeObserver(ask).observe(box);
    return box;
  },
};

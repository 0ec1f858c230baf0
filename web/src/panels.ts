// SPDX-License-Identifier: Apache-2.0
// The side of the page: lists, tables, charts. Each panel is one file in panels/ with this shape.
import type { Scene } from "./scene";
import type { Store } from "./state";
import { anglesPanel } from "./panels/angles";
import { chartsPanel } from "./panels/charts";
import { closeupPanel } from "./panels/closeup";
import { deviationPanel } from "./panels/deviation";
import { figuresPanel } from "./panels/figures";
import { findingsPanel } from "./panels/findings";
import { groupsPanel } from "./panels/groups";
import { messagesPanel } from "./panels/messages";
import { programPanel } from "./panels/program";

export interface Panel {
  id: string;
  title: string;
  /** Nothing when the scene has nothing for it. What costs time waits until it is seen (ResizeObserver). */
  make(scene: Scene, store: Store): HTMLElement | null;
}
/** In the order of their tabs; the first that is there is open. */
export const PANELS: Panel[] = [findingsPanel, figuresPanel, programPanel, deviationPanel, chartsPanel, anglesPanel, closeupPanel, groupsPanel, messagesPanel];
/** A wish of one part of the page to see a panel. */
export function openPanel(id: string): void { document.dispatchEvent(new CustomEvent("open-panel", { detail: id })); }

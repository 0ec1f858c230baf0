// SPDX-License-Identifier: Apache-2.0
// The side of the page: lists, tables, charts. Each panel is one file in panels/ with this shape.
import type { Scene } from "./scene";
import type { Store } from "./state";

export interface Panel {
  id: string;
  title: string;
  /** Nothing when the scene has nothing for it. */
  make(scene: Scene, store: Store): HTMLElement | null;
}

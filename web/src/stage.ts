// SPDX-License-Identifier: Apache-2.0
// What stands in the middle of the page.
import type { Scene } from "./scene";
import type { Store } from "./state";

export class Stage {
  constructor(readonly box: HTMLElement, readonly scene: Scene, readonly store: Store) {}
}

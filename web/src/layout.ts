// SPDX-License-Identifier: Apache-2.0
// The stage alone, until there is more.
import type { Scene } from "./scene";
import type { Store } from "./state";

export function makeLayout(app: HTMLElement, _scene: Scene, _store: Store): { stage: HTMLElement } {
  const stage = document.createElement("div");
  stage.style.cssText = "position:fixed;inset:0";
  app.append(stage);
  return { stage };
}

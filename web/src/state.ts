// SPDX-License-Identifier: Apache-2.0
// What the user has chosen, in one place: the stage and the panels change it with set() and are told of it.

export type View = "fit" | "iso" | "top" | "bottom" | "front" | "back" | "left" | "right" | "tool";
export interface State {
  time: number; // s on the path
  playing: boolean;
  speed: number; // times real time
  node: number; // of the path, the one at or before `time`
  picked: number | null; // node the user chose
  hovered: number | null;
  trial: { tip: [number, number, number]; axis: [number, number, number] } | null; // the tool is shown there instead; part coordinates
  colour: string; // "kind" | "group" | "feed" | "series:K" | "plain"
  range: [number, number] | null; // of the colours of feed or a series; null: from what is there
  heat: boolean; // deviation on the part
  heatRange: number; // mm to either side; 0: the mesh's own
  only: number | null; // group that alone is shown
  show: { part: boolean; path: boolean; rapids: boolean; tool: boolean; holder: boolean; stock: boolean; obstacles: boolean; ahead: boolean };
  view: { name: View; serial: number } | null; // a wish to the stage
  perspective: boolean;
  asMachine: boolean; // table axes turn the part
  section: { on: boolean; axis: 0 | 1 | 2; at: number; flip: boolean };
  measuring: boolean;
  measured: [number, number, number][]; // part coordinates, at most two
  lookAt: { at: [number, number, number]; span: number; serial: number } | null; // part coordinates; a wish of a panel to the stage
  theme: "light" | "dark" | "system";
}

type Listener = (state: Readonly<State>, changed: ReadonlySet<keyof State>) => void;

export class Store {
  private listeners: { keys: (keyof State)[]; call: Listener }[] = [];
  private changed = new Set<keyof State>();
  private asked = false;
  constructor(private current: State) {}
  get state(): Readonly<State> { return this.current; }
  /** Listeners hear of it once, before the next frame. */
  set(change: Partial<State>): void {
    for (const key of Object.keys(change) as (keyof State)[]) {
      if (Object.is(this.current[key], change[key])) continue;
      (this.current as unknown as Record<string, unknown>)[key] = change[key];
      this.changed.add(key);
    }
    if (this.changed.size > 0 && !this.asked) { this.asked = true; queueMicrotask(() => this.tell()); }
  }
  on(keys: (keyof State)[], call: Listener): void { this.listeners.push({ keys, call }); }
  private tell(): void {
    const changed = this.changed; this.changed = new Set(); this.asked = false;
    for (const l of this.listeners) if (l.keys.some(k => changed.has(k))) l.call(this.current, changed);
  }
}

export function initialState(): State {
  return {
    time: 0, playing: false, speed: 1, node: 0, picked: null, hovered: null, trial: null, colour: "kind", range: null, heat: false, heatRange: 0, only: null,
    show: { part: true, path: true, rapids: true, tool: true, holder: true, stock: false, obstacles: true, ahead: true },
    view: null, perspective: false, asMachine: false, section: { on: false, axis: 0, at: 0, flip: false }, measuring: false, measured: [], lookAt: null, theme: "system",
  };
}

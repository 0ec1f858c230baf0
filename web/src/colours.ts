// SPDX-License-Identifier: Apache-2.0
// Colours of values, the same on the stage, in legends and in charts.
import { Kind, Role } from "./scene";
import type { Mesh, Scene } from "./scene";
import type { State } from "./state";

export type Rgb = [number, number, number]; // 0..1, as CSS has them (sRGB)

export const KINDS = ["rapid", "feed", "link", "dwell"];
const KIND_LIGHT: Rgb[] = [[0.54, 0.58, 0.64], [0.04, 0.38, 0.77], [0.0, 0.54, 0.48], [0.56, 0.27, 0.68]];
const KIND_DARK: Rgb[] = [[0.46, 0.51, 0.56], [0.42, 0.7, 1.0], [0.3, 0.82, 0.72], [0.78, 0.57, 0.92]];
// Told apart by eye and, the first eight, by the colour-blind; repeats after twelve.
const GROUP_LIGHT = [0x0b62c4, 0xd1570a, 0x1b8a5a, 0xa8328c, 0x8a6d00, 0x0d8fa8, 0xc62828, 0x5b4bb5, 0x5f7d1c, 0x9a5b3c, 0x4a6b8a, 0xb0447a];
const GROUP_DARK = [0x6cb2ff, 0xffa057, 0x5fd39b, 0xee8bd6, 0xe0c14a, 0x5ad1e8, 0xff7b7b, 0xab9dfa, 0xb4d665, 0xdca283, 0x9fbfdd, 0xf593c0];
// Perceptually even (viridis); its dark end is lifted in the dark theme so that it is seen on the sheet.
const RAMP: Rgb[] = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [240, 210, 40]];
const RAMP_DARK: Rgb[] = [[126, 62, 158], [78, 112, 184], [42, 160, 158], [104, 206, 110], [250, 224, 70]];
// Below (gouge) red, 0 pale, above (excess) blue.
const DIVERGE: Rgb[] = [[165, 15, 30], [222, 84, 62], [247, 178, 143], [238, 238, 232], [158, 202, 230], [66, 134, 198], [15, 60, 140]];
const DIVERGE_DARK: Rgb[] = [[255, 66, 72], [226, 92, 76], [160, 92, 80], [104, 112, 120], [86, 124, 160], [84, 156, 222], [120, 196, 255]];

function stops(list: Rgb[], t: number): Rgb {
  const u = Math.min(1, Math.max(0, Number.isFinite(t) ? t : 0)) * (list.length - 1);
  const i = Math.min(list.length - 2, Math.floor(u)), f = u - i, a = list[i]!, b = list[i + 1]!;
  return [0, 1, 2].map(k => (a[k]! + f * (b[k]! - a[k]!)) / 255) as Rgb;
}
export const kindColour = (kind: Kind, dark: boolean): Rgb => (dark ? KIND_DARK : KIND_LIGHT)[kind] ?? [0.5, 0.5, 0.5];
export function groupColour(group: number, dark: boolean): Rgb {
  const c = (dark ? GROUP_DARK : GROUP_LIGHT)[group % 12]!;
  return [(c >> 16) / 255, ((c >> 8) & 255) / 255, (c & 255) / 255];
}
/** t from 0 to 1. */
export const rampColour = (t: number, dark: boolean): Rgb => stops(dark ? RAMP_DARK : RAMP, t);
/** t from -1 (too deep) over 0 to 1 (left standing). */
export const divergingColour = (t: number, dark: boolean): Rgb => stops(dark ? DIVERGE_DARK : DIVERGE, (t + 1) / 2);
export const NONE: Rgb = [0.6, 0.62, 0.66]; // no value
export const css = (c: Rgb): string => `rgb(${c.map(v => Math.round(255 * v)).join(" ")})`;
export const gradient = (of: (t: number) => Rgb, from: number, to: number): string =>
  `linear-gradient(90deg, ${Array.from({ length: 13 }, (_, i) => css(of(from + (to - from) * i / 12))).join(", ")})`;

/** What a path is coloured by: a value a node, or names. */
export interface Colouring {
  name: string; unit: string; signed: boolean;
  names: string[] | null; // of the values when they are indices
  value: ArrayLike<number> | null; // null: one colour
  lo: number; hi: number;
  colour(value: number, dark: boolean): Rgb;
}
/** Smallest and largest finite value but for the outer `cut` of them (a single peak would take the colours from all others). */
export function rangeOf(value: ArrayLike<number>, cut = 0): [number, number] {
  const n = value.length, step = Math.max(1, Math.floor(n / 20000)), all: number[] = [];
  let lo = Infinity, hi = -Infinity;
  for (let i = 0; i < n; ++i) {
    const v = value[i]!;
    if (!Number.isFinite(v)) continue;
    if (v < lo) lo = v;
    if (v > hi) hi = v;
    if (cut > 0 && i % step === 0) all.push(v);
  }
  if (!(lo <= hi)) return [0, 1];
  if (cut > 0 && all.length > 100) {
    all.sort((a, b) => a - b);
    const a = all[Math.floor(cut * (all.length - 1))]!, b = all[Math.ceil((1 - cut) * (all.length - 1))]!;
    if (b > a) return [a, b];
  }
  return lo < hi ? [lo, hi] : [lo - 0.5, hi + 0.5];
}
const measured = new WeakMap<object, [number, number]>(); // ranges are asked for often, the columns do not change
function keptRange(value: ArrayLike<number> & object, cut: number): [number, number] {
  let r = measured.get(value);
  if (!r) { r = rangeOf(value, cut); measured.set(value, r); }
  return r;
}
export function colouring(scene: Scene, state: Pick<State, "colour" | "range">): Colouring {
  const { path } = scene, c = state.colour;
  const indexed = (name: string, value: ArrayLike<number>, names: string[], of: (v: number, dark: boolean) => Rgb): Colouring =>
    ({ name, unit: "", signed: false, names, value, lo: 0, hi: names.length - 1, colour: of });
  if (c === "kind") return indexed("kind of move", path.kind, KINDS, (v, d) => kindColour(v, d));
  if (c === "group") return indexed("group", path.group, scene.groups, groupColour);
  const k = c.startsWith("series:") ? Number(c.slice(7)) : -1, series = scene.series[k];
  const value = series ? series.value : c === "feed" ? path.feed : null;
  if (!value) return { name: "one colour", unit: "", signed: false, names: null, value: null, lo: 0, hi: 1, colour: (_, d) => kindColour(Kind.feed, d) };
  let [lo, hi] = state.range ?? keptRange(value, 0.005);
  const signed = series?.signed ?? false;
  if (signed && !state.range) { hi = Math.max(Math.abs(lo), Math.abs(hi)); lo = -hi; }
  return {
    name: series?.name ?? "feed", unit: series?.unit ?? "mm/min", signed, names: null, value, lo, hi,
    colour(v, dark) {
      if (!Number.isFinite(v)) return NONE;
      const t = (v - lo) / (hi - lo || 1);
      return signed ? divergingColour(2 * t - 1, dark) : rampColour(t, dark);
    },
  };
}
/** Colours of a heat map run from -range to +range. */
export function heatRange(mesh: Pick<Mesh, "value" | "valueRange">, asked: number): number {
  if (asked > 0) return asked;
  if (mesh.valueRange > 0) return mesh.valueRange;
  if (!mesh.value) return 1;
  const [lo, hi] = keptRange(mesh.value, 0.002);
  return Math.max(Math.abs(lo), Math.abs(hi)) || 1;
}
export const roleName = (role: Role): string => ["part", "stock", "obstacle", "result"][role] ?? "mesh";
export function isDark(state: Pick<State, "theme">): boolean {
  return state.theme === "system" ? matchMedia("(prefers-color-scheme: dark)").matches : state.theme === "dark";
}
/** What the deviation is shown on: the meshes that have one, else the outlines; null: none. */
export function heated(scene: Scene): { name: string; unit: string; range(asked: number): number } | null {
  const mesh = scene.meshes.find(m => m.value && m.role === Role.design) ?? scene.meshes.find(m => m.value);
  if (mesh) return { name: mesh.valueName || "deviation", unit: mesh.valueUnit || "mm", range: asked => heatRange(mesh, asked) };
  let largest = 0;
  for (const o of scene.outlines) if (o.value) for (const v of o.value) if (Math.abs(v) > largest) largest = Math.abs(v);
  return scene.outlines.some(o => o.value) ? { name: "deviation", unit: "mm", range: asked => asked > 0 ? asked : largest || 1 } : null;
}

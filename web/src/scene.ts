// SPDX-License-Identifier: Apache-2.0
// The scene as the page holds it. docs/viewer.md says how it is written down. mm, degrees, s.

export enum Kind { rapid = 0, feed = 1, link = 2, dwell = 3 }
export type Vec = [number, number, number];

/** Columns, one row a node; row 0 is where the motion begins, what a row says of a way is about the way that ends there. */
export interface Path {
  count: number;
  point: Float32Array; // 3 a node; less scene.center, so that single precision is enough
  axis: Float32Array | null; // 3 a node, unit; null: all 0, 0, 1
  time: Float64Array; // s from the start
  kind: Uint8Array;
  feed: Float32Array; // mm/min, as programmed
  move: Uint32Array; // GOTO number
  line: Uint32Array; // of the program text, from 1; 0: none
  tool: Uint8Array;
  group: Uint16Array;
  rotary: Float32Array | null; // 2 a node, degrees
}
export interface Series { name: string; unit: string; signed: boolean; value: Float32Array }
export enum Role { design = 0, stock = 1, obstacle = 2, result = 3 }
export interface Mesh {
  name: string; role: Role;
  point: Float32Array; index: Uint32Array; // less scene.center
  value: Float32Array | null; valueName: string; valueUnit: string; valueRange: number; // 0: from the values
  triangles: number; of: number; // shown, of how many
}
export interface Outline { name: string; part: boolean; closed: boolean; point: Float32Array; value: Float32Array | null }
export interface Piece { kind: 0 | 1 | 2; radius: number; low: number; high: number; corner: number } // 0 cutter, 1 shank, 2 holder
export interface Tool { number: number; name: string; kerf: number; pieces: Piece[] }
export interface Axis { letter: string; table: boolean; direction: Vec; point: Vec }
export interface Machine { name: string; axes: Axis[] }
/** When each node of a grid lost its material: 0 was never there, NEVER stays, else 1 + GOTO number. */
export interface StockClock { count: Vec; origin: Vec; step: number; cut: Uint32Array; crossing: Uint8Array } // origin in part coordinates
export const NEVER = 0xffffffff;
export interface CSpace {
  node: number; label: string; tilt: [number, number]; yaw: [number, number]; tilts: number; yaws: number;
  cause: Uint8Array; radius: Float32Array | null; chosen: [number, number]; initial: [number, number] | null; // tilt, yaw
}
export interface Finding { level: 0 | 1 | 2; title: string; detail: string; at: Vec | null; node: number | null }
export interface Figure { group: string; name: string; value: string }
export interface Histogram { name: string; unit: string; from: number; step: number; area: number[]; tolerance: number }

export interface Scene {
  title: string; operation: string; command: string;
  center: Vec; // taken off all points of path, meshes and outlines
  box: { lo: Vec; hi: Vec }; // part coordinates
  path: Path; groups: string[]; series: Series[]; meshes: Mesh[]; outlines: Outline[]; tools: Tool[]; machine: Machine | null;
  stock: StockClock | null; cspaces: CSpace[]; causes: string[]; findings: Finding[]; figures: Figure[]; histograms: Histogram[];
  program: { name: string; lines: number; cut: boolean; text: string };
}

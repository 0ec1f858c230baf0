// SPDX-License-Identifier: Apache-2.0
// Container -> Scene, as docs/viewer.md says. Everything in it is checked: a damaged page says so and does not hang.
import { Role } from "./scene";
import type { Axis, CSpace, Figure, Finding, Histogram, Machine, Mesh, Outline, Path, Scene, Series, StockClock, Tool, Vec } from "./scene";

export type Progress = (share: number, what: string) => void;

/** What is wrong with the data, for the reader of the page. */
export class DamagedScene extends Error {}

const MAX_NODES = 20_000_000;
/** Of one chunk after inflation: more than any scene holds, less than a browser gives up at. */
const MAX_CHUNK_BYTES = 1 << 30;
const MAX_TEXT_BYTES = 64 << 20;
const NONE = 0x7fffffff;

interface Chunk {
  name: string; type: "u8" | "u16" | "u32" | "i32" | "f32" | "text"; components: number; count: number; coding: "plain" | "delta" | "text";
  scale?: number | number[]; offset?: number[]; none?: boolean; at: number; bytes: number;
}
interface Directory {
  version: number; title: string; operation: string; command: string; groups: string[]; tools: Tool[]; machine: Machine | null; causes: string[];
  findings: Finding[]; figures: Figure[]; histograms: Histogram[]; series: { name: string; unit: string; signed: boolean }[];
  meshes: { name: string; role: number | string; valueName: string; valueUnit: string; valueRange: number; triangles: number; of: number }[];
  outlines: { name: string; part: boolean; closed: boolean }[];
  cspaces: { node: number; label: string; tilt: [number, number]; yaw: [number, number]; tilts: number; yaws: number; chosen: [number, number]; initial: [number, number] | null }[];
  stock: { count: Vec; origin: Vec; step: number } | null; program: { name: string; lines: number; cut: boolean };
  nodes: number; box: { lo: Vec; hi: Vec }; chunks: Chunk[];
}

function damaged(what: string): never {
  throw new DamagedScene(`The data of this page is damaged: ${what} (a page written by "burin view", complete).`);
}

const BASE64 = (() => {
  const table = new Uint8Array(128).fill(255);
  const letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (let i = 0; i < 64; ++i) table[letters.charCodeAt(i)] = i;
  return table;
})();

/** White space at both ends is allowed, nothing else than base64 between. */
export function fromBase64(text: string): Uint8Array {
  text = text.trim();
  let end = text.length;
  while (end > 0 && text.length - end < 2 && text.charCodeAt(end - 1) === 61) --end;
  if (end % 4 === 1) damaged("its text ends in the middle");
  const out = new Uint8Array(Math.floor(end * 3 / 4));
  const six = (i: number): number => {
    const c = text.charCodeAt(i);
    const v = c < 128 ? BASE64[c]! : 255;
    if (v === 255) damaged(`letter ${i} is not base64`);
    return v;
  };
  let at = 0;
  const whole = end - end % 4;
  for (let i = 0; i < whole; i += 4) {
    const v = six(i) << 18 | six(i + 1) << 12 | six(i + 2) << 6 | six(i + 3);
    out[at++] = v >> 16; out[at++] = v >> 8; out[at++] = v;
  }
  if (end - whole >= 2) {
    const v = six(whole) << 18 | six(whole + 1) << 12 | (end - whole > 2 ? six(whole + 2) << 6 : 0);
    out[at++] = v >> 16;
    if (end - whole > 2) out[at++] = v >> 8;
  }
  return out;
}

/** Inflates to exactly `expected` bytes; null: to as many as there are, at most MAX_TEXT_BYTES. */
async function inflate(packed: Uint8Array, expected: number | null, name: string): Promise<Uint8Array> {
  const stream = new DecompressionStream("deflate");
  const writer = stream.writable.getWriter();
  // Errors of the writer come out of the reader too; the promises only must not stay unheard.
  writer.write(packed).catch(() => {}); writer.close().catch(() => {});
  const reader = stream.readable.getReader();
  const limit = expected ?? MAX_TEXT_BYTES;
  const pieces: Uint8Array[] = [];
  let have = 0;
  const whole = expected === null ? null : new Uint8Array(expected);
  for (;;) {
    let step: ReadableStreamReadResult<Uint8Array>;
    try { step = await reader.read(); } catch { damaged(`chunk ${name} cannot be inflated`); }
    if (step.done) break;
    if (have + step.value.length > limit) { void reader.cancel().catch(() => {}); damaged(`chunk ${name} holds more than ${limit} bytes`); }
    if (whole) whole.set(step.value, have); else pieces.push(step.value);
    have += step.value.length;
  }
  if (whole) {
    if (have !== expected) damaged(`chunk ${name} holds ${have} of ${expected} bytes`);
    return whole;
  }
  const all = new Uint8Array(have);
  let at = 0;
  for (const p of pieces) { all.set(p, at); at += p.length; }
  return all;
}

const WIDTH = { u8: 1, u16: 2, u32: 4, i32: 4, f32: 4, text: 1 };
type Out = Float32Array | Float64Array | Uint32Array | Uint16Array | Uint8Array;

function shiftOf(chunk: Chunk, less: Vec | null): { scale: number[]; offset: number[] } {
  const scale: number[] = [], offset: number[] = [];
  for (let c = 0; c < chunk.components; ++c) {
    const s = Array.isArray(chunk.scale) ? chunk.scale[c] : chunk.scale;
    scale.push(s ?? 1); offset.push((chunk.offset?.[c] ?? 0) - (less?.[c] ?? 0));
  }
  return { scale, offset };
}

function unpackDelta(chunk: Chunk, bytes: Uint8Array, out: Out, less: Vec | null): void {
  const C = chunk.components, n = chunk.count * C, n2 = 2 * n, n3 = 3 * n;
  const { scale, offset } = shiftOf(chunk, less);
  const none = chunk.none === true;
  const asInteger = out instanceof Uint32Array;
  for (let c = 0; c < C; ++c) {
    const s = scale[c]!, o = offset[c]!;
    let value = 0;
    for (let i = c; i < n; i += C) {
      const z = bytes[i]! | bytes[n + i]! << 8 | bytes[n2 + i]! << 16 | bytes[n3 + i]! << 24;
      value = (value + (z >>> 1 ^ -(z & 1))) | 0;
      out[i] = asInteger ? value >>> 0 : none && value === NONE ? NaN : o + s * value;
    }
  }
}

function unpackPlain(chunk: Chunk, bytes: Uint8Array, out: Out, less: Vec | null): void {
  const n = chunk.count * chunk.components;
  const { scale, offset } = shiftOf(chunk, less);
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const read = chunk.type === "u8" ? (i: number) => bytes[i]!
    : chunk.type === "u16" ? (i: number) => view.getUint16(2 * i, true)
    : chunk.type === "u32" ? (i: number) => view.getUint32(4 * i, true)
    : chunk.type === "i32" ? (i: number) => view.getInt32(4 * i, true)
    : (i: number) => view.getFloat32(4 * i, true);
  for (let i = 0, c = 0; i < n; ++i) { out[i] = offset[c]! + scale[c]! * read(i); if (++c === chunk.components) c = 0; }
}

class Reader {
  private chunks = new Map<string, Chunk>();
  private done = 0;
  private all = 0;
  constructor(private bytes: Uint8Array, private base: number, list: Chunk[], private progress: Progress) {
    for (const c of list) { this.chunks.set(c.name, c); this.all += c.bytes; }
  }
  has(name: string): boolean { return this.chunks.has(name); }
  private find(name: string): Chunk { return this.chunks.get(name) ?? damaged(`chunk ${name} is missing`); }
  count(name: string): number { return this.find(name).count; }

  private async raw(chunk: Chunk, expected: number | null): Promise<Uint8Array> {
    const from = this.base + chunk.at;
    if (!(chunk.at >= 0 && chunk.bytes >= 0 && from + chunk.bytes <= this.bytes.length)) damaged(`chunk ${chunk.name} ends behind the file`);
    const out = await inflate(this.bytes.subarray(from, from + chunk.bytes), expected, chunk.name);
    this.done += chunk.bytes;
    this.progress(this.done / Math.max(1, this.all), chunk.name);
    return out;
  }
  async into<T extends Out>(name: string, rows: number, components: number, make: new (n: number) => T, less: Vec | null = null): Promise<T> {
    const chunk = this.find(name);
    if (chunk.count !== rows || chunk.components !== components) damaged(`chunk ${name} has ${chunk.count} x ${chunk.components} values, not ${rows} x ${components}`);
    const width = WIDTH[chunk.type];
    if (!width || !(rows >= 0) || rows * components * width > MAX_CHUNK_BYTES) damaged(`chunk ${name} is too large`);
    const bytes = await this.raw(chunk, rows * components * width);
    if (chunk.coding === "plain" && chunk.type === "u8" && make === (Uint8Array as unknown) && !chunk.scale && !chunk.offset) return bytes as T;
    const out = new make(rows * components);
    if (chunk.coding === "delta" && width === 4) unpackDelta(chunk, bytes, out, less);
    else if (chunk.coding === "plain") unpackPlain(chunk, bytes, out, less);
    else damaged(`chunk ${name} is coded as "${chunk.coding}"`);
    return out;
  }
  async maybe<T extends Out>(name: string, rows: number, components: number, make: new (n: number) => T): Promise<T | null> {
    return this.has(name) ? this.into(name, rows, components, make) : null;
  }
  async text(name: string): Promise<string> {
    return this.has(name) ? new TextDecoder().decode(await this.raw(this.find(name), null)) : "";
  }
}

async function readPath(r: Reader, n: number, center: Vec): Promise<Path> {
  if (n > 0 && !r.has("path.point")) damaged("chunk path.point is missing");
  const [point, axis, time, kind, feed, move, line, tool, group, rotary] = await Promise.all([
    r.into("path.point", n, 3, Float32Array, center), r.maybe("path.axis", n, 3, Float32Array), r.into("path.time", n, 1, Float64Array),
    r.into("path.kind", n, 1, Uint8Array), r.into("path.feed", n, 1, Float32Array), r.into("path.move", n, 1, Uint32Array),
    r.into("path.line", n, 1, Uint32Array), r.into("path.tool", n, 1, Uint8Array), r.into("path.group", n, 1, Uint16Array),
    r.maybe("path.rotary", n, 2, Float32Array)]);
  if (axis) for (let i = 0; i < 3 * n; i += 3) {
    const l = Math.sqrt(axis[i]! ** 2 + axis[i + 1]! ** 2 + axis[i + 2]! ** 2); // Math.hypot is slow
    if (l > 0) { axis[i]! /= l; axis[i + 1]! /= l; axis[i + 2]! /= l; } else axis[i + 2] = 1;
  }
  return { count: n, point, axis, time, kind, feed, move, line, tool, group, rotary };
}

const NO_PATH = (): Path => ({
  count: 0, point: new Float32Array(0), axis: null, time: new Float64Array(0), kind: new Uint8Array(0), feed: new Float32Array(0), move: new Uint32Array(0),
  line: new Uint32Array(0), tool: new Uint8Array(0), group: new Uint16Array(0), rotary: null });

const ROLES: Record<string, Role> = { design: Role.design, stock: Role.stock, obstacle: Role.obstacle, result: Role.result };

async function readMesh(r: Reader, d: Directory, k: number, center: Vec): Promise<Mesh> {
  const m = d.meshes[k]!, vertices = r.count(`mesh.${k}.point`), triangles = r.count(`mesh.${k}.index`);
  const [point, index, value] = await Promise.all([
    r.into(`mesh.${k}.point`, vertices, 3, Float32Array, center), r.into(`mesh.${k}.index`, triangles, 3, Uint32Array),
    r.maybe(`mesh.${k}.value`, vertices, 1, Float32Array)]);
  for (let i = 0; i < index.length; ++i) if (index[i]! >= vertices) damaged(`mesh ${k} names vertex ${index[i]} of ${vertices}`);
  const role = typeof m.role === "number" ? m.role as Role : ROLES[m.role] ?? Role.design;
  return { name: m.name, role, point, index, value, valueName: m.valueName ?? "", valueUnit: m.valueUnit ?? "",
    valueRange: m.valueRange ?? 0, triangles: m.triangles ?? triangles, of: m.of ?? triangles };
}

async function readOutline(r: Reader, d: Directory, k: number, center: Vec): Promise<Outline> {
  const n = r.count(`outline.${k}.point`);
  const [point, value] = await Promise.all([r.into(`outline.${k}.point`, n, 3, Float32Array, center), r.maybe(`outline.${k}.value`, n, 1, Float32Array)]);
  return { ...d.outlines[k]!, point, value };
}

async function readCSpace(r: Reader, d: Directory, k: number): Promise<CSpace> {
  const c = d.cspaces[k]!, n = c.tilts * c.yaws;
  const [cause, radius] = await Promise.all([r.into(`cspace.${k}.cause`, n, 1, Uint8Array), r.maybe(`cspace.${k}.radius`, n, 1, Float32Array)]);
  return { ...c, cause, radius };
}

async function readStock(r: Reader, d: Directory): Promise<StockClock | null> {
  if (!d.stock) return null;
  const [x, y, z] = d.stock.count, n = x * y * z;
  const [cut, crossing] = await Promise.all([r.into("stock.cut", n, 1, Uint32Array), r.into("stock.crossing", n, 3, Uint8Array)]);
  return { ...d.stock, cut, crossing };
}

function readDirectory(bytes: Uint8Array): { directory: Directory; base: number } {
  const magic = new TextDecoder("latin1").decode(bytes.subarray(0, 8));
  if (bytes.length < 12 || magic !== "BURINSC1") damaged(bytes.length < 12 ? `there are only ${bytes.length} bytes` : "it does not begin with BURINSC1");
  const length = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength).getUint32(8, true);
  if (12 + length > bytes.length) damaged("the directory ends behind the file");
  let directory: Directory;
  try { directory = JSON.parse(new TextDecoder("utf-8", { fatal: true }).decode(bytes.subarray(12, 12 + length))) as Directory; }
  catch { damaged("the directory is not JSON"); }
  if (directory.version !== 1) damaged(`version ${String(directory.version)}, this page reads version 1`);
  if (!Array.isArray(directory.chunks) || !Number.isInteger(directory.nodes) || directory.nodes < 0 || directory.nodes > MAX_NODES) damaged("the directory is incomplete");
  return { directory, base: 12 + length };
}

/** Indices of the columns into the tables; what is beyond them would fail somewhere else, later. */
function checkTables(scene: Scene): void {
  const p = scene.path;
  for (let i = 0; i < p.count; ++i) {
    if (p.tool[i]! >= scene.tools.length && scene.tools.length > 0) damaged(`node ${i} names tool ${p.tool[i]} of ${scene.tools.length}`);
    if (p.kind[i]! > 3) damaged(`node ${i} is of kind ${p.kind[i]}`);
  }
}

export async function decodeScene(bytes: Uint8Array, progress: Progress = () => {}): Promise<Scene> {
  const { directory: d, base } = readDirectory(bytes);
  const box = d.box ?? { lo: [0, 0, 0], hi: [0, 0, 0] };
  const center = [0, 1, 2].map(i => { const c = (box.lo[i]! + box.hi[i]!) / 2; return Number.isFinite(c) ? c : 0; }) as Vec;
  const r = new Reader(bytes, base, d.chunks, progress);
  const list = <T, U>(from: T[] | undefined, f: (k: number) => Promise<U>): Promise<U[]> => Promise.all((from ?? []).map((_, k) => f(k)));
  const [path, series, meshes, outlines, cspaces, stock, text] = await Promise.all([
    d.nodes > 0 ? readPath(r, d.nodes, center) : NO_PATH(),
    list<unknown, Series>(d.series, async k => ({ ...d.series[k]!, value: await r.into(`series.${k}`, d.nodes, 1, Float32Array) })),
    list(d.meshes, k => readMesh(r, d, k, center)), list(d.outlines, k => readOutline(r, d, k, center)),
    list(d.cspaces, k => readCSpace(r, d, k)), readStock(r, d), r.text("program.text")]);
  const axes = (d.machine?.axes ?? []) as Axis[];
  const scene: Scene = {
    title: d.title ?? "", operation: d.operation ?? "", command: d.command ?? "", center, box, path, groups: d.groups ?? [], series, meshes, outlines,
    tools: (d.tools ?? []).map(t => ({ ...t, pieces: t.pieces ?? [] })), machine: d.machine ? { name: d.machine.name, axes } : null, stock, cspaces,
    causes: d.causes ?? [], findings: d.findings ?? [], figures: d.figures ?? [], histograms: d.histograms ?? [],
    program: { name: d.program?.name ?? "", lines: d.program?.lines ?? 0, cut: d.program?.cut ?? false, text } };
  checkTables(scene);
  return scene;
}

// SPDX-License-Identifier: Apache-2.0
// The stage's logic without a page: the container, surfaces of the stock, trees for picking, poses. node --test test/stage_test.mjs
import assert from "node:assert/strict";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";
import { build } from "esbuild";
import { container, empty, fiveAxis, laser, milled } from "./sample.mjs";

const out = mkdtempSync(join(tmpdir(), "burin-stage-"));
after(() => rmSync(out, { recursive: true, force: true }));
const contents = ["decode", "logic/motion", "stage/geometry", "stage/pick", "stage/pose", "stage/stock_mesh"].map(f => `export * from "./${f}";`).join("\n") + 'export { Matrix4, Vector3 } from "three";';
await build({ stdin: { contents, resolveDir: fileURLToPath(new URL("../src", import.meta.url)) }, bundle: true, format: "esm", outfile: join(out, "stage.mjs"), logLevel: "error" });
const S = await import(pathToFileURL(join(out, "stage.mjs")).href);

let seed = 4711;
const random = () => (seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0) / 2 ** 32; // the same numbers every time
const near = (a, b, e, what = "") => assert(Math.abs(a - b) <= e, `${what} ${a} is not ${b} within ${e}`);

test("what was written is read again", async () => {
  const s = fiveAxis({ rings: 4, around: 20 }), d = await S.decodeScene(S.fromBase64(container(s).toString("base64")));
  assert.equal(d.path.count, s.path.count);
  for (let i = 0; i < s.path.count; ++i) {
    for (let c = 0; c < 3; ++c) { near(d.path.point[3 * i + c] + d.center[c], s.path.point[3 * i + c], 6e-5, "point"); near(d.path.axis[3 * i + c], s.path.axis[3 * i + c], 4e-5, "axis"); }
    near(d.path.time[i], s.path.time[i], 6e-5, "time");
    near(d.path.rotary[2 * i], s.path.rotary[2 * i], 1e-4, "angle");
    assert.equal(d.path.group[i], s.path.group[i]);
  }
  assert.deepEqual([...d.meshes[0].index], s.meshes[0].index);
  assert.equal(d.series[0].value.filter(Number.isNaN).length, s.series[0].value.filter(Number.isNaN).length);
  assert.equal(d.program.text, s.program.text);
  assert.deepEqual([...d.cspaces[1].cause], s.cspaces[1].cause);
  assert.equal((await S.decodeScene(container(empty("nothing", "view")))).path.count, 0);
});

test("damaged data is said to be damaged", async () => {
  const bytes = container(laser());
  for (const n of [0, 5, 11, 100, bytes.length >> 1, bytes.length - 1]) await assert.rejects(S.decodeScene(bytes.subarray(0, n)), S.DamagedScene, `cut after ${n}`);
  const directory = bytes.readUInt32LE(8);
  for (let i = 0; i < 24; ++i) { // one bit of the packed chunks: zlib's sum does not agree
    const b = Buffer.from(bytes);
    b[12 + directory + Math.floor(random() * (b.length - 12 - directory))] ^= 1 << i % 8;
    await S.decodeScene(b).then(() => assert.fail("taken"), e => assert(e instanceof S.DamagedScene, String(e)));
  }
  assert.throws(() => S.fromBase64("AAA*"), S.DamagedScene);
  assert.throws(() => S.fromBase64("AAAAA"), S.DamagedScene);
  assert.deepEqual([...S.fromBase64(" TWFu\nTWE= ".replace("\n", ""))], [77, 97, 110, 77, 97]);
});

/** Volume inside a surface and how many of its edges have no partner. */
function body(bricks) {
  let volume = 0;
  const edges = new Map(), key = (p, i) => [0, 1, 2].map(c => Math.round(p[3 * i + c] * 1e4)).join();
  for (const b of bricks) for (let t = 0; t < b.index.length; t += 3) {
    const [i, j, k] = b.index.subarray(t, t + 3), p = b.position, at = (v, c) => p[3 * v + c];
    volume += (at(i, 0) * (at(j, 1) * at(k, 2) - at(j, 2) * at(k, 1)) - at(i, 1) * (at(j, 0) * at(k, 2) - at(j, 2) * at(k, 0)) + at(i, 2) * (at(j, 0) * at(k, 1) - at(j, 1) * at(k, 0))) / 6;
    for (const [a, c] of [[i, j], [j, k], [k, i]]) { const n = `${key(p, a)} ${key(p, c)}`, m = `${key(p, c)} ${key(p, a)}`; if (edges.get(m)) edges.set(m, edges.get(m) - 1); else edges.set(n, (edges.get(n) ?? 0) + 1); }
  }
  return { volume, open: [...edges.values()].reduce((a, b) => a + b, 0) };
}

test("the stock's surface is closed over the bricks, holds the material's volume, and does not depend on the way to a time", () => {
  const s = milled({ rows: 6, columns: 20, grid: [44, 30, 14] }), clock = { ...s.stock, cut: Uint32Array.from(s.stock.cut) }, none = { poses: new Float32Array(0), cutter: [] };
  const shown = new Map(), mesher = new S.StockMesher(clock);
  const go = (m, to, kept) => { m.set({ limit: to, ...none }); for (const b of m.changed()) kept.set(b.brick, b); return body([...kept.values()].filter(b => b.index.length)); };
  for (const limit of [0, 40, 43, 12, 60]) {
    const here = go(mesher, limit, shown), fresh = go(new S.StockMesher(clock), limit, new Map());
    assert.equal(here.open, 0);
    near(here.volume, fresh.volume, 1e-9 * fresh.volume, "volume");
    let gone = 0;
    for (const c of clock.cut) if (c > 0 && c <= limit) ++gone;
    near(here.volume, 90 * 60 * 22 - gone * clock.step ** 3, 0.25 * clock.step * 90 * 60, `volume at ${limit}`); // a quarter of a cell over the cut area
  }
});

test("a move takes its nodes as the cutter comes by", () => {
  const count = [41, 9, 9], cut = new Uint32Array(41 * 81), cutter = [{ radius: 2.5, low: 0, high: 20, corner: 2.5 }];
  for (let k = 1; k < 8; ++k) for (let j = 1; j < 8; ++j) for (let i = 1; i < 40; ++i) cut[(k * 9 + j) * 41 + i] = Math.hypot(j - 4, Math.min(0, k - 5.5)) < 2.5 ? 6 : 0xffffffff;
  const mesher = new S.StockMesher({ count, origin: [0, 0, 0], step: 1, cut, crossing: new Uint8Array(3 * cut.length) });
  let last = Infinity;
  for (const x of [2, 10, 20, 38]) {
    const poses = Float32Array.from(Array.from({ length: x - 1 }, (_, i) => [i + 2, 4, 3, 0, 0, 1]).flat());
    mesher.set({ limit: 5, poses, cutter });
    const left = mesher.solid.reduce((a, b) => a + b, 0);
    assert(left < last, `${left} of ${last} at ${x}`);
    last = left;
  }
  mesher.set({ limit: 6, poses: new Float32Array(0), cutter });
  assert.equal(mesher.solid.reduce((a, b) => a + b, 0), cut.filter(c => c === 0xffffffff).length);
});

test("the nearest way on the screen is that of a look at all of them", () => {
  const n = 4000, point = new Float32Array(3 * n), at = [0, 0, 0];
  for (let i = 0; i < n; ++i) for (let c = 0; c < 3; ++c) { at[c] += (random() - 0.5) * 8; at[c] *= 0.98; point[3 * i + c] = at[c]; }
  const path = { count: n, point, kind: new Uint8Array(n).fill(1) }, ways = new S.Ways(path), matrix = new S.Matrix4().makeOrthographic(-40, 40, 30, -30, -100, 100), screen = { matrix, width: 800, height: 600 };
  let found = 0;
  for (let q = 0; q < 100; ++q) {
    const x = random() * 800, y = random() * 600, hit = ways.nearest(screen, x, y, 12, () => true);
    let best = Infinity, reach = Infinity;
    for (let i = 0; i + 1 < n; ++i) {
      const a = new S.Vector3(...point.subarray(3 * i, 3 * i + 3)).applyMatrix4(matrix), b = new S.Vector3(...point.subarray(3 * i + 3, 3 * i + 6)).applyMatrix4(matrix), p = v => [(v.x + 1) * 400, (1 - v.y) * 300];
      const [ax, ay] = p(a), [bx, by] = p(b), dd = (bx - ax) ** 2 + (by - ay) ** 2, t = dd > 0 ? Math.min(1, Math.max(0, ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / dd)) : 0;
      const d = Math.hypot(ax + t * (bx - ax) - x, ay + t * (by - ay) - y);
      if (d <= 12) { reach = Math.min(reach, d); best = Math.min(best, d + 3 * (a.z + t * (b.z - a.z) + 1) / 2); }
    }
    assert.equal(hit === null, !(best < 12), `at ${x} ${y}`);
    if (hit) { ++found; near(hit.pixels + 3 * (hit.depth + 1) / 2, best, 1e-3); }
  }
  assert(found > 25);
});

test("a ray hits the triangle that a look at all of them finds; closed bodies are known", () => {
  const mesh = milled({ stock: false, rows: 2, columns: 4 }).meshes[0], m = { point: Float32Array.from(mesh.point), index: Uint32Array.from(mesh.index) };
  const surface = new S.Surface(m), v = i => new S.Vector3(...m.point.subarray(3 * i, 3 * i + 3));
  for (let q = 0; q < 6; ++q) {
    const from = new S.Vector3(random() * 90, random() * 60, 60), to = new S.Vector3(random() * 90, random() * 60, 0), direction = to.sub(from).normalize();
    let best = Infinity;
    for (let t = 0; t < m.index.length; t += 3) {
      const a = v(m.index[t]), e = v(m.index[t + 1]).sub(a), f = v(m.index[t + 2]).sub(a), normal = e.clone().cross(f), w = a.clone().sub(from).dot(normal) / direction.dot(normal);
      const p = from.clone().addScaledVector(direction, w).sub(a), inside = [e.clone().cross(p).dot(normal), p.clone().cross(f).dot(normal), f.clone().sub(e).cross(p.clone().sub(e)).dot(normal)].every(s => s >= -1e-9);
      if (w > 0 && inside) best = Math.min(best, w);
    }
    near(surface.hit({ from, direction }, Infinity, () => true)?.distance ?? Infinity, best, 1e-5);
  }
  const shaped = S.shape(m.point, m.index);
  assert(shaped.closed);
  assert(!S.shape(m.point, m.index.subarray(3)).closed);
  for (let i = 0; i < shaped.normal.length; i += 3) near(Math.hypot(...shaped.normal.subarray(i, i + 3)) / 32767, 1, 1e-3, "normal");
});

test("poses: the great circle between nodes; the table brings the tool's axis upright", async () => {
  const s = await S.decodeScene(container(fiveAxis({ rings: 5, around: 30 }))), up = new S.Vector3(0, 0, 1);
  for (let i = 2; i < s.path.count - 1; i += 3) {
    const pose = S.poseAt(s.path, i), m = S.tableMatrix(s.machine, S.rotaryAt(s.path, i), s.center);
    near(pose.axis.clone().transformDirection(m).angleTo(up), 0, 1e-4, `upright at ${i}`);
    const between = S.poseAt(s.path, i + 0.3).axis, a = new S.Vector3(...s.path.axis.subarray(3 * i, 3 * i + 3)), b = new S.Vector3(...s.path.axis.subarray(3 * i + 3, 3 * i + 6));
    near(between.angleTo(a), 0.3 * a.angleTo(b), 1e-4);
    near(between.angleTo(b), 0.7 * a.angleTo(b), 1e-4);
  }
  for (const t of [-1, 0, s.path.time[7], s.path.time[7] + 1e-6, 1e9]) { const n = S.lastAtMost(s.path.time, t); assert(n === 0 || s.path.time[n] <= t); assert(n + 1 === s.path.count || s.path.time[n + 1] > t); }
});

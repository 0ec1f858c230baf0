// SPDX-License-Identifier: Apache-2.0
// The viewer's logic without a page: contours, thinning, listing, steps in time, cross-sections. node --test test/logic_test.mjs
import assert from "node:assert/strict";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";
import { build } from "esbuild";

const out = mkdtempSync(join(tmpdir(), "burin-logic-"));
after(() => rmSync(out, { recursive: true, force: true }));
const source = name => fileURLToPath(new URL(`../src/logic/${name}.ts`, import.meta.url));
const names = ["bands", "contours", "decimate", "format", "groups", "histogram", "kerf", "listing", "motion", "orient", "section"];
await build({ entryPoints: names.map(source), outdir: out, bundle: true, format: "esm", outExtension: { ".js": ".mjs" }, logLevel: "error" });
const load = async name => import(pathToFileURL(join(out, `${name}.mjs`)).href);
const { bands } = await load("bands"), { contours, levelsFor, bilinear } = await load("contours"), { decimate, extent } = await load("decimate"), F = await load("format");
const { groupSums } = await load("groups"), { shares } = await load("histogram"), K = await load("kerf"), L = await load("listing"), { Motion, lastAtMost } = await load("motion"), S = await load("section"), O = await load("orient");

let seed = 12345;
const random = () => (seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0) / 2 ** 32; // the same numbers every time
const near = (a, b, e, what = "") => assert(Math.abs(a - b) <= e, `${what} ${a} is not ${b} within ${e}`);

/** A path of points (tip), times 1 s apart unless given. */
function makePath(points, more = {}) {
  const n = points.length, of = (key, make) => more[key] ?? make;
  return { count: n, point: Float32Array.from(points.flat()), axis: more.axis ? Float32Array.from(more.axis.flat()) : null, time: Float64Array.from(of("time", points.map((_, i) => i))), kind: Uint8Array.from(of("kind", points.map(() => 1))),
    feed: new Float32Array(n).fill(100), move: Uint32Array.from(of("move", points.map((_, i) => i))), line: Uint32Array.from(of("line", points.map(() => 0))), tool: new Uint8Array(n), group: Uint16Array.from(of("group", points.map(() => 0))), rotary: null };
}

test("the last row at most a value is what a walk finds", () => {
  for (let k = 0; k < 200; ++k) {
    const list = Array.from({ length: Math.floor(random() * 12) }, () => Math.floor(random() * 8)).sort((a, b) => a - b), v = random() * 9 - 0.5;
    let want = 0;
    list.forEach((x, i) => { if (x <= v) want = i; });
    assert.equal(lastAtMost(list, v), want, `${list} at ${v}`);
  }
});

test("tip and length between nodes are in proportion to the time", () => {
  const m = new Motion(makePath([[0, 0, 0], [10, 0, 0], [10, 20, 0]], { time: [0, 2, 2.5] }), [100, 0, 0]);
  assert.deepEqual(m.at(0.5).tip, [102.5, 0, 0]);
  near(m.at(2.25).length, 20, 1e-9);
  assert.deepEqual(m.at(99).tip, [110, 20, 0]);
  assert.equal(m.at(-1).node, 0);
  assert.equal(new Motion(makePath([]), [0, 0, 0]).at(1).node, 0);
});

test("steps reach every node, move and pass, and come to rest at the ends", () => {
  const m = new Motion(makePath(Array.from({ length: 9 }, (_, i) => [i, 0, 0]), { move: [0, 1, 1, 1, 2, 3, 3, 4, 4], kind: [0, 0, 1, 1, 2, 1, 1, 1, 0], group: [0, 0, 0, 0, 0, 0, 1, 1, 1] }), [0, 0, 0]);
  const walk = (by, d, from) => { const seen = [from]; for (let i = 0; i < 20; ++i) { const next = m.step(seen.at(-1), by, d); if (next === seen.at(-1)) break; seen.push(next); } return seen; };
  assert.deepEqual(walk("node", 1, 0), [0, 1, 2, 3, 4, 5, 6, 7, 8]);
  assert.deepEqual(walk("move", 1, 0), [0, 1, 4, 5, 7, 8]);
  assert.deepEqual(walk("move", -1, 8), [8, 7, 5, 4, 1, 0]);
  assert.deepEqual([...m.passes], [0, 2, 5, 6]);
  assert.deepEqual(walk("pass", 1, 0), [0, 2, 5, 6, 8]);
  assert.deepEqual(walk("pass", -1, 8), [8, 6, 5, 2, 0]);
});

test("thinning keeps extremes of every column, gaps, and stays small", () => {
  const n = 200_000, x = Float64Array.from({ length: n }, (_, i) => i), y = Float32Array.from({ length: n }, () => random());
  y[77_777] = 50; y[150_001] = -50;
  for (let i = 100_000; i < 110_000; ++i) y[i] = NaN;
  const q = decimate(x, y, 0, n - 1, 800);
  assert(q.length / 2 <= 4 * 801 + 8, `${q.length / 2} points`);
  const ys = q.filter((_, i) => i % 2 === 1), finite = ys.filter(v => !Number.isNaN(v));
  assert.equal(Math.max(...finite), 50);
  assert.equal(Math.min(...finite), -50);
  assert(ys.some(Number.isNaN), "the gap is lost");
  for (let i = 0; i < q.length; i += 2) if (!Number.isNaN(q[i])) assert(!(q[i] >= 100_000 && q[i] < 110_000));
  for (let i = 2, last = q[0]; i < q.length; i += 2) if (!Number.isNaN(q[i])) { assert(q[i] >= last); last = q[i]; }
  const w = n / 800;
  for (let c = 0; c < 800; c += 37) { // brute force
    let lo = Infinity, hi = -Infinity;
    for (let i = Math.ceil(c * (n - 1) / 800); i < (c + 1) * (n - 1) / 800; ++i) if (!Number.isNaN(y[i])) { lo = Math.min(lo, y[i]); hi = Math.max(hi, y[i]); }
    if (lo > hi) continue;
    const here = [];
    for (let i = 0; i < q.length; i += 2) if (q[i] >= c * w - 1 && q[i] <= (c + 1) * w + 1) here.push(q[i + 1]);
    assert(here.includes(lo) && here.includes(hi), `column ${c}`);
  }
  assert.deepEqual([...decimate(x, y, 3.5, 6.5, 100)], [3, y[3], 4, y[4], 5, y[5], 6, y[6], 7, y[7]]); // few points are all there
  assert.deepEqual(extent(x, y, 77_000, 78_000)[1], 50);
  assert.equal(extent(x, y, 101_000, 109_000), null);
});

test("contours lie where the value is the level, chain up, and circles close", () => {
  const rows = 61, columns = 47, value = new Float32Array(rows * columns), f = (i, j) => Math.hypot(i - 30, 1.3 * (j - 23));
  for (let i = 0; i < rows; ++i) for (let j = 0; j < columns; ++j) value[i * columns + j] = f(i, j);
  const lines = contours(value, rows, columns, [5, 12, 20]);
  assert.deepEqual(lines.map(l => [l.level, l.closed]), [[5, true], [12, true], [20, true]]);
  for (const l of lines) for (let k = 0; k < l.points.length; k += 2) {
    near(f(l.points[k], l.points[k + 1]), l.level, 0.08);
    near(bilinear(value, rows, columns, l.points[k], l.points[k + 1]), l.level, 1e-4);
  }
  for (const l of lines) { // an ellipse's circumference (Ramanujan)
    let length = 0; const a = l.level, b = l.level / 1.3, h = ((a - b) / (a + b)) ** 2;
    for (let k = 0; k < l.points.length; k += 2) { const m = (k + 2) % l.points.length; length += Math.hypot(l.points[m] - l.points[k], l.points[m + 1] - l.points[k + 1]); }
    near(length, Math.PI * (a + b) * (1 + 3 * h / (10 + Math.sqrt(4 - 3 * h))), 0.02 * length);
  }
});

test("contours: every crossed edge is on one line, also with saddles and holes", () => {
  for (let round = 0; round < 60; ++round) {
    const rows = 2 + Math.floor(random() * 9), columns = 2 + Math.floor(random() * 9), value = Float32Array.from({ length: rows * columns }, () => random() < 0.1 ? NaN : random());
    let cells = 0;
    for (let i = 0; i + 1 < rows; ++i) for (let j = 0; j + 1 < columns; ++j) {
      const q = [[0, 0], [0, 1], [1, 1], [1, 0]].map(([a, b]) => value[(i + a) * columns + j + b]);
      if (q.some(Number.isNaN)) continue;
      for (let k = 0; k < 4; ++k) if ((q[k] >= 0.5) !== (q[(k + 1) % 4] >= 0.5)) ++cells;
    }
    let pieces = 0;
    for (const l of contours(value, rows, columns, [0.5])) {
      pieces += l.points.length / 2 - (l.closed ? 0 : 1);
      for (const p of l.points) assert(Number.isFinite(p));
    }
    assert.equal(2 * pieces, cells, `round ${round}`); // a piece has two ends, each on an edge of its cell
  }
});

test("levels are round, inside the values, and not too many", () => {
  const even = Array.from({ length: 400 }, (_, i) => 3 + i / 50), wide = Array.from({ length: 400 }, (_, i) => 2 * 1.03 ** i);
  for (const v of [even, wide, wide.map(x => -x)]) { const l = levelsFor(v, 9); assert(l.length >= 3 && l.length <= 14, l.join()); for (const x of l) assert(x > Math.min(...v) && x < Math.max(...v)); }
  assert.deepEqual(levelsFor([1, 1, 1, 1, 1, NaN], 9), []);
});

test("the listing finds lines, nodes and blocks", () => {
  const text = "%\nN10 G0 X1\r\nN20 G1 X2 (N30 no block)\n\nG1 X3\nN030 X4\nN300 X5 N3.5\nM30";
  const l = new L.Listing(text, [0, 2, 3, 3, 5, 6, 99]);
  assert.equal(l.count, 8);
  assert.equal(l.line(2), "N10 G0 X1");
  assert.equal(l.line(8), "M30");
  assert.equal(l.line(9), "");
  assert.deepEqual([2, 3, 4, 5, 6, 8].map(n => l.nodeOf(n)), [1, 2, 4, 4, 5, 5]);
  assert(l.moves(3) && !l.moves(4));
  assert.equal(l.search("n30", 1, 1), 3); // a block in a comment is text as any other
  assert.equal(l.search("n30", 3, 1), 6);
  assert.equal(l.search("N30", 3, -1), 6); // around
  assert.equal(l.search("N300", 1, 1), 7);
  assert.equal(l.search("5", 1, 1), 5);
  assert.equal(l.search("999", 1, 1), 8);
  assert.equal(l.search("g1 x", 3, 1), 5);
  assert.equal(l.search("g1 x", 5, -1), 3);
  assert.equal(l.search("nowhere", 3, 1), null);
  assert.equal(new L.Listing("", []).nodeOf(1), null);
  assert.equal(new L.Listing("a\n", []).count, 1);
});
test("half a million lines are cut and searched in little time", () => {
  const lines = Array.from({ length: 500_000 }, (_, i) => `N${i} G1 X${i}`), begin = Date.now(), l = new L.Listing(lines.join("\n"), lines.map((_, i) => i + 1));
  assert.equal(l.count, 500_000);
  assert.equal(l.search("N499998", 1, 1), 499_999);
  assert.equal(l.nodeOf(400_000), 399_999);
  assert(Date.now() - begin < 5000, `${Date.now() - begin} ms`);
});
test("colouring takes nothing from a line", () => {
  for (const line of ["N10 G1 X-1.5Y2 F300 (feed (a) G1", "GOTO / 1.0, -2.5E-3, 3", "$$ PPRINT", "#1=[2+3] G43.4 H1 ; end", "", "\u00e4 \u2026"]) assert.equal(L.tinted(line).map(t => t.text).join(""), line);
  assert.deepEqual(L.tinted("N10 G1 X-1.5").filter(t => t.tint).map(t => [t.text, t.tint]), [["N10", "block"], ["G1", "code"], ["X", "axis"], ["-1.5", "number"]]);
});

test("bands: a column has the kind that takes most of it", () => {
  const p = makePath([[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]], { time: [0, 4, 4.5, 10], kind: [0, 1, 0, 2], group: [0, 0, 1, 2] });
  const b = bands(p, 0, 10, 5);
  assert.deepEqual([...b.kind], [1, 1, 2, 2, 2]);
  assert.deepEqual([...bands(p, 4, 4.5, 2).kind], [0, 0]);
  assert.deepEqual([...bands(p, 10, 14, 2).kind], [255, 255]);
});
test("sums of groups are those of the whole", () => {
  const p = makePath(Array.from({ length: 50 }, (_, i) => [i, 0, 0]), { group: Array.from({ length: 50 }, (_, i) => i >> 4), kind: Array.from({ length: 50 }, (_, i) => i % 3 === 0 ? 0 : 1) }), m = new Motion(p, [0, 0, 0]), s = groupSums(p, m.length, 4);
  near(s.time.reduce((a, b) => a + b), 49, 1e-9);
  near(s.cut.reduce((a, b) => a + b), 33, 1e-9);
  assert.deepEqual([...s.first], [0, 16, 32, 48]);
});
test("shares within the tolerance divide the bar that the limit crosses", () => {
  const s = shares({ from: -0.03, step: 0.02, area: [1, 2, 1], tolerance: 0.02 });
  near(s.within, (0.5 + 2 + 0.5) / 4, 1e-12); near(s.below, 0.125, 1e-12); near(s.above, 0.125, 1e-12);
});
test("times, lengths and ticks read well", () => {
  assert.equal(F.duration(59.999), "1:00.00"); assert.equal(F.duration(3725, 0), "1:02:05"); assert.equal(F.duration(0.5, 1), "0:00.5");
  assert.equal(F.fixed(-0.0001, 2), "0.00"); assert.equal(F.fixed(-0.01, 2), "-0.01");
  assert.deepEqual(F.ticks(-0.05, 0.05, 4), [-0.05, 0, 0.05]); assert.deepEqual(F.ticks(0.11, 0.19, 4), [0.12, 0.14, 0.16, 0.18]);
  assert(F.ticks(0, 1e9, 5).length <= 6 && F.ticks(5, 5, 3).length === 0);
});

// --- cross-sections ---
const ball = r => [{ kind: 0, radius: r, low: 0, high: r, corner: r }], bull = (r, c, high = 20) => [{ kind: 0, radius: r, low: 0, high, corner: c }];
const tilted = (lead, side) => { const a = [Math.sin(lead), Math.sin(side), 1], l = Math.hypot(...a); return a.map(v => v / l); };
const frame = { origin: [0, 0, 0], feed: [1, 0, 0], u: [0, 1, 0], v: [0, 0, 1] };

test("the swept profile of a ball is its circle, however it stands and whichever way it goes", () => {
  for (const axis of [tilted(0, 0), tilted(0.3, 0), tilted(-0.2, 0.5)]) for (const way of [[1, 0, 0], [0.8, 0.6, 0]]) {
    const R = 4, tip = [0, 0, 0], centre = axis.map(v => v * R), b = S.Swept.through(0, tip, axis, way, ball(R), frame);
    for (const u0 of [-2.5, -1, 0, 0.7, 2]) {
      // A cylinder about the line centre + s way cuts the plane in an ellipse.
      const cu = centre[1] - centre[0] * way[1] / way[0], k = way[0], u = cu + u0;
      near(b.low(u), centre[2] - Math.sqrt(R * R - (u0 * k) ** 2), 2e-7, `axis ${axis}, way ${way}, u ${u0}`);
    }
  }
});
test("flat and bull ends: the profile is the lowest of many points of the tool", () => {
  for (const [R, c] of [[5, 0], [5, 1.2]]) for (const axis of [tilted(0, 0), tilted(0.15, 0), tilted(0.1, -0.2)]) {
    const b = S.Swept.through(0, [0, 0, 0], axis, [1, 0, 0], bull(R, c), frame), x = S.unit(S.cross([0.3, 0.5, -0.2], axis)), y = S.cross(axis, x), low = new Map(), STEP = 0.25, at = u => Math.round(u / STEP);
    for (let i = 0; i <= 300; ++i) { // the lower edge and the bottom, by brute force
      const t = i / 300 * Math.PI / 2, r = R - c + c * Math.sin(t), h = c - c * Math.cos(t);
      for (const q of [1, 0.66, 0.33, 0]) for (let k = 0; k < 4000; ++k) {
        if (q < 1 && i > 0) break;
        const a = 2 * Math.PI * k / 4000, radius = q < 1 ? (R - c) * q : r, p = [0, 1, 2].map(d => axis[d] * (q < 1 ? 0 : h) + radius * (Math.cos(a) * x[d] + Math.sin(a) * y[d]));
        const cell = at(p[1]);
        if (Math.abs(p[1] - cell * STEP) < 0.004 && !(low.get(cell) <= p[2])) low.set(cell, p[2]);
      }
      if (c === 0) break;
    }
    let checked = 0;
    for (const [cell, v] of low) {
      const u = cell * STEP;
      if (Math.abs(u) > 0.8 * R) continue;
      const e = b.low(u);
      assert(Math.abs(e - v) < 0.02, `R ${R} c ${c} axis ${axis} at ${u}: ${e}, points ${v}`);
      ++checked;
    }
    assert(checked > 10, `${checked}`);
  }
});
test("scallops of a ball over a plane are R - sqrt(R^2 - (s/2)^2), also exaggerated steps and tilted planes", () => {
  for (const [R, s] of [[3, 0.5], [4, 1.2], [6, 0.05]]) for (const slope of [0, 0.4]) {
    const c = Math.cos(slope), w = Math.sin(slope), rows = [];
    for (let k = -4; k <= 4; ++k) rows.push([-10, k * s * c, k * s * w], [10, k * s * c, k * s * w]);
    // Centres lie on a sloping plane; the tool is upright.
    const path = makePath(rows, { kind: rows.map((_, i) => i % 2 ? 1 : 0) }), f = S.turned({ ...frame, origin: [0, 0, 0] }, -w, c), all = S.crossings(path, f, 5 * s, 20);
    assert.equal(all.length, 9);
    const bodies = all.map(q => S.Swept.through(q.node, q.tip, q.axis, q.way, ball(R), f)), middle = bodies[0].outermost(0, -1)[0], e = S.envelope(bodies, middle - 2.2 * s, middle + 2.2 * s, 400), ridges = S.cusps(bodies, e);
    assert.equal(ridges.length, 4);
    for (const r of ridges) near(r.height, R - Math.sqrt(R * R - s * s / 4), 2e-6, `R ${R} s ${s} slope ${slope}`); // points are single precision
  }
});
test("only cutting ways count as passes, and each once", () => {
  const path = makePath([[-1, 0, 0], [0, 0, 0], [1, 0, 0], [1, 1, 0], [-1, 1, 0]], { kind: [0, 1, 1, 0, 0] });
  assert.deepEqual(S.crossings(path, frame, 10, 10).map(c => c.node), [1]); // touches the plane at its end
  const none = S.feedAt(makePath([[0, 0, 0], [1, 0, 0]], { kind: [0, 0] }), 1);
  assert.equal(none, null);
});
test("the design's line is the mesh cut by the plane, and its normal points to the tool", () => {
  const s = 0.3, mesh = { point: Float32Array.from([-5, -5, -5 * s, 5, -5, -5 * s, 5, 5, 5 * s, -5, 5, 5 * s]), index: Uint32Array.from([0, 1, 2, 0, 2, 3]) };
  const line = S.cutMesh(mesh, frame, 50);
  assert.equal(line.length, 8);
  for (let i = 0; i < line.length; i += 2) near(line[i + 1], s * line[i], 1e-6);
  near(S.designAt(line, 1.5, 0), 0.45, 1e-6);
  assert(Number.isNaN(S.designAt(line, 9, 0)));
  const b = S.Swept.through(0, [0, 0, 0.05], [0, 0, 1], [1, 0, 0], ball(2), frame), n = S.normalNear(b, line, 2);
  near(n[0], -s / Math.hypot(1, s), 1e-6); near(n[1], 1 / Math.hypot(1, s), 1e-6);
});
test("kerf: the nearest place of an edge, and the beam's ways about a node", () => {
  const square = { name: "", part: true, closed: true, point: Float32Array.from([0, 0, 0, 10, 0, 0, 10, 10, 0, 0, 10, 0]), value: null };
  const path = makePath([[-0.15, -5, 0], [-0.15, 5, 0], [-0.15, 20, 0], [30, 20, 0]], { kind: [0, 1, 1, 0] }), plane = K.beamPlane(path, 1);
  const flat = K.flatOutline(square, plane, 3);
  near(K.nearestOn([{ points: flat, closed: true }], 0, 0).distance, 0.15, 1e-6);
  assert.equal(K.flatOutline(square, { ...plane, origin: [100, 0, 0] }, 3), null);
  assert.deepEqual(K.beamLines(path, plane, 3).map(l => l.nodes), [[0, 1, 2]]);
  assert.deepEqual([plane.x, plane.y], [[1, 0, 0], [0, 1, 0]]);
});
test("kerf: lines and arcs of a contour join, whichever way each of them runs", () => {
  const side = (...p) => ({ point: Float32Array.from(p.flatMap(([x, y]) => [x, y, 0])), closed: false }), a = [0, 0], b = [10, 0], c = [10, 10.0005], d = [0, 10];
  const all = K.joined([side(c, b), side(a, b), side([50, 50], [60, 50]), side(d, a), side([10, 10], [5, 11], d), { point: Float32Array.from([1, 1, 0, 2, 1, 0, 2, 2, 0]), closed: true }]);
  assert.deepEqual(all.map(o => o.closed).sort(), [false, true, true]);
  const loop = all.find(o => o.closed && o.point.length > 12);
  let area = 0;
  for (let i = 0, n = loop.point.length / 3; i < n; ++i) { const j = (i + 1) % n; area += (loop.point[3 * i] * loop.point[3 * j + 1] - loop.point[3 * j] * loop.point[3 * i + 1]) / 2; }
  near(Math.abs(area), 105, 0.01);
});
test("other angles of a contact point: the tool still touches it, and comes back", () => {
  const R = 6, r = 1.5, f = S.unit([0.6, 0.3, 0.1]), n = S.unit(S.cross(f, [0.2, -1, 0.4])), P = [10, -4, 3], rad = v => v * Math.PI / 180;
  const stand = (tilt, yaw) => { const t = S.cross(n, f), d = S.sum(f.map(v => v * Math.cos(rad(yaw))), t, Math.sin(rad(yaw))), axis = S.sum(n.map(v => v * Math.cos(rad(tilt))), d, Math.sin(rad(tilt)));
    // The middle of the corner's circle is r above the contact; from there inwards across the axis to its foot, and down.
    const inward = S.unit(S.sum(n, axis, -S.dot(n, axis))), middle = S.sum(P, n, r); return { axis, tip: S.sum(S.sum(middle, inward, R - r), axis, -r) }; };
  for (const [a, b] of [[[10, 0], [25, 40]], [[15, -30], [3, 120]], [[30, 80], [30, 80]], [[5, 10], [45, -90]]]) {
    const got = O.standingAt(stand(...a), f, a, b, R, r), want = stand(...b);
    for (let k = 0; k < 3; ++k) { near(got.tip[k], want.tip[k], 1e-9, `${a} to ${b}`); near(got.axis[k], want.axis[k], 1e-9); }
  }
  assert.equal(O.standingAt(stand(10, 0), f, [40, 0], [5, 0], R, r), null); // not the pose of those angles
});

// SPDX-License-Identifier: Apache-2.0
// Scenes made by JavaScript for the tests of the page, written down as docs/viewer.md says (independent of the C++ writer).
//   node test/sample.mjs OUTDIR [NAME...]     pages from data/pages/viewer.html
import { deflateSync } from "node:zlib";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { fileURLToPath } from "node:url";

const NONE = 0x7fffffff;
const RAPID = 0, FEED = 1, LINK = 2;

/** Zigzag deltas of each component as four planes of bytes. */
function delta(values, components, scale, offset) {
  const n = values.length, out = Buffer.alloc(4 * n), last = new Array(components).fill(0);
  for (let i = 0; i < n; ++i) {
    const c = i % components, v = Number.isNaN(values[i]) ? NONE : Math.round((values[i] - offset[c]) / scale) | 0;
    const d = (v - last[c]) | 0, z = (d << 1) ^ (d >> 31);
    last[c] = v;
    for (let b = 0; b < 4; ++b) out[b * n + i] = (z >>> (8 * b)) & 255;
  }
  return out;
}

class Chunks {
  list = []; data = []; at = 0;
  add(name, type, components, count, coding, bytes, more = {}) {
    const packed = deflateSync(bytes);
    this.list.push({ name, type, components, count, coding, ...more, at: this.at, bytes: packed.length });
    this.data.push(packed);
    this.at += packed.length;
  }
  delta(name, values, components, scale = 1, offset = new Array(components).fill(0), none = false) {
    this.add(name, "i32", components, values.length / components, "delta", delta(values, components, scale, offset), { scale, offset, ...(none ? { none } : {}) });
  }
  u8(name, values, components = 1) { this.add(name, "u8", components, values.length / components, "plain", Buffer.from(Uint8Array.from(values))); }
  u16(name, values) { this.add(name, "u16", 1, values.length, "plain", Buffer.from(Uint16Array.from(values).buffer)); }
}

/** A scene in the shape of src/scene.ts, points in part coordinates, arrays plain. */
export function container(s) {
  const c = new Chunks(), p = s.path, n = p.count, box = s.box;
  if (n > 0) {
    c.delta("path.point", p.point, 3, 1e-4, box.lo);
    if (p.axis) c.delta("path.axis", p.axis, 3, 1 / 32767);
    c.delta("path.time", p.time, 1, 1e-4);
    c.u8("path.kind", p.kind);
    c.delta("path.feed", p.feed, 1, 0.01);
    c.delta("path.move", p.move, 1);
    c.delta("path.line", p.line, 1);
    c.u8("path.tool", p.tool);
    c.u16("path.group", p.group);
    if (p.rotary) c.delta("path.rotary", p.rotary, 2, 1e-5);
    s.series.forEach((x, k) => c.delta(`series.${k}`, x.value, 1, 1e-4, [0], true));
  }
  s.meshes.forEach((m, k) => {
    c.delta(`mesh.${k}.point`, m.point, 3, 1e-4, box.lo);
    c.delta(`mesh.${k}.index`, m.index, 3);
    if (m.value) c.delta(`mesh.${k}.value`, m.value, 1, 1e-5, [0], true);
  });
  s.outlines.forEach((o, k) => {
    c.delta(`outline.${k}.point`, o.point, 3, 1e-4, box.lo);
    if (o.value) c.delta(`outline.${k}.value`, o.value, 1, 1e-5, [0], true);
  });
  s.cspaces.forEach((x, k) => { c.u8(`cspace.${k}.cause`, x.cause); if (x.radius) c.delta(`cspace.${k}.radius`, x.radius, 1, 1e-3, [0], true); });
  if (s.stock) { c.delta("stock.cut", Int32Array.from(s.stock.cut), 1); c.u8("stock.crossing", s.stock.crossing, 3); }
  if (s.program.text) { const text = Buffer.from(s.program.text); c.add("program.text", "text", 1, 1, "text", text); }
  const directory = Buffer.from(JSON.stringify({
    version: 1, title: s.title, operation: s.operation, command: s.command, groups: s.groups, tools: s.tools, machine: s.machine, causes: s.causes,
    findings: s.findings, figures: s.figures, histograms: s.histograms, series: s.series.map(({ value, ...x }) => x),
    meshes: s.meshes.map(({ point, index, value, ...m }) => ({ triangles: index.length / 3, of: index.length / 3, ...m })),
    outlines: s.outlines.map(({ point, value, ...o }) => o), cspaces: s.cspaces.map(({ cause, radius, ...x }) => x),
    stock: s.stock && { count: s.stock.count, origin: s.stock.origin, step: s.stock.step },
    program: { name: s.program.name, lines: s.program.text.split("\n").length - 1, cut: false }, nodes: n, box, chunks: c.list }));
  const head = Buffer.alloc(12);
  head.write("BURINSC1", 0, "latin1");
  head.writeUInt32LE(directory.length, 8);
  return Buffer.concat([head, directory, ...c.data]);
}

export function page(bytes, shell = readFileSync(new URL("../../data/pages/viewer.html", import.meta.url), "utf8"), title = "sample") {
  const put = { SCENE: bytes.toString("base64"), TITLE: title };
  return shell.replace(/@(SCENE|TITLE)@/g, (_, name) => put[name]);
}

// ---- what the samples are made of ----

export function empty(title, operation) {
  return { title, operation, command: `burin ${operation}`, box: { lo: [0, 0, 0], hi: [1, 1, 1] }, path: new Track().path(), groups: [], series: [], meshes: [], outlines: [], tools: [],
    machine: null, stock: null, cspaces: [], causes: [], findings: [], figures: [], histograms: [], program: { name: "", text: "" } };
}

class Track {
  point = []; axis = []; time = []; kind = []; feed = []; move = []; line = []; tool = []; group = []; rotary = []; text = [];
  constructor(five = false) { this.five = five; }
  go(kind, point, { feed = 1200, axis = [0, 0, 1], group = 0, rotary = [0, 0] } = {}) {
    const n = this.time.length, from = this.point.slice(-3), length = n ? Math.hypot(...point.map((v, i) => v - from[i])) : 0;
    this.point.push(...point); this.axis.push(...axis); this.rotary.push(...rotary);
    this.time.push((n ? this.time[n - 1] : 0) + length / ((kind === RAPID ? 6000 : feed) / 60));
    this.kind.push(kind); this.feed.push(kind === RAPID ? 0 : feed); this.move.push(n); this.tool.push(0); this.group.push(group);
    const f = v => v.toFixed(4);
    this.text.push(`${kind === RAPID ? "G0" : "G1"} X${f(point[0])} Y${f(point[1])} Z${f(point[2])}${this.five ? ` C${f(rotary[0])} A${f(rotary[1])}` : ""}${kind === RAPID ? "" : ` F${feed}`}`);
    this.line.push(this.text.length + 3);
  }
  path() {
    const { point, axis, time, kind, feed, move, line, tool, group, rotary } = this;
    return { count: time.length, point, axis: this.five ? axis : null, time, kind, feed, move, line, tool, group, rotary: this.five ? rotary : null };
  }
  program(name) { return { name, text: ["%", "G21 G90 G94", "M3 S12000", ...this.text, "M30", ""].join("\n") }; }
}

/** Triangles of f(u, v) over a grid; closed when walls are asked for down to z = floor. */
function sheet(nu, nv, f, floor = null) {
  const point = [], index = [], W = nu + 1;
  for (let j = 0; j <= nv; ++j) for (let i = 0; i <= nu; ++i) point.push(...f(i / nu, j / nv));
  for (let j = 0; j < nv; ++j) for (let i = 0; i < nu; ++i) { const a = j * W + i; index.push(a, a + 1, a + W + 1, a, a + W + 1, a + W); }
  if (floor !== null) {
    const rim = [];
    for (let i = 0; i < nu; ++i) rim.push(i);
    for (let j = 0; j < nv; ++j) rim.push(j * W + nu);
    for (let i = nu; i > 0; --i) rim.push(nv * W + i);
    for (let j = nv; j > 0; --j) rim.push(j * W);
    const base = point.length / 3;
    for (const r of rim) point.push(point[3 * r], point[3 * r + 1], floor);
    const n = rim.length;
    for (let k = 0; k < n; ++k) { const l = (k + 1) % n; index.push(rim[l], rim[k], base + k, rim[l], base + k, base + l); }
    for (let k = 1; k + 1 < n; ++k) index.push(base, base + k + 1, base + k);
  }
  return { point, index };
}

const ball = (radius, holder = true) => ({ number: 1, name: `ball ${2 * radius} mm`, kerf: 0, pieces: [
  { kind: 0, radius, low: 0, high: 4 * radius, corner: radius }, { kind: 1, radius: radius * 0.95, low: 4 * radius, high: 10 * radius, corner: 0 },
  ...(holder ? [{ kind: 2, radius: 12, low: 10 * radius, high: 10 * radius + 25, corner: 2 }, { kind: 2, radius: 20, low: 10 * radius + 25, high: 10 * radius + 45, corner: 0 }] : [])] });

function histogram(values, unit = "mm") {
  const step = 0.005, from = -0.05, area = new Array(20).fill(0);
  for (const v of values) if (!Number.isNaN(v)) area[Math.min(19, Math.max(0, Math.floor((v - from) / step)))] += 0.5;
  return { name: "deviation", unit, from, step, area, tolerance: 0.02 };
}

/** A pocketed wave under a ball, zigzag; with the clock of its stock. */
export function milled({ rows = 24, columns = 60, stock = true, grid = [120, 80, 34] } = {}) {
  const s = empty("waves, 3 axes", "verify"), X = 90, Y = 60, r = 4;
  const z = (x, y) => 12 + 4 * Math.sin(x / 12) * Math.cos(y / 11) - 7 * Math.exp(-((x - 58) ** 2 + (y - 30) ** 2) / 180);
  const part = sheet(150, 100, (u, v) => [u * X, v * Y, z(u * X, v * Y)], 0);
  const value = [];
  for (let i = 0; i < part.point.length; i += 3) {
    const [x, y, h] = part.point.slice(i, i + 3);
    const gouge = -0.05 * Math.exp(-((x - 30) ** 2 + (y - 20) ** 2) / 20);
    value.push(h < 1 ? NaN : 0.02 * Math.abs(Math.sin(y * 1.3)) * (0.4 + x / X) + gouge);
  }
  s.meshes.push({ name: "waves", role: 0, ...part, value, valueName: "deviation", valueUnit: "mm", valueRange: 0.05 });
  const t = new Track();
  s.groups = ["roughing", "finishing"];
  t.go(RAPID, [-8, -8, 45]);
  for (const [group, above, count] of [[0, 4, Math.ceil(rows / 2)], [1, 0, rows]]) {
    for (let j = 0; j < count; ++j) {
      const y = (j + 0.5) / count * Y, back = j % 2 === 1, xs = [];
      for (let i = 0; i <= columns; ++i) xs.push((back ? 1 - i / columns : i / columns) * X);
      const tip = x => {
        const gx = (z(x + 0.01, y) - z(x - 0.01, y)) / 0.02, gy = (z(x, y + 0.01) - z(x, y - 0.01)) / 0.02, l = Math.hypot(gx, gy, 1);
        return [x - r * gx / l, y - r * gy / l, z(x, y) + r / l - r + above];
      };
      const first = tip(xs[0]);
      if (j === 0) { t.go(RAPID, [first[0], first[1], 30], { group }); t.go(LINK, first, { feed: 300, group }); }
      else t.go(LINK, first, { group, feed: 600 });
      for (const x of xs.slice(1)) t.go(FEED, tip(x), { group, feed: group === 0 ? 1800 : 900 + 300 * Math.sin(x / 9) });
    }
    const end = t.point.slice(-3);
    t.go(RAPID, [end[0], end[1], 30], { group });
  }
  s.path = t.path();
  s.program = t.program("waves.ngc");
  s.tools = [ball(r)];
  s.series = [{ name: "deviation", unit: "mm", signed: true, value: s.path.time.map((_, i) => s.path.kind[i] === FEED ? 0.03 * Math.sin(i / 40) : NaN) },
    { name: "speed", unit: "mm/min", signed: false, value: s.path.feed.map((f, i) => f * (0.8 + 0.2 * Math.sin(i / 7))) }];
  s.machine = { name: "xyz", axes: [] };
  s.findings = [{ level: 2, title: "gouge 0.050 mm", detail: "move 700, line 704", at: [30, 20, z(30, 20)], node: 700 },
    { level: 1, title: "excess 0.021 mm", detail: "area 12 mm²", at: [80, 45, z(80, 45)], node: null }, { level: 0, title: "spacing 0.5 mm", detail: "bound 0.002 mm", at: null, node: null }];
  s.figures = [{ group: "quality", name: "worst gouge", value: "0.050 mm" }, { group: "quality", name: "worst excess", value: "0.021 mm" }, { group: "path", name: "time", value: "12 min" }];
  s.histograms = [histogram(value)];
  s.box = { lo: [-10, -10, 0], hi: [X + 10, Y + 10, 45] };
  if (stock) s.stock = clock(s.path, r, { lo: [0, 0, 0], hi: [X, Y, 22] }, grid);
  return s;
}

/** Nodes against capsules of the ball (and all above them): slow and simple. */
function clock(path, r, block, grid) {
  const step = Math.max(...[0, 1, 2].map(i => (block.hi[i] - block.lo[i]) / (grid[i] - 1)));
  const count = [0, 1, 2].map(i => Math.floor((block.hi[i] - block.lo[i]) / step + 1e-9) + 3), origin = block.lo.map(v => v - step * 0.5);
  const [nx, ny, nz] = count, N = nx * ny * nz, cut = new Uint32Array(N).fill(0xffffffff), distance = new Float32Array(N).fill(1e3);
  const at = (i, j, k) => (k * ny + j) * nx + i;
  const clampTo = (v, a, b) => Math.min(b, Math.max(a, v));
  for (let m = 1; m < path.count; ++m) {
    const a = path.point.slice(3 * m - 3, 3 * m), b = path.point.slice(3 * m, 3 * m + 3), d = b.map((v, i) => v - a[i]), dd = d[0] ** 2 + d[1] ** 2 + d[2] ** 2;
    if (path.kind[m] === RAPID && Math.min(a[2], b[2]) > block.hi[2]) continue;
    const range = c => [clampTo(Math.floor((Math.min(a[c], b[c]) - r - origin[c]) / step) - 1, 0, count[c] - 1), clampTo(Math.ceil((Math.max(a[c], b[c]) + r - origin[c]) / step) + 1, 0, count[c] - 1)];
    const [i0, i1] = range(0), [j0, j1] = range(1), k0 = clampTo(Math.floor((Math.min(a[2], b[2]) - origin[2]) / step) - 1, 0, nz - 1);
    for (let k = k0; k < nz; ++k) for (let j = j0; j <= j1; ++j) for (let i = i0; i <= i1; ++i) {
      const p = [origin[0] + i * step, origin[1] + j * step, origin[2] + k * step];
      // Ball centre r above the tip; what stands above the ball is within the cylinder.
      const q = dd > 0 ? clampTo(((p[0] - a[0]) * d[0] + (p[1] - a[1]) * d[1] + (p[2] - r - a[2]) * d[2]) / dd, 0, 1) : 0;
      const qh = d[0] ** 2 + d[1] ** 2 > 0 ? clampTo(((p[0] - a[0]) * d[0] + (p[1] - a[1]) * d[1]) / (d[0] ** 2 + d[1] ** 2), 0, 1) : 0;
      const f = t => { const x = p[0] - a[0] - t * d[0], y = p[1] - a[1] - t * d[1], h = p[2] - r - a[2] - t * d[2]; return Math.hypot(x, y, Math.min(0, h)) - r; };
      const v = Math.min(f(q), f(qh)), n = at(i, j, k);
      if (v < distance[n]) distance[n] = v;
      if (v < 0 && cut[n] === 0xffffffff) cut[n] = 1 + path.move[m];
    }
  }
  // The block itself: nodes outside never were material.
  const inside = (i, j, k) => { const p = [i, j, k].map((v, c) => origin[c] + v * step); return Math.min(...p.map((v, c) => Math.min(v - block.lo[c], block.hi[c] - v))); };
  const crossing = new Uint8Array(3 * N), share = f => clampTo(Math.round(f * 256 - 1), 1, 255);
  for (let k = 0; k < nz; ++k) for (let j = 0; j < ny; ++j) for (let i = 0; i < nx; ++i) if (inside(i, j, k) <= 0) cut[at(i, j, k)] = 0;
  for (let k = 0; k < nz; ++k) for (let j = 0; j < ny; ++j) for (let i = 0; i < nx; ++i) {
    const n = at(i, j, k), here = [i, j, k];
    for (let c = 0; c < 3; ++c) {
      const next = here.map((v, e) => v + (e === c ? 1 : 0));
      if (next[c] >= count[c]) continue;
      const m = at(...next), empties = (cut[n] === 0) !== (cut[m] === 0), final = (cut[n] === 0xffffffff) !== (cut[m] === 0xffffffff);
      const d0 = empties ? inside(i, j, k) : distance[n], d1 = empties ? inside(...next) : distance[m];
      if ((empties || final) && d0 * d1 <= 0 && d0 !== d1) crossing[3 * n + c] = share(d0 / (d0 - d1));
    }
  }
  return { count, origin, step, cut, crossing };
}

/** A dome under a tilted ball on a trunnion: u = (sin a sin c, sin a cos c, cos a). */
export function fiveAxis({ rings = 26, around = 90 } = {}) {
  const s = empty("dome, 5 axes", "orient"), R = 35, r = 3;
  const dome = sheet(120, 40, (u, v) => { const a = 2 * Math.PI * u, e = v * Math.PI * 0.47, q = R * (1 + 0.06 * Math.cos(5 * a) * Math.sin(e)); return [q * Math.sin(e) * Math.cos(a), q * Math.sin(e) * Math.sin(a), q * Math.cos(e)]; });
  for (let i = 0; i < dome.index.length; i += 3) [dome.index[i], dome.index[i + 1]] = [dome.index[i + 1], dome.index[i]];
  const value = [];
  for (let i = 0; i < dome.point.length; i += 3) value.push(0.012 * Math.sin(dome.point[i] / 3) + 0.01 * Math.cos(dome.point[i + 1] / 4));
  s.meshes.push({ name: "dome", role: 0, ...dome, value, valueName: "deviation", valueUnit: "mm", valueRange: 0 });
  s.meshes.push({ name: "clamp", role: 2, ...sheet(1, 1, (u, v) => [44 + 14 * u, -7 + 14 * v, 18], 0), value: null, valueName: "", valueUnit: "", valueRange: 0 });
  const t = new Track(true);
  let c = 0;
  t.go(RAPID, [0, 0, 80]);
  for (let j = 0; j < rings; ++j) {
    const e = 0.08 + (j / rings) * Math.PI * 0.42;
    for (let i = 0; i <= around; ++i) {
      const a = 2 * Math.PI * i / around, q = R * (1 + 0.06 * Math.cos(5 * a) * Math.sin(e));
      const n = [Math.sin(e) * Math.cos(a), Math.sin(e) * Math.sin(a), Math.cos(e)], tilt = Math.min(e + 0.25, 1.45);
      const u = [Math.sin(tilt) * Math.cos(a + 0.2), Math.sin(tilt) * Math.sin(a + 0.2), Math.cos(tilt)];
      const p = n.map((v, k) => q * v + r * v - r * u[k]);
      let deg = Math.atan2(u[0], u[1]) * 180 / Math.PI;
      while (deg < c - 180) deg += 360;
      while (deg > c + 180) deg -= 360;
      c = deg;
      const rotary = [c, Math.acos(u[2]) * 180 / Math.PI];
      if (i === 0 && j === 0) t.go(RAPID, p.map((v, k) => v + 20 * u[k]), { axis: u, rotary, group: j });
      t.go(i === 0 ? LINK : FEED, p, { axis: u, rotary, group: Math.floor(j / 4), feed: 1500 - 40 * j });
    }
  }
  t.go(RAPID, [0, 0, 80], { group: 6 });
  s.path = t.path();
  s.program = t.program("dome.ngc");
  s.groups = ["pass 1", "pass 2", "pass 3", "pass 4", "pass 5", "pass 6", "pass 7"];
  s.tools = [ball(r)];
  s.series = [{ name: "effective radius", unit: "mm", signed: false, value: s.path.time.map((_, i) => i < 2 ? NaN : 3 + 9 * Math.abs(Math.sin(i / 300))) }];
  s.machine = { name: "xyzac-trunnion", axes: [{ letter: "C", table: true, direction: [0, 0, 1], point: [0, 0, 0] }, { letter: "A", table: true, direction: [1, 0, 0], point: [0, 0, -20] }] };
  s.causes = ["free", "gouge", "holder", "axis limit"];
  for (const node of [200, 1200]) {
    const tilts = 31, yaws = 61, cause = [], radius = [];
    for (let i = 0; i < tilts; ++i) for (let j = 0; j < yaws; ++j) {
      const a = i / 30, b = j / 60, what = a > 0.85 ? 3 : a < 0.12 ? 1 : Math.hypot(a - 0.5, b - 0.7) < 0.17 ? 2 : 0;
      cause.push(what); radius.push(what ? NaN : 3 + 6 * a * (1 + Math.sin(6 * b)));
    }
    s.cspaces.push({ node, label: `ring ${Math.floor(node / 91)}, point ${node % 91}`, tilt: [0, 60], yaw: [-180, 180], tilts, yaws, cause, radius, chosen: [22, 15], initial: [10, 0] });
  }
  s.findings = [{ level: 1, title: "holder 0.4 mm from the clamp", detail: "move 900", at: [44, 0, 18], node: 900 }];
  s.figures = [{ group: "orientation", name: "mean effective radius", value: "7.1 mm" }];
  s.histograms = [histogram(value)];
  s.box = { lo: [-60, -60, -10], hi: [60, 60, 80] };
  return s;
}

/** A plate with holes under a beam. */
export function laser() {
  const s = empty("plate, laser", "laser"), kerf = 0.28, t = new Track();
  const round = (cx, cy, w, h, q, n = 12) => {
    const points = [];
    for (const [sx, sy, a0] of [[1, 1, 0], [-1, 1, 90], [-1, -1, 180], [1, -1, 270]]) for (let i = 0; i <= n; ++i) {
      const a = (a0 + 90 * i / n) * Math.PI / 180;
      points.push([cx + sx * (w / 2 - q) + q * Math.cos(a), cy + sy * (h / 2 - q) + q * Math.sin(a)]);
    }
    return points;
  };
  const shapes = [[[20, 20], 0.01], [[60, 20], -0.02], [[100, 20], 0]].map(([c]) => ({ hole: true, points: round(...c, 16, 16, 7.999, 24), grown: round(...c, 16 - kerf, 16 - kerf, 8 - kerf / 2 - 0.001, 24) }));
  for (let i = 0; i < 9; ++i) shapes.push({ hole: true, points: round(14 + 11.5 * i, 45, 7, 14, 1.5), grown: round(14 + 11.5 * i, 45, 7 - kerf, 14 - kerf, 1.5 - kerf / 2) });
  shapes.push({ hole: false, points: round(60, 32, 116, 60, 6), grown: round(60, 32, 116 + kerf, 60 + kerf, 6 + kerf / 2) });
  t.go(RAPID, [0, 0, 0]);
  shapes.forEach((shape, group) => {
    s.groups.push(shape.hole ? `hole ${group + 1}` : "outer contour");
    const g = shape.grown, lead = shape.hole ? [(g[0][0] * 2 + g[20][0]) / 3, (g[0][1] * 2 + g[20][1]) / 3] : [g[0][0] + 2, g[0][1]];
    t.go(RAPID, [...lead, 0], { group });
    t.go(LINK, [...g[0], 0], { group, feed: 800 });
    for (const p of [...g.slice(1), g[0]]) t.go(FEED, [...p, 0], { group, feed: shape.hole ? 1500 : 2500 });
    const point = shape.points.flatMap(p => [p[0], p[1], 0]);
    s.outlines.push({ name: s.groups[group], part: true, closed: true, point, value: shape.points.map((_, i) => 0.02 * Math.sin(i / 6 + group)) });
  });
  s.outlines.push({ name: "bend line", part: false, closed: false, point: [2, 55, 0, 118, 55, 0], value: null });
  s.path = t.path();
  s.program = t.program("plate.ngc");
  s.tools = [{ number: 1, name: `laser, kerf ${kerf} mm`, kerf, pieces: [] }];
  s.series = [{ name: "edge deviation", unit: "mm", signed: true, value: s.path.time.map((_, i) => s.path.kind[i] === FEED ? 0.02 * Math.sin(i / 15) : NaN) }];
  s.findings = [{ level: 1, title: "edge 0.020 mm outside", detail: "hole 2", at: [60, 28, 0], node: 60 }];
  s.figures = [{ group: "cutting", name: "length", value: "612.4 mm" }, { group: "cutting", name: "pierces", value: "13" }];
  s.box = { lo: [0, 0, 0], hi: [120, 64, 0] };
  return s;
}

/** 200,000 nodes over a wavy part of 100,000 triangles. */
export function large({ nodes = 200_000 } = {}) {
  const s = empty("200,000 nodes", "rotary"), X = 200, Y = 150;
  const z = (x, y) => 15 + 6 * Math.sin(x / 17) * Math.sin(y / 13) + 2 * Math.cos(x / 5);
  s.meshes.push({ name: "large", role: 0, ...sheet(288, 174, (u, v) => [u * X, v * Y, z(u * X, v * Y)]), value: null, valueName: "", valueUnit: "", valueRange: 0 });
  const t = new Track(), rows = 200, columns = nodes / rows - 1;
  for (let j = 0; j < rows; ++j) for (let i = 0; i <= columns; ++i) {
    const x = (j % 2 ? 1 - i / columns : i / columns) * X, y = (j + 0.5) / rows * Y;
    t.go(i === 0 ? (j === 0 ? RAPID : LINK) : FEED, [x, y, z(x, y)], { group: Math.floor(j / 10), feed: 1000 + 500 * Math.sin(x / 20) });
  }
  s.path = t.path();
  s.program = t.program("large.ngc");
  for (let j = 0; j < rows / 10; ++j) s.groups.push(`pass ${j + 1}`);
  s.tools = [ball(3)];
  s.series = [{ name: "deviation", unit: "mm", signed: true, value: s.path.time.map((_, i) => 0.02 * Math.sin(i / 500)) }];
  s.box = { lo: [0, 0, 0], hi: [X, Y, 30] };
  return s;
}

export const samples = { milled, fiveAxis, laser, large, empty: () => empty("nothing", "view"), clock: () => milled({ grid: [170, 115, 52] }) };

if (process.argv[1] === fileURLToPath(import.meta.url) && process.argv[2]) {
  const [, , out, ...names] = process.argv;
  mkdirSync(out, { recursive: true });
  for (const [name, make] of Object.entries(samples)) if (names.length === 0 || names.includes(name)) {
    const text = page(container(make()), undefined, name);
    writeFileSync(`${out}/${name}.html`, text);
    console.log(`${out}/${name}.html ${text.length} bytes`);
  }
}

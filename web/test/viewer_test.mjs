// SPDX-License-Identifier: Apache-2.0
// usage: node viewer_test.mjs BURIN SOURCE_DIR [SHOTS_DIR]
// The page in a browser: pages that burin makes of all four operations load, play, scrub, pick, and nothing is reported on the console.
// Exit 77 (left out) with the reason when there is no browser.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { launch, look, missing, open } from "./browser.mjs";

const [burin, source, shots] = process.argv.slice(2).map(path => resolve(path));
const reason = await missing();
if (reason) { console.log("left out: " + reason); process.exit(77); }

const work = mkdtempSync(join(tmpdir(), "burin-viewer-"));
process.on("exit", () => rmSync(work, { recursive: true, force: true }));
if (shots) mkdirSync(shots, { recursive: true });
const example = name => join(source, "examples", name);

function run(args, codes = [0]) {
  const p = spawnSync(burin, args, { encoding: "utf8", cwd: work });
  assert(codes.includes(p.status), `burin ${args.join(" ")}: exit ${p.status}\n${p.stderr}`);
  return p;
}
function page(name, ...args) {
  const file = join(work, name + ".html");
  run(["view", ...args, "-o", file], [0, 3]);
  return pathToFileURL(file).href;
}

const tests = [];
const test = (name, body) => tests.push({ name, body });
const state = p => p.evaluate(() => ({ ...window.burin.store.state }));
const path = p => p.evaluate(() => { const q = window.burin.scene.path; return { count: q.count, end: q.time[q.count - 1] }; });
async function shot(opened, name) {
  const png = await opened.page.screenshot();
  if (shots) writeFileSync(join(shots, name + ".png"), png);
  return look(opened.page, png);
}

run(["laser", example("bracket/bracket.dxf"), "--kerf", "0.3", "--layers", "CENTER=ignore,MARK=engrave", "-o", "bracket.ngc", "--cl", "bracket.cl"], [0, 3]);
run(["cycle", example("keys/keys.nc"), "-o", "keys.ngc", "--cl", "keys.cl"]);
run(["rotary", example("cam/cam.toml"), "-o", "cam.ngc", "--cl", "cam.cl"]);
run(["orient", example("walls/walls.toml"), "-o", "walls.ngc", "--cl", "walls.cl"], [0, 3]);
const pages = {
  laser: page("laser", example("bracket/bracket.dxf"), "bracket.ngc", "--kerf", "0.3"),
  cycle: page("cycle", "keys.cl"),
  rotary: page("rotary", example("cam/cam.toml"), "cam.cl"),
  orient: page("orient", example("walls/walls.toml"), "walls.cl"),
};

for (const [operation, url] of Object.entries(pages)) {
  test(`${operation}: loads, plays, scrubs, draws, and the console stays empty`, async browser => {
    const o = await open(browser, url);
    const { count, end } = await path(o.page);
    assert(count > 10 && end > 0, `${count} nodes, ${end} s`);
    const first = await shot(o, operation);
    assert(first.drawn > 0.05 && first.colours > 8, JSON.stringify(first));
    // Play: time goes on, and stops when told to.
    await o.page.evaluate(e => window.burin.store.set({ speed: e / 5 }), end);
    await o.page.keyboard.press("Space");
    await o.page.waitForFunction(() => window.burin.store.state.time > 0);
    await o.page.keyboard.press("Space");
    const stopped = (await state(o.page)).time;
    await o.page.waitForTimeout(300);
    assert.equal((await state(o.page)).time, stopped);
    // Scrub to the middle: the node is the one at or before the time.
    await o.page.evaluate(t => window.burin.store.set({ time: t }), end / 2);
    await o.page.waitForTimeout(100);
    const at = await o.page.evaluate(() => { const s = window.burin.store.state, t = window.burin.scene.path.time; return { node: s.node, before: t[s.node], after: t[s.node + 1] ?? Infinity, time: s.time }; });
    assert(at.before <= at.time + 1e-9 && at.time <= at.after + 1e-9, JSON.stringify(at));
    assert.deepEqual(o.faults, []);
    await o.close();
  });
}

test("a click on the path picks a segment near it", async browser => {
  const o = await open(browser, pages.cycle);
  const hit = await o.page.evaluate(() => {
    const { path } = window.burin.scene;
    for (let i = Math.floor(path.count / 2); i < path.count; ++i) {
      if (path.kind[i] !== 1) continue;
      const p = [0, 1, 2].map(k => (path.point[3 * i + k] + path.point[3 * i - 3 + k]) / 2 + window.burin.scene.center[k]);
      const q = window.burin.stage.project(p);
      if (q) return { ...q, node: i };
    }
    return null;
  });
  assert(hit);
  await o.page.mouse.click(hit.x, hit.y);
  await o.page.waitForFunction(() => window.burin.store.state.picked !== null, null, { timeout: 5000 });
  const { picked } = await state(o.page);
  // What was picked passes the place of the click within a few pixels, whichever pass is in front.
  const far = await o.page.evaluate(({ x, y, picked }) => {
    const { path, center } = window.burin.scene;
    const at = i => window.burin.stage.project([0, 1, 2].map(k => path.point[3 * i + k] + center[k]));
    const a = at(picked - 1), b = at(picked), dx = b.x - a.x, dy = b.y - a.y, l = dx * dx + dy * dy;
    const t = l > 0 ? Math.min(1, Math.max(0, ((x - a.x) * dx + (y - a.y) * dy) / l)) : 0;
    return Math.hypot(a.x + t * dx - x, a.y + t * dy - y);
  }, { ...hit, picked });
  assert(far < 8, `${far} pixels`);
  assert.deepEqual(o.faults, []);
  await o.close();
});

test("dark, and at the width of a phone: nothing wider than the page", async browser => {
  for (const [operation, url] of Object.entries(pages)) {
    const o = await open(browser, url, { width: 390, height: 844, dark: true, touch: true });
    const wide = await o.page.evaluate(() => document.documentElement.scrollWidth);
    assert(wide <= 390, `${operation}: ${wide} pixels`);
    const seen = await shot(o, operation + "-phone-dark");
    assert(seen.mean.every(v => v < 128), `dark: mean ${seen.mean}`);
    assert.deepEqual(o.faults, []);
    await o.close();
  }
});

test("200,000 segments open in seconds from a page below 10 MB", async browser => {
  const lines = ["CUTTER/6,3", "FEDRAT/1000"];
  for (let i = 0; i <= 200_000; ++i) { const a = i * 0.01; lines.push(`GOTO/${(50 * Math.cos(a)).toFixed(4)},${(50 * Math.sin(a)).toFixed(4)},${(i * 2e-4 + 0.3 * Math.sin(7 * a)).toFixed(4)}`); }
  writeFileSync(join(work, "long.cl"), lines.join("\n") + "\nFINI\n");
  const url = page("long", "long.cl"), bytes = statSync(join(work, "long.html")).size;
  assert(bytes < 10e6, `${bytes} bytes`);
  const o = await open(browser, url);
  assert((await path(o.page)).count >= 200_000);
  console.log(`   200,000 segments: ${bytes} bytes, open after ${o.milliseconds} ms`);
  await shot(o, "long");
  assert.deepEqual(o.faults, []);
  await o.close();
});

const only = process.env.BURIN_ONLY;
const browser = await launch();
let failed = 0;
for (const { name, body } of tests) {
  if (only && !name.includes(only)) continue;
  try { await body(browser); console.log("ok    " + name); } catch (error) { ++failed; console.log("FAILS " + name + "\n" + error.stack); }
}
await browser.close();
process.exitCode = failed ? 1 : 0;

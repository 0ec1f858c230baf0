// SPDX-License-Identifier: Apache-2.0
// What stands about the stage, in a browser: lists, listing, charts and close-ups lead to one another. node --test test/panels_test.mjs
import assert from "node:assert/strict";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { launch, missing, open } from "./browser.mjs";
import { container, page, samples } from "./sample.mjs";

const reason = await missing(), skip = reason ?? false, out = mkdtempSync(join(tmpdir(), "burin-panels-"));
let browser;
before(async () => { if (!skip) browser = await launch(); });
after(async () => { await browser?.close(); rmSync(out, { recursive: true, force: true }); });
const made = new Map();
function url(name) {
  if (!made.has(name)) { const file = join(out, `${name}.html`); writeFileSync(file, page(container(samples[name]()))); made.set(name, pathToFileURL(file).href); }
  return made.get(name);
}
const state = p => p.evaluate(() => ({ ...window.burin.store.state }));
const settle = p => p.evaluate(() => new Promise(r => requestAnimationFrame(() => requestAnimationFrame(r))));

test("a line of the program leads to its node and the time to its line", { skip }, async () => {
  const { page: p, faults, close } = await open(browser, url("milled"));
  await p.keyboard.press("/");
  await p.keyboard.type("1200");
  await p.keyboard.press("Enter");
  await p.click(".code-line.found");
  const { node } = await state(p), line = n => p.evaluate(k => window.burin.scene.path.line[k], n);
  assert.equal(await line(node), 1200);
  await p.evaluate(() => window.burin.store.set({ time: window.burin.scene.path.time[300] }));
  await settle(p);
  assert.equal(Number(await p.getAttribute(".code-line.now", "data-n")), await line(300));
  assert(await p.locator(".code-line").count() < 120, "only lines in sight exist");
  await p.focus(".code");
  await p.keyboard.press("ArrowDown");
  assert.equal(await line((await state(p)).node), await line(300) + 1);
  assert.deepEqual(faults, []);
  await close();
});

test("keys: play, steps, views, help; a finding leads to its place; a link to its time", { skip }, async () => {
  const { page: p, faults, close } = await open(browser, url("milled"));
  await p.keyboard.press("ArrowRight");
  assert.equal((await state(p)).node, 1);
  await p.keyboard.press("]");
  const pass = (await state(p)).node;
  assert(pass > 1);
  await p.keyboard.press("ArrowLeft");
  assert.equal((await state(p)).node, pass - 1);
  await p.keyboard.press("?");
  assert(await p.isVisible("dialog.help"));
  await p.keyboard.press("Escape");
  assert(!await p.isVisible("dialog.help"));
  await p.keyboard.press("Alt+1");
  await p.click(".finding.l2");
  const s = await state(p), finding = await p.evaluate(() => window.burin.scene.findings.find(f => f.level === 2));
  assert.equal(s.picked, finding.node);
  assert.deepEqual(s.lookAt.at, finding.at);
  await p.evaluate(() => { location.hash = "t=12.5"; });
  await p.waitForFunction(() => window.burin.store.state.time === 12.5);
  assert.equal(await p.getAttribute(".strip", "aria-valuenow"), "12.50");
  assert.deepEqual(faults, []);
  await close();
});

test("colours have legends: ranges are set, a group alone is shown and let go", { skip }, async () => {
  const { page: p, faults, close } = await open(browser, url("milled")), colour = 'select[aria-label="Colour of the path"]';
  await p.selectOption(colour, "series:0");
  await p.click('.limits[data-of="deviation"] summary');
  await p.fill('.limits[data-of="deviation"] input >> nth=1', "0.02");
  await p.keyboard.press("Enter");
  assert.equal((await state(p)).range[1], 0.02);
  await p.selectOption(colour, "group");
  await p.click(".legend .chip >> nth=1");
  assert.equal((await state(p)).only, 1);
  assert.equal((await state(p)).range, null);
  await p.keyboard.press("Escape");
  assert.equal((await state(p)).only, null);
  assert.deepEqual(faults, []);
  await close();
});

test("angles: the map follows the node, a click says the cause there", { skip }, async () => {
  const { page: p, faults, close } = await open(browser, url("fiveAxis"), { dark: true });
  await p.click("#tab-angles");
  const maps = await p.evaluate(() => window.burin.scene.cspaces.map(c => ({ node: c.node, label: c.label, tilt: c.tilt, yaw: c.yaw })));
  for (const m of maps) {
    await p.evaluate(n => window.burin.store.set({ picked: n }), m.node);
    await settle(p);
    assert((await p.textContent("#panel-angles .readout")).startsWith(m.label));
  }
  const box = await p.locator("#panel-angles .map").boundingBox();
  await p.mouse.click(box.x + 50, box.y + box.height / 2); // the least tilt: a gouge in this scene
  assert.match(await p.textContent("#panel-angles .readout"), /there tilt .*: gouge/);
  assert.deepEqual(faults, []);
  await close();
});

test("close-ups say scallops and the kerf", { skip }, async () => {
  const milled = await open(browser, url("milled"));
  await milled.page.evaluate(() => { const { path } = window.burin.scene; let n = 0; for (let i = 1; i < path.count; ++i) if (path.group[i] === 1 && path.kind[i] === 1) { n = i; if (i > 0.75 * path.count && path.kind[i + 20] === 1 && path.kind[i - 20] === 1) break; } window.burin.store.set({ picked: n }); });
  await milled.page.click("#tab-closeup");
  await milled.page.waitForSelector("#panel-closeup td");
  assert.match(await milled.page.textContent("#panel-closeup .readout"), /scallop on the left, right[\d.]+ (mm|µm), [\d.]+ (mm|µm)/);
  assert.deepEqual(milled.faults, []);
  await milled.close();
  const laser = await open(browser, url("laser"));
  await laser.page.evaluate(() => { const t = window.burin.scene.path.time; window.burin.store.set({ time: t[t.length - 60] }); });
  await laser.page.click("#tab-closeup");
  await laser.page.waitForSelector("#panel-closeup td");
  assert.match(await laser.page.textContent("#panel-closeup .readout"), /kerf0\.280 mmbeam to the edge of the part0\.1[34]\d+ mm/);
  assert.deepEqual(laser.faults, []);
  await laser.close();
});

test("at phone width nothing hangs over and every panel opens", { skip }, async () => {
  for (const name of ["fiveAxis", "laser", "empty"]) {
    const { page: p, faults, close } = await open(browser, url(name), { width: 360, height: 740, touch: true });
    for (const tab of await p.locator("[role=tab]").all()) {
      await tab.tap();
      await settle(p);
      const wide = await p.evaluate(() => [document.documentElement.scrollWidth, document.documentElement.scrollHeight, document.querySelector(".stage").clientHeight]);
      assert(wide[0] <= 360 && wide[1] <= 740 && wide[2] >= 90, `${name} ${await tab.textContent()}: ${wide}`);
    }
    const unnamed = await p.evaluate(() => [...document.querySelectorAll("button, input, select, [tabindex='0']")].filter(e => !(e.getAttribute("aria-label") || e.textContent.trim() || e.labels?.length || e.title)).map(e => e.outerHTML));
    assert.deepEqual(unnamed, []);
    assert.deepEqual(faults, []);
    await close();
  }
});

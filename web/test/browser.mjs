// SPDX-License-Identifier: Apache-2.0
// Headless Chromium for the tests of the page. Finds the browser and playwright-core, or says why not.
import { existsSync } from "node:fs";

const BROWSERS = [process.env.BURIN_CHROMIUM, "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
// WebGL is drawn by the processor: the same picture on every machine, and none needs a graphics card.
const FLAGS = ["--no-sandbox", "--disable-gpu", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run",
  "--disable-background-networking", "--disable-component-update", "--disable-sync"];

/** What is missing, or null. */
export async function missing() {
  if (!BROWSERS.some(path => path && existsSync(path))) return "no Chromium (Debian: apt-get install chromium)";
  try { await import("playwright-core"); } catch { return "no playwright-core (scripts/page deps)"; }
  return null;
}

export async function launch() {
  const { chromium } = await import("playwright-core");
  return chromium.launch({ executablePath: BROWSERS.find(path => path && existsSync(path)), args: FLAGS });
}

/** A page that collects what goes wrong in it: errors, console errors, requests to anywhere but `allowed`. */
export async function open(browser, url, { width = 1280, height = 800, dark = false, touch = false } = {}) {
  const context = await browser.newContext({ viewport: { width, height }, colorScheme: dark ? "dark" : "light", hasTouch: touch, deviceScaleFactor: 1 });
  const page = await context.newPage();
  const faults = [];
  page.on("pageerror", error => faults.push("error: " + error.message));
  page.on("console", message => { if (message.type() === "error") faults.push("console: " + message.text()); });
  page.on("request", request => { if (!/^(file|data|blob):/.test(request.url()) && !request.url().startsWith(new URL(url).origin + "/")) faults.push("request: " + request.url()); });
  const start = Date.now();
  await page.goto(url);
  await page.waitForFunction(() => window.burin !== undefined, null, { timeout: 60_000 });
  return { page, faults, milliseconds: Date.now() - start, close: () => context.close() };
}

/** Share of the pixels of a PNG that are not its most frequent colour, and how many colours it has: a coarse look at what is there. */
export async function look(page, png) {
  return page.evaluate(async base64 => {
    const bytes = Uint8Array.from(atob(base64), c => c.charCodeAt(0));
    const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    const canvas = new OffscreenCanvas(image.width, image.height), g = canvas.getContext("2d");
    g.drawImage(image, 0, 0);
    const d = g.getImageData(0, 0, image.width, image.height).data, seen = new Map();
    for (let i = 0; i < d.length; i += 4) { const c = (d[i] >> 4) << 8 | (d[i + 1] >> 4) << 4 | d[i + 2] >> 4; seen.set(c, (seen.get(c) ?? 0) + 1); }
    const most = Math.max(...seen.values()), all = d.length / 4, mean = [0, 1, 2].map(k => { let s = 0; for (let i = k; i < d.length; i += 4) s += d[i]; return s / all; });
    return { drawn: 1 - most / all, colours: seen.size, mean };
  }, png.toString("base64"));
}

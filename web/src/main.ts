// SPDX-License-Identifier: Apache-2.0
// The page: reads the scene that is in it (or the one beside it), then makes the panels and the stage.
import { startClock } from "./clock";
import { DamagedScene, decodeScene, fromBase64, type Progress } from "./decode";
import { makeLayout } from "./layout";
import type { Scene } from "./scene";
import { Stage } from "./stage";
import { initialState, Store } from "./state";

declare global { interface Window { burin?: { scene: Scene; store: Store; stage: Stage; opened: number } } }

/** From the page itself; when it is an empty shell, from beside it. */
async function sceneBytes(progress: Progress): Promise<Uint8Array> {
  const element = document.getElementById("burin-scene");
  const text = element?.textContent?.trim() ?? "";
  element?.remove(); // its text is large
  if (text !== "" && !text.startsWith("@")) return fromBase64(text);
  if (location.protocol === "file:") throw new DamagedScene('There is no scene in this page (write it with "burin view", or open it from "burin view --serve").');
  const answer = await fetch("scene.bin", { cache: "no-store" });
  if (!answer.ok || !answer.body) throw new DamagedScene(`The scene cannot be fetched: ${answer.status} ${answer.statusText} (from a running "burin view --serve").`);
  const all = Number(answer.headers.get("content-length") ?? 0), pieces: Uint8Array[] = [];
  let have = 0;
  for (const reader = answer.body.getReader();;) {
    const step = await reader.read();
    if (step.done) break;
    pieces.push(step.value); have += step.value.length;
    progress(all > 0 ? have / all : 0, "fetching");
  }
  const bytes = new Uint8Array(have);
  let at = 0;
  for (const p of pieces) { bytes.set(p, at); at += p.length; }
  return bytes;
}

function say(app: HTMLElement, className: string, text: string): void {
  const p = document.createElement("p");
  p.className = className;
  p.setAttribute("role", className === "failed" ? "alert" : "status");
  p.style.cssText = "max-width:40em;margin:20vh auto 0;padding:0 1.5em;text-align:center";
  p.textContent = text;
  app.replaceChildren(p);
}

async function open(): Promise<void> {
  const app = document.getElementById("app")!;
  try {
    say(app, "loading", "Opening …");
    const progress: Progress = (share, what) => { app.firstElementChild!.textContent = `Opening … ${Math.round(100 * share)} % (${what})`; };
    const scene = await decodeScene(await sceneBytes(progress), progress);
    if (scene.title) document.title = scene.title;
    const store = new Store({ ...initialState(), heat: scene.meshes.some(m => m.value !== null) || scene.outlines.some(o => o.value !== null) });
    app.replaceChildren();
    const { stage: box } = makeLayout(app, scene, store);
    const stage = new Stage(box, scene, store);
    startClock(scene, store);
    window.burin = { scene, store, stage, opened: performance.now() };
  } catch (error) {
    say(app, "failed", error instanceof DamagedScene ? error.message : `This page cannot be shown: ${error instanceof Error ? error.message : String(error)}`);
    if (!(error instanceof DamagedScene)) console.error(error);
  }
}

void open();

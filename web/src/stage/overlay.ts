// SPDX-License-Identifier: Apache-2.0
// Text over the picture: scale bar, axes of the view, labels of places.
import type { Vector3 } from "three";

const SVG = "http://www.w3.org/2000/svg";
const AXES = [{ name: "X", colour: "#d1495b" }, { name: "Y", colour: "#3a9d5d" }, { name: "Z", colour: "#3f7fd6" }];
const ARM = 26; // CSS pixels

function svg(name: string, attributes: Record<string, string | number>): SVGElement {
  const e = document.createElementNS(SVG, name);
  for (const [k, v] of Object.entries(attributes)) e.setAttribute(k, String(v));
  return e;
}
export interface Label { text: string; x: number; y: number; strong?: boolean; free?: boolean } // free: not kept within the picture

export class Overlay {
  private root = document.createElement("div");
  private scaleBar = document.createElement("div");
  private scaleText = document.createElement("span");
  private triad: { line: SVGElement; text: SVGElement }[] = [];
  private labels: HTMLElement[] = [];
  private picture = svg("svg", { width: 76, height: 76, viewBox: "-38 -38 76 76" });

  constructor(box: HTMLElement) {
    const place = (e: HTMLElement | SVGElement, css: string): void => { e.style.cssText = css; };
    place(this.root, "position:absolute;inset:0;pointer-events:none;overflow:hidden;font-size:12px;line-height:1.3;color:var(--ink,CanvasText)");
    place(this.picture, "position:absolute;left:6px;bottom:6px");
    for (const a of AXES) {
      const line = svg("line", { x1: 0, y1: 0, stroke: a.colour, "stroke-width": 2, "stroke-linecap": "round" });
      const text = svg("text", { fill: a.colour, "font-size": 11, "font-weight": 600, "text-anchor": "middle", "dominant-baseline": "central" });
      text.textContent = a.name;
      this.triad.push({ line, text });
    }
    this.picture.setAttribute("aria-hidden", "true");
    place(this.scaleBar, "position:absolute;left:88px;bottom:14px;border:1px solid var(--soft,GrayText);border-top:0;height:6px;box-sizing:border-box");
    place(this.scaleText, "position:absolute;bottom:7px;left:50%;transform:translateX(-50%);white-space:nowrap;color:var(--soft,GrayText);font-variant-numeric:tabular-nums");
    this.scaleBar.append(this.scaleText);
    this.root.append(this.picture, this.scaleBar);
    box.append(this.root);
  }
  /** Directions of the camera in the frame that is shown; mm of a CSS pixel. */
  frame(right: Vector3, up: Vector3, back: Vector3, pixel: number): void {
    const ends = AXES.map((_, i) => ({ i, x: right.getComponent(i) * ARM, y: -up.getComponent(i) * ARM, z: back.getComponent(i) }));
    ends.sort((a, b) => a.z - b.z);
    for (const e of ends) {
      const { line, text } = this.triad[e.i]!, l = Math.hypot(e.x, e.y) || 1, out = 1 + 8 / Math.max(l, 8);
      line.setAttribute("x2", e.x.toFixed(1)); line.setAttribute("y2", e.y.toFixed(1));
      text.setAttribute("x", (e.x * out).toFixed(1)); text.setAttribute("y", (e.y * out).toFixed(1));
      const faint = l < ARM * 0.12 ? "0" : "1"; // it points at us
      text.setAttribute("opacity", faint);
      this.picture.append(line, text);
    }
    const wish = 90 * pixel, power = 10 ** Math.floor(Math.log10(wish)), nice = power * (wish / power >= 5 ? 5 : wish / power >= 2 ? 2 : 1);
    this.scaleBar.style.width = `${(nice / pixel).toFixed(1)}px`;
    this.scaleText.textContent = nice < 0.001 ? `${+(nice * 1000).toPrecision(1)} µm` : `${+nice.toPrecision(1)} mm`;
  }
  say(labels: Label[]): void {
    while (this.labels.length > labels.length) this.labels.pop()!.remove();
    labels.forEach((l, i) => {
      let e = this.labels[i];
      if (!e) {
        e = document.createElement("div");
        e.style.cssText = "position:absolute;left:0;top:0;padding:2px 7px;border-radius:5px;white-space:pre;font-variant-numeric:tabular-nums;background:color-mix(in srgb,var(--panel,Canvas) 90%,transparent);border:1px solid var(--line,GrayText)";
        this.labels.push(e); this.root.append(e);
      }
      if (e.textContent !== l.text) e.textContent = l.text;
      e.style.fontWeight = l.strong ? "600" : "400";
      const w = this.root.clientWidth, h = this.root.clientHeight;
      const x = l.free ? l.x : Math.min(Math.max(4, l.x), Math.max(4, w - e.offsetWidth - 4)), y = l.free ? l.y : Math.min(Math.max(4, l.y), Math.max(4, h - e.offsetHeight - 4));
      e.style.transform = `translate(${Math.round(x)}px,${Math.round(y)}px)`;
      e.hidden = l.x < -50 || l.y < -50 || l.x > w + 50 || l.y > h + 50;
    });
  }
}

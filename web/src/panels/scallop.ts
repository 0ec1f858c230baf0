// SPDX-License-Identifier: Apache-2.0
// The plane across the feed: profiles that the passes sweep, the surface they leave, scallops in figures, the design.
import { Role } from "../scene";
import type { Scene } from "../scene";
import type { Store } from "../state";
import { brief, fixed, niceStep } from "../logic/format";
import { crossings, cusps, cutMesh, designAt, envelope, frameAt, normalNear, Swept, turned } from "../logic/section";
import type { Cusp, Envelope } from "../logic/section";
import { choice, el, haloed, sheet, themed, within } from "../ui";
import type { CloseUp } from "./closeup";

const MOST_PASSES = 48, COLUMNS = 600, EXAGGERATIONS = [1, 2, 5, 10, 20, 50, 100, 200, 500];
interface Cut { bodies: Swept[]; own: number; line: Float64Array; all: Envelope; ridges: Cusp[] }

/** mm with as many digits as small heights need. */
export const small = (v: number): string => !Number.isFinite(v) ? "-" : Math.abs(v) < 0.1 ? `${fixed(v * 1000, Math.abs(v) < 0.01 ? 2 : 1)} \u00b5m` : `${fixed(v, 3)} mm`;

class Section {
  half = 1; // of the width that is seen, mm
  middle = 0;
  cut: Cut | null = null;
  radius = 1;
  private bodies: Swept[] = []; private own = 0; private line: Float64Array<ArrayBufferLike> = new Float64Array(0);
  constructor(private scene: Scene) {}
  at(node: number, keep: boolean): string {
    const { scene } = this, { path } = scene, cutter = (k: number) => scene.tools[k]?.pieces.filter(p => p.kind === 0) ?? [];
    this.cut = null;
    let frame = frameAt(path, node);
    const pieces = cutter(path.tool[node]);
    if (!frame) return "Nothing is cut near this node.";
    if (pieces.length === 0) return "The tool of this node has no cutter.";
    this.radius = Math.max(...pieces.map(p => p.radius));
    const reach = 6 * this.radius, near = crossings(path, frame, reach, MOST_PASSES), body = Swept.through(node, frame.origin, axisAt(scene, node), frame.feed, pieces, frame);
    if (!body) return "The way at this node has no cross-section.";
    const meshes = scene.meshes.filter(m => m.role === Role.design), first = meshes.map(m => cutMesh(m, frame!, reach));
    for (const line of first) {
      const n = normalNear(body, line, this.radius);
      if (n) { frame = turned(frame, n[0], n[1]); break; }
    }
    body.see(frame);
    // The pass of the node itself goes through the plane as well: it is there once.
    const others = near.filter(c => Math.hypot(c.tip[0] - frame!.origin[0], c.tip[1] - frame!.origin[1], c.tip[2] - frame!.origin[2]) > 1e-4 * this.radius || Math.abs(c.node - node) > 2);
    this.bodies = [body, ...others.map(c => Swept.through(c.node, c.tip, c.axis, c.way, cutter(path.tool[c.node]), frame!)).filter((b): b is Swept => b !== null && b.pieces.length > 0)];
    this.own = 0;
    const all: number[] = [];
    for (const m of meshes) for (const v of cutMesh(m, frame, reach)) all.push(v);
    this.line = Float64Array.from(all);
    if (!keep) this.half = this.width();
    this.again();
    return "";
  }
  /** About two passes to each side, and not more than the tool. */
  private width(): number {
    const places = this.bodies.slice(1).map(b => Math.abs(b.outermost(0, -1)[0] - this.bodies[0].outermost(0, -1)[0])).filter(d => d > 1e-3 * this.radius).sort((a, b) => a - b);
    return places.length > 0 ? Math.min(2 * this.radius, Math.max(places[Math.min(3, places.length - 1)] * 1.25, places[0] * 1.5)) : 1.2 * this.radius;
  }
  again(): void {
    const centre = this.bodies[0].outermost(0, -1)[0] + this.middle, all = envelope(this.bodies, centre - this.half, centre + this.half, COLUMNS);
    this.cut = { bodies: this.bodies, own: this.own, line: this.line, all, ridges: cusps(this.bodies, all) };
  }
}
function axisAt(scene: Scene, i: number): [number, number, number] { const a = scene.path.axis; return a ? [a[3 * i], a[3 * i + 1], a[3 * i + 2]] : [0, 0, 1]; }

/** Excess of what is left over the design where both are known. */
function overDesign(c: Cut): { most: number; least: number } | null {
  let most = -Infinity, least = Infinity;
  if (c.line.length > 0) for (let i = 0; i < c.all.u.length; i += 2) {
    if (c.all.owner[i] < 0) continue;
    const d = c.all.v[i] - designAt(c.line, c.all.u[i], c.all.v[i]);
    if (Number.isFinite(d)) { most = Math.max(most, d); least = Math.min(least, d); }
  }
  return most >= least ? { most, least } : null;
}
function say(out: HTMLElement, c: Cut): void {
  const own = c.bodies[c.own], place = own.outermost(0, -1)[0], of = c.ridges.filter(r => r.left === c.own || r.right === c.own);
  const left = of.filter(r => r.right === c.own).pop(), right = of.find(r => r.left === c.own), over = overDesign(c), rows: [string, string][] = [];
  const apart = (k: number | undefined) => k === undefined ? "-" : fixed(Math.abs(c.bodies[k].outermost(0, -1)[0] - place), 3);
  rows.push(["scallop on the left, right", `${left ? small(left.height) : "-"}, ${right ? small(right.height) : "-"}`]);
  if (c.ridges.length > 0) rows.push(["highest scallop here", small(Math.max(...c.ridges.map(r => r.height)))]);
  rows.push(["next passes, left and right", `${apart(left?.left)}, ${apart(right?.right)} mm`]);
  if (over) rows.push(["left over the design", `${small(over.least)} to ${small(over.most)}`]);
  out.replaceChildren(el("table", {}, el("tbody", {}, ...rows.map(([a, b]) => el("tr", {}, el("td", {}, a), el("td", {}, b))))));
}

export function scallopView(scene: Scene, store: Store): CloseUp {
  const section = new Section(scene), out = el("div", { class: "readout" }), canvas = el("canvas", { "aria-hidden": "true" });
  const box = el("div", { class: "map", tabindex: 0, role: "img", "aria-label": "Cross-section of the passes at this node; plus and minus zoom, arrow keys move" }, canvas);
  let node = 0, why = "", exaggeration = 1, auto = false;
  const factor = () => { // so that the scallops fill a third of the height
    if (!auto || !section.cut) return exaggeration;
    const most = Math.max(0, ...section.cut.ridges.map(r => r.height));
    const want = most > 0 ? box.clientHeight / 4 / (most * box.clientWidth / (2 * section.half)) : 1;
    return EXAGGERATIONS.filter(e => e <= want).pop() ?? 1;
  };
  const drawn = sheet(canvas, ({ g, w, h }) => {
    if (!section.cut) { g.fillStyle = themed("soft"); g.textAlign = "center"; g.fillText(why, w / 2, h / 2); return; }
    paint(g, w, h, section.cut, section.half, factor());
  });
  const again = () => { if (section.cut) { section.again(); say(out, section.cut); } drawn.again(); };
  box.style.cssText = "touch-action:none;cursor:grab";
  const zoom = (f: number) => { section.half = Math.min(6 * section.radius, Math.max(section.radius * 1e-3, section.half * f)); again(); };
  const move = (d: number) => { section.middle = Math.min(5 * section.radius, Math.max(-5 * section.radius, section.middle + d)); again(); };
  box.addEventListener("wheel", e => { e.preventDefault(); zoom(Math.exp(Math.min(300, Math.max(-300, e.deltaY)) * 0.0015)); }, { passive: false });
  let held: number | null = null;
  box.addEventListener("pointerdown", e => { held = within(e, box).x; box.setPointerCapture(e.pointerId); });
  box.addEventListener("pointermove", e => { if (held !== null) { const x = within(e, box).x; move((held - x) / box.clientWidth * 2 * section.half); held = x; } });
  for (const end of ["pointerup", "pointercancel"]) box.addEventListener(end, () => { held = null; });
  box.addEventListener("dblclick", () => { section.middle = 0; section.at(node, false); again(); });
  box.addEventListener("keydown", e => {
    const act: Record<string, () => void> = { "+": () => zoom(0.8), "=": () => zoom(0.8), "-": () => zoom(1.25), ArrowLeft: () => move(-section.half / 10), ArrowRight: () => move(section.half / 10) };
    if (!act[e.key] || e.ctrlKey || e.metaKey || e.altKey || e.shiftKey) return;
    e.preventDefault(); e.stopPropagation(); act[e.key]();
  });
  store.on(["theme"], drawn.again);
  const heights = choice("Heights", [["1", "true scale"], ["auto", "heights to fit"], ...EXAGGERATIONS.slice(1).map((e): [string, string] => [String(e), `heights ${e}\u00d7`])], "1", v => { auto = v === "auto"; exaggeration = auto ? 1 : Number(v); drawn.again(); });
  const keys = el("div", { class: "keys" }, ...[["", "var(--hit)", "this pass"], ["", "var(--soft)", "other passes"], ["", "var(--accent)", "left by them"], ["dash", "var(--good)", "design"]].map(([cls, colour, text]) => { const i = el("i", { class: cls }); i.style.color = colour; return el("span", { class: "item" }, i, text); }));
  return {
    box: el("div", { class: "column" }, el("div", { class: "filters" }, el("span", { class: "soft" }, "across the feed"), heights), box, keys, out),
    show(n) {
      node = n; why = section.at(n, section.cut !== null && Math.abs(section.middle) > 0);
      if (section.cut) say(out, section.cut); else out.replaceChildren();
      drawn.again();
    },
  };
}

function paint(g: CanvasRenderingContext2D, w: number, h: number, c: Cut, half: number, ex: number): void {
  const k = w / (2 * half), first = c.all.u[0], e = c.all, base = c.bodies[c.own].outermost(0, -1)[1];
  const x = (u: number) => (u - first) * k, y = (v: number) => h * 0.66 - (v - base) * k * ex, soft = themed("soft"), ink = themed("ink");
  // Material below what is left.
  g.beginPath(); g.moveTo(0, h);
  for (let i = 0; i < e.u.length; ++i) g.lineTo(x(e.u[i]), e.owner[i] < 0 ? -10 : Math.max(-10, Math.min(h, y(e.v[i]))));
  g.lineTo(w, h); g.closePath(); g.fillStyle = themed("part"); g.globalAlpha = 0.35; g.fill(); g.globalAlpha = 1;
  // Tools: each outline, this one's last.
  c.bodies.map((b, i) => ({ b, own: i === c.own })).reverse().forEach(({ b, own: mine }) => {
    const rim = b.outline(ex > 1 ? 720 : 240);
    g.beginPath(); rim.forEach(([u, v], i) => i ? g.lineTo(x(u), y(v)) : g.moveTo(x(u), y(v))); g.closePath();
    if (mine) { g.fillStyle = themed("hit"); g.globalAlpha = 0.07; g.fill(); g.globalAlpha = 1; }
    g.strokeStyle = themed(mine ? "hit" : "soft"); g.lineWidth = mine ? 1.6 : 0.8; g.globalAlpha = mine ? 1 : 0.65; g.stroke(); g.globalAlpha = 1;
    const [pu, pv] = b.place(), [au, av] = b.axisSeen();
    if (mine) { const l = 3 * half; g.setLineDash([9, 3, 2, 3]); g.lineWidth = 1; g.beginPath(); g.moveTo(x(pu), y(pv)); g.lineTo(x(pu + au * l), y(pv + av * l)); g.stroke(); g.setLineDash([]); }
  });
  // Design.
  g.strokeStyle = themed("good"); g.lineWidth = 1.5; g.setLineDash([6, 3]); g.beginPath();
  for (let i = 0; i < c.line.length; i += 4) { g.moveTo(x(c.line[i]), y(c.line[i + 1])); g.lineTo(x(c.line[i + 2]), y(c.line[i + 3])); }
  g.stroke(); g.setLineDash([]);
  // What is left.
  g.strokeStyle = themed("accent"); g.lineWidth = 2; g.beginPath();
  for (let i = 0, pen = false; i < e.u.length; ++i) { if (e.owner[i] < 0) { pen = false; continue; } if (pen) g.lineTo(x(e.u[i]), y(e.v[i])); else g.moveTo(x(e.u[i]), y(e.v[i])); pen = true; }
  g.stroke();
  g.textAlign = "center";
  let last = -Infinity;
  for (const r of c.ridges) {
    const px = x(r.u), py = y(r.v);
    g.fillStyle = themed("accent"); g.beginPath(); g.arc(px, py, 2.6, 0, 7); g.fill();
    if (px - last > 62 && py > 24) { haloed(g, small(r.height), Math.min(w - 28, Math.max(28, px)), py - 14, ink, themed("panel")); last = px; }
  }
  scales(g, w, h, k, ex, soft);
}
/** A bar across, and when heights are drawn larger one upright. */
function scales(g: CanvasRenderingContext2D, w: number, h: number, k: number, ex: number, colour: string): void {
  g.strokeStyle = g.fillStyle = colour; g.lineWidth = 1.2;
  const mm = niceStep(60 / k), px = mm * k, x0 = w - 14 - px, y0 = h - 12;
  g.beginPath(); g.moveTo(x0, y0 - 4); g.lineTo(x0, y0); g.lineTo(x0 + px, y0); g.lineTo(x0 + px, y0 - 4); g.stroke();
  const text = mm < 0.01 ? `${brief(mm * 1000)} \u00b5m` : `${brief(mm)} mm`;
  haloed(g, text, x0 + px / 2, y0 - 9, colour, themed("panel"));
  if (ex === 1) return;
  const tall = niceStep(30 / (k * ex)), py = tall * k * ex, label = tall < 0.01 ? `${brief(tall * 1000)} \u00b5m` : `${brief(tall)} mm`;
  g.strokeStyle = colour; g.lineWidth = 1.2;
  g.beginPath(); g.moveTo(18, y0 - py); g.lineTo(14, y0 - py); g.lineTo(14, y0); g.lineTo(18, y0); g.stroke();
  g.textAlign = "left"; haloed(g, `${label}  (${ex}\u00d7)`, 22, y0 - py / 2, colour, themed("panel"));
}

// SPDX-License-Identifier: Apache-2.0
// The beam about a node: its path, what it takes away, the edge of the part, and how far the two are apart.
import type { Scene } from "../scene";
import type { Store } from "../state";
import { brief, fixed, niceStep } from "../logic/format";
import { beamLines, beamPlane, flatOutline, joined, nearestOn } from "../logic/kerf";
import { dot, feedAt } from "../logic/section";
import { el, haloed, sheet, themed, within } from "../ui";
import type { CloseUp } from "./closeup";
import { small } from "./scallop";

/** Less than this is the rounding of coordinates, mm. */
const NOTHING = 1e-3;
interface Cut { kerf: number; beams: { points: number[] }[]; parts: { points: Float64Array; closed: boolean }[]; others: { points: Float64Array; closed: boolean }[]; near: { x: number; y: number; distance: number } | null; way: [number, number] }

export function kerfView(scene: Scene, store: Store): CloseUp {
  const { path } = scene, canvas = el("canvas", { "aria-hidden": "true" }), out = el("div", { class: "readout" });
  const box = el("div", { class: "map", tabindex: 0, role: "img", "aria-label": "Cut of the beam about this node; plus and minus zoom" }, canvas);
  let cut: Cut | null = null, half = 0, node = 0;
  const all = { true: joined(scene.outlines.filter(o => o.part)), false: joined(scene.outlines.filter(o => !o.part)) };
  const make = () => {
    const tool = scene.tools[path.tool[node]], kerf = tool?.kerf || Math.max(0, ...scene.tools.map(t => t.kerf)), plane = beamPlane(path, node), reach = Math.max(2.2 * half, 5 * kerf);
    const curves = (part: boolean) => all[`${part}`].map(o => ({ points: flatOutline(o, plane, reach), closed: o.closed })).filter((o): o is { points: Float64Array; closed: boolean } => o.points !== null);
    const parts = curves(true);
    cut = { kerf, beams: beamLines(path, plane, reach), parts, others: curves(false), near: nearestOn(parts, 0, 0), way: [1, 0] };
    const feed = feedAt(path, node), fx = feed ? dot(feed, plane.x) : 1, fy = feed ? dot(feed, plane.y) : 0, l = Math.hypot(fx, fy);
    if (l > 1e-9) cut.way = [fx / l, fy / l];
    const rows: [string, string][] = [["kerf", `${fixed(kerf, 3)} mm`]];
    if (cut.near && cut.near.distance < 5 * kerf) {
      const d = cut.near.distance - kerf / 2;
      rows.push(["beam to the edge of the part", `${fixed(cut.near.distance, 4)} mm`], ["less half the kerf", `${d >= 0 ? "+" : ""}${small(d)} ${Math.abs(d) < NOTHING || d > kerf / 2 ? "" : d > 0 ? "(left standing)" : "(cut into the part)"}`]);
    } else rows.push(["beam to the edge of the part", "far away"]);
    out.replaceChildren(el("table", {}, el("tbody", {}, ...rows.map(([a, b]) => el("tr", {}, el("td", {}, a), el("td", {}, b))))));
  };
  const drawn = sheet(canvas, ({ g, w, h }) => { if (cut) paint(g, w, h, cut, half); });
  const zoom = (f: number) => { half = Math.min(200, Math.max(0.01, half * f)); make(); drawn.again(); };
  box.style.cssText = "touch-action:none";
  box.addEventListener("wheel", e => { e.preventDefault(); zoom(Math.exp(Math.min(300, Math.max(-300, e.deltaY)) * 0.0015)); }, { passive: false });
  let held: number | null = null; // a drag up and down zooms: fingers have no wheel
  box.addEventListener("pointerdown", e => { held = within(e, box).y; box.setPointerCapture(e.pointerId); });
  box.addEventListener("pointermove", e => { if (held !== null) { const y = within(e, box).y; zoom(Math.exp((y - held) * 0.006)); held = y; } });
  for (const end of ["pointerup", "pointercancel"]) box.addEventListener(end, () => { held = null; });
  box.addEventListener("keydown", e => {
    const f = e.key === "+" || e.key === "=" ? 0.8 : e.key === "-" ? 1.25 : 0;
    if (f && !e.ctrlKey && !e.metaKey && !e.altKey) { e.preventDefault(); e.stopPropagation(); zoom(f); }
  });
  store.on(["theme"], drawn.again);
  const keys = el("div", { class: "keys" }, ...[["", "var(--hit)", "beam centre"], ["cell", "color-mix(in srgb, var(--warn) 45%, var(--panel))", "taken away"], ["", "var(--accent)", "edge of the part"], ["cell", "var(--hatch)", "part"]].map(([cls, colour, text]) => { const i = el("i", { class: cls }); i.style.color = colour; return el("span", { class: "item" }, i, text); }));
  return {
    box: el("div", { class: "column" }, box, keys, out),
    show(n) { node = n; if (half === 0) half = 3 * Math.max(0.05, ...scene.tools.map(t => t.kerf)); make(); drawn.again(); },
  };
}

function trace(g: CanvasRenderingContext2D, points: ArrayLike<number>, closed: boolean, k: number, cx: number, cy: number): void {
  for (let i = 0; i + 1 < points.length; i += 2) if (i === 0) g.moveTo(cx + points[0] * k, cy - points[1] * k); else g.lineTo(cx + points[i] * k, cy - points[i + 1] * k);
  if (closed) g.closePath();
}
function hatch(g: CanvasRenderingContext2D, w: number, h: number, colour: string): void {
  g.strokeStyle = colour; g.lineWidth = 0.8; g.beginPath();
  for (let d = -h; d < w; d += 9) { g.moveTo(d, h); g.lineTo(d + h, 0); }
  g.stroke();
}
function paint(g: CanvasRenderingContext2D, w: number, h: number, c: Cut, half: number): void {
  const k = Math.min(w, h) / (2 * half), cx = w / 2, cy = h / 2, ink = themed("ink"), ground = themed("panel");
  // The part's side.
  g.save(); g.beginPath();
  for (const o of c.parts) if (o.closed) trace(g, o.points, true, k, cx, cy);
  g.fillStyle = themed("part"); g.globalAlpha = 0.25; g.fill("evenodd"); g.globalAlpha = 1; g.clip("evenodd"); hatch(g, w, h, themed("hatch")); g.restore();
  // What the beam takes: a round spot drawn along its path.
  g.lineCap = "round"; g.strokeStyle = themed("warn"); g.lineWidth = c.kerf * k; g.globalAlpha = 0.35; g.beginPath();
  for (const b of c.beams) trace(g, b.points, false, k, cx, cy);
  g.stroke(); g.globalAlpha = 1; g.lineCap = "butt";
  g.strokeStyle = themed("soft"); g.lineWidth = 1;
  for (const o of c.others) { g.beginPath(); trace(g, o.points, o.closed, k, cx, cy); g.stroke(); }
  g.strokeStyle = themed("accent"); g.lineWidth = 2; g.beginPath();
  for (const o of c.parts) trace(g, o.points, o.closed, k, cx, cy);
  g.stroke();
  g.strokeStyle = themed("hit"); g.lineWidth = 1.3; g.setLineDash([8, 3, 2, 3]); g.beginPath();
  for (const b of c.beams) trace(g, b.points, false, k, cx, cy);
  g.stroke(); g.setLineDash([]);
  g.beginPath(); g.arc(cx, cy, c.kerf / 2 * k, 0, 7); g.lineWidth = 1.6; g.stroke();
  g.fillStyle = themed("hit"); g.beginPath(); g.arc(cx, cy, 3, 0, 7); g.fill();
  // Dimensions: to the edge, and the kerf on the other side.
  g.strokeStyle = ink; g.lineWidth = 1; g.textAlign = "center";
  const n = c.near && c.near.distance > 1e-9 ? c.near : null, r = c.kerf / 2 * k, [wx, wy] = c.way, bx = cx - wx * 1.6 * r, by = cy + wy * 1.6 * r;
  if (n && n.distance < 1.5 * half) dimension(g, cx, cy, cx + n.x * k, cy - n.y * k, `${fixed(n.distance, 4)} mm`, -14, ink, ground);
  dimension(g, bx + wy * r, by + wx * r, bx - wy * r, by - wx * r, `kerf ${brief(c.kerf)} mm`, -14, ink, ground);
  const mm = niceStep(60 / k), x0 = w - 14 - mm * k, y0 = h - 12;
  g.strokeStyle = themed("soft"); g.lineWidth = 1.2;
  g.beginPath(); g.moveTo(x0, y0 - 4); g.lineTo(x0, y0); g.lineTo(x0 + mm * k, y0); g.lineTo(x0 + mm * k, y0 - 4); g.stroke();
  haloed(g, `${brief(mm)} mm`, x0 + mm * k / 2, y0 - 9, themed("soft"), ground);
}
/** A line with arrows and its figure beside it. */
function dimension(g: CanvasRenderingContext2D, x1: number, y1: number, x2: number, y2: number, text: string, off: number, colour: string, ground: string): void {
  const l = Math.hypot(x2 - x1, y2 - y1);
  if (l < 6) return;
  const ux = (x2 - x1) / l, uy = (y2 - y1) / l;
  g.strokeStyle = colour; g.lineWidth = 1; g.beginPath(); g.moveTo(x1, y1); g.lineTo(x2, y2);
  for (const [x, y, s] of [[x1, y1, 1], [x2, y2, -1]]) { g.moveTo(x + s * (7 * ux - 3 * uy), y + s * (7 * uy + 3 * ux)); g.lineTo(x, y); g.lineTo(x + s * (7 * ux + 3 * uy), y + s * (7 * uy - 3 * ux)); }
  g.stroke();
  // Beside the middle, as far away as the text is wide in that direction.
  const far = Math.sign(off) * (Math.abs(uy) * g.measureText(text).width / 2 + Math.abs(ux) * 7 + 5);
  haloed(g, text, (x1 + x2) / 2 - uy * far, (y1 + y2) / 2 + ux * far, colour, ground);
}

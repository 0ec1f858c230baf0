// SPDX-License-Identifier: Apache-2.0
// The cursor's questions to the scene, in the part's frame whatever the table does.
import { Matrix4, Vector3 } from "three";
import { Kind, type Mesh } from "../scene";
import type { Context } from "./context";
import type { Findings } from "./marks";
import type { Part } from "./part";
import { waysDone } from "./path";
import { type Hit, type Ray, type Screen, Surface, type WayHit, Ways } from "./pick";
import type { StockView } from "./stock";
import type { View } from "./view";

const SNAP = 7; // to a vertex, when measuring
/** How far behind a surface, of the depth's range, a way still counts as seen: cuts lie on their surface. */
const BEHIND = 0.004;

export class Picker {
  private ways: Ways | null = null;
  private surfaces = new Map<Mesh, Surface>();
  milliseconds = 0;
  reach = 1; // CSS pixels about the cursor
  constructor(private ctx: Context, private part: Part, private stock: StockView, private findings: Findings) {}

  /** Makes the trees before they are asked for, one after the other when there is time. */
  prepare(): void {
    const work: (() => void)[] = [() => { this.ways ??= new Ways(this.ctx.scene.path); }, ...this.part.solid().map(mesh => () => { this.of(mesh); })];
    const idle = (call: () => void): void => { if ("requestIdleCallback" in window) requestIdleCallback(call, { timeout: 2000 }); else setTimeout(call, 200); };
    const next = (): void => { work.shift()?.(); if (work.length > 0) idle(next); };
    idle(next);
  }
  private of(mesh: Mesh): Surface {
    let s = this.surfaces.get(mesh);
    if (!s) { s = new Surface(mesh); this.surfaces.set(mesh, s); }
    return s;
  }
  private screen(view: View, table: Matrix4, box: HTMLElement): Screen {
    return { matrix: view.viewProjection().multiply(table), width: box.clientWidth, height: box.clientHeight };
  }
  ray(view: View, table: Matrix4, box: HTMLElement, x: number, y: number): Ray {
    const { clientWidth: width, clientHeight: height } = box, back = view.viewProjection().multiply(table).invert();
    const a = new Vector3(2 * x / width - 1, 1 - 2 * y / height, -1).applyMatrix4(back), b = new Vector3(2 * x / width - 1, 1 - 2 * y / height, 1).applyMatrix4(back);
    return { from: a, direction: b.sub(a).normalize() };
  }

  private kept = (p: Vector3): boolean => {
    const { clip, clipOn } = this.ctx.shared;
    return clipOn.value < 0.5 || clip.value.x * p.x + clip.value.y * p.y + clip.value.z * p.z <= clip.value.w;
  };
  /** First point of part, obstacles or stock on the ray. */
  surface(ray: Ray): Hit | null {
    let best = this.stock.hit(ray, Infinity, this.kept);
    for (const mesh of this.part.solid()) {
      const h = this.of(mesh).hit(ray, best?.distance ?? Infinity, this.kept);
      if (h) best = h;
    }
    return best;
  }
  /** Way under the cursor that can be seen. */
  way(view: View, table: Matrix4, box: HTMLElement, x: number, y: number): WayHit | null {
    const begin = performance.now(), { scene: { path }, store: { state } } = this.ctx, { show, only } = state;
    if (!show.path || path.count < 2) return null;
    this.ways ??= new Ways(path);
    const screen = this.screen(view, table, box), now = waysDone(this.ctx);
    const hit = this.surface(this.ray(view, table, box, x, y)), wall = hit ? hit.point.applyMatrix4(screen.matrix).z + BEHIND : Infinity;
    const found = this.ways.nearest(screen, x, y, this.reach, (node, depth, p) =>
      (show.rapids || path.kind[node] !== Kind.rapid) && (only === null || path.group[node] === only) && (show.ahead || node - 1 < now) && depth <= wall && this.kept(p));
    this.milliseconds = performance.now() - begin;
    return found;
  }
  finding(view: View, table: Matrix4, box: HTMLElement, x: number, y: number): { index: number } | null {
    const { matrix, width, height } = this.screen(view, table, box);
    let best: { index: number } | null = null, least = this.reach;
    for (const f of this.findings.at) {
      const p = f.place.clone().applyMatrix4(matrix), d = Math.hypot((p.x + 1) / 2 * width - x, (1 - p.y) / 2 * height - y);
      if (d < least) { least = d; best = f; }
    }
    return best;
  }
  /** A vertex of an outline or of the path that is near, else the surface, else the nearest place on a way. Stage coordinates of the part. */
  measure(view: View, table: Matrix4, box: HTMLElement, x: number, y: number): Vector3 | null {
    const { scene } = this.ctx, { matrix, width, height } = this.screen(view, table, box), p = new Vector3();
    const off = (q: Vector3): number => { p.copy(q).applyMatrix4(matrix); return Math.hypot((p.x + 1) / 2 * width - x, (1 - p.y) / 2 * height - y); };
    const q = new Vector3();
    let best: Vector3 | null = null, least = SNAP;
    for (const o of scene.outlines) for (let i = 0; i < o.point.length; i += 3) { const d = off(q.fromArray(o.point, i)); if (d < least) { least = d; best = q.clone(); } }
    if (best) return best;
    const way = this.way(view, table, box, x, y), hit = this.surface(this.ray(view, table, box, x, y));
    if (way) {
      for (const node of [way.node - 1, way.node]) { const d = off(q.fromArray(scene.path.point, 3 * node)); if (d < least) { least = d; best = q.clone(); } }
      if (best || !hit) return best ?? way.point;
    }
    return hit?.point ?? null;
  }
}

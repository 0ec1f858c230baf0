// SPDX-License-Identifier: Apache-2.0
// The stock while it is cut: bricks of surface, remeshed in a worker where the time changed them; one wish under way at a time,
// so that scrubbing is as fine as the machine is fast.
import { BufferAttribute, BufferGeometry, Color, Group, Mesh as Object, type ShaderMaterial, type Vector3 } from "three";
import { Role, type Mesh, type Path, type StockClock, type Vec } from "../scene";
import { Cap } from "./cap";
import type { Context } from "./context";
import { surfaceMaterial } from "./materials";
import { waysDone } from "./path";
import { type Hit, type Ray, Surface } from "./pick";
import { poseAt } from "./pose";
import { type BrickMesh, type Cutter, StockMesher, type StockWish } from "./stock_mesh";
import StockWorker from "./stock_worker?worker&inline";

const MOST_POSES = 48; // of the move being cut

/** What of the program is done after `ways`; of the move under way the poses so far. */
export function stockWish(path: Path, ways: number, step: number, cutter: Cutter[]): StockWish {
  const none = new Float32Array(0), last = path.count - 1;
  if (last < 0) return { limit: 0, poses: none, cutter };
  const i = Math.min(last, Math.floor(ways)), f = ways - i, j = Math.min(last, i + 1);
  if (i === last || (f === 0 && path.move[j] !== path.move[i])) return { limit: path.move[i]! + 1, poses: none, cutter };
  const move = path.move[j]!;
  let from = j;
  while (from > 0 && path.move[from - 1] === move) --from;
  const begin = Math.max(0, from - 1);
  let length = 0;
  const p = path.point;
  for (let k = begin; k < j; ++k) length += Math.hypot(p[3 * k + 3]! - p[3 * k]!, p[3 * k + 4]! - p[3 * k + 1]!, p[3 * k + 5]! - p[3 * k + 2]!);
  const n = Math.max(2, Math.min(MOST_POSES, Math.ceil(length / step) + 1)), poses = new Float32Array(6 * n);
  for (let q = 0; q < n; ++q) {
    const pose = poseAt(path, begin + (ways - begin) * q / (n - 1));
    poses.set([pose.tip.x, pose.tip.y, pose.tip.z, pose.axis.x, pose.axis.y, pose.axis.z], 6 * q);
  }
  return { limit: move, poses, cutter };
}

export class StockView {
  readonly group = new Group();
  private worker: Worker | null = null;
  private mesher: StockMesher | null = null;
  private busy = false;
  private asked = "";
  private material: ShaderMaterial;
  private cap: Cap;
  private bricks = new Map<number, { object: Object; passes: Object[]; surface: Surface | null }>();
  private started = 0;
  milliseconds = 0; // of the last answer
  constructor(private ctx: Context) {
    this.material = surfaceMaterial(ctx, { colour: new Color(), tinted: true, nearer: 0.5, shine: 0.1 });
    this.cap = new Cap(ctx, 90, this.material.uniforms["colour"]!.value as Color, -1);
    this.group.add(this.cap.face);
    this.recolour();
    this.update();
  }
  get waiting(): boolean { return this.busy; }
  get triangles(): number { let n = 0; for (const b of this.bricks.values()) n += (b.object.geometry.index?.count ?? 0) / 3; return n; }

  /** About the stage's origin. */
  private clock(): StockClock {
    const { stock, center } = this.ctx.scene;
    return { ...stock!, origin: stock!.origin.map((v, c) => v - center[c]!) as Vec };
  }
  private start(): void {
    const clock = this.clock();
    try {
      this.worker = new StockWorker();
      this.worker.onmessage = (e: MessageEvent<BrickMesh[]>) => this.answered(e.data);
      this.worker.onerror = e => { e.preventDefault(); this.worker?.terminate(); this.worker = null; this.here(); };
      this.worker.postMessage({ clock });
    } catch { this.here(); }
  }
  /** Without workers: on the page's own thread. */
  private here(): void {
    this.worker = null;
    this.mesher = new StockMesher(this.clock());
    this.busy = false; this.asked = "";
    this.ctx.invalidate();
  }
  update(): void {
    const { scene, store } = this.ctx, clock = scene.stock;
    this.group.visible = store.state.show.stock && clock !== null;
    if (!clock || !this.group.visible || this.busy) return;
    if (!this.worker && !this.mesher) this.start();
    const ways = waysDone(this.ctx), tool = scene.tools[scene.path.tool[Math.min(scene.path.count - 1, Math.ceil(ways))] ?? 0];
    const cutter = tool?.pieces.filter(p => p.kind === 0).map(({ radius, low, high, corner }) => ({ radius, low, high, corner })) ?? [];
    const wish = stockWish(scene.path, ways, clock.step, cutter), key = `${wish.limit} ${wish.poses.length > 0 ? ways : ""}`;
    if (key === this.asked) return;
    this.asked = key; this.busy = true; this.started = performance.now();
    if (this.worker) this.worker.postMessage({ wish });
    else if (this.mesher) { this.mesher.set(wish); this.answered(this.mesher.changed()); }
  }
  private answered(bricks: BrickMesh[]): void {
    for (const b of bricks) this.put(b);
    this.milliseconds = performance.now() - this.started;
    this.busy = false;
    this.ctx.invalidate(); // the frame asks for what the time has become meanwhile
  }
  private put(b: BrickMesh): void {
    const old = this.bricks.get(b.brick);
    if (old) { this.group.remove(old.object, ...old.passes); old.object.geometry.dispose(); this.bricks.delete(b.brick); }
    if (b.index.length === 0) return;
    const g = new BufferGeometry();
    g.setAttribute("position", new BufferAttribute(b.position, 3));
    g.setAttribute("normal", new BufferAttribute(b.normal, 3));
    g.setAttribute("tint", new BufferAttribute(b.tint, 1));
    g.setIndex(new BufferAttribute(b.index, 1));
    const object = new Object(g, this.material);
    const passes = this.cap.passes(g);
    this.group.add(object, ...passes);
    this.bricks.set(b.brick, { object, passes, surface: null });
    this.cap.update(true);
  }
  section(): void { this.cap.update(true); }
  recolour(): void {
    const { dark } = this.ctx.theme;
    (this.material.uniforms["colour"]!.value as Color).set(dark ? "#6f6a5c" : "#bdb193");
    (this.material.uniforms["cutColour"]!.value as Color).set(dark ? "#a9b3c0" : "#d7dde4");
  }
  hit(ray: Ray, limit: number, seen: (p: Vector3) => boolean): Hit | null {
    if (!this.group.visible) return null;
    let best: Hit | null = null;
    for (const b of this.bricks.values()) {
      const g = b.object.geometry;
      b.surface ??= new Surface({ name: "", role: Role.stock, point: g.getAttribute("position").array as Float32Array, index: g.index!.array as Uint32Array,
        value: null, valueName: "", valueUnit: "", valueRange: 0, triangles: 0, of: 0 } satisfies Mesh);
      const h = b.surface.hit(ray, best?.distance ?? limit, seen);
      if (h) best = h;
    }
    return best;
  }
}

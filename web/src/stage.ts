// SPDX-License-Identifier: Apache-2.0
// What stands in the middle of the page: part, path, tool, stock and marks, drawn when something changed and not else.
import { Box3, ColorManagement, Group, LinearSRGBColorSpace, Matrix4, Scene as Root, Vector3, WebGLRenderer } from "three";
import { isDark } from "./colours";
import { Kind, Role, type Scene, type Vec } from "./scene";
import { type Context, fillRamp, makeShared, readTheme, toPart, toStage } from "./stage/context";
import { listen } from "./stage/input";
import { Findings, Ground, Measured, TableAxes } from "./stage/marks";
import { Outlines } from "./stage/outlines";
import { type Label, Overlay } from "./stage/overlay";
import { Part } from "./stage/part";
import { PathLines, waysDone } from "./stage/path";
import { Picker } from "./stage/picker";
import { rotaryAt, tableMatrix } from "./stage/pose";
import { StockView } from "./stage/stock";
import { ToolView } from "./stage/tool";
import { View } from "./stage/view";
import type { State, Store } from "./state";

export interface Stats { frames: number; frameMs: number; pickMs: number; stockMs: number; stockTriangles: number; waiting: boolean; segments: number; triangles: number; webgl: boolean }

/** Ways in sight that are drawn with a width, by a graphics card and without one. */
const RIBBONS = 400_000, RIBBONS_SOFTWARE = 12_000;
const LARGE = 60_000; // nodes and triangles

function software(gl: WebGL2RenderingContext | null): boolean {
  const info = gl?.getExtension("WEBGL_debug_renderer_info");
  return !!gl && !!info && /swiftshader|llvmpipe|software|basic render/i.test(String(gl.getParameter(info.UNMASKED_RENDERER_WEBGL)));
}
const CURSOR = 9, FINGER = 20; // CSS pixels about them that count as under them

/** What is looked at: bodies and cuts; rapids only when there is nothing else. */
function shownBox(scene: Scene): Box3 {
  const box = new Box3(), p = new Vector3(), { path } = scene;
  const add = (points: Float32Array): void => { for (let i = 0; i < points.length; i += 3) box.expandByPoint(p.fromArray(points, i)); };
  for (const m of scene.meshes) if (m.role !== Role.obstacle) add(m.point);
  for (const o of scene.outlines) add(o.point);
  for (let i = 1; i < path.count; ++i) if (path.kind[i] === Kind.feed) box.expandByPoint(p.fromArray(path.point, 3 * i));
  if (scene.stock && scene.meshes.length === 0) {
    const { origin, count, step } = scene.stock;
    box.expandByPoint(p.set(...toStage(origin, scene.center))).expandByPoint(p.set(...toStage([0, 1, 2].map(c => origin[c]! + step * (count[c]! - 1)) as Vec, scene.center)));
  }
  if (box.isEmpty()) add(path.point);
  if (box.isEmpty()) box.set(new Vector3(...toStage(scene.box.lo, scene.center)), new Vector3(...toStage(scene.box.hi, scene.center)));
  return box;
}

export class Stage {
  private ctx: Context;
  private renderer: WebGLRenderer | null = null;
  private root = new Root();
  private partFrame = new Group(); // turned by the table
  private shown!: Box3; // in the part's frame
  private view!: View;
  private overlay!: Overlay;
  private part!: Part;
  private path!: PathLines;
  private outlines!: Outlines;
  private tool!: ToolView;
  private stock!: StockView;
  private findings!: Findings;
  private measured!: Measured;
  private axes!: TableAxes;
  private ground!: Ground;
  private picker!: Picker;
  private ribbons = RIBBONS;
  private asked = false;
  private last = 0;
  private frames = 0;
  private frameMs = 0;
  private pointer: { x: number; y: number } | null = null;
  private hoverAsked = false;

  constructor(readonly box: HTMLElement, readonly scene: Scene, readonly store: Store) {
    ColorManagement.enabled = false; // colours are meant as CSS has them
    this.ctx = { scene, store, theme: readTheme(box, isDark(store.state)), shared: makeShared(), invalidate: () => this.invalidate() };
    if (getComputedStyle(box).position === "static") box.style.position = "relative";
    const canvas = document.createElement("canvas");
    canvas.style.cssText = "position:absolute;inset:0;width:100%;height:100%;touch-action:none;display:block";
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", "Part and tool path. Shift and arrows turn, Alt and arrows move, + and - zoom.");
    // Without a graphics card much is drawn slowly: a large scene then goes without smooth edges.
    const amount = scene.path.count + scene.meshes.reduce((n, m) => n + m.index.length / 3, 0), slow = amount > LARGE && software(document.createElement("canvas").getContext("webgl2"));
    const gl = canvas.getContext("webgl2", { antialias: !slow, alpha: false, stencil: true, powerPreference: "high-performance" });
    if (!gl) { this.withoutGraphics(); return; }
    box.append(canvas);
    this.renderer = new WebGLRenderer({ canvas, context: gl });
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.ribbons = software(gl) ? RIBBONS_SOFTWARE : RIBBONS;
    this.fill();
    this.connect(canvas);
  }
  private withoutGraphics(): void {
    const p = document.createElement("p");
    p.setAttribute("role", "alert");
    p.style.cssText = "position:absolute;inset:0;display:grid;place-content:center;text-align:center;padding:2em;margin:0";
    p.textContent = "This browser has no WebGL 2, so that part and path cannot be drawn (a browser with hardware acceleration switched on). Lists, charts and listing work.";
    this.box.append(p);
  }

  private fill(): void {
    const { scene, ctx } = this, shown = shownBox(scene), flat = scene.tools.some(t => t.kerf > 0) && !scene.meshes.some(m => m.role === Role.design);
    const size = shown.getSize(new Vector3()).length() || 1;
    // Nothing is cut off: the path with its rapids, and room for the tool above it and for the turned table.
    const all = shown.clone().expandByPoint(new Vector3(...toStage(scene.box.lo, scene.center))).expandByPoint(new Vector3(...toStage(scene.box.hi, scene.center)));
    const tool = Math.max(0, ...scene.tools.flatMap(t => t.pieces.map(p => p.high)));
    all.expandByScalar(tool + (scene.machine?.axes.some(a => a.table) ? 1.5 * size : 0.2 * size));
    this.shown = shown;
    this.view = new View(all, shown, flat);
    this.overlay = new Overlay(this.box);
    this.part = new Part(ctx);
    this.path = new PathLines(ctx, shown.getSize(new Vector3()));
    this.outlines = new Outlines(ctx);
    this.tool = new ToolView(ctx, size);
    this.stock = new StockView(ctx);
    this.findings = new Findings(ctx);
    this.measured = new Measured(ctx);
    this.axes = new TableAxes(ctx, size);
    this.ground = new Ground(ctx, shown, flat);
    this.picker = new Picker(ctx, this.part, this.stock, this.findings);
    this.partFrame.matrixAutoUpdate = false;
    this.partFrame.add(this.part.group, this.path.group, this.outlines.group, this.tool.group, this.stock.group, this.findings.group, this.measured.group);
    this.root.add(this.ground.mesh, this.axes.group, this.partFrame);
    this.recolour();
    this.turnTable();
    this.section();
    this.view.setPerspective(this.store.state.perspective);
    this.resize();
    this.view.named(flat ? "top" : "iso");
    this.view.jump();
  }

  private connect(canvas: HTMLCanvasElement): void {
    const { store, view } = this, on = (keys: (keyof State)[], call: (s: Readonly<State>) => void): void => store.on(keys, s => { call(s); this.invalidate(); });
    on(["time", "node", "playing", "show", "trial"], () => { this.path.update(); this.tool.update(); this.turnTable(); });
    on(["show"], () => { this.part.update(); this.outlines.update(); });
    on(["colour", "range", "only"], () => this.path.recolour());
    on(["heat", "heatRange"], () => { this.part.update(); this.outlines.update(); });
    on(["hovered", "picked"], () => this.path.highlight());
    on(["asMachine"], () => { this.turnTable(); view.shown = this.shown.clone().applyMatrix4(this.partFrame.matrix); view.fit(); });
    on(["section"], () => this.section());
    on(["measuring"], s => { canvas.style.cursor = s.measuring ? "crosshair" : ""; });
    on(["measured"], () => this.measured.update());
    on(["perspective"], s => view.setPerspective(s.perspective));
    on(["view"], s => { if (s.view) { if (s.view.name === "tool") view.look(this.tool.pose.axis.clone().transformDirection(this.partFrame.matrix)); else view.named(s.view.name); } });
    on(["lookAt"], s => { if (s.lookAt) view.moveTo(new Vector3(...toStage(s.lookAt.at, this.scene.center)).applyMatrix4(this.partFrame.matrix), s.lookAt.span); });
    on(["theme"], () => this.recolour());
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { this.recolour(); this.invalidate(); });
    listen(canvas, view, {
      click: (x, y, touch) => { this.picker.reach = touch ? FINGER : CURSOR; this.click(x, y); },
      hover: (x, y) => { this.picker.reach = CURSOR; this.pointer = { x, y }; this.askHover(); },
      leave: () => { this.pointer = null; store.set({ hovered: null }); canvas.title = ""; },
      orbitFrom: (x, y) => { const hit = this.picker.surface(this.picker.ray(view, this.partFrame.matrix, this.box, x, y)); if (hit) view.turnAbout(hit.point.applyMatrix4(this.partFrame.matrix)); },
      changed: () => this.invalidate(),
    });
    new ResizeObserver(() => { this.resize(); this.invalidate(); }).observe(this.box);
    this.box.addEventListener("draw-now", () => this.draw()); // the canvas is read at once: a picture to save
    matchMedia(`(resolution: ${devicePixelRatio}dppx)`).addEventListener("change", () => { this.resize(); this.invalidate(); });
    this.box.addEventListener("draw-now", () => this.draw()); // before its canvas is read
    canvas.addEventListener("webglcontextrestored", () => this.invalidate());
    this.picker.prepare();
    this.invalidate();
  }

  private resize(): void {
    const w = Math.max(1, this.box.clientWidth), h = Math.max(1, this.box.clientHeight), ratio = Math.min(3, devicePixelRatio || 1);
    this.renderer!.setPixelRatio(ratio);
    this.renderer!.setSize(w, h, false);
    this.ctx.shared.pixel.value = ratio;
    this.ctx.shared.screen.value.set(Math.floor(w * ratio), Math.floor(h * ratio));
    this.view.resize(w, h);
  }
  private recolour(): void {
    const dark = isDark(this.store.state);
    this.ctx.theme = readTheme(this.box, dark);
    fillRamp(this.ctx.shared, dark);
    this.renderer!.setClearColor(this.ctx.theme.sheet, 1);
    for (const p of [this.part, this.path, this.tool, this.stock, this.findings, this.measured, this.axes, this.ground]) p.recolour();
    this.outlines.update();
  }
  private turnTable(): void {
    const { scene, store } = this, m = store.state.asMachine ? tableMatrix(scene.machine, rotaryAt(scene.path, waysDone(this.ctx)), scene.center) : identity;
    this.partFrame.matrix.copy(m);
    this.partFrame.updateMatrixWorld(true);
    this.axes.update();
  }
  private section(): void {
    const { section } = this.store.state, { clip, clipOn } = this.ctx.shared, sign = section.flip ? -1 : 1;
    clipOn.value = section.on ? 1 : 0;
    clip.value.set(0, 0, 0, sign * (section.at - this.scene.center[section.axis]!));
    clip.value.setComponent(section.axis, sign);
    this.part.section();
    this.stock.section();
  }

  private click(x: number, y: number): void {
    const { store, scene } = this, s = store.state;
    if (s.measuring) {
      const p = this.picker.measure(this.view, this.partFrame.matrix, this.box, x, y);
      if (p) store.set({ measured: [...(s.measured.length >= 2 ? [] : s.measured), toPart([p.x, p.y, p.z], scene.center)] });
      return;
    }
    const finding = this.picker.finding(this.view, this.partFrame.matrix, this.box, x, y), node = finding ? scene.findings[finding.index]!.node : this.picker.way(this.view, this.partFrame.matrix, this.box, x, y)?.node ?? null;
    if (node === null || node >= scene.path.count) { if (!finding) store.set({ picked: null }); return; }
    store.set({ picked: node, time: scene.path.time[node]!, playing: false });
  }
  private askHover(): void {
    if (this.hoverAsked) return;
    this.hoverAsked = true;
    requestAnimationFrame(() => {
      this.hoverAsked = false;
      const p = this.pointer, canvas = this.renderer!.domElement;
      if (!p) return;
      const finding = this.store.state.measuring ? null : this.picker.finding(this.view, this.partFrame.matrix, this.box, p.x, p.y);
      const way = finding ? null : this.picker.way(this.view, this.partFrame.matrix, this.box, p.x, p.y);
      const title = finding ? `${this.scene.findings[finding.index]!.title}\n${this.scene.findings[finding.index]!.detail}` : "";
      if (canvas.title !== title) canvas.title = title;
      if (!this.store.state.measuring) canvas.style.cursor = finding || way ? "pointer" : "";
      this.store.set({ hovered: way?.node ?? null });
    });
  }

  /** Another frame, soon. */
  invalidate(): void {
    if (this.asked || !this.renderer) return;
    this.asked = true;
    requestAnimationFrame(now => {
      this.asked = false;
      const dt = Math.min(0.1, this.last > 0 ? (now - this.last) / 1000 : 1 / 60);
      const still = !this.view.step(dt);
      this.draw();
      this.last = still ? 0 : now;
      if (!still) this.invalidate();
    });
  }
  private draw(): void {
    const begin = performance.now(), { view } = this;
    this.stock.update();
    this.ground.zoomed(view.pixel);
    view.place();
    this.path.zoomed(view.pixel, view.viewProjection().multiply(this.partFrame.matrix), this.ribbons);
    this.renderer!.render(this.root, view.camera);
    this.overlay.frame(view.right, view.up, view.back, view.pixel);
    this.overlay.say(this.labels());
    this.frameMs = performance.now() - begin;
    ++this.frames;
  }
  private labels(): Label[] {
    const out: Label[] = [], { measured, measuring } = this.store.state, at = (p: Vec): { x: number; y: number } => this.onBox(new Vector3(...toStage(p, this.scene.center)).applyMatrix4(this.partFrame.matrix));
    if (measured.length === 2) {
      const [p, q] = measured as [Vec, Vec], d = q.map((v, i) => v - p[i]!) as Vec, a = at(p), b = at(q), f = (v: number): string => v.toFixed(3);
      out.push({ text: `${f(Math.hypot(...d))} mm\ndx ${f(d[0])}  dy ${f(d[1])}  dz ${f(d[2])}`, x: (a.x + b.x) / 2 + 12, y: (a.y + b.y) / 2 + 8, strong: true });
    } else if (measured.length === 1) {
      const a = at(measured[0]!), p = measured[0]!;
      out.push({ text: p.map((v, i) => `${"xyz"[i]} ${v.toFixed(3)}`).join("  "), x: a.x + 12, y: a.y + 8 });
    } else if (measuring) out.push({ text: "Click two points.", x: 12, y: 12 });
    for (const l of this.axes.labels) { const p = this.onBox(l.place); out.push({ text: l.text, x: p.x, y: p.y, free: true }); }
    return out;
  }
  /** Of the stage's machine frame, in CSS pixels of the box. */
  private onBox(p: Vector3): { x: number; y: number } {
    const c = p.clone().applyMatrix4(this.view.viewProjection());
    return { x: (c.x + 1) / 2 * this.box.clientWidth, y: (1 - c.y) / 2 * this.box.clientHeight };
  }

  /** A place of the part on the screen: CSS pixels of the page. */
  project(point: Vec): { x: number; y: number } {
    if (!this.renderer) return { x: 0, y: 0 };
    const p = this.onBox(new Vector3(...toStage(point, this.scene.center)).applyMatrix4(this.partFrame.matrix)), r = this.box.getBoundingClientRect();
    return { x: r.left + p.x, y: r.top + p.y };
  }
  stats(): Stats {
    const webgl = this.renderer !== null;
    return { frames: this.frames, frameMs: this.frameMs, pickMs: webgl ? this.picker.milliseconds : 0, stockMs: webgl ? this.stock.milliseconds : 0, stockTriangles: webgl ? this.stock.triangles : 0,
      waiting: this.asked || (webgl && this.stock.waiting), segments: Math.max(0, this.scene.path.count - 1), triangles: webgl ? this.part.triangles() : 0, webgl };
  }
}
const identity = new Matrix4();

// SPDX-License-Identifier: Apache-2.0
// The camera: a turntable about a target, orthographic or perspective, damped. z is up.
import { Box3, type Camera, Matrix4, OrthographicCamera, PerspectiveCamera, Sphere, Vector3 } from "three";
import type { View as ViewName } from "../state";

interface Place { target: Vector3; yaw: number; pitch: number; span: number } // span: height seen at the target, mm

const FOV = 28; // degrees
const SETTLE = 16; // 1/s: how fast the camera follows what is wished
const STILL = 2e-4; // of the span, and radians: near enough to rest
const NAMED: Partial<Record<ViewName, [number, number]>> = {
  iso: [-55, 32], top: [-90, 90], bottom: [-90, -90], front: [-90, 0], back: [90, 0], left: [180, 0], right: [0, 0] };
const radians = (d: number): number => d * Math.PI / 180;

export class View {
  readonly perspective = new PerspectiveCamera(FOV, 1, 1, 1000);
  readonly orthographic = new OrthographicCamera(-1, 1, 1, -1, 0, 1000);
  camera: Camera = this.orthographic;
  private goal: Place;
  private now: Place;
  private aspect = 1;
  private height = 1;
  private touched = false; // by the user; until then a new size fits anew
  readonly right = new Vector3(); readonly up = new Vector3(); readonly back = new Vector3();

  /** `all` is what must not be cut off by the near and far planes; `shown` is what fit() shows. */
  constructor(private all: Box3, public shown: Box3, readonly flat: boolean) {
    const c = shown.getCenter(new Vector3());
    this.goal = { target: c.clone(), yaw: 0, pitch: 0, span: 1 };
    this.now = { target: c.clone(), yaw: 0, pitch: 0, span: 1 };
  }
  get span(): number { return this.now.span; }
  get target(): Vector3 { return this.now.target; }
  /** mm of one CSS pixel at the target. */
  get pixel(): number { return this.now.span / this.height; }
  get isPerspective(): boolean { return this.camera === this.perspective; }
  setPerspective(on: boolean): void { this.camera = on ? this.perspective : this.orthographic; this.place(); }
  resize(width: number, height: number): void { this.aspect = Math.max(0.01, width / Math.max(1, height)); this.height = Math.max(1, height); if (this.touched) this.place(); else { this.fit(); this.jump(); } }

  private basis(p: Place): void {
    const cy = Math.cos(p.yaw), sy = Math.sin(p.yaw), cp = Math.cos(p.pitch), sp = Math.sin(p.pitch);
    this.right.set(-sy, cy, 0); this.back.set(cp * cy, cp * sy, sp); this.up.crossVectors(this.back, this.right);
  }
  /** Sets the camera to where it is now. */
  place(): void {
    const p = this.now;
    this.basis(p);
    const reach = this.all.getBoundingSphere(sphere);
    const behind = this.back.dot(offset.subVectors(reach.center, p.target)); // of the centre, towards the eye
    const isPersp = this.isPerspective, distance = isPersp ? p.span / (2 * Math.tan(radians(FOV) / 2)) : Math.max(p.span, behind + reach.radius * 1.05 + p.span);
    const camera = this.camera;
    camera.matrixAutoUpdate = false;
    camera.matrix.makeBasis(this.right, this.up, this.back).setPosition(p.target.x + distance * this.back.x, p.target.y + distance * this.back.y, p.target.z + distance * this.back.z);
    camera.matrixWorld.copy(camera.matrix);
    camera.matrixWorldInverse.copy(camera.matrix).invert();
    const nearest = distance - behind - reach.radius * 1.05, farthest = distance - behind + reach.radius * 1.05;
    if (isPersp) {
      const c = this.perspective;
      c.aspect = this.aspect; c.near = Math.max(nearest, distance * 0.02); c.far = Math.max(farthest, c.near * 2);
      c.updateProjectionMatrix();
    } else {
      const c = this.orthographic, h = p.span / 2;
      c.left = -h * this.aspect; c.right = h * this.aspect; c.top = h; c.bottom = -h; c.near = Math.max(0, nearest); c.far = Math.max(farthest, c.near + p.span);
      c.updateProjectionMatrix();
    }
  }
  /** One frame nearer to what is wished; false: there already. */
  step(dt: number): boolean {
    const { goal: g, now: n } = this, f = 1 - Math.exp(-SETTLE * dt);
    const far = Math.max(n.target.distanceTo(g.target) / g.span, Math.abs(n.yaw - g.yaw), Math.abs(n.pitch - g.pitch), Math.abs(Math.log(n.span / g.span)));
    if (far === 0) return false;
    if (far < STILL) this.jump();
    else {
      n.target.lerp(g.target, f); n.yaw += f * (g.yaw - n.yaw); n.pitch += f * (g.pitch - n.pitch); n.span *= (g.span / n.span) ** f;
      this.place();
    }
    return true;
  }
  jump(): void { const { goal: g, now: n } = this; n.target.copy(g.target); n.yaw = g.yaw; n.pitch = g.pitch; n.span = g.span; this.place(); }

  orbit(dx: number, dy: number): void {
    this.touched = true;
    const speed = Math.PI / Math.max(300, this.height) * 1.2;
    this.goal.yaw -= dx * speed;
    this.goal.pitch = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, this.goal.pitch + dy * speed));
  }
  /** By CSS pixels. */
  pan(dx: number, dy: number): void {
    this.touched = true;
    this.basis(this.goal);
    const k = this.goal.span / this.height;
    this.goal.target.addScaledVector(this.right, -dx * k).addScaledVector(this.up, dy * k);
    this.basis(this.now);
  }
  /** The place under the cursor (-1..1 each way) stays there. */
  zoom(factor: number, x = 0, y = 0): void {
    this.touched = true;
    const g = this.goal, most = this.all.getBoundingSphere(sphere).radius * 40 + 1, least = 1e-3;
    const span = Math.min(most, Math.max(least, g.span * factor)), f = 1 - span / g.span;
    this.basis(g);
    g.target.addScaledVector(this.right, f * x * g.span * this.aspect / 2).addScaledVector(this.up, f * y * g.span / 2);
    g.span = span;
    this.basis(this.now);
  }
  /** Turns from now on about the depth of this point, without a change of what is seen. */
  turnAbout(point: Vector3): void {
    this.basis(this.now);
    const depth = this.back.dot(offset.subVectors(point, this.now.target));
    for (const p of [this.now, this.goal]) {
      if (this.isPerspective) { const d = p.span / (2 * Math.tan(radians(FOV) / 2)), k = (d - depth) / d; if (k < 0.02) return; p.span *= k; }
      p.target.addScaledVector(this.back, depth);
    }
    this.place();
  }
  look(direction: Vector3): void {
    const d = direction.clone().normalize(), level = Math.hypot(d.x, d.y);
    this.turnTo(level < 1e-6 ? this.goal.yaw : Math.atan2(d.y, d.x), Math.asin(Math.min(1, Math.max(-1, d.z))));
  }
  private turnTo(yaw: number, pitch: number): void {
    const turn = 2 * Math.PI;
    this.goal.yaw = yaw + turn * Math.round((this.goal.yaw - yaw) / turn);
    this.goal.pitch = pitch;
  }
  named(name: ViewName): void {
    const angles = NAMED[name];
    if (angles) this.turnTo(radians(angles[0]), radians(angles[1]));
    this.fit();
  }
  fit(box: Box3 = this.shown): void {
    this.touched = false;
    this.basis(this.goal);
    let w = 0, h = 0;
    const c = box.getCenter(new Vector3());
    for (let i = 0; i < 8; ++i) {
      offset.set(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z).sub(c);
      w = Math.max(w, Math.abs(this.right.dot(offset))); h = Math.max(h, Math.abs(this.up.dot(offset)));
    }
    this.basis(this.now);
    this.goal.target.copy(c);
    this.goal.span = Math.max(2 * h, 2 * w / this.aspect, 1e-2) * 1.16;
  }
  /** So that `span` mm about the place are seen. */
  moveTo(at: Vector3, span: number): void {
    this.touched = true;
    this.goal.target.copy(at);
    if (span > 0) this.goal.span = span / Math.min(1, this.aspect);
  }
  viewProjection(): Matrix4 { return product.multiplyMatrices(this.camera.projectionMatrix, this.camera.matrixWorldInverse).clone(); }
}

const product = new Matrix4(), offset = new Vector3();
const sphere = new Sphere();

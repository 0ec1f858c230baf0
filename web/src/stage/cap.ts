// SPDX-License-Identifier: Apache-2.0
// The face that the section plane makes of a closed body: behind a point of the plane that is inside, one more back than front
// face follows; they are counted in the stencil, then the plane is painted where the count is not 0, and set back to 0.
import { BackSide, type BufferGeometry, type Color, DecrementWrapStencilOp, DoubleSide, FrontSide, GLSL3, IncrementWrapStencilOp, Matrix4, Mesh, NotEqualStencilFunc, PlaneGeometry, ShaderMaterial, Vector3, ZeroStencilOp } from "three";
import type { Context } from "./context";
import { toStage } from "./context";
import { CLIP_FRAGMENT, CLIP_VERTEX } from "./materials";

/** A share of the depth: of two faces in the plane the part's is seen, not the stock's. */
const NEARER = 2e-5;

export class Cap {
  readonly face: Mesh;
  private materials: ShaderMaterial[];
  private counted: Mesh[] = [];
  private reach: number;
  /** Each body its own `order`; `lean` 1 or -1: which way the hatching goes. */
  constructor(private ctx: Context, private order: number, colour: Color, lean: number) {
    const { shared, scene } = ctx;
    this.reach = 4 * Math.hypot(...[0, 1, 2].map(i => scene.box.hi[i]! - scene.box.lo[i]!)) + 1;
    this.materials = [BackSide, FrontSide].map(side => new ShaderMaterial({ glslVersion: GLSL3, side, colorWrite: false, depthWrite: false, depthTest: false,
      stencilWrite: true, stencilZPass: side === BackSide ? IncrementWrapStencilOp : DecrementWrapStencilOp, uniforms: { clip: shared.clip, clipOn: shared.clipOn },
      vertexShader: `${CLIP_VERTEX} void main() { vPart = position; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }`,
      fragmentShader: `${CLIP_FRAGMENT} out vec4 result; void main() { cut(); result = vec4(1.0); }` }));
    this.face = new Mesh(new PlaneGeometry(1, 1), new ShaderMaterial({ glslVersion: GLSL3, side: DoubleSide,
      stencilWrite: true, stencilRef: 0, stencilFunc: NotEqualStencilFunc, stencilFail: ZeroStencilOp, stencilZFail: ZeroStencilOp, stencilZPass: ZeroStencilOp,
      uniforms: { pixel: shared.pixel, colour: { value: colour }, lean: { value: lean }, nearer: { value: lean > 0 ? NEARER : 0 } },
      vertexShader: "uniform float nearer; void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); gl_Position.z -= nearer * gl_Position.w; }",
      fragmentShader: `uniform vec3 colour; uniform float pixel, lean; out vec4 result;
        void main() {
          float hatch = mod(gl_FragCoord.x + lean * gl_FragCoord.y, 8.0 * pixel) / pixel;
          result = vec4(mix(colour * 0.95, colour * 0.76, smoothstep(1.4, 0.5, abs(hatch - 1.4))), 1.0);
        }` }));
    this.face.matrixAutoUpdate = false;
    this.face.frustumCulled = false;
    this.face.renderOrder = this.at(2);
    this.face.visible = false;
  }
  /** Before everything else, one body after the other. */
  private at(step: number): number { return -1000 + 3 * this.order + step; }
  /** What must be drawn with a surface of the body. */
  passes(g: BufferGeometry): Mesh[] {
    this.counted = this.counted.filter(m => m.parent !== null);
    return this.materials.map((material, i) => {
      const m = new Mesh(g, material);
      m.frustumCulled = false; m.renderOrder = this.at(i); m.visible = this.face.visible;
      this.counted.push(m);
      return m;
    });
  }
  update(shown: boolean): void {
    const { section } = this.ctx.store.state, on = section.on && shown;
    this.face.visible = on;
    for (const m of this.counted) m.visible = on;
    if (!on) return;
    const at = new Vector3(...toStage(this.ctx.scene.box.lo.map((v, i) => (v + this.ctx.scene.box.hi[i]!) / 2) as [number, number, number], this.ctx.scene.center));
    at.setComponent(section.axis, section.at - this.ctx.scene.center[section.axis]!);
    const axes = [0, 1, 2].map(i => new Vector3().setComponent((section.axis + 1 + i) % 3, i === 2 ? 1 : this.reach));
    this.face.matrix.copy(new Matrix4().makeBasis(axes[0]!, axes[1]!, axes[2]!)).setPosition(at);
    this.face.matrixWorldNeedsUpdate = true;
  }
}

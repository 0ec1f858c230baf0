// SPDX-License-Identifier: Apache-2.0
// Curves of a drawing: the part's edges (coloured by deviation where it is known), other lines thin.
import { Color, Group } from "three";
import { divergingColour, heatRange, NONE } from "../colours";
import type { Outline } from "../scene";
import type { Context } from "./context";
import { Chain, Look, ribbonMaterial } from "./ribbon";

const WIDTH = 1.8, WIDTH_HEAT = 3.2; // CSS pixels

export class Outlines {
  readonly group = new Group();
  private chain: Chain;
  private width: { value: number };
  constructor(private ctx: Context) {
    const { outlines } = ctx.scene, points = new Float32Array(3 * outlines.reduce((n, o) => n + nodes(o), 0));
    let at = 0;
    for (const o of outlines) {
      points.set(o.point, 3 * at);
      if (o.closed) points.set(o.point.subarray(0, 3), 3 * (at + o.point.length / 3));
      at += nodes(o);
    }
    this.chain = new Chain(points);
    const material = ribbonMaterial(ctx, this.chain, { width: WIDTH, nearer: 0.0003, smooth: true });
    this.width = material.uniforms["width"] as { value: number };
    this.group.add(this.chain.object(material, 1));
    this.update();
  }
  update(): void {
    const { scene, store: { state }, theme } = this.ctx, edge = new Color().copy(theme.ink).lerp(theme.sheet, 0.12), other = new Color().copy(theme.soft).lerp(theme.sheet, 0.3);
    this.group.visible = state.show.part;
    const heat = state.heat && scene.outlines.some(o => o.value !== null);
    this.width.value = heat ? WIDTH_HEAT : WIDTH;
    let at = 0;
    for (const o of scene.outlines) {
      const m = o.point.length / 3, plain = o.part ? edge : other, value = heat ? o.value : null, range = value ? heatRange({ value, valueRange: 0 }, state.heatRange) : 1;
      for (let i = 0; i < nodes(o); ++i, ++at) {
        const v = value ? value[i % m]! : 0, c = !value ? [plain.r, plain.g, plain.b] : Number.isNaN(v) ? NONE : divergingColour(v / range, theme.dark);
        // From the outline before there is no way to the first point of this one.
        this.chain.paint(at, c[0]!, c[1]!, c[2]!, i === 0 ? Look.hidden : heat && !value ? Look.thin : o.part ? Look.plain : Look.thin);
      }
    }
    this.chain.painted();
  }
}
const nodes = (o: Outline): number => o.point.length === 0 ? 0 : o.point.length / 3 + (o.closed ? 1 : 0);

// SPDX-License-Identifier: Apache-2.0
// What all parts of the stage share: the scene, the theme, the section plane, and the wish for another frame.
import { Color, DataTexture, LinearFilter, RGBAFormat, Vector2, Vector4 } from "three";
import { divergingColour } from "../colours";
import type { Scene, Vec } from "../scene";
import type { Store } from "../state";

export interface Theme { dark: boolean; sheet: Color; ink: Color; soft: Color; line: Color; accent: Color; part: Color; hit: Color }

const LIGHT = { sheet: "#ffffff", ink: "#1b2430", soft: "#5b6776", line: "#d9dee5", accent: "#0b62c4", part: "#c3cad4", hit: "#ff2d95" };
const DARK = { sheet: "#161b23", ink: "#e4e9f0", soft: "#9aa7b8", line: "#2c3542", accent: "#6cb2ff", part: "#5d6878", hit: "#ff5db1" };

/** From the CSS variables that hold where `at` stands. */
export function readTheme(at: HTMLElement, dark: boolean): Theme {
  const fallback = dark ? DARK : LIGHT;
  const probe = document.createElement("span");
  probe.hidden = true;
  at.append(probe);
  const read = (name: keyof typeof LIGHT): Color => {
    probe.style.color = `var(--${name}, ${fallback[name]})`;
    const rgb = getComputedStyle(probe).color.match(/^rgba?\(([\d.]+)[, ]+([\d.]+)[, ]+([\d.]+)/);
    return rgb ? new Color(Number(rgb[1]) / 255, Number(rgb[2]) / 255, Number(rgb[3]) / 255) : new Color(fallback[name]);
  };
  const theme = { dark, sheet: read("sheet"), ink: read("ink"), soft: read("soft"), line: read("line"), accent: read("accent"), part: read("part"), hit: read("hit") };
  probe.remove();
  return theme;
}

/** Uniforms that every material of the part's frame has. */
export interface Shared {
  clip: { value: Vector4 }; // discarded where dot(xyz, p) > w
  clipOn: { value: number };
  ramp: { value: DataTexture }; // of deviations
  screen: { value: Vector2 }; // pixels of the device
  pixel: { value: number }; // pixels of the device in one of CSS
}

export interface Context {
  scene: Scene; store: Store; theme: Theme; shared: Shared;
  invalidate(): void;
}

const RAMP_STEPS = 256;

export function makeShared(): Shared {
  const ramp = new DataTexture(new Uint8Array(4 * RAMP_STEPS), RAMP_STEPS, 1, RGBAFormat);
  ramp.minFilter = ramp.magFilter = LinearFilter;
  return { clip: { value: new Vector4(0, 0, 1, 1e30) }, clipOn: { value: 0 }, ramp: { value: ramp }, screen: { value: new Vector2(1, 1) }, pixel: { value: 1 } };
}

export function fillRamp(shared: Shared, dark: boolean): void {
  const data = shared.ramp.value.image.data as Uint8Array;
  for (let i = 0; i < RAMP_STEPS; ++i) {
    const c = divergingColour(2 * i / (RAMP_STEPS - 1) - 1, dark);
    for (let k = 0; k < 3; ++k) data[4 * i + k] = Math.round(255 * c[k]!);
    data[4 * i + 3] = 255;
  }
  shared.ramp.value.needsUpdate = true;
}

/** Part coordinates to those of the stage and back. */
export const toStage = (p: Vec, center: Vec): Vec => [p[0] - center[0], p[1] - center[1], p[2] - center[2]];
export const toPart = (p: Vec, center: Vec): Vec => [p[0] + center[0], p[1] + center[1], p[2] + center[2]];

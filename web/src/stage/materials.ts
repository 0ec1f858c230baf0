// SPDX-License-Identifier: Apache-2.0
// How surfaces and plain lines are painted: light that goes with the eye, colours as CSS has them, the section plane.
import { BufferAttribute, BufferGeometry, Color, DoubleSide, FrontSide, GLSL3, LineSegments, ShaderMaterial } from "three";
import type { Context } from "./context";

/** Every vertex shader of the part's frame sets vPart; every fragment shader calls cut() first. */
export const CLIP_VERTEX = "out vec3 vPart;";
export const CLIP_FRAGMENT = `
in vec3 vPart;
uniform vec4 clip; uniform float clipOn;
void cut() { if (clipOn > 0.5 && dot(clip.xyz, vPart) > clip.w) discard; }`;

/** Stands for "none" in a float attribute; NaN is not passed on reliably. */
export const NO_VALUE = -1e30;

export interface SurfaceOptions { colour: Color; opacity?: number; back?: boolean; nearer?: number; tinted?: boolean; free?: boolean; shine?: number }

/** Uniforms of its own: colour, cutColour, opacity, heat (0, 1), range, push. */
export function surfaceMaterial(ctx: Context, o: SurfaceOptions): ShaderMaterial {
  const opacity = o.opacity ?? 1;
  return new ShaderMaterial({
    glslVersion: GLSL3, side: o.back === false ? FrontSide : DoubleSide, transparent: opacity < 1, depthWrite: opacity >= 1,
    polygonOffset: true, polygonOffsetFactor: 1 - (o.nearer ?? 0), polygonOffsetUnits: 2 - 2 * (o.nearer ?? 0),
    uniforms: { clip: ctx.shared.clip, clipOn: o.free ? { value: 0 } : ctx.shared.clipOn, ramp: ctx.shared.ramp,
      colour: { value: o.colour }, cutColour: { value: o.colour.clone() }, opacity: { value: opacity }, heat: { value: 0 }, range: { value: 1 }, shine: { value: o.shine ?? 0.14 }, push: { value: 0 } },
    vertexShader: `
      in float value; ${o.tinted ? "in float tint; out float vTint;" : ""}
      uniform float push; // mm away from the eye in depth only
      out vec3 vNormal; out float vValue; ${CLIP_VERTEX}
      void main() {
        vPart = position; vNormal = normalMatrix * normal; vValue = value; ${o.tinted ? "vTint = tint;" : ""}
        vec4 seen = modelViewMatrix * vec4(position, 1.0), back = projectionMatrix * (seen - vec4(0.0, 0.0, push, 0.0));
        gl_Position = projectionMatrix * seen;
        if (push > 0.0) gl_Position.z = back.z / back.w * gl_Position.w;
      }`,
    fragmentShader: `
      uniform vec3 colour; uniform vec3 cutColour; uniform float opacity, heat, range, shine; uniform sampler2D ramp;
      in vec3 vNormal; in float vValue; ${o.tinted ? "in float vTint;" : ""} ${CLIP_FRAGMENT}
      out vec4 result;
      void main() {
        cut();
        vec3 base = colour;
        ${o.tinted ? "base = mix(colour, cutColour, vTint);" : ""}
        if (heat > 0.5) base = vValue < -1e20 ? vec3(0.6, 0.62, 0.66) : texture(ramp, vec2(clamp(0.5 + 0.5 * vValue / range, 0.002, 0.998), 0.5)).rgb;
        vec3 n = normalize(vNormal);
        if (!gl_FrontFacing) n = -n;
        const vec3 key = normalize(vec3(0.35, 0.55, 0.8)), fill = normalize(vec3(-0.6, -0.25, 0.6)), halfway = normalize(vec3(0.35, 0.55, 1.8));
        float light = 0.5 + 0.42 * max(dot(n, key), 0.0) + 0.28 * max(dot(n, fill), 0.0);
        result = vec4(base * light + shine * pow(max(dot(n, halfway), 0.0), 30.0), opacity);
      }`,
  });
}

export function lineMaterial(ctx: Context, colour: Color, opacity = 1, nearer = 0.0004): ShaderMaterial {
  return new ShaderMaterial({
    glslVersion: GLSL3, transparent: opacity < 1, depthWrite: opacity >= 1,
    uniforms: { clip: ctx.shared.clip, clipOn: ctx.shared.clipOn, colour: { value: colour }, opacity: { value: opacity }, nearer: { value: nearer } },
    vertexShader: `${CLIP_VERTEX} uniform float nearer;
      void main() { vPart = position; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); gl_Position.z -= nearer * gl_Position.w; }`,
    fragmentShader: `uniform vec3 colour; uniform float opacity; ${CLIP_FRAGMENT} out vec4 result; void main() { cut(); result = vec4(colour, opacity); }`,
  });
}

export function lines(points: Float32Array, material: ShaderMaterial): LineSegments {
  const g = new BufferGeometry();
  g.setAttribute("position", new BufferAttribute(points, 3));
  const object = new LineSegments(g, material);
  object.frustumCulled = false;
  return object;
}

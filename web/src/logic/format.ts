// SPDX-License-Identifier: Apache-2.0
// Numbers as text, ticks of axes.
export const count = (n: number): string => Math.round(n).toLocaleString("en-US").replaceAll(",", "\u2009");
export const fixed = (v: number, digits: number): string => {
  if (!Number.isFinite(v)) return "-";
  const s = v.toFixed(digits);
  return /^-0\.?0*$/.test(s) ? s.slice(1) : s;
};
/** Four digits that count, without zeros at the end. */
export function brief(v: number): string {
  if (!Number.isFinite(v)) return "-";
  const a = Math.abs(v);
  if (a === 0) return "0";
  if (a < 1e-4 || a >= 1e7) return v.toExponential(2);
  return String(Number(v.toPrecision(4)));
}
/** "0:07.31", "12:04", "3:20:07". */
export function duration(s: number, digits = 2): string {
  if (!Number.isFinite(s)) return "-";
  const unit = 10 ** digits, all = Math.round(Math.max(0, s) * unit) / unit;
  const h = Math.floor(all / 3600), m = Math.floor(all / 60) % 60, rest = all - 3600 * h - 60 * m;
  const seconds = rest.toFixed(digits).padStart(digits > 0 ? digits + 3 : 2, "0");
  return h > 0 ? `${h}:${String(m).padStart(2, "0")}:${seconds}` : `${m}:${seconds}`;
}
export const length = (mm: number): string => mm >= 1e4 ? `${fixed(mm / 1000, 2)} m` : `${fixed(mm, mm >= 1000 ? 0 : 1)} mm`;
/** 1, 2 or 5 times a power of ten, at least `raw`. */
export function niceStep(raw: number): number {
  if (!(raw > 0) || !Number.isFinite(raw)) return 1;
  const p = 10 ** Math.floor(Math.log10(raw)), m = raw / p;
  return (m <= 1 ? 1 : m <= 2 ? 2 : m <= 5 ? 5 : 10) * p;
}
/** Round values from a to b, at most about n. */
export function ticks(a: number, b: number, n: number, step = niceStep((b - a) / Math.max(1, n))): number[] {
  const out: number[] = [];
  if (!(b > a) || !(step > 0)) return out;
  for (let i = Math.ceil(a / step - 1e-9); i * step <= b + 1e-9 * step && out.length < 1000; ++i) out.push(Number((i * step).toPrecision(12)));
  return out;
}
/** Steps people read angles and clocks in. */
export function stepOf(raw: number, steps: number[]): number {
  return raw < (steps[0] ?? 1) ? niceStep(raw) : steps.find(s => s >= raw) ?? niceStep(raw);
}
export const ANGLE_STEPS = [1, 2, 5, 10, 15, 30, 45, 90, 180, 360];
export const TIME_STEPS = [1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 14400, 36000, 86400];

// SPDX-License-Identifier: Apache-2.0
// The player: buttons, speed, readouts, and a strip of the whole time with kinds, groups and findings.
import type { Scene } from "./scene";
import type { Store } from "./state";
import { css, groupColour, isDark, kindColour, KINDS } from "./colours";
import { bands, NO_KIND } from "./logic/bands";
import { brief, duration, fixed, length, stepOf, ticks, TIME_STEPS } from "./logic/format";
import { focus, goNode, goTime, motionOf } from "./seek";
import { button, choice, el, setIcon, sheet, themed, within } from "./ui";

const narrow = matchMedia("(max-width: 760px)"); // there the figures scroll
const SPEEDS = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000], FIT_SECONDS = 30;

export function togglePlaying(scene: Scene, store: Store): void {
  const m = motionOf(scene);
  if (m.duration <= 0) return;
  store.set({ playing: !store.state.playing, picked: null, trial: null });
}
export function step(scene: Scene, store: Store, by: "node" | "move" | "pass", direction: number): void {
  store.set({ playing: false });
  goNode(scene, store, motionOf(scene).step(focus(store), by, direction));
}
export function changeSpeed(store: Store, direction: number): void {
  const now = store.state.speed;
  const next = direction > 0 ? SPEEDS.find(s => s > now * 1.001) : SPEEDS.filter(s => s < now * 0.999).pop();
  if (next !== undefined) store.set({ speed: next });
}
function speedMenu(scene: Scene, store: Store): HTMLSelectElement {
  const fit = motionOf(scene).duration / FIT_SECONDS;
  const menu = choice("Speed", [...SPEEDS.map((s): [string, string] => [String(s), `${s}\u00d7`]), ["fit", `in ${FIT_SECONDS} s`], ["own", ""]], "1", v => store.set({ speed: v === "fit" ? fit || 1 : Number(v) }));
  const own = menu.options[menu.options.length - 1];
  own.hidden = true;
  const show = () => {
    const s = store.state.speed;
    own.textContent = `${brief(s)}\u00d7`; own.hidden = true;
    if (SPEEDS.includes(s)) menu.value = String(s); else if (Math.abs(s - fit) < 1e-9 * s) menu.value = "fit"; else { own.hidden = false; own.value = String(s); menu.value = own.value; }
  };
  show(); store.on(["speed"], show);
  return menu;
}

/** Where the tool is, in figures. */
function readouts(scene: Scene, store: Store): { time: HTMLElement; more: HTMLElement } {
  const m = motionOf(scene), { path } = scene, clock = el("b", {}), way = el("span", { class: "soft" });
  const time = el("div", { class: "clock nums" }, el("span", {}, clock, el("span", { class: "soft" }, ` / ${duration(m.duration)}`)), way);
  const more = el("dl", { class: "readouts nums" }), cells = new Map<string, HTMLElement>();
  const cell = (name: string, wide = `r-${name}`) => { const d = el("dd", {}); more.append(el("div", { class: wide }, el("dt", {}, name), d)); cells.set(name, d); };
  for (const n of ["X", "Y", "Z"]) cell(n);
  const letters = path.rotary ? (scene.machine?.axes.slice(0, 2).map(a => a.letter) ?? ["A", "C"]) : [];
  for (const l of letters) cell(l);
  cell("F");
  if (scene.program.lines > 0) cell("line");
  cell("move");
  if (scene.tools.length > 0) cell("tool", "w2");
  if (scene.groups.length > 0) cell("in", "w2");
  if (path.axis) cell("axis", "w3");
  const say = (name: string, text: string) => { const c = cells.get(name); if (c && c.textContent !== text) c.textContent = text; };
  const show = () => {
    if (path.count === 0) return;
    const p = m.at(store.state.time), way1 = Math.min(path.count - 1, p.part > 0 ? p.node + 1 : p.node); // what it says of the way ends at the next node
    clock.textContent = duration(store.state.time); way.textContent = `${length(p.length)} of ${length(m.length[path.count - 1])}`;
    ["X", "Y", "Z"].forEach((n, k) => say(n, fixed(p.tip[k], 3)));
    say("axis", p.axis.map(v => fixed(v, 4)).join(" "));
    letters.forEach((l, k) => say(l, p.rotary ? `${fixed(p.rotary[k], 3)}\u00b0` : "-"));
    say("F", path.kind[way1] === 0 ? "rapid" : path.feed[way1] > 0 ? fixed(path.feed[way1], path.feed[way1] < 100 ? 1 : 0) : KINDS[path.kind[way1]] ?? "-");
    const tool = scene.tools[path.tool[way1]];
    say("tool", tool ? `T${tool.number} ${tool.name}` : "-");
    say("in", scene.groups[path.group[way1]] ?? "-");
    say("move", String(path.move[way1])); say("line", path.line[way1] > 0 ? String(path.line[way1]) : "-");
  };
  show(); store.on(["time", "node"], show);
  // What does not fit is not shown in part.
  new ResizeObserver(() => { for (const c of more.children) if (c instanceof HTMLElement) c.style.visibility = c.offsetLeft + c.offsetWidth > more.clientWidth + 1 && !narrow.matches ? "hidden" : ""; }).observe(more);
  return { time, more };
}

/** Time from left to right; wheel zooms, a double click shows all of it. */
function strip(scene: Scene, store: Store): HTMLElement {
  const m = motionOf(scene), { path } = scene, canvas = el("canvas", { "aria-hidden": "true" });
  const cursor = el("i", { class: "cursor" }), ghost = el("i", { class: "cursor ghost" }), tip = el("div", { class: "tip nums", hidden: true });
  const box = el("div", { class: "strip", role: "slider", tabindex: 0, "aria-label": "Time", "aria-valuemin": 0, "aria-valuemax": m.duration.toFixed(2) }, canvas, ghost, cursor, tip);
  const marks = scene.findings.filter(f => f.node !== null && f.node < path.count).map(f => ({ time: path.time[f.node!], level: f.level, title: f.title })).sort((a, b) => a.level - b.level);
  let from = 0, to = m.duration || 1;
  const x = (t: number) => (t - from) / (to - from) * box.clientWidth, t = (px: number) => from + px / Math.max(1, box.clientWidth) * (to - from);
  const drawn = sheet(canvas, ({ g, w, h }) => {
    const dark = isDark(store.state), cols = Math.max(1, Math.floor(w)), b = bands(path, from, to, cols), y = marks.length > 0 ? 14 : 5, mid = h - 22, groups = scene.groups.length > 1;
    for (let c = 0, begin = 0; c <= cols; ++c) {
      if (c > 0 && (c === cols || b.kind[c] !== b.kind[begin] || b.group[c] !== b.group[begin])) {
        if (b.kind[begin] !== NO_KIND) {
          g.fillStyle = css(kindColour(b.kind[begin], dark)); g.globalAlpha = b.kind[begin] === 1 ? 0.9 : 0.75; g.fillRect(begin, y, c - begin, groups ? mid - y - 5 : mid - y);
          if (groups) { g.globalAlpha = 0.85; g.fillStyle = css(groupColour(b.group[begin], dark)); g.fillRect(begin, mid - 4, c - begin, 4); }
        }
        begin = c;
      }
    }
    g.globalAlpha = 1; g.fillStyle = themed("soft"); g.strokeStyle = themed("line"); g.textAlign = "center";
    const steps = stepOf((to - from) / (w / 80), TIME_STEPS), digits = steps < 1 ? Math.min(3, Math.ceil(-Math.log10(steps))) : 0;
    for (const v of ticks(from, to, 1, steps)) {
      const px = Math.round(x(v)) + 0.5;
      g.beginPath(); g.moveTo(px, mid + 1); g.lineTo(px, mid + 5); g.stroke();
      if (px > 16 && px < w - 16) g.fillText(duration(v, digits), px, h - 8);
    }
    const most = 2000; // a mark is 6 pixels wide: more are not told apart
    for (const q of marks.slice(-most)) {
      const px = x(q.time);
      if (px < -5 || px > w + 5) continue;
      g.fillStyle = themed(["accent", "warn", "bad"][q.level]); g.strokeStyle = themed("panel"); g.lineWidth = 1;
      g.beginPath(); g.moveTo(px - 4.5, 3); g.lineTo(px + 4.5, 3); g.lineTo(px, 12); g.closePath(); g.fill(); g.stroke();
    }
  });
  const place = () => {
    const { time, playing } = store.state;
    // The window goes along with the time.
    if (to - from < m.duration && (time < from || time > to)) { const w = to - from; from = Math.min(Math.max(0, playing ? time : time - w / 2), m.duration - w); to = from + w; drawn.again(); }
    const px = x(time);
    cursor.style.transform = `translateX(${px.toFixed(1)}px)`; cursor.hidden = px < -1 || px > box.clientWidth + 1;
    box.setAttribute("aria-valuenow", time.toFixed(2)); box.setAttribute("aria-valuetext", `${duration(time)} of ${duration(m.duration)}`);
  };
  const near = (px: number) => marks.reduce<{ time: number; title: string } | null>((best, q) => Math.abs(x(q.time) - px) < 5 && (!best || Math.abs(x(q.time) - px) < Math.abs(x(best.time) - px)) ? q : best, null);
  const hover = (e: PointerEvent) => {
    const p = within(e, box), f = p.y < 14 ? near(p.x) : null, at = f ? f.time : Math.min(to, Math.max(from, t(p.x))), n = m.nodeAt(at);
    ghost.style.transform = `translateX(${x(at).toFixed(1)}px)`; ghost.classList.add("on");
    tip.hidden = path.count === 0;
    tip.textContent = f ? `${f.title}, ${duration(at)}` : `${duration(at)}${scene.groups.length > 1 ? `, ${scene.groups[path.group[n]] ?? ""}` : ""}`;
    tip.style.left = `${Math.min(Math.max(4, p.x - tip.offsetWidth / 2), box.clientWidth - tip.offsetWidth - 4)}px`;
  };
  let held = false;
  const take = (e: PointerEvent) => { const p = within(e, box), f = !held && p.y < 14 ? near(p.x) : null; goTime(scene, store, f ? f.time : t(p.x)); };
  box.addEventListener("pointerdown", e => { if (e.button !== 0) return; box.setPointerCapture(e.pointerId); store.set({ playing: false }); take(e); held = true; });
  box.addEventListener("pointermove", e => { if (held) take(e); hover(e); });
  const end = () => { held = false; };
  box.addEventListener("pointerup", end); box.addEventListener("pointercancel", end);
  box.addEventListener("pointerleave", () => { ghost.classList.remove("on"); tip.hidden = true; });
  box.addEventListener("dblclick", () => { from = 0; to = m.duration || 1; drawn.again(); place(); });
  box.addEventListener("wheel", e => {
    e.preventDefault();
    const all = m.duration || 1, least = Math.max(all * 1e-6, 1e-3);
    if (Math.abs(e.deltaX) > Math.abs(e.deltaY) || e.shiftKey) {
      const d = Math.min(all - to, Math.max(-from, (e.deltaX || e.deltaY) / box.clientWidth * (to - from)));
      from += d; to += d;
    } else {
      const at = t(within(e, box).x), f = Math.exp(Math.min(300, Math.max(-300, e.deltaY)) * 0.002), w = Math.min(all, Math.max(least, (to - from) * f));
      from = Math.min(Math.max(0, at - (at - from) * w / (to - from)), all - w); to = from + w;
    }
    drawn.again(); place();
  }, { passive: false });
  box.addEventListener("keydown", e => {
    const d = (to - from) / 100, by: Record<string, number> = { ArrowRight: d, ArrowUp: d, ArrowLeft: -d, ArrowDown: -d, PageUp: 10 * d, PageDown: -10 * d, Home: -Infinity, End: Infinity };
    if (!(e.key in by) || e.ctrlKey || e.altKey || e.metaKey || e.shiftKey) return;
    e.preventDefault(); e.stopPropagation();
    store.set({ playing: false });
    goTime(scene, store, by[e.key] === Infinity ? m.duration : by[e.key] === -Infinity ? 0 : store.state.time + by[e.key]);
  });
  store.on(["time", "playing"], place); store.on(["theme"], drawn.again);
  new ResizeObserver(place).observe(box);
  return box;
}

export function makeTimeline(scene: Scene, store: Store): HTMLElement {
  const playing = button("play", "Play", () => togglePlaying(scene, store), { key: "Space", class: "square main" });
  store.on(["playing"], s => setIcon(playing, s.playing ? "pause" : "play", s.playing ? "Pause" : "Play", "Space"));
  const go = (by: "node" | "move" | "pass", d: number) => () => step(scene, store, by, d);
  const buttons = el("div", { class: "transport", role: "group", "aria-label": "Player" },
    button("passBack", "Pass before", go("pass", -1), { key: "[" }), button("moveBack", "Move before", go("move", -1), { key: "Shift+Left" }), button("back", "Node before", go("node", -1), { key: "Left" }), playing,
    button("on", "Next node", go("node", 1), { key: "Right" }), button("moveOn", "Next move", go("move", 1), { key: "Shift+Right" }), button("passOn", "Next pass", go("pass", 1), { key: "]" }), speedMenu(scene, store));
  const { time, more } = readouts(scene, store), long = motionOf(scene).duration;
  if (long > 4 * FIT_SECONDS && store.state.speed === 1) store.set({ speed: long / FIT_SECONDS });
  const box = el("footer", { class: "timeline", "aria-label": "Timeline" }, buttons, time, more, strip(scene, store));
  if (scene.path.count < 2) box.hidden = true;
  return box;
}

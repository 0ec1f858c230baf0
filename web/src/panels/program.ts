// SPDX-License-Identifier: Apache-2.0
// The program's listing. Only the lines that are seen exist; it follows the time, a click goes to the line's move.
import type { Panel } from "../panels";
import type { Scene } from "../scene";
import type { Store } from "../state";
import { count } from "../logic/format";
import { Listing, tinted } from "../logic/listing";
import { goNode } from "../seek";
import { button, check, copy, el, tell } from "../ui";

const ROW = 20; // as style.css has it
/** Browsers end at some height of a box (Firefox: 17.8 million pixels): longer listings are scrolled in proportion. */
const TALLEST = 8e6;
const LONGEST = 400; // characters of a line that are shown

class View {
  readonly box: HTMLElement;
  private space = el("div"); private lines = el("div", { class: "code-lines" });
  private listing: Listing | null = null;
  private now = 0; private found = 0; private needle = ""; private asked = false; private shownFrom = -1; private dirty = true;
  follow = true;
  constructor(private scene: Scene, private store: Store) {
    this.box = el("div", { class: "code", tabindex: 0, role: "listbox", "aria-label": `Program ${scene.program.name}` }, this.space, this.lines);
    this.box.addEventListener("scroll", () => this.ask());
    this.box.addEventListener("wheel", e => {
      if (this.stretch() <= 1 || e.ctrlKey) return;
      e.preventDefault(); // a notch is as many lines as ever
      this.toTop(this.top() + (e.deltaMode === 1 ? e.deltaY : e.deltaY / ROW));
    }, { passive: false });
    this.lines.addEventListener("click", e => {
      const n = Number((e.target as HTMLElement).closest<HTMLElement>("[data-n]")?.dataset.n);
      if (n > 0 && !getSelection()?.toString()) this.go(n);
    });
    this.box.addEventListener("keydown", e => this.key(e));
    new ResizeObserver(() => { if (this.box.clientHeight > 0) { this.open(); this.dirty = true; this.centre(this.now, true); this.ask(); } }).observe(this.box);
    store.on(["node"], () => this.atNode());
  }
  /** The text is cut into lines when it is first seen. */
  open(): Listing {
    if (!this.listing) {
      this.listing = new Listing(this.scene.program.text, this.scene.path.line);
      this.space.style.height = `${Math.min(TALLEST, this.listing.count * ROW)}px`;
      this.lines.style.setProperty("--digits", `${String(this.listing.count).length}ch`);
      this.now = this.lineOfNode();
    }
    return this.listing;
  }
  get current(): number { return this.now; }
  private lineOfNode(): number {
    const { path } = this.scene, n = this.store.state.node, part = path.time[n] < this.store.state.time && n + 1 < path.count ? n + 1 : n;
    return path.count > 0 ? path.line[part] : 0;
  }
  private stretch(): number {
    const all = (this.listing?.count ?? 0) * ROW, h = this.box.clientHeight;
    return all > TALLEST ? (all - h) / (TALLEST - h) : 1;
  }
  /** Line at the upper edge, from 0, with its part that is scrolled away. */
  private top(): number { return this.box.scrollTop * this.stretch() / ROW; }
  private toTop(line: number): void { this.box.scrollTop = Math.max(0, line) * ROW / this.stretch(); this.ask(); }
  private visible(): number { return Math.max(1, Math.floor(this.box.clientHeight / ROW)); }
  centre(line: number, always = false): void {
    if (line < 1 || this.box.clientHeight === 0) return;
    const t = this.top(), n = this.visible();
    if (!always && line - 1 >= t + 2 && line - 1 < t + n - 3) return;
    this.toTop(line - 1 - Math.floor(n / 2));
  }
  private atNode(): void {
    if (!this.listing) return;
    const line = this.lineOfNode();
    if (line === this.now || line === 0) return;
    this.now = line; this.dirty = true;
    if (this.follow) this.centre(line);
    this.ask();
  }
  private ask(): void { if (!this.asked) { this.asked = true; requestAnimationFrame(() => { this.asked = false; this.draw(); }); } }
  private draw(): void {
    const l = this.listing, h = this.box.clientHeight;
    if (!l || h === 0) return;
    const top = this.top(), first = Math.max(0, Math.floor(top) - 8), end = Math.min(l.count, Math.ceil(top + h / ROW) + 8);
    // Where the first line stands: in proportion when the listing is too tall for a box.
    this.lines.style.transform = `translateY(${this.box.scrollTop - (top - first) * ROW}px)`;
    if (first === this.shownFrom && !this.dirty && this.lines.childElementCount === end - first) return;
    this.shownFrom = first; this.dirty = false;
    const rows: HTMLElement[] = [];
    for (let n = first + 1; n <= end; ++n) rows.push(this.row(l, n));
    this.lines.replaceChildren(...rows);
  }
  private row(l: Listing, n: number): HTMLElement {
    const full = l.line(n), text = full.length > LONGEST ? `${full.slice(0, LONGEST)}\u2026` : full, no = el("span", { class: "no" }, String(n));
    no.style.minWidth = "calc(var(--digits) + 20px)";
    const row = el("div", { class: `code-line${l.moves(n) ? " moves" : ""}${n === this.now ? " now" : ""}${n === this.found ? " found" : ""}`, "data-n": n, role: "option", "aria-selected": String(n === this.now) }, no);
    const at = n === this.found && this.needle ? text.toLowerCase().indexOf(this.needle) : -1;
    if (at >= 0) row.append(text.slice(0, at), el("mark", {}, text.slice(at, at + this.needle.length)), text.slice(at + this.needle.length));
    else for (const t of tinted(text)) row.append(t.tint ? el("span", { class: `t-${t.tint}` }, t.text) : t.text);
    return row;
  }
  go(line: number): void {
    const node = this.open().nodeOf(line);
    if (node === null) { tell("Nothing moves in this program"); return; }
    this.store.set({ playing: false });
    goNode(this.scene, this.store, node);
  }
  private key(e: KeyboardEvent): void {
    const n = this.visible(), by: Record<string, number> = { ArrowDown: 1, ArrowUp: -1, PageDown: n - 2, PageUp: 2 - n, Home: -Infinity, End: Infinity };
    if (!(e.key in by) || e.ctrlKey || e.metaKey || e.altKey) return;
    e.preventDefault(); e.stopPropagation();
    const l = this.open(), d = by[e.key], step = Math.sign(d);
    let to = Number.isFinite(d) ? Math.min(l.count, Math.max(1, this.now + d)) : d > 0 ? l.count : 1;
    while (to > 1 && to < l.count && !l.moves(to)) to += step; // lines without a move are passed over
    if (l.moves(to)) this.go(to); else this.toTop(this.top() + (Number.isFinite(d) ? d : step * l.count));
  }
  find(query: string, direction: 1 | -1): void {
    const l = this.open(), hit = l.search(query, this.found || this.now, direction);
    this.needle = /^\d+$/.test(query.trim()) ? "" : query.trim().toLowerCase();
    if (hit === null) { if (query.trim()) tell(`"${query.trim()}" is not in the program`); return; }
    this.found = hit; this.dirty = true;
    this.centre(hit); this.ask();
  }
  clear(): void { this.found = 0; this.dirty = true; this.ask(); }
  get foundLine(): number { return this.found; }
}

export const programPanel: Panel = {
  id: "program", title: "Program",
  make(scene: Scene, store: Store): HTMLElement | null {
    if (scene.program.lines === 0 || scene.program.text === "") return null;
    const view = new View(scene, store), q = el("input", { type: "search", id: "program-search", placeholder: "Text, N120 or line", "aria-label": "Search the program: text, block number or line number", spellcheck: "false" });
    q.addEventListener("keydown", e => {
      if (e.key === "Enter") { e.preventDefault(); if (e.ctrlKey && view.foundLine) view.go(view.foundLine); else view.find(q.value, e.shiftKey ? -1 : 1); }
      if (e.key === "Escape") { q.value = ""; view.clear(); view.box.focus(); }
    });
    q.addEventListener("input", () => { if (q.value === "") view.clear(); });
    const follow = check("follow", true, on => { view.follow = on; if (on) view.centre(view.current); });
    return el("div", { class: "column" },
      el("div", { class: "search" }, q, button("up", "Find before", () => view.find(q.value, -1), { key: "Shift+Enter" }), button("down", "Find next", () => view.find(q.value, 1), { key: "Enter" }), follow.box),
      view.box,
      el("div", { class: "readout row" }, el("span", { class: "soft" }, `${scene.program.name}, ${count(scene.program.lines)} lines${scene.program.cut ? " (cut)" : ""}`),
        button("copy", "Copy the program", () => void copy(scene.program.text, "Program"), { class: "small" })));
  },
};

// SPDX-License-Identifier: Apache-2.0
// Lines of a program text, nodes of lines, search, light colouring.

/** Where each line begins; one more for the end. */
export function lineStarts(text: string): Uint32Array {
  let n = 1;
  for (let at = text.indexOf("\n"); at >= 0; at = text.indexOf("\n", at + 1)) ++n;
  if (text.length === 0 || text.endsWith("\n")) --n;
  const out = new Uint32Array(n + 1);
  let at = 0;
  for (let i = 0; i < n; ++i) { out[i] = at; const end = text.indexOf("\n", at); at = end < 0 ? text.length : end + 1; }
  out[n] = text.length;
  return out;
}

export class Listing {
  readonly starts: Uint32Array;
  readonly count: number;
  private first: Uint32Array; // of each line: 1 + its first node, 0: none
  private lower: string | null = null;
  constructor(readonly text: string, lineOfNode: ArrayLike<number>) {
    this.starts = lineStarts(text);
    this.count = this.starts.length - 1;
    this.first = new Uint32Array(this.count + 1);
    for (let i = 0; i < lineOfNode.length; ++i) {
      const l = lineOfNode[i];
      if (l > 0 && l <= this.count && this.first[l] === 0) this.first[l] = i + 1;
    }
  }
  /** From 1, without its end. */
  line(n: number): string {
    if (n < 1 || n > this.count) return "";
    return this.text.slice(this.starts[n - 1], this.starts[n]).replace(/\r?\n$/, "");
  }
  moves(n: number): boolean { return n >= 1 && n <= this.count && this.first[n] > 0; }
  /** First node of the line, or of the next that moves, or of the last before it; null: nothing moves. */
  nodeOf(n: number): number | null {
    for (let l = Math.max(1, n); l <= this.count; ++l) if (this.first[l] > 0) return this.first[l] - 1;
    for (let l = Math.min(n, this.count); l >= 1; --l) if (this.first[l] > 0) return this.first[l] - 1;
    return null;
  }
  private lineAt(offset: number): number {
    let lo = 0, hi = this.count;
    while (lo < hi) { const mid = (lo + hi) >> 1; if (this.starts[mid] <= offset) lo = mid + 1; else hi = mid; }
    return lo;
  }
  /** A line number ("42"), a block number ("N120"), or text, from behind the line `from` on and around; null: nowhere. */
  search(query: string, from: number, direction: 1 | -1): number | null {
    const q = query.trim().toLowerCase();
    if (q === "" || this.count === 0) return null;
    if (/^\d+$/.test(q)) return Math.min(this.count, Math.max(1, Number(q)));
    const text = this.lower ??= this.text.toLowerCase(), block = /^n0*(\d+)$/.exec(q);
    const fits = block ? (at: number) => this.isBlock(text, at, block[1]) : () => true, key = block ? "n" : q;
    const edge = Math.min(this.count, Math.max(0, from));
    if (direction > 0) {
      for (const [a, b] of [[this.starts[edge], text.length], [0, this.starts[edge]]])
        for (let at = text.indexOf(key, a); at >= 0 && at < b; at = text.indexOf(key, at + 1)) if (fits(at)) return this.lineAt(at);
      return null;
    }
    const begin = this.starts[Math.max(0, edge - 1)];
    for (const [a, b] of [[0, begin], [begin, text.length]])
      for (let at = b > 0 ? text.lastIndexOf(key, b - 1) : -1; at >= a; at = at > 0 ? text.lastIndexOf(key, at - 1) : -1) if (fits(at)) return this.lineAt(at);
    return null;
  }
  private isBlock(text: string, at: number, digits: string): boolean {
    const before = at > 0 ? text[at - 1] : "\n";
    if (/[a-z0-9_]/.test(before)) return false;
    let k = at + 1;
    while (text[k] === "0") ++k;
    return text.startsWith(digits, k) && !/[0-9.]/.test(text[k + digits.length] ?? "");
  }
}

export type Tint = "comment" | "block" | "code" | "axis" | "rate" | "number" | "word" | "";
const TOKEN = /(\([^)]*\)?|;.*|\$\$.*|PPRINT.*)|([Nn]\s*\d+)|([GMgm]\s*\d+(?:\.\d+)?)|([XYZABCUVWIJKRxyzabcuvwijkr])(?=\s*[-+.\d[#])|([FSTDHPQLEfstdhpqle])(?=\s*[-+.\d[#])|([A-Z]{3,})|([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)/g;
const TINTS: Tint[] = ["comment", "block", "code", "axis", "rate", "word", "number"];
/** Pieces of a line with what they are. */
export function tinted(line: string): { text: string; tint: Tint }[] {
  const out: { text: string; tint: Tint }[] = [];
  let at = 0;
  for (const m of line.matchAll(TOKEN)) {
    if (m.index > at) out.push({ text: line.slice(at, m.index), tint: "" });
    out.push({ text: m[0], tint: TINTS[m.slice(1).findIndex(g => g !== undefined)] ?? "" });
    at = m.index + m[0].length;
  }
  if (at < line.length) out.push({ text: line.slice(at), tint: "" });
  return out;
}

// Shared by the report pages: small helpers, colours, the camera over the stage, drawing with WebGL 2, tables, input.
// A page names what it shows with setScene() and gives the functions that draw it.
const $ = id => document.getElementById(id);
const D = JSON.parse($("data").textContent);
const el = (tag, cls, text) => { const e = document.createElement(tag); if (cls) e.className = cls; if (text !== undefined) e.textContent = text; return e; };
const css = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const DPR = () => devicePixelRatio || 1;
const clamp = (v, a, b) => Math.min(b, Math.max(a, v));
const num = (v, d) => v === null || v === undefined || !isFinite(v) ? "-" : (+v).toFixed(d);
const brief = v => v === null || !isFinite(v) ? "-" : Math.abs(v) < 1e-9 ? "0" : Math.abs(v) < 1e-3 ? v.toExponential(1) : +v.toPrecision(4) + "";
const count = v => v.toLocaleString("en");
const DEG = 180 / Math.PI, TAU = 2 * Math.PI;

// --- data: little-endian arrays in base64 ---
function bytes(text) { const s = atob(text || ""), a = new Uint8Array(s.length); for (let i = 0; i < s.length; ++i) a[i] = s.charCodeAt(i); return a.buffer; }
/// Triangles of a shape: points, and normals padded to four bytes. `shift` is taken off the points.
function shapeMesh(m, shift) {
  const q = new Uint16Array(bytes(m.p)), s = new Int8Array(bytes(m.n)), p = new Float32Array(q.length), n = new Int8Array(q.length / 3 * 4);
  for (let i = 0; i < q.length; ++i) { const c = i % 3; p[i] = m.lo[c] + q[i] / 65535 * (m.hi[c] - m.lo[c]) - shift[c]; n[4 * ((i / 3) | 0) + c] = s[i]; }
  return { p, n, count: q.length / 3 };
}

// --- colours ---
function ramp3(t) { // a perceptually even ramp (viridis, five stops)
  const c = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [240, 210, 40]], u = clamp(isFinite(t) ? t : 0, 0, 0.9999) * 4, i = Math.floor(u), f = u - i;
  return [0, 1, 2].map(k => Math.round(c[i][k] + f * (c[i + 1][k] - c[i][k])));
}
const ramp = t => "rgb(" + ramp3(t).join(",") + ")";
const rampStops = () => "linear-gradient(90deg," + [0, .25, .5, .75, 1].map(ramp).join(",") + ")";
const probe = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
const rgb = text => { probe.fillStyle = "#000"; probe.fillStyle = text; const s = probe.fillStyle; return [1, 3, 5].map(i => parseInt(s.substr(i, 2), 16)); };
const dark = () => { const t = document.documentElement.dataset.theme; return t ? t === "dark" : matchMedia("(prefers-color-scheme: dark)").matches; };
const THEMED = ["sheet", "ink", "soft", "hit", "bad", "warn", "good", "line", "part", "accent", "free"];
let theme = {};
/// `lists`: further colours by name, {kinds: ["--rapid", ...]}.
function readTheme(lists) { theme = {}; for (const c of THEMED) theme[c] = rgb(css("--" + c)); for (const k in lists || {}) theme[k] = lists[k].map(c => rgb(css(c))); }
/// The button "theme" and the system's own change; `themed` draws again.
function onTheme(themed) {
  $("theme").onclick = () => { document.documentElement.dataset.theme = dark() ? "light" : "dark"; themed(); };
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", themed);
}
/// Rows of a legend: row(colour, name, class of the sign), cell(variable, name) of an area, bar(from, to) of the ramp.
function legendOf(id) {
  const L = $(id); L.textContent = "";
  return {
    row: (colour, name, cls) => { const d = el("div"), i = el("i", cls); if (cls === "dot" || cls === "area") i.style.background = colour; else i.style.borderColor = colour; d.append(i, name); L.append(d); },
    cell: (variable, name) => { const d = el("div"), i = el("i", "cell"); i.style.background = css(variable); d.append(i, name); L.append(d); },
    bar: (a, b) => { const d = el("div"), r = el("span", "ramp"); r.style.background = rampStops(); d.append(el("small", "", a), r, el("small", "", b)); L.append(d); } };
}

// --- camera: orthographic, z stays up ---
const stage = document.querySelector(".stage"), canvas = $("view"), g2 = canvas.getContext("2d"), glCanvas = $("gl");
const VIEWS = { top: [0, 90], front: [0, 0], side: [90, 0], end: [90, 0], iso: [-35, 28] };
const cam = { yaw: -35, pitch: 28, scale: 1, c: [0, 0, 0] };
/// lo, hi: what is seen; margin in pixels and as a divisor of the width; more: mm about it; turn: of the part about X.
const scene = { lo: [-1, -1, -1], hi: [1, 1, 1], size: 1, margin: 30, divisor: 9, more: 0, turn: () => 0 };
function setScene(s) { Object.assign(scene, s); scene.size = Math.hypot(...[0, 1, 2].map(k => scene.hi[k] - scene.lo[k])) || 1; [cam.yaw, cam.pitch] = VIEWS.iso; }
let W = 1, H = 1, dirty = true, coloursDirty = true, userMoved = false, target = null;
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const turned = (p, a) => { const c = Math.cos(a), s = Math.sin(a); return [p[0], p[1] * c - p[2] * s, p[1] * s + p[2] * c]; };
/// Right, up and towards the eye; turn of the part.
function basis() { const y = cam.yaw / DEG, p = cam.pitch / DEG, cy = Math.cos(y), sy = Math.sin(y), cp = Math.cos(p), sp = Math.sin(p); return { r: [cy, sy, 0], u: [-sy * sp, cy * sp, cp], w: [sy * cp, -cy * cp, sp], a: scene.turn() }; }
/// Pixels, and depth towards the eye in mm.
function project(q, b) { const m = b.a ? turned(q, b.a) : q, d = [m[0] - cam.c[0], m[1] - cam.c[1], m[2] - cam.c[2]]; return [W / 2 + cam.scale * dot(b.r, d), H / 2 - cam.scale * dot(b.u, d), dot(b.w, d)]; }
function fit() {
  const { lo, hi, more } = scene; cam.c = [0, 1, 2].map(k => (lo[k] + hi[k]) / 2); cam.scale = 1; const b = basis(); b.a = 0; let x0 = 1e300, x1 = -1e300, y0 = 1e300, y1 = -1e300;
  for (let k = 0; k < 8; ++k) { const p = project([0, 1, 2].map(i => k >> i & 1 ? hi[i] + more : lo[i] - more), b); x0 = Math.min(x0, p[0]); x1 = Math.max(x1, p[0]); y0 = Math.min(y0, p[1]); y1 = Math.max(y1, p[1]); }
  const m = Math.min(scene.margin * DPR(), W / scene.divisor), dx = (x0 + x1) / 2 - W / 2, dy = (y0 + y1) / 2 - H / 2; for (let k = 0; k < 3; ++k) cam.c[k] += b.r[k] * dx - b.u[k] * dy;
  cam.scale = Math.min((W - 2 * m) / Math.max(1e-6, x1 - x0), (H - 2 * m) / Math.max(1e-6, y1 - y0)); userMoved = false; dirty = true;
}
function size() { const r = stage.getBoundingClientRect(), k = DPR(); W = Math.max(1, Math.round(r.width * k)); H = Math.max(1, Math.round(r.height * k)); for (const c of [canvas, glCanvas]) { c.width = W; c.height = H; } dirty = true; }
function pan(dx, dy) { const b = basis(); for (let k = 0; k < 3; ++k) cam.c[k] += (-b.r[k] * dx + b.u[k] * dy) / cam.scale; userMoved = true; dirty = true; }
function turn(dx, dy) { cam.yaw = (cam.yaw - dx) % 360; cam.pitch = clamp(cam.pitch + dy, -90, 90); userMoved = true; dirty = true; }
function zoom(f, x, y) {
  const next = clamp(cam.scale * f, 0.02 * Math.min(W, H) / scene.size, 2e4 * Math.min(W, H) / scene.size); f = next / cam.scale; const b = basis(), dx = x - W / 2, dy = y - H / 2;
  for (let k = 0; k < 3; ++k) cam.c[k] += (b.r[k] * dx - b.u[k] * dy) * (1 - 1 / f) / cam.scale; cam.scale = next; userMoved = true; dirty = true;
}
/// A place of the part in the middle, with a ring about it, `span` mm across at most.
function zoomTo(q, span) { target = q; cam.c = turned(q, basis().a); cam.scale = Math.max(cam.scale, Math.min(W, H) / Math.max(span, 1e-3)); userMoved = true; dirty = true; }
function look(name) { [cam.yaw, cam.pitch] = VIEWS[name]; fit(); }

// --- on the plane canvas ---
function text(g, s, x, y, colour, align) { const k = DPR(); g.font = 11 * k + "px system-ui, sans-serif"; g.textAlign = align || "center"; g.textBaseline = "middle"; g.lineJoin = "round"; g.lineWidth = 3.5 * k; g.strokeStyle = css("--sheet"); g.strokeText(s, x, y); g.fillStyle = colour; g.fillText(s, x, y); }
function ring(g, q, r, colour, width) { g.strokeStyle = colour; g.lineWidth = width * DPR(); g.beginPath(); g.arc(q[0], q[1], r * DPR(), 0, 7); g.stroke(); }
function spot(g, q, r) { const k = DPR(); g.fillStyle = css("--hit"); g.beginPath(); g.arc(q[0], q[1], r * k, 0, 7); g.fill(); g.strokeStyle = css("--sheet"); g.lineWidth = 1.5 * k; g.stroke(); }
/// About `most` long, 1, 2 or 5 times a power of ten.
function roundLength(most) { const ten = Math.pow(10, Math.floor(Math.log10(most))); return most / ten < 2 ? ten : most / ten < 5 ? 2 * ten : 5 * ten; }
function warningRings(g, b, rel) { const marked = D.warnings.filter(m => m.position); for (const m of marked.slice(0, 200)) ring(g, project(rel(m.position), b), marked.length > 60 ? 3 : 7, css(m.severity === "left_out" ? "--bad" : "--warn"), 1.5); if (target) ring(g, project(target, b), 14, css("--hit"), 2); }
function axesAndScale(g, b) {
  const k = DPR(), ox = 34 * k, oy = H - 34 * k, names = ["X", "Y", "Z"], tints = ["--bad", "--good", "--accent"], unit = i => turned([+(i === 0), +(i === 1), +(i === 2)], b.a);
  [0, 1, 2].map(i => [dot(b.w, unit(i)), i]).sort((p, q) => p[0] - q[0]).forEach(([, i]) => { const e = unit(i), x = dot(b.r, e) * 22 * k, y = -dot(b.u, e) * 22 * k; g.strokeStyle = css(tints[i]); g.lineWidth = 2 * k; g.beginPath(); g.moveTo(ox, oy); g.lineTo(ox + x, oy + y); g.stroke(); if (Math.hypot(x, y) > 5 * k) text(g, names[i], ox + x * 1.35, oy + y * 1.35, css(tints[i])); });
  const s = roundLength(90 * k / cam.scale); $("scale").style.width = s * cam.scale / k + "px"; $("scale-text").textContent = +s.toPrecision(2) + " mm";
}
/// The canvas in its box's pixels, empty: [context, width, height, pixels a point].
function cleared(c) { const k = DPR(), r = c.getBoundingClientRect(), w = Math.max(1, Math.round(r.width * k)), h = Math.max(1, Math.round(r.height * k)); if (c.width !== w || c.height !== h) { c.width = w; c.height = h; } const g = c.getContext("2d"); g.clearRect(0, 0, w, h); return [g, w, h, k]; }
const ticks = (a, b, n) => { const raw = (b - a) / Math.max(1, n), p = Math.pow(10, Math.floor(Math.log10(raw))), s = raw / p <= 1 ? p : raw / p <= 2 ? 2 * p : raw / p <= 5 ? 5 * p : 10 * p, out = []; for (let i = Math.ceil(a / s - 1e-9); i * s <= b + 1e-9 * s; ++i) out.push(+(i * s).toPrecision(12)); return out; };
const angleTicks = (a, b, n) => { const raw = (b - a) / Math.max(1, n), s = [1, 2, 5, 10, 15, 30, 45, 90, 180, 360, 720, 1800].find(q => q >= raw) || 3600, out = []; if (raw < 1) return ticks(a, b, n); for (let i = Math.ceil(a / s - 1e-9); i * s <= b + 1e-9 * s; ++i) out.push(i * s); return out; };

// --- bodies of revolution about z: rings of [radius, height, normal outwards, normal up] ---
function revolved(rings) {
  const p = [], n = [], around = 36, at = (q, k) => { const t = TAU * k / around; p.push(q[0] * Math.cos(t), q[0] * Math.sin(t), q[1]); n.push(Math.round(127 * q[2] * Math.cos(t)), Math.round(127 * q[2] * Math.sin(t)), Math.round(127 * q[3]), 0); };
  for (let j = 1; j < rings.length; ++j) { const a = rings[j - 1], b = rings[j]; if (a[0] === b[0] && a[1] === b[1]) continue; for (let k = 0; k < around; ++k) { at(a, k); at(a, k + 1); at(b, k + 1); at(a, k); at(b, k + 1); at(b, k); } }
  return { p: new Float32Array(p), n: new Int8Array(n), count: p.length / 3 };
}
const tube = (r, from, to) => [[0, from, 0, -1], [r, from, 0, -1], [r, from, 1, 0], [r, to, 1, 0], [r, to, 0, 1], [0, to, 0, 1]];
/// Quarter of a circle from below outwards: middle at `from`, `height`, radius r.
const quarter = (from, height, r) => [...Array(9).keys()].map(k => { const a = -Math.PI / 2 + k * Math.PI / 16; return [from + r * Math.cos(a), height + r * Math.sin(a), Math.cos(a), Math.sin(a)]; });
/// The holder's pieces [radius, height] from `from` upwards; null without.
const holderOf = (pieces, from) => { const rings = []; let h = from; for (const [r, height] of pieces) { rings.push(...tube(r, h, h + height)); h += height; } return rings.length ? revolved(rings) : null; };

// --- WebGL 2: points are taken to the eye by R * p + t ---
// Drawn by the processor, smooth edges cost too much: they are only asked for where there is a graphics card.
let gl = null, smooth = true, G = null, far = 1;
if (!location.hash.includes("2d")) gl = glCanvas.getContext("webgl2", { antialias: true, alpha: false, failIfMajorPerformanceCaveat: true }) || glCanvas.getContext("webgl2", { antialias: smooth = false, alpha: false });
function setupGl() {
  const shader = (type, text) => { const s = gl.createShader(type); gl.shaderSource(s, "#version 300 es\nprecision highp float;\n" + text); gl.compileShader(s); if (!gl.getShaderParameter(s, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(s)); return s; };
  const program = (vs, fs) => { const p = gl.createProgram(); gl.attachShader(p, shader(gl.VERTEX_SHADER, vs)); gl.attachShader(p, shader(gl.FRAGMENT_SHADER, fs)); gl.linkProgram(p); if (!gl.getProgramParameter(p, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(p));
    const u = {}; for (let i = 0; i < gl.getProgramParameter(p, gl.ACTIVE_UNIFORMS); ++i) { const a = gl.getActiveUniform(p, i); u[a.name] = gl.getUniformLocation(p, a.name); } const at = {}; for (let i = 0; i < gl.getProgramParameter(p, gl.ACTIVE_ATTRIBUTES); ++i) { const a = gl.getActiveAttrib(p, i), l = gl.getAttribLocation(p, a.name); if (l >= 0) at[a.name] = l; } return { p, u, at }; };
  const surface = program(`in vec3 p; in vec3 n; uniform mat3 R; uniform vec3 t; uniform vec2 k; uniform float zr; out vec3 N;
    void main() { vec3 q = R * p + t; N = R * n; gl_Position = vec4(q.xy * k, -q.z / zr, 1.0); }`,
    `in vec3 N; uniform vec4 colour; uniform float shade; out vec4 o;
    void main() { float l = length(N); vec3 n = l > 0.0 ? N / l : vec3(0.0, 0.0, 1.0); if (n.z < 0.0) n = -n;
      float d = 1.06 - shade + shade * max(0.0, dot(n, normalize(vec3(-0.45, 0.62, 0.64)))), s = pow(max(0.0, dot(n, normalize(vec3(-0.26, 0.36, 0.9)))), 40.0);
      o = vec4(min(colour.rgb * d + 0.08 * s, 1.0), colour.a); }`);
  const line = program(`in vec3 a, b; in vec4 ca, cb; uniform mat3 R; uniform vec3 t; uniform vec2 k, pixels; uniform float zr, width, bias, gradient; uniform vec4 force; out vec4 C; out float along;
    void main() { vec3 qa = R * a + t, qb = R * b + t; vec2 sa = qa.xy * k * pixels, sb = qb.xy * k * pixels, d = sb - sa; float l = length(d); d = l > 1e-6 ? d / l : vec2(1.0, 0.0);
      float e = float(gl_VertexID & 1), side = float(gl_VertexID >> 1) * 2.0 - 1.0; vec4 cc = force.a > 0.0 ? force : cb; float w = cc.a > 0.3 && cc.a < 0.7 ? min(width, 0.5 * width + 0.4) : width;
      vec2 s = mix(sa, sb, e) + vec2(-d.y, d.x) * side * 0.5 * w + d * (e * 2.0 - 1.0) * 0.3 * w; along = e * l;
      C = force.a > 0.0 ? force : vec4(mix(cb.rgb, mix(ca.rgb, cb.rgb, e), gradient), cb.a);
      gl_Position = vec4(s / pixels, -mix(qa.z, qb.z, e) / zr - bias, 1.0); }`,
    `in vec4 C; in float along; uniform float dash; out vec4 o;
    void main() { if (C.a < 0.1) discard; if (C.a < 0.7 && C.a > 0.3 && fract(along / dash) > 0.55) discard; o = vec4(C.rgb, 1.0); }`);
  G = { surface, line, path: gl.createBuffer(), colours: gl.createBuffer(), drawn: null };
}
function glBuffer(data, kind) { const b = gl.createBuffer(); gl.bindBuffer(kind || gl.ARRAY_BUFFER, b); gl.bufferData(kind || gl.ARRAY_BUFFER, data, gl.STATIC_DRAW); return b; }
function attribute(at, buf, n, type, norm, stride, offset, divisor) { if (at === undefined || at < 0) return; gl.bindBuffer(gl.ARRAY_BUFFER, buf); gl.enableVertexAttribArray(at); gl.vertexAttribPointer(at, n, type, norm, stride, offset); gl.vertexAttribDivisor(at, divisor); }
const times = (M, v) => [0, 1, 2].map(i => M[i] * v[0] + M[i + 3] * v[1] + M[i + 6] * v[2]); // columns
const product = (A, B) => { const o = []; for (let c = 0; c < 3; ++c) o.push(...times(A, B.slice(3 * c, 3 * c + 3))); return o; };
const unitColour = (c, alpha) => [...c.map(v => v / 255), alpha === undefined ? 1 : alpha];
function use(prog, R9, t) { for (const p of [G.surface, G.line]) for (const at of Object.values(p.at)) { gl.vertexAttribDivisor(at, 0); gl.disableVertexAttribArray(at); } gl.useProgram(prog.p); gl.uniformMatrix3fv(prog.u.R, false, R9); gl.uniform3fv(prog.u.t, t); gl.uniform2f(prog.u.k, 2 * cam.scale / W, 2 * cam.scale / H); gl.uniform1f(prog.u.zr, far); if (prog === G.line) { gl.uniform2f(prog.u.pixels, W / 2, H / 2); gl.uniform1f(prog.u.dash, 7 * DPR()); gl.uniform1f(prog.u.gradient, 0); } }
/// Empty picture of depth `reach` about the camera: {R9 and t of the part (its turn included), px: a pixel and a half of depth}.
function beginGl(b, reach, path, colours) {
  if (coloursDirty) { gl.bindBuffer(gl.ARRAY_BUFFER, G.colours); gl.bufferData(gl.ARRAY_BUFFER, colours(), gl.DYNAMIC_DRAW); if (G.drawn !== path) { gl.bindBuffer(gl.ARRAY_BUFFER, G.path); gl.bufferData(gl.ARRAY_BUFFER, path, gl.STATIC_DRAW); G.drawn = path; } coloursDirty = false; }
  gl.viewport(0, 0, W, H); gl.clearColor(...unitColour(theme.sheet)); gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT); gl.enable(gl.DEPTH_TEST); gl.depthFunc(gl.LEQUAL); gl.disable(gl.BLEND);
  far = 2 * scene.size + reach + Math.hypot(...cam.c); const R9 = [b.r[0], b.u[0], b.w[0], b.r[1], b.u[1], b.w[1], b.r[2], b.u[2], b.w[2]], ca = Math.cos(b.a), sa = Math.sin(b.a);
  return { R9: product(R9, [1, 0, 0, 0, ca, sa, 0, -sa, ca]), t: times(R9, cam.c).map(v => -v), px: 1.5 * DPR() / cam.scale / far };
}
/// m.index: a grid's triangles; m.stride: bytes of a normal (4); m.shade: how dark the side away from the light is.
function glMesh(m, colour) {
  const s = G.surface; m.gp = m.gp || glBuffer(m.p); m.gn = m.gn || glBuffer(m.n); gl.uniform4fv(s.u.colour, colour); gl.uniform1f(s.u.shade, m.shade || 0.48); attribute(s.at.p, m.gp, 3, gl.FLOAT, false, 0, 0, 0); attribute(s.at.n, m.gn, 3, gl.BYTE, true, m.stride || 4, 0, 0);
  if (!m.index) { gl.drawArrays(gl.TRIANGLES, 0, m.count); return; }
  m.gi = m.gi || glBuffer(m.index, gl.ELEMENT_ARRAY_BUFFER); gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, m.gi); gl.drawElements(gl.TRIANGLES, m.index.length, gl.UNSIGNED_INT, 0);
}
/// Solid, pushed back a little so that lines on it show.
function glSolid(m, colour) { gl.enable(gl.POLYGON_OFFSET_FILL); gl.polygonOffset(1, 1); glMesh(m, colour); gl.disable(gl.POLYGON_OFFSET_FILL); }
/// [mesh, colour with alpha], seen through.
function glClear(list) { gl.enable(gl.BLEND); gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA); gl.enable(gl.CULL_FACE); for (const [m, colour] of list) if (m) glMesh(m, colour); gl.disable(gl.CULL_FACE); gl.disable(gl.BLEND); }
const TOOL_COLOUR = () => [...(dark() ? [0.72, 0.77, 0.84] : [0.42, 0.47, 0.54])], HOLDER_COLOUR = () => [...(dark() ? [0.55, 0.6, 0.7] : [0.55, 0.6, 0.68])];
/// Pairs of points in one colour. Colours are forced here: the arrays are switched off so that they need not be as long.
function glSegments(seg, colour, width, bias, keep) {
  if (!seg.length) return; const l = G.line, buf = seg.gl || glBuffer(seg); if (keep) seg.gl = buf; gl.uniform1f(l.u.width, width * DPR()); gl.uniform4f(l.u.force, ...unitColour(colour)); gl.uniform1f(l.u.bias, bias); attribute(l.at.a, buf, 3, gl.FLOAT, false, 24, 0, 1); attribute(l.at.b, buf, 3, gl.FLOAT, false, 24, 12, 1);
  for (const at of [l.at.ca, l.at.cb]) if (at !== undefined && at >= 0) { gl.disableVertexAttribArray(at); gl.vertexAttrib4f(at, 0, 0, 0, 1); } gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, seg.length / 6); if (!keep) gl.deleteBuffer(buf);
}
/// A piece of the path in its own colours (force: in one).
function glPath(first, count, width, force, bias) {
  if (count <= 0) return; const l = G.line; gl.uniform1f(l.u.width, width * DPR()); gl.uniform4fv(l.u.force, force || [0, 0, 0, 0]); gl.uniform1f(l.u.bias, bias);
  attribute(l.at.a, G.path, 3, gl.FLOAT, false, 12, 12 * first, 1); attribute(l.at.b, G.path, 3, gl.FLOAT, false, 12, 12 * first + 12, 1); attribute(l.at.ca, G.colours, 4, gl.UNSIGNED_BYTE, true, 4, 4 * first, 1); attribute(l.at.cb, G.colours, 4, gl.UNSIGNED_BYTE, true, 4, 4 * first + 4, 1); gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
}
/// Depth of the nearest triangle under a pixel.
function meshDepth(m, x, y, b) {
  let best = -Infinity; const s = new Float32Array(9);
  for (let i = 0; i < m.count; i += 3) {
    for (let k = 0; k < 3; ++k) s.set(project(m.p.subarray(3 * (i + k), 3 * (i + k) + 3), b), 3 * k);
    const ax = s[0] - x, ay = s[1] - y, bx = s[3] - x, by = s[4] - y, cx = s[6] - x, cy = s[7] - y, u = bx * cy - by * cx, v = cx * ay - cy * ax, w = ax * by - ay * bx; if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) continue;
    const t = u + v + w; if (t !== 0) best = Math.max(best, (u * s[2] + v * s[5] + w * s[8]) / t);
  }
  return best;
}
/// Part of the way from p to q (pixels) that is nearest to (x, y), and how near.
function nearOn(p, q, x, y) { const dx = q[0] - p[0], dy = q[1] - p[1], l = dx * dx + dy * dy, f = l ? clamp(((x - p[0]) * dx + (y - p[1]) * dy) / l, 0, 1) : 0; return [f, Math.hypot(x - p[0] - f * dx, y - p[1] - f * dy)]; }
/// The colours of a path without WebGL: strokes of one colour each, point by point.
function plainPath(g, P, C, from, last, b, widthOf) {
  const k = DPR(); let key = -1, open = false, prev = null;
  for (let i = from; i < last; ++i) {
    const q = project(P.subarray(3 * i, 3 * i + 3), b), id = (C[4 * i] << 16 | C[4 * i + 1] << 8 | C[4 * i + 2]) * 4 + (C[4 * i + 3] >> 6), quick = C[4 * i + 3] === 128;
    if (id !== key) { if (open) g.stroke(); g.beginPath(); if (prev) g.moveTo(prev[0], prev[1]); g.setLineDash(quick ? [5 * k, 4 * k] : []); g.lineWidth = widthOf(quick) * k; g.strokeStyle = "rgb(" + C[4 * i] + "," + C[4 * i + 1] + "," + C[4 * i + 2] + ")"; key = id; }
    open = C[4 * i + 3] > 0; if (open) g.lineTo(q[0], q[1]); else key = -1; prev = q;
  }
  if (open) g.stroke(); g.setLineDash([]);
}

// --- tables ---
function summary() { const s = $("sum"); return (name, value) => { s.append(s.childNodes.length ? " \u00b7 " : "", name + " "); s.append(el("b", "", value)); }; }
function go(e, f) { e.tabIndex = 0; e.onclick = f; e.onkeydown = k => { if (k.key === "Enter") f(); }; }
function gridTable(head) { const d = el("div", "wide"), t = el("table", "grid"), tr = el("tr"); for (const h of head) tr.append(el("th", "", h)); t.append(tr); d.append(t); return [d, t]; }
/// head(name) begins a table of two columns, row(name, value) adds to it.
function twoColumns(box) { let table = null; return { head: name => { box.append(el("h2", "", name)); table = el("table"); box.append(table); }, row: (name, value) => { const tr = el("tr"); tr.append(el("td", "", name), el("td", "", value)); table.append(tr); } }; }
// Keys of the JSON reports: the unit at their end is written behind the value instead.
const UNITS = [["_mm", " mm"], ["_deg", "\u00b0"], ["_s", " s"]];
function keyed(f) { const u = UNITS.find(q => f[1].endsWith(q[0])); return [(u ? f[1].slice(0, -u[0].length) : f[1]).replace(/_/g, " "), u && isFinite(+f[2]) ? +(+f[2]).toFixed(5) + u[1] : f[2]]; }
function figureRows(t, shown) { let group = null; for (const f of D.figures) { if (f[0] !== group) { group = f[0]; t.head(group); } t.row(...shown(f)); } }
function commandBox(box) { box.append(el("h2", "", "Command")); box.append(el("div", "cmd", D.command)); }
function tabCount(name, title, n) { document.querySelector('[data-tab="' + name + '"]').textContent = title + (n ? " (" + n + ")" : ""); }
/// Of a kind that comes often, five are shown and the rest is folded away.
function messages(showAt) {
  const w = $("tab-warnings"); if (!D.warnings.length) w.append(el("p", "ok", "Nothing was repaired, assumed or left out."));
  const order = [...D.warnings].sort((a, b) => (a.severity === b.severity ? 0 : a.severity === "left_out" ? -1 : 1)), total = new Map(), seen = new Map(), folds = new Map();
  for (const m of order) total.set(m.code, (total.get(m.code) || 0) + 1);
  for (const m of order) {
    const nth = (seen.get(m.code) || 0) + 1; seen.set(m.code, nth); let into = w;
    if (nth > 5 && total.get(m.code) > 6) { if (!folds.has(m.code)) { const d = el("details"), s = el("summary", "", (total.get(m.code) - 5) + " more: " + m.code); d.append(s); w.append(d); folds.set(m.code, d); } into = folds.get(m.code); }
    const e = el("div", "w " + m.severity); e.append(m.message + " "); if (m.entity) e.append(el("code", "", m.entity + " ")); e.append(el("code", "", m.code)); if (m.position) { e.dataset.at = "1"; e.title = "Show the place"; go(e, () => showAt(m.position)); } into.append(e);
  }
  if (D.warningCount > D.warnings.length) w.append(el("p", "ok", (D.warningCount - D.warnings.length) + " more messages"));
  tabCount("warnings", "Messages", D.warningCount);
}
let ncBuilt = false; const ncLines = D.nc.split("\n");
function buildNc() {
  if (ncBuilt) return; ncBuilt = true; const box = $("nc"), most = 20000;
  ncLines.slice(0, most).forEach((t, i) => { if (i === ncLines.length - 1 && !t) return; const d = el("div", "", t || " "); d.dataset.n = i + 1; box.append(d); });
  const listed = Math.min(most, ncLines.length - (ncLines[ncLines.length - 1] ? 0 : 1)), rest = D.ncLines - listed; if (rest > 0) box.append(el("div", "", "... " + rest + " more lines"));
}
const TABS = [...document.querySelectorAll(".tabs button")].map(b => b.dataset.tab);
/// What else happens when a tab opens, by its name.
const tabOpens = { nc: buildNc };
function openTab(name) { for (const c of document.querySelectorAll(".tabs button")) { c.setAttribute("aria-selected", c.dataset.tab === name); c.tabIndex = c.dataset.tab === name ? 0 : -1; } for (const t of TABS) $("tab-" + t).hidden = t !== name; if (tabOpens[name]) tabOpens[name](); }
for (const b of document.querySelectorAll(".tabs button")) { b.onclick = () => openTab(b.dataset.tab); b.onkeydown = e => { const d = e.key === "ArrowRight" ? 1 : e.key === "ArrowLeft" ? -1 : 0; if (!d) return; const n = TABS[(TABS.indexOf(b.dataset.tab) + d + TABS.length) % TABS.length]; openTab(n); document.querySelector('[data-tab="' + n + '"]').focus(); }; }
/// A long table that grows by a button: `add(i)` gives the row of number i.
function growing(box, table, all, step, add) { let shown = 0; const b = el("button", ""); const more = () => { for (const end = Math.min(all, shown + step); shown < end; ++shown) table.append(add(shown)); b.hidden = shown >= all; b.textContent = "Show more (" + (all - shown) + ")"; }; b.onclick = more; box.append(b); more(); }
function markOnly(tab, selector) { for (const e of document.querySelectorAll("#" + tab + " .on")) e.classList.remove("on"); const e = selector ? document.querySelector("#" + tab + " " + selector) : null; if (e) e.classList.add("on"); return e; }
function reveal(box, e) { // up and down only, and only inside its own box
  const a = box.getBoundingClientRect(), b = e.getBoundingClientRect(), head = 48; if (b.top < a.top + head) box.scrollTop += b.top - a.top - head; else if (b.bottom > a.bottom - 20) box.scrollTop += b.bottom - a.bottom + 20; }

// --- input ---
/// Drag turns, shift and drag or two fingers move, wheel and pinch zoom, a click picks. `keys`: of the page, beside 0, + and -, arrows on the stage; views: names for the keys 1, 2, ...
function orbitInput(pick, views, keys) {
  const pointers = new Map(), at = e => { const r = canvas.getBoundingClientRect(), k = DPR(); return [(e.clientX - r.left) * k, (e.clientY - r.top) * k]; }; let drag = null;
  canvas.onpointerdown = e => { canvas.setPointerCapture(e.pointerId); pointers.set(e.pointerId, at(e)); drag = { from: at(e), moved: pointers.size > 1, pan: e.shiftKey || e.button === 1 || e.button === 2 }; canvas.classList.add("drag"); };
  canvas.onpointermove = e => {
    const p = at(e); if (!pointers.has(e.pointerId) || !drag) return; const q = pointers.get(e.pointerId);
    if (pointers.size === 2) { const [a, b] = [...pointers.values()]; pointers.set(e.pointerId, p); const [c, d] = [...pointers.values()]; pan((c[0] + d[0] - a[0] - b[0]) / 2, (c[1] + d[1] - a[1] - b[1]) / 2); zoom(Math.hypot(c[0] - d[0], c[1] - d[1]) / Math.max(1, Math.hypot(a[0] - b[0], a[1] - b[1])), (c[0] + d[0]) / 2, (c[1] + d[1]) / 2); drag.moved = true; return; }
    if (Math.hypot(p[0] - drag.from[0], p[1] - drag.from[1]) > 4 * DPR()) drag.moved = true; if (drag.moved) { if (drag.pan || e.shiftKey) pan(p[0] - q[0], p[1] - q[1]); else turn((p[0] - q[0]) * 0.4 / DPR(), (p[1] - q[1]) * 0.4 / DPR()); } pointers.set(e.pointerId, p); };
  canvas.onpointerup = canvas.onpointercancel = e => { const p = at(e); if (drag && !drag.moved && e.type === "pointerup" && e.button === 0) pick(p[0], p[1]); pointers.delete(e.pointerId); if (!pointers.size) { drag = null; canvas.classList.remove("drag"); } };
  canvas.oncontextmenu = e => e.preventDefault();
  canvas.addEventListener("wheel", e => { e.preventDefault(); const p = at(e); zoom(Math.exp(-e.deltaY * (e.deltaMode ? 0.05 : 0.0016)), p[0], p[1]); }, { passive: false });
  canvas.ondblclick = fit; $("fit").onclick = () => { target = null; fit(); }; for (const b of document.querySelectorAll("[data-view]")) b.onclick = () => look(b.dataset.view);
  const all = { "0": () => { target = null; fit(); }, "+": () => zoom(1.25, W / 2, H / 2), "-": () => zoom(0.8, W / 2, H / 2), ...keys }; views.forEach((v, i) => { all[i + 1] = () => look(v); });
  addEventListener("keydown", e => {
    if (e.ctrlKey || e.metaKey || e.altKey || /INPUT|SELECT|BUTTON/.test(e.target.tagName)) return; if (all[e.key]) { all[e.key](); e.preventDefault(); return; }
    if (e.target !== canvas || !e.key.startsWith("Arrow")) return; const d = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[e.key]; if (!d) return; e.preventDefault(); if (e.shiftKey) pan(30 * d[0] * DPR(), 30 * d[1] * DPR()); else turn(5 * d[0], 5 * d[1]); });
}
/// Wheel over a chart: `zoomBy(factor, event)`.
function wheelZoom(c, zoomBy) { c.addEventListener("wheel", e => { e.preventDefault(); zoomBy(Math.exp(-e.deltaY * (e.deltaMode ? 0.05 : 0.0016)), e); }, { passive: false }); }
/// Keys that belong to one element.
function ownKeys(c, keys) { c.onkeydown = e => { if (keys[e.key]) { keys[e.key](e); e.preventDefault(); e.stopPropagation(); } }; }
/// The way played: the button "run", the menu "speed" with its texts. `step(seconds * speed)`: false at the end.
function player(speeds, name, chosen, begin, step) {
  for (const s of speeds) { const o = el("option", "", name(s)); o.value = s; $("speed").append(o); } $("speed").value = chosen; let playing = false, last = 0;
  const play = on => { playing = on && begin(); $("run").textContent = playing ? "Pause" : "Play"; last = 0; }; $("run").onclick = () => play(!playing);
  return { toggle: () => play(!playing), frame: ms => { if (!playing) return; if (last && !step((ms - last) / 1000 * +$("speed").value)) play(false); last = ms; } };
}
/// Begins: WebGL where it can be had (else `plain` says what is missing), the picture as large as its box, frames for ever.
function start(plainText, draw, frame) {
  const plain = () => { $("note").textContent = plainText; };
  if (gl) { try { setupGl(); } catch (e) { gl = null; } } if (!gl) plain();
  else glCanvas.addEventListener("webglcontextlost", e => { e.preventDefault(); gl = null; $("gl").hidden = true; plain(); dirty = true; });
  // Drawn at once: a canvas is empty after a change of its size.
  new ResizeObserver(() => { const keep = userMoved; size(); if (!keep) fit(); dirty = false; draw(); }).observe(stage);
  size(); fit(); const each = ms => { frame(ms); if (dirty) { dirty = false; draw(); } requestAnimationFrame(each); }; requestAnimationFrame(each);
}
document.querySelector("h1").textContent = D.title;

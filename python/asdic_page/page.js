// The page of a ping file: panels on canvases. A panel knows its axes, draws its data once and what is
// chosen (a time, a target, a ping) on a canvas above. Nothing is fetched: data stand in the page.
"use strict";

const D = JSON.parse(document.getElementById("data").textContent);
const S = {view: 0, time: null, pinned: false, target: null};
const T = {lo: 0, hi: 1, full: [0, 1]};          // the time axis that panels share
const panels = [];
const $ = (id) => document.getElementById(id);
const view = () => D.views[S.view];

// ------------------------------------------------------------------ words and numbers

function text(value, figures = 4) {
  if (value === null || !isFinite(value)) return "–";
  const digits = Math.max(0, figures - 1 - Math.floor(Math.log10(Math.abs(value) || 1)));
  return value.toFixed(Math.min(digits, 6)).replace("-", "−");
}
const seconds = (t) => t.toFixed(3) + " s";
const decibels = (v, unit) => (v === null ? "no value" : v.toFixed(1).replace("-", "−") + " " + unit);
const distance = (r) => (Math.abs(r) >= 1000 ? (r / 1000).toFixed(3).replace("-", "−") + " km"
                                             : r.toFixed(1).replace("-", "−") + " m");
const turned = (b) => ((b % 360) + 360) % 360;
const bearing = (b) => turned(b).toFixed(1).replace(/^360\.0/, "0.0") + "°";
const targetName = (i) => D.targets[i] || "target " + (i + 1);
const isDark = () => getComputedStyle(document.documentElement).colorScheme.includes("dark");
const themed = () => D.themes[isDark() ? "dark" : "light"];
const targetColour = (i) => (i >= 0 ? themed().targets[i % themed().targets.length] : css("--quiet"));
const foundBy = (i) => (i >= 0 ? "echo of " + targetName(i)
                        : i === -2 ? "the transmitter's own sound"
                        : i === -3 ? "of another ping" : "false alarm");
const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** Round steps that divide a span into about `count`. */
function ticks(lo, hi, count) {
  const rough = (hi - lo) / Math.max(count, 1);
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((k) => k * power).find((s) => s >= rough) || 10 * power;
  const found = [];
  for (let k = Math.ceil(lo / step - 1e-9); k * step <= hi + 1e-9 * step; ++k)
    found.push([k * step, (Math.abs(k * step) < 1e-12 * step ? 0 : k * step)
      .toFixed(Math.max(0, -Math.floor(Math.log10(step) + 1e-9))).replace("-", "−")]);
  return found;
}

// ------------------------------------------------------------------ images

const LUT = new Uint32Array(D.colours.map((c) => {
  const n = parseInt(c, 16);
  return (0xff000000 | ((n & 255) << 16) | (n & 0xff00) | (n >> 16)) >>> 0;
}));
const colourOf = (v, [lo, hi]) => LUT[Math.max(0, Math.min(255, Math.floor(256 * (v - lo) / (hi - lo))))];

/** A matrix of the page: 16 bits a value. */
class Cells {
  constructor(packed) {
    const bytes = Uint8Array.from(atob(packed.data), (c) => c.charCodeAt(0));
    this.values = new Uint16Array(bytes.buffer);
    Object.assign(this, {rows: packed.rows, columns: packed.columns, low: packed.low,
                         step: packed.step});
  }
  whole(row, column) { return this.values[row * this.columns + column]; }
  value(row, column) {
    if (row < 0 || column < 0 || row >= this.rows || column >= this.columns) return null;
    const n = this.whole(row, column);
    return n === 65535 ? null : this.low + n * this.step;
  }
}
function cellsOf(holder, name = "cells") {
  const kept = "_" + name;
  if (!holder[kept]) Object.defineProperty(holder, kept, {value: new Cells(holder[name])});
  return holder[kept];
}

/** Index k with edges[k] <= v < edges[k + 1]; rising edges; −1 outside. */
function between(edges, v) {
  let a = 0, b = edges.length - 1;
  if (!(v >= edges[0] && v <= edges[b])) return -1;
  while (b - a > 1) { const m = (a + b) >> 1; if (edges[m] <= v) a = m; else b = m; }
  return a;
}
function nearest(values, v) {
  let best = -1, least = Infinity;
  for (let i = 0; i < values.length; ++i) {
    const off = Math.abs(values[i] - v);
    if (off < least) { least = off; best = i; }
  }
  return best;
}

// ------------------------------------------------------------------ axes of angles

const radians = (d) => d * Math.PI / 180, degrees = (r) => r * 180 / Math.PI;
const clamp = (u) => Math.max(-1, Math.min(1, u));

/** The true bearings of a line's coordinate: on its first side, where they rise with it, and on the other. */
function sides(axis, u) {
  const off = degrees(Math.acos(clamp(-u)));
  return [turned(axis.ahead + off), turned(axis.ahead - off)];
}
/** The coordinate of a true bearing. */
const cosine = (axis, b) => -Math.cos(radians(b - axis.ahead));

/** What a coordinate of an axis is called, for people. */
function told(axis, v) {
  if (axis.kind === "cosine") {
    const [a, b] = sides(axis, v);
    return Math.abs(a - b) < 0.05 ? `${bearing(a)} true` : `${bearing(a)} or ${bearing(b)} true`;
  }
  if (axis.kind === "sine") {
    const up = degrees(Math.asin(clamp(axis.upwards * v)));
    return `look ${up >= 0 ? "+" : "−"}${Math.abs(up).toFixed(1)}° (up positive)`;
  }
  if (axis.kind === "bearing") return `${bearing(v)} true`;
  if (axis.unit === "Hz") {
    const shift = `${v >= 0 ? "+" : "−"}${Math.abs(v).toFixed(2)} Hz`;
    return axis.shift ? `${shift} (closing at ${text(v / axis.shift, 3)} m/s)` : shift;
  }
  return axis.label === "ping" ? `ping ${Math.round(v)}` : `${text(v)} ${axis.unit}`;
}

function axisTicks(axis, lo, hi, pixels) {
  if (axis.kind === "linear") {
    const found = ticks(lo, hi, pixels / 40);
    return axis.label === "ping" ? found.filter(([v]) => Number.isInteger(v)) : found;
  }
  const wanted = Math.max(3, pixels / 26);
  const place = axis.kind === "cosine" ? (d) => -Math.cos(radians(d))
              : axis.kind === "sine" ? (d) => axis.upwards * Math.sin(radians(d)) : (d) => d;
  const name = axis.kind === "cosine"
    ? (d) => `${text(turned(axis.ahead + d), 4).replace(/\.0+$/, "")}°`
    : axis.kind === "sine" ? (d) => (d > 0 ? "+" : "") + String(d).replace("-", "−") + "°"
    : (d) => `${d}°`;
  const [first, last] = axis.kind === "cosine" ? [0, 180] : axis.kind === "sine" ? [-90, 90] : [0, 360];
  for (const step of [0.5, 1, 2, 5, 10, 15, 30, 45, 90]) {
    const found = [];
    // true bearings of a line are round numbers, whatever its own bearing is
    const shift = axis.kind === "cosine" ? turned(-axis.ahead) % step : 0;
    for (let d = first + shift; d <= last + 1e-9; d += step) {
      const v = place(d);
      if (v >= lo - 1e-9 && v <= hi + 1e-9) found.push([v, name(Math.round(d * 1000) / 1000)]);
    }
    if (found.length <= wanted) {
      found.sort((a, b) => a[0] - b[0]);
      const gap = (hi - lo) * 13 / pixels;
      return found.filter((t, k) => k === 0 || k === found.length - 1
        ? k === 0 || t[0] - found[0][0] >= gap
        : t[0] - found[k - 1][0] >= gap && found[found.length - 1][0] - t[0] >= gap);
    }
  }
  return [];
}

// ------------------------------------------------------------------ a panel

class Panel {
  constructor(name, about, options = {}) {
    Object.assign(this, {name, about, flip: false, x: T, height: 260, left: 66, right: 84, top: 8,
                         bottom: 36, cursor: null}, options);
    this.y = {lo: 0, hi: 1, full: [0, 1]};
    this.section = document.createElement("section");
    this.section.className = "panel";
    this.section.innerHTML = '<header><h2></h2><button type="button" class="reset">whole</button>' +
      '</header><div class="stage"><canvas class="base"></canvas><canvas class="over"></canvas></div>' +
      '<p class="about"></p>';
    this.section.querySelector("h2").textContent = name;
    this.section.querySelector(".about").textContent = about;
    this.stage = this.section.querySelector(".stage");
    [this.base, this.over] = this.section.querySelectorAll("canvas");
    this.stage.tabIndex = 0;
    this.stage.setAttribute("role", "application");
    this.stage.setAttribute("aria-label", `${name}. ${about} Arrows move the cursor, plus and minus ` +
      "zoom, 0 shows all, Enter chooses, Escape lets go.");
    this.stage.style.height = this.height + "px";
    this.section.querySelector(".reset").addEventListener("click", () => this.reset());
    $(options.place || "time").append(this.section);
    this.listen();
    panels.push(this);
  }

  // -------- places
  get box() {
    return {x: this.left, y: this.top, w: Math.max(this.wide - this.left - this.right, 10),
            h: Math.max(this.high - this.top - this.bottom, 10)};
  }
  px(x) { const b = this.box; return b.x + b.w * (x - this.x.lo) / (this.x.hi - this.x.lo); }
  py(y) {
    const b = this.box, part = (y - this.y.lo) / (this.y.hi - this.y.lo);
    return this.flip ? b.y + b.h * part : b.y + b.h * (1 - part);
  }
  dx(px) { const b = this.box; return this.x.lo + (this.x.hi - this.x.lo) * (px - b.x) / b.w; }
  dy(py) {
    const b = this.box, part = (py - b.y) / b.h;
    return this.y.lo + (this.y.hi - this.y.lo) * (this.flip ? part : 1 - part);
  }
  inside(px, py) {
    const b = this.box;
    return px >= b.x && px <= b.x + b.w && py >= b.y && py <= b.y + b.h;
  }
  get shown() { return !this.section.hidden; }

  // -------- drawing
  resize() {
    if (this.square) this.stage.style.height = Math.min(460, Math.max(240, this.stage.clientWidth - this.left - this.right + 44)) + "px";
    this.wide = this.stage.clientWidth;
    this.high = this.stage.clientHeight;
    this.scale = window.devicePixelRatio || 1;
    for (const canvas of [this.base, this.over]) {
      canvas.width = Math.round(this.wide * this.scale);
      canvas.height = Math.round(this.high * this.scale);
    }
  }
  context(canvas) {
    const c = canvas.getContext("2d");
    c.setTransform(this.scale, 0, 0, this.scale, 0, 0);
    c.clearRect(0, 0, this.wide, this.high);
    c.font = "12px system-ui, 'DejaVu Sans', sans-serif";
    c.lineJoin = "round";
    return c;
  }
  clipped(c, draw) {
    const b = this.box;
    c.save();
    c.beginPath();
    c.rect(b.x, b.y, b.w, b.h);
    c.clip();
    draw();
    c.restore();
  }
  fit() {}
  draw() {
    if (!this.shown || !this.wide) return;
    this.fit();
    const c = this.context(this.base), b = this.box;
    c.fillStyle = css("--field");
    c.fillRect(b.x, b.y, b.w, b.h);
    this.clipped(c, () => this.drawData(c));
    this.drawAxes(c);
    this.section.querySelector(".reset").disabled = !this.zoomed;
    this.drawOver();
  }
  get zoomed() {
    return [this.x, this.y].some((a) => a.lo !== a.full[0] || a.hi !== a.full[1]);
  }
  xTicks() { return ticks(this.x.lo, this.x.hi, this.box.w / 60); }
  yTicks() { return ticks(this.y.lo, this.y.hi, this.box.h / 40); }
  drawAxes(c) {
    const b = this.box;
    c.strokeStyle = css("--line");
    c.fillStyle = css("--ink");
    c.lineWidth = 1;
    c.strokeRect(b.x - 0.5, b.y - 0.5, b.w + 1, b.h + 1);
    c.textAlign = "center";
    c.textBaseline = "top";
    for (const [v, name] of this.xTicks()) {
      const x = this.px(v);
      c.fillRect(Math.round(x), b.y + b.h, 1, 4);
      c.fillText(name, x, b.y + b.h + 6);
    }
    c.fillText(this.xLabel, b.x + b.w / 2, b.y + b.h + 21);
    c.textAlign = "right";
    c.textBaseline = "middle";
    for (const [v, name] of this.yTicks()) {
      const y = this.py(v);
      if (y < b.y - 1 || y > b.y + b.h + 1) continue;
      c.fillRect(this.tickAt - 4, Math.round(y), 4, 1);
      c.fillText(name, this.tickAt - 7, y);
    }
    c.save();
    c.translate(11, b.y + b.h / 2);
    c.rotate(-Math.PI / 2);
    c.textAlign = "center";
    c.fillText(this.yLabel, 0, 0, b.h + 20);
    c.restore();
  }
  get tickAt() { return this.box.x; }
  get xLabel() { return "time after the ping / s"; }
  drawOver() {
    if (!this.shown || !this.wide) return;
    const c = this.context(this.over);
    this.clipped(c, () => this.drawChosen(c));
    if (this.drag && this.drag.moved) {
      const {x0, y0, x1, y1} = this.drag, b = this.box, flat = this.drag.flat;
      c.fillStyle = css("--choice") + "30";
      c.strokeStyle = css("--choice");
      const r = flat ? [x0, b.y, x1 - x0, b.h] : [x0, y0, x1 - x0, y1 - y0];
      c.fillRect(...r);
      c.strokeRect(...r);
    }
    if (this.cursor && document.activeElement === this.stage) {
      c.strokeStyle = css("--choice");
      c.lineWidth = 1.5;
      c.beginPath();
      c.arc(this.px(this.cursor[0]), this.py(this.cursor[1]), 6, 0, 7);
      c.stroke();
    }
  }
  timeLine(c) {
    if (S.time === null) return;
    const x = this.px(S.time), b = this.box;
    c.strokeStyle = css("--choice");
    c.lineWidth = S.pinned ? 2 : 1;
    c.beginPath();
    c.moveTo(x, b.y);
    c.lineTo(x, b.y + b.h);
    c.stroke();
  }

  // -------- zoom
  get sharesTime() { return this.x === T; }
  changed() { if (this.sharesTime) drawAll(); else this.draw(); }
  limit(axis) {
    const [a, b] = axis.full, least = (b - a) * 1e-5;
    let span = Math.max(Math.min(axis.hi - axis.lo, b - a), least);
    let lo = Math.max(a, Math.min(axis.lo, b - span));
    if (span === b - a) lo = a;
    axis.lo = lo;
    axis.hi = lo + span;
    if (lo === a && Math.abs(axis.hi - b) < 1e-9 * (b - a)) axis.hi = b;
  }
  zoomAt(factor, x, y, which = "both") {
    const change = (axis, at) => {
      axis.lo = at - (at - axis.lo) * factor;
      axis.hi = at + (axis.hi - at) * factor;
      this.limit(axis);
    };
    if (which !== "y") change(this.x, x);
    if (which !== "x") change(this.y, y);
    this.changed();
  }
  zoomTo(x0, x1, y0, y1) {
    [this.x.lo, this.x.hi] = [Math.min(x0, x1), Math.max(x0, x1)];
    this.limit(this.x);
    if (y0 !== null) {
      [this.y.lo, this.y.hi] = [Math.min(y0, y1), Math.max(y0, y1)];
      this.limit(this.y);
    }
    this.changed();
  }
  shift(x, y) {
    for (const [axis, by] of [[this.x, x], [this.y, y]]) {
      axis.lo += by;
      axis.hi += by;
      this.limit(axis);
    }
    this.changed();
  }
  reset() {
    for (const axis of [this.x, this.y]) [axis.lo, axis.hi] = axis.full;
    this.changed();
  }

  // -------- pointer and keys
  listen() {
    const at = (e) => { const r = this.stage.getBoundingClientRect(); return [e.clientX - r.left, e.clientY - r.top]; };
    this.stage.addEventListener("wheel", (e) => {
      const [x, y] = at(e);
      if (!this.inside(x, y)) return;
      e.preventDefault();
      const factor = Math.exp(0.0015 * Math.max(-300, Math.min(300, e.deltaY || e.deltaX)));
      this.zoomAt(factor, this.dx(x), this.dy(y), e.shiftKey ? "y" : this.wheel || "both");
      this.hover(x, y);
    }, {passive: false});
    this.stage.addEventListener("pointerdown", (e) => {
      const [x, y] = at(e);
      if (e.button !== 0 || !this.inside(x, y)) return;
      this.stage.focus({preventScroll: true});
      this.stage.setPointerCapture(e.pointerId);
      this.drag = {x0: x, y0: y, x1: x, y1: y, moved: false, pan: e.shiftKey || e.pointerType === "touch"};
    });
    this.stage.addEventListener("pointermove", (e) => {
      const [x, y] = at(e), d = this.drag;
      if (!d) { this.hover(x, y, e.clientX, e.clientY); return; }
      if (d.pan) {
        if (Math.hypot(x - d.x1, y - d.y1) > 0) this.shift(this.dx(d.x1) - this.dx(x), this.dy(d.y1) - this.dy(y));
        d.panned = d.panned || Math.hypot(x - d.x0, y - d.y0) > 5;
        [d.x1, d.y1] = [x, y];
        return;
      }
      const b = this.box;
      d.x1 = Math.max(b.x, Math.min(b.x + b.w, x));
      d.y1 = Math.max(b.y, Math.min(b.y + b.h, y));
      d.moved = d.moved || Math.hypot(d.x1 - d.x0, d.y1 - d.y0) > 5;
      d.flat = Math.abs(d.y1 - d.y0) < 10;
      this.drawOver();
    });
    this.stage.addEventListener("pointerup", (e) => {
      const d = this.drag, [x, y] = at(e);
      this.drag = null;
      if (!d) return;
      if (d.moved && Math.abs(d.x1 - d.x0) > 3)
        this.zoomTo(this.dx(d.x0), this.dx(d.x1), d.flat ? null : this.dy(d.y0), d.flat ? null : this.dy(d.y1));
      else if (!d.panned && !d.moved) this.choose(x, y);
      else this.drawOver();
    });
    this.stage.addEventListener("pointercancel", () => { this.drag = null; this.drawOver(); });
    this.stage.addEventListener("pointerleave", () => { if (!this.drag) { tip(null); letGoOfTime(); } });
    this.stage.addEventListener("dblclick", () => this.reset());
    this.stage.addEventListener("blur", () => { this.cursor = null; tip(null); this.drawOver(); });
    this.stage.addEventListener("keydown", (e) => this.key(e));
  }
  key(e) {
    if (e.ctrlKey || e.metaKey || e.altKey) return;
    const by = e.shiftKey ? 0.1 : 0.01;
    const step = {ArrowLeft: [-by, 0], ArrowRight: [by, 0], ArrowUp: [0, by], ArrowDown: [0, -by]}[e.key];
    const here = () => this.cursor || [S.time !== null && this.sharesTime ? S.time : (this.x.lo + this.x.hi) / 2,
                                       (this.y.lo + this.y.hi) / 2];
    if (step) {
      const c = here(), up = this.flip ? -1 : 1;
      this.cursor = [c[0] + step[0] * (this.x.hi - this.x.lo), c[1] + up * step[1] * (this.y.hi - this.y.lo)];
      this.cursor[0] = Math.max(this.x.lo, Math.min(this.x.hi, this.cursor[0]));
      this.cursor[1] = Math.max(this.y.lo, Math.min(this.y.hi, this.cursor[1]));
      this.hoverCursor();
    } else if (e.key === "+" || e.key === "=") { this.zoomAt(0.7, ...here()); this.hoverCursor(); }
    else if (e.key === "-") { this.zoomAt(1 / 0.7, ...here()); this.hoverCursor(); }
    else if (e.key === "0" || e.key === "Home") this.reset();
    else if (e.key === "Enter" || e.key === " ") { const c = here(); this.choose(this.px(c[0]), this.py(c[1])); }
    else return;
    e.preventDefault();
  }
  hoverCursor() {
    if (!this.cursor) return;
    const r = this.stage.getBoundingClientRect(), x = this.px(this.cursor[0]), y = this.py(this.cursor[1]);
    this.hover(x, y, r.left + x, r.top + y);
    this.drawOver();
  }
  hover(px, py, clientX, clientY) {
    if (!this.inside(px, py)) { tip(null); letGoOfTime(); return; }
    const found = this.pick(px, py);
    if (found && found.time !== undefined && found.time !== null && !S.pinned) { S.time = found.time; drawOvers(); }
    tip(found && found.lines, clientX, clientY);
  }
  choose(px, py) {
    if (!this.inside(px, py)) return;
    const found = this.pick(px, py) || {};
    if (found.ping !== undefined) choosePing(found.ping);
    if (found.target !== undefined && found.target >= 0) chooseTarget(S.target === found.target ? null : found.target);
    else if (found.time !== undefined && found.time !== null) {
      S.pinned = !(S.pinned && Math.abs(this.px(S.time) - this.px(found.time)) < 4);
      S.time = found.time;
      drawOvers();
    }
  }
}

function faded(target) { return S.target !== null && S.target !== target; }

/** The circle of a detection: in a target's colour where it is its echo, small and white where not. */
function circle(c, x, y, target) {
  c.globalAlpha = faded(target) ? 0.3 : 1;
  const path = () => c.arc(x, y, target >= 0 ? 9 : 4.5, 0, 7);
  if (target >= 0) stroke(c, targetColour(target), S.target === target ? 3 : 1.8, path);
  else { c.strokeStyle = "#ffffff"; c.lineWidth = 1.2; c.beginPath(); path(); c.stroke(); }
  c.globalAlpha = 1;
}

/** A mark of the truth or of a detection, with a rim that shows on any colour. */
function stroke(c, colour, width, path) {
  for (const [style, more] of [[css("--rim"), 2.4], [colour, 0]]) {
    c.strokeStyle = style;
    c.lineWidth = width + more;
    c.beginPath();
    path();
    c.stroke();
  }
}

// ------------------------------------------------------------------ images over time

class TimeImage extends Panel {
  constructor(spec, options = {}) {
    super(spec.name, spec.about, options);
    this.take(spec);
  }
  take(spec) {
    this.spec = spec;
    this.section.hidden = !spec;
    if (!spec) return;
    this.cells = cellsOf(spec);
    this.flip = spec.axis.label === "ping";
    this.section.querySelector(".about").textContent = spec.about +
      (spec.joined ? ` Each cell is the largest of ${spec.joined} (up × along).` : "");
    const whole = [spec.y[0], spec.y[spec.y.length - 1]];
    if (spec.axis.kind === "cosine" || spec.axis.kind === "sine") { whole[0] = Math.max(whole[0], -1); whole[1] = Math.min(whole[1], 1); }
    this.y = {lo: whole[0], hi: whole[1], full: whole};
  }
  get yLabel() { return this.spec.axis.label + (this.spec.axis.unit ? " / " + this.spec.axis.unit : ""); }
  yTicks() { return axisTicks(this.spec.axis, this.y.lo, this.y.hi, this.box.h); }

  drawData(c) {
    const b = this.box, w = Math.round(b.w * this.scale), h = Math.round(b.h * this.scale);
    const picture = new ImageData(w, h), pixels = new Uint32Array(picture.data.buffer);
    const {first, step} = this.spec.x, {columns, rows, values, low} = this.cells, limits = this.spec.limits;
    const from = new Int32Array(w), to = new Int32Array(w);
    for (let i = 0; i < w; ++i) {
      const at = (k) => Math.floor((this.x.lo + (this.x.hi - this.x.lo) * k / w - first) / step);
      from[i] = at(i);
      to[i] = Math.max(at(i + 1) - 1, from[i]);
      if (to[i] >= columns) to[i] = columns - 1;
      if (from[i] < 0 && to[i] >= 0) from[i] = 0;
    }
    let last = null;
    for (let j = 0; j < h; ++j) {
      const edge = (k) => this.y.lo + (this.y.hi - this.y.lo) * (this.flip ? k / h : 1 - k / h);
      let r0 = between(this.spec.y, edge(j + 0.5)), r1 = r0;
      if (r0 >= 0) {
        const a = between(this.spec.y, edge(j)), e = between(this.spec.y, edge(j + 1));
        if (a >= 0 && e >= 0 && Math.abs(a - e) > 1) [r0, r1] = [Math.min(a, e) + 1, Math.max(a, e)];
      }
      const row = j * w;
      if (last && last[0] === r0 && last[1] === r1) { pixels.copyWithin(row, row - w, row); continue; }
      last = [r0, r1];
      if (r0 < 0) continue;
      for (let i = 0; i < w; ++i) {
        let most = -1;
        for (let k = from[i]; k <= to[i]; ++k)
          if (k >= 0) for (let r = r0; r <= r1 && r < rows; ++r) {
            const n = values[r * columns + k];
            if (n !== 65535 && n > most) most = n;
          }
        if (most >= 0) pixels[row + i] = colourOf(low + most * this.cells.step, limits);
      }
    }
    c.putImageData(picture, Math.round(b.x * this.scale), Math.round(b.y * this.scale));
  }
  drawAxes(c) {
    super.drawAxes(c);
    bar(c, this, this.spec.limits, this.spec.what, this.spec.unit);
  }
  drawChosen(c) {
    const long = view().duration;
    for (const m of this.spec.marks) {
      c.globalAlpha = faded(m.target) ? 0.25 : 1;
      stroke(c, targetColour(m.target), S.target === m.target ? 3.2 : 2, () => m.x.forEach((t, i) => {
        const x = this.px(t), y = this.py(m.y[i]);
        if (m.look === "bar") {
          const end = this.px(t + long);
          c.moveTo(x, y - 6); c.lineTo(x, y + 6); c.moveTo(x, y); c.lineTo(end, y);
          c.moveTo(end, y - 6); c.lineTo(end, y + 6);
        } else if (m.look === "stroke") {
          const half = Math.max(3, 0.38 * Math.abs(this.py(1) - this.py(0)));
          c.moveTo(x, y - half); c.lineTo(x, y + half);
        } else {
          c.moveTo(x - 5, y - 5); c.lineTo(x + 5, y + 5); c.moveTo(x - 5, y + 5); c.lineTo(x + 5, y - 5);
        }
      }));
    }
    c.globalAlpha = 1;
    const found = view().detections;
    if (this.spec.found && found) for (let i = 0; i < found.time.length; ++i)
      circle(c, this.px(found.time[i]), this.py(this.spec.found[i]), found.target[i]);
    if (this.spec.axis.label === "ping") {
      const y0 = this.py(view().ping - 0.5), y1 = this.py(view().ping + 0.5), b = this.box;
      c.strokeStyle = css("--choice");
      c.lineWidth = 2;
      c.strokeRect(b.x + 1, Math.min(y0, y1), b.w - 2, Math.abs(y1 - y0));
    }
    this.timeLine(c);
  }
  pick(px, py) {
    const x = this.dx(px), y = this.dy(py), {first, step} = this.spec.x;
    const column = Math.floor((x - first) / step), row = between(this.spec.y, y);
    const lines = [seconds(x), told(this.spec.axis, y),
                   `${this.spec.what}: ${decibels(this.cells.value(row, column), this.spec.unit)}`];
    const result = {lines, time: x, row, column, value: this.cells.value(row, column)};
    const found = view().detections;
    let least = 12;
    if (this.spec.found && found) for (let i = 0; i < found.time.length; ++i) {
      const off = Math.hypot(this.px(found.time[i]) - px, this.py(this.spec.found[i]) - py);
      if (off < least) { least = off; result.target = found.target[i]; result.detection = i; }
    }
    if (result.detection !== undefined) lines.push(...detectionLines(result.detection));
    least = 12;
    for (const m of this.spec.marks) for (let i = 0; i < m.x.length; ++i) {
      const end = this.px(m.x[i] + (m.look === "bar" ? view().duration : 0));
      const off = Math.hypot(Math.max(this.px(m.x[i]) - px, px - end, 0), this.py(m.y[i]) - py);
      if (off < least) { least = off; result.target = m.target; result.mark = [m, i]; }
    }
    if (result.mark) {
      const [m, i] = result.mark;
      lines.push(`truth: echo of ${targetName(m.target)} at ${seconds(m.x[i])}, ${told(this.spec.axis, m.y[i])}, ` +
                 decibels(m.level[i], "dB re 1 µPa"));
    }
    if (this.spec.axis.label === "ping") { result.ping = Math.round(y); delete result.target; delete result.time; }
    return result;
  }
}

function detectionLines(i) {
  const f = view().detections;
  const lines = [`found: ${foundBy(f.target[i])}, ${seconds(f.time[i])}, SNR ${text(f.snr[i], 3)} dB, ` +
                 `Doppler ${text(f.doppler[i], 3)} Hz`];
  if (f.range[i] !== null) lines.push(`range ${distance(f.range[i])}` +
    (f.bearing_deg[i] === null ? "" : `, bearing ${bearing(f.bearing_deg[i])} true`));
  if (f.mirror_range[i] !== null && f.mirror_bearing_deg[i] !== null)
    lines.push(`or ${distance(f.mirror_range[i])}, ${bearing(f.mirror_bearing_deg[i])} true`);
  return lines;
}

/** The scale of colours at the right of a panel. */
function bar(c, panel, [lo, hi], what, unit) {
  const b = panel.box, x = b.x + b.w + 10;
  for (let k = 0; k < b.h; ++k) {
    c.fillStyle = "#" + D.colours[Math.min(255, Math.floor(256 * (1 - k / b.h)))];
    c.fillRect(x, b.y + k, 12, 1.5);
  }
  c.fillStyle = css("--ink");
  c.textAlign = "left";
  c.textBaseline = "middle";
  for (const [v, name] of ticks(lo, hi, Math.min(6, b.h / 30))) {
    const y = b.y + b.h * (1 - (v - lo) / (hi - lo));
    c.fillRect(x + 12, Math.round(y), 3, 1);
    c.fillText(name, x + 18, y);
  }
  c.save();
  c.translate(panel.wide - 9, b.y + b.h / 2);
  c.rotate(-Math.PI / 2);
  c.textAlign = "center";
  c.fillText(`${what} / ${unit}`, 0, 0, b.h + 30);
  c.restore();
}

// ------------------------------------------------------------------ levels

class Lines extends Panel {
  constructor(spec) { super(spec.name, spec.about, {wheel: "x", height: 240}); this.take(spec); }
  take(spec) {
    this.spec = spec;
    this.section.hidden = !spec;
    if (!spec) return;
    const received = spec.lines.slice(0, 2).flatMap((l) => l.y).filter((v) => v !== null).sort((a, b) => a - b);
    const all = spec.lines.flatMap((l) => l.y).filter((v) => v !== null);
    const top = (all.length ? all.reduce((a, b) => Math.max(a, b)) : 100) + 5;
    const low = (received.length ? received[Math.floor(0.02 * received.length)] : top - 60) - 10;
    const whole = [Math.max(low, top - 100), top];
    this.y = {lo: whole[0], hi: whole[1], full: whole};
    let key = this.section.querySelector(".key");
    if (!key) { key = document.createElement("p"); key.className = "key"; this.stage.after(key); }
    key.textContent = "";
    for (const line of spec.lines) {
      const one = document.createElement("span"), sample = document.createElement("i");
      one.append(sample, line.name);
      key.append(one);
    }
    this.paintKey();
  }
  colour(line) {
    return line.colour === "ink" ? css("--ink") : typeof line.colour === "number" ? targetColour(line.colour)
         : themed()[line.colour];
  }
  paintKey() {
    this.section.querySelectorAll(".key i").forEach((sample, i) => {
      const line = this.spec.lines[i];
      sample.style.borderTop = `2px ${line.dashed ? "dashed" : "solid"} ${this.colour(line)}`;
    });
  }
  get yLabel() { return "level / " + this.spec.unit; }
  drawData(c) {
    c.strokeStyle = css("--grid");
    c.lineWidth = 1;
    c.beginPath();
    for (const [v] of this.yTicks()) { c.moveTo(this.box.x, this.py(v)); c.lineTo(this.box.x + this.box.w, this.py(v)); }
    c.stroke();
    for (const line of this.spec.lines) {
      c.strokeStyle = this.colour(line);
      c.lineWidth = line.colour === "ink" ? 1 : 2;
      c.setLineDash(line.dashed ? [5, 2] : []);
      c.beginPath();
      let pen = false;
      line.y.forEach((v, i) => {
        if (v === null) { pen = false; return; }
        const x = this.px(line.first + i * line.step), y = this.py(v);
        if (pen) c.lineTo(x, y); else c.moveTo(x, y);
        pen = true;
      });
      c.stroke();
      c.setLineDash([]);
    }
  }
  drawChosen(c) {
    for (const e of view().echoes) {
      c.globalAlpha = faded(e.target) ? 0.25 : 1;
      c.fillStyle = targetColour(e.target);
      const size = S.target === e.target ? 8 : 6;
      for (const t of e.delay) {
        const x = this.px(t), y = this.box.y + 1;
        c.beginPath();
        c.moveTo(x - size, y); c.lineTo(x + size, y); c.lineTo(x, y + 1.6 * size);
        c.fill();
        if (S.target === e.target) { c.fillRect(x - 0.5, y, 1, this.box.h); }
      }
    }
    c.globalAlpha = 1;
    this.timeLine(c);
  }
  pick(px, py) {
    const x = this.dx(px), lines = [seconds(x)], values = {};
    for (const line of this.spec.lines) {
      const v = line.y[Math.round((x - line.first) / line.step)];
      values[line.name] = v === undefined ? null : v;
      if (v !== undefined && v !== null) lines.push(`${line.name}: ${decibels(v, this.spec.unit)}`);
    }
    const result = {lines, time: x, values};
    let least = 10;
    for (const e of view().echoes) e.delay.forEach((t, i) => {
      const off = Math.abs(this.px(t) - px);
      if (off < least && py < this.box.y + 24) {
        least = off;
        result.target = e.target;
        result.said = `truth: echo of ${e.name} at ${seconds(t)}, ${decibels(e.level[i], "dB re 1 µPa")}, ` +
                      `Doppler ${text(e.doppler[i], 3)} Hz`;
      }
    });
    if (result.said) lines.push(result.said);
    return result;
  }
}

// ------------------------------------------------------------------ rays

class Rays extends Panel {
  constructor(spec) {
    super(spec.name, spec.about, {place: "space", flip: true, height: 330, left: 148, right: 12,
                                  x: {lo: 0, hi: 1, full: [0, 1]}});
    this.spec = spec;
    const deepest = Math.max(spec.bottom || 0, ...(spec.floor ? spec.floor.z.filter((v) => v !== null) : []),
                             ...spec.profile.depth, spec.platform || 0);
    let far = Math.max(1, ...spec.targets.map((t) => (t.r > 2e7 ? 0 : t.r)));
    for (const l of spec.lines) for (const r of l.r) if (r !== null && r > far) far = r;
    const highest = Math.min(0, ...(spec.surface ? spec.surface.z.filter((v) => v !== null) : []));
    const y = [highest - 0.03 * deepest, 1.045 * deepest];
    this.y = {lo: y[0], hi: y[1], full: y};
    this.x = {lo: 0, hi: 1.02 * far, full: [0, 1.02 * far]};
    const c = spec.profile.speed, low = Math.min(...c), high = Math.max(...c), room = Math.max(0.12 * (high - low), 5);
    this.speeds = [low - room, high + room];
  }
  get profileBox() { return {x: 66, w: this.left - 66 - 10}; }
  get tickAt() { return 66; }
  get xLabel() { return "range from the source / km"; }
  get yLabel() { return "depth / m"; }
  xTicks() { return ticks(this.x.lo / 1000, this.x.hi / 1000, this.box.w / 70).map(([v, n]) => [v * 1000, n]); }
  line(c, l) {
    c.beginPath();
    l.r.forEach((r, i) => (i ? c.lineTo(this.px(r), this.py(l.z[i])) : c.moveTo(this.px(r), this.py(l.z[i]))));
  }
  drawData(c) {
    const s = this.spec, b = this.box, ground = css("--ground");
    c.fillStyle = ground;
    if (s.floor) {
      c.beginPath();
      c.moveTo(this.px(s.floor.r[0]), b.y + b.h + 4000);
      s.floor.r.forEach((r, i) => c.lineTo(this.px(r), this.py(s.floor.z[i])));
      c.lineTo(this.px(s.floor.r[s.floor.r.length - 1]), b.y + b.h + 4000);
      c.fill();
    } else if (s.bottom !== null) c.fillRect(b.x, this.py(s.bottom), b.w, b.h + 4000);
    c.strokeStyle = css("--sea");
    c.lineWidth = 1.5;
    c.beginPath();
    if (s.surface) s.surface.r.forEach((r, i) => (i ? c.lineTo(this.px(r), this.py(s.surface.z[i])) : c.moveTo(this.px(r), this.py(s.surface.z[i]))));
    else { c.moveTo(b.x, this.py(0)); c.lineTo(b.x + b.w, this.py(0)); }
    c.stroke();
    c.strokeStyle = css("--quiet");
    c.globalAlpha = 0.6;
    c.lineWidth = 0.7;
    for (const l of s.lines) if (l.target < 0) { this.line(c, l); c.stroke(); }
    c.globalAlpha = 1;
    c.fillStyle = css("--ink");
    for (const r of s.hits) c.fillRect(this.px(r), this.py(0) - 5, 1, 10);
  }
  drawAxes(c) {
    super.drawAxes(c);
    const b = this.box, col = this.profileBox, p = this.spec.profile;
    c.fillStyle = css("--field");
    c.fillRect(col.x, b.y, col.w, b.h);
    c.save();
    c.beginPath();
    c.rect(col.x, b.y, col.w, b.h);
    c.clip();
    if (this.spec.bottom !== null) { c.fillStyle = css("--ground"); c.fillRect(col.x, this.py(this.spec.bottom), col.w, b.h); }
    c.strokeStyle = css("--sea");
    c.lineWidth = 2;
    c.beginPath();
    p.depth.forEach((z, i) => { const x = this.speedAt(p.speed[i]); if (i) c.lineTo(x, this.py(z)); else c.moveTo(x, this.py(z)); });
    c.stroke();
    c.restore();
    c.strokeStyle = css("--line");
    c.lineWidth = 1;
    c.strokeRect(col.x - 0.5, b.y - 0.5, col.w + 1, b.h + 1);
    c.fillStyle = css("--ink");
    c.textAlign = "center";
    c.textBaseline = "top";
    for (const [v, name] of ticks(...this.speeds, 1.6))
      if (this.speedAt(v) < col.x + col.w - 16) c.fillText(name, this.speedAt(v), b.y + b.h + 6);
    c.fillText("m/s", col.x + col.w / 2, b.y + b.h + 21);
  }
  speedAt(v) { const col = this.profileBox; return col.x + col.w * (v - this.speeds[0]) / (this.speeds[1] - this.speeds[0]); }
  drawChosen(c) {
    const s = this.spec;
    for (const l of s.lines) if (l.target >= 0) {
      c.globalAlpha = faded(l.target) ? 0.25 : 1;
      c.strokeStyle = targetColour(l.target);
      c.lineWidth = S.target === l.target ? 3.5 : 1.8;
      this.line(c, l);
      c.stroke();
    }
    for (const t of s.targets) {
      c.globalAlpha = faded(t.target) ? 0.3 : 1;
      c.beginPath();
      c.arc(this.px(t.r), this.py(t.z), S.target === t.target ? 9 : 6, 0, 7);
      c.fillStyle = t.there ? targetColour(t.target) : css("--field");
      c.fill();
      c.strokeStyle = t.there ? css("--rim") : targetColour(t.target);
      c.lineWidth = 1.5;
      c.stroke();
    }
    c.globalAlpha = 1;
    c.save();
    c.translate(this.px(0), this.py(s.platform || 0));
    c.rotate(Math.PI / 4);
    c.fillStyle = css("--ink");
    c.fillRect(-6, -6, 12, 12);
    c.restore();
    if (S.time !== null && s.there_and_back && view().ping === s.ping) {
      c.fillStyle = css("--choice");
      for (const l of s.lines) {
        const k = this.struck(l, S.time / 2);
        if (!k) continue;
        c.beginPath();
        c.arc(this.px(k[0]), this.py(k[1]), l.target >= 0 ? 4.5 : 2.5, 0, 7);
        c.fill();
      }
    }
  }
  /** Where a ray is after a time; null past its end. */
  struck(l, time) {
    const i = between(l.t, time);
    if (i < 0) return null;
    const part = (time - l.t[i]) / ((l.t[i + 1] - l.t[i]) || 1);
    return [l.r[i] + part * (l.r[i + 1] - l.r[i]), l.z[i] + part * (l.z[i + 1] - l.z[i])];
  }
  pick(px, py) {
    const r = this.dx(px), z = this.dy(py), p = this.spec.profile, lines = [];
    const result = {lines, r, z};
    lines.push(`range ${distance(r)}, depth ${text(z)} m`);
    if (z >= p.depth[0] && z <= p.depth[p.depth.length - 1]) {
      const i = between(p.depth, z), part = (z - p.depth[i]) / (p.depth[i + 1] - p.depth[i]);
      result.speed = p.speed[i] + part * (p.speed[i + 1] - p.speed[i]);
      lines.push(`sound speed ${result.speed.toFixed(1)} m/s` + (this.spec.floor || this.spec.surface ? " at the source" : ""));
    }
    let least = 10, best = null;
    for (const l of this.spec.lines) for (let i = 1; i < l.r.length; ++i) {
      const ax = this.px(l.r[i - 1]), ay = this.py(l.z[i - 1]), bx = this.px(l.r[i]), by = this.py(l.z[i]);
      const dx = bx - ax, dy = by - ay, d2 = dx * dx + dy * dy;
      const u = d2 ? Math.max(0, Math.min(1, ((px - ax) * dx + (py - ay) * dy) / d2)) : 0;
      const off = Math.hypot(ax + u * dx - px, ay + u * dy - py) - (l.target >= 0 ? 2 : 0);
      if (off < least) { least = off; best = [l, i, u]; }
    }
    if (best) {
      const [l, i, u] = best;
      lines.push(`${l.target >= 0 ? "eigenray to " + targetName(l.target) : "ray"}, launched at ` +
                 `${l.launch >= 0 ? "+" : "−"}${Math.abs(l.launch).toFixed(2)}°`);
      if (l.t) {
        result.travel = l.t[i - 1] + u * (l.t[i] - l.t[i - 1]);
        lines.push(`${seconds(result.travel)} after the ping`);
        if (this.spec.there_and_back && view().ping === this.spec.ping) result.time = 2 * result.travel;
      }
      if (l.target >= 0) result.target = l.target;
    }
    for (const t of this.spec.targets) if (Math.hypot(this.px(t.r) - px, this.py(t.z) - py) < 11) {
      result.target = t.target;
      lines.push(`${targetName(t.target)}: range ${distance(t.r)}, depth ${text(t.z)} m` + (t.there ? "" : ", not there in this ping"));
    }
    return result;
  }
}

// ------------------------------------------------------------------ range and bearing

class Plan extends Panel {
  constructor(spec) {
    super("Range and bearing", "", {place: "space", square: true, right: 84, x: {lo: -1, hi: 1, full: [-1, 1]}});
    this.take(spec);
  }
  take(spec) {
    this.spec = spec;
    this.section.hidden = !spec;
    if (!spec) return;
    this.section.querySelector(".about").textContent = spec.about;
    let far = 1;
    for (const s of spec.sides) far = Math.max(far, s.ranges[s.ranges.length - 1]);
    const same = this.far === far;
    this.far = far;
    if (!same) {
      this.x = {lo: -far, hi: far, full: [-far, far]};
      this.y = {lo: -far, hi: far, full: [-far, far]};
    }
    this.angleRow = this.rows(spec);
  }
  get xLabel() { return "east of the array / km"; }
  get yLabel() { return "north of the array / km"; }
  xTicks() { return ticks(this.x.lo / 1000, this.x.hi / 1000, this.box.w / 70).map(([v, n]) => [v * 1000, n]); }
  yTicks() { return ticks(this.y.lo / 1000, this.y.hi / 1000, this.box.h / 50).map(([v, n]) => [v * 1000, n]); }
  get zoomed() { return this.x.hi - this.x.lo < 1.99 * this.far && this.y.hi - this.y.lo < 1.99 * this.far; }
  /** Metres are as long up as along: the axis with room shows more. */
  fit() {
    const b = this.box, sx = (this.x.hi - this.x.lo) / b.w, sy = (this.y.hi - this.y.lo) / b.h, s = Math.max(sx, sy);
    const set = (axis, pixels) => { const m = (axis.lo + axis.hi) / 2; axis.lo = m - s * pixels / 2; axis.hi = m + s * pixels / 2; };
    set(this.x, b.w);
    set(this.y, b.h);
  }
  limit(axis) {
    const most = 2 * this.far * 1.3 * Math.max(1, this.box.w / this.box.h, this.box.h / this.box.w);
    if (axis.hi - axis.lo > most) { const m = (axis.lo + axis.hi) / 2; axis.lo = m - most / 2; axis.hi = m + most / 2; }
  }
  reset() { this.x.lo = this.y.lo = -this.far; this.x.hi = this.y.hi = this.far; this.draw(); }
  /** [tenth of a degree of true bearing] row of the cells, and which side. */
  rows(spec) {
    const found = new Int16Array(3600), side = new Uint8Array(3600);
    for (let k = 0; k < 3600; ++k) {
      const b = k / 10;
      if (spec.axis.kind === "cosine") {
        found[k] = nearest(spec.angles, cosine(spec.axis, b));
        side[k] = spec.sides.length > 1 && Math.sin(radians(b - spec.axis.ahead)) > 0 ? 1 : 0;
      } else found[k] = nearest(spec.angles.map((a) => Math.abs(((a - b + 540) % 360) - 180)), 0);
    }
    return {found, side};
  }
  cell(x, y) {
    const r = Math.hypot(x, y), k = Math.floor(turned(degrees(Math.atan2(x, y))) * 10 + 0.5) % 3600;
    const side = this.spec.sides[this.angleRow.side[k]], column = this.column(side, r);
    return {side, row: this.angleRow.found[k], column, r};
  }
  column(side, r) {
    const e = side.ranges, i = between(e, r);
    return i < 0 ? -1 : r - e[i] < e[i + 1] - r ? i : i + 1;
  }
  drawData(c) {
    const b = this.box, w = Math.round(b.w * this.scale), h = Math.round(b.h * this.scale);
    const picture = new ImageData(w, h), pixels = new Uint32Array(picture.data.buffer);
    for (let j = 0; j < h; ++j) {
      const y = this.y.hi - (this.y.hi - this.y.lo) * (j + 0.5) / h;
      for (let i = 0; i < w; ++i) {
        const x = this.x.lo + (this.x.hi - this.x.lo) * (i + 0.5) / w;
        const {side, row, column} = this.cell(x, y);
        if (column < 0) continue;
        const cells = cellsOf(side), n = cells.whole(row, column);
        if (n !== 65535) pixels[j * w + i] = colourOf(cells.low + n * cells.step, this.spec.limits);
      }
    }
    c.putImageData(picture, Math.round(b.x * this.scale), Math.round(b.y * this.scale));
    c.strokeStyle = css("--rim") + "70";
    c.lineWidth = 1;
    for (const [r] of ticks(0, this.far, 4)) {
      if (r * 1 === 0) continue;
      c.beginPath();
      c.arc(this.px(0), this.py(0), Math.abs(this.px(r) - this.px(0)), 0, 7);
      c.stroke();
    }
  }
  drawAxes(c) { super.drawAxes(c); bar(c, this, this.spec.limits, this.spec.what, this.spec.unit); }
  places() {
    const f = view().detections, found = [], [cx, cy] = this.spec.centre;
    if (f) for (let i = 0; i < f.time.length; ++i)
      for (const side of ["", "mirror_"])
        if (f[side + "x"][i] !== null) found.push([f[side + "x"][i] - cx, f[side + "y"][i] - cy, i]);
    return found;
  }
  drawChosen(c) {
    const s = this.spec, [cx, cy] = s.centre;
    for (const t of D.tracks) if (t.array === view().array && t.x[0] !== null) {
      c.globalAlpha = faded(t.target) ? 0.25 : 1;
      c.setLineDash(t.mirrored ? [5, 3] : []);
      c.strokeStyle = t.target >= 0 ? targetColour(t.target) : "#ffffff";
      c.lineWidth = t.target < 0 ? 0.8 : S.target === t.target ? 3.5 : 2;
      c.beginPath();
      t.x.forEach((x, i) => (i ? c.lineTo(this.px(x - cx), this.py(t.y[i] - cy)) : c.moveTo(this.px(x - cx), this.py(t.y[i] - cy))));
      c.stroke();
      c.setLineDash([]);
      t.ping.forEach((p, i) => {
        c.fillStyle = p === view().ping ? css("--choice") : c.strokeStyle;
        c.beginPath();
        c.arc(this.px(t.x[i] - cx), this.py(t.y[i] - cy), p === view().ping ? 4.5 : 2, 0, 7);
        c.fill();
      });
    }
    const f = view().detections;
    for (const [x, y, i] of this.places()) circle(c, this.px(x), this.py(y), f.target[i]);
    for (const t of s.targets) {
      c.globalAlpha = faded(t.target) ? 0.3 : 1;
      star(c, this.px(t.x), this.py(t.y), S.target === t.target ? 12 : 8, targetColour(t.target));
    }
    c.globalAlpha = 1;
    c.fillStyle = css("--choice");
    if (s.sender) {
      c.fillStyle = css("--ink");
      c.save();
      c.translate(this.px(s.sender[0]), this.py(s.sender[1]));
      c.rotate(Math.PI / 4);
      c.fillRect(-6, -6, 12, 12);
      c.restore();
    }
    const x = this.px(0), y = this.py(0);
    stroke(c, css("--ink"), 2, () => { c.moveTo(x - 7, y); c.lineTo(x + 7, y); c.moveTo(x, y - 7); c.lineTo(x, y + 7); });
    if (S.time !== null) this.ring(c, S.time);
  }
  /** From where sound is received at a time. */
  ring(c, time) {
    c.strokeStyle = css("--choice");
    c.lineWidth = S.pinned ? 2.5 : 1.5;
    c.beginPath();
    let pen = false;
    for (let k = 0; k <= 3600; k += 10) {
      const at = k % 3600, side = this.spec.sides[this.angleRow.side[at]];
      const r = this.rangeAt(side, this.angleRow.found[at], time);
      if (r === null) { pen = false; continue; }
      const x = this.px(r * Math.sin(radians(k / 10))), y = this.py(r * Math.cos(radians(k / 10)));
      if (pen) c.lineTo(x, y); else c.moveTo(x, y);
      pen = true;
    }
    c.stroke();
  }
  rangeAt(side, row, time) {
    const times = cellsOf(side, "times"), r = times.rows > 1 ? row : 0;
    let before = -1;
    for (let i = 0; i < times.columns; ++i) {
      const t = times.value(r, i);
      if (t === null) continue;
      if (t >= time) {
        if (before < 0) return null;
        const t0 = times.value(r, before);
        return side.ranges[before] + (side.ranges[i] - side.ranges[before]) * (time - t0) / ((t - t0) || 1);
      }
      before = i;
    }
    return null;
  }
  pick(px, py) {
    const x = this.dx(px), y = this.dy(py), {side, row, column, r} = this.cell(x, y);
    const result = {lines: [`range ${distance(r)}, bearing ${bearing(degrees(Math.atan2(x, y)))} true`], r};
    if (column >= 0) {
      const times = cellsOf(side, "times");
      result.value = cellsOf(side).value(row, column);
      result.time = times.value(times.rows > 1 ? row : 0, column);
      result.lines.push(`${this.spec.what}: ${decibels(result.value, this.spec.unit)}`);
      if (result.time !== null) result.lines.push(`received at ${seconds(result.time)}`);
    }
    let least = 12;
    for (const [a, b, i] of this.places()) {
      const off = Math.hypot(this.px(a) - px, this.py(b) - py);
      if (off < least) { least = off; result.detection = i; result.target = view().detections.target[i]; }
    }
    if (result.detection !== undefined) result.lines.push(...detectionLines(result.detection));
    for (const t of this.spec.targets) if (Math.hypot(this.px(t.x) - px, this.py(t.y) - py) < 12) {
      result.target = t.target;
      result.lines.push(`truth: ${targetName(t.target)} at ${distance(Math.hypot(t.x, t.y))}, ` +
                        `${bearing(degrees(Math.atan2(t.x, t.y)))} true, depth ${text(t.depth)} m`);
    }
    return result;
  }
}

function star(c, x, y, size, colour) {
  c.beginPath();
  for (let k = 0; k < 10; ++k) {
    const r = k % 2 ? 0.42 * size : size, a = k * Math.PI / 5;
    c.lineTo(x + r * Math.sin(a), y - r * Math.cos(a));
  }
  c.closePath();
  c.fillStyle = colour;
  c.strokeStyle = css("--rim");
  c.lineWidth = 1.5;
  c.stroke();
  c.fill();
}

// ------------------------------------------------------------------ what is chosen

function tip(lines, x, y) {
  const box = $("tip");
  if (!lines) { box.hidden = true; return; }
  box.hidden = false;
  box.replaceChildren(...lines.map((l) => Object.assign(document.createElement("div"), {textContent: l})));
  if (x === undefined) return;
  const w = box.offsetWidth, h = box.offsetHeight;
  box.style.left = Math.max(4, x + 16 + w > innerWidth ? x - w - 12 : x + 16) + "px";
  box.style.top = Math.max(4, y + 16 + h > innerHeight ? y - h - 12 : y + 16) + "px";
}
function letGoOfTime() { if (!S.pinned && S.time !== null) { S.time = null; drawOvers(); } }
function drawAll() { for (const p of panels) p.draw(); }
function drawOvers() { for (const p of panels) p.drawOver(); }

function chooseTarget(target) {
  S.target = target;
  for (const b of document.querySelectorAll("#targets button"))
    b.setAttribute("aria-pressed", String(Number(b.dataset.target) === target));
  let first = null;
  document.querySelectorAll("#scenario span").forEach((line, i) => {
    const mine = target !== null && D.tables[target] && i >= D.tables[target][0] && i < D.tables[target][1];
    line.classList.toggle("chosen", Boolean(mine));
    if (mine && !first) first = line;
  });
  if (first) { const box = $("scenario"); box.scrollTop = first.offsetTop - 20; }
  for (const row of document.querySelectorAll("#found tbody tr"))
    row.classList.toggle("chosen", target !== null && Number(row.dataset.target) === target);
  drawOvers();
}
function choosePing(number, array = view().array) {
  const off = D.views.map((v) => (v.array === array ? Math.abs(v.ping - number) : Infinity));
  const k = off.indexOf(Math.min(...off));          // the nearest that is here
  if (k !== S.view) show(k);
}

// ------------------------------------------------------------------ the page

let plan = null, levels = null, past = null;
const images = {};

function show(k) {
  const whole = T.lo === T.full[0] && T.hi === T.full[1];
  S.view = k;
  const v = view();
  T.full = v.time;
  if (whole) [T.lo, T.hi] = T.full; else { T.hi = Math.min(T.hi, T.full[1]); T.lo = Math.min(T.lo, T.hi - 1e-3); }
  for (const name of Object.keys(images)) images[name].take(v.images.find((i) => i.name === name) || null);
  if (levels) levels.take(v.levels);
  if (plan) plan.take(v.map);
  $("ping").value = String(v.ping);
  $("array").value = String(v.array);
  $("about").replaceChildren(...v.about.flatMap(([what, is]) => [
    Object.assign(document.createElement("dt"), {textContent: what}),
    Object.assign(document.createElement("dd"), {textContent: is})]));
  notes();
  foundTable();
  chooseTarget(S.target);
  resizeAll();
}

function notes() {
  const list = [...view().left_out, ...D.notes, ...(D.rays && D.rays.note ? [D.rays.note] : [])];
  $("notes").replaceChildren(...list.map((n) => Object.assign(document.createElement("li"), {textContent: n})));
}

function foundTable() {
  const f = view().detections, box = $("found");
  box.hidden = !f;
  if (!f) return;
  const order = f.time.map((_, i) => i).sort((a, b) => f.snr[b] - f.snr[a]).slice(0, 200);
  box.querySelector("summary").textContent = `Detections: ${f.time.length}` +
    (f.time.length > 200 ? ", the 200 loudest" : "");
  box.querySelector("tbody").replaceChildren(...order.map((i) => {
    const row = document.createElement("tr");
    row.dataset.target = f.target[i];
    for (const words of [f.time[i].toFixed(3), text(f.snr[i], 3), f.bearing_deg[i] === null ? "–" : bearing(f.bearing_deg[i]) +
                         (f.mirror_bearing_deg[i] === null ? "" : " or " + bearing(f.mirror_bearing_deg[i])),
                         f.range[i] === null ? "–" : (f.range[i] / 1000).toFixed(3), text(f.doppler[i], 3), foundBy(f.target[i])])
      row.append(Object.assign(document.createElement("td"), {textContent: words}));
    row.tabIndex = 0;
    const choose = () => { S.time = f.time[i]; S.pinned = true; if (f.target[i] >= 0) chooseTarget(f.target[i]); drawOvers(); };
    row.addEventListener("click", choose);
    row.addEventListener("keydown", (e) => { if (e.key === "Enter") choose(); });
    return row;
  }));
}

function resizeAll() { for (const p of panels) if (p.shown) p.resize(); drawAll(); }

function theme(name) {
  if (name) document.documentElement.dataset.theme = name;
  document.querySelectorAll("#targets i").forEach((dot, i) => { dot.style.background = targetColour(i); });
  if (levels && levels.shown) levels.paintKey();
  drawAll();
}

function start() {
  document.title = D.title + " · asdic";
  $("title").textContent = D.title;
  $("file").textContent = `${D.file} · asdic ${D.version}`;
  const choices = (id, values, label) => {
    $(id).replaceChildren(...values.map(([v, n]) => Object.assign(document.createElement("option"), {value: String(v), textContent: n})));
    $(id).parentElement.hidden = values.length < 2;
    $(id).setAttribute("aria-label", label);
  };
  const pings = [...new Set(D.views.map((v) => v.ping))], arrays = [...new Set(D.views.map((v) => v.array))];
  choices("ping", pings.map((p) => [p, String(p)]), "ping");
  choices("array", arrays.map((a) => [a, D.arrays[a]]), "array");
  $("ping").addEventListener("change", () => choosePing(Number($("ping").value)));
  $("array").addEventListener("change", () => choosePing(view().ping, Number($("array").value)));
  D.targets.forEach((name, i) => {
    const b = Object.assign(document.createElement("button"), {type: "button"});
    b.dataset.target = i;
    b.setAttribute("aria-pressed", "false");
    const dot = document.createElement("i");
    dot.style.background = targetColour(i);
    b.append(dot, name);
    b.addEventListener("click", () => chooseTarget(S.target === i ? null : i));
    $("targets").append(b);
  });
  D.scenario.split("\n").forEach((line) =>
    $("scenario").append(Object.assign(document.createElement("span"), {textContent: line + "\n"})));
  for (const w of D.warnings)
    $("warnings").append(Object.assign(document.createElement("li"), {textContent: w}));
  $("warnings").hidden = !D.warnings.length;

  if (D.rays) new Rays(D.rays);
  const withMap = D.views.find((v) => v.map);
  if (withMap) plan = new Plan(withMap.map);
  if (D.history) past = new TimeImage(D.history, {wheel: "x", height: 150 + 10 * Math.min(20, D.history.cells.rows)});
  for (const v of D.views) for (const spec of v.images)
    if (!images[spec.name]) images[spec.name] = new TimeImage(spec, {wheel: "x", height: spec.name === "Detections" ? 230 : 270});
  const withLevels = D.views.find((v) => v.levels);
  if (withLevels) levels = new Lines(withLevels.levels);
  T.lo = D.views[0].time[0];
  T.hi = D.views[0].time[1];
  T.full = D.views[0].time;
  show(0);

  $("theme").addEventListener("click", () => {
    theme(isDark() ? "light" : "dark");
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => theme());
  addEventListener("resize", resizeAll);
  document.addEventListener("keydown", (e) => {
    if (e.ctrlKey || e.metaKey || e.altKey || /^(INPUT|SELECT|TEXTAREA)$/.test(e.target.tagName)) return;
    if (e.key === "Escape") { S.pinned = false; S.time = null; tip(null); chooseTarget(null); }
    else if (e.key === "t" && D.targets.length) chooseTarget(S.target === null ? 0 : S.target + 1 < D.targets.length ? S.target + 1 : null);
    else if (e.key === "[" || e.key === "]") {
      const k = pings.indexOf(view().ping) + (e.key === "]" ? 1 : -1);
      if (k >= 0 && k < pings.length) choosePing(pings[k]);
    }
  });
}
start();

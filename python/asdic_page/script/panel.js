// A panel: axes, zoom, pointer and keys. What it shows is told by those that extend it.
class Panel {
  constructor(name, about, options = {}) {
    Object.assign(
      this,
      {
        name,
        about,
        flip: false,
        x: T,
        height: 260,
        left: 66,
        right: 84,
        top: 8,
        bottom: 36,
        cursor: null,
      },
      options
    );
    this.y = {lo: 0, hi: 1, full: [0, 1]};
    this.section = document.createElement("section");
    this.section.className = "panel";
    this.section.innerHTML =
      '<header><h2></h2><button type="button" class="reset">whole</button>' +
      '</header><div class="stage"><canvas class="base"></canvas><canvas class="over"></canvas></div>' +
      '<p class="about"></p>';
    this.section.querySelector("h2").textContent = name;
    this.section.querySelector(".about").textContent = about;
    this.stage = this.section.querySelector(".stage");
    [this.base, this.over] = this.section.querySelectorAll("canvas");
    this.stage.tabIndex = 0;
    this.stage.setAttribute("role", "application");
    this.stage.setAttribute(
      "aria-label",
      `${name}. ${about} Arrows move the cursor, plus and minus ` +
        "zoom, 0 shows all, Enter chooses, Escape lets go."
    );
    this.stage.style.height = this.height + "px";
    this.section.querySelector(".reset").addEventListener("click", () => this.reset());
    $(options.place || "time").append(this.section);
    this.listen();
    panels.push(this);
  }

  // -------- places
  get box() {
    return {
      x: this.left,
      y: this.top,
      w: Math.max(this.wide - this.left - this.right, 10),
      h: Math.max(this.high - this.top - this.bottom, 10),
    };
  }
  px(x) {
    const b = this.box;
    return b.x + (b.w * (x - this.x.lo)) / (this.x.hi - this.x.lo);
  }
  py(y) {
    const b = this.box,
      part = (y - this.y.lo) / (this.y.hi - this.y.lo);
    return this.flip ? b.y + b.h * part : b.y + b.h * (1 - part);
  }
  dx(px) {
    const b = this.box;
    return this.x.lo + ((this.x.hi - this.x.lo) * (px - b.x)) / b.w;
  }
  dy(py) {
    const b = this.box,
      part = (py - b.y) / b.h;
    return this.y.lo + (this.y.hi - this.y.lo) * (this.flip ? part : 1 - part);
  }
  inside(px, py) {
    const b = this.box;
    return px >= b.x && px <= b.x + b.w && py >= b.y && py <= b.y + b.h;
  }
  get shown() {
    return !this.section.hidden;
  }

  // -------- drawing
  resize() {
    if (this.square)
      this.stage.style.height =
        Math.min(460, Math.max(240, this.stage.clientWidth - this.left - this.right + 44)) + "px";
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
    const c = this.context(this.base),
      b = this.box;
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
  xTicks() {
    return ticks(this.x.lo, this.x.hi, this.box.w / 60);
  }
  yTicks() {
    return ticks(this.y.lo, this.y.hi, this.box.h / 40);
  }
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
  get tickAt() {
    return this.box.x;
  }
  get xLabel() {
    return "time after the ping / s";
  }
  drawOver() {
    if (!this.shown || !this.wide) return;
    const c = this.context(this.over);
    this.clipped(c, () => this.drawChosen(c));
    if (this.drag && this.drag.moved) {
      const {x0, y0, x1, y1} = this.drag,
        b = this.box,
        flat = this.drag.flat;
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
    const x = this.px(S.time),
      b = this.box;
    c.strokeStyle = css("--choice");
    c.lineWidth = S.pinned ? 2 : 1;
    c.beginPath();
    c.moveTo(x, b.y);
    c.lineTo(x, b.y + b.h);
    c.stroke();
  }

  // -------- zoom
  get sharesTime() {
    return this.x === T;
  }
  changed() {
    for (const p of panels) if (p === this || (this.sharesTime && p.sharesTime)) p.draw();
  }
  limit(axis) {
    const [a, b] = axis.full,
      least = (b - a) * 1e-5;
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
    for (const [axis, by] of [
      [this.x, x],
      [this.y, y],
    ]) {
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
    const at = (e) => {
      const r = this.stage.getBoundingClientRect();
      return [e.clientX - r.left, e.clientY - r.top];
    };
    this.stage.addEventListener(
      "wheel",
      (e) => {
        const [x, y] = at(e);
        if (!this.inside(x, y)) return;
        e.preventDefault();
        const factor = Math.exp(0.0015 * Math.max(-300, Math.min(300, e.deltaY || e.deltaX)));
        this.zoomAt(factor, this.dx(x), this.dy(y), e.shiftKey ? "y" : this.wheel || "both");
        this.hover(x, y);
      },
      {passive: false}
    );
    this.stage.addEventListener("pointerdown", (e) => {
      const [x, y] = at(e);
      if (e.button !== 0 || !this.inside(x, y)) return;
      this.stage.focus({preventScroll: true});
      this.stage.setPointerCapture(e.pointerId);
      this.drag = {
        x0: x,
        y0: y,
        x1: x,
        y1: y,
        moved: false,
        pan: e.shiftKey || e.pointerType === "touch",
      };
    });
    this.stage.addEventListener("pointermove", (e) => {
      const [x, y] = at(e),
        d = this.drag;
      if (!d) {
        this.hover(x, y, e.clientX, e.clientY);
        return;
      }
      if (d.pan) {
        if (Math.hypot(x - d.x1, y - d.y1) > 0)
          this.shift(this.dx(d.x1) - this.dx(x), this.dy(d.y1) - this.dy(y));
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
      const d = this.drag,
        [x, y] = at(e);
      this.drag = null;
      if (!d) return;
      if (d.moved && Math.abs(d.x1 - d.x0) > 3)
        this.zoomTo(
          this.dx(d.x0),
          this.dx(d.x1),
          d.flat ? null : this.dy(d.y0),
          d.flat ? null : this.dy(d.y1)
        );
      else if (!d.panned && !d.moved) this.choose(x, y);
      else this.drawOver();
    });
    this.stage.addEventListener("pointercancel", () => {
      this.drag = null;
      this.drawOver();
    });
    this.stage.addEventListener("pointerleave", () => {
      if (!this.drag) {
        tip(null);
        letGoOfTime();
      }
    });
    this.stage.addEventListener("dblclick", () => this.reset());
    this.stage.addEventListener("blur", () => {
      this.cursor = null;
      tip(null);
      this.drawOver();
    });
    this.stage.addEventListener("keydown", (e) => this.key(e));
  }
  key(e) {
    if (e.ctrlKey || e.metaKey || e.altKey) return;
    const by = e.shiftKey ? 0.1 : 0.01;
    const step = {ArrowLeft: [-by, 0], ArrowRight: [by, 0], ArrowUp: [0, by], ArrowDown: [0, -by]}[
      e.key
    ];
    const here = () =>
      this.cursor || [
        S.time !== null && this.sharesTime ? S.time : (this.x.lo + this.x.hi) / 2,
        (this.y.lo + this.y.hi) / 2,
      ];
    if (step) {
      const c = here(),
        up = this.flip ? -1 : 1;
      this.cursor = [
        c[0] + step[0] * (this.x.hi - this.x.lo),
        c[1] + up * step[1] * (this.y.hi - this.y.lo),
      ];
      this.cursor[0] = Math.max(this.x.lo, Math.min(this.x.hi, this.cursor[0]));
      this.cursor[1] = Math.max(this.y.lo, Math.min(this.y.hi, this.cursor[1]));
      this.hoverCursor();
    } else if (e.key === "+" || e.key === "=") {
      this.zoomAt(0.7, ...here());
      this.hoverCursor();
    } else if (e.key === "-") {
      this.zoomAt(1 / 0.7, ...here());
      this.hoverCursor();
    } else if (e.key === "0" || e.key === "Home") this.reset();
    else if (e.key === "Enter" || e.key === " ") {
      const c = here();
      this.choose(this.px(c[0]), this.py(c[1]));
    } else return;
    e.preventDefault();
  }
  hoverCursor() {
    if (!this.cursor) return;
    const r = this.stage.getBoundingClientRect(),
      x = this.px(this.cursor[0]),
      y = this.py(this.cursor[1]);
    this.hover(x, y, r.left + x, r.top + y);
    this.drawOver();
  }
  hover(px, py, clientX, clientY) {
    if (!this.inside(px, py)) {
      tip(null);
      letGoOfTime();
      return;
    }
    const found = this.pick(px, py);
    if (found && found.time !== undefined && found.time !== null && !S.pinned) {
      S.time = found.time;
      drawOvers();
    }
    tip(found && found.lines, clientX, clientY);
  }
  choose(px, py) {
    if (!this.inside(px, py)) return;
    const found = this.pick(px, py) || {};
    if (found.ping !== undefined) choosePing(found.ping);
    if (found.target !== undefined && found.target >= 0)
      chooseTarget(S.target === found.target ? null : found.target);
    else if (found.time !== undefined && found.time !== null) {
      S.pinned = !(S.pinned && Math.abs(this.px(S.time) - this.px(found.time)) < 4);
      S.time = found.time;
      drawOvers();
    }
  }
}

function faded(target) {
  return S.target !== null && S.target !== target;
}

/** The circle of a detection: in a target's colour where it is its echo, small and white where not. */
function circle(c, x, y, target) {
  c.globalAlpha = faded(target) ? 0.3 : 1;
  const path = () => c.arc(x, y, target >= 0 ? 9 : 4.5, 0, 7);
  if (target >= 0) stroke(c, targetColour(target), S.target === target ? 3 : 1.8, path);
  else {
    c.strokeStyle = "#ffffff";
    c.lineWidth = 1.2;
    c.beginPath();
    path();
    c.stroke();
  }
  c.globalAlpha = 1;
}

/** A mark of the truth or of a detection, with a rim that shows on any colour. */
function stroke(c, colour, width, path) {
  for (const [style, more] of [
    [css("--rim"), 2.4],
    [colour, 0],
  ]) {
    c.strokeStyle = style;
    c.lineWidth = width + more;
    c.beginPath();
    path();
    c.stroke();
  }
}

// Range and bearing as a map around the array.
class Plan extends Panel {
  constructor(spec) {
    super("Range and bearing", "", {
      place: "space",
      square: true,
      right: 84,
      x: {lo: -1, hi: 1, full: [-1, 1]},
    });
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
  get xLabel() {
    return "east of the array / km";
  }
  get yLabel() {
    return "north of the array / km";
  }
  xTicks() {
    return ticks(this.x.lo / 1000, this.x.hi / 1000, this.box.w / 70).map(([v, n]) => [
      v * 1000,
      n,
    ]);
  }
  yTicks() {
    return ticks(this.y.lo / 1000, this.y.hi / 1000, this.box.h / 50).map(([v, n]) => [
      v * 1000,
      n,
    ]);
  }
  get zoomed() {
    return this.x.hi - this.x.lo < 1.99 * this.far && this.y.hi - this.y.lo < 1.99 * this.far;
  }
  /** Metres are as long up as along: the axis with room shows more. */
  fit() {
    const b = this.box,
      sx = (this.x.hi - this.x.lo) / b.w,
      sy = (this.y.hi - this.y.lo) / b.h,
      s = Math.max(sx, sy);
    const set = (axis, pixels) => {
      const m = (axis.lo + axis.hi) / 2;
      axis.lo = m - (s * pixels) / 2;
      axis.hi = m + (s * pixels) / 2;
    };
    set(this.x, b.w);
    set(this.y, b.h);
  }
  limit(axis) {
    const most = 2 * this.far * 1.3 * Math.max(1, this.box.w / this.box.h, this.box.h / this.box.w);
    if (axis.hi - axis.lo > most) {
      const m = (axis.lo + axis.hi) / 2;
      axis.lo = m - most / 2;
      axis.hi = m + most / 2;
    }
  }
  reset() {
    this.x.lo = this.y.lo = -this.far;
    this.x.hi = this.y.hi = this.far;
    this.draw();
  }
  /** [tenth of a degree of true bearing] row of the cells, and which side. */
  rows(spec) {
    const found = new Int16Array(3600),
      side = new Uint8Array(3600);
    for (let k = 0; k < 3600; ++k) {
      const b = k / 10;
      if (spec.axis.kind === "cosine") {
        found[k] = nearest(spec.angles, cosine(spec.axis, b));
        side[k] = spec.sides.length > 1 && Math.sin(radians(b - spec.axis.ahead)) > 0 ? 1 : 0;
      } else
        found[k] = nearest(
          spec.angles.map((a) => Math.abs(((a - b + 540) % 360) - 180)),
          0
        );
    }
    return {found, side};
  }
  cell(x, y) {
    const r = Math.hypot(x, y),
      k = Math.floor(turned(degrees(Math.atan2(x, y))) * 10 + 0.5) % 3600;
    const side = this.spec.sides[this.angleRow.side[k]],
      column = this.column(side, r);
    return {side, row: this.angleRow.found[k], column, r};
  }
  column(side, r) {
    const e = side.ranges,
      i = between(e, r);
    return i < 0 ? -1 : r - e[i] < e[i + 1] - r ? i : i + 1;
  }
  /** Of rings half a pixel apart: first and last column of each side that a pixel there covers. */
  rings(side, metres, count) {
    const e = side.ranges,
      first = new Int32Array(count).fill(-1),
      last = new Int32Array(count);
    for (let k = 0; k < count; ++k) {
      const r = 0.5 * k * metres;
      if (r < e[0] || r > e[e.length - 1]) continue;
      first[k] = this.column(side, Math.max(r - 0.5 * metres, e[0]));
      last[k] = this.column(side, Math.min(r + 0.5 * metres, e[e.length - 1]));
      if (last[k] > first[k]) ++first[k]; // the one below belongs to the pixel before
    }
    return {first, last, cells: cellsOf(side)};
  }
  /** The largest of the cells of a beam that a pixel covers: no narrow echo falls between pixels. */
  drawData(c) {
    const b = this.box,
      w = Math.round(b.w),
      h = Math.round(b.h),
      metres = (this.x.hi - this.x.lo) / w,
      count = Math.ceil((2 * this.far) / metres) + 3;
    const picture = new ImageData(w, h),
      pixels = new Uint32Array(picture.data.buffer),
      {found, side} = this.angleRow,
      rings = this.spec.sides.map((one) => this.rings(one, metres, count));
    for (let j = 0; j < h; ++j) {
      const y = this.y.hi - ((this.y.hi - this.y.lo) * (j + 0.5)) / h;
      for (let i = 0; i < w; ++i) {
        const x = this.x.lo + (i + 0.5) * metres,
          ring = Math.round((2 * Math.sqrt(x * x + y * y)) / metres);
        if (ring >= count) continue;
        const tenth = Math.floor(turned(degrees(Math.atan2(x, y))) * 10 + 0.5) % 3600,
          {first, last, cells} = rings[side[tenth]];
        if (first[ring] < 0) continue;
        let most = -1;
        for (let k = first[ring], row = found[tenth] * cells.columns; k <= last[ring]; ++k) {
          const n = cells.values[row + k];
          if (n !== 65535 && n > most) most = n;
        }
        if (most >= 0)
          pixels[j * w + i] = colourOf(cells.low + most * cells.step, this.spec.limits);
      }
    }
    const drawn = Object.assign(document.createElement("canvas"), {width: w, height: h});
    drawn.getContext("2d").putImageData(picture, 0, 0);
    c.imageSmoothingEnabled = false;
    c.drawImage(drawn, b.x, b.y, b.w, b.h);
    c.strokeStyle = css("--rim") + "70";
    c.lineWidth = 1;
    for (const [r] of ticks(0, this.far, 4)) {
      if (r * 1 === 0) continue;
      c.beginPath();
      c.arc(this.px(0), this.py(0), Math.abs(this.px(r) - this.px(0)), 0, 7);
      c.stroke();
    }
  }
  drawAxes(c) {
    super.drawAxes(c);
    bar(c, this, this.spec.limits, this.spec.what, this.spec.unit);
  }
  places() {
    const f = view().detections,
      found = [],
      [cx, cy] = this.spec.centre;
    if (f)
      for (let i = 0; i < f.time.length; ++i)
        for (const side of ["", "mirror_"])
          if (f[side + "x"][i] !== null)
            found.push([f[side + "x"][i] - cx, f[side + "y"][i] - cy, i]);
    return found;
  }
  drawChosen(c) {
    const s = this.spec,
      [cx, cy] = s.centre;
    for (const t of D.tracks)
      if (t.array === view().array && t.x[0] !== null) {
        c.globalAlpha = faded(t.target) ? 0.25 : 1;
        c.setLineDash(t.mirrored ? [5, 3] : []);
        c.strokeStyle = t.target >= 0 ? targetColour(t.target) : "#ffffff";
        c.lineWidth = t.target < 0 ? 0.8 : S.target === t.target ? 3.5 : 2;
        c.beginPath();
        t.x.forEach((x, i) =>
          i
            ? c.lineTo(this.px(x - cx), this.py(t.y[i] - cy))
            : c.moveTo(this.px(x - cx), this.py(t.y[i] - cy))
        );
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
    const x = this.px(0),
      y = this.py(0);
    stroke(c, css("--ink"), 2, () => {
      c.moveTo(x - 7, y);
      c.lineTo(x + 7, y);
      c.moveTo(x, y - 7);
      c.lineTo(x, y + 7);
    });
    if (S.time !== null) this.ring(c, S.time);
  }
  /** From where sound is received at a time. */
  ring(c, time) {
    c.strokeStyle = css("--choice");
    c.lineWidth = S.pinned ? 2.5 : 1.5;
    c.beginPath();
    let pen = false;
    for (let k = 0; k <= 3600; k += 10) {
      const at = k % 3600,
        side = this.spec.sides[this.angleRow.side[at]];
      const r = this.rangeAt(side, this.angleRow.found[at], time);
      if (r === null) {
        pen = false;
        continue;
      }
      const x = this.px(r * Math.sin(radians(k / 10))),
        y = this.py(r * Math.cos(radians(k / 10)));
      if (pen) c.lineTo(x, y);
      else c.moveTo(x, y);
      pen = true;
    }
    c.stroke();
  }
  rangeAt(side, row, time) {
    const times = cellsOf(side, "times"),
      r = times.rows > 1 ? row : 0;
    let before = -1;
    for (let i = 0; i < times.columns; ++i) {
      const t = times.value(r, i);
      if (t === null) continue;
      if (t >= time) {
        if (before < 0) return null;
        const t0 = times.value(r, before);
        return (
          side.ranges[before] +
          ((side.ranges[i] - side.ranges[before]) * (time - t0)) / (t - t0 || 1)
        );
      }
      before = i;
    }
    return null;
  }
  pick(px, py) {
    const x = this.dx(px),
      y = this.dy(py),
      {side, row, column, r} = this.cell(x, y);
    const result = {
      lines: [`range ${distance(r)}, bearing ${bearing(degrees(Math.atan2(x, y)))} true`],
      r,
    };
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
      if (off < least) {
        least = off;
        result.detection = i;
        result.target = view().detections.target[i];
      }
    }
    if (result.detection !== undefined) result.lines.push(...detectionLines(result.detection));
    for (const t of this.spec.targets)
      if (Math.hypot(this.px(t.x) - px, this.py(t.y) - py) < 12) {
        result.target = t.target;
        result.lines.push(
          `truth: ${targetName(t.target)} at ${distance(Math.hypot(t.x, t.y))}, ` +
            `${bearing(degrees(Math.atan2(t.x, t.y)))} true, depth ${text(t.depth)} m`
        );
      }
    return result;
  }
}

function star(c, x, y, size, colour) {
  c.beginPath();
  for (let k = 0; k < 10; ++k) {
    const r = k % 2 ? 0.42 * size : size,
      a = (k * Math.PI) / 5;
    c.lineTo(x + r * Math.sin(a), y - r * Math.cos(a));
  }
  c.closePath();
  c.fillStyle = colour;
  c.strokeStyle = css("--rim");
  c.lineWidth = 1.5;
  c.stroke();
  c.fill();
}

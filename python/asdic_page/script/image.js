// Images over time, with the truth and what was found on them.
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
    this.section.querySelector(".about").textContent =
      spec.about + (spec.joined ? ` Each cell is the largest of ${spec.joined} (up × along).` : "");
    const whole = [spec.y[0], spec.y[spec.y.length - 1]];
    if (spec.axis.kind === "cosine" || spec.axis.kind === "sine") {
      whole[0] = Math.max(whole[0], -1);
      whole[1] = Math.min(whole[1], 1);
    }
    this.y = {lo: whole[0], hi: whole[1], full: whole};
  }
  get yLabel() {
    return this.spec.axis.label + (this.spec.axis.unit ? " / " + this.spec.axis.unit : "");
  }
  yTicks() {
    return axisTicks(this.spec.axis, this.y.lo, this.y.hi, this.box.h);
  }

  drawData(c) {
    const b = this.box,
      w = Math.round(b.w * this.scale),
      h = Math.round(b.h * this.scale);
    const picture = new ImageData(w, h),
      pixels = new Uint32Array(picture.data.buffer);
    const {first, step} = this.spec.x,
      {columns, rows, values, low} = this.cells,
      limits = this.spec.limits;
    const from = new Int32Array(w),
      to = new Int32Array(w);
    for (let i = 0; i < w; ++i) {
      const at = (k) => Math.floor((this.x.lo + ((this.x.hi - this.x.lo) * k) / w - first) / step);
      from[i] = at(i);
      to[i] = Math.max(at(i + 1) - 1, from[i]);
      if (to[i] >= columns) to[i] = columns - 1;
      if (from[i] < 0 && to[i] >= 0) from[i] = 0;
    }
    let last = null;
    for (let j = 0; j < h; ++j) {
      const edge = (k) => this.y.lo + (this.y.hi - this.y.lo) * (this.flip ? k / h : 1 - k / h);
      let r0 = between(this.spec.y, edge(j + 0.5)),
        r1 = r0;
      if (r0 >= 0) {
        const a = between(this.spec.y, edge(j)),
          e = between(this.spec.y, edge(j + 1));
        if (a >= 0 && e >= 0 && Math.abs(a - e) > 1)
          [r0, r1] = [Math.min(a, e) + 1, Math.max(a, e)];
      }
      const row = j * w;
      if (last && last[0] === r0 && last[1] === r1) {
        pixels.copyWithin(row, row - w, row);
        continue;
      }
      last = [r0, r1];
      if (r0 < 0) continue;
      for (let i = 0; i < w; ++i) {
        let most = -1;
        for (let k = from[i]; k <= to[i]; ++k)
          if (k >= 0)
            for (let r = r0; r <= r1 && r < rows; ++r) {
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
      stroke(c, targetColour(m.target), S.target === m.target ? 3.2 : 2, () =>
        m.x.forEach((t, i) => {
          const x = this.px(t),
            y = this.py(m.y[i]);
          if (m.look === "bar") {
            const end = this.px(t + long);
            c.moveTo(x, y - 6);
            c.lineTo(x, y + 6);
            c.moveTo(x, y);
            c.lineTo(end, y);
            c.moveTo(end, y - 6);
            c.lineTo(end, y + 6);
          } else if (m.look === "stroke") {
            const half = Math.max(3, 0.38 * Math.abs(this.py(1) - this.py(0)));
            c.moveTo(x, y - half);
            c.lineTo(x, y + half);
          } else {
            c.moveTo(x - 5, y - 5);
            c.lineTo(x + 5, y + 5);
            c.moveTo(x - 5, y + 5);
            c.lineTo(x + 5, y - 5);
          }
        })
      );
    }
    c.globalAlpha = 1;
    const found = view().detections;
    if (this.spec.found && found)
      for (let i = 0; i < found.time.length; ++i)
        circle(c, this.px(found.time[i]), this.py(this.spec.found[i]), found.target[i]);
    if (this.spec.axis.label === "ping") {
      const y0 = this.py(view().ping - 0.5),
        y1 = this.py(view().ping + 0.5),
        b = this.box;
      c.strokeStyle = css("--choice");
      c.lineWidth = 2;
      c.strokeRect(b.x + 1, Math.min(y0, y1), b.w - 2, Math.abs(y1 - y0));
    }
    this.timeLine(c);
  }
  pick(px, py) {
    const x = this.dx(px),
      y = this.dy(py),
      {first, step} = this.spec.x;
    const column = Math.floor((x - first) / step),
      row = between(this.spec.y, y);
    const lines = [
      seconds(x),
      told(this.spec.axis, y),
      `${this.spec.what}: ${decibels(this.cells.value(row, column), this.spec.unit)}`,
    ];
    const result = {lines, time: x, row, column, value: this.cells.value(row, column)};
    const found = view().detections;
    let least = 12;
    if (this.spec.found && found)
      for (let i = 0; i < found.time.length; ++i) {
        const off = Math.hypot(this.px(found.time[i]) - px, this.py(this.spec.found[i]) - py);
        if (off < least) {
          least = off;
          result.target = found.target[i];
          result.detection = i;
        }
      }
    if (result.detection !== undefined) lines.push(...detectionLines(result.detection));
    least = 12;
    for (const m of this.spec.marks)
      for (let i = 0; i < m.x.length; ++i) {
        const end = this.px(m.x[i] + (m.look === "bar" ? view().duration : 0));
        const off = Math.hypot(Math.max(this.px(m.x[i]) - px, px - end, 0), this.py(m.y[i]) - py);
        if (off < least) {
          least = off;
          result.target = m.target;
          result.mark = [m, i];
        }
      }
    if (result.mark) {
      const [m, i] = result.mark;
      lines.push(
        `truth: echo of ${targetName(m.target)} at ${seconds(m.x[i])}, ${told(
          this.spec.axis,
          m.y[i]
        )}, ` + decibels(m.level[i], "dB re 1 µPa")
      );
    }
    if (this.spec.axis.label === "ping") {
      result.ping = Math.round(y);
      delete result.target;
      delete result.time;
    }
    return result;
  }
}

function detectionLines(i) {
  const f = view().detections;
  const lines = [
    `found: ${foundBy(f.target[i])}, ${seconds(f.time[i])}, SNR ${text(f.snr[i], 3)} dB, ` +
      `Doppler ${text(f.doppler[i], 3)} Hz`,
  ];
  if (f.range[i] !== null)
    lines.push(
      `range ${distance(f.range[i])}` +
        (f.bearing_deg[i] === null ? "" : `, bearing ${bearing(f.bearing_deg[i])} true`)
    );
  if (f.mirror_range[i] !== null && f.mirror_bearing_deg[i] !== null)
    lines.push(`or ${distance(f.mirror_range[i])}, ${bearing(f.mirror_bearing_deg[i])} true`);
  return lines;
}

/** The scale of colours at the right of a panel. */
function bar(c, panel, [lo, hi], what, unit) {
  const b = panel.box,
    x = b.x + b.w + 10;
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

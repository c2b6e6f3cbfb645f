// Levels over time.
class Lines extends Panel {
  constructor(spec) {
    super(spec.name, spec.about, {wheel: "x", height: 240});
    this.take(spec);
  }
  take(spec) {
    this.spec = spec;
    this.section.hidden = !spec;
    if (!spec) return;
    const received = spec.lines
      .slice(0, 2)
      .flatMap((l) => l.y)
      .filter((v) => v !== null)
      .sort((a, b) => a - b);
    const all = spec.lines.flatMap((l) => l.y).filter((v) => v !== null);
    const top = (all.length ? all.reduce((a, b) => Math.max(a, b)) : 100) + 5;
    const low = (received.length ? received[Math.floor(0.02 * received.length)] : top - 60) - 10;
    const whole = [Math.max(low, top - 100), top];
    this.y = {lo: whole[0], hi: whole[1], full: whole};
    let key = this.section.querySelector(".key");
    if (!key) {
      key = document.createElement("p");
      key.className = "key";
      this.stage.after(key);
    }
    key.textContent = "";
    for (const line of spec.lines) {
      const one = document.createElement("span"),
        sample = document.createElement("i");
      one.append(sample, line.name);
      key.append(one);
    }
    this.paintKey();
  }
  colour(line) {
    return line.colour === "ink"
      ? css("--ink")
      : typeof line.colour === "number"
      ? targetColour(line.colour)
      : themed()[line.colour];
  }
  paintKey() {
    this.section.querySelectorAll(".key i").forEach((sample, i) => {
      const line = this.spec.lines[i];
      sample.style.borderTop = `2px ${line.dashed ? "dashed" : "solid"} ${this.colour(line)}`;
    });
  }
  get yLabel() {
    return "level / " + this.spec.unit;
  }
  drawData(c) {
    c.strokeStyle = css("--grid");
    c.lineWidth = 1;
    c.beginPath();
    for (const [v] of this.yTicks()) {
      c.moveTo(this.box.x, this.py(v));
      c.lineTo(this.box.x + this.box.w, this.py(v));
    }
    c.stroke();
    for (const line of this.spec.lines) {
      c.strokeStyle = this.colour(line);
      c.lineWidth = line.colour === "ink" ? 1 : 2;
      c.setLineDash(line.dashed ? [5, 2] : []);
      c.beginPath();
      let pen = false;
      line.y.forEach((v, i) => {
        if (v === null) {
          pen = false;
          return;
        }
        const x = this.px(line.first + i * line.step),
          y = this.py(v);
        if (pen) c.lineTo(x, y);
        else c.moveTo(x, y);
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
        const x = this.px(t),
          y = this.box.y + 1;
        c.beginPath();
        c.moveTo(x - size, y);
        c.lineTo(x + size, y);
        c.lineTo(x, y + 1.6 * size);
        c.fill();
        if (S.target === e.target) {
          c.fillRect(x - 0.5, y, 1, this.box.h);
        }
      }
    }
    c.globalAlpha = 1;
    this.timeLine(c);
  }
  pick(px, py) {
    const x = this.dx(px),
      lines = [seconds(x)],
      values = {};
    for (const line of this.spec.lines) {
      const v = line.y[Math.round((x - line.first) / line.step)];
      values[line.name] = v === undefined ? null : v;
      if (v !== undefined && v !== null) lines.push(`${line.name}: ${decibels(v, this.spec.unit)}`);
    }
    const result = {lines, time: x, values};
    let least = 10;
    for (const e of view().echoes)
      e.delay.forEach((t, i) => {
        const off = Math.abs(this.px(t) - px);
        if (off < least && py < this.box.y + 24) {
          least = off;
          result.target = e.target;
          result.said =
            `truth: echo of ${e.name} at ${seconds(t)}, ${decibels(e.level[i], "dB re 1 µPa")}, ` +
            `Doppler ${text(e.doppler[i], 3)} Hz`;
        }
      });
    if (result.said) lines.push(result.said);
    return result;
  }
}

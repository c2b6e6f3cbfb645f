// Rays over the sound speed and the ground.
class Rays extends Panel {
  constructor(spec) {
    super(spec.name, spec.about, {
      place: "space",
      flip: true,
      height: 330,
      left: 148,
      right: 12,
      x: {lo: 0, hi: 1, full: [0, 1]},
    });
    this.spec = spec;
    const deepest = Math.max(
      spec.bottom || 0,
      ...(spec.floor ? spec.floor.z.filter((v) => v !== null) : []),
      ...spec.profile.depth,
      spec.platform || 0
    );
    let far = Math.max(1, ...spec.targets.map((t) => (t.r > 2e7 ? 0 : t.r)));
    for (const l of spec.lines) for (const r of l.r) if (r !== null && r > far) far = r;
    const highest = Math.min(0, ...(spec.surface ? spec.surface.z.filter((v) => v !== null) : []));
    const y = [highest - 0.03 * deepest, 1.045 * deepest];
    this.y = {lo: y[0], hi: y[1], full: y};
    this.x = {lo: 0, hi: 1.02 * far, full: [0, 1.02 * far]};
    const c = spec.profile.speed,
      low = Math.min(...c),
      high = Math.max(...c),
      room = Math.max(0.12 * (high - low), 5);
    this.speeds = [low - room, high + room];
  }
  get profileBox() {
    return {x: 66, w: this.left - 66 - 10};
  }
  get tickAt() {
    return 66;
  }
  get xLabel() {
    return "range from the source / km";
  }
  get yLabel() {
    return "depth / m";
  }
  xTicks() {
    return ticks(this.x.lo / 1000, this.x.hi / 1000, this.box.w / 70).map(([v, n]) => [
      v * 1000,
      n,
    ]);
  }
  line(c, l) {
    c.beginPath();
    l.r.forEach((r, i) =>
      i ? c.lineTo(this.px(r), this.py(l.z[i])) : c.moveTo(this.px(r), this.py(l.z[i]))
    );
  }
  drawData(c) {
    const s = this.spec,
      b = this.box,
      ground = css("--ground");
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
    if (s.surface)
      s.surface.r.forEach((r, i) =>
        i
          ? c.lineTo(this.px(r), this.py(s.surface.z[i]))
          : c.moveTo(this.px(r), this.py(s.surface.z[i]))
      );
    else {
      c.moveTo(b.x, this.py(0));
      c.lineTo(b.x + b.w, this.py(0));
    }
    c.stroke();
    c.strokeStyle = css("--quiet");
    c.globalAlpha = 0.6;
    c.lineWidth = 0.7;
    for (const l of s.lines)
      if (l.target < 0) {
        this.line(c, l);
        c.stroke();
      }
    c.globalAlpha = 1;
    c.fillStyle = css("--ink");
    for (const r of s.hits) c.fillRect(this.px(r), this.py(0) - 5, 1, 10);
  }
  drawAxes(c) {
    super.drawAxes(c);
    const b = this.box,
      col = this.profileBox,
      p = this.spec.profile;
    c.fillStyle = css("--field");
    c.fillRect(col.x, b.y, col.w, b.h);
    c.save();
    c.beginPath();
    c.rect(col.x, b.y, col.w, b.h);
    c.clip();
    if (this.spec.bottom !== null) {
      c.fillStyle = css("--ground");
      c.fillRect(col.x, this.py(this.spec.bottom), col.w, b.h);
    }
    c.strokeStyle = css("--sea");
    c.lineWidth = 2;
    c.beginPath();
    p.depth.forEach((z, i) => {
      const x = this.speedAt(p.speed[i]);
      if (i) c.lineTo(x, this.py(z));
      else c.moveTo(x, this.py(z));
    });
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
  speedAt(v) {
    const col = this.profileBox;
    return col.x + (col.w * (v - this.speeds[0])) / (this.speeds[1] - this.speeds[0]);
  }
  drawChosen(c) {
    const s = this.spec;
    for (const l of s.lines)
      if (l.target >= 0) {
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
    const part = (time - l.t[i]) / (l.t[i + 1] - l.t[i] || 1);
    return [l.r[i] + part * (l.r[i + 1] - l.r[i]), l.z[i] + part * (l.z[i + 1] - l.z[i])];
  }
  pick(px, py) {
    const r = this.dx(px),
      z = this.dy(py),
      p = this.spec.profile,
      lines = [];
    const result = {lines, r, z};
    lines.push(`range ${distance(r)}, depth ${text(z)} m`);
    if (z >= p.depth[0] && z <= p.depth[p.depth.length - 1]) {
      const i = between(p.depth, z),
        part = (z - p.depth[i]) / (p.depth[i + 1] - p.depth[i]);
      result.speed = p.speed[i] + part * (p.speed[i + 1] - p.speed[i]);
      lines.push(
        `sound speed ${result.speed.toFixed(1)} m/s` +
          (this.spec.floor || this.spec.surface ? " at the source" : "")
      );
    }
    let least = 10,
      best = null;
    for (const l of this.spec.lines)
      for (let i = 1; i < l.r.length; ++i) {
        const ax = this.px(l.r[i - 1]),
          ay = this.py(l.z[i - 1]),
          bx = this.px(l.r[i]),
          by = this.py(l.z[i]);
        const dx = bx - ax,
          dy = by - ay,
          d2 = dx * dx + dy * dy;
        const u = d2 ? Math.max(0, Math.min(1, ((px - ax) * dx + (py - ay) * dy) / d2)) : 0;
        const off = Math.hypot(ax + u * dx - px, ay + u * dy - py) - (l.target >= 0 ? 2 : 0);
        if (off < least) {
          least = off;
          best = [l, i, u];
        }
      }
    if (best) {
      const [l, i, u] = best;
      lines.push(
        `${l.target >= 0 ? "eigenray to " + targetName(l.target) : "ray"}, launched at ` +
          `${l.launch >= 0 ? "+" : "−"}${Math.abs(l.launch).toFixed(2)}°`
      );
      if (l.t) {
        result.travel = l.t[i - 1] + u * (l.t[i] - l.t[i - 1]);
        lines.push(`${seconds(result.travel)} after the ping`);
        if (this.spec.there_and_back && view().ping === this.spec.ping)
          result.time = 2 * result.travel;
      }
      if (l.target >= 0) result.target = l.target;
    }
    for (const t of this.spec.targets)
      if (Math.hypot(this.px(t.r) - px, this.py(t.z) - py) < 11) {
        result.target = t.target;
        lines.push(
          `${targetName(t.target)}: range ${distance(t.r)}, depth ${text(t.z)} m` +
            (t.there ? "" : ", not there in this ping")
        );
      }
    return result;
  }
}

// Axes of directions, Doppler and pings: what a place on them is called.
const radians = (d) => (d * Math.PI) / 180,
  degrees = (r) => (r * 180) / Math.PI;
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
  const place =
    axis.kind === "cosine"
      ? (d) => -Math.cos(radians(d))
      : axis.kind === "sine"
      ? (d) => axis.upwards * Math.sin(radians(d))
      : (d) => d;
  const name =
    axis.kind === "cosine"
      ? (d) => `${text(turned(axis.ahead + d), 4).replace(/\.0+$/, "")}°`
      : axis.kind === "sine"
      ? (d) => (d > 0 ? "+" : "") + String(d).replace("-", "−") + "°"
      : (d) => `${d}°`;
  const [first, last] =
    axis.kind === "cosine" ? [0, 180] : axis.kind === "sine" ? [-90, 90] : [0, 360];
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
      const gap = ((hi - lo) * 13) / pixels;
      return found.filter((t, k) =>
        k === 0 || k === found.length - 1
          ? k === 0 || t[0] - found[0][0] >= gap
          : t[0] - found[k - 1][0] >= gap && found[found.length - 1][0] - t[0] >= gap
      );
    }
  }
  return [];
}

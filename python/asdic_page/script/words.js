// Words and numbers as people read them.
function text(value, figures = 4) {
  if (value === null || !isFinite(value)) return "–";
  const digits = Math.max(0, figures - 1 - Math.floor(Math.log10(Math.abs(value) || 1)));
  return value.toFixed(Math.min(digits, 6)).replace("-", "−");
}
const seconds = (t) => t.toFixed(3) + " s";
const decibels = (v, unit) =>
  v === null ? "no value" : v.toFixed(1).replace("-", "−") + " " + unit;
const distance = (r) =>
  Math.abs(r) >= 1000
    ? (r / 1000).toFixed(3).replace("-", "−") + " km"
    : r.toFixed(1).replace("-", "−") + " m";
const turned = (b) => ((b % 360) + 360) % 360;
const bearing = (b) =>
  turned(b)
    .toFixed(1)
    .replace(/^360\.0/, "0.0") + "°";
const targetName = (i) => D.targets[i] || "target " + (i + 1);
const isDark = () => getComputedStyle(document.documentElement).colorScheme.includes("dark");
const themed = () => D.themes[isDark() ? "dark" : "light"];
const targetColour = (i) =>
  i >= 0 ? themed().targets[i % themed().targets.length] : css("--quiet");
const foundBy = (i) =>
  i >= 0
    ? "echo of " + targetName(i)
    : i === -2
    ? "the transmitter's own sound"
    : i === -3
    ? "of another ping"
    : "false alarm";
const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** Round steps that divide a span into about `count`. */
function ticks(lo, hi, count) {
  const rough = (hi - lo) / Math.max(count, 1);
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((k) => k * power).find((s) => s >= rough) || 10 * power;
  const found = [];
  for (let k = Math.ceil(lo / step - 1e-9); k * step <= hi + 1e-9 * step; ++k)
    found.push([
      k * step,
      (Math.abs(k * step) < 1e-12 * step ? 0 : k * step)
        .toFixed(Math.max(0, -Math.floor(Math.log10(step) + 1e-9)))
        .replace("-", "−"),
    ]);
  return found;
}

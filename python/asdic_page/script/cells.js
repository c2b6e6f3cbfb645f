// Matrices of the page and the colours of their values.
const LUT = new Uint32Array(
  D.colours.map((c) => {
    const n = parseInt(c, 16);
    return (0xff000000 | ((n & 255) << 16) | (n & 0xff00) | (n >> 16)) >>> 0;
  })
);
const colourOf = (v, [lo, hi]) =>
  LUT[Math.max(0, Math.min(255, Math.floor((256 * (v - lo)) / (hi - lo))))];

/** A matrix of the page: 16 bits a value. */
class Cells {
  constructor(packed) {
    const bytes = Uint8Array.from(atob(packed.data), (c) => c.charCodeAt(0));
    this.values = new Uint16Array(bytes.buffer);
    Object.assign(this, {
      rows: packed.rows,
      columns: packed.columns,
      low: packed.low,
      step: packed.step,
    });
  }
  whole(row, column) {
    return this.values[row * this.columns + column];
  }
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
  let a = 0,
    b = edges.length - 1;
  if (!(v >= edges[0] && v <= edges[b])) return -1;
  while (b - a > 1) {
    const m = (a + b) >> 1;
    if (edges[m] <= v) a = m;
    else b = m;
  }
  return a;
}
function nearest(values, v) {
  let best = -1,
    least = Infinity;
  for (let i = 0; i < values.length; ++i) {
    const off = Math.abs(values[i] - v);
    if (off < least) {
      least = off;
      best = i;
    }
  }
  return best;
}

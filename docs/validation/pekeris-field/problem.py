"""The Pekeris guide, asdic against a wavenumber integral."""
from pathlib import Path

import numpy as np
import suite

NAME = "Pekeris guide, field"
TRUTH = "wavenumber integral"
QUICK = True


def compare(asdic, truth):
    found = asdic.field(Path(__file__).with_name("scenario.toml"))
    tl, exact = suite.loss(found.pressure), suite.loss(truth.pressure(found.range, found.depth))
    off = tl - exact
    near, far = found.range <= 5000, found.range > 5000
    shown = [np.abs(found.range - r).argmin() for r in (200.0, 1000.0, 2000.0, 5000.0, 10000.0)]

    def mean(p, where):     # energy, range averaged: what does not hang on nulls
        return suite.db((np.abs(p[:, where]) ** 2).mean(axis=1))

    p = truth.pressure(found.range, found.depth)
    averages = [mean(found.pressure, w) - mean(p, w) for w in (near, far)]

    def draw(axes, style):
        axes.plot(found.range / 1e3, exact[0], color=style.INK, lw=2.2, label="wavenumber integral")
        axes.plot(found.range / 1e3, tl[0], color=style.VERMILION, lw=1.0, ls="--", label="asdic")
        axes.set(xlabel="range / km", ylabel="transmission loss / dB", ylim=(90, 40))
        axes.legend(title="receiver at 100 m")

    rows = [[f"{found.depth[i]:.0f}", f"{found.range[j]:.0f}", f"{exact[i, j]:.3f}",
             f"{tl[i, j]:.3f}", f"{off[i, j]:+.3f}"] for i in (0, 1) for j in shown]
    return suite.Result(
        [suite.Check("median of 198 receivers", float(np.median(np.abs(off))), 0.5),
         suite.Check("mean energy, 0.2–5 km, worse of 2 depths", float(max(averages[0], key=abs)),
                     0.2),
         suite.Check("mean energy, 5–10 km, worse of 2 depths", float(max(averages[1], key=abs)),
                     0.2),
         suite.Check("95 % of 198 receivers", suite.percentile(off), 1.0)],
        ["depth / m", "range / m", "truth / dB", "asdic / dB", "difference / dB"], rows, draw)

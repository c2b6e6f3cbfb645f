"""Convergence zones, asdic against Numerov's wavenumber integral: lit windows and dark ones
apart."""
from pathlib import Path

import numpy as np
import suite
import truth_waves as waves

NAME = "Munk's convergence zones"
TRUTH = "wavenumber integral (Numerov)"
QUICK = False
LIT, DEEPEST = 92.0, 125.0      # TL [dB]: lit up to, compared up to


def compare(asdic, truth):
    found = asdic.field(Path(__file__).with_name("scenario.toml"))
    centres = np.arange(34e3, 70.1e3, 1e3)
    exact = waves.windows(truth.pressure(50.0, found.range, found.depth), found.range, centres, truth.HALF)
    tl = waves.windows(np.maximum(np.abs(found.pressure), 1e-20), found.range, centres, truth.HALF)
    off, lit, dark = tl - exact, exact < LIT, (exact >= LIT) & (exact < DEEPEST)

    def draw(axes, style):
        for i, colour in enumerate((style.BLUE, style.VERMILION)):
            axes.plot(centres / 1e3, exact[i], color=colour, lw=1.6,
                      label=f"{found.depth[i]:.0f} m, truth")
            axes.plot(centres / 1e3, np.where(tl[i] < 200, tl[i], np.nan), "o", ms=4, mfc="white",
                      color=colour, label=f"{found.depth[i]:.0f} m, asdic")
        axes.set(xlabel="range / km", ylabel="transmission loss / dB", ylim=(140, 70))
        axes.legend(fontsize=8)

    rows = [[f"{z:.0f}", f"{c / 1e3:.0f}", f"{exact[i, j]:.2f}",
             *((f"{tl[i, j]:.2f}", f"{off[i, j]:+.2f}") if tl[i, j] < 300 else ("silence", "—"))]
            for i, z in enumerate(found.depth) for j, c in enumerate(centres)
            if exact[i, j] < DEEPEST and j % 2 == 0]
    return suite.Result([suite.Check(f"median of {lit.sum()} lit windows (TL below {LIT:g} dB)",
                                     float(np.median(np.abs(off[lit]))), 0.5),
                         suite.Check(f"of {lit.sum()} lit windows, off by more than 2 dB",
                                     int(np.sum(np.abs(off[lit]) > 2.0)), 0, "windows"),
                         suite.Check(f"of {dark.sum()} dark windows to TL {DEEPEST:g} dB, off by more than 3 dB",
                                     int(np.sum(np.abs(off[dark]) > 3.0)), 0, "windows")],
                        ["depth / m", "range / km", "truth / dB", "asdic / dB", "difference / dB"],
                        rows, draw)

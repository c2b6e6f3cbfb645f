"""A leaky surface duct, asdic against Numerov's wavenumber integral: windows in the duct and below
it."""
from pathlib import Path

import numpy as np
import suite
import truth_waves as waves

NAME = "Leaky surface duct"
TRUTH = "wavenumber integral (Numerov)"
QUICK = False


def compare(asdic, truth):
    scenario = Path(__file__).with_name("scenario.toml")
    centres = np.array([5000.0, 10000.0, 15000.0, 20000.0])
    inside, below, rows, curve = [], [], [], []
    for frequency in (500.0, 1000.0):
        found = asdic.field(scenario, run__frequency=frequency)
        every = np.unique(np.concatenate([np.flatnonzero(np.abs(found.range - c) <= 500.0)
                                          for c in centres])[::2])
        ranges = found.range[every]
        exact = waves.windows(truth.pressure(frequency, ranges, found.depth), ranges, centres, truth.HALF)
        tl = waves.windows(np.maximum(np.abs(found.pressure[:, every]), 1e-20), ranges, centres, truth.HALF)
        off = tl - exact
        inside += list(off[0])
        below += list(off[1:].ravel())
        rows += [[f"{frequency:.0f}", f"{z:.0f}", f"{c / 1e3:.0f}", f"{exact[i, j]:.2f}",
                  *((f"{tl[i, j]:.2f}", f"{off[i, j]:+.2f}") if tl[i, j] < 300
                    else ("silence", "—"))]
                 for i, z in enumerate(found.depth) for j, c in enumerate(centres)]
        curve.append((frequency, exact, tl))
    inside, below = np.array(inside), np.array(below)

    def draw(axes, style):
        for frequency, exact, tl in curve:
            colour = style.BLUE if frequency == 500.0 else style.VERMILION
            for i, marker in enumerate("o^s"):
                received = np.where(tl[i] < 300, tl[i], np.nan)
                axes.plot(centres / 1e3, exact[i], color=colour, marker=marker, ms=4, lw=1.2,
                          label=f"{frequency:.0f} Hz, {(40, 100, 150)[i]} m")
                axes.plot(centres / 1e3, received, color=colour, marker=marker, mfc="white", ms=6,
                          ls="none")
        axes.set(xlabel="range / km (lines: truth, open marks: asdic)",
                 ylabel="transmission loss / dB", ylim=(125, 65))
        axes.legend(ncol=2, fontsize=7)

    return suite.Result(
        [suite.Check(f"of {len(inside)} windows in the duct, off by more than 2 dB",
                     int(np.sum(np.abs(inside) > 2.0)), 0, "windows"),
         suite.Check(f"of {len(below)} windows below the duct, off by more than 3 dB",
                     int(np.sum(np.abs(below) > 3.0)), 0, "windows")],
        ["frequency / Hz", "depth / m", "range / km", "truth / dB", "asdic / dB",
         "difference / dB"], rows, draw)

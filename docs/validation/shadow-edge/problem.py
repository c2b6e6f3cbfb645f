"""A shadow's edge, asdic against an Airy integral, lit side and dark side apart."""
from pathlib import Path

import numpy as np
import suite
import truth_waves as waves

NAME = "Shadow behind a limiting ray"
TRUTH = "Airy wavenumber integral"
QUICK = True

DEEPEST = 130.0     # TL [dB] down to which the shadow counts


def compare(asdic, truth):
    scenario = Path(__file__).with_name("scenario.toml")
    centres = np.arange(2150.0, 5551.0, 100.0)
    lit, dark, rows, curves = [], [], [], []
    for frequency in (500.0, 1000.0, 3500.0):
        found = asdic.field(scenario, run__frequency=frequency)
        exact = waves.windows(truth.pressure(frequency, found.range), found.range, centres, truth.HALF)
        tl = waves.windows(np.maximum(np.abs(found.pressure[0]), 1e-20), found.range, centres, truth.HALF)
        off = tl - exact
        lit += list(off[centres < truth.edge() - 100])
        dark += list(off[(centres > truth.edge() - 100) & (exact < DEEPEST)])
        rows += [[f"{frequency:.0f}", f"{c - truth.edge():+.0f}", f"{t:.2f}",
                  f"{a:.2f}" if a < 399 else "silence", f"{d:+.2f}" if a < 399 else "—"]
                 for c, t, a, d in list(zip(centres, exact, tl, off))[::4] if t < DEEPEST]
        curves.append((frequency, exact, tl))

    def draw(axes, style):
        for (frequency, exact, tl), colour in zip(curves,
                                                  (style.BLUE, style.GREEN, style.VERMILION)):
            seen = exact < 150
            axes.plot((centres[seen] - truth.edge()) / 1e3, exact[seen], color=colour, lw=2.0,
                      alpha=0.6, label=f"{frequency:.0f} Hz, truth")
            axes.plot((centres - truth.edge()) / 1e3, np.where(tl < 200, tl, np.nan), color=colour,
                      lw=1.0, ls="--", label="asdic")
        axes.axvline(0.0, color=style.GREY, lw=0.8)
        axes.set(xlabel="range from the limiting ray / km", ylabel="transmission loss / dB",
                 ylim=(150, 60))
        axes.legend(ncol=3, fontsize=7)

    dark = np.array(dark)
    return suite.Result(
        [suite.Check(f"{len(lit)} lit windows, worst", float(max(lit, key=abs)), 2.0),
         suite.Check(f"of {len(dark)} windows at the edge and behind it to TL 130 dB, off by more than 3 dB",
                     int(np.sum(np.abs(dark) > 3.0)), 0, "windows")],
        ["frequency / Hz", "from the edge / m", "truth / dB", "asdic / dB", "difference / dB"],
        rows, draw)

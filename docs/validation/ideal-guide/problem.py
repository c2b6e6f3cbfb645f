"""The ideal guide, asdic against modes."""
from pathlib import Path

import numpy as np
import suite

NAME = "Ideal guide"
TRUTH = "mode sum, checked by images"
QUICK = True


def compare(asdic, truth):
    found = asdic.field(Path(__file__).with_name("scenario.toml"))
    tl, exact = suite.loss(found.pressure), suite.loss(truth.pressure(found.range, found.depth))
    off = tl - exact
    shown = [np.abs(found.range - r).argmin() for r in (200.0, 1000.0, 2000.0, 3000.0, 5000.0)]
    two_sums = float(np.abs(suite.loss(truth.pressure(found.range[:1], found.depth))
                            - suite.loss(truth.pressure_of_images(found.range[:1],
                                found.depth))).max())

    def draw(axes, style):
        axes.plot(found.range / 1e3, exact[0], color=style.INK, lw=2.2, label="modes")
        axes.plot(found.range / 1e3, tl[0], color=style.VERMILION, lw=1.0, ls="--", label="asdic")
        axes.set(xlabel="range / km", ylabel="transmission loss / dB", ylim=(85, 35))
        axes.legend(title="receiver at 25 m")

    rows = [[f"{found.depth[i]:.0f}", f"{found.range[j]:.0f}", f"{exact[i, j]:.3f}",
             f"{tl[i, j]:.3f}", f"{off[i, j]:+.5f}"] for i in (0, 1) for j in shown]
    return suite.Result([suite.Check("95 % of 482 receivers", suite.percentile(off), 0.05)],
                        ["depth / m", "range / m", "truth / dB", "asdic / dB", "difference / dB"],
                        rows, draw,
                        [f"Modes and images of the truth itself agree to {two_sums:.1g} dB at 200 m."])

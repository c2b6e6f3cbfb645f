"""Lloyd's mirror, asdic against two terms."""
from pathlib import Path

import numpy as np
import suite

NAME = "Lloyd's mirror"
TRUTH = "two images, closed form"
QUICK = True


def compare(asdic, truth):
    found = asdic.field(Path(__file__).with_name("scenario.toml"))
    tl, exact = suite.loss(found.pressure[0]), suite.loss(truth.pressure(found.range))
    off = tl - exact
    shown = [np.abs(found.range - r).argmin() for r in (200.0, 500.0, 1000.0, 2000.0, 5000.0,
                                                        10000.0)]

    def draw(axes, style):
        axes.plot(found.range / 1e3, exact, color=style.INK, lw=2.2, label="two images")
        axes.plot(found.range / 1e3, tl, color=style.VERMILION, lw=1.0, ls="--", label="asdic")
        axes.set(xlabel="range / km", ylabel="transmission loss / dB", ylim=(110, 30))
        axes.legend()

    return suite.Result([suite.Check("largest of 397 ranges", float(np.abs(off).max()), 0.05)],
                        ["range / m", "truth / dB", "asdic / dB", "difference / dB"],
                        [[f"{found.range[i]:.0f}", f"{exact[i]:.3f}", f"{tl[i]:.3f}",
                          f"{off[i]:+.4f}"] for i in shown], draw)

"""Target echoes, asdic's pairs of paths against the energy of all images."""
from pathlib import Path

import h5py
import numpy as np
import suite

NAME = "Target echoes in a guide"
TRUTH = "energy of all images"
QUICK = True
RANGES = np.array([2000.0, 5000.0, 10000.0])
MANY = {"propagation__max_bottom_bounces": 30, "propagation__max_surface_bounces": 30}


def levels(file):
    """Sum of the energies of every pair of paths, by target [dB re 1 µPa²]"""
    with h5py.File(file) as f:
        echoes = f["echoes"]
        return np.array([suite.db((10 ** (0.1
                                          * echoes["level_db"][:][echoes["target"][:] == k])).sum())
                                          for k in range(len(RANGES))])


def compare(asdic, truth):
    scenario = Path(__file__).with_name("scenario.toml")
    exact = np.array([truth.level(r) for r in RANGES])
    default, many = levels(asdic.ping(scenario)), levels(asdic.ping(scenario, **MANY))

    def draw(axes, style):
        r = np.geomspace(1500.0, 12000.0, 40)
        axes.plot(r / 1e3, [truth.level(x) for x in r], color=style.INK, lw=2.0, label="all images")
        axes.plot(RANGES / 1e3, many, "o", color=style.BLUE, label="asdic, 30 bounces")
        axes.plot(RANGES / 1e3, default, "s", color=style.VERMILION, label="asdic, default bounces")
        axes.set(xlabel="range of the target / km", ylabel="echo level / dB re 1 µPa²",
                 xscale="log")
        axes.legend()

    return suite.Result([suite.Check("30 bounces, worst of 3 targets",
                                     float(max(many - exact, key=abs)), 0.1),
                         suite.Check("default bounces, worst of 3 targets",
                                     float(max(default - exact, key=abs)), 1.0)],
                        ["range / m", "truth / dB", "30 bounces / dB", "difference / dB",
                         "default / dB", "difference / dB"],
                        [[f"{r:.0f}", f"{e:.3f}", f"{m:.3f}", f"{m - e:+.3f}", f"{d:.3f}",
                          f"{d - e:+.3f}"] for r, e, m, d in zip(RANGES, exact, many, default)],
                          draw)

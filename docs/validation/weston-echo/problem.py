"""Target echoes, asdic's paths against the energy of all images."""
from pathlib import Path

import h5py
import numpy as np
import suite

NAME = "Target echoes in a guide"
TRUTH = "energy of all images"
QUICK = True
RANGES = np.array([2000.0, 5000.0, 10000.0])
MANY = {"propagation__max_bottom_bounces": 30, "propagation__max_surface_bounces": 30}


def levels(file, truth):
    """Energies of all paths out times those of all paths home, by target [dB re 1 µPa²]"""
    with h5py.File(file) as f:
        paths = f["arrivals"]
        energy = paths["amplitude_real"][:]**2 + paths["amplitude_imag"][:]**2
        leg, target = paths["leg"][:], paths["target"][:]
        return np.array([truth.LEVEL + truth.STRENGTH
                         + suite.db(energy[(leg == 0) & (target == k)].sum()
                                    * energy[(leg == 1) & (target == k)].sum())
                         for k in range(len(RANGES))])


def compare(asdic, truth):
    scenario = Path(__file__).with_name("scenario.toml")
    exact = np.array([truth.level(r) for r in RANGES])
    default = levels(asdic.ping(scenario), truth)
    many = levels(asdic.ping(scenario, **MANY), truth)

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

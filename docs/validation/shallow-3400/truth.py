#!/usr/bin/env python3
"""Bottom reverberation in 19 m of water at 3.4 kHz: energies of all images, with Thorp's
absorption. Prints levels [dB]."""
import sys
from pathlib import Path

import numpy as np

sys.path[:0] = [str(Path(__file__).resolve().parents[1])]
import truth_energy as energy  # noqa: E402

DEPTH, SOURCE, RECEIVER = 19.0, 17.8, 8.0
WATER, BOTTOM = (1525.0, 1025.0), (1680.0, 1950.0, 0.6)
LEVEL, MU, PULSE, FREQUENCY = 200.0, -27.0, 0.1, 3400.0


def thorp(frequency):
    """dB/km; Jensen et al. (2011), eq. 1.47"""
    f2 = (frequency / 1e3) ** 2
    return 3.3e-3 + 0.11 * f2 / (1 + f2) + 44 * f2 / (4100 + f2) + 3e-4 * f2


def levels(times, width=0.5):
    """Means over `width` about each time [dB re 1 µPa²]."""
    last = max(times) + width
    grid = energy.Grid(0.5 * last * WATER[0] + 10.0, last, ring=4.0, bin_=0.002)
    legs = [energy.image_leg(grid, z, DEPTH, WATER[0], lambda g: energy.rayleigh(g, WATER, BOTTOM))
            for z in (SOURCE, RECEIVER)]
    lossless = energy.reverberation(grid, *legs, MU, LEVEL, PULSE, times, width)
    # both legs together are c·t long
    return lossless - thorp(FREQUENCY) * (np.asarray(times) - PULSE / 2) * WATER[0] / 1e3


if __name__ == "__main__":
    at = np.array([0.5, 1.0, 1.5, 3.0])
    print([f"{t:g} s {x:.3f}" for t, x in zip(at, levels(at))])

#!/usr/bin/env python3
"""Bottom reverberation under a summer profile, all paths: energies of a fan of rays, arcs of
circles. Prints levels [dB]."""
import sys
from pathlib import Path

import numpy as np

sys.path[:0] = [str(Path(__file__).resolve().parents[1])]
import truth_energy as energy  # noqa: E402

PROFILE = [(0.0, 1530.0), (20.0, 1530.0), (40.0, 1490.0), (100.0, 1490.0)]
SOURCE, RECEIVER = 30.0, 50.0
WATER, BOTTOM = (1490.0, 1000.0), (1700.0, 2000.0, 0.5)     # at the floor
LEVEL, MU, PULSE = 220.0, -27.0, 0.2


def levels(times):
    """Means over ± 0.5 s [dB re 1 µPa²]."""
    last = max(times) + 0.6
    grid = energy.Grid(0.5 * last * 1530.0 + 50.0, last)
    legs = [energy.ray_leg(grid, z, PROFILE, lambda g: energy.rayleigh(g, WATER, BOTTOM), 5000)
            for z in (SOURCE, RECEIVER)]
    return energy.reverberation(grid, *legs, MU, LEVEL, PULSE, times)


if __name__ == "__main__":
    at = np.array([3.0, 4.0, 6.0, 10.0, 14.0, 18.0])
    print([f"{t:g} s {x:.3f}" for t, x in zip(at, levels(at))])

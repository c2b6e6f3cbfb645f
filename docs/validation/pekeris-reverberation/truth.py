#!/usr/bin/env python3
"""Bottom reverberation of a Pekeris guide, all paths: energies of images over range and delay, and
beside them a fan of rays. Prints both [dB]."""
import sys
from pathlib import Path

import numpy as np

sys.path[:0] = [str(Path(__file__).resolve().parents[1])]
import truth_energy as energy  # noqa: E402

DEPTH, SOURCE, RECEIVER = 100.0, 30.0, 50.0
WATER, BOTTOM = (1500.0, 1000.0), (1700.0, 2000.0, 0.5)
LEVEL, MU, PULSE = 220.0, -27.0, 0.2


def reflection(grazing):
    return energy.rayleigh(grazing, WATER, BOTTOM)


def levels(times, by=energy.image_leg):
    """Means over ± 0.5 s [dB re 1 µPa²]. The grid reaches as far as sound can come from by the last
    time."""
    last = max(times) + 0.6
    grid = energy.Grid(0.5 * last * WATER[0] + 50.0, last)
    water = {energy.image_leg: WATER[0], energy.ray_leg: None}[by]
    legs = [by(grid, z, DEPTH, water, reflection) if water
            else by(grid, z, [(0.0, WATER[0]), (DEPTH, WATER[0])], reflection, 5000)
            for z in (SOURCE, RECEIVER)]
    return energy.reverberation(grid, *legs, MU, LEVEL, PULSE, times)


if __name__ == "__main__":
    at = np.array([2.0, 4.0, 6.0, 10.0, 14.0, 18.0, 20.0])
    for t, image, fan in zip(at, levels(at), levels(at, energy.ray_leg)):
        print(f"{t:5.1f} s  images {image:8.3f}  fan {fan:8.3f}")

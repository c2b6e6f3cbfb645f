#!/usr/bin/env python3
"""Bottom reverberation of a guide that loses nothing: a closed form, and all images beside it.
Prints both [dB]."""
import sys
from pathlib import Path

import numpy as np

sys.path[:0] = [str(Path(__file__).resolve().parents[1])]
import truth_energy as energy  # noqa: E402

DEPTH, SOURCE, RECEIVER, SPEED = 100.0, 30.0, 50.0, 1500.0
LEVEL, MU, PULSE = 220.0, -27.0, 0.2


def levels(times):
    """SL + 10 lg(2π μ E/(H² t)), E = 3/8 T, t from the pulse's middle; mean over ± 0.5 s [dB re 1
    µPa²]."""
    fine = np.asarray(times)[:, None] - PULSE / 2 + np.linspace(-0.5, 0.5, 101)
    return LEVEL + MU + 10 * np.log10((2 * np.pi * 0.375 * PULSE / (DEPTH**2 * fine)).mean(axis=1))


def levels_of_images(times):
    last = max(times) + 0.6
    grid = energy.Grid(0.5 * last * SPEED + 50.0, last)
    legs = [energy.image_leg(grid, z, DEPTH, SPEED, np.ones_like) for z in (SOURCE, RECEIVER)]
    return energy.reverberation(grid, *legs, MU, LEVEL, PULSE, times)


if __name__ == "__main__":
    at = np.array([3.0, 6.0, 12.0, 18.0])
    for t, law, image in zip(at, levels(at), levels_of_images(at)):
        print(f"{t:5.1f} s  law {law:8.3f}  images {image:8.3f}")

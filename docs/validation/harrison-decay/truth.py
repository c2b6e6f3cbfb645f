#!/usr/bin/env python3
"""Late reverberation of a guide with linear bottom loss, in closed form after Harrison, and by the
energies of all images. Prints both [dB]."""
import sys
from pathlib import Path

import numpy as np

sys.path[:0] = [str(Path(__file__).resolve().parents[1])]
import truth_energy as energy  # noqa: E402

DEPTH, SOURCE, RECEIVER, SPEED = 60.0, 30.0, 50.0, 1500.0
ALPHA = 3.0                         # |R|² = e^{−αθ} [1/rad]
LEVEL, MU, PULSE = 220.0, -27.0, 0.2


def closed_form(times):
    """π μ c E/(α² r³) (1 + α√π/(4√β) + α²/8β)², r = c(t − T/2)/2, β = αr/2H; mean over ± 0.5 s [dB
    re 1 µPa²]."""
    r = 0.5 * SPEED * (np.asarray(times)[:, None] - PULSE / 2 + np.linspace(-0.5, 0.5, 101))
    beta = ALPHA * r / (2 * DEPTH)
    bounce_itself = (1 + ALPHA * np.sqrt(np.pi) / (4 * np.sqrt(beta)) + ALPHA**2 / (8 * beta)) ** 2
    return LEVEL + MU + 10 * np.log10((np.pi * SPEED * 0.375 * PULSE / (ALPHA**2 * r**3)
                                       * bounce_itself).mean(axis=1))


def levels(times):
    """By images, every pair [dB re 1 µPa²]."""
    last = max(times) + 0.6
    grid = energy.Grid(0.5 * last * SPEED + 50.0, last)
    legs = [energy.image_leg(grid, z, DEPTH, SPEED, lambda g: np.exp(-ALPHA * g))
            for z in (SOURCE, RECEIVER)]
    return energy.reverberation(grid, *legs, MU, LEVEL, PULSE, times)


if __name__ == "__main__":
    at = np.array([2.0, 4.0, 6.0, 8.0, 12.0, 20.0])
    for t, law, image in zip(at, closed_form(at), levels(at)):
        print(f"{t:5.1f} s  closed form {law:8.3f}  images {image:8.3f}")

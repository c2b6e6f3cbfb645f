#!/usr/bin/env python3
"""Convergence zones in Munk's ocean at 50 Hz: Numerov's depth equation for every wavenumber,
integrated below the axis. Prints window means of TL [dB]."""
import sys
from pathlib import Path

import numpy as np

sys.path[:0] = [str(Path(__file__).resolve().parents[1])]
import truth_waves as waves  # noqa: E402

SOURCE, DEEP, ABSORB = 1000.0, 5000.0, 3000.0
HALF = 500.0    # of a window of ranges [m]


def munk(z):
    x = 2.0 * (z - 1300.0) / 1300.0
    return 1500.0 * (1.0 + 0.00737 * (x - 1.0 + np.exp(-x)))


def pressure(frequency, ranges, receivers, step=1.0):
    """→ complex [receivers, ranges], exp(−iωt). Grazing angles to 18° at the source are kept (taper
    to 22°): steeper ones meet the floor and are gone."""
    omega = 2 * np.pi * frequency
    k0 = omega / munk(SOURCE)
    steep, flat = k0 * np.cos(np.radians(22.0)), omega / 1490.0
    k, dk = waves.contour(steep, flat, np.max(ranges))
    green = waves.numerov_green(k, omega, munk, step, DEEP, SOURCE, receivers, ABSORB)
    green *= waves.taper(k, (steep, k0 * np.cos(np.radians(18.0))), (omega / 1496.0, flat))
    return waves.integrate(green, k, dk, ranges)


if __name__ == "__main__":
    at = np.arange(34e3, 70.1e3, 2e3)
    r = np.concatenate([np.arange(c - 500.0, c + 501.0, 50.0) for c in at])
    for row, z in zip(waves.windows(pressure(50.0, r, [200.0, 800.0]), r, at, HALF), (200, 800)):
        print(z, [f"{c / 1e3:.0f} km {t:.2f}" for c, t in zip(at, row)])

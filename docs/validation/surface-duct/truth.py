#!/usr/bin/env python3
"""Leakage of a 60 m surface duct: Numerov's depth equation for every wavenumber, integrated below
the axis. Prints window means of TL [dB]."""
import sys
from pathlib import Path

import numpy as np

sys.path[:0] = [str(Path(__file__).resolve().parents[1])]
import truth_waves as waves  # noqa: E402

DEPTHS = np.array([0.0, 60.0, 160.0, 360.0, 1000.0, 5000.0])
SPEEDS = np.array([1510.0, 1510.96, 1500.96, 1490.96, 1487.76, 1551.76])
SOURCE, DEEP, ABSORB = 10.0, 500.0, 500.0
HALF = 500.0    # of a window of ranges [m]
# Below 360 m everything refracts down and comes back beyond 25 km: 500 m of it and a layer that
# absorbs stand for the rest.


def pressure(frequency, ranges, receivers, steps=20):
    """→ complex [receivers, ranges], exp(−iωt). Grazing angles to 12° at the source are kept (taper
    to 16°); `steps` a wavelength, rounded so
    that knots of the profile fall on steps (10 m divided by a whole number)."""
    omega = 2 * np.pi * frequency
    k0 = omega / SPEEDS[0]
    step = 10.0 / np.ceil(10.0 * steps * frequency / SPEEDS[0])
    steep, flat = k0 * np.cos(np.radians(16.0)), omega / 1507.0
    k, dk = waves.contour(steep, flat, np.max(ranges))
    green = waves.numerov_green(k, omega, lambda z: np.interp(z, DEPTHS, SPEEDS), step, DEEP,
                                SOURCE, receivers, ABSORB)
    green *= waves.taper(k, (steep, k0 * np.cos(np.radians(12.0))), (omega / 1508.5, flat))
    return waves.integrate(green, k, dk, ranges)


if __name__ == "__main__":
    at = np.array([5000.0, 10000.0, 20000.0])
    r = np.concatenate([np.arange(c - 500.0, c + 501.0, 20.0) for c in at])
    for f in (500.0, 1000.0):
        print(f, np.round(waves.windows(pressure(f, r, [40.0, 100.0, 150.0]), r, at, HALF), 2).tolist())

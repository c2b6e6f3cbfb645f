#!/usr/bin/env python3
"""Table 5.6 of the thesis by Snell's law and quadrature, and Tables 5.1's levels by the sonar
equation. Prints angles [deg], times [s], levels [dB]."""
import numpy as np
from scipy.optimize import brentq

VEHICLE, TARGET = 4500.0, 125.0
# range [m]: printed launch angle of the direct path, and of the one by the surface [deg up]
PRINTED = {5000.0: (40.0, 41.0), 7000.0: (30.0, 32.0), 9000.0: (23.0, 25.0), 17000.0: (9.0, 11.0),
           22000.0: (5.0, 6.0)}
NODES, WEIGHTS = np.polynomial.legendre.leggauss(200)


def munk(z):
    x = 2.0 * (z - 1300.0) / 1300.0
    return 1500.0 * (1.0 + 0.00737 * (x - 1.0 + np.exp(-x)))


def leg(elevation, top, bottom):
    """Horizontal range and time of a ray that leaves the vehicle at `elevation` [rad], between two
    depths; ∞ where it turns before."""
    z = 0.5 * (top + bottom) + 0.5 * (bottom - top) * NODES
    w = 0.5 * (bottom - top) * WEIGHTS
    cos = munk(z) * np.cos(elevation) / munk(VEHICLE)
    if np.any(cos >= 1.0):
        return np.inf, np.inf
    sin = np.sqrt(1.0 - cos**2)
    return np.sum(w * cos / sin), np.sum(w / (munk(z) * sin))


def path(elevation, by_surface):
    r, t = leg(elevation, TARGET, VEHICLE)
    if by_surface:
        r0, t0 = leg(elevation, 0.0, TARGET)
        r, t = r + 2 * r0, t + 2 * t0
    return r, t


def eigenray(distance, by_surface):
    """→ launch elevation [deg], travel time [s] of the path without turning points"""
    low = np.radians(4.75)          # rays below 4.64° do not reach the surface
    found = brentq(lambda e: path(e, by_surface)[0] - distance, low, np.radians(85.0), xtol=1e-14)
    return np.degrees(found), path(found, by_surface)[1]


def echo_level(source_level, strength, distance):
    return source_level + strength - 40.0 * np.log10(distance)


if __name__ == "__main__":
    for r, printed in PRINTED.items():
        print(f"{r / 1e3:4.0f} km", [tuple(np.round(eigenray(r, s), 6)) for s in (False, True)],
              "printed", printed)
    print([round(echo_level(230.0, 30.0, r), 3) for r in (10000.0, 30000.0)])

#!/usr/bin/env python3
"""The field about a shadow's edge by a wavenumber integral over Airy functions. Prints window means
of TL [dB]."""
import sys
from pathlib import Path

import numpy as np

sys.path[:0] = [str(Path(__file__).resolve().parents[1])]
import truth_waves as waves  # noqa: E402

# dc/dz = −0.05 /s at the surface
SPEED, SLOPE, SOURCE, RECEIVER = 1500.0, 0.1 / 1500.0, 25.0, 50.0
HALF = 100.0    # of a window of ranges [m]


def edge():
    """Where the ray that grazes the surface meets the receiver's depth, seen from the source [m]:
    parabolas z = a r²/4 on either side."""
    return np.sqrt(4 * SOURCE / SLOPE) + np.sqrt(4 * RECEIVER / SLOPE)


def pressure(frequency, ranges):
    """→ complex [ranges], exp(−iωt). Grazing angles to 18° are kept (taper to 25°): all that is
    received here beyond 1.9 km."""
    omega = 2 * np.pi * frequency
    k0 = omega / SPEED
    steep = k0 * np.cos(np.radians(25.0))
    k, dk = waves.contour(steep, 1.01 * k0, np.max(ranges))
    green = waves.linear_n2_green(k, omega, SPEED, SLOPE, SOURCE, [RECEIVER])
    green *= waves.taper(k, (steep, k0 * np.cos(np.radians(18.0))), (1.005 * k0, 1.01 * k0))
    return waves.integrate(green, k, dk, ranges)[0]


if __name__ == "__main__":
    print(f"edge at {edge():.3f} m")
    for f in (500.0, 1000.0, 3500.0):
        r = np.arange(2050.0, 5651.0, 10.0)
        at = np.arange(2150.0, 5551.0, 300.0)
        print(f, [f"{c:.0f} m {t:.2f}" for c, t in zip(at, waves.windows(pressure(f, r), r, at, HALF))])

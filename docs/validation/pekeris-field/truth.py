#!/usr/bin/env python3
"""The Pekeris guide by a wavenumber integral along a path below the poles: the whole field, with
lateral wave and leaky modes. Prints TL [dB]."""
import sys
from pathlib import Path

import numpy as np

sys.path[:0] = [str(Path(__file__).resolve().parents[1])]
import truth_waves as waves  # noqa: E402

DEPTH, FREQUENCY, SOURCE = 200.0, 250.0, 50.0
WATER, BOTTOM = (1500.0, 1000.0), (1700.0, 1800.0, 0.5)


def pressure(ranges, receivers):
    """→ complex [receivers, ranges], exp(−iωt)"""
    omega = 2 * np.pi * FREQUENCY
    k, dk = waves.contour(0.0, 1.25 * omega / WATER[0], np.max(ranges))
    return waves.integrate(waves.pekeris_green(k, omega, DEPTH, SOURCE, receivers, WATER, BOTTOM),
                           k, dk, ranges)


if __name__ == "__main__":
    places = np.array([200.0, 1000.0, 3000.0, 10000.0])
    print(np.round(-20 * np.log10(np.abs(pressure(places, [100.0, 150.0]))), 4))

#!/usr/bin/env python3
"""Target echoes in a Pekeris guide by the energy of all images on both legs. Prints levels [dB re 1
µPa²]."""
import sys
from pathlib import Path

import numpy as np

sys.path[:0] = [str(Path(__file__).resolve().parents[1])]
import truth_energy as energy  # noqa: E402

DEPTH, SOURCE, RECEIVER, TARGET = 100.0, 30.0, 50.0, 60.0
WATER, BOTTOM = (1500.0, 1000.0), (1700.0, 2000.0, 0.5)
LEVEL, STRENGTH = 220.0, 10.0


def intensity(distance, a, b, most=4000):
    """Σ |R|^{2|m|}/s² over all images of depth a seen from depth b: heights 2mD ± (a − b), 2mD ± (a
    + b) with |m| bottom bounces."""
    m = np.arange(-most, most + 1)
    total = 0.0
    for height in (2 * m * DEPTH + b - a, 2 * m * DEPTH + b + a):
        path = np.hypot(distance, height)
        total += np.sum(energy.rayleigh(np.arcsin(np.minimum(np.abs(height) / path, 1.0)), WATER,
                                        BOTTOM) ** np.abs(m) / path**2)
    return total


def level(distance):
    """SL + TS + 10 lg of the two legs' sums: every pair of paths by energy."""
    return LEVEL + STRENGTH + 10 * np.log10(intensity(distance, SOURCE, TARGET)
                                            * intensity(distance, RECEIVER, TARGET))


if __name__ == "__main__":
    print([f"{r / 1e3:g} km {level(r):.3f}" for r in (2000.0, 5000.0, 10000.0)])

#!/usr/bin/env python3
"""Lloyd's mirror: the source and its image above the surface, with the opposite sign. Prints range
[m] and transmission loss [dB]."""
import numpy as np

SPEED, FREQUENCY, SOURCE, RECEIVER = 1500.0, 150.0, 25.0, 200.0


def pressure(ranges):
    """e^{ikR₁}/R₁ − e^{ikR₂}/R₂, exp(−iωt). ranges [n] in m → complex [n]"""
    k = 2 * np.pi * FREQUENCY / SPEED
    near, far = np.hypot(ranges, RECEIVER - SOURCE), np.hypot(ranges, RECEIVER + SOURCE)
    return np.exp(1j * k * near) / near - np.exp(1j * k * far) / far


if __name__ == "__main__":
    for r in np.linspace(100.0, 10000.0, 100):
        print(f"{r:8.1f} {-20 * np.log10(abs(pressure(r))):10.5f}")

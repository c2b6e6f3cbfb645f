#!/usr/bin/env python3
"""The ideal guide by its modes, evanescent ones included, and by its images: two sums over nothing
in common. Prints both."""
import numpy as np
from scipy.special import hankel1

DEPTH, SPEED, FREQUENCY, SOURCE = 110.0, 1490.0, 27.0, 40.0


def pressure(ranges, receivers, modes=400):
    """(2πi/D) Σ sin γ_m z_s sin γ_m z H₀⁽¹⁾(k_m r), γ_m = (m − ½)π/D, exp(−iωt). → [receivers,
    ranges]"""
    gamma = (np.arange(1, modes + 1) - 0.5) * np.pi / DEPTH
    k = np.sqrt((2 * np.pi * FREQUENCY / SPEED) ** 2 - gamma**2 + 0j)
    waves = hankel1(0, np.outer(k, ranges))
    shapes = np.sin(np.outer(receivers, gamma)) * np.sin(gamma * SOURCE)
    return 2j * np.pi / DEPTH * shapes @ waves


def pressure_of_images(ranges, receivers, least=200000):
    """Σ (−1)^n over the images at 2nD ± z_s, n about ±least, its end averaged away (alternating in
    pairs: Cesàro's mean of the last sums)."""
    k = 2 * np.pi * FREQUENCY / SPEED
    n = np.arange(-least, least + 1)
    fade = np.cos(np.pi * n / (2 * (least + 1))) ** 2
    out = np.empty((len(receivers), len(ranges)), complex)
    for i, z in enumerate(receivers):
        for j, r in enumerate(ranges):
            near, far = np.hypot(r, z - SOURCE - 2 * n * DEPTH), np.hypot(r,
                z + SOURCE - 2 * n * DEPTH)
            out[i, j] = np.sum((-1.0) ** n * fade * (np.exp(1j * k * near) / near
                                                     - np.exp(1j * k * far) / far))
    return out


if __name__ == "__main__":
    places, depths = np.array([200.0, 1000.0, 3000.0, 5000.0]), np.array([25.0, 65.0])
    for name, p in (("modes", pressure(places, depths)),
                    ("images", pressure_of_images(places, depths))):
        print(name, np.round(-20 * np.log10(np.abs(p)), 5).tolist())

#!/usr/bin/env python3
"""The ideal wedge by images: where its angle is an even fraction of 180 degrees the images close to
a ring about the apex, nothing is diffracted there, and their sum is the whole field. Prints
transmission loss [dB] of a point and of a line source."""
import numpy as np
from scipy.special import hankel1

PARTS = 60                          # the angle is π/60: even, so that signs agree all around the apex
APEX, SOURCE, SPEED, FREQUENCY = 4000.0, 100.0, 1500.0, 250.0


def ring(ranges, depths):
    """Distances to all images [images, depths, ranges] and their signs [images]. The free surface
    lies at angle 0 about the apex, the rigid floor at π/PARTS."""
    angle, radius = np.arctan2(SOURCE, APEX), np.hypot(APEX, SOURCE)
    m = np.arange(PARTS)
    # m pairs of mirrors; one more, the surface: −1 each time it is the surface's turn
    turned = np.concatenate([2 * m * np.pi / PARTS + angle, 2 * m * np.pi / PARTS - angle])
    sign = np.concatenate([(-1.0) ** m, -((-1.0) ** m)])
    x, z = np.meshgrid(APEX - np.asarray(ranges, float), depths)
    return np.hypot(x - (radius * np.cos(turned))[:, None, None],
                    z - (radius * np.sin(turned))[:, None, None]), sign


def point(ranges, depths):
    """Σ ± e^{ikR}/R: three dimensions, receivers down the line of steepest slope. exp(−iωt)"""
    distance, sign = ring(ranges, depths)
    k = 2 * np.pi * FREQUENCY / SPEED
    return np.tensordot(sign, np.exp(1j * k * distance) / distance, 1)


def line(ranges, depths):
    """Σ ± of cylindrical waves, 4√(π/R) far away: a source along the apex, two dimensions."""
    distance, sign = ring(ranges, depths)
    k = 2 * np.pi * FREQUENCY / SPEED
    return np.tensordot(sign, 4 * np.pi * np.sqrt(k / 2) * hankel1(0, k * distance), 1)


def intensity(ranges, depths):
    """Σ 1/R²: of a point source, paths by energy."""
    return (ring(ranges, depths)[0] ** -2.0).sum(axis=0)


if __name__ == "__main__":
    places = np.array([200.0, 500.0, 1000.0, 2000.0])
    for name, p in (("point", point(places, [30.0])), ("line", line(places, [30.0]))):
        print(name, np.round(-20 * np.log10(np.abs(p)), 4).tolist())

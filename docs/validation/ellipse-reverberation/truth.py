#!/usr/bin/env python3
"""Bistatic reverberation of a flat floor by direct paths: the integral over the floor, cell by
cell, sorted by delay. Prints levels [dB]."""
import numpy as np

SPEED, DEPTH, SOURCE, RECEIVER, APART = 1500.0, 200.0, 60.0, 120.0, 600.0
LEVEL, PULSE = 220.0, 0.1
MU, NU, SLOPE = 10 ** -2.7, 10 ** -1.5, np.tan(np.radians(20.0))


def lambert(sin_in, sin_out, cos_turn):
    return MU * sin_in * sin_out


def ellis_crowe(sin_in, sin_out, cos_turn):
    """μ sin sin + ν(1 + ΔΩ)² exp(−ΔΩ/2s²), ΔΩ = (cos²θ_i + cos²θ_s − 2cos θ_i cos θ_s cos φ)/(sin
    θ_i + sin θ_s)². Ellis & Crowe, JASA 89, 2207 (1991)."""
    ci, cs = np.sqrt(1 - sin_in**2), np.sqrt(1 - sin_out**2)
    tilt = (ci**2 + cs**2 - 2 * ci * cs * cos_turn) / (sin_in + sin_out) ** 2
    return lambert(sin_in, sin_out, cos_turn) + np.minimum(1.0,
                                                           NU * (1 + tilt) ** 2
                                                           * np.exp(-tilt / (2 * SLOPE**2)))


def levels(times, law=lambert, width=0.2, cell=4.0, bin_=0.002):
    """Means over `width` about each time [s from the start of transmission]: dB re 1 µPa². The
    floor in squares of `cell`, half of it by symmetry."""
    reach = 0.5 * (max(times) + width) * SPEED
    x = np.arange(APART / 2 - reach, APART / 2 + reach, cell) + cell / 2
    received = np.zeros(int((max(times) + 2 * width + PULSE) / bin_) + 1)
    for y in np.arange(0.0, reach, cell) + cell / 2:
        there, back = np.hypot(x, y), np.hypot(x - APART, y)
        s1, s2 = np.hypot(there, DEPTH - SOURCE), np.hypot(back, DEPTH - RECEIVER)
        # between the way in and the way out: 1 straight on, −1 back
        cos_turn = -(x * (x - APART) + y * y) / (there * back)
        cos_turn = np.clip(cos_turn, -1.0, 1.0)
        power = 2 * cell**2 * law((DEPTH - SOURCE) / s1, (DEPTH - RECEIVER) / s2,
                                  cos_turn) / (s1 * s2) ** 2
        k = ((s1 + s2) / SPEED / bin_).astype(int)
        inside = k < len(received)
        received += np.bincount(k[inside], weights=power[inside], minlength=len(received))
    n = int(round(PULSE / bin_))
    window = np.sin(np.pi * (np.arange(n) + 0.5) / n) ** 4        # Hann squared
    power = 10 ** (LEVEL / 10) * np.convolve(received, window)[:len(received)]
    t = (np.arange(len(received)) + 0.5) * bin_
    return np.array([10 * np.log10(power[np.abs(t - c) < width / 2].mean()) for c in times])


if __name__ == "__main__":
    at = np.array([0.6, 0.8, 1.0, 2.0, 4.0])
    print("Lambert", np.round(levels(at), 3))
    print("Ellis–Crowe", np.round(levels(at, ellis_crowe), 3))

#!/usr/bin/env python3
"""Reverberation of a sloping floor by the energies of all images in three dimensions: the integral
over the floor, cell by cell, sorted by delay. Prints levels [dB re 1 µPa²], also over a flat floor.
"""
import numpy as np

SPEED, DEPTH, SOURCE, RECEIVER = 1500.0, 100.0, 40.0, 65.0
ANGLE = np.radians(3.0)
KEPT = 0.8**2                       # of the energy by a bounce off the floor, at all angles
LEVEL, MU, PULSE = 220.0, -27.0, 0.05
BEARING_DEG, BEAM_DB = [0, 30, 60, 90, 180], [0.0, -1.0, -6.0, -20.0, -40.0]    # straight in dB


def legs(end, slope_range, across, angle, orders, kept):
    """Ways [m] and energies times the sine at the floor of every path from depth `end` under the
    origin to places of the floor: slope_range [m] from the apex along it, `across` the slope.

    The wedge unfolds: the place's image j lies at the angle (2j + 1)·angle about the apex; as
    j ≥ 0 sound strikes the floor j times before, as j < 0 −j − 1 times. → [(way, energy,
    bearing off the way up the slope [deg] at `end`)]"""
    apex = DEPTH / np.tan(angle)
    radius, at = np.hypot(apex, end), np.arctan2(end, apex)
    for j in range(-orders, orders):
        turn = (2 * j + 1) * angle - at
        if abs(turn) >= np.pi:
            continue
        way = np.sqrt(slope_range**2 + radius**2 - 2 * slope_range * radius * np.cos(turn)
                      + across**2)
        sine = radius * np.abs(np.sin(turn)) / way      # of the grazing angle at the place
        up = radius * np.cos(at) - slope_range * np.cos(turn + at)
        yield (way, kept ** (j if j >= 0 else -j - 1) * sine / way**2,
               np.degrees(np.arctan2(across, up)))


def levels(times, angle=ANGLE, down=False, width=0.2, cell=6.0, bin_=0.001, orders=14,
           kept=KEPT):
    """Means over `width` about each time after the start of transmission: dB re 1 µPa². Half of
    the floor, by symmetry, up to the shore; the beam up the slope or down."""
    last = max(times) + width
    reach = 0.5 * last * SPEED
    foot = DEPTH / np.sin(angle)    # the place under the origin, from the apex
    along = np.arange(max(cell / 2, foot - reach), foot + reach, cell)
    received = np.zeros(int((last + PULSE) / bin_) + 1)
    for y in np.arange(0.0, reach, cell) + cell / 2:
        out = list(legs(SOURCE, along, y, angle, orders, kept))
        back = list(legs(RECEIVER, along, y, angle, orders, kept))
        for way_a, energy_a, bearing in out:
            beam = np.interp(180.0 - bearing if down else bearing, BEARING_DEG, BEAM_DB)
            energy_a = energy_a * 10 ** (0.1 * beam)
            for way_b, energy_b, _ in back:
                k = ((way_a + way_b) / SPEED / bin_).astype(int)
                inside = k < len(received)
                received += np.bincount(k[inside], minlength=len(received),
                                        weights=2 * cell**2 * (energy_a * energy_b)[inside])
    n = int(round(PULSE / bin_))
    window = np.sin(np.pi * (np.arange(n) + 0.5) / n) ** 4        # Hann squared
    power = 10 ** (0.1 * (LEVEL + MU)) * np.convolve(received, window)[:len(received)]
    t = (np.arange(len(received)) + 0.5) * bin_
    return np.array([10 * np.log10(power[np.abs(t - c) < width / 2].mean()) for c in times])


if __name__ == "__main__":
    at = np.array([0.4, 0.8, 1.2, 1.6, 2.0])
    print("up       ", np.round(levels(at), 3))
    print("down     ", np.round(levels(at, down=True), 3))
    print("flat     ", np.round(levels(at, np.radians(0.001)), 3))

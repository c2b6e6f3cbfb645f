#!/usr/bin/env python3
"""Where the sound goes that a Pierson-Moskowitz sea scatters: shares of what is scattered within
angles of the mirrored direction, by the first-order small-slope approximation over an isotropic
sea, in numpy and scipy alone. With Q = q_i + q_s, the sum of the vertical wavenumbers k sin(theta),
K the change of the horizontal one and C(r) = int S(K) J0(K r) dK,

    sigma = 4 (q_i q_s/Q)^2 (1/2pi) int [exp(-Q^2 (h^2 - C)) - exp(-Q^2 h^2)] J0(K r) r dr:

perturbation's 4 q_i^2 q_s^2 W(K) where the sea is hardly rough, Kirchhoff's slopes where it is
(Voronovich, Sov. Phys. JETP 62, 65, 1985). Waves to 400 rad/m. Energy scattered is int sigma dOmega
over sin(theta_i). Prints lobe.csv; three minutes.
"""
import numpy as np
from scipy.fft import fht, fhtoffset
from scipy.special import j0

GRAVITY, ALPHA, BETA, SPEED = 9.81, 8.1e-3, 0.74, 1500.0
R = np.logspace(-5, 5, 2**13)
STEP = np.log(R[1] / R[0])
OFFSET = fhtoffset(STEP, mu=0.0, bias=0.0)
WAVES = np.exp(OFFSET) / R[::-1]
EDGES = np.array([10, 20, 30, 45, 60, 180])


def structure(wind):
    """h^2 - C over R, and h^2 [m^2]."""
    u2 = (1.026 * wind) ** 2
    wave = np.exp(np.linspace(np.log(0.05 * GRAVITY / u2), np.log(400.0), 6000))
    part = 0.5 * ALPHA * wave**-2 * np.exp(-BETA * (GRAVITY / (wave * u2)) ** 2)
    part *= np.gradient(np.log(wave))
    out = np.empty(R.size)
    for i in range(0, R.size, 256):
        x = np.outer(R[i:i + 256], wave)
        out[i:i + 256] = np.where(x < 1e-2, x * x / 4, 1 - j0(x)) @ part
    return out, part.sum()


def scattered(sea, frequency, grazing, edges=EDGES, elevations=240, bearings=360):
    """Energy scattered within angles `edges` [deg] of the mirrored direction, and Rayleigh's
    parameter squared. sea: structure()"""
    lag, h2 = sea
    k, sine, cosine = 2 * np.pi * frequency / SPEED, np.sin(grazing), np.cos(grazing)
    u, v = np.arange(elevations + 1) / elevations, np.arange(bearings + 1) / bearings
    out, turn = 0.5 * np.pi * (0.5 * (u[1:] + u[:-1])) ** 2, np.pi * (0.5 * (v[1:] + v[:-1])) ** 2
    sum_ = np.zeros(len(edges))
    for angle, width in zip(out, 0.5 * np.pi * np.diff(u**2)):
        q = k * (np.sin(angle) + sine)
        lobe = (np.exp(-q * q * lag) - np.exp(-q * q * h2)) * R
        spectrum = fht(lobe, STEP, mu=0.0, offset=OFFSET) / WAVES / (2 * np.pi)
        flat = np.cos(angle) * cosine * np.cos(turn)
        change = k * np.sqrt(np.maximum(np.cos(angle) ** 2 + cosine**2 - 2 * flat, 1e-12))
        sigma = 4 * (k * k * np.sin(angle) * sine / q) ** 2
        sigma = sigma * np.interp(np.log(change), np.log(WAVES), spectrum)
        off = np.degrees(np.arccos(np.clip(np.sin(angle) * sine + flat, -1, 1)))
        energy = 2 * sigma * np.pi * np.diff(v**2) * np.cos(angle) * width / sine
        sum_ += [energy[off <= edge].sum() for edge in edges]
    return sum_, 4 * k * k * h2 * sine * sine


if __name__ == "__main__":
    print("# tests/reverb/data/surface-lobe/lobe.py: shares of the energy scattered within so many degrees "
          "of the mirrored direction")
    print("wind_mps,f_Hz,grazing_deg,rayleigh_squared,scattered," +
          ",".join(f"within_{edge}" for edge in EDGES[:-1]))
    for wind in (5, 10, 15):
        sea = structure(wind)
        for frequency in (1000, 3500, 10000, 20000):
            for degrees in (2, 5, 10, 20):
                energy, g2 = scattered(sea, frequency, np.radians(degrees))
                print(f"{wind},{frequency},{degrees},{g2:.5g},{energy[-1]:.4f}," +
                      ",".join(f"{e / energy[-1]:.4f}" for e in energy[:-1]), flush=True)

#!/usr/bin/env python3
"""Noise of the sea surface in a Pekeris guide after Kuperman and Ingenito: a wavenumber integral
over all modes and the continuous spectrum. Prints the ratio of noise from below to that from above
beside |R_b|², and the table of the scenario.

Dipoles just under the surface, uncorrelated, everywhere: between phones at z₁ and z₂, R apart,

    C ∝ ∫ v(z₁) v*(z₂) / |1 + R_b e^{2iγD}|² J₀(kR) k dk,   v = e^{iγz} + R_b e^{iγ(2D − z)}    (1)

with γ² = ω²/c² − k², exp(−iωt). What is evanescent in water is left out: phones are wavelengths
below the surface.
"""
import sys
from pathlib import Path

import numpy as np
from scipy.special import jv

sys.path[:0] = [str(Path(__file__).resolve().parents[1])]
import truth_energy as energy  # noqa: E402
import truth_waves as waves  # noqa: E402

DEPTH = 100.0
WATER, BOTTOM = (1500.0, 1000.0), (1700.0, 2000.0, 0.5)


def reflection(gamma, omega):
    """R_b for plane waves in water of vertical wavenumber γ [rad/m]; complex, exp(−iωt)."""
    c2, rho2, attenuation = BOTTOM
    k = np.sqrt((omega / WATER[0]) ** 2 - gamma**2 + 0j)
    below = waves.vertical(omega / c2 * (1.0 + 1j * attenuation / (40 * np.pi * np.log10(np.e))), k)
    return (rho2 * gamma - WATER[1] * below) / (rho2 * gamma + WATER[1] * below)


def nodes(omega, each=48):
    """γ and weights that are even across every resonance of (1), however narrow: between two
    maxima of |1 + ρe^{iφ}| the angle ψ = 2 atan((1 − ρ)/(1 + ρ) tan(φ/2)) of Poisson's kernel."""
    k0 = omega / WATER[0]
    grid = k0 * (np.arange(400000) + 0.5) / 400000
    r = reflection(grid, omega)
    phi = np.unwrap(np.angle(r)) + 2 * grid * DEPTH
    gamma, weight = [], []
    psi = -np.pi + 2 * np.pi * (np.arange(each) + 0.5) / each
    # a resonance at φ = π (2m + 1), its middle; whole turns between 2πm and 2π(m + 1)
    for m in range(int(np.ceil(phi[0] / (2 * np.pi))) - 1, int(phi[-1] / (2 * np.pi)) + 1):
        here = np.clip(np.searchsorted(phi, np.pi * (2 * m + 1)), 0, len(grid) - 1)
        rho = np.abs(r[here])
        turn = 2 * np.arctan((1 - rho) / (1 + rho) * np.tan(psi / 2))        # from the resonance
        slope = (1 - rho**2) / (1 + rho**2 + 2 * rho * np.cos(psi))          # dφ/dψ
        at = np.pi * (2 * m + 1) + turn
        inside = (at > phi[0]) & (at < phi[-1])
        found = np.interp(at[inside], phi, grid)
        rate = np.interp(found, grid, np.gradient(phi, grid))
        gamma.append(found)
        weight.append(slope[inside] * 2 * np.pi / each / rate)
    return np.concatenate(gamma), np.concatenate(weight)


def covariance(frequencies, depths, apart):
    """(1) between phones at `depths` [n], `apart` [n, n] horizontally, mean over frequencies, and
    E[P_i P_j*] for exp(+iωt). → complex [n, n], the same scale at all depths"""
    total = np.zeros((len(depths),) * 2, complex)
    for omega in 2 * np.pi * np.asarray(frequencies):
        gamma, weight = nodes(omega)
        r, k = reflection(gamma, omega), np.sqrt((omega / WATER[0]) ** 2 - gamma**2)
        v = np.exp(1j * np.outer(depths, gamma)) + r * np.exp(1j * np.outer(
            2 * DEPTH - np.asarray(depths), gamma))
        power = gamma * weight / np.abs(1 + r * np.exp(2j * gamma * DEPTH)) ** 2 / omega**2
        for h in np.unique(apart):
            total += np.where(apart == h, (v * power * jv(0, k * h)) @ v.conj().T, 0.0)
    return total.conj() / len(frequencies)


def kept(grazing):
    """|R_b|² of the floor: what it sends back of a plane wave."""
    return energy.rayleigh(grazing, WATER, BOTTOM)


def directionality(elevation):
    """Power per solid angle by counting bounces, up to a constant: sin ε/(1 − |R_b|²) from above,
    |R_b|² times that from below. elevation [rad], positive: from above"""
    grazing = np.maximum(np.abs(elevation), np.radians(0.01))
    above = np.sin(grazing) / (1 - kept(grazing))
    return above * np.where(elevation < 0, kept(grazing), 1.0)


TABLE_DEG = np.concatenate([np.arange(0, 26, 1.0), np.arange(26, 30, 0.25), np.arange(30, 91, 3.0)])
TABLE_DEG = np.concatenate([-TABLE_DEG[:0:-1], TABLE_DEG])

if __name__ == "__main__":
    print("elevation_deg =", [float(e) for e in TABLE_DEG])
    print("level_db =", [round(float(10 * np.log10(d)), 2)
                         for d in directionality(np.radians(TABLE_DEG))])
    for degrees in (10, 20, 40, 60):
        print(f"{degrees} deg: |R_b|^2 {10 * np.log10(kept(np.radians(degrees))):.2f} dB")

#!/usr/bin/env python3
"""The benchmark wedge of the Acoustical Society by a parabolic equation of all angles: steps of
exp(ik₀Δr √(1 + X)) as sums of poles. Prints transmission loss [dB], and how a flat floor agrees
with the wavenumber integral.

p√r = ψ, ∂ψ/∂r = ik₀ √(1 + X) ψ, X = (ρ ∂_z (1/ρ) ∂_z + k² − k₀²)/k₀², exp(−iωt). The sea is the
same around the source. Between the steps of the floor ψ/√(ρc) goes on, which keeps the energy
(M. D. Collins, JASA 94, 1736 (1993)); sound that returns is left out.
"""
import sys
from pathlib import Path

import numpy as np
from scipy.linalg import eigvals, lapack

sys.path[:0] = [str(Path(__file__).resolve().parents[1])]
import truth_waves as waves  # noqa: E402

APEX, DEPTH, SOURCE = 4000.0, 200.0, 100.0
WATER, BOTTOM = (1500.0, 1000.0), (1700.0, 1500.0, 0.5)


def rational(values, points, most=24, tolerance=1e-10):
    """Poles, residues and constant of a rational function through f(points) (AAA: Nakatsukasa,
    Sète, Trefethen, SIAM J. Sci. Comput. 40, A1494 (2018))."""
    rest, chosen = np.ones(len(points), bool), []
    fit = np.full(len(points), values.mean())
    for _ in range(most):
        k = int(np.abs(np.where(rest, values - fit, 0)).argmax())
        chosen.append(k)
        rest[k] = False
        cauchy = 1.0 / (points[rest, None] - points[None, chosen])
        loewner = values[rest, None] * cauchy - cauchy * values[None, chosen]
        weights = np.linalg.svd(loewner)[2][-1].conj() if len(chosen) > 1 else np.ones(1)
        fit = values.copy()
        fit[rest] = (cauchy @ (weights * values[chosen])) / (cauchy @ weights)
        if np.abs(fit - values).max() < tolerance:
            break
    z, f, w = points[chosen], values[chosen], weights
    n = len(z)
    # poles: the generalised eigenvalues of an arrow
    a, b = np.zeros((n + 1, n + 1), complex), np.eye(n + 1)
    a[0, 1:], a[1:, 0], a[np.arange(1, n + 1), np.arange(1, n + 1)] = w, 1.0, z
    b[0, 0] = 0.0
    poles = eigvals(a, b)
    poles = poles[np.isfinite(poles) & (np.abs(poles) < 1e8)]
    poles = poles[np.abs(points[:, None] - poles).min(axis=0) > 1e-12]
    # residues and constant by least squares on the same points
    columns = np.concatenate([1.0 / (points[:, None] - poles), np.ones((len(points), 1))], axis=1)
    found = np.linalg.lstsq(columns, values, rcond=None)[0]
    return poles, found[:-1], found[-1], np.abs(columns @ found - values).max()


def column(depth, k0, step, count, omega):
    """X of a column of water over the floor, as a tridiagonal matrix, and √(1/ρc), by cells:
    a cell that the floor cuts has the means of both."""
    z = step * np.arange(1, count + 1)
    c2, rho2, attenuation = BOTTOM
    wet = np.clip((depth - (z - step / 2)) / step, 0, 1)
    wet_between = np.clip((depth - step * np.arange(count + 1)) / step, 0, 1)
    sponge = 0.05 * np.clip((z / z[-1] - 0.5) / 0.5, 0, 1) ** 3
    ka = (omega / WATER[0]) ** 2
    kb = (omega / c2 * (1 + 1j * (attenuation / (40 * np.pi * np.log10(np.e)) + sponge))) ** 2
    beta = 1.0 / (wet_between * WATER[1] + (1 - wet_between) * rho2)
    mass = wet / WATER[1] + (1 - wet) / rho2
    kappa = wet * ka / WATER[1] + (1 - wet) * kb / rho2
    scale = 1.0 / (mass * k0**2)
    main = (-(beta[1:] + beta[:-1]) / step**2 + kappa) * scale - 1.0
    upper = beta[1:-1] / step**2 * scale[:-1]
    lower = beta[1:-1] / step**2 * scale[1:]
    flux = np.sqrt(wet / (WATER[1] * WATER[0]) + (1 - wet) / (rho2 * c2))
    return lower.astype(complex), main, upper.astype(complex), flux, mass


def applied(fit, matrix, psi):
    poles, residues, constant, _ = fit
    lower, main, upper = matrix[:3]
    out = constant * psi
    for pole, residue in zip(poles, residues):
        out = out + residue * lapack.zgtsv(lower, main - pole, upper, psi)[3]
    return out


def march(frequency, last, floor, step_z, step_r, bottom=1000.0, receivers=(30.0, 150.0)):
    """Pressure re 1 m at steps of range [m], at grid depths beside the receivers. floor(r) → depth
    → ranges, complex [receivers, ranges]"""
    omega = 2 * np.pi * frequency
    k0 = omega / WATER[0]
    count = int(bottom / step_z)
    least = 4.2 / (step_z * k0) ** 2 + 2
    # the spectrum of X, denser about the branch point −1
    away = np.concatenate([[0.0], np.geomspace(1e-7, least, 500)])
    points = np.concatenate([-1 - away, -1 + np.geomspace(1e-7, 1.05, 400)]).astype(complex)
    root = np.sqrt(1 + points)
    advance = rational(np.exp(1j * k0 * step_r * (root - 1)), points)
    start = 4 * step_r
    # the field of a point at a short range, its root of −1/4 as 7/4 − 2
    begin = rational(root**3.5 * np.exp(1j * k0 * start * root), points)
    matrix = column(floor(0.0), k0, step_z, count, omega)
    delta = np.zeros(count, complex)
    s = int(round(SOURCE / step_z)) - 1
    delta[s] = 1.0 / (step_z * matrix[4][s] * WATER[1])
    smooth = delta
    for _ in range(2):
        smooth = lapack.zgtsv(matrix[0], matrix[1] + 1.0, matrix[2], smooth)[3]
    psi = np.sqrt(2 * np.pi / k0) * np.exp(0.25j * np.pi) * applied(
        begin, matrix, smooth)
    at = [int(round(z / step_z)) - 1 for z in receivers]
    ranges = start + step_r * np.arange(int((last - start) / step_r) + 1)
    received = np.empty((len(at), len(ranges)), complex)
    for i, r in enumerate(ranges):
        received[:, i] = psi[at] / np.sqrt(r)
        after = column(floor(r + step_r / 2), k0, step_z, count, omega)
        psi = psi * matrix[3] / after[3]
        matrix = after
        psi = applied(advance, matrix, psi) * np.exp(1j * k0 * step_r)
    return ranges, received, (advance[3], begin[3], len(advance[0]), len(begin[0]))


def slope(r):
    return DEPTH * (1.0 - r / APEX)


def steps(frequency):
    """Of depth and range [m]: λ/60 and λ/12."""
    return 25.0 / frequency, 5.0 * 25.0 / frequency


def pressure(frequency, ranges, receivers=(30.0, 150.0)):
    """Pressure re 1 m at ranges of 50 m to 3.9 km → complex [receivers, ranges]"""
    there, received, _ = march(frequency, np.max(ranges) + 20.0, slope, *steps(frequency),
                            receivers=receivers)
    k0 = 2 * np.pi * frequency / WATER[0]
    turned = received * np.exp(-1j * k0 * there)
    return np.array([np.interp(ranges, there, h.real) + 1j * np.interp(ranges, there, h.imag)
                     for h in turned]) * np.exp(1j * k0 * np.asarray(ranges))


def flat_check(frequency=25.0):
    """Largest difference [dB] of the mean intensity over 500 m between the parabolic equation over
    a flat floor and the wavenumber integral, at both depths, to 4 km."""
    there, received, _ = march(frequency, 4000.0, lambda r: DEPTH, *steps(frequency))
    some = there[there > 200.0][::4]
    omega = 2 * np.pi * frequency
    k, dk = waves.contour(0.0, 1.5 * omega / WATER[0], 4000.0)
    exact = waves.integrate(waves.pekeris_green(k, omega, DEPTH, SOURCE, (30.0, 150.0), WATER,
                                                BOTTOM), k, dk, some)
    centres = np.arange(500.0, 3800.0, 500.0)
    mine = received[:, there > 200.0][:, ::4]
    return np.abs(waves.windows(mine, some, centres, 250.0)
                  - waves.windows(exact, some, centres, 250.0)).max()


if __name__ == "__main__":
    places = np.array([500.0, 1000.0, 2000.0, 3000.0, 3500.0])
    print("flat floor, against the integral:", round(flat_check(), 4), "dB")
    for frequency in (25.0, 100.0):
        print(frequency, np.round(-20 * np.log10(np.abs(pressure(frequency, places))), 2).tolist())

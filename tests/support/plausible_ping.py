"""A ping that is plausible, not exact, for tests of whatever reads ping files; plain numpy.

Rays are marched through a Munk-like profile, echoes are spherically spread plane waves,
reverberation is Gaussian noise per azimuth sector with the level of the beam's surface hits.
"""
from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

MICROPASCAL = 1e-6


@dataclass
class Settings:
    """What the synthetic ping is made of; lengths in m, times in s, angles in degrees."""

    array: str = "horizontal"            # horizontal, vertical, volume
    phones: int = 16
    spacing: float = 0.1875
    heading: float = 0.0                 # of a horizontal array, clockwise from north
    pings: int = 1
    pings_requested: int | None = None   # more than pings: a run that was stopped
    elevations: list[float] = field(default_factory=lambda: [8.0])
    interval: float = 60.0
    duration: float = 60.0               # of the record
    sample_rate: float = 16000.0
    frequency: float = 4000.0
    bandwidth: float = 0.0               # of a linear sweep; 0 is a tone
    pulse: float = 1.0
    source_level: float = 220.0
    depth: float = 4500.0                # of platform, source and array
    water: float = 5395.0
    targets: list[tuple[float, float, float]] = field(   # range, bearing, depth
        default_factory=lambda: [(25000.0, 65.0, 125.0)])
    strength: float = 25.0
    target_speed: float = 4.0            # towards the platform
    noise_level: float | None = 40.0     # [dB re 1 µPa²/Hz]
    reverberation: bool = True
    seed: int = 1
    version: int = 2                     # of the format


# ---------------------------------------------------------------- the ocean and its rays

def munk(z):
    eta = 2.0 * (z - 1300.0) / 1300.0
    return 1500.0 * (1.0 + 0.00737 * (eta - 1.0 + np.exp(-eta)))


def trace(angles_deg, s: Settings, reach: float, step: float = 25.0):
    """Marches rays to range `reach`. → range [m], depth [m], time [s], elevation [rad], bounces:
    each [ray, point]
    """
    theta = np.radians(np.asarray(angles_deg, float))          # positive up
    r, z, t = np.zeros_like(theta), np.full_like(theta, s.depth), np.zeros_like(theta)
    bounces = np.zeros((2, theta.size), int)
    rows = [(r.copy(), z.copy(), t.copy(), theta.copy(), bounces[0].copy())]
    for _ in range(int(1.25 * reach / step)):
        c = munk(z)
        dc = (munk(z + 1.0) - munk(z - 1.0)) / 2.0
        # dθ/ds = (dc/dz)·cos θ / c, θ up
        theta_mid = theta + 0.5 * step * dc * np.cos(theta) / c
        zm = z - 0.5 * step * np.sin(theta)
        cm = munk(zm)
        dcm = (munk(zm + 1.0) - munk(zm - 1.0)) / 2.0
        theta = theta + step * dcm * np.cos(theta_mid) / cm
        r = r + step * np.cos(theta_mid)
        z = z - step * np.sin(theta_mid)
        t = t + step / cm
        for boundary, over in enumerate((z < 0.0, z > s.water)):
            z = np.where(over, 2.0 * (0.0 if boundary == 0 else s.water) - z, z)
            theta = np.where(over, -theta, theta)
            bounces[boundary] += over
        rows.append((r.copy(), z.copy(), t.copy(), theta.copy(), bounces[0].copy()))
    return [np.array(column).T for column in zip(*rows)]


def at_range(rays, distance):
    """Depth, time, elevation and surface bounces of every ray where it crosses `distance`; NaN if
    it never does.
    """
    r, z, t, theta, bounces = rays
    after = np.argmax(r >= distance, axis=1)
    rows = np.arange(r.shape[0])
    before = np.maximum(after - 1, 0)
    w = (distance - r[rows, before]) / np.maximum(r[rows, after] - r[rows, before], 1e-9)
    mix = lambda x: np.where(after > 0, (1 - w) * x[rows, before] + w * x[rows, after], np.nan)
    return mix(z), mix(t), theta[rows, before], bounces[rows, before]


def eigenrays(s: Settings, distance: float, depth: float):
    """Launch elevation [deg], arrival elevation [deg], delay [s], surface bounces: each [path]"""
    if distance < 1.0:
        return np.zeros((4, 0))
    angles = np.linspace(-40.0, 40.0, 801)
    z, t, theta, bounces = at_range(trace(angles, s, distance), distance)
    miss = z - depth
    same = np.diff(bounces) == 0
    found = np.flatnonzero(same & (miss[:-1] * miss[1:] < 0) & (np.abs(np.diff(miss)) < 800.0))
    w = miss[found] / (miss[found] - miss[found + 1])
    blend = lambda x: (1 - w) * x[found] + w * x[found + 1]
    paths = np.array([blend(angles), np.degrees(blend(theta)), blend(t), bounces[found]])
    return paths[:, paths[3] <= 3]


def transmit_beam_db(elevation_deg, axis_deg, width_deg=6.0):
    u = 0.7203 * (
        np.sin(
            np.radians(
                elevation_deg)) - np.sin(np.radians(axis_deg))) / np.sin(np.radians(width_deg / 2))
    with np.errstate(divide="ignore", invalid="ignore"):
        b = np.where(np.abs(np.abs(u) - 1) < 1e-6, 0.5, np.sinc(u) / (1 - u**2))
    return 20 * np.log10(np.abs(b) + 1e-4)


def travel_direction(elevation_deg, bearing_deg):
    """Unit vector (east, north, depth) of travel."""
    e, b = np.radians(elevation_deg), np.radians(bearing_deg)
    return np.array([np.cos(e) * np.sin(b), np.cos(e) * np.cos(b), -np.sin(e)])


# ---------------------------------------------------------------- signals

def phone_offsets(s: Settings):
    n = (np.arange(s.phones) - (s.phones - 1) / 2.0) * s.spacing
    if s.array == "vertical":                  # the first phone is the deepest
        return np.stack([0 * n, 0 * n, -n], axis=1)
    if s.array == "volume":
        rng = np.random.default_rng(7)
        return rng.uniform(-4 * s.spacing, 4 * s.spacing, (s.phones, 3)) * [1, 1, 0.3]
    h = np.radians(s.heading)
    return np.stack([n * np.sin(h), n * np.cos(h), 0 * n], axis=1)


def analytic_pulse(t, s: Settings):
    inside = (t >= 0) & (t <= s.pulse)
    window = np.sin(np.pi * np.clip(t, 0, s.pulse) / s.pulse) ** 2      # Hann
    phase = 2 * np.pi * (s.frequency * t + 0.5 * s.bandwidth * (t * t / s.pulse - t))
    return np.where(inside, window, 0.0) * np.exp(1j * phase)


def add_echo(pressure, phones, s: Settings, delay, direction, doppler, level_db, c):
    """Adds Re{A s₊(η(t − τ))} to every phone, τ = delay + u·(x − reference)/c."""
    amplitude = np.sqrt(2.0) * 10 ** (level_db / 20.0) * MICROPASCAL
    for channel, x in enumerate(phones):
        tau = delay + direction @ x / c
        first = max(int(np.floor(tau * s.sample_rate)), 0)
        last = min(int(np.ceil((tau + s.pulse / doppler) * s.sample_rate)) + 1, pressure.shape[1])
        if last > first:
            t = np.arange(first, last) / s.sample_rate
            pressure[channel, first:last] += amplitude * analytic_pulse(doppler * (t - tau), s).real


def add_reverberation(pressure, phones, s: Settings, t_hit, power, elevation, c, rng):
    """Adds, per azimuth sector, pulse-shaped Gaussian noise with mean square `power` [Pa²] at
    `t_hit` [s].
    """
    band = max(2.0 * s.bandwidth, 8.0 / s.pulse)
    n = pressure.shape[1]
    rate = max(4.0 * band, 20.0)
    m = int(np.ceil(n / s.sample_rate * rate))
    t = np.arange(m) / rate
    mean_square = np.interp(t, t_hit, power, left=0.0, right=0.0)
    look = np.interp(t, t_hit, elevation)
    kernel = analytic_pulse(np.arange(0, s.pulse, 1 / rate),
                            s) * np.exp(-2j * np.pi * s.frequency * np.arange(0, s.pulse, 1 / rate))
    kernel /= np.sqrt(np.sum(np.abs(kernel) ** 2))
    base = np.zeros((len(phones), m), complex)
    for bearing in np.arange(0.0, 360.0, 10.0):
        w = (rng.standard_normal(m) + 1j * rng.standard_normal(m)) / np.sqrt(2)
        b = np.convolve(w * np.sqrt(2 * mean_square / 36.0), kernel)[:m]
        u = travel_direction(look, bearing)                     # [3, m]
        base += b * np.exp(-2j * np.pi * s.frequency / c * (phones @ u))
    grid = np.arange(n) / s.sample_rate
    carrier = np.exp(2j * np.pi * s.frequency * grid)
    for channel in range(len(phones)):
        envelope = np.interp(grid, t, base[channel].real) + 1j * np.interp(grid, t,
                                                                           base[channel].imag)
        pressure[channel] += (envelope * carrier).real


def mean_square_series(x, rate, step):
    per = max(int(round(step * rate)), 1)
    m = -(-x.shape[1] // per)
    padded = np.zeros((x.shape[0], m * per))
    padded[:, : x.shape[1]] = x
    return np.mean(padded.reshape(x.shape[0], m, per) ** 2, axis=(0, 2))


def simulate(s: Settings):
    """All that the file holds, as a dictionary of arrays."""
    rng = np.random.default_rng(s.seed)
    n = int(round(s.duration * s.sample_rate))
    offsets = phone_offsets(s)
    c = float(munk(s.depth))
    step = min(0.05, s.duration / 4)
    out = dict(pressure=np.zeros((s.pings, len(offsets), n), np.float32), levels={}, echoes=[],
               patches=[], arrivals=[],
               summary=[], step=step)
    fan_angles = np.linspace(-89, 89, 713)
    reach = min(0.5 * s.duration * 1500.0, 60000.0)
    fan = trace(fan_angles, s, reach)
    levels = {k: [] for k in ("echo", "reverberation", "noise")}
    for ping in range(s.pings):
        axis = s.elevations[ping % len(s.elevations)]
        parts = {k: np.zeros((len(offsets), n)) for k in levels}
        summary = []
        for index, (distance, bearing, depth) in enumerate(s.targets):
            distance = distance - s.target_speed * s.interval * ping
            launch, arrive, time, bounces = eigenrays(s, distance, depth)
            gain = transmit_beam_db(launch, axis)
            loss = 20 * np.log10(np.maximum(distance / np.cos(np.radians(launch)), 1.0))
            for leg in (0, 1):
                for k in range(launch.size):
                    out["arrivals"].append((ping + 1, leg, index, -1, k, bearing + 180 * leg,
                                            distance,
                                            launch[k] if leg == 0 else -arrive[k],
                                            arrive[k] if leg == 0 else -launch[k], 0.0, 0.0, time[k],
                                            10 ** (-loss[k] / 20) * (-1) ** bounces[k], 0.0,
                                            loss[k], 0.0, 0.0,
                                            time[k] * 1500, bounces[k], 0, 0, 0, 0, 0, 0))
            best = (np.nan, np.nan)
            for a in range(launch.size):
                for b in range(launch.size):
                    level = s.source_level + gain[a] - loss[a] - loss[b] + s.strength
                    delay = time[a] + time[b]
                    eta = 1.0 + 2.0 * s.target_speed * np.cos(np.radians(launch[a])) / 1500.0
                    arrival = (-launch[b], (bearing + 180.0) % 360.0)
                    out["echoes"].append((ping + 1, index, -1, -1, a, b, delay, eta, level, *arrival))
                    add_echo(parts["echo"], offsets, s, delay, travel_direction(*arrival), eta, level,
                             c)
                    if not level <= best[1]:
                        best = (delay, level)
            summary.append((1, launch.size**2, *best))
        if s.reverberation and fan[4].max() > 0:
            hit = [(r[i], t[i], np.degrees(np.abs(e[i])), a) for r, t, e, b, a in
                   zip(fan[0], fan[2], fan[3], fan[4], fan_angles)
                   for i in [int(np.argmax(b > 0))] if b.max() > 0]
            r, t, g, a = np.array(sorted(hit, key=lambda h: h[1])).T
            area = 2 * np.pi * np.maximum(r, 1) * 750.0 * s.pulse
            strength = -38.0 + 20 * np.log10(np.maximum(np.sin(np.radians(g)), 1e-3))
            slant = 20 * np.log10(np.maximum(1500 * t, 1.0))
            level = (s.source_level + transmit_beam_db(a, axis) - 2 * slant + strength
                     + 10 * np.log10(area))
            add_reverberation(parts["reverberation"], offsets, s, 2 * t, 10 ** (level / 10) * 1e-12,
                              -a, c, rng)
            out["patches"] += [(ping + 1, 0, *row)
                               for row in zip(r, area, 2 * t, g, g, a, -a, strength, level)]
        if s.noise_level is not None:
            sigma = np.sqrt(10 ** (s.noise_level / 10) * 1e-12 * s.sample_rate / 2)
            parts["noise"] = sigma * rng.standard_normal((len(offsets), n))
        out["pressure"][ping] = sum(parts.values())
        for key, part in parts.items():
            levels[key].append(mean_square_series(part, s.sample_rate, step))
        out["summary"].append(summary)
    out["levels"] = {k: np.array(v, np.float32) for k, v in levels.items()}
    out["fan"], out["fan_angles"], out["reach"], out["offsets"] = fan, fan_angles, reach, offsets
    return out

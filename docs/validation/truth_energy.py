"""Energy sums for the reverberation truths: what a pulse sends out by every path, spread over range
and delay. numpy only.

The sound that a ring of the sea floor gets from one end of a leg is a deposit: rays within dθ carry
2π cos θ dθ of the intensity at 1 m, times |R|² of
every earlier bounce; what falls on the ring between r and r + dr after the time τ is

    d(r, τ) = Σ 2π cos θ dθ Π|R|² (c_b/c_s)  =  ∫ p² sin θ_b 2πr dr
    (1)

(the law of Lambert is separable, so sin θ_b belongs to the leg), and the reverberation of two legs
over one bottom is

    I(t) = 10^(SL/10) μ ∫ w²(t − τ_a − τ_b) Σ_rings d_a d_b/(2πr dr)
    (2)

with w the pulse's window. Every pair of paths is in it, by energy; pairs that are each other's
reverse are not added coherently, which is right where source
and receiver are at different depths.
"""
import numpy as np


def rayleigh(grazing, water, bottom):
    """|R|² of a fluid half-space for plane waves. water = (c, ρ), bottom = (c, ρ, dB per
    wavelength)."""
    c1, rho1 = water
    c2, rho2, attenuation = bottom
    index = c1 / c2 * (1.0 + 1j * attenuation / (40.0 * np.pi * np.log10(np.e)))
    sine = np.sin(grazing)
    down = np.sqrt(index**2 - np.cos(grazing) ** 2 + 0j)
    down = np.where(down.imag < 0, -down, down)
    return np.abs((rho2 / rho1 * sine - down) / (rho2 / rho1 * sine + down)) ** 2


class Grid:
    """Rings of sea floor and bins of delay [m, s]."""

    def __init__(self, last_range, last_time, ring=20.0, bin_=0.01):
        self.ring, self.bin = ring, bin_
        self.rings, self.bins = int(np.ceil(last_range / ring)), int(np.ceil(last_time / bin_))
        self.middle = (np.arange(self.rings) + 0.5) * ring

    def deposit(self, ranges, times, energy):
        """Sum of energies by ring and bin. → [rings, bins]"""
        i, j = (ranges / self.ring).astype(int), (times / self.bin).astype(int)
        inside = (i < self.rings) & (j < self.bins) & (energy > 0.0)
        flat = np.bincount(i[inside] * self.bins + j[inside], weights=energy[inside],
                           minlength=self.rings * self.bins)
        return flat.reshape(self.rings, self.bins)


def image_leg(grid, end, depth, speed, reflection):
    """d(r, τ) of straight paths from depth `end` in a guide with a free surface, by images: n
    earlier bottom bounces, first up or first down.

    `reflection(grazing)` is |R|² of the bottom. Rings are sampled at 4 radii each."""
    fine = (np.arange(4 * grid.rings) + 0.5) * grid.ring / 4
    most = int(grid.bins * grid.bin * speed / (2 * depth)) + 1
    total = np.zeros((grid.rings, grid.bins))
    for n in range(most):
        for height in ((2 * n + 1) * depth - end, (2 * n + 1) * depth + end):
            path = np.hypot(fine, height)
            sine = height / path
            energy = reflection(np.arcsin(sine)) ** n * sine / path**2 * 2 * np.pi * fine * grid.ring / 4
            total += grid.deposit(fine, path / speed, energy)
    return total


def ray_leg(grid, end, profile, reflection, rays=20000):
    """d(r, τ) of rays from depth `end` through a sound speed that is straight between the rows of
    `profile` [(depth, speed)], to the sea floor at its
    last row, by arcs of circles. Rays that never meet the floor carry nothing there."""
    z, c = np.array(profile, float).T
    floor = c[-1]
    start = np.interp(end, z, c)
    # even in sin θ: 2π cos θ dθ = 2π d(sin θ)
    sine = (np.arange(2 * rays) + 0.5) / rays - 1.0
    a = np.sqrt(1.0 - sine**2) / start                       # Snell's constant
    energy = 2 * np.pi / rays * floor / start * np.ones_like(sine)

    def leg(top, bottom):
        """Horizontal range and time from depth top to bottom, and whether rays get through."""
        knots = np.unique(np.concatenate([[top, bottom], z[(z > top) & (z < bottom)]]))
        r, t, through = np.zeros_like(a), np.zeros_like(a), np.ones_like(a, bool)
        for z0, z1 in zip(knots[:-1], knots[1:]):
            c0, c1 = np.interp([z0, z1], z, c)
            s0, s1 = np.sqrt(np.maximum(1 - (a * c0) ** 2,
                                        0)), np.sqrt(np.maximum(1 - (a * c1) ** 2, 0))
            through &= (a * c0 < 1) & (a * c1 < 1)
            if abs(c1 - c0) < 1e-12:
                with np.errstate(divide="ignore"):
                    r, t = r + (z1 - z0) * a * c0 / s0, t + (z1 - z0) / (c0 * s0)
            else:
                g = (c1 - c0) / (z1 - z0)
                r = r + (s0 - s1) / (a * g)
                t = t + np.log(c1 / c0 * (1 + s0) / (1 + s1)) / g
        return r, t, through

    def up_and_back(bottom):
        """From depth `bottom` up to the surface, or to where the ray turns, and back to
        `bottom`."""
        r, t, through = leg(0.0, bottom)
        r, t = 2 * r, 2 * t
        # turned: from the deepest level whose top it does not reach
        for i in np.flatnonzero(~through):
            r[i] = t[i] = 0.0
            levels = np.unique(np.concatenate([[bottom], z[z < bottom]]))[::-1]
            for z1, z0 in zip(levels[:-1], levels[1:]):
                c1, c0 = np.interp([z1, z0], z, c)
                s1 = np.sqrt(max(1 - (a[i] * c1) ** 2, 0.0))
                g = (c1 - c0) / (z1 - z0)
                if a[i] * c0 < 1:
                    s0 = np.sqrt(1 - (a[i] * c0) ** 2)
                    r[i] += 2 * ((z1 - z0) * a[i] * c0 / s0 if abs(g) < 1e-12
                                 else (s0 - s1) / (a[i] * g))
                    t[i] += 2 * ((z1 - z0) / (c0 * s0) if abs(g) < 1e-12
                                 else np.log(c1 / c0 * (1 + s0) / (1 + s1)) / g)
                    continue
                r[i] += 2 * (-s1) / (a[i] * g)               # s0 = 0 at the turn, c there 1/a
                t[i] += 2 * np.log(c1 * a[i] / (1 + s1)) / g
                break
        return np.abs(r), np.abs(t)

    down = leg(end, z[-1])
    meets = a * floor < 1
    first_up = up_and_back(end)
    cycle_r, cycle_t = up_and_back(z[-1])
    rise = sine > 0
    r = down[0] + np.where(rise, first_up[0], 0.0)
    t = down[1] + np.where(rise, first_up[1], 0.0)
    energy = np.where(meets & down[2], energy, 0.0)
    kept = reflection(np.arccos(np.clip(a * floor, 0, 1)))
    total = np.zeros((grid.rings, grid.bins))
    while True:
        alive = (t < grid.bins * grid.bin) & (r < grid.rings * grid.ring) & (energy > 1e-15)
        if not alive.any():
            return total
        r, t, energy, cycle_r, cycle_t, kept = (x[alive]
                                                for x in (r, t, energy, cycle_r, cycle_t, kept))
        total += grid.deposit(r, t, energy)
        r, t, energy = r + cycle_r, t + cycle_t, energy * kept


def reverberation(grid, leg_a, leg_b, mu_db, source_level, pulse, times, width=1.0):
    """(2) as a mean over `width` about each of `times` [s from the start of transmission]: level
    [dB re 1 µPa²].

    `pulse` is the length of a Hann window (rms plateau at the source level, window peak 1, energy
    3/8 of its length)."""
    size = 2 * grid.bins
    spectrum = np.zeros(size // 2 + 1, complex)
    for a, b, r in zip(leg_a, leg_b, grid.middle):
        if a.any() and b.any():
            spectrum += np.fft.rfft(a, size) * np.fft.rfft(b, size) / (2 * np.pi * r * grid.ring)
    n = int(round(pulse / grid.bin))
    window = np.sin(np.pi * (np.arange(n) + 0.5) / n) ** 4      # Hann squared
    received = np.fft.irfft(spectrum * np.fft.rfft(window, size), size)[:grid.bins]
    # bins add their middles: half of each leg's and of the window's, less a half
    t = (np.arange(grid.bins) + 1.0) * grid.bin
    power = 10 ** (0.1 * (source_level + mu_db)) * received
    return np.array([10 * np.log10(power[np.abs(t - x) < width / 2].mean()) for x in times])

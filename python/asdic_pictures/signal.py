"""What is computed from the pressures: baseband, beams, levels, spectra. No files, no pictures."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

REFERENCE = 1e-12  # (1 µPa)² [Pa²]


def decibels(mean_square):
    """dB re 1 µPa of mean squares [Pa²], or re 1 µPa²/Hz of densities; NaN where not positive"""
    x = np.asarray(mean_square, float)
    return 10.0 * np.log10(np.where(x > 0, x, np.nan) / REFERENCE)


@dataclass
class Baseband:
    """Complex envelope of every phone; |values| is the peak envelope, |values|²/2 mean square."""

    values: np.ndarray   # [channel, sample] [Pa]
    rate: float          # [Hz]
    carrier: float       # [Hz]
    start: float         # time of the first sample [s]
    width: float         # of the band that was kept [Hz]

    @property
    def times(self):
        return self.start + np.arange(self.values.shape[1]) / self.rate


def baseband(channels, sample_rate: float, carrier: float, width: float,
             start: float = 0.0) -> Baseband:
    """Keeps `width` Hz around `carrier`: the analytic signal, shifted to frequency zero, decimated.

    One FFT a phone: the bins of the band are all that is kept (positive frequencies, doubled),
    their inverse FFT is the envelope. The new rate is 1.25 × the width.
    channels: iterable of [sample] arrays of equal length [Pa]
    """
    rows = []
    for p in channels:
        n = len(p)
        spectrum = np.fft.rfft(p)
        spacing = sample_rate / n
        centre = int(round(carrier / spacing))
        half = max(int(round(0.5 * width / spacing)), 1)
        low, high = max(centre - half, 0), min(centre + half, len(spectrum) - 1)
        m = max(int(round(1.25 * 2 * half)), 4)
        kept = np.zeros(m, complex)
        if high >= low:
            # negative indices wrap, as FFT order wants
            kept[np.arange(low, high + 1) - centre] = 2.0 * spectrum[low : high + 1] / n * m
        rows.append(np.fft.ifft(kept))
    carrier_bin = centre * spacing
    envelope = np.array(rows) if rows else np.zeros((0, 0), complex)
    rate = m * sample_rate / n
    # rfft's phase counts from the first sample; the carrier's, from t = 0
    return Baseband(envelope * np.exp(-2j * np.pi * carrier_bin * start), rate, carrier_bin, start,
                    2 * half * spacing)


def band_width(bandwidth: float, carrier: float, doppler_span: float, duration: float) -> float:
    """Width that holds the pulse and its Doppler shifts, with a little room [Hz]."""
    return max(1.2 * bandwidth, 4.0 / max(duration, 1e-6)) + 2.0 * carrier * (doppler_span + 0.0005)


def average(power, count: int):
    """Means of `power` [..., sample] over `count` equal stretches of time. → [..., count]"""
    n = power.shape[-1]
    count = max(min(count, n), 1)
    edges = np.linspace(0, n, count + 1).astype(int)[:-1]
    sums = np.add.reduceat(power, edges, axis=-1)
    return sums / np.diff(np.append(edges, n))


# ---------------------------------------------------------------- beams

@dataclass
class Scan:
    """The directions that an array is steered to."""

    kind: str                # "horizontal", "vertical", "azimuth"
    # [beam, 3] unit vectors (east, north, depth) towards where sound comes from
    looks: np.ndarray
    # [beam] the picture's axis: sin of the angle for a line, degrees for azimuth
    coordinate: np.ndarray
    axis: np.ndarray | None  # of a line array, in the sense in which `coordinate` grows


def line_axis(phones):
    """Direction of the line from the first phone to the last, or None. phones: [n, 3]"""
    centred = phones - phones.mean(axis=0)
    _, size, directions = np.linalg.svd(centred, full_matrices=False)
    if size[0] == 0 or (len(size) > 1 and size[1] > 0.02 * size[0]):
        return None
    axis = directions[0]
    return axis if centred[-1] @ axis >= centred[0] @ axis else -axis


def scan(phones, beams: int = 181) -> Scan:
    """The directions that suit an array.

    Horizontal line: apparent bearing, sin(app) = sin(bearing)·cos(elevation), clockwise from the
    broadside at heading + 90°. Vertical line: look elevation. Others: azimuth, horizontally.
    """
    axis = line_axis(phones)
    if axis is None:
        degrees = np.linspace(0.0, 360.0, 2 * beams - 1)
        b = np.radians(degrees)
        return Scan("azimuth", np.stack([np.sin(b), np.cos(b), 0 * b], axis=1), degrees, None)
    sine = np.linspace(-1.0, 1.0, beams)
    vertical = abs(axis[2]) > np.sqrt(0.5)
    if vertical:
        axis = axis if axis[2] < 0 else -axis    # grows upwards: depth is positive down
    else:
        # clockwise from broadside is towards the line's tail
        axis = -axis
    across = np.cross(axis, [0.0, 0.0, 1.0] if not vertical else [1.0, 0.0, 0.0])
    across /= np.linalg.norm(across)
    looks = sine[:, None] * axis + np.sqrt(np.maximum(1 - sine[:, None] ** 2, 0.0)) * across
    return Scan("vertical" if vertical else "horizontal", looks, sine, axis)


def apparent(where: Scan, travel):
    """Coordinate of the scan at which plane waves travelling along `travel` [n, 3] appear. → [n]"""
    look = -np.atleast_2d(travel)
    if where.axis is not None:
        return np.clip(look @ where.axis, -1.0, 1.0)
    return np.degrees(np.arctan2(look[:, 0], look[:, 1])) % 360.0


def beam_power(b: Baseband, phones, looks, speed: float, columns: int):
    """Mean-square output of each beam in `columns` stretches of time. → [beam, column] [Pa²]

    Conventional, equal weights. A plane wave along u reaches the phone at x with the delay u·x/c (x
    from the array's centre), so the beam is y(f) = 1/N Σ p(f)·exp(+i2πf u·x/c), u = −look. The
    phase is taken at the middle of sub-bands so narrow that the delay across the array times their
    width stays below 1/20: one for a tone, more for a wide sweep.
    """
    x = phones - phones.mean(axis=0)
    delay = -(looks @ x.T) / speed                                           # [beam, phone] [s]
    spectrum = np.fft.fft(b.values, axis=1)
    m = spectrum.shape[1]
    f = np.fft.fftfreq(m, 1.0 / b.rate)
    pieces = int(np.clip(np.ceil(b.width * np.ptp(delay) * 20.0), 1, 256))
    edges = np.linspace(-b.rate / 2, b.rate / 2, pieces + 1)
    columns = min(columns, m)
    out = np.empty((len(looks), columns))
    # 32 beams at a time keep memory small
    for first in range(0, len(looks), 32):
        mine = slice(first, first + 32)
        beam = np.zeros((len(delay[mine]), m), complex)
        for low, high in zip(edges[:-1], edges[1:]):
            bins = np.flatnonzero((f >= low) & ((f < high) | (high == edges[-1])))
            if bins.size:
                middle = b.carrier + 0.5 * (low + high)
                weights = np.exp(2j * np.pi * middle * delay[mine]) / len(phones)
                beam[:, bins] = weights @ spectrum[:, bins]
        out[mine] = average(0.5 * np.abs(np.fft.ifft(beam, axis=1)) ** 2, columns)
    return out


# ---------------------------------------------------------------- spectra

def spectrogram(b: Baseband, window: int, columns: int):
    """One-sided power spectral density of pressure, mean over the phones.

    → time [column] [s], frequency [bin] [Hz], density [bin, column] [Pa²/Hz]

    Hann windows of `window` samples, about `columns` of them, overlapping by half or more. The
    envelope's density is twice the pressure's.
    """
    n = b.values.shape[1]
    window = max(min(window, n), 2)
    hop = max(min(window // 2, (n - window) // max(columns - 1, 1)), 1)
    starts = np.arange(0, n - window + 1, hop)
    taper = np.sin(np.pi * (np.arange(window) + 0.5) / window) ** 2
    # finer bins of the same resolution, for the eye
    points = 4 * window
    density = np.zeros((points, len(starts)))
    for channel in b.values:
        pieces = channel[starts[:, None] + np.arange(window)] * taper
        density += (np.abs(np.fft.fft(pieces, points, axis=1)) ** 2).T
    density *= 0.5 / (len(b.values) * b.rate * np.sum(taper**2))
    times = b.start + (starts + 0.5 * window) / b.rate
    frequency = b.carrier + np.fft.fftshift(np.fft.fftfreq(points, 1.0 / b.rate))
    return times, frequency, np.fft.fftshift(density, axes=0)

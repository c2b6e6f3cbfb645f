"""What is computed from the pressures: baseband, beams, levels, spectra. No files, no pictures."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from . import bearings

REFERENCE = 1e-12  # (1 µPa)² [Pa²]
FILTER_LENGTH = 60.0  # times 1/width: the band filter's answer has died by about 130 dB


def decibels(mean_square):
    """dB re 1 µPa of mean squares [Pa²], or re 1 µPa²/Hz of densities; NaN where not positive"""
    x = np.asarray(mean_square, float)
    return 10.0 * np.log10(np.where(x > 0, x, np.nan) / REFERENCE)


@dataclass
class Baseband:
    """Complex envelope of every phone; |values| is the peak envelope, |values|²/2 mean square."""

    values: np.ndarray   # [channel, sample] [Pa]
    # [channel, more] the same before it was cut at the record's end: a circle in time, with nothing
    # at the ends of its spectrum
    circle: np.ndarray
    rate: float          # [Hz]
    carrier: float       # [Hz]
    start: float         # time of the first sample [s]
    width: float         # of the band that was kept [Hz]
    duration: float      # of the record [s]; the last sample may reach past its end
    least: int = 4       # samples that were asked for at least

    @property
    def times(self):
        return self.start + np.arange(self.values.shape[1]) / self.rate

    @property
    def end(self):
        return self.start + self.duration

    def edges(self, count: int):
        """`count` equal columns that fill the record. → times [count + 1] [s]"""
        return np.linspace(self.start, self.end, count + 1)

    def average(self, power, times):
        """Means of `power` [..., sample] between `times` [column + 1] [s]. → [..., column]"""
        return average_between(power, (np.asarray(times) - self.start) * self.rate)


def fast_length(least: int) -> int:
    """The smallest 2^a·3^b·5^c that is not below `least`: an FFT of a prime length is slow."""
    odd = [3**b * 5**c for b in range(4) for c in range(4)]
    return min(k << max(int(np.ceil(np.log2(max(least, 1) / k))), 0) for k in odd)


def band_filter(offset, width: float):
    """Amplitude at `offset` [Hz] from the band's middle; half the power at ± width/2.

    cos(π/2·sin²(π/2·x)), x = 0..1 over the last eighth of either half and as much beyond: flat
    inside, the power that white noise has in `width` is kept exactly, and its answer to a click
    dies like 1/t⁴ or faster, where a sharp edge's dies like 1/t and smears a loud start over the
    whole record.
    """
    x = np.clip((np.abs(offset) / (0.5 * width) - 0.875) / 0.25, 0.0, 1.0)
    return np.cos(0.5 * np.pi * np.sin(0.5 * np.pi * x) ** 2)


def passband(envelope: np.ndarray, finer: int, carrier: float, rate: float) -> np.ndarray:
    """Re{b e^{i2πf_c t}} at a rate `finer` times the envelope's, t = 0 at the first sample."""
    n = len(envelope)
    spectrum = np.fft.fft(envelope)
    wide = np.zeros(n * finer, complex)
    half = n // 2
    wide[:half] = spectrum[:half]
    if n > half:
        wide[-(n - half):] = spectrum[half:]
    t = np.arange(n * finer) / rate
    return np.real(np.fft.ifft(wide) * finer * np.exp(2j * np.pi * carrier * t))


def baseband(channels, sample_rate: float, carrier: float, width: float,
             start: float = 0.0, least: int = 4) -> Baseband:
    """Keeps `width` Hz around `carrier`: the analytic signal, shifted to frequency zero, decimated.

    One FFT a phone: the bins of the band are all that is kept (positive frequencies, doubled),
    their inverse FFT is the envelope. The new rate is 1.25 × the width, or more if the record would
    have fewer than `least` samples. Zeros as long as the filter follow the record, so that its
    start cannot wrap round into its end.
    channels: iterable of [sample] arrays of equal length [Pa]
    """
    rows = []
    for p in channels:
        n = len(p)
        padded = fast_length(n + int(np.ceil(FILTER_LENGTH / width * sample_rate)))
        spectrum = np.fft.rfft(p, padded)
        spacing = sample_rate / padded
        centre = int(round(carrier / spacing))
        kept_bins = np.arange(max(int(np.floor((carrier - 0.6 * width) / spacing)), 0),
                              min(int(np.ceil((carrier + 0.6 * width) / spacing)) + 1,
                                  len(spectrum)))
        m = fast_length(max(int(np.ceil(1.25 * width / spacing)) + 2, 4,
                            min(int(np.ceil(least * padded / n)), padded)))
        kept = np.zeros(m, complex)
        # negative indices wrap, as FFT order wants
        kept[kept_bins - centre] = (band_filter(kept_bins * spacing - carrier, width)
                                    * spectrum[kept_bins] * 2.0 / padded * m)
        rate = m * sample_rate / padded
        samples = max(int(np.ceil(n / sample_rate * rate)), 4)   # windows need a few
        rows.append(np.fft.ifft(kept))
    carrier_bin = centre * spacing
    circle = np.array(rows) if rows else np.zeros((0, 0), complex)
    # rfft's phase counts from the first sample; the carrier's, from t = 0
    circle = circle * np.exp(-2j * np.pi * carrier_bin * start)
    return Baseband(circle[:, : min(samples, m)], circle, rate, carrier_bin, start, width,
                    n / sample_rate, least)


def band_width(bandwidth: float, carrier: float, doppler_span: float, duration: float) -> float:
    """Width that holds the pulse and its Doppler shifts, with a little room [Hz]."""
    return max(1.2 * bandwidth, 4.0 / max(duration, 1e-6)) + 2.0 * carrier * (doppler_span + 0.0005)


def average(power, count: int):
    """Means of `power` [..., sample] over `count` equal spans of time. → [..., count]"""
    n = power.shape[-1]
    return average_between(power, np.linspace(0.0, n, max(min(count, n), 1) + 1))


def average_between(power, edges):
    """Means of `power` [..., sample] between rising `edges` [column + 1], in samples. → [..., column]

    Sample k stands for [k, k + 1); an edge may cut one: each part counts by its length. A column of
    which no part lies inside the samples is NaN.
    """
    n = power.shape[-1]
    edges = np.clip(np.asarray(edges, float), 0.0, n)
    first, last = edges[0], edges[-1]
    cuts = np.union1d(edges, np.arange(np.ceil(first), np.floor(last) + 1))
    length = np.diff(cuts)
    if length.size == 0:
        return np.full(power.shape[:-1] + (len(edges) - 1,), np.nan)
    sample = np.minimum((0.5 * (cuts[:-1] + cuts[1:])).astype(int), n - 1)
    starts = np.minimum(np.searchsorted(cuts, edges[:-1]), len(length) - 1)
    sums = np.add.reduceat(power[..., sample] * length, starts, axis=-1)
    width = np.diff(edges)
    return np.where(width > 0, sums / np.where(width > 0, width, 1.0), np.nan)


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

    Horizontal line: the cosine to it, in the sense of bearings.along(). Vertical line: look
    elevation. Others: azimuth, horizontally.
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
        axis = bearings.along(axis)
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


def beam_power(b: Baseband, phones, looks, speed: float, times):
    """Mean-square output of each beam between `times` [column + 1] [s]. → [beam, column] [Pa²]

    Conventional, equal weights. A plane wave along u reaches the phone at x with the delay u·x/c (x
    from the array's centre), so the beam is y(f) = 1/N Σ p(f)·exp(+i2πf u·x/c), u = −look. The
    factor is exact at every frequency, and the spectrum that of the record before it was cut: a
    kink, or a step at the ends of the band, would smear a loud sound over the whole record.
    """
    x = phones - phones.mean(axis=0)
    delay = -(looks @ x.T) / speed                                           # [beam, phone] [s]
    m = b.circle.shape[1]
    spectrum = np.fft.fftshift(np.fft.fft(b.circle, axis=1), axes=1)
    f = b.carrier + np.fft.fftshift(np.fft.fftfreq(m, 1.0 / b.rate))
    out = np.empty((len(looks), len(times) - 1))
    # 32 beams and 64 frequencies at a time keep memory small
    for first in range(0, len(looks), 32):
        mine = slice(first, first + 32)
        further = np.exp(2j * np.pi * (f[:64] - f[0])[:, None, None] * delay[mine])
        beam = np.empty((len(delay[mine]), m), complex)
        for low in range(0, m, 64):
            bins = slice(low, min(low + 64, m))
            weights = further[: bins.stop - low] * np.exp(2j * np.pi * f[low] * delay[mine])
            beam[:, bins] = (weights @ spectrum[:, bins].T[:, :, None])[:, :, 0].T / len(phones)
        received = np.fft.ifft(np.fft.ifftshift(beam, axes=1), axis=1)[:, : b.values.shape[1]]
        out[mine] = b.average(0.5 * np.abs(received) ** 2, times)
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

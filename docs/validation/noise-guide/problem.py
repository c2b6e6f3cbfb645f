"""Noise between a windy surface and a floor: asdic's samples against Kuperman and Ingenito."""
from pathlib import Path

import h5py
import numpy as np
import suite
from scipy.signal.windows import chebwin

NAME = "Surface noise in a guide"
TRUTH = "Kuperman–Ingenito wavenumber integral"
QUICK = True
BAND = np.arange(960.0, 1041.0, 16.0)           # of the truth's mean [Hz]
BLOCK = 250                                     # samples of a spectrum: half a second
SPEED, LINE, DEPTHS = 1500.0, 32, (10.0, 90.0)  # the line's phones come first
STEER_DEG = np.arange(10.0, 56.0, 5.0)


def spectra(file):
    """Hann spectra of a ping's noise in the band: [phones, blocks, bins], and frequencies [Hz]"""
    with h5py.File(file) as f:
        data = f["pressure"]
        x = data[0, :, :, 0] + 1j * data[0, :, :, 1]
        rate, carrier = float(data.attrs["sample_rate_hz"]), float(data.attrs["carrier_hz"])
    window = np.hanning(BLOCK + 1)[:-1]
    starts = np.arange(0, x.shape[1] - BLOCK + 1, BLOCK // 2)
    frequency = carrier + np.fft.fftfreq(BLOCK, 1 / rate)
    inside = (frequency >= BAND[0]) & (frequency <= BAND[-1])
    return np.stack([np.fft.fft(window * x[:, s:s + BLOCK])[:, inside] for s in starts],
                    axis=1), frequency[inside]


def covariance(found):
    """E[P_i P_j*] over blocks and bins."""
    flat = found.reshape(len(found), -1)
    return flat @ flat.conj().T / flat.shape[1]


def steering(depths, elevation, frequency):
    """Weights of a beam towards an elevation [rad]: 60 dB down beside the beam (Chebyshev)."""
    phase = 2 * np.pi * frequency / SPEED * np.sin(elevation) * depths
    return chebwin(len(depths), 60.0) * np.exp(-1j * phase)


def down_up(power_of):
    """10 lg of a beam from below over that from above, over STEER_DEG; power_of(elevation)"""
    return np.array([suite.db(power_of(-e) / power_of(e)) for e in np.radians(STEER_DEG)])


def received_ratio(found, frequency, depths):
    def power(elevation):
        return sum(np.mean(np.abs(steering(depths, elevation, f).conj() @ found[:LINE, :, q]) ** 2)
                   for q, f in enumerate(frequency))
    return down_up(power)


def compare(asdic, truth):
    scenario = Path(__file__).with_name("scenario.toml")
    found, frequency = spectra(asdic.ping(scenario))
    with h5py.File(asdic.out / f"{scenario.parent.name}-ping.h5") as f:
        seconds = f["pressure"].shape[2] / float(f["pressure"].attrs["sample_rate_hz"])
    sheet, _ = spectra(asdic.ping(scenario, noise='{spectral_level_db=60.0, coherence="surface"}'))

    line = 53.25 - 0.75 * np.arange(LINE)
    depths = np.concatenate([line, np.full(5, line[-1]), DEPTHS])
    east = np.concatenate([np.zeros(LINE), [0.75, 1.5, 3.0, 6.0, 12.0], [0.0, 0.0]])
    each = [truth.covariance([f], depths, np.abs(east[:, None] - east)) for f in BAND]
    exact = sum(each) / len(each)

    def wave_power(elevation):      # steered at each frequency, as the samples are
        return sum(np.real(w.conj() @ c[:LINE, :LINE] @ w) for c, w in
                   ((c, steering(line, elevation, f)) for c, f in zip(each, BAND)))

    waves = down_up(wave_power)
    received, alone = received_ratio(found, frequency, line), received_ratio(sheet, frequency, line)
    kept = suite.db(truth.kept(np.radians(STEER_DEG)))

    # coherence between the uppermost phone of the line, and all of line and cross
    cov = covariance(found)
    level = np.real(np.diag(cov))
    coherence = cov / np.sqrt(np.outer(level, level))
    power = np.real(np.diag(exact))
    wanted = exact / np.sqrt(np.outer(power, power))
    pairs = np.arange(LINE + 5)
    off = np.abs(coherence - wanted)[LINE - 1, pairs]
    heights = suite.db(level / level[:LINE].mean()) - suite.db(power / power[:LINE].mean())

    samples = (BAND[-1] - BAND[0]) * seconds
    sigma_c, sigma_db = 1 / np.sqrt(samples), 10 / np.log(10) * np.sqrt(2 / samples)

    def draw(axes, style):
        axes.plot(STEER_DEG, waves, color=style.INK, lw=2.2, label="Kuperman–Ingenito")
        axes.plot(STEER_DEG, kept, color=style.GREEN, lw=1.0, label="|R_b|²")
        axes.plot(STEER_DEG, received, "o--", color=style.BLUE, lw=1.0, ms=4, label="asdic, profile")
        axes.plot(STEER_DEG, alone, "s--", color=style.VERMILION, lw=1.0, ms=4,
                  label="asdic, surface")
        axes.set(xlabel="grazing angle / °", ylabel="from below over from above / dB",
                 ylim=(-65, 3))
        axes.legend()

    rows = [[f"{a:.0f}", f"{k:.2f}", f"{w:.2f}", f"{h:.2f}", f"{h - w:+.2f}", f"{s:.1f}"]
            for a, k, w, h, s in zip(STEER_DEG, kept, waves, received, alone)]
    return suite.Result(
        [suite.Check(f"down/up ratio, profile, worst of {len(rows)} angles",
                     float(max(received - waves, key=abs)), round(0.5 + 3 * sigma_db, 2)),
         suite.Check("down/up ratio, kind surface, worst angle",
                     float(max(alone - waves, key=abs)), round(0.5 + 3 * sigma_db, 2)),
         suite.Check(f"coherence, profile, worst of {len(pairs)} pairs", float(off.max()),
                     round(0.05 + 3 * sigma_c, 3), ""),
         suite.Check("level over depth, 10 to 90 m, worst of 34 phones",
                     float(max(heights[np.r_[:LINE, -2, -1]], key=abs)),
                     round(0.5 + 3 * sigma_db, 2))],
        ["angle / °", "\\|R_b\\|² / dB", "waves / dB", "profile / dB", "difference / dB",
         "surface / dB"], rows, draw,
        [f"One record of {seconds:g} s, {BAND[0]:g} to {BAND[-1]:g} Hz: one standard error "
         f"{sigma_db:.2f} dB of a ratio, {sigma_c:.3f} of a coherence; three are added to the "
         "bounds."])

"""Spectrogram around the pulse's band, mean over the phones."""
from __future__ import annotations

import numpy as np

from . import signal, style
from .pressure import mark_echoes

TITLE = "Spectrogram around the pulse's band"


def nothing_to_show(data, ping):
    return None


def record(data, ping):
    """What the picture shows. → times [s], frequencies [Hz], density [bin, column]
    [dB re 1 µPa²/Hz], length of a window [s]
    """
    b = data.envelope(ping)
    # As long as a tone lasts, for its line and its Doppler; for a sweep, 1/√(sweep rate), which
    # resolves time and frequency alike.
    sweep = data.pulse_sweep > 0 and data.bandwidth > 0
    length = np.sqrt(data.pulse_duration / data.bandwidth) if sweep else data.pulse_duration
    window = int(np.clip(round(length * b.rate), 16, max(b.values.shape[1] // 4, 16)))
    time, frequency, density = signal.spectrogram(b, window, 900)
    inside = np.abs(frequency - b.carrier) <= 0.5 * b.width
    return time, frequency[inside], signal.decibels(density)[inside], window / b.rate


def colour_limits(data, ping, db, window: float):
    """An echo's energy lies in 1/T or, for a sweep, in its band: its density is that much lower."""
    spread = 10.0 * np.log10(max(data.bandwidth, 1.0 / window, 1e-3))
    return style.colour_limits(db, data.loudest_echo(ping) - spread)


@style.picture
def draw(data, ping, axes=None, limits=None):
    b = data.envelope(ping)
    time, frequency, db, window = record(data, ping)
    fig, axes = style.figure(TITLE, 4.8, axes)
    limits = limits or colour_limits(data, ping, db, window)
    mesh = style.image(axes, style.cell_edges(time),
                       style.cell_edges(frequency - data.centre_frequency), db, limits)
    style.image_frame(axes)
    style.time_axis(axes, b.start, b.end)
    axes.set_ylim(frequency[0] - data.centre_frequency, frequency[-1] - data.centre_frequency)
    axes.set_ylabel(f"frequency above {data.centre_frequency:g} Hz / Hz")
    if data.pulse_sweep == 0:
        speed = data.sound_speed(float(np.mean(data.phones(ping)[:, 2])))
        # two-way Doppler, Hz per m/s
        shift = 2.0 * data.centre_frequency / speed
        right = axes.secondary_yaxis("right", functions=(lambda f: f / shift, lambda v: v * shift))
        right.set_ylabel("closing speed / m/s")
        right.tick_params(length=3)
    style.colour_bar(fig, mesh, axes, "spectral level / dB re 1 µPa²/Hz")
    phones = "1 phone" if data.channels == 1 else f"mean over {data.channels} phones"
    style.subtitle(axes, f"{data.heading(ping)}  ·  {phones}, windows of {window:.3g} s",
                   marks=True)
    style.legend_below(axes, mark_echoes(axes, data.echoes(ping), data.pulse_duration))
    return fig

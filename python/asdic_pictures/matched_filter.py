"""The record correlated with the transmitted pulse: a sweep's echoes become narrow peaks."""
from __future__ import annotations

import numpy as np
from matplotlib.lines import Line2D

from . import signal, style
from .pressure import extremes

TITLE = "Matched filter"
COLUMNS = 1400


def nothing_to_show(data, ping):
    if data.pulse_sweep == 0:
        return "a tone has nothing to compress"
    if data.valid_samples[ping] < data.replica().size:
        return "the record is shorter than the pulse"
    return None


def compress(envelopes, replica, axis=-1):
    """Correlates envelopes with the replica's, both at one rate. → same shape as envelopes

    y(τ) = Σ p(t + τ)·s*(t) / Σ |s(t)|²: an echo A·s(t − τ) has its peak |A| at its leading edge τ.
    """
    n = envelopes.shape[axis]
    length = signal.fast_length(n + len(replica))
    weight = np.conj(np.fft.fft(replica, length)) / np.sum(np.abs(replica) ** 2)
    return np.fft.ifft(np.fft.fft(envelopes, length, axis=axis) * weight, axis=axis)[..., :n]


def replica_envelope(data, b):
    """The stored pulse, in the band and at the rate of `b`. → [sample]"""
    replica = data.replica()
    padded = np.zeros(int(round(b.duration * data.sample_rate)))
    padded[: len(replica)] = replica[: len(padded)]
    # as long as the record, so that rate and carrier are the same
    r = signal.baseband([padded], data.sample_rate, data.centre_frequency, b.width,
                        least=b.least).values[0]
    return r[: int(np.ceil(len(replica) / data.sample_rate * b.rate)) + 1]


def towards(b, phones, travel, speed):
    """Beam towards the sound that travels along `travel`: exact delays. → envelope [1, sample]"""
    x = phones - phones.mean(axis=0)
    delay = x @ travel / speed                                           # [phone] [s]
    length = signal.fast_length(b.values.shape[1]
                                + int(np.ceil(signal.FILTER_LENGTH / b.width * b.rate)))
    f = b.carrier + np.fft.fftfreq(length, 1.0 / b.rate)
    total = sum(np.fft.fft(values, length) * np.exp(2j * np.pi * f * t)
                for values, t in zip(b.values, delay))
    return np.fft.ifft(total / len(phones))[None, : b.values.shape[1]]


def filtered(data, ping, echo):
    """What the picture shows. → times [s], mean over the phones [dB], beam towards `echo` [dB]/None

    dB re 1 µPa of the matched echo's level before its window, as `level_db` in the file.
    """
    b = data.envelope(ping)
    replica = replica_envelope(data, b)
    mean = np.mean([0.5 * np.abs(compress(p, replica)) ** 2 for p in b.values], axis=0)
    beam = None
    phones = data.phones(ping)
    if echo is not None and data.channels > 1 and np.all(np.isfinite(phones)):
        received = towards(b, phones, echo.direction[echo.strongest],
                           data.sound_speed(float(phones[:, 2].mean())))
        beam = signal.decibels(0.5 * np.abs(compress(received, replica)[0]) ** 2)
    return b.times, signal.decibels(mean), beam


def peaks(time, db):
    """The largest value of each of at most COLUMNS spans: a narrow peak is never lost."""
    _, most, starts = extremes(np.nan_to_num(db, nan=-300.0), COLUMNS)
    return time[starts], most


def blast(data, time, loudest, echoes):
    """Which times belong to the transmitter's own sound: from the loudest of all for as long as a pulse
    is, before and after, where that is far above the rest and no echo.
    """
    mine = np.abs(time - time[int(np.argmax(loudest))]) <= data.pulse_duration
    echo = any((np.abs(e.delay - time[int(np.argmax(loudest))]) < data.pulse_duration).any()
               for e in echoes)
    if echo or mine.all() or loudest.max() < loudest[~mine].max() + 10.0:
        return np.zeros(time.size, bool)
    return mine


def level_limits(data, time, lines, echoes):
    """Of the upper panel: from 10 dB under the last line's fifth percentile to 5 dB above all that comes
    beside the transmitter's own sound. A span of more than 80 dB is cut at its top, but not the echo of a
    target; then it is at most 100 dB.
    """
    shown = [peaks(time, db) for db in lines]
    at, loudest = shown[0][0], np.max([most for _, most in shown], axis=0)
    if not (loudest > -300.0).any():
        return -55.0, 5.0
    rest = ~blast(data, at, loudest, echoes)
    last = shown[-1][1][rest]
    received = last[last > -300.0]
    top = loudest[rest].max() + 5.0
    low = np.percentile(received, 5) - 10.0 if received.size else top - 60.0
    delays = np.concatenate([np.zeros(0)] + [e.delay[e.strong(at[0], at[-1])] for e in echoes])
    near = [loudest[np.argmin(np.abs(at - t))] + 5.0 for t in delays]
    cut = max([low + 80.0, *near])
    return float(max(low, min(top, cut) - 100.0)), float(min(top, cut))


def tell_what_is_above(axes) -> None:
    """A line that is cut is not lower: its name in the legend says how high it goes."""
    for line in axes.get_lines():
        highest = np.max(line.get_ydata())
        if highest > axes.get_ylim()[1]:
            line.set_label(f"{line.get_label()} (above the axis up to {highest:.0f} dB)")


@style.picture
def draw(data, ping, axes=None, limits=None):
    last = data.start + data.valid_samples[ping] / data.sample_rate
    echoes = [e for e in data.echoes(ping) if data.start <= e.delay[e.strongest] <= last]
    best = max(echoes, key=lambda e: e.level_db[e.strongest], default=None)
    time, mean, beam = filtered(data, ping, best)
    name = style.name(best.name) if best else ""
    fig, axes = style.figure(TITLE, 6.4 if best else 4.4, axes, nrows=2 if best else 1, squeeze=False)

    whole = axes[0, 0]
    lines = [(mean, style.GREY, "1 phone" if data.channels == 1 else "mean over the phones")]
    if beam is not None:
        lines.append((beam, style.INK, f"beam towards {name}"))
    for db, colour, label in lines:
        whole.plot(*peaks(time, db), color=colour, lw=0.9, label=label)
    whole.set_ylim(*(limits or level_limits(data, time, [db for db, _, _ in lines], echoes)))
    style.time_axis(whole, data.start, last)
    style.subtitle(whole, f"{data.heading(ping)}  ·  {data.pulse_kind} pulse of "
                   f"{data.pulse_duration:g} s, {data.bandwidth:.0f} Hz", marks=True)
    tell_what_is_above(whole)
    handles = whole.get_legend_handles_labels()[0] + mark_edges(whole, echoes)
    if best:
        near = axes[1, 0]
        span = zoom(data, best, last)
        loudest = best.level_db.max()
        for db, colour, _ in lines:
            shown = (time >= span[0]) & (time <= span[1])
            near.plot(time[shown], db[shown], color=colour, lw=1.1)
            loudest = max(loudest, db[shown].max(initial=-np.inf))
        low, high = whole.get_ylim()
        near.set_ylim(min(low, best.level_db.max() - 10.0), min(high, loudest + 8.0))
        for echo in echoes:
            mine = (echo.delay >= span[0]) & (echo.delay <= span[1])
            near.plot(echo.delay[mine], echo.level_db[mine], ls="none", marker="o", ms=8, mew=1.5,
                      mfc="none", mec=style.colour(echo.target), zorder=5,
                      path_effects=list(style.OVER_MAP))
        handles.append(Line2D([], [], ls="none", marker="o", ms=8, mew=1.5, mfc="none",
                              mec=style.colour(best.target), label="true time and level"))
        style.time_axis(near, *span)
        style.subtitle(near, f"near the strongest path: {name}, "
                       f"{best.delay[best.strongest]:.3f} s")
    for panel in axes[:, 0]:
        panel.set_ylabel("level / dB re 1 µPa")
        panel.grid(True)
    style.legend_below(axes[-1, 0], handles, ncol=4)
    return fig


def mark_edges(axes, echoes) -> list:
    """A mark over the axes at the leading edge of every strong path pair: there the filter has its
    peak. → handles for a legend
    """
    handles = []
    for echo in echoes:
        first, last = axes.get_xlim()
        shown = style.told_apart(echo.delay[echo.strong(first, last)], last - first)
        if shown.size:
            axes.plot(shown, np.full(shown.size, 1.02), transform=axes.get_xaxis_transform(),
                      clip_on=False, zorder=5, **style.truth(echo.target, "v", 7))
            label = f"{style.name(echo.name)}: true leading edge"
            if label not in [h.get_label() for h in handles]:
                handles.append(Line2D([], [], **style.truth(echo.target, "v", 7, label)))
    return handles[:6]


def zoom(data, echo, last):
    """The strong paths around the strongest one, at most a few pulses away. → first, last [s]"""
    middle = echo.delay[echo.strongest]
    close = echo.delay[echo.strong(data.start, last)]
    close = close[np.abs(close - middle) <= 2.0 * data.pulse_duration]
    resolution = 1.0 / max(data.bandwidth, 1.0 / data.pulse_duration)
    room = max(20.0 * resolution, 0.3 * np.ptp(close))
    return max(close.min() - room, data.start), min(close.max() + room, last)

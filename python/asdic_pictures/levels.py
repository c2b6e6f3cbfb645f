"""Level against time with echo, reverberation and noise each by itself."""
from __future__ import annotations

import numpy as np

from . import signal, style
from .pressure import mark_echoes

TITLE = "Level over time: echo, reverberation, noise"


def nothing_to_show(data, ping):
    if not data.has("levels/echo") or data.levels(ping)[0].size == 0:
        return "the file holds no levels"
    return None


def measured(data, ping, step: float):
    """Mean-square pressure over all phones, step by step. → time of the middles [s], [Pa²]"""
    per = max(int(round(step * data.sample_rate)), 1)
    total = None
    for channel in range(data.channels):
        p = data.pressure(ping, channel)
        square = np.add.reduceat(p * p, np.arange(0, len(p), per))
        total = square if total is None else total + square
    counts = np.diff(np.append(np.arange(0, len(p), per), len(p)))
    time = data.start + (np.arange(len(total)) * per + 0.5 * counts) / data.sample_rate
    return time, total / counts / data.channels


def curves(data, ping) -> dict:
    """What the picture shows of the phones that are selected: "measured", "in band", "noise",
    "reverberation", "echo" → middles of steps [s], level [dB re 1 µPa]
    """
    time, parts = data.levels(ping)
    step = interval(data, time)
    t_total, total = measured(data, ping, step)
    per = max(int(round(step * data.sample_rate)), 1)
    b = data.envelope(ping)
    edges = data.start + np.append(np.arange(len(t_total)) * per / data.sample_rate, b.duration)
    in_band = b.average(0.5 * np.mean(np.abs(b.values) ** 2, axis=0), edges)
    # level_time tells where a step starts
    starts = time.size and time[0] - data.start < 0.25 * step
    middle = time + 0.5 * step if starts else time
    found = {"measured": (t_total, signal.decibels(total)),
             "in band": (t_total, signal.decibels(in_band))}
    return found | {key: (middle, signal.decibels(parts[key]))
                    for key in ("noise", "reverberation", "echo")}


def interval(data, time) -> float:
    """Length of a step of the levels [s]"""
    return float(np.median(np.diff(time))) if time.size > 1 else data.samples / data.sample_rate


@style.picture
def draw(data, ping, axes=None, limits=None):
    """The levels in the file are means over all phones: so is what is measured here."""
    chosen = data.array
    data.select_array(None)
    try:
        return draw_all_phones(data, ping, axes, limits)
    finally:
        data.select_array(chosen)


def draw_all_phones(data, ping, axes, limits):
    lines = curves(data, ping)
    step = interval(data, data.levels(ping)[0])
    width = data.envelope(ping).width
    t_total, total = lines["measured"]
    in_band = lines["in band"][1]
    echoes = all_echoes(data, ping)
    targets = len({e.target for e in echoes})
    fig, axes = style.figure(TITLE, 4.8, axes)
    axes.plot(t_total, total, color=style.INK, lw=0.9, label="measured, all frequencies", zorder=3)
    axes.plot(t_total, in_band, color=style.INK, lw=0.9, ls=(0, (4, 1.5)),
              label=f"measured, in {width:.0f} Hz", zorder=3)
    shown = [total, in_band]
    drawn = []
    for key, colour in (("noise", style.GREY), ("reverberation", style.SLATE),
                        ("echo", echo_colour(echoes))):
        middle, db = lines[key]
        if np.isfinite(db).any():
            label = f"echo, all {targets} targets" if key == "echo" and targets > 1 else key
            drawn.append(axes.plot(middle, db, color=colour, lw=1.9, label=label, zorder=4,
                                   alpha=0.9)[0])
            shown.append(db)
    fit(axes, shown)
    if limits:
        axes.set_ylim(*limits)
    say_what_is_hidden(axes, drawn)
    style.time_axis(axes, data.start, max(t_total[-1] + 0.5 * step, data.start + step))
    axes.set_ylabel("level / dB re 1 µPa")
    axes.grid(True)
    phones = "1 phone" if data.channels == 1 else f"mean over {data.channels} phones"
    style.subtitle(axes, f"{data.heading(ping)}  ·  {phones}, steps of {1e3 * step:.0f} ms", marks=True)
    marks = mark_echoes(axes, echoes, data.pulse_duration)
    style.legend_below(axes, axes.get_legend_handles_labels()[0] + marks)
    return fig


def all_echoes(data, ping):
    """Of every array: marks of what each receives."""
    return [echo for number in range(len(data.array_names)) for echo in data.echoes(ping, number)]


def echo_colour(echoes):
    """A target's own colour; one that belongs to none where the line is the sum over several."""
    return style.colour(echoes[0].target) if len({e.target for e in echoes}) == 1 else style.BROWN


def say_what_is_hidden(axes, lines):
    """A line below the axis is not missing: its name in the legend says so."""
    for line in lines:
        highest = np.nanmax(line.get_ydata())
        if highest < axes.get_ylim()[0]:
            line.set_label(f"{line.get_label()} (below the axis, at most {highest:.0f} dB)")


def fit(axes, curves):
    """From 10 dB below what is measured, at most 100 dB below the peak: tails unheard are cut."""
    good = [c[np.isfinite(c)] for c in curves]
    values = np.concatenate(good) if good else np.zeros(0)
    if values.size == 0:
        axes.set_ylim(0.0, 100.0)
        style.silence(axes, values)
        return
    top = values.max() + 5.0
    received = np.concatenate(good[:2])
    low = (np.percentile(received, 2) if received.size else values.min()) - 10.0
    axes.set_ylim(max(low, top - 100.0), top)

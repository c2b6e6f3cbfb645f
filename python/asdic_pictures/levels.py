"""Level against time with echo, reverberation and noise told apart."""
from __future__ import annotations

import numpy as np

from . import signal, style
from .pressure import mark_echoes

TITLE = "Level over time: echo, reverberation, noise"


def nothing_to_show(data, ping):
    if not data.has("levels") or data.read("levels/level_time").size == 0:
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


def draw(data, ping):
    time, parts = data.levels(ping)
    step = float(np.median(np.diff(time))) if time.size > 1 else data.samples / data.sample_rate
    t_total, total = measured(data, ping, step)
    b = data.envelope(ping)
    in_band = signal.average(0.5 * np.mean(np.abs(b.values) ** 2, axis=0), len(t_total))
    t_band = b.start + (np.arange(len(in_band)) + 0.5) * b.values.shape[1] / b.rate / len(in_band)

    fig, axes = style.figure(TITLE, 4.8)
    # level_time tells where a step starts
    starts = time.size and time[0] - data.start < 0.25 * step
    middle = time + 0.5 * step if starts else time
    axes.plot(t_total, signal.decibels(total), color=style.INK, lw=0.9,
              label="measured, all frequencies", zorder=3)
    axes.plot(t_band, signal.decibels(in_band), color=style.INK, lw=0.9, ls=(0, (4, 1.5)),
              label=f"measured, in {b.width:.0f} Hz", zorder=3)
    shown = [signal.decibels(total), signal.decibels(in_band)]
    for key, colour in (("noise", style.GREY), ("reverberation", style.BLUE),
                        ("echo", style.VERMILION)):
        db = signal.decibels(parts[key])
        if np.isfinite(db).any():
            axes.plot(middle, db, color=colour, lw=1.9, label=key, zorder=4, alpha=0.9)
            shown.append(db)
    limits(axes, shown)
    style.time_axis(axes, data.start, max(t_total[-1] + 0.5 * step, data.start + step))
    axes.set_ylabel("level / dB re 1 µPa")
    axes.grid(True)
    phones = "1 phone" if data.channels == 1 else f"mean over {data.channels} phones"
    style.subtitle(axes, f"{data.heading(ping)}  ·  {phones}, steps of {1e3 * step:.0f} ms")
    marks = mark_echoes(axes, data.echoes(ping))
    style.legend_below(axes, axes.get_legend_handles_labels()[0] + marks)
    return fig


def limits(axes, curves):
    """From 10 dB below what is measured, at most 100 dB below the peak: tails unheard are cut."""
    good = [c[np.isfinite(c)] for c in curves]
    values = np.concatenate(good) if good else np.zeros(0)
    if values.size == 0:
        axes.set_ylim(0.0, 100.0)
        style.silence(axes, values)
        return
    top = values.max() + 5.0
    heard = np.concatenate(good[:2])
    low = (np.percentile(heard, 2) if heard.size else values.min()) - 10.0
    axes.set_ylim(max(low, top - 100.0), top)

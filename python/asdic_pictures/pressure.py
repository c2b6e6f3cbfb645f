"""Pressures of all phones over each other: the record, and the pulse's band near the best echo."""
from __future__ import annotations

import numpy as np
from matplotlib.lines import Line2D

from . import style

TITLE = "Pressure at the hydrophones"
COLUMNS = 1400


def nothing_to_show(data, ping):
    return None


def extremes(p, columns: int = COLUMNS):
    """Smallest and largest sample of each span, which draw what all samples would.

    → least, greatest, index of each span's first sample
    """
    columns = max(min(columns, len(p)), 1)
    starts = np.linspace(0, len(p), columns + 1).astype(int)[:-1]
    return np.minimum.reduceat(p, starts), np.maximum.reduceat(p, starts), starts


def phone_colours(count: int):
    return style.plt.get_cmap("cividis")(np.linspace(0.1, 0.8, count))


def prefix(peak: float):
    """Factor and unit that make `peak` [Pa] easy to read"""
    for factor, unit in ((1.0, "Pa"), (1e3, "mPa"), (1e6, "µPa")):
        if peak * factor >= 1.0:
            return factor, unit
    return 1e6, "µPa"


def draw_phones(axes, pressures, first: int, last: int, data):
    """Envelopes of the samples [first, last) of each phone, later phones over earlier ones."""
    peak = max(float(np.abs(p[first:last]).max(initial=0.0)) for p in pressures)
    factor, unit = prefix(peak)
    for colour, p in zip(phone_colours(len(pressures)), pressures):
        low, high, starts = extremes(p[first:last])
        t = data.start + (first + starts) / data.sample_rate
        if last - first <= COLUMNS:      # every sample is drawn: a line
            axes.plot(t, factor * p[first:last], color=colour, lw=0.8, alpha=0.8)
        else:
            axes.fill_between(t, factor * low, factor * high, color=colour, alpha=0.5, lw=0.35)
    axes.set_ylim(-1.08 * max(factor * peak, 1e-3), 1.08 * max(factor * peak, 1e-3))
    axes.set_ylabel(f"pressure / {unit}")
    style.time_axis(axes, data.start + first / data.sample_rate,
                    data.start + last / data.sample_rate)
    axes.grid(True)


def mark_echoes(axes, echoes):
    """A mark on the upper edge for every strong path pair. → handles for a legend"""
    handles = []
    for echo in echoes:
        shown = echo.delay[echo.strong(*axes.get_xlim())]
        if shown.size:
            axes.plot(shown, np.full(shown.size, 0.985), transform=axes.get_xaxis_transform(),
                      clip_on=False, zorder=5, **style.truth(echo.target, "v", 7))
            label = f"{style.name(echo.name)}: true echo times"
            if label not in [h.get_label() for h in handles]:  # received by several arrays
                handles.append(Line2D([], [], **style.truth(echo.target, "v", 7, label)))
    return handles[:6]


def draw(data, ping):
    pressures = [data.pressure(ping, channel) for channel in range(data.channels)]
    n = len(pressures[0])
    first_time, last_time = data.start, data.start + n / data.sample_rate
    echoes = [e for e in data.echoes(ping) if first_time <= e.delay[e.strongest] <= last_time]
    fig, axes = style.figure(TITLE, 6.4 if echoes else 4.4, nrows=2 if echoes else 1, squeeze=False)
    whole = axes[0, 0]
    draw_phones(whole, pressures, 0, n, data)
    phones = "1 phone" if data.channels == 1 else f"{data.channels} phones over each other"
    style.subtitle(whole, f"{data.heading(ping)}  ·  {phones}")
    handles = mark_echoes(whole, echoes)
    if echoes:
        draw_strongest(axes[1, 0], data, ping, max(echoes, key=lambda e: e.level_db[e.strongest]))
        mark_echoes(axes[1, 0], echoes)
        style.legend_below(axes[1, 0], handles, ncol=3, below=0.22)
    return fig


def draw_strongest(axes, data, ping, echo):
    """The pulse's band alone, around the strongest path pair: ± the envelope of each phone."""
    time = echo.delay[echo.strongest]
    b = data.envelope(ping)
    first, last = time - 2.0 * data.pulse_duration, time + 4.0 * data.pulse_duration
    shown = (b.times >= first) & (b.times <= last)
    peak = float(np.abs(b.values[:, shown]).max(initial=0.0))
    factor, unit = prefix(peak)
    for colour, values in zip(phone_colours(data.channels), b.values):
        envelope = factor * np.abs(values[shown])
        axes.plot(b.times[shown], envelope, color=colour, lw=1.0, alpha=0.8)
        axes.plot(b.times[shown], -envelope, color=colour, lw=1.0, alpha=0.8)
    axes.set_ylim(-1.08 * max(factor * peak, 1e-3), 1.08 * max(factor * peak, 1e-3))
    axes.set_ylabel(f"± envelope / {unit}")
    style.time_axis(axes, max(first, b.times[0]), min(last, b.times[-1]))
    axes.grid(True)
    level = echo.level_db[echo.strongest]
    style.subtitle(axes, f"{b.width:.0f} Hz around {data.centre_frequency:g} Hz, near the "
                   f"strongest path: {style.name(echo.name)}, {time:.2f} s, {level:.0f} dB re 1 µPa")

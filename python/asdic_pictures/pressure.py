"""Pressures of all phones as a gather, a row each: the record, and the pulse's band near the best
echo."""
from __future__ import annotations

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D

from . import signal, style

TITLE = "Pressure at the hydrophones"
COLUMNS = 1400
MOST_TRACES = 16    # of more phones, levels in colours


def nothing_to_show(data, ping):
    return None


def extremes(p, columns: int = COLUMNS):
    """Smallest and largest sample of each span, which draw what all samples would.

    → least, greatest, index of each span's first sample
    """
    columns = max(min(columns, len(p)), 1)
    starts = np.linspace(0, len(p), columns + 1).astype(int)[:-1]
    return np.minimum.reduceat(p, starts), np.maximum.reduceat(p, starts), starts


def prefix(peak: float):
    """Factor and unit that make `peak` [Pa] easy to read"""
    for factor, unit in ((1.0, "Pa"), (1e3, "mPa"), (1e6, "µPa")):
        if peak * factor >= 1.0:
            return factor, unit
    return 1e6, "µPa"


def phone_axis(axes, count: int) -> None:
    """Phones from 0 as in the file, the first on top."""
    axes.set_ylim(count - 0.4, -0.6)
    axes.set_ylabel("phone")
    axes.yaxis.set_major_locator(style.ticker.MaxNLocator(9, integer=True, steps=[1, 2, 4, 5, 8, 10]))


def one_trace(axes, t, low, high, factor: float, unit: str, peak: float, what: str) -> None:
    """Of a single phone: on an axis of pressure."""
    if len(t) < COLUMNS // 2:
        axes.plot(t, factor * high, color=style.BLUE, lw=0.8)
        axes.plot(t, factor * low, color=style.BLUE, lw=0.8)
    else:
        axes.fill_between(t, factor * low, factor * high, color=style.BLUE, lw=0.35)
    span = 1.08 * max(factor * peak, 1e-3)
    axes.set_ylim(-span, span)
    axes.set_ylabel(f"{what} / {unit}")
    axes.grid(True)


def traces(axes, t, lows, highs, factor: float, unit: str, peak: float) -> str:
    """A row a phone, all at one scale. → which that is"""
    scale = 0.47 / max(peak, 1e-30)
    lows, highs = (np.clip(rows, -peak, peak) for rows in (lows, highs))
    for k, (low, high) in enumerate(zip(lows, highs)):
        shade = (style.BLUE, style.SLATE)[k % 2]
        axes.fill_between(t, k - scale * high, k - scale * low, color=shade, lw=0.35)
    phone_axis(axes, len(lows))
    return f"  ·  a row is ±{factor * peak:.3g}\u00a0{unit}\u00a0high"


def levels(axes, edges, db, limits):
    """Rows in colours. → what a colour bar needs"""
    mesh = style.image(axes, edges, np.arange(len(db) + 1) - 0.5, db, limits)
    phone_axis(axes, len(db))
    axes.set_ylim(len(db) - 0.5, -0.5)
    style.image_frame(axes)
    return mesh


def mark_echoes(axes, echoes, duration: float):
    """A bar over the axes while each strong path pair's pulse is received, a stroke where it begins.
    → handles for a legend
    """
    handles = []
    first, last = axes.get_xlim()
    above = axes.get_xaxis_transform()
    for echo in echoes:
        starts = echo.delay[echo.strong(first - duration, last)]
        if not starts.size:
            continue
        shade = style.colour(echo.target)
        bars = [[(max(a, first), 1.02), (min(b, last), 1.02)]
                for a, b, _ in style.together(starts, starts + duration, np.zeros(starts.size), 1.0)
                if b > first]
        axes.add_collection(LineCollection(bars, colors=shade, linewidths=5.0, capstyle="butt",
                                           transform=above, clip_on=False, zorder=5),
                            autolim=False)
        seen = style.told_apart(starts[starts >= first], last - first)
        axes.plot(seen, np.full(seen.size, 1.02), ls="none", marker="|", ms=8, mew=1.1, color=style.INK,
                  transform=above, clip_on=False, zorder=6)
        label = f"{style.name(echo.name)}: true echo, one pulse long"
        if label not in [h.get_label() for h in handles]:  # received by several arrays
            handles.append(Line2D([], [], color=shade, lw=5.0, solid_capstyle="butt", label=label))
    return handles[:6]


@style.picture
def draw(data, ping, axes=None, limits=None):
    pressures = [data.pressure(ping, channel) for channel in range(data.channels)]
    n = len(pressures[0])
    first_time, last_time = data.start, data.start + n / data.sample_rate
    echoes = [e for e in data.echoes(ping) if first_time <= e.delay[e.strongest] <= last_time]
    tall = 1.0 if data.channels > 4 else 0.0
    fig, panels = style.figure(TITLE, 6.4 + 1.6 * tall if echoes else 4.4 + tall, axes,
                               nrows=2 if echoes else 1, squeeze=False)
    whole = panels[0, 0]
    scale = draw_record(fig, whole, pressures, data, limits)
    phones = "1 phone" if data.channels == 1 else f"{data.channels} phones"
    style.subtitle(whole, f"{data.heading(ping)}  ·  {phones}, all frequencies{scale}", marks=True)
    style.time_axis(whole, first_time, last_time)
    handles = mark_echoes(whole, echoes, data.pulse_duration)
    if echoes:
        near = panels[1, 0]
        draw_strongest(fig, near, data, ping, max(echoes, key=lambda e: e.level_db[e.strongest]),
                       limits)
        mark_echoes(near, echoes, data.pulse_duration)
        style.legend_below(near, handles, ncol=3)
    return fig


def draw_record(fig, axes, pressures, data, limits) -> str:
    """All that was received. → what its rows are"""
    peak = max(float(np.abs(p).max(initial=0.0)) for p in pressures)
    factor, unit = prefix(peak)
    n = len(pressures[0])
    if len(pressures) <= MOST_TRACES:
        spans = [extremes(p) for p in pressures]
        t = data.start + spans[0][2] / data.sample_rate
        if len(pressures) == 1:
            one_trace(axes, t, *spans[0][:2], factor, unit, peak, "pressure")
        else:
            return traces(axes, t, [s[0] for s in spans], [s[1] for s in spans], factor, unit, peak)
        return ""
    starts = np.linspace(0, n, min(COLUMNS, n) + 1).astype(int)
    power = [np.add.reduceat(p * p, starts[:-1]) / np.diff(starts) for p in pressures]
    db = signal.decibels(power)
    mesh = levels(axes, data.start + starts / data.sample_rate, db,
                  limits or style.colour_limits(db))
    style.colour_bar(fig, mesh, axes, "level / dB re 1 µPa")
    return ""


def draw_strongest(fig, axes, data, ping, echo, limits) -> None:
    """The pulse's band alone, around the strongest path pair: ± the envelope of each phone."""
    time = echo.delay[echo.strongest]
    b = data.envelope(ping)
    first, last = time - 2.0 * data.pulse_duration, time + 4.0 * data.pulse_duration
    shown = (b.times >= first) & (b.times <= last)
    envelopes = np.abs(b.values[:, shown])
    peak = float(envelopes.max(initial=0.0))
    during = (b.times[shown] >= time) & (b.times[shown] <= time + data.pulse_duration)
    own = float(envelopes[:, during].max(initial=0.0))
    peak = min(peak, 3.0 * own) if own > 0.0 else peak      # what is louder beside it is clipped
    factor, unit = prefix(peak)
    scale = ""
    if data.channels > MOST_TRACES and shown.sum() > 1:
        db = signal.decibels(0.5 * envelopes**2)
        level = float(echo.level_db[echo.strongest])
        mesh = levels(axes, style.cell_edges(b.times[shown]), db,
                      limits or style.colour_limits(db, level))
        style.colour_bar(fig, mesh, axes, "level / dB re 1 µPa")
    elif data.channels == 1:
        one_trace(axes, b.times[shown], -envelopes[0], envelopes[0], factor, unit, peak,
                  "± envelope")
    else:
        scale = traces(axes, b.times[shown], -envelopes, envelopes, factor, unit, peak)
    style.time_axis(axes, max(first, b.times[0]), min(last, b.times[-1]))
    level = echo.level_db[echo.strongest]
    style.subtitle(axes, f"{b.width:.0f} Hz around {data.centre_frequency:g} Hz, near the "
                   f"strongest path: {style.name(echo.name)}, {time:.2f} s, {level:.0f} dB re 1 µPa{scale}", marks=True)

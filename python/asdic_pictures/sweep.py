"""The pings of a sweep, one a row: level against time, beside the elevation of the beam."""
from __future__ import annotations

import numpy as np
from . import signal, style

TITLE = "History of the pings"
COLUMNS = 1000


def nothing_to_show(data, ping):
    return "the file holds one ping" if data.simulated.size < 2 else None


def history(data):
    """Mean level of the phones in the pulse's band; NaN past a record's end.

    → time edges [s], level [ping, column] [dB re 1 µPa], width of the band [Hz]
    """
    rows = data.simulated
    longest = int(data.valid_samples[rows].max())
    edges = data.start + np.linspace(0.0, longest, min(COLUMNS, longest) + 1) / data.sample_rate
    power = np.empty((rows.size, len(edges) - 1))
    for k, row in enumerate(rows):
        b = data.envelope(int(row))
        mine = np.minimum(edges, b.end)     # a shorter record ends within a column
        power[k] = b.average(0.5 * np.mean(np.abs(b.values) ** 2, axis=0), mine)
    return edges, signal.decibels(power), b.width


def row_edges(numbers):
    """A row reaches half a ping to either side of its number, whatever pings are missing."""
    return np.concatenate([[numbers[0] - 0.5], 0.5 * (numbers[1:] + numbers[:-1]),
                           [numbers[-1] + 0.5]])


@style.picture
def draw(data, ping, axes=None, limits=None):
    edges, db, width = history(data)
    rows = data.simulated
    numbers = data.numbers[rows]
    height = float(np.clip(2.8 + 0.28 * rows.size, 4.4, 9.0))
    elevation = data.elevation_deg[rows]
    if np.ptp(elevation) > 0:
        fig, (left, right) = style.figure(TITLE, height, axes, ncols=2, sharey=True,
                                          gridspec_kw={"width_ratios": [1, 6.2]})
        draw_elevations(left, elevation, numbers)
        right.tick_params(labelleft=False)
        beam = ""
    else:
        fig, right = style.figure(TITLE, height, axes)
        ping_axis(right)
        beam = f"  ·  beam {style.degrees(elevation[0])}" if np.isfinite(elevation[0]) else ""

    loudest = max(data.loudest_echo(int(row)) for row in rows)
    limits = limits or style.colour_limits(db, loudest)
    mesh = style.image(right, edges, row_edges(numbers), db, limits)
    right.set_ylim(numbers[-1] + 0.5, numbers[0] - 0.5)  # the first ping on top
    style.image_frame(right)
    style.time_axis(right, edges[0], edges[-1])
    style.colour_bar(fig, mesh, right, f"level in {width:.0f} Hz / dB re 1 µPa")
    ending = "  ·  stopped early" if data.stopped else ""
    style.subtitle(right, f"{data.title or data.path}  ·  {rows.size} pings{beam}{ending}")
    handles = [style.box_key(style.colour(target),
                             f"{style.name(name)}: its strongest true echo, one pulse long")
               for target, name in mark_true_echoes(right, data, edges).items()]
    style.legend_below(right, handles[:6], ncol=2)
    return fig


def ping_axis(axes):
    axes.set_ylabel("ping")
    axes.yaxis.set_major_locator(style.ticker.MaxNLocator(12, integer=True, steps=[1, 2, 5, 10]))


def draw_elevations(axes, elevation_deg, numbers):
    axes.plot(elevation_deg, numbers, color=style.INK, marker="o", ms=4.5, lw=1.0)
    axes.set_xlabel("beam elevation\ndegrees, up positive")
    axes.margins(x=0.15)
    ping_axis(axes)
    axes.grid(True)


def mark_true_echoes(axes, data, edges):
    """A box in each ping's row around the strongest echo of every target. → names of targets"""
    marked = {}
    for row in data.simulated:
        for echo in data.echoes(int(row)):
            time = echo.delay[echo.strongest]
            if edges[0] <= time <= data.start + data.valid_samples[row] / data.sample_rate:
                number = data.numbers[row]
                style.box(axes, time, time + data.pulse_duration, number - 0.42, number + 0.42,
                          style.colour(echo.target))
                marked[echo.target] = echo.name
    return marked

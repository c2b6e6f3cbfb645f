"""The pings of a sweep, one a row: level against time, beside the elevation of the beam."""
from __future__ import annotations

import numpy as np
from matplotlib.lines import Line2D

from . import signal, style

TITLE = "History of the sweep"
COLUMNS = 1000


def nothing_to_show(data, ping):
    return "the file holds one ping" if data.simulated.size < 2 else None


def history(data):
    """Mean level of the phones in the pulse's band; NaN past a record's end.

    → time edges [s], level [ping, column] [dB re 1 µPa], width of the band [Hz]
    """
    rows = data.simulated
    longest = int(data.valid_samples[rows].max())
    columns = min(COLUMNS, longest)
    power = np.full((rows.size, columns), np.nan)
    for k, row in enumerate(rows):
        b = data.envelope(int(row))
        mine = max(int(round(columns * data.valid_samples[row] / longest)), 1)
        values = signal.average(0.5 * np.mean(np.abs(b.values) ** 2, axis=0), mine)
        power[k, :mine] = np.repeat(values, -(-mine // len(values)))[:mine]
    edges = data.start + np.linspace(0.0, longest / data.sample_rate, columns + 1)
    return edges, signal.decibels(power), b.width


def draw(data, ping):
    edges, db, width = history(data)
    rows = data.simulated
    numbers = data.numbers[rows]
    height = float(np.clip(2.8 + 0.28 * rows.size, 4.4, 9.0))
    fig, (left, right) = style.figure(TITLE, height, ncols=2, sharey=True,
                                      gridspec_kw={"width_ratios": [1, 6.2]})
    draw_elevations(left, data.elevation_deg[rows], numbers)

    low, high = style.colour_limits(db)
    mesh = right.pcolormesh(edges, np.append(numbers - 0.5, numbers[-1] + 0.5), db, cmap=style.MAP,
                            vmin=low, vmax=high, shading="flat", rasterized=True)
    right.set_ylim(numbers[-1] + 0.5, numbers[0] - 0.5)  # the first ping on top
    right.tick_params(labelleft=False)
    style.image_frame(right)
    style.time_axis(right, edges[0], edges[-1])
    style.colour_bar(fig, mesh, right, f"level in {width:.0f} Hz / dB re 1 µPa")
    ending = "  ·  stopped early" if data.stopped else ""
    style.subtitle(right, f"{data.title or data.path}  ·  {rows.size} pings{ending}")
    marked = mark_true_echoes(right, data, edges)
    if marked:
        names = ", ".join(style.name(n) for n in marked)
        label = "true time of the strongest echo: "
        label += names if len(marked) < 4 else f"{len(marked)} targets"
        stroke = Line2D([], [], marker="|", ls="none", ms=11, mew=1.5, color="white",
                        path_effects=style.OVER_MAP, label=label)
        style.legend_below(right, [stroke])
    return fig


def draw_elevations(axes, elevation_deg, numbers):
    axes.plot(elevation_deg, numbers, color=style.BLUE, marker="o", ms=4.5, lw=1.0)
    axes.set_xlabel("beam elevation\ndegrees, up positive")
    axes.set_ylabel("ping")
    axes.margins(x=0.15)
    axes.yaxis.set_major_locator(style.ticker.MaxNLocator(12, integer=True, steps=[1, 2, 5, 10]))
    axes.grid(True)


def mark_true_echoes(axes, data, edges):
    """A stroke through each ping's row at the strongest echo of every target. → names of targets"""
    marked = {}
    for row in data.simulated:
        for echo in data.echoes(int(row)):
            time = echo.delay[echo.strongest]
            if edges[0] <= time <= edges[-1]:
                number = data.numbers[row]
                axes.plot([time, time], [number - 0.38, number + 0.38], color="white", lw=1.5,
                          path_effects=style.OVER_MAP, zorder=4)
                marked[echo.target] = echo.name
    return list(marked.values())

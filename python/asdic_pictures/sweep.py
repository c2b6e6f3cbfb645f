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
    """Mean level of the phones in the pulse's band. → time edges [s], [ping, column] [dB re 1 µPa], NaN past a record's end"""
    rows = data.simulated
    longest = int(data.valid_samples[rows].max())
    columns = min(COLUMNS, longest)
    power = np.full((rows.size, columns), np.nan)
    for k, row in enumerate(rows):
        b = data.envelope(int(row))
        mine = max(int(round(columns * data.valid_samples[row] / longest)), 1)
        values = signal.average(0.5 * np.mean(np.abs(b.values) ** 2, axis=0), mine)
        power[k, :mine] = np.repeat(values, -(-mine // len(values)))[:mine]
    return data.start + np.linspace(0.0, longest / data.sample_rate, columns + 1), signal.decibels(power)


def draw(data, ping):
    edges, db = history(data)
    rows = data.simulated
    numbers = data.numbers[rows]
    height = float(np.clip(2.8 + 0.28 * rows.size, 4.4, 9.0))
    fig, (left, right) = style.figure(TITLE, height, ncols=2, sharey=True, gridspec_kw={"width_ratios": [1, 6.2]})
    left.plot(data.elevation_deg[rows], numbers, color=style.BLUE, marker="o", ms=4.5, lw=1.0)
    left.set_xlabel("beam elevation\ndegrees, up positive")
    left.set_ylabel("ping")
    left.margins(x=0.15)
    left.yaxis.set_major_locator(style.ticker.MaxNLocator(integer=True, nbins=12, steps=[1, 2, 5, 10]))
    left.grid(True)

    low, high = style.colour_limits(db)
    mesh = right.pcolormesh(edges, np.append(numbers - 0.5, numbers[-1] + 0.5), db, cmap=style.MAP, vmin=low, vmax=high, shading="flat",
                            rasterized=True)
    right.set_ylim(numbers[-1] + 0.5, numbers[0] - 0.5)      # the first ping on top
    right.tick_params(labelleft=False)
    style.image_frame(right)
    style.time_axis(right, edges[0], edges[-1])
    style.colour_bar(fig, mesh, right, f"level in {data.envelope(int(rows[0])).width:.0f} Hz / dB re 1 µPa")
    style.subtitle(right, f"{data.title or data.path}  ·  {rows.size} pings" + ("  ·  stopped early" if data.stopped else ""))
    marked = mark_true_echoes(right, data, edges)
    if marked:
        text = ", ".join(style.name(n) for n in marked.values()) if len(marked) < 4 else f"{len(marked)} targets"
        style.legend_below(right, [Line2D([], [], marker="|", ls="none", ms=11, mew=1.5, color="white", path_effects=style.OVER_MAP,
                                          label=f"true time of the strongest echo: {text}")])
    return fig


def mark_true_echoes(axes, data, edges):
    """A stroke through each ping's row at the strongest echo of every target. → {target: name} of those marked"""
    marked = {}
    for row in data.simulated:
        for echo in data.echoes(int(row)):
            time = echo.delay[echo.strongest]
            if edges[0] <= time <= edges[-1]:
                number = data.numbers[row]
                axes.plot([time, time], [number - 0.38, number + 0.38], color="white", lw=1.5, path_effects=style.OVER_MAP, zorder=4)
                marked[echo.target] = echo.name
    return marked

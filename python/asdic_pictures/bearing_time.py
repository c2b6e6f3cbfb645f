"""Bearing–time record: every beam's level against time."""
from __future__ import annotations

import numpy as np
from matplotlib.lines import Line2D

from . import signal, style

TITLE = "Bearing–time record, conventional beams"
TITLES = {"horizontal": "Bearing–time record of the horizontal array",
          "vertical": "Elevation–time record of the vertical array",
          "azimuth": "Bearing–time record of the array"}
LABELS = {"horizontal": "apparent bearing relative to\nbroadside ({}° true)",
          "vertical": "look elevation, up positive",
          "azimuth": "look bearing, true, horizontal"}
COLUMNS = 900


def nothing_to_show(data, ping):
    if data.channels < 2:
        return "one phone tells no direction"
    phones = data.phones(ping)
    if not np.all(np.isfinite(phones)) or np.ptp(phones, axis=0).max() == 0:
        return "the phones are all in one place"
    return None


def record(data, ping):
    """What the picture shows. → scan, time edges [s], level [beam, column] [dB re 1 µPa]"""
    phones = data.phones(ping)
    where = signal.scan(phones)
    b = data.envelope(ping)
    speed = data.sound_speed(float(phones[:, 2].mean()))
    edges = b.edges(min(COLUMNS, b.values.shape[1]))
    power = signal.beam_power(b, phones, where.looks, speed, edges)
    return where, edges, signal.decibels(power)


def angle_axis(axes, where):
    """Degrees on an axis that is even in the sine for a line array."""
    if where.kind == "azimuth":
        axes.set_yticks(np.arange(0, 361, 45))
        ticks = np.arange(0, 361, 45)
    else:
        ticks = np.array([-90, -60, -45, -30, -15, 0, 15, 30, 45, 60, 90])
        axes.set_yticks(np.sin(np.radians(ticks)))
    signed = where.kind != "azimuth"
    axes.set_yticklabels([f"{t:+d}°".replace("-", "−") if signed and t else f"{t}°" for t in ticks])
    axes.set_ylabel(LABELS[where.kind].format(signal.broadside(where)))


def draw(data, ping):
    where, edges, db = record(data, ping)
    fig, axes = style.figure(TITLES[where.kind], 5.0)
    limits = style.colour_limits(db, data.loudest_echo(ping))
    mesh = style.image(axes, edges, style.cell_edges(where.coordinate), db, limits)
    axes.set_ylim(where.coordinate[0], where.coordinate[-1])
    angle_axis(axes, where)
    style.image_frame(axes)
    style.time_axis(axes, edges[0], edges[-1])
    style.colour_bar(fig, mesh, axes,
                     f"beam level in {data.envelope(ping).width:.0f} Hz / dB re 1 µPa")
    style.subtitle(axes,
                   f"{data.heading(ping)}  ·  {data.channels} phones, {data.centre_frequency:g} Hz")
    handles = []
    for echo in data.echoes(ping):
        strong = echo.strong(edges[0], edges[-1])
        if strong.any():
            axes.plot(echo.delay[strong], signal.apparent(where, echo.direction[strong]), ls="none",
                      marker="o", ms=9, mfc="none", mec=style.colour(echo.target), mew=1.4,
                      path_effects=style.OVER_MAP, zorder=4)
            handles.append(Line2D([], [], ls="none", marker="o", ms=9, mfc="none",
                                  mec=style.colour(echo.target), mew=1.6,
                                  label=f"{style.name(echo.name)}: true arrivals"))
    style.legend_below(axes, handles[:4], ncol=2)
    return fig

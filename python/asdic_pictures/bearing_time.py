"""Bearing–time record: every beam's level against time."""
from __future__ import annotations

import numpy as np

from . import bearings, signal, style

TITLE = "Bearing–time record, conventional beams"
TITLES = {"horizontal": "Bearing–time record of the horizontal array",
          "vertical": "Elevation–time record of the vertical array",
          "azimuth": "Bearing–time record of the array"}
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
    """Directions on an axis that is even in the sine for a line array."""
    if where.kind == "azimuth":
        bearings.of_circle(axes)
    elif where.kind == "vertical":
        bearings.of_upright(axes)
    else:
        bearings.of_line(axes, where.axis)


def mark_height(data, ping, where) -> float:
    """Of a box around an echo: a beam, and never too low to be seen."""
    phones = data.phones(ping)
    speed = data.sound_speed(float(phones[:, 2].mean()))
    width = bearings.beam_width(phones, data.centre_frequency, speed)
    if where.kind == "azimuth":
        return max(np.degrees(width), 18.0)
    return max(width, 0.1)


def mark_echoes(axes, data, ping, where, first: float, last: float) -> list:
    """A box around each true echo: its whole pulse, one beam high. → handles for a legend"""
    handles = []
    height = mark_height(data, ping, where)
    for echo in data.echoes(ping):
        strong = echo.strong(first, last)
        if not strong.any():
            continue
        shade = style.colour(echo.target)
        starts = echo.delay[strong]
        for begin, end, place in style.together(starts, starts + data.pulse_duration,
                                                signal.apparent(where, echo.direction[strong]),
                                                0.5 * height):
            style.box(axes, begin, end, place - 0.5 * height, place + 0.5 * height, shade)
        handles.append(style.box_key(shade, f"{style.name(echo.name)}: true echo, one pulse long"))
    return handles


@style.picture
def draw(data, ping, axes=None, limits=None):
    where, edges, db = record(data, ping)
    fig, axes = style.figure(TITLES[where.kind], 5.0, axes)
    limits = limits or style.colour_limits(db, data.loudest_echo(ping))
    mesh = style.image(axes, edges, style.cell_edges(where.coordinate), db, limits)
    angle_axis(axes, where)
    axes.set_ylim(where.coordinate[0], where.coordinate[-1])
    style.image_frame(axes)
    style.time_axis(axes, edges[0], edges[-1])
    style.colour_bar(fig, mesh, axes,
                     f"beam level in {data.envelope(ping).width:.0f} Hz / dB re 1 µPa")
    style.subtitle(axes,
                   f"{data.heading(ping)}  ·  {data.channels} phones, {data.centre_frequency:g} Hz")
    style.legend_below(axes, mark_echoes(axes, data, ping, where, edges[0], edges[-1])[:4], ncol=2)
    return fig

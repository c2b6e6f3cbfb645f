"""Axes of directions: true bearings in every picture, clockwise from north.

A line cannot tell its two sides apart: a beam is one on either. Its axis is even in the cosine, so
that beams are equally wide, and tells the bearings of one side on its left (or below) and those of
the other on its right (or above). A target has its bearing on the axis of its own side.
"""
from __future__ import annotations

import numpy as np

POINTS = ("north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west")
TRUE = "look bearing, true"
UPWARDS = "look elevation, up positive"
ELEVATIONS = (-90, -60, -45, -30, -15, 0, 15, 30, 45, 60, 90)


def along(axis) -> np.ndarray:
    """The sense of a line in which pictures count: bearings of its first side rise with it. That is
    the side whose broadside is to the east, or to the south of a line due east.
    """
    axis = np.asarray(axis, float)
    backwards = axis[1] > 1e-9 or (abs(axis[1]) <= 1e-9 and axis[0] > 0)
    return -axis if backwards else axis


def ahead(axis) -> float:
    """True bearing from which the first side's bearings rise over 180°. [deg] \\param axis  along()"""
    return float(np.degrees(np.arctan2(-axis[0], -axis[1])))


def place(axis, bearing_deg):
    """Where sound from a true bearing, horizontally, appears on the axis of a line: −1 … 1."""
    b = np.radians(bearing_deg)
    return axis[0] * np.sin(b) + axis[1] * np.cos(b)


def side(axis, second: bool) -> str:
    """The side's name: the compass point that its broadside faces."""
    broad = ahead(axis) + (-90.0 if second else 90.0)
    return POINTS[int(round(broad / 45.0)) % 8]


def side_of(axis, bearing_deg) -> bool:
    """Whether a bearing is on the second side."""
    return np.sin(np.radians(np.asarray(bearing_deg) - ahead(axis))) < 0.0


def ticks(axis, second: bool = False, gap: float = 0.15):
    """Round bearings of a side, at least `gap` apart on the axis. → places, labels"""
    start = ahead(axis)
    low, high = (start - 180.0, start) if second else (start, start + 180.0)
    chosen: list[tuple[float, int]] = []
    for step in (90, 45, 30, 15):
        for bearing in range(int(np.ceil(low / step - 1e-6)) * step, int(high + 1e-6) + 1, step):
            at = float(place(axis, bearing))
            if all(abs(at - other) >= gap for other, _ in chosen):
                chosen.append((at, bearing))
    chosen.sort()
    return [at for at, _ in chosen], [f"{bearing % 360}°" for _, bearing in chosen]


def of_line(axes, axis, vertical: bool = True, only: bool | None = None, gap: float | None = None):
    """Both sides of a line on an axis of cosines. \\param only  one side: whether the second"""
    gap = gap or (0.17 if vertical else 0.14)
    label = f"{TRUE} ({side(axis, bool(only))} side)"
    first = ticks(axis, bool(only), gap)
    if vertical:
        axes.set_yticks(*first)
        axes.set_ylabel(label)
        axes.set_ylim(-1.0, 1.0)
    else:
        axes.set_xticks(*first)
        axes.set_xlabel(label)
        axes.set_xlim(*((1.0, -1.0) if only else (-1.0, 1.0)))   # bearings rise
    if only is not None:
        return
    other = axes.secondary_yaxis("right") if vertical else axes.secondary_xaxis("top")
    other.tick_params(direction="out", length=3)
    (other.set_yticks if vertical else other.set_xticks)(*ticks(axis, True, gap))
    (other.set_ylabel if vertical else other.set_xlabel)(f"{TRUE} ({side(axis, True)} side)")


def of_circle(axes, vertical: bool = True) -> None:
    """All bearings, of an array that tells them apart."""
    marks = np.arange(0, 361, 45)
    labels = [f"{b}°" for b in marks]
    if vertical:
        axes.set_yticks(marks, labels)
        axes.set_ylabel(TRUE)
        axes.set_ylim(0.0, 360.0)
    else:
        axes.set_xticks(marks, labels)
        axes.set_xlabel(TRUE)
        axes.set_xlim(0.0, 360.0)


def of_upright(axes, upwards: float = 1.0) -> None:
    """Elevations of an upright line, even in the sine. \\param upwards  −1: they fall with the axis"""
    marks = np.array(ELEVATIONS)
    labels = [f"{e:+d}°".replace("-", "−") if e else "0°" for e in marks]
    axes.set_yticks(upwards * np.sin(np.radians(marks)), labels)
    axes.set_ylabel(UPWARDS)
    axes.set_ylim(-upwards, upwards)


def beam_width(phones, frequency: float, speed: float) -> float:
    """Between the −3 dB points at broadside, in cosines: 0.886 λ/L, L one spacing over the ends."""
    phones = np.asarray(phones, float)
    length = np.linalg.norm(np.ptp(phones, axis=0)) * len(phones) / max(len(phones) - 1, 1)
    return float(np.clip(0.886 * speed / frequency / max(length, 1e-9), 0.0, 2.0))

"""What `asdic process` wrote into a ping file: group /processed (docs/formats/ping.md)."""
from __future__ import annotations

from copy import copy
from dataclasses import dataclass

import numpy as np

from . import bearings, style

DETECTIONS = ["ping", "array", "time", "doppler_factor", "snr_db", "axis_cosine",
              "look_bearing_deg", "look_elevation_deg", "target", "x", "y", "range", "bearing_deg",
              "mirror_x", "mirror_y", "mirror_range", "mirror_bearing_deg"]
TRACKS = ["track", "array", "side", "ambiguous", "ping", "detection", "time", "x", "y", "range",
          "target", "position_sigma"]


def there(data) -> bool:
    return data.has("processed/detections")


def nothing(data, ping):
    """Why a picture of one ping cannot be drawn, or None."""
    if not there(data):
        return "the file is not processed (asdic process)"
    if not maps(data, ping):
        return "it was processed without maps, or without this ping"
    return None


def detections(data, ping) -> dict:
    """Columns of the detections of one ping, of the array that is drawn."""
    t = data._of_ping("processed/detections", ping, DETECTIONS)
    mine = t["array"] == (data.array or 0)
    return {name: column[mine] for name, column in t.items()}


def tracks(data) -> list[dict]:
    """Columns of each track of the array that is drawn."""
    if not data.has("processed/tracks/track"):
        return []
    t = {name: data.read(f"processed/tracks/{name}") for name in TRACKS}
    mine = t["array"] == (data.array or 0)
    t = {name: column[mine] for name, column in t.items()}
    return [{name: column[t["track"] == number] for name, column in t.items()}
            for number in np.unique(t["track"])]


@dataclass
class Maps:
    """Of the array that is drawn and one ping."""

    kind: str                 # point, line, plane, volume
    time: np.ndarray          # [column] [s]
    range: np.ndarray | None  # [column] [m], NaN where no path has that delay
    beam_range: list          # sender and array apart: [row, column] [m] of each side of the array
    angle: np.ndarray         # [row] of the picture, rising: cosine to `axis` (line), degrees of
                              # bearing (others)
    beam_db: np.ndarray       # [row, column]
    doppler: np.ndarray       # [filter]
    doppler_db: np.ndarray    # [filter, column]
    upright: bool
    axis: np.ndarray | None   # of a line, in the sense of bearings.along()
    turned: bool = False      # whether that is not the file's sense

    def angle_of(self, t) -> np.ndarray:
        """Where detections lie on the axis of angles."""
        if self.kind == "line":
            return -t["axis_cosine"] if self.turned else t["axis_cosine"]
        return t["look_bearing_deg"] % 360.0

    def angle_of_travel(self, travel) -> np.ndarray:
        look = -np.atleast_2d(travel)
        if self.kind == "line":
            return look @ self.axis
        return np.degrees(np.arctan2(look[:, 0], look[:, 1])) % 360.0


def maps(data, ping) -> Maps | None:
    group = f"processed/maps/array_{data.array or 0}"
    if not data.has(f"{group}/beam_time_db"):
        return None
    numbers = data.read(f"{group}/ping")
    row = np.flatnonzero(numbers == data.numbers[ping])
    if row.size == 0:
        return None
    attributes = data.file[group].attrs
    kind = data._text(attributes, "array_kind")
    beams = np.maximum(data.read(f"{group}/beam_time_db", int(row[0])), -60.0)
    apart = [data.read(f"{group}/{name}") for name in ("beam_range", "mirror_range")
             if data.has(f"{group}/{name}")]
    axis, upright, turned = None, False, False
    if kind == "line":
        angle = data.read(f"{group}/beam_cosine")
        bearing, elevation = (np.radians(float(attributes[f"axis_{a}_deg"]))
                              for a in ("bearing", "elevation"))
        axis = np.array([np.cos(elevation) * np.sin(bearing),
                         np.cos(elevation) * np.cos(bearing), -np.sin(elevation)])
        upright = abs(np.sin(elevation)) > np.sqrt(0.5)
        counted = axis if upright else bearings.along(axis)
        turned = bool(counted @ axis < 0.0)
        if turned:
            axis, angle, apart = counted, -angle, apart[::-1]
        order = np.argsort(angle)
        angle, beams, apart = angle[order], beams[order], [a[order] for a in apart]
    else:  # the loudest elevation of each bearing
        bearing = data.read(f"{group}/beam_bearing_deg")
        angle = np.arange(2.5, 360.0, 5.0) if kind != "point" else np.array([180.0])
        cell = np.minimum((bearing / 360.0 * len(angle)).astype(int), len(angle) - 1)
        rows = np.full((len(angle), beams.shape[1]), np.nan)
        ranges = [np.full(rows.shape, np.nan) for _ in apart]
        for k in range(len(angle)):
            if np.any(cell == k):
                rows[k] = beams[cell == k].max(axis=0)
                for mine, all_of_them in zip(ranges, apart):
                    mine[k] = all_of_them[np.flatnonzero(cell == k)[0]]
        beams, apart = rows, ranges
    span = data.read(f"{group}/range") if data.has(f"{group}/range") else None
    return Maps(kind, data.read(f"{group}/time"), span, apart, angle, beams,
                data.read(f"{group}/doppler_factor"),
                np.maximum(data.read(f"{group}/doppler_time_db", int(row[0])), -60.0), upright, axis,
                turned)


def angle_axis(axes, m: Maps, vertical=True, only: bool | None = None) -> None:
    """Directions, as every picture tells them. \\param only  one side of a line: whether the second"""
    if m.kind != "line":
        bearings.of_circle(axes, vertical)
    elif m.upright:     # the cosine is the elevation's sine, seen along the axis
        bearings.of_upright(axes, 1.0 if m.axis[2] < 0 else -1.0)
    else:
        bearings.of_line(axes, m.axis, vertical, only, None if only is None else 0.27)


def limits(data, ping, m: Maps):
    """Of colours [dB over the background]: from 0 to above the loudest echo of a target that was
    found, 30 at least. What is louder still, the transmitter's own sound, may be clipped.
    """
    t = detections(data, ping)
    found = t["snr_db"][(t["target"] >= 0) & np.isfinite(t["snr_db"])]
    top = max([30.0, *found])
    for echo in data.echoes(ping):
        for time in echo.delay[echo.strong(m.time[0], m.time[-1], 6.0)]:
            column = int(np.argmin(np.abs(m.time - time)))
            near = m.beam_db[:, max(column - 1, 0): column + 2]
            top = max(top, float(np.nanmax(near, initial=0.0)))
    return 0.0, float(5.0 * np.ceil(top / 5.0))


def mark(axes, x, y, t, names=()) -> list:
    """Circles: targets' detections in their colours, others white; squares: the transmitter's own
    sound. → handles for a legend
    """
    handles = []
    owner = t["target"].astype(int)
    for target in [-3, -2, -1, *sorted(set(owner[owner >= 0]))]:
        mine = owner == target
        if not mine.any():
            continue
        colour = style.colour(target) if target >= 0 else "white"
        label = {-3: "another ping", -2: "the transmitter's own sound",
                 -1: "other detections"}.get(
            target, f"{style.name(names[target])}: found" if 0 <= target < len(names) else "found")
        handles += axes.plot(x[mine], y[mine], ls="none", mfc="none", mec=colour, label=label,
                             marker={-3: "^", -2: "s"}.get(target, "o"),
                             ms=10 if target >= 0 else 5, zorder=5,
                             mew=1.6 if target >= 0 else 0.9,
                             path_effects=list(style.OVER_MAP) if target >= 0 else None)
    return handles


def legend(handles) -> list:
    """Of marks on a map for a legend beside it, where white (or black) could not be seen."""
    shown = []
    for handle in handles:
        new = copy(handle)
        if hasattr(new, "get_markeredgecolor") and new.get_markeredgecolor() == "white":
            new.set_markeredgecolor(style.GREY)
        shown.append(new)
    return shown

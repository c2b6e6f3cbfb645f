"""What `asdic process` wrote into a ping file: group /processed (docs/formats/ping.md)."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from . import signal, style

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
    angle: np.ndarray         # [row] of the picture: cosine (line), degrees of bearing (others)
    beam_db: np.ndarray       # [row, column]
    doppler: np.ndarray       # [filter]
    doppler_db: np.ndarray    # [filter, column]
    upright: bool
    axis: np.ndarray | None   # of a line

    def angle_of(self, t) -> np.ndarray:
        """Where detections lie on the axis of angles."""
        return t["axis_cosine"] if self.kind == "line" else t["look_bearing_deg"] % 360.0

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
    axis, upright = None, False
    if kind == "line":
        angle = data.read(f"{group}/beam_cosine")
        bearing, elevation = (np.radians(float(attributes[f"axis_{a}_deg"]))
                              for a in ("bearing", "elevation"))
        axis = np.array([np.cos(elevation) * np.sin(bearing),
                         np.cos(elevation) * np.cos(bearing), -np.sin(elevation)])
        upright = abs(np.sin(elevation)) > np.sqrt(0.5)
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
                np.maximum(data.read(f"{group}/doppler_time_db", int(row[0])), -60.0), upright, axis)


def angle_axis(axes, m: Maps, vertical=True) -> None:
    """Degrees on an axis that is even in the cosine for a line."""
    low, high = (-1.0, 1.0) if m.kind == "line" else (0.0, 360.0)
    if m.kind == "line":
        values = np.array([0, 30, 45, 60, 75, 90, 105, 120, 135, 150, 180])
        if not vertical:  # labels side by side: those next to the ends would touch
            values = np.setdiff1d(values, [30, 150])
        place = np.cos(np.radians(values))
        if m.upright:  # the cosine is the elevation's sine, seen along the axis
            up = 1.0 if m.axis[2] < 0 else -1.0
            values = np.array([-90, -60, -45, -30, -15, 0, 15, 30, 45, 60, 90])
            place = up * np.sin(np.radians(values))
        labels = [style.degrees(float(v)) if m.upright else f"{v}°" for v in values]
        name = ("look elevation, up positive" if m.upright
                else f"angle relative to the array's axis ({signal.true_bearing(m.axis)}° true)")
    else:
        place = np.arange(0, 361, 45)
        labels, name = [f"{v}°" for v in place], "look bearing, true (clockwise from north)"
    if vertical:
        axes.set_yticks(place, labels)
        axes.set_ylabel(name)
        axes.set_ylim(low, high)
    else:
        axes.set_xticks(place, labels)
        axes.set_xlabel(name)
        axes.set_xlim(*((high, low) if m.kind == "line" else (low, high)))  # angles rise


def mark(axes, x, y, t, names=()) -> list:
    """Circles: targets' detections in their colours, others grey. → handles for a legend"""
    handles = []
    owner = t["target"].astype(int)
    for target in [-2, -1, *sorted(set(owner[owner >= 0]))]:
        mine = owner == target
        if not mine.any():
            continue
        colour = style.colour(target) if target >= 0 else "white"
        label = {-2: "the transmitter's own sound", -1: "other detections"}.get(
            target, f"{style.name(names[target])}: found" if 0 <= target < len(names) else "found")
        handles += axes.plot(x[mine], y[mine], ls="none", marker="o", mfc="none",
                             ms=10 if target >= 0 else 5, mec=colour,
                             mew=1.6 if target >= 0 else 0.9, zorder=5,
                             path_effects=style.OVER_MAP if target >= 0 else None, label=label)
    return handles

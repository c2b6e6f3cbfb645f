"""Reads results of the propagation model: files of `asdic field`, `arrivals` and `rays`.

Whatever is wrong with one becomes an InputError. Elevations are positive up, depth positive down.
"""
from __future__ import annotations

import os
from dataclasses import dataclass, field

import h5py
import numpy as np

from . import source
from .data import InputError

KINDS = ("asdic field", "asdic arrivals", "asdic rays")


@dataclass
class Sea:
    """The sea as a picture needs it; parts that the file does not tell are None."""

    boundary_range: np.ndarray | None = None    # [n] [m]
    surface: np.ndarray | None = None           # [n] depth [m]
    bottom: np.ndarray | None = None            # [n] depth [m]
    depth: np.ndarray | None = None             # [k] [m]
    sound_speed: np.ndarray | None = None       # [k] at range 0 [m/s]
    section_range: np.ndarray | None = None     # [m] of water that varies with range: [m],
    section_depth: np.ndarray | None = None     # [n] [m],
    section_speed: np.ndarray | None = None     # [m, n] [m/s]
    map_end: float = np.inf                     # range at which the maps end that it was cut out of [m]


@dataclass
class Field:
    title: str
    frequency: float
    source_depths: np.ndarray
    depth: np.ndarray           # [rows] or [receivers]
    range: np.ndarray           # [columns] or [receivers]
    irregular: bool
    pressure: np.ndarray        # [sources, rows, columns] or [sources, receivers]
    how: str                    # "coherent", …; with the kind of beams
    sea: Sea = field(default_factory=Sea)
    errors: np.ndarray | None = None    # [sources, …] of the number of beams [dB], NaN: not known
    sure_db: float = 0.5                # a receiver with no more error than this is sure
    tags: dict = field(default_factory=dict)
    azimuths: np.ndarray | None = None  # [n] of a field over a map, counter-clockwise from x [°]
    around: np.ndarray | None = None    # [n, sources, …] its pressures, of its first place of sources
    places: int = 1                     # of sources on the map

    def unsure(self, source: int) -> np.ndarray | None:
        """Which receivers are not sure of their number of beams; None where that is not told. A
        column that was not looked at is as its nearest that was.
        """
        if self.errors is None:
            return None
        errors = self.errors[source]
        if not self.irregular:
            known = np.flatnonzero(~np.isnan(errors).all(axis=0))
            if known.size == 0:
                return None
            columns = np.arange(errors.shape[1])
            errors = errors[:, known[np.abs(columns[:, None] - known[None, :]).argmin(axis=1)]]
        return errors > self.sure_db    # NaN is not

    def tl(self, source: int) -> np.ndarray:
        """Transmission loss [dB]; NaN where there is no sound."""
        magnitude = np.abs(self.pressure[source])
        with np.errstate(divide="ignore", invalid="ignore"):
            loss = -20.0 * np.log10(magnitude)
        return np.where(np.isfinite(loss), loss, np.nan)


@dataclass
class Receiver:
    """What one receiver receives. [n] each"""

    label: str
    range: float
    delay: np.ndarray           # [s]
    level: np.ndarray           # re the pressure at 1 m [dB]
    launch: np.ndarray          # elevation [°]
    surface: np.ndarray         # bounces
    bottom: np.ndarray


@dataclass
class Arrivals:
    title: str
    frequency: float
    receivers: list[Receiver]
    tags: dict = field(default_factory=dict)


@dataclass
class Rays:
    title: str
    launch: np.ndarray          # [n] elevation [°]
    surface: np.ndarray         # [n] bounces
    bottom: np.ndarray
    range: np.ndarray           # [n, points] [m], padded with NaN
    depth: np.ndarray
    bottom_depth: float
    sea: Sea = field(default_factory=Sea)
    tags: dict = field(default_factory=dict)


def text(attributes, name: str) -> str:
    try:
        value = attributes[name]
    except Exception:
        return ""
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value)


def filetype(path) -> str:
    """What kind of file or dataset it is; "" where that cannot be told (then it is nothing of
    ours).
    """
    if source.is_dataset(path):
        return text(path.attrs, "filetype")
    if isinstance(path, source.Group):
        return text(path.attrs, "filetype")
    try:
        with h5py.File(path, "r") as f:
            return text(f.attrs, "filetype")
    except Exception:
        return ""


def map_end(reader) -> float:
    """Range at which the maps end that a section was cut out of [m]; infinite: they go on."""
    try:
        return float(np.ravel(reader.file["environment"].attrs["map_end_m"])[0])
    except Exception:
        return np.inf


class Reader:
    """An open file that says what is missing."""

    def __init__(self, path):
        if source.is_dataset(path):
            self.file, self.path = source.of_dataset(path), source.name_of(path)
            return
        if not os.path.exists(path):
            raise InputError(path, "no such file", "a result of asdic field, arrivals or rays")
        try:
            self.file = h5py.File(path, "r")
        except Exception as error:
            raise InputError(path, "a file that is not HDF5",
                             "a result of asdic field, arrivals or rays") from error
        self.path = str(path)

    def has(self, name) -> bool:
        return name in self.file

    def array(self, name) -> np.ndarray:
        try:
            return np.asarray(self.file[name][()])
        except Exception as error:
            raise InputError(self.path, f"no dataset {name} that can be read",
                             "one (docs/formats)") from error

    def number(self, name, otherwise=np.nan) -> float:
        try:
            return float(np.ravel(self.file.attrs[name])[0])
        except Exception:
            return otherwise

    def title(self) -> str:
        return text(self.file.attrs, "title")

    def tags(self) -> dict:
        """What a picture says of itself (output.Tags)."""
        return dict(title=self.title(), version=text(self.file.attrs, "program_version"),
                    digest=text(self.file.attrs, "scenario_sha256"))

    def sea(self) -> Sea:
        """An older file, or one of another program, tells nothing of its sea."""
        names = {"boundary_range": "boundary_range", "surface": "surface_depth",
                 "bottom": "bottom_depth", "depth": "depth", "sound_speed": "sound_speed",
                 "section_range": "section_range", "section_depth": "section_depth",
                 "section_speed": "section_speed"}
        found = {key: self.array("environment/" + name) for key, name in names.items()
                 if self.has("environment/" + name)}
        return Sea(**found, map_end=map_end(self))


def read(path):
    """Of a file, a dataset of one, or what `Scenario.field`, `.arrivals` and `.rays` give.
    → Field, Arrivals or Rays
    """
    if isinstance(path, (Field, Arrivals, Rays)):
        return path
    if in_memory := of_memory(path):
        return in_memory
    reader = Reader(path)
    with reader.file:
        kind = text(reader.file.attrs, "filetype")
        if kind not in KINDS:
            raise InputError(reader.path, f'filetype "{kind}"', "one of " + ", ".join(KINDS))
        made = {"asdic field": read_field, "asdic arrivals": read_arrivals,
                "asdic rays": read_rays}[kind](reader)
        made.tags = reader.tags()
        return made


def of_memory(found):
    """A field's DataArray, or a table of arrivals or rays; None of anything else."""
    if hasattr(found, "dims") and np.issubdtype(getattr(found, "dtype", float),
                                                np.complexfloating):
        return field_of(found)
    columns = [str(c) for c in getattr(found, "columns", ())]
    if "amplitude" in columns and "delay" in columns:
        return arrivals_of(found)
    if "launch_elevation_deg" in columns and "depth" in columns:
        return rays_of(found)
    return None


def field_of(pressure) -> Field:
    """Of a complex DataArray (depth, range), or with source_depth before them."""
    values = np.asarray(pressure.values)
    irregular = "receiver" in pressure.dims
    if "source_depth" not in pressure.dims:
        values = values[None]
    sources = np.atleast_1d(np.asarray(pressure.coords["source_depth"].values, float))
    return Field(str(pressure.attrs.get("title", "")), float(pressure.attrs.get("frequency_hz", np.nan)),
                 sources, np.atleast_1d(pressure.coords["depth"].values),
                 np.atleast_1d(pressure.coords["range"].values), irregular, values, "coherent")


def arrivals_of(table) -> Arrivals:
    """Of a table with a row an eigenray; legs of a ping are told apart."""
    amplitude = np.abs(np.asarray(table["amplitude"], complex))
    with np.errstate(divide="ignore"):
        level = 20.0 * np.log10(amplitude)
    keys = [c for c in ("leg", "target", "array") if c in table.columns]
    rows = np.stack([np.asarray(table[c]) for c in keys], axis=1) if keys \
        else np.zeros((len(level), 1), int)
    receivers = []
    for key in np.unique(rows, axis=0):
        mine = np.flatnonzero(np.all(rows == key, axis=1) & np.isfinite(level))
        if not mine.size:
            continue
        distance = float(table["range"].iloc[mine[0]]) if "range" in table.columns else np.nan
        words = [LEGS.get(int(key[0]), "")] if "leg" in keys else ["receiver"]
        words += [f"target {int(k) + 1}" for n, k in zip(keys, key) if n == "target" and k >= 0]
        words += [f"range {distance / 1e3:.3f} km"] if np.isfinite(distance) else []
        receivers.append(Receiver(", ".join(words), distance,
                                  np.asarray(table["delay"], float)[mine], level[mine],
                                  np.asarray(table["launch_elevation_deg"], float)[mine],
                                  np.asarray(table["surface_bounces"])[mine],
                                  np.asarray(table["bottom_bounces"])[mine]))
    return Arrivals("", np.nan, receivers)


def rays_of(table) -> Rays:
    """Of a table with a row a ray, whose `range` and `depth` are arrays."""
    points = max((len(r) for r in table["range"]), default=0)
    lines = []
    for column in ("range", "depth"):
        padded = np.full((len(table), points), np.nan)
        for row, values in zip(padded, table[column]):
            row[: len(values)] = values
        lines.append(padded)
    deepest = float(np.nanmax(lines[1], initial=0.0, where=np.isfinite(lines[1])))
    return Rays("", np.asarray(table["launch_elevation_deg"], float),
                np.asarray(table["surface_bounces"]), np.asarray(table["bottom_bounces"]),
                *lines, deepest)


def read_field(reader: Reader) -> Field:
    irregular = reader.has("receiver")
    prefix = "receiver_" if irregular else ""
    parts = reader.array("pressure")
    azimuths = reader.array("azimuth") if reader.has("azimuth") else None
    dims = (3 if irregular else 4) + (0 if azimuths is None else 3)
    if parts.ndim != dims or parts.shape[-1] != 2 or 0 in parts.shape:
        raise InputError(reader.path, f"pressure of shape {parts.shape}",
                         "(source_depth, depth, range, re_im)")
    around, places = None, 1
    if azimuths is not None:
        places = parts.shape[0] * parts.shape[1]
        around = parts[0, 0, ..., 0] + 1j * parts[0, 0, ..., 1]
        parts = parts[0, 0, 0]
    how = [text(reader.file.attrs, "field") or "coherent"]
    if text(reader.file.attrs, "solver") == "waves":
        how.append("wave equation")
    elif beams := text(reader.file.attrs, "beam_kind"):
        how.append(f"{beams} beams")
    errors = reader.array("beam_error") if reader.has("beam_error") else None
    if errors is not None and errors.shape != parts.shape[:-1]:
        raise InputError(reader.path, f"beam_error of shape {errors.shape}",
                         f"that of the receivers, {parts.shape[:-1]}")
    return Field(reader.title(), reader.number("frequency_hz"), reader.array("source_depth"),
                 reader.array(prefix + "depth"), reader.array(prefix + "range"), irregular,
                 parts[..., 0] + 1j * parts[..., 1], ", ".join(how), reader.sea(), errors,
                 reader.number("sure_db", 0.5), azimuths=azimuths, around=around, places=places)


LEGS = {0: "source to target", 1: "target to array", 2: "source to array", 3: "source to receiver"}


def read_arrivals(reader: Reader) -> Arrivals:
    def column(name):
        return reader.array("arrivals/" + name)

    amplitude = np.hypot(column("amplitude_real"), column("amplitude_imag"))
    with np.errstate(divide="ignore"):
        level = 20.0 * np.log10(amplitude)
    distance = column("range")
    if reader.has("arrivals/range_index"):
        names = ["source_index", "depth_index", "range_index"]
        if reader.has("arrivals/azimuth_index"):
            names += ["azimuth_index", "source_x_index", "source_y_index"]
        keys = np.stack([column(n) for n in names], axis=1)
    else:
        keys = np.stack([column(n) for n in ("ping", "leg", "target", "channel")], axis=1)
    receivers = []
    for key in np.unique(keys, axis=0):
        rows = np.flatnonzero(np.all(keys == key, axis=1) & np.isfinite(level))
        if rows.size:
            receivers.append(Receiver(
                receiver_label(reader, key, float(distance[rows[0]])), float(distance[rows[0]]),
                column("delay")[rows], level[rows], column("launch_elevation_deg")[rows],
                column("surface_bounces")[rows], column("bottom_bounces")[rows]))
    return Arrivals(reader.title(), reader.number("frequency_hz"), receivers)


def receiver_label(reader: Reader, key, distance: float) -> str:
    where = f"range {distance / 1e3:.3f} km"
    if len(key) == 4:
        depth = reader.number("receiver_depth_m")
        leg = LEGS.get(int(key[1]), "")
        target = f", target {key[2]}" if key[2] >= 0 else ""
        return f"{leg}{target}, {where}" + (f", depth {depth:g} m" if np.isfinite(depth) else "")
    depths, sources = reader.array("depth"), reader.array("source_depth")
    i = int(key[2] if reader.number("irregular", 0.0) else key[1])
    source = f", source at {sources[int(key[0])]:g} m" if sources.size > 1 else ""
    if len(key) == 6:
        where += f", azimuth {reader.array('azimuth')[int(key[3])]:g}°"
        x, y = reader.array("source_x"), reader.array("source_y")
        if x.size * y.size > 1:
            source += f", source at x {x[int(key[4])] / 1e3:g} km, y {y[int(key[5])] / 1e3:g} km"
    return f"{where}, depth {depths[i]:g} m{source}"


def read_rays(reader: Reader) -> Rays:
    return Rays(reader.title(), reader.array("rays/launch_elevation_deg"),
                reader.array("rays/surface_bounces"), reader.array("rays/bottom_bounces"),
                reader.array("rays/range"), reader.array("rays/depth"),
                reader.number("bottom_depth_m"), reader.sea())

"""A scenario before anything is computed: who is where, the water, the arrays. The program writes it
(io/result/scene_file.h)."""
from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from . import results, source, style
from .data import InputError

KIND = "asdic scene"


@dataclass
class Things:
    """Platforms, transmitters, arrays or targets."""

    names: list
    track: np.ndarray       # [things, instants, 3] east, north, depth [m]


@dataclass
class Floor:
    """The sea floor of an area's map."""

    east: np.ndarray        # [n] [m]
    north: np.ndarray       # [m] [m]
    depth: np.ndarray       # [m, n] [m], below 0 on land, NaN: no map
    longitude: np.ndarray | None = None     # [n] of a line due east [°]
    latitude: np.ndarray | None = None      # [m] of a line due north [°]

    def ended(self, east, north):
        """Whether places [m] are beyond the map; never where the file does not say."""
        i, j = (np.rint((np.asarray(at) - line[0]) / (line[1] - line[0])).astype(int)
                for at, line in ((east, self.east), (north, self.north)))
        known = (i >= 0) & (i < self.east.size) & (j >= 0) & (j < self.north.size)
        near = np.clip(j, 0, self.north.size - 1), np.clip(i, 0, self.east.size - 1)
        return known & np.isnan(self.depth[near])


@dataclass
class Pulse:
    """What the first transmitter sends, and what its matched filter makes of echoes of it."""

    transmitter: str
    kind: str               # "LFM"
    window: str             # "hann"
    centre: float           # [Hz]
    duration: float         # [s]
    energy: float           # ∫|s|²dt of unit peak before its window [s]
    frequency: np.ndarray   # [f] [Hz]
    spectrum: np.ndarray    # [f] energy density
    delay: np.ndarray       # [n] of the echo over the filter's [s]
    doppler: np.ndarray     # [m] factor
    ambiguity: np.ndarray   # [m, n] power, 1 at delay 0 and factor 1


@dataclass
class Scene:
    title: str
    sea: results.Sea
    frequency: float
    bearing: float                      # of the section, true [deg]
    end: float                          # of the last record [s]
    pings: int
    things: dict                        # "platforms", … → Things
    elevation: np.ndarray               # [transmitter] of the beam, positive up [deg]
    beamwidth: np.ndarray               # [deg], NaN: not a narrow one
    phones: list                        # [array] → [n, 3] from its middle [m]
    source_depth: np.ndarray            # of a run without a sonar [m]
    receivers: tuple                    # depths, ranges [m], whether they are one by one
    origin: str = ""                    # of the map: where on the Earth it is
    floor: Floor | None = None          # of an area
    pulse: Pulse | None = None
    tags: dict = field(default_factory=dict)

    @property
    def sonar(self) -> bool:
        return bool(self.things.get("platforms"))

    def start(self, kind: str) -> np.ndarray:
        """[things, 3] where they are at the start [m]"""
        return self.things[kind].track[:, 0]


def read(path) -> Scene:
    """\\throws InputError"""
    if results.filetype(path) != KIND:
        raise InputError(source.name_of(path), f'filetype "{results.filetype(path)}"', f'"{KIND}"')
    reader = results.Reader(path)
    with reader.file:
        things, phones = {}, []
        for kind in ("platforms", "transmitters", "arrays", "targets"):
            if not reader.has(kind):
                continue
            names = [results.text({"n": n}, "n")
                     for n in np.ravel(reader.file[kind].attrs.get("names", []))]
            if reader.has(f"{kind}/track"):
                things[kind] = Things(names, reader.array(f"{kind}/track"))
        if reader.has("arrays/phone"):
            owner = reader.array("arrays/phone_array")
            places = reader.array("arrays/phone")
            phones = [places[owner == k] for k in range(int(owner.max(initial=-1)) + 1)]

        def numbers(name):
            return reader.array(name) if reader.has(name) else np.zeros(0)

        return Scene(reader.title(), reader.sea(), reader.number("frequency_hz"),
                     reader.number("bearing_deg", 0.0), reader.number("end_s", 0.0),
                     int(reader.number("pings", 0.0)), things,
                     numbers("transmitters/elevation_deg"), numbers("transmitters/beamwidth_deg"),
                     phones, numbers("source_depth"),
                     (numbers("receiver_depth"), numbers("receiver_range"),
                      bool(reader.number("irregular", 0.0))),
                     style.on_earth(reader.file.attrs), floor_of(reader), pulse_of(reader),
                     reader.tags())


def pulse_of(reader) -> Pulse | None:
    if not reader.has("pulse/ambiguity"):
        return None
    told = reader.file["pulse"].attrs
    words = [results.text(told, name) for name in ("transmitter", "kind", "window")]
    numbers = [float(told[name]) for name in ("centre_frequency_hz", "duration_s", "energy_s")]
    return Pulse(*words, *numbers, *(reader.array(f"pulse/{name}") for name in
                                     ("frequency", "spectrum", "delay", "doppler_factor",
                                      "ambiguity")))


def floor_of(reader) -> Floor | None:
    """The sea floor of an area's map, of a file of pings or a scene."""
    array = getattr(reader, "array", None)
    array = array if callable(array) else reader.read
    names = {what: f"environment/area_{what}"
             for what in ("east", "north", "depth", "longitude", "latitude")}
    found = {what: array(name) for what, name in names.items() if reader.has(name)}
    if not {"east", "north", "depth"} <= found.keys():
        return None
    floor = Floor(**found)
    if floor.depth.shape != (floor.north.size, floor.east.size) or min(floor.depth.shape) < 2:
        raise InputError(reader.path, f"environment/area_depth of shape {floor.depth.shape}",
                         f"{(floor.north.size, floor.east.size)}, 2 by 2 at least")
    for along, degrees in (("east", "longitude"), ("north", "latitude")):
        values = getattr(floor, degrees)
        if values is not None and values.shape != getattr(floor, along).shape:
            raise InputError(reader.path, f"environment/area_{degrees} of shape {values.shape}",
                             f"{getattr(floor, along).shape}")
    return floor

"""What a sonar makes of pings."""
from __future__ import annotations

import os
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core, datasets, described
from .told import tell

if TYPE_CHECKING:
    import pandas as pd

#: their units; bool: on or off
OPTIONS: dict[str, Any] = {
    "mvdr": bool, "hann_shading": bool, "max_speed": "m/s", "split_window": bool,
    "across_beams": bool, "guard_cells": "", "reference_cells": "", "false_alarm_probability": "",
    "sub_bands": "", "cancel_direct_blast": bool, "start": "s", "stop": "s", "target_depth": "m", "range_speed": "m/s"}

UNITS = {"time": "s", "look_bearing_deg": "degrees", "look_elevation_deg": "degrees",
         "bearing_deg": "degrees", "snr_db": "dB", "excess_db": "dB", "level_db": "dB re 1 µPa",
         "east": "m", "north": "m", "depth": "m",
         "range": "m", "range_rate": "m/s", "latitude": "degrees", "longitude": "degrees",
         "velocity_east": "m/s", "velocity_north": "m/s", "position_sigma": "m"}
EARTH = ("latitude", "longitude")


@dataclass
class Processed:
    """Detections, places and tracks.

    Attributes
    ----------
    detections : pandas.DataFrame
        ping, array, time [s], doppler_factor, look_bearing_deg, look_elevation_deg, snr_db, excess_db,
        level_db, target (-1 a false alarm, -2 the direct sound, -3 another ping).
    places : pandas.DataFrame
        Where a detection may be: detection, east, north, depth [m] when it was struck, range [m],
        bearing_deg, range_rate [m/s]; of a scenario with ``environment.origin`` latitude and
        longitude [degrees], too. Two rows where left and right look alike, none where no path
        fits.
    tracks : list of dict
        array, ambiguous, target and ``points``, a pandas.DataFrame, with latitude and longitude
        likewise.
    warnings : list of str
    notes : list of str
        What was done to the records before they were searched, and what that costs.

    The units of a table's columns are its ``attrs["units"]``.
    """

    detections: pd.DataFrame
    places: pd.DataFrame
    tracks: list[dict]
    warnings: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


def process(source, progress=None, **options) -> Processed:
    """Matched filters, beams, detections, places and tracks, as ``asdic process`` does.

    Parameters
    ----------
    source : xarray.Dataset, sequence of them, or path
        What :meth:`Scenario.ping` gave, several pings of one scenario in order, or a ping file. A ping
        that came through a pickle or a netCDF file is simulated again.
    **options
        mvdr, hann_shading, max_speed [m/s], split_window, across_beams, guard_cells,
        reference_cells, false_alarm_probability, sub_bands, cancel_direct_blast, start, stop [s],
        target_depth [m], range_speed [m/s]; defaults are those of ``asdic process``.

    Raises InputError.
    """
    import pandas as pd

    for name in options:
        if name not in OPTIONS:
            raise described.made(name, "no such option", "one of " + ", ".join(OPTIONS))
    given = {}
    for name, value in options.items():
        if value is None:
            continue
        if OPTIONS[name] is not bool:
            given[name] = described.number(name, value, OPTIONS[name])
        elif isinstance(value, (bool, np.bool_)):
            given[name] = bool(value)
        else:
            raise described.made(name, repr(value), "True or False")
    if isinstance(source, (str, os.PathLike)):
        found = _core.process_file(os.fspath(source), given, progress)
    else:
        pings = [source] if hasattr(source, "variables") else list(source)
        found = _core.process_pings([_handle(one) for one in pings], given, progress)
    places = [{"detection": i, "east": p["position"][0], "north": p["position"][1],
               "depth": p["position"][2], "range": p["range"], "bearing_deg": p["bearing_deg"],
               "range_rate": p["range_rate"], **{name: p[name] for name in EARTH}}
              for i, several in enumerate(found["places"]) for p in several]
    columns = ["detection", "east", "north", "depth", "range", "bearing_deg", "range_rate"]
    if found["on_earth"]:
        columns += EARTH
    tracks = [{**track, "points": pd.DataFrame(track["points"])} for track in found["tracks"]]
    if not found["on_earth"]:
        for track in tracks:
            track["points"] = track["points"].drop(columns=list(EARTH))
    tell(found["warnings"])
    detections, where = pd.DataFrame(found["detections"]), pd.DataFrame(places, columns=columns)
    for table in (detections, where, *(track["points"] for track in tracks)):
        table.attrs["units"] = {name: UNITS[name] for name in table.columns if name in UNITS}
    return Processed(detections, where, tracks, found["warnings"], found["notes"])


def _handle(dataset):
    handle = datasets.ping_of(dataset)
    if handle is not None:
        values = datasets.as_complex(dataset["pressure"]).values
        if np.may_share_memory(values, handle.pressure) and values.shape == handle.pressure.shape \
                or np.array_equal(values, handle.pressure):
            return handle
    raise described.made("source", "a dataset that was changed, or came from elsewhere",
                         "one as Scenario.ping() gave it, or the path of a ping file")

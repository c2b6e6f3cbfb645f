"""Profiles and sea floors out of NumPy, pandas and xarray, as a scenario file says them."""
from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from . import described

UNITS = {"depth": "m", "range": "m", "speed": "m/s", "temperature": "degC", "salinity": "psu"}
SAND = {"kind": "grain-size", "grain_size": 1.5}  # medium sand (Hamilton)


def _names(table) -> list[str]:
    return [str(name).lower() for name in table.columns]


def _column(key: str, table, name: str, units) -> list:
    """The numbers of a column in the unit of files. Raises InputError for a row without one."""
    import pandas as pd

    values = pd.to_numeric(table[name], errors="coerce")
    missing = values.isna().to_numpy()
    if missing.any():
        row = int(missing.argmax())
        raise described.made(f"{key}: {name}, row {row}", str(table[name].iloc[row]),
                             "a number; dropna() leaves such rows out")
    told = units.get(name, "") if isinstance(units, Mapping) else ""
    return described.numbers(f"{key}: {name}", values.astype(float), UNITS[name], str(told)).tolist()


def _axis(key: str, array, name: str) -> list:
    """The numbers of a DataArray's coordinate [m]."""
    if name not in array.coords:
        raise described.made(f"{key}: {name}", "no such coordinate", "one with numbers [m]")
    return described.numbers(f"{key}: {name}", array[name], "m").tolist()


def _pairs(key: str, value, first: str, second: str) -> tuple[list, list]:
    """Two columns out of pairs [n, 2], a Series over `first`, or a DataFrame with both."""
    units = getattr(value, "attrs", {}).get("units")
    if hasattr(value, "columns"):  # pandas
        table = value.reset_index() if first not in _names(value) else value
        table = table.rename(columns=str).rename(columns=str.lower)
        for name in (first, second):
            if name not in table.columns:
                raise described.made(key, f"columns {', '.join(table.columns)}",
                                     f"{first} and {second}")
        return _column(key, table, first, units), _column(key, table, second, units)
    if hasattr(value, "index") and hasattr(value, "to_numpy"):  # a Series
        table = value.rename(second).rename_axis(first).reset_index()
        units = {second: units} if isinstance(units, str) else units
        return _column(key, table, first, units), _column(key, table, second, units)
    pairs = np.asarray(value, float)
    if pairs.ndim != 2 or pairs.shape[1] != 2:
        raise described.made(key, f"an array of shape {pairs.shape}",
                             f"pairs ({first}, {second}), [n, 2]")
    return pairs[:, 0].tolist(), pairs[:, 1].tolist()


def sound_speed(value) -> dict:
    """[environment.sound_speed] of a number, a profile or a section."""
    key = "sound_speed"
    if isinstance(value, Mapping):
        return described.taken("environment.sound_speed", "environment.sound_speed", value)
    if np.ndim(value) == 0:
        return {"kind": "table", "depth": [0.0], "speed": [described.number(key, value, "m/s")]}
    if hasattr(value, "dims"):  # xarray
        if set(value.dims) == {"depth"}:
            return {"kind": "table", "depth": _axis(key, value, "depth"),
                    "speed": described.numbers(key, value, "m/s").tolist()}
        if set(value.dims) == {"range", "depth"}:
            section = value.transpose("range", "depth")
            return {"kind": "section", "range": _axis(key, section, "range"),
                    "depth": _axis(key, section, "depth"),
                    "speed": described.numbers(key, section, "m/s").tolist()}
        raise described.made(key, f"a DataArray over {', '.join(map(str, value.dims))}",
                             "one over depth, or over range and depth")
    if hasattr(value, "columns") and {"temperature", "salinity"} <= set(_names(value)):
        if "speed" in _names(value):
            raise described.made(key, "columns speed, temperature and salinity",
                                 "speed, or temperature and salinity")
        table = (value if "depth" in _names(value) else value.reset_index())
        table = table.rename(columns=str).rename(columns=str.lower)
        return {"kind": "temperature-salinity",
                **{name: _column(key, table, name, value.attrs.get("units"))
                   for name in ("depth", "temperature", "salinity")}}
    depth, speed = _pairs(key, value, "depth", "speed")
    return {"kind": "table", "depth": depth, "speed": speed}


def bathymetry(value) -> dict:
    """What [environment.bottom] says of its depth: {"depth"} or {"shape"}."""
    key, shape = "bathymetry", "environment.bottom.shape"
    if isinstance(value, Mapping):
        return {"shape": described.taken(shape, shape, value)}
    if np.ndim(value) == 0:
        return {"depth": described.number(key, value, "m")}
    if hasattr(value, "dims"):
        if set(value.dims) != {"range"}:
            raise described.made(key, f"a DataArray over {', '.join(map(str, value.dims))}",
                                 "one over range")
        return {"shape": {"range": _axis(key, value, "range"),
                          "depth": described.numbers(key, value, "m").tolist()}}
    distance, depth = _pairs(key, value, "range", "depth")
    return {"shape": {"range": distance, "depth": depth}}


def setting(path: str, place: str, value):
    """A value for a setting as the library takes it: profiles become tables."""
    if place == "environment.sound_speed":
        return sound_speed(value)
    if place == "environment.bottom.shape":
        return bathymetry(value)["shape"]
    return described.taken(path, place, value)

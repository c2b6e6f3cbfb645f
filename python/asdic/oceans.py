"""Profiles and sea floors out of NumPy, pandas and xarray, as a scenario file says them."""
from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from . import described

SAND = {"kind": "grain-size", "grain_size": 1.5}  # medium sand (Hamilton)


def _names(table) -> list[str]:
    return [str(name).lower() for name in table.columns]


def _column(key: str, table, name: str) -> list:
    """The numbers of a column. Raises InputError for a row without one."""
    import pandas as pd

    values = pd.to_numeric(table[name], errors="coerce")
    missing = values.isna().to_numpy()
    if missing.any():
        row = int(missing.argmax())
        raise described.made(f"{key}: {name}, row {row}", str(table[name].iloc[row]),
                             "a number; dropna() leaves such rows out")
    return values.astype(float).tolist()


def _pairs(key: str, value, first: str, second: str) -> tuple[list, list]:
    """Two columns out of pairs [n, 2], a Series over `first`, or a DataFrame with both."""
    if hasattr(value, "columns"):  # pandas
        table = value.reset_index() if first not in _names(value) else value
        table = table.rename(columns=str).rename(columns=str.lower)
        for name in (first, second):
            if name not in table.columns:
                raise described.made(key, f"columns {', '.join(table.columns)}",
                                     f"{first} and {second}")
        return _column(key, table, first), _column(key, table, second)
    if hasattr(value, "index") and hasattr(value, "to_numpy"):  # a Series
        table = value.rename(second).rename_axis(first).reset_index()
        return _column(key, table, first), _column(key, table, second)
    pairs = np.asarray(value, float)
    if pairs.ndim != 2 or pairs.shape[1] != 2:
        raise described.made(key, f"an array of shape {pairs.shape}",
                             f"pairs ({first}, {second}), [n, 2]")
    return pairs[:, 0].tolist(), pairs[:, 1].tolist()


def sound_speed(value) -> dict:
    """[environment.sound_speed] of a number, a profile or a section."""
    if isinstance(value, Mapping):
        return dict(value)
    if np.ndim(value) == 0 and not hasattr(value, "dims"):
        return {"kind": "table", "depth": [0.0], "speed": [float(value)]}
    if hasattr(value, "dims"):  # xarray
        if set(value.dims) == {"depth"}:
            return {"kind": "table", "depth": value["depth"].values.astype(float).tolist(),
                    "speed": value.values.astype(float).tolist()}
        if set(value.dims) == {"range", "depth"}:
            section = value.transpose("range", "depth")
            return {"kind": "section", "range": section["range"].values.astype(float).tolist(),
                    "depth": section["depth"].values.astype(float).tolist(),
                    "speed": section.values.astype(float).tolist()}
        raise described.made("sound_speed", f"a DataArray over {', '.join(map(str, value.dims))}",
                             "one over depth, or over range and depth")
    if hasattr(value, "columns") and {"temperature", "salinity"} <= set(_names(value)):
        if "speed" in _names(value):
            raise described.made("sound_speed", "columns speed, temperature and salinity",
                                 "speed, or temperature and salinity")
        table = (value if "depth" in _names(value) else value.reset_index())
        table = table.rename(columns=str).rename(columns=str.lower)
        return {"kind": "temperature-salinity",
                **{name: _column("sound_speed", table, name)
                   for name in ("depth", "temperature", "salinity")}}
    depth, speed = _pairs("sound_speed", value, "depth", "speed")
    return {"kind": "table", "depth": depth, "speed": speed}


def bathymetry(value) -> dict:
    """What [environment.bottom] says of its depth: {"depth"} or {"shape"}."""
    if isinstance(value, Mapping):
        return {"shape": dict(value)}
    if np.ndim(value) == 0 and not hasattr(value, "dims"):
        return {"depth": float(value)}
    if hasattr(value, "dims"):
        if set(value.dims) != {"range"}:
            raise described.made("bathymetry",
                                 f"a DataArray over {', '.join(map(str, value.dims))}",
                                 "one over range")
        return {"shape": {"range": value["range"].values.astype(float).tolist(),
                          "depth": value.values.astype(float).tolist()}}
    distance, depth = _pairs("bathymetry", value, "range", "depth")
    return {"shape": {"range": distance, "depth": depth}}


def setting(place: str, value):
    """A value for a setting: profiles become tables, all else stays."""
    if place == "environment.sound_speed" and not isinstance(value, Mapping):
        return sound_speed(value)
    if place == "environment.bottom.shape" and not isinstance(value, Mapping):
        return bathymetry(value)["shape"]
    return value

"""What the library computes as pandas and xarray hold it, with the units of asdic's files."""
from __future__ import annotations

import threading
from typing import TYPE_CHECKING

import numpy as np

from . import _core

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

PAIRS = ("iq", "re_im")  # dimensions of a real and an imaginary part

_xarray = None
_lock = threading.Lock()


def xarray():
    """xarray, imported when it is first needed; it knows `ds.asdic` from then on."""
    global _xarray
    if _xarray is None:
        import xarray as xr

        with _lock:  # measures of a study come here from several threads
            if _xarray is None:
                xr.register_dataset_accessor("asdic")(Accessor)
                _xarray = xr
    return _xarray


class Accessor:
    """`ds.asdic`: what a dataset of asdic's holds beyond its arrays."""

    def __init__(self, dataset):
        self._dataset = dataset

    @property
    def times(self):
        """[samples] when the samples of ``pressure`` are received, after the start of the ping [s]"""
        return times(self._dataset["pressure"].attrs, self._dataset.sizes["sample"])[1]

    @property
    def pressure(self):
        """Pressure as complex64 where the file holds complex baseband as pairs; else as it is."""
        return as_complex(self._dataset["pressure"])

    def group(self, name: str) -> xr.Dataset:
        """The arrays of a group of the file under their own names: ``ds.asdic.group("echoes")``."""
        return group(self._dataset, name)

    def table(self, name: str) -> pd.DataFrame:
        """A group that is a table, as a pandas.DataFrame."""
        return group(self._dataset, name).to_dataframe()

    @property
    def scenario(self):
        """The scenario that it was made of. → asdic.Scenario"""
        from .scenario import Scenario
        return Scenario.parse(str(self._dataset["scenario"].values))


def group(dataset, name: str) -> xr.Dataset:
    """The arrays of a group of a file (``"processed/detections"``) under their own names. → xarray.Dataset"""
    before = flat(name.rstrip("/")) + "."
    found = {key[len(before):]: (tuple(str(dim).removeprefix(before) for dim in value.dims),
                                 value._data, value.attrs)
             for key, value in dataset.variables.items() if str(key).startswith(before)}
    if not found:
        raise KeyError(f"{name}: no such group")
    attrs = {key[len(before):]: value for key, value in dataset.attrs.items()
             if str(key).startswith(before)}
    return xarray().Dataset(found, attrs=attrs)


def flat(path: str) -> str:
    """The name of a file's array in a dataset: "echoes.delay" of "echoes/delay". netCDF has no names with a slash."""
    return path.replace("/", ".")


def as_pairs(data):
    """A Dataset or DataArray with its complex numbers as pairs, for netCDF, which has none.

    The last dimension of pairs, ``iq`` of complex baseband and ``re_im`` of all else, has the real and the imaginary
    part. :func:`as_complex` turns them back.
    """
    def paired(variable):
        if not np.issubdtype(variable.dtype, np.complexfloating):
            return variable
        values = np.ascontiguousarray(variable.values)
        dim = PAIRS[0 if "carrier_hz" in variable.attrs else 1]
        return xarray().Variable((*variable.dims, dim), values.view(values.real.dtype).reshape(*values.shape, 2),
                                 variable.attrs)

    return _changed(data, paired)


def as_complex(data):
    """A Dataset or DataArray with pairs of a real and an imaginary part, as files have them, as complex numbers."""
    return _changed(data, unpaired)


def unpaired(variable):
    """An xarray.Variable of pairs as complex numbers; else as it is."""
    if variable.ndim < 2 or variable.dims[-1] not in PAIRS:
        return variable
    values = np.ascontiguousarray(variable.values)
    kind = np.complex128 if values.dtype == np.float64 else np.complex64
    return xarray().Variable(variable.dims[:-1], values.view(kind)[..., 0], variable.attrs)


def _changed(data, change):
    """A Dataset or DataArray with each of its variables changed."""
    if isinstance(data, xarray().DataArray):
        return _changed(data.to_dataset(name=""), change)[""].rename(data.name)
    return data.assign({name: change(value.variable) for name, value in data.data_vars.items()})


MEANINGS = {"target": "number of the target, from 0", "array": "number of the array, from 0",
            "delay": "received, after the start of the ping", "struck": "when it struck the target",
            "doppler_factor": "received over transmitted frequency", "level_db": "of the echo's peak",
            "arrival_elevation_deg": "elevation of travel, positive up",
            "arrival_bearing_deg": "true bearing of travel: from the target to the array"}
UNITS = {"delay": "s", "struck": "s", "path_length": "m", "range": "m", "depth": "m"}


ARRIVAL_UNITS = {"delay": "s", "path_length": "m", "range": "m", "level_db": "dB re 1 m",
                 "spreading_db": "dB", "absorption_db": "dB", "amplitude": "re 1 m",
                 "bearing_deg": "degrees", "launch_elevation_deg": "degrees",
                 "arrival_elevation_deg": "degrees", "launch_deflection_deg": "degrees",
                 "arrival_deflection_deg": "degrees", "bounce_range": "m",
                 "bounce_grazing_deg": "degrees", "latitude": "degrees", "longitude": "degrees"}


def arrivals(columns, legs=None, warnings=()) -> pd.DataFrame:
    """Eigenrays as a table. → pandas.DataFrame"""
    import pandas as pd

    data = dict(legs or {})
    for name in columns.names:
        data[name] = getattr(columns, name)
    for name in ("bounce_range", "bounce_grazing_deg", "bounce_bottom"):
        data[name] = _objects(getattr(columns, name))
    made = pd.DataFrame(data, copy=False)
    made.attrs["units"] = ARRIVAL_UNITS
    return _with_warnings(made, warnings)


def _with_warnings(made, warnings):
    """The same, its `attrs` saying what to know; without any, nothing."""
    if warnings:
        made.attrs["warnings"] = list(warnings)
    return made


def _objects(arrays: list):
    """A column of arrays."""
    made = np.empty(len(arrays), object)
    for i, array in enumerate(arrays):
        made[i] = array
    return made


def rays(found: list, warnings=()) -> pd.DataFrame:
    """Rays as a table. → pandas.DataFrame"""
    import pandas as pd

    data = {}
    for name in found[0] if found else ():
        values = [ray[name] for ray in found]
        data[name] = _objects(values) if isinstance(values[0], np.ndarray) else values
    return _with_warnings(pd.DataFrame(data), warnings)


def field(found: dict) -> xr.DataArray:
    """A pressure field. → xarray.DataArray, complex"""
    xr = xarray()
    units = {"units": "m"}
    attrs = {"long_name": "pressure re 1 m", "frequency_hz": found["frequency"],
             "beam_error_db": found["beam_error_db"], "warnings": found["warnings"]}
    pressure = found["pressure"]
    if found["irregular"]:
        dims = ["source_depth", "receiver"]
        coords = {"depth": ("receiver", found["depth"], units),
                  "range": ("receiver", found["range"], units)}
    else:
        dims = ["source_depth", "depth", "range"]
        coords = {"depth": ("depth", found["depth"], units),
                  "range": ("range", found["range"], units)}
    coords["source_depth"] = ("source_depth", found["source_depth"], units)
    for name, unit in (("latitude", "degrees_north"), ("longitude", "degrees_east")):
        if name in found:
            coords[name] = (dims[-1], found[name], {"units": unit})
    made = xr.DataArray(pressure, dims=dims, coords=coords, name="pressure", attrs=attrs)
    return made.isel(source_depth=0) if len(found["source_depth"]) == 1 else made


def profile(depths, speeds) -> xr.DataArray:
    """Sound speed over depth. → xarray.DataArray"""
    return xarray().DataArray(speeds, dims="depth", name="sound_speed",
                              coords={"depth": ("depth", depths, {"units": "m"})},
                              attrs={"units": "m/s", "long_name": "sound speed"})


def waveform(found: dict) -> xr.DataArray:
    """A pulse. → xarray.DataArray, complex"""
    samples = found["analytic"]
    time = np.arange(len(samples)) / found["sample_rate"]
    return xarray().DataArray(
        samples, dims="time", name="waveform",
        coords={"time": ("time", time, {"units": "s", "long_name": "after the leading edge"})},
        attrs={"units": "1", "sample_rate_hz": found["sample_rate"],
               "source_level_db": found["source_level_db"],
               "centre_frequency_hz": found["centre_frequency"], "energy_s": found["energy"]})


def times(told, samples: int):
    """When samples are received, by what a file tells of its pressure. → a coordinate"""
    return ("sample", told["time_start"] + told["time_step"] * np.arange(samples),
            {"units": "s", "long_name": "time after the start of the ping"})


def ping(scenario, handle, warnings=()) -> xr.Dataset:
    """A ping's record. → xarray.Dataset with the names of docs/formats/ping.md"""
    xr = xarray()
    pressure = handle.pressure
    rate = handle.sample_rate
    told = {"units": "Pa", "long_name": "acoustic pressure", "sample_rate_hz": rate,
            "time_start": handle.start, "time_step": 1.0 / rate}
    if handle.is_complex:
        told |= {"carrier_hz": handle.carrier, "long_name": "complex baseband of the pressure"}
    variables = {
        "pressure": (("channel", "sample"), pressure, told),
        "phone_position": (("channel", "xyz"), handle.phones, {"units": "m"}),
        "ping": ((), handle.number), "transmitter": ((), handle.transmitter),
        "ping_time": ((), handle.time, {"units": "s"}),
        "scenario": ((), handle.scenario.to_toml())}
    for name, values in handle.echoes.items():
        unit = UNITS.get(name, "degrees" if name.endswith("_deg")
                         else "dB re 1 µPa" if name == "level_db" else "1")
        variables[f"echoes.{name}"] = ("echo", values,
                                       {"units": unit, "long_name": MEANINGS.get(name, name)})
    made = xr.Dataset(variables, coords={"channel": np.arange(pressure.shape[0]),
                                         "time": times(told, pressure.shape[1])},
                      attrs={"filetype": "asdic ping", "title": scenario.title or ""})
    made.encoding["asdic"] = handle  # that asdic.process() knows it again
    return _with_warnings(made, warnings)


def ping_of(dataset):
    """The library's ping behind a dataset of :func:`ping`; None behind others.

    Where the dataset came through a pickle or a file it is simulated again, out of the dataset's scenario.
    """
    handle = getattr(dataset, "encoding", {}).get("asdic")
    if handle is None and {"scenario", "ping", "pressure"} <= set(getattr(dataset, "variables", ())) \
            and dataset["ping"].ndim == 0:
        scenario = _core.Scenario.parse(str(dataset["scenario"].values), "scenario.toml")
        handle = _core.Pinger(scenario, None).ping(int(dataset["ping"]))
    return handle

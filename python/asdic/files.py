"""Every file of asdic's, and of BELLHOP's results, as a dataset."""
from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from . import _core, datasets, described
from .told import tell

if TYPE_CHECKING:
    import xarray as xr

BELLHOP = (".shd", ".arr", ".ray")


def open(path, load: bool | None = None) -> xr.Dataset:  # noqa: A001
    """A file of asdic's (ping, field, arrivals, rays, study) or of BELLHOP's (.shd, .arr, .ray).

    Returns an xarray.Dataset with the file's names, dimensions and units (docs/formats): arrays of
    groups are called by their path with dots, ``ds["echoes.delay"]``, attributes of groups likewise.
    ``ds.asdic.group("echoes")`` gives a group by itself, ``ds.asdic.table("echoes")`` as a
    DataFrame, ``ds.asdic.pressure`` complex baseband as complex64.

    `load`: True reads all, False reads arrays when they are used; by default files of up to 64 MB
    are read at once. What is read at once has complex numbers as complex64; else they are pairs,
    and ``ds.asdic.pressure`` is complex.

    Raises InputError for what is no such file; OSError.
    """
    path = Path(path)
    if not path.exists():
        raise described.made(str(path), "no such file", "one of asdic's or of BELLHOP's")
    if path.suffix.lower() in BELLHOP:
        with tempfile.TemporaryDirectory() as folder:
            made = os.path.join(folder, "result.h5")
            _core.convert_result(os.fspath(path), made)
            return _read(made, True)
    return _read(os.fspath(path), path.stat().st_size <= 64 << 20 if load is None else load)


def run(scenario, progress=None) -> xr.Dataset:
    """What [run] of a scenario asks for. → xarray.Dataset"""
    with tempfile.TemporaryDirectory() as folder:
        made = os.path.join(folder, "result.h5")
        notes = _core.write_run(made, scenario._core, progress)
        found = _read(made, True)
    if notes:
        found.attrs["warnings"] = notes
    tell(notes)
    return found


def _read(path: str, load: bool):
    import h5py

    xr = datasets.xarray()
    try:
        with h5py.File(path, "r") as file:
            kind = file.attrs.get("filetype", "")
            groups = []
            file.visititems(lambda name, item: groups.append(name)
                            if isinstance(item, h5py.Group) else None)
    except OSError as error:
        raise described.made(path, str(error), "an HDF5 file of asdic's") from None
    kind = kind.decode() if isinstance(kind, bytes) else str(kind)
    if not kind.startswith("asdic "):
        raise described.made(path, f'filetype "{kind}"' if kind else "a file without a filetype",
                             'a file of asdic\'s: filetype "asdic …"')
    made = xr.open_dataset(path, engine="h5netcdf", decode_times=False, phony_dims="access")
    whole = made.load() if load else made
    variables = dict(whole.variables)
    attrs = dict(whole.attrs)
    told = variables["pressure"].attrs if "pressure" in variables else {}
    timed = "time_start" in told and "sample" in whole.sizes and np.ndim(told["time_start"]) == 0
    sizes = dict(whole.sizes) | ({"time": 0} if timed else {})  # that no group's dimension has
    for path_of_group in groups:
        name = datasets.flat(path_of_group)
        part = xr.open_dataset(path, engine="h5netcdf", group=path_of_group, decode_times=False,
                               phony_dims="access")
        part = part.load() if load else part
        own = {dim: f"{name}.{dim}" for dim in part.dims
               if part.sizes[dim] != sizes.get(dim, part.sizes[dim])}
        sizes = dict(part.sizes) | sizes
        for key, value in part.variables.items():
            dims = tuple(own.get(dim, dim) for dim in value.dims)
            variables[f"{name}.{key}"] = xr.Variable(dims, value._data, value.attrs)
        attrs |= {f"{name}.{key}": value for key, value in part.attrs.items()}
        if load:
            part.close()
    if load:
        made.close()
    if load:
        variables = {name: datasets.unpaired(value) for name, value in variables.items()}
    if timed:
        variables["time"] = xr.Variable(*datasets.times(told, whole.sizes["sample"]))
    coords = {name: value for name, value in variables.items()
              if value.dims == (name,) or (name, value.dims) == ("time", ("sample",))
              or name in ("latitude", "longitude") and name in whole.coords}
    found = xr.Dataset({n: v for n, v in variables.items() if n not in coords}, coords, attrs)
    found.encoding["source"] = path
    return found

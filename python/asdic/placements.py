"""Where sensors are best put."""
from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

from . import _core, files
from .scenario import _text
from .told import tell

if TYPE_CHECKING:
    import xarray as xr


def place(plan: str | os.PathLike, output: str | os.PathLike | None = None, *,
          changes: Mapping[str, object] | Sequence[str] = (),
          progress: Callable[[int, int], object] | None = None) -> xr.Dataset:
    """The best places and options of sensors, how good a better set could be, and how sure the choice is.

    Parameters
    ----------
    plan : path
        A plan (docs/formats/placement.md).
    output : path, optional
        The file to write; none is kept without it.
    changes : mapping or sequence of str, optional
        Keys of the plan or of its scenarios, ``{"placement.sensors": 3}`` or ``["placement.sensors=3"]``.
    progress : callable, optional
        Is told (done, of) now and then.

    Returns
    -------
    xarray.Dataset
        With the names and units of docs/formats/placement.md: ``sensor_place``, ``sensor_option``,
        ``detection_probability`` over (depth, cell), …; ``attrs`` has the numbers of the answer.
    """
    if isinstance(changes, Mapping):
        changes = [f"{key}={_text(value)}" for key, value in changes.items()]
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "placement.h5") if output is None else os.fspath(output)
        warnings = _core.write_placement(path, os.fspath(plan), list(changes), progress)
        found = files.open(path, load=True)
    if output is None:
        found.encoding.pop("source", None)
    tell(warnings)
    return found

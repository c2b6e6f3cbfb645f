"""What a sonar sees of the area around it."""
from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from . import _core, described, files
from .told import tell

if TYPE_CHECKING:
    import xarray as xr

    from .scenario import Scenario


def area(scenario: Scenario | str | os.PathLike, depth: float | Sequence[float] | None = None, *,
         reach: float | None = None, bearings: int = 360, ranges: int = 500,
         strength_db: float | None = None, fluctuation: str | None = None,
         false_alarm_probability: float = 1e-4, reference_cells: float = 24.0,
         transmitter: str | None = None, array: str | None = None, ping: int | None = None,
         progress: Callable[[int, int], object] | None = None) -> xr.Dataset:
    """Echo, reverberation, noise, signal excess and probability of detection all round, as `asdic area`.

    Parameters
    ----------
    scenario : Scenario or path
        With its transmitter, array, pulse, noise and reverberation.
    depth : float or sequence, optional
        Of the target [m]; the first target's.
    reach : float, optional
        Up to that range [m]; as far as the record hears.
    bearings, ranges : int
        Cells all round, and from the array to there.
    strength_db : float, optional
        Of the target at every aspect [dB]; the first target's, without one 10.
    fluctuation : str, optional
        "none", "swerling-1" … "swerling-4"; the first target's.
    false_alarm_probability : float
        Of a cell without an echo.
    reference_cells : float
        Over which the background is averaged; 0: it is known.
    transmitter, array : str, optional
        Who sends and who listens; that of `ping`, and the first.
    ping : int, optional
        Of the run, from 1: where everything is then.
    progress : callable, optional
        Is told (done, of) now and then.

    Returns
    -------
    xarray.Dataset
        Over (depth, bearing, range), with the names and units of docs/formats/area.md:
        ``signal_excess_db``, ``detection_probability``, ``echo_db``, ``reverberation_db``, …
        ``attrs["warnings"]`` tells what to know before trusting it.

    Raises InputError naming the option at fault.
    """
    from .scenario import Scenario

    made = scenario if isinstance(scenario, Scenario) else Scenario(scenario)
    depths = [] if depth is None else np.ravel(described.numbers("depth", depth, "m")).tolist()
    reach = described.number("reach", reach, "m", True)
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "area.h5")
        warnings = _core.write_area(path, made._core, depths, reach, bearings, ranges, strength_db,
                                    fluctuation, false_alarm_probability, reference_cells,
                                    transmitter, array, ping, progress)
        found = files.open(path, load=True)
    found.encoding.pop("source", None)
    if warnings:
        found.attrs["warnings"] = warnings
    tell(warnings)
    return found

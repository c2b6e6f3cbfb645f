"""Active sonar in a real ocean: eigenrays, fields, pings, processing, channels, studies.

    import asdic
    s = asdic.Scenario("deep_ocean.toml")
    ping = s.ping()
    print(asdic.process(ping).detections)

All numbers are SI. Names that end in ``_deg`` are in degrees, in ``_db`` in decibels. Positions are
(east, north, depth), depth positive down; elevations are positive up; bearings are true.
docs/guide/python.md
"""
import sys as _sys

from ._core import Arrivals, InputError, RunError, Stopped, build, version
from . import bellhop
from . import datasets as _datasets
from .areas import area
from .channel import Channel
from .datasets import as_complex, as_pairs, group
from .files import open  # noqa: A004  asdic.open
from .pages import page
from .placements import place
from .places import Ocean, ocean
from .processing import Processed, process
from .scenario import Scenario, settings
from .studies import Measure, StudyResult, read_study, study, to_parquet
from .told import AsdicWarning

__version__ = version()
if "xarray" in _sys.modules:    # else it is imported when it is first needed
    _datasets.xarray()


def __getattr__(name: str):
    if name == "pictures":      # needs matplotlib, which takes a while: only who draws waits
        import importlib
        return importlib.import_module(".pictures", __name__)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


__all__ = ["Arrivals", "AsdicWarning", "Channel", "InputError", "Measure", "Ocean", "Processed",
           "RunError", "Scenario", "Stopped", "StudyResult", "area", "as_complex", "as_pairs",
           "bellhop", "build", "group", "ocean", "open", "page", "place", "process",
           "read_study", "settings", "study", "to_parquet", "version"]

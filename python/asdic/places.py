"""The ocean of a real place.

    s = asdic.ocean(30.5, -60.5, month=3)
    s.environment.bottom.depth
"""
from __future__ import annotations

import os

from . import _core
from .scenario import Scenario


class Ocean(Scenario):
    """A scenario whose [environment] is that of a real place; :func:`ocean` makes one.

    ``origins`` tells the files and variables that it is made of, ``notes`` what to know before
    trusting it.
    """

    __slots__ = ("_notes", "_origins")

    @property
    def notes(self) -> list[str]:
        return list(self._notes)

    @property
    def origins(self) -> list[str]:
        return list(self._origins)


def ocean(latitude: float, longitude: float, month: int | None = None, *,
          bearing_deg: float | None = None, range: float | None = None, data=None,
          **sections) -> Ocean:
    """The ocean of a real place, out of gridded climatologies, as ``asdic ocean`` writes it.

    Parameters
    ----------
    latitude, longitude : float
        Degrees north and east, longitude from -180 to 180 or 0 to 360.
    month : int, optional
        1 to 12; without it, the mean of the year.
    bearing_deg, range : float, optional
        A track from there: true bearing and length [m]. Sea floor and water are those along it.
    data : path, optional
        Folder of the climatologies; that of Debian's package ferret-datasets.
    **sections
        Everything else of a scenario, as :class:`Scenario` takes it: ``pulse={"kind": "cw", ...}``.

    Raises InputError for a place on land, and for data that are not there.

    The data say nothing of the sediment: the floor is abyssal clay. What they do not say else is in
    docs/guide/real-ocean.md.
    """
    core, origins, notes = _core.ocean(latitude, longitude, month, bearing_deg, range,
                                       "" if data is None else os.fspath(data))
    made = Ocean._of_core(core)
    object.__setattr__(made, "_notes", notes)
    object.__setattr__(made, "_origins", origins)
    made._take(sections)
    return made

"""The ocean of a real place.

    s = asdic.ocean(30.5, -60.5, month=3)
    s.environment.bottom.depth
"""
from __future__ import annotations

import os

from . import _core, described
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


def _names(files) -> list[str]:
    if files is None:
        return []
    one = isinstance(files, (str, os.PathLike))
    return [os.fspath(file) for file in ([files] if one else files)]


def ocean(latitude: float, longitude: float, month: int | None = None, *, date=None,
          bearing_deg: float | None = None, range: float | None = None, step: float | None = None,
          area: float | None = None, output=None, temperature=None, salinity=None,
          sound_speed=None, bathymetry=None, wind=None, sediment=None, data=None,
          **sections) -> Ocean:
    """The ocean of a real place, out of measured data, as ``asdic ocean`` writes it.

    Parameters
    ----------
    latitude, longitude : float
        Degrees north and east, longitude from -180 to 180 or 0 to 360.
    month : int, optional
        1 to 12: the mean of the data's times in it; without it, the mean of all.
    date : str or date, optional
        In place of a month: "2024-02-29", "2024-02-29T06:00", or what has ``isoformat()``.
    bearing_deg, range : float, optional
        A track from there: true bearing and length [m]. Sea floor and water are those along it.
    step : float, optional
        Between depths along the track [m]; without it, the grid's own spacing.
    area : float, optional
        Side of a square about the place [m], in place of a track: its maps are written to a netCDF
        file beside ``output``, a name that ends in .toml.
    temperature, salinity, sound_speed, bathymetry, wind, sediment : path or paths, optional
        Files of data, "FILE" or "FILE:VARIABLE", as the options of ``asdic ocean`` take them; more
        than one where they are tiles, times, or levels of one another.
    data : path, optional
        Folder of what is not named; that of Debian's package ferret-datasets.
    **sections
        Everything else of a scenario, as :class:`Scenario` takes it: ``pulse={"kind": "cw", ...}``.

    Raises InputError for a place on land, and for data that are not there or in another unit.

    Where no map of sediments is named, the floor is what is most common at its depth, and a note
    says so. Files, digests, times and place are in ``environment.origin``. What the data do not say
    is in docs/guide/real-ocean.md.
    """
    files = {"temperature": _names(temperature), "salinity": _names(salinity),
             "sound_speed": _names(sound_speed), "bathymetry": _names(bathymetry),
             "wind": _names(wind), "sediment": _names(sediment)}
    latitude, longitude = (described.number(key, value, "degrees")
                           for key, value in (("latitude", latitude), ("longitude", longitude)))
    bearing_deg = described.number("bearing_deg", bearing_deg, "degrees", True)
    range, step, area = (described.number(key, value, "m", True)
                         for key, value in (("range", range), ("step", step), ("area", area)))
    day = "" if date is None else date if isinstance(date, str) else date.isoformat()
    core, origins, notes = _core.ocean(latitude, longitude, month, day, bearing_deg, range, step,
                                       area, "" if output is None else os.fspath(output), files,
                                       "" if data is None else os.fspath(data))
    made = Ocean._of_core(core)
    object.__setattr__(made, "_notes", notes)
    object.__setattr__(made, "_origins", origins)
    made._take(sections)
    return made

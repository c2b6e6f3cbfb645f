"""BELLHOP's cases and results.

    case = asdic.bellhop.read("munk.env")
    field = case.run()
"""
from __future__ import annotations

import os

from . import _core
from .files import open as _open
from .scenario import Scenario


class Case(Scenario):
    """A case of BELLHOP's as asdic understands it: a scenario with a [run].

    ``notes`` tells what the reader did that one should know. ``run()`` does what the case asks for
    and returns an xarray.Dataset, as :func:`asdic.open` does of a .shd, .arr or .ray file.
    """

    __slots__ = ("_notes",)

    @property
    def notes(self) -> list[str]:
        return list(self._notes)


def read(root, maps="") -> Case:
    """Reads ROOT.env and the files beside it (.bty .ati .ssp .brc .trc .sbp).

    A case of BELLHOP3D becomes the scenario of its first plane, in an area whose maps are written
    to the file ``maps`` ("seamount.nc"). ``environment.transect.bearing_deg`` turns it. The command
    ``asdic bellhop`` runs all azimuths at once.

    Raises InputError, "munk.env:12: …".
    """
    core, notes = _core.read_bellhop(os.fspath(root), os.fspath(maps))
    made = Case._of_core(core)
    object.__setattr__(made, "_notes", notes)
    return made


def open(path):  # noqa: A001
    """A .shd, .arr or .ray file as an xarray.Dataset: :func:`asdic.open`."""
    return _open(path)


def convert(source, to) -> None:
    """A field, arrivals or rays from one kind of file to another (.h5, .shd, .arr, .ray)."""
    _core.convert_result(os.fspath(source), os.fspath(to))

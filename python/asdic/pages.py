"""A ping as one page for a browser."""
from __future__ import annotations

import os


def page(source, file, *, ping=None, array=None, force: bool = False) -> str:
    """Writes one page that zooms, tells values and links its panels, as ``asdic plot --html`` does.

    Parameters
    ----------
    source : xarray.Dataset or path
        What :meth:`Scenario.ping` or :func:`asdic.open` gave, or a ping file.
    file : path
        Where the page goes. Nothing that asdic did not write is written over without `force`.
    ping : int, array : str
        A ping's number, an array's name; without them the page holds all.

    Returns the path of the page. Needs h5py and matplotlib. Raises InputError, OSError.
    """
    from asdic_page import page as _page

    from .pictures import _ping

    with _ping(source) as data:
        return os.fspath(_page.write(data, file, ping, array, force))

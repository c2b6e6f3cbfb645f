"""What to know before trusting a number, told as Python tells of such things."""
from __future__ import annotations

import os
import sys
import warnings

_HERE = os.path.dirname(__file__) + os.sep
_told: set = set()  # (line, file, number of its line): Python's own memory is emptied by pandas


class AsdicWarning(UserWarning):
    """What to know before trusting a number.

    Each is told once for a line of code. ``warnings.simplefilter("error", asdic.AsdicWarning)``
    makes errors of them, ``"ignore"`` leaves them out.
    """


def tell(lines) -> None:
    """Warns of each line, at the line of the caller's code that called asdic."""
    if not lines:
        return
    level, frame = 1, sys._getframe()
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_HERE):
        level, frame = level + 1, frame.f_back
    asked = any(action in ("always", "error") and issubclass(AsdicWarning, category)
                for action, _, category, _, _ in warnings.filters)
    for line in lines:
        place = line, frame.f_code.co_filename, frame.f_lineno
        if asked or place not in _told:
            _told.add(place)
            warnings.warn(line, AsdicWarning, stacklevel=level)

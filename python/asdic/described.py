"""The settings that there are, out of the one description that the library has."""
from __future__ import annotations

import difflib
import functools
import operator
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import _core
from ._core import InputError


class Text(str):
    """Lines that a notebook or a prompt shows as lines."""

    def __repr__(self) -> str:
        return str(self)


@dataclass(frozen=True)
class Setting:
    """One key of a scenario file.

    path       "pulse.duration", "target[].strength_db"
    kind       "number", "whole", "flag", "text", "word", "numbers", "rows", "axis", "vector",
               "vectors", "name"
    unit       "m"; "" of none
    lowest, highest, or_zero   its range; or_zero: or 0, where the lowest is above it
    words      that there are, of a number those in its place
    standard   what holds without it, as TOML; "" of none
    otherwise  the same in words, or the setting that is its default
    help, condition, required
    """

    path: str
    kind: str
    unit: str
    lowest: float
    highest: float
    or_zero: bool
    words: tuple
    length: int
    standard: str
    otherwise: str
    help: str
    condition: str
    required: bool

    @property
    def range(self) -> str:
        """What it may be, in words."""
        if self.words and self.kind == "word":
            return "one of " + ", ".join(f'"{word}"' for word in self.words)
        inf = float("inf")
        low = f"{'0, or ' if self.or_zero else ''}from {self.lowest:g}"
        text = ""
        if self.lowest > -inf:
            text = low + (f" to {self.highest:g}" if self.highest < inf else "")
        elif self.highest < inf:
            text = f"up to {self.highest:g}"
        others = " or ".join(f'"{word}"' for word in self.words)
        return " or ".join(part for part in (text, others) if part)

    @property
    def doc(self) -> str:
        """A few lines for people."""
        lines = [f"{self.path}{f' [{self.unit}]' if self.unit else ''}: {self.help}"]
        if self.range:
            lines.append(f"  may be:   {self.range}")
        if self.standard or self.otherwise:
            lines.append(f"  default:  {self.standard or self.otherwise}")
        if self.condition:
            lines.append(f"  where:    {self.condition}")
        return "\n".join(lines)


@functools.lru_cache(maxsize=None)
def settings() -> dict[str, list[Setting]]:
    """Every setting of a scenario file. → {path: [Setting of each choice that has it]}"""
    found: dict[str, list[Setting]] = {}
    for told in _core.settings():
        of: dict[str, Any] = {**told, "words": tuple(told["words"])}
        one = Setting(**of)
        found.setdefault(one.path, []).append(one)
    return found


@functools.lru_cache(maxsize=None)
def tables() -> dict[str, dict[str, Any]]:
    """Every table. → {path without [] at its end: {"help", "list", "one_or_more"}}"""
    found: dict[str, dict[str, Any]] = {}
    for told in _core.setting_tables():
        path = told["path"]
        found.setdefault(path[:-2] if told["list"] else path, told)
    for path in list(found) + list(settings()):  # those that are told of through what is in them
        while "." in path:
            path = path.rsplit(".", 1)[0]
            bare = path[:-2] if path.endswith("[]") else path
            found.setdefault(bare, {"path": path, "help": "", "list": path.endswith("[]"),
                                    "one_or_more": path.endswith("[]")})
    return found


@functools.lru_cache(maxsize=None)
def keys_of(place: str) -> tuple:
    """The keys of a table, settings first. \"\": of the file itself."""
    before = place + "." if place else ""
    names = []
    for path in list(settings()) + list(tables()):
        if path.startswith(before):
            rest = path[len(before):].split(".")[0].removesuffix("[]")
            if rest and rest not in names:
                names.append(rest)
    return tuple(names)


def is_list(place: str) -> bool:
    """Whether a table may stand several times."""
    told = tables().get(place)
    return told is not None and (told["list"] or told["one_or_more"])


def unknown(place: str, name: str) -> InputError:
    """The error for a key that no table has."""
    near = difflib.get_close_matches(name, keys_of(place), 3) or keys_of(place)
    where = f"{place}.{name}" if place else name
    return made(where, "no such setting", "one of " + ", ".join(near))


def measured(choices: list, value):
    """A number that was written with its unit, "25km", as a number in the setting's own; else as it is."""
    if isinstance(value, str):
        for one in choices:
            if one.kind in ("number", "whole") and value not in one.words:
                found = _core.measured(value, one.unit)
                return value if found is None else found
    return value


def made(key: str, found: str, expected: str) -> InputError:
    error = InputError(f"{key}: found {found}, expected {expected}")
    error.where = error.key = key
    error.file, error.line, error.found, error.expected = "", 0, found, expected
    return error


def check(key: str, choices: list, value) -> None:
    """Refuses a number out of range and a word that there is not, before anything is computed."""
    if not choices or value is None:
        return
    value = measured(choices, value)
    if isinstance(value, str) and all(one.kind in ("number", "whole") for one in choices) \
            and not any(value in one.words for one in choices):
        unit = choices[0].unit
        raise made(key, f'"{value}"', f"a number{f' [{unit}], or one with its unit' if unit else ''}")
    if not isinstance(value, (str, bool)) and hasattr(value, "__float__") \
            and getattr(value, "ndim", 0) == 0:
        ranged = [one for one in choices if one.kind in ("number", "whole")]
        asked = float(value)
        fits = [one for one in ranged if one.lowest <= asked <= one.highest
                or one.or_zero and asked == 0]
        if ranged and not fits:
            unit = f" {ranged[0].unit}" if ranged[0].unit else ""
            raise made(key, f"{asked:g}{unit}", ranged[0].range)
    elif isinstance(value, str):
        words = [word for one in choices for word in one.words]
        if all(one.kind in ("word", "number", "whole") for one in choices) and words \
                and value not in words:
            raise made(key, f'"{value}"', "one of " + ", ".join(f'"{w}"' for w in words))


def unit_of(value) -> str:
    """The unit that an array gives for itself: `attrs["units"]` of xarray, pandas and h5py, `units` of others.

    "": it gives none.
    """
    if isinstance(value, (str, Mapping)):
        return ""
    attrs = getattr(value, "attrs", None)
    told = getattr(value, "units", None) if attrs is None else attrs.get("units")
    if isinstance(told, Mapping):  # a column of a table, which has the units of all
        told = told.get(getattr(value, "name", None))
    return "" if told is None else str(told.decode() if isinstance(told, bytes) else told).strip()


def numbers(key: str, value, unit: str, told: str | None = None) -> np.ndarray:
    """The numbers of an array in `unit`, converted from the unit that it gives for itself, or from `told`.

    Numbers without a unit are in `unit`. Raises InputError for a unit that does not convert to it.
    """
    told = unit_of(value) if told is None else told
    values = np.asarray(value, float)
    if told in ("", unit) or (told, unit) == ("1", ""):
        return values
    zero, one = (_core.measured(f"{x} {told}", unit) for x in "01")
    if zero is None or one is None:
        raise made(key, f'units of "{told}"', f'"{unit}", or a unit that converts to it' if unit else "no unit")
    return values * (one - zero) + zero


def place_of(path: str) -> str:
    """A setting's place in the description by its path: "target.0.depth" is "target[].depth"."""
    place = ""
    for key in path.split("."):
        if not key.isdigit():
            place = f"{_inside(place)}.{key}" if place else key
    return place


def _inside(place: str) -> str:
    return place if keys_of(place) else place + "[]"


def taken(path: str, place: str, value):
    """A value as the library takes it: arrays with units in the unit of their setting.

    Raises InputError for keys that a table does not have, numbers out of range, and units that do not convert.
    """
    if isinstance(value, Mapping):
        inside = _inside(place)
        known = keys_of(inside)
        for name in value if known else ():
            if name not in known:
                near = difflib.get_close_matches(str(name), known, 3) or known
                raise made(f"{path}.{name}", "no such setting", "one of " + ", ".join(near))
        return {name: taken(f"{path}.{name}", f"{inside}.{name}", inner) for name, inner in value.items()}
    if isinstance(value, (list, tuple)):
        return [taken(f"{path}.{i}", place, one) if isinstance(one, Mapping) or unit_of(one) else one
                for i, one in enumerate(value)]
    choices = settings().get(place, [])
    if choices and unit_of(value):
        value = numbers(path, value, choices[0].unit).tolist()
    check(path, choices, value)
    return value


def number(key: str, value, unit: str, optional: bool = False):
    """An argument that is a number, or a text with its unit, "6km". Raises InputError."""
    if value is None and optional:
        return None
    found = _core.measured(value, unit) if isinstance(value, str) else value
    if unit_of(found):
        found = numbers(key, found, unit)
    try:
        return float(found)
    except (TypeError, ValueError):
        shown = f'"{value}"' if isinstance(value, str) else f"a {type(value).__name__}"
        raise made(key, shown, f"a number [{unit}]" if unit else "a number") from None


def whole(key: str, value) -> int:
    """An argument that counts. Raises InputError."""
    try:
        return operator.index(value)
    except TypeError:
        raise made(key, f"{value!r}", "a whole number") from None

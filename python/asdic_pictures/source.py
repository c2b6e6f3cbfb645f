"""Where numbers come from: a file on the disk, one that is open, or a dataset in memory.

Readers (data.py, results.py, study_data.py, scene.py) know h5py's way of asking: `f["echoes/delay"]`,
`"rays" in f`, `f.attrs`. A dataset of xarray, as `asdic.open` and `Scenario.ping` give it, answers
the same way here: its "echoes.delay" is the file's "echoes/delay". xarray itself is not needed.
"""
from __future__ import annotations

import os

import numpy as np


def is_path(source) -> bool:
    return isinstance(source, (str, os.PathLike))


def is_open(source) -> bool:
    """An h5py.File."""
    return hasattr(source, "visititems")


def is_dataset(source) -> bool:
    """An xarray.Dataset or a tree of them, or an open file."""
    return hasattr(source, "subtree") or is_open(source) \
        or (hasattr(source, "data_vars") and hasattr(source, "attrs"))


def name_of(source) -> str:
    """For messages and titles: where a dataset was read, if it was."""
    if is_path(source):
        return os.fspath(source)
    if is_open(source):
        return str(source.file.filename)
    return str(getattr(source, "encoding", {}).get("source", "") or "dataset")


class Member:
    """A dataset of a file: what h5py.Dataset is to its readers. Complex numbers are pairs."""

    def __init__(self, variable):
        self._variable = variable
        self._complex = np.issubdtype(variable.dtype, np.complexfloating)

    @property
    def shape(self):
        return tuple(self._variable.shape) + ((2,) if self._complex else ())

    @property
    def attrs(self):
        return self._variable.attrs

    def __getitem__(self, rows):
        whole = isinstance(rows, tuple) and not rows or rows is Ellipsis
        if not self._complex:
            return np.asarray((self._variable if whole else self._variable[rows]).values)
        values = np.asarray(self._variable.values if whole else self._variable[rows].values)
        real = np.float64 if values.dtype == np.complex128 else np.float32
        return np.ascontiguousarray(values).view(real).reshape(*values.shape, 2)


class Group:
    """A group of a file, or all of it."""

    def __init__(self, variables: dict, attributes: dict, prefix: str = ""):
        self._variables, self._attributes, self._prefix = variables, attributes, prefix

    @property
    def attrs(self) -> dict:
        mine = {key[len(self._prefix):]: value for key, value in self._attributes.items()
                if key.startswith(self._prefix)}
        return {key: value for key, value in mine.items() if "/" not in key}

    def __iter__(self):
        seen = dict.fromkeys(key[len(self._prefix):].split("/")[0]
                             for key in (*self._variables, *self._attributes)
                             if key.startswith(self._prefix)
                             and (key in self._variables or "/" in key[len(self._prefix):]))
        return iter(seen)

    def items(self):
        return [(name, self[name]) for name in self]

    def __contains__(self, name) -> bool:
        key = self._prefix + str(name).strip("/")
        return key in self._variables or any(
            other.startswith(key + "/") for other in (*self._variables, *self._attributes))

    def __getitem__(self, name):
        key = self._prefix + str(name).strip("/")
        if key in self._variables:
            return Member(self._variables[key])
        if not key or name in self:
            return Group(self._variables, self._attributes, key + "/" if key else "")
        raise KeyError(key)

    def close(self) -> None:
        pass

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass


class Kept:
    """An open file that is the caller's: it stays open."""

    def __init__(self, file):
        self._file = file
        self.attrs = file.attrs

    def __contains__(self, name) -> bool:
        return name in self._file

    def __getitem__(self, name):
        return self._file[name]

    def close(self) -> None:
        pass

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass


def of_dataset(dataset):
    """A file's arrays and attributes by their paths."""
    if is_open(dataset):
        return Kept(dataset)
    if not hasattr(dataset, "subtree"):
        return Group({str(k).replace(".", "/"): v for k, v in dataset.variables.items()},
                     {str(k).replace(".", "/"): v for k, v in dataset.attrs.items()})
    variables, attributes = {}, {}
    for node in dataset.subtree:
        at = node.path.strip("/")
        before = at + "/" if at else ""
        variables |= {f"{before}{k}": v for k, v in node.variables.items()}
        attributes |= {f"{before}{k}": v for k, v in node.attrs.items()}
    return Group(variables, attributes)

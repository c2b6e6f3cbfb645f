"""Reads a file of a study (docs/formats/study-results.md). Whatever is wrong with it becomes an
InputError.
"""
from __future__ import annotations

import json
import re
from dataclasses import dataclass, field

import h5py
import numpy as np

from . import source
from .data import InputError

KIND = "asdic study"

PROPORTIONS = {"pd": "probability of detection", "pfa": "probability of false alarm", "p": "probability",
               "ptrack": "probability of track initiation"}
DECIBELS = "_db"
DEGREES = "_deg"
SHORT = {"snr": "SNR"}
WHOLE = {"p_event": "probability of the rare event"}


def spoken(name: str) -> str:
    """A column's name as words: "snr_matched_db" → "SNR matched". The unit says that it is in dB or degrees."""
    if name in WHOLE:
        return WHOLE[name]
    word, _, rest = name.partition("_")
    if word in PROPORTIONS:
        if rest == "ever" or rest.startswith("ever_"):  # over a run of pings
            return f"{PROPORTIONS[word]} in any ping" + (f", {rest[5:]}" if rest[5:] else "")
        return f"{PROPORTIONS[word]}, {rest}" if rest else PROPORTIONS[word]
    words = name.replace(DECIBELS + "_", "_", 1)  # a target's name may follow
    words = words.removesuffix(DECIBELS).removesuffix(DEGREES).split("_")
    # a group's name and its key's may be one: "bottom_bottom"
    once = [w for k, w in enumerate(words) if k == 0 or w != words[k - 1]]
    return " ".join(SHORT.get(w, w) for w in once)


@dataclass
class Column:
    """A column of the table or of a summary."""

    name: str
    unit: str
    meaning: str
    values: np.ndarray
    role: str = ""
    labels: list = field(default_factory=list)
    event: bool = False  # of one's own: it happens, or not

    def label(self) -> str:
        """For an axis: "range / km", "echo level / dB re 1 µPa"."""
        words, unit = self.words(), "km" if self.scale() != 1.0 else self.unit
        return f"{words} / {unit}" if unit and unit != "1" else words

    def words(self) -> str:
        """Its name as words; of a setting of a thing, with the thing: "target depth"."""
        words = spoken(self.name)
        told = re.match(r"(target|transmitter|array|platform)\.(?:\d+\.)?(\w+):", self.meaning)
        return f"{told[1]} {words}" if told and told[2] == self.name else words

    def is_depth(self) -> bool:
        """Whether it grows downwards."""
        return self.unit == "m" and "depth" in self.name.split("_")

    def is_constant(self) -> bool:
        """Whether there is nothing to see in it."""
        good = self.values[np.isfinite(self.values)]
        return good.size == 0 or bool(np.all(good == good[0]))

    def scale(self) -> float:
        """Of the values in a picture: metres that are many are drawn as kilometres."""
        good = np.abs(self.values[np.isfinite(self.values)])
        return 1e-3 if self.unit == "m" and good.max(initial=0.0) >= 1e4 else 1.0


@dataclass
class SummaryTable:
    name: str
    title: str
    columns: list
    method: str = ""       # of its intervals

    def __contains__(self, name) -> bool:
        return any(c.name == name for c in self.columns)

    def __getitem__(self, name) -> Column:
        return next(c for c in self.columns if c.name == name)


@dataclass
class Law:
    """What a column of an input was drawn by (`laws` in the file)."""

    value: np.ndarray
    cumulative: np.ndarray
    probability: np.ndarray | None  # of single values; none where there is a density

    def expected(self, edges) -> np.ndarray:
        """Shares between edges."""
        if self.probability is not None:
            return np.histogram(self.value, edges, weights=self.probability)[0]
        return np.diff(np.interp(edges, self.value, self.cumulative, left=0.0, right=1.0))


@dataclass
class Study:
    path: str
    title: str
    realisations: int
    complete: bool
    columns: list          # of the table: inputs and measures, valid rows alone
    summary: list          # of SummaryTable
    skipped: int = 0       # realisations that made no scenario
    confidence: float = np.nan          # of every interval
    false_alarms: float | None = None   # probability that the threshold is made for
    tags: dict = field(default_factory=dict)
    laws: dict = field(default_factory=dict)  # of Law, by column
    weights: np.ndarray | None = None  # of the rows; none where they are drawn from the inputs' laws
    left_out: str = ""     # which tables are not made, and why

    @property
    def interval(self) -> str:
        """What a band is: "95 % confidence"."""
        if not np.isfinite(self.confidence):
            return "confidence interval"
        return f"{100.0 * self.confidence:.6g} % confidence"

    def heading(self) -> str:
        notes = [f"{self.skipped} skipped"] if self.skipped else []
        notes += [] if self.complete else ["not complete"]
        notes += ["drawn from a proposal, with weights"] if self.weights is not None else []
        some = f" ({', '.join(notes)})" if notes else ""
        many = "realisation" if self.realisations == 1 else "realisations"
        return f"{self.title or self.path} · {self.realisations} {many}{some}"

    def tables(self, test) -> list:
        return [t for t in self.summary if test(t)]


def _words(dataset) -> str:
    """A dataset that is a text."""
    value = dataset[()]
    return _text(value.item() if isinstance(value, np.ndarray) and value.size == 1 else value)


def _false_alarms(f) -> float | None:
    """That measure.detection of the study asks for, if it says so."""
    words = _words(f["study"]) if "study" in f else ""
    found = re.search(r"false_alarm_probability\s*=\s*([0-9.eE+_-]+)", words)
    try:
        return float(found[1].replace("_", "")) if found else None
    except ValueError:
        return None


def _text(value) -> str:
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value)


def _column(name, dataset, rows=slice(None)) -> Column:
    attributes = dataset.attrs
    labels = [_text(label) for label in np.ravel(attributes.get("labels", []))]
    unit = " re ".join(_text(attributes[key]) for key in ("units", "reference") if key in attributes)
    return Column(name, unit, _text(attributes.get("long_name", name)),
                  np.asarray(dataset[()], float)[rows], _text(attributes.get("role", "")), labels,
                  bool(np.ravel(attributes.get("event", 0))[0]))


def _summary(name, group) -> SummaryTable:
    order = [_text(n) for n in np.ravel(group.attrs.get("columns", sorted(group)))]
    return SummaryTable(name, _text(group.attrs.get("title", name)),
                        [_column(n, group[n]) for n in order],
                        _text(group.attrs.get("intervals", "")))


def _laws(f) -> dict:
    """Of all rows; files before version 1.4 have none."""
    laws = {}
    for name, group in f.get("laws", {}).items():
        if "value" in group:
            probability = np.asarray(group["probability"][()]) if "probability" in group else None
            laws[name] = Law(np.asarray(group["value"][()]), np.asarray(group["cumulative"][()]),
                             probability)
    return laws


def _order(f) -> list:
    """Names of the table's columns as the study has them: HDF5 lists them by the alphabet."""
    there = list(f["table"])
    told = json.loads(_words(f["manifest"])) if "manifest" in f else {}
    order = [c["name"] for c in told.get("columns", []) if c["name"] in there]
    return order + [name for name in there if name not in order]


def read(path) -> Study:
    """Of a file, or a dataset of one. \\throws InputError"""
    opened, path = path, source.name_of(path)
    try:
        with (source.of_dataset(opened) if source.is_dataset(opened)
              else h5py.File(path, "r")) as f:
            version = _text(f.attrs.get("version", "none"))
            if version.split(".")[0] != "1":
                raise InputError(path, f"version {version} of the format", "version 1")
            valid = np.asarray(f["valid"][()]) != 0
            if np.any(np.asarray(f["index"][()]) < 0):
                raise InputError(path, "rows of a part that is not there",
                                 "all parts where the catalogue knows them")
            if not valid.any():
                raise InputError(path, f"{valid.size} realisations, and none of them valid",
                                 "at least one that is: let the study go on")
            columns = [_column(n, f["table"][n], valid) for n in _order(f)]
            weights = next((np.exp(c.values) for c in columns if c.name == "log_weight" and c.role == "weight"), None)
            columns = [c for c in columns if c.role != "weight"]
            summary = [_summary(n, g) for n, g in f["summary"].items()]
            return Study(path, _text(f.attrs.get("title", "")), int(valid.size),
                         bool(f.attrs.get("complete", 1)), columns, summary,
                         int(np.sum(~valid)),
                         float(np.ravel(f["summary"].attrs.get("confidence", np.nan))[0]),
                         _false_alarms(f),
                         dict(title=_text(f.attrs.get("title", "")),
                              version=_text(f.attrs.get("program_version", "")),
                              digest=_text(f.attrs.get("identity", ""))),
                         _laws(f), weights, _text(f["summary"].attrs.get("left_out", "")))
    except (KeyError, OSError, ValueError) as error:
        raise InputError(path, f"what cannot be read ({error})",
                         "a whole file of `asdic study` or `asdic merge`") from error

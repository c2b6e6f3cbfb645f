"""Monte Carlo studies, with measures of one's own."""
from __future__ import annotations

import hashlib
import os
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Callable

from . import _core, datasets, described
from .scenario import Scenario, _text
from .told import tell

if TYPE_CHECKING:
    import pandas as pd


@dataclass
class Measure:
    """A measure of one's own: one more column of the study's table.

    Attributes
    ----------
    of : callable
        What is measured: called with the ping's dataset (as :meth:`Scenario.ping` gives it), from
        several threads in turn; returns a number, NaN where there is none. What it raises ends the
        study.
    unit, meaning : str
    version : str
        Rows of another version are not taken over. By default the function's own code tells it;
        what that code calls is not looked at.
    samples : bool
        False: levels and echoes are enough, which are had much faster.
    """

    of: Callable[..., float]
    unit: str = ""
    meaning: str = ""
    version: str = ""
    samples: bool = True

    def _version(self) -> str:
        if self.version:
            return self.version
        code = getattr(self.of, "__code__", None)
        if code is None:
            return type(self.of).__name__
        consts = [c for c in code.co_consts if not hasattr(c, "co_code")]
        return hashlib.sha256(repr((code.co_code, consts, code.co_names)).encode()).hexdigest()[:16]


@dataclass
class StudyResult:
    """The table of a study.

    Attributes
    ----------
    table : pandas.DataFrame
        A row a realisation: what varied, then what was measured.
    units : dict
    question, value, low, high
        What the study answers first ("pd"; "" for nothing), and its confidence interval.
    complete : bool
    warnings : list of str
    """

    table: pd.DataFrame
    units: dict[str, str]
    question: str
    value: float
    low: float
    high: float
    complete: bool
    warnings: list[str] = field(default_factory=list)


def _shown(found: dict) -> StudyResult:
    import pandas as pd

    return StudyResult(pd.DataFrame(found["columns"]),
                       dict(zip(found["columns"], found["units"])), found["question"],
                       found["value"], found["low"], found["high"], found["complete"],
                       found["warnings"])


def study(source, output=None, *, measures: Mapping | None = None, set: Mapping | None = None,
          realisations: int | None = None, vary: Mapping | None = None,
          measure=None, summary: Mapping | None = None, fresh: bool = False,
          until=None, progress=None) -> StudyResult:
    """Runs a study into a file, in parallel. Rows that are there are not made again, so one that was
    stopped (Ctrl-C) goes on.

    Parameters
    ----------
    source : path or Scenario
        A study file (docs/formats/study.md), or the scenario of a study that the next parameters
        tell of.
    output : path, optional
        The file of its rows (HDF5). Without one the rows are in the result alone, and a study that
        is stopped is lost.
    measures : mapping, optional
        {name of the column: function of a ping's dataset, or Measure}.
    set : mapping, optional
        Settings to replace, by their path, ``{"study.realisations": 1000}``.
    realisations, vary, measure, summary : optional
        Of a Scenario: how many; [vary], ``
        ``{"target.0.range": {"law": "uniform", "low": 5e3, "high": 20e3}}``; names of
        measures, or [measure]; [summary].
    fresh : bool
        Begins anew, whatever rows are there.
    until : float, str, callable, or a list of these, optional
        Ends before the last row: a half-width, ``"pd_by_range=0.1"`` or ``"pd: low > 0.9"``, as
        ``--until`` takes them; or a function of the table so far (a pandas.DataFrame), True when its
        rows are enough. Of several all must hold. They are asked after 100, 200, … 1000, 2000, …
        rows; each time is a chance to stop by luck.

    Raises InputError; what a measure raised.
    """
    changes = [f"{key}={_text(value)}" for key, value in (set or {}).items()]
    own = []
    for name, one in (measures or {}).items():
        one = one if isinstance(one, Measure) else Measure(one)
        own.append({"name": name, "unit": one.unit, "meaning": one.meaning,
                    "version": one._version(), "samples": one.samples, "of": _called(one.of)})

    asked_for = until if isinstance(until, (list, tuple)) else [] if until is None else [until]
    words = [str(one) for one in asked_for if not callable(one)]
    rules = [one for one in asked_for if callable(one)]

    def enough(found: dict) -> bool:
        import pandas as pd

        rows = pd.DataFrame(found["columns"])
        return all(bool(rule(rows)) for rule in rules)

    def run(file) -> StudyResult:
        with tempfile.TemporaryDirectory() as folder:
            rows = os.path.join(folder, "study.h5") if output is None else os.fspath(output)
            found = _shown(_core.study(os.fspath(file), rows, changes, own, fresh, words,
                                       enough if rules else None, progress))
        tell(found.warnings)
        return found

    if not isinstance(source, Scenario):
        return run(source)
    if realisations is None:
        raise described.made("realisations", "nothing", "how many")
    asked = measure if isinstance(measure, Mapping) else \
        {name: True for name in ([measure] if isinstance(measure, str) else measure or ["paths"])}
    with tempfile.TemporaryDirectory() as folder:
        scenario, plan = os.path.join(folder, "scenario.toml"), os.path.join(folder, "study.toml")
        source.save(scenario)
        core = _core.Scenario()
        core.set("study", {"scenario": "scenario.toml", "realisations": int(realisations)})
        core.set("vary", {})
        core.set("measure", asked)
        if summary:
            core.set("summary", dict(summary))
        text = core.to_toml()
        # keys of [vary] have dots
        lines = "".join(f'"{key}" = {_core.toml(_law(key, value))}\n' for key, value in (vary or {}).items())
        with open(plan, "x", encoding="utf-8") as to:
            to.write(text.replace("[vary]\n", "[vary]\n" + lines) if "[vary]\n" in text
                     else text + "\n[vary]\n" + lines)
        return run(plan)


def _law(key: str, law):
    """A law of [vary], its arrays in the unit of the setting that varies."""
    choices = described.settings().get(described.place_of(key), [])
    unit = choices[0].unit if choices else ""
    return law if not isinstance(law, Mapping) else {
        name: described.numbers(f"vary.{key}.{name}", value, unit).tolist() if described.unit_of(value) else value
        for name, value in law.items()}


def _called(function):
    def of(handle) -> float:
        scenario = Scenario._of_core(handle.scenario)
        return float(function(datasets.ping(scenario, handle)))
    return of


def to_parquet(file, output, *, rows: int = 1 << 17) -> int:
    """Writes the table of a study's file as Parquet, for tools that read columns (Arrow, Polars,
    DuckDB, Spark). Needs pyarrow and h5py.

    Columns are ``index``, ``valid``, then what varied and what was measured, as in the file.
    Labels are texts (a dictionary). Unit, meaning and role of a column are metadata of its field
    (``unit``, ``meaning``, ``role``), title, identity and seed of the study those of the table.
    It is read and written in blocks, one row group each: memory does not grow with the rows.

    Parameters
    ----------
    file : path
        Of `asdic study` or `asdic merge`.
    output : path
        Must not be there.
    rows : int
        Of a row group.

    Returns how many rows were written. Raises InputError, OSError; ModuleNotFoundError without
    pyarrow.
    """
    from .parquet import write

    return write(os.fspath(file), os.fspath(output), rows)


def read_study(file) -> StudyResult:
    """The table of a study's file."""
    return _shown(_core.read_study(os.fspath(file)))

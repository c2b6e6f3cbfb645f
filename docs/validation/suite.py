"""What the problems of docs/validation share: running asdic, reading its files, and the shape of a
verdict.

Nothing here computes a truth; those are in each problem's truth.py, truth_waves.py and
truth_energy.py.
"""
from __future__ import annotations

import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import Callable, Sequence

import h5py
import numpy as np

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[1] / "python")]

MICROPASCAL = 1e-6
TIME_LIMIT = 600  # of one run of asdic [s]


@dataclass
class Check:
    """One number that asdic and the truth agree on within a bound, or do not."""

    what: str               # what was compared, in words
    error: float            # the largest, or whatever `what` says
    bound: float            # |error| may be at most this
    unit: str = "dB"
    gap: str = ""           # why it is known not to hold yet; the bound stays what should hold

    @property
    def holds(self) -> bool:
        return bool(abs(self.error) <= self.bound)     # False for NaN

    @property
    def verdict(self) -> str:
        if self.gap:
            return "HOLDS NOW" if self.holds else "gap"
        return "pass" if self.holds else "FAIL"


@dataclass
class Result:
    """What a problem's compare() returns: verdicts, the page's table, and how to draw its
    picture."""

    checks: list[Check]
    header: Sequence[str]
    rows: list[Sequence]
    draw: Callable          # draw(axes): curves, labels, legend
    notes: list[str] = field(default_factory=list)


class Failed(Exception):
    """asdic could not do it; the text is what it said."""


@dataclass
class Field:
    """A field file: pressure re 1 m, [depth, range], time dependence exp(+iωt)."""

    depth: np.ndarray
    range: np.ndarray
    pressure: np.ndarray


class Asdic:
    """The program under test; its files go to one folder."""

    def __init__(self, program: str, out: Path, threads: int = 1):
        self.program, self.out, self.threads = str(program), Path(out), threads
        self.out.mkdir(parents=True, exist_ok=True)
        self.said = ""      # on standard error, by the last run

    def run(self, command: str, scenario: Path, *options: str) -> Path:
        """→ the file written. Raises Failed."""
        file = self.out / f"{Path(scenario).parent.name}-{command}.h5"
        words = [self.program, command, str(scenario), "--force", "-o", str(file), *options]
        if command in ("field", "ping"):        # the others have no such option
            words += ["--threads", str(self.threads)]
        try:
            done = subprocess.run(words, capture_output=True, text=True, timeout=TIME_LIMIT,
                                  check=False)
        except subprocess.TimeoutExpired as late:
            raise Failed(f"asdic {command} {scenario}: not done after {TIME_LIMIT} s") from late
        if done.returncode != 0:
            raise Failed(f"asdic {command} {scenario}: exit {done.returncode}: {done.stderr.strip()}")
        self.said = done.stderr
        return file

    def field(self, scenario: Path, **settings) -> Field:
        with h5py.File(self.run("field", scenario, *overrides(settings))) as file:
            p = file["pressure"][0].astype(float)
            return Field(file["depth"][:], file["range"][:], p[..., 0] + 1j * p[..., 1])

    def ping(self, scenario: Path, **settings) -> Path:
        return self.run("ping", scenario, *overrides(settings))


def overrides(settings: dict) -> list[str]:
    """{"run__frequency": 500.0} → ["--set", "run.frequency=500.0"]"""
    return [word for key, value in settings.items()
            for word in ("--set", f"{key.replace('__', '.')}={value}")]


def db(intensity):
    """10 lg, with a floor far below anything that is compared."""
    return 10.0 * np.log10(np.maximum(intensity, 1e-40))


def loss(pressure):
    """Transmission loss [dB re 1 m] of a complex pressure."""
    return -db(np.abs(pressure) ** 2)


def mean_square(path: Path):
    """Mean square pressure of a ping file over pings and phones. → times [s], level re 1 µPa² (a
    power, not dB)"""
    with h5py.File(path) as file:
        data = file["pressure"]
        x = data[:].astype(float)
        start, rate = float(data.attrs["time_start"]), float(data.attrs["sample_rate_hz"])
    power = (x[..., 0] ** 2 + x[..., 1] ** 2) / 2.0 if x.ndim == 4 else x**2
    power = power.mean(axis=(0, 1)) / MICROPASCAL**2
    return start + np.arange(len(power)) / rate, power


def window_levels(t, power, centres, width):
    """Mean level [dB] over windows of `width` about each of `centres`; the unit is that of t."""
    return np.array([db(power[np.abs(t - c) < width / 2].mean()) for c in centres])


def percentile(errors, share=95.0) -> float:
    return float(np.percentile(np.abs(errors), share))


def chance(pulse, pings, width=1.0) -> float:
    """One standard error of the level [dB] of a mean over `width` s and so many pings: intensity of
    Rayleigh noise of a Hann pulse of `pulse` s, whose
    samples are independent every ∫ρ² dτ = 0.5255 of a pulse (ρ the pulse's own correlation).
    """
    return 10.0 / np.log(10.0) * np.sqrt(0.5255 * pulse / (width * pings))


@dataclass
class Reverberation:
    """One way of running a reverberation scenario: what it is called, its settings, when it is
    listened to, and why it is known to fail."""

    label: str
    settings: dict
    times: np.ndarray       # after the start of transmission [s]
    pings: int              # averaged over
    gap: str = ""


DEFAULT_BOUNCES = Reverberation("default bounces", {},
                                np.array([3.0, 4.0, 6.0, 8.0, 10.0, 14.0, 18.0]), 24)
TWENTY_BOUNCES = Reverberation("20 bounces", {"propagation__max_bottom_bounces": 20,
                                              "propagation__max_surface_bounces": 20,
                                              "pings__recording_duration": 6.6},
                               np.array([3.0, 4.0, 5.0, 6.0]), 16)


def compare_reverberation(asdic, scenario, exact, runs, pulse, width=1.0, bound=0.5,
                          truth_name="truth"):
    """Window means of simulated reverberation against `exact(times)` [dB re 1 µPa²], worst time of
    each run. The bound is `bound` beside three standard
    errors of the average. → Result"""
    checks, columns, notes = [], {}, []
    every = np.unique(np.concatenate([run.times for run in runs]))
    truth = dict(zip(every, exact(every)))
    for run in runs:
        sigma = chance(pulse, run.pings, width)
        levels = window_levels(*mean_square(asdic.ping(scenario, pings__count=run.pings,
                                                       **run.settings)), run.times, width)
        off = levels - np.array([truth[t] for t in run.times])
        checks.append(Check(f"{run.label}, worst of {len(off)} times", float(max(off, key=abs)),
                            round(bound + 3 * sigma, 2), gap=run.gap))
        columns[run.label] = dict(zip(run.times, levels))
        notes.append(f"{run.label[0].upper()}{run.label[1:]}: means over {width:g} s and {run.pings} "
                     f"pings, one standard error {sigma:.2f} dB; the bound is {bound:g} dB and three "
                     "of them.")
    rows = [[f"{t:g}", f"{truth[t]:.2f}",
             *(text for found in columns.values() for text in ((f"{found[t]:.2f}",
                 f"{found[t] - truth[t]:+.2f}") if t in found else ("", "")))] for t in every]

    def draw(axes, style):
        axes.plot(every, [truth[t] for t in every], color=style.INK, lw=2.2, label=truth_name)
        for (label, found), colour in zip(columns.items(),
                                          (style.VERMILION, style.BLUE, style.GREEN)):
            axes.plot(list(found), list(found.values()), "o--", color=colour, lw=1.0, ms=4,
                      label=f"asdic, {label}")
        axes.set(xlabel="time after the start of transmission / s", ylabel="level / dB re 1 µPa²")
        axes.legend()

    header = ["t / s", "truth / dB", *(word for label in columns
                                       for word in (f"{label} / dB", "difference / dB"))]
    return Result(checks, header, rows, draw, notes)

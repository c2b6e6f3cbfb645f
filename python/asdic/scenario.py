"""The scenario as an object: its settings are its attributes, its methods compute."""
from __future__ import annotations

import json
import os
import queue
import threading
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, Self, overload

import numpy as np

from . import _core, datasets, described, oceans
from .channel import Channel
from .described import settings  # noqa: F401  asdic.settings
from .told import tell

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr


def _value_of_default(text: str):
    """A default as the description tells it, TOML."""
    try:
        return json.loads(text)
    except ValueError:
        return tomllib.loads(f"x = {text}")["x"]


class _Table:
    """A table of a scenario: its settings are attributes.

    What was not set is what holds without it; a setting without a default is None.
    """

    __slots__ = ("_core", "_path", "_place")

    def __init__(self, core, path: str, place: str):
        object.__setattr__(self, "_core", core)
        object.__setattr__(self, "_path", path)    # as of --set: "target.0"
        object.__setattr__(self, "_place", place)  # as described: "target[]"

    # ------------------------------------------------------------ names

    def _of(self, name: str) -> tuple[str, str]:
        """(path, place) of a key. → also "targets" for the list "target" """
        before, within = (f"{self._path}." if self._path else ""), \
            (f"{self._place}." if self._place else "")
        for key in (name, name[:-1] if name.endswith("s") else name):
            if within + key in described.settings() or within + key in described.tables():
                return before + key, within + key
        raise described.unknown(self._place, name)

    def _get(self, path):
        return self._core.get(path) if path and self._core.has(path) else None

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            path, place = self._of(name)
        except described.InputError as error:
            raise AttributeError(str(error)) from None
        there = self._get(path)
        if place in described.tables() and not (there is not None
                                                and not isinstance(there, (dict, list))):
            if described.is_list(place):
                return _List(self._core, path, place)
            return _Table(self._core, path, place)
        choices = described.settings().get(place, [])
        if there is not None:
            return described.measured(choices, there)
        if choices and choices[0].standard:
            return _value_of_default(choices[0].standard)
        return None

    def __setattr__(self, name: str, value) -> None:
        path, place = self._of(name)
        if value is None:
            self._core.erase(path)
            return
        self._core.set(path, oceans.setting(path, place, value))

    def __delattr__(self, name: str) -> None:
        self._core.erase(self._of(name)[0])

    def __dir__(self):
        names = {name for name in dir(type(self)) if not name.startswith("_")}
        for key in described.keys_of(self._place):
            place = f"{self._place}.{key}" if self._place else key
            several = described.is_list(place) and not key.endswith("s")
            names.add(key + "s" if several else key)
        return sorted(names)

    # ------------------------------------------------------------ what it says

    def help(self, name: str | None = None) -> str:
        """What a setting means, its unit, range and default; without a name all of the table's."""
        if name is None:
            return described.Text("\n".join(self.help(key) for key in described.keys_of(self._place)))
        place = self._of(name)[1]
        if place in described.settings():
            return described.Text("\n".join(one.doc for one in described.settings()[place]))
        return described.Text(f"{place}: {described.tables()[place]['help']}")

    def to_dict(self) -> dict:
        """What was set, without defaults."""
        return self._get(self._path) or {}

    def __repr__(self) -> str:
        return f"<{self._path or 'scenario'} {self.to_dict()}>"


class _List(Sequence):
    """Tables of one kind: `s.targets[0].depth = 200`. [table] alone is a list of one."""

    __slots__ = ("_core", "_path", "_place")

    def __init__(self, core, path: str, place: str):
        self._core, self._path, self._place = core, path, place

    def _there(self):
        return self._core.get(self._path) if self._core.has(self._path) else []

    def __len__(self) -> int:
        there = self._there()
        return 1 if isinstance(there, dict) else len(there)

    def __getitem__(self, index) -> Any:
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        count = len(self)
        number = index + count if index < 0 else index
        if not 0 <= number < count:
            raise IndexError(f"{self._path}[{index}]: there are {count}")
        single = isinstance(self._there(), dict)
        described_as = self._place + "[]"
        known = any(path.startswith(described_as + ".") for path in described.settings())
        return _Table(self._core, self._path if single else f"{self._path}.{number}",
                      described_as if known else self._place)

    def __getattr__(self, name: str) -> Any:
        """Of the only one: `s.transmitter.source_level_db`."""
        if name.startswith("_"):
            raise AttributeError(name)
        if len(self) > 1:
            raise AttributeError(f"{self._path}: there are {len(self)}; write {self._path}[0].{name}")
        return getattr(self[0] if len(self) else _Table(self._core, self._path, self._place), name)

    def __setattr__(self, name: str, value) -> None:
        if name in _List.__slots__:
            object.__setattr__(self, name, value)
            return
        if len(self) > 1:
            raise AttributeError(f"{self._path}: there are {len(self)}; write {self._path}[0].{name}")
        setattr(self[0] if len(self) else _Table(self._core, self._path, self._place), name, value)

    def __dir__(self):
        own = [name for name in dir(type(self)) if not name.startswith("_")]
        return sorted({*own, *dir(_Table(self._core, "", self._place + "[]"))})

    def append(self, table: Mapping | None = None, **settings) -> None:
        """One more, of a dictionary or of keywords."""
        made = described.taken(f"{self._path}.{len(self)}", self._place, {**(table or {}), **settings})
        there = self._there()
        if isinstance(there, dict):
            self._core.set(self._path, [there])
        self._core.add(self._path, made)

    def clear(self) -> None:
        self._core.erase(self._path)

    def __repr__(self) -> str:
        return f"<{len(self)} × {self._path}>"


class _Pings(_Table):
    """[pings], and the pings themselves: ``s.pings.count = 4``, ``for ping in s.pings(): …``"""

    __slots__ = ("_scenario",)

    def __call__(self, ahead: int = 2) -> Iterator[xr.Dataset]:
        """All pings in order, each as :meth:`Scenario.ping` gives it; the next ones are computed
        meanwhile.

        `ahead`: how many may wait. Who leaves the loop stops the work.
        """
        return _computed_ahead(self._scenario, ahead)


class _Run(_Table):
    """[run], and what it asks for: ``s.run.frequency = 50``, ``s.run()``"""

    __slots__ = ("_scenario",)

    def __call__(self, progress=None) -> xr.Dataset:
        """A field, arrivals or rays. → xarray.Dataset as :func:`asdic.open` gives it"""
        from .files import run
        return run(self._scenario, progress)


class Scenario(_Table):
    """A scenario: everything that a simulation needs.

    Attributes are the settings: ``s.pulse.duration``, ``s.targets[0].depth = 200``. ``dir(s.pulse)``
    lists them, ``s.pulse.help("duration")`` explains one.

    Parameters
    ----------
    file : path, optional
        A scenario file (TOML, docs/formats/scenario.md).
    set : mapping, optional
        Settings to replace, by their path: ``{"target.0.depth": 200, "pulse.duration": "0.2s"}``.
    sound_speed : optional
        A number [m/s]; pairs (depth, speed), [n, 2]; a pandas Series over depth, or a DataFrame with
        columns depth and speed, or depth, temperature and salinity; an xarray DataArray over depth,
        or over range and depth; a dictionary of the file's own keys.
    bathymetry : optional
        A depth [m]; pairs (range, depth), [n, 2]; a Series, DataFrame or DataArray over range.
        Where these give units (``attrs["units"]``), they are converted.
    bottom : mapping, optional
        What lies below, ``{"kind": "rigid"}``. A bathymetry without it lies on medium sand:
        ``{"kind": "grain-size", "grain_size": 1.5}``.
    **sections
        Everything else by its name in the file: ``pulse={"kind": "cw", ...}``, ``targets=[{...}]``.

    Raises
    ------
    InputError
        With file, line, key, found, expected. Values are checked in full by :meth:`validate` and by
        the first method that computes.
    """

    __slots__ = ()

    def __init__(self, file=None, *, set: Mapping | None = None, sound_speed=None, bathymetry=None,
                 bottom: Mapping | None = None, **sections):
        changes = {key: described.taken(key, described.place_of(key), value)
                   for key, value in (set or {}).items()}
        if file is None:
            core = _core.Scenario()
        else:
            core = _core.Scenario.read(os.fspath(file),
                                       [f"{key}={_text(value)}" for key, value in changes.items()])
        super().__init__(core, "", "")
        if sound_speed is not None:
            core.set("environment.sound_speed", oceans.sound_speed(sound_speed))
        if bathymetry is not None:
            for key, value in oceans.bathymetry(bathymetry).items():
                core.set(f"environment.bottom.{key}", value)
        for key, value in (bottom or {}).items():
            place = f"environment.bottom.{key}"
            core.set(place, oceans.setting(place, place, value))
        if bathymetry is not None and not core.has("environment.bottom.kind"):
            for key, value in oceans.SAND.items():
                core.set(f"environment.bottom.{key}", value)
        self._take(sections)
        if file is None:
            for key, value in changes.items():
                core.set(key, value)

    def _take(self, sections: Mapping) -> None:
        """Sections by their names; a table is put into one that is there."""
        for name, value in sections.items():
            path, place = self._of(name)
            value = oceans.setting(path, place, value)
            if isinstance(value, Mapping) and isinstance(self._get(path), dict):
                for key, inner in value.items():
                    self._core.set(f"{path}.{key}", inner)
            else:
                self._core.set(path, value)

    @classmethod
    def parse(cls, text: str, name="scenario.toml") -> Scenario:
        """Of a text in TOML. Files that it names lie in the folder of `name`."""
        return cls._of_core(_core.Scenario.parse(text, os.fspath(name)))

    @classmethod
    def _of_core(cls, core) -> Self:
        made = cls.__new__(cls)
        _Table.__init__(made, core, "", "")
        return made

    def to_dict(self) -> dict:
        """What was set, without defaults, by the keys of the file."""
        return {key: self._core.get(key) for key in described.keys_of("") if self._core.has(key)}

    def copy(self) -> Self:
        """Another one. The ocean and the paths that were found are shared until one is changed."""
        made = self._of_core(self._core.copy())
        own: tuple[str, ...] = type(self).__slots__
        for name in own:  # notes of what it was read from
            object.__setattr__(made, name, getattr(self, name))
        return made

    def __copy__(self):
        return self.copy()

    def __deepcopy__(self, memo):
        return self.copy()

    def __reduce__(self):
        own: tuple[str, ...] = type(self).__slots__
        return _restored, (type(self), self.to_toml(), os.path.abspath(self._core.path()),
                           {name: getattr(self, name) for name in own})

    def set(self, path: str, value) -> Scenario:
        """Sets what stands at a path, ``"target.0.depth"``. → self"""
        if value is None:
            self._core.erase(path)
        else:
            self._core.set(path, oceans.setting(path, described.place_of(path), value))
        return self

    def get(self, path: str):
        """What stands at a path: what was read or set, no defaults. Raises InputError for nothing."""
        return self._core.get(path)

    def to_toml(self) -> str:
        """As a scenario file."""
        return self._core.to_toml()

    def save(self, file) -> None:
        """Writes it as a new scenario file. Raises FileExistsError: nothing is written over."""
        with open(file, "x", encoding="utf-8") as to:
            to.write(self.to_toml())

    def validate(self, progress=None) -> list[str]:
        """Checks everything, as ``asdic validate``. → warnings: what to know before trusting a number.

        Of an ocean alone, without a sonar and a [run], that ocean. Raises InputError at the first fault.
        """
        if self._core.has("environment") and not any(
                self._core.has(name) for name in ("platform", "run", "pulse", "transmitter", "array")):
            return self._with_run(frequency=1000.0, source_depth=0.0, depths=[0.0],
                                  ranges=[1.0])._core.validate(progress)
        return self._core.validate(progress)

    @property
    def warnings(self) -> list[str]:
        """Of these warnings those that are known by now: of reading it, and after a ping all."""
        return self._core.warnings()

    def _repr_html_(self) -> str:
        from . import drawing
        return drawing.html(self)

    def __repr__(self) -> str:
        return f"<asdic.Scenario {self.title!r}>" if self.title else "<asdic.Scenario>"

    def __str__(self) -> str:
        return self.to_toml()

    def __getattr__(self, name: str) -> Any:
        made = super().__getattr__(name)
        kind = {"pings": _Pings, "run": _Run}.get(name)
        if kind is not None:
            made = kind(self._core, name, name)
            object.__setattr__(made, "_scenario", self)
        return made

    # ------------------------------------------------------------ paths

    @overload
    def arrivals(self, *, range: float | None = None, depth: float | None = None,
                 source_depth: float | None = None, bearing_deg: float | None = None,
                 frequency: float | None = None, ping: int = 1,
                 arrays: Literal[False] = False) -> pd.DataFrame: ...
    @overload
    def arrivals(self, *, range: float, depth: float, source_depth: float | None = None,
                 bearing_deg: float | None = None, frequency: float | None = None, ping: int = 1,
                 arrays: Literal[True]) -> _core.Arrivals: ...
    @overload
    def arrivals(self, *, ping: int = 1,
                 arrays: Literal[True]) -> tuple[_core.Arrivals, dict[str, np.ndarray]]: ...

    def arrivals(self, *, range=None, depth=None, source_depth=None, bearing_deg=None,
                 frequency=None, ping=1, arrays=False):
        """Eigenrays: of a ping to the targets and back, or to any receiver.

        Parameters
        ----------
        range, depth : float, optional
            A receiver: horizontal distance from the source and depth [m]. Without them, the legs of
            ping number `ping`: to every target and from there to every array.
        source_depth : float, optional
            [m]; the transmitter's.
        bearing_deg : float, optional
            True; along the transect, or north.
        frequency : float, optional
            At which losses are told [Hz]; the pulse's centre.
        arrays : bool
            NumPy arrays, one a quantity, without pandas.

        Returns
        -------
        pandas.DataFrame
            A row a path, sorted by delay [s]; ``amplitude`` is complex, re 1 m; ``bounce_range`` [m],
            ``bounce_grazing_deg`` and ``bounce_bottom`` hold an array each. Of legs also leg (0 to
            the target, 1 to the array), target, array, path, bearing_deg, range, and latitude and
            longitude of the leg's end [degrees] where the map's place on the Earth is known.
        Arrivals
            With `arrays`: the same as attributes. Of legs also a dictionary of what is of them.
        """
        if (range is None) != (depth is None):
            raise described.made("depth" if depth is None else "range", "nothing",
                                 "range and depth, which go together")
        ping = described.whole("ping", ping)
        if range is None:
            columns, legs = _core.legs(self._core, ping)
            tell(self._core.warnings())
            return (columns, legs) if arrays else \
                datasets.arrivals(columns, legs, warnings=self.warnings)
        range, depth = described.number("range", range, "m"), described.number("depth", depth, "m")
        source_depth = described.number("source_depth", source_depth, "m", True)
        frequency = described.number("frequency", frequency, "Hz", True)
        bearing_deg = described.number("bearing_deg", bearing_deg, "degrees", True)
        core = self._core
        if not core.has("platform") and not core.has("run"):
            core = self._with_run(frequency=frequency, source_depth=source_depth, depths=[depth],
                                  ranges=[range])._core
        found = _core.arrivals(core, range, depth, source_depth, bearing_deg, frequency, ping)
        told = core.warnings()
        tell(told)
        return found if arrays else datasets.arrivals(found, warnings=told)

    def rays(self, *, lowest_deg=-20.0, highest_deg=20.0, count=41, elevations_deg=(), range=50e3,
             source_depth=None, bounces=100) -> pd.DataFrame:
        """Rays as lines, with a point at every bounce and turning point.

        Parameters: launch elevations, positive up, evenly spaced or `elevations_deg` exactly [deg];
        `range` how far [m]; `source_depth` [m], the platform's; a ray ends after `bounces`.

        Returns a pandas.DataFrame, a row a ray: launch_elevation_deg, final_elevation_deg,
        path_length [m], surface_bounces, bottom_bounces, turns, and the arrays range, depth [m] and
        time [s]; over an area or along a transect whose place on the Earth is known, also latitude
        and longitude [degrees].
        """
        range = described.number("range", range, "m")
        source_depth = described.number("source_depth", source_depth, "m", True)
        core = self._core
        if not core.has("platform") and not core.has("run"):
            core = self._with_run(frequency=1000.0, source_depth=source_depth, depths=[0.0],
                                  ranges=[range])._core
        elevations = described.numbers("elevations_deg", elevations_deg, "degrees").tolist()
        found = _core.rays(core, lowest_deg, highest_deg, count, elevations, range,
                           source_depth, bounces)
        told = core.warnings()
        tell(told)
        return datasets.rays(found, warnings=told)

    def sound_speed(self, depths, range: float = 0.0) -> xr.DataArray:
        """Sound speed as rays meet it, interpolation and equations in it.

        `depths` [m]; `range` along the transect, from the first platform [m].

        Returns an xarray.DataArray over depth [m/s].
        """
        core = self._core
        if not core.has("platform") and not core.has("run"):
            core = self._with_run(frequency=1000.0, source_depth=0.0, depths=[0.0],
                                  ranges=[1.0])._core
        z = np.atleast_1d(described.numbers("depths", depths, "m"))
        range = described.number("range", range, "m")
        return datasets.profile(z, _core.sound_speed(core, z.tolist(), range))

    def waveform(self, sample_rate: float | None = None, transmitter: int | str = 0) -> xr.DataArray:
        """What a transmitter sends: the replica of a matched filter.

        `sample_rate` [Hz]: that of the record; where it is baseband, of pressure that holds the
        pulse. `transmitter`: number or name.

        Returns an xarray.DataArray over time [s], complex: the analytic signal, 1 at its peak before
        its window. Pressure at 1 m is ``np.sqrt(2) * 1e-6 * 10**(SL / 20) * w.real`` [Pa] with
        ``w.attrs["source_level_db"]``; ``energy_s`` is the integral of its square.
        """
        sample_rate = described.number("sample_rate", sample_rate, "Hz", True)
        return datasets.waveform(_core.waveform(self._core, self._number("transmitter", transmitter),
                                                sample_rate))

    def field(self, *, frequency=None, source_depth=None, depths=None,
              ranges=None) -> xr.DataArray:
        """The pressure field of a source: what [run] asks for, or the arguments.

        Parameters
        ----------
        frequency : float, optional
            [Hz]
        source_depth : float or sequence, optional
            [m]
        depths, ranges : sequence, optional
            Of the receivers [m].

        Returns
        -------
        xarray.DataArray
            Complex pressure re 1 m, e^{+iωt}, (depth, range); with several sources
            (source_depth, depth, range). Transmission loss is ``-20*np.log10(abs(p))``.
            Over an area or along a transect whose place on the Earth is known, ``latitude`` and
            ``longitude`` of the receivers are coordinates [degrees].
            ``attrs["warnings"]`` tells what to know before trusting it.
        """
        scenario = self
        if any(x is not None for x in (frequency, source_depth, depths, ranges)):
            scenario = self._with_run(frequency=frequency, source_depth=source_depth, depths=depths,
                                      ranges=ranges)
        found = _core.field(scenario._core)
        tell(found["warnings"])
        return datasets.field(found)

    def _with_run(self, *, frequency=None, source_depth=None, depths=None, ranges=None) -> Scenario:
        """A copy with a [run] that says so."""
        made = self.copy()
        if frequency is None and not made._core.has("run.frequency") \
                and not made._core.has("platform"):
            raise described.made("frequency", "nothing", "one [Hz]")
        for key, value, unit in (("run.frequency", frequency, "Hz"), ("run.source.depth", source_depth, "m"),
                                 ("run.receivers.depth", depths, "m"),
                                 ("run.receivers.range", ranges, "m")):
            if value is not None:
                made._core.set(key, described.numbers(key, value, unit).tolist())
        if not made._core.has("run.source.depth") and made._core.has("platform"):
            made._core.set("run.source.depth", float(self.platforms[0].position[2]))
        if not made._core.has("run.frequency"):
            made._core.set("run.frequency", float(self._pulse_centre()))
        return made

    def _pulse_centre(self) -> float:
        pulse = self.pulse
        if pulse.frequency is not None:
            return pulse.frequency
        if pulse.start_frequency is None:  # samples
            return self.waveform().attrs["centre_frequency_hz"]
        return 0.5 * (pulse.start_frequency + pulse.end_frequency)

    # ------------------------------------------------------------ pings

    def ping(self, number: int = 1, progress=None) -> xr.Dataset:
        """One ping of the scenario: calibrated pressure at every phone.

        Returns an xarray.Dataset with the names, dimensions and units of the ping file
        (docs/formats/ping.md): ``pressure`` (channel, sample) [Pa], float32, or complex64 where the
        scenario asks for complex baseband, not copied and not to be written to; ``time`` [s];
        ``phone_position`` [m]; the truth as ``echoes.delay`` and so on.

        What to know before trusting a number is warned of (AsdicWarning), and in
        ``attrs["warnings"]``.

        Raises InputError; KeyboardInterrupt by Ctrl-C.
        """
        number = described.whole("number", number)
        pinger = _core.Pinger(self._core, progress)
        tell(pinger.warnings)
        return datasets.ping(self, pinger.ping(number), pinger.warnings)

    def write(self, file, progress=None) -> None:
        """All pings into a ping file, as ``asdic ping``. Nothing that asdic did not write is written over."""
        _core.write_pings(os.fspath(file), self._core, progress)
        tell(self.warnings)

    def channel(self, transmitter=0, array=0, *, duration=None, step=0.1, frequency=None,
                ping=None, held=False) -> Channel:
        """The time-varying impulse response from a transmitter to every phone of an array.

        Parameters
        ----------
        transmitter, array : int or str
            Number or name.
        duration : float, optional
            Of what is sent [s]; the pulse's.
        step : float
            Between times at most [s]; it is finer where delays need it.
        frequency : float, optional
            Of the amplitudes [Hz]; the pulse's centre.
        ping : int, optional
            Time 0 is when this ping is sent, from 1; the transmitter's first.

        held : bool
            Each path keeps the amplitude that it begins with, as in :meth:`ping`; else amplitudes
            change as things move.

        Direct sound with what surface and bottom mirror; no target, no scatterer.
        """
        number, receiver = self._number("transmitter", transmitter), self._number("array", array)
        first = number + 1 if ping is None else described.whole("ping", ping)
        duration = described.number("duration", duration, "s", True)
        step = described.number("step", step, "s")
        frequency = described.number("frequency", frequency, "Hz", True)
        found = Channel(self, (first, receiver, duration, step, frequency, held))
        tell(self.warnings)
        tell(found.warnings)
        return found

    def _number(self, kind: str, asked) -> int:
        if not isinstance(asked, str):
            return int(asked)
        names = [one.name for one in getattr(self, kind)]
        if asked in names:
            return names.index(asked)
        raise described.made(kind, f'"{asked}"', "one of " + ", ".join(f'"{n}"' for n in names))


def _restored(kind, text: str, path: str, own: dict):
    """A scenario out of a pickle. → `kind`"""
    made = kind._of_core(_core.Scenario.parse(text, path))
    for name, value in own.items():
        object.__setattr__(made, name, value)
    return made


def _text(value) -> str:
    """A value as --set takes it."""
    if described.unit_of(value):
        raise described.made("set", f'a value with units of "{described.unit_of(value)}"', "one in the setting's unit")
    return value if isinstance(value, str) else _core.toml(value)


def _computed_ahead(scenario: Scenario, ahead: int) -> Iterator[xr.Dataset]:
    """The pings of a scenario, by a thread of their own."""
    waiting: queue.Queue = queue.Queue(max(1, ahead))
    left = threading.Event()

    class Left(Exception):
        pass

    def put(item) -> None:
        while not left.is_set():
            try:
                waiting.put(item, timeout=0.05)
                return
            except queue.Full:
                continue
        raise Left

    def work() -> None:
        try:
            pinger = _core.Pinger(scenario._core.copy(), None)
            put(pinger.warnings)
            pinger.run(put, None)
            put(None)
        except Left:
            pass
        except BaseException as error:  # told of where the pings are taken
            try:
                put(error)
            except Left:
                pass

    thread = threading.Thread(target=work, name="asdic pings", daemon=True)
    thread.start()
    told: list = []
    try:
        while (item := waiting.get()) is not None:
            if isinstance(item, BaseException):
                raise item
            if isinstance(item, list):
                told = item
                tell(told)
                continue
            yield datasets.ping(scenario, item, told)
    finally:
        left.set()
        thread.join()

"""Reads a ping file (docs/formats/ping.md). Whatever is wrong with it becomes an InputError."""
from __future__ import annotations

import os
from dataclasses import dataclass
from functools import cached_property

import h5py
import numpy as np

from . import signal, source


ENVELOPE_SAMPLES = 2000  # at least: two for every column of a picture


class InputError(Exception):
    """The file is not what it should be: where, what was found, what was expected."""

    def __init__(self, where, found, expected):
        self.words = str(where), str(found), str(expected)
        super().__init__(f"{where}: found {found}, expected {expected}")


@dataclass
class Echo:
    """The path pairs of one target at the array's reference point. [n] each"""

    target: int
    name: str
    delay: np.ndarray          # of the leading edge [s]
    level_db: np.ndarray       # [dB re 1 µPa]
    doppler: np.ndarray        # frequency factor
    direction: np.ndarray      # [n, 3] of travel at the array (east, north, depth)

    @property
    def strongest(self) -> int:
        return int(np.argmax(self.level_db))

    def strong(self, first: float, last: float, within_db: float = 20.0):
        """[n] which pairs are worth a mark: near the strongest in level, between two times [s]"""
        loud = self.level_db >= self.level_db.max() - within_db
        return loud & (self.delay >= first) & (self.delay <= last)


def travel_direction(elevation_deg, bearing_deg):
    """Unit vectors (east, north, depth), [n, 3]. Elevation positive up, bearing from north."""
    e, b = np.radians(elevation_deg), np.radians(bearing_deg)
    return np.stack([np.cos(e) * np.sin(b), np.cos(e) * np.cos(b), -np.sin(e)], axis=-1)


def opened(path):
    """\\throws InputError"""
    expected = "a ping file written by `asdic ping`"
    if not os.path.exists(path):
        raise InputError(path, "no such file", expected)
    if os.path.isdir(path):
        raise InputError(path, "a directory", expected)
    if not os.access(path, os.R_OK):
        raise InputError(path, "a file that may not be read", "one with read permission")
    try:
        return h5py.File(path, "r")
    except Exception as error:
        whole = "truncated" not in str(error)
        raise InputError(path, "a file that is not HDF5" if whole else "a truncated HDF5 file",
                         expected) from error


class PingFile:
    """A ping file open for reading, or a dataset like one (source.py); every ping is given by its
    row, from 0.

    Raises InputError if it is missing, damaged, or something else
    """

    def __init__(self, path):
        self.path = source.name_of(path) if source.is_dataset(path) else str(path)
        self._bad_samples: dict[tuple[int, int], int] = {}
        self._envelopes: dict[int, signal.Baseband] = {}
        self._columns: dict[str, np.ndarray] = {}
        if isinstance(path, source.Group):
            self.file = path
        else:
            self.file = source.of_dataset(path) if source.is_dataset(path) else opened(path)
        kind = self._text(self.file.attrs, "filetype")
        if kind != "asdic ping":
            self.file.close()
            raise InputError(path,
                             f'filetype "{kind}"' if kind else "an HDF5 file without a filetype",
                             'filetype "asdic ping"')
        version = self._text(self.file.attrs, "version") or "none"
        if version.split(".")[0] not in ("1", "2", "3"):
            self.file.close()
            raise InputError(path, f"version {version} of the format", "version 1, 2 or 3")
        shape = self._dataset("pressure").shape
        self.complex = len(shape) == 4 and shape[3] == 2
        if (len(shape) != 3 and not self.complex) or 0 in shape:
            raise InputError(path, f"pressure of shape {shape}",
                             "(ping, channel, sample) or (ping, channel, sample, 2), none of them 0")
        self.pings, self._file_channels, self.samples = shape[:3]
        self.array: int | None = None    # the pictures' own, None: all phones, whatever their array
        self._replica = "replica"        # of the transmitter whose ping is drawn
        if self.complex:
            self.samples *= self._finer

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.file.close()

    # ------------------------------------------------------------ reading, safely

    @staticmethod
    def _text(attributes, name) -> str | None:
        try:
            value = attributes[name]
        except Exception:
            return None
        return value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value)

    def _dataset(self, name):
        try:
            item = self.file[name]
        except Exception as error:
            raise InputError(self.path, f"no dataset {name}",
                             "one (docs/formats/ping.md)") from error
        if not hasattr(item, "shape"):
            raise InputError(self.path, f"a group where the dataset {name} should be", "a dataset")
        return item

    def read(self, name, rows=()) -> np.ndarray:
        """A dataset, or its part `rows`."""
        dataset = self._dataset(name)
        try:
            return np.asarray(dataset[rows])
        except Exception as error:
            raise InputError(self.path, f"{name} that cannot be read ({error})",
                             "a whole file") from error

    def has(self, name) -> bool:
        try:
            return name in self.file
        except Exception:
            return False

    def attribute(self, where, name) -> float:
        """A number kept as an attribute of a dataset or group."""
        try:
            return float(np.ravel(self.file[where].attrs[name])[0])
        except Exception as error:
            raise InputError(self.path, f"no number in the attribute {name} of {where}",
                             "one (docs/formats/ping.md)") from error

    def times(self, name, coordinate, count) -> np.ndarray:
        """When the first samples of a dataset are [s]: by its attributes or, in files of version 1,
        by the dataset of its times.
        """
        if "time_start" not in self._dataset(name).attrs:
            return self.read(coordinate, slice(0, count))
        return self.attribute(name, "time_start") \
            + self.attribute(name, "time_step") * np.arange(count)

    def _column(self, name):
        """A column of a table, read once."""
        if name not in self._columns:
            self._columns[name] = self.read(name)
        return self._columns[name]

    def _of_ping(self, group, row, columns):
        """The rows of a table that belong to one ping. → dictionary of columns"""
        if not self.has(group):
            return {name: np.zeros(0) for name in columns}
        mine = self._column(f"{group}/ping") == self.numbers[row]
        return {name: self._column(f"{group}/{name}")[mine] for name in columns}

    # ------------------------------------------------------------ what is in it

    @cached_property
    def _channel_array(self) -> np.ndarray:
        """[channel of the file] number of its array"""
        if not self.has("channel_array"):
            return np.zeros(self._file_channels, int)
        return self.read("channel_array").astype(int)

    @cached_property
    def array_names(self) -> list[str]:
        count = int(self._channel_array.max(initial=0)) + 1
        names = []
        if self.has("channel_array"):
            names = np.ravel(self.file["channel_array"].attrs.get("names", []))
        names = [n.decode() if isinstance(n, bytes) else str(n) for n in names] + [""] * count
        return [names[i] or f"array {i + 1}" for i in range(count)]

    def select_array(self, number: int | None) -> None:
        """What is received, from now on, is what this array receives; None: all of them together."""
        if number != self.array:
            self.array = number
            self._envelopes.clear()

    def choose_array(self, name: str) -> int:
        if name not in self.array_names:
            known = ", ".join(f'"{n}"' for n in self.array_names)
            raise InputError(self.path, f'no array "{name}"', f"one of {known}"
                             if len(self.array_names) > 1 else known)
        return self.array_names.index(name)

    @property
    def _channels(self) -> np.ndarray:
        """The file's channels that are drawn"""
        if self.array is None:
            return np.arange(self._file_channels)
        return np.flatnonzero(self._channel_array == self.array)

    @property
    def channels(self) -> int:
        return len(self._channels)

    @cached_property
    def title(self) -> str:
        return self._text(self.file.attrs, "title") or ""

    def tags(self, row: int) -> dict:
        """What a picture of a ping says of itself (output.Tags)."""
        return dict(title=self.title, version=self._text(self.file.attrs, "program_version") or "",
                    digest=self._text(self.file.attrs, "scenario_sha256") or "",
                    ping=int(self.numbers[row]))

    @cached_property
    def numbers(self) -> np.ndarray:
        return self.read("ping")

    @cached_property
    def valid_samples(self) -> np.ndarray:
        """[ping], never more than the record is long"""
        return np.clip(self.read("valid_samples") * self._finer, 0, self.samples)

    @cached_property
    def simulated(self) -> np.ndarray:
        """Rows of the pings that were simulated: a run that was stopped may leave empty ones."""
        return np.flatnonzero(self.valid_samples > 0)

    @cached_property
    def start(self) -> float:
        """Time of the first sample [s]"""
        return self.times("pressure", "time", 1)[0]

    @cached_property
    def stored_rate(self) -> float:
        rate = self.attribute("pressure", "sample_rate_hz")
        if not rate > 0:
            raise InputError(self.path, f"a sample rate of {rate} Hz", "one above 0")
        return rate

    @cached_property
    def _finer(self) -> int:
        """Samples of pressure for one of complex baseband: enough for the highest frequency."""
        if not self.complex:
            return 1
        carrier = self.attribute("pressure", "carrier_hz")
        return int(np.ceil(2.5 * (carrier + 0.5 * self.stored_rate) / self.stored_rate))

    @cached_property
    def sample_rate(self) -> float:
        """Of `pressure` and `replica` [Hz]"""
        return self.stored_rate * self._finer

    def _real(self, parts: np.ndarray) -> np.ndarray:
        """Pressure of complex baseband [samples, 2], t = 0 at its first sample."""
        return signal.passband(parts[:, 0] + 1j * parts[:, 1], self._finer,
                               self.attribute("pressure", "carrier_hz"), self.sample_rate)

    def replica(self) -> np.ndarray:
        """The pulse at `sample_rate`, unit peak before its window"""
        r = np.nan_to_num(self.read(self._replica).astype(float))
        return self._real(r) if self.complex else r

    @property
    def centre_frequency(self) -> float:
        return self.attribute(self._replica, "centre_frequency_hz")

    @property
    def bandwidth(self) -> float:
        return max(self.attribute(self._replica, "bandwidth_hz"), 0.0)

    @property
    def pulse_duration(self) -> float:
        return self.attribute(self._replica, "duration_s")

    @property
    def pulse_kind(self) -> str:
        return self._text(self.file[self._replica].attrs, "kind") or ""

    @property
    def pulse_sweep(self) -> float:
        """Width of the frequencies that it goes through [Hz]: 0 of a tone, NaN where it is not known.

        Files before version 2.1 tell it by their kinds.
        """
        if "sweep_hz" in self.file[self._replica].attrs:
            return self.attribute(self._replica, "sweep_hz")
        known = {"lfm": self.bandwidth, "hfm": self.bandwidth, "file": np.nan}
        return known.get(self.pulse_kind, 0.0)

    @cached_property
    def elevation_deg(self) -> np.ndarray:
        return self.read("elevation_deg")

    def choose_ping(self, number: int | None) -> int:
        """Row of ping `number`, or of the first one. The pulse is its transmitter's from now on."""
        row = self._row_of(number)
        sender = int(self.read("transmitter", row)) if self.has("transmitter") else 0
        if sender > 0 and self.has(f"replica_{sender}"):
            self._replica = f"replica_{sender}"
        return row

    def _row_of(self, number: int | None) -> int:
        if self.simulated.size == 0:
            raise InputError(self.path, "no ping that was simulated", "at least one")
        if number is None:
            return int(self.simulated[0])
        known = self.numbers[self.simulated]
        found = self.simulated[known == number]
        if found.size == 0:
            raise InputError(self.path, f"no ping {number}",
                             f"one of {known.min()} to {known.max()}")
        return int(found[0])

    def heading(self, row: int) -> str:
        """For titles: the scenario and, where there are several, the ping."""
        requested = self.pings
        if "pings_requested" in self.file.attrs:
            requested = int(self.attribute("/", "pings_requested"))
        text = self.title or os.path.basename(self.path)
        several = max(requested, self.pings) > 1
        if several or self.numbers[row] > 1:
            text += f" · ping {self.numbers[row]}"
        if several and self.numbers[self.simulated].max() == self.simulated.size:
            text += f" of {self.simulated.size}"
        if self.stopped:
            text += f" (stopped; {requested} were asked for)"
        return text + self.of_array

    @property
    def of_array(self) -> str:
        """For titles: which array is drawn, where there are several."""
        if len(self.array_names) == 1:
            return ""
        return "  ·  all arrays" if self.array is None else f"  ·  {self.array_names[self.array]}"

    @cached_property
    def stopped(self) -> bool:
        return "complete" in self.file.attrs and not int(self.attribute("/", "complete"))

    def pressure(self, row: int, channel: int) -> np.ndarray:
        """Pressure of one phone [Pa]; samples that are not numbers are 0 (see `warnings`)."""
        valid = slice(0, int(self.valid_samples[row]) // self._finer)
        stored = int(self._channels[channel])
        p = self.read("pressure", (row, stored, valid)).astype(float)
        self._bad_samples[row, stored] = int(np.count_nonzero(~np.isfinite(p)))
        p = np.nan_to_num(p, nan=0.0, posinf=0.0, neginf=0.0)
        return self._real(p) if self.complex else p

    def warnings(self) -> list[str]:
        """What the reader of the pictures should know, after they are drawn."""
        bad = sum(self._bad_samples.values())
        return [f"{bad} samples of pressure are not numbers; drawn as 0"] if bad else []

    @property
    def band(self) -> float:
        """Width around the centre frequency that holds the pulse and its Doppler shifts [Hz]"""
        factors = self.read("echoes/doppler_factor") if self.has("echoes") else np.zeros(0)
        span = float(np.max(np.abs(factors[np.isfinite(factors)] - 1.0), initial=0.0))
        velocity = np.nan_to_num(self.read("platform_velocity"))
        speed = np.linalg.norm(velocity, axis=-1).max(initial=0.0)
        span = min(max(span, 2.0 * float(speed) / 1400.0), 0.1)
        return signal.band_width(self.bandwidth, self.centre_frequency, span, self.pulse_duration)

    def envelope(self, row: int) -> signal.Baseband:
        """Every phone's complex envelope in `band`."""
        if row not in self._envelopes:  # one ping at a time: a file may hold thousands
            self._envelopes.clear()
            phones = (self.pressure(row, channel) for channel in range(self.channels))
            self._envelopes[row] = signal.baseband(phones, self.sample_rate, self.centre_frequency,
                                                   self.band, self.start, ENVELOPE_SAMPLES)
        return self._envelopes[row]

    def phones(self, row: int) -> np.ndarray:
        """[channel, 3] east, north, depth [m]"""
        return self.read("phone_position", row)[self._channels]

    def places(self) -> np.ndarray:
        """[simulated ping, 3] the middle of the phones"""
        return self.read("phone_position")[self.simulated][:, self._channels].mean(axis=1)

    def platform(self, row: int) -> np.ndarray:
        return self.read("platform_position", row)

    @cached_property
    def profile(self):
        """Depth [m], sound speed [m/s]"""
        return self.read("environment/depth"), self.read("environment/sound_speed")

    def sound_speed(self, depth: float) -> float:
        """At a depth [m/s]"""
        z, c = self.profile
        good = np.isfinite(z) & np.isfinite(c) & (c > 0)
        if not good.any():
            raise InputError(self.path, "no sound speed that is a number",
                             "a profile in /environment")
        return float(np.interp(depth, z[good], c[good]))

    @cached_property
    def bottom_depth(self) -> float:
        return self.attribute("environment", "bottom_depth_m")

    def rays_line(self, side: str):
        """Range and depth [m] of the "bottom" or "surface" in the rays' plane; None where flat"""
        if not self.has(f"rays/{side}_depth"):
            return None
        return self.read(f"rays/{side}_range"), self.read(f"rays/{side}_depth")

    @cached_property
    def target_names(self) -> list[str]:
        if not self.has("target_index"):
            return []
        count = self._dataset("target_index").shape[0]
        names = self.file["target_index"].attrs.get("names", [])
        if isinstance(names, (str, bytes)):  # one string, names apart by commas or lines
            names = names.decode() if isinstance(names, bytes) else names
            names = names.replace("\n", ",").split(",")
        names = [n.decode() if isinstance(n, bytes) else str(n) for n in np.ravel(names)]
        names = [n.strip() for n in names] + [""] * count
        return [names[i] or f"target {i + 1}" for i in range(count)]

    def targets(self, row: int):
        """[(index, name, east-north-depth [m], whether it is there)] of those that have a place"""
        if not self.target_names:
            return []
        there, place = self.read("target_present", row), self.read("target_position", row)
        return [(i, self.target_names[i], place[i], bool(there[i]))
                for i in range(len(self.target_names)) if np.all(np.isfinite(place[i]))]

    def echoes(self, row: int, array: int | None = None) -> list[Echo]:
        """One entry a target that answers, as received at the array's reference point.

        Where every phone has its own paths, as received at the middle phone.
        """
        several = len(self.array_names) > 1
        t = self._of_ping("echoes", row,
                          ["target", "channel", "delay", "doppler_factor", "level_db",
                           "arrival_elevation_deg", "arrival_bearing_deg"]
                          + ["array"] * several)
        good = np.isfinite(t["delay"]) & np.isfinite(t["level_db"])
        if several:
            good &= t["array"] == ((self.array or 0) if array is None else array)
        found = []
        for target in np.unique(t["target"][good]).astype(int):
            mine = good & (t["target"] == target)
            channels = np.unique(t["channel"][mine])
            mine &= t["channel"] == (-1 if -1 in channels else channels[len(channels) // 2])
            order = np.flatnonzero(mine)[np.argsort(t["delay"][mine], kind="stable")]
            known = target < len(self.target_names)
            name = self.target_names[target] if known else f"target {target + 1}"
            direction = travel_direction(t["arrival_elevation_deg"][order],
                                         t["arrival_bearing_deg"][order])
            found.append(Echo(target, name, t["delay"][order], t["level_db"][order],
                              t["doppler_factor"][order], direction))
        return found

    def loudest_echo(self, row: int) -> float:
        """Level of the strongest path inside the record [dB re 1 µPa]; −∞ without one"""
        last = self.start + self.valid_samples[row] / self.sample_rate
        return max((float(e.level_db[received].max()) for e in self.echoes(row)
                    if (received := e.strong(self.start, last)).any()), default=-np.inf)

    def levels(self, row: int):
        """Time [s] and the mean-square pressures [Pa²] of echo, reverberation and noise"""
        count = self._dataset("levels/echo").shape[-1]
        return self.times("levels/echo", "levels/level_time", count), {k: self.read(f"levels/{k}", row).astype(float)
                      for k in ("echo", "reverberation", "noise")}

    def rays(self):
        """Launch elevation [ray], range and depth [ray, point], kind [ray], surface hits [hit]"""
        hits = self.read("rays/hit_range") if self.has("rays/hit_range") else np.empty(0)
        return [self.read(f"rays/{k}")
                for k in ("launch_elevation_deg", "range", "depth", "kind")] + [hits]

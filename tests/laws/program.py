"""Runs of the program on scenarios, and what their files hold."""
import hashlib
import json
import os
import re
import resource
import shutil
import signal
import subprocess
import tempfile
from collections import OrderedDict
from pathlib import Path

import h5py
import numpy as np

from schema import ASDIC

SECONDS = int(os.environ.get("ASDIC_LAWS_SECONDS", "12"))  # of processor time, after which a run is ended


class Refused(Exception):
    """The program does not take the scenario: the draw says nothing."""


class Dear(Exception):
    """The program takes longer than a draw may: a fault of cost, or of how draws are made small."""


class Violation(AssertionError):
    """A law does not hold."""


def spent():
    """Seconds of processor time of this process and of the runs that have ended."""
    return sum(sum(resource.getrusage(who)[:2]) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))


def word(value):
    """A value as TOML has it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {word(one)}" for key, one in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(word(one) for one in value) + "]"
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    return str(value)


def toml(scenario):
    """A scenario as a file; keys that begin with "_" are ours."""
    values, tables = [], []
    for key, value in scenario.items():
        if key.startswith("_"):
            continue
        if isinstance(value, dict):
            tables.append(f"[{key}]\n" + "".join(f"{k} = {word(v)}\n" for k, v in value.items()))
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            tables += [f"[[{key}]]\n" + "".join(f"{k} = {word(v)}\n" for k, v in one.items()) for one in value]
        else:
            values.append(f"{key} = {word(value)}\n")
    return "".join(values) + "".join(tables)


class Folder:
    """A folder that a scenario and what it names are written to."""

    def __init__(self, scenario):
        self.path = Path(tempfile.mkdtemp(prefix="laws.", dir="/dev/shm" if os.path.isdir("/dev/shm") else None))
        for name, text in scenario.get("_files", {}).items():
            (self.path / name).write_text(text)
        (self.path / "s.toml").write_text(toml(scenario))

    def __enter__(self):
        return self.path

    def __exit__(self, *_):
        shutil.rmtree(self.path, ignore_errors=True)


def run(folder, *arguments, **more):
    """What the program said; Refused of status 2, Violation of any other end."""
    done = subprocess.run(["prlimit", f"--cpu={SECONDS}", "--", ASDIC, *arguments], cwd=folder, capture_output=True, text=True, **more)
    if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        raise Dear(f"asdic {arguments[0]}: not done after {SECONDS} s of processor time")
    if done.returncode == 2:
        raise Refused(done.stderr.strip()[-400:])
    if done.returncode != 0:
        raise Violation(f"asdic {arguments[0]}: status {done.returncode}: {done.stderr.strip()[-400:]}")
    return done.stdout


class Record:
    """What `asdic ping` wrote."""

    def __init__(self, path):
        with h5py.File(path) as file:
            pressure = file["pressure"]
            self.rate = float(pressure.attrs["sample_rate_hz"])
            self.start = float(np.ravel(pressure.attrs["time_start"])[0])
            self.carrier = float(pressure.attrs["carrier_hz"]) if "carrier_hz" in pressure.attrs else None
            self.bits = hashlib.sha256(pressure[...].tobytes()).hexdigest()
            samples = np.asarray(pressure[...], dtype=float)
            self.pressure = samples[..., 0] + 1j * samples[..., 1] if self.carrier is not None else samples
            replica = np.asarray(file["replica"][...], dtype=float)
            # Of a path with the amplitude 1 Pa: sqrt(sum of its samples' squares).
            self.replica_norm = float(np.linalg.norm(replica))
            self.phone_position = file["phone_position"][...]
            self.valid = file["valid_samples"][...]
            self.ping_time = file["ping_time"][...]
            self.warnings = [one.decode() if isinstance(one, bytes) else str(one) for one in np.ravel(file.attrs["warnings"])] \
                if "warnings" in file.attrs else []
            for name in ("arrivals", "bounces", "echoes", "summary", "levels", "patches"):
                group = file.get(name)
                setattr(self, name, {key: group[key][...] for key in group} if group is not None else {})
            levels = file.get("levels")
            self.level_start, self.level_step = (
                (float(np.ravel(levels["echo"].attrs["time_start"])[0]), float(np.ravel(levels["echo"].attrs["time_step"])[0]))
                if levels is not None and "echo" in levels and "time_start" in levels["echo"].attrs else (0.0, 0.0))

    def leg(self, number, target=0, channel=None):
        """Rows of a leg of the first ping, those of the reference point or the first phone that has any."""
        a = self.arrivals
        if not a or len(a["leg"]) == 0:
            return {}
        rows = (a["leg"] == number) & (a["target"] == target) & (a["ping"] == a["ping"].min())
        if rows.any():
            channels = a["channel"][rows]
            rows &= a["channel"] == (channels.min() if channel is None else channel)
        return {key: value[rows] for key, value in a.items() if len(value) == len(rows)}

    def peak(self):
        """Greatest modulus of the analytic signal, between samples as well [Pa]."""
        from scipy.signal import hilbert, resample
        whole = self.pressure if self.carrier is not None else hilbert(self.pressure, axis=-1)
        return float(np.max(np.abs(resample(whole, 8 * whole.shape[-1], axis=-1))))


_known = OrderedDict()


def ping(scenario, *options):
    """The record of a scenario; remembered, since several laws ask for the same one."""
    key = (toml(scenario), tuple(sorted(scenario.get("_files", {}).items())), options, os.environ.get("ASDIC_FAULT"))
    if key in _known:
        _known.move_to_end(key)
        value = _known[key]
    else:
        try:
            with Folder(scenario) as folder:
                run(folder, "ping", "s.toml", "-o", "o.h5", "-q", "--threads", "1", *options)
                value = Record(folder / "o.h5")
                value.scenario, value.options = scenario, options
        except (Refused, Violation, Dear) as fault:
            value = fault
        _known[key] = value
        if len(_known) > 24:
            _known.popitem(last=False)
    if isinstance(value, Exception):
        raise value
    return value


def at_one_rate(*records):
    """The records at one sample rate, the highest of theirs: baseband's follows from all that moves, a rough sea as well."""
    rate = max(one.rate for one in records)
    return [one if one.rate > (1 - 1e-9) * rate else
            ping(one.scenario | {"pings": one.scenario["pings"] | {"baseband_rate": rate}}, *one.options) for one in records]


def cost(scenario, command, *options):
    """Processor time [s] and largest memory [bytes] of a command, and what it said; Dear after three times SECONDS."""
    with Folder(scenario) as folder:
        with open(folder / "said", "w") as out:
            child = subprocess.Popen(["prlimit", f"--cpu={3 * SECONDS}", "--", ASDIC, command, "s.toml", *options], cwd=folder,
                                     stdout=out, stderr=subprocess.STDOUT)
            _, status, used = os.wait4(child.pid, 0)
            child.returncode = os.waitstatus_to_exitcode(status)
        said = (folder / "said").read_text()
        if child.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
            raise Dear(f"asdic {command}: not done after {3 * SECONDS} s of processor time")
        if child.returncode == 2:
            raise Refused(said.strip()[-400:])
        if child.returncode != 0:
            raise Violation(f"asdic {command}: status {child.returncode}: {said.strip()[-400:]}")
        # Linux counts what the forked runner held before it became the command: up to that nothing is known.
        own = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        memory = used.ru_maxrss * 1024.0 if used.ru_maxrss > 1.02 * own else 0.0
        return used.ru_utime + used.ru_stime, memory, said


def bytes_of(text):
    """The number of bytes of "139.6 MB"."""
    number, unit = re.match(r"([0-9.]+) ?([kMGTP]?)i?B", text).groups()
    return float(number) * {"": 1.0, "k": 1e3, "M": 1e6, "G": 1e9, "T": 1e12, "P": 1e15}[unit]

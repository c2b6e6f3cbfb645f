"""asdic-moos: an active sonar in a MOOS community (docs/guide/moos.md)."""
import argparse
import json
import signal
import socket
import sys
import threading
from pathlib import Path

import numpy as np

from . import mission, quantities
from .moosdb import Clock, MoosDB
from .quantities import Wrong
from .settings import settings_of, value_of
from .sonar import Sonar
from .steady import Steady

INPUTS = {**{q.name: q.key for q in quantities.PLATFORM}, "ACTIVE_SONAR_COMMAND": "command",
          "SIM_TARGET": "target", "TOWED_ARRAY_POSITIONS": "phones", "BELLHOP_REQUEST": "paths"}
OUTPUTS = {"ACTIVE_SONAR_PING": "ping", "ACTIVE_SONAR_SAMPLES": "samples",
           "ACTIVE_SONAR_DATA_FILE": "files", "ACTIVE_SONAR_REPLICA_FILE": "files",
           "ACTIVE_SONAR_DETECTION": "detections", "ACTIVE_SONAR_TRACK": "tracks",
           "ACTIVE_SONAR_TRUTH": "truth", "ACTIVE_SONAR_LATENCY": "latency",
           "ACTIVE_SONAR_ERROR": "error", "BELLHOP_RESPONSE": "paths"}
EXAMPLE = """ServerHost = localhost
ServerPort = 9000
Community = alpha
MOOSTimeWarp = 1

ProcessConfig = asdic-moos
{
  Scenario = deep_ocean.toml     // or Socket = sonar.sock of an asdic serve that is running
  Arguments = --set 'pings={samples="baseband", recording_duration=40.0}'
  ReceiverOptions = --target-depth 125m
  ArrayFollowsHeading = true     // a line of phones along the hull
  // NAV_X = NODE_X              // any variable by another name
}
"""


class App:
    """The mission's block → database and sonar, and what goes from one to the other."""

    def __init__(self, path, name="asdic-moos", changes=()):
        """changes: (name, value) in place of the mission's. \\throws Wrong, MissionError,
        OSError
        """
        values, block = mission.read(path, name)
        if block is None:
            raise mission.MissionError(f"{path}: found no block, expected ProcessConfig = {name}")
        for key, value in changes:
            values.values[key.lower()] = value
        self.name = name
        self.names = {n: n for n in (*INPUTS, *OUTPUTS)}  # by default → in use
        own = {}
        for key, value in block.values.items():
            if key.upper() in self.names:
                self.names[key.upper()] = self._variable(value, block.place(key))
            elif key not in ("apptick", "commstick", "maxapptick"):  # of every app; nothing ticks
                own[block.names[key]] = value
        host = values.get("ServerHost", "localhost")
        port = self._of(values, "ServerPort", "9000", (1, 65535))
        warp = self._of(values, "MOOSTimeWarp", "1", (1e-3, 1e4))
        self.settings, rest = settings_of(own, warp, block.place)
        if rest:
            raise Wrong(block.place(rest[0]), "a name that there is none",
                        "a setting or a variable of docs/formats/middleware.md")
        self._find_files(Path(path).resolve().parent)
        self.clock = Clock(warp)
        self._in = {}  # variable in use → what it is; one name may not serve two
        for variable, what in INPUTS.items():
            used = self.names[variable]
            if used in self._in:
                raise Wrong(used, "it as the name of two inputs", "a name for each")
            self._in[used] = (variable, what)
        self.db = MoosDB(host, int(port), name, self.clock, {n: 0.0 for n in self._in}, self._mail,
                         self._lost, self._up)
        self.sonar = Sonar(self.settings, Steady(self.clock, warp), self._result)
        self._clock_known = threading.Event()
        if host in ("localhost", "127.0.0.1", "::1", socket.gethostname()):
            self._clock_known.set()

    @staticmethod
    def _variable(value, where):
        if not value or len(value) > quantities.NAME_LENGTH or not value.isprintable() or \
                any(c in value for c in " ,=*?"):
            raise Wrong(where, quantities.shown(value), "the name of a variable")
        return value

    @staticmethod
    def _of(values, name, default, kind):
        text = values.get(name, default)
        where = values.place(name) if name.lower() in values.lines else name
        it = value_of(kind, text, where)
        if isinstance(kind[1], int) and it != int(it):
            raise Wrong(where, quantities.shown(text), "a whole number")
        return it

    def _find_files(self, folder):
        """Files of the block lie beside the mission, or where its words say."""
        for name in ("scenario", "token_file", "socket"):
            value = getattr(self.settings, name)
            if value and not Path(value).is_absolute() and (folder / value).exists():
                setattr(self.settings, name, str(folder / value))

    def told(self):
        """What it would do, a line each."""
        server = self.settings.socket or self.settings.tcp or self.settings.scenario
        lines = [f"{self.name} at {self.db.host}:{self.db.port}, time goes {self.clock.warp:g} "
                 f"times as fast, {server}"]
        for what, names in (("takes", INPUTS), ("publishes", OUTPUTS)):
            lines += [f"{what:9} {self.names[n]}" + (f" ({n})" if self.names[n] != n else "")
                      for n in names]
        return "\n".join(lines)

    def run(self, stop):
        """The sonar begins when the clock is known: that of a database elsewhere may be another."""
        self.db.start()
        while not stop.wait(0.05):
            if self._clock_known.is_set():
                self.sonar.start()
                break
        stop.wait()
        self.sonar.close()
        self.db.close()

    # In -------------------------------------------------------------------------------------------

    def _mail(self, message):
        """One variable, in the database's thread: it is read, and work is left to others."""
        variable, what = self._in[message.key]
        where = message.key
        try:
            if what in ("command", "target", "phones", "paths"):
                self._text(what, where, message)
            else:
                value = message.value if message.data == "D" else message.str_value
                self.sonar.set_platform(what, value, where, message.time)
        except Wrong as wrong:
            self.sonar.error(str(wrong))

    def _text(self, what, where, message):
        if message.data != "S":
            raise Wrong(where, "a number" if message.data == "D" else "bytes", "a text")
        text = message.str_value
        if what == "phones":
            self.sonar.set_phones(quantities.positions_of(text, where), message.time)
        elif what == "paths":
            self.sonar.request_paths(quantities.paths_of(text, where), where)
        else:
            pairs = quantities.pairs_of(text, where)
            if what == "target":
                fields = quantities.keyed(pairs, quantities.TARGET, where)
                self.sonar.set_target(fields, where, message.time)
            else:
                self.sonar.ping(quantities.ping_of(pairs, where), where)

    def _lost(self, reason):
        say(reason)

    def _up(self):
        self._clock_known.set()
        say(f"in the community {self.db.community} at {self.db.host}:{self.db.port}")

    # Out ------------------------------------------------------------------------------------------

    def _result(self, kind, what):
        if kind == "ready":
            heard = "listening" if what["listening"] else "pinging on command"
            say(f"{what['scenario']}: {what['channels']} phones, {heard}")
        elif kind == "samples":
            self._publish("ACTIVE_SONAR_SAMPLES", block_bytes(what))
        elif kind == "files":
            self._publish("ACTIVE_SONAR_DATA_FILE", what["data"])
            if what["replica"]:
                self._publish("ACTIVE_SONAR_REPLICA_FILE", what["replica"])
        elif kind == "paths":
            self._publish("BELLHOP_RESPONSE", json.dumps(what))
        elif kind == "error":
            say(what["message"])
            self._publish("ACTIVE_SONAR_ERROR", what["message"])
        elif kind == "ping":
            self._publish("ACTIVE_SONAR_PING", quantities.text_of(ping_fields(what)))
        elif kind == "detections":
            for k, one in enumerate(what["detections"]):
                self._publish("ACTIVE_SONAR_DETECTION", quantities.text_of(
                    {"ping": what["ping"], "number": k + 1, "of": what["of"],
                     "ping_time": what["ping_time"], **detection_fields(one)}))
        elif kind == "latency":
            self._publish("ACTIVE_SONAR_LATENCY", quantities.text_of(what))
        else:
            for one in what[kind]:
                self._publish({"tracks": "ACTIVE_SONAR_TRACK", "truth": "ACTIVE_SONAR_TRUTH"}[kind],
                              quantities.text_of({"ping": what["ping"], **one}))

    def _publish(self, variable, value):
        self.db.notify(self.names[variable], value)


def block_bytes(what):
    """A block as bytes: a line of JSON, and float32 row by row."""
    data = what["data"]
    head = {k: v for k, v in what.items() if k not in ("data", "phones")}
    head |= {"channels": data.shape[0], "samples": data.shape[1], "complex": data.ndim == 3 or
             np.iscomplexobj(data), "unit": "Pa", "type": "float32", "byte_order": "little"}
    kind = "<c8" if np.iscomplexobj(data) else "<f4"
    return json.dumps(head).encode() + b"\n" + np.ascontiguousarray(data, kind).tobytes()


def ping_fields(what):
    """With the waveform by the names that a command has."""
    what = dict(what)
    wave = what.pop("waveform", None) or {}
    names = {q.key: q.name for q in quantities.COMMAND}
    for key, value in wave.items():
        what[names.get(key, f"waveform.{key}")] = value
    if not wave:
        what["type"] = "scenario"
    for key in ("elevation_deg", "source_level_db", "beamwidth_deg"):
        if key in what:
            what[names[key]] = what.pop(key)
    return what


def detection_fields(what):
    """With the first place as x, y, …, the other side's as mirror_x, …"""
    what = dict(what)
    for side, place in zip(("", "mirror_"), what.pop("places")):
        what |= {side + name: value for name, value in place.items()}
    return what


def say(line):
    print(f"asdic-moos: {line}", file=sys.stderr, flush=True)


def main(words=None):
    parser = argparse.ArgumentParser(
        prog="asdic-moos", description="An active sonar in a MOOS community: takes NAV_*, targets "
        "and commands, publishes samples, detections, tracks and the truth. docs/guide/moos.md")
    parser.add_argument("mission", nargs="?", help="mission file (.moos)")
    parser.add_argument("name", nargs="?", default="asdic-moos",
                        help="of the block and of the app; default: asdic-moos")
    parser.add_argument("--host", help="of the MOOSDB, in place of the mission's ServerHost")
    parser.add_argument("--port", help="in place of the mission's ServerPort")
    parser.add_argument("--check", action="store_true",
                        help="read the mission, tell the variables in use, and end")
    parser.add_argument("--example", action="store_true", help="print a mission file, and end")
    given = parser.parse_args(words)
    if given.example:
        print(EXAMPLE, end="")
        return 0
    if given.mission is None:
        parser.error("found no mission file, expected one")
    changes = [(n, v) for n, v in (("ServerHost", given.host), ("ServerPort", given.port)) if v]
    try:
        app = App(given.mission, given.name, changes)
    except OSError as error:
        say(f"{given.mission}: {error.strerror}")
        return 2
    except ValueError as error:
        say(error)
        return 2
    if given.check:
        print(app.told())
        return 0
    stop = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, lambda *_: stop.set())
    app.run(stop)
    return 0

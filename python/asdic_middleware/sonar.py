"""The sonar of a vehicle: what is known of vehicle, targets and array, the pings made of it by
`asdic serve`, and what becomes of them. MOOS and ROS tell it what arrives and publish what it
emits.

Threads: inputs may come from any. One thread speaks with the server and runs the receiver, one
answers requests of sound paths, one lets results go when they are due.
"""
import heapq
import itertools
import math
import os
import queue
import threading
import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from . import paths, quantities, receiver, stream
from .link import Client, Link, Refused
from .quantities import Wrong, shown
from .tracker import Tracker, TrackerSettings

MOST_PINGS_WAITING = 8
MOST_REQUESTS_WAITING = 16
MOST_TARGETS = 64
MOST_HELD_BYTES = 512 << 20  # of samples that are not due
ERRORS_PER_SECOND = 20
TRUTH = ("present", "paths", "echo_time", "echo_level_db", "echo_peak_db", "reverberation_db",
         "noise_db", "echo_to_background_db")  # of a target, in a ping's answer
SLEW = 10.0                  # to a place off the way that was told, while listening [m/s]
MOST_SKEW = 10.0             # of a stamp against the clock [s]; beyond it counts as now


@dataclass
class Settings:
    """As the mission file or ROS's parameters have them."""

    scenario: str = ""            # of an own server, and for sound paths
    arguments: list = field(default_factory=list)  # of `asdic serve`, further ones
    program: str = "asdic"
    socket: str = ""              # of a running server, instead
    tcp: int = 0
    token_file: str = ""
    pace: str = "clock"           # "clock": of the middleware; "fast": as soon as results are had
    factor: float = 1.0           # how fast that clock goes
    platform: str = ""            # the first, where there are several
    array: str = ""
    array_follows_heading: bool = False
    delivery: str = "auto"        # "pings": the record of each; "listen": a stream; "none"
    receiver: bool = True
    receiver_options: list = field(default_factory=list)
    most_detections: int = 50
    block: float = 1.0            # of samples [s]
    update: float = 1.0           # while listening, between changes [s]
    folder: str = "asdic-data"
    files_kept: int = 100         # pings whose files are kept
    tracker: TrackerSettings = field(default_factory=TrackerSettings)


class Sonar:
    """
    clock  the middleware's time [s], a function
    emit   called with (kind, dict) for each result, from threads of this class. Kinds: "ping",
           "samples", "files", "detections", "tracks", "truth" (each of a ping, with a list of
           that name), "latency" (the last of a ping), "paths", "error", "ready"
    """

    def __init__(self, settings, clock, emit):
        self.settings, self._clock, self._emit = settings, clock, emit
        self._lock = threading.Lock()
        self._platform, self._targets = {}, {}  # as they were told, and taken
        self._changes = {}           # of targets, not yet told to the server
        self._phones = None          # (places, time)
        self._fresh = {"platform": False, "phones": False}
        self._jobs = queue.Queue(MOST_PINGS_WAITING)
        self._requests = queue.Queue(MOST_REQUESTS_WAITING)
        self._stop = threading.Event()
        self._held, self._held_bytes, self._count = [], 0, itertools.count()
        self._due = threading.Condition()
        self._errors = [0.0, 0, 0]   # second, told in it, held back
        self._files = []
        self._link, self.listening, self._format, self._origin = None, False, None, 0.0
        self._twin, self._heard_of, self._pending = None, None, []  # of a stream
        self._keep_heard = 30.0 * settings.factor  # [s]: while the twin works
        self._velocity, self._place = (0.0, 0.0), None
        self._tracker = Tracker(settings.tracker)
        self._threads = [threading.Thread(target=t, daemon=True, name=t.__name__.strip("_"))
                         for t in (self._work, self._answer_requests, self._let_go,
                                   self._cut_records)]

    def start(self):
        for thread in self._threads:
            thread.start()

    def close(self):
        self._stop.set()
        with self._due:
            self._due.notify_all()
        link = self._link
        if link is not None:
            link.close()
        for thread in self._threads:
            if thread.is_alive():
                thread.join(timeout=5)

    # Inputs ---------------------------------------------------------------------------------------

    def set_platform(self, name, value, where, stamp=None):
        """name: x, y, depth, heading_deg, speed. \\throws Wrong"""
        quantity = next(q for q in quantities.PLATFORM if q.key == name)
        value = quantity.of(value, where)
        with self._lock:
            self._platform[name] = (value, self._time_of(stamp))
            self._fresh["platform"] = True

    def set_target(self, fields, where, stamp=None):
        """fields: as quantities.keyed() has them of TARGET. \\throws Wrong"""
        fields = quantities.target_of(fields, where)
        name = fields["name"]
        with self._lock:
            if name not in self._targets and \
                    len(self._targets) + len(self._changes) >= MOST_TARGETS:
                raise Wrong(f"{where}: {shown(name)}", f"one more than {MOST_TARGETS} targets",
                            "fewer; remove=true takes one out")
            before = self._changes.get(name, {})
            anew = fields.get("remove") == "true" or "remove" in before
            change = {**({} if anew else before), **fields, "where": where, "before": before}
            if "x" in fields:
                change["time"] = self._time_of(stamp)
            before.pop("before", None)
            self._changes[name] = change

    def set_phones(self, places, stamp=None):
        """places: as quantities.positions_of() has them"""
        with self._lock:
            self._phones = (places, self._time_of(stamp))
            self._fresh["phones"] = True

    def ping(self, fields, where):
        """fields: as quantities.ping_of() has them. \\throws Wrong when too many wait"""
        try:
            self._jobs.put_nowait((fields, where))
        except queue.Full:
            raise Wrong(where, f"{MOST_PINGS_WAITING} pings that wait", "fewer; it is not sent") \
                from None

    def request_paths(self, asked, where):
        """asked: as quantities.paths_of() has it. \\throws Wrong"""
        try:
            self._requests.put_nowait((asked, where))
        except queue.Full:
            raise Wrong(where, f"{MOST_REQUESTS_WAITING} requests that wait",
                        "fewer; it is not answered") from None

    def error(self, text):
        """One line; of more than so many a second their number alone is told."""
        now = time.monotonic()
        with self._lock:
            if now - self._errors[0] >= 1.0:
                held, self._errors = self._errors[2], [now, 0, 0]
            else:
                held = 0
            self._errors[1] += 1
            over = self._errors[1] > ERRORS_PER_SECOND
            self._errors[2] += over
        if held:
            self._emit("error", {"message": f"{held} more errors came within a second; they are "
                                            "not told one by one"})
        if not over:
            self._emit("error", {"message": " ".join(text.split())[:500]})

    def _time_of(self, stamp):
        now = self._clock()
        near = MOST_SKEW * max(self.settings.factor, 1.0)
        return stamp if stamp is not None and abs(stamp - now) <= near else now

    # The server -----------------------------------------------------------------------------------

    def _work(self):
        said = None
        while not self._stop.is_set():
            try:
                self._session()
                said = None
            except (OSError, Refused, ValueError) as error:
                if self._stop.is_set():
                    return
                if str(error) != said:
                    said = str(error)
                    self.error(said)
            finally:
                link, self._link = self._link, None
                twin, self._twin = self._twin, None
                for end in (link, twin):
                    if end is not None:
                        end.close()
            self._stop.wait(2.0)

    def _connect(self):
        s = self.settings
        if s.socket:
            return Client.unix(s.socket)
        if s.tcp:
            token = Path(s.token_file).read_text().strip() if s.token_file else \
                os.environ.get("ASDIC_TOKEN", "")
            return Client.tcp(s.tcp, token)
        words = ["--pace", "fast" if s.pace == "fast" else f"{s.factor:.10g}", *s.arguments]
        if self._wants_files():
            Path(s.folder).mkdir(parents=True, exist_ok=True)
            words += ["--output-dir", s.folder]
        return Client.start(s.scenario, *words, program=s.program)

    def _wants_files(self):
        return self.settings.receiver and self.settings.delivery in ("auto", "pings")

    def _session(self):
        """From the handshake on, until the connection breaks. \\throws OSError, Refused"""
        link = Link(self._connect(), self._heard)
        self._link = link
        self._origin = self._clock()
        self._check_pace(link.greeting["pace"])
        state = link.call("state")[0]
        self._platform_now = self._named(state["platforms"], self.settings.platform, "platform")
        self._array_now = self._named(state["arrays"], self.settings.array, "array")
        self._several = {what: len(state[what]) > 1 for what in ("platforms", "arrays", "targets")}
        self._known_targets = {t["name"] for t in state["targets"]}
        self._place, self._place_time = list(self._platform_now["position"]), state["time"]
        self._velocity = tuple(self._platform_now["velocity"][:2])
        self._files_here = self._known_place = True
        self._tracker = Tracker(self.settings.tracker)
        with self._lock:  # a new session knows nothing
            self._fresh = {"platform": bool(self._platform), "phones": self._phones is not None}
            for name, target in self._targets.items():
                self._changes[name] = {**target, **self._changes.get(name, {}), "before": target}
            self._targets.clear()
        self.listening, self._told = False, []
        to_listen = self._wants_to_listen()
        if not to_listen:
            self._ready(link)
        for line in link.greeting.get("warnings", []):
            self._warn(line)
        updated = time.monotonic()
        while not self._stop.is_set():
            try:
                fields, where = self._jobs.get(timeout=0.1)
            except queue.Empty:
                fields = None
            if to_listen and (fields is not None or {"x", "y", "depth"} <= set(self._platform)):
                # nothing jumps while it listens: all that was told is done before
                to_listen = False
                self._update(self._now())
                self._listen(link)
                self._ready(link)
            if fields is None:
                if link.broken:
                    raise ConnectionError(link.broken)
                if self.listening and \
                        (time.monotonic() - updated) * self.settings.factor >= self.settings.update:
                    updated = time.monotonic()
                    self._update(self._now())
                continue
            self._ping(fields, where)

    def _ready(self, link):
        self._emit("ready", {"scenario": link.greeting["scenario"], "listening": self.listening,
                             "channels": link.greeting["channels"],
                             "sample_rate": link.greeting["sample_rate"]})

    def _wants_to_listen(self):
        s = self.settings
        return s.pace != "fast" and \
            (s.delivery == "listen" or s.delivery == "auto" and not s.receiver)

    def _check_pace(self, pace):
        wanted = "fast" if self.settings.pace == "fast" else self.settings.factor
        has = pace if pace == "fast" else 1.0 if pace == "real" else float(pace)
        if has != wanted:
            raise ValueError(f"asdic serve: found --pace {pace}, expected --pace {wanted} as the "
                             "clock goes here")

    @staticmethod
    def _named(known, name, what):
        for one in known:
            if not name or one["name"] == name:
                return one
        raise ValueError(f"{what}: found {shown(name)}, expected one of "
                         + ", ".join(one["name"] for one in known))

    def _now(self):
        """The scenario's time [s]."""
        return max(self._clock() - self._origin, 0.0)

    def _listen(self, link):
        """Begins to hear, where the server can."""
        s = self.settings
        try:
            # its answer comes before its blocks, but is taken by another thread: both wait here
            with self._due:
                self._format, _ = link.call("listen", block=s.block)
                self._heard_of = stream.Heard(self._format["sample_rate"])
                self._pending.clear()
            self.listening = True
        except Refused as no:
            if no.code != "command" or s.delivery == "listen":
                raise
            return
        if s.receiver and s.scenario:
            Path(s.folder).mkdir(parents=True, exist_ok=True)
            rate = self._format["sample_rate"] if "carrier" in self._format else None
            self._twin = stream.Twin(s.scenario, s.arguments, s.folder, rate, s.program)
            for at, change in self._told:
                self._twin.update(at, change)
        elif s.receiver:
            self.error("the receiver rests: found no Scenario in the settings, expected that of "
                       "the server")

    def _heard(self, answer, samples):
        """A block of a stream."""
        with self._due:
            form = self._format
            self._heard_of.add(answer["time"], samples)
            oldest = min((job["start"] for job in self._pending), default=np.inf)
            self._heard_of.forget(min(oldest, self._heard_of.end - self._keep_heard))
            if self._pending and self._heard_of.end >= min(job["end"] for job in self._pending):
                self._due.notify_all()
        self._emit("samples", {
            "block": answer["block"], "time": self._origin + answer["time"],
            "sample_rate": form["sample_rate"], "carrier": form.get("carrier", 0.0),
            "behind": answer.get("behind", 0.0), "data": samples, **self._geometry()})

    def _geometry(self):
        place = self._place
        return {"x": place[0], "y": place[1], "depth": place[2]}

    # Changes --------------------------------------------------------------------------------------

    def _update(self, t):
        """Tells the server what has come. Each thing by itself: one that is refused is told and
        forgotten. → whether the platform is where the vehicle is
        """
        with self._lock:
            fresh, self._fresh = self._fresh, {"platform": False, "phones": False}
            platform, phones = dict(self._platform), self._phones
            changes, self._changes = self._changes, {}
        if self.listening:
            # told a little ahead, so that what it changes has not sounded yet
            t += max(self.settings.block, 0.5 * self.settings.update)
            if t - self._place_time < 0.5 * self.settings.update:
                with self._lock:
                    for what in fresh:
                        self._fresh[what] |= fresh[what]
                for name, change in changes.items():
                    self._put_back(name, change)
                return self._known_place
        ahead, self._place_time = t - self._place_time, t
        self._step = ahead
        self._place = [self._place[0] + self._velocity[0] * ahead,
                       self._place[1] + self._velocity[1] * ahead, self._place[2]]
        if fresh["platform"]:
            before = list(self._place), self._velocity
            change = {"platform": self._platform_fields(platform, t)}
            if self.settings.array_follows_heading and "heading_deg" in platform and phones is None:
                change["array"] = self._one("array", {"heading_deg": platform["heading_deg"][0]})
            told = self._tell("NAV", t, **change)
            if told is not None:
                self._known_place = told
            if not told:  # pings must not go from elsewhere
                self._place, self._velocity = before
            if told is None:
                with self._lock:
                    self._fresh["platform"] = True
        if fresh["phones"] and \
                self._tell("the array", t, array=self._phone_fields(*phones)) is None:
            with self._lock:
                self._fresh["phones"] = True
        for name, change in changes.items():
            self._update_target(name, change, t)
        return self._known_place

    def _put_back(self, name, change):
        """A target's change for later, before what came since."""
        with self._lock:
            self._changes[name] = {**change, **self._changes.get(name, {})}

    def _tell(self, what, t, **change):
        """→ whether it was taken; None: it came too late, since commands before took long"""
        try:
            if self.settings.pace == "fast" or self.listening:
                change["time"] = t
            answer, _ = self._link.call("update", **change)
            if self._twin is not None:
                self._twin.update(answer["time"], change)
            elif not self.listening and self._wants_to_listen():
                self._told.append((answer["time"], change))
            return True
        except Refused as no:
            if self.listening and str(no).startswith("value: time:"):
                return None
            self.error(f"{what}: {no}")
            return False

    def _one(self, what, fields):
        """With its name, where there are several."""
        if self._several[what + "s"]:
            fields["name"] = (self._platform_now if what == "platform" else self._array_now)["name"]
        return fields

    def _platform_fields(self, known, t):
        """The place now, by the latest fix and how it moves."""
        place, velocity = list(self._place), self._velocity
        fields = {}
        if "speed" in known or "heading_deg" in known:
            speed = known.get("speed", (math.hypot(*velocity), 0))[0]
            heading = known.get("heading_deg", (math.degrees(math.atan2(*velocity)), 0))[0]
            velocity = quantities.velocity_of(speed, heading)
            if speed >= 0:
                fields = {"speed": speed, "heading_deg": heading}
            else:  # astern
                fields = {"velocity": [*velocity, 0.0]}
        for k, name in enumerate(("x", "y", "depth")):
            if name in known:
                value, stamp = known[name]
                place[k] = value + (velocity[k] * (t - self._since(stamp)) if k < 2 else 0.0)
        place, late = self._slewed(self._place, place)
        if late:
            self._warn("the vehicle is not where it was going while it listens: it goes there at "
                       f"{SLEW:g} m/s")
            with self._lock:
                self._fresh["platform"] = True
        self._place, self._velocity = place, velocity
        fields["position"] = list(place)
        return self._one("platform", fields)

    def _slewed(self, expected, wanted):
        """While listening nothing jumps: → the place on the way from where it was going to where it
        is said to be, and whether that is not reached.
        """
        if not self.listening:
            return wanted, False
        off = np.subtract(wanted, expected)
        reach = SLEW * min(self._step, max(self.settings.block, 0.5 * self.settings.update))
        distance = float(np.linalg.norm(off))
        if distance <= reach:
            return wanted, False
        return [float(e + o * reach / distance) for e, o in zip(expected, off)], True

    def _since(self, stamp):
        return stamp - self._origin

    def _phone_fields(self, places, stamp):
        """The world's places → from the platform, where it was then."""
        with self._lock:
            known = dict(self._platform)
        fix = list(self._place)
        for k, name in enumerate(("x", "y")):
            if name in known:
                fix[k] = known[name][0] + self._velocity[k] * (stamp - known[name][1])
        if "depth" in known:
            fix[2] = known["depth"][0]
        rows = [[one - at for one, at in zip(row, fix)] for row in places]
        return self._one("array", {"positions": rows, "offset": [0.0, 0.0, 0.0]})

    def _update_target(self, name, change, t):
        """Tells what is said of a target. If that is refused the latest message is forgotten."""
        before = change.pop("before", None)
        where = f"{change['where']}: {name}"
        if change.get("remove") == "true":
            if name in self._known_targets and \
                    self._tell(where, t, targets=[{"name": name, "remove": True}]):
                self._known_targets.discard(name)
            with self._lock:
                self._targets.pop(name, None)
            return
        known = self._carried_on(name, t)
        whole = {**known, **change}
        fields = {"name": name}
        if "strength_db" in change:
            fields["strength_db"] = change["strength_db"]
        if "heading_deg" in change:
            fields["heading_deg"] = change["heading_deg"]
            if "speed" in whole:
                fields["speed"] = whole["speed"]
        if "x" in change:
            east, north = self._velocity_of(whole)
            ahead = t - self._since(change["time"])
            place = [change["x"] + east * ahead, change["y"] + north * ahead, change["depth"]]
            if "x" in known:
                place, late = self._slewed([known["x"], known["y"], known["depth"]], place)
                if late:
                    self._warn(f"{where}: it is not where it was going while it is listened to: it "
                               f"goes there at {SLEW:g} m/s")
                    self._put_back(name, {**change, "before": {}})
            whole |= dict(zip(("x", "y", "depth"), place))
            fields["position"] = place
        whole["time"] = self._origin + t
        told = self._tell(where, t, targets=[fields])
        if told:
            self._known_targets.add(name)
            with self._lock:
                self._targets[name] = whole
            return
        if told is None:
            self._put_back(name, change)
            return
        if known:
            with self._lock:
                self._targets[name] = known
        if before:
            self._update_target(name, before, t)

    @staticmethod
    def _velocity_of(target):
        return quantities.velocity_of(target.get("speed", 0.0), target.get("heading_deg", 0.0))

    def _carried_on(self, name, t):
        """What is known of a target, where it is at t."""
        with self._lock:
            known = dict(self._targets.get(name, {}))
        if "x" in known:
            east, north = self._velocity_of(known)
            ahead = t - self._since(known["time"])
            known |= {"x": known["x"] + east * ahead, "y": known["y"] + north * ahead,
                      "time": self._origin + t}
        return known

    # Pings ----------------------------------------------------------------------------------------

    def _ping(self, fields, where):
        t = self._now()
        if not self._update(t):
            self.error(f"{where}: the ping is not sent, since it is not known where from")
            return
        try:
            ping = self._sent(fields, t)
        except Refused as no:
            self.error(f"{where}: {no}")
            return
        answer = ping.answer
        number, at = answer["ping"], self._origin + answer["time"]
        self._emit("ping", {"number": number, "time": at, "scenario_time": answer["time"],
                            "elevation_deg": answer["elevation_deg"],
                            "transmitter": answer["transmitter"],
                            **{k: v for k, v in fields.items() if k in
                               ("source_level_db", "beamwidth_deg", "waveform")},
                            **self._geometry(), "file": answer.get("file")})
        self._emit("truth", {"ping": number, "time": at, "truth": [
            {"target": one["name"], **{k: one[k] for k in TRUTH if k in one}}
            for one in answer.get("targets", [])]})
        for line in answer.get("warnings", []):
            self._warn(line)
        taken = {"ping": number, "latency": answer["latency"], "behind": answer.get("behind", 0.0)}
        if self._twin is not None:
            self._await_record(fields, answer, taken)
            return
        end = at
        if answer.get("samples", {}).get("shape") and not self.listening and \
                self.settings.delivery != "none":
            end = self._deliver(ping, number, at)
        if answer.get("file") and self._files_here:
            taken["receiver"] = self._receive(answer["file"], number, at, end, self._place,
                                              self._velocity)
        self._hold(end, "latency", taken)  # the last of the ping

    def _await_record(self, fields, answer, taken):
        """While listening: the ping's record is cut out of the stream when all of it was heard."""
        try:
            file = self._twin.ping(answer["time"], fields)
        except (Refused, OSError) as error:
            self.error(f"the receiver has nothing of ping {answer['ping']}: {error}")
            self._emit("latency", taken)
            return
        what = file["samples"]
        start = answer["time"] + what["start"]
        end = start + what["shape"][1] / self._format["sample_rate"]
        with self._due:
            self._pending.append({"start": start, "end": end, "count": what["shape"][1],
                                  "file": file, "time": answer["time"], "taken": taken,
                                  "place": list(self._place), "velocity": self._velocity})
            self._due.notify_all()

    def _cut_records(self):
        """Records that are complete → files, detections, tracks."""
        while not self._stop.is_set():
            with self._due:
                job = next((j for j in self._pending
                            if j["end"] <= self._heard_of.end + 1e-6), None)
                if job is None:
                    self._due.wait(0.5)
                    continue
                self._pending.remove(job)
                data = self._heard_of.cut(job["start"], job["count"])
            taken, file = job["taken"], job["file"]
            at, end = self._origin + job["time"], self._origin + job["end"]
            if data is None:
                self.error(f"the record of ping {taken['ping']} is not whole: too much was heard "
                           "since")
            else:
                try:
                    stream.put_samples(file["file"], file["index"], data)
                    _, replica, _ = self._of_file(file)
                    self._save(data, replica, file, taken["ping"], at, end)
                    taken["receiver"] = self._receive(file["file"], taken["ping"], at, end,
                                                      job["place"], job["velocity"])
                except (ValueError, OSError, ImportError) as error:
                    self.error(f"the receiver has nothing of ping {taken['ping']}: {error}")
            self._hold(end, "latency", taken)

    _warned = ()

    def _warn(self, line):
        """Once each."""
        if line not in self._warned and len(self._warned) < 100:
            self._warned = (*self._warned, line)
            self.error(f"warning: {line}")

    def _sent(self, fields, t):
        """→ Ping, as the settings want it delivered"""
        when = {"time": t} if self.settings.pace == "fast" else {}
        if self.listening or self.settings.delivery == "none":
            return self._link.ping(deliver="none", **when, **fields)
        if self._wants_files() and self._files_here:
            try:
                return self._link.ping(deliver="file", **when, **fields)
            except Refused as no:
                if "deliver" not in str(no):
                    raise
                self._files_here = False
                self.error("the receiver rests: asdic serve writes no files, expected it with "
                           "--output-dir")
        return self._link.ping(deliver="samples", replica=True, **when, **fields)

    def _deliver(self, ping, number, at):
        """Samples in blocks, each due when its last sample would be received, and the files.
        → when the record ends
        """
        what = ping.answer["samples"]
        if ping.samples is not None:
            data, replica, phones = ping.samples, ping.replica, None
        else:
            data, replica, phones = self._of_file(ping.answer)
        if data is None:
            return at
        rate, start = what["sample_rate"], what["start"]
        length = max(int(round(self.settings.block * rate)), 1)
        count = data.shape[1]
        for k, first in enumerate(range(0, count, length)):
            block = np.ascontiguousarray(data[:, first:first + length])
            begins = at + start + first / rate
            self._hold(begins + block.shape[1] / rate, "samples", {
                "ping": number, "block": k, "time": begins, "sample_rate": rate,
                "carrier": what.get("carrier", 0.0), "data": block, "phones": phones,
                **self._geometry()})
        end = at + start + count / rate
        self._save(data, replica, ping.answer, number, at, end)
        return end

    def _save(self, data, replica, answer, number, at, end):
        """The record and the pulse as files, due at `end`."""
        what = answer["samples"]
        folder = Path(self.settings.folder)
        try:
            folder.mkdir(parents=True, exist_ok=True)
            names = [(folder / f"ping-{number:06d}-{kind}.npy").resolve()
                     for kind in ("data", "replica")]
            np.save(names[0], data)
            if replica is not None:
                np.save(names[1], replica)
        except OSError as error:
            self.error(f"{folder}: {error.strerror}")
            return
        self._keep([*names, *([Path(answer["file"])] if "file" in answer else [])])
        self._hold(end, "files", {"ping": number, "data": str(names[0]),
                                  "replica": str(names[1]) if replica is not None else None,
                                  "sample_rate": what["sample_rate"],
                                  "carrier": what.get("carrier", 0.0),
                                  "start": at + what["start"]})

    def _of_file(self, answer):
        """Samples, pulse and places of a ping file. → [phones × samples], [samples], [phones ×
        3]; or three times None: it is not here
        """
        try:
            import h5py
            with h5py.File(answer["file"]) as f:
                k = answer["index"]
                data, pulse = f[answer["dataset"]][k], f["replica"][:]
                phones = f["phone_position"][k]
        except (ImportError, OSError, KeyError) as error:
            if self._files_here:
                self.error(f"the ping's file cannot be read here, so there are neither samples nor "
                           f"detections: {error}")
            self._files_here = False
            return None, None, None
        data, pulse = (np.ascontiguousarray(x).view("<c8")[..., 0] if complex_too else x
                       for x, complex_too in ((data, data.ndim == 3), (pulse, pulse.ndim == 2)))
        return data, pulse, phones

    def _keep(self, names):
        """The oldest files go."""
        self._files.append(names)
        while len(self._files) > max(self.settings.files_kept, 1):
            for name in self._files.pop(0):
                name.unlink(missing_ok=True)

    def _receive(self, path, number, at, end, place, velocity):
        """Detections and tracks, due when the record ends. → seconds it took"""
        begun = time.monotonic()
        try:
            found, count = receiver.process(self.settings.program, path,
                                            self.settings.receiver_options,
                                            self.settings.most_detections)
        except (receiver.ReceiverError, OSError) as error:
            self.error(f"asdic process: {error}")
            return None
        self._hold(end, "detections", {"ping": number, "of": count, "ping_time": at, "time": end,
                                       "detections": found})
        tracks = self._tracker.update(at, found, place[:2], velocity)
        self._hold(end, "tracks", {"ping": number, "time": end,
                                   "tracks": [self._track_fields(t, place) for t in tracks]})
        return time.monotonic() - begun

    @staticmethod
    def _track_fields(track, place):
        away = track.state[:2] - np.asarray(place[:2])
        x, y, vx, vy = map(float, track.state)
        return {"track": track.number, "time": track.time, "x": x, "y": y, "vx": vx, "vy": vy,
                "speed": math.hypot(vx, vy), "heading_deg": math.degrees(math.atan2(vx, vy)) % 360,
                "range": float(np.hypot(*away)),
                "bearing_deg": math.degrees(math.atan2(*away)) % 360,
                "position_sigma": track.position_sigma, "hits": track.hits, "missed": track.missed,
                "ended": bool(track.ended), "snr_db": track.snr_db}

    # Sound paths ----------------------------------------------------------------------------------

    def _answer_requests(self):
        while not self._stop.is_set():
            try:
                asked, where = self._requests.get(timeout=0.2)
            except queue.Empty:
                continue
            with self._lock:
                depth = self._platform.get("depth", (None,))[0]
            ident = {"id": asked["id"]} if "id" in asked else {}
            try:
                if not self.settings.scenario:
                    raise paths.PathsError("found no scenario in the settings, expected one")
                found = paths.answer(self.settings.program, asked, self.settings.scenario, depth,
                                     self.settings.arguments)
            except (paths.PathsError, OSError) as error:
                self.error(f"{where}: {error}")
                found = {"ok": False, **ident, "message": str(error)}
            self._emit("paths", found)

    # Results when they are due --------------------------------------------------------------------

    def _hold(self, due, kind, what):
        """Lets a result go at `due`; at once where there is no clock."""
        if self.settings.pace == "fast":
            self._emit(kind, what)
            return
        size = what["data"].nbytes if kind == "samples" else 0
        with self._due:
            if self._held_bytes + size > MOST_HELD_BYTES:
                full = True
            else:
                full = False
                self._held_bytes += size
                heapq.heappush(self._held, (due, next(self._count), kind, what))
                self._due.notify()
        if full:
            self.error(f"ping {what['ping']}: a block of samples is lost: more than "
                       f"{MOST_HELD_BYTES} bytes wait for their time")

    def _let_go(self):
        while True:
            with self._due:
                if self._stop.is_set():
                    return
                if not self._held:
                    self._due.wait(0.5)
                    continue
                late = self._clock() - self._held[0][0]
                if late < 0:
                    self._due.wait(min(-late / max(self.settings.factor, 1e-9), 0.5))
                    continue
                _, _, kind, what = heapq.heappop(self._held)
                if kind == "samples":
                    self._held_bytes -= what["data"].nbytes
            self._emit(kind, what)

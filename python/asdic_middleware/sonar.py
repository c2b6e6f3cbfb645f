"""The sonar of a vehicle: the pings made of what is known of it by `asdic serve`, and what becomes
of them. MOOS and ROS tell it what arrives and publish what it emits.

Threads: inputs may come from any. One thread speaks with the server and runs the receiver, one
answers requests of sound paths, one lets results go when they are due, one cuts records out of
what is heard.
"""
import os
import queue
import threading
import time
from pathlib import Path

from .due import Due
from .errors import Errors
from .link import Client, Link, Refused
from .listening import Listening
from .path_requests import PathRequests
from .quantities import Wrong
from .records import Records
from .world import World

MOST_PINGS_WAITING = 8
TRUTH = ("present", "paths", "echo_time", "echo_level_db", "echo_peak_db", "reverberation_db",
         "noise_db", "echo_to_background_db")  # of a target, in a ping's answer


class Sonar:
    """
    clock  Steady, the middleware's time [s]
    emit   called with (kind, dict) for each result, from threads of this class. Kinds: "ping",
           "samples", "files", "detections", "tracks", "truth" (each of a ping, with a list of
           that name), "latency" (the last of a ping), "paths", "error", "ready"
    """

    def __init__(self, settings, clock, emit):
        self.settings, self._clock, self._emit = settings, clock, emit
        self._errors = Errors(emit)
        self._world = World(settings, clock, self._errors)
        self._due = Due(None if settings.pace == "fast" else clock, settings.factor, emit,
                        self._errors.tell)
        self._records = Records(settings, self._due.hold, self._errors.tell)
        self._listening = Listening(settings, self._records, self._due.hold, emit,
                                    self._errors.tell, self._world.geometry)
        self._paths = PathRequests(settings, self._world.depth, emit, self._errors.tell)
        # Inputs, from any thread
        self.set_platform, self.set_target = self._world.set_platform, self._world.set_target
        self.set_phones, self.request_paths = self._world.set_phones, self._paths.put
        self.error = self._errors.tell
        self._jobs = queue.Queue(MOST_PINGS_WAITING)
        self._stop = threading.Event()
        self._link, self._origin = None, 0.0
        self._threads = [
            threading.Thread(target=work, args=of, daemon=True, name=work.__name__.strip("_"))
            for work, of in ((self._work, ()), (self._paths.answer, (self._stop,)),
                             (self._due.let_go, ()),
                             (self._listening.cut_records, (self._stop,)))]

    @property
    def listening(self):
        return self._listening.on

    def start(self):
        self._clock.begin()
        for thread in self._threads:
            thread.start()

    def close(self):
        self._stop.set()
        self._due.stop()
        self._listening.wake()
        link = self._link
        if link is not None:
            link.close()
        for thread in self._threads:
            if thread.is_alive():
                thread.join(timeout=5)

    def ping(self, fields, where):
        """fields: as quantities.ping_of() has them. \\throws Wrong when too many wait"""
        try:
            self._jobs.put_nowait((fields, where))
        except queue.Full:
            raise Wrong(where, f"{MOST_PINGS_WAITING} pings that wait", "fewer; it is not sent") \
                from None

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
                if link is not None:
                    link.close()
                self._listening.close()
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
        link = Link(self._connect(), self._listening.heard)
        self._link = link
        self._origin = self._clock()
        self._check_pace(link.greeting["pace"])
        state = link.call("state")[0]
        self._listening.reset(self._origin)
        self._records.begin()
        self._world.begin(state, self._origin, self._tell)
        to_listen = self._listening.wanted()
        if not to_listen:
            self._ready(link)
        for line in link.greeting.get("warnings", []):
            self._errors.warn(line)
        updated = time.monotonic()
        while not self._stop.is_set():
            if (step := self._clock.stepped()) != 0.0:
                self.error(f"warning: the clock was set by {step:+.0f} s in all; times of this sonar "
                           "go on evenly, as if it had not been, until it is started again")
            try:
                fields, where = self._jobs.get(timeout=0.1)
            except queue.Empty:
                fields = None
            if to_listen and (fields is not None or self._world.has_a_place()):
                # nothing jumps while it listens: all that was told is done before
                to_listen = False
                self._world.update(self._now())
                self._listening.begin(link)
                self._world.listening = self.listening
                self._ready(link)
            if fields is None:
                if link.broken:
                    raise ConnectionError(link.broken)
                if self.listening and \
                        (time.monotonic() - updated) * self.settings.factor >= self.settings.update:
                    updated = time.monotonic()
                    self._world.update(self._now())
                continue
            self._ping(fields, where)

    def _ready(self, link):
        self._emit("ready", {"scenario": link.greeting["scenario"], "listening": self.listening,
                             "channels": link.greeting["channels"],
                             "sample_rate": link.greeting["sample_rate"]})

    def _check_pace(self, pace):
        wanted = "fast" if self.settings.pace == "fast" else self.settings.factor
        has = pace if pace == "fast" else 1.0 if pace == "real" else float(pace)
        if has != wanted:
            raise ValueError(f"asdic serve: found --pace {pace}, expected --pace {wanted} as the "
                             "clock goes here")

    def _now(self):
        """The scenario's time [s]."""
        return max(self._clock() - self._origin, 0.0)

    def _tell(self, what, t, **change):
        """→ whether it was taken; None: it came too late, since commands before took long"""
        try:
            if self.settings.pace == "fast" or self.listening:
                change["time"] = t
            answer, _ = self._link.call("update", **change)
            self._listening.told(answer["time"], change)
            return True
        except Refused as no:
            if self.listening and str(no).startswith("value: time:"):
                return None
            self.error(f"{what}: {no}")
            return False

    # Pings ----------------------------------------------------------------------------------------

    def _ping(self, fields, where):
        t = self._now()
        if not self._world.update(t):
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
                            **self._world.geometry(), "file": answer.get("file")})
        self._emit("truth", {"ping": number, "time": at, "truth": [
            {"target": one["name"], **{k: one[k] for k in TRUTH if k in one}}
            for one in answer.get("targets", [])]})
        for line in answer.get("warnings", []):
            self._errors.warn(line)
        taken = {"ping": number, "latency": answer["latency"], "behind": answer.get("behind", 0.0)}
        if self._listening.has_receiver:
            self._listening.await_record(fields, answer, taken, self._world.place,
                                         self._world.velocity)
            return
        end = at
        if answer.get("samples", {}).get("shape") and not self.listening and \
                self.settings.delivery != "none":
            end = self._records.deliver(ping, number, at, self._world.geometry())
        if answer.get("file") and self._records.files_here:
            taken["receiver"] = self._records.receive(answer["file"], number, at, end,
                                                      self._world.place, self._world.velocity)
        self._due.hold(end, "latency", taken)  # the last of the ping

    def _sent(self, fields, t):
        """→ Ping, as the settings want it delivered"""
        when = {"time": t} if self.settings.pace == "fast" else {}
        if self.listening or self.settings.delivery == "none":
            return self._link.ping(deliver="none", **when, **fields)
        if self._wants_files() and self._records.files_here:
            try:
                return self._link.ping(deliver="file", **when, **fields)
            except Refused as no:
                if "deliver" not in str(no):
                    raise
                self._records.files_here = False
                self.error("the receiver rests: asdic serve writes no files, expected it with "
                           "--output-dir")
        return self._link.ping(deliver="samples", replica=True, **when, **fields)

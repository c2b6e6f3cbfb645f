"""What is heard of a server that listens: blocks as they come, and the records of pings in them."""
import threading
from pathlib import Path

import numpy as np

from . import stream
from .link import Refused


class Listening:
    """
    records   Records, of pings that are cut out of the stream
    hold      called with (due, kind, dict): results that are to be told then
    emit      called with (kind, dict)
    error     called with a line
    geometry  a function: where the vehicle is, of a block
    """

    def __init__(self, settings, records, hold, emit, error, geometry):
        self.settings, self._records, self._hold = settings, records, hold
        self._emit, self._error, self._geometry = emit, error, geometry
        self._due = threading.Condition()
        self._format, self._origin = None, 0.0
        self._twin, self._heard_of, self._pending, self._told = None, None, [], []
        self._keep_heard = 30.0 * settings.factor  # [s]: while the twin works
        self.on, self._waits = False, False  # it listens; it is to listen

    def reset(self, origin):
        """A new session. origin: the middleware's time when the scenario's began [s]"""
        self._origin, self.on, self._told, self._waits = origin, False, [], self.wanted()

    def close(self):
        twin, self._twin = self._twin, None
        if twin is not None:
            twin.close()

    def wake(self):
        """Who waits looks whether it is to stop."""
        with self._due:
            self._due.notify_all()

    @property
    def has_receiver(self):
        return self._twin is not None

    def wanted(self):
        s = self.settings
        able = s.scenario or not s.receiver  # a receiver needs a twin of the server
        return s.pace != "fast" and (s.delivery == "listen" or s.delivery == "auto" and bool(able))

    def told(self, at, change):
        """What the server has taken of the world."""
        if self._twin is not None:
            self._twin.update(at, change)
        elif self._waits:
            self._told.append((at, change))

    def begin(self, link):
        """Begins to hear, where the server can."""
        s, self._waits = self.settings, False
        try:
            # its answer comes before its blocks, but is taken by another thread: both wait here
            with self._due:
                self._format, _ = link.call("listen", block=s.block)
                self._heard_of = stream.Heard(self._format["sample_rate"])
                self._pending.clear()
            self.on = True
        except Refused as no:
            if s.delivery == "listen":
                raise
            if no.code != "command":  # an older server has none
                self._error(f"warning: each ping has its record, since nothing is listened to: {no}")
            return
        if s.receiver and s.scenario:
            Path(s.folder).mkdir(parents=True, exist_ok=True)
            rate = self._format["sample_rate"] if "carrier" in self._format else None
            self._twin = stream.Twin(s.scenario, s.arguments, s.folder, rate, s.program)
            for at, change in self._told:
                self._twin.update(at, change)
        elif s.receiver:
            self._error("the receiver rests: found no Scenario in the settings, expected that of "
                        "the server")

    def heard(self, answer, samples):
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

    def await_record(self, fields, answer, taken, place, velocity):
        """The ping's record is cut out of the stream when all of it was heard."""
        try:
            file = self._twin.ping(answer["time"], fields)
        except (Refused, OSError) as error:
            self._error(f"the receiver has nothing of ping {answer['ping']}: {error}")
            self._emit("latency", taken)
            return
        what = file["samples"]
        start = answer["time"] + what["start"]
        end = start + what["shape"][1] / self._format["sample_rate"]
        with self._due:
            self._pending.append({"start": start, "end": end, "count": what["shape"][1],
                                  "file": file, "time": answer["time"], "taken": taken,
                                  "place": list(place), "velocity": velocity})
            self._due.notify_all()

    def cut_records(self, stop):
        """Records that are complete → files, detections, tracks; until an event."""
        while not stop.is_set():
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
                self._error(f"the record of ping {taken['ping']} is not whole: too much was heard "
                            "since")
            else:
                try:
                    stream.put_samples(file["file"], file["index"], data)
                    _, replica, _ = self._records.of_file(file)
                    self._records.save(data, replica, file, taken["ping"], at, end)
                    taken["receiver"] = self._records.receive(file["file"], taken["ping"], at, end,
                                                      job["place"], job["velocity"])
                except (ValueError, OSError, ImportError) as error:
                    self._error(f"the receiver has nothing of ping {taken['ping']}: {error}")
            self._hold(end, "latency", taken)

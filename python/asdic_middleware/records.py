"""Records of pings: their samples in blocks, their files, and what the receiver finds in them."""
import math
import time
from pathlib import Path

import numpy as np

from . import receiver
from .tracker import Tracker


class Records:
    """
    hold   called with (due, kind, dict): results that are to be told then
    error  called with a line
    """

    def __init__(self, settings, hold, error):
        self.settings, self._hold, self._error = settings, hold, error
        self._files = []
        self.begin()

    def begin(self):
        """A new session."""
        self.files_here = True       # those that the server writes
        self._tracker = Tracker(self.settings.tracker)

    def deliver(self, ping, number, at, geometry):
        """Samples in blocks, each due when its last sample would be received, and the files.
        → when the record ends
        """
        what = ping.answer["samples"]
        if ping.samples is not None:
            data, replica, phones = ping.samples, ping.replica, None
        else:
            data, replica, phones = self.of_file(ping.answer)
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
                **geometry})
        end = at + start + count / rate
        self.save(data, replica, ping.answer, number, at, end)
        return end

    def save(self, data, replica, answer, number, at, end):
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
            self._error(f"{folder}: {error.strerror}")
            return
        self._keep([*names, *([Path(answer["file"])] if "file" in answer else [])])
        self._hold(end, "files", {"ping": number, "data": str(names[0]),
                                  "replica": str(names[1]) if replica is not None else None,
                                  "sample_rate": what["sample_rate"],
                                  "carrier": what.get("carrier", 0.0),
                                  "start": at + what["start"]})

    def of_file(self, answer):
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
            if self.files_here:
                self._error("the ping's file cannot be read here, so there are neither samples nor "
                            f"detections: {error}")
            self.files_here = False
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

    def receive(self, path, number, at, end, place, velocity):
        """Detections and tracks, due when the record ends. → seconds it took"""
        begun = time.monotonic()
        try:
            found, count = receiver.process(self.settings.program, path,
                                            self.settings.receiver_options,
                                            self.settings.most_detections)
        except (receiver.ReceiverError, OSError) as error:
            self._error(f"asdic process: {error}")
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

"""Of a server that listens: what was heard of late, records of pings cut out of it, and files of
them for the
receiver.
"""
import shutil
from collections import deque
from pathlib import Path

import numpy as np

from asdic_client import Client, Refused

MOST_BYTES = 512 << 20


class Heard:
    """The stream's latest samples. rate [Hz]; times are the scenario's [s]."""

    def __init__(self, rate):
        self.rate = rate
        self._blocks, self._bytes = deque(), 0  # (time, [phones × samples])
        self.end = -np.inf

    def add(self, time, data):
        self._blocks.append((time, data))
        self._bytes += data.nbytes
        self.end = time + data.shape[1] / self.rate
        while self._bytes > MOST_BYTES:
            self._bytes -= self._blocks.popleft()[1].nbytes

    def forget(self, before):
        """What ended before a time."""
        while self._blocks and \
                self._blocks[0][0] + self._blocks[0][1].shape[1] / self.rate < before:
            self._bytes -= self._blocks.popleft()[1].nbytes

    def cut(self, start, count):
        """So many samples from a time on. → [phones × count], None if not all of them are there"""
        if not self._blocks:
            return None
        first = round((start - self._blocks[0][0]) * self.rate)
        parts, skip = [], first
        for _, data in self._blocks:
            length = data.shape[1]
            if skip < length:
                parts.append(data[:, max(skip, 0):skip + count])
            skip -= length
            if skip + count <= 0:
                break
        found = np.concatenate(parts, axis=1) if parts else np.empty((0, 0))
        return found if first >= 0 and found.shape[1] == count else None


class Twin:
    """A second server of the same scenario, told the same. Its files of the pings have what the
    receiver must
    know of sonar and sea; the samples in them are replaced by those of the stream.
    """

    def __init__(self, scenario, arguments, folder, rate, program):
        """rate [Hz] of the stream, None unless it is baseband"""
        words = [*arguments, "--pace", "fast", "--output-dir", str(folder)]
        if rate is not None:
            words += ["--set", f"pings.baseband_rate={float(rate)!r}"]
        self._client = Client.start(scenario, *words, program=program)

    def update(self, time, change):
        try:
            self._client.update(**{**change, "time": time})
        except Refused:
            pass  # the other one took it; the ping will tell

    def ping(self, time, fields):
        """→ the answer, with `file`. \\throws Refused, ConnectionError"""
        return self._client.ping(deliver="file", time=time, **fields).answer

    def close(self):
        self._client.process.terminate()
        self._client.close()


def put_samples(path, index, data):
    """Replaces those of one ping in a ping file; whole or not at all. \\throws ValueError,
    OSError
    """
    import h5py
    path, new = Path(path), Path(path).with_suffix(".new")
    shutil.copyfile(path, new)
    with h5py.File(new, "r+") as f:
        place = f["pressure"]
        numbers = data.view("<f4").reshape(*data.shape, 2) if np.iscomplexobj(data) else data
        if place[index].shape != numbers.shape:
            raise ValueError(f"the stream's record has the shape {numbers.shape}, the file's "
                             f"{place[index].shape}")
        place[index] = numbers
    new.replace(path)

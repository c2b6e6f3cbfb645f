"""A client of `asdic serve` (docs/formats/serve.md): standard library and numpy.

    from asdic_client import Client

    with Client.start("scenarios/deep_ocean.toml") as sonar:       # a server of one's own
        sonar.update(platform={"position": [0, 0, 300], "heading_deg": 90, "speed": 2})
        ping = sonar.ping(elevation_deg=5, deliver="samples")
        print(ping.answer["latency"], ping.samples.shape)

    Client.unix("sonar.sock")                                      # or one that is running
    Client.tcp(4711, token=open("token").read().strip())
"""
import collections
import json
import socket
import subprocess

import numpy as np


class Refused(Exception):
    """The server did not carry a command out. `code` is for programs: value, limit, busy, …"""

    def __init__(self, error):
        super().__init__(f"{error.get('code')}: {error.get('message')}")
        self.code = error.get("code")


def _plain(value):
    """Arrays and numbers of numpy, as fixes of a vehicle often are."""
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} cannot be sent")


class Ping:
    """A ping's answer, and its samples if they came with it.

    answer   dict as docs/formats/serve.md has it
    samples  [channels × samples] pressure [Pa]: float32, or complex64 baseband; None without them
    replica  [samples] the pulse of unit peak, of the same type; None unless it was asked for
    """

    def __init__(self, answer, samples):
        self.answer, self.samples = answer, samples
        self.replica = answer.get("replica", {}).get("values")


class Block:
    """Samples of all phones that were received together.

    number   in the session, from 0
    time     of the first sample [s]
    samples  [channels × samples] pressure [Pa]: float32, or complex64 baseband
    behind   after its last sample, by the clock [s]
    """

    def __init__(self, line, samples):
        self.number, self.time, self.behind = line["block"], line["time"], line["behind"]
        self.samples = samples


class Client:
    """One connection; a client of several threads needs a lock. Commands are carried out in order.
    With several under way (send, receive), a refusal may overtake the answers of those that wait:
    tell them by their `id`.
    """

    _FOLLOWS = {"samples": 2, "pressure": 3, "levels": 2}  # what may follow a line, its dimensions

    def __init__(self, reader, writer, token=None, when_full="busy", close=()):
        self._reader, self._writer, self._close = reader, writer, close
        self._id = 0
        self._heard = collections.deque()               # blocks that came while an answer was waited for
        self.scheduled = collections.deque(maxlen=1000) # what is known of pings of the schedule
        hello = {"asdic": 1, "when_full": when_full}
        if token is not None:
            hello["token"] = token
        self._write(hello)
        self.greeting, _ = self.receive()
        if not self.greeting["ok"]:
            self.close()
            raise Refused(self.greeting["error"])

    @classmethod
    def unix(cls, path, **options):
        """To a server's --socket."""
        end = socket.socket(socket.AF_UNIX)
        end.connect(str(path))
        return cls._of_socket(end, options)

    @classmethod
    def tcp(cls, port, token, host="127.0.0.1", **options):
        """To a server's --tcp."""
        end = socket.create_connection((host, port))
        end.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return cls._of_socket(end, {"token": token, **options})

    @classmethod
    def start(cls, scenario, *arguments, program="asdic", **options):
        """Runs `asdic serve SCENARIO ARGUMENTS`, and is its only client."""
        process = subprocess.Popen([program, "serve", str(scenario), *arguments],
                                   stdin=subprocess.PIPE, stdout=subprocess.PIPE)

        class End:
            @staticmethod
            def close():
                process.stdin.close()
                process.wait()
                process.stdout.close()

        try:
            client = cls(process.stdout, process.stdin, close=(End,), **options)
        except ConnectionError:
            raise ConnectionError(f"{program} serve has ended with status {process.wait()}; its "
                                  "standard error says why") from None
        client.process = process
        return client

    @classmethod
    def _of_socket(cls, end, options):
        return cls(end.makefile("rb"), end.makefile("wb"), close=(end,), **options)

    # Commands: each returns when it is answered -------------------------------------------------

    def ping(self, **fields):
        """→ Ping. Keys: time, transmitter, waveform, elevation_deg, beamwidth_deg,
        source_level_db, deliver ("file", "samples", "none"), replica
        """
        return Ping(*self.command("ping", **fields))

    def update(self, **fields):
        """Keys: time, platform, array, targets, wind_speed, sound_speed, noise, seed, recording."""
        return self.command("update", **fields)[0]

    def listen(self, **fields):
        """→ dict. Keys: block, seconds, schedule, stop. The samples: blocks()"""
        return self.command("listen", **fields)[0]

    def blocks(self):
        """Yields each Block as it comes, until it was listened to for `seconds`, or `stop`. Commands
        may be given meanwhile.
        """
        while True:
            heard = self._heard.popleft() if self._heard else self._event(*self.receive())
            if heard is None:
                return
            yield heard

    def _event(self, line, samples):
        """A Block; None after the last one."""
        while "block" not in line:
            if line.get("listening") is False:
                return None
            if "scheduled" not in line:
                raise Refused(line.get("error", {}))
            self.scheduled.append(line)
            line, samples = self.receive()
        return Block(line, samples)
    # The propagation model by itself: what `asdic arrivals`, `rays` and `field` tell.

    def arrivals(self, **fields):
        """→ dict with legs. Keys: time, leg ("target", "array"), target (a name), frequency; or of
        a receiver anywhere: range, receiver_depth, source_depth, bearing_deg
        """
        return self.command("arrivals", **fields)[0]

    def rays(self, **fields):
        """→ dict with rays. Keys: time, from_deg, to_deg, count, elevations_deg, range,
        source_depth, bearing_deg, bounces
        """
        return self.command("rays", **fields)[0]

    def field(self, **fields):
        """→ dict, pressure [sources × depths × ranges] complex64. Keys: time, run (a table)"""
        return self.command("field", **fields)

    def levels(self, **fields):
        """→ dict, [3 × intervals]: mean-square pressure [Pa²] of echo, reverberation and noise that
        the next ping would have. Keys: those of ping, but for deliver and replica
        """
        return self.command("levels", **fields)

    def state(self):
        return self.command("state")[0]

    def save(self, **fields):
        """→ dict: file, or with deliver="text" toml: the scenario as it is by now; ping: which of
        its pings is the next one
        """
        return self.command("save", **fields)[0]

    def limits(self):
        return self.command("limits")[0]["limits"]

    def cancel(self, of=None):
        """Calls off the command with an id, that send() gave, or all that were sent before. → the
        id of this one. Its answer and those of the cancelled are had by receive().
        """
        return self.send("cancel") if of is None else self.send("cancel", of=of)

    def quit(self):
        answer, _ = self.command("quit")
        self.close()
        return answer

    def command(self, command, **fields):
        """→ answer, samples. \\throws Refused"""
        sent = self.send(command, **fields)
        answer, samples = self.receive()
        while "id" not in answer:  # it answers no command
            if "scheduled" in answer:
                self.scheduled.append(answer)
            else:
                self._heard.append(self._event(answer, samples))
            answer, samples = self.receive()
        if not answer["ok"]:
            raise Refused(answer["error"])
        assert answer["id"] == sent
        return answer, samples

    # A line at a time, for those who keep several commands under way ------------------------------

    def send(self, command, **fields):
        """→ the command's id, which its answer has"""
        self._id += 1
        self._write({"id": self._id, "command": command, **fields})
        return self._id

    def receive(self):
        """The next answer. → dict, array or None"""
        line = self._reader.readline()
        if not line.endswith(b"\n"):
            raise ConnectionError("the server has closed the connection")
        answer = json.loads(line)
        is_complex, samples = False, None
        for name, dimensions in self._FOLLOWS.items():  # real and imaginary part: one more
            what = answer.get(name, {})
            if "shape" in what:
                is_complex = len(what["shape"]) > dimensions
            if "bytes" in what:
                samples = self._numbers(what, is_complex)
                break
        if "replica" in answer:
            answer["replica"]["values"] = self._numbers(answer["replica"], is_complex)
        return answer, samples

    def _numbers(self, what, is_complex):
        data = self._reader.read(what["bytes"])
        if len(data) != what["bytes"]:
            raise ConnectionError("the server has closed the connection within samples")
        numbers = np.frombuffer(data, "<f4").reshape(what["shape"])
        return numbers.view("<c8")[..., 0] if is_complex else numbers

    def _write(self, message):
        line = json.dumps(message, allow_nan=False, default=_plain)
        self._writer.write(line.encode() + b"\n")
        self._writer.flush()

    def close(self):
        for end in self._close:
            if isinstance(end, socket.socket):
                try:
                    end.shutdown(socket.SHUT_RDWR)  # a thread that waits for an answer waits no longer
                except OSError:
                    pass
        for end in (self._writer, self._reader, *self._close):
            try:
                end.close()
            except OSError:
                pass  # it was closed from the other side
        self._close = ()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

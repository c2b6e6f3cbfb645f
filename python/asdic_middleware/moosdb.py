"""A client of MOOSDB: connects, registers, notifies, keeps alive, and comes back when it was
lost.
"""
import math
import select
import socket
import threading
import time
from collections import deque

from . import packets
from .packets import Malformed, Message, Type

KEEP_ALIVE = 1.0  # seconds between signs of life
SILENCE = 10.0    # of the database, after which it is taken for lost: it answers signs of life
MOST_WAITING = 4096
MOST_WAITING_BYTES = 256 << 20


class Clock:
    """MOOSTime: seconds since 1970, warp times as fast, and `skew` ahead of this machine's, which
    is how much the database's clock is, on another machine.
    """

    def __init__(self, warp=1.0):
        self.warp = warp
        self.skew = 0.0

    def own(self):
        return self.warp * time.time()

    def __call__(self):
        return self.own() + self.skew


class Refused(Exception):
    """The database does not take this client: its reason."""


class MoosDB:
    """
    variables  to register: {name: interval [s]}
    received   called with each Message of a variable, in the reader's thread
    lost       called with a reason, a line, when a connection breaks or cannot be made; once a loss
    up         called after each connection, when the variables are registered

    notify() never waits: while there is no database, and when it takes too slowly, what is oldest
    is dropped, and counted in `dropped`.
    """

    def __init__(self, host, port, name, clock, variables, received, lost, up=lambda: None):
        self.host, self.port, self.name, self.clock = host, port, name, clock
        self.variables, self._received, self._lost, self._up = variables, received, lost, up
        self.community = ""
        self.connected = False
        self.connections = self.malformed = self.dropped = 0
        self._out, self._out_bytes, self._lock = deque(), 0, threading.Lock()
        self._wake_end, self._wake = socket.socketpair()
        self._wake.setblocking(False)
        self._wake_end.setblocking(False)
        self._stop = threading.Event()
        self._next_id = 0
        self._said = None
        self._thread = threading.Thread(target=self._run, name="moosdb", daemon=True)

    def start(self):
        self._thread.start()

    def close(self):
        self._stop.set()
        self._stir()
        self._thread.join(timeout=5)

    def notify(self, variable, value, time=None):
        message = packets.notify(variable, value, self.clock() if time is None else time)
        message.source = self.name
        with self._lock:
            self._next_id += 1
            message.id = self._next_id
            self._out.append(message)
            self._out_bytes += len(message.text)
            while len(self._out) > MOST_WAITING or self._out_bytes > MOST_WAITING_BYTES:
                self._out_bytes -= len(self._out.popleft().text)
                self.dropped += 1
        self._stir()

    def _stir(self):
        try:
            self._wake.send(b"!")
        except OSError:
            pass  # it is awake

    def _run(self):
        while not self._stop.is_set():
            end = None
            try:
                end = self._connect()
                self._said = None
                self._serve(end)
            except (OSError, Malformed, Refused) as error:
                self._tell(error)
            finally:
                self.connected = False
                if end is not None:
                    end.close()
            self._stop.wait(1.0)

    def _tell(self, error):
        if self._stop.is_set():
            return
        if isinstance(error, Malformed):
            self.malformed += 1
        reason = f"MOOSDB at {self.host}:{self.port}: {error}"
        if reason != self._said:  # once, not every second
            self._said = reason
            self._lost(reason)

    def _connect(self):
        end = socket.create_connection((self.host, self.port), timeout=5)
        try:
            end.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            hello = packets.hello(self.name, self.clock.own())
            end.sendall(packets.GREETING + packets.packed([hello]))
            welcome = packets.unpacked(self._packet(end))
            if not welcome or welcome[0].type not in (Type.WELCOME, Type.REFUSED):
                raise Malformed("found no welcome, expected one after the handshake")
            if welcome[0].type == Type.REFUSED:
                raise Refused("refused: " + welcome[0].str_value[:200])
            self.community = welcome[0].community
            host = welcome[0].source_aux.partition("hostname=")[2]
            self._elsewhere = host not in ("", socket.gethostname())
            self._skews = []
            registrations = []
            for variable, interval in self.variables.items():
                one = packets.register(variable, interval)
                one.source = self.name
                one.time = self.clock()
                registrations.append(one)
            end.sendall(packets.packed([packets.timing(self.clock.own()), *registrations]))
        except BaseException:
            end.close()
            raise
        return end

    @staticmethod
    def _packet(end):
        """One packet, of a blocking socket."""
        def exactly(count):
            data = bytearray()
            while len(data) < count:
                more = end.recv(min(count - len(data), 1 << 20))
                if not more:
                    raise ConnectionError("closed the connection")
                data += more
            return bytes(data)
        head = exactly(packets.HEAD.size)
        return head + exactly(packets.length_of(head) - packets.HEAD.size)

    def _serve(self, end):
        """Until the connection breaks: reads and writes as either is possible."""
        self.connected = True
        self.connections += 1
        end.setblocking(False)
        if not self._elsewhere:
            self._up()
        coming, going = bytearray(), b""
        heard = said = time.monotonic()
        while not self._stop.is_set():
            if not going:
                going = self._next_packet()
            now = time.monotonic()
            if not going and now - said >= KEEP_ALIVE:
                going = packets.packed([packets.timing(self.clock.own())])
            if now - heard > SILENCE:
                raise ConnectionError(f"nothing came for {SILENCE:g} s")
            readable, writable, _ = select.select([end, self._wake_end], [end] if going else [], [],
                                                  0.25)
            if self._wake_end in readable:
                self._wake_end.recv(4096)
            if end in writable:
                going = going[end.send(going[:1 << 20]):]
                said = time.monotonic()
            if end in readable:
                data = end.recv(1 << 20)
                if not data:
                    raise ConnectionError("closed the connection")
                heard = time.monotonic()
                coming += data
                self._take(coming)

    def _next_packet(self):
        """The oldest messages that wait, about a mebibyte of them."""
        messages, size = [], 0
        with self._lock:
            while self._out and size < 1 << 20:
                messages.append(self._out.popleft())
                size += len(messages[-1].text)
            self._out_bytes -= size
        return packets.packed(messages) if messages else b""

    def _take(self, coming):
        """Whole packets from the front of what came."""
        while len(coming) >= packets.HEAD.size:
            length = packets.length_of(bytes(coming[:packets.HEAD.size]))
            if len(coming) < length:
                return
            packet = bytes(coming[:length])
            del coming[:length]
            for message in packets.unpacked(packet):
                if message.type == Type.TIMING:
                    self._compare(message)
                elif message.type == Type.NOTIFY and message.key in self.variables:
                    self._received(message)

    def _compare(self, answer):
        """The database's clock against this one's: it told its time half way between question and
        answer. Of the latest the one that took the shortest is the best.
        """
        if not self._elsewhere:
            return
        now, asked = self.clock.own(), answer.time
        if not 0 <= now - asked <= 10 * self.clock.warp or not math.isfinite(answer.value):
            return
        self._skews = [*self._skews[-15:], (now - asked, answer.value - (asked + now) / 2)]
        first = len(self._skews) == 1
        self.clock.skew = min(self._skews)[1]
        if first:
            self._up()


__all__ = ["Clock", "Message", "MoosDB", "Refused"]

"""Receives a block stream of `asdic serve` (docs/formats/stream.md): standard library and numpy.

    from asdic_stream import Ring, Stream

    for block in Stream("239.1.2.3", 4711):        # a group; or an address of this machine
        print(block.time, block.samples.shape, block.lost)

    for block in Ring("/dev/shm/asdic"):           # on the same machine
        print(block.time, block.samples.shape, block.lost)

A client's `listen` with "deliver": "udp" or "ring" makes it begin. `about` is what the latest
descriptor says: sample_rate, carrier, positions of the phones. By UDP a stream is one sender's, with
one number: whatever else comes to the port is left aside, counted and reported.
"""
import collections
import ipaddress
import json
import mmap
import socket
import struct
import time
import warnings

import numpy as np

HEADER = struct.Struct("<2sBBIIHHQ")  # "AS", version, kind, sequence, block, fragment, fragments, stream
VERSION = 2
DESCRIPTOR, BLOCK = 0, 1
PAYLOAD = 1408
TYPES = {"float32": "<f4", "complex64": "<c8"}
WINDOW = 4          # blocks later than one that lacks a piece, until it is given up
LONGEST_GAP = 65536  # blocks or packets
LONGEST_DELAY = 4096  # packets
LONGEST_DESCRIPTOR = 4096  # fragments
MOST_DESCRIPTORS = 4       # incomplete descriptors that are kept
SILENCE = 5.0              # of the sender, after which another sender's stream may be joined [s]


class Block:
    """Samples of all phones that were received together.

    number   in the session, from 0
    time     of the first sample [s]
    samples  [channels × samples] pressure [Pa]: float32, or complex64 baseband
    lost     blocks directly before it that did not come whole
    about    the descriptor that it came after: dict
    """

    def __init__(self, number, time, samples, lost, about):
        self.number, self.time, self.samples, self.lost = number, time, samples, lost
        self.about = about


def _ahead(number, of):
    """How far a number of 32 bits, which wraps, lies after another."""
    return (number - of + 0x80000000) % 0x100000000 - 0x80000000


def _read(text):
    """A descriptor; None: it is none, or tells what cannot be."""
    try:
        about = json.loads(text)
        whole = [about[key] for key in ("block", "channels", "block_samples")]
        numbers = [about[key] for key in ("time", "sample_rate")]
        sound = (all(type(n) is int and 0 <= n < 2**53 for n in whole) and all(whole[1:])
                 and all(type(x) in (int, float) and abs(x) < 1e300 for x in numbers) and numbers[1] > 0
                 and about["type"] in TYPES and isinstance(about["stream"], str)
                 and len(about["positions"]) == about["channels"] and len(about["arrays"]) > 0)
    except (ValueError, KeyError, TypeError, RecursionError):
        return None
    return about if sound else None


class Assembler:
    """Puts packets together into blocks, in order, without sockets. For any input memory stays bounded.

    It is bound to the sender and the number of the stream that it joins at a descriptor. It takes the
    sender's next stream when that begins, and another sender's stream when its own has ended or has
    been silent for SILENCE seconds.

    packets, lost, reordered, duplicates, foreign   packets so far
    others                                          packets of other streams so far
    blocks, lost_blocks                             blocks so far
    """

    def __init__(self):
        self.packets = self.lost = self.reordered = self.duplicates = self.foreign = self.others = 0
        self.blocks = self.lost_blocks = 0
        self.about, self.ended, self.sender = None, False, None
        self._stream, self._over = None, False  # its number; whether it has ended
        self._heard = 0.0       # time of its last packet [s]
        self._partial = {}      # number → [first sequence, fragments, {fragment: bytes}]
        self._own, self._strange = {}, {}  # descriptors: key → [fragments, {fragment: bytes}]
        self._next = self._before = self._begin = self._latest = 0
        self._anchor = 0, 0     # block of the latest descriptor, and sequence after it
        self._seen = set()

    def take(self, packet, sender=None, now=0.0):
        """Takes a packet → list of the Blocks that it completes

        sender: any value that distinguishes senders; now: time by a clock that never goes back [s]
        """
        if not HEADER.size < len(packet) <= HEADER.size + PAYLOAD:
            self.foreign += 1
            return []
        magic, version, kind, sequence, block, fragment, fragments, stream = HEADER.unpack_from(packet)
        payload = packet[HEADER.size:]
        if (magic != b"AS" or version != VERSION or kind > 1 or fragment >= fragments
                or (fragment + 1 < fragments and len(payload) != PAYLOAD)):
            self.foreign += 1
            return []
        first = (sequence - fragment) % 0x100000000
        piece = first, fragment, fragments, payload
        if self.about is None or (sender, stream) != (self.sender, self._stream):
            if self.about is not None and not self._over:
                self.others += sender != self.sender
                self.foreign += sender == self.sender and kind == BLOCK
            if kind == DESCRIPTOR:
                about = self._descriptor(self._strange, (sender, stream), *piece)
                if about and not about.get("ended") and about["stream"] == f"{stream:016x}" and \
                        self._may_join(first, sender, now):
                    self._join(about, first, fragments, sender, stream, now)
            return []
        self._heard = now
        far = self._is_far(sequence)  # after a long gap only a descriptor counts
        if not far and not self._is_new(sequence):
            return []
        if kind == DESCRIPTOR:
            about = self._descriptor(self._own, None, *piece)
            return self._described(about, first, fragments, far) if about else []
        self.foreign += far
        return [] if far else self._put(block, *piece)

    def _is_far(self, sequence):
        return not -LONGEST_DELAY < _ahead(sequence, self._latest) <= LONGEST_GAP

    def _may_join(self, first, sender, now):
        if self.about is None or self._over or now > self._heard + SILENCE:
            return True
        return sender == self.sender and (_ahead(first, self._latest) > 0 or self._is_far(first))

    def _is_new(self, sequence):
        step = _ahead(sequence, self._latest)
        if step > 0:
            self.lost += step - 1
            self._latest = sequence
            if len(self._seen) > 2 * LONGEST_DELAY:
                self._seen = {s for s in self._seen if _ahead(s, sequence) > -LONGEST_DELAY}
        elif _ahead(sequence, self._begin) < 0:
            self.foreign += 1
            return False
        elif sequence in self._seen:
            self.duplicates += 1
            return False
        else:
            self.reordered += 1
            self.lost -= self.lost > 0
        self._seen.add(sequence)
        self.packets += 1
        return True

    def _descriptor(self, waiting, whose, first, fragment, fragments, payload):
        """Takes a fragment of a descriptor → its content once it is complete; otherwise None"""
        if fragments > LONGEST_DESCRIPTOR:
            self.foreign += 1
            return None
        known, pieces = waiting.setdefault((whose, first), (fragments, {}))
        if known != fragments:
            self.foreign += 1
            return None
        pieces.setdefault(fragment, payload)
        if len(pieces) < fragments:
            while len(waiting) > MOST_DESCRIPTORS:
                waiting.pop(next(iter(waiting)))
            return None
        del waiting[whose, first]
        about = _read(b"".join(pieces[i] for i in range(fragments)))
        self.foreign += about is None
        return about

    def _join(self, about, first, fragments, sender, stream, now):
        """Begins or joins a stream; packets sent before its descriptor do not belong to it."""
        after = (first + fragments) % 0x100000000
        if self.about is None or sender != self.sender or self._is_far(first):
            self._latest = (first - 1) % 0x100000000
        self.lost += max(_ahead(first, self._latest) - 1, 0)
        self._seen = {(first + i) % 0x100000000 for i in range(fragments)}
        self._latest = (after - 1) % 0x100000000
        self.packets += fragments
        self._partial.clear()
        self._own.clear()
        self._strange.clear()
        self.sender, self._stream, self._heard = sender, stream, now
        self._next, self._before, self._begin = about["block"], 0, first
        self.ended = self._over = False
        self._tell(about, after)

    def _tell(self, about, after):
        self.about, self._type, self._anchor = about, np.dtype(TYPES[about["type"]]), (about["block"], after)
        self._row = about["channels"] * self._type.itemsize
        self._longest = self._row * about["block_samples"]

    def _described(self, about, first, fragments, far):
        """Takes a descriptor of the joined stream."""
        if about["stream"] != self.about["stream"] or self._over:
            return []
        given, after = [], (first + fragments) % 0x100000000
        if far:
            if about["block"] < self._next:
                self.foreign += 1
                return []
            self.lost += max(_ahead(first, self._latest) - 1, 0)
            self.packets += fragments
            self._seen, self._begin = {(first + i) % 0x100000000 for i in range(fragments)}, first
            self._latest = (after - 1) % 0x100000000
        if far or about.get("ended"):
            given = self._pass(about["block"])
        if about.get("ended"):
            self._partial.clear()
            self.ended = self._over = True
        elif about["block"] >= self._anchor[0]:  # not if it is a late repetition
            self._tell(about, after)
        return given

    def _put(self, block, first, fragment, fragments, payload):
        number = self._next + _ahead(block, self._next % 0x100000000)
        size = (fragments - 1) * PAYLOAD + (len(payload) if fragment + 1 == fragments else 1)
        whole = -(-self._longest // PAYLOAD)  # packets of a block
        known, after = self._anchor
        if (not self._next <= number <= self._next + LONGEST_GAP or _ahead(first, self._begin) < 0
                or (number - known) * whole > max(_ahead(first, after), 0)  # packets sent before it, at the least
                or size > self._longest or (fragment + 1 == fragments and size % self._row)):
            self.foreign += 1
            return []
        given = self._pass(number - WINDOW + 1) if number >= self._next + WINDOW else []
        partial = self._partial.setdefault(number, (first, fragments, {}))
        if partial[:2] != (first, fragments):
            self.foreign += 1
            return given
        partial[2].setdefault(fragment, payload)
        return given + self._whole()

    def _whole(self):
        given = []
        while self._next in self._partial and len(self._partial[self._next][2]) == self._partial[self._next][1]:
            _, fragments, pieces = self._partial.pop(self._next)
            content = b"".join(pieces[i] for i in range(fragments))
            samples = np.frombuffer(content, self._type).reshape(self.about["channels"], -1)
            after = (self._next - self.about["block"]) * self.about["block_samples"]
            given.append(Block(self._next, self.about["time"] + after / self.about["sample_rate"], samples,
                               self._before, self.about))
            self._before = 0
            self._next += 1
            self.blocks += 1
        return given

    def _lose(self, blocks):
        self._before += blocks
        self.lost_blocks += blocks
        self._next += blocks

    def _pass(self, block):
        """Whatever comes before a block is given, or lost."""
        given = self._whole()
        while self._next < block:
            self._partial.pop(self._next, None)
            known = min((n for n in self._partial if n > self._next), default=block)
            self._lose(min(known, block) - self._next)
            given += self._whole()
        return given


class Stream:
    """Blocks as they come, until the stream has ended.

    host        a group, which is joined; or an address of this machine: "0.0.0.0" for all
    interface   address of the interface on which a group is joined
    timeout     after so many seconds without a packet it ends with TimeoutError; None: it waits
    """

    def __init__(self, host, port, interface="", timeout=None):
        address = ipaddress.ip_address(socket.getaddrinfo(host, port)[0][4][0])
        self._end = socket.socket(socket.AF_INET if address.version == 4 else socket.AF_INET6, socket.SOCK_DGRAM)
        self._end.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 24)  # the system may give less
        if address.is_multicast:  # several on one machine may listen to it
            self._end.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self._end.bind((str(address), port))
        if address.is_multicast and address.version == 4:
            self._end.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                                 address.packed + socket.inet_aton(interface or "0.0.0.0"))
        elif address.is_multicast:
            self._end.setsockopt(socket.IPPROTO_IPV6, socket.IPV6_JOIN_GROUP,
                                 address.packed + struct.pack("@I", socket.if_nametoindex(interface) if interface else 0))
        self._end.settimeout(timeout)
        self.assembler = Assembler()
        self._ready = collections.deque()
        self._warned = False

    @property
    def about(self):
        """The latest descriptor: dict; None before the first."""
        return self.assembler.about

    def __iter__(self):  # again after the end: the next stream
        self.assembler.ended = False
        return self

    def __next__(self):
        while not self._ready:
            if self.assembler.ended:
                raise StopIteration
            packet, sender = self._end.recvfrom(65536)
            bound, others = self.assembler.sender, self.assembler.others
            self._ready.extend(self.assembler.take(packet, sender, time.monotonic()))
            if bound not in (None, self.assembler.sender):
                warnings.warn(f"the stream comes from {sender[0]}:{sender[1]} now, before from "
                              f"{bound[0]}:{bound[1]}", stacklevel=2)
            elif self.assembler.others > others and not self._warned:
                self._warned = True
                warnings.warn(f"another stream comes to this port, from {sender[0]}:{sender[1]}; "
                              f"it is left aside", stacklevel=2)
        return self._ready.popleft()

    def close(self):
        self._end.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


class Ring:
    """Blocks out of the ring of a server on this machine (`asdic serve --ring PATH`), until the stream ends.
    A stream that begins later is read from its first block.

    oldest    begin with the oldest block that is there, in place of the next one that comes
    timeout   after so many seconds without a block it ends with TimeoutError; None: it waits

    Blocks whose place another had before they were read are counted in `lost` of the next one.
    """

    HEADER, SLOT = struct.Struct("<8sII9Q"), struct.Struct("<QQqdQQ")
    SLOT_BYTES = 64
    STREAMING, GONE = 1, 2

    def __init__(self, path, oldest=False, timeout=None):
        with open(path, "rb") as file:
            self._map = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
        magic, version, state, stream, written, slots, *_ = self.HEADER.unpack_from(self._map)
        if magic != b"ASDICRNG" or version != 1:
            raise ValueError(f"{path}: found no ring of asdic, expected one of version 1")
        self.about, self._text_turn, self._timeout = None, None, timeout
        self._next = self._lost = 0
        self._stream = self._done = None  # the one that is read; the one before it
        if state == self.STREAMING and stream % 2 == 0:
            self._stream, self._next = stream, max(0, written - slots + 1) if oldest else written
        elif not oldest:
            self._done = stream

    def __iter__(self):
        return self

    def __next__(self):
        begin = time.monotonic()
        while True:
            _, _, state, stream, written, slots, step, first, *text = self.HEADER.unpack_from(self._map)
            if self._stream is None and stream % 2 == 0 and stream != self._done and written > 0:
                self._stream, self._next, self._lost = stream, 0, 0
            if self._stream is not None:
                if stream != self._stream:  # another one has begun
                    self._end()
                if written > self._next:
                    block = self._block(self._next, written, slots, step, first, text)
                    if block:
                        return block
                    continue
                if state != self.STREAMING and self.HEADER.unpack_from(self._map)[4] == self._next:
                    self._end()
            elif state == self.GONE:
                raise StopIteration
            if self._timeout is not None and time.monotonic() > begin + self._timeout:
                raise TimeoutError(f"no block within {self._timeout} s")
            time.sleep(0.0005)

    def _end(self):
        self._stream, self._done = None, self._stream
        raise StopIteration

    def _block(self, n, written, slots, step, first, text):
        """The block before which n were written; None: it was overtaken."""
        at = first + n % slots * step
        _, after, number, when, samples, size = self.SLOT.unpack_from(self._map, at)
        if after == n + 1 and size <= step - self.SLOT_BYTES:
            content = self._map[at + self.SLOT_BYTES:at + self.SLOT_BYTES + size]
            self._describe(*text)
            before, = struct.unpack_from("<Q", self._map, at)
            if before == n + 1 and self.HEADER.unpack_from(self._map)[3] == self._stream:
                rows = np.frombuffer(content, TYPES[self.about["type"]]).reshape(-1, samples)
                block = Block(number, when, rows, self._lost, self.about)
                self._next, self._lost = n + 1, 0
                return block
        ahead = max(n + 1, written - slots // 2)  # with room, so that it is not overtaken at once
        self._lost += ahead - n
        self._next = ahead
        return None

    def _describe(self, begin, _room, turn, size):
        while turn != self._text_turn:
            if turn % 2 == 0:
                content = self._map[begin:begin + size]
                if self.HEADER.unpack_from(self._map)[-2] == turn:
                    self.about, self._text_turn = json.loads(content), turn
                    return
            *_, turn, size = self.HEADER.unpack_from(self._map)

    def close(self):
        self._map.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

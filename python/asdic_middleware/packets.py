"""The packets that MOOSDB and its clients exchange by TCP (docs/formats/middleware.md).

A packet: length [4 bytes, with these], number of messages [4], 0 [1], the messages. A message:

    length [4]  with these
    id [4]      counted by the sender; -1 of what belongs to the protocol
    type [1]    see Type
    data [1]    D: number, S: text, B: bytes
    source, source's auxiliary, community, key: each length [4] and bytes
    time, value, second value: 8 bytes each
    text: length [4] and bytes

All little endian; numbers are IEEE doubles.
"""
import struct
from dataclasses import dataclass

GREETING = b"ELKS CAN'T DANCE 2/8/10".ljust(32, b"\0")
LONGEST_PACKET = 64 << 20
SHORTEST_MESSAGE = 4 + 4 + 1 + 1 + 4 * 4 + 3 * 8 + 4
HEAD = struct.Struct("<iiB")


class Type:
    """What messages are for."""

    HELLO = "i"  # client: its name; source's welcome to it, or refusal:
    WELCOME = "W"
    REFUSED = "K"
    NOTIFY = "N"
    REGISTER = "R"
    REGISTER_PATTERN = "*"
    UNREGISTER = "U"
    TIMING = "T"  # keeps the connection alive; the answer has the time of the database


class Malformed(ValueError):
    """Bytes that are no packet."""


@dataclass
class Message:
    """text holds the bytes of a text or a binary value; `str_value` is its text."""

    type: str
    key: str = ""
    data: str = "D"
    value: float = 0.0
    text: bytes = b""
    source: str = ""
    source_aux: str = ""
    community: str = ""
    time: float = 0.0
    second: float = -1.0
    id: int = -1

    @property
    def str_value(self):
        return self.text.decode("utf-8", "replace")


def packed(messages):
    """→ bytes of one packet"""
    body = b"".join(map(_message, messages))
    return HEAD.pack(HEAD.size + len(body), len(messages), 0) + body


def _message(m):
    strings = b"".join(struct.pack("<i", len(s)) + s for s in
                       (one.encode() for one in (m.source, m.source_aux, m.community, m.key)))
    body = (struct.pack("<icc", m.id, m.type.encode("latin-1"), m.data.encode("latin-1")) + strings
            + struct.pack("<dddi", m.time, m.value, m.second, len(m.text)) + m.text)
    return struct.pack("<i", len(body) + 4) + body


def length_of(head):
    """Of a packet by its first HEAD.size bytes, before more of it is read. \\throws Malformed"""
    length, count, packing = HEAD.unpack(head)
    if packing != 0:
        raise Malformed(f"a compressed packet ({packing})")
    if not HEAD.size <= length <= LONGEST_PACKET:
        raise Malformed(f"a packet of {length} bytes")
    if not 0 <= count <= (length - HEAD.size) // SHORTEST_MESSAGE:
        raise Malformed(f"{count} messages in {length} bytes")
    return length


def unpacked(packet):
    """→ list of Message. \\throws Malformed"""
    if len(packet) < HEAD.size or length_of(packet[:HEAD.size]) != len(packet):
        raise Malformed(f"{len(packet)} bytes that are no packet")
    messages, at = [], HEAD.size
    for _ in range(HEAD.unpack_from(packet)[1]):
        if at + 4 > len(packet):
            raise Malformed("a packet that breaks off")
        length, = struct.unpack_from("<i", packet, at)
        if not SHORTEST_MESSAGE <= length <= len(packet) - at:
            raise Malformed(f"a message of {length} bytes")
        messages.append(_unpack(packet, at + 4, at + length))
        at += length
    if at != len(packet):
        raise Malformed(f"{len(packet) - at} bytes after the last message")
    return messages


def _unpack(packet, at, end):
    ident, kind, data = struct.unpack_from("<icc", packet, at)
    at += 6
    words = []
    for _ in range(4):
        word, at = _bytes(packet, at, end)
        words.append(word.decode("utf-8", "replace"))
    if at + 24 > end:
        raise Malformed("a message that breaks off")
    time, value, second = struct.unpack_from("<ddd", packet, at)
    text, at = _bytes(packet, at + 24, end)
    if at != end:
        raise Malformed("a message longer than its parts")
    source, aux, community, key = words
    return Message(kind.decode("latin-1"), key, data.decode("latin-1"), value, text, source, aux,
                   community, time, second, ident)


def _bytes(packet, at, end):
    if at + 4 > end:
        raise Malformed("a message that breaks off")
    length, = struct.unpack_from("<i", packet, at)
    if not 0 <= length <= end - at - 4:
        raise Malformed(f"a string of {length} bytes")
    return bytes(packet[at + 4:at + 4 + length]), at + 4 + length


def hello(name, time):
    return Message(Type.HELLO, data="S", key="asynchronous", text=name.encode(), time=time,
                   value=-1.0)


def register(variable, interval=0.0):
    """interval [s]: no more often than this; 0 every time"""
    return Message(Type.REGISTER, variable, value=interval)


def timing(time):
    return Message(Type.TIMING, "_async_timing", time=time)


def notify(variable, value, time):
    """value: number, text, or bytes"""
    if isinstance(value, bytes):
        return Message(Type.NOTIFY, variable, "B", -1.0, value, time=time)
    if isinstance(value, str):
        return Message(Type.NOTIFY, variable, "S", -1.0, value.encode(), time=time)
    return Message(Type.NOTIFY, variable, "D", float(value), time=time)

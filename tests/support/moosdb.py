"""A small MOOSDB for tests, written from the protocol (docs/formats/middleware.md) and apart from
the client that it tests. It keeps the latest value of each variable, sends those that are asked
for, and
can say what no database would.

    with SmallMoosDB() as db:
        db.post("NAV_X", 100.0)
        db.wait("ACTIVE_SONAR_PING", lambda m: "number=1" in m["text"])
"""
import socket
import struct
import threading
import time

GREETING = b"ELKS CAN'T DANCE 2/8/10" + bytes(9)


def string(data):
    data = data.encode() if isinstance(data, str) else data
    return struct.pack("<i", len(data)) + data


def packet(*messages):
    """messages: dicts of kind, data, key, value, second, text, source, aux, community, time, id"""
    body = b""
    for m in messages:
        one = struct.pack("<i", m.get("id", -1)) + m["kind"].encode() + m.get("data", "D").encode()
        for name in ("source", "aux", "community", "key"):
            one += string(m.get(name, ""))
        one += struct.pack("<ddd", m.get("time", 0.0), m.get("value", 0.0), m.get("second", -1.0))
        one += string(m.get("text", b""))
        body += struct.pack("<i", len(one) + 4) + one
    return struct.pack("<iiB", 9 + len(body), len(messages), 0) + body


def messages(data):
    """Of one packet."""
    assert struct.unpack_from("<i", data)[0] == len(data), "a packet's length"
    count, at = struct.unpack_from("<i", data, 4)[0], 9
    found = []
    for _ in range(count):
        end = at + struct.unpack_from("<i", data, at)[0]
        m = {"id": struct.unpack_from("<i", data, at + 4)[0], "kind": chr(data[at + 8]),
             "data": chr(data[at + 9])}
        at += 10
        for name in ("source", "aux", "community", "key"):
            length = struct.unpack_from("<i", data, at)[0]
            m[name] = data[at + 4:at + 4 + length].decode()
            at += 4 + length
        m["time"], m["value"], m["second"] = struct.unpack_from("<ddd", data, at)
        length = struct.unpack_from("<i", data, at + 24)[0]
        m["bytes"] = data[at + 28:at + 28 + length]
        m["text"] = m["bytes"].decode("utf-8", "replace")
        assert at + 28 + length == end, "a message's length"
        at = end
        found.append(m)
    assert at == len(data), "a packet's messages"
    return found


class SmallMoosDB:
    """hostname, ahead: of a machine whose clock is so far ahead [s of MOOSTime]"""

    def __init__(self, port=0, warp=1.0, hostname=None, ahead=0.0):
        self.warp, self.ahead, self.hostname = warp, ahead, hostname or socket.gethostname()
        self.values, self.log, self.clients = {}, [], {}
        self.changed = threading.Condition(threading.RLock())
        self.door = socket.socket()
        self.door.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.door.bind(("127.0.0.1", port))
        self.door.listen()
        self.port = self.door.getsockname()[1]
        self.open = True
        threading.Thread(target=self._doorkeeper, daemon=True).start()

    def now(self):
        return time.time() * self.warp + self.ahead

    def _doorkeeper(self):
        while self.open:
            try:
                end, _ = self.door.accept()
            except OSError:
                return
            threading.Thread(target=self._client, args=(end,), daemon=True).start()

    def _client(self, end):
        name = None
        try:
            read = end.makefile("rb")
            if read.read(32) != GREETING:
                return
            hello = self._next(read)[0]
            assert (hello["kind"], hello["data"], hello["key"]) == ("i", "S", "asynchronous"), hello
            with self.changed:
                if hello["text"] in self.clients:
                    end.sendall(packet({"kind": "K", "data": "S", "value": -1.0,
                                        "text": f'A client of this name ("{hello["text"]}") already exists'}))
                    return
                name = hello["text"]
                self.clients[name] = {"end": end, "wants": set()}
                end.sendall(packet({"kind": "W", "aux": f"hostname={self.hostname}", "community": "small",
                                    "time": self.now(), "value": 0.0, "text": "asynchronous"}))
                self.changed.notify_all()
            while True:
                for m in self._next(read):
                    self._take(name, end, m)
        except (OSError, EOFError, struct.error, AssertionError) as error:
            if isinstance(error, AssertionError):
                self.log.append({"key": "FAULT", "text": str(error)})
        finally:
            with self.changed:
                if name is not None:
                    self.clients.pop(name, None)
                self.changed.notify_all()
            end.close()

    @staticmethod
    def _next(read):
        head = read.read(4)
        if len(head) < 4:
            raise EOFError
        length = struct.unpack("<i", head)[0]
        body = read.read(length - 4)
        if len(body) < length - 4:
            raise EOFError
        return messages(head + body)

    def _take(self, name, end, m):
        with self.changed:
            if m["kind"] == "T":
                end.sendall(packet({"kind": "T", "key": m["key"], "time": m["time"],
                                    "value": self.now(), "second": 0.0}))
            elif m["kind"] == "R":
                self.clients[name]["wants"].add(m["key"])
                self.changed.notify_all()
                if m["key"] in self.values:
                    self._send(end, self.values[m["key"]])
            elif m["kind"] == "N":
                self._spread(m)

    def _spread(self, m):
        with self.changed:
            self.values[m["key"]] = m
            self.log.append(m)
            for client in list(self.clients.values()):
                if m["key"] in client["wants"]:
                    self._send(client["end"], m)
            self.changed.notify_all()

    def _send(self, end, m):
        try:
            end.sendall(packet({**m, "community": "small", "text": m["bytes"]}))
        except OSError:
            pass

    def post(self, key, value, source="test"):
        """As if a client had: number, text or bytes."""
        data = "D" if isinstance(value, (int, float)) else "S" if isinstance(value, str) else "B"
        text = b"" if data == "D" else value.encode() if data == "S" else value
        self._spread({"id": 1, "kind": "N", "data": data, "key": key, "source": source, "aux": "",
                      "value": float(value) if data == "D" else -1.0, "second": -1.0,
                      "time": self.now(), "bytes": text, "text": text.decode("utf-8", "replace")})

    def raw(self, name, data):
        """Bytes to a client that may be anything."""
        self.clients[name]["end"].sendall(data)

    def of(self, key):
        with self.changed:
            return [m for m in self.log if m["key"] == key]

    def wait(self, key, holds=lambda m: True, seconds=300, after=0):
        """→ the first message of a variable that holds, of those after so many. \\throws
        TimeoutError
        """
        with self.changed:
            found = []

            def there():
                found[:] = [m for m in self.of(key)[after:] if holds(m)]
                return found

            if not self.changed.wait_for(there, seconds):
                said = [m["text"] for m in self.of("ACTIVE_SONAR_ERROR")][-5:]
                raise TimeoutError(f"no {key} within {seconds} s; errors: {said}")
            return found[0]

    def wait_client(self, name, wants=None, seconds=300):
        with self.changed:
            if not self.changed.wait_for(lambda: name in self.clients and (
                    wants is None or wants in self.clients[name]["wants"]), seconds):
                raise TimeoutError(f"no client {name} within {seconds} s")

    def close(self):
        self.open = False
        try:
            self.door.shutdown(socket.SHUT_RDWR)  # wakes who waits at it
        except OSError:
            pass
        self.door.close()
        with self.changed:
            for client in self.clients.values():
                try:
                    client["end"].shutdown(socket.SHUT_RDWR)
                except OSError:
                    pass

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

#!/usr/bin/env python3
"""Lines that no client should send: commands with bytes changed, cut off or doubled, bytes of chance, values past all
ends. Each is answered by a line of JSON, an error mostly, and the server goes on, in the memory that it had.

    ASDIC=build/ci/bin/asdic hostile.py [LINES]      default 20 000; ASDIC_DEEP=1: 1 000 000
"""
import json
import os
import random
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
ASDIC = str(Path(os.environ["ASDIC"]).resolve())
DEEP = os.environ.get("ASDIC_DEEP") == "1"
COMMANDS = [
    '{"id": 7, "command": "state"}',
    '{"id": 7, "command": "update", "platform": {"heading_deg": 12}}',
    '{"id": 7, "command": "update", "targets": [{"name": "x", "position": [1e308, 0, 0]}]}',
    '{"id": 7, "command": "update", "noise": {"spectral_level_db": 1e400}}',
    '{"id": 7, "command": "ping", "deliver": "none", "time": -5}',
    '{"id": 7, "command": "cancel", "of": 3}',
    '{"id": 7, "command": "listen", "block": 1e-9}',
    '{"id": 7, "command": "listen", "stop": true}',
    '{"id": 7, "command": "arrivals", "receiver": [0, 0, -1]}',
    '{"id": 7, "command": "save", "file": "/nowhere"}',
    '{"id": 7, "command": "levels", "x": [[[[[[1]]]]]]}',
]
AT_ONCE, OF_A_CLIENT = 50, 5000  # lines


def hostile(chance):
    line = bytearray(chance.choice(COMMANDS).encode())
    kind = chance.random()
    if kind < 0.5:
        for _ in range(chance.randint(1, 6)):
            line[chance.randrange(len(line))] = chance.randrange(256)
    elif kind < 0.6:
        del line[chance.randrange(1, len(line)):]
    elif kind < 0.7:
        begin = chance.randrange(len(line))
        end = chance.randrange(begin, len(line))
        line[begin:begin] = line[begin:end] * chance.randint(1, 8)
    elif kind < 0.8:
        line = bytearray(chance.randbytes(chance.randint(1, 200)))
    text = bytes(line).replace(b"\n", b" ").replace(b"\r", b" ")
    return text if text.strip() and b"quit" not in text else b"{"


def resident(process):
    with open(f"/proc/{process.pid}/status") as status:
        return int(next(line for line in status if line.startswith("VmRSS")).split()[1])


def dialled(path, greeting=b'{"asdic": 1, "when_full": "wait"}\n'):
    for _ in range(600):
        try:
            end = socket.socket(socket.AF_UNIX)
            end.connect(path)
            break
        except OSError:
            end.close()
            time.sleep(0.05)
    lines = end.makefile("rb")
    end.sendall(greeting)
    assert json.loads(lines.readline())["ok"]
    return end, lines


def answers(lines, count):
    """The next answers, without what comes of itself and without what follows a line."""
    while count > 0:
        line = lines.readline()
        assert line, "the server closed the connection"
        answer = json.loads(line)
        follows = answer.get("samples")
        if isinstance(follows, dict):
            lines.read(follows.get("bytes", 0))
        if "ok" in answer:
            count -= 1
            yield answer


def main():
    wanted = int(sys.argv[1]) if len(sys.argv) > 1 else (1_000_000 if DEEP else 20_000)
    chance = random.Random(7)
    codes, sizes = {}, []
    with tempfile.TemporaryDirectory() as folder:
        path = str(Path(folder) / "sonar.sock")
        server = subprocess.Popen([ASDIC, "serve", ROOT / "scenarios" / "isovelocity.toml", "--socket", path],
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            begun = time.monotonic()
            for first in range(0, wanted, OF_A_CLIENT):
                end, lines = dialled(path)
                for _ in range(0, min(OF_A_CLIENT, wanted - first), AT_ONCE):
                    end.sendall(b"".join(hostile(chance) + b"\n" for _ in range(AT_ONCE)))
                    for answer in answers(lines, AT_ONCE):
                        code = "ok" if answer["ok"] else answer["error"]["code"]
                        codes[code] = codes.get(code, 0) + 1
                lines.close()
                end.close()
                sizes.append(resident(server))  # a session has been
            late = len(sizes) * 3 // 4
            grown = max(sizes[late:]) - max(sizes[:late])
            assert sum(codes.values()) >= wanted, codes
            assert {"ok", "json", "value", "command"} <= codes.keys() and "internal" not in codes, codes
            assert grown < 16384, f"{grown} kB more"
            end, lines = dialled(path)
            end.sendall(b'{"id": 1, "command": "state"}\n')
            assert next(answers(lines, 1))["ok"], "it still answers"
            assert server.poll() is None
            print(f"{wanted} lines in {time.monotonic() - begun:.1f} s: {codes}; {max(sizes)} kB, "
                  f"{max(grown, 0)} of it in the last quarter")
        finally:
            server.terminate()
            server.wait()


main()

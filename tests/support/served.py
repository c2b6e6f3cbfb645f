"""`asdic serve` for tests in Python: the program (ASDIC), a small sea that it serves, servers, and what clients are
refused. Its client is python/asdic_client.py.
"""
import contextlib
import os
import re
import signal
import socket
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
if str(ROOT / "python") not in sys.path:
    sys.path.insert(0, str(ROOT / "python"))
from asdic_client import Refused  # noqa: E402
from checks import check  # noqa: E402

ASDIC = str(Path(os.environ["ASDIC"]).resolve())
_TABLES = {
    "environment": 'wind_speed = 8.0\nsound_speed = { kind = "isovelocity", speed = 1500.0 }',
    "environment.bottom": 'depth = 1000.0\nkind = "rigid"',
    "platform": "position = [0.0, 0.0, 200.0]",
    "transmitter": "source_level_db = 200.0\nbeamwidth_deg = 20.0",
    "pulse": 'kind = "cw"\nfrequency = 1000.0\nduration = 0.1\nwindow = "hann"',
    "array": 'kind = "horizontal"\nphones = 4\nspacing = 0.75',
    "[target]": 'name = "rock"\nposition = [3000.0, 0.0, 500.0]\nstrength_db = 10.0',
    "noise": "spectral_level_db = 40.0",
    "pings": 'count = 3\ninterval = 10.0\nrecording_duration = 6.0\nsamples = "baseband"',
}


def sea(first="seed = 5", more="", **tables):
    """A small sea as TOML. `first` stands before its tables, `more` after them.
    :param tables: lines of a table in place of those that it has ("target": the only one of several); ""
        leaves it out, and another name is one more
    """
    wanted = {name: tables.pop(name.strip("[]"), lines) for name, lines in _TABLES.items()} | tables
    parts = [f"[{name}]\n{lines.strip()}" for name, lines in wanted.items() if lines]
    return "\n".join([first.strip(), *parts, more.strip(), ""])


def resident(process):
    """Memory that a process has now [kB]."""
    text = Path(f"/proc/{process.pid}/status").read_text()
    return int(re.search(r"VmRSS:\s+(\d+)", text).group(1))


def free_port():
    """That no socket for datagrams has."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as end:
        end.bind(("127.0.0.1", 0))
        return end.getsockname()[1]


@contextlib.contextmanager
def server(*arguments, listens=1, scenario="sea.toml", **environment):
    """→ process, what it said on standard error until it listened"""
    process = subprocess.Popen([ASDIC, "serve", str(scenario), *arguments], stdin=subprocess.DEVNULL,
                               stderr=subprocess.PIPE, text=True, env={**os.environ, **environment})
    said = ""
    while said.count("listening on") < listens:
        line = process.stderr.readline()
        check(line, f"the server ended: {said}")
        said += line
    try:
        yield process, said
    finally:
        process.send_signal(signal.SIGINT)
        try:
            process.wait(timeout=30)
        except subprocess.TimeoutExpired:
            process.kill()
            raise
        process.stderr.close()
        check(process.returncode == 0, f"exit status {process.returncode}")


def refused(code, work, says=""):
    """What is refused says why, and nothing that is the server's secret."""
    try:
        work()
    except Refused as error:
        check(error.code == code and says in str(error), f"{error}, expected {code}: {says}")
        check("SECRET" not in str(error), str(error))
        return
    raise AssertionError(f"not refused: {code}")

#!/usr/bin/env python3
"""Memory has a budget: what would take more than run.memory is refused by one message that names the key to
turn, in `validate` and in the run alike, before it is taken; what is not refused stays within it.

    ASDIC=build/ci/bin/asdic memory.py
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
ASDIC = Path(os.environ["ASDIC"]).resolve()
DATA = ROOT / "tests/data/pulse-files"
OWN = 120e6  # the program, its libraries and threads

SHALLOW = """
[environment]
wind_speed = 5.0
[environment.sound_speed]
kind = "isovelocity"
speed = 1525.0
[environment.bottom]
depth = 19.0
kind = "fluid"
speed = 1680.0
density = 1950.0
attenuation_db_per_wavelength = 0.6
[platform]
position = [0.0, 0.0, 17.8]
[transmitter]
source_level_db = 200.0
taper = "omnidirectional"
[pulse]
kind = "cw"
frequency = 3400.0
duration = 0.1
window = "hann"
[array]
kind = "horizontal"
phones = 1
spacing = 0.2
[noise]
spectral_level_db = 50.0
[reverberation.bottom]
kind = "lambert"
[propagation]
max_surface_bounces = 50
max_bottom_bounces = 50
[pings]
recording_duration = 4.0
samples = "baseband"
"""


def check(good, what):
    if not good:
        sys.exit(f"FAILED: {what}")


def run(*words):
    """\\return status, what was said, most memory [bytes]"""
    with tempfile.TemporaryFile("w+") as said:
        process = subprocess.Popen([ASDIC, *map(str, words)], stdout=said, stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(process.pid, 0)
        said.seek(0)
        return os.waitstatus_to_exitcode(status), said.read(), 1024.0 * usage.ru_maxrss


def sets(settings):
    return [word for setting in settings for word in ("--set", setting)]


def refused(command, scenario, settings, key):
    for words in (["validate"], command):
        status, said, memory = run(*words, scenario, *sets(settings))
        check(status == 2 and key in said and "or a larger run.memory" in said,
              f"{words} {settings}: status {status}: {said}")
        check(memory < OWN + 200e6, f"{words} {settings}: {memory / 1e6:.0f} MB to refuse it")
        check(len([line for line in said.splitlines() if "found" in line]) == 1, f"one message: {said}")
    print(f"refused, {memory / 1e6:.0f} MB: {said.strip()}")


def kept(command, scenario, settings, most):
    """A run that is not refused stays within what validate tells of it, and that is no wild guess."""
    status, said, _ = run("validate", scenario, *sets(settings))
    check(status == 0, f"validate {settings}: {said}")
    number, unit = re.search(r"takes at most about ([0-9.]+) (\w+)", said).groups()
    told = float(number) * {"bytes": 1.0, "kB": 1e3, "MB": 1e6, "GB": 1e9}[unit]
    status, said, memory = run(*command, scenario, *sets(settings), "-q")
    check(status == 0, f"{command} {settings}: {said}")
    check(memory < OWN + told, f"{command} {settings}: {memory / 1e6:.0f} MB, told {told / 1e6:.0f} MB")
    check(told < most * memory, f"{command} {settings}: told {told / 1e6:.0f} MB, took {memory / 1e6:.0f} MB")
    print(f"kept: told {told / 1e6:.0f} MB, took {memory / 1e6:.0f} MB: {command} {settings}")


ping = ["ping", "-o", "p.h5"]
field = ["field", "-o", "f.h5"]
folder = tempfile.mkdtemp(prefix="asdic-memory-")
try:
    os.chdir(folder)
    Path("shallow.toml").write_text(SHALLOW)
    deep = ROOT / "scenarios/deep_ocean.toml"
    refused(ping, "shallow.toml", ["run.memory=100 MB", "reverberation.ground_spacing=0.3"],
            "reverberation.ground_spacing")
    refused(ping, deep, ["pulse={kind=\"cw\", frequency=3000.0, duration=1e-6}", "run.memory=500 MB"], "pulse.duration")
    refused(ping, deep, ["pings.recording_duration=50000", "run.memory=1 GB"], "pings.recording_duration")
    refused(field, ROOT / "scenarios/wedge.toml", ["run.receivers.range={first=1, last=4000, count=100000}",
                                                   "run.receivers.depth={first=1, last=200, count=2000}",
                                                   "run.memory=2 GB"], "run.receivers")
    kept(ping, "shallow.toml", ["propagation.max_bottom_bounces=20", "propagation.max_surface_bounces=20"], 4.0)
    kept(field, ROOT / "scenarios/wedge.toml", ["run.receivers.range={first=1, last=4000, count=50}",
                                                "run.receivers.depth={first=1, last=200, count=12000}"], 4.0)
    status, said, memory = run("validate", deep, "--set", f'pulse={{kind="file", file="{DATA}/claims-250M-samples.flac"}}')
    check(status == 2 and "found 0 samples, where its header claims 250000000" in said, said)
    check(memory < OWN, f"a FLAC of 44 bytes takes {memory / 1e6:.0f} MB")
finally:
    os.chdir("/")
    shutil.rmtree(folder)

#!/usr/bin/env python3
"""A signal ends every command within two seconds of processor time, whatever it is computing; what is ignored stays so.

ASDIC=path/to/asdic tests/app/validation/stops_soon.py
"""
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from deep import DEEP  # noqa: E402

ASDIC = os.environ["ASDIC"]
ALLOWED = 2.0  # of processor time [s]; each run below takes half a minute and more

# Fifty bounces of either kind in 19 m of water: thousands of path pairs at each of a million scatterers.
SHALLOW = """
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
offset = [0.0, 0.0, -0.8]
[noise]
spectral_level_db = 50.0
[reverberation]
ground_spacing = 0.1
[reverberation.bottom]
kind = "lambert"
mu_db = -27.0
[propagation]
max_surface_bounces = 50
max_bottom_bounces = 50
[pings]
recording_duration = 4.0
samples = "baseband"
"""
STUDY = """
[study]
scenario = "shallow.toml"
realisations = 20
[vary]
"noise.spectral_level_db" = { law = "uniform", low = 40.0, high = 50.0 }
[measure]
series_level = true
"""
# Hundreds of arrivals at each of 40 000 receivers over a rough, range-dependent sea floor.
FIELD = """
[environment.sound_speed]
kind = "munk"
[environment.bottom]
kind = "rigid"
[environment.bottom.shape]
range = [0.0, 20e3, 40e3, 60e3, 80e3, 100e3]
depth = [5000.0, 4000.0, 5000.0, 4200.0, 5000.0, 4500.0]
[run]
task = "TASK"
frequency = 500.0
[run.source]
depth = 1000.0
[run.receivers]
depth = { first = 10.0, last = 4000.0, count = 200 }
range = { first = 500.0, last = 100e3, count = 200 }
"""

BUOY = SHALLOW.replace("max_surface_bounces = 50\nmax_bottom_bounces = 50", "max_surface_bounces = 1").replace(
    "ground_spacing = 0.1", "enabled = false") + """
[[target]]
range = 2000.0
bearing_deg = 0.0
depth = 12.0
strength_db = 10.0
"""
# Some 300 maps of 6400 cells in 40 draws.
PLAN = """
[placement]
scenario = "buoy.toml"
sensors = 6
draws = 40
ranges = 400
target_depths = [12.0]
map_error = "cells"
[placement.places]
east = [-4e3, 4e3]
north = [-2e3, 2e3]
step = 500.0
[placement.cells]
east = [-4e3, 4e3]
north = [-4e3, 4e3]
step = 100.0
[[placement.option]]
name = "low"
[[placement.option]]
name = "high"
set = { "pulse.frequency" = 2000.0 }
[vary]
"noise.spectral_level_db" = { law = "uniform", low = 40.0, high = 50.0 }
"""


def processor_time(pid):
    """Of a process so far [s]; None when it is gone."""
    try:
        with open(f"/proc/{pid}/stat") as file:
            fields = file.read().rpartition(")")[2].split()
    except (FileNotFoundError, ProcessLookupError):
        return None
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def start(words, ignored=()):
    def in_child():
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, signal.SIG_IGN if number in ignored else signal.SIG_DFL)

    return subprocess.Popen([ASDIC, *words], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                            preexec_fn=in_child)


def run_for(process, seconds):
    """Until it has used so much processor time."""
    while (used := processor_time(process.pid)) is not None and used < seconds:
        if process.poll() is not None:
            raise SystemExit(f"FAILED: it ended by itself with {process.returncode}: {process.stderr.read()}")
        time.sleep(0.02)


def stop(process, number, name):
    """Sends a signal; the processor time until the end."""
    before = last = processor_time(process.pid)
    process.send_signal(number)
    while process.poll() is None:
        last = processor_time(process.pid) or last
        if last - before > ALLOWED:
            process.kill()
            raise SystemExit(f"FAILED: {name}: still at work {last - before:.1f} s of processor time after {number.name}")
        time.sleep(0.01)
    said = process.stderr.read()
    if process.returncode not in (0, 1):
        raise SystemExit(f"FAILED: {name}: {number.name} ended it with {process.returncode}: {said}")
    print(f"{name}: {number.name} ended it after {last - before:.2f} s of processor time")


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for name, text in (("shallow", SHALLOW), ("study", STUDY), ("field", FIELD.replace("TASK", "field")),
                           ("place", PLAN), ("buoy", BUOY),
                           ("arrivals", FIELD.replace("TASK", "arrivals"))):
            with open(name + ".toml", "w") as file:
                file.write(text)
        commands = {
            "ping": ["ping", "shallow.toml", "-o", "ping.h5", "-q"],
            "study": ["study", "study.toml", "-o", "study.h5", "-q"],
            "place": ["place", "place.toml", "-o", "place.h5", "-q", "--threads", "1"],
            "field": ["field", "field.toml", "-o", "field.h5", "-q"],
            "arrivals": ["arrivals", "arrivals.toml", "-o", "arrivals.h5"],
        }
        # early, in the middle of preparations, and later; each kind of signal. Of a command one of them, two of ping,
        # and all in the deep check.
        moments = ((0.3, signal.SIGTERM), (1.5, signal.SIGHUP), (0.8, signal.SIGINT))
        of = {"ping": moments[1:], "study": moments[2:], "field": moments[:1], "place": moments[:2], "arrivals": moments[2:]}
        for name, words in commands.items():
            for seconds, number in moments if DEEP else of[name]:
                process = start(words)
                run_for(process, seconds)
                stop(process, number, f"{name} at {seconds} s")
            left = [entry for entry in os.listdir() if entry.startswith(name + ".h5") and "journal" not in entry]
            if left:
                raise SystemExit(f"FAILED: {name} left {left}")

        # As under nohup, and in the background of a shell's script.
        process = start(commands["ping"], ignored=(signal.SIGINT, signal.SIGHUP))
        run_for(process, 0.5)
        process.send_signal(signal.SIGINT)
        process.send_signal(signal.SIGHUP)
        run_for(process, 1.5)  # it goes on
        stop(process, signal.SIGTERM, "ping, others ignored")


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""A row that kills its process does not kill its study for ever: the next start tells of the rows that were
in hand and makes each alone; one that two processes died with is passed over, or ends the study in a
message, and --retry makes it again. A process that was told to end leaves nobody to blame.

    ASDIC=build/ci/bin/asdic study_deaths.py
"""
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import h5py
import numpy as np

ASDIC = Path(os.environ["ASDIC"]).resolve()

STUDY = """
[study]
realisations = 5
seed = 7
on_error = "%s"
[vary]
"target.0.range" = { law = "uniform", low = 600.0, high = 1200.0 }
[measure]
echo_level = true
series_level = true
[environment.sound_speed]
kind = "isovelocity"
speed = 1525.0
[environment.bottom]
depth = 30.0
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
duration = 0.05
window = "hann"
[array]
kind = "horizontal"
phones = 4
spacing = 0.2
[[target]]
position = [1000.0, 0.0, 10.0]
strength_db = 10.0
[noise]
spectral_level_db = 50.0
[reverberation]
synthesis = "scatterers"        # hundreds of paths: a good part of a second a realisation
[reverberation.bottom]
kind = "lambert"
[propagation]
max_surface_bounces = 5
max_bottom_bounces = 5
[pings]
recording_duration = 2.0
samples = "baseband"
"""


def check(good, what):
    if not good:
        sys.exit(f"FAILED: {what}")


def start(output, *more):
    return subprocess.Popen([ASDIC, "study", "s.toml", "-o", output, "-q", "--threads", "2", *more],
                            stderr=subprocess.PIPE, text=True)


def in_hand(output):
    """Rows that are being made, as the file beside the journal says."""
    try:
        lines = Path(output + ".journal-hand").read_text().splitlines()[2:]
    except FileNotFoundError:
        return []
    return [int(line.split()[1]) for line in lines if line.startswith("m ")]


def wait_until(what, run, condition):
    for _ in range(60000):
        found = condition()
        if found:
            return found
        if run.poll() is not None:
            sys.exit(f"FAILED: {what}: the study ended first: {run.stderr.read()}")
        time.sleep(0.001)
    sys.exit(f"FAILED: {what}: not within a minute")


def die(run):
    run.send_signal(signal.SIGSEGV)
    run.wait()
    check(run.returncode == -signal.SIGSEGV, f"status {run.returncode}")
    return run.stderr.read()


def killed_twice(output):
    """\\return the row that both processes died with"""
    first = start(output)
    wait_until("a row in hand", first, lambda: in_hand(output))
    die(first)
    left = in_hand(output)
    check(left, "a kill leaves the rows in hand")
    second = start(output)
    said = second.stderr.readline()
    row = min(left)
    check(f"realisation {row} was in hand when a process died: it is made again, alone" in said, f"{left}, said {said}")
    wait_until("a suspect in hand, alone", second, lambda: in_hand(output) == [row])
    die(second)
    return row


def table(path):
    with h5py.File(path) as file:
        return {name: file["table"][name][:] for name in file["table"]}, file["valid"][:], file["faults"][()]


def passed_over():
    Path("s.toml").write_text(STUDY % "skip")
    whole = start("whole.h5")
    check(whole.wait() == 0, "an undisturbed study")
    row = killed_twice("k.h5")
    third = start("k.h5")
    said = third.communicate()[1]
    check(third.returncode == 0, f"the third run ends: {said}")
    check(f"realisation {row} is passed over: it was in hand when 2 processes died; --retry makes it again" in said,
          f"said {said}")
    (was, _, _), (now, valid, faults) = table("whole.h5"), table("k.h5")
    others = np.arange(len(valid)) != row
    check(not valid[row] and valid[others].all(), f"all rows but {row}: {valid}")
    check(b"2 processes that died while they made it" in faults, f"faults: {faults}")
    check(all(np.array_equal(was[name][others], now[name][others]) for name in was), "the same rows but for that")
    check(was["range"][row] == now["range"][row], "what it drew is told")
    check(not list(Path(".").glob("k.h5.*")), "nothing is left")
    again = start("k.h5", "--retry")
    check(again.wait() == 0 and table("k.h5")[1].all(), "--retry makes it again")
    check(all(np.array_equal(was[name], table("k.h5")[0][name]) for name in was), "the same bits then")
    print(f"row {row} died twice: passed over, then --retry: the same bits")


def ended_in_a_message():
    Path("s.toml").write_text(STUDY % "stop")
    row = killed_twice("e.h5")
    for _ in range(2):
        third = start("e.h5")
        said = third.communicate()[1]
        check(third.returncode == 2 and f"realisation {row}: found 2 processes that died while they made it" in said,
              f"status {third.returncode}: {said}")
    again = start("e.h5", "--retry")
    check(again.wait() == 0 and table("e.h5")[1].all(), "--retry makes it again")
    print(f"row {row} died twice: told, then --retry")


def told_to_end():
    Path("s.toml").write_text(STUDY % "stop")
    run = start("t.h5")
    wait_until("a row in hand", run, lambda: in_hand("t.h5"))
    run.terminate()
    wait_until("nobody to blame", run, lambda: not in_hand("t.h5"))
    run.kill()  # as a batch system does that waits no longer
    run.wait()
    again = start("t.h5")
    said = again.communicate()[1]
    check(again.returncode == 0 and "in hand" not in said, f"status {again.returncode}: {said}")
    print("SIGTERM, then SIGKILL: no row is to blame")


folder = tempfile.mkdtemp(prefix="asdic-deaths-")
try:
    os.chdir(folder)
    passed_over()
    ended_in_a_message()
    told_to_end()
finally:
    os.chdir("/")
    shutil.rmtree(folder)

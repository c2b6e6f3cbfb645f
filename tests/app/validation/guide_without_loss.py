#!/usr/bin/env python3
"""Paths of a guide that loses nothing have no end: they are listed up to a limit, which is told with what it costs.

    ASDIC=path/to/asdic tests/app/validation/guide_without_loss.py
"""
import json
import math
import os
import subprocess
import tempfile

import h5py

ASDIC = os.environ["ASDIC"]
DEPTH, SOURCE, RECEIVER, RANGE, SPEED = 110.0, 40.0, 25.0, 2000.0, 1490.0
MOST = 2048  # bounces off either boundary

GUIDE = f"""
[environment]
water_density = 1000.0
[environment.sound_speed]
kind = "isovelocity"
speed = {SPEED}
[environment.bottom]
depth = {DEPTH}
kind = "rigid"
[environment.absorption]
kind = "none"
[run]
task = "arrivals"
frequency = 27.0
[run.source]
depth = {SOURCE}
[run.receivers]
depth = [{RECEIVER}]
range = [{RANGE}]
"""


def asdic(*words):
    done = subprocess.run([ASDIC, *words], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done


def intensity_of_images(first, last):
    """Of the images about the n-th multiple of twice the depth, n from first to last − 1: 1/R² each."""
    total = 0.0
    for n in range(first, last):
        for middle in {2 * n * DEPTH, -2 * n * DEPTH}:
            for z in (middle + SOURCE, middle - SOURCE):
                total += 1.0 / (RANGE**2 + (z - RECEIVER) ** 2)
    return total


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        with open("guide.toml", "w") as file:
            file.write(GUIDE)
        table = asdic("arrivals", "guide.toml")
        rows = [line for line in table.stdout.splitlines() if line.split()[:1] and line.split()[0].isdigit()]
        assert len(rows) > 2 * MOST, len(rows)
        assert max(len(line) for line in rows) < 4000, "a row lists all of its thousands of bounces"
        assert "more" in rows[-1], rows[-1][-80:]
        notes = [line for line in table.stderr.splitlines() if f"{MOST} bounces" in line]
        assert len(notes) == 1, table.stderr

        # What is told bounds what the images beyond the limit hold, without being far off.
        told = float(notes[0].split("at most ")[1].split(" dB")[0])
        found = intensity_of_images(0, MOST)
        left = intensity_of_images(MOST, 200 * MOST) * 200 / 199
        truth = 10.0 * math.log10(1.0 + left / found)
        assert truth <= told * 1.05 and told < 3.0 * truth, (told, truth)

        # Of the steepest paths, which bounce most: all of them are 320 MB of JSON.
        listed = json.loads(asdic("arrivals", "guide.toml", "--json", "--set", "run.fan.lowest_deg=89.7", "--set",
                                  "run.fan.highest_deg=90").stdout)
        assert listed["notes"] == [notes[0].removeprefix("asdic: note: ")], listed["notes"]
        longest = listed["legs"][0]["arrivals"][-1]
        assert len(longest["bounces"]) == 256 and longest["more_bounces"] > 3000, longest["more_bounces"]

        asdic("arrivals", "guide.toml", "-o", "guide.h5")
        with h5py.File("guide.h5") as file:
            assert f"{MOST} bounces" in str(file.attrs["notes"]), dict(file.attrs)
            assert len(file["arrivals/delay"]) == len(rows)

        # A bottom that takes something has an end of paths, and nothing is to be told.
        lossy = asdic("arrivals", "guide.toml", "--set", "environment.bottom.kind=grain-size", "--set",
                      "environment.bottom.grain_size=1.0")
        assert "bounces off" not in lossy.stderr, lossy.stderr
        print(f"{len(rows)} paths; left out {truth:.3f} dB, told {told} dB")


if __name__ == "__main__":
    main()

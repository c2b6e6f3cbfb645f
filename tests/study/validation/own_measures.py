#!/usr/bin/env python3
"""Measures of one's own and rules that stop, as a user meets them: formulae are added without another run, parts and
comparisons have them; rules, `study.until` and rounds of a comparison end where the rows say, and say why.

    ASDIC=build/release/bin/asdic own_measures.py
"""
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

ASDIC = Path(os.environ["ASDIC"]).resolve()

SEA = """
[environment]
wind_speed = 5.0
[environment.sound_speed]
kind = "isovelocity"
speed = 1500.0
[environment.bottom]
depth = 1000.0
kind = "rigid"
[platform]
position = [0.0, 0.0, 100.0]
[transmitter]
source_level_db = %g
taper = "omnidirectional"
[pulse]
kind = "cw"
frequency = 1000.0
duration = 0.1
window = "hann"
[array]
kind = "horizontal"
phones = 2
spacing = 0.75
[[target]]
position = [3000.0, 0.0, 100.0]
strength_db = 10.0
fluctuation = "swerling-1"
scan_pings = 1
[noise]
spectral_level_db = 60.0
[reverberation]
enabled = false
[propagation]
max_surface_bounces = 0
max_bottom_bounces = 0
[pings]
samples = "baseband"
recording_duration = 8.0
"""
STUDY = """
[study]
realisations = 400
seed = 3
%s
[vary]
"target.0.range" = { law = "uniform", low = 2000.0, high = 4000.0 }
[measure]
echo_level = true
noise_level = true
[summary]
by = [{ axis = "range", bins = 4 }]
[summary.own]
%s
"""
OWN = 'margin = { value = "echo_level_db - noise_level_db - 12", unit = "dB" }\n' \
      'over = { value = "margin > 0 && range < 3500", event = true }\n'

faults = []


def check(condition, what):
    if not condition:
        faults.append(what)


def run(*arguments, status=0):
    done = subprocess.run([ASDIC, *map(str, arguments)], capture_output=True, text=True, timeout=300)
    check(done.returncode == status, f"{arguments}: status {done.returncode}, {done.stdout}{done.stderr}")
    return done.stdout + done.stderr


def write(name, head="", own=OWN, source=226.0):
    Path(name).write_text(STUDY % (head, own) + SEA % source)
    return name


def table(path):
    with h5py.File(path) as f:
        return {name: column[:] for name, column in f["table"].items()}


def formulae_are_added_without_another_run():
    write("one.toml")
    run("study", "one.toml", "-o", "one.h5")
    rows = table("one.h5")
    margin = rows["echo_level_db"] - rows["noise_level_db"] - 12
    check(np.array_equal(rows["margin"], margin), "margin is not its formula")
    check(np.array_equal(rows["over"], (margin > 0) & (rows["range"] < 3500)), "over is not its formula")
    with h5py.File("one.h5") as f:
        by = f["summary/p_over_by_range"]
        for k, (low, high) in enumerate(zip(by["range_low"][:], by["range_high"][:])):
            here = (rows["range"] >= low) & (rows["range"] < high)
            check(abs(by["p_over"][k] - rows["over"][here].mean()) < 1e-12, f"p_over of bin {k}")
        check(f["table/over"].attrs["formula"].decode() == "margin > 0 && range < 3500", "no formula in the file")
    write("one.toml", own=OWN.replace("3500", "3000") + 'twice = "2 * margin"\n')
    said = run("study", "one.toml", "-o", "one.h5")
    check("400 realisations were there already" in said and "\n0 realisations in" in said, f"rows were made again: {said}")
    again = table("one.h5")
    check(np.array_equal(again["echo_level_db"], rows["echo_level_db"]), "a row has changed")
    check(np.array_equal(again["twice"], 2 * margin), "twice is not there")
    check(np.array_equal(again["over"], (margin > 0) & (rows["range"] < 3000)), "over is as it was")
    check("data         as the manifest says" in run("info", "one.h5"), "the manifest does not hold them")


def parts_have_them():
    write("parts.toml")
    for part in ("1/2", "2/2"):
        run("study", "parts.toml", "--shard", part, "-o", f"part{part[0]}.h5")
    write("more.toml", own=OWN + 'twice = "2 * margin"\n')
    for copy in (["--copy"], []):
        run("merge", "part1.h5", "part2.h5", "-o", "both.h5", "--study", "more.toml", "--force", *copy)
        rows = table("both.h5")
        check(np.array_equal(rows["twice"], 2 * rows["margin"]) and len(rows["twice"]) == 400, f"merge {copy}")
        run("info", "both.h5")


def rules_stop():
    write("until.toml")
    said = run("study", "until.toml", "-o", "until.h5", "--until", "p_over: low > 0.05 && rows >= 150")
    with h5py.File("until.h5") as f:
        check(len(f["index"]) == 200, f"{len(f['index'])} rows, not 200")
        check(f.attrs["stopped_by"].decode() == '--until "p_over: low > 0.05 && rows >= 150"', f.attrs["stopped_by"])
    check("p_over: low > 0.05 && rows >= 150: holds, " in said, said)
    write("head.toml", head='until = ["margin=1", "p_over: rows > 250"]')
    run("study", "head.toml", "-o", "head.h5")
    with h5py.File("head.h5") as f:
        check(len(f["index"]) == 300, f"study.until: {len(f['index'])} rows")
    said = run("study", "head.toml", "--shard", "1/2", "-o", "no.h5", status=2)
    check("head.toml:5: study.until: found a part of the study" in said and "--set study.until=[]" in said, said)
    run("study", "head.toml", "--shard", "1/2", "-o", "some.h5", "--set", "study.until=[]")
    said = run("study", "until.toml", "-o", "no.h5", "--until", "p_ovr: low > 1", status=2)
    check('did you mean "p_over"?' in said, said)


def cells_of_a_map_stop():
    """East of the array, between 2 and 4 km: one of two cells has all rows."""
    place = ["--set", "measure.target_place=true", "--set", "summary.map={east={edges=[0.0, 5e3]}, "
             "north={edges=[-1e3, 1e3, 2e3]}}"]
    write("cells.toml")
    said = run("study", "cells.toml", "-o", "cells.h5", "--until", "map_p_over=0.08", *place)
    with h5py.File("cells.h5") as f:
        count = f["summary/map_p_over/count"][:]
        rows = len(f["index"])
        check(sorted(count) == [0, rows] and 100 < rows < 400, f"{count} of {rows} rows")
        half = np.nanmax(0.5 * (f["summary/map_p_over/p_over_high"][:] - f["summary/map_p_over/p_over_low"][:])[count > 0])
    where = f"map_p_over: ± {half:.3g} at the worst (place_east 2500, place_north 0, {rows} realisations), asked for ± 0.08"
    check(f"{where}; 1 of 2 cells without a realisation" in said, f"{said} for {where}")
    write("other.toml", source=224.0)
    said = run("study", "--compare", "cells.toml", "other.toml", "-o", "no.h5", "--until", "map_p_over=0.1", *place, status=2)
    check("a comparison has no maps" in said, said)


def comparisons_go_on_in_rounds():
    write("weak.toml", source=224.0)
    write("loud.toml")
    said = run("study", "--compare", "weak.toml", "loud.toml", "-o", "rounds.h5", "--until", "p_over=0.04")
    with h5py.File("rounds.h5") as f:
        n = int(f.attrs["realisations"])
        differences = {name: column[:] for name, column in f["summary/differences"].items()}
        check(n < 400 and f.attrs["stopped_by"].decode() == "--until p_over=0.04", f"{n} rows, {dict(f.attrs)}")
    check(n == 200, f"{n} rows, not 200")
    check("margin: " in said and "loud less weak is 2 (2 to 2)" in said, said)
    check("over: " in said and f"enough after {n} realisations" in said, said)
    check("p over by range, best of 4 bins" in said, said)
    # The same rows, the same answers: of whole studies of so many realisations.
    run("study", "--compare", "weak.toml", "loud.toml", "-o", "whole.h5", "--fresh", "--set", f"study.realisations={n}")
    with h5py.File("whole.h5") as f:
        for name, column in f["summary/differences"].items():
            check(np.array_equal(column[:], differences[name], equal_nan=True), f"differences/{name}")
    # Rows that are there stay, and more of them change nothing.
    run("study", "--compare", "weak.toml", "loud.toml", "-o", "all.h5")
    run("study", "--compare", "weak.toml", "loud.toml", "-o", "again.h5", "--until", "p_over=0.04")
    with h5py.File("again.h5") as f:
        check(int(f.attrs["realisations"]) == n, "another end where there are more rows")
    said = run("study", "--compare", "weak.toml", "loud.toml", "-o", "rule.h5", "--until",
               "echo_level_db: low > 0 || high < 0")
    check("enough after 100 realisations" in said and "holds" in said, said)
    check("echo_level_db: loud is best, loud less weak is 2 (2 to 2)" in said, said)
    check("noise_level_db: the same of weak and loud" in said, said)


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for part in (formulae_are_added_without_another_run, parts_have_them, rules_stop, cells_of_a_map_stop,
                     comparisons_go_on_in_rounds):
            part()
        os.chdir("/")
    for fault in faults:
        print("FAULT:", fault)
    print(f"{len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())

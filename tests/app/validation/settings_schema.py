#!/usr/bin/env python3
"""The JSON Schema of `asdic settings --schema` says what the reader says: scenarios that the reader takes are good by
it, and of files with one fault each it finds the fault at the same key.

    ASDIC=build/ci/bin/asdic settings_schema.py
"""
import json
import os
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
ASDIC = Path(os.environ["ASDIC"]).resolve()
sys.path.insert(0, str(ROOT / "scripts"))
import json_schema  # noqa: E402

GOOD = """
title = "a plain sea"
seed = 3
[environment]
wind_speed = 5.0
[environment.sound_speed]
kind = "isovelocity"
speed = 1500.0
[environment.bottom]
depth = 200.0
kind = "fluid"
speed = 1700.0
[platform]
position = [0.0, 0.0, 50.0]
[transmitter]
source_level_db = 200.0
beamwidth_deg = 20.0
[pulse]
kind = "lfm"
start_frequency = 900.0
end_frequency = 1100.0
duration = 0.1
window = "tukey"
tukey_fraction = 0.2
[array]
kind = "horizontal"
phones = 4
spacing = 0.5
[[target]]
range = 2000.0
depth = 100.0
strength_db = 10.0
[noise]
spectral_level_db = 50.0
[reverberation.surface]
kind = "nrl"
gamma2 = 3.0
[pings]
recording_duration = 4.0
sample_rate = 4000.0
"""

# Other ways to say things, which are as good: what stands, and what stands in its place.
OTHER_WAYS = [
    ("[platform]", "[[platform]]"),
    ("[transmitter]", "[[transmitter]]"),
    ("[array]", "[[array]]"),
    ("beamwidth_deg = 20.0", "beamwidth_rad = 0.3"),
    ("beamwidth_deg = 20.0", 'taper = "omnidirectional"'),
    ("phones = 4\nspacing = 0.5", "phones = 1"),
    ("range = 2000.0\ndepth = 100.0", "position = [0.0, 2000.0, 100.0]"),
    ("range = 2000.0", "range = 2000\nbearing_rad = 0.1"),
    ("range = 2000.0\ndepth = 100.0", "waypoints = [{ time = 0.0, position = [0.0, 2000.0, 100.0] }]"),
    ("spectral_level_db = 50.0", 'kind = "knudsen"\nsea_state = 2'),
    ("spectral_level_db = 50.0", 'kind = "wenz"'),
    ("strength_db = 10.0", "aspect = { bow_db = 0, beam_db = 10, stern_db = 3 }\nheading_deg = 0"),
    ("strength_db = 10.0", 'strength_db = 10.0\nfluctuation = "swerling-1"\nscan_pings = 3'),
    ("wind_speed = 5.0", "wind_speed = 5\nwater_density = 1020.0"),
    ("wind_speed = 5.0", "water_density = { depth = [0.0, 50.0], density = [1020.0, 1025.0] }"),
    ("depth = 200.0", "shape = { range = [0.0, 1e4], depth = [200.0, 210.0] }"),
    ("[pings]", '[run]\nmemory = "4 GB"\n[pings]'),
    ("[pings]", "[run]\nmemory = 4e9\n[pings]"),
    ("[pings]", '[propagation]\nmax_surface_bounces = "auto"\nmax_bottom_bounces = 5\n[pings]'),
]

# One fault each: what stands, what stands in its place, and the key that the schema names.
FAULTS = [
    ("seed = 3", "seed = -1", "seed"),
    ("seed = 3", 'seed = "three"', "seed"),
    ("seed = 3", "sead = 3", "sead"),
    ("wind_speed = 5.0", "wind_speed = 61.0", "environment.wind_speed"),
    ("wind_speed = 5.0", "wind = 5.0", "environment.wind"),
    ('kind = "isovelocity"', 'kind = "isovelocty"', "environment.sound_speed.kind"),
    ("speed = 1500.0", "", "environment.sound_speed.speed"),
    ("speed = 1500.0", "speed = 1500.0\naxis_depth = 1300.0", "environment.sound_speed.axis_depth"),
    ("depth = 200.0", "", "environment.bottom.depth"),
    ("depth = 200.0", "depth = 200.0\nshape = { range = [0.0], depth = [200.0] }", "environment.bottom.depth"),
    ("speed = 1700.0", "shear_speed = 300.0", "environment.bottom.shear_speed"),
    ("[platform]\nposition = [0.0, 0.0, 50.0]", "", ""),  # neither a sonar nor a run
    ("position = [0.0, 0.0, 50.0]", "", "platform"),
    ("position = [0.0, 0.0, 50.0]", "position = [0.0, 50.0]", "platform"),
    ("position = [0.0, 0.0, 50.0]", "position = [0.0, 0.0, 50.0]\ndepth = 3", "platform"),
    ("source_level_db = 200.0", "", "transmitter"),
    ("source_level_db = 200.0", "source_level_db = 200.0\nbearing_deg = 3.0", "transmitter"),
    ("beamwidth_deg = 20.0", "", "transmitter"),
    ("duration = 0.1", "", "pulse.duration"),
    ("duration = 0.1", "duration = 0.0", "pulse.duration"),
    ("start_frequency = 900.0", "frequency = 900.0", "pulse.frequency"),
    ("tukey_fraction = 0.2", "tukey_fraction = 1.2", "pulse.tukey_fraction"),
    ('window = "tukey"', 'window = "hann"', "pulse.tukey_fraction"),
    ("gamma2 = 3.0", "gamma2 = 3.0\ncorrelation_length = 80.0", "reverberation.surface.correlation_length"),
    ("spectral_level_db = 50.0", 'kind = "knudsen"\nwind_speed = 5.0\nsea_state = 2.0', "noise.sea_state"),
    ("phones = 4", "", "array"),
    ("phones = 4", "phones = 4.5", "array"),
    ("spacing = 0.5", "spacing = 0.5\nbehind = [3.0]", "array"),
    ("[[target]]", "[target]", "target"),
    ("range = 2000.0", "range = 2000.0\nposition = [0.0, 0.0, 3.0]", "target[0].position"),
    ("depth = 100.0", "", "target[0].depth"),
    ("strength_db = 10.0", "", "target[0].strength_db"),
    ("strength_db = 10.0", 'strength_db = 10.0\nfluctuation = "swerling-1"', "target[0].scan_pings"),
    ("spectral_level_db = 50.0", 'kind = "white"', "noise.spectral_level_db"),
    ("spectral_level_db = 50.0", 'kind = "wenz"\nsea_state = 3', "noise.sea_state"),
    ("gamma2 = 3.0", "gama2 = 3.0", "reverberation.surface.gama2"),
    ("gamma2 = 3.0", "mu_db = -27", "reverberation.surface.mu_db"),
    ("sample_rate = 4000.0", "carrier = 4000.0", "pings.carrier"),
    ("[pings]", '[run]\nmemory = "4 apples"\n[pings]', "run.memory"),
    ("[pings]", '[run.beams]\nkind = "hats"\n[pings]', "run.beams.kind"),
]


def reader_takes(text):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "s.toml"
        path.write_text(text)
        return subprocess.run([ASDIC, "validate", path, "--all"], capture_output=True).returncode == 0


def exchanged(old, new):
    assert GOOD.count(old) == 1, old
    return GOOD.replace(old, new)


def main():
    said = subprocess.run([ASDIC, "settings", "--schema"], check=True, capture_output=True, text=True).stdout
    schema = json.loads(said)
    wrong = []

    def expect(good, what):
        if not good:
            wrong.append(what)

    def by_schema(text):
        return list(json_schema.faults(tomllib.loads(text), schema))

    files = sorted((ROOT / "scenarios").glob("*.toml"))
    expect(len(files) > 10, "scenarios/ has scenarios")
    for path in files:
        expect(by_schema(path.read_text()) == [], f"{path.name}: {by_schema(path.read_text())}")
    for text in [GOOD] + [exchanged(old, new) for old, new in OTHER_WAYS]:
        expect(by_schema(text) == [], f"{by_schema(text)} of what is good:\n{text}")
        expect(reader_takes(text), f"the reader refuses what is good:\n{text}")
    for old, new, key in FAULTS:
        text = exchanged(old, new)
        found = by_schema(text)
        expect(any(place == key for place, _ in found), f"{new!r} for {old!r}: found {found}, expected {key}")
        expect(not reader_takes(text), f"{new!r} for {old!r}: the reader takes it")
    print(*wrong, sep="\n")
    print(f"{len(files)} scenarios, {len(OTHER_WAYS)} other ways, {len(FAULTS)} faults: {len(wrong)} wrong")
    sys.exit(1 if wrong else 0)


main()

#!/usr/bin/env python3
"""Every number of a scenario has physical bounds. At them asdic refuses or computes, without NaN and without hanging.

The bounds are those of `asdic settings --schema`. Each number of the scenarios below is set to its bounds in turn, to
the least numbers above 0 where 0 is allowed, and to what lies just outside. The truth is that sound pressure is a
number. That is the full form (ASDIC_DEEP=1); every day those are tried that once hung, or gave what is no number.

    ASDIC=build/ci/bin/asdic number_bounds.py
"""
import concurrent.futures
import copy
import json
import math
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
from deep import in_depth  # noqa: E402

ASDIC = Path(os.environ["ASDIC"]).resolve()
LONG = 60.0  # a command that takes longer than this hangs: each takes some 0.1 s [s]

# Numbers that no scenario here sets, and why.
NOT_SET = {
    "environment.area": "maps in files: docs/formats/ocean-area.md has their bounds",
    "environment.origin": "is told, and nothing depends on it",
    "environment.transect.origin": "of an area's maps",
    "environment.transect.bearing": "of an area's maps",
    "reverberation.seabed": "of an area's maps; the laws are those of the bottom",
    "run.fan.elevations": "in place of lowest and highest, whose bounds they have",
    "run.beams.cerveny": "of BELLHOP's beams, as a case of BELLHOP's has them",
    "run.literal": "of BELLHOP's steps, as a case of BELLHOP's has them",
    "run.memory": "a budget: every scenario here has it",
    "run.dimension": "3: of an area's maps",
    "propagation.dimension": "3: of an area's maps",
}
# Numbers without an upper bound, and why.
UNBOUNDED = {"seed": "any whole number: it is mixed into bits"}

BASE = {
    "seed": 1,
    "environment": {
        "wind_speed": 6.0,
        "water_density": 1027.0,
        "sound_speed": {"kind": "isovelocity", "speed": 1500.0},
        "absorption": {"kind": "francois-garrison", "temperature": 10.0, "salinity": 35.0, "ph": 8.0, "depth": 50.0},
        "bottom": {"depth": 100.0, "kind": "fluid", "speed": 1650.0, "density": 1900.0, "quality_factor": 60.0,
                   "roughness": 0.1},
        "surface": {"depth": 0.0, "roughness": 0.2},
    },
    "platform": {"position": [0.0, 0.0, 30.0], "velocity": [1.0, 0.0, 0.0]},
    "transmitter": {"source_level_db": 200.0, "elevation_deg": 2.0, "beamwidth_deg": 20.0, "offset": [1.0, 0.0, 0.0],
                    "first_ping_time": 0.0, "interval": 5.0},
    "pulse": {"kind": "cw", "frequency": 1000.0, "duration": 0.02, "window": "tukey", "tukey_fraction": 0.2},
    "array": {"kind": "line", "phones": 2, "spacing": 0.5, "heading_deg": 10.0, "pitch_deg": 5.0,
              "offset": [-1.0, 0.0, 0.0]},
    "target": [{"range": 150.0, "bearing_deg": 30.0, "depth": 60.0, "strength_db": 10.0, "first_ping": 1,
                "last_ping": 5, "fluctuation": "swerling-1", "scan_pings": 1, "velocity": [0.0, 1.0, 0.0]}],
    "noise": {"spectral_level_db": 50.0},
    "reverberation": {"azimuths": 4, "scatterers_per_cell": 1, "most_returns": 100000, "ground_spacing": 20.0},
    "propagation": {"max_surface_bounces": 1, "max_bottom_bounces": 1, "max_launch_angle_deg": 80.0},
    "pings": {"count": 1, "recording_duration": 0.3, "recording_start": 0.1, "sample_rate": 6000.0},
    "run": {"memory": 300e6},
}
LOSSES = {"attenuation_db_per_wavelength": 0.5, "attenuation_db_per_metre": 0.1, "attenuation_db_per_metre_khz": 0.1,
          "attenuation_nepers_per_metre": 0.01, "quality_factor": 60.0, "loss_parameter": 0.01}
QUIET = {"reverberation": {"enabled": False}}
SHALLOW = {"depth": 100.0}
FIELD = {"task": "field", "frequency": 200.0, "source": {"depth": 30.0}, "box_range": 2e4, "box_depth": 300.0,
         "receivers": {"depth": [20.0, 60.0], "range": [100.0, 500.0]}, "field": "incoherent", "memory": 300e6}


def merged(base, change):
    """A copy of nested tables with others put into it; None takes a key away."""
    made = copy.deepcopy(base)
    for key, value in change.items():
        if value is None:
            made.pop(key, None)
        elif isinstance(value, dict):
            plain = "kind" in value or not isinstance(made.get(key), dict)  # another kind has other keys
            made[key] = merged({} if plain else made[key], value)
        else:
            made[key] = copy.deepcopy(value)
    return made


def scenarios():
    """Small scenarios which together set every number: (command, tables)."""
    def ping(**change):
        return "ping", merged(BASE, change)

    def pulse(**of):
        return ping(pulse={"duration": 0.1, **of}, **QUIET)

    def bottom(**of):
        return ping(environment={"bottom": {**SHALLOW, **of}}, **QUIET)

    yield ping()
    yield "field", merged(BASE, {"run": {**FIELD, "fan": {"lowest_deg": -30.0, "highest_deg": 30.0, "count": 20}}})
    yield "field", merged(BASE, {"run": {
        **FIELD, "off_transect_deg": 5.0, "source": {
            "depth": {"first": 20.0, "last": 30.0, "count": 2},
            "pattern": {"elevation_deg": [-90.0, 0.0, 90.0], "amplitude": [0.5, 1.0, 0.5]}},
        "receivers": {"depth": {"first": 20.0, "last": 60.0, "count": 2},
                      "range": {"first": 100.0, "last": 500.0, "count": 2}}}})
    yield "field", merged(BASE, {"run": {**FIELD, "source": {
        "depth": 30.0, "pattern": {"elevation_deg": [-90.0, 90.0], "level_db": [-3.0, 0.0]}}}})
    # the water
    yield ping(environment={"sound_speed": {"kind": "munk", "axis_speed": 1500.0, "axis_depth": 60.0,
                                            "scale_depth": 60.0, "perturbation": 0.005},
                            "bottom": {"kind": "rigid", "depth": 150.0}}, **QUIET)
    yield ping(environment={"sound_speed": {"kind": "table", "interpolation": "pchip", "depth": [0.0, 40.0, 100.0],
                                            "speed": [1500.0, 1495.0, 1490.0]},
                            "water_density": {"depth": [0.0, 100.0], "density": [1025.0, 1028.0]},
                            "attenuation": {"depth": [0.0, 100.0], "db_per_km": [0.1, 0.2]},
                            "absorption": {"kind": "ainslie-mccolm", "temperature": 10.0, "salinity": 35.0, "ph": 8.0,
                                           "depth": 50.0}}, **QUIET)
    yield ping(environment={"sound_speed": {"kind": "temperature-salinity", "depth": [0.0, 100.0],
                                            "temperature": [12.0, 10.0], "salinity": [35.0, 35.1],
                                            "latitude_deg": 45.0}}, **QUIET)
    yield ping(environment={"sound_speed": {"kind": "section", "range": [0.0, 1000.0], "depth": [0.0, 100.0],
                                            "speed": [[1500.0, 1490.0], [1501.0, 1492.0]]}}, **QUIET)
    yield ping(environment={"biology": [{"top": 20.0, "bottom": 40.0, "resonance": 1000.0, "quality_factor": 5.0,
                                         "strength_db_per_km": 0.1}]}, **QUIET)
    # boundaries
    for key, loss in LOSSES.items():
        yield bottom(kind="fluid", **{key: loss})
        yield bottom(kind="elastic", speed=2400.0, shear_speed=800.0, density=2200.0, **{key: loss},
                     **{"shear_" + key: loss})
        yield bottom(kind="layered", speed=1800.0, density=2000.0, shear_speed=200.0, **{key: loss},
                     **{"shear_" + key: loss},
                     layer=[{"thickness": 1.0, "speed": 1550.0, "density": 1500.0, "shear_speed": 100.0, key: loss,
                             "shear_" + key: loss}])
    yield bottom(kind="grain-size", grain_size=3.0, water_speed=1500.0, water_density=1027.0)
    yield bottom(kind="table", grazing_deg=[0.0, 45.0, 90.0], magnitude=[1.0, 0.5, 0.3], phase_deg=[180.0, 90.0, 0.0])
    yield bottom(kind="table", grazing_deg=[0.0, 45.0, 90.0], loss_db=[0.0, 5.0, 9.0])
    yield bottom(kind="table", curve=[
        {"frequency": 500.0, "grazing_deg": [0.0, 90.0], "loss_db": [0.0, 9.0], "phase_deg": [180.0, 0.0]},
        {"frequency": 2000.0, "grazing_deg": [0.0, 90.0], "magnitude": [1.0, 0.3]}])
    yield bottom(kind="rigid", roughness=0.1, roughness_wind=8.0, roughness_floor_db=-30.0)
    yield ping(environment={"surface": {"roughness": "wind", "roughness_floor_db": -30.0,
                                        "bubbles": "apl-uw", "bubbles_wind": 8.0}}, **QUIET)
    yield ping(environment={"bottom": {"kind": "rigid", "depth": None,
                                       "shape": {"range": [-1e3, 0.0, 1e3], "depth": [90.0, 100.0, 95.0]}},
                            "surface": {"depth": None, "shape": {"range": [-1e3, 1e3], "depth": [0.0, 1.0]}}}, **QUIET)
    # pulses
    for kind in ("lfm", "hfm"):
        yield pulse(kind=kind, start_frequency=900.0, end_frequency=1100.0)
    yield pulse(kind="sfm", frequency=1000.0, swing=100.0, modulation_frequency=20.0, end_modulation_frequency=30.0)
    yield pulse(kind="costas", frequency=1000.0, prime=11, root=2, step=100.0)
    yield pulse(kind="costas", frequency=1000.0, order=[1.0, 3.0, 2.0])
    yield pulse(kind="ptfm", start_frequency=900.0, end_frequency=1100.0, sweeps=2)
    yield pulse(kind="geometric_comb", start_frequency=900.0, end_frequency=1100.0, lines=4, gap_ratio=1.5)
    yield pulse(kind="pulse_train", start_frequency=900.0, end_frequency=1100.0, pulses=4, pulse_duration=0.01)
    yield pulse(kind="pulse_train", frequency=1000.0, pulses=4, pulse_duration=0.01)
    yield ping(pulse={"kind": "file", "samples": [0.0, 1.0, 0.0, -1.0] * 8, "sample_rate": 4000.0}, **QUIET)
    # transmitters and arrays
    yield ping(platform={"position": None, "velocity": None,
                         "waypoints": [{"time": 0.0, "position": [0.0, 0.0, 30.0]},
                                       {"time": 100.0, "position": [200.0, 0.0, 30.0]}]},
               transmitter={"kind": "projectors", "source_level_db": 200.0, "elevation_deg": 2.0, "bearing_deg": 5.0, "projector": [
                   {"offset": [0.0, 0.0, 0.1], "amplitude": 1.0, "phase_deg": 10.0, "delay": 0.001},
                   {"offset": [0.0, 0.0, -0.1]}]}, **QUIET)
    yield ping(transmitter={"kind": "table", "source_level_db": 200.0, "bearing_deg": 5.0, "table": {
        "bearing_deg": [0.0, 90.0, 180.0, 270.0], "elevation_deg": [-90.0, 0.0, 90.0],
        "level_db": [[-20.0, 0.0, -20.0]] * 4}}, **QUIET)
    yield ping(array={"kind": "positions",
                      "positions": [[0.0, 0.0, 0.0], [0.5, 0.0, 0.0]],
                      "electronics": {"gain_db": [1.0, 2.0], "phase_deg": [10.0, 20.0], "gain_std_db": 0.1,
                                      "phase_std_deg": 1.0, "dead": [0],
                                      "band_pass": {"order": 2, "low": 500.0, "high": 1500.0},
                                      "converter": {"bits": 16, "full_scale": 100.0}}}, **QUIET)
    yield ping(array={"kind": "towed", "behind": [20.0, 20.5]}, **QUIET)
    yield ping(array={"kind": "positions", "shapes": [{"positions": [[0.0, 0.0, 0.0], [0.5, 0.1, 0.0]]}]},
               **QUIET)
    yield ping(transmitter={"elevation_deg": None}, pings={"elevations_deg": [2.0]}, **QUIET)
    yield ping(transmitter={"elevation_deg": None, "elevations_deg": [2.0]}, **QUIET)
    yield ping(transmitter={"interval": None}, pings={"interval": 5.0}, **QUIET)
    yield ping(pings={"samples": "baseband", "carrier": 1000.0, "baseband_rate": 1500.0, "sample_rate": None}, **QUIET)
    # targets, ships, noise
    target = BASE["target"][0]
    yield ping(target=[merged(target, {"range": None, "bearing_deg": None, "depth": None, "strength_db": None,
                                       "velocity": None, "heading_deg": 20.0,
                                       "waypoints": [{"time": 0.0, "position": [100.0, 100.0, 60.0]},
                                                     {"time": 9.0, "position": [110.0, 100.0, 60.0]}],
                                       "aspect": {"angle_deg": [0.0, 90.0, 180.0, 270.0],
                                                  "level_db": [0.0, 10.0, 3.0, 10.0]}})], **QUIET)
    yield ping(target=[merged(target, {"range": None, "bearing_deg": None, "depth": None, "strength_db": None,
                                       "position": [100.0, 100.0, 60.0],
                                       "aspect": {"bow_db": 0.0, "beam_db": 10.0, "stern_db": 3.0}})], **QUIET)
    yield ping(target=[merged(target, {"strength_db": None, "hull": {"length": 60.0, "beam": 8.0}, "highlight": [
        {"offset": [10.0, 0.0, 0.0], "strength_db": 5.0},
        {"offset": [-10.0, 0.0, 0.0], "aspect": {"bow_db": 0.0, "beam_db": 10.0, "stern_db": 3.0}},
        {"offset": [0.0, 0.0, 0.0], "aspect": {"angle_deg": [0.0, 180.0], "level_db": [0.0, 10.0]}}]})], **QUIET)
    yield ping(interferer=[{"position": [300.0, 0.0, 5.0], "velocity": [5.0, 0.0, 0.0], "level_db": 100.0,
                            "slope_db_per_decade": -20.0, "tonal": [{"frequency": 1000.0, "level_db": 120.0}]}],
               **QUIET)
    yield ping(interferer=[{"waypoints": [{"time": 0.0, "position": [300.0, 0.0, 5.0]},
                                          {"time": 9.0, "position": [310.0, 0.0, 5.0]}],
                            "spectrum": {"frequency": [100.0, 3000.0], "level_db": [110.0, 90.0]}}], **QUIET)
    yield ping(noise={"kind": "wenz", "shipping": 0.5, "wind_speed": 5.0}, **QUIET)
    yield ping(noise={"kind": "knudsen", "sea_state": 2}, **QUIET)
    yield ping(noise={"kind": "table", "frequency": [100.0, 3000.0], "level_db": [60.0, 50.0],
                      "coherence": "surface", "dipole_exponent": 1.0}, **QUIET)
    yield ping(noise={"kind": "wenz", "coherence": "profile",
                      "profile": {"elevation_deg": [-90.0, 90.0], "level_db": [0.0, 3.0]}}, **QUIET)
    # reverberation
    moves = {"motion": "spread", "speed_rms": 0.5, "current": [0.1, 0.0], "coherence_time": 5.0, "k_shape": 2.0,
             "correlation_length": 50.0}
    yield ping(reverberation={"surface": {"kind": "nrl", "A_s": 0.00055, "gamma2": 3.9, "h0": 1.0, **moves},
                              "bottom": {"kind": "ellis-crowe", "mu_db": -27.0, "nu_db": -15.0, "slope_deg": 10.0,
                                         "coherence_time": 5.0, "k_shape": 2.0, "correlation_length": 50.0},
                              "volume": [{"depth": [30.0, 40.0], "strength_db": -75.0, "sheets": 1, **moves}]})
    yield ping(reverberation={"surface": {"kind": "table", "grazing_deg": [0.0, 90.0], "strength_db": [-40.0, -20.0],
                                          "motion": "bragg", "receding_share": 0.5},
                              "bottom": {"kind": "table", "grazing_deg": [0.0, 90.0], "strength_db": [-40.0, -20.0]},
                              "volume": [{"depth": [30.0, 40.0], "strength_db": -75.0, "motion": "bragg",
                                          "receding_share": 0.5}]})
    yield ping(reverberation={"bottom": {"kind": "lambert", "mu_db": -27.0}})


def schema_numbers(schema, path=""):
    """Where a scenario may have numbers, and what each must be: {path: [rule]}."""
    found = {}
    if schema.get("type") in ("number", "integer"):
        found[path] = [schema]
    inner = [(path, one) for one in schema.get("anyOf", [])]
    inner += [(path, schema["items"])] if "items" in schema else []
    inner += [(f"{path}.{key}" if path else key, one) for key, one in schema.get("properties", {}).items()]
    for where, one in inner:
        zero = any(other.get("enum") == [0] for other in schema.get("anyOf", []))
        for at, rules in schema_numbers(one, where).items():
            found.setdefault(at, []).extend({**rule, "or_zero": rule.get("or_zero", False) or zero and at == path}
                                            for rule in rules)
    return found


def places(value, path="", at=()):
    """Every number of a scenario: its path, and the keys that lead to it. Of a list of numbers the first and last."""
    if isinstance(value, dict):
        for key, one in value.items():
            yield from places(one, f"{path}.{key}" if path else key, (*at, key))
    elif isinstance(value, list):
        for i in sorted({0, len(value) - 1} if value and isinstance(value[0], (int, float)) else range(len(value))):
            yield from places(value[i], path, (*at, i))
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        yield path, at


def with_number(tables, at, number):
    made = copy.deepcopy(tables)
    inner = made
    for key in at[:-1]:
        inner = inner[key]
    inner[at[-1]] = number
    return made


def toml(value):
    """A value as inline TOML."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml(one)}" for key, one in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(toml(one) for one in value) + "]"
    return json.dumps(value) if not isinstance(value, float) else repr(value)


def numbers_to_try(rules):
    """Values within the bounds, and those outside, which must be refused."""
    inside, outside = [], []
    for rule in rules:
        whole = rule["type"] == "integer"
        low, high = rule["minimum"], rule.get("maximum")
        inside += [low] + ([high] if high is not None else [])
        if rule["or_zero"]:
            inside.append(0.0)
        if not whole and (low <= 0.0 <= (high or 1.0)):
            inside += [5e-324, 1e-300, 1e-30]
    for value in [rule["minimum"] for rule in rules] + [rule.get("maximum") for rule in rules]:
        if value is None:
            continue
        step = 1 if rules[0]["type"] == "integer" else max(abs(value) * 1e-9, 1e-12)
        for beyond in (value - step, value + step):
            if not any(rule["minimum"] <= beyond <= rule.get("maximum", math.inf) for rule in rules):
                outside.append(beyond)
    if any(rule["or_zero"] for rule in rules):
        outside += [5e-324, 1e-300]
    exact = [int(v) if rules[0]["type"] == "integer" else float(v) for v in inside]
    return sorted(set(exact)), sorted(set(outside))


def run(folder, number, command, tables, value):
    """Runs a scenario. -> "" or what is wrong, whether it was refused"""
    scenario, result = Path(folder, f"{number}.toml"), Path(folder, f"{number}.h5")
    scenario.write_text("\n".join(f"{key} = {toml(one)}" for key, one in tables.items()) + "\n")
    words = [ASDIC, command, scenario, "-o", result, "-q", "--threads", "1"]
    try:
        done = subprocess.run(words, capture_output=True, text=True, timeout=LONG, errors="replace")
    except subprocess.TimeoutExpired:
        return f"more than {LONG:g} s", False
    finally:
        scenario.unlink()
    if done.returncode in (1, 2):
        return ("" if done.stderr.startswith("asdic: ") else f"said {done.stderr!r}"), True
    if done.returncode != 0:
        return f"status {done.returncode}: {done.stderr.strip()[-200:]}", False
    with h5py.File(result) as file:
        bad = sum(int(np.count_nonzero(~np.isfinite(file[name][()]))) for name in ("pressure", "pressure_square")
                  if name in file)
    result.unlink()
    return (f"{bad} samples that are no number" if bad else ""), False


class Bounds(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        said = subprocess.run([ASDIC, "settings", "--schema"], capture_output=True, text=True, check=True).stdout
        cls.rules = schema_numbers(json.loads(said))

    def test_every_number_has_bounds(self):
        for path, rules in self.rules.items():
            for rule in rules:
                self.assertNotIn("exclusiveMinimum", rule, path)
                self.assertIn("minimum", rule, path)
                if path not in UNBOUNDED:
                    self.assertIn("maximum", rule, path)

    def test_scenarios_set_every_number(self):
        there = {path for _, tables in scenarios() for path, _ in places(tables)}
        for path in self.rules:
            # materials, pulses: equal tables at several places of a scenario
            same = path.replace("_rad", "_deg").replace("transmitter.pulse", "pulse")
            for place in ("bottom.shape.material", "surface.shape.material", "surface"):
                alone = same.replace(f"environment.{place}.", "environment.bottom.")
                same = same if same in there else alone
            if not any(path.startswith(start) for start in NOT_SET):
                self.assertIn(same, there, path)

    def test_what_once_was_no_number_is_refused(self):
        tiny = {("pulse", "frequency"): 1e-30, ("pulse", "duration"): 1e-300,
                ("environment", "bottom", "shear_speed"): 1e-300,
                ("environment", "bottom", "layer", 0, "shear_speed"): 1e-300,
                ("reverberation", "surface", "coherence_time"): 5e-324,
                ("reverberation", "volume", 0, "coherence_time"): 5e-324,
                ("environment", "sound_speed", "depth", 1): 5e-324}
        for number, (at, value) in enumerate(tiny.items()):
            path = ".".join(key for key in at if isinstance(key, str))
            tables = next(tables for command, tables in scenarios()
                          if command == "ping" and (path, at) in list(places(tables)))
            with self.subTest(path), tempfile.TemporaryDirectory() as folder:
                self.assertEqual(run(folder, number, "ping", with_number(tables, at, value), value), ("", True))

    @in_depth("what once was no number is tried")
    def test_bounds_are_refused_or_computed(self):
        seen, tries = set(), []
        for command, tables in scenarios():
            tries.append((command, tables, None, "the scenario", False))
            for path, at in places(tables):
                kind = (command, path, at[-1] if isinstance(at[-1], int) else "", tables["pulse"]["kind"],
                        tables["environment"]["bottom"]["kind"])
                if kind in seen or any(path.startswith(start) for start in NOT_SET) or path in UNBOUNDED:
                    continue
                seen.add(kind)
                inside, outside = numbers_to_try(self.rules[path])
                values = [(v, False) for v in inside] + [(v, True) for v in outside]
                for value, refused in values:
                    tries.append((command, with_number(tables, at, value), value,
                                  f"{path} ({'.'.join(map(str, at))})", refused))
        print(f"{len(tries)} scenarios")
        with tempfile.TemporaryDirectory() as folder, \
                concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            done = [(one, pool.submit(run, folder, i, one[0], one[1], one[2])) for i, one in enumerate(tries)]
            for (command, tables, value, what, refused), future in done:
                wrong, was_refused = future.result()
                with self.subTest(f"{command}: {what} = {value}"):
                    self.assertEqual(wrong, "")
                    if value is None:
                        self.assertFalse(was_refused)
                    if refused:
                        self.assertTrue(was_refused, "it lies outside of its bounds")


if __name__ == "__main__":
    unittest.main()

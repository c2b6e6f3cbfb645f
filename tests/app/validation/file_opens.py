#!/usr/bin/env python3
"""A ping file is what docs/formats/ping.md says, and opens in h5py, xarray and h5dump.

    ASDIC=build/ci/bin/asdic file_opens.py      runs `asdic ping` on a scenario and checks its file
    file_opens.py --file FILE.h5                checks a file that is there already
    file_opens.py                               without ASDIC: checks a synthetic file, so proves
    the test alone
"""
import argparse
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))

ROOT_ATTRIBUTES = ["filetype", "version", "title", "program_version", "build", "seed",
                   "scenario_sha256", "complete", "pings_requested"]
PRESSURE_ATTRIBUTES = ["sample_rate_hz", "time_start", "time_step", "reference"]
REPLICA_ATTRIBUTES = ["kind", "centre_frequency_hz", "bandwidth_hz", "sweep_hz", "duration_s",
                      "window", "source_level_db"]
ENVIRONMENT_ATTRIBUTES = ["surface", "bottom", "bottom_depth_m", "wind_speed_mps", "absorption",
                          "interpolation", "scattering_model",
                          "transmitter_line_length_m"]
RUN_ATTRIBUTES = ["host", "started", "cpu", "threads", "library_versions"]

F4, F8, I1, I4, I8 = "<f4", "<f8", "|i1", "<i4", "<i8"
TARGET = {"target_index", "target_position", "target_velocity", "target_strength_db",
          "target_present"}

# Dataset → dimensions, type (None: any number). A name that is its own dimension is a scale.
LAYOUT = {
    "ping": ("ping", I4), "channel": ("channel", I4), "time": ("sample", F8), "xyz": ("xyz", I4),
    "pressure": ("ping channel sample", F4), "valid_samples": ("ping", I8),
    "ping_time": ("ping", F8), "elevation_deg": ("ping", F8),
    "platform_position": ("ping xyz", F8), "platform_velocity": ("ping xyz", F8),
    "phone_position": ("ping channel xyz", F8),
    "target_index": ("target", I4), "target_position": ("ping target xyz", F8),
    "target_velocity": ("ping target xyz", F8),
    "target_strength_db": ("ping target", F8), "target_present": ("ping target", I1),
    "replica": ("replica_sample", F4), "replica_time": ("replica_sample", F8),
    "environment/depth": ("depth", F8), "environment/sound_speed": ("depth", F8),
    "levels/level_time": ("interval", F8), "levels/echo": ("ping interval", F4),
    "levels/reverberation": ("ping interval", F4),
    "levels/noise": ("ping interval", F4),
    "rays/launch_elevation_deg": ("ray", None), "rays/range": ("ray point", None),
    "rays/depth": ("ray point", None),
    "rays/kind": ("ray", None), "rays/hit_range": ("hit", None),
}
# Axes that are there with --time-axis alone → the dimensions without values in their place.
TIMES = {"time": "sample", "replica_time": "replica_sample", "levels/level_time": "interval"}
TABLES = {
    "arrivals":
        "ping leg target channel path bearing_deg range launch_elevation_deg "
        "arrival_elevation_deg launch_deflection_deg arrival_deflection_deg delay amplitude_real "
        "amplitude_imag spreading_db "
        "absorption_db scattered path_length surface_bounces bottom_bounces upper_turns "
        "lower_turns caustics first_bounce bounce_count",
    "bounces":
        "boundary grazing_deg range",
    "echoes":
        "ping target channel highlight outgoing returning delay doppler_factor level_db "
        "arrival_elevation_deg arrival_bearing_deg",
    "patches":
        "ping boundary range area delay grazing_in_deg grazing_out_deg launch_elevation_deg "
        "arrival_elevation_deg scattering_strength_db level_db",
}
ROWS = {"arrivals": "arrival", "bounces": "bounce", "echoes": "echo", "patches": "patch"}
SUMMARY = "present array paths echo_time echo_level_db echo_peak_db reverberation_db noise_db echo_to_background_db signal_excess_db"
TIMINGS = "rays eigenrays patches synthesis noise write"
REUSE = "reuse_ocean legs_searched legs_reused planes_searched planes_reused reuse_reverberation reuse_expected_level band_points band_error surface_bounces bottom_bounces left_out_db sea_drawn_anew ended_searches"
INTEGERS = {"ping", "leg", "target", "channel", "highlight", "path", "outgoing", "returning",
            "surface_bounces",
            "bottom_bounces", "upper_turns",
            "lower_turns", "caustics", "first_bounce", "bounce_count", "boundary"}

# What a name's unit is: the first pattern that fits. None: a pure number, and then no unit or "1".
UNITS = [
    (r"_deg$", "degrees"), (r"_db$", "dB"),
    (r"(^|/)(time|replica_time|level_time|ping_time|delay|echo_time|time_\w+)$", "s"),
    (r"_velocity$", "m/s"), (r"sound_speed$", "m/s"), (r"_position$", "m"),
    (r"(range|depth|path_length)$", "m"), (r"area$", "m2"),
    (r"^pressure$", "Pa"), (r"^levels/(echo|reverberation|noise)$", "Pa2"),
    (r"amplitude_(real|imag)$", None),
]
SAME_UNIT = {"degree": "degrees", "deg": "degrees", "decibel": "dB", "m s-1": "m/s", "m^2": "m2",
             "m²": "m2", "Pa^2": "Pa2", "Pa²": "Pa2",
             "1": None, "": None}


class Check:
    """Collects everything that is wrong, so that one run shows all of it."""

    def __init__(self):
        self.faults, self.count = [], 0

    def that(self, condition, fault):
        self.count += 1
        if not condition:
            self.faults.append(fault)
        return bool(condition)


def text(value):
    return value.decode() if isinstance(value, bytes) else str(value)


def layout_of(f):
    """LAYOUT and the tables, as this file should have them (targets are optional)."""
    wanted = dict(LAYOUT)
    for table, columns in TABLES.items():
        wanted.update({f"{table}/{c}": (ROWS[table], None) for c in columns.split()})
    wanted.update({f"run/time_{t}": ("ping", None) for t in TIMINGS.split()})
    wanted.update({f"run/{name}": ("ping", None) for name in REUSE.split()})
    if "time" not in f:
        for axis, dimension in TIMES.items():
            group = axis.rpartition("/")[0]
            wanted.pop(axis)
            wanted[f"{group}/{dimension}".lstrip("/")] = (dimension, None)
    if "target_index" in f:
        wanted.update({f"summary/{c}": ("ping target", None) for c in SUMMARY.split()})
    else:
        wanted = {k: v for k, v in wanted.items() if k not in TARGET}
    return wanted


def check_layout(f, check):
    """Every dataset is there, with its dimensions in order and its type; equal names have equal
    lengths.
    """
    sizes = {}
    for name, (dimensions, kind) in layout_of(f).items():
        if not check.that(name in f and isinstance(f[name], h5py.Dataset), f"{name}: missing"):
            continue
        d, wanted = f[name], dimensions.split()
        if not check.that(d.ndim == len(wanted),
                          f"{name}: {d.ndim} dimensions, expected ({dimensions})"):
            continue
        for dimension, length in zip(wanted, d.shape):
            known = sizes.setdefault(dimension, length)
            check.that(known == length,
                       f"{name}: {length} along {dimension}, expected {known} as elsewhere")
        if kind:
            check.that(d.dtype.str == kind, f"{name}: type {d.dtype.str}, expected {kind}")
        column = name.rsplit("/", 1)[-1]
        if kind is None and name.split("/")[0] in TABLES and d.size:
            good = "iu" if column in INTEGERS else "f"
            wanted = "an integer" if good == "iu" else "floating point"
            check.that(d.dtype.kind in good, f"{name}: type {d.dtype.str}, expected {wanted}")
    return sizes


def check_self_description(f, check):
    """long_name, units, scales on every dataset; no type that netCDF or MATLAB cannot read."""
    def visit(name, d):
        if not isinstance(d, h5py.Dataset):
            return
        string = h5py.check_string_dtype(d.dtype) is not None
        check.that(d.dtype.kind in "iuf" or string,
                   f"{name}: type {d.dtype}, expected a number or a string")
        check.that(text(d.attrs.get("long_name", "")).strip(), f"{name}: no long_name")
        unit = text(d.attrs.get("units", "")) or None
        unit = SAME_UNIT.get(unit, unit)
        if not string:
            for pattern, expected in UNITS:
                if re.search(pattern, name):
                    check.that(unit == expected, f"{name}: units {unit!r}, expected {expected!r}")
                    break
        is_scale = h5py.h5ds.is_scale(d.id)
        for axis in range(d.ndim):
            if not is_scale or d.ndim > 1:
                check.that(len(d.dims[axis]) > 0, f"{name}: no scale on dimension {axis}")
        for attribute in d.attrs:
            value = d.attrs[attribute]
            check.that(np.asarray(value).dtype.kind not in "Vc"
                       or attribute in ("REFERENCE_LIST", "DIMENSION_LIST"),
                       f"{name}: attribute {attribute} of a type that netCDF cannot read")
    f.visititems(visit)


def check_attributes(f, check):
    for place, names in (("/", ROOT_ATTRIBUTES), ("pressure", PRESSURE_ATTRIBUTES),
                         ("replica", REPLICA_ATTRIBUTES),
                         ("environment", ENVIRONMENT_ATTRIBUTES), ("run", RUN_ATTRIBUTES),
                         ("patches", ["every"])):
        if check.that(place in f, f"{place}: missing"):
            for name in names:
                check.that(name in f[place].attrs, f"{place}: no attribute {name}")
    check.that(text(f.attrs.get("filetype", "")) == "asdic ping",
               f"filetype {f.attrs.get('filetype')!r}")
    check.that(text(f.attrs.get("version", "")) == "3.3", f"version {f.attrs.get('version')!r}")
    check.that(re.fullmatch(r"[0-9a-f]{64}", text(f.attrs.get("scenario_sha256", ""))),
               "scenario_sha256: not 64 hexadecimal digits")
    if "scenario" in f:
        check.that(f["scenario"].shape == (), "scenario: not a scalar")
    if "target_index" in f and check.that("names" in f["target_index"].attrs,
                                          "target_index: no attribute names"):
        check.that(np.size(f["target_index"].attrs["names"]) == f["target_index"].shape[0],
                   "target_index: not one name a target")


def check_values(f, check):
    """What every file must obey whatever was simulated."""
    rate = float(f["pressure"].attrs["sample_rate_hz"])
    told = f["pressure"].attrs
    start, step, samples = told["time_start"], told["time_step"], f["pressure"].shape[2]
    check.that(np.array_equal(f["ping"][()], np.arange(1, f["ping"].shape[0] + 1)),
               "ping: not 1, 2, …")
    check.that(np.array_equal(f["channel"][()], np.arange(f["channel"].shape[0])),
               "channel: not 0, 1, …")
    check.that(abs(step * rate - 1.0) < 1e-9, f"time_step {step}: not the sample rate's")
    if "time" in f:
        check.that(np.allclose(f["time"][()], start + np.arange(samples) * step, rtol=0,
                               atol=1e-3 * step), "time: not what start and step tell")
    valid = f["valid_samples"][()]
    check.that(np.all((valid >= 0) & (valid <= samples)), "valid_samples: not within the record")
    for row, n in enumerate(valid):
        check.that(not np.any(f["pressure"][row, :, n:]),
                   f"pressure: not 0 past valid_samples of ping {row + 1}")
        check.that(np.all(np.isfinite(f["pressure"][row, :, :n])),
                   f"pressure: not finite in ping {row + 1}")
    chunks = f["pressure"].chunks
    check.that(chunks is not None and chunks[:2] == (1, 1),
               f"pressure: chunks {chunks}, expected (1, 1, n)")
    depth, speed = f["environment/depth"][()], f["environment/sound_speed"][()]
    check.that(np.all(np.diff(depth) > 0), "environment/depth: not increasing")
    check.that(np.all((speed > 1300) & (speed < 1700)),
               "environment/sound_speed: not that of sea water")
    check.that(np.abs(f["replica"][()]).max() <= 1.0 + 1e-6, "replica: above unit peak")
    for key in ("echo", "reverberation", "noise"):
        check.that(np.all(f[f"levels/{key}"][()] >= 0), f"levels/{key}: negative mean squares")
    first, count = f["arrivals/first_bounce"][()], f["arrivals/bounce_count"][()]
    has = count > 0
    check.that(np.all(first[has] + count[has] <= f["bounces/range"].shape[0]),
               "arrivals: bounces past the end of /bounces")
    eta = f["echoes/doppler_factor"][()]
    check.that(np.all(np.abs(eta[np.isfinite(eta)] - 1.0) < 0.1),
               "echoes: a Doppler factor of no vessel")


def check_xarray(path, check):
    """xarray opens the root and every group, with axes; and reads the numbers that h5py reads."""
    import xarray

    with h5py.File(path, "r") as f:
        groups = [name for name in f if isinstance(f[name], h5py.Group)]
        corner = f["pressure"][0, -1, :64]
    check.that(set(groups) >= {"environment", "arrivals", "bounces", "echoes", "patches", "levels",
                               "rays", "run"}, f"groups: only {groups}")
    try:
        with xarray.open_dataset(path, engine="netcdf4") as root:
            p = root["pressure"]
            axes = ["ping", "channel"] + ["time"] * ("time" in root.variables)
            for axis in axes:
                check.that(axis in p.dims, f"xarray: pressure has the axes {p.dims}, no {axis}")
                check.that(axis in p.coords, f"xarray: pressure has no coordinate {axis}")
            check.that(p.dims[2] in ("time", "sample"), f"xarray: pressure has the axes {p.dims}")
            check.that(np.array_equal(p.values[0, -1, :64], corner, equal_nan=True),
                       "xarray: other pressures than h5py")
            check.that(p.attrs.get("units") == "Pa", "xarray: pressure without units")
    except Exception as error:  # whatever a damaged file brings out of the library
        check.that(False, f"xarray: {type(error).__name__}: {error}")
    for group in groups:
        try:
            with xarray.open_dataset(path, engine="netcdf4", group=group) as part:
                part.load()
                check.that(group == "summary" or len(part.variables) > 0,
                           f"xarray: nothing in {group}")
        except Exception as error:
            check.that(False, f"xarray: {group}: {type(error).__name__}: {error}")


def check_h5dump(path, check):
    done = subprocess.run(["h5dump", "-H", path], capture_output=True, text=True)
    check.that(done.returncode == 0,
               f"h5dump -H: exit {done.returncode}: {done.stderr.strip()[:200]}")
    check.that('DATASET "pressure"' in done.stdout, "h5dump -H: no pressure")
    check.that("H5T_COMPOUND" not in re.sub(r'ATTRIBUTE "REFERENCE_LIST" \{.*?\n\s*DATASPACE', "",
                                            done.stdout, flags=re.S),
               "h5dump -H: a compound type")


def check_file(path):
    check = Check()
    with h5py.File(path, "r") as f:
        check_layout(f, check)
        check_attributes(f, check)
        check_self_description(f, check)
        if not check.faults:
            check_values(f, check)
    check_xarray(path, check)
    check_h5dump(path, check)
    for fault in check.faults:
        print(f"{path}: {fault}")
    print(f"{path}: {check.count} checks, {len(check.faults)} faults")
    return not check.faults


def proves_itself(folder):
    """A good synthetic file passes and each spoilt one fails: the test can tell."""
    import contextlib
    import io

    import make_ping_file as synthetic

    settings = synthetic.Settings(duration=2.0, sample_rate=2500.0, frequency=1000.0, pulse=0.25,
                                  phones=3, depth=500.0, water=1200.0,
                                  targets=[(1200.0, 65.0, 60.0)], pings=2)
    good = folder / "good.h5"
    synthetic.write(good, settings)
    if not check_file(good):
        return False
    spoils = {
        "no units": lambda f: f["pressure"].attrs.__delitem__("units"),
        "no long_name": lambda f: f["echoes/delay"].attrs.__delitem__("long_name"),
        "no scale": lambda f: f["phone_position"].dims[1].detach_scale(f["channel"]),
        "no dataset": lambda f: f.__delitem__("levels/noise"),
        "compound": lambda f: f.create_dataset("x", data=np.zeros(2, [("a", "f4"), ("b", "f4")])),
        "not the rate": lambda f: f["pressure"].attrs.__setitem__("time_step", 1.0),
        "past the end": lambda f: f["valid_samples"].__setitem__(0, 100),
        "wrong unit": lambda f: f["environment/depth"].attrs.__setitem__("units", "km"),
    }
    for name, spoil in spoils.items():
        bad = folder / f"{name}.h5"
        bad.write_bytes(good.read_bytes())
        with h5py.File(bad, "r+") as f:
            spoil(f)
        with contextlib.redirect_stdout(io.StringIO()):
            passed = check_file(bad)
        if passed:
            print(f"a file spoilt by '{name}' was not found out")
            return False
    return True


def run_program(program, folder, *options):
    """Runs `asdic ping` on the isovelocity scenario (any other, where that is not there). → path of
    the file
    """
    scenarios = [ROOT / "scenarios" / "isovelocity.toml",
                 *sorted((ROOT / "scenarios").glob("*.toml"))]
    scenario = next((s for s in scenarios if s.exists()), None)
    if scenario is None:
        return None
    file = folder / ("ping.h5" if not options else "axis.h5")
    done = subprocess.run([program, "ping", scenario, "-o", file, "--quiet", *options],
                          capture_output=True, text=True)
    if done.returncode != 0 or not file.exists():
        sys.exit(f"asdic ping {scenario.name}: exit {done.returncode}: {done.stderr.strip()}")
    if list(folder.glob("*.part")):
        sys.exit("asdic ping left a .part file behind")
    return file


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--file", help="check this file instead of running the program")
    options = parser.parse_args()
    if options.file:
        return 0 if check_file(options.file) else 1
    with tempfile.TemporaryDirectory(prefix="asdic_file_") as folder:
        folder = Path(folder)
        if not proves_itself(folder):
            return 1
        program = os.environ.get("ASDIC")
        file = run_program(program, folder) if program else None
        if file is None:
            print("no program or no scenario: checked the synthetic file only")
            return 0
        return 0 if check_file(file) and check_file(run_program(program, folder, "--time-axis")) else 1


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Every kind of HDF5 file that asdic writes opens whole in xarray (both engines), h5netcdf, ncdump and
h5py, with names and units by the CF conventions; and `asdic info` reads every result.

    ASDIC=build/ci/bin/asdic every_reader.py [KIND...]     of these kinds alone
    every_reader.py --file FILE.h5...                      these files

xarray and h5netcdf read each layout of a group once, which is what decides how they take it; with ASDIC_DEEP=1
every group of every file. h5py, ncdump and netCDF read all of every file.
"""
import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import h5netcdf
import h5py
import netCDF4
import numpy as np
import xarray

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
from deep import DEEP  # noqa: E402

BELLHOP = ROOT / "tests" / "data" / "bellhop"

SEA = """title = "small sea"
seed = 3
[environment]
wind_speed = 8.0
[environment.sound_speed]
kind = "isovelocity"
speed = 1500.0
[environment.bottom]
depth = 300.0
kind = "fluid"
speed = 1600.0
density = 1500.0
[[platform]]
name = "ship"
position = [0.0, 0.0, 50.0]
velocity = [0.0, 3.0, 0.0]
[[platform]]
name = "buoy"
position = [400.0, 300.0, 80.0]
[[transmitter]]
name = "ping"
platform = "ship"
source_level_db = 200.0
taper = "omnidirectional"
{transmitters}
[pulse]
kind = "lfm"
start_frequency = 950.0
end_frequency = 1050.0
duration = 0.1
{arrays}
{targets}
[noise]
spectral_level_db = 40.0
[reverberation]
azimuths = 8
[propagation]
max_surface_bounces = 1
max_bottom_bounces = 1
[pings]
count = 2
interval = 6.0
recording_duration = 2.0
sample_rate = 4000.0
"""
LINE = """[[array]]
name = "line"
platform = "ship"
offset = [0.0, 0.0, 10.0]
kind = "horizontal"
phones = 6
spacing = 0.75
"""
PHONE = """[[array]]
name = "phone"
platform = "buoy"
kind = "vertical"
phones = 1
spacing = 1.0
"""
ROCK = """[[target]]
name = "rock"
position = [900.0, 300.0, 150.0]
strength_db = 20.0
"""
SUBMARINE = """[[target]]
name = "submarine"
position = [600.0, -500.0, 120.0]
velocity = [3.0, 0.0, 0.0]
strength_db = 15.0
"""
SECOND = """[[transmitter]]
name = "second"
platform = "buoy"
source_level_db = 200.0
taper = "omnidirectional"
first_ping_time = 3.0
[transmitter.pulse]
kind = "cw"
frequency = 1020.0
duration = 0.1
"""
FREIGHTER = """[[interferer]]
name = "freighter"
position = [900.0, 1200.0, 8.0]
level_db = 130.0
"""
SLOPE = """kind = "fluid"
speed = 1600.0
density = 1500.0
[environment.bottom.shape]
range = [0.0, 1500.0, 3000.0]
depth = [300.0, 250.0, 280.0]
"""
SECTION = """kind = "section"
range = [0, 2000]
depth = [0, 100, 300]
speed = [[1500, 1495, 1500], [1510, 1500, 1502]]
"""
RUN = """[run]
task = "{task}"
field = "{field}"
frequency = 200.0
[run.source]
depth = [40.0, 60.0]
[run.receivers]
depth = {depth}
range = [500.0, 1000.0, 1500.0]
irregular = {irregular}
[run.fan]
lowest_deg = -20.0
highest_deg = 20.0
count = {count}
"""
STUDY = """[study]
title = "readers"
scenario = "{scenario}"
realisations = 24
on_error = "skip"
[vary]
"target.0.range" = {{ law = "uniform", low = 500.0, high = 1500.0 }}
"target.0.depth" = {{ law = "uniform", low = 100.0, high = {deepest} }}
"noise.spectral_level_db" = {{ law = "uniform", low = 35.0, high = 80.0 }}
"environment.absorption.kind" = {{ law = "categorical", values = ["none", "thorp"] }}
[measure]
echo_level = true
detection = {{ false_alarm_probability = 1e-2 }}
strongest_path = true
time_series = {kept}
[summary]
by = [{{ axis = "range", edges = [500, 800, 1500] }}, "spectral_level_db", ["range", "spectral_level_db"]]
"""


ORIGIN = """[environment.origin]
latitude_deg = 54.0
longitude_deg = 7.5
"""


def sea(arrays=LINE, targets=ROCK, transmitters="", more=""):
    return SEA.format(arrays=arrays, targets=targets, transmitters=transmitters) + more


def baseband(text):
    return text.replace("sample_rate = 4000.0", 'samples = "baseband"')


def over_slope():
    text = sea()
    text = re.sub(r'kind = "isovelocity"\nspeed = 1500.0\n', SECTION, text)
    return re.sub(r'depth = 300.0\nkind = "fluid"\nspeed = 1600.0\ndensity = 1500.0\n', SLOPE, text)


def ocean_of(text):
    """The environment of a run of the propagation model"""
    return text.split("[[platform]]")[0].replace("seed = 3\n", "").replace("wind_speed = 8.0\n", "")


def run_of(task, field="coherent", irregular=False, count=0):
    return ocean_of(sea()) + RUN.format(task=task, field=field, irregular=str(irregular).lower(), count=count,
                                    depth="[50.0, 80.0, 90.0]" if irregular else "[50.0, 100.0]")


class Files:
    """Makes the files, each kind on its own."""

    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def asdic(self, *words, status=0, stdin=None):
        done = subprocess.run([self.program, *words], cwd=self.folder, capture_output=True, text=True,
                              input=stdin)
        if done.returncode != status:
            sys.exit(f"asdic {' '.join(words)}: exit {done.returncode}: {done.stderr.strip()}")
        return done.stdout

    def ping(self, name, text, *words):
        (self.folder / f"{name}.toml").write_text(text)
        self.asdic("ping", f"{name}.toml", "-o", f"{name}.h5", "--quiet", *words)
        return f"{name}.h5"

    def kind_ping(self):
        several = baseband(sea(LINE + PHONE, ROCK + SUBMARINE, SECOND, FREIGHTER))
        return [self.ping("real", sea()), self.ping("real_axis", sea(), "--time-axis"),
                self.ping("baseband", baseband(sea())),
                self.ping("baseband_axis", baseband(sea()), "--time-axis"),
                self.ping("one_phone", sea(PHONE)), self.ping("no_target", sea(targets="")),
                self.ping("silent", sea(), "--set", "reverberation.enabled=false", "--set",
                          "noise.spectral_level_db=-300"),
                self.ping("several", several),
                self.ping("continuous", several, "--set", "pings.continuous=true", "--set", "pings.recording_duration=5.0", "--set", "pings.interval=6.0"),
                self.ping("slope", over_slope() + ORIGIN),
                self.ping("per_phone", sea(), "--set", "propagation.exact_per_phone=true")]

    def kind_processed(self):
        files = []
        for name, text in (("p_line", sea(more=ORIGIN)), ("p_several", sea(LINE + PHONE, transmitters=SECOND))):
            ping = self.ping(name, baseband(text))
            self.asdic("process", ping, "-o", f"{name}_done.h5", "--quiet", "--target-depth", "150m")
            self.asdic("process", ping, "-o", f"{name}_bare.h5", "--quiet", "--no-maps")
            files += [f"{name}_done.h5", f"{name}_bare.h5"]
        return files

    def kind_area(self):
        (self.folder / "area.toml").write_text(sea(more=ORIGIN))
        self.asdic("area", "area.toml", "-o", "area.h5", "--quiet", "--depth", "50,120", "--reach",
                   "2km", "--bearings", "12", "--ranges", "20")
        return ["area.h5"]

    def kind_placement(self):
        (self.folder / "placed.toml").write_text(sea(more=ORIGIN))
        (self.folder / "plan.toml").write_text(
            '[placement]\nscenario = "placed.toml"\nsensors = 2\nbearings = 12\nranges = 20\nreach = 2000.0\n'
            'draws = 2\nmap_error = "cells"\n[placement.places]\npoints = [[0.0, 0.0], [500.0, 0.0], [0.0, 900.0]]\n'
            '[placement.cells]\neast = [-1000.0, 1000.0]\nnorth = [-1000.0, 1000.0]\nstep = 500.0\n')
        self.asdic("place", "plan.toml", "-o", "placed.h5", "--quiet")
        return ["placed.h5"]

    def kind_field(self):
        cases = {"grid": run_of("field"), "incoherent": run_of("field", "incoherent"),
                 "places": run_of("field", irregular=True)}
        for name, text in cases.items():
            (self.folder / f"f_{name}.toml").write_text(text)
            self.asdic("field", f"f_{name}.toml", "-o", f"f_{name}.h5", "--quiet")
        (self.folder / "f_front.toml").write_text(
            run_of("field").replace(ocean_of(sea()), ocean_of(over_slope())))
        self.asdic("field", "f_front.toml", "-o", "f_front.h5", "--quiet")
        return [f"f_{name}.h5" for name in (*cases, "front")]

    def kind_arrivals(self):
        (self.folder / "a.toml").write_text(sea())
        self.asdic("arrivals", "a.toml", "-o", "a_legs.h5")
        self.asdic("arrivals", "a.toml", "--receiver-depth", "100", "--range", "1km", "-o",
                   "a_receiver.h5")
        for name, irregular in (("a_grid", False), ("a_places", True)):
            (self.folder / f"{name}.toml").write_text(run_of("arrivals", irregular=irregular))
            self.asdic("arrivals", f"{name}.toml", "-o", f"{name}.h5")
        return ["a_legs.h5", "a_receiver.h5", "a_grid.h5", "a_places.h5"]

    def kind_rays(self):
        (self.folder / "r.toml").write_text(over_slope())
        self.asdic("rays", "r.toml", "-o", "r_fan.h5")
        (self.folder / "r_run.toml").write_text(run_of("rays", count=9).replace("[40.0, 60.0]", "40.0"))
        self.asdic("rays", "r_run.toml", "-o", "r_run.h5")
        return ["r_fan.h5", "r_run.h5"]

    def kind_converted(self):
        files = []
        for ending in ("shd", "arr", "ray"):
            source = sorted(BELLHOP.glob(f"**/*.{ending}"))[0]
            shutil.copy(source, self.folder / f"c.{ending}")
            self.asdic("convert", f"c.{ending}", f"c_{ending}.h5", "--quiet")
            files.append(f"c_{ending}.h5")
        return files

    def kind_study(self):
        (self.folder / "sea.toml").write_text(sea())
        (self.folder / "baseband_sea.toml").write_text(baseband(sea()))
        files = []
        for name, scenario, kept, deepest, words in (
                ("s_real", "sea", '"all"', 250.0, ()),
                ("s_baseband", "baseband_sea", "2", 250.0, ()),
                ("s_skipped", "sea", '"none"', 800.0, ()),
                ("s_until", "sea", '"none"', 250.0, ("--until", "0.2"))):
            (self.folder / f"{name}.toml").write_text(
                STUDY.format(scenario=f"{scenario}.toml", kept=kept, deepest=deepest))
            self.asdic("study", f"{name}.toml", "-o", f"{name}.h5", "--quiet", *words)
            files.append(f"{name}.h5")
        for part in (1, 2):
            self.asdic("study", "s_baseband.toml", "-o", f"part{part}.h5", "--quiet", "--shard",
                       f"{part}/2")
        self.asdic("merge", "part1.h5", "part2.h5", "-o", "s_catalogue.h5", "--quiet")
        self.asdic("merge", "part1.h5", "part2.h5", "-o", "s_copy.h5", "--copy", "--quiet")
        return files + ["part1.h5", "s_catalogue.h5", "s_copy.h5"]

    def kind_served(self):
        (self.folder / "served.toml").write_text(sea())
        (self.folder / "served").mkdir()
        self.asdic("serve", "served.toml", "--output-dir", "served",
                   stdin='{"asdic": 1}\n{"command": "ping"}\n')
        return [str(p.relative_to(self.folder)) for p in self.folder.glob("served/**/*.h5")]

    KINDS = ["ping", "processed", "area", "placement", "field", "arrivals", "rays", "converted", "study", "served"]

    def others(self):
        """Results in other formats, which `asdic info` reads."""
        (self.folder / "o.toml").write_text(run_of("field"))
        self.asdic("field", "o.toml", "-o", "o.shd", "--quiet")
        (self.folder / "o_rays.toml").write_text(run_of("rays", count=9))
        self.asdic("rays", "o_rays.toml", "-o", "o.ray")
        (self.folder / "o_arrivals.toml").write_text(run_of("arrivals"))
        self.asdic("arrivals", "o_arrivals.toml", "-o", "o.arr")
        self.asdic("export", self.ping("sound", sea()), "--wav")
        return ["o.shd", "o.ray", "o.arr", "sound_ping001.wav"]


# ---------------------------------------------------------------- what every file obeys

# Of CF's table (https://cfconventions.org/standard-names.html), with the canonical unit.
STANDARD_NAMES = {"depth": "m", "sea_floor_depth_below_mean_sea_level": "m",
                  "speed_of_sound_in_sea_water": "m/s", "sound_pressure_in_water": "Pa",
                  "sound_pressure_level_in_water": "dB", "latitude": "degrees_north",
                  "longitude": "degrees_east"}
# UDUNITS has no decibel; CF's own table uses it. Everything else UDUNITS reads.
UNITS = {"1", "m", "m2", "m/s", "s", "Hz", "Pa", "Pa2", "degree", "degrees", "dB", "kg/m3", "degC",
         "degrees_north", "degrees_east", "min", "h", "d"}
UNITS |= {f"({unit})-1" for unit in UNITS - {"degC"}}  # of densities
INSIDE = {"CLASS", "NAME", "REFERENCE_LIST", "DIMENSION_LIST", "_Netcdf4Dimid",
          "_Netcdf4Coordinates", "_NCProperties", "_nc3_strict"}
NO_VARIABLE = "This is a netCDF dimension but not a netCDF variable"


def text(value):
    return value.decode() if isinstance(value, bytes) else str(value)


def is_bare(dataset):
    """A dimension without a variable"""
    return text(dataset.attrs.get("NAME", "")).startswith(NO_VARIABLE)


def faults_of_dataset(name, d, f):
    string = h5py.check_string_dtype(d.dtype) is not None
    scale = h5py.h5ds.is_scale(d.id)
    if not (d.dtype.kind in "iuf" or string):
        yield f"type {d.dtype}, expected a number or a string"
    if not text(d.attrs.get("long_name", "")).strip():
        yield "no long_name"
    for axis in range(d.ndim):
        count = len(d.dims[axis])
        if count != (0 if scale else 1):
            yield f"{count} scales on dimension {axis}"
        elif count and d.dims[axis][0].shape[0] != d.shape[axis]:
            yield f"a scale of length {d.dims[axis][0].shape[0]} on dimension {axis} of {d.shape[axis]}"
    units = text(d.attrs["units"]) if "units" in d.attrs else None
    if units is not None and units not in UNITS:
        yield f'units "{units}", which are not among {sorted(UNITS)}'
    column = name.rsplit("/", 1)[-1]
    if re.search(r"_db(_low|_high)?$", column) and "quantity" not in d.parent and units != "dB":
        yield f"units {units!r}, expected dB"
    standard = text(d.attrs["standard_name"]) if "standard_name" in d.attrs else None
    if standard is not None and STANDARD_NAMES.get(standard) != units:
        yield f'standard_name "{standard}" with units {units!r}, expected one of {STANDARD_NAMES}'
    if standard == "depth" and text(d.attrs.get("positive", "")) != "down":
        yield "a depth that is not positive down"
    if "axis" in d.attrs and not (scale and text(d.attrs["axis"]) in ("X", "Y", "Z")):
        yield f"axis {text(d.attrs['axis'])!r} of no coordinate"
    if is_bare(d) and d.id.get_storage_size() != 0:
        yield "a dimension without values that takes room"
    for key in text(d.attrs.get("coordinates", "")).split():
        if key not in d.parent:
            yield f"coordinates: no {key}"
    if not is_bare(d) and "time_step" in d.attrs and not d.attrs["time_step"] > 0.0:
        yield f"a time step of {d.attrs['time_step']} s"


def is_unterminated(kind, value):
    """netCDF-C reads a text of fixed length on until it finds a zero: past the end, if it has none."""
    return (isinstance(kind, h5py.h5t.TypeStringID) and not kind.is_variable_str()
            and any(len(text) >= kind.get_size() for text in np.ravel(value)))


def check_h5py(path, f, groups, fault):
    if text(f.attrs.get("Conventions", "")) != "CF-1.10":
        fault("no Conventions = CF-1.10")

    def visit(name, item):
        if isinstance(item, h5py.Dataset):
            for what in faults_of_dataset(name, item, f):
                fault(f"{name}: {what}")
            item[()]
            if is_unterminated(item.id.get_type(), item[()]):
                fault(f"{name}: a text without a zero at its end")
        for key in item.attrs:
            if key not in INSIDE and is_unterminated(h5py.h5a.open(item.id, key.encode()).get_type(),
                                                     item.attrs[key]):
                fault(f"{name}: attribute {key}: a text without a zero at its end")
            if key not in INSIDE and np.asarray(item.attrs[key]).dtype.kind in "Vc":
                fault(f"{name}: attribute {key} of a type that netCDF cannot read")
    f.visititems(visit)


def groups_of(group):
    yield group.name
    for item in group.values():
        if isinstance(item, h5py.Group):
            yield from groups_of(item)


def variables_of(group):
    return {name: item for name, item in group.items()
            if isinstance(item, h5py.Dataset) and not is_bare(item)}


def layout(group, names):
    """What decides how a reader takes a group: all but the lengths and the numbers. `names` of the file's
    datasets by their addresses, as to find the name of a scale takes HDF5 a search of the whole file."""
    def scales(item):
        return tuple(tuple(names[h5py.h5o.get_info(scale.id).addr] for scale in dimension.values())
                     for dimension in item.dims)
    return (group.name, tuple(sorted(group.attrs)),
            *((name, item.dtype.str, item.shape == (), 0 in item.shape, is_bare(item), scales(item),
               tuple(sorted(item.attrs)))
              for name, item in sorted(group.items()) if isinstance(item, h5py.Dataset)))


layouts_read = set()  # by the slow readers


def groups_to_read(f):
    """\return the groups whose layout no slow reader has read before, notes that they have now"""
    names = {}
    f.visititems(lambda name, item: names.update({h5py.h5o.get_info(item.id).addr: name}))
    some = []
    for group in groups_of(f):
        now = layout(f[group], names)
        if DEEP or now not in layouts_read:
            some.append(group)
        layouts_read.add(now)
    return some


def check_variables(where, group, there, numbers, fault):
    """The variables and the numbers that h5py reads in a group. `numbers` gives those of a name."""
    expected = variables_of(group)
    if set(there) != set(expected):
        fault(f"{where}: variables {sorted(there)}, expected {sorted(expected)}")
    for name, item in expected.items():
        if item.dtype.kind in "iuf" and name in there and not np.array_equal(
                numbers(name), item[()], equal_nan=item.dtype.kind == "f"):
            fault(f"{where}: {name}: other numbers than in h5py")


def check_netcdf(path, f, groups, fault):
    """All groups of every file"""
    try:
        with netCDF4.Dataset(path) as data:
            data.set_auto_maskandscale(False)
            for group in groups_of(f):
                there = data[group].variables if group != "/" else data.variables
                check_variables(f"netCDF, {group}", f[group], there, lambda name: there[name][...], fault)
    except Exception as error:  # whatever comes out of the library
        fault(f"netCDF: {type(error).__name__}: {str(error)[:200]}")


def check_xarray(path, f, groups, fault):
    """With the numbers that h5py reads and without dimensions of no name"""
    for engine in ("netcdf4", "h5netcdf"):
        for group in groups:
            where = f"xarray, {engine}, {group}"
            try:
                with xarray.open_dataset(path, engine=engine, group=group) as data:
                    data.load()
                    check_variables(where, f[group], data.variables, lambda name: data[name].values, fault)
                    phony = [d for d in data.dims if "phony" in d]
                    if phony:
                        fault(f"{where}: dimensions {phony}")
            except Exception as error:
                fault(f"{where}: {type(error).__name__}: {str(error)[:200]}")


def check_h5netcdf(path, f, groups, fault):
    """Names, types and dimensions; xarray's engine h5netcdf reads the numbers."""
    try:
        with h5netcdf.File(path, "r") as g:
            for group in groups:
                for variable in (g[group] if group != "/" else g).variables.values():
                    variable.dtype
                    variable.dimensions
    except Exception as error:
        fault(f"h5netcdf: {type(error).__name__}: {str(error)[:200]}")


def check_ncdump(path, f, groups, fault):
    """Large files as headers: check_netcdf() reads the numbers by the same library."""
    large = Path(path).stat().st_size > 500_000
    done = subprocess.run(["ncdump", *(["-h"] if large else []), path], capture_output=True,
                          text=True, errors="replace")
    if done.returncode != 0:
        fault(f"ncdump: exit {done.returncode}: {done.stderr.strip()[:200]}")
    if "phony_dim" in done.stdout:
        fault("ncdump: " + next(line for line in done.stdout.splitlines() if "phony_dim" in line))


def check_file(path):
    """\\return the number of faults, which it prints"""
    faults = []
    with h5py.File(path, "r") as f:
        groups = groups_to_read(f)
        for check in (check_h5py, check_netcdf, check_xarray, check_h5netcdf, check_ncdump):
            check(path, f, groups, faults.append)
    for fault in faults:
        print(f"{Path(path).name}: {fault}")
    return len(faults)


def check_special(folder):
    """What readers count on beyond: axes with names and places, bins as coordinates"""
    faults = []

    def expect(good, what):
        if not good:
            faults.append(what)
    with xarray.open_dataset(folder / "baseband.h5", engine="netcdf4") as d:
        expect(d.pressure.dims == ("ping", "channel", "sample", "iq"), f"baseband: {d.pressure.dims}")
        expect("time" not in d, "baseband: times written out")
        start, step = d.pressure.attrs["time_start"], d.pressure.attrs["time_step"]
        expect(step * d.pressure.attrs["sample_rate_hz"] == 1.0, "baseband: time_step")
        expect(d.replica.dims == ("replica_sample", "iq"), f"baseband: {d.replica.dims}")
    with xarray.open_dataset(folder / "baseband_axis.h5", engine="netcdf4") as d:
        expect(d.pressure.dims == ("ping", "channel", "time", "iq"), f"axis: {d.pressure.dims}")
        expect(np.allclose(d.time, start + step * np.arange(d.time.size), rtol=0, atol=1e-9 * step),
               "axis: other times than start and step tell")
    with xarray.open_dataset(folder / "s_real.h5", group="summary/means_by_range") as d:
        expect("range" in d.echo_level_db.coords, f"bins: {d.echo_level_db.coords}")
        expect({"range_low", "range_high"} <= set(d.echo_level_db.coords), "bins: no edges")
    with xarray.open_dataset(folder / "s_real.h5", group="summary/pd_by_range_and_spectral_level_db") as d:
        expect({"range", "spectral_level_db"} <= set(d.pd.coords), f"bins of two: {d.pd.coords}")
    with xarray.open_dataset(folder / "s_baseband.h5", group="time_series") as d:
        expect(d.pressure.dims == ("index", "channel", "sample", "iq"), f"series: {d.pressure.dims}")
    with h5py.File(folder / "s_real.h5") as f:
        level = f["table/path_level_db"].attrs
        expect(text(level["units"]) == "dB" and text(level["reference"]) == "1 µPa", "table: levels")
    for fault in faults:
        print(fault)
    return len(faults)


def proves_itself(path, folder):
    """A file that is spoilt is found out."""
    spoils = {
        "no scale": lambda f: f["replica"].dims[1].detach_scale(f["iq"]),
        "no long_name": lambda f: f["echoes/delay"].attrs.__delitem__("long_name"),
        "unit": lambda f: f["echoes/delay"].attrs.__setitem__("units", "dB re 1 uPa"),
        "standard_name": lambda f: f["echoes/delay"].attrs.__setitem__("standard_name", "echo_delay"),
        "conventions": lambda f: f.attrs.__delitem__("Conventions"),
        "no axis": lambda f: f["echoes/delay"].dims[0].detach_scale(f["echoes/echo"]),
    }
    unseen = 0
    for name, spoil in spoils.items():
        bad = folder / f"{name}.h5"  # a reader that fails may keep a file open
        shutil.copy(path, bad)
        with h5py.File(bad, "r+") as f:
            spoil(f)
        faults = []
        with h5py.File(bad, "r") as f:
            check_h5py(bad, f, [], faults.append)
            if name == "no scale":  # what readers said of every baseband file once
                for check in (check_xarray, check_ncdump):
                    some = []
                    check(bad, f, groups_of(f), some.append)
                    if not some:
                        print(f"{check.__name__} does not see {name}")
                        unseen += 1
        if not faults:
            print(f"a file spoilt by '{name}' was not found out")
            unseen += 1
    return unseen


def udunits_faults():
    """The strict list above, by UDUNITS itself where it is installed."""
    if shutil.which("udunits2") is None:
        return 0
    bad = [u for u in sorted(UNITS - {"dB", "(dB)-1"})
           if subprocess.run(["udunits2", "-H", u, "-W", u], capture_output=True).returncode != 0]
    if bad:
        print(f"udunits2 does not read {bad}")
    return len(bad)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("kinds", nargs="*", help=f"of {Files.KINDS}")
    parser.add_argument("--file", nargs="+", help="check these files instead of running the program")
    options = parser.parse_args()
    if options.file:
        return min(1, sum(check_file(path) for path in options.file))
    program = os.environ.get("ASDIC")
    if not program:
        sys.exit("ASDIC names no program")
    with tempfile.TemporaryDirectory(prefix="asdic_readers_") as folder:
        folder = Path(folder)
        make = Files(str(Path(program).resolve()), folder)
        faults, count = udunits_faults(), 0
        kinds = options.kinds or Files.KINDS
        for kind in kinds:
            files = getattr(make, f"kind_{kind}")()
            if not files:
                sys.exit(f"{kind}: no file was made")
            for name in files:
                faults += check_file(folder / name)
                if len(make.asdic("info", name)) < 100:
                    faults += 1
                    print(f"{name}: asdic info says next to nothing")
                count += 1
        if kinds == Files.KINDS:
            faults += check_special(folder) + proves_itself(folder / "baseband.h5", folder)
            for name in make.others():
                if len(make.asdic("info", name)) < 80:
                    faults += 1
                    print(f"{name}: asdic info says next to nothing")
        print(f"{count} files, {faults} faults")
        return min(1, faults)


if __name__ == "__main__":
    sys.exit(main())

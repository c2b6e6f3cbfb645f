#!/usr/bin/env python3
"""The Python package: what it computes is what the program computes, and how it meets its users."""
import ast
import json
import os
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import warnings
from pathlib import Path

BUILD, PROGRAM = Path(os.environ["ASDIC_BUILD"]), os.environ["ASDIC"]
SCENARIOS = Path(__file__).resolve().parents[3] / "scenarios"
if not list((BUILD / "python/asdic").glob("_core*.so")):
    print("the Python package was not built here")
    sys.exit(77)
sys.path.insert(0, str(BUILD / "python"))

import numpy as np  # noqa: E402
import pandas as pd  # noqa: E402
import xarray as xr  # noqa: E402

import asdic  # noqa: E402


def run(*words) -> str:
    return subprocess.run([PROGRAM, *map(str, words)], check=True, capture_output=True,
                          text=True).stdout


class Areas(unittest.TestCase):
    def test_it_is_what_the_program_writes(self):
        scenario = SCENARIOS / "isovelocity.toml"
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "area.h5"
            run("area", scenario, "-o", path, "-q", "--depth", "40,80", "--reach", "3km",
                "--bearings", 24, "--ranges", 30, "--fluctuation", "swerling-1")
            told = json.loads(run("area", scenario, "-o", Path(folder) / "same.h5", "--json", "--depth",
                                  "40,80", "--reach", "3000", "--bearings", 24, "--ranges", 30,
                                  "--fluctuation", "swerling-1"))
            read = asdic.open(path, load=True)
            self.assertIn("24 bearings x 30 ranges to 3 km", run("info", path))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            made = asdic.area(asdic.Scenario(scenario), [40.0, 80.0], reach=3e3, bearings=24, ranges=30,
                              fluctuation="swerling-1")
        self.assertEqual(dict(made.sizes) | dict(depth=2, bearing=24, range=30), dict(made.sizes))
        for name in read.data_vars:
            np.testing.assert_array_equal(made[name].values, read[name].values, err_msg=name)
        # Where nothing fluctuates so, half is detected at an excess of 0.
        excess, probability = made.signal_excess_db.values, made.detection_probability.values
        self.assertTrue(np.all((probability > 0.5) == (excess > 0.0)))
        self.assertEqual([d["depth"] for d in told["depths"]], [40.0, 80.0])
        share = (np.where(probability[0] >= 0.5, 1.0, 0.0) * made.range.values).sum() \
            / (24 * made.range.values.sum())
        self.assertAlmostEqual(told["depths"][0]["detected_pct"], 100.0 * share, places=3)

    def test_faults_name_the_option(self):
        scenario = asdic.Scenario(SCENARIOS / "isovelocity.toml")
        with self.assertRaises(asdic.InputError) as raised:
            asdic.area(scenario, 40.0, array="bow")
        self.assertIn('--array: found "bow"', str(raised.exception))
        with self.assertRaises(asdic.InputError):
            asdic.area(scenario, -1.0)


class Settings(unittest.TestCase):
    def setUp(self):
        self.s = asdic.Scenario(SCENARIOS / "deep_ocean.toml")

    def test_attributes_are_the_settings(self):
        s = self.s
        self.assertEqual(s.pulse.frequency, 4000.0)
        self.assertEqual(s.targets[0].depth, 125.0)
        s.targets[0].depth = 200
        self.assertEqual(asdic.Scenario.parse(s.to_toml()).targets[0].depth, 200.0)
        self.assertEqual(len(s.targets[0].waypoints), 0)
        self.assertEqual(s.propagation.direct_blast, True)  # a default
        s.pulse.window = None  # back to what holds without it
        self.assertFalse(s._core.has("pulse.window"))

    def test_names_and_help_are_those_of_the_description(self):
        names = dir(self.s.pulse)
        self.assertIn("duration", names)
        self.assertIn("targets", dir(self.s))
        text = self.s.pulse.help("duration")
        self.assertIn("[s]", text)
        self.assertIn("from 1e-06 to 1000", text)
        for path in asdic.settings():
            self.assertTrue(all(one.help for one in asdic.settings()[path]), path)

    def test_faults_are_told_with_key_found_and_expected(self):
        with self.assertRaises(asdic.InputError) as raised:
            self.s.pulse.duration = -1
        self.assertEqual(raised.exception.key, "pulse.duration")
        self.assertIn("-1", raised.exception.found)
        with self.assertRaises(asdic.InputError) as raised:
            self.s.pulse.duratoin = 1
        self.assertIn("duration", str(raised.exception))
        with self.assertRaises(asdic.InputError) as raised:
            self.s.pulse.window = "han"
        self.assertIn("hann", raised.exception.expected)
        with self.assertRaises(AttributeError):
            self.s.pulse.wavelength
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "bad.toml"
            file.write_text("[pulse]\nduration = \"long\"\n")
            with self.assertRaises(asdic.InputError) as raised:
                asdic.Scenario(file).validate()
            self.assertTrue(raised.exception.file or raised.exception.key, str(raised.exception))
            file.write_text("[pulse\n")
            with self.assertRaises(asdic.InputError) as raised:
                asdic.Scenario(file)
            self.assertEqual(raised.exception.line, 1)
            self.assertTrue(raised.exception.file.endswith("bad.toml"))
        self.assertIsInstance(raised.exception, ValueError)

    def test_lists_grow(self):
        s = self.s
        s.targets.append(name="second", range=9e3, depth=50.0, strength_db=10.0)
        self.assertEqual(len(s.targets), 2)
        self.assertEqual(s.targets[-1].name, "second")
        self.assertEqual([t.name for t in s.targets][1], "second")
        with self.assertRaises(IndexError):
            s.targets[2]
        with self.assertRaises(AttributeError):
            s.targets.depth = 3.0
        self.assertEqual(s.transmitter.source_level_db, s.transmitters[0].source_level_db)

    def test_copies_are_their_own(self):
        other = self.s.copy()
        other.seed = 99
        self.assertNotEqual(self.s.seed, 99)
        self.assertEqual(pickle.loads(pickle.dumps(other)).seed, 99)

    def test_it_draws_itself_and_escapes(self):
        self.s.title = "<script>alert(1)</script>"
        self.s.targets[0].name = "<b>x</b>"
        html = self.s._repr_html_()
        self.assertIn("<svg", html)
        self.assertNotIn("<script>", html)
        self.assertNotIn("<b>x", html)
        asdic.Scenario()._repr_html_()

    def test_set_as_on_the_command_line(self):
        s = asdic.Scenario(SCENARIOS / "deep_ocean.toml",
                           set={"target.0.range": "30km", "pulse.duration": 0.5})
        self.assertEqual(s.pulse.duration, 0.5)
        self.assertEqual(s.targets[0].range, 30e3)


class Oceans(unittest.TestCase):
    """One profile in every form that people have it in."""

    DEPTH, SPEED = np.array([0.0, 50.0, 200.0]), np.array([1520.0, 1500.0, 1505.0])

    def level(self, **ocean):
        s = asdic.Scenario(**ocean)
        found = s.arrivals(range=2000.0, depth=60.0, source_depth=30.0, frequency=1000.0,
                           arrays=True)
        return found.delay[0], found.amplitude[0], len(found)

    def test_profiles(self):
        pairs = np.column_stack([self.DEPTH, self.SPEED])
        forms = [pairs, pairs.tolist(), pd.Series(self.SPEED, self.DEPTH),
                 pd.DataFrame({"depth": self.DEPTH, "speed": self.SPEED}),
                 pd.DataFrame({"speed": self.SPEED}, index=pd.Index(self.DEPTH, name="depth")),
                 xr.DataArray(self.SPEED, dims="depth", coords={"depth": self.DEPTH}),
                 {"kind": "table", "depth": self.DEPTH, "speed": self.SPEED}]
        told = {self.level(sound_speed=form, bathymetry=200.0) for form in forms}
        self.assertEqual(len(told), 1, told)
        s = asdic.Scenario()
        s.environment.sound_speed = pairs
        self.assertEqual(s.environment.sound_speed.kind, "table")

    def test_a_number_is_one_speed(self):
        delay, amplitude, _ = self.level(sound_speed=1500.0, bathymetry=200.0)
        self.assertAlmostEqual(delay, np.hypot(2000.0, 30.0) / 1500.0, 9)
        self.assertAlmostEqual(abs(amplitude), 1.0 / np.hypot(2000.0, 30.0), 4)

    def test_temperature_and_salinity(self):
        table = pd.DataFrame({"depth": [0.0, 200.0], "temperature": [15.0, 8.0],
                              "salinity": [35.0, 35.0]})
        s = asdic.Scenario(sound_speed=table, bathymetry=200.0)
        self.assertEqual(s.environment.sound_speed.kind, "temperature-salinity")

    def test_sections_and_slopes(self):
        section = xr.DataArray([[1520.0, 1500.0], [1510.0, 1500.0]], dims=("range", "depth"),
                               coords={"range": [0.0, 5000.0], "depth": [0.0, 300.0]})
        slope = np.array([[0.0, 250.0], [5000.0, 150.0]])
        forms = [slope, pd.Series(slope[:, 1], slope[:, 0]),
                 pd.DataFrame({"range": slope[:, 0], "depth": slope[:, 1]}),
                 xr.DataArray(slope[:, 1], dims="range", coords={"range": slope[:, 0]})]
        told = {self.level(sound_speed=section, bathymetry=form) for form in forms}
        self.assertEqual(len(told), 1)

    def test_what_is_no_profile_is_refused(self):
        for wrong in (np.zeros((3, 3)), pd.DataFrame({"a": [1.0]}),
                      xr.DataArray([1.0], dims="time")):
            with self.assertRaises(asdic.InputError):
                asdic.Scenario(sound_speed=wrong)


class Faults(unittest.TestCase):
    """What is wrong is told by its name, before anything is computed."""

    def told(self, call, *words):
        with self.assertRaises(asdic.InputError) as caught:
            call()
        for word in words:
            self.assertIn(word, str(caught.exception))

    def test_arguments(self):
        s = asdic.Scenario(SCENARIOS / "modem.toml")
        self.told(lambda: s.arrivals(range="6 furlongs", depth=50), "range", "furlongs", "[m]")
        self.told(lambda: s.ping(1.5), "number", "1.5", "whole")
        self.told(lambda: s.channel(duration=[1, 2]), "duration", "list")
        self.told(lambda: asdic.process("none.h5", target_depth="deep"), "target_depth", "[m]")
        self.told(lambda: asdic.process("none.h5", mvdr="yes"), "mvdr", "True or False")
        np.testing.assert_array_equal(s.arrivals(range="0.5km", depth=20.0).delay,
                                      s.arrivals(range=500.0, depth=20.0).delay)

    def test_signals(self):
        channel = asdic.Scenario(SCENARIOS / "modem.toml").channel(duration=0.5)
        good = np.zeros(200)
        for bad, word in ((good + 0j, "complex"), (good.reshape(2, 100), "shape (2, 100)"),
                          (np.where(np.arange(200) == 7, np.nan, good), "nan at sample 7")):
            self.told(lambda: channel(bad, 48e3), "signal", word)

    def test_settings(self):
        s = asdic.Scenario(SCENARIOS / "deep_ocean.toml")

        def duration():
            s.pulse.duration = "250 sec"

        def pulse():
            s.pulse = {"kind": "cw", "freq": 3e3}

        self.told(duration, "pulse.duration", "250 sec", "[s]")
        self.told(pulse, "pulse.freq", "frequency")
        self.told(lambda: asdic.Scenario(pulse={"kind": "cw", "duration": -1.0}), "pulse.duration")
        self.told(lambda: asdic.Scenario(targets=[{"rnage": 1.0}]), "target.0.rnage", "range")
        s.platforms[0].velocity = np.array([1.0, 2.0, 0.0])
        self.assertEqual(s.platforms[0].velocity, [1.0, 2.0, 0.0])

    def test_casts_with_gaps(self):
        for gap in (None, np.nan, pd.NA):
            cast = pd.DataFrame({"depth": [0.0, 10.0, 20.0], "speed": [1500.0, gap, 1490.0]})
            self.told(lambda: asdic.Scenario(sound_speed=cast), "speed, row 1", "dropna")
        cast["temperature"] = cast["salinity"] = 10.0
        self.told(lambda: asdic.Scenario(sound_speed=cast), "speed, or temperature and salinity")

    def test_a_sea_alone(self):
        s = asdic.Scenario(sound_speed=1500.0, bathymetry=100.0)
        self.assertEqual(s.validate(), [])
        with self.assertRaises(asdic.InputError):
            asdic.Scenario(sound_speed=[[0, 1500], [10, -3]], bathymetry=100.0).validate()

    def test_a_ping_is_no_scenario(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "p.h5")
            asdic.Scenario(SCENARIOS / "modem.toml").write(file)
            self.told(lambda: asdic.Scenario(file), "an HDF5 file", "a scenario")


class Warnings(unittest.TestCase):
    """What to know before trusting a number is told wherever a number is had."""

    def test_a_ping_says_what_it_lacks(self):
        s = asdic.Scenario(SCENARIOS / "isovelocity.toml")
        self.assertEqual(s.warnings, [])
        with self.assertWarnsRegex(asdic.AsdicWarning, "lacks the paths") as told:
            ping = s.ping()
        self.assertEqual(os.path.basename(told.filename), "python_package.py")
        self.assertIn("lacks the paths", ping.attrs["warnings"][0])
        self.assertEqual(s.warnings, ping.attrs["warnings"])
        with self.assertWarnsRegex(asdic.AsdicWarning, "lacks the paths"):
            self.assertEqual([p.attrs["warnings"] for p in s.pings()], [s.warnings])
        s.propagation.max_surface_bounces = s.propagation.max_bottom_bounces = "auto"
        with warnings.catch_warnings():
            warnings.simplefilter("error", asdic.AsdicWarning)
            self.assertNotIn("warnings", s.ping().attrs)

    def test_paths_say_what_their_ocean_lacks(self):
        s = asdic.Scenario(SCENARIOS / "deep_ocean.toml")
        calls = [lambda: s.arrivals(), lambda: s.arrivals(range=25e3, depth=125.0),
                 lambda: s.arrivals(range=25e3, depth=125.0, arrays=True),
                 lambda: s.rays(count=2, range=1e3),
                 lambda: s.field(frequency=50.0, source_depth=1000.0, depths=[500.0],
                                 ranges=[1e3])]
        for call in calls:
            with self.assertWarnsRegex(asdic.AsdicWarning, "5000 m"):
                found = call()
            if not isinstance(found, asdic.Arrivals):
                self.assertIn("5000 m", found.attrs["warnings"][0])

    def test_once_a_line_of_code(self):
        s = asdic.Scenario(SCENARIOS / "deep_ocean.toml")
        text = ("import asdic\n"
                f"s = asdic.Scenario({str(SCENARIOS / 'deep_ocean.toml')!r})\n"
                "for i in range(3):\n"
                "    s.arrivals(range=25e3, depth=125.0)\n")
        done = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True,
                              env={**os.environ, "PYTHONPATH": str(BUILD / "python")})
        self.assertEqual(done.stderr.count("AsdicWarning"), 1, done.stderr)


class Names(unittest.TestCase):
    def test_what_completes(self):
        s = asdic.Scenario(SCENARIOS / "deep_ocean.toml")
        self.assertLessEqual({"ping", "arrivals", "pulse", "targets", "to_toml"}, set(dir(s)))
        for table in (s, s.platforms[0], s.targets[0], s.targets, s.environment.bottom):
            for name in dir(table):
                self.assertFalse(name.endswith("ss") and name != "roughness", name)
                getattr(table, name)
        self.assertIn("waypoints", dir(s.targets[0]))

    def test_the_stub_is_the_extension(self):
        stub = Path(asdic.__file__).with_name("_core.pyi")
        told = {}
        for node in ast.parse(stub.read_text(encoding="utf-8")).body:
            if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
                told[node.name] = {n.name for n in getattr(node, "body", [])
                                   if isinstance(n, ast.FunctionDef)} if isinstance(node, ast.ClassDef) else None
        there = {name for name in dir(asdic._core) if not name.startswith("_")}
        self.assertEqual(set(told), there)
        for name, members in told.items():
            if members is None or issubclass(getattr(asdic._core, name), Exception):
                continue
            public = {n for n in vars(getattr(asdic._core, name)) if not n.startswith("_")}
            self.assertEqual({m for m in members if not m.startswith("_")}, public - {"names"}, name)


class Paths(unittest.TestCase):
    def setUp(self):
        self.file = SCENARIOS / "deep_ocean.toml"
        self.s = asdic.Scenario(self.file)

    def test_arrivals_are_the_programs(self):
        told = json.loads(run("arrivals", self.file, "--receiver-depth", 125, "--range", 25000,
                              "--json"))["legs"][0]["arrivals"]
        found = self.s.arrivals(range=25e3, depth=125.0)
        self.assertEqual(len(found), len(told))
        for name in ("delay", "level_db", "launch_elevation_deg", "path_length", "absorption_db",
                     "upper_turns"):
            np.testing.assert_allclose(found[name], [one[name] for one in told], rtol=1e-12)
        self.assertEqual([len(r) for r in found.bounce_range], [len(o["bounces"]) for o in told])
        arrays = self.s.arrivals(range=25e3, depth=125.0, arrays=True)
        np.testing.assert_array_equal(arrays.delay, found.delay)

    def test_legs(self):
        told = json.loads(run("arrivals", self.file, "--json"))["legs"]
        found = self.s.arrivals()
        self.assertEqual(len(found), sum(len(leg["arrivals"]) for leg in told))
        self.assertEqual(set(found.leg), {0, 1})

    def test_calls_do_not_grow(self):
        def held():
            return int(Path("/proc/self/statm").read_text().split()[1]) * 4096

        for i in range(2000):
            self.s.arrivals(range=25e3 + i % 7, depth=125.0)
        before = held()
        for i in range(10000):
            self.s.arrivals(range=25e3 + i % 7, depth=125.0, arrays=i % 2 == 0)
        self.assertLess(held() - before, 2 << 20)

    def test_rays(self):
        found = self.s.rays(count=3, range=20e3)
        self.assertEqual(list(found.launch_elevation_deg), [-20.0, 0.0, 20.0])
        self.assertAlmostEqual(found.range[1][-1], 20e3, 3)

    def test_field(self):
        found = self.s.field(frequency=50.0, source_depth=1000.0, depths=[500.0, 1000.0],
                             ranges=[1e3, 2e3, 4e3])
        self.assertEqual(found.dims, ("depth", "range"))
        self.assertTrue(np.iscomplexobj(found))
        loss = -20 * np.log10(abs(found.sel(depth=1000.0, range=1e3)))
        self.assertLess(abs(float(loss) - 60.0), 6.0)
        with self.assertRaises(asdic.InputError):
            asdic.Scenario(sound_speed=1500.0, bathymetry=100.0).field(depths=[1.0], ranges=[1e3])


class Pings(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def test_the_same_bits_as_the_program(self):
        run("ping", SCENARIOS / "modem.toml", "-o", self.path("a.h5"), "-q")
        ping = asdic.Scenario(SCENARIOS / "modem.toml").ping()
        file = asdic.open(self.path("a.h5"))
        np.testing.assert_array_equal(ping.pressure, file.pressure[0])
        self.assertEqual(ping.pressure.attrs["time_start"], file.pressure.attrs["time_start"])
        np.testing.assert_allclose(ping.phone_position, file.phone_position[0])
        self.assertEqual(ping.pressure.dims, ("channel", "sample"))
        self.assertEqual(float(ping.asdic.times[0]), 0.4)

    def test_no_copy(self):
        ping = asdic.Scenario(SCENARIOS / "modem.toml").ping()
        handle = ping.encoding["asdic"]
        self.assertTrue(np.shares_memory(ping.pressure.values, handle.pressure))
        with self.assertRaises(ValueError):
            ping.pressure.values[0, 0] = 1.0
        values = ping.pressure.values
        expected = values[0, :10].copy()
        del ping, handle
        np.testing.assert_array_equal(values[0, :10], expected)  # it lives as long as the array

    def test_baseband_is_complex(self):
        s = asdic.Scenario(SCENARIOS / "modem.toml")
        s.pings.samples = "baseband"
        s.pings.sample_rate = None
        ping = s.ping()
        self.assertEqual(ping.pressure.dtype, np.complex64)
        self.assertGreater(ping.pressure.attrs["carrier_hz"], 0.0)
        s.write(self.path("b.h5"))
        file = asdic.open(self.path("b.h5"))
        np.testing.assert_array_equal(file.asdic.pressure[0], ping.pressure)
        self.assertGreater(len(asdic.process(ping).detections.columns), 5)

    def test_pings_come_in_order_and_may_be_left(self):
        s = asdic.Scenario(SCENARIOS / "modem.toml")
        s.pings.count = 6
        s.pings.interval = 2.0
        pings = list(s.pings())
        self.assertEqual([int(p.ping) for p in pings], [1, 2, 3, 4, 5, 6])
        np.testing.assert_array_equal(pings[3].pressure, s.ping(4).pressure)
        before = threading.active_count()
        for ping in s.pings():
            break
        self.assertEqual(threading.active_count(), before)
        s.pulse.duration = 900.0
        with self.assertRaises(asdic.InputError):
            list(s.pings())

    def test_processing_of_a_ping_is_that_of_its_file(self):
        s = asdic.Scenario(SCENARIOS / "isovelocity.toml")
        s.write(self.path("c.h5"))
        a, b = asdic.process(s.ping()), asdic.process(self.path("c.h5"))
        pd.testing.assert_frame_equal(a.detections, b.detections)
        self.assertIn(0, set(a.detections.target))
        pd.testing.assert_frame_equal(a.places, b.places)
        run("process", self.path("c.h5"), "-q")
        file = asdic.open(self.path("c.h5"))
        self.assertEqual(file.time.dims, ("sample",))
        truth = s.ping()
        for name in ("delay", "level_db", "doppler_factor", "arrival_bearing_deg"):
            np.testing.assert_allclose(truth[f"echoes.{name}"], file[f"echoes.{name}"], rtol=1e-12)
        bearing = a.detections.look_bearing_deg
        self.assertTrue(((bearing >= 0.0) & (bearing < 360.0) | bearing.isna()).all())
        maps = "processed/maps/array_0"
        self.assertEqual(file.asdic.group(maps).sizes["time"], file.sizes[maps.replace("/", ".") + ".time"])
        with self.assertRaises(asdic.InputError):
            asdic.process(s.ping().assign(pressure=0.0 * s.ping().pressure))
        with self.assertRaises(asdic.InputError):
            asdic.process(s.ping(), mwdr=True)

    def test_the_interpreter_is_free_meanwhile(self):
        s = asdic.Scenario(SCENARIOS / "deep_ocean.toml")
        counted, stop = [0], threading.Event()

        def count():
            while not stop.is_set():
                counted[0] += 1
                time.sleep(0.001)

        thread = threading.Thread(target=count)
        thread.start()
        try:
            began, before = time.monotonic(), counted[0]
            s.ping()
            took, ticks = time.monotonic() - began, counted[0] - before
        finally:
            stop.set()
            thread.join()
        self.assertGreater(ticks, 20 * took)


class Channels(unittest.TestCase):
    def test_the_pulse_through_it_is_the_ping(self):
        s = asdic.Scenario(SCENARIOS / "modem.toml")
        s.noise.kind = "white"
        s.noise.spectral_level_db = -100.0
        s.propagation.exact_per_phone = True
        rate, duration, peak = 48000.0, 0.1, np.sqrt(2.0) * 10 ** (180 / 20) * 1e-6
        t = np.arange(int(duration * rate) + 1) / rate
        pulse = peak * np.sin(np.pi * t / duration) ** 2 \
            * np.cos(2 * np.pi * (9000.0 * t + 0.5 * 4000.0 / duration * t ** 2))
        ping = s.ping().pressure
        for channel in (s.channel(held=True), s.channel("transmitter", 0, held=True)):
            heard = channel(pulse, rate, start=0.4, samples=ping.sizes["sample"])
            off = ((heard.values - ping.values) ** 2).sum() / (ping.values ** 2).sum()
            self.assertLess(10 * np.log10(off), -60.0)
        self.assertEqual(heard.dims, ("phone", "time"))
        paths = s.channel(duration=1.0).paths
        self.assertEqual(paths.delay.dims, ("phone", "path", "time"))
        self.assertEqual(float(paths.time[-1]), 1.0)
        bearing = paths.arrival_bearing_deg.values[np.isfinite(paths.arrival_bearing_deg)]
        self.assertTrue(bearing.size and ((bearing >= 0.0) & (bearing <= 360.0)).all())
        s.platforms[1].position = [-700.0, 200.0, 0.0]  # to the west
        west = s.channel(duration=0.1).paths.arrival_bearing_deg
        self.assertAlmostEqual(float(west[0, 0, 0]), 285.9, delta=3.0)
        with self.assertRaises(asdic.InputError):
            s.channel(duration=0.1)(np.zeros(48000), rate)
        with self.assertRaises(asdic.InputError):
            s.channel("nobody")

    def test_a_wide_band_is_warned_of(self):
        s = asdic.Scenario(SCENARIOS / "modem.toml")
        s.environment.absorption.kind = "thorp"
        s.platforms[1].position = [9000.0, 0.0, 0.0]
        noise = np.random.default_rng(1).standard_normal(4800)
        with self.assertWarnsRegex(UserWarning, "absorption"):
            s.channel()(noise, 96000.0)


class Studies(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.output = os.path.join(self.folder.name, "study.h5")
        self.s = asdic.Scenario(SCENARIOS / "isovelocity.toml")
        self.vary = {"target.0.strength_db": {"law": "uniform", "low": 0.0, "high": 20.0}}

    def test_own_measures_and_going_on(self):
        calls = []

        def strength(ping):
            calls.append(1)
            return ping.asdic.scenario.targets[0].strength_db

        def loudest(ping):
            return 20 * np.log10(float(abs(ping.pressure).max()) / 1e-6)

        def make(count):
            return asdic.study(self.s, self.output, realisations=count, vary=self.vary,
                               measures={"strength": asdic.Measure(strength, unit="dB",
                                                                   samples=False),
                                         "loudest_db": loudest})

        first = make(8)
        np.testing.assert_array_equal(first.table.strength, first.table.strength_db)
        self.assertTrue(np.isfinite(first.table.loudest_db).all())
        self.assertEqual(len(calls), 8)
        second = make(20)
        self.assertEqual(len(calls), 20)
        np.testing.assert_array_equal(second.table.strength[:8], first.table.strength)
        self.assertEqual(asdic.read_study(self.output).units["strength"], "dB")

    def test_what_a_measure_raises_ends_it(self):
        def bad(ping):
            raise KeyError("mine")

        with self.assertRaisesRegex(KeyError, "mine"):
            asdic.study(self.s, self.output, realisations=4, vary=self.vary, measures={"x": bad})

    def test_a_rule_of_ones_own_stops_it(self):
        asked = []

        def enough(rows):
            asked.append((len(rows), "pd" in rows, "detected" in rows))
            return len(rows) >= 200 and rows.detected.mean() > 0.0

        known = SCENARIOS / "studies/known_answer.toml"
        found = asdic.study(known, self.output, set={"study.realisations": 500}, until=enough)
        self.assertEqual(asked, [(100, False, True), (200, False, True)])
        self.assertEqual(len(found.table), 200)
        words = asdic.study(known, self.output, set={"study.realisations": 500}, fresh=True,
                            until=["pd: rows >= 150", enough])
        self.assertEqual(len(words.table), 200)

        def bad(rows):
            raise KeyError("mine")

        with self.assertRaisesRegex(KeyError, "mine"):
            asdic.study(known, self.output, set={"study.realisations": 500}, fresh=True, until=bad)
        with self.assertRaisesRegex(asdic.InputError, "until: found"):
            asdic.study(known, self.output, fresh=True, until="pf=0.1")

    def test_formulae_of_rows_and_of_functions(self):
        def strength(ping):
            return ping.asdic.scenario.targets[0].strength_db

        def make(own):
            return asdic.study(self.s, self.output, realisations=8, vary=self.vary,
                               measures={"strength": asdic.Measure(strength, samples=False)},
                               summary={"own": own})

        first = make({"twice": "2 * strength"})
        np.testing.assert_array_equal(first.table.twice, 2.0 * first.table.strength_db)
        again = make({"far": {"value": "strength > 10", "event": True}})
        np.testing.assert_array_equal(again.table.far, again.table.strength_db > 10.0)
        self.assertNotIn("twice", asdic.read_study(self.output).table)

    def test_a_file_of_a_study(self):
        found = asdic.study(SCENARIOS / "studies/known_answer.toml", self.output,
                            set={"study.realisations": 50})
        self.assertEqual(len(found.table), 50)
        self.assertEqual(found.question, "pd")
        self.assertTrue(found.low <= found.value <= found.high)
        self.assertEqual(asdic.open(self.output).attrs["filetype"], "asdic study")


class Bellhop(unittest.TestCase):
    def test_cases_and_results(self):
        case = asdic.bellhop.read(SCENARIOS / "bellhop/munk.env")
        self.assertTrue(any("beams" in note for note in case.notes))
        case.set("run.receivers.range", [1e4, 2e4]).set("run.receivers.depth", [1000.0])
        field = case.run()
        direct = case.field()
        np.testing.assert_allclose(np.squeeze(field.pressure.values), np.squeeze(direct.values),
                                   rtol=1e-6)
        with tempfile.TemporaryDirectory() as folder:
            run("bellhop", SCENARIOS / "bellhop/munk", "-o", os.path.join(folder, "munk"), "-q")
            shade = asdic.open(os.path.join(folder, "munk.shd"))
            self.assertEqual(shade.pressure.shape[-2:], (101, 200))
            with self.assertRaises(asdic.InputError):
                asdic.open(os.path.join(folder, "nothing.shd"))

    def test_a_case_over_a_map(self):
        env = ("'slope'\n300\n1\n'CVW'\n2 0 300\n0 1500 /\n300 1500 /\n'A~' 0\n300 1700 0 1.8 0.4 /\n"
               "1\n-1 /\n1\n0.5 /\n1\n30 /\n2\n20 60 /\n3\n0.5 1.5 /\n4\n0 270 /\n'IG   2'\n"
               "0\n-40 40 /\n9\n0 360 /\n0 5 5 400\n")
        with tempfile.TemporaryDirectory() as folder:
            root, maps = os.path.join(folder, "slope"), os.path.join(folder, "maps.nc")
            with open(root + ".env", "w") as file:
                file.write(env)
            with open(root + ".bty", "w") as file:
                file.write("'R'\n2\n-9 9\n3\n-9 9 /\n100 300\n110 280\n120 260\n")
            with self.assertRaisesRegex(asdic.InputError, "slope.env: .*maps"):
                asdic.bellhop.read(root + ".env")
            case = asdic.bellhop.read(root, maps=maps)
            self.assertTrue(any("first of 4" in note for note in case.notes))
            one = case.run()
            run("bellhop", root, "-q")
            around = asdic.open(root + ".shd")
            self.assertEqual(around.pressure.dims[:4], ("source_x", "source_y", "azimuth", "source_depth"))
            np.testing.assert_allclose(around.azimuth.values, [0, 90, 180, 270])
            first = np.abs(around.pressure.values[0, 0, 0])
            np.testing.assert_allclose(np.abs(one.pressure.values), first, rtol=1e-2)


class Interrupts(unittest.TestCase):
    def test_control_c(self):
        text = ("import sys, asdic\n"
                f"s = asdic.Scenario({str(SCENARIOS / 'deep_ocean.toml')!r})\n"
                "s.pings.count = 100000\n"
                "print('begun', flush=True)\n"
                "try:\n"
                "    asdic._core.Pinger(s._core, None).run(lambda p: None, None)\n"
                "except KeyboardInterrupt:\n"
                "    print('interrupted', flush=True)\n"
                "print(len(s.arrivals()), 'after', flush=True)\n")
        process = subprocess.Popen([sys.executable, "-c", text], stdout=subprocess.PIPE, text=True,
                                   env={**os.environ, "PYTHONPATH": str(BUILD / "python")})
        self.assertEqual(process.stdout.readline(), "begun\n")
        time.sleep(1.0)
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=60)
        self.assertIn("interrupted", out)
        self.assertIn("after", out)
        self.assertEqual(process.returncode, 0)

    def test_a_progress_that_raises_ends_the_work(self):
        s = asdic.Scenario(SCENARIOS / "deep_ocean.toml")

        def no(done, total):
            raise RuntimeError("enough")

        with self.assertRaisesRegex(RuntimeError, "enough"):
            s.validate(no)
        self.assertEqual(s.validate(lambda done, total: None), s.validate())


if __name__ == "__main__":
    unittest.main(verbosity=1)

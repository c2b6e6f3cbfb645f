#!/usr/bin/env python3
"""The Python package: oceans of real places, profiles, waveforms, times, and what a notebook shows."""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

BUILD = Path(os.environ["ASDIC_BUILD"])
ROOT = Path(__file__).resolve().parents[3]
SCENARIOS, BELLHOP = ROOT / "scenarios", ROOT / "tests/data/bellhop"
CLIMATOLOGY = Path("/usr/share/ferret-vis/data/etopo5.cdf")
if not list((BUILD / "python/asdic").glob("_core*.so")):
    print("the Python package was not built here")
    sys.exit(77)
sys.path.insert(0, str(BUILD / "python"))

import numpy as np  # noqa: E402

import asdic  # noqa: E402


@unittest.skipUnless(CLIMATOLOGY.exists(), "no ferret-datasets here")
class Oceans(unittest.TestCase):
    def test_a_place_is_the_scenario_that_the_program_wrote(self):
        found = asdic.ocean(30.5, -60.5)
        written = (SCENARIOS / "ocean_sargasso.toml").read_text()
        self.assertEqual(found.to_toml(), written)
        self.assertEqual(found.environment.bottom.depth, 5395.0)
        self.assertIn("5000 m", " ".join(found.notes))
        self.assertIn("levitus", " ".join(found.origins))
        self.assertEqual(found.copy().notes, found.notes)

    def test_a_track_has_a_sea_floor_and_takes_a_sonar(self):
        found = asdic.ocean(31.5, -65.5, bearing_deg=45.0, range=60e3,
                            pulse={"kind": "cw", "frequency": 3000.0, "duration": 0.1})
        shape = found.environment.bottom.shape
        self.assertEqual(shape.range[-1], 60e3)
        self.assertLess(shape.depth[-1], shape.depth[0])
        self.assertEqual(found.pulse.frequency, 3000.0)

    def test_wrong_places(self):
        for place, says in (((47.0, 8.0), "land, 1225 m high"), ((95.0, 0.0), "latitude"),
                            ((30.0, -60.0, 13), "month")):
            with self.assertRaisesRegex(asdic.InputError, says):
                asdic.ocean(*place)
        with self.assertRaisesRegex(asdic.InputError, "go together"):
            asdic.ocean(30.0, -60.0, range=1e3)


class MissingData(unittest.TestCase):
    def test_the_message_says_how_to_get_them(self):
        with tempfile.TemporaryDirectory() as folder:
            with self.assertRaisesRegex(asdic.InputError, "ferret-datasets") as raised:
                asdic.ocean(30.0, -60.0, data=folder)
            self.assertTrue(raised.exception.file.endswith("etopo5.cdf"))


class NamedFiles(unittest.TestCase):
    """Of texts, which need no data of others: a grid as ESRI has it, and a CTD cast."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        (self.folder / "grid.asc").write_text("ncols 4\nnrows 4\nxllcenter -61\nyllcenter 30\ncellsize 0.5\n"
                                              + "-900 -800 -700 -600\n" * 4)
        (self.folder / "cast.csv").write_text("# latitude = 30.6\n# longitude = -60.5\n# date = 2024-02-03\n"
                                              "Depth [m];Temperature [degC];Salinity\n0;20,5;36\n500;12,0;35,5\n")
        self.files = dict(bathymetry=self.folder / "grid.asc", temperature=[str(self.folder / "cast.csv")], data="none")

    def test_a_place(self):
        found = asdic.ocean(30.5, -60.5, date="2024-02-03", **self.files)
        self.assertEqual(found.environment.bottom.depth, 800.0)
        self.assertEqual(list(found.environment.sound_speed.temperature), [20.5, 12.0])
        origin = found.environment.origin
        self.assertEqual((origin.latitude_deg, origin.longitude_deg, origin.time), (30.5, -60.5, "2024-02-03"))
        self.assertEqual([source["name"] for source in found.to_dict()["environment"]["origin"]["source"]],
                         ["cast.csv", "grid.asc"])
        self.assertIn("11 km away", " ".join(found.notes))

    def test_a_track_by_its_grid(self):
        import datetime
        found = asdic.ocean(30.5, -60.9, date=datetime.date(2024, 2, 3), bearing_deg=90.0, range=100e3, **self.files)
        self.assertGreater(len(found.environment.bottom.shape.range), 2)
        self.assertLess(found.environment.bottom.shape.depth[-1], 720.0)
        with self.assertRaisesRegex(asdic.InputError, "grid.asc: elevation: found 10 N") as raised:
            asdic.ocean(10.0, -60.0, **self.files)
        self.assertEqual(raised.exception.file, str(self.folder / "grid.asc"))

    def test_an_area(self):
        file = self.folder / "place.toml"
        found = asdic.ocean(30.6, -60.4, area=60e3, output=file, **self.files)
        self.assertEqual(found.to_toml(), file.read_text())
        self.assertTrue((self.folder / "place.nc").exists())
        with self.assertRaisesRegex(asdic.InputError, "output"):
            asdic.ocean(30.6, -60.4, area=60e3, **self.files)


class Profiles(unittest.TestCase):
    def test_a_table_is_linear_between_its_samples(self):
        s = asdic.Scenario(sound_speed=[[0.0, 1520.0], [100.0, 1500.0]], bathymetry=100.0)
        c = s.sound_speed([0.0, 25.0, 100.0])
        np.testing.assert_allclose(c, [1520.0, 1515.0, 1500.0])
        self.assertEqual((c.dims, c.attrs["units"]), (("depth",), "m/s"))
        self.assertEqual(float(asdic.Scenario(SCENARIOS / "isovelocity.toml").sound_speed(7.0)), 1500.0)

    def test_a_section_by_range(self):
        import xarray as xr
        section = xr.DataArray([[1520.0, 1500.0], [1500.0, 1480.0]], dims=("range", "depth"),
                               coords={"range": [0.0, 1000.0], "depth": [0.0, 100.0]})
        s = asdic.Scenario(sound_speed=section, bathymetry=100.0)
        np.testing.assert_allclose(s.sound_speed([0.0, 100.0], range=500.0), [1510.0, 1490.0])
        with self.assertRaises(asdic.InputError):
            s.sound_speed([float("nan")])


class Waveforms(unittest.TestCase):
    def test_a_sweep_is_its_formula(self):
        s = asdic.Scenario(SCENARIOS / "modem.toml")
        w = s.waveform(48e3)
        t, T = w.time.values, 0.1
        exact = np.sin(np.pi * t / T) ** 2 * np.exp(2j * np.pi * (9e3 * t + 0.5 * 4e3 / T * t ** 2))
        np.testing.assert_allclose(w, exact, atol=1e-9)
        self.assertAlmostEqual(w.attrs["energy_s"], 3 / 8 * T, 6)
        self.assertEqual(w.attrs["source_level_db"], 180.0)
        np.testing.assert_array_equal(s.waveform(transmitter="transmitter"), s.waveform())
        with self.assertRaises(asdic.InputError):
            s.waveform(-1.0)
        with self.assertRaises(asdic.InputError):
            s.waveform(transmitter=1)

    def test_it_is_the_replica_of_the_file(self):
        s = asdic.Scenario(SCENARIOS / "modem.toml")
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "a.h5")
            s.write(file)
            np.testing.assert_allclose(s.waveform().real, asdic.open(file).replica, atol=1e-6)


class Shown(unittest.TestCase):
    def test_samples_have_times(self):
        s = asdic.Scenario(SCENARIOS / "modem.toml")
        ping = s.ping()
        self.assertEqual((ping.time.dims, ping.time.attrs["units"]), (("sample",), "s"))
        np.testing.assert_array_equal(ping.time, ping.asdic.times)
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "a.h5")
            s.write(file)
            for load in (True, False):
                np.testing.assert_array_equal(asdic.open(file, load=load).time, ping.time)
        part = ping.swap_dims(sample="time").sel(time=slice(0.5, 0.6))
        self.assertAlmostEqual(float(part.time[0]), 0.5, 4)
        self.assertIn("from the target", ping["echoes.arrival_bearing_deg"].attrs["long_name"])

    def test_help_is_shown_as_lines(self):
        s = asdic.Scenario(SCENARIOS / "modem.toml")
        self.assertEqual(repr(s.pulse.help("duration")), str(s.pulse.help("duration")))
        self.assertIn("\n", s.pulse.help())

    def test_a_run_is_drawn_with_source_and_receivers(self):
        drawn = asdic.bellhop.read(BELLHOP / "munk-coherent-hat/case.env")._repr_html_()
        for word in (">source<", ">receivers<", "80 km"):
            self.assertIn(word, drawn)

    def test_a_scenario_as_a_dictionary(self):
        told = asdic.Scenario(SCENARIOS / "modem.toml").to_dict()
        self.assertEqual(told["pulse"]["duration"], 0.1)
        self.assertEqual(len(told["platform"]), 2)

    def test_tables_tell_their_units(self):
        s = asdic.Scenario(SCENARIOS / "deep_ocean.toml")
        self.assertEqual(s.arrivals(range=25e3, depth=125.0).attrs["units"]["delay"], "s")
        case = asdic.bellhop.read(BELLHOP / "munk-coherent-hat/case.env")
        self.assertEqual(case.copy().notes, case.notes)

    def test_threads_may_be_the_first_to_need_xarray(self):
        """As the measures of a study are: the accessor is registered once."""
        text = ("import threading, warnings, asdic.datasets as d\n"
                "warnings.simplefilter('error')\n"
                "failed = []\n"
                "threading.excepthook = lambda told: failed.append(told)\n"
                "all_ = [threading.Thread(target=d.xarray) for _ in range(8)]\n"
                "[t.start() for t in all_], [t.join() for t in all_]\n"
                "assert not failed, failed[0].exc_value\n")
        done = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True,
                              env={**os.environ, "PYTHONPATH": str(BUILD.resolve() / "python")})
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_study_needs_no_file(self):
        found = asdic.study(SCENARIOS / "studies/known_answer.toml", set={"study.realisations": 20})
        self.assertEqual(len(found.table), 20)
        self.assertEqual(found.table.columns[0], "range")
        self.assertNotIn("legs_searched", found.table)  # the file's bookkeeping


if __name__ == "__main__":
    unittest.main(verbosity=1)

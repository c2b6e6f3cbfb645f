#!/usr/bin/env python3
"""One name, one quantity: what a table of Python and a table of a file call alike is alike."""
import os
import subprocess
import sys
import tempfile
import unittest
import warnings
from pathlib import Path

BUILD, PROGRAM = Path(os.environ["ASDIC_BUILD"]), os.environ["ASDIC"]
SCENARIOS = Path(__file__).resolve().parents[3] / "scenarios"
if not list((BUILD / "python/asdic").glob("_core*.so")):
    print("the Python package was not built here")
    sys.exit(77)
sys.path.insert(0, str(BUILD / "python"))

import h5py  # noqa: E402
import numpy as np  # noqa: E402

import asdic  # noqa: E402

warnings.simplefilter("ignore", asdic.AsdicWarning)


class EqualNames(unittest.TestCase):
    """Both sides are the same doubles, in files some as float32: 1e-9 and 1e-6 leave room for rounding."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def run_asdic(self, *words):
        subprocess.run([PROGRAM, *map(str, words)], check=True, capture_output=True)

    def compare(self, table, group, names, rows=slice(None)):
        """Compares the columns that both have. names: at least these are among them."""
        both = [name for name in group if name in table and isinstance(group[name], h5py.Dataset)
                and group[name].shape[:1] == group["delay" if "delay" in group else "time"].shape]
        self.assertLessEqual(set(names), set(both))
        for name in both:
            mine, theirs = np.asarray(table[name]), group[name][()][rows]
            self.assertEqual(mine.shape, theirs.shape, name)
            exact = 1e-9 if theirs.dtype.itemsize > 4 or theirs.dtype.kind == "i" else 1e-6
            np.testing.assert_allclose(mine, theirs, rtol=exact, atol=1e-9, err_msg=name)

    def test_detections_places_and_tracks(self):
        """A place's bearing is not the beam's: over 25 km a line array hears a target at another angle."""
        file = self.folder / "p.h5"
        asdic.Scenario(SCENARIOS / "two_targets.toml").write(file)
        found = asdic.process(file, target_depth=125.0)
        self.run_asdic("process", file, "-q", "--no-maps", "--target-depth", "125m")
        with h5py.File(file) as f:
            group = f["processed/detections"]
            self.assertGreater(len(found.detections), 2)
            self.compare(found.detections, group,
                         ("ping", "time", "look_bearing_deg", "look_elevation_deg", "level_db"))
            for side, prefix in ((0, ""), (1, "mirror_")):
                one = found.places[found.places.groupby("detection").cumcount() == side]
                self.assertTrue(len(one))
                for name in ("depth", "range", "bearing_deg", "range_rate"):
                    np.testing.assert_allclose(one[name], group[prefix + name][()][one.detection], rtol=1e-9,
                                               err_msg=prefix + name)
            away = (group["bearing_deg"][()] - group["look_bearing_deg"][()] + 180.0) % 360.0 - 180.0
            self.assertGreater(np.nanmax(abs(away)), 1.0)  # so that the two names could be told apart
            tracks = f["processed/tracks"]
            self.assertEqual(len(found.tracks), len(set(tracks["track"][()])))
            for number, track in enumerate(found.tracks, 1):
                self.compare(track["points"], tracks, ("ping", "time", "position_sigma"),
                             tracks["track"][()] == number)

    def test_echoes_and_legs(self):
        file = self.folder / "p.h5"
        s = asdic.Scenario(SCENARIOS / "deep_ocean.toml", set={"environment.origin": {"latitude_deg": 30.0,
                                                                                    "longitude_deg": -60.0}})
        s.write(file)
        ping, legs = s.ping(), s.arrivals()
        with h5py.File(file) as f:
            mine = f["echoes/ping"][()] == 1
            self.compare(ping.asdic.table("echoes"), f["echoes"],
                         ("delay", "level_db", "arrival_bearing_deg"), mine)
            group = f["arrivals"]
            mine = (group["ping"][()] == 1) & (group["channel"][()] == -1) & (group["leg"][()] < 2)
            self.compare(legs, group,
                         ("leg", "bearing_deg", "range", "delay", "launch_elevation_deg", "latitude"), mine)

    def test_arrivals(self):
        s = asdic.Scenario(sound_speed=1500.0, bathymetry=200.0, bottom={"kind": "rigid"},
                           run={"task": "arrivals", "frequency": 1000.0, "source": {"depth": 30.0},
                                "receivers": {"depth": [60.0], "range": [2000.0]}})
        s.save(self.folder / "s.toml")
        self.run_asdic("arrivals", self.folder / "s.toml", "-o", self.folder / "a.h5")
        found = s.arrivals(range=2000.0, depth=60.0)
        real, imaginary = np.real(found.amplitude), np.imag(found.amplitude)
        found = found.assign(amplitude_real=real, amplitude_imag=imaginary)
        del found["amplitude"]  # in these files a magnitude without absorption, as BELLHOP's .arr has it
        with h5py.File(self.folder / "a.h5") as f:
            self.compare(found, f["arrivals"], ("delay", "launch_elevation_deg", "arrival_elevation_deg",
                                                "amplitude_real", "amplitude_imag", "surface_bounces"))


if __name__ == "__main__":
    unittest.main(verbosity=1)

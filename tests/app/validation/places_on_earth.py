"""Latitudes and longitudes in results: scatterers, detections, tracks, areas, tables and pictures.

Truth: distance and bearing of the geodesic from the map's [0, 0], by Vincenty's formula, against the x and y beside them or the cells' range and bearing."""
import csv
import os
import subprocess
import sys
import tempfile
import unittest
import warnings
from pathlib import Path

import h5py
import numpy as np

ASDIC = os.environ.get("ASDIC", "build/release/bin/asdic")
BUILD = Path(os.environ.get("ASDIC_BUILD", "build/release"))
sys.path.insert(0, str(BUILD / "python"))
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
from geodesic import inverse  # noqa: E402

ORIGIN = (-52.0, 179.98)  # the map crosses the date line

LIKE = dict(target_depth=100.0, max_speed=7.0, start=1.6, stop=2.4)  # what is processed, as below

SEA = """title = "a place"
[environment.sound_speed]
kind = "isovelocity"
speed = 1500.0
[environment.bottom]
kind = "fluid"
[environment.bottom.shape]
range = [-20000.0, 20000.0]
depth = [250.0, 350.0]
"""
PLACE = """[environment.origin]
latitude_deg = -52.0
longitude_deg = 179.98
"""
SONAR = """[platform]
position = [500.0, -200.0, 60.0]
velocity = [5.0, 1.0, 0.0]
[transmitter]
source_level_db = 215.0
taper = "omnidirectional"
[pulse]
kind = "cw"
frequency = 1000.0
duration = 0.1
[array]
kind = "horizontal"
phones = 4
spacing = 0.75
[[target]]
name = "wreck"
position = [1500.0, 900.0, 100.0]
strength_db = 40.0
[reverberation]
azimuths = 12
[propagation]
max_surface_bounces = 1
max_bottom_bounces = 1
[pings]
count = 3
interval = 10.0
recording_duration = 3.0
sample_rate = 4000.0
"""


def on_map(lat, lon):
    """East and north of the origin [m]"""
    distance, bearing = inverse(*ORIGIN, np.asarray(lat), np.asarray(lon))
    return distance * np.sin(bearing), distance * np.cos(bearing)


class Places(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.temporary.name)
        for name, text in (("here", SEA + PLACE + SONAR), ("nowhere", SEA + SONAR)):
            (cls.folder / f"{name}.toml").write_text(text)
            cls.asdic(f"ping {name}.toml -q -o {name}.h5")
            cls.asdic(f"process {name}.h5 --target-depth 100m --max-speed 7 --from 1.6 --until 2.4 --no-maps --csv {name}")
            cls.asdic(f"area {name}.toml --depth 100 --bearings 24 --ranges 20 --reach 2km -o {name}_area.h5")

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    @classmethod
    def asdic(cls, words):
        done = subprocess.run([ASDIC, *words.split()], cwd=cls.folder, capture_output=True, text=True)
        if done.returncode != 0:
            raise AssertionError(words + "\n" + done.stdout + done.stderr)
        return done.stdout

    def assert_places(self, lat, lon, east, north):
        """Where one is known the other is, to a millimetre; and somewhere one is."""
        lat, lon, east, north = (np.asarray(a, float) for a in (lat, lon, east, north))
        known = np.isfinite(east) & np.isfinite(north)
        self.assertTrue(known.any())
        np.testing.assert_array_equal(np.isfinite(lat), known)
        np.testing.assert_array_equal(np.isfinite(lon), known)
        x, y = on_map(lat[known], lon[known])
        np.testing.assert_allclose(x, east[known], atol=1e-3)
        np.testing.assert_allclose(y, north[known], atol=1e-3)

    def assert_columns(self, group, prefix="", x="x", y="y"):
        self.assert_places(*(group[prefix + name][()] for name in ("latitude", "longitude", x, y)))
        for name, units in (("latitude", "degrees_north"), ("longitude", "degrees_east")):
            said = group[prefix + name].attrs
            self.assertEqual((said["units"].decode(), said["standard_name"].decode()), (units, name))

    def test_detections_and_tracks(self):
        with h5py.File(self.folder / "here.h5") as f:
            self.assert_columns(f["processed/detections"])
            self.assert_columns(f["processed/detections"], "mirror_")
            self.assert_columns(f["processed/tracks"])
        for table in ("detections", "tracks"):
            with open(self.folder / f"here/here_{table}.csv") as file:
                rows = list(csv.DictReader(file))
            self.assertGreater(len(rows), 0)
            values = [[float(row[name] or "nan") for row in rows] for name in ("latitude", "longitude", "x", "y")]
            # ten digits of 179.98 degrees are 1e-7 of one, 11 mm
            lat, lon, east, north = map(np.array, values)
            x, y = on_map(lat, lon)
            np.testing.assert_allclose(x, east, atol=0.02)
            np.testing.assert_allclose(y, north, atol=0.02)

    def test_scatterers(self):
        with h5py.File(self.folder / "here.h5") as f:
            patches = {name: f["patches"][name][()] for name in ("latitude", "longitude", "range", "bearing_deg", "ping")}
            ping, own = f["ping"][()], f["platform_position"][()]
        self.assertGreater(patches["range"].size, 100)
        self.assertTrue(np.isfinite(patches["latitude"]).all())
        # Cells hang on points of a lattice: those of one ping have at most four of them (the nearest anchor tells), each
        # within a sixteenth of the field's radius per axis of the sonar.
        for k, number in enumerate(ping):
            of = patches["ping"] == number
            east, north = on_map(patches["latitude"][of], patches["longitude"][of])
            bearing, span = np.radians(patches["bearing_deg"][of]), patches["range"][of]
            anchor = np.stack([east - span * np.sin(bearing), north - span * np.cos(bearing)], axis=1)
            different = np.unique(np.round(anchor, 1), axis=0)
            self.assertLessEqual(len(different), 4)
            self.assertLess(np.abs(anchor - own[k, :2]).max(), 0.5 * span.max())

    def test_area(self):
        with h5py.File(self.folder / "here_area.h5") as f:
            middle = f["array_position"][:2]
            bearing, span = np.radians(f["bearing"][()]), f["range"][()]
            self.assert_places(f["latitude"][()], f["longitude"][()], middle[0] + np.outer(np.sin(bearing), span),
                               middle[1] + np.outer(np.cos(bearing), span))
            for end in ("array_position", "source_position"):
                x, y = on_map(f[end].attrs["latitude_deg"], f[end].attrs["longitude_deg"])
                np.testing.assert_allclose([x, y], f[end][:2], atol=1e-3)
            for kind in ("platforms", "transmitters", "arrays", "targets"):
                track = f[kind]["track"][()]
                self.assert_places(f[kind]["latitude"][()], f[kind]["longitude"][()], track[..., 0], track[..., 1])

    def test_xarray_draws_an_area_on_its_coordinates(self):
        import matplotlib
        matplotlib.use("Agg")
        import xarray

        warnings.simplefilter("ignore", RuntimeWarning)
        with xarray.open_dataset(self.folder / "here_area.h5") as area:
            for name in ("signal_excess_db", "certainty", "bottom_depth"):
                self.assertLessEqual({"latitude", "longitude"}, set(area[name].coords))
            self.assertEqual(area.latitude.dims, ("bearing", "range"))
            mesh = area.signal_excess_db.isel(depth=0).plot(x="longitude", y="latitude")
            self.assertEqual(mesh.get_array().size, 24 * 20)
            self.assertIn("longitude of a cell's middle", mesh.axes.get_xlabel())

    def test_python(self):
        import asdic

        warnings.simplefilter("ignore", asdic.AsdicWarning)
        area = asdic.open(self.folder / "here_area.h5")
        self.assertIn("latitude", area.signal_excess_db.coords)
        self.assertEqual(area.asdic.group("targets").latitude.dims, ("thing", "instant"))
        for found in (asdic.process(self.folder / "here.h5", **LIKE),
                      asdic.process(asdic.Scenario(self.folder / "here.toml").ping(), **LIKE)):
            self.assert_places(*(found.places[name] for name in ("latitude", "longitude", "east", "north")))
            self.assertEqual(found.places.attrs["units"]["latitude"], "degrees")
            for track in found.tracks:
                points = track["points"]
                self.assert_places(*(points[name] for name in ("latitude", "longitude", "east", "north")))
        nowhere = asdic.process(self.folder / "nowhere.h5", **LIKE)
        self.assertNotIn("latitude", nowhere.places)
        self.assertGreater(len(nowhere.tracks), 0)
        self.assertNotIn("latitude", nowhere.tracks[0]["points"])

    def test_nothing_is_said_where_the_origin_is_unknown(self):
        for name in ("nowhere.h5", "nowhere_area.h5"):
            with h5py.File(self.folder / name) as f:
                names = []
                f.visit(names.append)
                self.assertEqual([n for n in names if "latitude" in n or "longitude" in n], [])
                self.assertNotIn("latitude_deg", f.attrs)
        with open(self.folder / "nowhere/nowhere_detections.csv") as file:
            self.assertNotIn("latitude", file.readline())
        with h5py.File(self.folder / "nowhere_area.h5") as f:
            self.assertNotIn("coordinates", f["signal_excess_db"].attrs)


if __name__ == "__main__":
    unittest.main()

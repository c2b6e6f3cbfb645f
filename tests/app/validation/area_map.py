#!/usr/bin/env python3
"""Over a map: what lies beyond it is marked in files and pictures, and results know where on the Earth they are.

Truth: the map's own edges in degrees; distance and bearing of the geodesic from [0, 0], by Vincenty's formula; the depth
that the map was made of."""
import json
import os
import subprocess
import sys
import tempfile
import unittest
import warnings
from pathlib import Path

import numpy as np

try:
    import netCDF4
except ImportError:
    print("no netCDF4 for Python here")
    sys.exit(77)
import h5py

ASDIC = os.environ.get("ASDIC", "build/release/bin/asdic")
ROOT = Path(__file__).resolve().parents[3]
BUILD = Path(os.environ.get("ASDIC_BUILD", ROOT / "build/release"))
sys.path[:0] = [str(BUILD / "python"), str(ROOT / "tests" / "support")]
from geodesic import inverse  # noqa: E402

ORIGIN = (60.0, -20.0)  # far north: meridians converge
STEP = 1 / 120
LAT = np.arange(59.9, 60.1001, STEP)
LON = np.arange(-20.2, -19.7999, STEP)
WATER_LON = np.arange(-20.2, -19.8499, 0.05)    # ends 2.8 km before the sea floor, in the east
EAST = LON[-1] + 0.5 * STEP                     # grids hold the middles of their cells


def depth_of(lat, lon):
    return 400.0 + 2000.0 * (lat - 59.9) + 500.0 * (lon + 20.2)


SEA = """title = "a map"
[environment.origin]
latitude_deg = 60.0
longitude_deg = -20.0
[environment.area.bathymetry]
file = "floor.nc"
[environment.bottom]
kind = "fluid"
[environment.transect]
origin = [2000.0, 1000.0]
bearing_deg = 70.0
"""
LEVEL = "[environment.sound_speed]\nkind = \"isovelocity\"\nspeed = 1500.0\n"
WATER = "[environment.area.sound_speed]\nfile = \"water.nc\"\n"
RUN = """[run]
frequency = 200.0
off_transect_deg = 20.0
[run.receivers]
depth = [50.0, 100.0]
range = { first = 500.0, last = 12e3, count = 24 }
"""
SONAR = """[platform]
position = [6000.0, -3000.0, 30.0]
velocity = [5.0, 0.0, 0.0]
[transmitter]
source_level_db = 215.0
taper = "omnidirectional"
[pulse]
kind = "cw"
frequency = 1000.0
duration = 0.1
[array]
kind = "horizontal"
phones = 2
spacing = 0.75
[[target]]
name = "wreck"
position = [8000.0, 1000.0, 100.0]
strength_db = 20.0
[noise]
kind = "wenz"
[reverberation]
enabled = false
[propagation]
max_surface_bounces = 1
max_bottom_bounces = 1
[pings]
recording_duration = 12.0
sample_rate = 4000.0
"""


def on_map(lat, lon):
    """East and north of the origin [m]"""
    distance, bearing = inverse(*ORIGIN, np.asarray(lat, float), np.asarray(lon, float))
    return np.stack([distance * np.sin(bearing), distance * np.cos(bearing)], axis=-1)


def along(place, bearing_deg, ranges):
    b = np.radians(bearing_deg)
    return np.asarray(place) + np.asarray(ranges, float)[..., None] * [np.sin(b), np.cos(b)]


def outside(lat, lon, lons=LON, half=0.5 * STEP):
    return (lat < LAT[0] - 0.5 * STEP) | (lat > LAT[-1] + 0.5 * STEP) | (lon < lons[0] - half) | (lon > lons[-1] + half)


def write_map(path, name, axes, values, **attributes):
    """Over (lat, lon), or over levels of these."""
    with netCDF4.Dataset(path, "w") as f:
        for axis, (places, more) in axes.items():
            f.createDimension(axis, len(places))
            v = f.createVariable(axis, "f8", (axis,))
            v.setncatts(more)
            v[:] = places
        v = f.createVariable(name, "f4", tuple(axes))
        v.setncatts(attributes)
        v[:] = values


class OverAMap(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.folder = Path(cls.temporary.name)
        degrees = [{"units": "degrees_north", "standard_name": "latitude"},
                   {"units": "degrees_east", "standard_name": "longitude"}]
        write_map(cls.folder / "floor.nc", "depth_of_floor", {"lat": (LAT, degrees[0]), "lon": (LON, degrees[1])},
                  depth_of(LAT[:, None], LON[None, :]), units="m", standard_name="sea_floor_depth_below_mean_sea_level")
        levels = np.array([0.0, 100.0, 1500.0])
        write_map(cls.folder / "water.nc", "sound_speed",
                  {"depth": (levels, {"units": "m", "positive": "down"}), "lat": (LAT[::6], degrees[0]),
                   "lon": (WATER_LON, degrees[1])},
                  1500.0 + 0.01 * levels[:, None, None] + 20.0 * (WATER_LON + 20.0) + 0.0 * LAT[::6, None], units="m s-1",
                  standard_name="speed_of_sound_in_sea_water")
        for name, text in (("sonar", SEA + LEVEL + RUN + SONAR), ("water", SEA + WATER + SONAR),
                           ("run", SEA + LEVEL + RUN.replace("[run.receivers]", "[run.source]\ndepth = 40.0\n[run.receivers]"))):
            (cls.folder / f"{name}.toml").write_text(text)

    def asdic(self, words):
        done = subprocess.run([ASDIC, *words.split()], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, words + "\n" + done.stdout + done.stderr)
        return done.stdout

    def assert_places(self, lat, lon, expected):
        """To a millimetre; NaN where they are."""
        lat, lon = np.asarray(lat, float), np.asarray(lon, float)
        known = np.isfinite(expected[..., 0])
        self.assertTrue(known.any())
        np.testing.assert_array_equal(np.isfinite(lat), known)
        np.testing.assert_allclose(on_map(lat[known], lon[known]), expected[known], atol=1e-3)

    def map_end(self, place, bearing):
        """Range at which the sea floor's map ends in the east, by halving; files tell whole steps of its grid."""
        low, high = 0.0, 20e3
        lat, lon = np.meshgrid(np.linspace(59.85, 60.15, 121), np.linspace(EAST, EAST, 1), indexing="ij")
        edge = on_map(lat.ravel(), lon.ravel())     # the meridian where it ends
        for _ in range(60):
            middle = 0.5 * (low + high)
            x, y = along(place, bearing, middle)
            low, high = (middle, high) if x < np.interp(y, edge[:, 1], edge[:, 0]) else (low, middle)
        return low

    def assert_map_end(self, found, place, bearing):
        truth = self.map_end(place, bearing)
        self.assertLessEqual(found, truth)
        self.assertGreater(found, truth - 1000.0 * 111.2 * STEP)    # a step of the grid: 0.93 km or less

    def test_cells_beyond_the_map(self):
        for name in ("sonar", "water"):
            self.asdic(f"area {name}.toml --bearings 36 --ranges 40 --reach 7km --depth 100 -o {name}_area.h5 -q")
            with h5py.File(self.folder / f"{name}_area.h5") as f:
                lat, lon, ends = (f[n][()] for n in ("latitude", "longitude", "beyond_map"))
                floor = f["bottom_depth"][()]
                said = dict(f["beyond_map"].attrs)
                np.testing.assert_array_equal(said["flag_values"], [0, 1, 2, 3])
                self.assertEqual(said["flag_values"].dtype, ends.dtype)
                self.assertEqual(len(said["flag_meanings"].split()), 4)
                self.assertEqual(said["coordinates"], b"latitude longitude")
                np.testing.assert_array_equal(f["certainty"].attrs["flag_values"], [0, 1, 2, 3])
            expected = np.where(outside(lat, lon), 1, 0)
            if name == "water":
                expected[(expected == 0) & outside(lat, lon, WATER_LON, 0.025)] = 2
                self.assertTrue((expected == 2).any())
            for which in (0, 1):
                self.assertGreater((expected == which).sum(), 30)
            np.testing.assert_array_equal(ends, expected)
            inner = ~outside(lat, lon, LON, -0.5 * STEP) & (np.abs(lat - 60.0) < 0.1)
            np.testing.assert_allclose(floor[inner], depth_of(lat, lon)[inner], atol=0.01)

    def test_pictures_hatch_what_is_beyond(self):
        """And only then: the key of a picture well within the map has no such words."""
        import matplotlib
        matplotlib.use("Agg")
        from asdic import pictures

        for depth in ("near", "far"):
            reach = dict(near="2km", far="7km")[depth]
            self.asdic(f"area sonar.toml --bearings 36 --ranges 40 --reach {reach} --depth 100 -o {depth}.h5 -q")
        for what in ("signal_excess", "echo_level", "sea_floor", "sections"):
            for depth, there in (("near", False), ("far", True)):
                figure = pictures.area(self.folder / f"{depth}.h5", what=what, theme="dark" if there else "light")
                told = [t.get_text() for a in figure.axes if a.get_legend() for t in a.get_legend().get_texts()]
                self.assertEqual(any("beyond the map" in t for t in told), there, (what, told))

    def test_fields_and_arrivals_of_a_run(self):
        for name, place in (("sonar", (6000.0, -3000.0)), ("run", (2000.0, 1000.0))):
            self.asdic(f"field {name}.toml -o {name}_field.h5 -q")
            with h5py.File(self.folder / f"{name}_field.h5") as f:
                expected = along(place, 90.0, f["range"][()])
                self.assert_places(f["latitude"][()], f["longitude"][()], expected)
                self.assertEqual(f["pressure"].attrs["coordinates"], b"latitude longitude")
                self.assertAlmostEqual(f.attrs["bearing_deg"], 90.0)
                self.assert_places(f.attrs["source_latitude_deg"], f.attrs["source_longitude_deg"], np.array(place))
                self.assert_map_end(f["environment"].attrs["map_end_m"], place, 90.0)
        found = json.loads(self.asdic("arrivals run.toml --json"))["legs"]
        self.assert_places([leg["latitude"] for leg in found], [leg["longitude"] for leg in found],
                           along((2000.0, 1000.0), 90.0, [leg["range"] for leg in found]))
        self.asdic("arrivals run.toml -o run_arrivals.h5")
        with h5py.File(self.folder / "run_arrivals.h5") as f:
            self.assert_places(f["latitude"][()], f["longitude"][()], along((2000.0, 1000.0), 90.0, f["range"][()]))
        (self.folder / "scattered.toml").write_text(
            (self.folder / "run.toml").read_text().replace("depth = [50.0, 100.0]", "irregular = true\ndepth = [50.0, 70.0]")
            .replace("{ first = 500.0, last = 12e3, count = 24 }", "[3000.0, 1000.0]"))
        self.asdic("field scattered.toml -o scattered.h5 -q")
        with h5py.File(self.folder / "scattered.h5") as f:
            self.assert_places(f["latitude"][()], f["longitude"][()], along((2000.0, 1000.0), 90.0, [3000.0, 1000.0]))
            self.assertEqual(f["pressure"].attrs["coordinates"], b"receiver_depth receiver_range latitude longitude")

    def test_rays(self):
        for words, bearing in (("", 90.0), ("--bearing 130", 130.0)):
            asked = f"rays sonar.toml {words} --count 5 --range 4km"
            self.asdic(f"{asked} -o rays.h5 --force")
            with h5py.File(self.folder / "rays.h5") as f:
                span = f["rays/range"][()]
                self.assertTrue(np.isnan(span).any())
                lat, lon = f["rays/latitude"][()], f["rays/longitude"][()]
                self.assert_places(lat, lon, along((6000.0, -3000.0), bearing, span))
                self.assertEqual(f["rays/depth"].attrs["coordinates"], b"latitude longitude")
            for ray, row in zip(json.loads(self.asdic(asked + " --json"))["rays"], lat):
                np.testing.assert_array_equal(ray["latitude"], row[np.isfinite(row)])

    def test_ends_of_legs(self):
        self.asdic("arrivals sonar.toml -o legs.h5 --force")
        self.asdic("ping sonar.toml -o ping.h5 -q")
        for name in ("legs.h5", "ping.h5"):
            with h5py.File(self.folder / name) as f:
                table = {key: f["arrivals"][key][()] for key in ("leg", "latitude", "longitude", "delay")}
            for leg, end in ((0, [8000.0, 1000.0]), (1, [6000.0, -3000.0])):
                mine = table["leg"] == leg
                self.assertTrue(mine.any())
                # the array has moved on by the time when the echo comes, on its way to the east
                moved = 5.0 * 2.0 * 4472.0 / 1500.0 if leg == 1 else 0.0
                at = on_map(table["latitude"][mine], table["longitude"][mine])
                np.testing.assert_allclose(at, np.broadcast_to([end[0] + moved, end[1]], at.shape), atol=1.0 if moved else 1e-3)
        found = json.loads(self.asdic("arrivals sonar.toml --json"))["legs"]
        self.assert_places(found[0]["latitude"], found[0]["longitude"], np.array([8000.0, 1000.0]))
        free = json.loads(self.asdic("arrivals sonar.toml --receiver-depth 60 --range 3km --bearing 210 --json"))["legs"][0]
        self.assert_places(free["latitude"], free["longitude"], along((6000.0, -3000.0), 210.0, 3000.0))

    def test_python(self):
        import asdic

        warnings.simplefilter("ignore", asdic.AsdicWarning)
        sonar, run = (asdic.Scenario(self.folder / f"{name}.toml") for name in ("sonar", "run"))
        field = run.field()
        self.assertEqual(field.latitude.dims, ("range",))
        expected = along((2000.0, 1000.0), 90.0, field.range.values)
        self.assert_places(field.latitude, field.longitude, expected)
        whole = run.run()
        self.assert_places(whole.latitude, whole.longitude, expected)
        self.assertIn("latitude", whole.pressure.coords)
        rays = sonar.rays(count=3, range=3000.0)
        for _, ray in rays.iterrows():      # along the transect from the platform, turned as the run's
            self.assert_places(ray.latitude, ray.longitude, along((6000.0, -3000.0), 70.0, ray.range))
        legs = sonar.arrivals()
        there = legs[legs.leg == 0]
        self.assert_places(there.latitude, there.longitude, np.broadcast_to([8000.0, 1000.0], (len(there), 2)))
        self.assertEqual(legs.attrs["units"]["latitude"], "degrees")

    def test_a_scenes_map(self):
        """The depths of the map below the picture of a scenario, its degrees, and where its section leaves it."""
        import asdic
        from asdic import _core, pictures

        path = self.folder / "scene.h5"
        text = (self.folder / "sonar.toml").read_text().replace("[8000.0, 1000.0, 100.0]", "[11200.0, -3000.0, 100.0]")
        (self.folder / "edge.toml").write_text(text)
        warnings.simplefilter("ignore", asdic.AsdicWarning)
        scenario = asdic.Scenario(self.folder / "edge.toml")
        _core.write_scene(str(path), scenario._core)
        self.asdic("ping sonar.toml -o map.h5 -q")
        for name in (path, self.folder / "map.h5"):
            with h5py.File(name) as f:
                sea = f["environment"]
                x, y, depth = (sea[f"area_{n}"][()] for n in ("east", "north", "depth"))
                lon, lat = sea["area_longitude"][()], sea["area_latitude"][()]
                middle = y.size // 2, x.size // 2
                # degrees of the middle row and column: places due east and due north of the platform
                self.assert_places(lat[middle[0]], lon[middle[1]], np.array([6000.0, -3000.0]))
                self.assertTrue(np.all(np.diff(lon) > 0) and np.all(np.diff(lat) > 0))
                # where the row and the column meet the map's ends: NaN begins there
                half = 0.5 * STEP
                last = lon[np.isfinite(depth[middle[0]])].max()
                self.assertTrue(EAST - 3.0 * (lon[1] - lon[0]) < last <= EAST + 1e-9, last)
                low = lat[np.isfinite(depth[:, middle[1]])].min()
                self.assertTrue(LAT[0] - half - 1e-9 <= low < LAT[0] - half + 3.0 * (lat[1] - lat[0]), low)
                here = depth_of(lat[middle[0]], lon[middle[1]])
                self.assertAlmostEqual(depth[middle], here, delta=0.01)
        with h5py.File(path) as f:
            self.assert_map_end(f["environment"].attrs["map_end_m"], (6000.0, -3000.0), 90.0)
        for figure in (pictures.ppi(self.folder / "map.h5"), pictures.geometry(scenario)):
            told = [t.get_text() for a in figure.axes if a.get_legend() for t in a.get_legend().get_texts()]
            self.assertIn("beyond the map: its edge goes on", told)
            self.assertIn("depth of the sea floor / m", told)
            self.assertEqual(len(figure.axes[0].child_axes), 2)     # longitudes, latitudes
        self.assertTrue(any("the map ends" in t.get_text() for t in figure.axes[1].texts))


if __name__ == "__main__":
    unittest.main()

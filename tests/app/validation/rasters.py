#!/usr/bin/env python3
"""`asdic ocean` and [environment.area] read GeoTIFF and binary grids of ESRI's. The files are written by
tests/support/geotiff.py, without GDAL, of seas that are formulas; what comes out is held against these.
Without GDAL the message tells what to do, and the rest is skipped."""
import hashlib
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import tomllib
import unittest
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests/support"))
from geodesic import inverse, radii  # noqa: E402
from geotiff import binary_grid, float_grid, geotiff, sparse_geotiff  # noqa: E402

ASDIC = os.environ["ASDIC"]
HAS_GDAL = "GDAL" in subprocess.run([ASDIC, "--version"], capture_output=True, text=True, check=True).stdout
WEST, NORTH, STEP, ROWS, COLUMNS = 3.0, 51.0, 1 / 60, 60, 90
HERE = (50.504, 3.753)


def depth(lat, lon):
    """A plane in degrees: bilinear interpolation has it without an error."""
    return 400.0 + 120.0 * (lon - 3.0) - 80.0 * (lat - 50.0)


LAT = NORTH - STEP * (np.arange(ROWS) + 0.5)
LON = WEST + STEP * (np.arange(COLUMNS) + 0.5)
HEIGHT = -depth(LAT[:, None], LON[None, :])
PIXELS = dict(west=WEST, north=NORTH, dx=STEP, dy=STEP)

SONAR = """[platform]
position = [0.0, 0.0, 50.0]
[transmitter]
source_level_db = 215.0
taper = "omnidirectional"
[pulse]
kind = "cw"
frequency = 3000.0
duration = 0.1
[array]
kind = "horizontal"
phones = 2
spacing = 0.25
[reverberation]
azimuths = 12
[pings]
recording_duration = 6.0
[environment.sound_speed]
kind = "isovelocity"
speed = 1500.0
[environment.bottom]
kind = "fluid"
"""


class Folder(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        (self.folder / "water.csv").write_text("# latitude = 50.5\n# longitude = 3.75\nDepth [m];Sound speed [m/s]\n"
                                               "0;1500\n100;1490\n600;1495\n")

    def run_asdic(self, words):
        return subprocess.run([ASDIC, *words.split()], cwd=self.folder, capture_output=True, text=True)

    def asdic(self, words):
        done = self.run_asdic(words)
        self.assertEqual(done.returncode, 0, words + "\n" + done.stdout + done.stderr)
        return done.stdout + done.stderr

    def refused(self, words, *parts):
        done = self.run_asdic(words)
        self.assertNotEqual(done.returncode, 0, words)
        for part in parts:
            self.assertIn(part, done.stderr)
        return done.stderr

    def ocean(self, files, more=""):
        """→ the fragment and what was said"""
        (self.folder / "ocean.toml").unlink(missing_ok=True)
        said = self.asdic(f"ocean --latitude {HERE[0]} --longitude {HERE[1]} --sound-speed water.csv {files} {more} "
                          "--data none -o ocean.toml")
        return tomllib.loads((self.folder / "ocean.toml").read_text())["environment"], said

    def refused_ocean(self, files, *parts):
        return self.refused(f"ocean --latitude {HERE[0]} --longitude {HERE[1]} --sound-speed water.csv {files} "
                            "--data none -o ocean.toml", *parts)


class WithoutGdal(Folder):
    def test_the_message_tells_what_to_do(self):
        if HAS_GDAL:
            self.skipTest("this asdic has GDAL")
        geotiff(self.folder / "chart.tif", [HEIGHT.astype("f4")], **PIXELS)
        self.refused_ocean("--bathymetry chart.tif", "chart.tif: found a GeoTIFF", "gdal_translate -of netCDF chart.tif",
                           "built with GDAL")
        binary_grid(self.folder / "grid", HEIGHT, WEST, NORTH - STEP * ROWS, STEP)
        self.refused_ocean("--bathymetry grid", "grid: found a binary grid of ESRI's", "gdal_translate")
        (self.folder / "area.toml").write_text(SONAR + '[environment.area.bathymetry]\nfile = "chart.tif"\n')
        self.refused("validate area.toml", "chart.tif", "gdal_translate")


@unittest.skipUnless(HAS_GDAL, "this asdic is built without GDAL (Debian: libgdal-dev)")
class Ocean(Folder):
    def assert_depth(self, file, accuracy=0.0501, named=""):
        # A fragment has a digit behind the point; the next pixels are 1.3 and 2 m away.
        ocean, said = self.ocean(f"--bathymetry {file}{named}")
        self.assertAlmostEqual(ocean["bottom"]["depth"], depth(*self.point()), delta=accuracy)
        return ocean, said

    @staticmethod
    def point():
        """The depth of a place is its nearest pixel's."""
        return LAT[np.argmin(abs(LAT - HERE[0]))], LON[np.argmin(abs(LON - HERE[1]))]

    def test_depths_are_the_pixels(self):
        south = NORTH - STEP * ROWS
        geotiff(self.folder / "area.tif", [HEIGHT.astype("f4")], **PIXELS, units=["m"], described=["elevation"])
        geotiff(self.folder / "point.tif", [HEIGHT.astype("f4")], LON[0], LAT[0], STEP, STEP, point=True, units=["m"],
                described=["elevation"])
        geotiff(self.folder / "packed.tif", [np.rint((HEIGHT + 500.0) / 0.05).astype("i2")], **PIXELS, scale=0.05,
                offset=-500.0, units=["m"], nodata=-32768, described=["elevation"])
        geotiff(self.folder / "km.tif", [(-HEIGHT / 1000.0).astype("f8")], **PIXELS, units=["km"], described=["depth"])
        float_grid(self.folder / "esri.flt", HEIGHT, WEST, south, STEP)
        binary_grid(self.folder / "esri", HEIGHT, WEST, south, STEP)
        for file in ("area.tif", "point.tif", "km.tif", "esri.flt", "esri", "esri/hdr.adf"):
            with self.subTest(file):
                self.assert_depth(file)
        self.assert_depth("packed.tif", 0.0501 + 0.0251)
        # where nothing says so, a height in m is assumed, and told
        _, said = self.assert_depth("esri.flt")
        self.assertIn("esri.flt: band 1 has no units: taken as m", said)
        self.assertIn("esri.flt: band 1 does not say what it is: taken as a height", said)
        self.assertNotIn("taken as", self.assert_depth("area.tif")[1])

    def test_a_track_is_bilinear_between_pixels(self):
        geotiff(self.folder / "chart.tif", [HEIGHT.astype("f8")], **PIXELS, units=["m"], described=["elevation"])
        ocean, _ = self.ocean("--bathymetry chart.tif", "--bearing 90 --range 20km --step 1km")
        shape = ocean["bottom"]["shape"]
        # The geodesic from HERE to the east, by Newton's steps; a fragment has a digit behind the point.
        span = np.array(shape["range"])
        lat, lon = np.full_like(span, HERE[0]), HERE[1] + np.degrees((span + 1e-3) / radii(HERE[0])[1])
        for _ in range(5):
            way, bearing = inverse(*HERE, lat, lon)
            north, east = radii(lat)
            lat = lat - np.degrees(way * np.cos(bearing) / north)
            lon = lon + np.degrees((span - way * np.sin(bearing)) / east)
        np.testing.assert_allclose(shape["depth"], depth(lat, lon), atol=0.0501)

    def test_bands_by_number_and_by_description(self):
        other = np.full_like(HEIGHT, -7.0).astype("f4")
        geotiff(self.folder / "two.tif", [other, HEIGHT.astype("f4")], **PIXELS, described=["quality", "my heights"],
                units=["1", "m"])
        self.assert_depth("two.tif", named=":2")
        self.refused_ocean("--bathymetry two.tif", "two.tif: found 2 bands, expected FILE:BAND with a number from 1 to 2: "
                                                   "1 quality, 2 my heights")
        self.refused_ocean("--bathymetry two.tif:3", 'no band "3"', "from 1 to 2")
        self.refused_ocean("--bathymetry two.tif:1", 'two.tif: band 1: found units of "1"', "bathymetry in one of m, km")
        geotiff(self.folder / "named.tif", [other, HEIGHT.astype("f4")], **PIXELS, described=["quality", "Elevation"])
        ocean, _ = self.assert_depth("named.tif")
        self.assert_depth("named.tif", named=":elevation")
        source = next(s for s in ocean["origin"]["source"] if s["quantity"] == "bathymetry")
        self.assertEqual((source["name"], source["variable"]), ("named.tif", "band 2"))
        self.assertEqual(source["digest"], "sha256:" + hashlib.sha256((self.folder / "named.tif").read_bytes()).hexdigest())

    def test_what_is_missing(self):
        holes = HEIGHT.astype("f4")
        holes[np.hypot(LAT[:, None] - HERE[0], LON[None, :] - HERE[1]) < 0.1] = -99999.0
        geotiff(self.folder / "hole.tif", [holes], **PIXELS, nodata=-99999.0)
        self.refused_ocean("--bathymetry hole.tif", "hole.tif: band 1: 50.504 N 3.753 E: found a hole")
        geotiff(self.folder / "masked.tif", [np.rint(-HEIGHT).astype("u2")], **PIXELS, described=["depth"],
                alpha=np.where(holes == -99999.0, 0, 65535).astype("u2"))
        self.refused_ocean("--bathymetry masked.tif", "masked.tif: band 1: 50.504 N 3.753 E: found a hole")

    def test_other_quantities(self):
        geotiff(self.folder / "chart.tif", [HEIGHT.astype("f4")], **PIXELS, units=["m"], described=["elevation"])
        kinds = np.where(LON[None, :] + 0 * LAT[:, None] < 3.5, 1, 2).astype("u1")
        geotiff(self.folder / "kinds.tif", [kinds], **PIXELS, colours="palette")
        (self.folder / "kinds.tif.aux.xml").write_text(
            '<PAMDataset><PAMRasterBand band="1"><CategoryNames><Category/><Category>rock and boulders</Category>'
            "<Category>mud</Category></CategoryNames></PAMRasterBand></PAMDataset>")
        geotiff(self.folder / "wind.tif", [np.full_like(HEIGHT, 20.0).astype("f4")], **PIXELS, units=["knots"])
        ocean, _ = self.ocean("--bathymetry chart.tif --sediment kinds.tif --wind wind.tif")
        self.assertAlmostEqual(ocean["wind_speed"], 20.0 * 1852 / 3600, delta=0.06)
        self.assertEqual((ocean["bottom"]["kind"], ocean["bottom"]["grain_size"]), ("grain-size", 6.5))  # mud
        components = [np.full_like(HEIGHT, v).astype("f4") for v in (3.0, 4.0)]
        geotiff(self.folder / "uv.tif", components, **PIXELS, units=["m/s", "m/s"], described=["u10", "v10"])
        self.assertAlmostEqual(self.ocean("--bathymetry chart.tif --wind uv.tif")[0]["wind_speed"], 5.0, delta=0.05)
        geotiff(self.folder / "u.tif", components[:1], **PIXELS, units=["m/s"], described=["u10"])
        self.refused_ocean("--bathymetry chart.tif --wind u.tif", "u.tif")  # half of a wind is none
        self.refused(f"ocean --latitude {HERE[0]} --longitude {HERE[1]} --sound-speed kinds.tif --bathymetry chart.tif "
                     "--data none -o ocean.toml", "kinds.tif")

    def test_refusals_say_what_was_found_and_what_to_do(self):
        z = HEIGHT.astype("f4")
        make = lambda name, **how: geotiff(self.folder / name, [z], **{**PIXELS, **how})
        make("turned.tif", turned_deg=12.0)
        self.refused_ocean("--bathymetry turned.tif", "turned.tif: band 1: found a rotated raster", "12 degrees", "gdalwarp")
        make("nowhere.tif", placed=False)
        self.refused_ocean("--bathymetry nowhere.tif", "nowhere.tif: band 1: found pixels without places", "gdalwarp")
        make("system.tif", referenced=False)
        self.refused_ocean("--bathymetry system.tif", "no coordinate reference system", "-a_srs EPSG:4326")
        make("utm.tif", west=480e3, north=5.61e6, dx=500.0, dy=500.0, epsg=32631, projected=True)
        self.refused_ocean("--bathymetry utm.tif", "utm.tif: band 1: found a grid on projected x and y: WGS 84 / UTM zone 31N",
                           "longitude and latitude", "gdalwarp -t_srs EPSG:4326")
        make("paris.tif", epsg=4807)
        self.refused_ocean("--bathymetry paris.tif", "the meridian of Paris", "Greenwich")
        geotiff(self.folder / "map.tif", [np.zeros((9, 9), "u1")] * 3, **PIXELS, colours="rgb")
        self.refused_ocean("--bathymetry map.tif", "map.tif: found a picture", "numbers")
        geotiff(self.folder / "palette.tif", [np.zeros((9, 9), "u1")], **PIXELS, colours="palette")
        self.refused_ocean("--bathymetry palette.tif", "palette.tif: band 1: found colours of a palette")
        wild = z.copy()
        wild[np.hypot(LAT[:, None] - HERE[0], LON[None, :] - HERE[1]) < 0.1] = -3.4e38  # which the file does not tell
        geotiff(self.folder / "wild.tif", [wild], **PIXELS)
        self.refused_ocean("--bathymetry wild.tif", "wild.tif: band 1: 50.504 N 3.753 E: found a depth of", "which value stands for none")
        (self.folder / "cut.tif").write_bytes((self.folder / "turned.tif").read_bytes()[:500])
        self.refused_ocean("--bathymetry cut.tif", "cut.tif: found a file that cannot be opened", "a GeoTIFF that GDAL can read")
        make("feet.tif", units=["ft"])
        self.refused_ocean("--bathymetry feet.tif", 'feet.tif: band 1: found units of "ft"')

    def test_another_datum_is_told(self):
        geotiff(self.folder / "old.tif", [HEIGHT.astype("f4")], **PIXELS, epsg=4230, units=["m"])
        _, said = self.ocean("--bathymetry old.tif")
        self.assertRegex(said, r"old.tif is in ED50: its places were taken as those of WGS 84, 1[0-9]{2} m off")

    def test_a_raster_of_the_globes_size_is_opened_and_not_loaded(self):
        side = 60_000  # 14 GB as float32
        z = np.full((512, 512), -321.0)
        sparse_geotiff(self.folder / "big.tif", side, 0.0, 60.0, 1 / 3600,
                       (round((60.0 - HERE[0]) * 3600), round(HERE[1] * 3600)), z)
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
        ocean, _ = self.ocean("--bathymetry big.tif")
        self.assertEqual(ocean["bottom"]["depth"], 321.0)
        used = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
        self.assertTrue(used == before or used < 400_000, f"{used} kB")

    def test_python(self):
        build = Path(os.environ["ASDIC_BUILD"]) / "python"
        if not (build / "asdic").is_dir():
            self.skipTest("no Python package here")
        sys.path.insert(0, str(build))
        import asdic

        geotiff(self.folder / "chart.tif", [HEIGHT.astype("f4")], **PIXELS, units=["m"], described=["elevation"])
        found = asdic.ocean(*HERE, bathymetry=[str(self.folder / "chart.tif")],
                            sound_speed=[str(self.folder / "water.csv")], data="none")
        self.assertAlmostEqual(found.environment.bottom.depth, depth(*self.point()), delta=0.0501)


@unittest.skipUnless(HAS_GDAL, "this asdic is built without GDAL (Debian: libgdal-dev)")
class Area(Folder):
    def bottom(self, text):
        """Depths of the sea floor that sound meets: their bearing [rad], range [m]."""
        (self.folder / "area.toml").write_text(SONAR + text)
        self.asdic("area area.toml --depth 40 --bearings 24 --ranges 10 --reach 4km --force -o area.h5")
        with h5py.File(self.folder / "area.h5") as f:
            return f["bottom_depth"][()], np.radians(f["bearing"][()])[:, None], f["range"][()][None, :]

    def test_a_map_in_degrees(self):
        geotiff(self.folder / "chart.tif", [HEIGHT.astype("f4")], **PIXELS, units=["m"], described=["elevation"])
        found, bearing, span = self.bottom('[environment.origin]\nlatitude_deg = 50.5\nlongitude_deg = 3.75\n'
                                           '[environment.area.bathymetry]\nfile = "chart.tif"\n')
        # On the plane tangent to the ellipsoid; over 4 km meridians turn by 0.05 %, 2 m of way, 3 mm of depth.
        north, east = radii(50.5)
        lat = 50.5 + np.degrees(span * np.cos(bearing) / north)
        lon = 3.75 + np.degrees(span * np.sin(bearing) / east)
        np.testing.assert_allclose(found, depth(lat, lon), atol=0.02)

    def utm(self, name, west=495e3, north=5000.0, rows=100, columns=100, step=100.0, **how):
        """A plane in easting and northing: 200 m at [500000, 0], 0.01 deeper a metre east, 0.02 north."""
        x = west + step * (np.arange(columns) + 0.5)
        y = north - step * (np.arange(rows) + 0.5)
        z = -(200.0 + 0.01 * (x[None, :] - 500e3) + 0.02 * y[:, None])
        geotiff(self.folder / name, [z.astype("f4")], west, north, step, step, projected=True,
                **{"epsg": 32631, "units": ["m"], "described": ["elevation"], **how})

    MAP = '[environment.area]\neasting = 500000.0\nnorthing = 0.0\n[environment.area.bathymetry]\nfile = "utm.tif"\n'

    def test_a_projected_map(self):
        self.utm("utm.tif")
        found, bearing, span = self.bottom(self.MAP)
        np.testing.assert_allclose(found, 200.0 + span * (0.01 * np.sin(bearing) + 0.02 * np.cos(bearing)), atol=0.01)
        # with its origin told, at the equator on the zone's middle meridian, too; but not elsewhere
        origin = "[environment.origin]\nlatitude_deg = 0.0\nlongitude_deg = 3.0\n"
        (self.folder / "place.toml").write_text(SONAR + self.MAP + origin)
        self.assertIn("results have no latitudes and longitudes", self.asdic("validate place.toml"))
        (self.folder / "place.toml").write_text(SONAR + self.MAP + origin.replace("3.0", "3.1"))
        self.refused("validate place.toml", "area.bathymetry", "[0, 0] in two places 11.1", "0 N 3.1 E",
                     "utm.tif: band 1, WGS 84 / UTM zone 31N")

    def test_maps_of_two_projections_are_refused(self):
        self.utm("utm.tif")
        kinds = '[environment.area.seabed]\nfile = "kinds.tif"\n[[environment.area.seabed.class]]\nnumber = 1\nkind = "rigid"\n'
        for epsg, name in ((32632, "WGS 84 / UTM zone 32N"), (25831, "ETRS89 / UTM zone 31N")):
            geotiff(self.folder / "kinds.tif", [np.ones((100, 100), "u1")], 495e3, 5000.0, 100.0, 100.0, epsg=epsg,
                    projected=True)
            (self.folder / "place.toml").write_text(SONAR + self.MAP + kinds)
            self.refused("validate place.toml", "area.seabed", f"kinds.tif: band 1 in {name}",
                         "utm.tif: band 1 in WGS 84 / UTM zone 31N", "one projection")
        geotiff(self.folder / "kinds.tif", [np.ones((100, 100), "u1")], 495e3, 5000.0, 100.0, 100.0, epsg=32631,
                projected=True)
        self.asdic("validate place.toml")

    def test_maps_in_degrees_and_in_a_projection_that_part_are_refused(self):
        # At 60 N, 6 E zone 31 is turned by 3 sin 60 = 2.6 degrees. Its easting and northing there, by Snyder's series
        # (U.S.G.S. Professional Paper 1395, ch. 8): 667 286 m, 6 655 206 m, to a metre.
        self.utm("utm.tif", west=657e3, north=6.665e6, rows=200, columns=200)
        geotiff(self.folder / "kinds.tif", [np.ones((60, 60), "u1")], 5.5, 60.5, STEP, STEP)
        (self.folder / "place.toml").write_text(
            SONAR + "[environment.origin]\nlatitude_deg = 60.0\nlongitude_deg = 6.0\n" +
            self.MAP.replace("500000.0", "667286.0").replace("northing = 0.0", "northing = 6655206.0") +
            '[environment.area.seabed]\nfile = "kinds.tif"\n[[environment.area.seabed.class]]\nnumber = 1\nkind = "rigid"\n')
        self.refused("validate place.toml", "area.seabed", "maps in degrees and one in WGS 84 / UTM zone 31N",
                     "all in degrees or all in one projection")

    def test_a_volume_is_no_raster(self):
        geotiff(self.folder / "chart.tif", [HEIGHT.astype("f4")], **PIXELS, units=["m"], described=["elevation"])
        geotiff(self.folder / "speed.tif", [0 * HEIGHT.astype("f4") + 1500], **PIXELS, units=["m/s"])
        (self.folder / "place.toml").write_text(
            SONAR.replace('[environment.sound_speed]\nkind = "isovelocity"\nspeed = 1500.0\n', "") +
            '[environment.origin]\nlatitude_deg = 50.5\nlongitude_deg = 3.75\n[environment.area.bathymetry]\n'
            'file = "chart.tif"\n[environment.area.sound_speed]\nfile = "speed.tif"\nvariable = "1"\n')
        self.refused("validate place.toml", "area.sound_speed", "a variable over depth and map")


if __name__ == "__main__":
    if not shutil.which(ASDIC):
        sys.exit(f"no {ASDIC}")
    found = unittest.main(exit=False).result
    if not HAS_GDAL and found.wasSuccessful():
        print("skipped but for the message: this asdic is built without GDAL (Debian: libgdal-dev)")
        sys.exit(77)
    sys.exit(0 if found.wasSuccessful() else 1)

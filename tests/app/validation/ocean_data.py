#!/usr/bin/env python3
"""`asdic ocean` reads data as their makers ship them. The files are synthetic, in each maker's layout,
of a sea whose depth, temperatures and winds are formulas; what comes out is held against these."""
import hashlib
import os
import re
import subprocess
import sys
import tempfile
import tomllib
import unittest
from pathlib import Path

import numpy as np

try:
    import netCDF4
except ImportError:
    print("no netCDF4 for Python here")
    sys.exit(77)
import h5py

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
from geodesic import inverse, radii  # noqa: E402

ASDIC = os.environ["ASDIC"]


# The sea of the test: a cone on a plain, whose summit is a grid point; water by month.
SUMMIT = (31.0 + 0.5 / 240.0, -60.0 + 0.5 / 240.0)  # 15 arcseconds, cells' middles, as GEBCO's
PLAIN, TOP, SLOPE = 4000.0, 1000.0, 0.2


def distance(lat, lon, lat0, lon0):
    return inverse(lat0, lon0, lat, lon)[0]


def floor(lat, lon):
    return np.minimum(PLAIN, TOP + SLOPE * distance(lat, lon, *SUMMIT))


def temperature(depth, month):
    """A seasonal layer over a cold deep sea [degC]."""
    return 3.0 + 15.0 * np.exp(-depth / 700.0) + 4.0 * np.cos(2 * np.pi * (month - 8.0) / 12.0) * np.exp(-depth / 60.0)


def salinity(depth):
    return 35.0 + 1.5 * np.exp(-depth / 800.0)


def variable(f, name, kind, dims, values, fill=None, **attributes):
    v = f.createVariable(name, kind, dims, fill_value=fill)
    v.set_auto_maskandscale(False)
    for key, value in attributes.items():
        v.setncattr(key, value)
    if values is not None:
        v[:] = values
    return v


def woa(path, letter, depths, month, bounds, lats=(30.5, 31.5), lons=(-60.5, -59.5)):
    """World Ocean Atlas: float axes, time in months since 1955, a climatology."""
    with netCDF4.Dataset(path, "w", format="NETCDF4_CLASSIC") as f:
        for name, size in (("lat", len(lats)), ("lon", len(lons)), ("depth", len(depths)), ("time", 1), ("nbounds", 2)):
            f.createDimension(name, size)
        variable(f, "lat", "f4", ("lat",), lats, standard_name="latitude", units="degrees_north", axis="Y")
        variable(f, "lon", "f4", ("lon",), lons, standard_name="longitude", units="degrees_east", axis="X")
        variable(f, "depth", "f4", ("depth",), depths, standard_name="depth", positive="down", units="meters", axis="Z")
        at = bounds[0] + 0.5 * ((bounds[1] - bounds[0]) % 12 or 12) + 12 * 33
        variable(f, "time", "f4", ("time",), [at], standard_name="time", axis="T",
                 units="months since 1955-01-01 00:00:00", climatology="climatology_bounds")
        variable(f, "climatology_bounds", "f4", ("time", "nbounds"), [bounds])
        z = np.asarray(depths)
        column = temperature(z, month) if letter == "t" else salinity(z)
        values = np.broadcast_to(column[None, :, None, None], (1, len(depths), len(lats), len(lons)))
        name, standard, units = (("t_an", "sea_water_temperature", "degrees_celsius") if letter == "t" else
                                 ("s_an", "sea_water_practical_salinity", "1"))
        variable(f, name, "f4", ("time", "depth", "lat", "lon"), values.astype("f4"), np.float32(9.96921e36),
                 standard_name=standard, units=units, cell_methods="time: mean within years time: mean over years")
        variable(f, letter + "_mn", "f4", ("time", "depth", "lat", "lon"), None, np.float32(9.96921e36),
                 standard_name=standard, units=units)


def gebco(path, south, north, west, east, height=lambda lat, lon: -floor(lat, lon), step=1 / 240.0):
    """GEBCO: int16 elevations on the middles of cells of 15 arcseconds."""
    lat = south + step * (np.arange(round((north - south) / step)) + 0.5)
    lon = west + step * (np.arange(round((east - west) / step)) + 0.5)
    with netCDF4.Dataset(path, "w") as f:
        f.createDimension("lat", lat.size)
        f.createDimension("lon", lon.size)
        variable(f, "lat", "f8", ("lat",), lat, standard_name="latitude", units="degrees_north", axis="Y")
        variable(f, "lon", "f8", ("lon",), lon, standard_name="longitude", units="degrees_east", axis="X")
        values = np.rint(height(lat[:, None], lon[None, :]))
        variable(f, "elevation", "i2", ("lat", "lon"), np.broadcast_to(values, (lat.size, lon.size)).astype("i2"),
                 standard_name="height_above_mean_sea_level", units="m",
                 long_name="Elevation relative to sea level")


def hycom(path, hours, since="2000-01-01 00:00:00", land=False, south=30.0, west=299.0):
    """HYCOM: packed shorts, a fill value, hours since 2000, longitudes 0..360; warmer by 0.05 K an hour."""
    lat, lon = south + np.arange(0.0, 2.01, 0.08), west + np.arange(0.0, 2.01, 0.08)
    depth = np.array([0, 10, 50, 100, 500, 1000, 2000, 4000, 5000.0])
    with netCDF4.Dataset(path, "w", format="NETCDF3_64BIT_OFFSET") as f:
        for name, size in (("time", len(hours)), ("depth", depth.size), ("lat", lat.size), ("lon", lon.size)):
            f.createDimension(name, size)
        variable(f, "time", "f8", ("time",), hours, units=f"hours since {since}", calendar="gregorian", axis="T")
        variable(f, "depth", "f8", ("depth",), depth, units="m", positive="down", axis="Z")
        variable(f, "lat", "f8", ("lat",), lat, units="degrees_north", axis="Y")
        variable(f, "lon", "f8", ("lon",), lon, units="degrees_east", axis="X")
        for name, standard, units, column in (
                ("water_temp", "sea_water_temperature", "degC", temperature(depth, 1.0)),
                ("salinity", "sea_water_salinity", "psu", salinity(depth))):
            values = column[None, :, None, None] + 0.05 * (name == "water_temp") * np.arange(len(hours))[:, None, None, None]
            packed = np.rint((np.broadcast_to(values, (len(hours), depth.size, lat.size, lon.size)) - 20.0) / 0.001)
            packed = np.where(depth[None, :, None, None] > 4500.0, -30000, packed)  # below its floor
            if land:
                packed = np.full_like(packed, -30000)
            variable(f, name, "i2", ("time", "depth", "lat", "lon"), packed.astype("i2"), np.int16(-30000),
                     standard_name=standard, units=units, scale_factor=0.001, add_offset=20.0,
                     missing_value=np.int16(-30000))


def cmems(path):
    """CMEMS: potential temperature, packed, with the valid range of packed values."""
    lat, lon = np.arange(30.0, 32.01, 1 / 12), np.arange(-61.0, -58.99, 1 / 12)
    depth = np.array([0.494, 97.0, 541.1, 1062.4, 2225.1, 4405.2, 5274.8])
    with netCDF4.Dataset(path, "w") as f:
        for name, size in (("time", 1), ("depth", depth.size), ("latitude", lat.size), ("longitude", lon.size)):
            f.createDimension(name, size)
        variable(f, "time", "f4", ("time",), [650_316.0], units="hours since 1950-01-01", calendar="gregorian")
        variable(f, "depth", "f4", ("depth",), depth, units="m", positive="down", standard_name="depth")
        variable(f, "latitude", "f4", ("latitude",), lat, units="degrees_north", standard_name="latitude")
        variable(f, "longitude", "f4", ("longitude",), lon, units="degrees_east", standard_name="longitude")
        shape = (1, depth.size, lat.size, lon.size)
        for name, standard, units, value, scale, offset in (
                ("thetao", "sea_water_potential_temperature", "degrees_C", 2.0, 0.000732444226741791, 21.0),
                ("so", "sea_water_salinity", "1e-3", 35.0, 0.00152592547237873, -0.00152592547237873)):
            packed = np.full(shape, round((value - offset) / scale), "i2")
            variable(f, name, "i2", ("time", "depth", "latitude", "longitude"), packed, np.int16(-32767),
                     standard_name=standard, units=units, scale_factor=scale, add_offset=offset,
                     valid_min=np.int16(-32760), valid_max=np.int16(32760))


def era5(path, first=1_086_972, south=29.0, west=297.0):
    """ERA5: eastward and northward components, hourly, longitudes 0..360, latitudes falling."""
    lat, lon = south + np.arange(4.0, -0.1, -0.25), west + np.arange(0.0, 6.1, 0.25)
    hours = first + np.arange(24)  # by default 2024-01-01 12:00 and on
    with netCDF4.Dataset(path, "w", format="NETCDF3_64BIT_OFFSET") as f:
        for name, size in (("longitude", lon.size), ("latitude", lat.size), ("time", 24)):
            f.createDimension(name, size)
        variable(f, "longitude", "f4", ("longitude",), lon, units="degrees_east", long_name="longitude")
        variable(f, "latitude", "f4", ("latitude",), lat, units="degrees_north", long_name="latitude")
        variable(f, "time", "i4", ("time",), hours, units="hours since 1900-01-01 00:00:00.0", calendar="gregorian")
        # The wind turns round in a day at 8 m/s: mean components are nothing, the mean speed is 8.
        turn = 2 * np.pi * np.arange(24) / 24
        for name, part in (("u10", np.cos(turn)), ("v10", np.sin(turn))):
            packed = np.broadcast_to(np.rint(8.0 * part / 0.001)[:, None, None], (24, lat.size, lon.size))
            variable(f, name, "i2", ("time", "latitude", "longitude"), packed.astype("i2"), np.int16(-32767),
                     units="m s**-1", scale_factor=0.001, add_offset=0.0, missing_value=np.int16(-32767),
                     long_name="10 metre U wind component")


def argo(path, profiles):
    """Argo: (latitude, longitude, days since 1950, mode) each; a bad level by its flag."""
    pressure = np.array([5.0, 100.0, 500.0, 1000.0, 2000.0], "f4")
    n = len(profiles)
    with netCDF4.Dataset(path, "w", format="NETCDF3_CLASSIC") as f:
        for name, size in (("N_PROF", n), ("N_LEVELS", 6), ("STRING8", 8)):
            f.createDimension(name, size)
        variable(f, "PLATFORM_NUMBER", "S1", ("N_PROF", "STRING8"), [list("6901234 ")] * n)
        variable(f, "CYCLE_NUMBER", "i4", ("N_PROF",), 1 + np.arange(n))
        variable(f, "DATA_MODE", "S1", ("N_PROF",), [p[3] for p in profiles])
        for name, k, units in (("JULD", 2, "days since 1950-01-01 00:00:00 UTC"), ("LATITUDE", 0, "degree_north"),
                               ("LONGITUDE", 1, "degree_east")):
            variable(f, name, "f8", ("N_PROF",), [p[k] for p in profiles], 99999.0, units=units)
        for name, column, units in (("PRES", pressure, "decibar"), ("TEMP", temperature(pressure, 1.0), "degree_Celsius"),
                                    ("PSAL", salinity(pressure), "psu")):
            for suffix, shift in (("", 0.0), ("_ADJUSTED", 0.01)):
                values = np.full((n, 6), 99999.0)
                values[:, :5] = column + shift
                flags = [list("11411 ")] * n if name == "TEMP" else [list("11111 ")] * n
                variable(f, name + suffix, "f4", ("N_PROF", "N_LEVELS"), values, np.float32(99999.0), units=units)
                variable(f, name + suffix + "_QC", "S1", ("N_PROF", "N_LEVELS"), flags)


class Folder(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.addCleanup(self._folder.cleanup)
        self.folder = Path(self._folder.name)

    def asdic(self, words, status=0):
        done = subprocess.run([ASDIC, *words.split()], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, status, words + "\n" + done.stdout + done.stderr)
        return done.stdout + done.stderr

    def ocean(self, words, place="--latitude 31 --longitude -60.5"):
        text = self.asdic(f"ocean {place} {words}")
        return tomllib.loads(text)["environment"], text

    def refused(self, words, *says, place="--latitude 31 --longitude -60.5"):
        text = self.asdic(f"ocean {place} {words}", 2)
        for part in says:
            self.assertIn(part, text)
        return text


class WorldOceanAtlas(Folder):
    def setUp(self):
        super().setUp()
        gebco(self.folder / "gebco.nc", 30.9, 31.1, -60.6, -60.4)
        shallow, deep = [0, 50, 100, 500, 1000, 1500], [0, 100, 500, 1000, 1500, 2000, 3000, 5000]
        for letter in "ts":
            woa(self.folder / f"{letter}01.nc", letter, shallow, 1.0, (0, 805))
            woa(self.folder / f"{letter}07.nc", letter, shallow, 7.0, (6, 811))
            woa(self.folder / f"{letter}00.nc", letter, deep, 4.5, (0, 816))

    files = "--bathymetry gebco.nc --temperature {} --salinity {} --data none"

    def test_a_month_is_found_by_its_time(self):
        for month in (1, 7):
            both = " --temperature ".join(("t01.nc", "t07.nc"))
            found, text = self.ocean(f"--bathymetry gebco.nc --temperature {both} --salinity s01.nc --salinity s07.nc "
                                     f"--month {month} --data none")
            water = found["sound_speed"]
            np.testing.assert_allclose(water["temperature"], temperature(np.array(water["depth"]), month), atol=2e-3)
            np.testing.assert_allclose(water["salinity"], salinity(np.array(water["depth"])), atol=2e-3)
            self.assertIn(f"one time of month {month}", text)

    def test_a_date_lies_between_months(self):
        lines = " ".join(f"--temperature t{m}.nc --salinity s{m}.nc" for m in ("01", "07"))
        self.refused(f"--bathymetry gebco.nc {lines} --date 2024-04-20 --data none",
                     "t01.nc: t_an and 1 file more: found a climatology of month 1 7", "2024-04-20")
        woa(self.folder / "t02.nc", "t", [0, 50, 100, 500, 1000, 1500], 2.0, (1, 806))
        found, text = self.ocean("--bathymetry gebco.nc --temperature t01.nc --temperature t02.nc --salinity s01.nc "
                                 "--date 2023-02-01 --data none")
        self.assertIn("the steps of months 1 and 2", text)
        # 1 February is 15.5 days after the middle of January, of 29.75 days to that of February.
        share = 15.5 / 29.75
        mixed = (1 - share) * temperature(0.0, 1.0) + share * temperature(0.0, 2.0)
        self.assertAlmostEqual(found["sound_speed"]["temperature"][0], mixed, delta=0.01)

    def test_the_year_goes_on_below_the_month(self):
        found, text = self.ocean("--bathymetry gebco.nc --temperature t00.nc --temperature t07.nc --salinity s00.nc "
                                 "--salinity s07.nc --month 7 --data none")
        water = found["sound_speed"]
        z = np.array(water["depth"])
        self.assertEqual(z[-1], 5000)
        month = np.where(z <= 1500, 7.0, 4.5)
        np.testing.assert_allclose(water["temperature"], temperature(z, month), atol=2e-3)
        self.assertIn("below 1500 m the temperature is that of t00.nc (one time of the whole year", text)

    def test_a_year_for_a_month_is_told(self):
        _, text = self.ocean("--bathymetry gebco.nc --temperature t00.nc --salinity s00.nc --month 3 --data none")
        self.assertIn("of the whole year, not of month 3", text)

    def test_a_date_beyond_the_months_is_told(self):
        # 20 July is 3.5 days past the middle of the month, 2 August 16.5.
        words = "--bathymetry gebco.nc --temperature t07.nc --salinity s07.nc --data none --date "
        self.assertIn("one time of month 7", self.ocean(words + "2024-07-20")[1])
        self.assertRegex(self.ocean(words + "2024-08-02")[1],
                         r"the nearest time, of month 7, 1[67][.0-9]* days from 2024-08-02")

    def test_salinity_of_its_own(self):
        self.refused("--bathymetry gebco.nc --temperature t00.nc --data none", "t00.nc: found no variable of salinity")
        found, _ = self.ocean("--bathymetry gebco.nc --temperature t00.nc:t_an --salinity s00.nc:s_an --data none")
        self.assertEqual(len(found["sound_speed"]["depth"]), 8)


class Gebco(Folder):
    """A cone, 1000 m to 4000 m deep with a slope of 0.2, over two tiles: its summit is in the second."""

    def setUp(self):
        super().setUp()
        gebco(self.folder / "west.nc", 30.9, 31.1, -60.6, -60.2)
        gebco(self.folder / "east.nc", 30.9, 31.1, -60.2, -59.7)
        for letter in "ts":
            woa(self.folder / f"{letter}00.nc", letter, [0, 500, 5000], 4.5, (0, 816))

    water = " --temperature t00.nc --salinity s00.nc --data none"

    def track(self, words, lat=SUMMIT[0], lon=-60.5):
        return self.ocean(words + self.water, f"--latitude {lat} --longitude {lon}")

    def test_the_summit_is_within_10_m(self):
        # A great circle due east leaves the parallel by 50 m on the way: 10 m of the slope.
        found, text = self.track("--bathymetry west.nc --bathymetry east.nc --bearing 89.88 --range 70km")
        shape = found["bottom"]["shape"]
        summit = min(shape["depth"])
        self.assertLess(abs(summit - TOP), 10.0)
        self.assertAlmostEqual(shape["range"][int(np.argmin(shape["depth"]))], distance(*SUMMIT, SUMMIT[0], -60.5), delta=300)
        self.assertNotIn("coast", text)
        self.assertNotIn("leaves", text)
        # Everywhere the floor is the cone, over the seam of the tiles too: a cell's diagonal is
        # 600 m, and bilinear of 0.2 within it is off by some metres.
        for r, z in zip(shape["range"], shape["depth"]):
            lon = -60.5 + np.degrees(r / radii(SUMMIT[0])[1])
            self.assertLess(abs(z - floor(SUMMIT[0], lon)), 25.0, r)

    def test_along_the_parallel_of_grid_points(self):
        # Northwards along a meridian of grid points every sample is one: to the rounding of int16.
        gebco(self.folder / "north.nc", 30.5, 31.5, -60.1, -59.9)
        found, _ = self.ocean("--bathymetry north.nc --bearing 0 --range 60km" + self.water,
                              f"--latitude 30.6 --longitude {SUMMIT[1]}")
        self.assertLess(abs(min(found["bottom"]["shape"]["depth"]) - TOP), 1.0)

    def test_a_step_of_ones_own_tells_what_it_misses(self):
        found, text = self.track("--bathymetry west.nc --bathymetry east.nc --bearing 89.88 --range 70km --step 5km")
        self.assertEqual(len(found["bottom"]["shape"]["range"]), 15)
        missed = re.search(r"steps of 5000 m leave out up to (\d+) m", text)
        self.assertTrue(missed and int(missed[1]) > 100, text)

    def test_a_track_leaves_the_last_tile_by_name(self):
        found, text = self.track("--bathymetry west.nc --bearing 90 --range 70km")
        self.assertIn("the transect leaves west.nc: elevation", text)
        self.assertIn("that is no coast", text)
        end = distance(SUMMIT[0], -60.2, SUMMIT[0], -60.5)
        self.assertAlmostEqual(found["bottom"]["shape"]["range"][-1], end, delta=500)

    def test_islands_and_holes(self):
        island = lambda lat, lon: np.where(distance(lat, lon, SUMMIT[0], -60.3) < 1500.0, 30.0, -2000.0)
        gebco(self.folder / "island.nc", 30.9, 31.1, -60.6, -60.2, island)
        _, text = self.track("--bathymetry island.nc --bearing 90 --range 25km")
        self.assertIn("ends at the coast", text)
        _, text = self.track("--bathymetry island.nc --bearing 90 --range 25km --step 8km")
        self.assertIn("ends at the coast", text)  # it lies between two samples
        with netCDF4.Dataset(self.folder / "island.nc", "a") as f:
            f["elevation"].missing_value = np.int16(-2000)
        self.refused("--bathymetry island.nc" + self.water, "island.nc: elevation: 31 N -60.5 E", "a hole")

    def test_finer_tiles_win(self):
        gebco(self.folder / "coarse.nc", 30.0, 32.0, -61.0, -59.0, lambda lat, lon: -3000.0 + 0 * lat * lon, 1 / 20)
        found, _ = self.ocean("--bathymetry coarse.nc --bathymetry west.nc" + self.water)
        self.assertEqual(found["bottom"]["depth"], PLAIN)
        found, _ = self.ocean("--bathymetry coarse.nc --bathymetry west.nc" + self.water,
                              "--latitude 30.5 --longitude -60.5")
        self.assertEqual(found["bottom"]["depth"], 3000)

    def test_a_grid_of_text(self):
        (self.folder / "grid.asc").write_text("ncols 3\nnrows 2\nxllcorner -61\nyllcorner 30\ncellsize 0.5\n"
                                              "NODATA_value -9999\n-100 -200 -9999\n-400 -500.5 -600\n")
        found, text = self.ocean("--bathymetry grid.asc" + self.water, "--latitude 30.3 --longitude -60.3")
        self.assertEqual(found["bottom"]["depth"], 500)  # of 500.5, to an even number
        self.refused("--bathymetry grid.asc" + self.water, "grid.asc: elevation: 30.7 N -59.8 E", "a hole",
                     place="--latitude 30.7 --longitude -59.8")


class Models(Folder):
    def setUp(self):
        super().setUp()
        gebco(self.folder / "gebco.nc", 30.9, 31.1, -60.6, -60.4)

    def test_hours_are_no_months(self):
        hycom(self.folder / "hycom.nc", 210_384 + np.arange(24))  # 2024-01-01
        both = "--bathymetry gebco.nc --temperature hycom.nc --data none"
        found, text = self.ocean(both + " --month 1")
        self.assertIn("mean of 24 steps of month 1, 2024-01-01 to 2024-01-01T23:00", text)
        self.assertAlmostEqual(found["sound_speed"]["temperature"][0], temperature(0.0, 1.0) + 0.05 * 11.5, delta=2e-3)
        self.assertEqual(found["sound_speed"]["depth"][-1], 4000)  # 5000 m is a fill value
        self.refused(both + " --month 12", "hycom.nc: water_temp: found 24 steps from 2024-01-01 to 2024-01-01T23:00",
                     "month 12")
        found, text = self.ocean(both + " --date 2024-01-01T06:30")
        self.assertAlmostEqual(found["sound_speed"]["temperature"][0], temperature(0.0, 1.0) + 0.05 * 6.5, delta=2e-3)
        self.assertIn("between 2024-01-01T06:00 and 2024-01-01T07:00", text)
        _, text = self.ocean(both + " --date 2024-01-05")
        self.assertIn("the nearest time, 2024-01-01T23:00, 3 days from 2024-01-05", text)
        self.refused(both + " --date 2025-01-01", "hycom.nc: water_temp", "2025-01-01")
        _, text = self.ocean(both)
        self.assertIn("mean of 24 steps of all times, 2024-01-01 to", text)

    def test_files_are_joined_in_time(self):
        for day in range(2):
            hycom(self.folder / f"{day}.nc", [210_384 + 24 * day])
        _, text = self.ocean("--bathymetry gebco.nc --temperature 0.nc --temperature 1.nc --date 2024-01-01T12:00 --data none")
        self.assertIn("between 2024-01-01 and 2024-01-02", text)

    def test_potential_temperature(self):
        cmems(self.folder / "cmems.nc")
        found, text = self.ocean("--bathymetry gebco.nc --temperature cmems.nc --date 2024-03-08T12:00 --data none")
        self.assertIn("thetao is potential temperature", text)
        water = dict(zip(found["sound_speed"]["depth"], found["sound_speed"]["temperature"]))
        self.assertAlmostEqual(water[0.5], 2.0, delta=1e-3)
        # UNESCO (1983): the adiabatic gradient is 0.0975 to 0.13 K/km in water of 2 degC and 35 psu.
        deepest = max(water)
        self.assertGreater(water[deepest], 2.0 + 0.08e-3 * deepest)
        self.assertLess(water[deepest], 2.0 + 0.14e-3 * deepest)

    def test_wind_of_components(self):
        hycom(self.folder / "hycom.nc", [210_396])
        era5(self.folder / "era5.nc")
        found, text = self.ocean("--bathymetry gebco.nc --temperature hycom.nc --wind era5.nc --month 1 --data none")
        self.assertEqual(found["wind_speed"], 8.0)  # of the mean components it were nothing
        self.assertIn("the wind: mean of 24 steps of month 1, 2024-01-01T12:00 to 2024-01-02T11:00", text)

    def test_wind_is_not_needed(self):
        hycom(self.folder / "hycom.nc", [210_396])
        found, text = self.ocean("--bathymetry gebco.nc --temperature hycom.nc --data none")
        self.assertNotIn("wind_speed", found)
        self.assertIn("no file of winds", text)


class Casts(Folder):
    def setUp(self):
        super().setUp()
        gebco(self.folder / "gebco.nc", 30.9, 31.1, -60.6, -60.4)

    def test_argo(self):
        argo(self.folder / "argo.nc", [(35.0, -60.5, 27028.0, "R"), (31.1, -60.6, 27030.0, "D")])
        found, text = self.ocean("--bathymetry gebco.nc --temperature argo.nc --data none")
        water = found["sound_speed"]
        # 100 dbar are 99.3 m at 31 N in UNESCO's standard ocean; Leroy and Parthiot's common oceans are
        # lighter by 10 kPa z/(z + 100 m), 0.5 m here. 500 dbar has a bad temperature.
        self.assertEqual(len(water["depth"]), 4)
        self.assertAlmostEqual(water["depth"][1], 99.3 + 0.5, delta=0.2)
        self.assertAlmostEqual(water["depth"][3], 1979.0, delta=3.0)
        self.assertAlmostEqual(water["temperature"][0], temperature(5.0, 1.0) + 0.01, delta=2e-3)  # adjusted
        self.assertIn("float 6901234, cycle 2, the nearest of 2, 15 km away", text)
        self.assertIn("1 level without good values", text)

    def test_columns_with_semicolons_and_commas(self):
        (self.folder / "cast.csv").write_text(
            "# Station 7\n# latitude = 31.05\n# longitude = -60.45\n# date: 2024-02-03\n"
            "Druck [dbar];Temperature [\u00b0C];Salinity [psu];Oxygen\n"
            "1,0;20,5;36,5;5,1\n100,0;18,25;36,2;\n100,0;18,20;36,2;\n2000,0;3,5;35,0;6\n1500,0;4,0;35,0;6\n", "utf-8")
        found, text = self.ocean("--bathymetry gebco.nc --temperature cast.csv --data none")
        water = found["sound_speed"]
        self.assertEqual(water["temperature"], [20.5, 18.25, 3.5])
        self.assertAlmostEqual(water["depth"][2], 1979.0, delta=3.0)
        self.assertIn("7 km away at 31.05 N -60.45 E, of 2024-02-03", text)

    def test_columns_of_sound_speed_with_units_in_a_second_line(self):
        (self.folder / "svp.csv").write_text("Depth,Sound Speed\nm,m/s\n0,1520\n100,1500\n1000,1490\n")
        found, text = self.ocean("--bathymetry gebco.nc --sound-speed svp.csv --data none")
        water = found["sound_speed"]
        self.assertEqual(water["kind"], "table")
        self.assertEqual(water["speed"][:3], [1520, 1500, 1490])
        self.assertGreaterEqual(water["depth"][-1], PLAIN)
        self.assertAlmostEqual(water["speed"][-1], 1490 + 0.017 * (water["depth"][-1] - 1000), delta=0.5)

    def test_sea_bird(self):
        lines = ["* Sea-Bird SBE 9 Data File:", "* NMEA Latitude = 31 03.00 N", "* NMEA Longitude = 060 27.00 W",
                 "* NMEA UTC (Time) = Feb 03 2024 12:00:00", "# nquan = 4", "# name 0 = prDM: Pressure, Digiquartz [db]",
                 "# name 1 = t090C: Temperature [ITS-90, deg C]", "# name 2 = sal00: Salinity, Practical [PSU]",
                 "# name 3 = flag: flag", "# bad_flag = -9.990e-29", "*END*"]
        lines += [f"{p:11.3f} {temperature(p, 1.0):10.4f} {salinity(p):10.4f} 0.0000e+00" for p in range(1, 3000)]
        lines[20] = lines[20].replace("0.0000e+00", "-9.990e-29")
        (self.folder / "cast.cnv").write_text("\n".join(lines) + "\n")
        found, text = self.ocean("--bathymetry gebco.nc --temperature cast.cnv --date 2024-02-03 --data none")
        water = found["sound_speed"]
        self.assertLess(len(water["depth"]), 400)
        self.assertIn("at 31.05 N -60.45 E, of 2024-02-03T12:00", text)
        self.assertIn("samples are averaged", text)
        z = np.array(water["depth"])  # pressures are within 1.5 % of depths: so are scales of the formula
        self.assertLess(np.max(np.abs(np.array(water["temperature"]) - temperature(z * 1.01, 1.0))), 0.1)

    def test_what_is_wrong_with_a_cast(self):
        cases = (("depth,temp\n1,2\n", "cast.csv: found no column of salinity among depth, temp"),
                 ("temp,sal\n1,35\n", "no column of depth or pressure"),
                 ("depth [ft],temp [degC],sal\n1,2,35\n", 'cast.csv:1: depth: found the unit "ft", expected a depth in m'),
                 ("depth [m];temp [F];sal\n1;2;35\n", 'cast.csv:1: temp: found the unit "F"'),
                 ("pressure,temp,sal\n1,2,35\n", ""),
                 ("depth,temp,sal\n1,warm,35\n", 'cast.csv:2: temp: found "warm", expected a number'),
                 ("depth,temp,sal\n1,-99,35\n", "of which none is good"),
                 ("hello\n", 'cast.csv:1: found "hello", expected a header'))
        for text, says in cases:
            with self.subTest(text=text):
                (self.folder / "cast.csv").write_text(text)
                words = "--bathymetry gebco.nc --temperature cast.csv --data none"
                if says:
                    self.refused(words, says)
                else:
                    self.ocean(words)


class Sediments(Folder):
    def setUp(self):
        super().setUp()
        hycom(self.folder / "hycom.nc", [210_396])

    def bottom(self, words, depth):
        gebco(self.folder / "gebco.nc", 30.9, 31.1, -60.6, -60.4, lambda lat, lon: -depth + 0.0 * lat * lon)
        found, text = self.ocean(f"--bathymetry gebco.nc --temperature hycom.nc --data none {words}")
        return found["bottom"], text

    def test_by_the_depth(self):
        bottom, text = self.bottom("", 50.0)  # of the North Sea, say: no abyssal clay
        self.assertEqual((bottom["kind"], bottom["grain_size"]), ("grain-size", 2.5))
        self.assertIn("of the shelf, fine sand was taken; --sediment takes a map", text)
        self.assertEqual(self.bottom("", 1000.0)[0]["grain_size"], 6)
        bottom, text = self.bottom("", 5000.0)
        self.assertEqual((bottom["kind"], bottom["speed"], bottom["density"]), ("fluid", 1520, 1400))
        self.assertIn("of the abyss, abyssal clay was taken", text)

    def map(self, values, **attributes):
        with netCDF4.Dataset(self.folder / "map.nc", "w") as f:
            f.createDimension("lat", 2)
            f.createDimension("lon", 2)
            variable(f, "lat", "f8", ("lat",), [30.95, 31.05], units="degrees_north")
            variable(f, "lon", "f8", ("lon",), [-60.55, -60.45], units="degrees_east")
            variable(f, attributes.pop("name", "sediment"), "f4", ("lat", "lon"), values, np.float32(-99), **attributes)

    def test_of_maps(self):
        self.map([[1.5, 1.5], [1.5, 1.5]], name="grain_size", units="phi")
        bottom, text = self.bottom("--sediment map.nc", 50.0)
        self.assertEqual(bottom["grain_size"], 1.5)
        self.assertIn("medium sand", text)
        self.map([[9, 9], [9, 7]], flag_values=np.array([7, 9], "f4"), flag_meanings="mud rock_and_boulders")
        self.assertEqual(self.bottom("--sediment map.nc", 50.0)[0]["grain_size"], 6.5)
        self.map([[1, 1], [1, 1]])
        self.assertEqual(self.bottom("--sediment map.nc", 50.0)[0]["speed"], 3750)  # rock, by our numbers
        self.map([[-99, -99], [-99, -99]])
        bottom, text = self.bottom("--sediment map.nc", 50.0)
        self.assertIn("says nothing of 31 N", text)
        self.map([[77, 77], [77, 77]])
        self.refused("--bathymetry gebco.nc --temperature hycom.nc --sediment map.nc --data none",
                     "map.nc: sediment: 31 N -60.5 E: found class 77")
        self.map([[1, 1], [1, 1]], flag_values=np.array([1], "f4"), flag_meanings="cheese")
        self.refused("--bathymetry gebco.nc --temperature hycom.nc --sediment map.nc --data none",
                     'map.nc: sediment: flag_meanings: found "cheese"')

    def test_along_a_track(self):
        gebco(self.folder / "gebco.nc", 30.9, 31.1, -60.6, -60.4, lambda lat, lon: -50.0 + 0.0 * lat * lon)
        self.map([[10, 12], [10, 12]])
        found, _ = self.ocean("--bathymetry gebco.nc --temperature hycom.nc --sediment map.nc --bearing 90 --range 8km "
                              "--data none", "--latitude 31 --longitude -60.54")
        sizes = [m["grain_size"] for m in found["bottom"]["shape"]["material"]]
        self.assertEqual(len(sizes), len(found["bottom"]["shape"]["range"]))
        self.assertEqual((sizes[0], sizes[-1]), (2.5, 3.5))


class Messages(Folder):
    """Each names file, variable and place."""

    def setUp(self):
        super().setUp()
        gebco(self.folder / "gebco.nc", 30.9, 31.1, -60.6, -60.4)
        hycom(self.folder / "hycom.nc", [210_396])

    def test_of_what_is_missing_or_wrong(self):
        good = {"bathymetry": "gebco.nc", "temperature": "hycom.nc"}

        def words(**other):
            return " ".join(f"--{k.replace('_', '-')} {v}" for k, v in {**good, **other}.items() if v) + " --data none"

        self.refused(words(bathymetry="none.nc"), "none.nc: found no such file", "netCDF file of bathymetry")
        self.refused(words(temperature="gebco.nc"), "gebco.nc: found no variable of temperature",
                     "or FILE:VARIABLE with one of elevation")
        self.refused(words(temperature="hycom.nc:warmth"), 'hycom.nc: found no variable "warmth"',
                     "expected one of water_temp, salinity, or FILE:VARIABLE")
        self.refused(words(), "gebco.nc: elevation: found 35 N -60.5 E, out of its grid (30.9", "holds the place",
                     place="--latitude 35 --longitude -60.5")
        self.refused(words(salinity="none.nc"), "none.nc: found no such file")
        self.refused(words(sound_speed="hycom.nc"), "sound speed: found files of it and of temperature")
        hycom(self.folder / "land.nc", [210_396], land=True)
        self.refused(words(temperature="land.nc"), "land.nc: water_temp: 31 N -60.5 E: found a hole")
        gebco(self.folder / "land.nc", 30.9, 31.1, -60.6, -60.4, lambda lat, lon: 250.0 + 0.0 * lat * lon)
        self.refused(words(bathymetry="land.nc"), "land.nc: elevation: 31 N -60.5 E: found land, 250 m high")
        for name, file, wrong, says in (("elevation", "gebco.nc", "feet", "bathymetry in one of m, km"),
                                        ("water_temp", "hycom.nc", "degF", "temperature in one of degc, k"),
                                        ("salinity", "hycom.nc", "mS/cm", "salinity in one of psu")):
            with netCDF4.Dataset(self.folder / file, "a") as f:
                before = f[name].units
                f[name].units = wrong
            self.refused(words(), f'{file}: {name}: found units of "{wrong}"', says)
            with netCDF4.Dataset(self.folder / file, "a") as f:
                f[name].units = before
        (self.folder / "a.tif").write_bytes(b"II*\0" + bytes(100))
        self.refused(words(bathymetry="a.tif"), "a.tif", "a GeoTIFF", "GDAL")
        self.refused(words() + " --date yesterday", "--date", "2024-02-29")
        self.refused(words() + " --date 2024-01-01 --month 1", "--month")
        self.refused(words() + " --step 10", "--step", "--bearing and --range")


class Provenance(Folder):
    def test_it_is_in_the_fragment_and_in_results(self):
        gebco(self.folder / "gebco.nc", 30.9, 31.1, -60.6, -60.4)
        hycom(self.folder / "hycom.nc", [210_396])
        self.asdic("ocean --latitude 31 --longitude -60.5 --bathymetry gebco.nc --temperature hycom.nc "
                   "--date 2024-01-01T12:00 --data none -o ocean.toml")
        origin = tomllib.loads((self.folder / "ocean.toml").read_text())["environment"]["origin"]
        self.assertEqual((origin["latitude_deg"], origin["longitude_deg"], origin["time"]), (31, -60.5, "2024-01-01T12:00"))
        sources = {s["quantity"]: s for s in origin["source"]}
        self.assertEqual(sorted(sources), ["bathymetry", "temperature, salinity"])
        self.assertEqual(sources["temperature, salinity"]["variable"], "water_temp, salinity")
        self.assertEqual(sources["temperature, salinity"]["time"], "one time, 2024-01-01T12:00")
        for name, file in (("bathymetry", "gebco.nc"), ("temperature, salinity", "hycom.nc")):
            self.assertEqual(sources[name]["digest"],
                             "sha256:" + hashlib.sha256((self.folder / file).read_bytes()).hexdigest())
        (self.folder / "ping.toml").write_text("""include = "ocean.toml"
title = "a place"
[platform]
position = [0.0, 0.0, 100.0]
velocity = [5.0, 0.0, 0.0]
[transmitter]
source_level_db = 210.0
taper = "omnidirectional"
[pulse]
kind = "cw"
frequency = 1000.0
duration = 0.1
[array]
kind = "horizontal"
phones = 1
spacing = 1.0
[[target]]
name = "wreck"
position = [3000.0, 4000.0, 100.0]
strength_db = 10.0
[reverberation]
enabled = false
[pings]
count = 1
recording_duration = 8.0
sample_rate = 4000.0
""")
        (self.folder / "run.toml").write_text('include = "ocean.toml"\n[run]\nfrequency = 100.0\n[run.source]\ndepth = 100.0\n'
                                              "[run.receivers]\ndepth = 50.0\nrange = 2000.0\n")
        self.asdic("ping ping.toml -o ping.h5")
        for command in ("field", "arrivals", "rays"):
            self.asdic(f"{command} run.toml -o {command}.h5")
        for name in ("ping", "field", "arrivals", "rays"):
            with h5py.File(self.folder / f"{name}.h5") as f:
                self.assertAlmostEqual(f.attrs["latitude_deg"], 31.0, 12)
                self.assertAlmostEqual(f.attrs["longitude_deg"], -60.5, 12)
                text = " ".join(x if isinstance(x, str) else x.decode() for x in f.attrs["ocean_sources"])
                self.assertIn("hycom.nc, water_temp", text)
                self.assertIn(sources["bathymetry"]["digest"], text)
        with h5py.File(self.folder / "ping.h5") as f:
            self.assertAlmostEqual(f["platform_latitude"][0], 31.0, 9)
            lat, lon = f["target_latitude"][0, 0], f["target_longitude"][0, 0]
            self.assertAlmostEqual(distance(lat, lon, 31.0, -60.5), 5000.0, delta=0.01)
            bearing = np.degrees(inverse(31.0, -60.5, lat, lon)[1])
            self.assertAlmostEqual(bearing, np.degrees(np.arctan2(3, 4)), 6)


class Area(Folder):
    def test_maps_of_a_square(self):
        gebco(self.folder / "west.nc", 30.7, 31.3, -60.6, -60.0)
        gebco(self.folder / "east.nc", 30.7, 31.3, -60.0, -59.4)
        hycom(self.folder / "hycom.nc", [210_396])
        era5(self.folder / "era5.nc")
        text = self.asdic(f"ocean --latitude {SUMMIT[0]} --longitude {SUMMIT[1]} --area 40km --bathymetry west.nc "
                          "--bathymetry east.nc --temperature hycom.nc --wind era5.nc --month 1 --data none -o place.toml")
        self.assertIn("place.nc: 40 km square", text)
        area = tomllib.loads((self.folder / "place.toml").read_text())["environment"]
        self.assertEqual(area["area"]["bathymetry"], {"file": "place.nc", "variable": "elevation", "interpolation": "bicubic"})
        self.assertEqual(area["area"]["sound_speed"]["variable"], "sound_speed")
        self.assertEqual(area["area"]["wind"]["variable"], "wind_speed")
        classes = {c["number"]: c["name"] for c in area["area"]["seabed"]["class"]}
        self.assertEqual(set(classes.values()), {"sandy mud", "abyssal clay"})
        for key in ("depth", "sound_speed", "wind_speed"):
            self.assertNotIn(key, area["bottom"] if key == "depth" else area)
        with netCDF4.Dataset(self.folder / "place.nc") as f:
            lat, lon = f["latitude"][:], f["longitude"][:]
            self.assertAlmostEqual(float(np.diff(lat).mean()), 1 / 240, 9)
            half = np.degrees(20e3 / radii(SUMMIT[0])[0])
            self.assertLess(lat[0], SUMMIT[0] - half)
            self.assertGreater(lat[-1], SUMMIT[0] + half)
            self.assertLess(np.ptp(np.diff(lon)), 1e-9)  # no gap between the tiles
            z = f["elevation"][:]
            self.assertEqual(f["elevation"].dimensions, ("latitude", "longitude"))
            np.testing.assert_array_equal(z, np.rint(-floor(np.asarray(lat)[:, None], np.asarray(lon)[None, :])))
            c = f["sound_speed"]
            self.assertEqual(c.dimensions, ("water_depth", "water_latitude", "water_longitude"))
            self.assertGreaterEqual(f["water_depth"][-1], PLAIN)
            self.assertFalse(np.isnan(np.asarray(c[:])).any())
            self.assertLess(np.ptp(c[0]), 0.1)  # the same everywhere, but for the latitude
            self.assertAlmostEqual(float(f["wind_speed"][:].mean()), 8.0, 3)
            depth = -np.asarray(z)
            numbers = {name: number for number, name in classes.items()}
            np.testing.assert_array_equal(f["sediment"][:] == numbers["sandy mud"], depth <= 2500.0)
            self.assertEqual(f.getncattr("filetype"), "asdic ocean area")
        (self.folder / "ping.toml").write_text("""include = "place.toml"
[platform]
position = [-8000.0, 0.0, 150.0]
[transmitter]
source_level_db = 215.0
taper = "omnidirectional"
[pulse]
kind = "cw"
frequency = 1000.0
duration = 0.1
[array]
kind = "horizontal"
phones = 1
spacing = 0.7
[[target]]
position = [-8000.0, 3000.0, 200.0]
strength_db = 12.0
[reverberation]
enabled = false
[pings]
recording_duration = 6.0
sample_rate = 4000.0
""")
        self.assertIn("place.nc: elevation, bicubic", self.asdic("validate ping.toml"))
        self.asdic("ping ping.toml -o ping.h5")
        with h5py.File(self.folder / "ping.h5") as f:
            self.assertIn("west.nc, elevation", " ".join(map(str, f.attrs["ocean_sources"])))
            self.assertAlmostEqual(distance(f["platform_latitude"][0], f["platform_longitude"][0], *SUMMIT), 8000.0, delta=0.01)
            self.assertGreater(f["summary/paths"][0, 0], 0)
        # The speeds are those of the profile, level by level.
        one = self.ocean("--bathymetry west.nc --temperature hycom.nc --month 1 --data none")[0]["sound_speed"]
        self.assertEqual(one["kind"], "temperature-salinity")

    def test_holes_classes_and_depths_are_told(self):
        gebco(self.folder / "gebco.nc", 30.7, 31.3, -60.6, -59.4)
        with netCDF4.Dataset(self.folder / "gebco.nc", "a") as f:
            lat, lon = f["lat"][:], f["lon"][:]
            j, i = int(np.argmin(abs(lat - 30.95))), int(np.argmin(abs(lon + 60.05)))
            f["elevation"].missing_value = np.int16(-32000)
            f["elevation"][j, i:i + 3] = -32000
            f["elevation"].delncattr("units")
        gebco(self.folder / "whole.nc", 30.7, 31.3, -60.6, -59.4)
        hycom(self.folder / "hycom.nc", [210_396])
        place = f"ocean --latitude {SUMMIT[0]} --longitude {SUMMIT[1]} --area 40km --temperature hycom.nc --data none -o place.toml"
        text = self.asdic(place + " --bathymetry gebco.nc")
        self.assertRegex(text, r"note: 3 of \d+ cells of the bathymetry are holes in gebco.nc: elevation, "
                         rf"the first at {round(float(lat[j]), 4)} N {round(float(lon[i]), 4)} E; a second --bathymetry")
        self.assertIn("note: gebco.nc: elevation has no units: taken as m", text)
        for told in (text, (self.folder / "place.toml").read_text()):
            self.assertIn("by the depth of each cell, sandy mud, abyssal clay were taken; --sediment takes a map", told)
            self.assertNotIn("was taken; --sediment", told)
        # The remedy that the note names: a second file of the same grid.
        self.assertNotIn("holes", self.asdic(place + " --bathymetry gebco.nc --bathymetry whole.nc --force"))
        with netCDF4.Dataset(self.folder / "place.nc") as f:
            self.assertFalse(np.isnan(np.ma.filled(f["elevation"][:], np.nan)).any())

    def test_depths_of_targets_below_the_floor_everywhere(self):
        (self.folder / "flat.toml").write_text("""[environment.sound_speed]
kind = "isovelocity"
speed = 1500.0
[environment.bottom]
kind = "grain-size"
grain_size = 2.5
depth = 200.0
[platform]
position = [0.0, 0.0, 50.0]
[transmitter]
source_level_db = 215.0
taper = "omnidirectional"
[pulse]
kind = "cw"
frequency = 1000.0
duration = 0.1
[array]
kind = "horizontal"
phones = 1
spacing = 0.7
[pings]
recording_duration = 2.0
sample_rate = 4000.0
""")
        text = self.asdic("area flat.toml --depth 3000,100 --bearings 4 --ranges 5 -o flat.h5")
        self.assertIn("--depth: 3000 m is in the water nowhere within the reach, whose deepest place has 200 m", text)
        self.assertIn("3000 m: in the water nowhere", text)
        self.assertNotIn("--depth: 100 m", text)
        self.assertIn("3000 m: in the water nowhere", self.asdic("info flat.h5"))

    def test_of_tiles_that_end(self):
        gebco(self.folder / "gebco.nc", 30.7, 31.3, -60.6, -60.0)
        hycom(self.folder / "hycom.nc", [210_396])
        words = "--area 100km --bathymetry gebco.nc --temperature hycom.nc --data none"
        text = self.asdic(f"ocean --latitude 31 --longitude -60.5 {words} -o place.toml")
        self.assertIn("the files of bathymetry end within the area, in the south, north, west, east", text)
        self.refused(words, "--area", "-o NAME.toml")
        (self.folder / "other.nc").write_text("mine")
        self.refused(words + " -o other.toml", "other.nc")
        self.assertEqual((self.folder / "other.nc").read_text(), "mine")


class Guide(Folder):
    """The commands of docs/guide/real-ocean.md, of files in their makers' layout about Muir Seamount."""

    def test_the_commands_run(self):
        cone = lambda lat, lon: -np.minimum(4500.0, 1400.0 + 0.15 * distance(lat, lon, 33.7, -62.5))
        gebco(self.folder / "gebco_2024_n35.0_s33.0_w-64.0_e-62.0.nc", 33.0, 35.0, -64.0, -62.0, cone)
        shallow, deep = list(range(0, 1501, 100)), list(range(0, 5501, 250))
        where = ((33.5, 34.5), (-63.5, -62.5))
        for letter in "ts":
            woa(self.folder / f"woa23_decav_{letter}03_01.nc", letter, shallow, 3.0, (2, 807), *where)
            woa(self.folder / f"woa23_decav_{letter}00_01.nc", letter, deep, 4.5, (0, 816), *where)
        hycom(self.folder / "hycom_20240315.nc", 212_160 + np.arange(0, 24, 3), south=33.0, west=296.0)
        era5(self.folder / "era5_2024_03.nc", first=1_088_736, south=32.0, west=296.0)
        page = (ROOT / "docs/guide/real-ocean.md").read_text()
        blocks = re.findall(r"<!-- data -->\n```sh\n(.*?)```", page, re.S)
        self.assertEqual(len(blocks), 5)
        for block in blocks:
            done = subprocess.run(["bash", "-euc", block], cwd=self.folder, capture_output=True, text=True,
                                  env={**os.environ, "PATH": f"{Path(ASDIC).parent}:{os.environ['PATH']}"})
            self.assertEqual(done.returncode, 0, block + done.stdout + done.stderr)
            if "cat > muir_ping.toml" in block:
                self.assertIn("33.7 N -63 E is the map's [0, 0]; its ocean: 2024-03-15T06:00", done.stdout)
                self.assertIn("temperature, salinity: hycom_20240315.nc", done.stdout)
        place = tomllib.loads((self.folder / "place.toml").read_text())["environment"]
        water = place["sound_speed"]
        z = np.array(water["depth"])
        np.testing.assert_allclose(water["temperature"], temperature(z, np.where(z <= 1500, 3.0, 4.5)), atol=2e-3)
        self.assertEqual(place["wind_speed"], 8.0)
        shape = tomllib.loads((self.folder / "track.toml").read_text())["environment"]["bottom"]["shape"]
        self.assertLess(abs(min(shape["depth"]) - 1400.0), 60.0)  # a cell off the summit at the most
        with h5py.File(self.folder / "muir_ping.h5") as f:
            self.assertAlmostEqual(f.attrs["latitude_deg"], 33.7, 9)
            self.assertEqual(f.attrs["complete"], 1)
            self.assertGreater(f["summary/paths"][0, 0], 0)
            self.assertAlmostEqual(f["target_longitude"][0, 0], -63.0 + np.degrees(12e3 / radii(33.7)[1]), 4)
        # the vehicle's run over the area: where it is at each ping, and at the third for asdic area
        way = np.array([[-6000.0, -3000.0], [-3600.0, -3000.0], [-3600.0, -600.0]])

        def on_map(lat, lon):
            span, bearing = inverse(33.7, -62.5, np.asarray(lat), np.asarray(lon))
            return np.stack([span * np.sin(bearing), span * np.cos(bearing)], axis=-1)

        with h5py.File(self.folder / "muir_run.h5") as f:
            np.testing.assert_allclose(on_map(f["platform_latitude"][()], f["platform_longitude"][()]), way, atol=0.01)
            self.assertTrue((f["summary/paths"][()] > 0).all())
            # the sea floor below the first place, of the cone that the tile was made of
            depth = 1400.0 + 0.15 * np.hypot(*way[0])
            self.assertAlmostEqual(f["environment"].attrs["bottom_depth_m"], depth, delta=5.0)
        with h5py.File(self.folder / "muir_area.h5") as f:
            np.testing.assert_allclose(f["array_position"][:2], way[2], atol=1e-6)
            self.assertEqual(f["beyond_map"][()].max(), 0)
        with h5py.File(self.folder / "muir_field.h5") as f:
            east = way[0] + np.stack([f["range"][()], 0.0 * f["range"][()]], axis=-1)
            np.testing.assert_allclose(on_map(f["latitude"][()], f["longitude"][()]), east, atol=0.01)
        self.assertGreater((self.folder / "before/geometry.png").stat().st_size, 10_000)


if __name__ == "__main__":
    unittest.main()

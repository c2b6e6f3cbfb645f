#!/usr/bin/env python3
"""Arrays that give their units mean the same as the same quantities written in SI units, or are refused."""
import os
import sys
import unittest
from pathlib import Path

BUILD = Path(os.environ["ASDIC_BUILD"])
SCENARIOS = Path(__file__).resolve().parents[3] / "scenarios"
if not list((BUILD / "python/asdic").glob("_core*.so")):
    print("the Python package was not built here")
    sys.exit(77)
sys.path.insert(0, str(BUILD / "python"))

import numpy as np  # noqa: E402
import pandas as pd  # noqa: E402
import xarray as xr  # noqa: E402

import asdic  # noqa: E402


def array(values, units=None, **coords):
    """A DataArray over its coordinates, each (numbers, unit or None)."""
    return xr.DataArray(values, dims=tuple(coords), attrs={"units": units} if units else {},
                        coords={name: (name, numbers, {"units": unit} if unit else {})
                                for name, (numbers, unit) in coords.items()})


class Profiles(unittest.TestCase):
    """Numbers in other units are scaled by one multiplication, so 1e-12 leaves room for rounding alone."""

    DEPTH, RANGE = np.array([0.0, 100.0, 200.0]), np.array([0.0, 5000.0])
    SPEED = np.array([[1500.0, 1490.0, 1510.0], [1510.0, 1495.0, 1510.0]])
    LENGTHS = (("m", 1.0), ("metres", 1.0), ("meters", 1.0), ("km", 1e3), ("kilometers", 1e3), ("cm", 0.01),
               ("nmi", 1852.0), ("ft", 0.3048))
    SPEEDS = (("m/s", 1.0), ("m s-1", 1.0), ("cm/s", 0.01), ("ft/s", 0.3048), ("knots", 1852.0 / 3600.0))

    def same(self, found, wanted):
        self.assertEqual(set(found), set(wanted))
        for key, value in wanted.items():
            if isinstance(value, str):
                self.assertEqual(found[key], value)
            else:
                np.testing.assert_allclose(found[key], value, rtol=1e-12, err_msg=key)

    def test_profiles_and_sections(self):
        for unit, metres in self.LENGTHS:
            for speed_unit, mps in self.SPEEDS:
                profile = array(self.SPEED[0] / mps, speed_unit, depth=(self.DEPTH / metres, unit))
                self.same(asdic.Scenario(sound_speed=profile).environment.sound_speed.to_dict(),
                          {"kind": "table", "depth": self.DEPTH, "speed": self.SPEED[0]})
            section = array(self.SPEED, None, range=(self.RANGE / metres, unit), depth=(self.DEPTH, None))
            self.same(asdic.Scenario(sound_speed=section.T).environment.sound_speed.to_dict(),
                      {"kind": "section", "range": self.RANGE, "depth": self.DEPTH, "speed": self.SPEED})

    def test_sea_floors(self):
        for unit, metres in self.LENGTHS:
            floor = array(np.array([200.0, 100.0]) / metres, unit, range=(self.RANGE / metres, unit))
            wanted = {"range": self.RANGE, "depth": [200.0, 100.0]}
            self.same(asdic.Scenario(bathymetry=floor).environment.bottom.shape.to_dict(), wanted)
            s = asdic.Scenario()
            s.environment.bottom.shape = floor
            self.same(s.environment.bottom.shape.to_dict(), wanted)
            deep = asdic.Scenario(bathymetry=array(200.0 / metres, unit))
            self.assertAlmostEqual(deep.environment.bottom.depth, 200.0, places=9)

    def test_tables_of_pandas(self):
        cast = pd.DataFrame({"depth": [0.0, 0.2], "temperature": [288.15, 281.15], "salinity": [35.0, 35.0]})
        cast.attrs["units"] = {"depth": "km", "temperature": "K"}
        found = asdic.Scenario(sound_speed=cast).environment.sound_speed
        np.testing.assert_allclose(found.depth, [0.0, 200.0])
        np.testing.assert_allclose(found.temperature, [15.0, 8.0], atol=1e-9)  # 288.15 has 13 digits behind the point
        speed = pd.Series([5000.0, 4900.0], [0.0, 50.0])
        speed.attrs["units"] = "ft/s"
        np.testing.assert_allclose(asdic.Scenario(sound_speed=speed).environment.sound_speed.speed, [1524.0, 1493.52])

    def test_what_is_refused_says_where_what_and_what_is_expected(self):
        depth = self.DEPTH
        for ocean, words in (
                ({"sound_speed": array(self.SPEED[0], "furlong/s", depth=(depth, "m"))},
                 ("sound_speed:", '"furlong/s"', '"m/s"')),
                ({"sound_speed": array(self.SPEED[0], "degC", depth=(depth, "m"))},
                 ("sound_speed:", '"degC"', '"m/s"')),
                ({"sound_speed": array(self.SPEED[0], None, depth=(depth, "dbar"))},
                 ("sound_speed: depth:", '"dbar"', '"m"')),
                ({"bathymetry": array([200.0, 100.0], "m", range=([0.0, 1.0], "degrees_north"))},
                 ("bathymetry: range:", '"degrees_north"', '"m"')),
                ({"bathymetry": xr.DataArray([200.0, 100.0], dims="range")},
                 ("bathymetry: range:", "no such coordinate"))):
            with self.assertRaises(asdic.InputError) as raised:
                asdic.Scenario(**ocean)
            for word in words:
                self.assertIn(word, str(raised.exception))


class Settings(unittest.TestCase):
    def test_any_setting(self):
        s = asdic.Scenario(SCENARIOS / "deep_ocean.toml", set={"environment.wind_speed": array(10.0, "kn")})
        self.assertAlmostEqual(s.environment.wind_speed, 10 * 1852.0 / 3600.0, places=12)
        s.targets[0].depth = array(0.2, "km")
        s.set("target.0.range", array(2.5, "nmi"))
        self.assertEqual((s.targets[0].depth, s.targets[0].range), (200.0, 4630.0))
        s.platforms[0].position = array([1.0, 2.0, 0.1], "km", axis=([0, 1, 2], None))
        self.assertEqual(s.platforms[0].position, [1000.0, 2000.0, 100.0])
        s.targets.append(name="second", range=array(9.0, "km"), depth=50.0, strength_db=10.0)
        self.assertEqual(s.targets[1].range, 9000.0)
        s.environment.sound_speed = {"kind": "table", "depth": array([0.0, 6.0], "km", k=([0, 1], None)),
                                     "speed": [1500.0, 1510.0]}
        self.assertEqual(s.environment.sound_speed.depth, [0.0, 6000.0])
        made = asdic.Scenario(environment={"wind_speed": array(36.0, "km/h")},
                              bottom={"kind": "rigid", "depth": array(1.0, "km")})
        self.assertEqual((made.environment.wind_speed, made.environment.bottom.depth), (10.0, 1000.0))
        with self.assertRaisesRegex(asdic.InputError, 'pulse.duration: found units of "m", expected "s"'):
            s.pulse.duration = array(0.1, "m")
        with self.assertRaisesRegex(asdic.InputError, "from 1e-06 to 1000"):  # the range is that of seconds
            s.pulse.duration = array(20.0, "min")

    def test_arguments(self):
        s = asdic.Scenario(sound_speed=1500.0, bathymetry=200.0)
        far = s.arrivals(range=array(2.0, "km"), depth=array(6000.0, "cm"), source_depth=30.0,
                         frequency=array(1.0, "kHz"))
        np.testing.assert_array_equal(
            far.delay, s.arrivals(range=2000.0, depth=60.0, source_depth=30.0, frequency=1000.0).delay)
        two = ([0, 1], None)
        told = dict(frequency=array(0.2, "kHz"), source_depth=array(0.05, "km"),
                    depths=array([50.0, 6000.0], "cm", k=two), ranges=array([1.0, 2.0], "km", k=two))
        np.testing.assert_array_equal(
            s.field(**told), s.field(frequency=200.0, source_depth=50.0, depths=[0.5, 60.0], ranges=[1e3, 2e3]))
        np.testing.assert_array_equal(s.sound_speed(array([0.0, 0.1], "km", k=([0, 1], None))).depth, [0.0, 100.0])

    def test_laws_of_a_study(self):
        s = asdic.Scenario(SCENARIOS / "isovelocity.toml")
        vary = {"target.0.position.0": {"law": "uniform", "low": array(2.0, "km"), "high": array(3.0, "km")}}
        found = asdic.study(s, realisations=4, vary=vary).table
        self.assertTrue(found.iloc[:, 0].between(2e3, 3e3).all(), found)
        with self.assertRaisesRegex(asdic.InputError, 'vary.*low: found units of "s"'):
            vary["target.0.position.0"]["low"] = array(2.0, "s")
            asdic.study(s, realisations=4, vary=vary)

    def test_signals(self):
        channel = asdic.Scenario(SCENARIOS / "modem.toml").channel(duration=0.5)
        sent = np.random.default_rng(1).standard_normal(200)
        np.testing.assert_allclose(channel(array(sent * 1e6, "uPa", time=(np.arange(200.0), "s")), 48e3),
                                   channel(sent, 48e3), rtol=1e-5, atol=1e-12)  # received as float32
        with self.assertRaisesRegex(asdic.InputError, 'signal: found units of "V"'):
            channel(array(sent, "V", time=(np.arange(200.0), "s")), 48e3)


if __name__ == "__main__":
    unittest.main(verbosity=1)

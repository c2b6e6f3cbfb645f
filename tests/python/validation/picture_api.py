#!/usr/bin/env python3
"""asdic.pictures: the same pictures of datasets in memory, of files and of scenarios, and of a scenario
before it runs by the program.
"""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
BUILD, PROGRAM = Path(os.environ["ASDIC_BUILD"]), os.environ["ASDIC"]
if not list((BUILD / "python/asdic").glob("_core*.so")):
    print("the Python package was not built here")
    sys.exit(77)
sys.path[:0] = [str(BUILD / "python"), str(ROOT / "tests" / "support")]

import asdic  # noqa: E402

WITHOUT_MATPLOTLIB = "matplotlib" not in sys.modules
from asdic import pictures  # noqa: E402

import numpy as np  # noqa: E402
from matplotlib.figure import Figure  # noqa: E402
from deep import DEEP  # noqa: E402
from text_layout import faults  # noqa: E402

SEA = """
title = "a small sea"
[environment.sound_speed]
kind = "isovelocity"
speed = 1500.0
[environment.bottom]
depth = 1000.0
kind = "rigid"
[environment.absorption]
kind = "none"
[platform]
name = "ship"
position = [0.0, 0.0, 200.0]
velocity = [3.0, 0.0, 0.0]
[transmitter]
source_level_db = 210.0
beamwidth_deg = 30.0
[pulse]
kind = "cw"
frequency = 1000.0
duration = 0.25
[array]
kind = "horizontal"
phones = 4
spacing = 0.75
[[target]]
name = "rock"
position = [2000.0, 1500.0, 400.0]
strength_db = 15.0
[noise]
spectral_level_db = 50.0
[reverberation]
enabled = false
[propagation]
max_surface_bounces = 0
max_bottom_bounces = 0
[pings]
recording_duration = 4.0
sample_rate = 2500.0
"""
FRONT = str(ROOT / "scenarios" / "front.toml")


def page(fig):
    fig.set_dpi(50)
    fig.canvas.draw()
    return np.asarray(fig.canvas.buffer_rgba()).copy()


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def same(self, a, b, what):
        """\\param b  a page: a figure that is drawn twice may be laid out a little otherwise"""
        self.assertTrue(np.array_equal(page(a), b), what)


class Pings(Case):
    def setUp(self):
        super().setUp()
        self.s = asdic.Scenario.parse(SEA)
        self.file = self.folder / "ping.h5"

    def test_who_does_not_draw_does_not_wait_for_matplotlib(self):
        self.assertTrue(WITHOUT_MATPLOTLIB)
        self.assertIs(asdic.pictures, pictures)

    def test_a_ping_its_file_and_the_dataset_of_the_file_are_one_picture(self):
        self.s.write(self.file)
        ping, opened = self.s.ping(), asdic.open(self.file)
        for draw in (pictures.levels, pictures.rays)[:2 if DEEP else 1]:
            wanted = draw(str(self.file))
            self.assertIsInstance(wanted, Figure)
            wanted = page(wanted)
            self.same(draw(ping), wanted, draw.__name__)
            self.same(draw(opened), wanted, draw.__name__)
        self.same(pictures.pressure(asdic.open(self.file, load=False)),
                  page(pictures.pressure(self.file)), "not loaded")

    def test_complex_baseband(self):
        self.s.pings.samples, self.s.pings.sample_rate = "baseband", None
        self.s.write(self.file)
        wanted = page(pictures.bearing_time(str(self.file)))
        self.same(pictures.bearing_time(self.s.ping()), wanted, "ping")
        self.same(pictures.bearing_time(asdic.open(self.file)), wanted, "dataset")

    def test_a_pressure_that_was_changed_is_drawn_as_it_is(self):
        """A hundred times louder: 40 dB, of what is measured, not of the truth."""
        ping = self.s.ping()
        louder = ping.assign(pressure=ping.pressure * np.float32(100.0))
        curves = [{x.get_label(): x.get_ydata() for x in pictures.levels(p).axes[0].lines}
                  for p in (ping, louder)]
        quiet, loud = (c["measured, all frequencies"] for c in curves)
        np.testing.assert_allclose(loud - quiet, 40.0, atol=1e-4)
        echo = [next(y for x, y in c.items() if x.startswith("echo")) for c in curves]
        np.testing.assert_array_equal(*echo)

    def test_on_axes_of_ones_own(self):
        fig = Figure(figsize=(6, 6))
        first, second = fig.subplots(2)
        ping = self.s.ping()
        self.assertIs(pictures.levels(ping, first, limits=(30, 120)), fig)
        self.assertIs(pictures.bearing_time(ping, second, theme="dark"), fig)
        self.assertEqual(first.get_ylim(), (30, 120))
        self.assertTrue(second.images)

    def test_what_cannot_be_drawn_is_told(self):
        ping = self.s.ping()
        for draw, told in ((pictures.detections, "not processed"), (pictures.sweep, "one ping"),
                           (pictures.matched_filter, "a tone")):
            with self.assertRaises(asdic.InputError) as raised:
                draw(ping)
            self.assertIn(told, str(raised.exception))
        with self.assertRaises(asdic.InputError):
            pictures.transmission_loss(str(self.folder / "none.h5"))

    def test_saved_pictures_say_what_they_are_of(self):
        fig = pictures.levels(self.s.ping())
        for ending in (".png", ".pdf", ".svg"):
            path = self.folder / ("levels" + ending)
            pictures.save(fig, path)
            content = path.read_bytes()
            self.assertIn(b"asdic " + asdic.__version__.encode(), content)
            pictures.save(fig, path)                       # over our own
            path.write_bytes(b"mine")
            with self.assertRaisesRegex(asdic.InputError, "asdic did not write"):
                pictures.save(fig, path)
        with self.assertRaises(asdic.InputError):
            pictures.save(fig, self.folder / "levels.gif")

    def test_a_notebook_shows_them(self):
        self.assertEqual(pictures.levels(self.s.ping())._repr_png_()[:4], b"\x89PNG")


class Results(Case):
    def test_fields_arrivals_and_rays_in_memory(self):
        s = asdic.Scenario(sound_speed=1500.0, bathymetry=200.0)
        field = s.field(frequency=200.0, source_depth=50.0, depths=np.linspace(5.0, 195.0, 20),
                        ranges=np.linspace(100.0, 5000.0, 50))
        fig = pictures.transmission_loss(field)
        drawn = next(m for m in fig.axes[0].collections if hasattr(m, "colorbar") and m.colorbar)
        loss = -20.0 * np.log10(np.abs(field.values))
        np.testing.assert_allclose(np.sort(np.ravel(drawn.get_array())), np.sort(loss.ravel()), rtol=1e-6)
        arrivals = s.arrivals(range=5e3, depth=100.0, frequency=200.0, source_depth=50.0)
        self.assertIn(f"{len(arrivals)} arrivals", pictures.arrivals(arrivals).axes[0].get_title(loc="left"))
        rays = s.rays(source_depth=50.0, count=9, range=5e3)
        self.assertEqual(sum(len(x.get_xdata()) > 1 for x in pictures.rays(rays).axes[0].lines), 9)

    def test_a_file_and_its_dataset(self):
        path = self.folder / "run.h5"
        run = asdic.Scenario.parse(SEA[SEA.index("[env"):SEA.index("[platform]")] + """[run]
task = "field"
frequency = 300.0
[run.source]
depth = 60.0
[run.receivers]
depth = [50.0, 100.0, 150.0, 200.0, 250.0]
range = [1e3, 2e3, 3e3]
""")
        asdic._core.write_run(str(path), run._core, None)
        self.same(pictures.transmission_loss(asdic.open(path)), page(pictures.transmission_loss(path)), "field")


class Before(Case):
    """A scenario that has not run: places, water and phones are those that it says."""

    def test_geometry(self):
        s = asdic.Scenario.parse(SEA)
        above, beside = pictures.geometry(s).axes[:2]
        target = next(x for x in above.lines if x.get_marker() == "o")
        np.testing.assert_allclose([*target.get_xdata(), *target.get_ydata()], [2.0, 1.5])
        target = next(x for x in beside.lines if x.get_marker() == "o")
        self.assertAlmostEqual(float(np.ravel(target.get_xdata())[0]), 2.5)
        self.assertEqual(float(np.ravel(target.get_ydata())[0]), 400.0)
        self.assertGreater(beside.get_ylim()[0], beside.get_ylim()[1])     # depth is down
        ways = [x for x in above.lines if len(x.get_xdata()) > 2]
        self.assertAlmostEqual(max(np.ptp(x.get_xdata()) for x in ways), 0.012)    # 4 s at 3 m/s

    def test_array(self):
        s = asdic.Scenario.parse(SEA)
        s.arrays[0].heading_deg = 90.0
        above = pictures.array(s).axes[0]
        places = np.asarray(above.collections[0].get_offsets())
        np.testing.assert_allclose(places[:, 0], [-1.125, -0.375, 0.375, 1.125], atol=1e-9)
        np.testing.assert_allclose(places[:, 1], 0.0, atol=1e-9)
        self.assertIn("0.5 wavelengths", above.get_title(loc="left"))

    def test_words_of_an_upright_array_and_of_none(self):
        s = asdic.Scenario.parse(SEA.replace('kind = "horizontal"', 'kind = "vertical"'))
        self.assertEqual(faults(pictures.array(s)), [])
        with self.assertRaisesRegex(asdic.InputError, f"^{FRONT}: found no array"):
            pictures.array(FRONT)

    def test_every_profile_of_water_that_varies_with_range(self):
        axes = pictures.sound_speed(FRONT).axes[0]
        profiles = [x for x in axes.lines if len(x.get_xdata()) > 2]
        self.assertEqual(len(profiles), 4)
        np.testing.assert_allclose(profiles[2].get_xdata()[:3], [1495.0, 1484.0, 1478.0])

    def test_the_program_draws_them_and_words_can_be_read(self):
        done = subprocess.run(
            [PROGRAM, "plot", str(ROOT / "scenarios/deep_ocean.toml"), "-o", str(self.folder / "p"),
             "--format", "svg", "--set", "target.0.depth=300m"], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(sorted(p.name for p in (self.folder / "p").iterdir()),
                         ["array.svg", "geometry.svg", "pulse.svg", "sound_speed.svg"])
        done = subprocess.run([PROGRAM, "plot", str(self.folder / "none.toml")], capture_output=True,
                              text=True)
        self.assertEqual(done.returncode, 2)
        names = ("front", "bistatic", "towed_array_turn", "deep_ocean")
        for name in names if DEEP else names[:2]:
            path = str(ROOT / f"scenarios/{name}.toml")
            for draw in (pictures.geometry, pictures.sound_speed, pictures.array, pictures.pulse):
                if name != "front" or draw not in (pictures.array, pictures.pulse):
                    self.assertEqual(faults(draw(path)), [], (name, draw.__name__))



class Areas(Case):
    """What a sonar sees of the area, and a ping on the map."""

    def test_every_map_of_a_dataset_and_of_its_file(self):
        found = asdic.area(asdic.Scenario.parse(SEA), [100.0, 400.0], reach=3e3, bearings=24, ranges=30)
        drawn = {name: pictures.area(found, what=name, depth=400.0)
                 for name in ("signal_excess", "echo_level", "sea_floor", "sections")}
        self.assertEqual(faults(drawn["signal_excess"]), [])
        shown = drawn["echo_level"].axes[0].collections[0].get_array()
        np.testing.assert_array_equal(np.ravel(shown), np.ravel(found.echo_db.sel(depth=400.0).values))
        with self.assertRaisesRegex(asdic.InputError, "depth: found 5 m, expected one of 100, 400"):
            pictures.area(found, depth=5.0)
        with self.assertRaisesRegex(asdic.InputError, "reverberation_level"):   # there is none
            pictures.area(found, what="reverberation_level")
        (self.folder / "sea.toml").write_text(SEA)
        for words in (["area", "sea.toml", "-o", "area.h5", "-q", "--reach", "3km", "--bearings", "24",
                       "--ranges", "30"], ["plot", "area.h5", "-o", "p", "--only", "signal_excess"]):
            done = subprocess.run([PROGRAM, *words], cwd=self.folder, capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual([p.name for p in (self.folder / "p").iterdir()], ["signal_excess.png"])

    def test_a_placement_of_a_plan_and_of_its_file(self):
        (self.folder / "sea.toml").write_text(SEA)
        (self.folder / "plan.toml").write_text(
            '[placement]\nscenario = "sea.toml"\nsensors = 2\nbearings = 12\nranges = 20\nreach = 4e3\n'
            '[placement.places]\npoints = [[0.0, 0.0], [1500.0, 0.0], [0.0, 2500.0]]\n'
            '[placement.cells]\neast = [-3000.0, 3000.0]\nnorth = [-3000.0, 3000.0]\nstep = 1000.0\n')
        with self.assertWarns(asdic.AsdicWarning):      # nothing was drawn
            found = asdic.place(self.folder / "plan.toml", changes={"placement.sensors": 1})
        self.assertEqual(found.sensor_place.size, 1)
        share = float((found.weight * found.detection_probability).sum())
        self.assertAlmostEqual(share, float(found.share[0]), places=5)
        self.assertAlmostEqual(share, float(found.candidate_share.max()), places=5)    # one sensor: the best alone
        self.assertEqual(faults(pictures.placement(found)), [])
        with self.assertRaisesRegex(asdic.InputError, "nothing was drawn"):
            pictures.placement(found, what="draws")
        done = subprocess.run([PROGRAM, "place", "plan.toml", "-o", "p.h5", "-q", "--set", "placement.sensors=1"],
                              cwd=self.folder, capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        np.testing.assert_array_equal(asdic.open(self.folder / "p.h5").detection_probability.values,
                                      found.detection_probability.values)

    def test_a_ping_on_the_map(self):
        """The loudest cell of the map is at the target, by its bearing, or at its mirror image; its range is
        that of the slant way. Of a bistatic pair any scatterer's range comes out of its delay.
        """
        from asdic_pictures import ppi
        ping = asdic.Scenario.parse(SEA).ping()
        fig = pictures.ppi(ping)
        mesh = fig.axes[0].collections[0]
        corners = mesh.get_coordinates()
        power = np.ma.filled(mesh.get_array(), -np.inf).reshape(corners.shape[0] - 1, -1)
        k = np.unravel_index(power.argmax(), power.shape)
        x, y = corners[k[0]:k[0] + 2, k[1]:k[1] + 2].reshape(-1, 2).mean(axis=0)
        way = np.hypot(2500.0, 200.0) / 1e3
        self.assertLess(abs(np.hypot(x, y) - way), 0.2)     # the pulse is 188 m long
        self.assertLess(abs(y - 1.5) / way, 0.1)            # a line to the north hears both its sides
        draw = np.random.default_rng(7)
        for source, place in draw.uniform(-5e3, 5e3, (20, 2, 2)):
            delay = (np.hypot(*(place - source)) + np.hypot(*place)) / 1500.0
            found = ppi.ranges([delay], [np.arctan2(*place)], np.hypot(*source), np.arctan2(*source),
                               1500.0)
            self.assertAlmostEqual(found[0, 0], np.hypot(*place), delta=1e-6 * np.hypot(*place) + 1e-6)


if __name__ == "__main__":
    unittest.main(verbosity=1)

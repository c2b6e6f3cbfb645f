#!/usr/bin/env python3
"""What the pictures show: axes that tell the truth, colours that can be read, honest legends."""
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "tests" / "support")]

import make_ping_file as synthetic  # noqa: E402
from asdic_pictures import (area, bearing_time, levels, matched_filter, rays,  # noqa: E402
                            results, scene, scene_pictures, style, sweep)
from asdic_pictures import sea as seas  # noqa: E402
from asdic_pictures.data import PingFile  # noqa: E402
from matplotlib.colors import to_hex  # noqa: E402

SMALL = dict(duration=6.0012, sample_rate=2500.0, frequency=1000.0, pulse=0.25, phones=8,
             spacing=0.75, depth=500.0, water=1200.0, targets=[(3000.0, 65.0, 60.0)],
             strength=30.0, target_speed=0.0, reverberation=False)


class Case(unittest.TestCase):
    def look(self, change=None, **settings):
        """A synthetic file, changed and open."""
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = Path(folder.name) / "ping.h5"
        self.settings = synthetic.Settings(**{**SMALL, **settings})
        synthetic.write(path, self.settings)
        if change:
            with h5py.File(path, "r+") as f:
                change(f)
        data = PingFile(path)
        self.addCleanup(data.file.close)
        return data

    def labels(self, fig):
        return [t.get_text() for a in fig.axes if a.get_legend() for t in a.get_legend().get_texts()]


class History(Case):
    def test_echoes_stand_at_their_time_and_the_last_column_ends_with_the_record(self):
        """Hann pulses at known times: the brightest column holds the pulse's middle, within one.
        15 003 samples, and 10 001 in the second ping: neither fits the columns.
        """
        starts = (5.2, 3.3)

        def inject(f):
            phones = np.zeros((8, 3))
            f["valid_samples"][1] = 10001
            for k, start in enumerate(starts):
                p = np.zeros((8, f["pressure"].shape[2]))
                synthetic.add_echo(p, phones, self.settings, start, np.zeros(3), 1.0, 120.0, 1500.0)
                f["pressure"][k] = p
        data = self.look(inject, pings=2, noise_level=None)
        edges, db, _ = sweep.history(data)
        column = edges[1] - edges[0]
        self.assertAlmostEqual(edges[-1], 15003 / 2500.0, places=9)
        for k, start in enumerate(starts):
            brightest = np.nanargmax(db[k])
            middle = 0.5 * (edges[brightest] + edges[brightest + 1])
            self.assertLess(abs(middle - (start + 0.125)), 1.01 * column)
        last = np.flatnonzero(np.isfinite(db[1]))[-1]
        self.assertLess(abs(edges[last + 1] - 10001 / 2500.0), 1.01 * column)

    def test_elevation_is_drawn_only_where_it_changes(self):
        for elevations, panels in (([8.0], 2), ([6.0, 9.0], 3)):    # with the colour bar
            fig = sweep.draw(self.look(pings=2, elevations=elevations), 0)
            self.assertEqual(len(fig.axes), panels)


class Titles(Case):
    def test_a_ping_is_called_by_its_number(self):
        def later(first):
            def change(f):
                f["ping"][:] += first - 1
            return change
        for pings, first, told in ((1, 1, ""), (1, 2, " · ping 2"), (2, 1, " · ping 1 of 2"),
                                   (2, 3, " · ping 3")):
            with self.subTest(pings=pings, first=first):
                data = self.look(later(first), pings=pings, elevations=[8.0])
                self.assertEqual(data.heading(data.choose_ping(None)), data.title + told)


class Colours(Case):
    def test_a_loud_start_leaves_the_rest_readable(self):
        """1 % of the cells at 175 dB over noise at 40 ± 3 dB and an echo at 70 dB: the floor is a
        little under the noise, the top clips only the start."""
        db = 40.0 + 3.0 * np.random.default_rng(1).standard_normal(100_000)
        db[:1000] = 175.0
        low, high = style.colour_limits(db, 70.0)
        self.assertTrue(30.0 <= low < 40.0, low)
        self.assertTrue(70.0 <= high <= low + 55.0, high)

    def test_a_loud_echo_is_not_clipped(self):
        db = np.full(100_000, 40.0)
        db[:10] = 130.0
        low, high = style.colour_limits(db, 130.0)
        self.assertEqual((low, high), (75.0, 130.0))

    def test_boxes_have_their_targets_colours(self):
        data = self.look(targets=[(2500.0, 40.0, 60.0), (3200.0, 100.0, 200.0)])
        fig = bearing_time.draw(data, 0)
        boxes = {to_hex(box.get_edgecolor()).upper() for box in fig.axes[0].patches}
        self.assertEqual(boxes, {style.colour(0).upper(), style.colour(1).upper()})


class Legends(Case):
    def test_echo_line_of_several_targets_has_no_targets_colour(self):
        data = self.look(targets=[(2500.0, 40.0, 60.0), (3200.0, 100.0, 200.0)])
        self.assertNotIn(levels.echo_colour(data.echoes(0)), style.TARGETS)
        self.assertIn("echo, all 2 targets", self.labels(levels.draw(data, 0)))

    def test_a_line_below_the_axis_is_named(self):
        def quiet(f):
            f["levels/echo"][...] = 1e-12
        self.assertTrue(any("echo (below the axis" in t
                            for t in self.labels(levels.draw(self.look(quiet), 0))))

    def test_targets_of_other_bearings_and_absent_ones(self):
        def leave(f):
            f["target_present"][0, 1] = 0
            f["rays/range"][0, -1] = 1e12
        data = self.look(leave, targets=[(2500.0, 40.0, 60.0), (3200.0, 100.0, 200.0)])
        fig = rays.draw(data, 0)
        self.assertIn("60° apart", fig.axes[1].get_title(loc="left"))
        self.assertTrue(any("not there" in t for t in self.labels(fig)))
        hollow = [a for a in fig.axes[1].get_lines()
                  if a.get_marker() == "o" and a.get_markerfacecolor() == "white"]
        self.assertEqual(len(hollow), 1)
        # 6 s there and back at 1.55 km/s at most: 4.7 km, and a tenth
        self.assertLess(fig.axes[1].get_xlim()[1], 1.1 * 4.7 * 1.02)


class MatchedFilter(Case):
    def test_peak_stands_at_the_leading_edge_at_the_echos_level(self):
        """One echo of 100 dB at 3.2 s: a peak there within half of 1/bandwidth, and 0.5 dB."""
        travel = synthetic.travel_direction(0.0, 245.0)

        def inject(f):
            p = np.zeros(f["pressure"].shape[1:])
            phones = f["phone_position"][0] - f["phone_position"][0].mean(axis=0)
            speed = float(np.interp(500.0, f["environment/depth"], f["environment/sound_speed"]))
            synthetic.add_echo(p, phones, self.settings, 3.2, travel, 1.0, 100.0, speed)
            f["pressure"][0] = p
        data = self.look(inject, bandwidth=200.0, noise_level=None)
        echo = data.echoes(0)[0]
        echo.direction[:] = travel
        time, mean, beam = matched_filter.filtered(data, 0, echo)
        for db in (mean, beam):
            self.assertLess(abs(time[np.nanargmax(db)] - 3.2), 0.5 / 200.0 + 0.003)
        self.assertAlmostEqual(np.nanmax(beam), 100.0, delta=0.5)

    def test_the_axis_leaves_out_the_transmitters_own_sound_and_says_so(self):
        """A blast of 190 dB at the start; then noise over a faint echo, which fills the axis."""
        def inject(f):
            phones = np.zeros((8, 3))
            p = f["pressure"][0].astype(float)
            synthetic.add_echo(p, phones, self.settings, 0.0, np.zeros(3), 1.0, 190.0, 1500.0)
            f["pressure"][0] = p
        data = self.look(inject, bandwidth=200.0, strength=-30.0)
        echo = data.echoes(0)[0]
        fig = matched_filter.draw(data, 0)
        low, high = fig.axes[0].get_ylim()
        time, mean, beam = matched_filter.filtered(data, 0, echo)
        later = time > 0.26     # the pulse lasts 0.25 s
        self.assertGreater(np.mean((beam[later] > low) & (beam[later] < high)), 0.9)
        loudest = max(mean[later].max(), beam[later].max())
        self.assertGreater(high, loudest)
        self.assertLess(high, loudest + 10.0)
        self.assertTrue(any("above the axis up to" in t for t in self.labels(fig)))


class AreaMaps(Case):
    """Maps whose cells are known."""

    def area(self, bearings=36, ranges=50, reach=80e3, beyond="", **values):
        shape = (1, bearings, ranges)
        turn = 360.0 / bearings
        span = (np.arange(ranges) + 0.5) * reach / ranges
        given = {v.dataset: np.zeros(shape) for v in area.MAPS.values()}
        given |= {name: np.broadcast_to(v, shape).astype(float) for name, v in values.items()}
        given.setdefault("certainty", np.zeros(shape))
        floor = np.broadcast_to(1000.0 + span / 40.0, shape[1:])
        return area.Area("made", np.array([80.0]), turn * (np.arange(bearings) + 0.5), span,
                         np.array([0.0, 0.0, 6.0]), np.array([0.0, 0.0, 6.0]), given,
                         given["certainty"], np.zeros(shape), floor, "it", "the array", beyond)

    def test_a_flat_floor_has_no_contours(self):
        """Of 2 m in 60 they would hide the map; the picture of the floor has them."""
        span = np.linspace(0.0, 1.0, 50)
        self.assertEqual(style.depth_levels(60.0 + 2.0 * span).size, 0)
        self.assertGreater(style.depth_levels(60.0 + 2.0 * span, relief=0.0).size, 2)
        self.assertGreater(style.depth_levels(60.0 + 4.0 * span).size, 2)

    def test_colours_are_those_of_the_area(self):
        """Levels that fall evenly with the area within, from 124 to -176 dB: 2 % above, 60 dB below."""
        span = (np.arange(50) + 0.5) / 50.0
        found = self.area(echo_db=124.0 - 300.0 * span**2)
        low, high = area.draw(found, "echo_level").axes[0].collections[0].get_clim()
        self.assertEqual((low, high), (60.0, 120.0)) 
        even = self.area(echo_db=60.0 - 50.0 * span**2)
        low, high = area.draw(even, "echo_level").axes[0].collections[0].get_clim()
        self.assertLessEqual(abs(low - 12.5), 5.0)
        self.assertLessEqual(abs(high - 59.0), 5.0)
        # in an eighth of the cells, in 1.5 % of the area; then over 3 % of it: the rest has colours
        for spike, part in ((75.0, 0.015), (150.0, 0.03), (400.0, 0.03)):
            few = self.area(echo_db=np.where(span**2 < part, spike, 20.0 - 20.0 * span**2))
            low, high = area.draw(few, "echo_level").axes[0].collections[0].get_clim()
            self.assertEqual((low, high), (0.0, 20.0))

    def test_no_detection_is_white(self):
        span = (np.arange(50) + 0.5) / 50.0
        fig = area.draw(self.area(signal_excess_db=60.0 - 200.0 * span), "signal_excess")
        mesh = fig.axes[0].collections[0]
        self.assertEqual(mesh.get_clim(), (-60.0, 30.0))
        self.assertEqual(to_hex(mesh.cmap(mesh.norm(0.0))), to_hex(mesh.cmap(0.5)))

    def test_cells_without_a_value_are_told(self):
        values = np.zeros((1, 36, 50))
        values[..., :5] = -np.inf
        fig = area.draw(self.area(reverberation_db=values), "reverberation_level")
        self.assertIn("no reverberation comes then", self.labels(fig))
        certainty = np.zeros((1, 36, 50))
        certainty[..., :5], certainty[..., 40:] = area.NO_PATH, area.NO_WATER
        values[..., 40:], values[0, 0, 20] = np.nan, np.nan
        told = self.labels(area.draw(self.area(echo_db=values, certainty=certainty), "echo_level"))
        for words in ("shadow: no ray comes", "sea floor above that depth", "no value"):
            self.assertIn(words, told)
        self.assertNotIn("no value", self.labels(area.draw(self.area(), "echo_level")))

    def test_depths_can_be_seen_on_any_colour(self):
        fig = area.draw(self.area(), "detection_probability")
        shades = {to_hex(style.INK)}
        lines = [c for c in fig.axes[0].collections
                 if len(c.get_edgecolor()) == 1 and to_hex(c.get_edgecolor()[0]) in shades
                 and c.get_path_effects()]
        self.assertGreater(len(lines), 0)

    def test_cells_beyond_the_map_are_hatched(self):
        """East of 40 km; the strokes fall, those of uncertain cells rise. Which map ends is told."""
        found = self.area()
        bearing = np.radians(found.bearing)[:, None]
        for number, name in area.ENDED.items():
            found.ends = np.where(found.range * np.sin(bearing) > 40e3, number, 0)
            for what in ("signal_excess", "reverberation_level", "sea_floor") if number == 1 else ("echo_level",):
                axes = area.draw(found, what).axes[0]
                self.assertIn(f"beyond the map of {name}", self.labels(axes.figure))
                strokes = [c for c in axes.collections if type(c).__name__ == "LineCollection"
                           and len(c.get_path_effects()) == 1 and c.get_zorder() == 2.5]
                self.assertEqual(len(strokes), 1)
                ends = np.array(strokes[0].get_segments())
                cell = 80.0 / 50.0 + 80.0 * np.radians(10.0)    # at the corner of one
                self.assertGreater(ends[..., 0].min(), 40.0 - cell)
                self.assertGreater(ends[..., 0].max(), 75.0)
        self.assertIn("beyond the map: its edge goes on", self.labels(area.draw(found, "sections")))
        for ends in (None, np.zeros((36, 50))):
            found.ends = ends
            for what in ("sea_floor", "sections"):
                self.assertFalse(any("beyond" in told for told in self.labels(area.draw(found, what))))

    def test_degrees_on_the_frame_are_those_of_the_cells(self):
        found = self.area()
        bearing = np.radians(found.bearing)[:, None]
        x, y = found.range * np.sin(bearing), found.range * np.cos(bearing)
        latitude = 60.0 + y / 111e3
        found.earth = latitude, 179.9 + x / (111e3 * np.cos(np.radians(latitude)))
        axes = area.draw(found, "echo_level").axes[0]
        axes.figure.canvas.draw()
        over, beside = axes.child_axes
        low, high = np.array(axes.get_xlim()) * 1e3
        per_degree = 111e3 * np.cos(np.radians(60.0))
        np.testing.assert_allclose(over.get_xlim(), 179.9 + np.array([low, high]) / per_degree, atol=1e-3)
        np.testing.assert_allclose(beside.get_ylim(), 60.0 + np.array([low, high]) / 111e3, atol=1e-6)
        self.assertTrue(any(t.get_text().endswith("° W") for t in over.get_xticklabels()))
        self.assertEqual(area.draw(self.area(), "echo_level").axes[0].child_axes, [])

    def test_the_maps_end_and_bearings_are_told(self):
        attributes = {"warnings": [b"propagation: rays", b"environment.area: sound is followed to 80 km, "
                                   b"and muir.nc ends 20.1 km away at 255 degrees; beyond it its edge goes on"]}
        beyond = area.of_the_map(attributes)
        self.assertIn("20.1 km away", beyond)
        self.assertEqual(area.of_the_map({}), "")
        for name in ("sea_floor", "sections", "echo_level"):
            title = area.draw(self.area(beyond=beyond), name).axes[0].get_title(loc="left")
            self.assertIn("20.1 km away", title.replace("\n", " "))
        told = self.labels(area.draw(self.area(bearings=72), "sections"))
        self.assertIn("towards 137.5°", told)
        self.assertIn("towards 145°", self.labels(area.draw(self.area(), "sections")))


class Geometry(Case):
    def test_depths_of_an_area_are_on_the_map(self):
        x = np.linspace(-5e3, 5e3, 41)
        depth = np.tile(np.where(x > 2.6e3, np.nan, -1000.0 * x / 4e3 + 500.0), (41, 1))
        track = np.zeros((1, 2, 3))
        things = {kind: scene.Things([kind], track + [0.0, where, 50.0])
                  for kind, where in (("platforms", 0.0), ("transmitters", 0.0), ("targets", 4e3))}
        sea = results.Sea(np.linspace(0.0, 5e3, 5), np.zeros(5), np.full(5, 500.0),
                          np.array([0.0, 500.0]), np.array([1500.0, 1500.0]))
        made = scene.Scene("made", sea, 1e3, 0.0, 5.0, 1, things, np.zeros(1), np.full(1, np.nan), [],
                           np.zeros(0), (np.zeros(0), np.zeros(0), False), "",
                           scene.Floor(x, x, depth, -20.0 + x / 6e4, 50.0 + x / 11e4))
        told = self.labels(scene_pictures.geometry(made))
        for words in ("depth of the sea floor / m", "land", "beyond the map: its edge goes on"):
            self.assertIn(words, told)
        # degrees on the frame, where the map has them
        axes = scene_pictures.geometry(made).axes[0]
        axes.figure.canvas.draw()
        over, beside = axes.child_axes
        (low, high), (south, north) = np.array(axes.get_xlim()) * 1e3, np.array(axes.get_ylim()) * 1e3
        np.testing.assert_allclose(over.get_xlim(), [-20.0 + low / 6e4, -20.0 + high / 6e4])
        np.testing.assert_allclose(beside.get_ylim(), [50.0 + south / 11e4, 50.0 + north / 11e4])
        made.floor = None
        bare = scene_pictures.geometry(made)
        self.assertNotIn("land", self.labels(bare))
        self.assertEqual(bare.axes[0].child_axes, [])

    def test_degrees_are_words(self):
        for value, places, words, told in ((-62.75, 2, "EW", "62.75° W"), (181.5, 1, "EW", "178.5° W"),
                                           (-0.001, 2, "NS", "0.00°"), (0.5, 1, "NS", "0.5° N"),
                                           (-33.0, 0, "NS", "33° S"), (180.0, 0, "EW", "180° W")):
            self.assertEqual(style.degree_text(value, places, words), told)

    def test_depths_have_their_numbers_within_the_picture(self):
        """A contour of four corners: its longest part inside; none of what is short or outside."""
        square = np.array([[x, 0.0] for x in range(11)] + [[10.0, y] for y in range(1, 11)])
        found = style.label_places([[square], [square[:2]], [square + 50.0]], lambda at: (at[:, 0] < 8.5), 3.0)
        self.assertEqual(found, [(4.0, 0.0)])
        x = np.linspace(-50.0, 50.0, 101)
        fig, axes = style.figure("contours")
        axes.set_xlim(-10.0, 10.0)
        axes.set_ylim(-10.0, 10.0)
        style.depth_lines(axes, x, x, np.tile(1000.0 + x, (101, 1)), [960.0, 1000.0, 1005.0],
                          inside=lambda at: (np.abs(at) < 9.0).all(axis=1))
        self.assertEqual(sorted(t.get_text() for t in axes.texts), ["1000", "1005"])
        for t in axes.texts:
            self.assertLess(np.abs(t.get_position()).max(), 10.0)

    def test_strokes_are_where_they_belong_and_can_be_seen(self):
        """All of a half plane, nothing of the other; in ink within a halo of paper."""
        for falling in (False, True):
            with style.look("dark"):
                fig, axes = style.figure("strokes")
                made = style.hatched(axes, lambda x, y: x + y > 1.0, 4.0, "there", 20, falling)
                self.assertEqual([h.get_label() for h in made], ["there"])
                strokes = axes.collections[0]
                self.assertEqual(to_hex(strokes.get_colors()[0]), style.INK)
                self.assertEqual(len(strokes.get_path_effects()), 1)
            ends = np.array(strokes.get_segments())
            self.assertGreaterEqual(ends.sum(axis=-1).min(), 1.0)
            self.assertLessEqual(np.abs(ends).max(), 4.0)
            slope = np.diff(ends, axis=1)[:, 0]
            np.testing.assert_allclose(slope[:, 1] / slope[:, 0], -1.0 if falling else 1.0)
        fig, axes = style.figure("none")
        self.assertEqual(style.hatched(axes, lambda x, y: x > 5.0, 4.0, "there"), [])


class Profiles(Case):
    """Of water that varies with range: those within the map, with that at its end."""

    def sea(self, map_end=np.inf):
        z = np.array([0.0, 100.0, 5000.0])
        speeds = np.array([1500.0, 1510.0, 1540.0])[:, None] + np.array([0.0, -10.0, 300.0])
        return results.Sea(np.linspace(0.0, 30e3, 5), np.zeros(5), np.full(5, 100.0), z[:2], speeds[0, :2],
                           np.array([0.0, 20e3, 40e3]), z, speeds, map_end)

    def test_none_is_beyond_the_map(self):
        for end, ranges, last in ((np.inf, [0.0, 20e3, 30e3], 1525.0), (10e3, [0.0, 10e3], 1505.0),
                                  (20e3, [0.0, 20e3], 1510.0), (0.0, [0.0], 1500.0)):
            found = seas.profiles(self.sea(end))
            self.assertEqual([r for r, _, _ in found], ranges)
            self.assertAlmostEqual(found[-1][2][0], last)

    def test_the_axis_is_that_of_the_water(self):
        """1500 to 1525 m/s between surface and bottom; the 1800 m/s of 5 km are below the axes."""
        fig, axes = style.figure("profile")
        seas.draw_profile(axes, self.sea())
        low, high = axes.get_xlim()
        self.assertTrue(1480.0 < low < 1490.0 and 1525.0 < high < 1535.0, (low, high))
        told = [t.get_text() for t in axes.get_legend().get_texts()]
        self.assertEqual(told, ["0 km", "20 km", "30 km"])

    def test_where_the_map_ends_is_told_within_the_axes_alone(self):
        for end, words in ((10e3, 1), (np.inf, 0), (50e3, 0)):
            fig, axes = style.figure("section")
            axes.set_xlim(0.0, 30.0)
            seas.draw_map_end(axes, self.sea(end))
            self.assertEqual(len([t for t in axes.texts if "the map ends" in t.get_text()]), words)


if __name__ == "__main__":
    unittest.main(verbosity=1)

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
from asdic_pictures import (bearing_time, levels, matched_filter, rays, style,  # noqa: E402
                            sweep)
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
    def labels(self, fig):
        return [t.get_text() for a in fig.axes if a.get_legend() for t in a.get_legend().get_texts()]

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


if __name__ == "__main__":
    unittest.main(verbosity=1)

#!/usr/bin/env python3
"""The pictures of what `asdic process` found: drawn for every kind of array, true to the file, left
out in words where there is nothing to show.

    ASDIC=build/ci/bin/asdic processed_pictures.py
"""
import contextlib
import io
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from unittest.mock import patch

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "tests" / "support")]

from asdic_pictures import (api, bearing_time, bearings, command, processed,  # noqa: E402
                            range_bearing, style)
from asdic_pictures.data import PingFile  # noqa: E402
from deep import DEEP  # noqa: E402
from text_layout import faults  # noqa: E402

style.TESTING.update({"figure.dpi": 100})    # quicker to draw
if not DEEP:    # where words stand is no matter of these tests, and takes half of the time
    style.TESTING["figure.constrained_layout.use"] = False
FOUND = ["ambiguity", "detections", "range_bearing", "tracks"]

SCENARIO = """
title = "a small sea"
[environment]
wind_speed = 5.0
[environment.sound_speed]
kind = "isovelocity"
speed = 1500.0
[environment.bottom]
depth = 1000.0
kind = "rigid"
[environment.absorption]
kind = "none"
[platform]
position = [0.0, 0.0, 200.0]
[transmitter]
source_level_db = 210.0
taper = "omnidirectional"
[pulse]
kind = "cw"
frequency = 1000.0
duration = 0.25
[array]
{array}
[[target]]
name = "rock"
position = [2000.0, 1500.0, 400.0]
velocity = [-5.0, 0.0, 0.0]
strength_db = 15.0
[noise]
spectral_level_db = 50.0
[reverberation]
enabled = false
[propagation]
max_surface_bounces = 0
max_bottom_bounces = 0
[pings]
count = 5
interval = 20.0
recording_duration = 5.0
sample_rate = 2500.0
"""
ARRAYS = {
    "horizontal": 'kind = "horizontal"\nphones = 8\nspacing = 0.75',
    "vertical": 'kind = "vertical"\nphones = 8\nspacing = 0.75',
    "volume": 'kind = "positions"\npositions = [' + ", ".join(
        f"[{np.sin(a):.3f}, {np.cos(a):.3f}, {z}]" for a in np.arange(6) * np.pi / 3
        for z in (-0.4, 0.4)) + "]",
    "one": 'kind = "horizontal"\nphones = 1\nspacing = 0.75',
}


MADE = {}  # the processed file of a scenario, a number of pings and options


class Case(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="asdic_processed_"))
        self.addCleanup(shutil.rmtree, self.folder, True)

    def made(self, scenario, pings, *options):
        """A copy of the file of a scenario, processed: each is simulated and processed once for all cases."""
        key = (scenario, pings, options)
        if key not in MADE:
            where = Path(tempfile.mkdtemp(prefix="asdic_processed_"))
            unittest.addModuleCleanup(shutil.rmtree, where, True)
            (where / "sea.toml").write_text(scenario)
            for words in (["ping", "sea.toml", "-o", "sea.h5", "-q", "--pings", str(pings)],
                          ["process", "sea.h5", "--target-depth", "400m", "-q", *options]):
                subprocess.run([os.environ["ASDIC"], *words], cwd=where, check=True)
            MADE[key] = where / "sea.h5"
        return Path(shutil.copy(MADE[key], self.folder))

    def make(self, array, *options):
        return self.made(SCENARIO.format(array=ARRAYS[array]), 5, *options)

    def plot(self, path, *options):
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = command.main([str(path), "-o", str(self.folder / "pictures"), *options])
        self.assertEqual((code, err.getvalue()), (0, ""))
        drawn = sorted(p.stem for p in (self.folder / "pictures").iterdir() if p.stem in FOUND)
        return drawn, out.getvalue()


class EveryPicture(Case):
    def test_of_a_horizontal_line(self):
        self.assertEqual(self.plot(self.make("horizontal"))[0], FOUND)

    def test_of_a_vertical_line(self):
        drawn, said = self.plot(self.make("vertical"))
        self.assertEqual(drawn, ["ambiguity", "detections", "tracks"])
        self.assertIn("range_bearing.png: left out, the array tells no bearing", said)

    def test_of_a_volume(self):
        self.assertEqual(self.plot(self.make("volume"))[0], FOUND)

    def test_of_one_phone(self):
        drawn, _ = self.plot(self.make("one"))
        self.assertEqual(drawn, ["ambiguity", "detections", "tracks"])

    def test_without_maps(self):
        drawn, said = self.plot(self.make("horizontal", "--no-maps"))
        self.assertEqual(drawn, ["tracks"])
        self.assertEqual(said.count("processed without maps"), 3)


class SeveralArrays(Case):
    """An upright array 300 m astern, a line to the north and one to the east."""

    ARRAYS = """[[array]]
name = "upright"
offset = [0.0, -300.0, 0.0]
kind = "vertical"
phones = 4
spacing = 0.75
[[array]]
name = "north line"
kind = "horizontal"
phones = 8
spacing = 0.75
[[array]]
name = "east line"
kind = "horizontal"
phones = 8
spacing = 0.75
heading_deg = 90.0
"""

    def make_several(self):
        return self.made(SCENARIO.format(array="@").replace("[array]\n@\n", self.ARRAYS), 1)

    def test_each_is_steered_alone(self):
        """On a line's axis a target is at the cosine of the angle between them. By a quarter of a
        beam, 1/8 of the cosine."""
        with PingFile(self.make_several()) as data:
            for name, along in (("north line", [0, 1, 0]), ("east line", [1, 0, 0])):
                data.select_array(data.choose_array(name))
                self.assertEqual(data.channels, 8)
                where, _, db = bearing_time.record(data, 0)
                self.assertEqual(where.kind, "horizontal")
                off = data.targets(0)[0][2] - data.phones(0).mean(axis=0)
                loud = np.unravel_index(np.nanargmax(db), db.shape)[0]
                axis = bearings.along(along)
                self.assertAlmostEqual(where.coordinate[loud], off @ axis / np.linalg.norm(off),
                                       delta=0.03)
            data.select_array(0)
            self.assertEqual((data.channels, bearing_time.record(data, 0)[0].kind), (4, "vertical"))

    def test_the_first_and_what_tells_bearings(self):
        drawn, said = self.plot(self.make_several())
        self.assertEqual(drawn, ["ambiguity", "detections", "range_bearing"])
        self.assertRegex(said, "bearing_time.png: .* upright\n")
        self.assertRegex(said, "range_bearing.png: .* north line\n")
        self.assertIn('3 arrays, "upright", "north line", "east line": --array NAME', said)

    def test_the_chosen_one(self):
        path = self.make_several()
        said = self.plot(path, "--array", "east line")[1]
        for name in ("pressure", "bearing_time", "detections", "range_bearing"):
            self.assertRegex(said, f"{name}.png: .* east line\n")
        out = subprocess.run([os.environ["ASDIC"], "plot", str(path), "--array", "west line"],
                             capture_output=True, text=True)
        self.assertEqual(out.returncode, 2)
        self.assertIn('found no array "west line", expected one of "upright", "north line", '
                      '"east line"', out.stderr)


    def test_apart_from_the_sender_a_delay_is_another_range_in_every_bearing(self):
        """300 m from the sender, both sides: where a delay and a beam meet, sound takes that long
        there and back by straight rays of 1500 m/s, to a table's step of ranges (10 ms)."""
        self.ARRAYS = self.ARRAYS.replace("kind", "offset = [300.0, 0.0, 0.0]\nkind").replace(
            "offset = [0.0, -300.0, 0.0]\n", "")
        path = self.make_several()
        drawn, _ = self.plot(path, "--array", "north line")
        self.assertIn("range_bearing", drawn)
        with PingFile(path) as data:
            data.select_array(1)
            m = processed.maps(data, 0)
            self.assertIsNone(m.range)
            self.assertEqual(len(m.beam_range), 2)
            centre = data.phones(0).mean(axis=0)
            for side, span in zip((1.0, -1.0), m.beam_range):
                across = side * np.array([m.axis[1], -m.axis[0], 0.0])
                for row, cosine in enumerate(m.angle):
                    look = cosine * m.axis + np.sqrt(max(0.0, 1.0 - cosine**2)) * across
                    known = np.isfinite(span[row])
                    place = centre + span[row][known, None] * look
                    place[:, 2] = 400.0
                    way = (np.linalg.norm(place - data.platform(0), axis=1)
                           + np.linalg.norm(place - centre, axis=1))
                    self.assertGreater(known.sum(), 100)
                    self.assertLess(np.abs(way / 1500.0 - m.time[known]).max(), 0.01)


def mapped(fig):
    """What the colour bars of a picture stand for."""
    return [m for a in fig.axes for m in (*a.images, *a.collections) if getattr(m, "colorbar", None)]


class OneConvention(Case):
    """A target at 53° true: there in every picture, whatever the array's heading."""

    def bearing_at(self, axis, place):
        """By the tick labels alone: places of a line are a·sin b + c·cos b."""
        ticks = [(p, np.radians(float(t.get_text().rstrip("°"))))
                 for p, t in zip(axis.get_ticklocs(), axis.get_ticklabels())]
        weights, *_ = np.linalg.lstsq(np.array([[np.sin(b), np.cos(b)] for _, b in ticks]),
                                      np.array([p for p, _ in ticks]), rcond=None)
        tried = np.radians(np.arange(0.0, 360.0, 0.1))
        middle = np.mean([np.exp(1j * b) for _, b in ticks])
        tried = tried[np.cos(tried - np.angle(middle)) >= -1e-9]      # of this side
        there = weights[0] * np.sin(tried) + weights[1] * np.cos(tried)
        return float(np.degrees(tried[np.argmin(np.abs(there - place))]))

    def test_in_all_pictures(self):
        """Sound comes from 5° below: 0.996 of the cosine. A beam of 8 phones is 13° wide."""
        true = np.degrees(np.arctan2(2000.0, 1500.0))
        for heading, second in ((0.0, False), (90.0, True), (200.0, False))[:3 if DEEP else 2]:
            scenario = SCENARIO.format(array=ARRAYS["horizontal"] + f"\nheading_deg = {heading}")
            with self.subTest(heading=heading), PingFile(self.made(scenario, 1)) as data:
                found = {}
                for name in ("bearing_time", "detections", "range_bearing"):
                    fig = api.of_ping(name, data)
                    axes = fig.axes[0]
                    other = axes.child_axes[0]
                    if name == "range_bearing":
                        axis = other.xaxis if second else axes.xaxis
                        star = next(x for x in axes.lines if x.get_marker() == "*")
                        ring = next(x for x in axes.lines if x.get_markersize() == 10)
                        found[name] = self.bearing_at(axis, star.get_xdata()[0])
                        found["ring"] = self.bearing_at(axis, ring.get_xdata()[0])
                    else:
                        axis = other.yaxis if second else axes.yaxis
                        box = axes.patches[0]
                        found[name] = self.bearing_at(axis, box.get_y() + 0.5 * box.get_height())
                    self.assertRegex(axis.get_label_text(), "^look bearing, true ")
                ring = found.pop("ring")
                for name, bearing in found.items():
                    self.assertAlmostEqual(bearing, true, delta=0.7, msg=name)
                self.assertAlmostEqual(ring, true, delta=8.0)


class WhatTheyShow(Case):
    def test_colours_reach_the_echo(self):
        """The target's echo is 45 dB over the background: nothing of it is clipped."""
        loud = SCENARIO.replace("strength_db = 15.0", "strength_db = 40.0")
        with PingFile(self.made(loud.format(array=ARRAYS["horizontal"]), 1)) as data:
            t = processed.detections(data, 0)
            snr = t["snr_db"][t["target"] == 0].max()
            self.assertGreater(snr, 40.0)
            for name in ("detections", "range_bearing"):
                fig = api.of_ping(name, data)
                self.assertTrue(mapped(fig))
                for one in mapped(fig):
                    self.assertGreaterEqual(one.get_clim()[1], snr, name)
                fig = api.of_ping(name, data, limits=(-5.0, 20.0))
                self.assertEqual({m.get_clim() for m in mapped(fig)}, {(-5.0, 20.0)})

    def test_every_kind_of_mark_has_a_look_of_its_own(self):
        """Sender and array apart: found, of no target, the transmitter's own sound."""
        t = {"target": np.array([-2.0, -1.0, 0.0])}
        _, axes = style.figure("marks")
        handles = processed.mark(axes, np.arange(3.0), np.arange(3.0), t, ["rock"])
        looks = {(h.get_marker(), h.get_markeredgecolor(), h.get_markersize()) for h in handles}
        self.assertEqual(len(looks), 3)
        self.assertNotIn("white", [h.get_markeredgecolor() for h in processed.legend(handles)])

    def test_words_can_be_read(self):
        """One array, and two sides of one that is apart from the sender."""
        apart = SCENARIO.format(array="offset = [900.0, 0.0, 0.0]\n" + ARRAYS["horizontal"])
        with patch.dict(style.TESTING, {"figure.constrained_layout.use": True}):
            for scenario in (SCENARIO.format(array=ARRAYS["horizontal"]), apart):
                with PingFile(self.made(scenario, 1)) as data:
                    for name in ("detections", "range_bearing"):
                        self.assertEqual(faults(api.of_ping(name, data)), [], name)
                    sides = len(processed.maps(data, 0).beam_range) or 1
                    self.assertEqual(len(api.of_ping("range_bearing", data).axes), sides + 1)

    def test_detections_lie_where_the_map_is_loud(self):
        """The target's detection, in its beam and column of the map: within one of either."""
        with PingFile(self.make("horizontal")) as data:
            m, t = processed.maps(data, 0), processed.detections(data, 0)
            mine = int(np.flatnonzero(t["target"] == 0)[0])
            row = np.argmin(np.abs(m.angle - m.angle_of(t)[mine]))
            column = np.argmin(np.abs(m.time - t["time"][mine]))
            near = m.beam_db[max(row - 1, 0): row + 2, max(column - 1, 0): column + 2]
            self.assertGreater(near.max(), t["snr_db"][mine] - 2.0)
            # The map's range at that time is the detection's, within a column.
            span = m.range[range_bearing.rising(m.range)]
            self.assertAlmostEqual(m.range[column], t["range"][mine], delta=2 * np.diff(span).max())

    def test_tracks_keep_to_the_truth(self):
        """The track of the target: 5 m/s to the west from 2 km east."""
        with PingFile(self.make("horizontal")) as data:
            mine = [t for t in processed.tracks(data) if t["target"][0] == 0 and t["side"][0] == 0]
            self.assertTrue(mine)
            last = {k: v[-1] for k, v in mine[0].items()}
            self.assertAlmostEqual(last["x"], 2000.0 - 5.0 * last["time"], delta=60.0)
            self.assertAlmostEqual(last["y"], 1500.0, delta=60.0)

    def test_left_over_pictures_are_removed(self):
        path = self.make("horizontal")
        self.plot(path)
        with h5py.File(path, "r+") as f:
            del f["processed"]
        drawn, said = self.plot(path)
        self.assertEqual(drawn, [])
        self.assertNotIn("is not processed", said)


if __name__ == "__main__":
    if not os.environ.get("ASDIC"):
        sys.exit("ASDIC names no program")
    unittest.main(verbosity=1)

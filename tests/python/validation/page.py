#!/usr/bin/env python3
"""The page of `asdic plot --html`: one file that asks no network and holds what the ping file does.

    ASDIC=build/ci/bin/asdic page.py

How it looks and answers in a browser is tested by tests/python/validation/page_in_browser.py.
"""
import base64
import html.parser
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "tests" / "support")]

import make_ping_file as synthetic  # noqa: E402
from asdic_page import content, page  # noqa: E402
from asdic_pictures import bearing_time, levels, processed, spectrogram  # noqa: E402
from asdic_pictures.data import PingFile  # noqa: E402

SCENARIO = """
title = "a small sea </script><script>alert(1)</script>"   # see https://example.org
[environment.sound_speed]
kind = "munk"
[environment.bottom]
depth = 5000.0
kind = "fluid"
speed = 1600.0
density = 1500.0
attenuation_db_per_wavelength = 0.2
[platform]
position = [0.0, 0.0, 200.0]
[transmitter]
source_level_db = 215.0
taper = "omnidirectional"
[pulse]
kind = "cw"
frequency = 1000.0
duration = 0.25
[array]
kind = "horizontal"
phones = 8
spacing = 0.75
[[target]]
name = "rock"
position = [2000.0, 1500.0, 400.0]
velocity = [-5.0, 0.0, 0.0]
strength_db = 15.0
[[target]]
name = "reef"
position = [1500.0, -900.0, 300.0]
strength_db = 15.0
[noise]
spectral_level_db = 50.0
[reverberation]
enabled = false
[pings]
count = 2
interval = 20.0
recording_duration = 5.0
sample_rate = 2500.0
"""


class Parts(html.parser.HTMLParser):
    """Tags with their attributes, and the text of styles and scripts."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.texts, self._inside = [], {}, None
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))
        if tag in ("script", "style"):
            self._inside = (tag, dict(attrs).get("id", ""))

    def handle_endtag(self, tag):
        if tag in ("script", "style"):
            self._inside = None

    def handle_data(self, text):
        if self._inside:
            self.texts[self._inside] = self.texts.get(self._inside, "") + text


def data_of(path) -> dict:
    return json.loads(Parts(path.read_text()).texts["script", "data"])


def values(packed) -> np.ndarray:
    """What the page's script makes of packed cells."""
    whole = np.frombuffer(base64.b64decode(packed["data"]), "<u2").astype(float)
    whole[whole == 65535] = np.nan
    return (packed["low"] + whole * packed["step"]).reshape(packed["rows"], packed["columns"])


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp(prefix="asdic_page_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder, True)
        (cls.folder / "sea.toml").write_text(SCENARIO)
        for words in (["ping", "sea.toml", "-o", "sea.h5", "-q"], ["process", "sea.h5", "-q"],
                      ["plot", "sea.h5", "--html"]):
            done = subprocess.run([os.environ["ASDIC"], *words], cwd=cls.folder, check=True,
                                  capture_output=True, text=True)
        cls.said, cls.path = done.stdout, cls.folder / "sea.html"
        cls.parts = Parts(cls.path.read_text())
        cls.data = data_of(cls.path)
        cls.file = PingFile(cls.folder / "sea.h5")
        cls.addClassCleanup(cls.file.file.close)

    def setUp(self):
        self.file.choose_ping(1)
        self.file.select_array(0)

    def image(self, name, view=0):
        return next(i for i in self.data["views"][view]["images"] if i["name"] == name)

    def test_one_file_that_asks_no_network(self):
        self.assertEqual(self.said, "sea.html: a page for a browser\n")
        active = ("script", "style", "img", "iframe", "object", "embed", "base")
        self.assertEqual([tag for tag, _ in self.parts.tags if tag in active],
                         ["style", "script", "script"])
        for tag, attributes in self.parts.tags:
            for name in ("src", "href", "action", "srcset", "data", "poster"):
                self.assertIn(attributes.get(name, "data:,"), ["data:,"], tag)
        policy = [attributes["content"] for _, attributes in self.parts.tags
                  if attributes.get("http-equiv") == "Content-Security-Policy"]
        self.assertEqual([p.split(";")[0] for p in policy], ["default-src 'none'"])
        text = self.path.read_text()
        written_by_us = text.replace(self.parts.texts["script", "data"], "")
        self.assertIn("https://", text)      # the scenario's own words stay what they are
        for word in ("http:", "https:", "//www", "@import", "url(", "fetch(", "XMLHttpRequest",
                     "import(", "WebSocket", "sendBeacon"):
            self.assertNotIn(word, written_by_us)

    def test_a_scenario_cannot_break_out_of_its_place(self):
        self.assertIn("</script><script>alert(1)", self.data["title"])
        self.assertNotIn("<script>alert", self.path.read_text())
        self.assertEqual(self.data["scenario"], SCENARIO)

    def test_what_is_on_it(self):
        views = self.data["views"]
        self.assertEqual([(v["ping"], v["array"]) for v in views], [(1, 0), (2, 0)])
        for view in views:
            self.assertEqual([i["name"] for i in view["images"]],
                             ["Bearing–time", "Detections", "Doppler–time", "Spectrogram"])
            self.assertIsNotNone(view["map"])
            self.assertIsNotNone(view["levels"])
        self.assertEqual(self.data["targets"], ["rock", "reef"])
        lines = SCENARIO.splitlines()
        self.assertEqual([lines[first + 1] for first, _ in self.data["tables"]],
                         ['name = "rock"', 'name = "reef"'])
        self.assertEqual([lines[end] for _, end in self.data["tables"]], ["[[target]]", "[noise]"])
        self.assertEqual(self.data["history"]["cells"]["rows"], 2)
        self.assertIn("samples of each phone are not here", " ".join(self.data["notes"]))

    def test_cells_are_those_of_the_pictures(self):
        """To half a step of 0.01 dB."""
        m = processed.maps(self.file, 0)
        for name, expected in (("Bearing–time", bearing_time.record(self.file, 0)[2]),
                               ("Spectrogram", spectrogram.record(self.file, 0)[2]),
                               ("Detections", m.beam_db), ("Doppler–time", m.doppler_db)):
            np.testing.assert_allclose(values(self.image(name)["cells"]), expected, atol=0.0051)
        other = values(self.image("Detections", 1)["cells"])
        self.assertGreater(np.abs(other - m.beam_db).max(), 1.0)
        curves = levels.curves(self.file, 0)
        for line in self.data["views"][0]["levels"]["lines"]:
            key = {"measured, all frequencies": "measured", "echo, all 2 targets": "echo"}.get(
                line["name"], line["name"])
            time, db = curves[key if key in curves else "in band"]
            np.testing.assert_allclose(np.array(line["y"], float), db, atol=0.0051)
            self.assertAlmostEqual(line["first"], time[0], 6)

    def test_truth_and_detections_are_those_of_the_file(self):
        with h5py.File(self.folder / "sea.h5") as f:
            echoes, found = f["echoes"], f["processed/detections"]
            for view in self.data["views"]:
                told = sorted(t for e in view["echoes"] for t in e["delay"])
                rows = echoes["ping"][()] == view["ping"]
                delay, level = echoes["delay"][()][rows], echoes["level_db"][()][rows]
                target = echoes["target"][()][rows]
                loud = [t for t, v, i in zip(delay, level, target)
                        if v >= level[target == i].max() - 20.0]
                np.testing.assert_allclose(told, sorted(loud), rtol=1e-7)
                mine = found["ping"][()] == view["ping"]
                self.assertGreater(mine.sum(), 0)
                np.testing.assert_allclose(view["detections"]["time"], found["time"][()][mine],
                                           rtol=1e-7)
                np.testing.assert_allclose(np.array(view["detections"]["bearing_deg"], float),
                                           found["bearing_deg"][()][mine], rtol=1e-6)

    def test_bearings_of_marks_are_true(self):
        """What the page's script makes of a mark's place is the bearing of the target."""
        for name in ("Bearing–time", "Detections"):
            panel = self.image(name)
            for mark, place in zip(panel["marks"], [(2000.0, 1500.0), (1500.0, -900.0)]):
                off = np.degrees(np.arccos(np.clip(-mark["y"][0], -1.0, 1.0)))
                both = [(panel["axis"]["ahead"] + side * off) % 360.0 for side in (1, -1)]
                true = np.degrees(np.arctan2(*place)) % 360.0
                # the sound comes a little from below, which draws it towards broadside
                self.assertLess(min(abs(b - true) for b in both), 2.0, (name, both, true))

    def test_times_along_eigenrays_are_those_of_the_model(self):
        """Of the target that rests: the other is elsewhere when it is struck. The drawn points of a
        ray are some 10 m apart, so that chords and trapezoids err by far less than 1 ms.
        """
        with h5py.File(self.folder / "sea.h5") as f:
            a = f["arrivals"]
            first = (a["ping"][()] == 1) & (a["leg"][()] == 0) & (a["target"][()] == 1)
            delays = a["delay"][()][first]
        times = [line["t"][-1] for line in self.data["rays"]["lines"] if line["target"] == 1]
        self.assertEqual(len(times), first.sum())
        self.assertGreater(len(times), 2)
        for time in times:
            self.assertLess(np.abs(delays - time).min(), 1e-3)

    def test_from_python(self):
        """A dataset of asdic.open makes the page that the program makes of the file."""
        package = Path(os.environ.get("ASDIC_BUILD", ROOT / "build" / "release")) / "python"
        if not any((package / "asdic").glob("_core*.so")):
            self.skipTest("no Python package was built")
        code = "import asdic; asdic.page(asdic.open('sea.h5'), 'python.html', ping=2)"
        subprocess.run([sys.executable, "-c", code], cwd=self.folder, check=True,
                       env=os.environ | {"PYTHONPATH": str(package)})
        made = data_of(self.folder / "python.html")
        self.assertEqual(made["views"], self.data["views"][1:])

    def test_every_script_is_in_it(self):
        files = {path.stem for path in (ROOT / "python" / "asdic_page" / "script").glob("*.js")}
        self.assertEqual(files, set(page.SCRIPTS))

    def test_never_over_what_is_not_ours(self):
        path = self.folder / "notes.html"
        path.write_text("<html>mine</html>")

        def run(*more):
            words = [os.environ["ASDIC"], "plot", "--html", "sea.h5", "--ping", "2", "-o", *more]
            return subprocess.run(words, cwd=self.folder, capture_output=True, text=True)
        refused = run("notes.html")
        self.assertEqual(refused.returncode, 2)
        self.assertIn("a file that asdic did not write", refused.stderr)
        self.assertEqual(path.read_text(), "<html>mine</html>")
        self.assertEqual(run("notes.html", "--force").returncode, 0)
        self.assertEqual([v["ping"] for v in data_of(path)["views"]], [2])
        page.write(self.file, path, 1)                    # a page of ours
        self.assertEqual([v["ping"] for v in data_of(path)["views"]], [1])
        self.assertEqual([p.name for p in self.folder.glob("*.part")], [])


    def test_into_a_folder(self):
        """-o NAME.html names the page; any other name is a folder, which is made. A file of that name is left alone."""
        def run(where):
            words = [os.environ["ASDIC"], "plot", "--html", "sea.h5", "-o", where]
            return subprocess.run(words, cwd=self.folder, capture_output=True, text=True)
        for where, made in (("pics", "pics/sea.html"), ("new/pics", "new/pics/sea.html"), ("pics", "pics/sea.html"),
                            ("named.html", "named.html")):
            done = run(where)
            self.assertEqual((done.returncode, done.stdout), (0, f"{made}: a page for a browser\n"), done.stderr)
            self.assertTrue((self.folder / made).is_file())
        (self.folder / "mine").write_text("mine")
        refused = run("mine")
        self.assertEqual(refused.returncode, 2)
        self.assertIn("mine: found a file, expected a folder", refused.stderr)
        self.assertEqual((self.folder / "mine").read_text(), "mine")

    def test_settings_of_matplotlib_that_are_none(self):
        """No window is opened and no backend needed, whatever the shell sets. Whatever keeps matplotlib from starting
        is reported in one line.
        """
        def run(**environment):
            words = [os.environ["ASDIC"], "plot", "sea.h5", "-o", "drawn", "--only", "levels", "--force"]
            return subprocess.run(words, cwd=self.folder, capture_output=True, text=True,
                                  env=os.environ | environment)
        for backend in ("nonsense", "TkAgg", "module://nowhere"):
            done = run(MPLBACKEND=backend)
            self.assertEqual((done.returncode, done.stderr), (0, ""), backend)
        (self.folder / "file").write_text("")
        self.assertEqual(run(MPLCONFIGDIR=str(self.folder / "file")).returncode, 0)  # another folder is used
        (self.folder / "settings").write_bytes(b"axes.grid: \xff\xfe\n")
        done = run(MATPLOTLIBRC=str(self.folder / "settings"))
        self.assertEqual(done.returncode, 1)
        self.assertNotIn("Traceback", done.stderr)
        self.assertRegex(done.stderr.splitlines()[-1], "^asdic plot: matplotlib does not start: ")


class Numbers(unittest.TestCase):
    def test_joined_cells_keep_the_largest(self):
        random = np.random.default_rng(1)
        cells = random.normal(size=(7, 11))
        cells[2, 5] = np.nan
        joined = content.most(cells, 2, 3)
        self.assertEqual(joined.shape, (4, 4))
        for r in range(4):
            for c in range(4):
                block = cells[2 * r: 2 * r + 2, 3 * c: 3 * c + 3]
                self.assertEqual(joined[r, c], np.nanmax(block))
        self.assertTrue(np.isnan(content.most(np.full((2, 3), np.nan), 2, 3)).all())

    def test_packed_values_come_back(self):
        cells = np.array([[-60.0, 0.004, np.nan], [48.2, 13.0, -np.inf]])
        back = values(content.packed(cells))
        np.testing.assert_allclose(back, np.where(np.isfinite(cells), cells, np.nan), atol=0.0051)
        self.assertTrue(np.isnan(values(content.packed(np.full((1, 2), np.nan)))).all())

    def test_a_thinned_line_stays_where_it_is(self):
        x = np.linspace(0.0, 1.0, 400)
        y = np.sin(9.0 * x) ** 3
        kept = content.needed(x, y, 2e-3)
        self.assertLess(len(kept), 100)
        # where it is steep, it is further off along y
        self.assertLess(np.abs(np.interp(x, x[kept], y[kept]) - y).max(), 2e-2)
        fewer = kept[::2]
        self.assertGreater(np.abs(np.interp(x, x[fewer], y[fewer]) - y).max(), 2e-2)

    def test_many_pings_are_chosen_from_end_to_end(self):
        folder = Path(tempfile.mkdtemp(prefix="asdic_page_"))
        self.addCleanup(shutil.rmtree, folder, True)
        synthetic.write(folder / "many.h5", synthetic.Settings(
            duration=1.0, sample_rate=2500.0, frequency=1000.0, pulse=0.1, phones=1, depth=500.0,
            water=1200.0, targets=[(500.0, 65.0, 60.0)], pings=30))
        with PingFile(folder / "many.h5") as file:
            made = page.text(file)
        data = json.loads(Parts(made).texts["script", "data"])
        pings = [v["ping"] for v in data["views"]]
        self.assertEqual((len(pings), pings[0], pings[-1]), (content.VIEWS, 1, 30))
        self.assertIn("12 of 30 pings", " ".join(data["notes"]))
        self.assertEqual(data["history"]["cells"]["rows"], 30)
        left_out = " ".join(data["views"][0]["left_out"])
        self.assertIn("one phone tells no direction", left_out)
        self.assertIn("Run asdic process", left_out)


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""How pictures are asked for and what they say of themselves: formats, metadata, themes, limits,
names; where directions are; that no words are cut off or lie over one another.
"""
import contextlib
import io
import re
import shutil
import sys
import tempfile
import unittest
import zlib
from pathlib import Path
from xml.etree import ElementTree

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "tests" / "support")]

import make_ping_file as synthetic  # noqa: E402
import matplotlib.image  # noqa: E402
from asdic_pictures import (api, bearing_time, bearings, command, levels, output,  # noqa: E402
                            pressure, signal, source, spectrogram, style, sweep)
from asdic_pictures.data import PingFile  # noqa: E402
from deep import DEEP  # noqa: E402
from text_layout import faults  # noqa: E402

SMALL = dict(duration=6.0, sample_rate=2500.0, frequency=1000.0, pulse=0.25, phones=8, spacing=0.75,
             depth=500.0, water=1200.0, targets=[(3000.0, 65.0, 60.0)], strength=30.0,
             target_speed=0.0, reverberation=False)


def plot(*arguments):
    """→ exit code, standard output, standard error"""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = command.main([str(a) for a in arguments])
    return code, out.getvalue(), err.getvalue()


class Case(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="asdic_options_"))
        self.addCleanup(shutil.rmtree, self.folder, True)
        self.written, self.pictures = 0, self.folder / "pictures"

    def write(self, **changes):
        self.written += 1       # an earlier one may be open
        self.file = self.folder / f"ping{self.written}.h5"
        synthetic.write(self.file, synthetic.Settings(**{**SMALL, **changes}))
        return self.file

    def open(self, **changes):
        data = PingFile(self.write(**changes))
        self.addCleanup(data.file.close)
        return data


class Formats(Case):
    """Each file is whole, by the rules of its format, and tells what it is of."""

    WORDS = ["--ping", "2", "--only", "levels", "--dpi", "80", "--program", "1.2.3"]
    drawn = None    # once for all

    def setUp(self):
        super().setUp()
        if Formats.drawn is None:
            where = Path(tempfile.mkdtemp(prefix="asdic_formats_"))
            unittest.addModuleCleanup(shutil.rmtree, where, True)
            synthetic.write(where / "ping.h5", synthetic.Settings(**{**SMALL, "pings": 2}))
            with h5py.File(where / "ping.h5", "r+") as f:
                f.attrs["title"] = "A – ping (of 2)"
            told = plot(where / "ping.h5", "-o", where / "pictures", "--format", "png,pdf,svg", *self.WORDS)
            Formats.drawn = where, told
        where, (code, self.said, err) = Formats.drawn
        self.assertEqual((code, err), (0, ""))
        self.file = where / "ping.h5"
        shutil.copytree(where / "pictures", self.pictures)

    def test_only_what_was_asked_for(self):
        self.assertEqual(sorted(p.name for p in self.pictures.iterdir()),
                         ["levels.pdf", "levels.png", "levels.svg"])
        self.assertEqual(len(self.said.splitlines()), 3)

    def test_png(self):
        content = (self.pictures / "levels.png").read_bytes()
        self.assertEqual(content[:8], output.SIGNATURE)
        at, told = 8, {}
        while at < len(content):
            size, kind = int.from_bytes(content[at:at + 4], "big"), content[at + 4:at + 8]
            body = content[at + 8:at + 8 + size]
            self.assertEqual(zlib.crc32(kind + body),
                             int.from_bytes(content[at + 8 + size:at + 12 + size], "big"))
            if kind == b"tEXt":
                key, _, value = body.partition(b"\0")
                told[key.decode()] = value.decode("latin-1")
            at += 12 + size
        self.assertEqual(kind, b"IEND")
        self.assertEqual(told, {"Software": "asdic 1.2.3", "Scenario": "A - ping (of 2)",
                                "Scenario-SHA256": "0" * 64, "Ping": "2",
                                "Title": "Level over time: echo, reverberation, noise"})
        image = matplotlib.image.imread(self.pictures / "levels.png")
        self.assertEqual(image.shape[1], 800)   # 10 inches

    def test_pdf(self):
        content = (self.pictures / "levels.pdf").read_bytes()
        self.assertTrue(content.startswith(b"%PDF-1."))
        self.assertTrue(content.rstrip().endswith(b"%%EOF"))
        start = int(re.search(rb"startxref\s+(\d+)\s+%%EOF", content)[1])
        self.assertEqual(content[start:start + 4], b"xref")
        rows = re.findall(rb"(\d{10}) \d{5} n", content[start:])
        self.assertGreater(len(rows), 5)
        for number, row in enumerate(rows, 1):      # the table leads to every object
            self.assertTrue(content[int(row):].startswith(b"%d 0 obj" % number), number)
        self.assertIn(b"/Creator (asdic 1.2.3)", content)
        for word in (b"Ping: 2", b"0" * 64):
            self.assertTrue(word in content or word.decode().encode("utf-16-be") in content, word)
        self.assertIn(b"/Subtype /Type0", content)   # fonts are in it, as outlines that can be edited

    def test_svg(self):
        root = ElementTree.parse(self.pictures / "levels.svg").getroot()
        self.assertEqual(root.tag, "{http://www.w3.org/2000/svg}svg")
        words = [e.text for e in root.iter() if e.text and e.text.strip()]
        self.assertIn("asdic 1.2.3", words)
        self.assertIn("Level over time: echo, reverberation, noise", words)
        self.assertTrue(any("Ping: 2" in w and "0" * 64 in w and "A – ping" in w for w in words))

    def test_the_same_numbers_make_the_same_file(self):
        before = {p.name: p.read_bytes() for p in self.pictures.iterdir()}
        self.assertEqual(plot(self.file, "-o", self.pictures, "--format", "svg,pdf,png", *self.WORDS)[0], 0)
        self.assertEqual(before, {p.name: p.read_bytes() for p in self.pictures.iterdir()})

    def test_what_is_the_users_stays(self):
        """Ours are known in each format; a paper that holds one of ours, and a drawing that was
        edited, are not ours.
        """
        for kind in output.FORMATS:
            self.assertTrue(output.is_ours(self.pictures / f"levels.{kind}"), kind)
        others = {
            "svg": (self.pictures / "levels.svg").read_bytes().replace(
                b"<svg ", b'<svg xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" ', 1),
            "pdf": b"%PDF-1.5\n1 0 obj\n<< /PTEX.InfoDict << /Creator (asdic 1.2.3) >> >>\nendobj\n"
                   b"2 0 obj\n<< /Creator (TeX) >>\nendobj\nxref\n0 0\n"
                   b"trailer\n<< /Info 2 0 R >>\nstartxref\n0\n%%EOF\n",
            "png": b"\x89PNG\r\n\x1a\n" + b"\0" * 40}
        for kind, content in others.items():
            path = self.pictures / f"levels.{kind}"
            path.write_bytes(content)
            code, _, err = plot(self.file, "-o", self.pictures, "--format", kind, "--only", "levels")
            self.assertEqual(code, 2)
            self.assertIn("asdic did not write", err)
            self.assertEqual(path.read_bytes(), content)

    def test_left_out_pictures_go_in_every_format(self):
        fig, _ = style.figure("of an earlier run")
        for kind in output.FORMATS:
            style.write(fig, self.pictures / f"matched_filter.{kind}")
        code, said, _ = plot(self.file, "-o", self.pictures, "--only", "matched_filter")
        self.assertEqual(code, 0)
        self.assertIn("left out, a tone has nothing to compress", said)
        self.assertEqual([p for p in self.pictures.iterdir() if "matched" in p.name], [])


class Words(Case):
    def test_wrong_ones_are_told(self):
        self.write()
        for words, told in ((("--only", "level"), '"level", expected one of rays, pressure'),
                            (("--format", "png,gif"), '"gif", expected one of png, pdf, svg'),
                            (("--dpi", "5"), "expected a number from 30 to 1200"),
                            (("--dpi", "many"), "expected a number from 30 to 1200"),
                            (("--theme", "blue"), "expected light or dark"),
                            (("--limits", "90:40"), "LOW below HIGH"),
                            (("--limits", "40"), "LOW:HIGH"),
                            (("--limits", "rays=0:1"), '"rays", expected one of pressure')):
            code, out, err = plot(self.file, "-o", self.pictures, *words)
            self.assertEqual((code, out), (2, ""), words)
            self.assertIn(words[0], err)
            self.assertIn(told, err)
            self.assertFalse(self.pictures.exists())

    def test_h5py_and_matplotlib_are_enough(self):
        self.write()
        self.assertEqual(plot(self.file, "-o", self.pictures, "--only", "rays")[0], 0)
        self.assertEqual({"xarray", "pandas", "asdic"} & set(sys.modules), set())

    def test_limits_are_obeyed(self):
        """Of all, of one, and of one beside all."""
        data = self.open()
        for name in ("bearing_time", "spectrogram"):
            fig = api.of_ping(name, data, limits=(41.0, 83.0))
            mapped = [i for a in fig.axes for i in (*a.images, *a.collections)
                      if getattr(i, "colorbar", None)]
            self.assertEqual({i.get_clim() for i in mapped}, {(41.0, 83.0)}, name)
        self.assertEqual(api.of_ping("levels", data, limits=(41.0, 83.0)).axes[0].get_ylim(), (41.0, 83.0))
        wish = command.wishes(command.arguments(["f", "--limits=-10:20,levels=0:90"]), self.folder)
        self.assertEqual((wish.limits_for("levels"), wish.limits_for("sweep")),
                         ((0.0, 90.0), (-10.0, 20.0)))

    def test_a_dark_page_is_dark_and_its_words_are_light(self):
        self.write()
        for theme, page, ink in (("light", 1.0, 0.3), ("dark", 0.12, 0.8)):
            code, _, err = plot(self.file, "-o", self.pictures, "--theme", theme, "--only", "levels")
            self.assertEqual((code, err), (0, ""))
            image = matplotlib.image.imread(self.pictures / "levels.png")[:, :, :3].mean(axis=2)
            self.assertAlmostEqual(float(np.median(image)), page, delta=0.05)
            title = image[: image.shape[0] // 14, : image.shape[1] // 3]
            extreme = title.min() if theme == "light" else title.max()
            self.assertLess(extreme, ink) if theme == "light" else self.assertGreater(extreme, ink)

    def test_a_notebooks_own_settings_are_left_alone(self):
        before = dict(matplotlib.rcParams)
        api.of_ping("levels", self.open(), theme="dark")
        self.assertEqual(before, dict(matplotlib.rcParams))
        self.assertEqual(style.PAPER, "white")


class Axes(Case):
    def test_pictures_are_drawn_on_the_callers_axes(self):
        from matplotlib.figure import Figure
        data = self.open()
        fig = Figure(figsize=(8, 8))
        one, two, three = fig.subplots(3)
        self.assertIs(api.of_ping("levels", data, one), fig)
        self.assertIs(api.of_ping("pressure", data, [two, three]), fig)
        self.assertTrue(one.lines and three.collections)
        self.assertIsNone(fig._suptitle)
        with self.assertRaisesRegex(ValueError, "axes: found 1, expected 2"):
            api.of_ping("pressure", data, one)


class InMemory(Case):
    """A dataset that answers as xarray's do gives the picture that its file gives."""

    class Variable:
        def __init__(self, values, attrs):
            self.values, self.attrs = values, attrs
            self.dtype, self.shape = values.dtype, values.shape

        def __getitem__(self, rows):
            return InMemory.Variable(self.values[rows], self.attrs)

    class Dataset:
        def __init__(self, path):
            self.variables, self.attrs, self.encoding = {}, {}, {}
            with h5py.File(path) as f:
                self.attrs |= f.attrs
                f.visititems(self.add)
            self.data_vars = self.variables

        def add(self, name, item):
            if isinstance(item, h5py.Group):
                self.attrs |= {f"{name}/{key}": value for key, value in item.attrs.items()}
            elif item.dtype.kind in "if":
                self.variables[name] = InMemory.Variable(np.asarray(item[()]), dict(item.attrs))

    def test_every_picture(self):
        self.write()
        dataset = self.Dataset(self.file)
        self.assertTrue(source.is_dataset(dataset))
        for name in ("rays", "levels") if not DEEP else api.OF_PINGS[:5]:
            pages = []
            for one in (str(self.file), dataset):
                fig = api.of_ping(name, one)
                fig.set_dpi(60)
                fig.canvas.draw()
                pages.append(np.asarray(fig.canvas.buffer_rgba()).copy())
            self.assertTrue(np.array_equal(*pages), name)

    def test_an_open_file_stays_open(self):
        self.write()
        with h5py.File(self.file) as f:
            one = api.of_ping("levels", f)
            self.assertTrue(f.id.valid)
            np.testing.assert_array_equal(one.axes[0].lines[0].get_ydata(),
                                          api.of_ping("levels", self.file).axes[0].lines[0].get_ydata())

    def test_complex_numbers_are_pairs(self):
        values = np.array([[1 + 2j, 3 - 4j]], np.complex64)
        member = source.Member(self.Variable(values, {}))
        self.assertEqual(member.shape, (1, 2, 2))
        np.testing.assert_array_equal(member[0, 1], [3.0, -4.0])
        np.testing.assert_array_equal(member[()], [[[1.0, 2.0], [3.0, -4.0]]])


def place_on(axis, bearing):
    """Where a true bearing is on an axis of pictures, by its tick labels alone: places of a line are
    a·sin b + c·cos b, which two of them tell.
    """
    ticks = [(p, np.radians(float(t.get_text().rstrip("°")))) for p, t in
             zip(axis.get_ticklocs(), axis.get_ticklabels())]
    rows = np.array([[np.sin(b), np.cos(b)] for _, b in ticks])
    weights, *_ = np.linalg.lstsq(rows, np.array([p for p, _ in ticks]), rcond=None)
    return float(weights @ [np.sin(np.radians(bearing)), np.cos(np.radians(bearing))])


class Directions(Case):
    def test_a_target_stands_at_its_true_bearing(self):
        """On the axis of its side, whatever the array's heading. Sound from an elevation e appears
        nearer to broadside, at cos e times the place."""
        cases = ((0.0, 290.0), (217.0, 65.0), (90.0, 120.0), (0.0, 65.0), (217.0, 200.0))
        for heading, bearing in cases if DEEP else cases[:2]:
            with self.subTest(heading=heading, bearing=bearing):
                data = self.open(heading=heading, targets=[(3000.0, bearing, 300.0)], depth=310.0)
                echo = data.echoes(0)[0]
                rise = np.abs(echo.direction[echo.strong(0.0, 9.0), 2])
                shrink = np.sqrt(1.0 - rise**2)
                fig = bearing_time.draw(data, 0)
                axes = fig.axes[0]
                second = bearings.side_of(bearings.along(signal.line_axis(data.phones(0))), bearing)
                axis = axes.child_axes[0].yaxis if second else axes.yaxis
                box = max(axes.patches, key=lambda p: p.get_height())
                middle = box.get_y() + 0.5 * box.get_height()
                exact = place_on(axis, bearing)
                self.assertGreater(shrink.min(), 0.8)
                self.assertTrue(shrink.min() - 1e-6 <= middle / exact <= shrink.max() + 1e-6,
                                (middle, exact, shrink))
                self.assertIn("look bearing, true", axes.get_ylabel())
                # and the beam that is loudest at the echo is there too, within half a beam
                where, edges, db = bearing_time.record(data, 0)
                middle_of_pulse = echo.delay[echo.strongest] + 0.5 * data.pulse_duration
                loud = where.coordinate[np.nanargmax(db[:, np.searchsorted(edges, middle_of_pulse) - 1])]
                self.assertAlmostEqual(loud, middle, delta=0.13)

    def test_ticks_are_round_apart_and_right(self):
        """Of lines in every direction: each tick's label is a bearing of its side, at its place."""
        for heading in np.arange(0.0, 360.0, 7.0):
            b = np.radians(heading)
            axis = bearings.along([np.sin(b), np.cos(b), 0.0])
            for second in (False, True):
                places, labels = bearings.ticks(axis, second)
                self.assertGreaterEqual(len(places), 5)
                self.assertGreaterEqual(np.diff(places).min(), 0.149)
                for at, label in zip(places, labels):
                    bearing = float(label.rstrip("°"))
                    self.assertEqual(bearing % 15, 0)
                    self.assertAlmostEqual(at, np.cos(np.radians(bearing - np.degrees(
                        np.arctan2(axis[0], axis[1])))), places=9)
                    if abs(at) < 0.99:
                        self.assertEqual(bool(bearings.side_of(axis, bearing)), second)

    def test_sides_are_called_by_the_compass(self):
        for heading, first, second in ((0, "east", "west"), (180, "east", "west"),
                                       (90, "south", "north"), (45, "south-east", "north-west")):
            b = np.radians(heading)
            axis = bearings.along([np.sin(b), np.cos(b), 0.0])
            self.assertEqual((bearings.side(axis, False), bearings.side(axis, True)), (first, second))


class Truth(Case):
    def test_marks_last_as_long_as_the_pulse(self):
        """From the leading edge of the first strong path to a pulse after the last."""
        data = self.open(pings=2)
        echo = data.echoes(0)[0]
        strong = echo.delay[echo.strong(data.start, 1e9)]
        first, last = strong.min(), strong.max() + 0.25
        boxes = bearing_time.draw(data, 0).axes[0].patches
        self.assertAlmostEqual(min(b.get_x() for b in boxes), first, places=9)
        self.assertAlmostEqual(max(b.get_x() + b.get_width() for b in boxes), last, places=9)
        for module in (levels, spectrogram, pressure):
            axes = module.draw(data, 0).axes[0]
            bars = np.concatenate([s[:, 0] for c in axes.collections
                                   if isinstance(c, matplotlib.collections.LineCollection)
                                   for s in c.get_segments()])
            self.assertAlmostEqual(bars.min(), first, places=9, msg=module.__name__)
            self.assertAlmostEqual(bars.max(), last, places=9, msg=module.__name__)
        axes = sweep.draw(data, 0).axes[0]
        self.assertEqual([b.get_width() for b in axes.patches], [0.25, 0.25])
        self.assertEqual(axes.patches[0].get_x(), echo.delay[echo.strongest])


class Gather(Case):
    def test_every_phone_has_a_row(self):
        """Up to 16 as traces, more as levels; a phone that is louder stands out in its own row."""
        for phones in (8, 40):
            data = self.open(phones=phones, noise_level=50.0)
            axes = pressure.draw(data, 0).axes[0]
            self.assertEqual(axes.get_ylabel(), "phone")
            if phones <= pressure.MOST_TRACES:
                rows = [c.get_datalim(axes.transData) for c in axes.collections
                        if isinstance(c, matplotlib.collections.PolyCollection)]
                self.assertEqual(len(rows), phones)
                for k, row in enumerate(rows):
                    self.assertLess(max(abs(row.y0 - k), abs(row.y1 - k)), 0.5)
            else:
                self.assertEqual(axes.images[0].get_array().shape[0], phones)


class Layout(Case):
    """No words leave the page, none lie over others: long titles, many targets, several pings."""

    def check(self, fig, name):
        self.assertEqual(faults(fig), [], name)

    def test_pictures_of_a_ping(self):
        data = self.open(pings=2, bandwidth=100.0, targets=[(2500.0, 40.0, 60.0), (3200.0, 100.0, 200.0)],
                         elevations=[5.0, 8.0])
        data.title = "A vehicle at 4500 m in the Sargasso Sea, far from everything, and a target at 125 m " \
                     "of depth and 25 km that nobody has ever seen, with a title that goes on and on"
        data.target_names = ["the first of the targets, a long one", "the second"]
        names = ("rays", "bearing_time", "levels", "matched_filter", "pressure", "spectrogram", "sweep")
        for name in names if DEEP else names[:4]:
            fig = api.of_ping(name, data)
            self.check(fig, name)
            words = " ".join(a.get_title(loc="left") for a in fig.axes).replace("\n", " ")
            self.assertIn("goes on and on", words, name)     # not cut off

    def test_one_phone_and_many(self):
        for phones in (1, 40):
            self.check(api.of_ping("pressure", self.open(phones=phones)), phones)


if __name__ == "__main__":
    unittest.main(verbosity=1)

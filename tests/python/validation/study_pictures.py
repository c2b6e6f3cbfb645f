#!/usr/bin/env python3
"""The pictures of a study: each is drawn, shows what the file holds, and fits; bad input is told
plainly. The file is made here, in the form of docs/formats/study-results.md.
"""
import contextlib
import io
import json
import re
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "tests" / "support")]

import matplotlib  # noqa: E402

matplotlib.use("Agg")
import matplotlib.image  # noqa: E402
from asdic_pictures import command, study_data, study_pictures, style  # noqa: E402
from text_layout import faults  # noqa: E402

style.TESTING.update({"figure.dpi": 100})    # quicker to draw

INPUTS = {"range": "m", "wind_speed": "m/s", "kind": "1"}
MEASURES = {"echo_level_db": "dB re 1 µPa", "detected": "1", "bearing_error_deg": "degrees"}


def plot(*arguments):
    """→ exit code, standard output, standard error"""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = command.main([str(a) for a in arguments])
    return code, out.getvalue(), err.getvalue()


def table(f, name, title, **columns):
    """A table of the summary; a column is its values, or (values, unit), or (values, unit, labels)."""
    group = f.create_group(f"summary/{name}")
    group.attrs["title"] = title
    group.attrs.create("columns", list(columns), dtype=h5py.string_dtype())
    for key, column in columns.items():
        column = column if isinstance(column, tuple) else (column,)
        values, unit, labels = (*column, *("1", None)[len(column) - 1:])
        group[key] = np.asarray(values, float)
        group[key].attrs.update(units=unit, long_name=key)
        if labels:
            group[key].attrs.create("labels", labels, dtype=h5py.string_dtype())


def estimate(name, value, half=0.1):
    value = np.asarray(value, float)
    return {name: value, f"{name}_low": value - half, f"{name}_high": value + half}


def write(path, rows=400, skipped=0, inputs=INPUTS, complete=True):
    """Detection falls from 0.9 at 10 km to 0.1 at 40 km; the echo's level by 20 dB over that."""
    random = np.random.default_rng(1)
    with h5py.File(path, "w") as f:
        f.attrs.update(filetype="asdic study", version="1.0", title="a search", complete=int(complete))
        f["index"], valid = np.arange(rows), np.ones(rows, "i1")
        valid[:skipped] = 0
        f["valid"] = valid
        for name, unit in (*inputs.items(), *MEASURES.items()):
            values = {"range": random.uniform(10e3, 40e3, rows), "kind": np.arange(rows) % 3,
                      "detected": np.arange(rows) % 2}.get(name, random.normal(50.0, 5.0, rows))
            d = f.create_dataset(f"table/{name}", data=np.asarray(values, float))
            d.attrs.update(units=unit, long_name=name,
                           role="measure" if name in MEASURES else "input")
            if name == "kind":
                d.attrs.create("labels", ["cw", "lfm", "hfm"], dtype=h5py.string_dtype())
        r, pd = np.array([15e3, 25e3, 35e3]), [0.9, 0.5, 0.1]
        bins = {"range": (r, "m"), "range_low": (r - 5e3, "m"), "range_high": (r + 5e3, "m"),
                "count": np.full(3, rows / 3)}
        table(f, "pd_by_range", "", **bins, **estimate("pd", pd))
        table(f, "means_by_range", "", **bins, **estimate("echo_level_db", [60.0, 50.0, 40.0], 2.0))
        table(f, "pd_by_kind", "", kind=([0, 1, 2], "1", ["cw", "lfm", "hfm"]),
              count=np.full(3, rows / 3), **estimate("pd", [0.4, 0.5, 0.6]))
        grid = [np.repeat(r, 2), np.tile([3.0, 9.0], 3)]
        table(f, "pd_by_range_and_wind_speed", "", range=(grid[0], "m"),
              range_low=(grid[0] - 5e3, "m"), range_high=(grid[0] + 5e3, "m"),
              wind_speed=(grid[1], "m/s"), wind_speed_low=(grid[1] - 3, "m/s"),
              wind_speed_high=(grid[1] + 3, "m/s"), count=np.full(6, rows / 6),
              **estimate("pd", [0.95, 0.85, 0.6, 0.4, 0.2, 0.0]))
        pfa = np.geomspace(1e-4, 1.0, 30)
        table(f, "roc", "", threshold=-pfa, pfa=pfa, **estimate("pd", pfa ** 0.2, 0.05))
        count = np.unique(np.geomspace(2, rows, 20).astype(int))
        table(f, "convergence", "", count=count, **estimate("pd", 0.5 + 0.3 / count))
        pairs = [(m, i) for m in range(len(MEASURES)) for i in range(len(inputs))]
        table(f, "sensitivity", "", measure=([m for m, _ in pairs], "1", list(MEASURES)),
              input=([i for _, i in pairs], "1", list(inputs)),
              first_order=np.linspace(-0.01, 0.9, len(pairs)),
              rank_correlation=np.linspace(-0.9, 0.9, len(pairs)))


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.file = self.folder / "study.h5"

    def figure(self, wanted, **options):
        """That one picture; the others are drawn by EveryPictureIsDrawn."""
        write(self.file, **options)
        for name, fig in study_pictures.draw(study_data.read(str(self.file)), [wanted]):
            if name == wanted:
                return fig
        self.fail(f"no picture {wanted}")

    def texts_apart(self, axes):
        """No two words of an axis of names, nor two numbers of a map, lie over one another."""
        axes.figure.canvas.draw()
        boxes = [t.get_window_extent() for t in axes.texts if t.get_text().strip()]
        for i, one in enumerate(boxes):
            for other in boxes[:i]:
                self.assertFalse(one.overlaps(other))


class Honest(Case):
    """Intervals are named, depth is down, what is constant is left out, the ROC goes on to where the
    threshold is.
    """

    def test_the_confidence_level_is_told(self):
        write(self.file)
        with h5py.File(self.file, "r+") as f:
            f["summary"].attrs["confidence"] = 0.9
        study = study_data.read(str(self.file))
        for name, fig in study_pictures.draw(study):
            words = " ".join(t.get_text() for t in fig.findobj(matplotlib.text.Text))
            if name not in ("histograms", "sensitivity"):   # without intervals
                self.assertIn("90 % confidence", words.replace("\n", " "), name)

    def test_numbers_are_in_the_unit_that_the_axis_names(self):
        """For places 12 and 14 km away an axis in km reads 12 and 14: along one input, over two, and while the
        estimate settles.
        """
        write(self.file)
        with h5py.File(self.file, "r+") as f:
            del f["summary/means_by_range"], f["summary/convergence"]
            r = np.array([15e3, 35e3])
            bins = {"range": (r, "m"), "range_low": (r - 10e3, "m"), "range_high": (r + 10e3, "m"),
                    "count": np.full(2, 200.0)}
            place = {f"place_east{end}": (np.array([12e3, 14e3]) + more, "m")
                     for end, more in (("", 0.0), ("_low", -500.0), ("_high", 500.0))}
            table(f, "means_by_range", "", **bins, **place)
            table(f, "convergence", "", count=np.array([2.0, 400.0]), **place)
            wind = {"wind_speed": ([3.0, 9.0, 3.0, 9.0], "m/s"), "range": (np.repeat(r, 2), "m"),
                    "count": np.full(4, 100.0)}
            table(f, "means_by_range_and_wind_speed", "", **{k: wind[k] for k in ("range", "wind_speed", "count")},
                  **{k: (np.tile(v, 2), unit) for k, (v, unit) in place.items()})
        study = study_data.read(str(self.file))
        seen = 0
        wanted = ["means_by_range", "means_by_range_and_wind_speed", "convergence"]
        for name, fig in study_pictures.draw(study, wanted):
            for axes in fig.axes:
                for axis, ends in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, axes.get_ylim())):
                    if axis.get_label_text().endswith("/ km"):
                        seen += 1
                        self.assertLessEqual(max(ends), 50.0, (name, axis.get_label_text()))
                        self.assertGreater(max(ends), 10.0, (name, axis.get_label_text()))
        self.assertGreaterEqual(seen, 5)

    def orders(self):
        """Of two measures and three inputs: first orders, totals that are 0.2 more, and pairs."""
        write(self.file)
        with h5py.File(self.file, "r+") as f:
            del f["summary/sensitivity"]
            names, measures = ["season", "depth", "chance"], ["echo_level_db", "detected"]
            first = np.array([0.3, 0.1, -0.01, 0.0, 0.05, 0.2])
            where = dict(measure=(np.repeat([0, 1], 3), "1", measures),
                         input=(np.tile([0, 1, 2], 2), "1", names))
            table(f, "sensitivity", "", **where, count=np.full(6, 200.0),
                  **estimate("first_order", first, 0.04), **estimate("total_order", first + 0.2, 0.06),
                  unexplained=np.repeat([0.61, 0.75], 3))
            where["with"] = ([1, 2, 2, 1, 2, 2], "1", names)
            where["input"] = ([0, 0, 1, 0, 0, 1], "1", names)
            table(f, "interactions", "", **where, count=np.full(6, 200.0),
                  **estimate("second_order", np.array([0.4, 0.02, 0.0, 0.1, 0.3, 0.0]), 0.05))
        return study_data.read(str(self.file))

    def test_first_and_total_order_stand_side_by_side(self):
        """Each input has two bars, as long as the table says, with their intervals; most first."""
        figures = dict(study_pictures.draw(self.orders(), ["sensitivity", "interactions"]))
        axes = figures["sensitivity"].axes
        self.assertEqual(len(axes), 2)
        level = axes[0]
        self.assertEqual([t.get_text() for t in level.get_yticklabels()], ["season", "depth", "chance"])
        np.testing.assert_allclose([b.get_width() for b in level.patches], [0.3, 0.1, 0.0, 0.5, 0.3, 0.19])
        low, high = zip(*(segment[:, 0] for c in level.collections for segment in c.get_segments()))
        np.testing.assert_allclose(low, [0.26, 0.06, 0.0, 0.44, 0.24, 0.13])  # none below 0
        np.testing.assert_allclose(high, [0.34, 0.14, 0.03, 0.56, 0.36, 0.25])
        self.assertIn("of no input alone: 0.61", level.get_xlabel())
        words = " ".join(t.get_text() for t in figures["sensitivity"].findobj(matplotlib.text.Text))
        self.assertIn("confidence interval, 200 blocks", words.replace("\n", " "))
        pairs = [t.get_text() for t in figures["interactions"].axes[1].get_yticklabels()]
        self.assertEqual(pairs[0], "season × chance")

    def test_depth_grows_downwards(self):
        write(self.file)
        with h5py.File(self.file, "r+") as f:
            del f["summary/pd_by_range_and_wind_speed"]
            r = np.array([15e3, 25e3])
            table(f, "pd_by_range_and_depth", "", range=(np.repeat(r, 2), "m"),
                  depth=(np.tile([50.0, 150.0], 2), "m"), count=np.full(4, 100.0),
                  **estimate("pd", [0.9, 0.8, 0.4, 0.3]))
            table(f, "means_by_kind", "", kind=([0, 1], "1", ["cw", "lfm"]), count=np.full(2, 9.0),
                  **{k: (v, "m") for k, v in estimate("depth", [90.0, 120.0], 9.0).items()})
        figures = dict(study_pictures.draw(study_data.read(str(self.file)),
                                           ["pd_by_range_and_depth", "means_by_kind"]))
        for fig in figures.values():
            bottom, top = fig.axes[0].get_ylim()
            self.assertGreater(bottom, top)
        self.assertEqual(len(figures), 2)

    def test_what_is_constant_is_left_out_and_told(self):
        write(self.file)
        with h5py.File(self.file, "r+") as f:
            table(f, "pfa_by_range", "", range=([15e3, 25e3], "m"), count=np.full(2, 9.0),
                  **estimate("pfa", [0.0, 0.0]))
            f["table/detected"][...] = 1.0
        study = study_data.read(str(self.file))
        figures = dict(study_pictures.draw(study))
        self.assertNotIn("pfa_by_range", figures)
        self.assertEqual(study_pictures.left_out(study),
                         {"pfa_by_range": "probability of false alarm is 0 everywhere"})
        self.assertNotIn("detected", [a.get_xlabel() for a in figures["histograms"].axes])
        rows = [t.get_text() for t in figures["sensitivity"].axes[0].get_yticklabels()]
        self.assertEqual(rows, ["echo level", "bearing error"])
        code, out, _ = plot(self.file, "-o", self.folder / "pictures")
        self.assertEqual(code, 0)
        self.assertRegex(out, "pfa_by_range.png: left out, probability of false alarm is 0 everywhere")

    def test_the_roc_reaches_the_threshold(self):
        """Swerling 1 at 10 dB in exponential noise: P_d = P_fa^(1/(1 + SNR)), to a factor of 10 below
        what 2000 rows can count, within three deviations of the tail's fit (a twentieth of its 200
        values' mean, in the exponent) and of P_d.
        """
        random = np.random.default_rng(3)
        n, asked = 2000, 5e-5
        write(self.file, rows=n)
        absent, present = random.exponential(1.0, n), random.exponential(11.0, n)
        threshold = -np.log(asked)
        with h5py.File(self.file, "r+") as f:
            for name, values in (("snr_absent_db", 10 * np.log10(absent)),
                                 ("snr_matched_db", 10 * np.log10(present))):
                f[f"table/{name}"] = values
                f[f"table/{name}"].attrs.update(units="dB", long_name=name, role="measure")
            f["table/detected"][...] = present > threshold
            f["study"] = f"[measure]\ndetection = {{ false_alarm_probability = {asked} }}\n"
            del f["summary/roc"]
            pfa = np.arange(1, n, 10) / n
            at = np.quantile(absent, 1.0 - pfa)
            table(f, "roc", "", threshold_db=at, pfa=pfa,
                  **estimate("pd", (present[None] > at[:, None]).mean(axis=1), 0.02))
        fig = dict(study_pictures.draw(study_data.read(str(self.file)), ["roc"]))["roc"]
        axes = fig.axes[0]
        self.assertLess(axes.get_xlim()[0], asked)
        dashed = next(x for x in axes.lines if "exponential law" in str(x.get_label()))
        pfa, pd = dashed.get_data()
        self.assertLess(pfa.min(), asked)
        exact = pfa ** (1.0 / 11.0)
        self.assertLess(np.abs(pd - exact).max(), 3 * (0.5 / np.sqrt(n) + 0.05 * 7 / 11 * exact.max()))
        words = " ".join(t.get_text() for t in axes.get_legend().get_texts())
        self.assertRegex(words, r"operating point, Pfa 5e-05, Pd 0\.\d+")

    def test_words_are_said_once(self):
        self.assertEqual(study_data.spoken("bottom_bottom_depth"), "bottom depth")
        self.assertEqual(study_data.spoken("bottom_bottom"), "bottom")
        column = study_data.Column("depth", "m", "target.0.depth: depth below the mean surface",
                                   np.array([1.0, 2.0]))
        self.assertEqual(column.label(), "target depth / m")

    def test_words_can_be_read(self):
        write(self.file)
        with h5py.File(self.file, "r+") as f:
            f.attrs["title"] = "a search of everything that there is in a sea of which little is known, " \
                               "by a sonar of which nobody knows much either"
        for name, fig in study_pictures.draw(study_data.read(str(self.file))):
            self.assertEqual(faults(fig), [], name)
            words = " ".join(t.get_text() for t in fig.findobj(matplotlib.text.Text))
            self.assertIn("much either", re.sub(r"\s+", " ", words), name)   # not cut off


class MoreMeasuresThanPanels(Case):
    def test_what_is_left_out_is_told(self):
        write(self.file)
        names = [f"path_{k}" for k in range(10)] + ["series_rms_db", "echo_level_db",
                                                    "position_error", "range_error",
                                                    "bearing_error_deg"]
        with h5py.File(self.file, "r+") as f:
            del f["summary/means_by_range"]
            columns = {}
            for name in names:
                columns.update(estimate(name, [3.0, 2.0, 1.0]))
            table(f, "means_by_range", "", range=([15e3, 25e3, 35e3], "m"),
                  count=np.full(3, 100.0), **columns)
        fig = dict(study_pictures.draw(study_data.read(str(self.file))))["means_by_range"]
        self.assertEqual(len(fig.axes), 12)
        self.assertIn("12 of 15 measures", fig._suptitle.get_text())
        self.assertTrue(any("osition error" in a.get_ylabel() for a in fig.axes))


class EveryPictureIsDrawn(Case):
    def test_all_of_them(self):
        write(self.file)
        code, out, err = plot(self.file, "-o", self.folder / "pictures")
        self.assertEqual((code, err), (0, ""))
        names = ["convergence", "histograms", "means_by_range", "pd_by_kind", "pd_by_range",
                 "pd_by_range_and_wind_speed", "roc", "sensitivity"]
        pictures = sorted((self.folder / "pictures").iterdir())
        self.assertEqual([p.name for p in pictures], [f"{n}.png" for n in names])
        for path in pictures:
            self.assertIn(f"{path}: ", out)
            image = matplotlib.image.imread(path)[:, :, :3]
            self.assertGreaterEqual(min(image.shape[:2]), 380, path)
            self.assertGreater(image.std(), 0.02, path)

    def test_a_summary_that_was_not_asked_for(self):
        write(self.file)
        with h5py.File(self.file, "r+") as f:
            for name in list(f["summary"]):
                del f["summary"][name]
        code, out, err = plot(self.file, "-o", self.folder / "pictures")
        self.assertEqual((code, err), (0, ""))
        self.assertEqual([p.name for p in (self.folder / "pictures").iterdir()], ["histograms.png"])


class WhatThePicturesShow(Case):
    def test_probabilities_stand_over_the_middles_of_their_bins(self):
        axes = self.figure("pd_by_range").axes[0]
        np.testing.assert_allclose(axes.lines[0].get_xydata(), [[15, 0.9], [25, 0.5], [35, 0.1]])
        self.assertEqual(axes.get_xlim(), (10.0, 40.0))  # kilometres, all of the bins
        self.assertEqual(axes.get_xlabel(), "range / km")
        self.assertEqual(axes.get_ylabel(), "probability of detection")
        low, high = axes.get_ylim()
        self.assertLess(low, 0.0)
        self.assertGreaterEqual(high, 1.0)

    def test_the_band_is_the_interval(self):
        axes = self.figure("pd_by_range").axes[0]
        outline = axes.collections[0].get_paths()[0].vertices
        np.testing.assert_allclose([outline[:, 1].min(), outline[:, 1].max()], [0.0, 1.0], atol=1e-12)

    def test_names_are_ticks(self):
        axes = self.figure("pd_by_kind").axes[0]
        self.assertEqual([t.get_text() for t in axes.get_xticklabels()], ["cw", "lfm", "hfm"])

    def test_a_map_has_its_cells_where_they_belong(self):
        fig = self.figure("pd_by_range_and_wind_speed")
        mesh = fig.axes[0].collections[0]
        np.testing.assert_allclose(np.ma.filled(mesh.get_array()).reshape(2, 3),
                                   [[0.95, 0.6, 0.2], [0.85, 0.4, 0.0]])  # wind upwards
        self.assertEqual(fig.axes[0].get_ylabel(), "wind speed / m/s")
        self.texts_apart(fig.axes[0])

    def test_a_histogram_has_its_law_over_it(self):
        write(self.file)
        with h5py.File(self.file, "r+") as f:
            even = np.linspace(10e3, 40e3, 7)
            f["laws/range/value"], f["laws/range/density"] = even, np.full(7, 1.0 / 30e3)
            f["laws/range/cumulative"] = (even - 10e3) / 30e3
            f["laws/kind/value"] = np.arange(3.0)
            f["laws/kind/probability"], f["laws/kind/cumulative"] = [0.5, 0.25, 0.25], [0.5, 0.75, 1]
        (_, fig), = study_pictures.draw(study_data.read(str(self.file)), ["histograms"])
        lines = {a.get_xlabel(): a.patches[-1].get_data() for a in fig.axes
                 if a.get_xlabel() in ("range / km", "kind")}
        np.testing.assert_allclose(lines["kind"].values, [200.0, 100.0, 100.0])
        values, edges, _ = lines["range / km"]
        np.testing.assert_allclose(values, 400 * np.diff(edges) / 30.0)  # in km
        words = " ".join(t.get_text() for t in fig.findobj(matplotlib.text.Text))
        self.assertIn("their laws (black)", words)

    def test_units_are_not_said_twice(self):
        axes = self.figure("histograms").axes
        labels = [a.get_xlabel() for a in axes]
        self.assertIn("bearing error / degrees", labels)
        self.assertIn("echo level / dB re 1 µPa", labels)

    def test_a_heading_says_what_is_missing(self):
        write(self.file, skipped=3, complete=False)
        self.assertEqual(study_data.read(str(self.file)).heading(),
                         "a search · 400 realisations (3 skipped, not complete)")

    def test_columns_come_as_the_study_has_them(self):
        write(self.file)
        with h5py.File(self.file, "r+") as f:
            f["manifest"] = json.dumps({"columns": [{"name": n} for n in ("range", "wind_speed", "kind")]})
        self.assertEqual([c.name for c in study_data.read(str(self.file)).columns][:3],
                         ["range", "wind_speed", "kind"])

    def test_columns_that_do_not_fit_are_counted(self):
        many = {f"input_{i}": "m" for i in range(12)}
        fig = self.figure("histograms", inputs=many)
        self.assertEqual(len(fig.axes), 12)
        self.assertIn("12 of 15 columns", fig._suptitle.get_text())

    def test_numbers_of_many_inputs_have_room(self):
        for count in (3, 6, 7, 12):
            with self.subTest(count=count):
                fig = self.figure("sensitivity", inputs={f"input_{i}": "m" for i in range(count)})
                for axes in fig.axes[:2]:
                    self.texts_apart(axes)


class BadInput(Case):
    def refused(self, words):
        code, out, err = plot(self.file, "-o", self.folder / "pictures")
        self.assertEqual((code, out), (2, ""), err)
        self.assertEqual(len(err.strip().splitlines()), 1, err)
        self.assertRegex(err, words)

    def test_nothing_valid(self):
        write(self.file, rows=5, skipped=5)
        self.refused("found 5 realisations, and none of them valid, expected ")

    def test_a_part_that_is_not_there(self):
        write(self.file)
        with h5py.File(self.file, "r+") as f:
            f["index"][7] = -1
        self.refused("found rows of a part that is not there, expected ")

    def test_parts_of_the_file_that_are_missing(self):
        for name in ("index", "valid", "table", "summary"):
            with self.subTest(name=name):
                write(self.file)
                with h5py.File(self.file, "r+") as f:
                    del f[name]
                self.refused("found what cannot be read .*, expected a whole file")

    def test_a_newer_format(self):
        write(self.file)
        with h5py.File(self.file, "r+") as f:
            f.attrs["version"] = "2.0"
        self.refused("found version 2.0 of the format, expected version 1")


if __name__ == "__main__":
    unittest.main(verbosity=1)

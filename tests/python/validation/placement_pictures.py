#!/usr/bin/env python3
"""The pictures of a placement, and of ellipses of errors of place: each is drawn, its words can be read, and marks lie
where the file says. Files are made here, in the form of docs/formats/placement.md and study-results.md.
"""
import contextlib
import io
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
from asdic_pictures import api, command, placement, study_data, study_pictures, style  # noqa: E402
from asdic_pictures.data import InputError  # noqa: E402
from text_layout import faults  # noqa: E402

style.TESTING.update({"figure.dpi": 100})
REFUSED = [0, 0, 1, 0, 2, 0]


def write(path, judging=5, options=("1 kHz", "3 kHz"), points=False):
    """Two sensors among six places in two rows, four by three cells, two depths."""
    east, north = np.meshgrid(np.arange(4) * 1000.0, np.arange(3) * 1000.0)
    cell = np.stack([east.ravel(), north.ravel()], -1)
    place = np.array([[x, y] for y in (500.0, 1500.0) for x in (0.0, 1500.0, 3000.0)])
    with h5py.File(path, "w") as f:
        f.attrs.update(filetype="asdic placement", version="1.0", title="a strait with a long name to read",
                       sensors=2, at_least=1, multistatic=0, judging_draws=judging, told_apart=0, difference=0.01,
                       difference_low=-0.02, difference_high=0.04, confidence=0.95, upper_bound=0.9, proved=0,
                       share_of_choosing_draws=0.7)
        f.attrs.create("options", list(options), dtype=h5py.string_dtype())
        f["place_east"], f["place_north"], f["place_refused"] = *place.T, np.array(REFUSED, "i1")
        good = np.flatnonzero(np.array(REFUSED) == 0)
        f["candidate_place"] = np.repeat(good, len(options))
        f["candidate_option"] = np.tile(np.arange(len(options)), good.size)
        f["candidate_share"] = np.linspace(0.1, 0.5, good.size * len(options))
        f["sensor_place"], f["sensor_option"] = [0, 5], [0, len(options) - 1]
        f["other_place"], f["other_option"] = [1, 5], [0, 0]
        f["share_without"], f["greedy_share"] = [0.4, 0.3], [0.45, 0.7]
        f["depth"], f["cell"] = [50.0, 150.0], np.arange(12)
        if not points:
            f["cell"].attrs["size_m"] = 1000.0
        f["cell_east"], f["cell_north"] = cell.T
        detection = np.stack([np.linspace(0.0, 0.55, 12), np.linspace(0.2, 0.9, 12)])
        detection[1, 3] = np.nan
        f["detection_probability"], f["bottom_depth"] = detection, np.linspace(100.0, 500.0, 12)
        f["share"] = np.linspace(0.6, 0.8, max(1, judging))
        f["other_share"] = np.linspace(0.61, 0.78, max(1, judging))
    return detection


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.file = self.folder / "place.h5"

    def plot(self, *arguments):
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = command.main([str(a) for a in arguments])
        return code, out.getvalue(), err.getvalue()


class Placements(Case):
    def test_every_picture_is_drawn_and_read(self):
        write(self.file)
        code, out, err = self.plot(self.file, "-o", self.folder / "p", "--dpi", "40", "--only", "placement,draws")
        self.assertEqual((code, err), (0, ""))
        names = {p.name for p in (self.folder / "p").iterdir()}
        self.assertEqual(names, {"placement_1.png", "placement_2.png", "draws.png"})
        for name in placement.ALL:
            self.assertEqual(faults(api.of_placement(name, str(self.file))), [], name)

    def test_cells_and_sensors_lie_where_the_file_says(self):
        detection = write(self.file)
        axes = api.of_placement("placement", str(self.file), depth=150.0).axes[0]
        mesh = axes.collections[0]
        shown = np.ma.filled(np.ma.asarray(mesh.get_array(), float), np.nan).reshape(3, 4)
        np.testing.assert_allclose(shown, detection[1].reshape(3, 4))   # rows go north, columns east
        np.testing.assert_allclose(mesh.get_coordinates()[0, :, 0], [-0.5, 0.5, 1.5, 2.5, 3.5])
        drawn = {tuple(np.round(line.get_xydata()[0], 3)) for line in axes.lines
                 if line.get_markerfacecolor() == style.INK and len(line.get_xydata()) == 1}
        self.assertEqual(drawn, {(0.0, 0.5), (3.0, 1.5)})
        words = " ".join(t.get_text() for t in axes.get_figure().findobj(matplotlib.text.Text))
        self.assertIn("cannot be told", words.replace("\n", " "))

    def test_what_is_not_there_is_left_out_and_told(self):
        write(self.file, judging=0, options=("alone",), points=True)
        code, out, err = self.plot(self.file, "-o", self.folder / "p", "--dpi", "40")
        self.assertEqual((code, err), (0, ""))
        self.assertIn("draws.png: left out, nothing was drawn", out)
        self.assertEqual(faults(api.of_placement("placement", str(self.file))), [])

    def test_a_broken_file_is_told(self):
        write(self.file)
        with h5py.File(self.file, "r+") as f:
            f["sensor_place"][0] = 77
        with self.assertRaisesRegex(InputError, "do not fit together"):
            placement.read(str(self.file))
        with h5py.File(self.file, "r+") as f:
            del f["weight" if "weight" in f else "share"]
        with self.assertRaisesRegex(InputError, "asdic place"):
            placement.read(str(self.file))


class Ellipses(Case):
    def study(self, **columns):
        """One bin at 3 km east and 4 km north, an ellipse of 200 by 50 m along 30°."""
        values = dict(range=[5000.0, 9000.0], count=[10, 10], found=[9, 1], target_east=[3000.0, np.nan],
                      target_north=[4000.0, np.nan])
        for name, value in (("east_bias", 10.0), ("north_bias", -20.0), ("major", 200.0), ("minor", 50.0),
                            ("axis_deg", 30.0)):
            values |= {name: [value, np.nan], f"{name}_low": [0.9 * value, np.nan], f"{name}_high": [1.1 * value, np.nan]}
        values |= dict(inside=[0.9, np.nan], rms=[60.0, np.nan]) | columns
        with h5py.File(self.file, "w") as f:
            f.attrs.update(filetype="asdic study", version="1.0", title="places", complete=1)
            f["index"], f["valid"] = np.arange(20), np.ones(20, "i1")
            f.create_dataset("table/range", data=np.linspace(4e3, 1e4, 20)).attrs.update(units="m", role="input")
            group = f.create_group("summary/ellipses_by_range")
            f["summary"].attrs["confidence"] = 0.95
            group.attrs.create("columns", list(values), dtype=h5py.string_dtype())
            for name, value in values.items():
                group[name] = np.asarray(value, float)
                group[name].attrs.update(units="m", long_name=name)
        return study_data.read(str(self.file))

    def test_the_ellipse_is_where_and_as_large_as_it_says(self):
        name = "ellipses_by_range_plan"
        (_, fig), = study_pictures.draw(self.study(), [name])
        self.assertEqual(faults(fig), [])
        ellipse = fig.axes[0].lines[0].get_xydata()         # [km], drawn once as large: 0.06·5 km over 200 m is 1.5
        np.testing.assert_allclose(ellipse[:-1].mean(0), [3.01, 3.98], atol=1e-9)
        off = ellipse - [3.01, 3.98]
        self.assertAlmostEqual(np.hypot(*off.T).max(), 0.2, places=9)
        far = off[np.hypot(*off.T).argmax()]
        self.assertAlmostEqual(np.degrees(np.arctan2(*far)) % 180.0, 30.0, places=6)
        self.assertEqual(sum(len(line.get_xydata()) == 73 for line in fig.axes[0].lines), 1)   # one bin has none

    def test_the_table_is_in_its_own_units(self):
        more = dict(major=[200.0, 400.0], major_low=[180.0, 350.0], major_high=[220.0, 450.0])
        (_, fig), = study_pictures.draw(self.study(**more), ["ellipses_by_range"])
        major = next(a for a in fig.axes if "major" in a.get_ylabel())
        self.assertGreater(major.get_ylim()[1], 100.0)


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""The pictures of fields, arrivals and rays: each is drawn and shows what the file holds; bad input
is told plainly.
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
sys.path[:0] = [str(ROOT / "python")]

import matplotlib  # noqa: E402

matplotlib.use("Agg")
import matplotlib.image  # noqa: E402
from asdic_pictures import (arrival_stems, command, comparison, ray_paths, results,  # noqa: E402
                            style, transmission_loss)

style.TESTING.update({"figure.dpi": 100})    # quicker to draw


def plot(*arguments):
    """→ exit code, standard output, standard error"""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            code = command.main([str(a) for a in arguments])
        except SystemExit as stop:  # argparse
            code = stop.code
    return code, out.getvalue(), err.getvalue()


def write_sea(f):
    r = np.linspace(0.0, 10e3, 51)
    f["environment/boundary_range"] = r
    f["environment/surface_depth"] = np.zeros(r.size)
    f["environment/bottom_depth"] = 300.0 - 0.01 * r
    f["environment/depth"] = np.linspace(0.0, 300.0, 31)
    f["environment/sound_speed"] = np.linspace(1520.0, 1490.0, 31)


def write_field(path, level_db=0.0, depths=40, irregular=False, sea=True, sources=1, silent=False,
                unsure=None):
    """Spherical spreading from the source, with a shadow of silence. `unsure`: [receivers] bool"""
    with h5py.File(path, "w") as f:
        f.attrs.update(filetype="asdic field", version="1.0", title="a slope", frequency_hz=100.0,
                       field="coherent", beam_kind="hat")
        r = np.linspace(100.0, 10e3, 60)
        z = np.linspace(5.0, 195.0, 60 if irregular else depths)
        f["source_depth"] = np.linspace(50.0, 100.0, sources)
        if irregular:
            f["receiver"], f["receiver_range"], f["receiver_depth"] = np.arange(60), r, z
            slant = np.hypot(r, z - 50.0)
        else:
            f["range"], f["depth"] = r, z
            slant = np.hypot(r[None, :], z[:, None] - 50.0)
        p = 10.0 ** (level_db / 20.0) * np.exp(-0.4j * slant) / slant
        p[..., -5:] = 0.0
        p = np.repeat(p[None] * (not silent), sources, axis=0)
        f["pressure"] = np.stack([p.real, p.imag], axis=-1).astype("f4")
        if unsure is not None:
            f["beam_error"] = np.where(np.broadcast_to(unsure, p.shape), np.inf, 0.1).astype("f4")
            f.attrs["sure_db"] = 0.5
        if sea:
            write_sea(f)


def write_arrivals(path, receivers=5, legs=False, later=0.0):
    with h5py.File(path, "w") as f:
        f.attrs.update(filetype="asdic arrivals", version="1.0", title="paths", frequency_hz=1e3)
        n = 6 * receivers
        k = np.arange(n)
        receiver, path_number = k // 6, k % 6
        f["arrivals/range"] = 1000.0 * (receiver + 1)
        f["arrivals/delay"] = (receiver + 1) / 1.5 + 0.05 * path_number ** 1.5 + later
        f["arrivals/amplitude_real"] = 1e-3 * 0.5 ** path_number
        f["arrivals/amplitude_imag"] = np.zeros(n)
        f["arrivals/launch_elevation_deg"] = 5.0 * path_number
        f["arrivals/surface_bounces"] = path_number % 3
        f["arrivals/bottom_bounces"] = path_number // 2
        if legs:
            for name in ("ping", "leg", "target", "channel"):
                f["arrivals/" + name] = receiver if name == "target" else 0 * k
        else:
            f["source_depth"], f["depth"] = [50.0], [20.0]
            f["range"] = 1000.0 * (np.arange(receivers) + 1)
            for name in ("source_index", "depth_index", "range_index"):
                f["arrivals/" + name] = receiver if name == "range_index" else 0 * k


def write_rays(path, below=0.0, rays=9, sea=True):
    with h5py.File(path, "w") as f:
        f.attrs.update(filetype="asdic rays", version="1.0", title="a fan", bottom_depth_m=300.0)
        launch = np.linspace(-10.0, 10.0, rays) if rays else np.zeros(0)
        r = np.tile(np.linspace(0.0, 1000.0, 50), (rays, 1))
        f["rays/launch_elevation_deg"] = launch
        f["rays/surface_bounces"] = np.arange(rays) % 2
        f["rays/bottom_bounces"] = np.arange(rays) // 5
        f["rays/range"] = r
        f["rays/depth"] = 150.0 + below - r * np.tan(np.radians(launch))[:, None]
        if sea:
            write_sea(f)


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.file, self.other = self.folder / "a.h5", self.folder / "b.h5"

    def check_picture(self, path):
        """It is there, large, and shows something."""
        image = matplotlib.image.imread(path)[:, :, :3]
        self.assertGreaterEqual(min(image.shape[:2]), 380, path)
        self.assertGreater(image.std(), 0.02, path)

    def check_plot(self, *names):
        code, out, err = plot(self.file, "-o", self.folder / "pictures")
        self.assertEqual((code, err), (0, ""))
        self.assertEqual(sorted(p.name for p in (self.folder / "pictures").iterdir()),
                         sorted(names))
        for name in names:
            self.check_picture(self.folder / "pictures" / name)

    def check_against(self):
        picture = self.folder / "both.png"
        code, out, err = plot(self.file, "--against", self.other, "-o", picture, "--names", "x.shd",
                              "y.shd")
        self.assertEqual(code, 0, err)
        self.check_picture(picture)


class EveryPictureIsDrawn(Case):
    def test_field(self):
        write_field(self.file)
        self.check_plot("transmission_loss.png")

    def test_field_without_its_sea(self):
        write_field(self.file, sea=False)
        self.check_plot("transmission_loss.png")

    def test_receivers_at_one_depth(self):
        write_field(self.file, depths=1)
        self.check_plot("transmission_loss.png")

    def test_scattered_receivers(self):
        write_field(self.file, irregular=True)
        self.check_plot("transmission_loss.png")

    def test_what_is_not_sure_is_hatched(self):
        """Darker by the hatching where it is, the same where it is not; told in words below."""
        half = np.arange(60) >= 30
        for options in (dict(), dict(depths=2), dict(irregular=True)):
            with self.subTest(**options):
                write_field(self.file, sea=False, unsure=half, **options)
                fig = transmission_loss.draw(results.read(self.file))
                words = [t.get_text() for legend in fig.findobj(matplotlib.legend.Legend)
                         for t in legend.get_texts()]
                self.assertIn("more beams may change it by over 0.5 dB: 50 % of the receivers", words)
        pictures = []
        for unsure in (half, None):
            write_field(self.file, sea=False, unsure=unsure)
            fig = transmission_loss.draw(results.read(self.file))
            axes = fig.axes[0]
            for legend in fig.findobj(matplotlib.legend.Legend):
                legend.set(in_layout=False, visible=False)
            for strut in axes.texts:
                strut.set(in_layout=False)
            fig.canvas.draw()
            box = axes.get_window_extent()
            image = np.asarray(fig.canvas.buffer_rgba())[::-1, :, :3].astype(float).mean(axis=2)
            columns = np.linspace(box.x0, box.x1, 11).astype(int)
            middle = image[int(box.y0) + 8:int(box.y1) - 8]
            pictures.append([middle[:, a + 4:b - 4].mean() for a, b in zip(columns, columns[1:])])
        change = np.subtract(*pictures)
        self.assertTrue(np.all(np.abs(change[1:4]) < 1e-9), change)
        self.assertTrue(np.all(change[6:9] < -2.0), change)

    def test_columns_not_looked_at_are_as_their_neighbours(self):
        errors = np.full((1, 3, 7), np.nan)
        errors[0, :, 1], errors[0, :, 5] = 0.1, [0.1, np.inf, 2.0]
        field = results.Field("", 1.0, np.zeros(1), np.arange(3.0), np.arange(7.0), False,
                              np.ones((1, 3, 7)), "", errors=errors)
        self.assertFalse(field.unsure(0)[:, :3].any())
        self.assertTrue((field.unsure(0)[:, 4:] == [[False], [True], [True]]).all())
        field.errors = np.full((1, 3, 7), np.nan)
        self.assertIsNone(field.unsure(0))
        field.errors = None
        self.assertIsNone(field.unsure(0))

    def test_errors_of_another_shape(self):
        write_field(self.file)
        with h5py.File(self.file, "a") as f:
            f["beam_error"] = np.zeros(3)
        self.assertNotEqual(plot(self.file, "-o", self.file.parent / "out")[0], 0)

    def test_several_sources(self):
        write_field(self.file, sources=2)
        self.check_plot("transmission_loss_1.png", "transmission_loss_2.png")

    def test_arrivals_at_receivers_and_of_legs(self):
        for legs in (False, True):
            with self.subTest(legs=legs):
                write_arrivals(self.file, legs=legs)
                self.check_plot("arrivals.png")

    def test_rays(self):
        for sea in (False, True):
            with self.subTest(sea=sea):
                write_rays(self.file, sea=sea)
                self.check_plot("rays.png")

    def test_nothing_to_show(self):
        for write in (lambda: write_field(self.file, silent=True),
                      lambda: write_arrivals(self.file, receivers=0),
                      lambda: write_rays(self.file, rays=0)):
            write()
            code, out, err = plot(self.file, "-o", self.folder / "pictures")
            self.assertEqual((code, err), (0, ""))
            self.assertIn("left out", out)


class Comparisons(Case):
    def test_fields(self):
        for options in ({}, {"depths": 1}, {"irregular": True}):
            with self.subTest(**options):
                write_field(self.file, level_db=1.0, **options)
                write_field(self.other, **options)
                self.check_against()

    def test_arrivals(self):
        write_arrivals(self.file, later=1e-3)
        write_arrivals(self.other)
        self.check_against()

    def test_rays(self):
        write_rays(self.file, below=5.0)
        write_rays(self.other)
        self.check_against()

    def test_two_kinds_are_refused(self):
        write_rays(self.file)
        write_field(self.other)
        code, _, err = plot(self.file, "--against", self.other, "-o", self.folder / "x.png")
        self.assertEqual(code, 2)
        self.assertEqual(len(err.splitlines()), 1)


class WhatThePicturesShow(Case):
    def test_loss_is_of_the_pressure_and_silence_is_blank(self):
        write_field(self.file)
        tl = results.read(self.file).tl(0)
        self.assertTrue(np.isnan(tl[:, -5:]).all())
        self.assertAlmostEqual(tl[10, 0], 20 * np.log10(np.hypot(100.0, 5 + 190 / 39 * 10 - 50)), 4)

    def test_loud_is_light_and_depth_is_down(self):
        write_field(self.file)
        fig = transmission_loss.draw(results.read(self.file))
        axes = fig.axes[1]
        self.assertGreater(axes.get_ylim()[0], axes.get_ylim()[1])
        colours = matplotlib.colormaps[style.LOSS_MAP]
        self.assertGreater(sum(colours(0.0)[:3]), sum(colours(1.0)[:3]))

    def test_difference_is_a_minus_b(self):
        write_field(self.file, level_db=-2.0)
        write_field(self.other)
        a, b = results.read(self.file), results.read(self.other)
        fig = comparison.draw(a, b, ["a", "b"], 120.0)
        values = fig.axes[2].collections[0].get_array()
        self.assertAlmostEqual(float(np.nanmedian(np.ma.filled(values, np.nan))), 2.0, 4)

    def test_stems_stand_at_delay_and_level(self):
        write_arrivals(self.file)
        first = results.read(self.file).receivers[0]
        self.assertAlmostEqual(first.level[0], -60.0, 9)
        self.assertAlmostEqual(first.delay[0], 1 / 1.5, 9)
        self.assertEqual(arrival_stems.chosen(list(range(9))), [0, 4, 8])

    def test_colours_of_rays_tell_what_they_met(self):
        write_rays(self.file)
        self.assertEqual(list(ray_paths.histories(results.read(self.file))),
                         [0, 1, 0, 1, 0, 3, 2, 3, 2])


class BadInput(Case):
    def refused(self, *arguments):
        code, out, err = plot(*arguments)
        self.assertEqual(code, 2, err)
        self.assertEqual(len(err.strip().splitlines()), 1, err)
        return err

    def test_parts_that_are_missing(self):
        for write, names in ((write_field, ("pressure", "range", "source_depth")),
                             (write_arrivals, ("arrivals/delay", "arrivals/amplitude_real")),
                             (write_rays, ("rays/range", "rays/launch_elevation_deg"))):
            for name in names:
                with self.subTest(name=name):
                    write(self.file)
                    with h5py.File(self.file, "r+") as f:
                        del f[name]
                    self.assertRegex(self.refused(self.file, "-o", self.folder / "p"),
                                     rf"found .*{name}.*, expected ")

    def test_pressure_of_another_shape(self):
        write_field(self.file)
        with h5py.File(self.file, "r+") as f:
            del f["pressure"]
            f["pressure"] = np.zeros((2, 3))
        self.assertIn("pressure of shape (2, 3)", self.refused(self.file, "-o", self.folder / "p"))


if __name__ == "__main__":
    unittest.main(verbosity=1)

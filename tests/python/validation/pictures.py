#!/usr/bin/env python3
"""The pictures of a ping file: every one is drawn, none is empty, and bad input is told plainly.

Synthetic files with known contents (tests/support/make_ping_file.py) stand for the simulator's.
"""
import contextlib
import io
import os
import resource
import shutil
import stat
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
import matplotlib  # noqa: E402
from deep import DEEP, in_depth  # noqa: E402

matplotlib.use("Agg")
import matplotlib.image  # noqa: E402
from asdic_pictures import command, output, style  # noqa: E402

style.TESTING.update({"figure.dpi": 100})    # quicker to draw
if not DEEP:    # where words stand is no matter of these tests, and takes half of the time
    style.TESTING["figure.constrained_layout.use"] = False

ALWAYS = ["rays", "pressure", "bearing_time", "levels", "spectrogram"]
# A small sea: 6 s of 8 phones at a low rate, so that a case costs little more than its drawing.
SMALL = dict(duration=6.0, sample_rate=2500.0, frequency=1000.0, pulse=0.25, phones=8, spacing=0.75,
             depth=500.0, water=1200.0, targets=[(3000.0, 65.0, 60.0)], strength=30.0,
             target_speed=4.0)


def small(**changes):
    return synthetic.Settings(**{**SMALL, **changes})


def plot(*arguments):
    """Runs `asdic plot` in this process. → exit code, standard output, standard error"""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            code = command.main([str(a) for a in arguments])
        except SystemExit as stop:  # argparse
            code = stop.code
    return code, out.getvalue(), err.getvalue()


class Case(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="asdic_pictures_"))
        self.file = self.folder / "ping.h5"
        self.addCleanup(shutil.rmtree, self.folder, True)

    def check_picture(self, path):
        """A picture is there, at least 900 × 400 pixels, and shows something: many colours or many
        changes.
        """
        self.assertTrue(path.is_file(), path)
        self.assertGreater(path.stat().st_size, 10_000, path)
        image = matplotlib.image.imread(path)[:, :, :3]
        self.assertGreaterEqual(image.shape[0], 400, path)
        self.assertGreaterEqual(image.shape[1], 900, path)
        self.assertGreater(image.std(), 0.02, path)      # a white page: 0; text alone: about 0.01
        drawn = image[int(0.2 * len(image)) : int(0.8 * len(image)),
                      int(0.2 * image.shape[1]) : int(0.8 * image.shape[1])]
        colours = np.rint(drawn * 255).astype(np.uint32) @ np.array([1 << 16, 1 << 8, 1], np.uint32)
        self.assertGreater(len(np.unique(colours)), 8, path)

    def check_plot(self, settings, expected=tuple(ALWAYS), change=None, arguments=()):
        """Writes a file, changes it with `change`, plots it: exit code 0, the expected pictures and
        no others.
        """
        if "bearing_time" in expected and settings.array != "vertical":    # bearings are told
            expected = [*expected, "ppi"]
        synthetic.write(self.file, settings)
        if change:
            with h5py.File(self.file, "r+") as f:
                change(f)
        code, out, err = plot(self.file, "-o", self.folder / "pictures", *arguments)
        self.assertEqual(code, 0, err)
        written = sorted(p.stem for p in (self.folder / "pictures").iterdir())
        self.assertEqual(written, sorted(expected))
        self.assertEqual(out.count("left out"), 8 - len(expected), out)
        self.assertEqual(len(out.splitlines()), 8, out)
        for name in expected:
            self.check_picture(self.folder / "pictures" / f"{name}.png")
        return err


class EveryPictureIsDrawn(Case):
    @in_depth("left-over pictures go under those of one")
    def test_horizontal_array(self):
        self.assertEqual(self.check_plot(small()), "")

    def test_vertical_array(self):
        self.check_plot(small(array="vertical"))

    @in_depth("arrays of either direction are drawn")
    def test_array_in_space(self):
        self.check_plot(small(array="volume"))

    def test_linear_sweep(self):
        self.check_plot(small(bandwidth=100.0), ALWAYS + ["matched_filter"])

    @in_depth("two pings are drawn, and a sweep of frequency")
    def test_several_pings(self):
        self.check_plot(small(pings=4, elevations=[6.0, 9.0, 12.0]), ALWAYS + ["sweep"],
                        arguments=["--ping", "3"])

    @in_depth("one target is drawn")
    def test_two_targets(self):
        self.check_plot(small(targets=[(2500.0, 40.0, 60.0), (3200.0, 100.0, 200.0)]))

    @in_depth("a ping cut short is drawn")
    def test_stopped_early(self):
        self.check_plot(small(pings=2, pings_requested=5), ALWAYS + ["sweep"])

    @in_depth("a ping cut short is drawn")
    def test_stopped_early_with_rows_left_empty(self):
        def stop(f):
            f["valid_samples"][1:] = 0
            f["pressure"][1:] = 0
            f.attrs["complete"] = 0
        self.check_plot(small(pings=3), change=stop)

    def test_ping_cut_short(self):
        def cut(f):
            f["valid_samples"][1] = f["pressure"].shape[2] // 3
        self.check_plot(small(pings=2), ALWAYS + ["sweep"], change=cut, arguments=["--ping", "2"])


class OddFilesAreDrawn(Case):
    def test_no_targets(self):
        self.check_plot(small(targets=[]))

    @in_depth("files without targets and without anything are drawn")
    def test_no_noise(self):
        self.check_plot(small(noise_level=None))

    @in_depth("files without targets and without anything are drawn")
    def test_no_reverberation(self):
        self.check_plot(small(reverberation=False))

    def test_one_phone_has_no_bearings(self):
        self.check_plot(small(phones=1), [n for n in ALWAYS if n != "bearing_time"])

    def test_silence(self):
        """Nothing was received at all: there is nothing to be drawn in colour, and that is no
        failure.
        """
        synthetic.write(self.file, small(targets=[], noise_level=None, reverberation=False))
        code, out, err = plot(self.file, "-o", self.folder / "pictures")
        self.assertEqual((code, err), (0, ""))

    def test_record_shorter_than_the_pulse(self):
        for duration in (0.0004, 0.004, 0.05) if DEEP else (0.0004,):      # 1, 10, 125 samples
            with self.subTest(duration=duration):
                synthetic.write(self.file, small(duration=duration))
                code, out, err = plot(self.file, "-o", self.folder / "pictures")
                self.assertEqual(code, 0, err)

    def test_samples_that_are_not_numbers(self):
        def spoil(f):
            f["pressure"][0, 2, 100:200] = np.nan
            f["levels/echo"][0, :3] = np.nan
            f["echoes/delay"][0] = np.nan
        err = self.check_plot(small(), change=spoil)
        self.assertIn("100 samples of pressure are not numbers", err)

    def test_tables_without_rows(self):
        def strip(f):
            for name in ("echoes", "arrivals", "patches", "rays", "levels"):
                del f[name]
        self.check_plot(small(), ["pressure", "bearing_time", "spectrogram"], change=strip)

    def test_names_are_not_read_as_mathematics(self):
        def rename(f):
            f.attrs["title"] = r"costs $5 and \frac{1} _x_ " + "long " * 60
            f["target_index"].attrs["names"] = ["_$bad^{name"]
        self.check_plot(small(), change=rename)

    def test_left_over_pictures_are_removed(self):
        """A sweep picture of an earlier file must not stay beside the pictures of a file with one
        ping.
        """
        self.check_plot(small(pings=2), ALWAYS + ["sweep"])
        self.check_plot(small())


class BadInput(Case):
    def refused(self, *arguments, code=2):
        got, out, err = plot(*arguments)
        self.assertEqual(got, code, err)
        self.assertEqual(out, "")
        self.assertNotIn("Traceback", err)
        self.assertEqual(len(err.strip().splitlines()), 1, err)
        return err

    def test_missing_file(self):
        self.assertRegex(self.refused(self.folder / "none.h5"),
                         r"none\.h5: found no such file, expected ")

    def test_directory(self):
        self.assertRegex(self.refused(self.folder), r"found a directory, expected ")

    def test_not_hdf5(self):
        self.file.write_text("not a ping file\n")
        self.assertRegex(self.refused(self.file),
                         r"ping\.h5: found a file that is not HDF5, expected ")

    def test_empty_file(self):
        self.file.touch()
        self.assertRegex(self.refused(self.file), r"found .*, expected ")

    def test_other_hdf5(self):
        with h5py.File(self.file, "w") as f:
            f["x"] = 1
        self.assertRegex(self.refused(self.file),
                         r"found an HDF5 file without a filetype, expected filetype \"asdic ping\"")

    def test_truncated(self):
        synthetic.write(self.file, small())
        whole = self.file.read_bytes()
        for part in (0.1, 0.5, 0.95):
            with self.subTest(part=part):
                self.file.write_bytes(whole[: int(part * len(whole))])
                self.assertRegex(self.refused(self.file), r"found a truncated HDF5 file, expected ")

    def test_newer_format(self):
        synthetic.write(self.file, small())
        with h5py.File(self.file, "r+") as f:
            f.attrs["version"] = "4.0"
        self.assertRegex(self.refused(self.file),
                         r"found version 4\.0 of the format, expected version ")

    def test_datasets_that_are_missing(self):
        whole = self.folder / "whole.h5"
        synthetic.write(whole, small(duration=1.0))
        needed = ("pressure", "ping", "valid_samples", "phone_position", "environment/sound_speed", "replica")
        for name in needed if DEEP else needed[::2]:
            with self.subTest(name=name):
                shutil.copy(whole, self.file)
                with h5py.File(self.file, "r+") as f:
                    del f[name]
                code, out, err = plot(self.file, "-o", self.folder / "pictures")
                self.assertEqual(code, 2, err)
                self.assertRegex(err, rf"found no .*{name}.*, expected ")

    def test_no_such_ping(self):
        synthetic.write(self.file, small(pings=2))
        self.assertRegex(self.refused(self.file, "--ping", "9"),
                         r"found no ping 9, expected one of 1 to 2")

    def test_output_is_a_file(self):
        synthetic.write(self.file, small(duration=1.0))
        self.refused(self.file, "-o", self.file, code=1)

    @unittest.skipIf(os.geteuid() == 0, "root may write anywhere")
    def test_unwritable_directory(self):
        synthetic.write(self.file, small(duration=1.0))
        locked = self.folder / "locked"
        locked.mkdir()
        locked.chmod(stat.S_IRUSR | stat.S_IXUSR)
        self.refused(self.file, "-o", locked, code=1)

    def test_full_disk(self):
        """A limit on the size of files stands in: writing a picture fails, which is the world's
        fault, not the input's.
        """
        synthetic.write(self.file, small(duration=1.0))
        pictures = self.folder / "pictures"
        before = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (1000, before[1]))
        try:
            self.assertIn("rays.png", self.refused(self.file, "-o", pictures, code=1))
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, before)
        self.assertEqual(list(pictures.iterdir()), [])

    def test_pictures_of_others(self):
        """Neither written over nor removed; ours are, and say whose they are."""
        synthetic.write(self.file, small(duration=1.0))
        pictures = self.folder / "pictures"
        self.assertEqual(plot(self.file, "-o", pictures)[0], 0)
        drawn = {path.name for path in pictures.iterdir()}
        self.assertIn("rays.png", drawn)
        for path in pictures.iterdir():
            self.assertTrue(output.is_ours(path), path)
        for name in ("tracks.png", "sweep.png", "detections.png"):   # of which nothing is drawn
            self.assertNotIn(name, drawn)
            (pictures / name).write_bytes(b"a drawing by hand")
        self.assertEqual(plot(self.file, "-o", pictures)[0], 0)
        for name in ("tracks.png", "sweep.png", "detections.png"):
            self.assertEqual((pictures / name).read_bytes(), b"a drawing by hand", name)

        fig, _ = style.figure("by another program")                  # a PNG, but not ours
        fig.savefig(pictures / "rays.png")
        others = (pictures / "rays.png").read_bytes()
        self.assertFalse(output.is_ours(pictures / "rays.png"))
        self.assertIn("asdic did not write", self.refused(self.file, "-o", pictures))
        self.assertEqual((pictures / "rays.png").read_bytes(), others)
        self.assertEqual(plot(self.file, "-o", pictures, "--force")[0], 0)
        self.assertTrue(output.is_ours(pictures / "rays.png"))
        (pictures / "rays.png").unlink()
        (pictures / "rays.png").symlink_to(self.file)
        self.assertIn("no file", self.refused(self.file, "-o", pictures, "--force"))
        self.assertEqual([p for p in pictures.iterdir() if p.name.endswith(".part")], [])

    def test_pictures_of_ours_that_are_left_out_go(self):
        synthetic.write(self.file, small(duration=1.0))
        pictures = self.folder / "pictures"
        pictures.mkdir()
        fig, _ = style.figure("of an earlier run")
        style.write(fig, pictures / "tracks.png")
        self.assertEqual(plot(self.file, "-o", pictures)[0], 0)
        self.assertFalse((pictures / "tracks.png").exists())

    def test_the_script_itself(self):
        """As the program calls it: a separate process, its exit code and its one line."""
        done = subprocess.run([sys.executable, ROOT / "python" / "asdic_plot.py",
                               self.folder / "none.h5"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertEqual(len(done.stderr.splitlines()), 1)


if __name__ == "__main__":
    unittest.main(verbosity=1)

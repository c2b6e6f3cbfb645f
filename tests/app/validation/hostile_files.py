#!/usr/bin/python3
"""Files that mean harm, or that somebody has damaged: refused in words, never waited for, never obeyed.

Runs the program (ASDIC=path/to/asdic) on files that h5py has changed.
"""
import os
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import h5py
import numpy as np

ASDIC = os.environ.get("ASDIC", "asdic")
DATA = Path(__file__).resolve().parents[2] / "data"
SCENARIO = """title = "small"
[environment.sound_speed]
kind = "isovelocity"
speed = 1500.0
[environment.bottom]
depth = 5000.0
kind = "fluid"
[platform]
position = [0.0, 0.0, 1000.0]
[transmitter]
source_level_db = 220.0
taper = "omnidirectional"
[pulse]
kind = "cw"
frequency = 1000.0
duration = 0.02
window = "hann"
[array]
kind = "horizontal"
phones = 4
spacing = 0.5
[[target]]
name = "rock"
position = [300.0, 0.0, 1000.0]
strength_db = 15.0
[pings]
recording_duration = 0.6
sample_rate = 8000.0
"""
STUDY = """[study]
scenario = "small.toml"
realisations = 3
[vary]
"target.0.range" = { law = "uniform", low = 200.0, high = 300.0 }
[measure]
echo_level = true
"""
ENV = "'guide'\n100\n1\n'CVW'\n0 0 100\n0 1500 /\n100 1500 /\n'R' 0\n1\n50 /\n1\n50 /\n2\n0 1 /\n'C'\n21\n-40 40 /\n0 120 1.1\n"


class HostileFiles(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp(prefix="asdic-hostile-"))
        os.chdir(cls.folder)
        Path("small.toml").write_text(SCENARIO)
        Path("study.toml").write_text(STUDY)
        Path("guide.env").write_text(ENV)
        for words in ("ping small.toml -o whole.h5 -q", "study study.toml -o study.h5 -q",
                      "arrivals small.toml -o arrivals.h5", "rays small.toml -o rays.h5"):
            done = cls.run_asdic(words)
            assert done.returncode == 0, (words, done.stderr)

    @classmethod
    def tearDownClass(cls):
        os.chdir("/")
        shutil.rmtree(cls.folder)

    @staticmethod
    def run_asdic(words, timeout=60, **more):
        return subprocess.run([ASDIC, *words.split()], capture_output=True, text=True,
                              timeout=timeout, stdin=subprocess.DEVNULL, **more)

    def refused(self, words, *says, timeout=60):
        """Status 2 and one line that says so."""
        done = self.run_asdic(words, timeout)
        self.assertEqual(done.returncode, 2, f"{words}: {done.returncode}: {done.stderr}")
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        for word in says:
            self.assertIn(word, done.stderr, words)
        return done.stderr

    def changed(self, change, source="whole.h5"):
        shutil.copy(source, "changed.h5")
        with h5py.File("changed.h5", "r+") as f:
            change(f)
        return "changed.h5"

    def test_strings_have_a_fixed_length(self):
        for path in ("whole.h5", "study.h5", "arrivals.h5", "rays.h5"):
            with h5py.File(path) as f:
                items = [f]
                f.visititems(lambda _, item: items.append(item))
                for item in items:
                    types = {key: item.attrs.get_id(key).dtype for key in item.attrs}
                    if isinstance(item, h5py.Dataset):
                        types["its values"] = item.dtype
                    for key, dtype in types.items():
                        string = h5py.check_string_dtype(dtype)
                        self.assertFalse(string and string.length is None,
                                         f"{path}: {item.name}: {key}")

    def test_damaged_files_are_refused(self):
        for name in ("attribute-text-crash", "hang", "info-crash", "merge-crash"):
            for command in ("info", "process", "merge -o all.h5", "plot -o pictures", "export --wav"):
                with self.subTest(name=name, command=command):
                    self.refused(f"{command} {DATA}/hostile/{name}.h5", f"{name}.h5")

    def test_links_and_data_elsewhere_are_refused(self):
        def link(f):
            del f["pressure"]
            f["pressure"] = h5py.ExternalLink("whole.h5", "/pressure")

        def stored_elsewhere(f):
            del f["pressure"]
            f.create_dataset("pressure", (1, 4, 100), "f4", external=[("/etc/passwd", 0, 1600)])

        def shown(f):
            layout = h5py.VirtualLayout((1, 4, 100), "f4")
            layout[:] = h5py.VirtualSource("whole.h5", "pressure", (1, 4, 2400))[:, :, :100]
            del f["pressure"]
            f.create_virtual_dataset("pressure", layout)

        def hidden(f):  # behind a link within the file
            f.create_group("a")["b"] = h5py.ExternalLink("/etc/passwd", "/")
            f["c"] = h5py.SoftLink("/a/b")

        for change, says in ((link, "a link to another file"), (hidden, "a link to another file"),
                             (stored_elsewhere, "data in another file"),
                             (shown, "data in other files")):
            path = self.changed(change)
            for command in ("info", "process", "plot -o pictures", "export --wav"):
                with self.subTest(change=change.__name__, command=command):
                    self.refused(f"{command} {path}", says)

    def test_claims_that_no_file_holds_are_refused(self):
        def huge(f):
            del f["valid_samples"]
            f.create_dataset("valid_samples", (10**15,), "i8", chunks=(1000,))

        self.refused(f"info {self.changed(huge)}", "valid_samples", "claims more than")

    def test_tables_whose_columns_do_not_fit_are_refused(self):
        def shorten(f):
            del f["echoes/struck"]
            f["echoes/struck"] = [1.0] * (f["echoes/delay"].size + 1)

        def another_array(f):
            f["echoes/array"][...] = 7

        def too_many_samples(f):
            f["valid_samples"][...] = 10**9

        self.refused(f"process {self.changed(shorten)} -q", "echoes/struck with")
        self.refused(f"process {self.changed(another_array)} -q", "7 in echoes/array")
        self.refused(f"process {self.changed(too_many_samples)} -q", "in valid_samples")

    def test_a_catalogue_shows_studies_only(self):
        def stranger(f):
            layout = h5py.VirtualLayout((3,), "i8")
            layout[:] = h5py.VirtualSource("whole.h5", "valid_samples", (3,))
            del f["index"]
            f.create_virtual_dataset("index", layout)

        self.refused(f"info {self.changed(stranger, 'study.h5')}", "no study's file")

    def test_pipes_and_devices_are_not_waited_for(self):
        for name in ("p.toml", "p.h5", "p.env", "p.shd", "p.csv", "p.wav", "p.nc", "p.journal"):
            os.mkfifo(name)
        Path("named.toml").write_text(SCENARIO.replace(
            'kind = "isovelocity"\nspeed = 1500.0', 'kind = "table"\nfile = "p.csv"'))
        Path("sound.toml").write_text(SCENARIO.replace('kind = "cw"\nfrequency = 1000.0\n'
                                                       'duration = 0.02', 'kind = "file"\n'
                                                       'file = "p.wav"'))
        Path("included.toml").write_text('include = "p.toml"\n' + SCENARIO)
        os.mkfifo("p_study.h5.journal")
        os.mkdir("data")
        for name in ("levitus_climatology", "etopo5", "coads_climatology"):
            os.mkfifo(f"data/{name}.cdf")
        for words in ("validate p.toml", "ping p.toml", "arrivals p.toml", "rays p.toml",
                      "field p.toml", "study p.toml", "serve p.toml", "validate named.toml",
                      "validate sound.toml", "validate included.toml", "info p.h5", "plot p.h5",
                      "process p.h5", "merge p.h5 -o all.h5", "export p.h5 --wav", "bellhop p",
                      "explain p", "convert p.env a.toml", "convert p.shd a.h5",
                      "compare p.shd p.shd", "study study.toml -o p_study.h5",
                      "ocean --latitude 30 --longitude -60 --data data", "validate /dev/zero", "info /dev/zero"):
            with self.subTest(words=words):
                self.refused(words, "which is no file", timeout=20)

    def test_an_embedded_scenario_leads_nowhere(self):
        def include(f):
            text = f["scenario"][()].decode()
            del f["scenario"]
            f["scenario"] = 'include = "/etc/passwd"\n' + text

        def profile(f):
            text = f["scenario"][()].decode()
            del f["scenario"]
            f["scenario"] = text.replace('kind = "isovelocity"\nspeed = 1500.0',
                                         'kind = "table"\nfile = "../../../../etc/passwd"')

        def override(f):
            f.attrs["overrides"] = ['environment.sound_speed={kind="table",file="/etc/passwd"}']

        for change in (include, profile, override):
            with self.subTest(change=change.__name__):
                said = self.refused(f"process {self.changed(change)}", "/etc/passwd",
                                    "named in a file of results", "--scenario")
                self.assertNotIn("root", said)

    def test_a_file_beside_is_still_found(self):
        Path("cast.csv").write_text("depth,speed\n0,1500\n5000,1501\n")
        os.makedirs("elsewhere", exist_ok=True)
        Path("named_cast.toml").write_text(SCENARIO.replace(
            'kind = "isovelocity"\nspeed = 1500.0', 'kind = "table"\nfile = "cast.csv"'))
        for output in ("beside.h5", "elsewhere/away.h5"):
            self.assertEqual(self.run_asdic(f"ping named_cast.toml -o {output} -q").returncode, 0)
        done = self.run_asdic("process beside.h5 -o processed.h5 -q")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.refused("process elsewhere/away.h5 -q", "no such file")
        done = self.run_asdic("process elsewhere/away.h5 -q --scenario named_cast.toml")
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_control_characters_are_escaped(self):
        def rename(f):
            f.attrs["title"] = "\x1b]0;owned\x07\x1b[2J"
            f["target_index"].attrs["names"] = ["\x1b[31mred"]

        done = self.run_asdic(f"info {self.changed(rename)}")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("\x1b", done.stdout)
        self.assertIn(r"\x1b]0;owned\x07", done.stdout)
        Path("esc.toml").write_text(SCENARIO + '"\\u001b[31m" = 1\n')
        self.assertNotIn("\x1b", self.refused("validate esc.toml", r"\x1b[31m"))

    def test_pictures_ignore_the_working_folder(self):
        here = self.folder / "trap"
        here.mkdir()
        done = self.run_asdic(f"plot {self.folder}/whole.h5 -o {self.folder}/before")
        self.assertEqual(done.returncode, 0, done.stderr)
        (here / "matplotlibrc").write_text("savefig.facecolor: red\nlines.linewidth: 9\n"
                                           "axes.grid: True\n")
        for module in ("contextlib", "numpy", "h5py", "types", "warnings"):
            (here / f"{module}.py").write_text(f"open({str(here / 'owned')!r}, 'w').close()\n")
        done = self.run_asdic(f"plot {self.folder}/whole.h5 -o {self.folder}/after", cwd=here)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertFalse((here / "owned").exists(), "Python ran a module of the working folder")
        import matplotlib.image
        names = sorted(p.name for p in (self.folder / "before").iterdir())
        self.assertTrue(names)
        for name in names:
            before, after = (matplotlib.image.imread(self.folder / d / name)
                             for d in ("before", "after"))
            self.assertTrue(np.array_equal(before, after), name)

    def test_reading_in_a_child_takes_no_time_to_speak_of(self):
        took = []
        for _ in range(10):
            begin = time.perf_counter()
            self.assertEqual(self.run_asdic("info whole.h5").returncode, 0)
            took.append(time.perf_counter() - begin)
        print(f"asdic info: {1e3 * min(took):.1f} ms")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])

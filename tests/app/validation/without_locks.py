#!/usr/bin/env python3
"""Where a file system refuses locks (NFS: ENOLCK, EOPNOTSUPP, ENOSYS), commands work all the same.

The truth is what the same command makes where there are locks. A study that several processes --join needs them, and
says so.

    ASDIC=build/ci/bin/asdic without_locks.py
"""
import errno
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
sys.path.insert(0, str(ROOT / "tests" / "support"))

from plain_sea import SEA  # noqa: E402

ASDIC = Path(os.environ["ASDIC"]).resolve()
COMPILER = os.environ.get("CC") or shutil.which("cc")
if COMPILER is None:
    print("no C compiler here")
    sys.exit(77)

STUDY = """[study]
scenario = "sea.toml"
realisations = 4
[vary]
"target.0.strength_db" = { law = "uniform", low = 0.0, high = 20.0 }
[measure]
paths = true
"""


class WithoutLocks(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="asdic_locks_")
        cls.library = Path(cls.folder.name, "no_locks.so")
        subprocess.run([COMPILER, "-shared", "-fPIC", "-o", cls.library, ROOT / "tests/support/no_locks.c", "-ldl"],
                       check=True)
        Path(cls.folder.name, "sea.toml").write_text(SEA)
        Path(cls.folder.name, "study.toml").write_text(STUDY)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def asdic(self, *words, refused=0):
        """Runs a command; refused: the error number of every lock, 0: locks work."""
        more = {"LD_PRELOAD": str(self.library), "NO_LOCKS": str(refused)} if refused else {}
        return subprocess.run([ASDIC, *words], cwd=self.folder.name, env={**os.environ, **more}, capture_output=True,
                              text=True)

    def same(self, one, other, *names):
        with h5py.File(Path(self.folder.name, one)) as a, h5py.File(Path(self.folder.name, other)) as b:
            for name in names:
                np.testing.assert_array_equal(a[name][()], b[name][()])

    def test_commands_work(self):
        commands = {"ping": ("ping", "sea.toml", "-q", "-o"), "study": ("study", "study.toml", "-q", "-o")}
        for name, words in commands.items():
            done = self.asdic(*words, f"{name}.h5")
            self.assertEqual(done.returncode, 0, done.stderr)
        for error in (errno.ENOLCK, errno.EOPNOTSUPP, errno.ENOSYS):
            with self.subTest(errno.errorcode[error]):
                for name, words in commands.items():
                    done = self.asdic(*words, f"{name}_{error}.h5", refused=error)
                    self.assertEqual((done.returncode, done.stderr), (0, ""))
                self.same("ping.h5", f"ping_{error}.h5", "pressure")
                self.same("study.h5", f"study_{error}.h5", "index")
                for words in (("info", "ping.h5", "--check"), ("process", f"ping_{error}.h5", "-q"),
                              ("info", f"study_{error}.h5")):
                    done = self.asdic(*words, refused=error)
                    self.assertEqual((done.returncode, done.stderr), (0, ""), words)
        self.assertEqual([], [p.name for p in Path(self.folder.name).iterdir() if p.suffix in (".lock", ".part")])

    def test_who_needs_locks_says_so(self):
        done = self.asdic("study", "study.toml", "-q", "--join", "-o", "crew.h5", refused=errno.ENOLCK)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, r"^asdic: .*journal: the file system there knows no locks.*set another -o\n$")


if __name__ == "__main__":
    unittest.main()

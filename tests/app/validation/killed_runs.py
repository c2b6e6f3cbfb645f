#!/usr/bin/env python3
"""A run that is ended by a signal leaves nothing. After kill -9 it leaves a part, which `asdic recover` lists and the
next run of the same output removes.

    ASDIC=build/ci/bin/asdic killed_runs.py
"""
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import h5py

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))

from plain_sea import SEA  # noqa: E402

ASDIC = Path(os.environ["ASDIC"]).resolve()


class KilledRuns(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="asdic_killed_")
        cls.at = Path(cls.folder.name)
        (cls.at / "sea.toml").write_text(SEA)
        large = ("array.phones=64", "pings.samples=pressure", "pings.sample_rate=4000.0", "pings.recording_duration=30.0")
        cls.asdic("ping", "sea.toml", "-q", *(word for key in large for word in ("--set", key)), "-o", "big.h5")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def asdic(cls, *words):
        return subprocess.run([ASDIC, *words], cwd=cls.at, check=True, capture_output=True, text=True).stdout

    def litter(self, folder):
        return sorted(p.name for p in (self.at / folder).iterdir() if p.suffix in (".part", ".lock"))

    def killed(self, number, folder, *words):
        """Begins a command and kills it when it has a part. -> whether it had not ended before"""
        (self.at / folder).mkdir(exist_ok=True)
        process = subprocess.Popen([ASDIC, *words], cwd=self.at, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while process.poll() is None and not any(name.endswith(".part") for name in self.litter(folder)):
            time.sleep(0.0005)
        process.send_signal(number)
        return process.wait() == -number

    def test_a_signal_leaves_nothing(self):
        for kind in ("mat", "wav"):
            for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
                with self.subTest(f"{kind}, {number.name}"):
                    self.killed(number, kind, "export", "big.h5", f"--{kind}", "-o", kind)
                    self.assertEqual(self.litter(kind), [])

    def test_the_next_run_takes_parts_away(self):
        for kind in ("mat", "wav"):
            folder = f"next_{kind}"
            words = ("export", "big.h5", f"--{kind}", "-o", folder)
            if not self.killed(signal.SIGKILL, folder, *words):
                continue  # the command ended before the signal
            self.assertNotEqual(self.litter(folder), [])
            self.assertIn("no whole ping", self.asdic("recover", folder))
            self.asdic(*words)
            self.assertEqual(self.litter(folder), [])

    def test_pings_are_kept_and_listed(self):
        words = ("ping", "sea.toml", "-q", "--set", "pings.count=2000", "-o", "pings/p.h5")
        (self.at / "pings").mkdir()
        process = subprocess.Popen([ASDIC, *words], cwd=self.at)
        pings = 0
        while pings < 3:
            self.assertIsNone(process.poll())
            time.sleep(0.02)
            for part in (self.at / "pings").glob("*.part"):
                try:
                    with h5py.File(part, locking=False) as file:
                        pings = file["ping"].shape[0]
                except (OSError, KeyError):
                    pass
        self.assertRegex(self.asdic("recover", "pings"), r"another asdic is at work on it: process \d+")
        process.kill()
        process.wait()
        said = self.asdic("recover", "pings")
        self.assertRegex(said, r"^pings/p\.h5\.\w{4}\.part: \d+ of 2000 pings: asdic recover pings/p\.h5\.\w{4}\.part\n$")
        (self.at / "pings/p.h5.0000.part").write_bytes(b"\x89HDF\r\n\x1a\n torn")
        self.asdic(*words[:4], "pings.count=1", *words[5:])
        self.assertEqual([p for p in self.litter("pings")], [said.split(":")[0].removeprefix("pings/")],
                         "whole pings stay, the rest goes")


if __name__ == "__main__":
    unittest.main()

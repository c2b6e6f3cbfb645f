#!/usr/bin/env python3
"""One program for every processor: what is compiled for an instruction level stays in its object, the level is chosen when the
program starts, and all levels give the same numbers to rounding (docs/develop/instruction-levels.md).

Wants ASDIC, the program, and ASDIC_BUILD, its build folder; qemu-x86_64 for an older processor than this one.
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

import h5py
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[3]
ASDIC = os.environ["ASDIC"]
BUILD = pathlib.Path(os.environ["ASDIC_BUILD"])
LEVELS = ("v2", "v3", "v4")
FOLDERS = [path.name for path in sorted((BUILD / "levels").glob("*")) if path.is_dir()]
SMALL = ["--set", "array.phones=4", "--set", "pings.recording_duration=36", "--set", "pings.sample_rate=9000", "--quiet"]


def run(*command, **environment):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, env={**os.environ, **environment})


def level_here():
    """The highest level of this machine, as the program sees it"""
    return re.search(r"x86-64-(v\d)$", run(ASDIC, "--version").stdout, re.MULTILINE)[1]


def levels_here():
    return LEVELS[: LEVELS.index(level_here()) + 1]


@unittest.skipUnless(FOLDERS, "this build has one instruction level")
class Objects(unittest.TestCase):
    def test_no_level_lends_a_function_to_another(self):
        """Of a level's object the linker sees functions with the level's name at their end, and nothing weak."""
        seen = 0
        for folder in FOLDERS:
            for level in LEVELS:
                said = run("nm", "--defined-only", "--extern-only", "--format=posix", BUILD / "levels" / folder / f"{folder}_{level}.o").stdout
                for line in said.splitlines():
                    name, kind = line.split()[:2]
                    self.assertEqual((kind, name.rsplit(".", 1)[-1]), ("T", level), f"{folder}_{level}.o: {line}")
                    seen += 1
        self.assertGreater(seen, 100)

    def test_the_rest_is_for_every_processor(self):
        """Beside the levels' objects there is no register of AVX in any library."""
        for library in sorted(BUILD.glob("libasdic_*.a")):
            with tempfile.TemporaryDirectory() as folder:
                subprocess.run(["ar", "x", library.resolve()], cwd=folder, check=True)
                objects = [path for path in pathlib.Path(folder).glob("*.o") if not re.search(r"_v[34]\.o$", path.name)]
                self.assertTrue(objects, library)
                code = subprocess.run(["objdump", "-d", "--no-show-raw-insn", *objects], capture_output=True, text=True, check=True).stdout
            self.assertIsNone(re.search(r"%[yz]mm\d", code), f"{library.name} uses AVX outside of its levels")


@unittest.skipUnless(FOLDERS, "this build has one instruction level")
class Choice(unittest.TestCase):
    def test_the_environment_pins_a_lower_level(self):
        for level in levels_here():
            said = run(ASDIC, "--version", ASDIC_LEVEL=f"x86-64-{level}")
            self.assertRegex(said.stdout, rf"(?m)x86-64-{level}$")

    def test_what_cannot_be_obeyed_is_refused(self):
        for wrong in ("v3", "x86-64-v9", "avx2"):
            said = run(ASDIC, "validate", ROOT / "scenarios/deep_ocean.toml", ASDIC_LEVEL=wrong)
            self.assertEqual(said.returncode, 2)
            self.assertIn(f'ASDIC_LEVEL: found "{wrong}"', said.stderr)

    @unittest.skipUnless(shutil.which("qemu-x86_64"), "no qemu-x86_64 (Debian: qemu-user)")
    def test_a_processor_of_2008_pings(self):
        """Nehalem has SSE4.2 and no AVX: one instruction too many ends the program."""
        with tempfile.TemporaryDirectory() as folder:
            there = ["qemu-x86_64", "-cpu", "Nehalem"]
            file = pathlib.Path(folder) / "ping.h5"
            said = run(*there, ASDIC, "ping", ROOT / "scenarios/deep_ocean.toml", "-o", file, *SMALL)
            self.assertEqual(said.returncode, 0, said.stderr)
            with h5py.File(file) as ping:
                self.assertIn("x86-64-v2", str(ping.attrs["build"]))
            said = run(*there, ASDIC, "--version", ASDIC_LEVEL="x86-64-v3")
            self.assertEqual(said.returncode, 2)
            self.assertIn("at most x86-64-v2", said.stderr)
            tests = BUILD / "tests" / "levels_raytrace_v2"
            if tests.exists():
                self.assertEqual(run(*there, tests, "--gtest_filter=LaneMath*").returncode, 0)


@unittest.skipUnless(FOLDERS, "this build has one instruction level")
class Numbers(unittest.TestCase):
    def test_pings_agree_to_rounding(self):
        """The pressure of one ping, reverberation, noise and a moving target in it: single precision, so that levels
        differ by some 1e-6 of the loudest sample (the pulse's own samples are floats: 6e-8 each, some hundred added).
        The same level twice gives the same bits.
        """
        with tempfile.TemporaryDirectory() as folder:
            pressure = {}
            for name, level in [*((level, level) for level in levels_here()), ("again", "v2")]:
                file = pathlib.Path(folder) / f"{name}.h5"
                said = run(ASDIC, "ping", ROOT / "scenarios/deep_ocean.toml", "-o", file, *SMALL, ASDIC_LEVEL=f"x86-64-{level}")
                self.assertEqual(said.returncode, 0, said.stderr)
                with h5py.File(file) as ping:
                    pressure[name] = ping["pressure"][:]
            np.testing.assert_array_equal(pressure["again"], pressure["v2"])
            loudest = np.abs(pressure["v2"]).max()
            for level in levels_here():
                self.assertLess(np.abs(pressure[level] - pressure["v2"]).max(), 2e-6 * loudest, level)

    def test_eigenrays_agree_to_rounding(self):
        """Delays to a nanosecond, 1e-10 of 20 s; angles to 1e-9 rad; the same paths in the same order."""
        found = {}
        for level in levels_here():
            said = run(ASDIC, "arrivals", ROOT / "scenarios/deep_ocean.toml", "--json", ASDIC_LEVEL=f"x86-64-{level}")
            self.assertEqual(said.returncode, 0, said.stderr)
            found[level] = json.loads(said.stdout)

        def numbers(value):
            if isinstance(value, dict):
                return [n for key in sorted(value) if key != "build" for n in numbers(value[key])]
            if isinstance(value, list):
                return [n for item in value for n in numbers(item)]
            return [value] if isinstance(value, (int, float)) else []

        truth = np.array(numbers(found["v2"]), dtype=float)
        self.assertGreater(truth.size, 20)
        for level, value in found.items():
            np.testing.assert_allclose(np.array(numbers(value), dtype=float), truth, rtol=1e-7, atol=1e-9, err_msg=level)


if __name__ == "__main__":
    unittest.main()

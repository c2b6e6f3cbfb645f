#!/usr/bin/env python3
"""The notebooks of docs/notebooks run: what they compute holds against what they compute by hand.

Every day two of them run, and all sources are looked at; ASDIC_DEEP=1 runs all.
"""
import importlib.util
import json
import os
import sys
import tempfile
import unittest
from pathlib import Path

ROOT, BUILD = Path(__file__).resolve().parents[3], Path(os.environ["ASDIC_BUILD"]).resolve()
sys.path[:0] = [str(ROOT / "scripts"), str(ROOT / "tests/support")]
if not list((BUILD / "python/asdic").glob("_core*.so")):
    print("the Python package was not built here")
    sys.exit(77)
if any(importlib.util.find_spec(name) is None for name in ("nbconvert", "ipykernel", "matplotlib")):
    print("python3-nbconvert, python3-ipykernel or python3-matplotlib is not here")
    sys.exit(77)

import notebooks  # noqa: E402
from deep import in_depth  # noqa: E402

NAMES = ["array_and_beamformer", "bellhop", "detection_range", "first_ping", "modem_channel",
         "monte_carlo"]


def notebook(*sources, **changes) -> dict:
    """One with a cell of code for each source."""
    cells = [{"cell_type": "code", "source": source, "metadata": {}} for source in sources]
    made = notebooks.cleaned({"cells": cells})
    made["cells"][0] |= changes
    return made


class Sources(unittest.TestCase):
    def test_they_are_all_there_and_clean(self):
        self.assertEqual(sorted(path.stem for path in notebooks.SOURCES.glob("*.ipynb")), NAMES)
        for name in NAMES:
            self.assertEqual(notebooks.faults(notebooks.SOURCES / f"{name}.ipynb"), [])

    def test_the_guide_lists_them(self):
        guide = (ROOT / "docs/guide/python.md").read_text()
        for name in NAMES:
            self.assertIn(f"(../notebooks/{name}.ipynb)", guide)

    def test_faults_are_found(self):
        output = {"output_type": "stream", "name": "stdout", "text": "1"}
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "x.ipynb"
            for text, says in ((notebooks.text_of(notebook("1 +")), "expected Python"),
                               (notebooks.text_of(notebook("1", outputs=[output])), "expected none"),
                               (notebooks.text_of(notebook("1", execution_count=3)), "another form"),
                               (notebooks.text_of(notebook("x = 1" + 100 * " " + "+ 1")), "columns"),
                               (json.dumps(notebook("1")), "another form"), ("{", "expected JSON")):
                path.write_text(text)
                self.assertRegex(" ".join(notebooks.faults(path)), says)
            path.write_text(notebooks.text_of(notebook("1", outputs=[output], metadata={"a": 1})))
            path.write_text(notebooks.text_of(notebooks.cleaned(json.loads(path.read_text()))))
            self.assertEqual(notebooks.faults(path), [])


class Runs(unittest.TestCase):
    def run_one(self, name, folder=notebooks.SOURCES):
        """→ its HTML"""
        before = sorted(folder.iterdir())
        with tempfile.TemporaryDirectory() as output:
            with notebooks.surroundings(BUILD):
                notebooks.execute(folder / f"{name}.ipynb", Path(output))
            self.assertEqual(sorted(folder.iterdir()), before)  # nothing is left beside it
            return (Path(output) / f"{name}.html").read_text()

    def test_bellhop(self):
        html = self.run_one("bellhop")
        self.assertIn("image/png;base64", html)
        self.assertNotRegex(html, r"(src|href)\s*=\s*[\"']https?://")  # it asks no network

    def test_array_and_beamformer(self):
        self.run_one("array_and_beamformer")

    def test_a_cell_that_fails_is_told(self):
        from nbclient.exceptions import CellExecutionError
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "wrong.ipynb"
            path.write_text(notebooks.text_of(notebook("import asdic", "assert asdic.version() == 'x'")))
            with self.assertRaisesRegex(CellExecutionError, "AssertionError"):
                self.run_one("wrong", Path(folder))

    @in_depth("two others run")
    def test_first_ping(self):
        self.run_one("first_ping")

    @in_depth("two others run")
    def test_monte_carlo(self):
        self.run_one("monte_carlo")

    @in_depth("two others run")
    def test_modem_channel(self):
        self.run_one("modem_channel")

    @in_depth("two others run")
    @unittest.skipUnless(Path("/usr/share/ferret-vis/data/etopo5.cdf").exists(), "no ferret-datasets")
    def test_detection_range(self):
        self.run_one("detection_range")


if __name__ == "__main__":
    sys.dont_write_bytecode = True
    unittest.main(verbosity=1)

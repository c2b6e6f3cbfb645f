#!/usr/bin/env python3
"""One problem of each kind of the physics suite, docs/validation: asdic against closed forms and wave theory. And that a
wrong truth is noticed. With ASDIC_DEEP=1 all quick problems.

    ASDIC=path/to/asdic tests/scripts/validation/physics_suite.py
"""
import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
PAGES = ROOT / "docs" / "validation"
sys.path[:0] = [str(ROOT / "scripts"), str(PAGES), str(ROOT / "tests" / "support")]
sys.dont_write_bytecode = True

import numpy as np  # noqa: E402
import suite  # noqa: E402
import validate_physics as command  # noqa: E402
from deep import DEEP  # noqa: E402

# A field over a half-space and in a guide, paths, an echo, reverberation. scripts/deep_check.sh runs all problems.
EVERY_DAY = ["lloyd", "pekeris-field", "thesis-tables", "weston-echo", "rigid-reverberation"]


def run(*words):
    return subprocess.run([sys.executable, str(ROOT / "scripts" / "validate_physics.py"), "--asdic",
                           os.environ["ASDIC"], *words],
                          capture_output=True, text=True, check=False)


def main():
    with tempfile.TemporaryDirectory() as folder:
        # A truth that is 1 % off in frequency is told, and so is a problem that there is not.
        problem, truth = command.load("lloyd", "problem"), command.load("lloyd", "truth")
        truth.FREQUENCY *= 1.01
        wrong = problem.compare(suite.Asdic(os.environ["ASDIC"], Path(folder)), truth)
        assert command.verdict(wrong) == "FAIL", wrong.checks
        assert run("atlantis").returncode == 2

        # What the verdicts mean: a gap does not count as broken, says so when it closes, and NaN
        # never holds.
        assert suite.Check("x", 2.0, 1.0, gap="known").verdict == "gap"
        assert suite.Check("x", 0.5, 1.0, gap="known").verdict == "HOLDS NOW"
        assert suite.Check("x", np.nan, 1.0).verdict == "FAIL"

        done = run(*(["--quick"] if DEEP else EVERY_DAY), "--out", folder)
        print(done.stdout, end="")
        assert done.returncode == 0, done.stdout + done.stderr

    # Every page is whole: in the order, with marks, scenario and picture.
    for name in command.ORDER:
        page = PAGES / name
        for file in ("README.md", "scenario.toml", "truth.py", "problem.py", "plot.png"):
            assert (page / file).is_file(), f"{page / file}: not there"
        assert (page
                / "plot.png").stat().st_size <= command.MOST_BYTES, f"{page}: too large a picture"
        text = (page / "README.md").read_text()
        assert command.BEGIN in text and command.END in text and "Not confirmed" in text, f"{page}: a part is missing"
        assert f"({name}/README.md)" in (PAGES
                                         / "README.md").read_text(), f"{name}: not in the index"
        assert "asdic " not in (page / "truth.py").read_text().split('"""',
            2)[2], f"{page}/truth.py runs asdic"
    assert {p.name for p in PAGES.iterdir() if p.is_dir()} - {"__pycache__"} == set(command.ORDER)


if __name__ == "__main__":
    main()

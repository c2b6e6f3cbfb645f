#!/usr/bin/env python3
"""Lines of progress on terminals of 80, 60 and 40 columns: a ping, a field and a study show one within their first
second, it changes within that second, and nothing of it is left when they end or are interrupted."""
import os
import re
import signal
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
import terminal  # noqa: E402

ASDIC = os.environ["ASDIC"]
ROOT = Path(__file__).resolve().parents[3]
PROGRESS = re.compile(r"^(\[[# ]*\] |preparing|\d+ of \d+ \w+|\d+(\.\d)? %,)")
FIRST_SECOND = 1.0


def fail(text):
    raise SystemExit("FAILED: " + text)


def lines_of_progress(lines):
    return [line for line in lines if PROGRESS.match(line)]


def check(name, words, columns, folder):
    """Three tries, for a machine that is busy with other things."""
    for trial in range(3):
        out = ["-o", f"{name}{trial}.h5"]
        status, seen = terminal.run([ASDIC, *words, *out], columns, interrupt_after=1.6, folder=folder)
        early = [lines for time, lines in seen if time < FIRST_SECOND]
        shown = {line for lines in early for line in lines_of_progress(lines)}
        if len(shown) >= 2:
            break
    else:
        fail(f"{name}, {columns} columns: {len(shown)} lines of progress within the first second: {shown}")
    # Work that ends just as it is interrupted may be stopped by the signal itself.
    if status not in (0, 1, -signal.SIGINT):
        fail(f"{name}: status {status}")
    for time, lines in seen:
        if len(lines_of_progress(lines)) > 1:
            fail(f"{name}, {columns} columns, {time:.2f} s: more than one line of progress:\n" + "\n".join(lines))
        for line in lines_of_progress(lines):
            if len(line.removesuffix("^C")) > columns - 3:
                fail(f"{name}: no room for ^C in {columns} columns: {line}")
    if left := lines_of_progress(seen[-1][1]) or [line for line in seen[-1][1] if "##" in line or "] " in line]:
        fail(f"{name}, {columns} columns: left when it ended: {left}")
    print(f"{name}, {columns} columns: {len(shown)} lines within the first second, "
          f"such as {sorted(shown)[-1]!r}")


with tempfile.TemporaryDirectory() as folder:
    scenarios = ROOT / "scenarios"
    one_ping = ["ping", str(scenarios / "deep_ocean.toml"), "--threads", "1", "--set", "array.phones=100"]
    field = ["field", str(scenarios / "wedge.toml"), "--threads", "1", "--set", "run.frequency=200"]
    study = ["study", str(scenarios / "studies" / "known_answer.toml"), "--threads", "1", "--set",
             "study.realisations=1000000"]
    check("ping", one_ping, 80, folder)
    check("field", field, 60, folder)
    check("study", study, 60, folder)
    check("study", study, 40, folder)

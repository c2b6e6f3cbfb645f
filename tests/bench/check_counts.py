#!/usr/bin/env python3
"""Instructions that kernels take, counted by callgrind, against those of tests/bench/counts.json.

  check_counts.py COUNT_KERNELS [--update] [--only REGEX] [--jobs N]

Noise cannot disturb a count: it changes with the code and the compiler alone. A kernel fails when it takes more than the file's
margin above its count there; well below it, the table asks for --update, which writes what was counted. Counted is the
instruction level x86-64-v3, on a processor that has it: valgrind knows no AVX-512.
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

COUNTS = pathlib.Path(__file__).with_name("counts.json")


def count(program, name):
    """Instructions of one run of a kernel, its warm-up aside."""
    with tempfile.TemporaryDirectory() as folder:
        said = subprocess.run(
            ["valgrind", "--tool=callgrind", "--toggle-collect=asdic_counted", f"--callgrind-out-file={folder}/out", program, name],
            capture_output=True, text=True, env={**os.environ, "ASDIC_LEVEL": "x86-64-v3"})
    found = re.search(r"Collected : (\d+)", said.stderr)
    if said.returncode != 0 or not found or int(found[1]) == 0:
        sys.exit(f"check_counts.py: {name}: valgrind counted nothing:\n{said.stderr[-2000:]}")
    return int(found[1])


def verdict(counted, expected, margin):
    """Returns what to print, and whether the kernel passes"""
    if expected is None:
        return "new: --update", False
    ratio = counted / expected
    if ratio > 1.0 + margin:
        return f"{100 * (ratio - 1):+.1f} %  TOO MANY", False
    return f"{100 * (ratio - 1):+.1f} %" + ("  fewer: --update" if ratio < 1.0 - margin else ""), True


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("program")
    arguments.add_argument("--update", action="store_true", help="write what was counted")
    arguments.add_argument("--only", default="", metavar="REGEX", help="kernels whose names match")
    arguments.add_argument("--jobs", type=int, default=2)
    given = arguments.parse_args()
    book = json.loads(COUNTS.read_text())
    names = subprocess.run([given.program], capture_output=True, text=True, check=True).stdout.split()
    names = [name for name in names if re.search(given.only, name)]
    if not names:
        sys.exit(f"check_counts.py: no kernel matches {given.only}")
    with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        counted = dict(zip(names, pool.map(lambda name: count(given.program, name), names)))
    failed = 0
    print(f"{'kernel':<26}{'counted':>16}{'expected':>16}")
    for name in names:
        expected = book["instructions"].get(name)
        said, good = verdict(counted[name], expected, book["margin"])
        failed += not good
        print(f"{name:<26}{counted[name]:>16,}{expected or 0:>16,}  {said}")
    if given.update:
        book["instructions"].update(counted)
        book["instructions"] = dict(sorted(book["instructions"].items()))
        COUNTS.write_text(json.dumps(book, indent=2) + "\n")
        print(f"written: {COUNTS}")
    elif failed:
        sys.exit(f"{failed} of {len(names)} kernels take more than {100 * book['margin']:.0f} % over their counts, or have none")


if __name__ == "__main__":
    main()

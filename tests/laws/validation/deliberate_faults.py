#!/usr/bin/env python3
"""tests/laws/mutations/faults.patch applies to this tree, holds all that it includes and knows the faults of
faults.txt."""
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
PATCH = ROOT / "tests/laws/mutations/faults.patch"


def main():
    if not shutil.which("git"):
        sys.exit(77)
    applied = subprocess.run(["git", "apply", "--check", str(PATCH)], cwd=ROOT, capture_output=True, text=True)
    assert applied.returncode == 0, applied.stderr[-2000:]
    patch = PATCH.read_text()
    for header in set(re.findall(r'^\+#include "(.+)"', patch, re.MULTILINE)):
        assert (ROOT / header).exists() or f"+++ b/{header}\n" in patch, f"{header} is included, but neither here nor made"
    known = set(re.findall(r'fault\("(\w+)"\)', patch))
    listed = {line.split()[0] for line in (PATCH.parent / "faults.txt").read_text().splitlines() if not line.startswith("#")}
    assert listed <= known, f"not in the patch: {sorted(listed - known)}"
    print(f"{len(listed)} faults")


main()

#!/usr/bin/env python3
"""The commands in the documentation run: every ```sh and ```python block under a line
`<!-- test -->` in README.md and docs/guide/*.md.

The blocks of one page run in order, in one working directory: a fresh copy of scenarios/ (and tests/data/bellhop), with
`asdic` on PATH. A block may end in a line `# exit 2`: then that is the exit code it must have.
Lines of output are not compared. The ```python blocks of a page are one program. It runs in the
same directory after the commands, with the built package asdic, where there is one.

    ASDIC=build/ci/bin/asdic commands_in_docs.py [PAGE.md ...]
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
TIME_LIMIT = 600  # of a block [s]
PYTHON = "/usr/bin/python3"  # that the package is built for


def blocks(page):
    """→ [(line number, language, commands)] of the marked blocks. \\throws ValueError for a mark without a
    block, or a block without an end
    """
    lines = page.splitlines()
    found = []
    for number, line in enumerate(lines):
        if line.strip() != "<!-- test -->":
            continue
        language = lines[number + 1].strip() if number + 1 < len(lines) else ""
        if language not in ("```sh", "```python"):
            raise ValueError(f"line {number + 1}: <!-- test --> without a ```sh or ```python block "
                             "just below")
        end = next((k for k in range(number + 2, len(lines)) if lines[k].strip() == "```"), None)
        if end is None:
            raise ValueError(f"line {number + 2}: a block without an end")
        found.append((number + 3, language[3:], "\n".join(lines[number + 2 : end]) + "\n"))
    return found


def program_of(todo):
    """The ```python blocks as one program with the page's line numbers; "" if there are none."""
    program = ""
    for line, language, commands in todo:
        if language == "python":
            program += "\n" * (line - 1 - program.count("\n")) + commands
    return program


def has_package(environment):
    return subprocess.run([PYTHON, "-c", "import asdic"], env=environment,
                          capture_output=True).returncode == 0


def expected_exit(commands):
    last = re.findall(r"^# exit (\d+)\s*$", commands, flags=re.M)
    return int(last[-1]) if last else 0


def run_page(page, environment):
    """Runs a page's blocks in a directory of their own. → number of blocks, faults"""
    try:
        todo = blocks(page.read_text())
    except ValueError as error:
        return 0, [f"{page.name}: {error}"]
    if not todo:
        return 0, []
    with tempfile.TemporaryDirectory(prefix="asdic_docs_") as folder:
        if (ROOT / "scenarios").is_dir():
            shutil.copytree(ROOT / "scenarios", Path(folder) / "scenarios")
            shutil.copytree(ROOT / "tests/data/bellhop", Path(folder) / "tests/data/bellhop")
        runs = [(line, commands, ["bash", "-euo", "pipefail", "-c", commands])
                for line, language, commands in todo if language == "sh"]
        program = program_of(todo)
        if program and ("asdic" not in program or has_package(environment)):
            runs.append((1, program, [PYTHON, "-W", "error::DeprecationWarning:__main__",
                                      "-c", program]))
        for line, commands, words in runs:
            try:
                done = subprocess.run(words, cwd=folder, env=environment, capture_output=True,
                                      text=True, timeout=TIME_LIMIT, stdin=subprocess.DEVNULL)
                code, said = done.returncode, done.stderr
            except subprocess.TimeoutExpired:
                code, said = None, f"not done after {TIME_LIMIT} s"
            if code != expected_exit(commands):  # the next blocks build on this one
                wanted = expected_exit(commands)
                fault = (f"{page.name}:{line}: exit {code}, expected {wanted}\n"
                         f"{commands.lstrip()}{said}")
                return len(todo), [fault]
    return len(todo), []


def proves_itself(environment):
    """Passing, failing, expected-to-fail and broken blocks are distinguished; blocks of a page share a
    directory.
    """
    def faults(text):
        with tempfile.TemporaryDirectory() as folder:
            page = Path(folder) / "page.md"
            page.write_text(text)
            return run_page(page, environment)

    sh = lambda commands: f"<!-- test -->\n```sh\n{commands}\n```\n"
    python = lambda code: f"<!-- test -->\n```python\n{code}\n```\n"
    cases = [
        (sh("true"), 1, 0), (sh("false"), 1, 1), (sh("false\ntrue"), 1, 1),
        (sh("false | cat"), 1, 1), (sh("exit 2\n# exit 2"), 1, 0),
        (sh("true\n# exit 2"), 1, 1), (sh("touch a") + sh("test -e a"), 2, 0),
        ("```sh\nfalse\n```\n", 0, 0),
        (python("assert True"), 1, 0), (python("assert False"), 1, 1),
        (python("a = 1") + python("assert a == 1"), 2, 0),
        (python("open('a')") + sh("touch a"), 2, 0), (python("open('a')"), 1, 1),
        ("<!-- test -->\ntext\n", 0, 1), ("<!-- test -->\n```sh\ntrue\n", 0, 1),
    ]
    for text, count, bad in cases:
        got_count, got_faults = faults(text)
        if (got_count, len(got_faults)) != (count, bad):
            print(f"this test is wrong about\n{text}: {got_count} blocks, faults {got_faults}")
            return False
    return True


def main():
    environment = dict(os.environ)
    program = environment.get("ASDIC")
    if program:
        folder = Path(program).resolve().parent
        environment["PATH"] = f"{folder}{os.pathsep}{environment.get('PATH', '')}"
    built = Path(environment.get("ASDIC_BUILD", ROOT / "build/release")) / "python"
    environment |= {"PYTHONPATH": str(built), "MPLBACKEND": "Agg"}
    if not proves_itself(environment):
        return 1
    known = [ROOT / "README.md", *sorted((ROOT / "docs" / "guide").glob("*.md"))]
    pages = [Path(p) for p in sys.argv[1:]] or [p for p in known if p.exists()]
    if not program or not (ROOT / "scenarios").is_dir():
        print("no program (ASDIC) or no scenarios: checked only that the blocks can be found")
        for page in pages:
            print(f"{page.name}: {len(blocks(page.read_text()))} blocks")
        return 0
    total, faults = 0, []
    for page in pages:
        count, bad = run_page(page, environment)
        total += count
        faults += bad
    print("\n".join(faults))
    print(f"{len(pages)} pages, {total} blocks, {len(faults)} pages at fault")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())

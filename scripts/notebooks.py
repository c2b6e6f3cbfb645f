#!/usr/bin/python3
"""Executes the notebooks of docs/notebooks, whose sources carry no outputs.

  scripts/notebooks.py [NAME...]    runs them; build/notebooks gets NAME.ipynb and NAME.html, outputs and all
  scripts/notebooks.py --check      sources: parsable cells, no outputs, clean metadata, readable JSON
  scripts/notebooks.py --clean      makes them so, after Jupyter saved one

A cell that fails is printed and ends it with status 1. Debian: python3-nbconvert python3-ipykernel python3-matplotlib.
The package asdic is the one that Python finds, or that of build/release/python (--build DIR for another).
"""
import argparse
import ast
import contextlib
import json
import os
import re
import sys
import tempfile
import time
import warnings
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SOURCES = ROOT / "docs/notebooks"
WIDTH = 100  # of code: what fits beside the cells' numbers
METADATA = {"kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
            "language_info": {"name": "python"}}


def cleaned(notebook: dict) -> dict:
    """The same without outputs, counts and what an editor left in the metadata."""
    cells = []
    for number, cell in enumerate(notebook["cells"], 1):
        source = cell["source"]
        lines = ("".join(source) if isinstance(source, list) else source).strip("\n")
        made = {"cell_type": cell["cell_type"], "id": f"cell-{number}", "metadata": {},
                "source": lines.splitlines(keepends=True)}
        if cell["cell_type"] == "code":
            made |= {"execution_count": None, "outputs": []}
        cells.append(dict(sorted(made.items())))
    return {"cells": cells, "metadata": METADATA, "nbformat": 4, "nbformat_minor": 5}


def text_of(notebook: dict) -> str:
    """As git holds it: a line of source a line, letters as they are."""
    return json.dumps(notebook, indent=1, ensure_ascii=False) + "\n"


def faults(path: Path) -> list[str]:
    """What is wrong with a source."""
    text = path.read_text(encoding="utf-8")
    try:
        notebook = json.loads(text)
    except ValueError as error:
        return [f"{path.name}: found {error}, expected JSON"]
    found = []
    for number, cell in enumerate(notebook["cells"], 1):
        where = f"{path.name}: cell {number}"
        if cell.get("outputs"):
            found.append(f"{where}: found outputs, expected none: scripts/notebooks.py --clean")
        if cell["cell_type"] == "code":
            found += [f"{where}: found a line of {len(line)} columns, expected at most {WIDTH}"
                      for line in "".join(cell["source"]).splitlines() if len(line) > WIDTH]
            try:
                ast.parse("".join(cell["source"]))
            except SyntaxError as error:
                found.append(f"{where}: found {error}, expected Python")
    if not found and text != text_of(cleaned(notebook)):
        found.append(f"{path.name}: found another form than git's: scripts/notebooks.py --clean")
    return found


@contextlib.contextmanager
def surroundings(build: Path):
    """What a kernel needs to find the package of a build; nothing of the user's own is touched."""
    before = dict(os.environ)
    with tempfile.TemporaryDirectory() as home:
        if (build / "python").is_dir():
            found = [str(build.resolve() / "python"), os.environ.get("PYTHONPATH", "")]
            os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, found))
        os.environ |= {"IPYTHONDIR": home, "JUPYTER_CONFIG_DIR": home, "JUPYTER_RUNTIME_DIR": home,
                       "JUPYTER_DATA_DIR": home, "PYDEVD_DISABLE_FILE_VALIDATION": "1",
                       "PYTHONDONTWRITEBYTECODE": "1"}
        try:
            yield
        finally:
            os.environ.clear()
            os.environ.update(before)


def execute(path: Path, output: Path, seconds: int = 600) -> float:
    """Runs one, in its own folder, and writes what came out. → seconds. Raises CellExecutionError."""
    import nbformat
    from nbconvert import HTMLExporter
    from nbconvert.preprocessors import ExecutePreprocessor

    warnings.simplefilter("ignore")  # of nbconvert's about itself
    notebook = nbformat.read(path, as_version=4)
    began = time.monotonic()
    try:
        ExecutePreprocessor(timeout=seconds, kernel_name="python3").preprocess(
            notebook, {"metadata": {"path": str(path.parent)}})
    finally:  # a failed one may be looked at, too
        output.mkdir(parents=True, exist_ok=True)
        nbformat.write(notebook, output / path.name)
        exporter = HTMLExporter(mathjax_url="", require_js_url="", jquery_url="")  # no network
        body, _ = exporter.from_notebook_node(notebook, {"metadata": {"name": path.stem}})
        (output / f"{path.stem}.html").write_text(body, encoding="utf-8")
    return time.monotonic() - began


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="of docs/notebooks; default: all")
    parser.add_argument("--check", action="store_true", help="look at the sources alone")
    parser.add_argument("--clean", action="store_true", help="take outputs out of the sources")
    parser.add_argument("--build", type=Path, default=ROOT / "build/release", metavar="DIR",
                        help="whose Python package is used; default: build/release")
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "build/notebooks", metavar="DIR")
    given = parser.parse_args()
    there = {path.stem: path for path in sorted(SOURCES.glob("*.ipynb"))}
    for name in given.names:
        if name not in there:
            print(f"{name}: no such notebook, expected one of {', '.join(there)}", file=sys.stderr)
            return 2
    paths = [there[name] for name in given.names] or list(there.values())
    if given.clean:
        for path in paths:
            path.write_text(text_of(cleaned(json.loads(path.read_text(encoding="utf-8")))),
                            encoding="utf-8")
        return 0
    wrong = [fault for path in paths for fault in faults(path)]
    for fault in wrong:
        print(fault, file=sys.stderr)
    if given.check or wrong:
        return 1 if wrong else 0
    failed = 0
    with surroundings(given.build):
        from nbclient.exceptions import CellExecutionError
        for path in paths:
            try:
                print(f"{path.stem}: {execute(path, given.output):.1f} s", flush=True)
            except CellExecutionError as error:
                failed += 1
                plain = re.sub("\x1b" + r"\[[0-9;]*m", "", str(error))  # without colours
                print(f"{path.stem}: FAILED\n{plain}",
                      file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

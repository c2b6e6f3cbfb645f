#!/usr/bin/env python3
"""The physics suite: every problem of docs/validation run by asdic and compared with its truth.

    scripts/validate_physics.py [PROBLEM ...] [--quick] [--asdic PATH] [--threads N] [--out FOLDER]
    [--update]

One line a problem: pass, FAIL, or gap: what should hold and is known not to hold yet, with its
error as measured. "HOLDS NOW" is a gap
that has closed; its mark in problem.py can go. Pictures and files go to out/validation. --quick
runs what takes seconds; --update writes the
measured tables and pictures into docs/validation. Exit code: 0, 1 when a bound is broken (gaps do
not count), 2 when there is nothing to run.
"""
import argparse
import importlib.util
import io
import os
import re
import sys
import traceback
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGES = ROOT / "docs" / "validation"
sys.path[:0] = [str(PAGES), str(ROOT / "python")]
sys.dont_write_bytecode = True

import suite  # noqa: E402

# as they stand in the index: fields, then echoes and noise, then reverberation
ORDER = ["lloyd", "ideal-guide", "pekeris-field", "surface-duct", "shadow-edge", "munk-zones",
         "ideal-wedge", "asa-wedge", "thesis-tables", "weston-echo", "noise-guide",
         "pekeris-reverberation", "summer-reverberation", "rigid-reverberation", "harrison-decay",
         "ellipse-reverberation", "shallow-3400", "slope-reverberation"]
BEGIN, END = "<!-- measured -->", "<!-- end of what was measured -->"
MOST_BYTES = 25_000  # of a picture


def load(name, file):
    """The module docs/validation/NAME/FILE.py, under a name of its own."""
    spec = importlib.util.spec_from_file_location(f"{name.replace('-', '_')}_{file}",
                                                  PAGES / name / f"{file}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def number(x):
    return x if isinstance(x, str) else "—" if x != x else f"{x:.3g}" if abs(x) < 10 else f"{x:.1f}"


def markdown(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join(lines + ["| " + " | ".join(number(x) for x in row) + " |" for row in rows])


def said(check):
    return f"{check.what} {check.error:.3g} {check.unit} (bound {check.bound:g})".replace(" )", ")")


def verdict(result):
    """The worst of a problem's verdicts."""
    found = {check.verdict for check in result.checks}
    return next(v for v in ("FAIL", "HOLDS NOW", "gap", "pass") if v in found)


def write_between(page, text):
    """Puts text between the marks of a page. Raises ValueError where it has none."""
    old = page.read_text()
    pattern = re.compile(re.escape(BEGIN) + ".*?" + re.escape(END), re.DOTALL)
    if not pattern.search(old):
        raise ValueError(f"{page}: found no {BEGIN} … {END}, expected one")
    page.write_text(pattern.sub(lambda _: f"{BEGIN}\n{text}\n{END}", old))


def table_of_page(result):
    checks = markdown(["what", "error", "bound", "verdict"],
                      [[c.what, f"{c.error:.3g} {c.unit}", f"{c.bound:g} {c.unit}",
                        c.verdict + (f": {c.gap}" if c.gap else "")] for c in result.checks])
    notes = "".join(f"\n\n{note}" for note in result.notes)
    return f"{checks}\n\n{markdown(result.header, result.rows)}{notes}"


def draw(result, title, file):
    """The problem's picture, in few colours, small."""
    from asdic_pictures import style
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from PIL import Image
    data = io.BytesIO()
    with style.look():
        fig = style.Picture(figsize=(6.4, 3.6), dpi=100)
        FigureCanvasAgg(fig)
        axes = fig.subplots()
        axes.set_title(title, fontsize=10)
        result.draw(axes, style)
        axes.grid(True)
        fig.savefig(data, dpi=100)
    data.seek(0)
    for colours in (48, 24, 12):
        Image.open(data).convert("RGB").quantize(colours).save(file, optimize=True)
        if file.stat().st_size <= MOST_BYTES:
            return
    raise ValueError(f"{file}: found {file.stat().st_size} bytes, expected at most {MOST_BYTES}")


def summary_rows(results):
    for name, (problem, result) in results.items():
        for k, c in enumerate(result.checks):
            yield [f"[{problem.NAME}]({name}/README.md)" if k == 0 else "",
                   problem.TRUTH if k == 0 else "", c.what, f"{c.error:.3g} {c.unit}",
                   f"{c.bound:g} {c.unit}", "holds" if c.verdict == "pass"
                   else "**does not hold yet**: " + c.gap if c.verdict == "gap"
                   else f"**{c.verdict}**"]


def main():
    arguments = argparse.ArgumentParser(description=__doc__,
                                        formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("problem", nargs="*", help="folders of docs/validation; all without")
    arguments.add_argument("--quick", action="store_true", help="only what takes seconds")
    arguments.add_argument("--asdic", default=os.environ.get("ASDIC",
        str(ROOT / "build" / "release" / "bin" / "asdic")))
    arguments.add_argument("--threads", type=int, default=1)
    arguments.add_argument("--out", type=Path, default=ROOT / "out" / "validation")
    arguments.add_argument("--update", action="store_true",
                           help="write tables and pictures into docs/validation")
    options = arguments.parse_args()

    there = [name for name in ORDER if (PAGES / name / "problem.py").is_file()]
    unknown = [name for name in options.problem if name not in there]
    if unknown or not there:
        print(f"validate_physics.py: found no problem {', '.join(unknown)}, expected some of: {' '.join(there)}",
              file=sys.stderr)
        return 2
    program = suite.Asdic(options.asdic, options.out, options.threads)
    results, broken = {}, []
    for name in options.problem or there:
        problem = load(name, "problem")
        if options.quick and not problem.QUICK:
            continue
        try:
            result = problem.compare(program, load(name, "truth"))
            draw(result, problem.NAME, options.out / f"{name}.png")
        # a problem that cannot be run is a bound that is broken; the others go on
        except Exception as fault:
            if not isinstance(fault, suite.Failed):
                traceback.print_exc()
            print(f"FAIL       {name}: {fault}", flush=True)
            broken.append(name)
            continue
        results[name] = (problem, result)
        print(f"{verdict(result):10} {name}: {'; '.join(said(c) for c in result.checks)}",
              flush=True)
        if verdict(result) == "FAIL":
            broken.append(name)
        if options.update:
            draw(result, problem.NAME, PAGES / name / "plot.png")
            write_between(PAGES / name / "README.md", table_of_page(result))
    if options.update and set(results) == set(there):
        write_between(PAGES / "README.md", markdown(["problem", "truth", "what is compared",
                                                     "error", "bound", "verdict"],
                                                     summary_rows(results)))
    elif options.update:
        print("the index is rewritten when all problems ran", flush=True)
    checks = [c for _, result in results.values() for c in result.checks]
    count = {v: sum(c.verdict == v for c in checks) for v in ("pass", "gap", "HOLDS NOW", "FAIL")}
    print(f"{len(results)} problems: {count['pass']} numbers hold, {count['gap']} are known not to "
          f"hold yet, {count['FAIL']} FAIL"
          + (f"; {count['HOLDS NOW']} hold now: take their gap out of problem.py"
             if count["HOLDS NOW"] else "")
          + (f"; broken: {' '.join(broken)}" if broken else ""))
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())

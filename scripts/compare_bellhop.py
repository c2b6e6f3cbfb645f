#!/usr/bin/env python3
"""The 16 reference cases of BELLHOP run by asdic, and how far everything is from everything.

    ASDIC=path/to/asdic scripts/compare_bellhop.sh [--times] [CASE ...]
    ASDIC=path/to/asdic scripts/compare_bellhop.sh --emulation
    ASDIC=path/to/asdic [BELLHOP=path/to/bellhop] scripts/compare_bellhop.sh --cost [CASE ...]

For each case of tests/data/bellhop: BELLHOP's default run against its converged one; asdic's own run
of case.env against the converged one; asdic's rays with exactly the fan of converged/case.env against
the converged one; and --like-bellhop against the default run. Everything by `asdic compare`. Prints
Markdown; --times adds asdic's wall times; --emulation prints how far --like-bellhop is from the forty
small cases of tests/data/bellhop-emulation instead; --cost the processor seconds that each case takes
on one thread, whole processes, least of three, by asdic's own rule and with the beams as written, and
BELLHOP's beside them if there is one. Exit code: 0, 1 when a run failed, 2 when there is
nothing to run.
"""
import json
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
DATA = ROOT / "tests" / "data" / "bellhop"
ASDIC = os.environ.get("ASDIC", str(ROOT / "build" / "release" / "bin" / "asdic"))
TIME_LIMIT = float(os.environ.get("ASDIC_TIME_LIMIT", "600"))  # of one run [s]


class Failed(Exception):
    pass


def asdic(*words):
    """→ what it printed. Raises Failed when it could not"""
    try:
        done = subprocess.run([ASDIC, *map(str, words)], capture_output=True, text=True,
                              timeout=TIME_LIMIT)
    except subprocess.TimeoutExpired:
        raise Failed(f"asdic {words[0]}: not done after {TIME_LIMIT:g} s")
    if done.returncode != 0:
        raise Failed(done.stderr.strip() or f"asdic {words[0]}: exit {done.returncode}")
    return done.stdout


def compare(a, b, *options):
    return json.loads(asdic("compare", a, b, "--json", *options))


class Case:
    """One case, and the runs of it that are there."""

    def __init__(self, name, work):
        self.name = name
        self.folder = DATA / name
        self.meta = json.loads((self.folder / "meta.json").read_text())
        self.output = self.meta["output"].split(".")[-1]        # shd, arr or ray
        self.work = work
        self.faults = []
        self.seconds = float("nan")

    def run(self, which, *options, converged=False):
        """Runs the case (or the converged one) → its output file, or None with a fault noted."""
        folder = self.work / self.name / which
        source = self.folder / "converged" if converged else self.folder
        folder.mkdir(parents=True)
        for file in [*self.folder.iterdir(), *source.iterdir()]:    # companions are with the case
            if file.is_file() and file.suffix not in (".shd", ".arr", ".ray", ".json"):
                shutil.copy(file, folder)
        started = time.monotonic()
        try:
            asdic("bellhop", folder / "case", *options)
        except Failed as fault:
            self.faults.append(f"{self.name}, {which}: {fault}")
            return None
        self.seconds = time.monotonic() - started
        return folder / f"case.{self.output}"

    def against(self, a, b, *options):
        """→ figures of two files, or None"""
        if a is None or not a.exists():
            return None
        try:
            return compare(a, b, *options)
        except Failed as fault:
            self.faults.append(f"{self.name}: {fault}")
            return None

    @property
    def default(self):
        return self.folder / f"case.{self.output}"

    @property
    def converged(self):
        return self.folder / "converged" / f"case.{self.output}"


def figure(value):
    if value is None:
        return "–"
    if 0 < abs(value) < 1e-3:
        return "< 0.001"
    return f"{value:.2g}" if abs(value) < 10 else f"{value:.0f}"


def pair(figures, key, first="median", second="p95"):
    spread = figures and figures.get(key)
    return "–" if not spread else f"{figure(spread[first])} / {figure(spread[second])}"


def row(*cells):
    return "| " + " | ".join(str(c) for c in cells) + " |"


def table(head, rows, times=True):
    """The last column is of times, or goes."""
    lines = [row(*head), row(*["---"] * len(head)), *rows]
    return "\n".join(lines if times else [line[:-2].rpartition("|")[0] + "|" for line in lines])


def field_row(case):
    own = case.run("own")
    seconds = case.seconds
    fan = case.run("fan", "--beams-as-written", converged=True)
    like = case.run("like", "--like-bellhop")
    bellhop = case.against(case.default, case.converged)
    mine = case.against(own, case.converged)
    level = "–" if mine is None else f"{mine['level_db']:+.2f}"
    return row(f"`{case.name}`", pair(bellhop, "tl_db"),
               f"{case.meta['figures']['residual']['dtl_median']:.2g} / "
               f"{case.meta['figures']['residual']['dtl_p95']:.2g}",
               pair(mine, "tl_db"), level, pair(case.against(fan, case.converged), "tl_db"),
               pair(case.against(like, case.default), "tl_db"), f"{seconds:.1f}")


def arrival_cells(figures):
    if figures is None:
        return ["–"] * 4
    strong = figures["strong_matched_pct"]
    return [f"{figures['matched_pct']:.1f} ({strong:.1f})", pair(figures, "delay_us"),
            pair(figures, "amplitude_db"), figure((figures["arrival_angle_deg"] or {}).get("p95"))]


def arrival_rows(case):
    own = case.run("own")
    seconds = case.seconds
    like = case.run("like", "--like-bellhop")
    residual = case.meta["figures"]["residual"]
    return [row(f"`{case.name}`", "BELLHOP's default against its converged",
                *arrival_cells(case.against(case.default, case.converged)), ""),
            row("", "residual of the converged", f"{residual['matched_pct']:.1f}",
                f"{figure(residual.get('d_delay_us_median'))} / "
                f"{figure(residual.get('d_delay_us_p95'))}",
                f"{figure(residual.get('d_amp_db_median'))} / "
                f"{figure(residual.get('d_amp_db_p95'))}",
                figure(residual.get("d_rcv_deg_p95")), ""),
            row("", "asdic against BELLHOP's converged",
                *arrival_cells(case.against(own, case.converged)), f"{seconds:.2f}"),
            row("", "like BELLHOP against its default",
                *arrival_cells(case.against(like, case.default)), "")]


def ray_cells(figures):
    if figures is None:
        return ["–"] * 3
    inside = figures["inside_m"]
    return [f"{figures['paired']} of {figures['rays_b']}",
            "–" if not inside else f"{figure(inside['median'])} / {figure(inside['max'])}",
            pair(figures, "end_m", "median", "max")]


def ray_rows(case):
    # exact eigenrays are other rays than those of a fan that come near the receiver
    wide = ["--pair-deg", "0.2"] if case.meta["run"].startswith("E") else []
    own, like = case.run("own"), case.run("like", "--like-bellhop")
    return [row(f"`{case.name}`", "BELLHOP's default against its converged",
                *ray_cells(case.against(case.default, case.converged))),
            row("", "asdic against BELLHOP's converged",
                *ray_cells(case.against(own, case.converged, *wide))),
            row("", "like BELLHOP against its default",
                *ray_cells(case.against(like, case.default)))]


def emulation():
    """Prints the table of the emulation's cases. → exit code"""
    faults, fields, arrivals = [], [], []
    root = DATA.parent / "bellhop-emulation"
    with tempfile.TemporaryDirectory(prefix="asdic_bellhop_") as work:
        for env in sorted(root.rglob("case.env")):
            name = env.parent.relative_to(root).as_posix()
            outputs = env.with_suffix(".shd"), env.with_suffix(".arr")
            output = next(file for file in outputs if file.exists())
            ours = Path(work) / name.replace("/", "-") / "case"
            ours.parent.mkdir()
            try:
                asdic("bellhop", env.with_suffix(""), "--like-bellhop", "-o", ours)
                d = compare(ours.with_suffix(output.suffix), output)
            except Failed as fault:
                faults.append(f"{name}: {fault}")
                continue
            if output.suffix == ".shd":
                tl = d["tl_db"]
                fields.append(row(f"`{name}`", *(f"{tl[k]:.1e}" for k in ("median", "p99", "max")),
                                  f"{d['one_sided_pct']:.2g}"))
            else:
                arrivals.append(row(f"`{name}`", d["rows_a"], d["rows_b"], f"{d['matched_pct']:g}",
                                    *(f"{d[k]['p99']:.1e}" for k in ("delay_us", "amplitude_db"))))
    print("Fields: |ΔTL| [dB]\n")
    print(table(["case", "median", "99 %", "max", "one-sided cells %"], fields))
    print("\nArrivals: at 99 %\n")
    print(table(["case", "rows", "BELLHOP's", "matched %", "delay µs", "amplitude dB"], arrivals))
    for fault in faults:
        print(f"compare_bellhop: {fault}", file=sys.stderr)
    return 1 if faults else 0


def processor_seconds(*command, folder):
    """→ user and system time of the least of three runs [s]; NaN: it failed"""
    least = float("nan")
    for _ in range(3):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run(list(map(str, command)), cwd=folder, capture_output=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if done.returncode != 0:
            return float("nan")
        seconds = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
        least = min(seconds, least) if least == least else seconds
    return least


def cost(cases):
    """Prints the table of the cases' cost. → exit code"""
    bellhop, rows, failed = os.environ.get("BELLHOP"), [], False
    for case in cases:
        folder = case.work / case.name
        folder.mkdir(parents=True)
        for file in case.folder.iterdir():
            if file.is_file() and file.suffix not in (".shd", ".arr", ".ray", ".json"):
                shutil.copy(file, folder)
        cells = [f"`{case.name}`"]
        for options in ([], ["--beams-as-written"]):
            seconds = processor_seconds(ASDIC, "bellhop", "case", "--threads", "1", *options,
                                        folder=folder)
            failed = failed or seconds != seconds
            report = (folder / "case.prt").read_text() if seconds == seconds else ""
            beams = [line.split()[1] for line in report.splitlines()
                     if line.startswith("beams ") and line.endswith("a source")]
            cells += [f"{seconds:.3f}", beams[0] if beams else "–"]
        theirs = processor_seconds(bellhop, "case", folder=folder) if bellhop else float("nan")
        rows.append(row(*cells, f"{theirs:.3f}" if theirs == theirs else "–"))
    print(table(["case", "own rule, s", "beams", "as written, s", "beams", "BELLHOP, s"], rows))
    return 1 if failed else 0


def main(names):
    if names == ["--emulation"]:
        return emulation()
    costs = "--cost" in names
    names = [name for name in names if name != "--cost"]
    times = "--times" in names
    names = [name for name in names if name != "--times"]
    every = sorted(p.parent.name for p in DATA.glob("*/meta.json"))
    names = names or every
    if not every or not set(names) <= set(every):
        print(f"compare_bellhop: no such case; there are {', '.join(every)}", file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory(prefix="asdic_bellhop_") as folder:
        cases = [Case(name, Path(folder)) for name in names]
        if costs:
            return cost(cases)
        of = {kind: [c for c in cases if c.output == kind] for kind in ("shd", "arr", "ray")}
        if of["shd"]:
            print("Fields: |ΔTL| median / 95 % of the cells below 120 dB [dB]\n")
            print(table(["case", "BELLHOP's default against its converged",
                         "residual of the converged", "asdic against the converged",
                         "its mean level, dB", "asdic with the converged fan",
                         "like BELLHOP against its default", "asdic, s"],
                        [field_row(c) for c in of["shd"]], times))
        if of["arr"]:
            print("\nArrivals: paths joined, within 40 dB of the strongest; spreads as median / 95 %\n")
            print(table(["case", "", "matched % (within 20 dB)", "delay µs", "amplitude dB",
                         "angle °, 95 %", "asdic, s"],
                        [r for c in of["arr"] for r in arrival_rows(c)], times))
        if of["ray"]:
            print("\nRays: distance from the other's path, median / max over the rays [m]\n")
            print(table(["case", "", "paired", "end points aside", "end points"],
                        [r for c in of["ray"] for r in ray_rows(c)]))
        faults = [fault for c in cases for fault in c.faults]
    for fault in faults:
        print(f"compare_bellhop: {fault}", file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

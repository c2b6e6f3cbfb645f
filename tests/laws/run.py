#!/usr/bin/env python3
"""The law machine: draws scenarios, holds them to laws, shrinks what fails and keeps it. docs/develop/laws.md.

    run.py                               replays what was found, then makes some 60 draws with the seed of the day
    run.py --minutes 60 --jobs 2         an hour of draws; --seed S, --law NAME (again for more), --draws N
    run.py --replay [NAME ...]           replays alone
    run.py --faults [NAME ...]           which law finds which deliberate fault (scripts/laws_mutations.sh)

A draw is a scenario held to a law. A scenario is held to several, which share its runs.
"""
import argparse
import collections
import datetime
import hashlib
import json
import os
import random
import re
import signal
import subprocess
import sys
import time
import tomllib
import traceback
from pathlib import Path

sys.dont_write_bytecode = True
HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import hypothesis  # noqa: E402
from hypothesis import HealthCheck, Phase, given, settings, strategies as st  # noqa: E402
from hypothesis.errors import Flaky, UnsatisfiedAssumption  # noqa: E402

import covering  # noqa: E402
import program  # noqa: E402
import scenarios  # noqa: E402
from law import LAWS, Silent, copied  # noqa: E402
from program import Dear, Refused, Violation, spent  # noqa: E402
import bounds, cost, limits, live, refinement, same_bits, summary, symmetry  # noqa: E402,E401,F401

FOUND = HERE / "found"
OUTCOMES = ("held", "silent", "refused", "dear", "known", "violated")
EACH = 8  # laws that a scenario is held to
BUDGET = 20.0  # seconds of processor time, after which a scenario meets no further law


class Enough(BaseException):
    """The time for shrinking is over; no Exception, so Hypothesis lets it through."""


class Parameters:
    """What a law chooses beside its scenario, each of a few values: by a number that is drawn, or as it was kept.

    The number 0, towards which Hypothesis shrinks, chooses the first value of each.
    """

    def __init__(self, number=0, values=None):
        self.number, self.values = number, {} if values is None else dict(values)

    def __call__(self, name, choices):
        if name not in self.values:
            self.values[name] = choices[0] if self.number == 0 else random.Random(f"{self.number} {name}").choice(choices)
        return self.values[name]


def known():
    """Faults that are known and not mended yet: lists of `found` names, and of laws under conditions."""
    with open(HERE / "known.toml", "rb") as file:
        return tomllib.load(file)


def is_known(law, s, text):
    """The reason why a violation of a random draw is expected, or None: a law, levels that were drawn, words of the fault."""
    for one in known().get("draws", ()):
        if one["law"] in ("*", law) and re.search(one.get("says", ""), text) and all(
                s["_levels"].get(name, "absent") in values for name, values in one.get("levels", {}).items()):
            return one["reason"]
    return None


def attempt(law, s, p):
    """(outcome, text) of a law on a scenario."""
    try:
        LAWS[law](copied(s), p)
    except Silent as why:
        return "silent", str(why)
    except Refused as why:
        return "refused", str(why)
    except Dear as why:
        return "dear", str(why)
    except Violation as why:
        return "violated", str(why)
    except (KeyError, IndexError, TypeError, ValueError, ConnectionError):  # a law that does not fit: a fault of its own
        return "violated", "the law itself fails: " + traceback.format_exc(limit=-2)
    return "held", ""


def drawn(row, levels, seed, test, phases=(Phase.generate,)):
    """Calls test(scenario, number) with what Hypothesis draws about a row; again while it raises Violation, to shrink it."""
    failed = False

    @hypothesis.seed(seed)
    @settings(max_examples=1, database=None, deadline=None, derandomize=False, print_blob=False, report_multiple_bugs=False,
              phases=phases, suppress_health_check=list(HealthCheck))
    @given(st.data())
    def once(data):
        nonlocal failed
        # Hypothesis first tries examples that are zero but for their first draw, which say nothing about the row.
        first, second = data.draw(st.integers(0, 255)), data.draw(st.integers(0, 255))
        if 0 in (first, second) and not failed:
            hypothesis.reject()
        s = data.draw(scenario_of(row, levels))
        number = data.draw(st.integers(0, 255))
        try:
            test(s, number)
        except Violation:
            failed = True
            raise

    try:
        once()
    except (Violation, Flaky, UnsatisfiedAssumption, Enough):
        pass


@st.composite
def scenario_of(draw, row, levels):
    return scenarios.scenario(draw, row, levels)


def shrunk(law, row, levels, seed, seconds):
    """The simplest violation of a law that is found in some seconds of processor time: (text, scenario, parameters)."""
    simplest, end = None, spent() + seconds

    def test(s, number):
        nonlocal simplest
        if simplest is not None and spent() > end:
            raise Enough
        p = Parameters(number)
        outcome, text = attempt(law, s, p)
        if outcome == "violated" and is_known(law, s, text) is None:
            simplest = text, s, p.values
            raise Violation(re.sub(r"[0-9.e+-]+", "#", text))

    drawn(row, levels, seed, test, (Phase.generate, Phase.shrink))
    return simplest


def written(law, s, values, text, origin):
    """A found case as a file: the scenario, and in its first lines what the law needs beside it."""
    more = {"law": law, "hz": s["_hz"], "span": s["_span"], "with": values}
    if s.get("_files"):
        more["files"] = s["_files"]
    return f"# {origin}\n# seen: {' '.join(text.split())}\n#: {json.dumps(more)}\n" + program.toml(s)


def read(path):
    """(law, scenario, parameters) of a found case."""
    text = path.read_text()
    more = json.loads(next(line for line in text.splitlines() if line.startswith("#: "))[3:])
    s = tomllib.loads(text)
    s |= {"_hz": more["hz"], "_span": more["span"], "_files": more.get("files", {}), "_levels": {}}
    return more["law"], s, more["with"]


def replay(names):
    """Whether every found case is as expected: it holds, or it is known and fails."""
    good, expected = True, known().get("found", {})
    for path in sorted(FOUND.glob("*.toml")):
        if names and path.stem not in names:
            continue
        law, s, values = read(path)
        outcome, text = attempt(law, s, Parameters(values=values))
        if outcome == "violated" and path.stem in expected:
            print(f"  known     {path.stem}: {expected[path.stem]}")
        elif outcome == "violated":
            good = False
            print(f"  VIOLATED  {path.stem}: {law}: {text}")
        elif path.stem in expected:
            good = False
            print(f"  MENDED    {path.stem}: {law} holds now ({outcome}): take it out of tests/laws/known.toml")
        else:
            print(f"  {outcome:9} {path.stem}")
    return good


def scenes(options, job):
    """Rows of the covering array with a scenario about each: (row, seed, scenario, number for parameters)."""
    levels = scenarios.factors()
    for n, row in enumerate(covering.rows(levels, options.seed * 1000 + job)):
        seed = int.from_bytes(hashlib.sha256(f"{options.seed} {job} {n}".encode()).digest()[:8], "big")
        got = []
        drawn(row, levels, seed, lambda s, number: got.append((s, number)))
        if got:
            yield row, seed, *got[-1]


def work(options, job):
    """Draws of one process: (law, outcome, text, scenario, parameters, row, seed).

    Every law comes as often as any other: where a scenario has used up its time, the next goes on with the next law.
    """
    names = options.law or list(LAWS)
    end = time.monotonic() + 60 * options.minutes if options.minutes else None
    draws, turn = -(-options.draws // options.jobs), job * len(names) // options.jobs
    n = 0
    for row, seed, s, number in scenes(options, job):
        began = spent()
        for _ in range(min(EACH, len(names))):
            if (time.monotonic() > end) if end else (n >= draws):
                return
            law, p = names[turn % len(names)], Parameters(number)
            outcome, text = attempt(law, s, p)
            if outcome == "violated" and (why := is_known(law, s, text)) is not None:
                outcome, text = "known", why
            yield law, outcome, text, s, p.values, row, seed
            n, turn = n + 1, turn + 1
            if spent() - began > BUDGET:
                break


def until_stopped(draws):
    """The draws until SIGTERM comes: what has been counted by then is told."""
    stopped = []
    signal.signal(signal.SIGTERM, lambda *_: stopped.append(True))
    for one in draws:
        yield one
        if stopped:
            return


def report(options, job, out):
    counts = collections.defaultdict(collections.Counter)
    levels, began = scenarios.factors(), spent()
    for law, outcome, text, s, values, row, seed in until_stopped(work(options, job)):
        counts[law][outcome] += 1
        counts["_"]["seconds"] = spent() - began
        if outcome == "violated":
            print(f"  VIOLATED  {law}: {text}", flush=True)
            origin = f"{law}: drawn by scripts/laws.sh, seed {options.seed}, job {job}"
            as_drawn = written(law, s, values, text, origin)
            text, s, values = shrunk(law, row, levels, seed, options.shrink) or (text, s, values)
            name = f"{law}-{hashlib.sha256(program.toml(s).encode()).hexdigest()[:6]}"
            folder = Path(options.keep)
            folder.mkdir(parents=True, exist_ok=True)
            (folder / f"{name}.toml").write_text(written(law, s, values, text, origin))
            (folder / f"{name}.drawn").write_text(as_drawn)  # for a developer: a shrunk case can be another fault
            print(f"  kept as   {name}: {text}", flush=True)
            began = spent() - counts["_"]["seconds"]  # shrinking is no draw
        elif options.verbose:
            print(f"  {outcome:9} {law}: {text[:300]}", flush=True)
        if out is not None:
            out.write_text(json.dumps({k: dict(v) for k, v in counts.items()}))
    return counts


def find_faults(options):
    """Prints for each deliberate fault and its law the number of draws until it is found, and whether all are.

    A fault is found by a scenario on which the law is broken with it and not broken without it.
    """
    lines = [line.split() for line in (HERE / "mutations/faults.txt").read_text().splitlines() if not line.startswith("#")]
    drawing, pool, good = scenes(options, 0), [], True
    for fault, law in lines:
        if options.faults and fault not in options.faults or options.law and law not in options.law:
            continue
        outcomes, said = collections.Counter(), None
        for n in range(options.draws):
            if n == len(pool):
                pool.append(next(drawing)[2:])
            s, number = pool[n]
            os.environ["ASDIC_FAULT"] = fault
            outcome, text = attempt(law, s, Parameters(number))
            del os.environ["ASDIC_FAULT"]
            if outcome == "violated" and attempt(law, s, Parameters(number))[0] != "violated":
                said = f"found after {n + 1} draws: {text[:120]}"
                break
            outcomes[outcome] += 1
        good &= said is not None
        print(f"{fault:22} {law:28} {said or f'NOT FOUND in {options.draws} draws: {dict(outcomes)}'}", flush=True)
    return good


def table(counts):
    seconds = counts.pop("_", {}).get("seconds", 0.0)
    print(f"{'law':30}" + "".join(f"{name:>10}" for name in OUTCOMES))
    total = collections.Counter()
    for law in sorted(counts):
        total.update(counts[law])
        print(f"{law:30}" + "".join(f"{counts[law].get(name, 0):>10}" for name in OUTCOMES))
    print(f"{'all':30}" + "".join(f"{total.get(name, 0):>10}" for name in OUTCOMES) + f"   {sum(total.values())} draws, {seconds:.0f} s of processor time")


def day_of_commit():
    """The day of the last commit as a number, so that the same sources have the same draws: 20261130; 1 outside of git."""
    try:
        said = subprocess.run(["git", "log", "-1", "--format=%cd", "--date=format:%Y%m%d"], cwd=HERE, capture_output=True, text=True)
    except OSError:  # no git on this machine
        return 1
    return int(said.stdout) if said.returncode == 0 and said.stdout.strip() else 1


def main():
    today = int(datetime.datetime.now(datetime.timezone.utc).strftime("%Y%m%d"))
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--minutes", type=float)
    parser.add_argument("--draws", type=int, default=60)
    parser.add_argument("--seed", type=int, default=today)
    parser.add_argument("--seed-of-commit", action="store_true", help="seed: the day of the last commit, or 1 where there is none")
    parser.add_argument("--law", action="append", choices=sorted(LAWS))
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--shrink", type=float, default=60.0, help="seconds of processor time for which a failing draw is shrunk")
    parser.add_argument("--keep", default=str(FOUND), help="folder for what is found")
    parser.add_argument("--replay", nargs="*", metavar="NAME")
    parser.add_argument("--no-replay", action="store_true")
    parser.add_argument("--faults", nargs="*", metavar="NAME")
    parser.add_argument("--verbose", action="store_true")
    options = parser.parse_args()
    if options.seed_of_commit:
        options.seed = day_of_commit()
    if options.replay is not None:
        sys.exit(0 if replay(options.replay) else 1)
    if options.faults is not None:
        sys.exit(0 if find_faults(options) else 1)
    print(f"laws: seed {options.seed}" + (f", {options.minutes:g} minutes" if options.minutes else f", {options.draws} draws"), flush=True)
    good = options.no_replay or replay([])
    if options.jobs > 1:
        counts = in_processes(options)
    else:
        counts = report(options, 0, None)
    table(counts)
    violated = sum(one.get("violated", 0) for one in counts.values())
    if violated:
        print(f"{violated} violations, kept in {options.keep}: a law that is broken, or a tolerance that is wrong")
    sys.exit(0 if good and not violated else 1)


def in_processes(options):
    import tempfile
    folder = Path(tempfile.mkdtemp(prefix="laws."))
    children = []
    for job in range(options.jobs):
        child = os.fork()
        if child == 0:
            report(options, job, folder / f"{job}.json")
            os._exit(0)
        children.append(child)
    for child in children:
        os.waitpid(child, 0)
    counts = collections.defaultdict(collections.Counter)
    for job in range(options.jobs):
        path = folder / f"{job}.json"
        for law, one in (json.loads(path.read_text()) if path.exists() else {}).items():
            counts[law].update(one)
    return counts


if __name__ == "__main__":
    main()

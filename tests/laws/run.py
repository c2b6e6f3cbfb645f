#!/usr/bin/env python3
"""The law machine: draws scenarios, holds them to laws, shrinks what fails and keeps it. docs/develop/laws.md.

    run.py --draws 0                     CI: replays what was found; run.py alone: some 60 draws with the seed of the day as well
    run.py --minutes 60 --jobs 2         an hour of draws; --seed S, --law NAME (again for more), --draws N
    run.py --replay [NAME ...]           replays alone
"""
import argparse
import collections
import datetime
import hashlib
import json
import os
import re
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
from hypothesis.internal.conjecture import engine  # noqa: E402

import covering  # noqa: E402
import program  # noqa: E402
import scenarios  # noqa: E402
from law import LAWS, Silent, copied  # noqa: E402
from program import Dear, Refused, Violation  # noqa: E402
import bounds, cost, limits, live, refinement, same_bits, summary, symmetry  # noqa: E402,E401,F401

FOUND = HERE / "found"
OUTCOMES = ("held", "silent", "refused", "dear", "known", "violated")


class Parameters:
    """What a law draws beside its scenario, kept so that it can be replayed."""

    def __init__(self, draw=None, values=None):
        self.draw, self.values = draw, {} if values is None else dict(values)

    def __call__(self, name, strategy):
        if name not in self.values:
            self.values[name] = strategy.example() if self.draw is None else self.draw(strategy)
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


def attempt(law, s, values):
    """(outcome, text) of a law on a scenario."""
    try:
        LAWS[law](copied(s), values if isinstance(values, Parameters) else Parameters(values=values))
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


def hold(law, row, levels, seed, shrink_seconds):
    """Draws a scenario about a row, holds it to a law, and shrinks it where it fails: (outcome, text, scenario, parameters)."""
    last = {"outcome": ("held", ""), "first": None}
    engine.MAX_SHRINKING_SECONDS = shrink_seconds

    @hypothesis.seed(seed)
    @settings(max_examples=1, database=None, deadline=None, derandomize=False, print_blob=False, report_multiple_bugs=False,
              phases=(Phase.generate, Phase.shrink), suppress_health_check=list(HealthCheck))
    @given(st.data())
    def holds(data):
        # Hypothesis first tries examples that are zero but for their first draw, which say nothing about the row.
        first, second = data.draw(st.integers(0, 255)), data.draw(st.integers(0, 255))
        if 0 in (first, second) and "violated" not in last:
            hypothesis.reject()
        s = data.draw(scenario_of(row, levels))
        p = Parameters(draw=data.draw)
        outcome, text = attempt(law, s, p)
        if last["first"] is None:
            last["first"] = True
            last["outcome"] = (outcome, text, s, dict(p.values))
        if outcome == "violated" and is_known(law, s, text) is None:
            last["violated"] = (outcome, text, s, dict(p.values))
            raise Violation(re.sub(r"[0-9.e+-]+", "#", text))
        if outcome == "violated":
            last["outcome"] = ("known", is_known(law, s, text), s, dict(p.values))

    try:
        holds()
    except (Violation, Flaky, UnsatisfiedAssumption):
        pass
    return last.get("violated", last["outcome"] if len(last["outcome"]) == 4 else (*last["outcome"], None, {}))


@st.composite
def scenario_of(draw, row, levels):
    return scenarios.scenario(draw, row, levels)


def written(law, s, values, text, origin):
    """A found case as a file: the scenario, and in its first lines what the law needs beside it."""
    more = {"law": law, "hz": s["_hz"], "span": s["_span"], "with": values}
    if s.get("_files"):
        more["files"] = s["_files"]
    return f"# {origin}\n# seen: {text}\n#: {json.dumps(more)}\n" + program.toml(s)


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
        outcome, text = attempt(law, s, values)
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


def work(options, job):
    """Draws of one process; yields (law, outcome, text, scenario, parameters, number of the row)."""
    levels = scenarios.factors()
    names = options.law or list(LAWS)
    rows = covering.rows(levels, options.seed * 1000 + job)
    end = time.monotonic() + 60 * options.minutes if options.minutes else None
    n = 0
    row_number = -1
    row = None
    draws = -(-options.draws // options.jobs)
    while (time.monotonic() < end) if end else (n < draws):
        if row is None or n % options.each == 0:
            row, row_number = next(rows), row_number + 1
        # Every row meets `each` laws, and every law comes as often as any other.
        law = names[(n + job * len(names) // max(options.jobs, 1)) % len(names)]
        seed = int.from_bytes(hashlib.sha256(f"{options.seed} {job} {n}".encode()).digest()[:8], "big")
        yield (law, *hold(law, row, levels, seed, options.shrink), row_number)
        n += 1


def report(options, job, out):
    counts = collections.defaultdict(collections.Counter)
    for n, (law, outcome, text, s, values, row) in enumerate(work(options, job)):
        counts[law][outcome] += 1
        if outcome == "violated":
            origin = f"{law}: drawn by scripts/laws.sh, seed {options.seed}, job {job}, row {row}"
            name = f"{law}-{hashlib.sha256(program.toml(s).encode()).hexdigest()[:6]}"
            folder = Path(options.keep)
            folder.mkdir(parents=True, exist_ok=True)
            (folder / f"{name}.toml").write_text(written(law, s, values, text, origin))
            print(f"  VIOLATED  {name}: {text}", flush=True)
            if options.until_found:
                print(f"found after {n + 1} draws", flush=True)
                break
        elif options.verbose:
            print(f"  {outcome:9} {law}: {text[:300]}", flush=True)
        if out is not None:
            out.write_text(json.dumps({k: dict(v) for k, v in counts.items()}))
    return counts


def table(counts):
    print(f"{'law':30}" + "".join(f"{name:>10}" for name in OUTCOMES))
    total = collections.Counter()
    for law in sorted(counts):
        total.update(counts[law])
        print(f"{law:30}" + "".join(f"{counts[law].get(name, 0):>10}" for name in OUTCOMES))
    print(f"{'all':30}" + "".join(f"{total.get(name, 0):>10}" for name in OUTCOMES) + f"   {sum(total.values())} draws")


def main():
    today = int(datetime.datetime.now(datetime.timezone.utc).strftime("%Y%m%d"))
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--minutes", type=float)
    parser.add_argument("--draws", type=int, default=60)
    parser.add_argument("--each", type=int, default=1, help="laws that each row of the covering array meets")
    parser.add_argument("--seed", type=int, default=today)
    parser.add_argument("--law", action="append", choices=sorted(LAWS))
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--shrink", type=float, default=60.0, help="seconds for which a failing draw is shrunk")
    parser.add_argument("--keep", default=str(FOUND), help="folder for what is found")
    parser.add_argument("--replay", nargs="*", metavar="NAME")
    parser.add_argument("--no-replay", action="store_true")
    parser.add_argument("--until-found", action="store_true", help="ends with the first violation")
    parser.add_argument("--verbose", action="store_true")
    options = parser.parse_args()
    if options.replay is not None:
        sys.exit(0 if replay(options.replay) else 1)
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

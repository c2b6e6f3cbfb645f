"""What a run takes is what `validate` has predicted. Processor time and memory, never the wall's clock."""
import re

from law import Silent, expect, law
from program import Dear, Violation, bytes_of, cost

EMPTY = 120e6  # of the program with its libraries, before it has done anything


@law
def memory_as_predicted(s, p):
    """A run takes no more than three times what `validate` says, beside the program itself."""
    _, _, said = cost(s, "validate")
    if "were not looked at to the end" in said:
        raise Silent("validate says that its paths take too long and the memory is not known")
    found = re.search(r"takes at most about ([0-9.]+ ?[kMGT]?i?B)", said)
    expect(found, "validate tells no memory")
    _, used, _ = cost(s, "ping", "-o", "o.h5", "-q", "--threads", "1")
    expect(used <= 3 * bytes_of(found.group(1)) + EMPTY, f"{used / 1e6:.0f} MB, predicted {found.group(1)}")


@law
def time_as_predicted(s, p):
    """Where `validate` tells a time of searches, a run takes at most three times that and ten seconds; validate itself takes
    no more than the run and two seconds."""
    checked, _, said = cost(s, "validate")
    taken, _, _ = cost(s, "ping", "-o", "o.h5", "-q", "--threads", "1")
    found = re.search(r"about ([0-9.]+) (s|min) of processor time", said)
    if found:
        predicted = float(found.group(1)) * (60.0 if found.group(2) == "min" else 1.0)
        expect(taken <= 3 * predicted + 10.0, f"{taken:.1f} s, predicted {predicted:.1f} s")
    expect(checked <= taken + 2.0, f"validate takes {checked:.1f} s, the run {taken:.1f} s")


@law
def small_draws_are_quick(s, p):
    """A draw has at most 6000 independent samples a phone and a few bounces: twenty seconds of one core are a fault of cost.

    That is ten of a core by itself: another process on it doubles them. Thirty in three dimensions, where a search takes
    0.2 s and ends that move need some eighty of them.
    """
    try:
        taken, _, _ = cost(s, "ping", "-o", "o.h5", "-q", "--threads", "1")
    except Dear as why:
        raise Violation(str(why)) from None
    most = 30.0 if s["propagation"].get("dimension", 2) == 3 else 20.0
    expect(taken <= most, f"{taken:.1f} s of processor time")

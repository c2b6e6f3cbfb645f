"""Nothing is louder than physics allows, and every valid scenario runs."""
import math

import numpy as np

import program
from law import db, expect, law, need_leg, ping, plain
from program import Folder, Refused, run


@law
def runs(s, p):
    """A draw runs, and all its numbers are finite."""
    record = ping(s)
    expect(np.all(np.isfinite(record.pressure)), "samples that are not finite")
    for table in ("arrivals", "echoes"):
        for name, values in getattr(record, table).items():
            if name in ("latitude", "longitude") or not np.issubdtype(np.asarray(values).dtype, np.floating):
                continue
            bad = ~np.isfinite(values) & ~((name.endswith("_db")) & np.isinf(values))
            expect(not np.any(bad), f"/{table}/{name}: {int(np.sum(bad))} numbers are not finite")


@law
def validate_agrees(s, p):
    """`validate` takes what `ping` takes, and refuses what it refuses."""
    try:
        ping(s)
        taken = True
    except Refused as refusal:
        taken, why = False, str(refusal)
    with Folder(s) as folder:
        try:
            run(folder, "validate", "s.toml")
            valid = True
        except Refused as refusal:
            valid, why = False, str(refusal)
    expect(taken == valid, f"ping {'takes' if taken else 'refuses'}, validate {'takes' if valid else 'refuses'}: "
           + ("" if taken and valid else why))
    if not taken:
        raise Refused(why)


def bound(hz, metres, slowest, rises):
    """The greatest intensity of one path re 1 m, a bound of energy flux.

    In water of one speed with flat boundaries a path spreads as 1/s². Elsewhere a field at the range r is a sum of
    modes, |p| ≤ sqrt(2π/(kr))·Σ|ψ_n(z_s)ψ_n(z)|, and by Cauchy–Schwarz it is largest where both ends are the same:
    Σψ_n² ≤ 2k/π, twice the mean density of modes, since sin² ≤ 1. So |p|² ≤ (2π/(kr))·(2k/π)² = 16/(λr), times
    (c_max/c_min)² since k is not the same at both ends: a gain of 16 r/λ over 1/r².
    """
    if not rises:
        return 1.0 / metres ** 2
    return max(1.0 / metres ** 2, 1.1 * 16.0 * hz / (slowest * metres))


@law
def path_is_bounded(s, p):
    """No path is louder than energy flux allows: mean field and what is scattered about it together."""
    record = ping(plain(s))
    e = s["environment"]
    isovelocity = e["sound_speed"]["kind"] == "isovelocity"
    bends = not isovelocity or any("shape" in e.get(b, {}) for b in ("surface", "bottom")) or "area" in e
    for leg in (0, 1, 2):
        rows = record.leg(leg, -1 if leg == 2 else 0)
        if not rows:
            continue
        intensity = rows["amplitude_real"] ** 2 + rows["amplitude_imag"] ** 2 + np.nan_to_num(rows["scattered"])
        for k in range(len(intensity)):
            length = float(rows["path_length"][k])
            if length < 1500.0 / s["_hz"]:
                continue
            most = bound(s["_hz"], length, 1400.0, bends)
            # 0.05 dB: path lengths are told to a relative 1e-6 and reflections are at most 1.
            expect(db(intensity[k]) <= db(most) + 0.05,
                   f"leg {leg}, path {k} of {length:.1f} m: {db(intensity[k]):.1f} dB, at most {db(most):.1f} dB")


@law
def leg_is_bounded(s, p):
    """All paths of a leg together: the bound of modes holds for their coherent sum; 3 dB are for what images add up to."""
    record = ping(plain(s))
    rows = need_leg(record)
    a = rows["amplitude_real"] + 1j * rows["amplitude_imag"]
    total = abs(np.sum(a * np.exp(-2j * np.pi * s["_hz"] * rows["delay"]))) ** 2
    r = max(float(np.min(rows["path_length"])), 1e-3)
    most = max(bound(s["_hz"], r, 1400.0, True), np.sum(1.0 / np.maximum(rows["path_length"], 1e-3)) ** 2)
    expect(db(total) <= db(most) + 3.0, f"{db(total):.1f} dB, at most {db(most) + 3.0:.1f} dB")


@law
def delays_are_possible(s, p):
    """No path is faster than a straight line through the fastest water, or slower than its own length in the slowest."""
    record = ping(plain(s))
    e = s["environment"]["sound_speed"]
    for leg in (0, 1):
        rows = record.leg(leg)
        if not rows:
            continue
        fastest = 1600.0 if e["kind"] != "isovelocity" else e["speed"]
        slowest = 1390.0 if e["kind"] != "isovelocity" else e["speed"]
        rays = rows["kind"] != 1  # a diffracted arrival's delay is that of its group
        if not np.any(rays):
            continue
        early = rows["delay"] - rows["range"] / fastest
        late = rows["path_length"] / slowest - rows["delay"]
        expect(np.all(early[rays] >= -1e-9 - 1e-6 * rows["delay"][rays]), f"leg {leg}: {-early[rays].min():.2e} s before it can be there")
        expect(np.all(late[rays] >= -1e-9 - 1e-6 * rows["delay"][rays]), f"leg {leg}: {-late[rays].min():.2e} s after its own length")

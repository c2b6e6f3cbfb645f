"""What the laws are made with: their register, changes of a scenario, and sizes that tolerances are told in.

A law is a function of a scenario, which is its own copy, and of `p`, by which it draws what else it needs. It raises
Violation where it does not hold, and Silent where the scenario says nothing about it (nothing is received).
"""
import copy
import math

import numpy as np

import program
from program import Violation

LAWS = {}


class Silent(Exception):
    """Nothing is received, or the program has warned of just this: the law says nothing here."""


def law(function):
    LAWS[function.__name__] = function
    return function


def copied(s):
    return copy.deepcopy(s)


def expect(holds, text):
    if not holds:
        raise Violation(text)


# --- changes of a scenario -------------------------------------------------------------------------------------------

def plain(s):
    """Without what is drawn at random or added to every ping: sounds of echoes and of the ping itself are left."""
    s.pop("noise", None)
    s.pop("interferer", None)
    s["reverberation"] = {"enabled": False}
    s["pings"] = {k: v for k, v in s["pings"].items() if k not in ("continuous", "blanking")} | {"count": 1}
    for t in s["target"]:
        t.pop("fluctuation", None)
        t.pop("scan_pings", None)
    for a in s["array"]:
        a.pop("electronics", None)
    return s


def still(s):
    """Everybody at rest."""
    for one in s["platform"] + s["target"] + s.get("interferer", []):
        one.pop("velocity", None)
        if "waypoints" in one:
            one["position"] = one.pop("waypoints")[0]["position"]
    return s


def smooth(s):
    """Boundaries that scatter nothing."""
    for boundary in (s["environment"]["bottom"], s["environment"].get("surface", {})):
        for key in [k for k in boundary if k.startswith(("roughness", "bubbles"))]:
            del boundary[key]
    return s


def one_place(s, phones=1):
    """One station with an omnidirectional source and `phones` phones where it is, one point target."""
    s["platform"] = s["platform"][:1]
    s["transmitter"] = {"platform": s["platform"][0]["name"], "source_level_db": s["transmitter"]["source_level_db"],
                        "taper": "omnidirectional"}
    s["array"] = [{"name": "array", "platform": s["platform"][0]["name"], "kind": "positions", "positions": [[0.0, 0.0, 0.0]] * phones}]
    t = s["target"][0]
    s["target"] = [{k: v for k, v in t.items() if k in ("name", "position", "velocity", "waypoints")} | {"strength_db": 10.0}]
    s["propagation"].pop("fathometer", None)
    return s


def stratified(s):
    """Speed a function of depth, flat boundaries, rays in vertical planes: where waves are exact."""
    e = s["environment"]
    water = e["sound_speed"]
    if water["kind"] == "section":
        e["sound_speed"] = {"kind": "table", "depth": water["depth"], "speed": water["speed"][0]}
    e["bottom"]["depth"] = water_depth(s)
    e["bottom"].pop("shape", None)
    e.pop("area", None)
    e.get("surface", {}).pop("shape", None)
    s["propagation"].pop("dimension", None)
    s["propagation"].pop("diffraction", None)
    return s


def water_depth(s):
    """The greatest depth of the water, for a floor that is made flat."""
    e = s["environment"]
    if "depth" in e["bottom"]:
        return e["bottom"]["depth"]
    if "shape" in e["bottom"]:
        return max(e["bottom"]["shape"]["depth"])
    rows = s["_files"]["floor.asc"].splitlines()[6:]
    return -min(float(x) for row in rows for x in row.split())


def everywhere(s, change):
    """Applies change([east, north, depth]) to every place, and returns the scenario."""
    for one in s["platform"] + s["target"] + s.get("interferer", []):
        if "position" in one:
            one["position"] = change(one["position"])
        for point in one.get("waypoints", ()):
            point["position"] = change(point["position"])
    return s


# --- sizes -----------------------------------------------------------------------------------------------------------

def duration(s):
    """Duration of the pulse [s]."""
    p = s["pulse"]
    return p["duration"] if "duration" in p else len(p["samples"]) / p["sample_rate"]


def amplitudes(record, s):
    """Peak pressures of all paths at the phones [Pa]: rows of echoes, and direct sound without the pattern."""
    level = np.concatenate([np.asarray(record.echoes.get("level_db", ()), dtype=float),
                            s["transmitter"]["source_level_db"]
                            + 20 * np.log10(np.maximum(1e-30, np.hypot(*(blast(record)))))])
    return math.sqrt(2) * 1e-6 * 10 ** (level[np.isfinite(level)] / 20)


def blast(record):
    a = record.arrivals
    if not a or len(a["leg"]) == 0:
        return np.zeros(0), np.zeros(0)
    rows = a["leg"] == 2
    return a["amplitude_real"][rows], a["amplitude_imag"][rows]


def loudness(record, s):
    """All paths together: the sum of their amplitudes times the pulse's norm, or three times the root of the sum of their
    squares, whichever is less.

    An error of each path by a share x changes the samples by at most x of the sum, in norm (triangle inequality). Errors
    of many paths have phases of their own: then their squares add up, and three times that is rarely exceeded.
    """
    a = amplitudes(record, s)
    phones = max(1, record.pressure.shape[1])
    own_rows = record.echoes and len(record.echoes.get("channel", ())) and np.max(record.echoes["channel"]) >= 0
    if own_rows:
        a = a / phones
    total = min(float(np.sum(a)), 3 * float(np.linalg.norm(a)) * (math.sqrt(phones) if own_rows else 1)) * record.replica_norm
    if total <= 0.0 or not np.any(record.pressure):
        raise Silent("nothing is received")
    return total


def norm(samples):
    return float(np.linalg.norm(samples))


def alike(a, b, s, share, what, phones=slice(None), part=slice(None)):
    """Two records are the same but for `share` of all their paths' amplitudes together."""
    a, b = program.at_one_rate(a, b)
    expect(a.pressure.shape[0] == b.pressure.shape[0], f"{what}: {a.pressure.shape} and {b.pressure.shape} samples")
    x, y = a.pressure[:, phones, part], b.pressure[:, :, part]
    n = min(x.shape[-1], y.shape[-1])
    x, y = x[..., :n], y[..., :n]
    most = max(loudness(a, s), 0.0)
    for phone in range(x.shape[1]):
        off = norm(x[:, phone] - y[:, phone])
        expect(off <= share * most,
               f"{what}: phone {phone} differs by {off / most:.2e} of all paths together ({off / max(norm(x[:, phone]), 1e-300):.2e} "
               f"of the record), at most {share:.1e}")


def drawn_share(record):
    """Root of the share of the energy that rough boundaries scatter, of a pair of legs.

    Its parts are drawn at the reference point of the array and carried to the phones as plane waves of their directions, which
    is right to first order. A phone alone is the reference point.
    """
    a = record.arrivals
    if not a or len(a["leg"]) == 0:
        return 0.0
    mean, scattered = a["amplitude_real"] ** 2 + a["amplitude_imag"] ** 2, np.nan_to_num(a["scattered"])
    left = [float(np.sum(mean[rows]) / max(np.sum((mean + scattered)[rows]), 1e-300))
            for rows in (a["leg"] == leg for leg in (0, 1, 2)) if rows.any()]
    ways = [math.prod(left[:2])] + left[2:]
    return math.sqrt(max(0.0, 1.0 - min(ways)))


def alike_in_the_mean(a, b, s, share, what):
    """The same samples, or the same paths where rough boundaries scatter about them.

    What is scattered is drawn from the waves of the sea at the places of the bounces (docs/theory/surface-scattering.md,
    Energy): other places have other waves. Mean fields, delays and the energy that is scattered have no such draw.
    """
    if not np.any(np.nan_to_num(a.arrivals.get("scattered", np.zeros(1))) > 0.0):
        alike(a, b, s, share, what)
        return
    for name, rows, others in (("arrivals", a.arrivals, b.arrivals), ("echoes", a.echoes, b.echoes)):
        x, y = (pressures(one, s["_hz"]) for one in (rows, others))
        expect(x.shape == y.shape, f"{what}: {x.shape} and {y.shape} {name}")
        off, most = np.abs(x - y).max(initial=0.0), np.abs(x).sum()
        expect(off <= share * most, f"{what}: one of the {name} differs by {off / max(most, 1e-300):.2e} of all, at most {share:.1e}")


def pressures(rows, hz):
    """Paths at a frequency, and the roots of what is scattered about them; echoes with what is scattered, in the mean.

    Rows within a nanosecond of one another, as surface and bottom paths about the middle of the water, come in an
    order of rounding, so each leg's rows are put in the order of their delays and then of their pressures.
    """
    if not rows or len(rows["delay"]) == 0:
        return np.zeros(0)
    order = np.lexsort((rows["delay"], rows.get("leg", np.zeros(len(rows["delay"])))))
    rows = {name: np.asarray(values)[order] for name, values in rows.items() if len(values) == len(order)}
    turned = np.exp(-2j * np.pi * hz * rows["delay"])
    if "level_db" in rows:
        x, scattered = 10 ** (rows["level_db"] / 20) * turned, np.zeros(0)
    else:
        x = (rows["amplitude_real"] + 1j * rows["amplitude_imag"]) * turned
        scattered = np.sqrt(np.nan_to_num(rows["scattered"]))
    apart = np.cumsum(np.abs(np.diff(rows["delay"], prepend=rows["delay"][0])) > 1e-9)
    key = np.round(x / np.abs(x).max(initial=1e-300), 6)
    order = np.lexsort((key.imag, key.real, apart))
    return np.concatenate([x[order], scattered[order[:len(scattered)]]])


def field(rows, hz):
    """Sum of a leg's paths at a frequency, and the sum of their amplitudes."""
    a = rows["amplitude_real"] + 1j * rows["amplitude_imag"]
    return np.sum(a * np.exp(-2j * np.pi * hz * rows["delay"])), float(np.sum(np.abs(a)))


def energy(rows):
    """Mean intensity of a leg: of the mean fields, and of what rough boundaries scatter about them."""
    return float(np.sum(rows["amplitude_real"] ** 2 + rows["amplitude_imag"] ** 2 + np.nan_to_num(rows["scattered"])))


def db(power):
    return 10 * math.log10(max(power, 1e-300))


def warned(record, *words):
    """Whether the run has said that it may be wrong in this."""
    return any(word in text for text in record.warnings for word in words)


def need_leg(record, number=0):
    rows = record.leg(number)
    if not rows or len(rows["delay"]) == 0:
        raise Silent("no path")
    return rows


ping = program.ping

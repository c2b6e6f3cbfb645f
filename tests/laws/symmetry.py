"""What does not change when the world is turned, mirrored, moved, or looked at from the other end."""
import math

import numpy as np

from law import (LAWS, Silent, alike, alike_in_the_mean, copied, db, drawn_share, energy, everywhere, expect, field, law,
                 loudness, need_leg, norm, one_place, ping, plain, still, stratified, warned)


@law
def reciprocal(s, p):
    """The leg back is the leg there: energy and coherent sum, source and receiver at one place and at rest.

    Waves share what is left to within 1 % of a leg (docs/theory/waves.md, Cycles), in either direction: 2 %. Cylindrical
    spreading turns slopes about the source, which is another sea from either end.
    """
    s["environment"].pop("spreading", None)
    record = ping(one_place(still(plain(s))))
    out, home = need_leg(record, 0), need_leg(record, 1)
    (there, total), (back, _) = field(out, s["_hz"]), field(home, s["_hz"])
    expect(abs(there - back) <= 0.02 * total, f"the sums of both legs differ by {abs(there - back) / total:.2e} of all paths")
    # 0.2 dB: 2 % of amplitude.
    expect(abs(db(energy(out)) - db(energy(home))) <= 0.2, f"{db(energy(out)):.2f} dB there, {db(energy(home)):.2f} dB back")


def turned(s, degrees):
    """The world turned clockwise about the map's [0, 0]."""
    a = math.radians(degrees)
    def turn(v):
        return [v[0] * math.cos(a) + v[1] * math.sin(a), -v[0] * math.sin(a) + v[1] * math.cos(a), v[2]]
    everywhere(s, turn)
    for one in s["platform"] + s["target"]:
        if "velocity" in one:
            one["velocity"] = turn(one["velocity"])
    for t in s["target"]:
        if "heading_deg" in t:
            t["heading_deg"] += degrees
    for one in s["array"]:
        if "offset" in one:
            one["offset"] = turn(one["offset"])
        if "positions" in one:
            one["positions"] = [turn(x) for x in one["positions"]]
        if one["kind"] in ("horizontal", "line", "towed"):
            one["heading_deg"] = one.get("heading_deg", 0.0) + degrees
    t = s["transmitter"]
    if "offset" in t:
        t["offset"] = turn(t["offset"])
    if t.get("kind") in ("projectors", "table"):
        ship = next(one for one in s["platform"] if one["name"] == t["platform"])
        rests = not any(ship.get("velocity", [])) and "waypoints" not in ship  # heads north however the world turns
        if t.get("bearing_from", "north") == "north" or rests:
            t["bearing_deg"] = t.get("bearing_deg", 0.0) + degrees
            for one in t.get("projector", ()):
                one["offset"] = turn(one["offset"])
    s["environment"]["transect"] = {"bearing_deg": float(degrees)}
    return s


def without_map(s):
    e = s["environment"]
    if "area" in e:
        from law import water_depth
        e["bottom"]["depth"] = water_depth(s)
        del e["area"]
    return s


@law
def turned_world(s, p):
    """Samples do not know where north is. Places are turned with 16 digits: 1e-6 of a path at 2e4 wavelengths is rounding;
    1e-4 since waves' kernels are found for ranges that round otherwise (waves.md: pressures to 1e-7, shares to 1e-5)."""
    s = without_map(plain(s))
    first = ping(s)
    angle = p("angle", [90.0, 180.0, 37.0, 270.0, 5.0])
    alike(first, ping(turned(copied(s), angle)), s, 1e-4, f"turned by {angle:g} degrees")


@law
def mirrored_world(s, p):
    """Samples do not know right from left, but for waves that are drawn, which are not mirrored. As `turned_world`."""
    s = without_map(plain(s))
    first = ping(s)
    m = copied(s)
    def mirror(v):
        return [-v[0], v[1], v[2]]
    everywhere(m, mirror)
    for one in m["platform"] + m["target"]:
        if "velocity" in one:
            one["velocity"] = mirror(one["velocity"])
    for t in m["target"]:
        if "heading_deg" in t:
            t["heading_deg"] = -t["heading_deg"]
        for h in t.get("highlight", ()):
            h["offset"][1] = -h["offset"][1]
    for one in m["array"]:
        if "offset" in one:
            one["offset"] = mirror(one["offset"])
        if "positions" in one:
            one["positions"] = [mirror(x) for x in one["positions"]]
        if "heading_deg" in one:
            one["heading_deg"] = -one["heading_deg"]
    t = m["transmitter"]
    if "offset" in t:
        t["offset"] = mirror(t["offset"])
    for one in t.get("projector", ()):
        one["offset"] = mirror(one["offset"])
    if "bearing_deg" in t:
        t["bearing_deg"] = -t["bearing_deg"]
    m["environment"]["transect"] = {"bearing_deg": 0.0}
    alike_in_the_mean(first, ping(m), s, 1e-4, "mirrored")


@law
def moved_world(s, p):
    """Samples do not know where the map's [0, 0] is, but for waves that are drawn, which are those of a place.

    1e-9 m of rounding at 1e6 m: 1e-6 of a wavelength of 1 mm.
    """
    s = without_map(plain(s))
    first = ping(s)
    dx, dy = p("east", [1000.0, -7.0, 1e5]), p("north", [0.0, 123.0, -2e4])
    m = everywhere(copied(s), lambda v: [v[0] + dx, v[1] + dy, v[2]])
    m["environment"]["transect"] = {"origin": [dx, dy]}
    alike_in_the_mean(first, ping(m), s, 1e-4, f"moved by {dx:g} m east, {dy:g} m north")


@law
def offset_is_a_place(s, p):
    """A source and an array beside their platform are those of a platform beside it. Places round to 1e-12 m."""
    s = plain(s)
    off = p("offset", [[3.0, 0.0, 0.0], [0.0, -2.5, 0.0], [1.0, 2.0, 0.01]])
    s["platform"] = s["platform"][:1]
    s["array"] = s["array"][:1]
    s["array"][0]["platform"] = s["transmitter"]["platform"] = s["platform"][0]["name"]
    if s["array"][0]["kind"] == "towed" and "waypoints" in s["platform"][0]:
        still(s)  # a tow point beside a platform that turns has a path of its own
    moved = copied(s)
    for one in (s["array"][0], s["transmitter"]):
        one["offset"] = [a + b for a, b in zip(one.get("offset", [0.0, 0.0, 0.0]), off)]
    ship = moved["platform"][0]
    for point in ship.get("waypoints", [ship]):
        point["position"] = [a + b for a, b in zip(point["position"], off)]
    alike(ping(s), ping(moved), s, 1e-4, f"offset {off}")


@law
def phone_is_itself(s, p):
    """A phone in an array receives what it receives alone.

    A plane wave stands for a front while it is right to a hundredth of a period of the highest frequency, 0.063 rad
    (docs/theory/echoes.md, Phones). Amplitudes are those of the middle: L/r more. 0.02 is what waves leave to rays.
    """
    s = plain(s)
    s["pings"]["samples"] = "baseband"
    s["pings"].pop("sample_rate", None)
    whole = ping(s)
    n = whole.pressure.shape[1]
    a = s["array"][0]
    ship = next(one for one in s["platform"] if one["name"] == a["platform"])
    at = ship["waypoints"][0]["position"] if "waypoints" in ship else ship["position"]
    phone = p("phone", [0, n - 1, n // 2])
    phone = min(phone, n - 1)
    where = whole.phone_position[0, phone]
    alone = copied(s)
    if a["kind"] == "towed":
        alone["array"][0] = a | {"behind": [a["behind"][phone]]}
    else:
        alone["array"][0] = {"name": "array", "platform": a["platform"], "kind": "positions", "positions": [[0.0, 0.0, 0.0]],
                             "offset": [float(x - y) for x, y in zip(where, at)]}
    size = float(np.max(np.linalg.norm(whole.phone_position[0] - np.mean(whole.phone_position[0], axis=0), axis=1)))
    reach = float(np.min(whole.arrivals["path_length"])) if len(whole.arrivals.get("path_length", ())) else 1.0
    share = 0.063 + 0.02 + size / max(reach, size, 1e-9) + 2.0 * drawn_share(whole)
    alike(whole, ping(alone), s, share, f"phone {phone} of {n}", phones=slice(phone, phone + 1))


@law
def exact_is_plane(s, p):
    """Eigenrays to every phone, or a plane wave where that is enough: the same, as `phone_is_itself`."""
    s = plain(s)
    s["propagation"].pop("exact_per_phone", None)
    plane = ping(s)
    s["propagation"]["exact_per_phone"] = True
    exact = ping(s)
    size = float(np.max(np.linalg.norm(plane.phone_position[0] - np.mean(plane.phone_position[0], axis=0), axis=1)))
    reach = float(np.min(plane.arrivals["path_length"])) if len(plane.arrivals.get("path_length", ())) else 1.0
    share = 0.063 + 0.02 + size / max(reach, size, 1e-9) + 2.0 * drawn_share(plane)
    alike(plane, exact, s, share, "exact_per_phone")


def small_move(s, p):
    """A sea for a small move, and its length: a thousandth of a wavelength, or a millimetre where that is less.

    Every other sea has one speed of sound: there no caustic is near, and nothing is left to waves. The sound of the ping
    itself, which is louder than echoes, is left out.
    """
    s = one_place(stratified(still(plain(s))))
    s["propagation"]["direct_blast"] = False
    if p("sea", ["isovelocity", "drawn"]) == "isovelocity":
        s["environment"]["sound_speed"] = {"kind": "isovelocity", "speed": 1500.0}
    return s, min(1e-3 * 1500.0 / s["_hz"], p("step", [1e-3, 1.0, 1e-7]))


def bends(s):
    return s["environment"]["sound_speed"]["kind"] != "isovelocity"


@law
def continuous_in_place(s, p):
    """A target that moves by a thousandth of a wavelength, or a millimetre where that is less, changes little.

    A path's phase turns by at most kd there and kd back, 2·0.0063·(1500/1400); its amplitude changes by 2d/r and, beside
    a caustic, over (λ²ρ)^(1/3) ≫ λ. Waves leave up to 1 % of each leg to rays (0.02), and at a critical angle a bounce
    changes as the root of the angle: by sqrt(2d/3λ), 0.026. Water is stratified: over slopes and fronts rays end, and a
    run says so.
    """
    s, d = small_move(s, p)
    first = ping(s)
    wave = 1500.0 / s["_hz"]
    axis = p("axis", [2, 0, 1])
    s2 = copied(s)
    z = s2["target"][0]["position"]
    z[axis] += d if axis < 2 or z[2] > s["platform"][0]["position"][2] else -d
    second = ping(s2)
    of_waves = ("waves", "caustic", "changes faster across the pulse")
    if bends(s) and (warned(first, *of_waves) or warned(second, *of_waves)):
        raise Silent("warned")
    share = 2 * 2 * math.pi * d / wave * 1.07 + 2 * d / max(3 * wave, 1.0) + 0.02 + 0.026
    alike(first, second, s, share, f"target moved by {d:g} m")


@law
def continuous_in_source(s, p):
    """As `continuous_in_place`, of the platform's depth: the legs' sums at the centre frequency."""
    s, d = small_move(s, p)
    first = need_leg(ping(s))
    s2 = copied(s)
    s2["platform"][0]["position"][2] += d if s2["platform"][0]["position"][2] < s2["target"][0]["position"][2] else -d
    record = ping(s2)
    if bends(s) and warned(record, "waves", "caustic"):
        raise Silent("warned")
    (a, total), (b, _) = field(first, s["_hz"]), field(need_leg(record), s["_hz"])
    share = 2 * math.pi * d * s["_hz"] / 1500.0 * 1.07 + 0.02 + 0.026
    expect(abs(a - b) <= share * total, f"source moved by {d:g} m: the leg changes by {abs(a - b) / total:.2e} of all paths, at most {share:.1e}")

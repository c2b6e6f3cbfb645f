"""The same thing said otherwise, or more finely: nothing changes."""
import math

import numpy as np

import program
from law import Silent, alike, copied, expect, field, law, need_leg, ping, plain, smooth, stratified


def table(s, interpolation, p):
    """A profile of straight pieces in the water of a scenario."""
    from law import water_depth
    depth = water_depth(s)
    return {"kind": "table", "interpolation": interpolation, "depth": [0.0, 0.4 * depth, 1.2 * depth],
            "speed": [1500.0, 1500.0 - p("fall", [4.0, 0.0, 12.0, -6.0]), 1501.0]}


@law
def node_on_a_line(s, p):
    """A sample put on a straight piece of the profile changes nothing. Layers of waves are cut at samples, by which each leg of
    each run may be 1 % off: 4 %."""
    s = plain(s)
    e = s["environment"]
    law = p("interpolation", ["c-linear", "n2-linear"])
    e["sound_speed"] = table(s, law, p)
    first = ping(s)
    share = p("at", [0.5, 0.01, 0.999])
    piece = p("piece", [0, 1])
    s2 = copied(s)
    water = s2["environment"]["sound_speed"]
    z0, z1 = water["depth"][piece:piece + 2]
    c0, c1 = water["speed"][piece:piece + 2]
    c = c0 + share * (c1 - c0) if law == "c-linear" else (c0 ** -2 + share * (c1 ** -2 - c0 ** -2)) ** -0.5
    water["depth"].insert(piece + 1, z0 + share * (z1 - z0))
    water["speed"].insert(piece + 1, c)
    alike(first, ping(s2), s, 0.04, f"a node at {share:g} of piece {piece}, {law}")


@law
def isovelocity_as_a_table(s, p):
    """Water of one speed is a table of equal speeds, whatever lies between. As `node_on_a_line`."""
    s = plain(s)
    s["environment"]["sound_speed"] = {"kind": "isovelocity", "speed": 1500.0}
    first = ping(s)
    s2 = copied(s)
    kind = p("interpolation", ["c-linear", "n2-linear", "spline", "pchip"])
    from law import water_depth
    depth = water_depth(s)
    s2["environment"]["sound_speed"] = {"kind": "table", "interpolation": kind, "depth": [0.0, 0.3 * depth, 0.7 * depth, 1.2 * depth],
                                        "speed": [1500.0] * 4}
    alike(first, ping(s2), s, 0.04, f"a table ({kind}) of one speed")


@law
def section_of_equal_profiles(s, p):
    """A section of one profile repeated is that profile. Two solvers find the rays, delays to 1e-9 s, amplitudes to 1e-6
    (docs/theory/eigenrays.md, Evidence); waves are for the layered one alone, so without diffraction. Each finds out for
    itself where a plane wave is enough for an array, so neither may. Where ends move the delay is told to 1e-7 s
    (docs/theory/echoes.md) and the place of a bounce to sqrt(2rc·1e-7 s), half a metre at 1 km: the sea there is another
    one, so nothing is scattered."""
    s = smooth(stratified(plain(s)))
    s["propagation"] |= {"diffraction": False, "exact_per_phone": True}
    s["environment"]["sound_speed"] = table(s, "c-linear", p)
    first = ping(s)
    s2 = copied(s)
    water = s2["environment"]["sound_speed"]
    s2["environment"]["sound_speed"] = {"kind": "section", "range": [-1e5, 0.0, 1e5], "depth": water["depth"], "speed": [water["speed"]] * 3}
    alike(first, ping(s2), s, 0.02, "a section of equal profiles")


@law
def split_layer(s, p):
    """A layer of the floor cut in two is one. Rounding of impedances: 1e-6."""
    s = plain(s)
    bottom = s["environment"]["bottom"]
    geometry = {k: v for k, v in bottom.items() if k in ("depth", "shape")}
    thick = p("thickness", [0.5, 2.0, 0.1]) * 1500.0 / s["_hz"]
    layer = {"speed": 1560.0, "density": 1600.0, "attenuation_db_per_wavelength": 0.3}
    if p("solid", [False, True]):
        layer |= {"shear_speed": 200.0, "shear_attenuation_db_per_wavelength": 1.0}
    half = {"speed": 1800.0, "density": 2000.0, "attenuation_db_per_wavelength": 0.5}
    s["environment"]["bottom"] = {"kind": "layered", **geometry, **half, "layer": [{"thickness": thick, **layer}]}
    s2 = copied(s)
    part = p("part", [0.5, 0.1, 0.9])
    s2["environment"]["bottom"]["layer"] = [{"thickness": part * thick, **layer}, {"thickness": (1 - part) * thick, **layer}]
    alike(ping(s), ping(s2), s, 1e-3, f"a layer of {thick:g} m cut in two")


@law
def finer_floor(s, p):
    """A node put on a facet of the floor changes nothing. A ray that strikes it within the search's 1e-4 m is lost: 2 %."""
    s = plain(s)
    from law import water_depth
    depth = 1.05 * water_depth(s)  # below all that is in the water
    e = s["environment"]
    e.pop("area", None)
    e["bottom"].pop("depth", None)
    far = max(abs(x) for x in s["target"][0].get("position", [0.0, 0.0])[:2]) * 3 + depth
    e["bottom"]["shape"] = {"range": [-far, 0.2 * far, far], "depth": [depth, 0.97 * depth, depth]}
    first = ping(s)
    s2 = copied(s)
    shape = s2["environment"]["bottom"]["shape"]
    shape["range"] = [-far, -0.4 * far, 0.2 * far, 0.6 * far, far]
    shape["depth"] = [depth, 0.985 * depth, 0.97 * depth, 0.985 * depth, depth]
    alike(first, ping(s2), s, 0.02, "nodes on the floor's facets")


@law
def flat_shape(s, p):
    """A floor of one depth told by a shape is flat. Two solvers, without scattering, as `section_of_equal_profiles`."""
    s = smooth(stratified(plain(s)))
    s["propagation"] |= {"diffraction": False, "exact_per_phone": True}
    first = ping(s)
    s2 = copied(s)
    bottom = s2["environment"]["bottom"]
    depth = bottom.pop("depth")
    bottom["shape"] = {"interpolation": p("interpolation", ["piecewise-linear", "smooth", "curvilinear"]),
                       "range": [-1e4, 0.0, 3e3, 1e5], "depth": [depth] * 4}
    alike(first, ping(s2), s, 0.02, "a shape of one depth")


@law
def finer_map(s, p):
    """A map of a plane floor sampled twice as finely is the same floor. Four-byte heights: 1e-7 of the depth.

    Planes over a bicubic map leave out up to 2 cm of it, so paths strike a rough boundary elsewhere, where it has other waves.
    There the sums of the mean fields are compared, whose bottom paths are 2 cm longer or shorter each way.
    """
    s = stratified(plain(s))
    e = s["environment"]
    depth = e["bottom"].pop("depth") / 0.8  # below all that is in the water
    cell = (max(abs(x) for x in s["target"][0].get("position", [100.0, 0.0])[:2]) + 50.0) / 111195.0  # degrees
    e["origin"] = {"latitude_deg": 0.0, "longitude_deg": 0.0}
    how = p("interpolation", ["bicubic", "faceted"])

    def grid(n, step):
        lines = [f"ncols {n}", f"nrows {n}", f"xllcenter {-step * (n // 2)!r}", f"yllcenter {-step * (n // 2)!r}", f"cellsize {step!r}", "NODATA_value -99999"]
        half = n // 2
        return "\n".join(lines + [" ".join(repr(-(depth * (0.9 + 0.05 * (j - half) * step / (4 * cell) + 0.03 * (half - i) * step / (4 * cell)))) for j in range(n))
                                  for i in range(n)]) + "\n"

    e["area"] = {"bathymetry": {"file": "floor.asc", "interpolation": how}}
    s["_files"] = {"floor.asc": grid(9, cell)}
    first = ping(s)
    s2 = copied(s)
    s2["_files"] = {"floor.asc": grid(17, cell / 2)}
    second = ping(s2)
    if not np.any(np.nan_to_num(first.arrivals.get("scattered", np.zeros(1))) > 0.0):
        return alike(first, second, s, 0.02, f"a plane map of half the cells ({how})")
    rows = need_leg(first)
    (a, total), (b, _) = field(rows, s["_hz"]), field(need_leg(second), s["_hz"])
    loud = np.hypot(rows["amplitude_real"], rows["amplitude_imag"])
    longer = min(2.0, 2.0 * math.pi * s["_hz"] / 1450.0 * 2 * 0.02) if how == "bicubic" else 0.0
    share = 0.02 + longer * float(np.sum(loud[rows["bottom_bounces"] > 0]) / max(np.sum(loud), 1e-300))
    expect(abs(a - b) <= share * total, f"a plane map of half the cells ({how}): the leg differs by {abs(a - b) / total:.2e}, at most {share:.1e}")


@law
def included_file(s, p):
    """An environment in a file of its own is the same: bit for bit."""
    s = plain(s)
    first = ping(s)
    s2 = copied(s)
    e = s2.pop("environment")
    s2["_files"]["ocean.toml"] = program.toml({"environment": e})
    second = ping({"include": "ocean.toml", **s2})
    expect(first.bits == second.bits, "an included environment gives other samples")


@law
def other_units(s, p):
    """Radians in place of degrees, six ways to tell an attenuation: the same but for rounding, 1e-12 of the numbers; waves
    are smooth in them, and are cut and kept by thresholds of 1e-3."""
    s = plain(s)
    bottom = s["environment"]["bottom"]
    geometry = {k: v for k, v in bottom.items() if k in ("depth", "shape")}
    s["environment"]["bottom"] = {"kind": "fluid", **geometry, "speed": 1650.0, "density": 1800.0, "attenuation_db_per_wavelength": 0.5}
    first = ping(s)
    s2 = copied(s)
    from scenarios import attenuation
    unit = p("unit", ["per metre kHz", "quality", "loss parameter"])
    floor = s2["environment"]["bottom"]
    del floor["attenuation_db_per_wavelength"]
    floor |= attenuation(0.5, unit, 1650.0, s["_hz"])
    for one in s2["array"] + s2["target"] + [s2["transmitter"]]:
        for key in [k for k in one if k.endswith("_deg") and isinstance(one[k], float)]:
            one[key[:-4] + "_rad"] = math.radians(one.pop(key))
    # 27.2875 and 54.575 are rounded to 1e-8.
    alike(first, ping(s2), s, 2e-3, f"attenuation by {unit}, angles in radians")


@law
def waypoints_are_a_velocity(s, p):
    """A straight track told by waypoints is one of constant velocity. Curves of the delay are followed to 1e-3 rad, there
    and back, and amplitudes are those of the leading edge."""
    s = plain(s)
    one = s["target"][0]
    if "waypoints" in one:
        one["position"] = one.pop("waypoints")[0]["position"]
    v = one.setdefault("velocity", [1.0, -0.5, 0.0])
    first = ping(s)
    s2 = copied(s)
    t = s2["target"][0]
    at = t.pop("position")
    del t["velocity"]
    t["waypoints"] = [{"time": 0.0, "position": at}, {"time": 1e4, "position": [x + 1e4 * w for x, w in zip(at, v)]}]
    if "heading_deg" not in t and ("aspect" in t or "highlight" in t):
        raise Silent("its course")
    alike(first, ping(s2), s, 0.01, "waypoints on a straight track")


@law
def range_and_bearing(s, p):
    """A target told by range and bearing is where they say. Rounding of 1e-12 m."""
    s = plain(s)
    t = s["target"][0]
    at = t["position"] if "position" in t else t["waypoints"][0]["position"]
    ship = s["platform"][0]
    from_ = ship["waypoints"][0]["position"] if "waypoints" in ship else ship["position"]
    t.pop("waypoints", None)
    t["position"] = at
    first = ping(s)
    s2 = copied(s)
    t2 = s2["target"][0]
    del t2["position"]
    dx, dy = at[0] - from_[0], at[1] - from_[1]
    t2 |= {"range": math.hypot(dx, dy), "bearing_deg": math.degrees(math.atan2(dx, dy)), "depth": at[2]}
    alike(first, ping(s2), s, 1e-4, "range and bearing")

"""Valid scenarios, small enough to run in about a second, drawn by Hypothesis about a row of a covering array.

Every factor has its row's level, or now and then its simplest one, towards which Hypothesis shrinks. Sizes follow from
one another: ranges from depth and frequency, records from ranges, pulses from frequency. So draws are valid by
construction, and nothing is rejected.
"""
import math

from hypothesis import strategies as st

import schema

# Levels of the factors that recipes below turn into tables, the simplest first. Those that the program has a list of
# are taken from its schema.
FREQUENCIES = {"mid": (200.0, 2e3), "low": (20.0, 200.0), "high": (2e3, 2e4), "ultra": (2e4, 3e5)}
DEPTHS = {"shelf": (50.0, 300.0), "harbour": (5.0, 50.0), "slope": (300.0, 1500.0), "deep": (1500.0, 6000.0)}
PLACES = ["free", "node", "minimum", "equal", "millimetre", "hair", "shallow", "floor"]


def recipes():
    """Factors of the recipes: name → levels."""
    return {
        "depth": list(DEPTHS), "frequency": list(FREQUENCIES), "distance": ["medium", "near", "far", "steep"],
        "sea": ["flat", "floor", "swell", "ice", "area"],
        "profile": ["isovelocity"] + [k for k in schema.words_at("environment", "sound_speed", "kind") if k != "isovelocity"],
        "interpolation": schema.words_at("environment", "sound_speed", "interpolation"),
        "profile shape": ["gradient", "upward", "channel", "thermocline", "duct"],
        "nodes": [2, 3, 5, 9], "source place": PLACES, "target place": PLACES,
        "bottom": ["fluid"] + [k for k in schema.words_at("environment", "bottom", "kind") if k != "fluid"],
        "surface": ["vacuum"] + [k for k in schema.words_at("environment", "surface", "kind") if k != "vacuum"],
        "attenuation unit": ["per wavelength", "per metre", "per metre kHz", "nepers", "quality", "loss parameter"],
        "shape": schema.words_at("environment", "bottom", "shape", "interpolation"),
        "roughness": ["none", "number", "wind"], "bottom roughness": ["none", "number"],
        "wind": ["calm", "breeze", "gale"],
        "surface bounces": [1, 0, 2, 3, "auto"], "bottom bounces": [1, 0, 2, 3, "auto"],
        "array": schema.words_at("array", "kind"), "phones": [1, 2, 4, 8],
        "array offset": ["none", "offset"], "electronics": ["none", "errors"],
        "motion": ["rest", "target", "platform", "both", "waypoints"],
        "pulse": [k for k in schema.words_at("pulse", "kind") if k != "file"] + ["file"],
        "window": schema.words_at("pulse", "window"), "pulse length": ["medium", "short", "long"],
        "target": ["point", "aspect", "levels", "highlights", "two"],
        "fluctuation": schema.words_at("target", "fluctuation"),
        "reverberation": ["off", "surface", "bottom", "volume", "all"],
        "surface law": schema.words_at("reverberation", "surface", "kind"),
        "bottom law": schema.words_at("reverberation", "bottom", "kind"),
        "noise": ["off"] + schema.words_at("noise", "kind"),
        "coherence": schema.words_at("noise", "coherence"),
        "stations": ["one", "two"],
        "transmitter": ["omnidirectional", "line", "projectors", "table"],
        "samples": ["baseband", "pressure"], "pings": [1, 2], "dimension": [2, 3],
        "fish": ["none", "fish"], "ship": ["none", "ship"], "water density": ["number", "table"],
    }


# What the recipes set, so that it is no generic factor as well. "x.*" is a table and all within it.
CLAIMED = {
    "environment.wind_speed", "environment.water_density", "environment.water_density.*", "environment.biology", "environment.biology.*",
    "environment.sound_speed", "environment.sound_speed.*", "environment.attenuation", "environment.attenuation.*",
    "environment.surface", "environment.surface.kind", "environment.surface.shape", "environment.surface.shape.*",
    "environment.surface.layer", "environment.surface.layer.*", "environment.surface.curve", "environment.surface.curve.*",
    "environment.surface.roughness", "environment.surface.roughness_wind",
    "environment.bottom", "environment.bottom.depth", "environment.bottom.kind", "environment.bottom.shape",
    "environment.bottom.shape.*", "environment.bottom.layer", "environment.bottom.layer.*", "environment.bottom.curve",
    "environment.bottom.curve.*", "environment.bottom.roughness", "environment.bottom.roughness_wind",
    "platform", "platform.*", "transmitter", "transmitter.platform", "transmitter.name", "transmitter.offset",
    "transmitter.kind", "transmitter.taper", "transmitter.projector", "transmitter.projector.*", "transmitter.table",
    "transmitter.table.*", "transmitter.source_level_db", "pulse", "pulse.*", "array", "array.name", "array.platform",
    "array.kind", "array.phones", "array.spacing", "array.shapes", "array.shapes.*", "array.positions", "array.behind",
    "array.offset", "array.electronics", "array.electronics.*", "array.heading_deg",
    "target", "target.*", "interferer", "interferer.*", "noise", "noise.kind", "noise.spectral_level_db", "noise.frequency", "noise.level_db",
    "noise.coherence", "noise.profile", "noise.profile.*", "reverberation", "reverberation.enabled",
    "reverberation.surface", "reverberation.surface.kind", "reverberation.surface.enabled", "reverberation.bottom",
    "reverberation.bottom.kind", "reverberation.volume", "reverberation.volume.depth", "reverberation.volume.sheets",
    "propagation", "propagation.dimension", "propagation.max_surface_bounces", "propagation.max_bottom_bounces",
    "pings", "pings.count", "pings.samples",
}
# Materials' numbers of both boundaries are drawn by the recipe of materials.
for _boundary in ("surface", "bottom"):
    CLAIMED |= {f"environment.{_boundary}.{name}" for name in (
        "speed", "shear_speed", "density", "grain_size", "water_speed", "water_density", "file",
        *(f"{prefix}{name}" for prefix in ("", "shear_") for name in (
            "attenuation_db_per_wavelength", "attenuation_db_per_metre", "attenuation_db_per_metre_khz",
            "attenuation_nepers_per_metre", "quality_factor", "loss_parameter")))}


def factors():
    return {**recipes(), **schema.generic_factors(CLAIMED)}


def digits(value, n=4):
    return float(f"{value:.{n}g}")


class Drawer:
    """Numbers for the recipes, all out of integers that shrink towards the lowest value."""

    def __init__(self, draw, row):
        self.draw, self.row, self.used = draw, row, {}

    def level(self, name, levels):
        """The row's level, once in 40 the simplest one."""
        wanted = self.row.get(name, levels[0])
        self.used[name] = self.draw(st.sampled_from([levels[0]] + [wanted] * 40)) if wanted != levels[0] else wanted
        return self.used[name]

    def between(self, low, high, steps=48, n=4):
        return digits(low + (high - low) * self.draw(st.integers(0, steps)) / steps, n)

    def times(self, low, high, steps=48, n=4):
        return digits(low * (high / low) ** (self.draw(st.integers(0, steps)) / steps), n)

    def one_of(self, *values):
        return self.draw(st.sampled_from(values))


def scenario(draw, row, levels):
    """A scenario about a row of the covering array.

    Keys that begin with "_" are for laws: "_files" that it names, "_levels" that were drawn, "_hz" the pulse's centre,
    "_span" seconds after which every echo of the allowed bounces has gone.
    """
    d = Drawer(draw, row)
    level = {name: d.level(name, levels[name]) for name in recipes()}
    hz = d.times(*FREQUENCIES[level["frequency"]])
    depth = d.times(*DEPTHS[level["depth"]])
    # What sea water absorbs on the way (Thorp, roughly) is at most 30 dB, and nobody is further than 20 000 wavelengths.
    absorbed = 0.11e-3 * (hz / 1e3) ** 2 / (1 + (hz / 1e3) ** 2) + 0.044 * (hz / 1e3) ** 2 / (4100 + (hz / 1e3) ** 2)
    furthest = min(30.0 / max(absorbed, 1e-9), 2e4 * 1500.0 / hz, 60 * depth, 4e4)
    share = d.between(1.0, 1.4)
    reach = min(depth, furthest) * (2 * share - 1.8) if level["distance"] == "steep" else \
        {"medium": 0.2, "near": 0.05, "far": 0.7}[level["distance"]] * furthest * share
    reach = digits(max(reach, 5.0, 3 * 1500.0 / hz))
    s = {"_files": {}, "title": "drawn", "seed": d.one_of(1, 2, 3)}
    if level["sea"] in ("floor", "swell", "area") or level["profile"] == "section":
        # Paths multiply with every bounce over ground that slopes: few of them there.
        for name in ("surface bounces", "bottom bounces"):
            level[name] = level[name] if level[name] in (0, 1) else 2
    floor, top = ocean(d, level, s, depth, hz, reach)
    stations(d, level, s, floor, top, hz, reach)
    sound(d, level, s, hz, reach, depth)
    s["_hz"], s["_levels"] = hz, dict(d.used)
    generic(d, s, levels)
    return s


# --- the ocean -------------------------------------------------------------------------------------------------------

def ocean(d, level, s, depth, hz, reach):
    """[environment]; returns the shallowest floor and the deepest surface."""
    wind = {"calm": 0.0, "breeze": d.between(1.0, 8.0), "gale": d.between(8.0, 20.0)}[level["wind"]]
    e = s["environment"] = {"wind_speed": wind}
    bottom = {"depth": depth, **material(d, level["bottom"], level["attenuation unit"], hz)}
    surface = material(d, level["surface"], level["attenuation unit"], hz)
    floor, top, sea = depth, 0.0, level["sea"]
    if sea in ("floor", "area"):
        relief = d.between(0.02, 0.15) * min(depth, 0.3 * reach)
        floor = depth - relief
    if sea == "floor":
        far = max(2 * reach, depth)
        del bottom["depth"]
        bottom["shape"] = {"interpolation": level["shape"], "range": [digits(x * far) for x in (-1, -0.2, 0.3, 1)],
                           "depth": [digits(depth - x * relief) for x in (0.0, 0.6, 0.2, 1.0)]}
    elif sea == "swell":
        top = digits(min(0.04 * depth, 2.0))
        step = max(reach / 3, 10 * top)
        surface["shape"] = {"interpolation": level["shape"], "range": [digits(i * step) for i in range(-3, 4)],
                            "depth": [0.0 if i % 2 else top for i in range(7)]}
    elif sea == "ice":
        top = digits(min(0.05 * depth, 3.0))
        surface = {"kind": "elastic", "speed": 3500.0, "shear_speed": 1800.0, "density": 900.0, "depth": top}
    elif sea == "area":
        del bottom["depth"]
        cell, n = max(reach / 3, 20.0) / 111195.0, 9  # degrees about [0, 0]
        rows = [[digits(-(depth - relief * (0.5 + 0.5 * math.sin(0.9 * i) * math.cos(0.7 * j)))) for j in range(n)]
                for i in range(n)]
        s["_files"]["floor.asc"] = (f"ncols {n}\nnrows {n}\nxllcenter {-4 * cell}\nyllcenter {-4 * cell}\ncellsize {cell}\n"
                                    "NODATA_value -99999\n" + "\n".join(" ".join(map(str, row)) for row in rows) + "\n")
        e["origin"] = {"latitude_deg": 0.0, "longitude_deg": 0.0}
        e["area"] = {"bathymetry": {"file": "floor.asc", "interpolation": d.one_of("bicubic", "faceted")}}
    e["sound_speed"] = profile(d, level, depth, reach)
    if level["roughness"] == "wind":
        surface["roughness"] = "wind"
    elif level["roughness"] == "number":
        surface["roughness"] = d.times(1e-3, 2.0)
    if level["bottom roughness"] == "number":
        bottom["roughness"] = d.times(1e-3, 0.5)
    if surface != {"kind": "vacuum"}:
        e["surface"] = surface
    e["bottom"] = bottom
    if level["fish"] == "fish":
        e["biology"] = [{"top": digits(0.2 * depth), "bottom": digits(0.4 * depth), "resonance": hz, "quality_factor": 4.0,
                         "strength_db_per_km": d.times(0.01, 1.0)}]
    if level["water density"] == "table":
        e["water_density"] = {"depth": [0.0, depth], "density": [1020.0, 1030.0]}
    return floor, top


def profile(d, level, depth, reach):
    kind, shape, n = level["profile"], level["profile shape"], level["nodes"]
    if kind == "isovelocity":
        return {"kind": kind, "speed": d.between(1450.0, 1550.0)}
    if kind == "munk":
        return {"kind": kind, "axis_depth": digits(0.3 * depth), "scale_depth": digits(max(0.3 * depth, 10.0))}
    n = max(n, 3) if shape != "gradient" else n
    change = min(25.0, 0.05 * depth) * d.between(0.3, 1.0)
    at = [digits(depth * i / (n - 1)) for i in range(n)]
    law = {"gradient": lambda x: -change * x, "upward": lambda x: change * x, "channel": lambda x: change * abs(2 * x - 1),
           "thermocline": lambda x: -change / (1 + math.exp(-25 * (x - 0.35))),
           "duct": lambda x: change * (x if x < 0.34 else 0.68 - x)}[shape]
    if kind == "temperature-salinity":
        return {"kind": kind, "interpolation": level["interpolation"], "depth": at,
                "temperature": [digits(12.0 + 0.25 * law(z / depth)) for z in at], "salinity": [35.0] * n}
    speed = [digits(1495.0 + law(z / depth), 7) for z in at]
    if kind == "section":
        return {"kind": kind, "range": [0.0, digits(2 * reach)], "depth": at,
                "speed": [speed, [digits(c + 2.0 * (1 - z / depth), 7) for c, z in zip(speed, at)]]}
    if kind == "table":
        return {"kind": kind, "interpolation": level["interpolation"], "depth": at, "speed": speed}
    return {"kind": kind}  # a kind that this does not know yet: `completed` draws what it requires


def attenuation(value, unit, speed, hz, prefix=""):
    """An attenuation in dB per wavelength as another key says it (docs/formats/scenario.md)."""
    return {"per wavelength": {prefix + "attenuation_db_per_wavelength": value},
            "per metre": {prefix + "attenuation_db_per_metre": value * hz / speed},
            "per metre kHz": {prefix + "attenuation_db_per_metre_khz": value * 1000.0 / speed},
            "nepers": {prefix + "attenuation_nepers_per_metre": value * hz / speed / 8.685889638065037},
            "quality": {prefix + "quality_factor": 27.287527 / value},
            "loss parameter": {prefix + "loss_parameter": value / 54.575054}}[unit]


def material(d, kind, unit, hz):
    if kind in ("vacuum", "rigid"):
        return {"kind": kind}
    if kind == "grain-size":
        return {"kind": kind, "grain_size": d.between(-1.0, 9.0)}
    if kind == "table":
        return {"kind": kind, "grazing_deg": [0.0, 20.0, 90.0], "magnitude": [1.0, d.between(0.3, 0.95), 0.2],
                "phase_deg": [180.0, 90.0, 0.0]}
    fluid = {"speed": d.between(1480.0, 1900.0), "density": d.between(1100.0, 2100.0)}
    fluid |= attenuation(d.times(0.05, 1.0), unit, fluid["speed"], hz)
    if kind == "fluid":
        return {"kind": kind, **fluid}
    solid = {"speed": d.between(2000.0, 4000.0), "shear_speed": d.between(300.0, 900.0), "density": d.between(1900.0, 2400.0)}
    solid |= attenuation(0.2, unit, solid["speed"], hz) | attenuation(0.5, unit, solid["shear_speed"], hz, "shear_")
    if kind == "elastic":
        return {"kind": kind, **solid}
    if kind == "layered":
        half = {key: value for key, value in (solid if d.one_of(False, True) else fluid).items()}
        return {"kind": kind, **half, "layer": [{"thickness": digits(1500.0 / hz * d.times(0.05, 5.0)), "speed": d.between(1450.0, 1700.0),
                                                 "density": 1500.0, "attenuation_db_per_wavelength": 0.2}]}
    return {"kind": kind}


# --- who is where ----------------------------------------------------------------------------------------------------

def nodes_of(profile, depth):
    if "depth" in profile:
        return profile["depth"]
    return [profile["axis_depth"]] if "axis_depth" in profile else [0.5 * depth]


def minimum_of(profile, depth):
    if profile["kind"] in ("table", "section"):
        speed = profile["speed"] if profile["kind"] == "table" else profile["speed"][0]
        return profile["depth"][speed.index(min(speed))]
    return profile.get("axis_depth", 0.5 * depth)


def place(d, how, profile, floor, top, other=None):
    """A depth in the water between the highest floor and the deepest surface."""
    margin = min(1.0, 0.05 * (floor - top))
    inside = [z for z in nodes_of(profile, floor) if top + margin < z < floor - margin] or [0.5 * (floor + top)]
    free = digits(top + (floor - top) * d.between(0.15, 0.85))
    z = {"free": free, "node": d.one_of(*inside), "minimum": minimum_of(profile, floor),
         "equal": free if other is None else other, "millimetre": (d.one_of(*inside) if other is None else other) + 1e-3,
         "hair": (d.one_of(*inside) if other is None else other) * (1 + 1e-12), "shallow": top + margin,
         "floor": floor - margin}[how]
    return min(max(z, top + margin), floor - margin)


def stations(d, level, s, floor, top, hz, reach):
    water = s["environment"]["sound_speed"]
    span, wave = floor - top, 1500.0 / hz
    zs = place(d, level["source place"], water, floor, top)
    zt = place(d, level["target place"], water, floor, top, zs)
    zt = min(max(zt, zs - 0.8 * reach), zs + 0.8 * reach)
    bearing = d.one_of(0.0, 30.0, 90.0, 217.0)
    away = math.sqrt(max(reach ** 2 - (zt - zs) ** 2, (0.3 * reach) ** 2))
    east, north = math.sin(math.radians(bearing)), math.cos(math.radians(bearing))
    def at(x, y, z):
        return [digits(x, 9) if x else 0.0, digits(y, 9) if y else 0.0, z]
    speed = min(d.times(0.1, 10.0), 0.05 * reach / max(2 * reach / 1500.0, 0.1))
    moves = level["motion"]
    ships = [{"name": "one", "position": at(0.0, 0.0, zs)}]
    if level["stations"] == "two":
        ships.append({"name": "two", "position": at(0.4 * reach * north, -0.4 * reach * east, place(d, "free", water, floor, top))})
    if moves in ("platform", "both"):
        for ship in ships:
            ship["velocity"] = [digits(speed), digits(-0.5 * speed), 0.0]
    if moves == "waypoints":
        ships[0] = {"name": "one", "waypoints": [{"time": 0.0, "position": at(0.0, 0.0, zs)},
                                                 {"time": digits(reach / 1500.0), "position": at(digits(speed * reach / 1500.0), 0.0, zs)},
                                                 {"time": 1000.0, "position": at(digits(speed * reach / 1500.0), digits(100 * speed), zs)}]}
    s["platform"] = ships
    t = {"name": "target", "position": at(away * east, away * north, zt)}
    if moves in ("target", "both"):
        t["velocity"] = [digits(-speed), digits(0.3 * speed), 0.0]
    strength = d.between(-10.0, 20.0)
    kind = level["target"]
    if kind in ("point", "two"):
        t["strength_db"] = strength
    elif kind == "aspect":
        t |= {"aspect": {"bow_db": 0.0, "beam_db": strength + 10.0, "stern_db": 3.0}, "heading_deg": 40.0}
    elif kind == "levels":
        t |= {"aspect": {"angle_deg": [0.0, 90.0, 180.0], "level_db": [0.0, strength, -3.0]}, "heading_deg": 40.0}
    else:
        size = min(30.0, 0.2 * span, 0.1 * reach)
        t |= {"heading_deg": 40.0, "highlight": [{"offset": [digits(size), 0.0, 0.0], "strength_db": strength},
                                                 {"offset": [digits(-0.6 * size), digits(0.1 * size), 0.0], "strength_db": 3.0}]}
    if level["fluctuation"] != "none":
        t["fluctuation"] = level["fluctuation"]
        if level["fluctuation"] in ("swerling-1", "swerling-3"):
            t["scan_pings"] = 1
    s["target"] = [t]
    if kind == "two":
        s["target"].append({"name": "second", "position": at(0.8 * away * east, 0.8 * away * north, place(d, "free", water, floor, top)),
                            "strength_db": 5.0})
    carrier = ships[-1]
    zr = (carrier["waypoints"][0]["position"] if "waypoints" in carrier else carrier["position"])[2]
    s["array"] = [array(d, level, 1.6 * min(zr - top, floor - zr), 0.1 * reach, wave, carrier["name"])]
    if level["ship"] == "ship":
        s["interferer"] = [{"name": "ship", "position": at(-0.7 * reach * north, 0.7 * reach * east, top + min(5.0, 0.2 * span)),
                            "level_db": 120.0}]


def array(d, level, room, reach, wave, platform):
    """[array], no longer than `room` where it may stand upright and than `reach` elsewhere."""
    n, kind = level["phones"], level["array"]
    most = min(room if kind in ("vertical", "line", "positions") else reach, reach)
    spacing = digits(max(min(wave * d.times(0.3, 8.0), 0.9 * most / max(n - 1, 1), 50.0), 1e-4))
    a = {"name": "array", "platform": platform, "kind": kind}
    if kind in ("horizontal", "vertical", "line"):
        a |= {"phones": n} | ({"spacing": spacing} if n > 1 else {})
    elif kind == "positions":
        a["positions"] = [[digits(spacing * i), digits(0.5 * spacing * (i % 2)), digits(0.2 * spacing * (i - 0.5 * (n - 1)))] for i in range(n)]
    elif kind == "towed":
        a |= {"behind": [digits(10 * spacing + spacing * i) for i in range(n)]}
    if kind in ("horizontal", "line", "towed"):
        a["heading_deg"] = d.one_of(0.0, 45.0, 90.0)
    if level["array offset"] == "offset":
        a["offset"] = [digits(3 * spacing), digits(-spacing), 0.0]
    if level["electronics"] == "errors":
        a["electronics"] = {"gain_db": [digits(0.5 * i + 0.5) for i in range(n)], "phase_deg": [10.0 * i for i in range(n)]}
    return a


# --- what is sent and received ---------------------------------------------------------------------------------------

def sound(d, level, s, hz, reach, depth):
    kind = level["transmitter"]
    t = {"platform": "one", "source_level_db": 210.0}
    if kind == "omnidirectional":
        t["taper"] = "omnidirectional"
    elif kind == "line":
        t |= {"taper": d.one_of("hann", "rectangular"), "beamwidth_deg": d.between(10.0, 90.0)}
    elif kind == "projectors":
        t |= {"kind": kind, "projector": [{"offset": [0.0, 0.0, digits(-0.25 * 1500.0 / hz)]},
                                          {"offset": [0.0, 0.0, digits(0.25 * 1500.0 / hz)]}]}
    else:
        t |= {"kind": "table", "table": {"bearing_deg": [0.0, 180.0], "elevation_deg": [-90.0, 0.0, 90.0],
                                         "level_db": [[-20.0, 0.0, -20.0], [-20.0, -3.0, -20.0]]}}
    s["transmitter"] = t
    s["pulse"], bandwidth = pulse(d, level, hz)
    length = s["pulse"]["duration"] if "duration" in s["pulse"] else len(s["pulse"]["samples"]) / s["pulse"]["sample_rate"]
    if level["window"] != "none" and s["pulse"]["kind"] != "file":
        s["pulse"]["window"] = level["window"]
    bounces = [b if b != "auto" else 4 for b in (level["surface bounces"], level["bottom bounces"])]
    slant = math.hypot(reach, 2 * min(sum(bounces), 2 * min(bounces) + 1) * depth)
    both = 2.0 if level["stations"] == "one" else 2.5
    first, last = 0.6 * both * reach / 1500.0, both * slant / 1420.0 + 2 * length + 64 / bandwidth
    start = 0.0 if level["stations"] == "two" else digits(max(0.0, first - length), 3)
    # A phone has at most some 6000 independent samples, however deep the sea.
    record = digits(max(min(last - start, 1500.0 / bandwidth), 1.2 * length), 3)
    p = {"count": level["pings"], "interval": digits(record + start + 1.0), "recording_duration": record, "samples": "baseband"}
    if start > 0.0:
        p["recording_start"] = start
    # Edges that jump have their -40 dB band at 32 over the duration to either side.
    rate = digits(2.5 * (hz + bandwidth + (40 / length if s["pulse"].get("window", "none") != "hann" else 4 / length)), 6)
    if level["samples"] == "pressure" and record * rate < 1e5:
        p |= {"samples": "pressure", "sample_rate": rate}
    s["pings"], s["_span"] = p, last
    s["propagation"] = {"max_surface_bounces": level["surface bounces"], "max_bottom_bounces": level["bottom bounces"]}
    if level["dimension"] == 3 and level["sea"] in ("flat", "floor"):
        s["propagation"] |= {"dimension": 3} | {
            key: 1 for key in ("max_surface_bounces", "max_bottom_bounces") if s["propagation"][key] not in (0, 1)}
    s["reverberation"] = reverberation(d, level, depth, record)
    if level["noise"] != "off":
        s["noise"] = noise(level, hz)


def pulse(d, level, hz):
    """[pulse] and its bandwidth [Hz]."""
    cycles = {"medium": d.times(20.0, 60.0), "short": d.times(4.0, 12.0), "long": d.times(100.0, 400.0)}[level["pulse length"]]
    length, kind = digits(cycles / hz), level["pulse"]
    swept = hz * d.between(0.05, 0.3)
    p = {"kind": kind, "duration": length}
    if kind == "cw":
        return p | {"frequency": hz}, 2 / length
    if kind in ("lfm", "hfm"):
        return p | {"start_frequency": digits(hz - swept / 2), "end_frequency": digits(hz + swept / 2)}, swept + 2 / length
    if kind == "sfm":
        return p | {"frequency": hz, "swing": digits(swept), "modulation_frequency": digits(2 / length)}, swept + 4 / length
    if kind == "costas":
        return {"kind": kind, "duration": digits(max(length, 60 / hz)), "frequency": hz, "prime": 5}, 8 / max(length, 60 / hz)
    if kind == "ptfm":
        return p | {"start_frequency": digits(hz - swept / 2), "end_frequency": digits(hz + swept / 2), "sweeps": 2}, swept + 4 / length
    if kind == "geometric_comb":
        length = digits(max(length, 60 / hz))
        low = digits(0.9 * hz)
        return {"kind": kind, "duration": length, "start_frequency": low, "end_frequency": digits(low + 4 / length), "lines": 3}, 6 / length
    if kind == "pulse_train":
        length = digits(max(length, 30 / hz))
        return {"kind": kind, "duration": length, "frequency": hz, "pulses": 2, "pulse_duration": digits(length / 3)}, 6 / length
    rate, n = digits(8 * hz), 96
    return {"kind": "file", "sample_rate": rate, "samples": [digits(math.sin(math.pi * i / n) ** 2 * math.sin(2 * math.pi * i / 8)) for i in range(n)]}, \
        4 * rate / n


def reverberation(d, level, depth, record):
    which = level["reverberation"]
    if which == "off":
        return {"enabled": False}
    # Some thirty rings of four sectors, however long the record.
    r = {"azimuths": 4 if level["sea"] in ("flat", "ice") else 2, "resolve_azimuth": False,
         "ground_spacing": digits(max(record * 750.0 / 30, 0.02), 3)}
    table = {"grazing_deg": [0.0, 90.0], "strength_db": [-50.0, -20.0]}
    if which in ("surface", "all"):
        r["surface"] = {"kind": level["surface law"]} | (table if level["surface law"] == "table" else {})
    else:
        r["surface"] = {"enabled": False}
    if which in ("bottom", "all"):
        r["bottom"] = {"kind": level["bottom law"]} | (table if level["bottom law"] == "table" else {})
    if which in ("volume", "all"):
        r["volume"] = [{"depth": [digits(0.3 * depth), digits(0.5 * depth)], "strength_db": d.between(-90.0, -60.0), "sheets": 2}]
    return r


def noise(level, hz):
    kind = level["noise"]
    n = {"kind": kind, "coherence": level["coherence"]}
    if kind == "white":
        n["spectral_level_db"] = 50.0
    elif kind == "table":
        n |= {"frequency": [digits(hz / 10), digits(min(hz * 10, 1e6))], "level_db": [60.0, 40.0]}
    if level["coherence"] == "profile":
        n["profile"] = {"elevation_deg": [-90.0, 0.0, 90.0], "level_db": [0.0, -3.0, 3.0]}
    return n


# --- all other settings ----------------------------------------------------------------------------------------------

def value_of(d, node, wanted):
    """A value of a setting by its schema; None if it cannot be drawn."""
    if wanted == "table":
        return completed(d, {}, schema.table_of(node))
    if wanted != "drawn":
        return wanted
    low, high, default, whole = schema.bounds(node)
    if isinstance(default, (int, float)) and not isinstance(default, bool) and default:
        value = default * d.times(0.5, 2.0)
    elif high - low <= 1000.0:
        value = low + 0.25 * (high - low) * d.between(0.0, 1.0)
    else:
        value = d.times(0.01, 10.0)
    value = min(max(value, low + 1e-3 * (low > float("-inf"))), high)
    return max(int(value), int(low) if low > float("-inf") else 0) if whole else digits(value)


def completed(d, table, node):
    """A table with a number for each key that is required."""
    for key in node.get("required", ()):
        inner = node["properties"][key]
        if key not in table and schema.bounds(inner) is not None:
            table[key] = value_of(d, inner, "drawn")
        elif key not in table and schema.words(inner):
            table[key] = schema.words(inner)[0]
    return table


def generic(d, s, levels):
    """Sets what no recipe does, wherever it may stand; keeps what the schema takes."""
    known, drawn = recipes(), []
    for path, node in schema.settings():
        name = ".".join(path)
        if name not in levels or name in known:
            continue
        wanted = d.level(name, levels[name])
        if wanted == "absent":
            continue
        table = s
        for key in path[:-1]:
            table = table.get(key) if isinstance(table, dict) else None
            table = table[0] if isinstance(table, list) and table else table
        if not isinstance(table, dict) or not schema.fits(table, path[-1]):
            continue
        table[path[-1]] = value_of(d, node, wanted)
        drawn.append((name, table, path[-1]))
    # What the schema does not take beside the rest goes again, the last one first.
    while drawn and schema.faults(s):
        name, table, key = drawn.pop()
        del table[key]
        d.used[name] = "absent"
    if s["pings"].get("continuous"):
        s["pings"].pop("recording_start", None)
    varies = s["environment"]["sound_speed"]["kind"] == "section" or "area" in s["environment"] or any(
        "shape" in s["environment"].get(boundary, {}) for boundary in ("surface", "bottom"))
    if varies and s["propagation"].get("dimension", 2) == 2:
        s["propagation"].pop("fathometer", None)
    s["_levels"] = dict(d.used)

"""Limits in which one thing becomes another, and what is linear or monotone."""
import json
import math

import h5py
import numpy as np

import program
from law import (Silent, alike, copied, db, energy, expect, field, law, loudness, need_leg, norm, one_place, ping, plain, smooth, still,
                 stratified, warned)
from program import Folder, Refused, run


@law
def smooth_limit(s, p):
    """A roughness of nothing is none. A wave height σ takes at most 2(kσ)² of a bounce: with kσ = 1e-4, 2e-8 of each;
    what it scatters is 4(kσ)² of intensity, 2e-4 of amplitude; a hundred bounces: 1e-3 by energy."""
    s = smooth(plain(s))
    first = ping(s)
    s2 = copied(s)
    sigma = 1e-4 / (2 * math.pi * s["_hz"] / 1500.0)
    name = p("boundary", ["surface", "bottom"])
    s2["environment"].setdefault(name, {"kind": "vacuum"})["roughness"] = sigma
    alike(first, ping(s2), s, 5e-3, f"roughness {sigma:.1e} m of the {name}")


@law
def calm_limit(s, p):
    """The sea of no wind is smooth."""
    s = plain(s)
    s["environment"]["wind_speed"] = 0.0
    surface = s["environment"].setdefault("surface", {"kind": "vacuum"})
    for key in ("bubbles_wind", "roughness_wind", "roughness_floor_db", "roughness"):
        surface.pop(key, None)
    first = ping(s)
    s2 = copied(s)
    s2["environment"]["surface"]["roughness"] = "wind"
    alike(first, ping(s2), s, 1e-6, "roughness = \"wind\" without wind")


@law
def wind_only_takes(s, p):
    """More wind leaves less of the mean field of every path that meets the surface, and of its energy no more than a calm sea.

    Rays are those of the same water, so they are told by their launch angles. 0.05 dB: what "auto" leaves out.
    """
    s = plain(s)
    s["environment"].setdefault("surface", {"kind": "vacuum"})["roughness"] = "wind"
    for key in ("roughness_wind", "roughness_floor_db", "bubbles_wind"):
        s["environment"]["surface"].pop(key, None)
    s["propagation"]["diffraction"] = False
    legs = []
    winds = [0.0, p("wind", [1.0, 1.75, 3.0, 5.0]), p("more", [8.0, 12.0, 20.0])]
    for wind in winds:
        s["environment"]["wind_speed"] = wind
        rows = need_leg(ping(copied(s)))
        mean = rows["amplitude_real"] ** 2 + rows["amplitude_imag"] ** 2
        legs.append({(round(float(angle), 5), int(up), int(down)): (float(m), float(m + x)) for angle, up, down, m, x in zip(
            rows["launch_elevation_deg"], rows["surface_bounces"], rows["bottom_bounces"], mean, np.nan_to_num(rows["scattered"]))})
    for i in (1, 2):
        for key, (mean, whole) in legs[i].items():
            if key in legs[0]:
                expect(db(whole) <= db(legs[0][key][1]) + 0.05, f"wind {winds[i]:g} m/s: path at {key[0]:g} degrees has {db(whole):.2f} dB, "
                       f"{db(legs[0][key][1]):.2f} dB without wind")
            if key in legs[i - 1]:
                expect(db(mean) <= db(legs[i - 1][key][0]) + 0.05, f"wind {winds[i]:g} m/s: the mean field of the path at {key[0]:g} degrees "
                       f"has {db(mean):.2f} dB, {db(legs[i - 1][key][0]):.2f} dB at {winds[i - 1]:g} m/s")


@law
def narrow_is_wide(s, p):
    """Of a tone of a thousand periods both bands are one frequency. Its band is f/500: path by path amplitudes and phases
    change by less than 5 % over it, where nothing resonates within (layers are at most a few wavelengths thick)."""
    s = one_place(plain(s))
    hz = s["_hz"]
    s["pulse"] = {"kind": "cw", "frequency": hz, "duration": 1000.0 / hz, "window": "hann"}
    s["pings"] = {"recording_duration": s["_span"] + 1000.0 / hz, "samples": "baseband"}
    s["propagation"]["band"] = "narrow"
    narrow = ping(s)
    s2 = copied(s)
    s2["propagation"]["band"] = "wide"
    wide = ping(s2)
    alike(narrow, wide, s, 0.05, "narrow and wide")


@law
def rest_limit(s, p):
    """A speed of a nanometre a second is none. Doppler shifts are 1e-12; phases change by k·v·t = 1e-6·f/1e6.

    What is towed follows astern of any course, so the speed is along the heading that the array has at rest. Over slopes
    plane waves serve the phones of what rests to −30 dB (docs/theory/echoes.md, Phones), and two steps what moves.
    """
    s = still(plain(s))
    if s["transmitter"].get("bearing_from") == "heading":  # a course would turn its beam
        s["transmitter"].pop("bearing_from")
    first = ping(s)
    s2 = copied(s)
    who = p("who", ["target", "platform"])
    course = math.radians(s["array"][0].get("heading_deg", 45.0))
    s2[who][0]["velocity"] = [1e-9 * math.sin(course), 1e-9 * math.cos(course), 0.0]
    e = s["environment"]
    slopes = "area" in e or e["sound_speed"]["kind"] == "section" or any("shape" in e.get(b, {}) for b in ("surface", "bottom"))
    alike(first, ping(s2), s, 0.0316 if slopes else 1e-3, f"{who} at 1e-9 m/s")


@law
def no_offset_limit(s, p):
    """An offset of 1e-9 m is none: k·1e-9 = 1e-3 at 300 kHz."""
    s = plain(s)
    first = ping(s)
    s2 = copied(s)
    for one in (s2["array"][0], s2["transmitter"]):
        one["offset"] = [x + 1e-9 for x in one.get("offset", [0.0, 0.0, 0.0])]
    alike(first, ping(s2), s, 5e-3, "offset by 1e-9 m")


@law
def no_loss_limit(s, p):
    """An added attenuation of 1e-9 dB/km is none: 1e-9 of amplitude."""
    s = plain(s)
    s["environment"].pop("attenuation", None)
    first = ping(s)
    s2 = copied(s)
    s2["environment"]["attenuation"] = {"db_per_km": 1e-9}
    alike(first, ping(s2), s, 1e-5, "attenuation of 1e-9 dB/km")


@law
def louder_source(s, p):
    """Samples are linear in the source's level, to rounding of float32 (6e-8, some operations)."""
    s = plain(s)
    first = ping(s)
    more = p("db", [20.0, 6.0, -40.0])
    s2 = copied(s)
    s2["transmitter"]["source_level_db"] += more
    second = ping(s2)
    second_pressure = second.pressure / 10 ** (more / 20)
    off = norm(second_pressure - first.pressure) / loudness(first, s)
    expect(off <= 1e-5, f"{more:+g} dB of source level: samples differ by {off:.1e}")


@law
def stronger_target(s, p):
    """Echoes are linear in the target's strength."""
    s = plain(s)
    s["propagation"]["direct_blast"] = False
    s["propagation"]["fathometer"] = False
    first = ping(s)
    more = p("db", [20.0, 6.0, -40.0])
    s2 = copied(s)
    def add(one):
        for key in ("strength_db", "bow_db", "beam_db", "stern_db"):
            if key in one:
                one[key] += more
        if "level_db" in one:
            one["level_db"] = [x + more for x in one["level_db"]]
    for t in s2["target"]:
        add(t)
        add(t.get("aspect", {}))
        for h in t.get("highlight", ()):
            add(h)
            add(h.get("aspect", {}))
    second = ping(s2)
    off = norm(second.pressure / 10 ** (more / 20) - first.pressure) / loudness(first, s)
    expect(off <= 1e-5, f"{more:+g} dB of target strength: samples differ by {off:.1e}")


@law
def targets_add(s, p):
    """Two targets together are the sum of each alone: 3.6e-4.

    Synthesis errs by -90 dB of the loudest sound (3e-5) in each of four places, that is in the pulse's band, in the filter
    of delays, in the expansion of Doppler and in the paths that are left out, and three runs are compared.

    "auto" follows as many bounces as each run needs, so numbers stand in its place. What rough boundaries scatter is drawn
    for each target by its number. A pulse has soft edges here: of one whose edges jump, what is let through depends on the
    largest Doppler factor of all targets (theory/synthesis.md, "Band"). Pulses of pieces jump between these, so they are
    held to the law at rest. Waves are sampled over the band to 4e-3 at as many frequencies as the legs of all targets need
    (sonar/echoes/leg_response.h).
    """
    s = smooth(plain(s))
    if s["pulse"]["kind"] != "file":
        s["pulse"]["window"] = "hann"
    if s["pulse"]["kind"] in ("costas", "ptfm", "pulse_train"):
        s = still(s)
    s["propagation"]["direct_blast"] = False
    s["propagation"]["fathometer"] = False
    for key in ("max_surface_bounces", "max_bottom_bounces"):
        if s["propagation"].get(key) == "auto":
            s["propagation"][key] = 2
    a = s["target"][0]
    b = {"name": "another", "strength_db": 3.0}
    if "position" in a:
        b["position"] = [0.9 * a["position"][0] + 1.0, 0.9 * a["position"][1], a["position"][2]]
    else:
        b["position"] = list(a["waypoints"][0]["position"])
    both, one, other = program.at_one_rate(*(ping(copied(s) | {"target": targets}) for targets in ([a, b], [a], [b])))
    n = min(x.pressure.shape[-1] for x in (both, one, other))
    off = norm(both.pressure[..., :n] - one.pressure[..., :n] - other.pressure[..., :n]) / loudness(both, s)
    waves = bool(np.any(np.asarray(both.arrivals.get("kind", [0])) != 0))
    expect(off <= (4e-3 if waves else 3.6e-4), f"two targets differ from the sum of both by {off:.1e}")


@law
def equal_layers(s, p):
    """A layer of the half space's own material is none: 1e-6 of rounding in the layers' impedances."""
    s = plain(s)
    bottom = s["environment"]["bottom"]
    fluid = {"speed": 1650.0, "density": 1800.0, "attenuation_db_per_wavelength": 0.5}
    geometry = {k: v for k, v in bottom.items() if k in ("depth", "shape")}
    s["environment"]["bottom"] = {"kind": "fluid", **geometry, **fluid}
    first = ping(s)
    thick = p("thickness", [0.3, 1.0, 7.0]) * 1500.0 / s["_hz"]
    s2 = copied(s)
    s2["environment"]["bottom"] = {"kind": "layered", **geometry, **fluid, "layer": [{"thickness": thick, **fluid}]}
    alike(first, ping(s2), s, 1e-3, f"a layer of {thick:g} m of the same")


@law
def no_focus_in_isovelocity(s, p):
    """In water of one speed between walls that reflect all angles alike waves add nothing to images: diffraction on and off
    are the same. Off other walls waves are not reflected as plane waves are, and rays have no part in that."""
    s = stratified(plain(s))
    e = s["environment"]
    for name, kind in (("bottom", p("bottom", ["rigid", "vacuum"])), ("surface", "vacuum")):
        wall = e.get(name, {"kind": "vacuum"})
        kept = {k: v for k, v in wall.items() if k == "depth" or k.startswith(("roughness", "bubbles"))}
        e[name] = {"kind": wall["kind"] if wall["kind"] in ("rigid", "vacuum") else kind} | kept
    s["environment"]["sound_speed"] = {"kind": "isovelocity", "speed": 1500.0}
    s["propagation"]["diffraction"] = True
    first = ping(s)
    s2 = copied(s)
    s2["propagation"]["diffraction"] = False
    alike(first, ping(s2), s, 1e-3, "diffraction in water of one speed")


@law
def image_sources(s, p):
    """In water of one speed between a free surface and a floor far below, direct and surface path are those of images:
    closed forms. 1e-6 of the distance, absorption as the run has it."""
    s = one_place(still(stratified(plain(s))))
    c = 1500.0
    e = s["environment"]
    e["sound_speed"] = {"kind": "isovelocity", "speed": c}
    e.pop("surface", None)
    s["propagation"] |= {"max_surface_bounces": 1, "max_bottom_bounces": 0}
    rows = need_leg(ping(s))
    a, b = s["platform"][0]["position"], s["target"][0]["position"]
    r = math.hypot(a[0] - b[0], a[1] - b[1])
    for bounces, sign in ((0, 1.0), (1, -1.0)):
        which = (rows["surface_bounces"] == bounces) & (rows["bottom_bounces"] == 0)
        length = math.hypot(r, a[2] - b[2] if bounces == 0 else a[2] + b[2])
        expect(np.sum(which) == 1, f"{int(np.sum(which))} paths with {bounces} bounces off the surface, expected one")
        k = int(np.flatnonzero(which)[0])
        # 10 us/s of relative error: delays are told to 1e-9 s.
        expect(abs(rows["delay"][k] - length / c) <= 1e-9 + 1e-7 * length / c, f"delay {rows['delay'][k]:.9f} s, image {length / c:.9f} s")
        want = sign / length * 10 ** (-rows["absorption_db"][k] / 20)
        got = rows["amplitude_real"][k] + 1j * rows["amplitude_imag"][k]
        expect(abs(got - want) <= 1e-4 * abs(want), f"amplitude {got:.6g}, image {want:.6g}")


@law
def legs_are_waves(s, p):
    """A leg's paths add up to the wave equation's field: 41 % of it over ten wavelengths of range, by which 3 dB of energy are off.

    Nine places along ten wavelengths, the coherent sum of paths at each, against `asdic field` by waves at the same
    ones. Rays are stationary phase: right where depth is many wavelengths, so the water is twenty of them at least. Paths
    that have the reflection of plane waves may be wrong by 12 % of the root of their energy before the run warns. Beside a
    wall they cancel and these errors do not, so they are added. Tables that change fast with the angle are left out, since
    waves need what they are at complex angles. Water takes 40 dB from what comes at the record's end, and 2 dB from what
    comes first: near a mode's cut-off between walls without loss images add up for ever, and a record of any length holds
    too few.
    """
    s = smooth(one_place(still(stratified(plain(s)))))  # what is scattered is the rays' alone
    e = s["environment"]
    depth = e["bottom"]["depth"]
    wave = depth / p("wavelengths", [20.0, 35.0, 60.0])
    hz = 1500.0 / wave
    s["pulse"] = {"kind": "cw", "frequency": hz, "duration": 20.0 / hz, "window": "hann"}
    for boundary in (e["bottom"], e.get("surface", {})):
        for key in boundary:
            if key.endswith("per_metre"):  # the same loss per wavelength as at the drawn frequency
                boundary[key] *= hz / s["_hz"]
        for layer in boundary.get("layer", ()):  # as many wavelengths thick as drawn
            layer["thickness"] *= s["_hz"] / hz
        if boundary.get("kind") == "table":
            boundary |= {"magnitude": boundary["magnitude"][1:2] * 3, "phase_deg": [180.0] * 3}
    e.pop("spreading", None)  # other laws than the wave equation's
    e.pop("biology", None)  # losses with depth are left to rays
    a, b = s["platform"][0]["position"], s["target"][0]["position"]
    r = min(max(math.hypot(a[0] - b[0], a[1] - b[1]), depth), 15 * depth)
    e["attenuation"] = {"db_per_km": 2000.0 / (r + depth)}
    s["propagation"] |= {"max_surface_bounces": "auto", "max_bottom_bounces": "auto"}
    # "auto" follows what arrives in the record: steep paths of ten times the way as well.
    s["pings"] = {"recording_duration": 20.0 * (r + depth) / 1500.0, "samples": "baseband"}
    ranges = [float(f"{r + (i - 4) * 10 * wave / 8:.8g}") for i in range(9)]
    b[:2] = [a[0], a[1] + r]
    sums, energies = [], []
    with Folder(s) as folder:
        for x in ranges:
            said = json.loads(run(folder, "arrivals", "s.toml", "--receiver-depth", repr(b[2]), "--range", repr(x), "--json"))
            rows = said["legs"][0]["arrivals"]
            sums.append(sum((one["amplitude_real"] + 1j * one["amplitude_imag"]) * np.exp(-2j * np.pi * hz * one["delay"]) for one in rows))
            energies.append(sum(one["amplitude_real"] ** 2 + one["amplitude_imag"] ** 2 for one in rows))
    f = {k: v for k, v in s.items() if k in ("environment", "_files")}
    f["run"] = {"task": "field", "field": "coherent", "solver": "waves", "frequency": hz, "source": {"depth": a[2]},
                "receivers": {"depth": b[2], "range": ranges}}
    with Folder(f) as folder:
        run(folder, "field", "s.toml", "-o", "f.h5", "-q", "--threads", "1")
        with h5py.File(folder / "f.h5") as file:
            name = next(key for key in file if key.startswith("pressure"))
            value = np.asarray(file[name][...])
    waves = (value[..., 0] + 1j * value[..., 1]).ravel()
    off = norm(np.array(sums) - waves) / norm(waves)
    most = 0.41 + 0.12 * math.sqrt(sum(energies)) / norm(waves)
    if off > most and any(warned(ping(s), words) for words in ("as plane waves are", "no direct ray goes", "waves along a boundary")):
        raise Silent("warned")
    expect(off <= most, f"paths {db(norm(sums) ** 2 / 9):.2f} dB, waves {db(norm(waves) ** 2 / 9):.2f} dB over ten wavelengths at {r:g} m, "
           f"their difference {off:.2f} of the waves, at most {most:.2f}")

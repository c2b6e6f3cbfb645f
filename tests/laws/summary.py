"""What a file says about its samples is what they hold."""
import math

import numpy as np

from law import Silent, alike, copied, db, duration, expect, law, loudness, need_leg, norm, one_place, ping, plain, still, warned, water_depth
from program import Folder, run


def one_echo(s):
    """One phone, one point target, no other sound; all bounces that are followed fit into the record."""
    s = one_place(plain(s))
    for key in ("max_surface_bounces", "max_bottom_bounces"):
        if s["propagation"].get(key) == "auto":
            s["propagation"][key] = 2
    s["pings"] = {"samples": "baseband", "recording_duration": s["_span"] + 0.1}
    return s


@law
def peak_is_in_the_samples(s, p):
    """`echo_peak_db` is the greatest envelope over sqrt(2): 0.5 dB.

    Synthesis errs by -90 dB of all paths together. Where these cancel by 60 dB and more, nothing is said.
    """
    s = one_echo(s)
    record = ping(s)
    said = float(record.summary["echo_peak_db"][0, 0])
    most = record.peak()
    if not math.isfinite(said) or most == 0.0:
        raise Silent("no echo")
    found = 20 * math.log10(most / math.sqrt(2) / 1e-6)
    if found < 20 * math.log10(np.sum(10 ** (record.echoes["level_db"] / 20))) - 60:
        raise Silent("paths cancel")
    expect(abs(said - found) <= 0.5, f"echo_peak_db {said:.2f} dB, samples {found:.2f} dB")


@law
def strongest_path_is_listed(s, p):
    """`echo_level_db` and `echo_time` are those of the strongest row of /echoes."""
    s = one_echo(s)
    record = ping(s)
    level = record.echoes.get("level_db", np.zeros(0))
    said = float(record.summary["echo_level_db"][0, 0])
    if len(level) == 0 or not math.isfinite(said):
        raise Silent("no echo")
    k = int(np.argmax(level))
    expect(abs(said - level[k]) <= 0.01, f"echo_level_db {said:.2f} dB, the loudest of /echoes {level[k]:.2f} dB")
    near = level >= level[k] - 0.01
    expect(np.min(np.abs(record.echoes["delay"][near] - float(record.summary["echo_time"][0, 0]))) <= 1e-6, "echo_time is not that path's delay")


@law
def echo_is_its_legs(s, p):
    """A row of /echoes is the product of two rows of /arrivals: level and delay, of an omnidirectional source at rest.

    A level is that of the mean intensity, with what rough boundaries scatter about the paths (docs/theory/echoes.md).
    """
    s = still(one_echo(s))
    record = ping(s)
    out, home = need_leg(record, 0), need_leg(record, 1)
    e = record.echoes
    if len(e.get("level_db", ())) == 0:
        raise Silent("no echo")
    size = lambda rows: np.sqrt(rows["amplitude_real"] ** 2 + rows["amplitude_imag"] ** 2 + np.nan_to_num(rows["scattered"]))
    by_path = [{int(path): k for k, path in enumerate(rows["path"])} for rows in (out, home)]
    for k in range(min(len(e["level_db"]), 200)):
        i, j = by_path[0].get(int(e["outgoing"][k])), by_path[1].get(int(e["returning"][k]))
        if i is None or j is None:
            continue
        want = s["transmitter"]["source_level_db"] + 10.0 + 20 * math.log10(max(size(out)[i] * size(home)[j], 1e-300))
        if want > -200.0:
            expect(abs(want - e["level_db"][k]) <= 0.01, f"echo {k}: {e['level_db'][k]:.3f} dB, its legs {want:.3f} dB")
        # Paths are found again at their own moments: all is at rest, so to the search's 1e-7 s.
        expect(abs(out["delay"][i] + home["delay"][j] - e["delay"][k]) <= 1e-6, f"echo {k}: {e['delay'][k]:.7f} s, its legs {out['delay'][i] + home['delay'][j]:.7f} s")


@law
def bearings_are_true(s, p):
    """Bearings and ranges of legs are those of the places: 0.01 degrees and 1 mm, at rest."""
    s = still(plain(s))
    record = ping(s)
    a = record.arrivals
    if not a or len(a["leg"]) == 0:
        raise Silent("no path")
    ship = {one["name"]: one["position"] for one in s["platform"]}
    sender, array = ship[s["transmitter"]["platform"]], s["array"][0]
    sender = [x + y for x, y in zip(sender, s["transmitter"].get("offset", [0, 0, 0]))]
    middle = np.mean(record.phone_position[0], axis=0)
    for k in range(len(a["leg"])):
        target = s["target"][int(a["target"][k])]["position"] if a["target"][k] >= 0 else None
        if a["channel"][k] >= 0 or array["kind"] == "towed" or s["transmitter"].get("kind"):
            continue
        start, end = {0: (sender, target), 1: (target, middle), 2: (sender, middle)}[int(a["leg"][k])]
        dx, dy = end[0] - start[0], end[1] - start[1]
        if math.hypot(dx, dy) < 1.0 or "dimension" in s["propagation"]:
            continue
        expect(abs(a["range"][k] - math.hypot(dx, dy)) <= 1e-3 + 1e-9 * math.hypot(dx, dy), f"range {a['range'][k]:.4f} m, places {math.hypot(dx, dy):.4f} m")
        off = (a["bearing_deg"][k] - math.degrees(math.atan2(dx, dy)) + 180.0) % 360.0 - 180.0
        expect(abs(off) <= 0.01, f"bearing off by {off:.4f} degrees")


@law
def samples_hold_the_echo(s, p):
    """A single path's echo has the energy of the pulse at its level, and comes at its delay.

    Synthesis leaves -80 dB; 0.1 dB for a record's baseband filter. The correlation with the pulse peaks at the delay to
    half a sample.
    """
    s = still(one_echo(s))
    s["environment"].pop("surface", None)
    s["propagation"] |= {"max_surface_bounces": 0, "max_bottom_bounces": 0, "band": "narrow"}
    record = ping(s)
    e = record.echoes
    if len(e.get("level_db", ())) != 1:
        raise Silent("not one path")
    if warned(record, "reaches down to 0 Hz"):  # edges of few periods: what lies below is not recorded
        raise Silent("warned")
    want = loudness(record, s)
    got = norm(record.pressure[0, 0])
    rows = [need_leg(record, k) for k in (0, 1)]
    if any(np.any(np.nan_to_num(r["scattered"]) > 0) for r in rows) or any(np.any(r["kind"] != 0) for r in rows):
        raise Silent("not a single ray")
    expect(abs(20 * math.log10(got / want)) <= 0.1, f"samples {20 * math.log10(got / want):+.2f} dB re the path's level and the pulse")


@law
def levels_hold_the_echo(s, p):
    """/levels' row of echoes integrates to the samples' energy: 0.5 dB (as `echo_peak_db`)."""
    s = one_echo(s)
    record = ping(s)
    if not record.levels or not np.any(record.pressure):
        raise Silent("no echo")
    energy = float(np.sum(record.levels["echo"][0])) * record.level_step
    held = float(np.sum(np.abs(record.pressure[0, 0]) ** 2)) / record.rate * (0.5 if record.carrier is not None else 1.0)
    expect(abs(db(energy / held)) <= 0.5, f"/levels {db(energy / held):+.2f} dB re the samples")


def independent_values(record):
    """The number of independent values in the noise of several pings: time times the width of its spectrum, (sum P)^2 / sum P^2.

    P is the mean of the pings' periodograms, whose squares are by 1 over their number larger than the spectrum's. Phones may
    receive the same noise, so they count as one.
    """
    x = record.pressure[:, 0]
    power = np.mean(np.abs((np.fft.fft if record.carrier is not None else np.fft.rfft)(x)) ** 2, axis=0)
    return (len(x) + 1) * float(np.sum(power)) ** 2 / float(np.sum(power ** 2))


@law
def levels_hold_the_noise(s, p):
    """/levels' row of noise is the samples' mean square, to six standard deviations of the mean of independent values."""
    if "noise" not in s:
        raise Silent("no noise")
    noise = s["noise"]
    s = plain(s)
    s["noise"] = noise
    s["target"] = s["target"][:1]
    s["transmitter"]["source_level_db"] = -200.0
    s["pings"]["count"] = 2
    record = ping(s)
    row = record.levels.get("noise") if record.levels else None
    if row is None or not np.any(row) or record.pressure.shape[-1] < 64:
        raise Silent("no noise")
    held = float(np.mean(np.abs(record.pressure) ** 2)) * (0.5 if record.carrier is not None else 1.0)
    said = float(np.mean(row))
    share = 6.0 / math.sqrt(independent_values(record)) + 0.01
    expect(abs(held / said - 1.0) <= share, f"samples {held / said - 1.0:+.3f} of /levels, at most {share:.3f}")


@law
def levels_hold_the_reverberation(s, p):
    """/levels' row of reverberation is the mean of what is received: over six pings whose scatterers forget.

    A record has about as many independent values as pulses fit into what is loud of it; at six standard deviations.
    A value may be a sum of few scatterers, whose powers vary like exponentials: factor two in variance.
    """
    r = copied(s)["reverberation"]
    if not r.get("enabled", True):
        raise Silent("no reverberation")
    s = still(plain(s))
    s["target"] = s["target"][:1]
    s["target"][0] = {k: v for k, v in s["target"][0].items() if k in ("name", "position")} | {"strength_db": -200.0}
    s["propagation"] |= {"direct_blast": False, "fathometer": False}
    s["propagation"].pop("dimension", None)
    for part in ("surface", "bottom"):
        if part in r:
            r[part] = {k: v for k, v in r[part].items() if k not in ("frozen", "coherence_time", "k_shape", "correlation_length")} | (
                {"coherence_time": 0.0} if r[part].get("enabled", True) else {})
    for layer in r.get("volume", ()):
        for key in ("frozen", "coherence_time", "k_shape", "correlation_length"):
            layer.pop(key, None)
    filled = 700.0 * s["pulse"].get("duration", 0.0)  # less than half of what the pulse is long
    if r.get("ground_spacing", 0.0) > filled and s["pings"]["recording_duration"] < 300 * s["pulse"].get("duration", 0.0):
        r["ground_spacing"] = filled
    # As many sectors as by default. Places are drawn once for all pings, so that of few and large cells one beside an end,
    # or in a lobe about the mirrored direction, is all of the mean.
    r["azimuths"] = 36
    cell = 0.25 * min(min(z, water_depth(s) - z) for z in (one["position"][2] for one in s["platform"]))
    if cell < s["pings"]["recording_duration"] * 750.0 / 300:
        raise Silent("more than 300 rings")
    r["ground_spacing"] = min(r.get("ground_spacing", cell), cell)
    s["reverberation"] = r
    s["pings"]["count"] = 6
    s["pings"]["interval"] = s["pings"]["recording_duration"] + s["pings"].get("recording_start", 0.0) + 1.0
    record = ping(s)
    row = record.levels.get("reverberation") if record.levels else None
    if row is None or not np.any(row):
        raise Silent("no reverberation")
    if warned(record, "reverberation.ground_spacing"):
        raise Silent("rings with gaps")
    power = np.mean(np.abs(record.pressure) ** 2, axis=1) * (0.5 if record.carrier is not None else 1.0)  # of phones
    held, said = float(np.mean(power)), float(np.mean(np.asarray(row, dtype=float)[..., : row.shape[-1]]))
    # Cells that count: the effective number of intervals, (Σx)²/Σx².
    x = np.asarray(row, dtype=float).mean(axis=0)
    step = s["pings"]["recording_duration"] / x.size
    cells = float(x.sum() ** 2 / np.sum(x ** 2)) * min(1.0, step / max(duration(s), step))
    # Within a few pulses it comes from few places, which are the same for all pings.
    share = 6.0 * math.sqrt(2.0 / max((6.0 if cells > 3.0 else 1.0) * cells, 1.0))
    expect(held / said <= 1 + share + 0.1 and (share >= 0.9 or held / said >= 1 - share - 0.1),
           f"samples {db(held / said):+.2f} dB re /levels over {cells:.1f} independent cells")


@law
def arrivals_are_the_pings(s, p):
    """`asdic arrivals` tells the legs that `asdic ping` used: amplitudes to 1e-6, delays to 1e-9 s, at rest."""
    import json
    s = still(plain(s))
    record = ping(s)
    rows = need_leg(record)
    with Folder(s) as folder:
        said = json.loads(run(folder, "arrivals", "s.toml", "--leg", "target", "--target", "0", "--json"))
    found = said["legs"][0]["arrivals"]
    expect(len(found) == len(rows["delay"]), f"{len(found)} arrivals, /arrivals {len(rows['delay'])}")
    order = np.argsort(rows["delay"], kind="stable")
    a = (rows["amplitude_real"] + 1j * rows["amplitude_imag"])[order]
    for k, one in enumerate(found):
        expect(abs(one["delay"] - rows["delay"][order][k]) <= 1e-9, f"arrival {k}: {one['delay']} s, /arrivals {rows['delay'][order][k]} s")
    b = np.array([one["amplitude_real"] + 1j * one["amplitude_imag"] for one in found])
    expect(np.sum(np.abs(np.sort_complex(a) - np.sort_complex(b))) <= 1e-5 * max(np.sum(np.abs(a)), 1e-300), "amplitudes differ")


@law
def losses_add_up(s, p):
    """Of each path spreading, absorption and bounces make its level: amplitude² never above spreading and absorption alone.

    Reflections take: |R| ≤ 1. Caustic and diffracted paths have their waves' amplitude as spreading.
    """
    record = ping(plain(s))
    for leg in (0, 1):
        rows = record.leg(leg)
        if not rows:
            continue
        level = 20 * np.log10(np.maximum(1e-300, np.hypot(rows["amplitude_real"], rows["amplitude_imag"])))
        most = -(rows["spreading_db"] + rows["absorption_db"])
        free = (rows["surface_bounces"] == 0) & (rows["bottom_bounces"] == 0)
        for k in range(len(level)):
            if not np.isfinite(most[k]) or level[k] < -250:
                continue
            expect(level[k] <= most[k] + 0.01, f"leg {leg}, path {k}: {level[k]:.2f} dB, {most[k]:.2f} dB without its bounces")
            expect(not free[k] or abs(level[k] - most[k]) <= 0.01, f"leg {leg}, path {k} without a bounce: {level[k]:.2f} dB, spreading and absorption {most[k]:.2f} dB")

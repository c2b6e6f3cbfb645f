"""What the page of a ping file shows, as numbers that go into JSON.

Images are those of the pictures: the same functions compute them. Where there is too much for a
page, cells are joined, and each tells the largest value of those it is made of.
"""
from __future__ import annotations

import base64
import math
import re

import numpy as np
from asdic_pictures import (bearing_time, bearings, levels, processed, range_bearing, rays, signal,
                            spectrogram, style, sweep)

CELLS = 1_500_000      # of all images of a page: about 4 MB of text
VIEWS = 12             # pings and arrays that are shown whole
STEP = 0.01            # of the values of images [dB]
MARKS = 300            # path pairs of a target that are marked
SHAPE = 2e-4           # a ray may be drawn this far from where it is, of the panel's height


def content(data, ping: int | None = None, array: str | None = None) -> dict:
    """All that the page shows of a PingFile. ping: its number, array: its name; None: all of them,
    as far as they go into a page. \\throws InputError
    """
    views, notes = chosen(data, ping, array)
    first = views[0]
    name = data.path.rsplit("/", 1)[-1]
    page = {"title": data.title or name, "file": name,
            "version": data._text(data.file.attrs, "program_version") or "",
            "scenario": scenario(data), "targets": [], "notes": notes,
            "arrays": data.array_names, "processed": processed.there(data),
            "colours": [map_colour(i) for i in range(256)], "themes": themes(), "views": []}
    page["tables"] = target_lines(page["scenario"])
    page["targets"] = list(data.target_names)
    page["warnings"] = warnings(data)
    for row, number in views:
        page["views"].append(view(data, row, number))
    select(data, *first)
    data.choose_ping(int(data.numbers[first[0]]))
    page["rays"] = ray_panel(data)
    page["history"] = history(data, page["notes"])
    page["tracks"] = tracks(data, {number for _, number in views})
    page["notes"] += joined(page)
    page["notes"].append(f"The {data.samples // data._finer} samples of each phone are not here. "
                         "What is shown are the numbers of the pictures of asdic plot.")
    page["notes"] += data.warnings()
    return page


def chosen(data, ping, array):
    """Which (row, array) are shown, the first that tells bearings first. → views, notes"""
    numbers = [data.choose_array(array)] if array else list(range(len(data.array_names)))
    rows = [data.choose_ping(ping)] if ping is not None else [int(r) for r in data.simulated]
    if not rows:
        data.choose_ping(None)  # says what is wrong
    most = max(VIEWS // len(numbers), 1)
    notes = []
    if len(numbers) > VIEWS:
        notes.append(f"{VIEWS} of {len(numbers)} arrays are here; --array NAME chooses another.")
        numbers = numbers[:VIEWS]
    if len(rows) > most:
        kept = np.unique(np.linspace(0, len(rows) - 1, most).round().astype(int))
        notes.append(f"{len(kept)} of {len(rows)} pings are here whole; --ping N chooses another.")
        rows = [rows[k] for k in kept]
    return [(row, number) for row in rows for number in numbers], notes


def select(data, row: int, array: int) -> None:
    data.choose_ping(int(data.numbers[row]))
    data.select_array(array)


def themes() -> dict:
    """Colours of the pictures' themes: of targets, in their order, and of levels."""
    found = {}
    for name in ("light", "dark"):
        with style.look(name):
            found[name] = {"targets": list(style.TARGETS), "noise": style.GREY,
                           "reverberation": style.SLATE, "several": style.BROWN}
    return found


def map_colour(i: int) -> str:
    red, green, blue = (round(255 * part) for part in style.matplotlib.colormaps[style.MAP](i)[:3])
    return f"{red:02x}{green:02x}{blue:02x}"


def scenario(data) -> str:
    if not data.has("scenario"):
        return ""
    text = data.read("scenario")[()]
    return text.decode("utf-8", "replace") if isinstance(text, bytes) else str(text)


def target_lines(text: str) -> list:
    """[target] its first line in the scenario, from 0, and the one after its last"""
    lines = text.splitlines()
    heads = [i for i, line in enumerate(lines) if re.match(r"\s*\[(?!\[?\s*target\s*\.)", line)]
    return [[i, next((h for h in heads if h > i), len(lines))]
            for i in heads if re.match(r"\s*\[\[\s*target\s*\]\]", lines[i])]


def warnings(data) -> list:
    found = data.file.attrs.get("warnings", [])
    return [w.decode() if isinstance(w, bytes) else str(w) for w in np.ravel(found)]


# ---------------------------------------------------------------- numbers for JSON

def number(value, digits: int = 6):
    """A number of so many figures, None where there is none."""
    value = float(value)
    return float(f"{value:.{digits}g}") if math.isfinite(value) else None


def numbers(values, digits: int = 6) -> list:
    return [number(v, digits) for v in np.ravel(values)]


def packed(values, step: float = STEP) -> dict:
    """A matrix as whole steps above its least value, 16 bits each; 65535 where it has none."""
    values = np.asarray(values, float)
    good = np.isfinite(values)
    low, high = (values[good].min(), values[good].max()) if good.any() else (0.0, 0.0)
    step = max(step, (high - low) / 65534.0)
    whole = np.full(values.shape, 65535, "<u2")
    whole[good] = np.rint((values[good] - low) / step)
    return {"rows": values.shape[0], "columns": values.shape[1], "low": float(low), "step": step,
            "data": base64.b64encode(whole.tobytes()).decode()}


def most(values, rows: int, columns: int):
    """The largest value of each cell of so many rows and columns; NaN where none has one."""
    above = [-values.shape[0] % rows, -values.shape[1] % columns]
    padded = np.pad(values, [(0, above[0]), (0, above[1])], constant_values=np.nan)
    blocks = padded.reshape(padded.shape[0] // rows, rows, -1, columns)
    blocks = np.where(np.isfinite(blocks), blocks, -np.inf).max(axis=(1, 3))
    return np.where(np.isfinite(blocks), blocks, np.nan)


def image(values, x_edges, y_edges, axis: dict, what: str, unit: str, limits) -> dict:
    """Cells between edges, y up; joined later, when it is known how many there are on the page."""
    return {"values": np.asarray(values, float), "x_edges": np.asarray(x_edges, float),
            "y_edges": np.asarray(y_edges, float), "axis": axis, "what": what, "unit": unit,
            "limits": [float(limit) for limit in limits], "marks": []}


def joined(page) -> list:
    """Packs all images, with cells joined so that all of them fit. → notes"""
    of_views = [panel for view in page["views"] for panel in view["images"]]
    images = of_views + ([page["history"]] if page["history"] else [])
    total = sum(panel["values"].size for panel in images)
    factor = max(math.ceil(total / CELLS), 1)
    notes = []
    for panel in images:
        values, x, y = panel.pop("values"), panel.pop("x_edges"), panel.pop("y_edges")
        columns = factor if panel["name"] == "Pings" else math.ceil(math.sqrt(factor))
        columns = min(columns, values.shape[1])
        rows = 1 if panel["name"] == "Pings" else min(math.ceil(factor / columns), values.shape[0])
        panel["x"] = {"first": float(x[0]), "step": float((x[-1] - x[0]) / (len(x) - 1) * columns),
                      "last": float(x[-1])}
        panel["y"] = numbers(np.append(y[:-1:rows], y[-1]), 9)
        panel["cells"] = packed(most(values, rows, columns))
        if rows * columns > 1:
            panel["joined"] = f"{rows} × {columns}"
            note = (f"{panel['name']}: each cell shows the largest of {rows} × {columns} cells "
                    "(up × along).")
            if note not in notes:
                notes.append(note)
    return notes


# ---------------------------------------------------------------- axes

def cosine_axis(axis) -> dict:
    """Even in the cosine of the angle to a line, whose two sides look alike: labels are of its
    first side, as in the pictures (bearings.py).
    """
    return {"kind": "cosine", "ahead": number(bearings.ahead(axis) % 360.0, 9),
            "label": f"{bearings.TRUE} ({bearings.side(axis, False)} side)"}


def sine_axis(upwards: float = 1.0) -> dict:
    return {"kind": "sine", "upwards": upwards, "label": bearings.UPWARDS}


def azimuth_axis() -> dict:
    return {"kind": "bearing", "label": bearings.TRUE}


def linear_axis(label: str, unit: str, **more) -> dict:
    return {"kind": "linear", "label": label, "unit": unit, **more}


def scan_axis(where) -> dict:
    """Of a bearing–time record."""
    if where.kind == "horizontal":
        return cosine_axis(where.axis)
    return sine_axis() if where.kind == "vertical" else azimuth_axis()


def map_axis(m) -> dict:
    """Of what `asdic process` kept."""
    if m.kind != "line":
        return azimuth_axis()
    return sine_axis(1.0 if m.axis[2] < 0 else -1.0) if m.upright \
        else cosine_axis(m.axis)


# ---------------------------------------------------------------- views

def view(data, row: int, array: int) -> dict:
    """One ping, as one array received it."""
    select(data, row, array)
    found = {"ping": int(data.numbers[row]), "array": array, "heading": data.heading(row),
             "about": about(data, row), "images": [], "map": None, "left_out": [],
             "frequency": data.centre_frequency, "duration": data.pulse_duration,
             "echoes": [echo(data, e) for e in data.echoes(row)],
             "time": [data.start, data.start + data.valid_samples[row] / data.sample_rate]}
    found["images"] += bearing_image(data, row, found)
    found["images"] += detection_images(data, row, found)
    found["images"].append(spectrogram_image(data, row))
    found["levels"] = level_lines(data, row, found)
    reason = range_bearing.nothing_to_show(data, row)
    if not reason:
        found["map"] = map_panel(data, row)
    elif processed.there(data):
        found["left_out"].append(f"Range and bearing: {reason}.")
        if processed.tracks(data):
            found["left_out"].append("Tracks: they are drawn on the map alone. The pictures of "
                                     "asdic plot draw them over range.")
    return found


def about(data, row) -> list:
    """[what, text] of the ping"""
    lasts = data.valid_samples[row] / data.sample_rate
    told = [["pulse", f"{data.pulse_kind} of {data.pulse_duration:g} s at "
             f"{data.centre_frequency:g} Hz"
             + (f", {data.bandwidth:.0f} Hz wide" if data.pulse_sweep else "")],
            ["array", f"{data.channels} phone{'s' * (data.channels != 1)}"],
            ["record", f"{lasts:g} s at {data.stored_rate:g} Hz"
             + (", complex baseband" if data.complex else "")]]
    time = float(data.read("ping_time", row))
    if time > 0:
        told.append(["ping at", f"{time:g} s"])
    return told


def strong(e):
    """Which path pairs of a target are marked: the strong ones, at most MARKS of them."""
    loud = np.flatnonzero(e.strong(-np.inf, np.inf))
    return np.sort(loud[np.argsort(-e.level_db[loud], kind="stable")][:MARKS])


def echo(data, e) -> dict:
    loud = strong(e)
    return {"target": int(e.target), "name": e.name, "delay": numbers(e.delay[loud], 8),
            "level": numbers(e.level_db[loud], 5),
            "doppler": numbers(data.centre_frequency * (e.doppler[loud] - 1.0), 5)}


def marks(e, y, look: str) -> dict:
    """The true echoes of a target in a panel."""
    loud = strong(e)
    return {"target": int(e.target), "look": look, "x": numbers(e.delay[loud], 8),
            "y": numbers(np.asarray(y)[loud], 8), "level": numbers(e.level_db[loud], 5)}


def bearing_image(data, row, found) -> list:
    if reason := bearing_time.nothing_to_show(data, row):
        found["left_out"].append(f"Bearing–time: {reason}.")
        return []
    where, edges, db = bearing_time.record(data, row)
    made = image(db, edges, style.cell_edges(where.coordinate), scan_axis(where),
                 f"beam level in {data.envelope(row).width:.0f} Hz", "dB re 1 µPa",
                 style.colour_limits(db, data.loudest_echo(row)))
    made["name"] = "Elevation–time" if where.kind == "vertical" else "Bearing–time"
    made["about"] = (f"Conventional beams over {data.channels} phones, means over "
                     f"{edges[1] - edges[0]:.3g} s. Bars: true echoes, from leading edge to end.")
    made["marks"] = [marks(e, signal.apparent(where, e.direction), "bar") for e in data.echoes(row)]
    return [made]


def detection_images(data, row, found) -> list:
    if not processed.there(data):
        found["left_out"].append("Detections, range and bearing: the file is not processed. Run "
                                 "asdic process, then this again.")
        return []
    if reason := processed.nothing(data, row):
        found["left_out"].append(f"Detections: {reason}.")
        return []
    m, t = processed.maps(data, row), processed.detections(data, row)
    found["detections"] = detections(data, t)
    edges, limits = style.cell_edges(m.time), processed.limits(data, row, m)
    made = []
    if m.kind != "point":
        beams = image(m.beam_db, edges, style.cell_edges(m.angle), map_axis(m),
                      "power over the background", "dB", limits)
        beams |= {"name": "Detections", "found": numbers(m.angle_of(t), 8),
                  "about": "Power over the background in every beam, the largest of all Doppler "
                           "filters. Circles: found. Marks: true echoes."}
        made.append(beams)
    if len(m.doppler) > 1:
        shift = data.centre_frequency * (m.doppler - 1.0)
        doppler = image(m.doppler_db, edges, style.cell_edges(shift),
                        linear_axis("Doppler shift", "Hz", **speeds(data, row)),
                        "power over the background", "dB", limits)
        doppler |= {"name": "Doppler–time",
                    "found": numbers(data.centre_frequency * (t["doppler_factor"] - 1.0), 7),
                    "about": "Power over the background in every Doppler filter, the largest of "
                             "all beams. Circles: found. Marks: true echoes."}
        made.append(doppler)
    for panel in made:
        for e in data.echoes(row):
            y = data.centre_frequency * (e.doppler - 1.0) if panel["name"] == "Doppler–time" \
                else m.angle_of_travel(e.direction)
            panel["marks"].append(marks(e, y, "cross"))
    return made


def detections(data, t) -> dict:
    """Columns of the table of what was found in a ping."""
    return {"time": numbers(t["time"], 8), "target": [int(v) for v in t["target"]],
            "snr": numbers(t["snr_db"], 4),
            "doppler": numbers(data.centre_frequency * (t["doppler_factor"] - 1.0), 5),
            **{name: numbers(t[name], 7) for name in
               ("range", "bearing_deg", "x", "y", "mirror_range", "mirror_bearing_deg", "mirror_x",
                "mirror_y")}}


def speeds(data, row) -> dict:
    """Hz for a closing speed of 1 m/s, there and back; nothing for a sweep."""
    speed = data.sound_speed(float(np.mean(data.phones(row)[:, 2])))
    return {"shift": number(2.0 * data.centre_frequency / speed, 8)}


def spectrogram_image(data, row) -> dict:
    time, frequency, db, window = spectrogram.record(data, row)
    tone = speeds(data, row) if data.pulse_sweep == 0 else {}
    made = image(db, style.cell_edges(time), style.cell_edges(frequency - data.centre_frequency),
                 linear_axis(f"frequency above {data.centre_frequency:g} Hz", "Hz", **tone),
                 "spectral level", "dB re 1 µPa²/Hz",
                 spectrogram.colour_limits(data, row, db, window))
    phones = "1 phone" if data.channels == 1 else f"mean over {data.channels} phones"
    made |= {"name": "Spectrogram", "about": f"{phones[0].upper()}{phones[1:]}, windows of "
             f"{window:.3g} s. Bars: true echoes."}
    made["marks"] = [marks(e, data.centre_frequency * (e.doppler - 1.0), "bar")
                     for e in data.echoes(row)]
    return made


def level_lines(data, row, found):
    if reason := levels.nothing_to_show(data, row):
        found["left_out"].append(f"Levels: {reason}.")
        return None
    chosen_array = data.array
    data.select_array(None)
    try:
        curves = levels.curves(data, row)
        width = data.envelope(row).width
        channels = data.channels
    finally:
        data.select_array(chosen_array)
    heard = {e.target for e in levels.all_echoes(data, row)}
    named = {"measured": ("measured, all frequencies", "ink"),
             "in band": (f"measured, in {width:.0f} Hz", "ink"), "noise": ("noise", "noise"),
             "reverberation": ("reverberation", "reverberation"),
             "echo": ("echo", int(heard.pop())) if len(heard) == 1
             else (f"echo, all {len(heard)} targets", "several")}
    lines = []
    for key, (time, db) in curves.items():
        if not np.isfinite(db).any():
            continue
        name, colour = named[key]
        lines.append({"name": name, "colour": colour, "dashed": key == "in band",
                      "first": number(time[0], 9), "step": number(np.median(np.diff(time))
                                                                  if len(time) > 1 else 1.0, 9),
                      "y": [None if not math.isfinite(v) else round(float(v), 2) for v in db]})
    phones = "1 phone" if channels == 1 else f"mean over all {channels} phones"
    return {"name": "Levels", "lines": lines, "unit": "dB re 1 µPa",
            "about": f"{phones[0].upper()}{phones[1:]}. Triangles: true times of echoes."}


# ---------------------------------------------------------------- the map

def map_panel(data, row) -> dict:
    """Cells of bearing and range around the array. Left and right of a line look alike where sender
    and array are at one place; apart, each side has its own ranges.
    """
    m = processed.maps(data, row)
    centre = data.phones(row).mean(axis=0)
    sides = []
    if m.beam_range:
        farthest = max(np.nanmax(span) for span in m.beam_range)
        ranges = np.linspace(0.0, farthest, 400)
        times = np.broadcast_to(m.time, m.beam_db.shape)
        for span in m.beam_range:
            power, time = (np.array([range_bearing.on_ranges(s, v, ranges)
                                     for s, v in zip(span, held)]) for held in (m.beam_db, times))
            sides.append({"ranges": numbers(ranges), "cells": packed(power),
                          "times": packed(time, 1e-3)})
    else:
        good = range_bearing.rising(m.range)
        sides.append({"ranges": numbers(m.range[good], 7), "cells": packed(m.beam_db[:, good]),
                      "times": packed(m.time[good][None, :], 1e-3)})
    targets = [{"target": int(i), "x": number(p[0] - centre[0]), "y": number(p[1] - centre[1]),
                "depth": number(p[2])} for i, _, p, present in data.targets(row) if present]
    sender = data.platform(row) - centre
    return {"name": "Range and bearing", "axis": map_axis(m), "angles": numbers(m.angle, 8),
            "sides": sides, "centre": numbers(centre, 8), "targets": targets,
            "sender": numbers(sender) if np.hypot(*sender[:2]) > 1.0 else None,
            "unit": "dB", "what": "power over the background",
            "limits": processed.limits(data, row, m),
            "about": "By the sound paths, north up. Circles: found. Stars: where targets are at "
                     "the ping." + (" The array cannot tell left from right: both sides are drawn."
                                if m.kind == "line" else "")}


def tracks(data, arrays: set) -> list:
    """Tracks of the arrays that are shown."""
    found = []
    if not processed.there(data):
        return found
    for array in sorted(arrays):
        data.select_array(array)
        for t in processed.tracks(data):
            found.append({"array": array, "target": int(t["target"][0]),
                          "mirrored": bool(t["ambiguous"][0]) and int(t["side"][0]) == 1,
                          "ping": [int(p) for p in t["ping"]], "x": numbers(t["x"], 7),
                          "y": numbers(t["y"], 7), "range": numbers(t["range"], 7)})
    return found


# ---------------------------------------------------------------- rays

def travel_times(r, z, depth, speed):
    """Along rays [ray, point] in a sea that changes with depth alone: ∫ds/c, c linear between
    samples of the profile and points of the ray. → [ray, point] [s]
    """
    slowness = 1.0 / np.interp(z, depth, speed)
    step = np.hypot(np.diff(r, axis=1), np.diff(z, axis=1))
    time = np.nan_to_num(step * 0.5 * (slowness[:, 1:] + slowness[:, :-1]))
    return np.concatenate([np.zeros((len(r), 1)), np.cumsum(time, axis=1)], axis=1)


def needed(x, y, tolerance: float):
    """Which points of a line keep it within `tolerance` of where it is (Douglas and Peucker)."""
    keep = np.zeros(len(x), bool)
    keep[[0, -1]] = True
    todo = [(0, len(x) - 1)]
    while todo:
        a, b = todo.pop()
        if b - a < 2:
            continue
        dx, dy = x[b] - x[a], y[b] - y[a]
        length = max(math.hypot(dx, dy), 1e-12)
        off = np.abs((x[a + 1:b] - x[a]) * dy - (y[a + 1:b] - y[a]) * dx) / length
        worst = int(np.argmax(off))
        if off[worst] > tolerance:
            middle = a + 1 + worst
            keep[middle] = True
            todo += [(a, middle), (middle, b)]
    return np.flatnonzero(keep)


def ray_panel(data):
    """Rays of the first ping's beam, eigenrays, profile and boundaries."""
    row = int(data.simulated[0])
    if rays.nothing_to_show(data, row):
        return None
    launch, r, z, kind, hits = data.rays()
    platform, targets = data.platform(row), data.targets(row)
    places = [(i, float(np.hypot(*(p - platform)[:2])), float(p[2])) for i, _, p, there in targets
              if there]
    reach = rays.largest_range(data, row, r, [p[1] for p in places])
    depth, speed = data.profile
    water = np.isfinite(depth) & np.isfinite(speed)
    layered = not data.has("environment/section_sound_speed") and water.sum() > 1
    time = travel_times(r, z, depth[water], speed[water]) if layered else None
    lines, kept, all_points = [], 0, 0
    size = max(float(np.nanmax(z, initial=1.0)), 1.0), max(reach, 1.0)
    for k in range(len(r)):
        good = np.flatnonzero(np.isfinite(r[k]) & np.isfinite(z[k]) & (r[k] >= 0)
                              & (r[k] <= 1.1 * reach))
        if good.size < 2:
            continue
        mine = good[needed(r[k, good] / size[1], z[k, good] / size[0], SHAPE)]
        kept, all_points = kept + len(mine), all_points + len(good)
        line = {"launch": number(launch[k], 5), "r": numbers(r[k, mine], 7),
                "z": numbers(z[k, mine], 7),
                "target": int(rays.eigenray_target(r[k], z[k], places)) if kind[k] == 1 else -1}
        if time is not None:
            line["t"] = numbers(time[k, mine], 7)
        lines.append(line)
    centre = data.phones(row).mean(axis=0)
    apart = float(np.linalg.norm(centre - platform))
    hits = hits[(hits >= 0) & (hits <= 1.1 * reach)]
    found = {"name": "Rays", "lines": lines, "hits": numbers(hits),
             "platform": number(platform[2]), "ping": int(data.numbers[row]),
             "there_and_back": bool(time is not None and apart < 100.0),
             "profile": {"depth": numbers(depth[water]), "speed": numbers(speed[water], 7)},
             "bottom": number(data.bottom_depth), "floor": None, "surface": None,
             "targets": [{"target": i, "r": number(np.hypot(*(p - platform)[:2])),
                          "z": number(p[2]), "there": there} for i, _, p, there in targets],
             "about": f"The beam at {data.elevation_deg[row]:+g}° and the eigenrays to targets, "
                      f"first ping{rays.in_one_plane(platform, targets)}."
                      + (" Dots: where what is received at the chosen time was struck." if time
                         is not None and apart < 100.0 else "")}
    for side, name in (("bottom", "floor"), ("surface", "surface")):
        line = data.rays_line(side)
        if line is not None:
            found[name] = {"r": numbers(line[0], 7), "z": numbers(line[1], 7)}
    found["note"] = (f"Rays: {kept} of {all_points} points, no line off by more than "
                     f"{100 * SHAPE:g} % of the panel.") if kept < all_points else ""
    return found


# ---------------------------------------------------------------- several pings

def history(data, notes: list):
    """Level of each ping against time."""
    if sweep.nothing_to_show(data, 0):
        return None
    edges, db, width = sweep.history(data)
    rows = data.simulated
    pings = data.numbers[rows]
    loudest = max(data.loudest_echo(int(row)) for row in rows)
    made = image(db, edges, sweep.row_edges(pings), linear_axis("ping", ""),
                 f"level in {width:.0f} Hz", "dB re 1 µPa", style.colour_limits(db, loudest))
    made |= {"name": "Pings", "about": "Level of every ping. Strokes: the strongest true echo of "
                                       "each target. A click chooses the ping."}
    strokes: dict = {}
    for row in rows:
        for e in data.echoes(int(row)):
            mark = strokes.setdefault(int(e.target), {"target": int(e.target), "look": "stroke",
                                                      "x": [], "y": [], "level": []})
            mark["x"].append(number(e.delay[e.strongest], 8))
            mark["y"].append(int(data.numbers[row]))
            mark["level"].append(number(e.level_db[e.strongest], 5))
    made["marks"] = list(strokes.values())
    return made

"""Range, by the sound paths, against bearing: the map of one ping and where its detections are."""
from __future__ import annotations

import numpy as np

from . import processed, style

TITLE = "Range and bearing"


def nothing_to_show(data, ping):
    reason = processed.nothing(data, ping)
    if reason:
        return reason
    m = processed.maps(data, ping)
    if m.kind == "point" or m.upright:
        return "the array tells no bearing"
    known = m.beam_range or ([] if m.range is None else [m.range])
    if sum(np.isfinite(span).sum() for span in known) < 2:
        return "no path has the delays of the record"
    return None


def rising(span):
    """[column] which columns have a range above all before: a map needs one row a range"""
    known = np.where(np.isfinite(span), span, -np.inf)
    highest = np.maximum.accumulate(known)
    return np.isfinite(span) & (known > np.concatenate([[-np.inf], highest[:-1]]))


def on_ranges(span, values, ranges):
    """[range] of one beam: what it holds where its own range, rising or not, is nearest"""
    good = rising(span)
    if good.sum() < 2:
        return np.full(len(ranges), np.nan)
    mine, held = span[good], values[good]
    after = np.clip(np.searchsorted(mine, ranges), 1, len(mine) - 1)
    nearest = after - (ranges - mine[after - 1] < mine[after] - ranges)
    inside = (ranges >= mine[0]) & (ranges <= mine[-1])
    return np.where(inside, held[nearest], np.nan)


@style.picture
def draw(data, ping, axes=None, limits=None):
    """One map; of a line whose sender is elsewhere one for each of its sides, which differ then:
    beside one another they are all bearings, rising from left to right.
    """
    m, t = processed.maps(data, ping), processed.detections(data, ping)
    limits = limits or processed.limits(data, ping, m)
    sides = m.beam_range or [None]
    fig, panels = style.figure(TITLE, 6.4, axes, ncols=len(sides), sharey=True, squeeze=False)
    handles, farthest = [], max((np.nanmax(s) for s in m.beam_range), default=0.0)
    drawn = []
    for k, (panel, span) in enumerate(zip(panels[0], sides)):
        if span is None:
            good = rising(m.range)
            ranges, power = m.range[good], m.beam_db[:, good].T
        else:
            ranges = np.linspace(0.0, farthest, 400)
            power = np.array([on_ranges(s, p, ranges) for s, p in zip(span, m.beam_db)]).T
        drawn.append(power.ravel())
        mesh = panel.pcolormesh(style.cell_edges(m.angle), style.cell_edges(ranges / 1000.0), power,
                                cmap=style.MAP, vmin=limits[0], vmax=limits[1], rasterized=True)
        # right of the line's sense, the first of the file's sides, is the picture's second
        processed.angle_axis(panel, m, vertical=False, only=None if span is None else k == 0)
        found = t["range"] if len(sides) == 1 else ranges_on(t, m, k)
        marks = processed.mark(panel, m.angle_of(t), found / 1000.0, t, data.target_names)
        marks += true_places(panel, data, ping, m, None if len(sides) == 1 else k)
        handles += [h for h in marks if h.get_label() not in [g.get_label() for g in handles]]
        style.image_frame(panel)
        panel.set_ylim(max(ranges[0] / 1000.0, 0.0), ranges[-1] / 1000.0)
    first = panels[0, 0]
    first.set_ylabel("horizontal range / km")
    style.colour_bar(fig, mesh, list(panels[0]) if len(sides) > 1 else first,
                     "power over the background / dB", style.beyond(np.concatenate(drawn), limits))
    style.subtitle(first, f"{data.heading(ping)}  ·  ranges by the sound paths")
    style.legend_below(first, processed.legend(handles), ncol=4)
    return fig


def ranges_on(t, m, side):
    """[detection] range of the place that lies right (0) or left (1) of the line; NaN: none"""
    axis = np.degrees(np.arctan2(m.axis[0], m.axis[1]))
    there = {name: (np.sin(np.radians(t[f"{name}bearing_deg"] - axis)) >= 0.0) == (side == 0)
             for name in ("", "mirror_")}
    return np.where(there[""], t["range"], np.where(there["mirror_"], t["mirror_range"], np.nan))


def true_places(axes, data, ping, m, side):
    """Stars where the targets are at the ping; of two sides (right 0, left 1) on theirs. → handles"""
    handles = []
    centre = data.phones(ping).mean(axis=0)
    for index, name, place, present in data.targets(ping):
        off = place - centre
        if not present or (side is not None and
                           (off @ np.array([m.axis[1], -m.axis[0], 0.0]) > 0.0) != (side == 0)):
            continue
        flat = off * [1.0, 1.0, 0.0]
        look = (off if m.kind == "line" else flat) / np.linalg.norm(off)
        handles += axes.plot(m.angle_of_travel(-look), [np.hypot(off[0], off[1]) / 1000.0],
                             **style.truth(index, "*", 13, f"{style.name(name)}: true place at the ping"),
                             zorder=6)
    return handles

"""Range, by the sound paths, against bearing: the map of one ping and where its detections are."""
from __future__ import annotations

import numpy as np

from . import processed, style
from .detections import LIMITS, dark

TITLE = "Range and bearing"


def nothing_to_show(data, ping):
    reason = processed.nothing(data, ping)
    if reason:
        return reason
    m = processed.maps(data, ping)
    if m.kind == "point" or m.upright:
        return "the array tells no bearing"
    if m.range is None or np.isfinite(m.range).sum() < 2:
        apart = np.linalg.norm(data.phones(ping).mean(axis=0) - data.platform(ping))
        if apart > 10.0:
            return f"{apart:.0f} m from the sender: a delay is another range in every bearing"
        return "no path has the delays of the record"
    return None


def rising(span):
    """[column] which columns have a range above all before: a map needs one row a range"""
    known = np.where(np.isfinite(span), span, -np.inf)
    highest = np.maximum.accumulate(known)
    return np.isfinite(span) & (known > np.concatenate([[-np.inf], highest[:-1]]))


def draw(data, ping):
    m, t = processed.maps(data, ping), processed.detections(data, ping)
    good = rising(m.range)
    span = m.range[good] / 1000.0
    fig, axes = style.figure(TITLE, 6.4)
    mesh = axes.pcolormesh(m.angle, span, m.beam_db[:, good].T, cmap=style.MAP, vmin=LIMITS[0],
                           vmax=LIMITS[1], shading="nearest", rasterized=True)
    processed.angle_axis(axes, m, vertical=False)
    handles = processed.mark(axes, m.angle_of(t), t["range"] / 1000.0, t, data.target_names)
    centre = data.phones(ping).mean(axis=0)
    for index, name, place, present in data.targets(ping):
        if not present:
            continue
        off = place - centre
        look = off / np.linalg.norm(off)
        handles += axes.plot(m.angle_of_travel(-look), [np.hypot(off[0], off[1]) / 1000.0],
                             **style.truth(index, "*", 13, f"{style.name(name)}: true place at the ping"),
                             zorder=6)
    style.image_frame(axes)
    axes.set_ylim(max(span[0], 0.0), span[-1])
    axes.set_ylabel("horizontal range / km")
    style.colour_bar(fig, mesh, axes, "power over the background / dB")
    style.subtitle(axes, f"{data.heading(ping)}  ·  ranges by the sound paths")
    style.legend_below(axes, dark(handles), ncol=3, below=0.16)
    return fig

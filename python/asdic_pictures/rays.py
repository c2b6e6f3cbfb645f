"""Rays of the first ping over the sound-speed profile."""
from __future__ import annotations

import numpy as np
from matplotlib.lines import Line2D

from . import style

TITLE = "Rays of the transmitted beam and eigenrays to the targets"


def nothing_to_show(data, ping):
    if not data.has("rays") or data.read("rays/kind").size == 0:
        return "the file holds no rays"
    return None


def eigenray_target(r, z, places):
    """Index of the place nearest to a ray's end. places: [(index, range, depth)]"""
    good = np.flatnonzero(np.isfinite(r) & np.isfinite(z))
    if good.size == 0 or not places:
        return 0
    end = r[good[-1]], z[good[-1]]
    return min(places, key=lambda p: np.hypot(p[1] - end[0], p[2] - end[1]))[0]


def draw_profile(axes, data):
    z, c = data.profile
    axes.plot(c, z, color=style.BLUE, lw=1.8)
    axes.set_xlabel("sound speed\nm/s")
    axes.set_ylabel("depth / m")
    low, high = np.nanmin(c), np.nanmax(c)
    room = max(0.12 * (high - low), 5.0)
    axes.set_xlim(low - room, high + room)
    axes.xaxis.set_major_locator(style.ticker.MaxNLocator(2, integer=True))
    axes.grid(True)


def draw(data, ping):
    row = int(data.simulated[0])          # the file holds the rays of the first ping alone
    launch, r, z, kind, hits = data.rays()
    fig, (left, right) = style.figure(TITLE, 5.2, ncols=2, sharey=True,
                                      gridspec_kw={"width_ratios": [1, 6.2]})
    draw_profile(left, data)

    platform = data.platform(row)
    places = [(i, float(np.hypot(*(p - platform)[:2])), float(p[2]))
              for i, _, p in data.targets(row)]
    names = {i: n for i, n, _ in data.targets(row)}
    fan = np.flatnonzero(kind == 0)
    for k in fan:
        right.plot(r[k] / 1e3, z[k], color=style.GREY, lw=0.6, alpha=0.55, zorder=2)
    for k in np.flatnonzero(kind == 1):
        right.plot(r[k] / 1e3, z[k], color=style.colour(eigenray_target(r[k], z[k], places)),
                   lw=1.5, alpha=0.9, zorder=3)
    hits = hits[np.isfinite(hits)]
    if hits.size:
        right.plot(hits / 1e3, np.zeros(hits.size), ls="none", marker="|", ms=9, mew=1.1,
                   color=style.INK, clip_on=False, zorder=5)
    for i, distance, depth in places:
        right.plot(distance / 1e3, depth, marker="o", ms=9, mfc=style.colour(i), mec="white",
                   mew=1.4, zorder=6, clip_on=False)
    right.plot(0.0, platform[2], marker="D", ms=8, mfc=style.INK, mec="white", mew=1.2, zorder=6,
               clip_on=False)

    reach = max([np.max(r, initial=0.0, where=np.isfinite(r)), hits.max(initial=0.0)]
                + [p[1] for p in places])
    right.set_xlim(0.0, max(reach, 1.0) / 1e3 * 1.02)
    right.set_xlabel("range from the source / km")
    draw_boundaries(data, (left, right))
    style.subtitle(right,
                   f"{data.title or data.path}  ·  beam {data.elevation_deg[row]:+g}°, first ping")
    handles = [Line2D([], [], marker="D", ls="none", ms=7, mfc=style.INK, mec="white",
                      label="source")]
    if fan.size:
        handles.append(Line2D([], [], color=style.GREY, lw=1.0, label="fan of the beam"))
    if hits.size:
        handles.append(Line2D([], [], marker="|", ls="none", ms=9, mew=1.1, color=style.INK,
                              label="fan meets the surface"))
    count = {i: sum(eigenray_target(r[k], z[k], places) == i for k in np.flatnonzero(kind == 1))
             for i, _, _ in places}
    for i, _, _ in places[:6]:
        label = f"{style.name(names[i])}, {count[i]} eigenray{'s' * (count[i] != 1)}"
        handles.append(Line2D([], [], marker="o", ms=7, color=style.colour(i), mec="white",
                              label=label))
    style.legend_below(right, handles, ncol=min(len(handles), 5))
    return fig


def draw_boundaries(data, panels):
    """Surface at the top, sea floor at the bottom, depth down. The panels share the axis."""
    bottom = data.bottom_depth
    if not np.isfinite(bottom) or bottom <= 0:
        bottom = float(np.nanmax(data.profile[0]))
    panels[0].set_ylim(bottom * 1.045, -bottom * 0.03)
    for axes in panels:
        axes.axhspan(bottom, bottom * 1.045, color="#cdbfa9", lw=0, zorder=1)
        axes.axhline(0.0, color=style.BLUE, lw=1.2, zorder=1)
    panels[1].text(0.995, bottom * 1.0225, "sea floor", transform=panels[1].get_yaxis_transform(),
                   ha="right", va="center_baseline",
                   fontsize=8, color="#5d4f38")
    panels[1].tick_params(labelleft=False)
    panels[1].grid(True)

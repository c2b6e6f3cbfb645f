"""Rays of the first ping over the sound-speed profile."""
from __future__ import annotations

import numpy as np
from matplotlib.lines import Line2D

from . import results, sea, style

TITLE = "Rays of the transmitted beam and eigenrays to the targets"

HALF_THE_EARTH = 2e7    # round its girth [m]


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


def largest_range(data, row, r, targets):
    """The farthest range that makes sense [m]: what the record can hold, or a target.

    Sound is back from there when the record ends; without that, the farthest ray.
    """
    c = data.profile[1]
    duration = data.valid_samples[row] / data.sample_rate
    received = 0.5 * float(np.nanmax(c)) * duration
    on_earth = [t for t in targets if t <= HALF_THE_EARTH]
    return max([received] + on_earth)


def disc(target, there):
    """A target: full, or hollow where it is not there in this ping."""
    colour = style.colour(target)
    return dict(marker="o", ms=9, mfc=colour if there else style.PAPER,
                mec=style.PAPER if there else colour, mew=1.2 if there else 1.8)


def in_one_plane(platform, targets):
    """Says so where the targets' bearings differ: the picture has no room for bearings."""
    east, north = np.array([p[:2] - platform[:2] for _, _, p, _ in targets]).reshape(-1, 2).T
    bearing = np.degrees(np.arctan2(east, north))[np.hypot(east, north) > 1.0]
    apart = np.abs((bearing[:, None] - bearing + 180.0) % 360.0 - 180.0).max(initial=0.0)
    return f"; targets up to {apart:.0f}° apart in bearing, drawn in one plane" if apart > 5 else ""


def draw_profile(axes, data):
    """Of water that varies with range each profile."""
    z, c = data.profile
    water = results.Sea(depth=z, sound_speed=c)
    if data.has("environment/section_sound_speed"):
        water.section_range, water.section_depth, water.section_speed = (
            data.read(f"environment/section_{part}") for part in ("range", "depth", "sound_speed"))
    water.map_end = results.map_end(data)
    sea.draw_profile(axes, water, "transect at")
    axes.set_ylabel("depth / m")


@style.picture
def draw(data, ping, axes=None, limits=None):
    row = int(data.simulated[0])          # the file holds the rays of the first ping alone
    launch, r, z, kind, hits = data.rays()
    fig, (left, right) = style.figure(TITLE, 5.2, axes, ncols=2, sharey=True,
                                      gridspec_kw={"width_ratios": [1, 6.2]})
    draw_profile(left, data)

    platform = data.platform(row)
    targets = data.targets(row)
    names = {i: n for i, n, _, _ in targets}
    there = {i: present for i, _, _, present in targets}
    everywhere = [(i, float(np.hypot(*(p - platform)[:2])), float(p[2])) for i, _, p, _ in targets]
    places = [p for p in everywhere if there[p[0]]]
    reach = largest_range(data, row, r, [p[1] for p in everywhere])
    r = np.where((r >= 0) & (r <= 1.1 * reach), r, np.nan)
    hits = hits[(hits >= 0) & (hits <= 1.1 * reach)]
    fan = np.flatnonzero(kind == 0)
    for k in fan:
        right.plot(r[k] / 1e3, z[k], color=style.GREY, lw=0.6, alpha=0.55, zorder=2)
    for k in np.flatnonzero(kind == 1):
        right.plot(r[k] / 1e3, z[k], color=style.colour(eigenray_target(r[k], z[k], places)),
                   lw=1.5, alpha=0.9, zorder=3)
    if hits.size:
        right.plot(hits / 1e3, np.zeros(hits.size), ls="none", marker="|", ms=9, mew=1.1,
                   color=style.INK, clip_on=False, zorder=5)
    for i, distance, depth in everywhere:
        if distance <= 1.1 * reach:
            right.plot(distance / 1e3, depth, zorder=6, clip_on=False, **disc(i, there[i]))
    right.plot(0.0, platform[2], marker="D", ms=8, mfc=style.INK, mec=style.PAPER, mew=1.2, zorder=6,
               clip_on=False)

    drawn = max([np.max(r, initial=0.0, where=np.isfinite(r)), hits.max(initial=0.0)]
                + [p[1] for p in everywhere if p[1] <= 1.1 * reach])
    line = data.rays_line("bottom")
    known = np.inf if line is None else max(float(np.nanmax(line[0])), drawn)   # no further than the floor
    right.set_xlim(0.0, min(1.02 * max(drawn, 1.0), known) / 1e3)
    right.set_xlabel("range from the source / km")
    draw_boundaries(data, (left, right))
    style.subtitle(right,
                   f"{data.title or data.path}  ·  beam "
                   f"{style.degrees(data.elevation_deg[row])}, first ping{in_one_plane(platform, targets)}")
    handles = [Line2D([], [], marker="D", ls="none", ms=7, mfc=style.INK, mec=style.PAPER,
                      label="source")]
    if fan.size:
        handles.append(Line2D([], [], color=style.GREY, lw=1.0, label="fan of the beam"))
    if hits.size:
        handles.append(Line2D([], [], marker="|", ls="none", ms=9, mew=1.1, color=style.INK,
                              label="fan meets the surface"))
    count = {i: sum(eigenray_target(r[k], z[k], places) == i for k in np.flatnonzero(kind == 1))
             for i, _, _ in places}
    for i, _, _ in everywhere[:6]:
        what = (f"{count[i]} eigenray{'s' * (count[i] != 1)}" if there[i]
                else "not there in this ping")
        handles.append(Line2D([], [], label=f"{style.name(names[i])}, {what}",
                              color=style.colour(i), lw=1.4 if there[i] else 0.0,
                              **disc(i, there[i])))
    style.legend_below(left if isinstance(fig, style.Picture) else right, handles, ncol=5, points=54)
    return fig


def draw_boundaries(data, panels):
    """Surface at the top, sea floor at the bottom, depth down. The panels share the axis."""
    bottom = data.bottom_depth
    if not np.isfinite(bottom) or bottom <= 0:
        bottom = float(np.nanmax(data.profile[0]))
    floor, surface = data.rays_line("bottom"), data.rays_line("surface")
    deepest = bottom if floor is None else max(float(np.nanmax(floor[1])), bottom)
    panels[0].set_ylim(deepest * 1.045, -deepest * 0.03)
    flat = panels if floor is None else panels[:1]
    for axes in flat:
        axes.axhspan(bottom, deepest * 1.045, color=style.GROUND, lw=0, zorder=1)
    if floor is not None:
        panels[1].fill_between(floor[0] / 1e3, floor[1], deepest * 1.045, color=style.GROUND, lw=0,
                               zorder=1)
    for axes in panels if surface is None else panels[:1]:
        axes.axhline(0.0, color=style.BLUE, lw=1.2, zorder=1)
    if surface is not None:
        panels[1].plot(surface[0] / 1e3, surface[1], color=style.BLUE, lw=1.2, zorder=1)
    panels[1].text(0.995, deepest * 1.0225, "sea floor",
                   transform=panels[1].get_yaxis_transform(), ha="right", va="center_baseline",
                   fontsize=8, color=style.GROUND_INK)
    panels[1].tick_params(labelleft=False)
    panels[1].grid(True)

"""The sea around a result: water column, boundaries, the ground below; and the colours of paths."""
from __future__ import annotations

import matplotlib
import numpy as np

from . import style

# what a path met: surface and bottom, in the order of the legend; the name of its colour
HISTORIES = [("neither", False, False, "GREEN"), ("surface", True, False, "BLUE"),
             ("bottom", False, True, "BROWN"), ("surface and bottom", True, True, "GREY")]


def history(surface, bottom) -> int:
    """Index into HISTORIES"""
    return int(surface > 0) + 2 * int(bottom > 0)


def shade(which: int) -> str:
    return getattr(style, HISTORIES[which][3])


def met(which: int) -> str:
    """For a legend: "met the surface"."""
    words = HISTORIES[which][0]
    return "met neither boundary" if which == 0 else f"met {words}" if which == 3 else f"met the {words}"


def extent(sea, depths, fallback: float = 1.0):
    """Least and greatest depth to be drawn [m]."""
    all_depths = [np.asarray(depths, float)]
    for part in (sea.surface, sea.bottom):
        if part is not None:
            all_depths.append(part)
    values = np.concatenate([d[np.isfinite(d)] for d in all_depths])
    top = min(0.0, values.min()) if values.size else 0.0
    bottom = values.max() if values.size else fallback
    return top, max(bottom, top + fallback)


def depth_axis(axes, top: float, bottom: float) -> None:
    room = 0.03 * (bottom - top)
    axes.set_ylim(bottom + room, top - (room if top < 0 else 0.0))
    axes.set_ylabel("depth / m")


def draw_boundaries(axes, sea) -> None:
    """The ground as a brown area, the air as the page, where the file tells of them."""
    if sea.boundary_range is None:
        return
    r = sea.boundary_range / 1e3
    low, high = sorted(axes.get_ylim())
    if sea.bottom is not None:
        axes.fill_between(r, sea.bottom, np.maximum(sea.bottom, high), color=style.GROUND, lw=0,
                          zorder=3)
        axes.plot(r, sea.bottom, color=style.GROUND_INK, lw=0.9, zorder=3.1)
    if sea.surface is not None:
        axes.fill_between(r, np.minimum(sea.surface, low), sea.surface, color=style.PAPER, lw=0,
                          zorder=3)
        axes.plot(r, sea.surface, color=style.BLUE, lw=1.0, zorder=3.1)


def draw_map_end(axes, sea) -> None:
    """Where the maps end that a section was cut out of: from there on it has their edge's depth."""
    first, last = axes.get_xlim()
    at = sea.map_end / 1e3
    if not first <= at < last:
        return
    axes.axvline(at, color=style.INK, lw=1.0, ls=(0, (4, 3)), zorder=3.4,
                 path_effects=list(style.OVER_MAP))
    left = at > first + 0.6 * (last - first)
    axes.annotate("the map ends: its edge goes on", (at, 0.03), (-4.0 if left else 4.0, 0.0),
                  ("data", "axes fraction"), "offset points", ha="right" if left else "left",
                  fontsize=8, color=style.INK, zorder=3.5, path_effects=list(style.OVER_MAP))


def profiles(sea):
    """Range [m], depth [m] and speed [m/s] of each profile: those of a section as far as the maps and
    the rest of the file go, with the one there (straight between two); or the one.
    """
    if sea.section_speed is None:
        return [(0.0, sea.depth, sea.sound_speed)]
    ranges, speeds = np.asarray(sea.section_range, float), np.asarray(sea.section_speed, float)
    last = min(sea.map_end, np.inf if sea.boundary_range is None else float(sea.boundary_range.max()))
    if last <= ranges[0]:
        ranges, speeds = ranges[:1], speeds[:1]
    elif last < ranges[-1]:
        k = int(np.searchsorted(ranges, last))      # ranges[k - 1] < last <= ranges[k]
        share = (last - ranges[k - 1]) / (ranges[k] - ranges[k - 1])
        there = speeds[k - 1] + share * (speeds[k] - speeds[k - 1])
        ranges, speeds = np.append(ranges[:k], last), np.vstack([speeds[:k], there])
    return [(float(r), sea.section_depth, c) for r, c in zip(ranges, speeds)]


MOST_PROFILES = 6


def draw_profile(axes, sea, at: str = "at range") -> None:
    """The sound speed over depth; of water that varies with range each profile, the key says of
    which range.
    """
    several = profiles(sea)
    many = len(several)
    if many > MOST_PROFILES:
        several = [several[round(k)] for k in np.linspace(0, many - 1, MOST_PROFILES)]
    shades = matplotlib.colormaps["plasma"](
        np.linspace(0.05, 0.8, len(several)) + (0.2 if style.PAPER != "white" else 0.0))
    speeds = []
    deepest = np.nanmax(sea.depth) if sea.depth is not None else np.inf   # of the axes
    for shade_of_range, (r, z, c) in zip(shades, several):
        alone = len(several) == 1
        label = None if alone else f"{r / 1e3:.4g} km"
        axes.plot(c, z, color=style.BLUE if alone else shade_of_range, lw=1.8 if alone else 1.3,
                  label=label)
        drawn = np.asarray(z) <= deepest
        speeds.append(np.asarray(c)[drawn] if drawn.any() else c)
    axes.set_xlabel("sound speed\nm/s")
    low, high = np.nanmin(np.concatenate(speeds)), np.nanmax(np.concatenate(speeds))
    room = max(0.12 * (high - low), 5.0)
    axes.set_xlim(low - room, high + room)
    axes.xaxis.set_major_locator(style.ticker.MaxNLocator(2, integer=True))
    axes.grid(True)
    if len(several) > 1:
        some = f"{len(several)} of {many} profiles" if many > len(several) else "profiles"
        axes.legend(loc="best", fontsize=7, handlelength=1.0, title=f"{some}\n{at}",
                    title_fontsize=7, labelspacing=0.25, borderaxespad=0.2, frameon=True,
                    framealpha=0.85, facecolor=style.PAPER, edgecolor="none")


def figure(title: str, sea, height: float = 5.2, axes=None):
    """A panel for the water column, where that is known, and one for the rest. → figure, main axes

    Of the caller's axes one is the main one, two have the water column on the left.
    """
    if axes is not None and np.size(np.array(axes, dtype=object)) == 1:
        return style.figure(title, height, axes)
    if sea.sound_speed is None:
        return style.figure(title, height, axes)
    fig, (left, right) = style.figure(title, height, axes, ncols=2, sharey=True,
                                      gridspec_kw={"width_ratios": [1.15, 7]})
    draw_profile(left, sea)
    right.tick_params(labelleft=False)
    return fig, right


def label_depth(fig, main) -> None:
    """The depth axis belongs to the leftmost panel."""
    if isinstance(fig, style.Picture) and fig.axes[0] is not main:
        fig.axes[0].set_ylabel(main.get_ylabel())
        main.set_ylabel("")

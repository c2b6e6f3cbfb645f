"""The sea around a result: water column, boundaries, the ground below; and the colours of paths."""
from __future__ import annotations

import numpy as np

from . import style

GROUND, GROUND_INK = "#cdbfa9", "#5d4f38"

# what a path met: surface and bottom, in the order of the legend
HISTORIES = [("neither", False, False, style.GREEN), ("surface", True, False, style.BLUE),
             ("bottom", False, True, style.BROWN), ("surface and bottom", True, True, style.GREY)]


def history(surface, bottom) -> int:
    """Index into HISTORIES"""
    return int(surface > 0) + 2 * int(bottom > 0)


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
    """The ground as a brown area, the air as a white one, where the file tells of them."""
    if sea.boundary_range is None:
        return
    r = sea.boundary_range / 1e3
    low, high = sorted(axes.get_ylim())
    if sea.bottom is not None:
        axes.fill_between(r, sea.bottom, np.maximum(sea.bottom, high), color=GROUND, lw=0, zorder=3)
        axes.plot(r, sea.bottom, color=GROUND_INK, lw=0.9, zorder=3.1)
    if sea.surface is not None:
        axes.fill_between(r, np.minimum(sea.surface, low), sea.surface, color="white", lw=0,
                          zorder=3)
        axes.plot(r, sea.surface, color=style.BLUE, lw=1.0, zorder=3.1)


def draw_profile(axes, sea) -> None:
    axes.plot(sea.sound_speed, sea.depth, color=style.BLUE, lw=1.8)
    axes.set_xlabel("sound speed\nm/s")
    low, high = np.nanmin(sea.sound_speed), np.nanmax(sea.sound_speed)
    room = max(0.12 * (high - low), 5.0)
    axes.set_xlim(low - room, high + room)
    axes.xaxis.set_major_locator(style.ticker.MaxNLocator(2, integer=True))
    axes.grid(True)


def figure(title: str, sea, height: float = 5.2):
    """A panel for the water column, where that is known, and one for the rest. → figure, main axes"""
    if sea.sound_speed is None:
        return style.figure(title, height)
    fig, (left, right) = style.figure(title, height, ncols=2, sharey=True,
                                      gridspec_kw={"width_ratios": [1, 7]})
    draw_profile(left, sea)
    right.tick_params(labelleft=False)
    return fig, right


def label_depth(fig, main) -> None:
    """The depth axis belongs to the leftmost panel."""
    if fig.axes[0] is not main:
        fig.axes[0].set_ylabel(main.get_ylabel())
        main.set_ylabel("")

"""Two results side by side: both fields and their difference, stems back to back, rays overlaid."""
from __future__ import annotations

import numpy as np
from matplotlib.lines import Line2D

from . import arrival_stems, ray_paths, sea, style, transmission_loss
from .data import InputError
from .results import Arrivals, Field, Rays


@style.picture
def draw(a, b, names, floor: float = 120.0, axes=None, limits=None):
    if type(a) is not type(b):
        raise InputError(names[0], f"a file of {type(a).__name__.lower()}",
                         f"{type(b).__name__.lower()}, as in {names[1]}")
    kinds = {Field: draw_fields, Arrivals: draw_arrivals, Rays: draw_rays}
    return kinds[type(a)](a, b, names, floor, axes, limits)


# ---------------------------------------------------------------------------------------- fields


def nearest(have, wanted):
    """Index in `have` of each place wanted, or None where one is missing by more than 1 mm."""
    index = np.abs(np.asarray(have)[:, None] - np.asarray(wanted)).argmin(axis=0)
    apart = np.abs(np.asarray(have)[index] - wanted)
    return index if np.all(apart <= 1e-3 + 1e-6 * np.abs(wanted)) else None


def on_grid_of(a, b, names):
    """A's loss where B's receivers are."""
    if a.irregular or b.irregular:
        if a.pressure.shape != b.pressure.shape:
            raise InputError(names[0], "other receivers", f"those of {names[1]}")
        return a.tl(0)
    rows, columns = nearest(a.depth, b.depth), nearest(a.range, b.range)
    if rows is None or columns is None:
        raise InputError(names[0], "a grid without some of the places", f"those of {names[1]}")
    return a.tl(0)[np.ix_(rows, columns)]


def difference_limit(difference) -> float:
    """Half the span of the difference's colours [dB]: nearly all of it, 0.1 to 20."""
    good = np.abs(difference[np.isfinite(difference)])
    if good.size == 0:
        return 1.0
    wanted = np.percentile(good, 95.0)
    steps = [0.1, 0.2, 0.5, 1.0, 2.0, 3.0, 5.0, 10.0, 20.0]
    return next((s for s in steps if s >= wanted), steps[-1])


def draw_fields(a, b, names, floor, axes=None, given=None):
    tl_a, tl_b = on_grid_of(a, b, names), b.tl(0)
    if a.sea.boundary_range is not None and b.sea.boundary_range is None:
        b.sea = a.sea
    both = (tl_a < floor) & (tl_b < floor)
    difference = np.where(both, tl_a - tl_b, np.nan)
    if not b.irregular and b.depth.size == 1:
        return draw_lines(b, tl_a, tl_b, difference, names, axes, given)
    fig, axes = style.figure("Transmission loss compared", 9.0, axes, nrows=3, sharex=True, sharey=True)
    colours = given or transmission_loss.colour_limits(tl_a, tl_b)
    for k, (panel, values) in enumerate(zip(axes, (tl_a, tl_b, difference))):
        limit = difference_limit(difference)
        last = k == 2
        mesh = transmission_loss.draw_map(panel, b, values, (-limit, limit) if last else colours,
                                          style.DIVERGING if last else style.LOSS_MAP)
        transmission_loss.frame(panel, b, 0)
        if last:
            style.colour_bar(fig, mesh, panel, "TL(A) − TL(B) / dB")
        else:
            transmission_loss.loss_bar(fig, mesh, panel, "TL / dB")
    style.subtitle(axes[0], f"A: {names[0]}")
    style.subtitle(axes[1], f"B: {names[1]}  ·  {b.frequency:g} Hz, source at "
                            f"{b.source_depths[0]:g} m")
    style.subtitle(axes[2], difference_text(difference, floor))
    axes[2].set_xlabel("range from the source / km")
    return fig


def difference_text(difference, floor) -> str:
    good = np.abs(difference[np.isfinite(difference)])
    if good.size == 0:
        return f"no cell is below {floor:g} dB in both"
    return (f"A − B where both are below {floor:g} dB: |difference| median {np.median(good):.3g} dB, "
            f"95 % {np.percentile(good, 95):.3g} dB")


def draw_lines(b, tl_a, tl_b, difference, names, axes=None, given=None):
    fig, (top, below) = style.figure("Transmission loss compared", 6.0, axes, nrows=2, sharex=True,
                                     gridspec_kw={"height_ratios": [2, 1]})
    r = b.range / 1e3
    top.plot(r, tl_b[0], color=style.GREY, lw=2.2, label=f"B: {names[1]}")
    top.plot(r, tl_a[0], color=style.VERMILION, lw=0.9, label=f"A: {names[0]}")
    low, high = given or transmission_loss.colour_limits(tl_a, tl_b)
    top.set_ylim(high + 2, low - 2)
    top.set_ylabel("transmission loss / dB")
    top.legend(loc="upper right")
    below.plot(r, difference[0], color=style.INK, lw=0.9)
    limit = difference_limit(difference)
    below.set_ylim(-1.05 * limit, 1.05 * limit)
    below.set_ylabel("TL(A) − TL(B) / dB")
    below.set_xlabel("range from the source / km")
    for axes in (top, below):
        axes.grid(True)
    style.subtitle(top, f"{b.frequency:g} Hz, source at {b.source_depths[0]:g} m, receivers at "
                        f"{b.depth[0]:g} m")
    style.subtitle(below, difference_text(difference, np.inf))
    return fig


# -------------------------------------------------------------------------------------- arrivals


def draw_arrivals(a, b, names, floor, axes=None, given=None):
    by_label = {r.label: r for r in a.receivers}
    shared = [(by_label[r.label], r) for r in b.receivers if r.label in by_label]
    if not shared:
        raise InputError(names[0], "arrivals at other receivers", f"those of {names[1]}")
    panels = [shared[i] for i in arrival_stems.chosen(shared)]
    fig, rows = style.figure("Arrivals compared: A upwards, B downwards", 1.6 + 2.4 * len(panels), axes,
                             nrows=len(panels), squeeze=False)
    for axes, (mine, theirs) in zip(rows[:, 0], panels):
        low, top, first, last = arrival_stems.bounds(mine, theirs)
        arrival_stems.stems(axes, mine, low)
        arrival_stems.stems(axes, theirs, low, sign=-1.0)
        axes.axhline(0.0, color=style.INK, lw=0.8)
        arrival_stems.level_axis(axes, low, top, mirrored=True)
        axes.set_xlim(first, last)
        style.subtitle(axes, f"{theirs.label}: A {mine.delay.size}, B {theirs.delay.size} rows")
    rows[-1, 0].set_xlabel(f"delay / s        A: {names[0]}        B: {names[1]}".replace("$", r"\$"))
    receivers = [r for pair in panels for r in pair]
    style.legend_below(rows[-1, 0], arrival_stems.history_handles(*receivers))
    return fig


# ------------------------------------------------------------------------------------------ rays


def draw_rays(a, b, names, floor, axes=None, given=None):
    known = a if a.sea.boundary_range is not None else b
    fig, axes = sea.figure("Rays compared", known.sea, axes=axes)
    for rays, look in ((b, dict(color=style.GREY, lw=2.4, alpha=0.6)),
                       (a, dict(color=style.VERMILION, lw=0.8))):
        for k in range(rays.launch.size):
            axes.plot(rays.range[k] / 1e3, rays.depth[k], zorder=2.5, **look)
    ray_paths.frame(axes, a, b)
    sea.label_depth(fig, axes)
    style.subtitle(axes, b.title or a.title)
    style.legend_below(axes, [
        Line2D([], [], color=style.VERMILION, lw=0.8,
               label=f"A: {names[0]}, {a.launch.size} rays".replace("$", r"\$")),
        Line2D([], [], color=style.GREY, lw=2.4, alpha=0.6,
               label=f"B: {names[1]}, {b.launch.size} rays".replace("$", r"\$"))])
    return fig

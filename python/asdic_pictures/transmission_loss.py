"""Transmission loss over range and depth, over the sea floor where that is known."""
from __future__ import annotations

import matplotlib
import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from . import sea, style

TITLE = "Transmission loss"


def hatching():
    """Its colour."""
    return matplotlib.colors.to_rgba(style.INK, 0.55)


def nothing_to_show(field) -> str | None:
    if field.around is not None and np.abs(field.around).max() > 0.0:
        return None
    return None if np.isfinite(field.tl(0)).any() else "no sound arrives anywhere"


def colour_limits(*maps, span: float = 100.0):
    """Colour limits in dB, multiples of 5: nearly all cells lie between them. Where they span more
    than `span`, the quiet ones are clipped.
    """
    good = np.concatenate([m[np.isfinite(m)].ravel() for m in maps])
    if good.size == 0:
        return 40.0, 100.0
    low = 5.0 * np.floor(np.percentile(good, 0.5) / 5.0)
    high = 5.0 * np.ceil(np.percentile(good, 99.5) / 5.0)
    return float(low), float(np.clip(high, low + 20.0, low + span))


def edges(centres):
    """Edges of cells around coordinates that need not be even. [n] → [n + 1]"""
    return style.cell_edges(centres) if len(centres) > 1 else centres[0] + np.array([-0.5, 0.5])


def draw_map(axes, field, values, colours, cmap):
    """Cells, or points where the receivers are scattered. → what a colour bar needs"""
    low, high = colours
    if field.irregular:
        return axes.scatter(field.range / 1e3, field.depth, c=values, s=14, cmap=cmap, vmin=low,
                            vmax=high, lw=0)
    return axes.pcolormesh(edges(field.range) / 1e3, edges(field.depth), values, cmap=cmap,
                           vmin=low, vmax=high, rasterized=True)


def draw_unsure(axes, field, source: int) -> bool:
    """Hatches what is not sure of its number of beams. → whether there is any"""
    unsure = field.unsure(source)
    if unsure is None or not unsure.any():
        return False
    if field.irregular:
        axes.scatter(field.range[unsure] / 1e3, field.depth[unsure], marker="x", s=30, lw=0.8,
                     color=hatching())
        return True
    # Cells are doubled, so that a contour of what is in and what is out follows their edges.
    across, down = edges(field.range) / 1e3, edges(field.depth)
    beside = np.repeat(across, 2)[1:-1], np.repeat(down, 2)[1:-1]
    drawn = axes.contourf(*beside, np.kron(unsure, np.ones((2, 2))), levels=[0.5, 1.5],
                             colors="none", hatches=["////"])
    for part in getattr(drawn, "collections", [drawn]):   # before matplotlib 3.8, and since
        part.set(edgecolor=hatching(), linewidth=0.0)
    return True


def loss_bar(fig, mesh, axes, label="transmission loss / dB"):
    bar = style.colour_bar(fig, mesh, axes, label)
    bar.ax.invert_yaxis()
    return bar


def frame(axes, field, source: int) -> None:
    """Axes of a map: range, depth, boundaries, the source. Grey where no sound arrives, white where
    there are no receivers.
    """
    style.image_frame(axes)
    if not field.irregular:
        across, down = edges(field.range) / 1e3, edges(field.depth)
        axes.add_patch(Rectangle((across[0], down[0]), across[-1] - across[0], down[-1] - down[0],
                                 fc=axes.get_facecolor(), lw=0, zorder=-1))
        axes.set_facecolor(style.PAPER)
    depths = np.concatenate([field.depth, field.source_depths])
    sea.depth_axis(axes, *sea.extent(field.sea, depths))
    first, last = field.range.min() / 1e3, field.range.max() / 1e3
    axes.set_xlim(min(first, 0.0), last if last > first else first + 1.0)
    sea.draw_boundaries(axes, field.sea)
    sea.draw_map_end(axes, field.sea)
    axes.plot(0.0, field.source_depths[source], marker="D", ms=7, mfc=style.INK, mec=style.PAPER,
              mew=1.2, zorder=6, clip_on=False)


def describe(field, source: int) -> str:
    several = len(sea.profiles(field.sea)) if field.sea.sound_speed is not None else 1
    water = "" if several == 1 else f"  ·  the water varies with range: {several} profiles"
    title = f"{field.title}  ·  " if field.title else ""
    if field.azimuths is not None:
        water += (f"  ·  azimuth {field.azimuths[0]:g}°"
                  + (f", the first of {field.azimuths.size}" if field.azimuths.size > 1 else ""))
    return (f"{title}{field.frequency:g} Hz, source at {field.source_depths[source]:g} m, "
            f"{field.how}{water}")


def unsure_key(field, source: int, curves: bool = False):
    """What the hatching (of curves: the dots) means, and how many receivers it is, of those of which it is known. → for a
    legend
    """
    errors = field.errors[source]
    known = ~np.isnan(errors)
    unsure = 100.0 * np.mean(errors[known] > field.sure_db)
    label = (f"more beams may change it by over {field.sure_db:g} dB: "
             f"{unsure:.0f} % of the receivers")
    if curves:
        return Line2D([], [], color=style.INK, lw=0.9, ls=":", label=label)
    if field.irregular:
        return Line2D([], [], color=hatching(), marker="x", ms=5, ls="none", label=label)
    return Patch(fc="none", ec=hatching(), hatch="////", lw=0, label=label)


MOST_CURVES = 4


def draw_curves(field, source: int, axes=None, given=None):
    """Receivers at a few depths: a curve over range for each."""
    fig, axes = style.figure(TITLE, 4.2, axes)
    unsure = field.unsure(source)
    dotted = unsure is not None and unsure.any()
    for k, loss in enumerate(field.tl(source)):
        colour = (style.BLUE, style.VERMILION, style.GREEN, style.PURPLE)[k]
        sure = np.where(unsure[k], np.nan, loss) if dotted else loss
        axes.plot(field.range / 1e3, sure, lw=1.1, label=f"{field.depth[k]:g} m", color=colour)
        if dotted:
            axes.plot(field.range / 1e3, loss, lw=0.9, ls=":", color=colour)
    low, high = given or colour_limits(field.tl(source))
    axes.set_ylim(high + 2, low - 2)
    axes.set_xlim(min(field.range.min(), 0.0) / 1e3, field.range.max() / 1e3)
    axes.set_ylabel("transmission loss / dB")
    axes.set_xlabel("range from the source / km")
    axes.grid(True)
    axes.add_artist(axes.legend(title="receivers at", loc="upper right"))
    if dotted:
        style.legend_below(axes, [unsure_key(field, source, curves=True)])
    style.subtitle(axes, describe(field, source))
    return fig


FEWEST_AROUND = 3       # azimuths that are drawn from above


def draw_from_above(field, source: int, axes=None, given=None):
    """Receivers at the depth nearest to the source's, around the source: x to the right, y up."""
    row = int(np.abs(field.depth - field.source_depths[source]).argmin())
    magnitude = np.abs(field.around[:, source] if field.irregular else field.around[:, source, row])
    with np.errstate(divide="ignore"):
        values = -20.0 * np.log10(magnitude)
    values[~np.isfinite(values)] = np.nan
    fig, axes = style.figure("Transmission loss from above", 8.8, axes)
    low, high = given or colour_limits(values)
    turn, out = np.radians(edges(field.azimuths)), np.maximum(edges(field.range), 0.0) / 1e3
    mesh = axes.pcolormesh(np.outer(np.cos(turn), out), np.outer(np.sin(turn), out), values,
                           cmap=style.LOSS_MAP, vmin=low, vmax=high, rasterized=True)
    style.image_frame(axes)
    axes.set_facecolor(style.PAPER)
    axes.set_aspect("equal", anchor="W")
    axes.plot(0.0, 0.0, marker="D", ms=7, mfc=style.INK, mec=style.PAPER, mew=1.2, zorder=6)
    axes.set_xlabel("x from the source / km")
    axes.set_ylabel("y from the source / km")
    loss_bar(fig, mesh, axes)
    title = f"{field.title}  ·  " if field.title else ""
    places = f", the first of {field.places} places" if field.places > 1 else ""
    where = "receivers as listed" if field.irregular else f"receivers at {field.depth[row]:g} m"
    style.subtitle(axes, f"{title}{field.frequency:g} Hz, source at {field.source_depths[source]:g} m"
                         f"{places}, {where}, {field.azimuths.size} azimuths, {field.how}")
    return fig


@style.picture
def draw(field, source: int = 0, axes=None, limits=None):
    if field.azimuths is not None and field.azimuths.size >= FEWEST_AROUND:
        return draw_from_above(field, source, axes, limits)
    if not field.irregular and field.depth.size <= MOST_CURVES:
        return draw_curves(field, source, axes, limits)
    fig, axes = sea.figure(TITLE, field.sea, axes=axes)
    values = field.tl(source)
    mesh = draw_map(axes, field, values, limits or colour_limits(values), style.LOSS_MAP)
    unsure = draw_unsure(axes, field, source)
    frame(axes, field, source)
    sea.label_depth(fig, axes)
    axes.set_xlabel("range from the source / km")
    loss_bar(fig, mesh, axes)
    style.subtitle(axes, describe(field, source))
    if unsure:
        style.legend_below(axes, [unsure_key(field, source)])
    return fig

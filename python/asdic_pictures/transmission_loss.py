"""Transmission loss over range and depth, over the sea floor where that is known."""
from __future__ import annotations

import numpy as np
from matplotlib.patches import Rectangle

from . import sea, style

TITLE = "Transmission loss"
MAP = "viridis_r"       # loud is light


def nothing_to_show(field) -> str | None:
    return None if np.isfinite(field.tl(0)).any() else "no sound arrives anywhere"


def limits(*maps, span: float = 60.0):
    """Colour limits in dB, multiples of 5: all but a hundredth of the loud cells, at most `span`."""
    good = np.concatenate([m[np.isfinite(m)].ravel() for m in maps])
    if good.size == 0:
        return 40.0, 40.0 + span
    low = 5.0 * np.floor(np.percentile(good, 1.0) / 5.0)
    high = 5.0 * np.ceil(np.percentile(good, 97.0) / 5.0)
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
        axes.set_facecolor("white")
    depths = np.concatenate([field.depth, field.source_depths])
    sea.depth_axis(axes, *sea.extent(field.sea, depths))
    first, last = field.range.min() / 1e3, field.range.max() / 1e3
    axes.set_xlim(min(first, 0.0), last if last > first else first + 1.0)
    sea.draw_boundaries(axes, field.sea)
    axes.plot(0.0, field.source_depths[source], marker="D", ms=7, mfc=style.INK, mec="white",
              mew=1.2, zorder=6, clip_on=False)


def describe(field, source: int) -> str:
    return (f"{style.shorten(field.title, 60)}  ·  {field.frequency:g} Hz, source at "
            f"{field.source_depths[source]:g} m, {field.how}")


MOST_CURVES = 4


def draw_curves(field, source: int):
    """Receivers at a few depths: a curve over range for each."""
    fig, axes = style.figure(TITLE, 4.2)
    for k, loss in enumerate(field.tl(source)):
        axes.plot(field.range / 1e3, loss, lw=1.1, label=f"{field.depth[k]:g} m",
                  color=(style.BLUE, style.VERMILION, style.GREEN, style.PURPLE)[k])
    low, high = limits(field.tl(source), span=100.0)
    axes.set_ylim(high + 2, low - 2)
    axes.set_xlim(min(field.range.min(), 0.0) / 1e3, field.range.max() / 1e3)
    axes.set_ylabel("transmission loss / dB")
    axes.set_xlabel("range from the source / km")
    axes.grid(True)
    axes.legend(title="receivers at", loc="upper right")
    style.subtitle(axes, describe(field, source))
    return fig


def draw(field, source: int = 0):
    if not field.irregular and field.depth.size <= MOST_CURVES:
        return draw_curves(field, source)
    fig, axes = sea.figure(TITLE, field.sea)
    values = field.tl(source)
    mesh = draw_map(axes, field, values, limits(values), MAP)
    frame(axes, field, source)
    sea.label_depth(fig, axes)
    axes.set_xlabel("range from the source / km")
    loss_bar(fig, mesh, axes)
    style.subtitle(axes, describe(field, source))
    return fig

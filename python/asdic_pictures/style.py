"""The common look: sizes, axes, colours (Okabe & Ito's, safe for the colour-blind), and writing."""
from __future__ import annotations

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib import patheffects, ticker  # noqa: E402

from . import output  # noqa: E402

INK, GREY = "#222222", "#8a8a8a"
BLUE, VERMILION, GREEN = "#0072B2", "#D55E00", "#009E73"
SLATE, BROWN = "#6f7fa6", "#6b4423"     # of no target
ORANGE, PURPLE, SKY = "#E69F00", "#CC79A7", "#56B4E9"
TARGETS = [VERMILION, BLUE, GREEN, PURPLE, ORANGE, SKY]
MAP = "viridis"
# keeps a mark readable on any colour of the map, and a cluster of marks apart
OVER_MAP = [patheffects.withStroke(linewidth=2.4, foreground="white")]

plt.rcParams.update({
    "figure.dpi": 150, "savefig.dpi": 150, "figure.constrained_layout.use": True,
    "figure.facecolor": "white",
    "font.family": "DejaVu Sans", "font.size": 10, "text.color": INK,
    "axes.titlesize": 11, "axes.titlelocation": "left", "axes.titlepad": 8, "axes.labelsize": 10,
    "axes.labelcolor": INK,
    "axes.edgecolor": GREY, "axes.linewidth": 0.8, "axes.spines.top": False,
    "axes.spines.right": False, "axes.axisbelow": True,
    "xtick.labelsize": 9, "ytick.labelsize": 9, "xtick.color": GREY, "ytick.color": GREY,
    "xtick.labelcolor": INK, "ytick.labelcolor": INK,
    "grid.color": "#e8e8e8", "grid.linewidth": 0.7, "lines.linewidth": 1.4,
    "lines.solid_capstyle": "round",
    "legend.frameon": False, "legend.fontsize": 9, "legend.handlelength": 1.6,
    "legend.columnspacing": 1.6,
    "agg.path.chunksize": 20000,
})


def colour(target: int) -> str:
    return TARGETS[target % len(TARGETS)]


def figure(what: str, height: float = 4.6, **grid):
    """A figure under a title that says what it is. → figure, axes (as plt.subplots)"""
    fig, axes = plt.subplots(figsize=(10.0, height), **grid)
    fig.suptitle(what, x=0.012, ha="left", fontsize=13, fontweight="bold")
    fig.set_constrained_layout_pads(w_pad=0.1, h_pad=0.07, wspace=0.02, hspace=0.03)
    return fig, axes


def subtitle(axes, text: str) -> None:
    """One grey line above the axes: what it is of."""
    axes.set_title(shorten(text), color="#555555", fontsize=9.5, fontweight="normal")


def shorten(text: str, limit: int = 125) -> str:
    text = " ".join(str(text).replace("$", r"\$").split())
    return text if len(text) <= limit else text[: limit - 1] + "…"


def name(text: str) -> str:
    """A target's name for a legend: never read as mathematics, never long, never hidden for its
    leading underscore.
    """
    return shorten(text, 28).lstrip("_") or "target"


def degrees(angle: float) -> str:
    """−12.5°, with a real minus sign."""
    return f"{angle:+.6g}°".replace("-", "−") if angle else "0°"


def time_axis(axes, first: float, last: float, label: str = "time after the ping / s") -> None:
    axes.set_xlim(first, last if last > first else first + 1e-3)
    axes.set_xlabel(label)


def legend_below(axes, handles=None, below: float = 0.13, **options) -> None:
    """A legend in a row under the axes, where it can hide nothing."""
    handles = handles if handles is not None else axes.get_legend_handles_labels()[0]
    if handles:
        # in characters; about 115 fit in a row
        widest = sum(len(h.get_label()) + 6 for h in handles)
        columns = min(options.pop("ncol", 6), -(-len(handles) // -(-widest // 115)))
        axes.legend(handles=handles, loc="upper left", bbox_to_anchor=(0.0, -below), ncol=columns,
                    borderaxespad=0.3, **options)


def truth(target: int, marker: str, size: float, label: str = "_"):
    """Look of a mark of the truth beside an image or a curve: the target's colour, a thin edge."""
    return dict(ls="none", marker=marker, ms=size, mfc=colour(target), mec=INK, mew=0.35,
                label=label)


def image_frame(axes) -> None:
    """Axes around an image: all four sides, ticks outwards; grey where there are no data."""
    axes.set_facecolor("#ececec")
    for side in axes.spines.values():
        side.set_visible(True)
    axes.tick_params(direction="out", length=3)


def silence(axes, db) -> None:
    """Says so where there is nothing to be drawn."""
    if not np.isfinite(db).any():
        axes.text(0.5, 0.5, "silence", transform=axes.transAxes, ha="center", va="center",
                  color=GREY)


def colour_bar(fig, mesh, axes, label: str, extend: str = "both"):
    silence(axes, mesh.get_array())
    bar = fig.colorbar(mesh, ax=axes, pad=0.015, fraction=0.05, aspect=28, extend=extend)
    bar.set_label(label)
    bar.outline.set_linewidth(0.6)
    bar.outline.set_edgecolor(GREY)
    bar.locator = ticker.MaxNLocator(7, steps=[1, 2, 5, 10])
    bar.update_ticks()
    return bar


def colour_limits(db, echo_db: float = -np.inf, floor_percentile: float = 20.0,
                  least: float = 20.0, most: float = 55.0):
    """Limits in dB, multiples of 5, at least 20 and at most 55 dB apart.

    The floor is a little below the background: the noise, where there is some. The top is where all
    but a thousandth lies below, but at most 55 dB higher: a loud start is clipped, not the quiet
    rest. Only an echo of `echo_db` that would be clipped lifts both.
    """
    good = db[np.isfinite(db)]
    if good.size == 0:
        return 0.0, least
    low = 5.0 * np.floor((np.percentile(good, floor_percentile) - 2.0) / 5.0)
    top = 5.0 * np.ceil(np.percentile(good, 99.9) / 5.0)
    top = np.clip(top, low + least, low + most)
    # never above what is drawn
    needed = 5.0 * np.ceil(min(echo_db, good.max()) / 5.0)
    top = max(top, needed)
    return float(max(low, top - most)), float(top)


def image(axes, x_edges, y_edges, values, limits):
    """An image of cells between edges, in the common map."""
    return axes.pcolorfast(x_edges, y_edges, values, cmap=MAP, vmin=limits[0], vmax=limits[1])


def cell_edges(centres):
    """Edges of the cells around evenly spaced centres. [n] → [n + 1]"""
    centres = np.asarray(centres, float)
    if centres.size == 1:
        return centres[0] + np.array([-0.5, 0.5])
    middle = 0.5 * (centres[1:] + centres[:-1])
    return np.concatenate([[2 * centres[0] - middle[0]], middle, [2 * centres[-1] - middle[-1]]])


def write(fig, path, force: bool = False) -> None:
    """\\throws InputError where the name is somebody's, OSError with the path when it cannot be written"""
    try:
        output.write(fig, path, force)
    finally:
        plt.close(fig)

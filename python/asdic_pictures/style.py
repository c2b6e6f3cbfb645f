"""The common look: sizes, axes, colours (Okabe & Ito's, safe for the colour-blind), light and dark.

Colours are names of this module, and those of the theme that is drawn in: `with look("dark"):`.
A notebook's own settings of matplotlib are left alone.
"""
from __future__ import annotations

import functools
import io
import re
import textwrap
from contextlib import contextmanager

import matplotlib
import numpy as np
from matplotlib import patheffects, ticker
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from matplotlib.textpath import text_to_path
from matplotlib.transforms import ScaledTranslation

from . import output

WIDTH = 10.0    # of a figure [inch]

LIGHT = dict(
    INK="#222222", GREY="#8a8a8a", NOTE="#555555", PAPER="white", GRID="#e8e8e8",
    NOTHING="#ececec", BLUE="#0072B2", VERMILION="#D55E00", GREEN="#009E73", SLATE="#6f7fa6",
    BROWN="#6b4423", ORANGE="#E69F00", PURPLE="#CC79A7", SKY="#56B4E9", GROUND="#cdbfa9",
    GROUND_INK="#5d4f38", WATER="#eaf3f9", DEPTHS=("#f4f9fc", "#9fc3de"), MAP="viridis", LOSS_MAP="viridis_r", DIVERGING="RdBu_r")
DARK = dict(
    INK="#e8e8e8", GREY="#9a9a9a", NOTE="#b8b8b8", PAPER="#14171c", GRID="#2c313a",
    NOTHING="#2a2e35", BLUE="#4fa8e0", VERMILION="#ff8840", GREEN="#2fc99b", SLATE="#93a4d0",
    BROWN="#c99a6b", ORANGE="#f2b632", PURPLE="#e39fc6", SKY="#8fd0f7", GROUND="#5b4d38",
    GROUND_INK="#d8c8ab", WATER="#182430", DEPTHS=("#1b252f", "#2c5273"), MAP="viridis", LOSS_MAP="viridis_r",
    DIVERGING="RdBu_r")
THEMES = {"light": LIGHT, "dark": DARK}
globals().update(LIGHT)
TARGETS: list[str] = []
OVER_MAP: list = []     # keeps a mark readable on any colour of a map
TESTING: dict = {}      # settings of matplotlib that tests put on top
_theme = "light"
_inside = False
_given = None           # the caller's axes, of pictures that take none


def settings(theme: dict) -> dict:
    """Of matplotlib."""
    ink, grey = theme["INK"], theme["GREY"]
    return {
        "figure.dpi": 150, "savefig.dpi": "figure", "figure.constrained_layout.use": True,
        "figure.facecolor": theme["PAPER"], "savefig.facecolor": "auto",
        "axes.facecolor": theme["PAPER"], "font.family": "DejaVu Sans", "font.size": 10,
        "text.color": ink, "axes.titlesize": 11, "axes.titlelocation": "left", "axes.titlepad": 9,
        "axes.labelsize": 10, "axes.labelcolor": ink, "axes.edgecolor": grey,
        "axes.linewidth": 0.8, "axes.spines.top": False, "axes.spines.right": False,
        "axes.axisbelow": True, "axes.unicode_minus": True,
        "xtick.labelsize": 9, "ytick.labelsize": 9, "xtick.color": grey, "ytick.color": grey,
        "xtick.labelcolor": ink, "ytick.labelcolor": ink, "grid.color": theme["GRID"],
        "grid.linewidth": 0.7, "lines.linewidth": 1.4, "lines.solid_capstyle": "round",
        "legend.frameon": False, "legend.fontsize": 9, "legend.handlelength": 1.6,
        "legend.columnspacing": 1.6, "legend.labelcolor": ink, "hatch.linewidth": 0.7,
        "text.usetex": False, "agg.path.chunksize": 20000, "pdf.fonttype": 42,
        "svg.hashsalt": "asdic", "svg.fonttype": "path", **TESTING}


def _put_on(name: str) -> None:
    global _theme
    _theme = name
    theme = THEMES[name]
    globals().update(theme)
    TARGETS[:] = [theme[c] for c in ("VERMILION", "BLUE", "GREEN", "PURPLE", "ORANGE", "SKY")]
    OVER_MAP[:] = [patheffects.withStroke(linewidth=2.4, foreground="white" if name == "light"
                                          else "black")]


_put_on("light")


@contextmanager
def look(name: str | None = None):
    """What is drawn inside has this theme; inside another `look`, without a name, that one's."""
    global _inside
    before, nested = _theme, _inside
    wanted = name or (before if nested else "light")
    if wanted not in THEMES:
        raise ValueError(f'theme: found "{wanted}", expected one of {", ".join(THEMES)}')
    _put_on(wanted)
    _inside = True
    try:
        with matplotlib.rc_context(settings(THEMES[wanted])):
            yield
    finally:
        _put_on(before)
        _inside = nested


@contextmanager
def onto(axes):
    """Pictures inside are drawn on the caller's axes."""
    global _given
    before, _given = _given, axes
    try:
        yield
    finally:
        _given = before


def picture(draw):
    """A function that draws, in the common look whatever is around it."""
    @functools.wraps(draw)
    def in_common_look(*arguments, **options):
        with look():
            return draw(*arguments, **options)
    return in_common_look


class Picture(Figure):
    """A figure that a notebook shows by itself, and that knows what it is called."""

    name = ""

    def _repr_png_(self):
        if self.canvas is None:
            FigureCanvasAgg(self)
        made = io.BytesIO()
        self.savefig(made, format="png", dpi=100)
        return made.getvalue()


def colour(target: int) -> str:
    return TARGETS[target % len(TARGETS)]


def colours(count: int) -> list:
    """Shades of the common map, one after the other, none of which is lost on the page."""
    ends = (0.0, 0.9) if _theme == "light" else (0.28, 1.0)
    return [matplotlib.colormaps[MAP](x) for x in np.linspace(*ends, count)]


def flat_map(shade):
    """A map of one colour: of cells that are all alike."""
    return matplotlib.colors.ListedColormap([shade])


# ------------------------------------------------------------------------------------- figures


def figure(what: str, height: float = 4.6, axes=None, nrows: int = 1, ncols: int = 1,
           squeeze: bool = True, **grid):
    """A figure under a title that says what it is, or the caller's own axes. → figure, axes (as
    plt.subplots)
    """
    axes = _given if axes is None else axes
    if axes is not None:
        flat = np.ravel(np.array(axes, dtype=object))
        if flat.size != nrows * ncols:
            raise ValueError(f"axes: found {flat.size}, expected {nrows * ncols} "
                             f"({what[0].lower()}{what[1:]})")
        own = flat.reshape(nrows, ncols)
        return flat[0].figure, (np.squeeze(own)[()] if squeeze else own)
    fig = Picture(figsize=(WIDTH, height))
    FigureCanvasAgg(fig)
    made = fig.subplots(nrows, ncols, squeeze=squeeze, **grid)
    title(fig, what)
    if engine := fig.get_layout_engine():
        engine.set(w_pad=0.1, h_pad=0.07, wspace=0.02, hspace=0.03)
    return fig, made


def title(fig, text: str) -> None:
    """Of a picture of ours; a caller's figure keeps its own."""
    if isinstance(fig, Picture):
        fig.name = text
        fig.suptitle("\n".join(wrapped(text, 72.0 * WIDTH - 20.0, 13, "bold")), x=0.012, ha="left",
                     fontsize=13, fontweight="bold")


def plain(text) -> str:
    """Never read as mathematics, in one line."""
    return re.sub(r"[ \t\r\n\f\v]+", " ", str(text).replace("$", r"\$")).strip()


def width_of(text: str, size: float, weight: str = "normal") -> float:
    """Of a line of text [points]"""
    font = FontProperties(family="DejaVu Sans", size=size, weight=weight)
    return text_to_path.get_text_width_height_descent(text.replace(r"\$", "$"), font, False)[0]


def wrapped(text: str, room: float, size: float, weight: str = "normal", most: int = 4):
    """Lines that are no wider than `room` [points]. More than `most` of them end in …"""
    letters = max(int(room / (width_of("abcdefghijklmnopqrstuvwxyz ", size, weight) / 27)), 12)
    while True:
        lines = textwrap.wrap(text, letters, break_on_hyphens=False) or [""]
        widest = max(width_of(line, size, weight) for line in lines)
        if widest <= room or letters <= 12:
            break
        letters = max(12, min(letters - 1, int(letters * room / widest)))
    if len(lines) > most:
        lines = lines[:most]
        lines[-1] = lines[-1][:-1] + "…"
    return lines


def room_of(axes) -> float:
    """From the left end of an axes to the right edge of its figure [points]"""
    fig = axes.figure
    width = fig.get_figwidth()
    place = axes.get_subplotspec()
    if place is None or not isinstance(fig, Picture):
        return 72.0 * width * axes.get_position().width
    grid = place.get_gridspec()
    ratios = np.array(grid.get_width_ratios(), float)
    left = 1.05 + (width - 1.25) * ratios[: place.colspan.start].sum() / ratios.sum()
    return 72.0 * (width - left - 0.1)


def subtitle(axes, text: str, marks: bool = False) -> None:
    """Grey lines above the axes: what it is of. As many as it takes. \\param marks  leaves room for
    marks over the axes
    """
    lines = wrapped(plain(text), room_of(axes), 9.5)
    axes.set_title("\n".join(lines), color=NOTE, fontsize=9.5, fontweight="normal", loc="left",
                   pad=17.0 if marks else None)


def shorten(text: str, limit: int = 125) -> str:
    text = plain(text)
    return text if len(text) <= limit else text[: limit - 1] + "…"


def name(text: str) -> str:
    """A target's name for a legend: never read as mathematics, never long, never hidden for its
    leading underscore.
    """
    return shorten(text, 28).lstrip("_") or "target"


def on_earth(attributes) -> str:
    """"33.7000° N, 63.0000° W" by the attributes latitude_deg and longitude_deg; "" without them."""
    try:
        north, east = (float(np.ravel(attributes[key])[0]) for key in ("latitude_deg", "longitude_deg"))
    except (KeyError, IndexError, TypeError, ValueError):
        return ""
    east = (east + 180.0) % 360.0 - 180.0
    return (f"{abs(north):.4f}° {'N' if north >= 0.0 else 'S'}, "
            f"{abs(east):.4f}° {'E' if east >= 0.0 else 'W'}")


def east_of(place: str) -> str:
    """The label of a map's axis, with where its [0, 0] is, if that is known."""
    return f"east of {place} / km" if place else "east / km"


def degrees(angle: float) -> str:
    """−12.5°, with a real minus sign."""
    return f"{angle:+.6g}°".replace("-", "−") if angle else "0°"


def time_axis(axes, first: float, last: float, label: str = "time after the ping / s") -> None:
    axes.set_xlim(first, last if last > first else first + 1e-3)
    axes.set_xlabel(label)


def legend_below(axes, handles=None, points: float = 40.0, ncol: int = 6, **options) -> None:
    """A legend in rows under the axes and its label, where it can hide nothing."""
    handles = list(handles if handles is not None else axes.get_legend_handles_labels()[0])
    if not handles:
        return
    widths = [width_of(plain(h.get_label()), 9) + 44.0 for h in handles]
    room = room_of(axes)
    columns = min(ncol, len(handles))
    while columns > 1:
        rows, longer = divmod(len(widths), columns)     # the first columns are a row longer
        cuts = np.cumsum([0] + [rows + (k < longer) for k in range(columns)])
        if sum(max(widths[a:b]) for a, b in zip(cuts, cuts[1:])) <= room:
            break
        columns -= 1
    below = axes.transAxes + ScaledTranslation(0.0, -points / 72.0, axes.figure.dpi_scale_trans)
    before = axes.get_legend()
    legend = axes.legend(handles=handles, loc="upper left", bbox_to_anchor=(0.0, 0.0), ncol=columns,
                         bbox_transform=below, borderaxespad=0.0, borderpad=0.0, **options)
    if before:      # axes.legend() has put it away
        axes.add_artist(before)
    # wider than its axes it would squeeze them: a strut keeps its height free instead
    legend.set_in_layout(False)
    height = 14.0 * -(-len(handles) // columns) + 2.0
    axes.annotate(" ", (0.0, 0.0), (0.0, -points - height), "axes fraction", "offset points",
                  fontsize=2, annotation_clip=False)


def told_apart(times, span: float) -> np.ndarray:
    """Those of many times that strokes can tell apart: none nearer to the one before than 0.6 % of the
    axis. The first is among them.
    """
    kept: list = []
    for time in np.sort(times):
        if not kept or time - kept[-1] >= 0.006 * span:
            kept.append(time)
    return np.array(kept)


def truth(target: int, marker: str, size: float, label: str = "_"):
    """Look of a mark of the truth beside an image or a curve: the target's colour, a thin edge."""
    return dict(ls="none", marker=marker, ms=size, mfc=colour(target), mec=INK, mew=0.35,
                label=label)


def box(axes, first: float, last: float, low: float, high: float, shade: str, **options):
    """An outline around what is between two times, and between two places of the other axis."""
    return axes.add_patch(Rectangle((first, low), last - first, high - low, fill=False, ec=shade,
                                    lw=1.4, zorder=6, path_effects=list(OVER_MAP), **options))


def box_key(shade: str, label: str):
    """Of `box`, for a legend."""
    return Rectangle((0, 0), 1, 1, fill=False, ec=shade, lw=1.6, label=label)


def together(first, last, place, near: float):
    """Boxes of one height that lie over one another as one each. → rows of first, last, place"""
    order = np.argsort(first, kind="stable")
    made: list[list[float]] = []
    for f, g, y in zip(np.asarray(first)[order], np.asarray(last)[order],
                       np.asarray(place)[order]):
        for one in made:
            if f <= one[1] and abs(y - one[2]) <= near:
                one[1] = max(one[1], g)
                break
        else:
            made.append([float(f), float(g), float(y)])
    return made


def image_frame(axes) -> None:
    """Axes around an image: all four sides, ticks outwards; grey where there are no data."""
    axes.set_facecolor(NOTHING)
    for side in axes.spines.values():
        side.set_visible(True)
    axes.tick_params(direction="out", length=3)


def silence(axes, db) -> None:
    """Says so where there is nothing to be drawn."""
    if not np.isfinite(db).any():
        axes.text(0.5, 0.5, "silence", transform=axes.transAxes, ha="center", va="center",
                  color=GREY)


def beyond(values, limits) -> str:
    """Which ends of a colour bar are arrows: those that some of the values lie beyond."""
    good = np.asarray(values, float)
    good = good[np.isfinite(good)]
    low = good.size and good.min() < limits[0] - 1e-9
    high = good.size and good.max() > limits[1] + 1e-9
    return {(False, False): "neither", (True, False): "min", (False, True): "max",
            (True, True): "both"}[bool(low), bool(high)]


def colour_bar(fig, mesh, axes, label: str, extend: str | None = None):
    first = axes if not np.ndim(axes) else np.ravel(axes)[0]
    values = np.ma.filled(np.ma.asarray(mesh.get_array(), float), np.nan)
    silence(first, values)
    bar = fig.colorbar(mesh, ax=axes, pad=0.015, fraction=0.05, aspect=28,
                       extend=extend or beyond(values, mesh.get_clim()))
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


def weighted_percentiles(values, weight, percents) -> np.ndarray:
    """Of finite values, each by its weight; NaN where there is none."""
    good = np.isfinite(values)
    if not good.any():
        return np.full(len(percents), np.nan)
    order = np.argsort(values[good])
    part = np.cumsum(weight[good][order])
    place = np.searchsorted(part, np.asarray(percents) / 100.0 * part[-1])
    return np.asarray(values)[good][order][np.minimum(place, order.size - 1)].astype(float)


def depth_levels(depth, relief: float = 0.05) -> np.ndarray:
    """About six even depths [m] between the least and the greatest; none of a floor that is flat but for a
    share of its depth: its lines would hide what they are drawn over. \param relief  that share
    """
    good = depth[np.isfinite(depth)]
    if not good.size or not np.ptp(good) > max(1.0, relief * float(good.max())):
        return np.zeros(0)
    low, high = float(good.min()), float(good.max())
    step = (high - low) / 6.0
    nice = 10.0 ** np.floor(np.log10(step))
    step = nice * min((f for f in (1, 2, 5, 10) if f * nice >= step), default=10)
    return np.arange(np.ceil(low / step) * step, high, step)


def label_places(segments, inside, least: float) -> list:
    """Of the contours of each level the middles of the two longest parts within a picture that are no
    shorter than `least`. \\param segments  [level][segment] of [n, 2]
    \\param inside  points [n, 2] → where they are
    """
    places = []
    for lines in segments:
        parts = []
        for line in lines:
            seen = np.flatnonzero(inside(line))
            for part in np.split(seen, np.flatnonzero(np.diff(seen) > 1) + 1):
                if part.size < 3:
                    continue
                way = np.append(0.0, np.cumsum(np.hypot(*np.diff(line[part], axis=0).T)))
                if way[-1] >= least:
                    middle = line[part[int(np.searchsorted(way, 0.5 * way[-1]))]]
                    parts.append((float(way[-1]), tuple(middle.tolist())))
        places += [place for _, place in sorted(parts, reverse=True)[:2]]
    return places


def depth_lines(axes, x, y, depth, levels, zorder: float = 3.0, inside=None) -> list:
    """Contours of the sea floor, in a halo that keeps them readable on any colour. → handles

    \\param inside  points [n, 2] → those among which a level has its number; none: wherever there is room
    """
    if not np.size(levels):
        return []
    made = axes.contour(x, y, depth, levels=levels, colors=[INK], linewidths=0.8, zorder=zorder)
    halo = [patheffects.withStroke(linewidth=2.0, foreground=PAPER)]
    for part in getattr(made, "collections", [made]):   # one a level before matplotlib 3.8
        part.set_path_effects(halo)
    least = 0.12 * abs(np.subtract(*axes.get_xlim()))
    where = {} if inside is None else {"manual": label_places(made.allsegs, inside, least)}
    if where == {"manual": []}:
        return [Line2D([], [], color=INK, lw=0.8, label="depth of the sea floor / m")]
    for text in axes.clabel(made, fmt="%g", fontsize=7, **where):
        text.set_path_effects(halo)
        text.set_zorder(zorder + 0.1)
    return [Line2D([], [], color=INK, lw=0.8, label="depth of the sea floor / m")]


def depth_shades():
    """Of the sea floor below marks: faint, the deeper the darker."""
    return matplotlib.colors.LinearSegmentedColormap.from_list("depths", list(DEPTHS))


def hatched(axes, inside, far: float, label: str, lines: int = 45, falling: bool = False,
            middle=(0.0, 0.0), zorder: float = 2.5) -> list:
    """Strokes in a halo over part of a map, which are seen on any colour. → handles

    \\param inside  (x, y) → where it is that part   \\param far  half a side of the square that has it
    \\param lines  across that square
    """
    step, along = 2.0 * far / lines, np.linspace(-far, far, 30 * lines)
    made = []
    for k in range(-lines, lines + 1):
        y = (-along if falling else along) + k * step
        seen = inside(along + middle[0], y + middle[1]) & (np.abs(y) <= far)
        cuts = np.flatnonzero(np.diff(np.concatenate([[False], seen, [False]]).astype(int)))
        for first, last in zip(cuts[::2], cuts[1::2]):
            if last - first > 1:
                made.append([(along[i] + middle[0], y[i] + middle[1]) for i in (first, last - 1)])
    if not made:
        return []
    strokes = LineCollection(made, colors=[INK], linewidths=0.7, zorder=zorder,
                             path_effects=[patheffects.withStroke(linewidth=1.8, foreground=PAPER)])
    axes.add_collection(strokes, autolim=False)
    return [Patch(fc="none", ec=INK, hatch=("\\\\" if falling else "//") * 2, lw=0.0, label=label)]


def compass(axes, far: float) -> None:
    """True bearings around a map whose circle ends at `far`."""
    axes.set_xlim(-1.11 * far, 1.11 * far)
    axes.set_ylim(-1.11 * far, 1.11 * far)
    for bearing in range(0, 360, 30):
        b = np.radians(bearing)
        axes.plot(*(np.outer([np.sin(b), np.cos(b)], [1.0, 1.012]) * far), color=GREY, lw=0.8, zorder=4)
        axes.text(1.055 * far * np.sin(b), 1.055 * far * np.cos(b),
                  "N" if bearing == 0 else f"{bearing:03d}°", ha="center", va="center", color=NOTE,
                  fontsize=9 if bearing == 0 else 7, fontweight="bold" if bearing == 0 else "normal",
                  zorder=4)


def degree_text(value: float, places: int, words: str) -> str:
    """62.75° W. \\param words  "NS" or "EW\""""
    value = (value + 180.0) % 360.0 - 180.0 if words == "EW" else value
    rounded = round(value, places)
    return f"{abs(rounded):.{places}f}°" + (f" {words[int(rounded < 0.0)]}" if rounded else "")


def degree_ticks(axes, east, longitude, north, latitude) -> None:
    """Longitudes above a map and latitudes to its right. \\param east, north  two places on the axes
    \\param longitude, latitude  of these [°]
    """
    for side, (a, b), (u, v), words in (("top", east, longitude, "EW"), ("right", north, latitude, "NS")):
        rate = (v - u) / (b - a)
        if not np.isfinite(rate) or rate == 0.0:
            return
        there, back = (lambda x, a=a, u=u, r=rate: u + (x - a) * r), (lambda w, a=a, u=u, r=rate: a + (w - u) / r)
        other = (axes.secondary_xaxis if side == "top" else axes.secondary_yaxis)(
            side, functions=(there, back))
        axis = other.xaxis if side == "top" else other.yaxis
        axis.set_major_locator(ticker.MaxNLocator(6, steps=[1, 2, 5, 10]))
        low, high = sorted(there(x) for x in (axes.get_xlim() if side == "top" else axes.get_ylim()))
        ticks = axis.get_major_locator().tick_values(low, high)
        places = max(0, int(np.ceil(-np.log10(ticks[1] - ticks[0]) - 1e-9)))
        axis.set_major_formatter(ticker.FuncFormatter(
            lambda x, _, n=places, w=words: degree_text(x, n, w)))
        other.tick_params(direction="out", length=3, labelsize=7.5, pad=2)
        for spine in other.spines.values():
            spine.set_visible(False)


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


def readable_on(shade) -> str:
    """Black or white: what can be read on a colour."""
    red, green, blue = matplotlib.colors.to_rgb(shade)
    return "black" if 0.299 * red + 0.587 * green + 0.114 * blue > 0.5 else "white"


def write(fig, path, force: bool = False, **options) -> None:
    """\\throws InputError where the name is somebody's, OSError with the path when it cannot be written"""
    with look():
        output.write(fig, path, force, **options)

"""Pictures of a study's maps of place (`[summary] map`, docs/formats/study.md): north up, a panel for each depth."""
from __future__ import annotations

import numpy as np
from matplotlib.patches import Patch

from . import style
from .study_data import Study, SummaryTable, spoken
from .study_pictures import DETAILS, axes_of, columns_of, heading, panels, top, varying

HEAD = "map_"
MOST_MEASURES = 6
PLACES = ("place_east", "place_north", "place_range", "place_bearing", "place_depth")
THIN = 20             # realisations, below which a cell's number is told
MOST_NUMBERS = 240    # cells of a panel that numbers still fit into
ARC = 3.0             # degrees of a sector's outline that are drawn straight


def measures(table: SummaryTable) -> list:
    """What a table has a map of."""
    name = table.name[len(HEAD):]
    if name != "means":
        return [name] if name in table else []
    return [n for n in varying(table) if not n.startswith(DETAILS + PLACES)][:MOST_MEASURES]


def names_of(study: Study) -> list:
    return [HEAD + n for t in study.tables(lambda t: t.name.startswith(HEAD)) for n in measures(t)]


class Cells:
    """The cells of a table, [depths, across, up]."""

    def __init__(self, table: SummaryTable):
        names = axes_of(table)
        self.depth = table[names[0]] if len(names) == 3 else None
        across, up = (table[n] for n in names[-2:])
        self.names = names[-2:]
        self.polar = up.unit == "degrees"
        self.first, self.second = self.edges(table, across), self.edges(table, up)
        self.layers = 1 if self.depth is None else np.unique(self.depth.values).size
        self.shape = (self.layers, self.first.size - 1, self.second.size - 1)
        self.count = table["count"].values.reshape(self.shape)

    @staticmethod
    def edges(table: SummaryTable, column) -> np.ndarray:
        if f"{column.name}_low" in table:
            return np.unique(np.concatenate([table[f"{column.name}_{end}"].values for end in ("low", "high")]))
        return style.cell_edges(np.unique(column.values))

    def of(self, table: SummaryTable, name: str) -> np.ndarray:
        return table[name].values.reshape(self.shape)

    def depth_words(self, table: SummaryTable, layer: int) -> str:
        if self.depth is None:
            return ""

        def at(name):
            return table[name].values.reshape(self.shape)[layer, 0, 0]
        name = self.depth.name
        if self.depth.labels:
            return f"{spoken(name)} {self.depth.labels[int(at(name))]}"
        if f"{name}_low" in table:
            return f"{spoken(name)} {at(name + '_low'):.4g} to {at(name + '_high'):.4g} m"
        return f"{spoken(name)} {at(name):.4g} m"

    def corners(self):
        """East and north of a mesh [km], and how often each cell is repeated along the second axis."""
        if not self.polar:
            return *np.meshgrid(self.first / 1e3, self.second / 1e3, indexing="ij"), 1
        pieces = max(1, int(np.ceil(np.max(np.diff(self.second)) / ARC)))
        fine = np.concatenate([np.linspace(a, b, pieces, endpoint=False)
                               for a, b in zip(self.second[:-1], self.second[1:])] + [self.second[-1:]])
        turn = np.radians(fine)
        return np.outer(self.first, np.sin(turn)) / 1e3, np.outer(self.first, np.cos(turn)) / 1e3, pieces

    def room(self, i: int, j: int) -> float:
        """Width of a cell, of the whole map's."""
        if not self.polar:
            return min(np.diff(self.first)[i] / np.ptp(self.first), np.diff(self.second)[j] / np.ptp(self.second))
        return self.first[i:i + 2].mean() * np.radians(np.diff(self.second)[j]) / (2.0 * self.first[-1])

    def middle(self, i: int, j: int):
        """[km]"""
        a, b = self.first[i:i + 2].mean(), self.second[j:j + 2].mean()
        if not self.polar:
            return a / 1e3, b / 1e3
        return a * np.sin(np.radians(b)) / 1e3, a * np.cos(np.radians(b)) / 1e3


def draw_layer(axes, cells: Cells, value, count, limits):
    """One depth. → the mesh for the colour bar"""
    x, y, repeated = cells.corners()

    def mesh(what, **look):
        return axes.pcolormesh(x, y, np.repeat(what, repeated, axis=1), rasterized=True, **look)

    empty = np.where(count == 0, 1.0, np.nan)
    unknown = np.where((count > 0) & ~np.isfinite(value), 1.0, np.nan)
    for where, shade in ((empty, style.NOTHING), (unknown, style.GREY)):
        if np.isfinite(where).any():
            mesh(where, cmap=style.flat_map(shade), vmin=0.0, vmax=1.0)
    image = mesh(value, cmap=style.MAP, vmin=limits[0], vmax=limits[1])
    axes.plot(0.0, 0.0, "^", ms=7, mfc=style.INK, mec=style.PAPER, mew=0.9, zorder=6)
    axes.set_aspect("equal", anchor="W")
    axes.set_xlim(min(x.min(), 0.0), max(x.max(), 0.0))
    axes.set_ylim(min(y.min(), 0.0), max(y.max(), 0.0))
    axes.margins(0.03)
    style.image_frame(axes)
    if count.size <= MOST_NUMBERS:
        for (i, j), n in np.ndenumerate(count):
            if 0 < n < THIN and cells.room(i, j) > 0.04:
                shade = image.to_rgba(value[i, j]) if np.isfinite(value[i, j]) else (0.5, 0.5, 0.5, 1.0)
                axes.text(*cells.middle(i, j), f"{n:.0f}", ha="center", va="center", fontsize=6.5,
                          color=style.readable_on(shade), zorder=7)
    return image


def how_full(cells: Cells) -> str:
    """What is to be known of the numbers of realisations."""
    there = cells.count[cells.count > 0]
    thin = int(np.sum(there < THIN))
    if not thin:
        return f"at least {int(there.min(initial=np.inf)) if there.size else 0} realisations in a cell"
    written = " (their number)" if cells.shape[1] * cells.shape[2] <= MOST_NUMBERS else ""
    return f"{thin} of {there.size} cells have fewer than {THIN} realisations{written}"


def draw_one(study: Study, table: SummaryTable, name: str):
    cells = Cells(table)
    scale = table[name].scale()
    value = scale * cells.of(table, name)
    probability = not table.name.endswith("means")
    known = value[np.isfinite(value)]
    limits = ((0.0, min(1.0, top(table[f"{name}_high"].values[table["count"].values > 0])))
              if probability else (known.min(), known.max()))
    words = table[name].words()
    fig, axes = panels(study, f"{words[:1].upper()}{words[1:]} over place", cells.layers,
                       7.9 if cells.layers == 1 else 4.9 - 0.5 * columns_of(cells.layers))
    full = cells.count >= THIN
    half = 0.5 * scale * (cells.of(table, f"{name}_high") - cells.of(table, f"{name}_low"))[full]
    half = half[np.isfinite(half)]
    within = f" · all others within ± {half.max():.2g} or less ({study.interval})" if half.size else ""
    for layer, a in enumerate(axes):
        image = draw_layer(a, cells, value[layer], cells.count[layer], limits)
        depth = cells.depth_words(table, layer)
        a.set_xlabel(("east of the array / km" if cells.names[0].startswith("place_east") else "east / km")
                     + (f"\n{depth}" if depth else ""))
        a.set_ylabel("north / km")
    style.colour_bar(fig, image, axes[0] if len(axes) == 1 else axes, table[name].label(), "neither")
    for a in axes:
        a.set_anchor("W")  # a colour bar has drawn it to the right
    told = how_full(cells) + within
    if len(axes) == 1:
        style.subtitle(axes[0], f"{study.heading()} · {told}")
    else:
        heading(axes[0], study, told)
    keys = []
    if np.any(cells.count == 0):
        keys.append(Patch(fc=style.NOTHING, ec=style.GREY, label=f"no realisation ({int(np.sum(cells.count == 0))} cells)"))
    if np.any((cells.count > 0) & ~np.isfinite(value)):
        keys.append(Patch(fc=style.GREY, ec=style.GREY, label="realisations without a finite value"))
    if keys:
        style.legend_below(axes[0], keys, points=40.0 if cells.depth is None else 54.0)
    return fig


def draw(study: Study) -> dict:
    figures = {}
    for table in study.tables(lambda t: t.name.startswith(HEAD)):
        for name in measures(table):
            if np.isfinite(table[name].values).any():
                figures[HEAD + name] = draw_one(study, table, name)
    return figures

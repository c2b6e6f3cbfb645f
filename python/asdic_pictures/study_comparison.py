"""Pictures of a comparison of studies (`asdic study --compare`, docs/formats/study-results.md): who is better
where, and how sure that is.
"""
from __future__ import annotations

from dataclasses import dataclass, field

import h5py
import numpy as np

from . import source, style
from .data import InputError
from .study_data import SummaryTable, _summary, _text, spoken
from .study_pictures import axes_of, bins, heading, name_ticks, orient, panels

KIND = "asdic comparison"


@dataclass
class Comparison:
    path: str
    names: list                 # of the studies, as columns have them
    realisations: int
    summary: list               # of SummaryTable
    confidence: float = 0.95    # of every interval
    tags: dict = field(default_factory=dict)

    def heading(self) -> str:
        return (f"{' against '.join(spoken(n) for n in self.names)} · {self.realisations} realisations of the same "
                f"sea · {100.0 * self.confidence:.6g} % confidence")

    def pairs(self) -> list:
        """(name of the columns, words)"""
        return [(f"{a}_to_{b}", f"{spoken(b)} − {spoken(a)}")
                for i, a in enumerate(self.names) for b in self.names[i + 1:]]


def read(path) -> Comparison:
    """Of a file. \\throws InputError"""
    path = source.name_of(path)
    try:
        with h5py.File(path, "r") as f:
            return Comparison(path, [_text(n) for n in np.ravel(f.attrs["names"])],
                              int(f.attrs["realisations"]), [_summary(n, g) for n, g in f["summary"].items()],
                              float(np.ravel(f["summary"].attrs["confidence"])[0]),
                              dict(title=" against ".join(_text(n) for n in np.ravel(f.attrs["names"])),
                                   version=_text(f.attrs.get("program_version", "")),
                                   digest=" ".join(_text(n) for n in np.ravel(f.attrs["identities"]))))
    except (KeyError, OSError, ValueError) as error:
        raise InputError(path, f"what cannot be read ({error})",
                         "a whole file of `asdic study --compare`") from error


def begun(words: str) -> str:
    """With a capital letter."""
    return words[:1].upper() + words[1:]


def word_of(table: SummaryTable) -> str:
    """What its answers are called: "pd", "echo_level_db"."""
    return table.name.split("_by_")[0]


def band(axes, table: SummaryTable, y: str, colour: str, label: str, aside: float = 0.0) -> None:
    """An estimate with its interval along the table's axis. \\param aside  of categories, so that several are seen"""
    x = table[axes_of(table)[0]]
    value, low, high = (table[y + end].values for end in ("", "_low", "_high"))
    if x.labels:
        axes.errorbar(np.arange(value.size) + aside, value, [value - low, high - value], fmt="o", color=colour,
                      capsize=3, label=label)
        axes.set_xticks(np.arange(value.size), [style.shorten(n, 18) for n in
                                                (x.labels[int(k)] for k in x.values)])
    else:
        place = x.values * x.scale()
        axes.fill_between(place, low, high, color=colour, alpha=0.2, lw=0)
        axes.plot(place, value, "-o", ms=3.5, color=colour, label=label)
    axes.grid(True)


def draw_line(comparison: Comparison, table: SummaryTable):
    """All studies along one input, and what they differ by."""
    word = word_of(table)
    x = table[axes_of(table)[0]]
    unit = table[f"{word}_{comparison.names[0]}"].unit
    of_unit = f" / {unit}" if unit and unit != "1" else ""
    fig, axes = style.figure(begun(f"{spoken(word)} against {spoken(x.name)}"), 6.4, nrows=2, sharex=True)
    count = len(comparison.names)
    for k, name in enumerate(comparison.names):
        band(axes[0], table, f"{word}_{name}", style.colour(k), spoken(name), 0.12 * (k - 0.5 * (count - 1)))
    axes[0].set_ylabel(spoken(word) + of_unit)
    if unit == "1":
        axes[0].set_ylim(-0.02, 1.02)
    for k, (name, words) in enumerate(comparison.pairs()):
        band(axes[1], table, name, style.colour(count + k), words)
    axes[1].axhline(0.0, color=style.GREY, lw=0.8, ls="--")
    axes[1].set_ylabel(f"difference{of_unit}")
    axes[1].set_xlabel(x.label())
    heading(axes[0], comparison, "bands hold for each bin by itself")
    for a in axes:
        style.legend_below(a, ncol=3)
    return fig


def draw_map(comparison: Comparison, table: SummaryTable):
    """What each pair differs by over two inputs; a dot where the interval holds no difference, too."""
    x, y = (table[n] for n in axes_of(table))
    across, down = bins(table, x), bins(table, y)
    cells = (across.size - 1, down.size - 1)
    if cells[0] * cells[1] != x.values.size:
        return None
    pairs = comparison.pairs()
    word = word_of(table)
    along = " and ".join(spoken(n) for n in axes_of(table))
    fig, axes = panels(comparison, begun(f"{spoken(word)} against {along}: differences"), len(pairs), 3.4)
    heading(axes[0], comparison, "a dot: not decided")
    largest = max((float(np.nanmax(np.abs(table[n].values), initial=0.0)) for n, _ in pairs), default=1.0) or 1.0
    for (name, words), a in zip(pairs, axes):
        value, low, high = (table[name + end].values.reshape(cells) for end in ("", "_low", "_high"))
        image = a.pcolormesh(across, down, value.T, cmap=style.DIVERGING, vmin=-largest, vmax=largest)
        open_ = np.isfinite(value) & (low <= 0.0) & (high >= 0.0)
        i, j = np.nonzero(open_)
        a.plot(0.5 * (across[i] + across[i + 1]), 0.5 * (down[j] + down[j + 1]), ".", ms=4, color=style.NOTE)
        for axis, column in ((a.xaxis, x), (a.yaxis, y)):
            if column.labels:
                axis.set_ticks(*name_ticks(column))
        orient(a.yaxis, y)
        style.image_frame(a)
        a.set_xlabel(x.label())
        a.set_ylabel(y.label())
        unit = table[name].unit
        fig.colorbar(image, ax=a, label=words + (f" / {unit}" if unit and unit != "1" else ""))
    return fig


def draw_all_measures(comparison: Comparison, table: SummaryTable):
    """Every measure's differences over all realisations, a panel each: their units differ."""
    measures = table["measure"]
    pairs = comparison.pairs()
    answers = np.array([table[f"value_{n}"].values for n in comparison.names])
    shown = [k for k in range(measures.values.size)
             if np.isfinite([table[n].values[k] for n, _ in pairs]).any() and answers[:, k].any()][:12]
    if not shown:
        return None
    fig, axes = panels(comparison, "Differences over all realisations", len(shown), 1.4 + 0.3 * len(pairs))
    for k, a in zip(shown, axes):
        for row, (name, _) in enumerate(pairs):
            value, low, high = (table[name + end].values[k] for end in ("", "_low", "_high"))
            a.errorbar(value, row, xerr=[[value - low], [high - value]], fmt="o", color=style.colour(row + 1),
                       capsize=4)
        a.axvline(0.0, color=style.GREY, lw=0.8, ls="--")
        a.set_yticks(range(len(pairs)), [style.shorten(words, 34) for _, words in pairs])
        a.set_ylim(len(pairs) - 0.4, -0.6)
        name = measures.labels[int(measures.values[k])]
        a.set_xlabel(spoken(name) + (" / dB" if "_db" in name else " / degrees" if "_deg" in name else ""))
        a.grid(True, axis="x")
    heading(axes[0], comparison)
    return fig


def is_nothing(comparison: Comparison, table: SummaryTable) -> bool:
    """Whether every study's answer is 0 everywhere, or not known."""
    return table.name != "differences" and not any(
        np.nan_to_num(table[f"{word_of(table)}_{n}"].values).any() for n in comparison.names)


def names_of(comparison: Comparison) -> list:
    return [t.name for t in comparison.summary]


def draw(comparison: Comparison, only=None):
    """→ (name, figure) of every picture, one at a time. \\param only  names, if not all"""
    for table in comparison.summary:
        if (only is not None and table.name not in only) or is_nothing(comparison, table):
            continue
        with style.look():
            if table.name == "differences":
                figure = draw_all_measures(comparison, table)
            elif len(axes_of(table)) == 1:
                figure = draw_line(comparison, table)
            else:
                figure = draw_map(comparison, table)
        if figure is not None:
            yield table.name, figure

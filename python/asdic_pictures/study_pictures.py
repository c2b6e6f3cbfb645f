"""Pictures of a study: each `draw_…(study)` gives figures by the name of their file, none where the
study holds nothing of the kind.
"""
from __future__ import annotations

import numpy as np
from matplotlib.lines import Line2D

from . import style
from .study_data import Study, SummaryTable, spoken

MOST_PANELS = 12
MOST_BESIDE = 6  # inputs of two maps side by side
YES_OR_NO = ("detected", "false_alarm", "initiated", "tracked", "rare_event")
CELL_WORDS = {"pfa": "false-alarm rate", "k_shape": "shape of the K distribution (high: Rayleigh)"}
RARE = "p_event"  # drawn from a proposal or not: by its logarithm
WORTH = 10.0  # effective rows of an event that say something of its least probability
CELLS = "roc_cells"  # the table of all cells without an echo
RAYLEIGH = 1e4  # a shape of the K distribution that nobody tells from it
TAIL = 0.1  # share of the values without an echo that the tail of an ROC is drawn after
ELLIPSES = ("ellipses", "sight_ellipses")
IN_UNITS = ("means", *ELLIPSES)  # tables of what is no probability
DETAILS = ("path", "echo_time", "noise_level", "series_")  # measures that are left out first


def columns_of(count: int) -> int:
    """Of a grid of small pictures."""
    return 2 if count == 4 else min(3, count)


def panels(study: Study, what: str, count: int, height: float = 2.6):
    """A grid of axes for `count` small pictures. → figure, axes [count]"""
    columns = columns_of(count)
    rows = -(-count // columns)
    fig, axes = style.figure(what, max(4.2, 0.9 + height * rows), nrows=rows, ncols=columns,
                             squeeze=False)
    flat = axes.ravel()
    for unused in flat[count:]:
        unused.remove()
    return fig, flat[:count]


def heading(axes, study: Study, more: str = "") -> None:
    """style.subtitle over several axes: its length moves none of them, nor their colour bars."""
    words = study.heading() + (f" · {more}" if more else "")
    lines = style.wrapped(style.plain(words), style.room_of(axes), 9.5)
    axes.set_title("\n".join(" " for _ in lines), fontsize=9.5)  # keeps its height free
    line = axes.annotate("\n".join(lines), (0.0, 1.0), (0.0, 8.0), "axes fraction",
                         "offset points", color=style.NOTE, fontsize=9.5, annotation_clip=False)
    line.set_in_layout(False)


def orient(axis, column) -> None:
    """Depth grows downwards."""
    if column.is_depth():
        axis.axes.set_ylim(*sorted(axis.axes.get_ylim(), reverse=True))


def banded(table: SummaryTable) -> list:
    """Names of the columns that have an interval beside them, but for those of an axis's bins and
    those in which nothing is known anywhere.
    """
    names = [c.name for c in table.columns]
    first = names.index("count") + 1 if "count" in names else 0
    return [n for n in names[first:] if f"{n}_low" in table and f"{n}_high" in table
            and np.isfinite(table[n].values).any()]


def band(axes, table: SummaryTable, x: str, y: str, colour: str, label: str | None = None) -> None:
    """An estimate with its interval: a line and a band, or, of categories, dots and bars."""
    at, value = table[x], table[y]
    middle, low, high = (table[y + end].values * value.scale() for end in ("", "_low", "_high"))
    if y == "k_shape":  # without end: Rayleigh
        middle, high = np.minimum(middle, RAYLEIGH), np.minimum(high, RAYLEIGH)
    if y == RARE:  # none found: the band alone
        middle = np.where(middle > 0.0, middle, np.nan)
    if at.labels:
        place = np.arange(at.values.size)
        axes.errorbar(place, middle, [middle - low, high - middle], fmt="o",
                      color=colour, capsize=3, label=label)
        names = [at.labels[int(k)] if 0 <= k < len(at.labels) else f"{k:g}" for k in at.values]
        axes.set_xticks(place, [style.shorten(n, 18) for n in names])
    else:
        place = at.values * at.scale()
        axes.fill_between(place, low, high, color=colour, alpha=0.2, lw=0)
        axes.plot(place, middle, "-o", ms=3.5, color=colour, label=label)
        if f"{x}_low" in table:  # of bins: the whole of them, not the middles alone
            edges = np.concatenate([table[f"{x}_low"].values, table[f"{x}_high"].values])
            axes.set_xlim(edges.min() * at.scale(), edges.max() * at.scale())
    axes.set_xlabel(at.label())
    axes.grid(True)


def axes_of(table: SummaryTable) -> list:
    """The columns that a table is laid out along: those before `count` that are no bin's edges."""
    names = [c.name for c in table.columns]
    before = names[: names.index("count")] if "count" in names else []
    return [n for n in before if not n.endswith(("_low", "_high")) or n.rsplit("_", 1)[0] not in before]


def varying(table: SummaryTable) -> list:
    """Of banded(): those that are not the same everywhere."""
    return [n for n in banded(table) if not table[n].is_constant() or table[n].values.size == 1]


def beside(table: SummaryTable, name: str) -> bool:
    """Whether a column is the false-alarm rate that stands beside a probability of detection."""
    return name == "pfa" and table.name.startswith("pd")


def rate_axis(axes, table: SummaryTable, name: str) -> None:
    """Small probabilities and shapes by their logarithm, and the rate that is set."""
    low, high = table[f"{name}_low"].values, table[f"{name}_high"].values
    there = np.concatenate([low, table[name].values, high])
    there = there[np.isfinite(there) & (there > 0.0)]
    if not there.size:
        return
    axes.set_yscale("log")
    least, most = there.min() / 1.5, there.max() * 1.5
    if name == "pfa" and "pfa_set" in table:
        wanted = table["pfa_set"].values[0]
        axes.axhline(wanted, color=style.GREY, lw=1.0, ls=":")
        axes.annotate("as it is set", (0.99, wanted), xycoords=("axes fraction", "data"),
                      ha="right", va="bottom", fontsize=8.5, color=style.NOTE)
        least, most = max(min(least, wanted / 3.0), wanted / 300.0), min(max(most, 3.0 * wanted), 1.0)
    if name == RARE:
        known = table["effective"].values >= WORTH if "effective" in table else table[name].values > 0.0
        found = table[name].values[known & (table[name].values > 0.0)]
        least, most = max(least, found.min(initial=most) / 30.0), min(most, 1.0)
    axes.set_ylim(least, most)


def drawn(table: SummaryTable) -> list:
    """Of varying(): as many as there are panels for, what was detected and where before details."""
    return sorted(varying(table), key=lambda n: n.startswith(DETAILS))[:MOST_PANELS]


def constants(table: SummaryTable) -> str:
    """Of what there is no panel: "false alarm is 0 everywhere"."""
    said = [f"{spoken(n)} is {table[n].values[np.isfinite(table[n].values)][0]:.3g} everywhere"
            for n in banded(table) if n not in varying(table)]
    return ", ".join(said[:3])


def title(table: SummaryTable, names: list) -> str:
    """What a table along inputs shows: "Probability of detection against range"."""
    every = len(varying(table))
    some = f", {len(names)} of {every} measures" if len(names) < every else ""
    alone = [n for n in names if not beside(table, n)] or names
    what = spoken(alone[0]) if alone[0].startswith(("pd", "pfa", "p_", "ptrack", RARE)) else "means"
    if table.name.startswith(ELLIPSES):
        what = "errors of place, and their ellipses"
    what += ", and the false-alarm rate," if len(alone) < len(names) else ""
    if table.name.startswith("cells"):
        return f"Cells without an echo: {' and '.join(CELL_WORDS.get(n, n) for n in names)} against time"
    along = " and ".join(spoken(n) for n in axes_of(table))
    return f"{what[0].upper()}{what[1:]} against {along}{some}"


def top(values) -> float:
    """Upper limit of an axis of probabilities: 1, or near what is there when that is tiny."""
    greatest = np.nanmax(values, initial=0.0)
    return 1.02 if greatest > 0.2 or greatest == 0.0 else 1.1 * greatest


def draw_by(study: Study) -> dict:
    """Probabilities and means along one input."""
    figures = {}
    for table in study.tables(lambda t: "_by_" in t.name and len(axes_of(t)) == 1):
        names = drawn(table)
        if not names:
            continue
        fig, axes = panels(study, title(table, names), len(names), 3.0)
        heading(axes[0], study, f"bands: {study.interval}" if not table[axes_of(table)[0]].labels
                else f"bars: {study.interval}")
        for k, (name, a) in enumerate(zip(names, axes)):
            band(a, table, axes_of(table)[0], name, style.colour(k + 1))
            orient(a.yaxis, table[name])
            a.set_ylabel(CELL_WORDS.get(name, table[name].label())
                         if table.name.startswith("cells") else table[name].label())
            if beside(table, name) or table.name.startswith(("cells", RARE)):
                rate_axis(a, table, name)
            elif table[name].values.size and not table.name.startswith(IN_UNITS):
                limit = top(table[f"{name}_high"].values)
                a.set_ylim(-0.02 * limit, limit)
        figures[table.name] = fig
    return figures


def bins(table: SummaryTable, column) -> np.ndarray:
    """Edges of the cells of a map along one of its inputs, as they are drawn: those of the bins, or
    half-way between values.
    """
    if f"{column.name}_low" in table:
        low, high = table[f"{column.name}_low"].values, table[f"{column.name}_high"].values
        return np.unique(np.concatenate([low, high])) * column.scale()
    return style.cell_edges(np.unique(column.values) * column.scale())


def name_ticks(column):
    """Where the values of a column of names are, and the names."""
    there = np.unique(column.values)
    names = [column.labels[int(k)] if 0 <= k < len(column.labels) else f"{k:g}" for k in there]
    return there, [style.shorten(n, 18) for n in names]


def numbers(axes, across, down, value, image, low, high, count) -> None:
    """Writes the value of each cell into it, if there is room; if there is more, its interval and how many it is of."""
    if value.shape[0] > 12 or value.shape[1] > 10:
        return
    roomy = value.shape[0] <= 8 and value.shape[1] <= 6

    def short(v):
        return f"{v:.2g}" if v < 0.1 else f"{v:.2f}"
    for (column, row), v in np.ndenumerate(value):
        if np.isfinite(v):
            middle = across[column:column + 2].mean(), down[row:row + 2].mean()
            text = short(v)
            if roomy:
                text += f"\n{short(low[column, row])} to {short(high[column, row])}\nof {count[column, row]:.0f}"
            axes.text(*middle, text, ha="center", va="center", fontsize=6.5 if roomy else 8, linespacing=1.1,
                      color=style.readable_on(image.to_rgba(v)))


def draw_map(study: Study) -> dict:
    """Probabilities over two inputs, as a map."""
    figures = {}
    for table in study.tables(lambda t: "_by_" in t.name and len(axes_of(t)) == 2):
        names = [n for n in drawn(table) if not beside(table, n)]
        x, y = (table[n] for n in axes_of(table))
        across, down = bins(table, x), bins(table, y)
        cells = (across.size - 1, down.size - 1)
        if not names or cells[0] * cells[1] != x.values.size:
            continue
        fig, axes = panels(study, title(table, names), len(names), 3.4)
        widest = max(float(np.nanmax(table[f"{n}_high"].values - table[f"{n}_low"].values))
                     for n in names) / 2.0
        heading(axes[0], study, f"each within {widest:.2g} or less ({study.interval})"
                if len(names) == 1 else "")
        for name, a in zip(names, axes):
            value = table[name].values.reshape(cells) * table[name].scale()
            probability = not table.name.startswith(IN_UNITS)
            limit = top(table[f"{name}_high"].values) if probability else None
            image = a.pcolormesh(across, down, value.T, cmap=style.MAP,
                                 vmin=0.0 if probability else None,
                                 vmax=min(limit, 1.0) if probability else None)
            for axis, column in ((a.xaxis, x), (a.yaxis, y)):
                if column.labels:
                    axis.set_ticks(*name_ticks(column))
            orient(a.yaxis, y)
            style.image_frame(a)
            a.set_xlabel(x.label())
            a.set_ylabel(y.label())
            fig.colorbar(image, ax=a, label=table[name].label())
            if probability and len(names) == 1:
                low, high, count = (table[n].values.reshape(cells) for n in (f"{name}_low", f"{name}_high", "count"))
                numbers(a, across, down, value, image, low, high, count)
        figures[table.name] = fig
    return figures


def in_metres(most: float):
    """→ scale and unit of places"""
    return (1e-3, "km") if most >= 3000.0 else (1.0, "m")


def draw_ellipses(study: Study) -> dict:
    """Errors of place on the plan about the array: of each bin the ellipse, about where its targets are found on the
    mean. Ellipses are larger than they are by a round factor where they would be dots.
    """
    figures = {}
    for table in study.tables(lambda t: t.name.startswith("ellipses") and "_by_" in t.name):
        east, north = table["target_east"].values, table["target_north"].values
        major, minor = table["major"].values, table["minor"].values
        good = np.isfinite(east) & np.isfinite(major)
        if not good.any():
            continue
        far = float(np.max(np.hypot(east[good], north[good]))) or 1.0
        typical = float(np.median(major[good])) or 1.0
        exact = 0.06 * far / typical
        larger = max(1.0, 10.0 ** np.floor(np.log10(exact)) * max(f for f in (1, 2, 5)
                     if f <= exact / 10.0 ** np.floor(np.log10(exact)))) if exact > 1.0 else 1.0
        scale, unit = in_metres(far)
        fig, axes = style.figure("Where targets are found: ellipses of errors of place", 8.2)
        turn = np.linspace(0.0, 2.0 * np.pi, 73)
        for row in np.flatnonzero(good):
            bearing = np.radians(table["axis_deg"].values[row])
            u, v = larger * major[row] * np.cos(turn), larger * minor[row] * np.sin(turn)
            off = larger * table["east_bias"].values[row], larger * table["north_bias"].values[row]
            x = east[row] + off[0] + u * np.sin(bearing) + v * np.cos(bearing)
            y = north[row] + off[1] + u * np.cos(bearing) - v * np.sin(bearing)
            axes.fill(scale * x, scale * y, color=style.colour(0), alpha=0.25, lw=0)
            axes.plot(scale * x, scale * y, color=style.colour(0), lw=1.2)
            axes.plot(scale * np.array([east[row], east[row] + off[0]]), scale * np.array([north[row], north[row] + off[1]]),
                      color=style.INK, lw=0.9)
            axes.plot(scale * east[row], scale * north[row], ls="none", marker="+", ms=6, color=style.INK)
            axes.annotate(f"{table['found'].values[row]:.0f}", (scale * x[y.argmax()], scale * y.max()), (0, 3),
                          textcoords="offset points", ha="center", fontsize=7.5, color=style.NOTE)
        axes.plot(0.0, 0.0, ls="none", marker="^", ms=8, color=style.INK)
        axes.set_aspect("equal", adjustable="datalim", anchor="W")
        axes.grid(True)
        axes.set_xlabel(f"east of the array / {unit}")
        axes.set_ylabel(f"north of the array / {unit}")
        drawn_so = f", ellipses and biases drawn {larger:g} times larger" if larger > 1.0 else ""
        heading(axes, study, f"mean errors and ellipses that hold the next one with {study.interval}; numbers: found "
                             f"targets{drawn_so}")
        style.legend_below(axes, [
            Line2D([], [], ls="none", marker="^", ms=8, color=style.INK, label="array"),
            Line2D([], [], ls="none", marker="+", ms=6, color=style.INK, label="mean place of a bin's targets"),
            Line2D([], [], color=style.INK, lw=0.9, label="to where they are found on the mean"),
            Line2D([], [], color=style.colour(0), lw=1.2, label="ellipse")])
        figures[f"{table.name}_plan"] = fig
    return figures


def tail_of(study: Study, suffix: str, least: float, most: float):
    """The ROC beyond the smallest probability that the realisations can tell, one in as many as
    there are: the largest tenth of the values without an echo, as powers, go on as the exponential
    law that noise has after a filter. → pfa, pd, or None where the table does not tell them
    """
    columns = {c.name: c.values for c in study.columns}
    absent, present = (columns.get(f"snr_{what}_db{suffix}") for what in ("absent", "matched"))
    if absent is None or present is None:
        return None
    absent = 10.0 ** (absent[np.isfinite(absent)] / 10.0)
    if absent.size < 100 or np.isnan(present).all():
        return None
    start = np.quantile(absent, 1.0 - TAIL)
    mean = np.mean(absent[absent > start] - start)
    pfa = np.geomspace(least, most, 40)
    threshold = 10.0 * np.log10(start + mean * np.log(TAIL / pfa))
    present = np.nan_to_num(present[~np.isnan(present)], neginf=-300.0)
    return pfa, np.mean(present[None, :] > threshold[:, None], axis=1)


def operating_point(study: Study, suffix: str):
    """Where the study's own threshold is: its false alarms, as asked for or, without that, as
    counted, and its detections with their interval. → pfa, pd, half the interval; None: not told
    """
    columns = {c.name: c.values for c in study.columns}
    hits = columns.get(f"detected{suffix}")
    false = columns.get(f"false_alarm{suffix}")
    pfa = study.false_alarms or (float(np.nanmean(false)) if false is not None else 0.0)
    if hits is None or not np.isfinite(hits).any() or not pfa > 0.0:
        return None
    hits = hits[np.isfinite(hits)]
    pd = float(hits.mean())
    from statistics import NormalDist
    level = study.confidence if np.isfinite(study.confidence) else 0.95
    z = NormalDist().inv_cdf(0.5 + 0.5 * level)
    return pfa, pd, z * np.sqrt(max(pd * (1.0 - pd), 1e-12) / hits.size)


def roc_of_cells(axes, study: Study, table: SummaryTable, shade: str, name: str) -> float:
    """The curve of all cells without an echo, with the intervals of both probabilities. → the least
    probability of false alarm
    """
    pfa, pd, tail = (table[n].values for n in ("pfa", "pd", "by_tail"))
    good = pfa > 0.0
    pfa, pd, tail = pfa[good], pd[good], tail[good] > 0.5
    bands = {n: table[n].values[good] for n in ("pfa_low", "pfa_high", "pd_low", "pd_high")}
    axes.fill_between(pfa, bands["pd_low"], bands["pd_high"], color=shade, alpha=0.2, lw=0)
    axes.fill_betweenx(pd, np.maximum(bands["pfa_low"], 1e-12), bands["pfa_high"], color=shade,
                       alpha=0.2, lw=0)
    counted = ~tail
    joined = tail | np.append(tail[1:], False) | np.insert(tail[:-1], 0, False)  # without a gap
    axes.plot(pfa[counted], pd[counted], color=shade,
              label=name or f"all cells without an echo, counted, {study.interval}")
    if tail.any():
        axes.plot(pfa[joined], pd[joined], color=shade, ls=(0, (4, 2)),
                  label=None if name else "by the tail that is fitted to them")
    return float(pfa.min(initial=1.0))


def draw_roc(study: Study) -> dict:
    """From the operating point's neighbourhood to 1: solid where false alarms were counted, dashed
    where their law goes on. Where all cells were counted, theirs instead of one a realisation.
    """
    tables = study.tables(lambda t: t.name.startswith("roc") and "pfa" in t and "pd" in t)
    of_cells = [t.name for t in tables if t.name.startswith(CELLS)]
    tables = [t for t in tables if CELLS + t.name[3:] not in of_cells]
    if not tables:
        return {}
    fig, axes = style.figure("Receiver operating characteristic", 4.9)
    least = 1.0
    guessed = False
    for k, table in enumerate(tables):
        cells = table.name in of_cells
        suffix = table.name[len(CELLS) if cells else 3:]
        shade = style.colour(k)
        pfa, pd = table["pfa"].values, table["pd"].values
        # of thresholds with as many false alarms the one that detects the most
        seen = (pfa > 0) & np.append(np.diff(pfa) > 0, True)
        counted = pfa[seen].min(initial=1.0)
        name = suffix[1:].replace("_", " ")
        if cells:
            least = min(least, roc_of_cells(axes, study, table, shade, name))
            point = operating_point(study, suffix)
            if point:
                axes.errorbar(*point, fmt="D", ms=6, color=shade, capsize=3, mec=style.PAPER,
                              mew=0.8, zorder=5, label=f"{name + ': ' if name else ''}operating "
                              f"point, P_fa {point[0]:.2g}, P_d {point[1]:.3f}".replace("_", ""))
            continue
        axes.fill_between(pfa[seen], table["pd_low"].values[seen], table["pd_high"].values[seen],
                          color=shade, alpha=0.2, lw=0)
        axes.plot(pfa[seen], pd[seen], color=shade,
                  label=name or f"as counted, with {study.interval}")
        point = operating_point(study, suffix)
        wanted = min(counted, point[0] / 3.0) if point else counted
        least = min(least, wanted)
        further = tail_of(study, suffix, wanted, counted) if wanted < counted else None
        if further:
            guessed = True
            axes.plot(*further, color=shade, ls=(0, (4, 2)),
                      label=None if name else "fewer false alarms than one in all realisations: "
                                              "exponential law")
        if point:
            axes.errorbar(point[0], point[1], point[2], fmt="D", ms=6, color=shade, capsize=3,
                          mec=style.PAPER, mew=0.8, zorder=5,
                          label=f"{name + ': ' if name else ''}operating point, "
                                f"P_fa {point[0]:.2g}, P_d {point[1]:.3f}".replace("_", ""))
    chance = np.geomspace(max(least, 1e-9), 1.0, 50)
    axes.plot(chance, chance, color=style.GREY, lw=0.8, ls=":", label="by chance")
    axes.set_xscale("log")
    axes.set_xlim(chance[0], 1.0)
    axes.set_ylim(0.0, 1.02)
    axes.set_xlabel("probability of false alarm")
    axes.set_ylabel("probability of detection")
    axes.grid(True)
    style.subtitle(axes, f"{study.heading()} · bands and bars: {study.interval}"
                   + (" · dashed: exponential law" if guessed and len(tables) > 1 else ""))
    style.legend_below(axes, ncol=2)
    return {"roc": fig}


def draw_expected(a, edges, law, rows, scale=1.0):
    """The numbers of rows that a law gives to the bins of a histogram."""
    a.stairs(rows * law.expected(np.asarray(edges) / scale), edges, color="black", linewidth=1.0)


def draw_histograms(study: Study) -> dict:
    columns = [c for c in study.columns if not c.is_constant() and c.role != "ping"]
    all_of_them = len(columns)
    columns = sorted(columns, key=lambda c: c.role != "measure")[:MOST_PANELS]
    if not columns:
        return {}
    some = f", {len(columns)} of {all_of_them} columns" if len(columns) < all_of_them else ""
    lines = ", their laws (black)" if any(c.name in study.laws for c in columns) else ""
    fig, axes = panels(study, f"Inputs as they were drawn (grey){lines} and measures (blue)" + some,
                       len(columns))
    heading(axes[0], study, "rows as they were drawn, not weighed" if study.weights is not None else "")
    for column, a in zip(columns, axes):
        values = column.values[np.isfinite(column.values)] * column.scale()
        law = study.laws.get(column.name)
        colour = style.BLUE if column.role == "measure" else style.GREY
        different = np.unique(values).size
        yes_or_no = (column.event or column.name.startswith(YES_OR_NO)) and set(values) <= {0.0, 1.0}
        if column.labels:
            count = np.bincount(values.astype(int), minlength=len(column.labels))
            a.bar(np.arange(count.size), count, color=colour)
            names = [style.shorten(n, 14) for n in column.labels]
            a.set_xticks(np.arange(len(names)), names, rotation=20 if len(names) > 3 else 0)
            if law is not None:
                draw_expected(a, np.arange(count.size + 1) - 0.5, law, values.size)
        elif yes_or_no or different <= min(12, values.size // 4):  # a number of phones, say
            there, count = np.unique(values, return_counts=True)
            a.bar(np.arange(there.size), count, width=0.7, color=colour)
            a.set_xticks(np.arange(there.size),
                         [("no", "yes")[int(v)] if yes_or_no else f"{v:.6g}" for v in there])
            if there.size < 3:
                a.set_xlim(-0.75, there.size - 0.25)
        else:
            edges = a.hist(values, bins=min(60, max(8, int(np.sqrt(values.size)))), color=colour)[1]
            if law is not None:
                draw_expected(a, edges, law, values.size, column.scale())
        a.set_xlabel(column.label())
        a.set_ylabel("realisations")
    return {"histograms": fig}


def bars(axes, table: SummaryTable, rows, name: str, at, colour: str, height: float, label=None):
    """Shares of the variance as bars with their intervals; what falls below 0 by chance as 0."""
    value = np.maximum(table[name].values[rows], 0.0)
    low, high = table[f"{name}_low"].values[rows], table[f"{name}_high"].values[rows]
    axes.barh(at, value, height, color=colour, label=label)
    ends = [value - np.clip(low, 0.0, value), np.maximum(high - value, 0.0)]
    axes.errorbar(value, at, xerr=np.nan_to_num(ends), fmt="none", ecolor=style.INK, capsize=2.0,
                  lw=0.9)


def bar_panels(study: Study, table: SummaryTable, title: str, column: str, most: int,
               least: float = -np.inf):
    """A panel for each measure that has shares which may reach `least`. → figure, and of each panel
    axes and rows, most first
    """
    of, shown = table["measure"], []
    for k in range(len(of.labels)):
        seen = np.isfinite(table[column].values) & (table[f"{column}_high"].values >= least)
        rows = np.flatnonzero((of.values == k) & seen)
        if rows.size and np.any(table[column].values[rows] != 0.0):
            shown.append((k, rows[np.argsort(-table[column].values[rows], kind="stable")][:most]))
    every, shown = len(shown), shown[:MOST_PANELS]
    if not shown:
        return None, []
    some = f", {len(shown)} of {every} measures" if len(shown) < every else ""
    tallest = max(rows.size for _, rows in shown)
    fig, axes = panels(study, title + some, len(shown), height=1.1 + 0.36 * tallest)
    for a, (k, rows) in zip(axes, shown):
        a.set_xlim(0.0, 1.05)
        a.set_ylim(rows.size - 0.4, -0.6)
        a.set_xlabel(f"share of the variance of\n{spoken(of.labels[k])}")
        a.grid(True, axis="x")
        over = np.max(table[f"{column}_high"].values[rows], initial=0.0)
        if over > 1.05:
            a.set_xlim(0.0, min(2.0, 1.05 * over))
    return fig, [(a, rows) for a, (_, rows) in zip(axes, shown)]


def draw_orders(study: Study, table: SummaryTable) -> dict:
    """First and total order of every input beside each other, with their intervals."""
    fig, shown = bar_panels(study, table, "Which input matters: alone, and with the others",
                            "total_order", 12)
    if fig is None:
        return {}
    inputs = table["input"]
    for a, rows in shown:
        at = np.arange(rows.size)
        bars(a, table, rows, "first_order", at - 0.2, style.BLUE, 0.36, "alone (first order)")
        bars(a, table, rows, "total_order", at + 0.2, style.ORANGE, 0.36, "in all (total order)")
        a.set_yticks(at, [style.shorten(spoken(inputs.labels[int(k)]), 18)
                          for k in inputs.values[rows]])
        left = table["unexplained"].values[rows[0]]
        if np.isfinite(left):
            a.set_xlabel(f"{a.get_xlabel()} (of no input alone: {max(0.0, left):.2f})")
    style.legend_below(shown[-1 - (len(shown) - 1) % columns_of(len(shown))][0], points=52.0, ncol=2)
    heading(shown[0][0], study, f"bars: {study.interval}, "
                                f"{int(np.max(table['count'].values))} blocks")
    return {"sensitivity": fig}


def draw_interactions(study: Study) -> dict:
    """What pairs of inputs do together, the ten that do most."""
    tables = study.tables(lambda t: t.name == "interactions" and "second_order" in t)
    if not tables or not tables[0]["input"].labels:
        return {}
    table = tables[0]
    fig, shown = bar_panels(study, table, "Which inputs act together", "second_order", 10, 0.01)
    if fig is None:
        return {}
    one, other = table["input"], table["with"]
    for a, rows in shown:
        bars(a, table, rows, "second_order", np.arange(rows.size), style.BLUE, 0.6)
        a.set_yticks(np.arange(rows.size),
                     [f"{style.shorten(spoken(one.labels[int(i)]), 12)} × "
                      f"{style.shorten(spoken(other.labels[int(j)]), 12)}"
                      for i, j in zip(one.values[rows], other.values[rows])])
    heading(shown[0][0], study, f"bars: {study.interval}, second order")
    return {"interactions": fig}


def unexplained(table: SummaryTable, measure: int) -> str:
    """Beside a measure's name, where first orders leave much of its variance out."""
    if "unexplained" not in table:
        return ""
    left = table["unexplained"].values[table["measure"].values == measure]
    much = left.size and np.isfinite(left[0]) and left[0] > 0.3
    return f"\n({left[0]:.2f} of no input alone)" if much else ""


def draw_sensitivity(study: Study) -> dict:
    tables = study.tables(lambda t: t.name == "sensitivity" and "first_order" in t)
    if not tables:
        return {}
    table = tables[0]
    if "total_order" in table and table["measure"].labels and table["input"].labels:
        return draw_orders(study, table)
    measures, inputs = table["measure"], table["input"]
    if not measures.labels or not inputs.labels:
        return {}
    constant = [k for k, name in enumerate(measures.labels) for c in study.columns
                if c.name == name and np.unique(c.values[np.isfinite(c.values)]).size < 2]
    shown = [k for k in range(len(measures.labels)) if k not in constant]
    if not shown:
        return {}
    height = max(3.9, 1.8 + 0.45 * len(shown))
    if len(inputs.labels) > MOST_BESIDE:  # one above the other: there would be no room for numbers
        fig, axes = style.figure("Which input matters", 1.8 * height, nrows=2, sharex=True)
    else:
        fig, axes = style.figure("Which input matters", height, ncols=2, sharey=True)
    for a, name, title, low in ((axes[0], "first_order", "share of the variance", 0.0),
                                (axes[1], "rank_correlation", "rank correlation", -1.0)):
        grid = np.full((len(measures.labels), len(inputs.labels)), np.nan)
        grid[measures.values.astype(int), inputs.values.astype(int)] = table[name].values
        grid = np.maximum(grid[shown], low)  # an estimate of no share falls below 0 by chance
        image = a.imshow(grid, cmap=style.DIVERGING if low < 0 else style.MAP, vmin=low, vmax=1.0,
                         aspect="auto")
        for side in a.spines.values():
            side.set_visible(True)
        for (row, column), value in np.ndenumerate(grid):
            if not np.isfinite(value):  # of names without an order
                a.text(column, row, "–", ha="center", va="center", fontsize=8, color=style.GREY)
            else:
                words = f"{round(value, 2) + 0.0:.2f}".replace("-", "−")  # never −0.00
                a.text(column, row, words, ha="center", va="center", fontsize=8,
                       color=style.readable_on(image.to_rgba(value)))
        a.set_xticks(np.arange(len(inputs.labels)), [spoken(n) for n in inputs.labels],
                     rotation=25, ha="right")
        a.set_yticks(np.arange(len(shown)), [spoken(measures.labels[k]) + unexplained(table, k)
                                             for k in shown])
        a.set_xlabel(title)
        fig.colorbar(image, ax=a, pad=0.02, aspect=30)
    told = [spoken(measures.labels[k]) for k in constant]
    heading(axes[0], study, f"constant, and left out: {', '.join(told)}" if told else "")
    return {"sensitivity": fig}


def draw_convergence(study: Study) -> dict:
    tables = study.tables(lambda t: t.name == "convergence" and banded(t))
    if not tables:
        return {}
    table = tables[0]
    name = banded(table)[0]
    fig, axes = style.figure("How the estimate settles")
    band(axes, table, "count", name, style.BLUE)
    axes.axhline(table[name].values[-1] * table[name].scale(), color=style.GREY, lw=0.8, ls="--", label="all of them")
    axes.set_xscale("log")
    axes.set_xlabel("realisations")
    axes.set_ylabel(table[name].label())
    if name == RARE:
        rate_axis(axes, table, name)
    how = f", {table.method}" if table.method else ""
    style.subtitle(axes, f"{study.heading()} · band: {study.interval}{how}")
    return {"convergence": fig}


def draw_places(study: Study) -> dict:
    from . import study_places
    return study_places.draw(study)


def draw_pings(study: Study) -> dict:
    from . import study_pings
    return study_pings.draw(study)


ALL = (draw_by, draw_map, draw_places, draw_pings, draw_ellipses, draw_roc, draw_histograms, draw_sensitivity, draw_interactions,
       draw_convergence)


def draw(study: Study, only=None):
    """→ (name, figure) of every picture, one at a time. \\param only  names, if not all"""
    for one in ALL:
        if only is not None and not any(n in only for n in names_of(study, one)):
            continue
        with style.look():
            made = one(study)
        for name, figure in made.items():
            if only is None or name in only:
                yield name, figure


def names_of(study: Study, one) -> list:
    """What a function of ALL may draw."""
    if one in (draw_by, draw_map):
        return [t.name for t in study.summary if "_by_" in t.name]
    if one is draw_ellipses:
        return [f"{t.name}_plan" for t in study.summary if t.name.startswith("ellipses") and "_by_" in t.name]
    if one in (draw_places, draw_pings):
        from . import study_pings, study_places
        return (study_places if one is draw_places else study_pings).names_of(study)
    return [{draw_roc: "roc", draw_histograms: "histograms", draw_sensitivity: "sensitivity",
             draw_interactions: "interactions", draw_convergence: "convergence"}[one]]


def left_out(study: Study) -> dict:
    """Name and reason of what would be drawn if it changed."""
    return {t.name: constants(t) for t in study.summary
            if "_by_" in t.name and banded(t) and not varying(t)}

"""Pictures of a run of pings of a study (`[measure] pings`, docs/formats/study.md)."""
from __future__ import annotations

import numpy as np

from . import style
from .study_data import Study, SummaryTable
from .study_pictures import band, heading

HEAD = "pings"


def tables(study: Study) -> list:
    return study.tables(lambda t: t.name.startswith(HEAD) and "pd_ever" in t)


def names_of(study: Study) -> list:
    return [t.name for t in tables(study)]


def draw_one(study: Study, table: SummaryTable):
    fig, axes = style.figure("Detection over several pings", 4.6, ncols=2)
    never = 1.0 - table["pd_ever"].values[-1]
    least, most = int(table["count"].values.min()), int(table["count"].values.max())
    known = "" if least == most else f", {least} to {most} of them known"
    heading(axes[0], study, f"bands: {study.interval}{known}")
    shown = [("pd", style.GREY, "in this ping"), ("pd_ever", style.BLUE, "in this one or before")]
    if "ptrack" in table:
        shown.append(("ptrack", style.ORANGE, "a track has begun"))
    for name, shade, words in shown:
        band(axes[0], table, "ping", name, shade, words)
    axes[0].plot(table["ping"].values, table["pd_ever_independent"].values, color=style.BLUE, ls=(0, (4, 2)), lw=1.0,
                 label="or before, were pings independent")
    ends = [f"{name}_high" for name, _, _ in shown] + ["pd_ever_independent"]
    top = max(float(np.nanmax(table[end].values)) for end in ends)
    top = 1.0 if top > 0.3 else top  # of rare events not a line along the bottom
    axes[0].set_ylim(-0.02 * top, 1.02 * top)
    axes[0].set_ylabel("probability of detection")
    axes[0].set_xlabel("ping")
    axes[0].xaxis.set_major_locator(style.ticker.MaxNLocator(8, integer=True, steps=[1, 2, 5, 10], min_n_ticks=1))
    style.legend_below(axes[0], ncol=2)
    at = table["ping"].values
    axes[1].bar(at, table["first"].values, width=0.75, color=style.BLUE)
    axes[1].bar([at[-1] + 2], [never], width=0.75, color=style.GREY)
    step = max(1, -(-at.size // 8))
    axes[1].set_xticks(np.append(at[::step], at[-1] + 2), [f"{n:.0f}" for n in at[::step]] + ["never"])
    axes[1].set_xlabel(f"ping that detects it first ({table['time'].values[-1]:.4g} s from first to last)")
    axes[1].set_ylabel("share of the realisations")
    for a in axes:
        a.grid(True)
    far = axes[1].twinx()
    far.plot(at, table["range"].values * table["range"].scale(), "-", color=style.ORANGE, lw=1.4)
    far.set_ylabel(("mean range / km" if table["range"].scale() != 1.0 else "mean range / m"), color=style.ORANGE)
    far.spines["right"].set_visible(True)
    far.grid(False)
    return fig


def draw(study: Study) -> dict:
    return {t.name: draw_one(study, t) for t in tables(study)}

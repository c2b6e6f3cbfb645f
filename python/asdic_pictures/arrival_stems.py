"""Arrivals as stems: level over time at some receivers, and the delays at all of them."""
from __future__ import annotations

import numpy as np
from matplotlib.lines import Line2D

from . import sea, style

TITLE = "Arrivals"
BELOW_STRONGEST = 60.0      # weaker ones are not drawn [dB]
MOST_PANELS = 3


def nothing_to_show(arrivals) -> str | None:
    return None if arrivals.receivers else "nothing arrives anywhere"


def chosen(receivers, most: int = MOST_PANELS):
    """A few receivers, evenly out of all, the first and last among them."""
    if len(receivers) <= most:
        return list(range(len(receivers)))
    return sorted({int(round(x)) for x in np.linspace(0, len(receivers) - 1, most)})


def strong(receiver):
    return receiver.level >= receiver.level.max() - BELOW_STRONGEST


def stems(axes, receiver, floor: float, sign: float = 1.0) -> None:
    """A line from the floor to each arrival's level, in the colour of what it met."""
    keep = strong(receiver)
    met = np.array([sea.history(s, b) for s, b in zip(receiver.surface, receiver.bottom)], int)
    for k in range(len(sea.HISTORIES)):
        colour = sea.shade(k)
        mine = keep & (met == k)
        height = sign * (receiver.level[mine] - floor)
        axes.vlines(receiver.delay[mine], 0.0, height, color=colour, lw=1.2, zorder=3)
        axes.plot(receiver.delay[mine], height, ls="none", marker="o", ms=4, color=colour, zorder=4)


def level_axis(axes, floor: float, top: float, mirrored: bool = False) -> None:
    """Levels on an axis of heights above the floor."""
    span = 1.06 * (top - floor)
    axes.set_ylim(-span if mirrored else 0.0, span)
    ticks = np.arange(0.0, top - floor + 1e-9, 20.0 if top - floor > 35.0 else 10.0)
    both = np.concatenate([-ticks[:0:-1], ticks]) if mirrored else ticks
    axes.set_yticks(both)
    axes.set_yticklabels([f"{floor + abs(t):g}".replace("-", "−") for t in both])
    axes.set_ylabel("level re 1 m / dB")
    axes.grid(True)


def bounds(*receivers):
    """Floor and top of the level axis [dB], first and last delay [s]."""
    level = np.concatenate([r.level[strong(r)] for r in receivers])
    delay = np.concatenate([r.delay[strong(r)] for r in receivers])
    top = 5.0 * np.ceil(level.max() / 5.0)
    floor = max(10.0 * np.floor((level.min() - 3.0) / 10.0), top - BELOW_STRONGEST - 10.0)
    room = max(0.03 * np.ptp(delay), 1e-3)
    return floor, top, delay.min() - room, delay.max() + room


def history_handles(*receivers):
    met = {sea.history(s, b) for r in receivers for s, b in zip(r.surface, r.bottom)}
    return [Line2D([], [], color=sea.shade(k), lw=1.8, label=sea.met(k))
            for k in range(len(sea.HISTORIES)) if k in met]


@style.picture
def draw(arrivals, axes=None, limits=None):
    panels = chosen(arrivals.receivers)
    fig, rows = style.figure(TITLE, 1.6 + 2.2 * len(panels), axes, nrows=len(panels), squeeze=False)
    for axes, i in zip(rows[:, 0], panels):
        receiver = arrivals.receivers[i]
        floor, top, first, last = bounds(receiver)
        floor, top = limits or (floor, top)
        stems(axes, receiver, floor)
        level_axis(axes, floor, top)
        axes.set_xlim(first, last)
        style.subtitle(axes, f"{receiver.label}: {receiver.delay.size} arrivals")
    rows[-1, 0].set_xlabel("delay / s")
    more = len(arrivals.receivers) - len(panels)
    told = [style.plain(arrivals.title)] if arrivals.title else []
    told += [f"{arrivals.frequency:g} Hz"] if np.isfinite(arrivals.frequency) else []
    told += [f"{more} more receivers"] if more > 0 else []
    style.title(fig, TITLE + (": " if told else "") + ", ".join(told))
    style.legend_below(rows[-1, 0], history_handles(*[arrivals.receivers[i] for i in panels]))
    return fig

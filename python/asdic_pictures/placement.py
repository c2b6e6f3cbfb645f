"""Where sensors are best put (docs/formats/placement.md): a plan with what the best set detects, how much each
sensor more brings, and how sure the choice is."""
from __future__ import annotations

from dataclasses import dataclass, field

import h5py
import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from . import results, source, style
from .data import InputError

KIND = "asdic placement"
PICTURES = {"placement": "Best places, and what they detect", "candidates": "What each candidate detects by itself",
            "sensors": "What each sensor more detects", "draws": "Best set and runner-up, draw by draw"}
ALL = tuple(PICTURES)
MARKERS = ("^", "s", "D", "v", "P", "X")     # of options


@dataclass
class Placement:
    path: str
    title: str
    place: np.ndarray           # [p, 2] east, north [m]
    refused: np.ndarray         # [p] 0: a sensor may be there
    options: list               # names
    candidates: np.ndarray      # [c, 2] place, option
    alone: np.ndarray           # [c] share that each detects
    best: np.ndarray            # [s, 2] place, option
    other: np.ndarray           # [s, 2] of the runner-up
    without: np.ndarray         # [s] share
    depth: np.ndarray           # [d] [m]
    cell: np.ndarray            # [k, 2] [m]
    size: float                 # of a cell [m]; 0: they are points
    detection: np.ndarray       # [d, k]
    floor: np.ndarray           # [k] [m]
    greedy: np.ndarray          # [s] share of so many sensors
    shares: np.ndarray          # [draws]
    other_shares: np.ndarray    # [draws], or none
    numbers: dict               # attributes that are numbers
    tags: dict = field(default_factory=dict)
    earth: tuple | None = None  # latitude and longitude of the cells [°]

    def number(self, name: str) -> float:
        return float(self.numbers.get(name, np.nan))

    def about(self) -> str:
        n = int(self.number("sensors"))
        text = f"{n} {'sensor' if n == 1 else 'sensors'}"
        if self.number("multistatic"):
            text += ", each hears the pings of all"
        if self.number("at_least") > 1:
            text += f", {int(self.number('at_least'))} detections count as one"
        return f"{self.title or self.path}  ·  {text}"


def read(path) -> Placement:
    """Of a file or a dataset. Raises InputError."""
    if isinstance(path, Placement):
        return path
    name = source.name_of(path)
    try:
        with (source.of_dataset(path) if source.is_dataset(path) else h5py.File(path, "r")) as f:
            def values(key):
                return np.asarray(f[key][()], float)

            def pair(thing):
                return np.stack([values(f"{thing}_place"), values(f"{thing}_option")], -1).astype(int)

            def at(thing):
                return np.stack([values(f"{thing}_east"), values(f"{thing}_north")], -1)

            numbers = {}
            for key, value in f.attrs.items():
                if np.issubdtype(np.asarray(value).dtype, np.number):
                    numbers[key] = float(np.ravel(value)[0])
            options = [results.text({"n": n}, "n") for n in np.ravel(f.attrs["options"])]
            size = float(np.ravel(f["cell"].attrs.get("size_m", 0.0))[0])
            earth = None
            if "cell_latitude" in f and "cell_longitude" in f:
                earth = (values("cell_latitude"), values("cell_longitude"))
            found = Placement(
                str(name), results.text(f.attrs, "title"), at("place"), values("place_refused").astype(int), options,
                pair("candidate"), values("candidate_share"), pair("sensor"), pair("other"),
                values("share_without"), values("depth"), at("cell"), size, values("detection_probability"),
                values("bottom_depth"), values("greedy_share"), values("share"),
                values("other_share") if "other_share" in f else np.zeros(0), numbers,
                dict(title=results.text(f.attrs, "title"), version=results.text(f.attrs, "program_version")), earth)
    except (KeyError, OSError, ValueError) as error:
        raise InputError(str(name), f"what cannot be read ({error})", "a whole file of `asdic place`") from error
    inside = [found.best[:, 0], found.other[:, 0], found.candidates[:, 0]]
    if found.detection.shape != (found.depth.size, len(found.cell)) or any(
            i.size and not (0 <= i.min() and i.max() < len(found.place)) for i in inside):
        raise InputError(str(name), "datasets that do not fit together", "a whole file of `asdic place`")
    return found


def nothing_to_show(found: Placement, name: str) -> str | None:
    if name == "sensors" and found.greedy.size < 2:
        return "there is one sensor"
    if name == "draws" and (found.number("judging_draws") < 2 or not found.other_shares.size):
        return "nothing was drawn"
    return None


def marker(option: int) -> str:
    return MARKERS[option % len(MARKERS)]


def limits(found: Placement):
    """Of both axes [km], with everything in them; none is more than three times as long as the other."""
    half = 0.5 * max(found.size, 0.0)
    points = np.concatenate([found.cell - half, found.cell + half, found.place]) / 1e3
    low, high = points.min(0), points.max(0)
    longest = max(float(np.max(high - low)), 1e-3)
    side = 0.5 * np.maximum(high - low, longest / 3.0) + 0.03 * longest
    middle = 0.5 * (low + high)
    return (middle[0] - side[0], middle[0] + side[0]), (middle[1] - side[1], middle[1] + side[1])


def height(found: Placement, width: float) -> float:
    """Of axes that are so wide [inch]"""
    across, up = limits(found)
    return width * (up[1] - up[0]) / (across[1] - across[0])


def grid(found: Placement):
    """Edges of the cells and where each is in a raster: (x, y, rows, columns); none where they are points."""
    if found.size <= 0.0:
        return None
    low = found.cell.min(0)
    at = np.rint((found.cell - low) / found.size).astype(int)
    shape = at.max(0) + 1
    if shape[0] * shape[1] > 4_000_000:
        return None
    edges = [(low[i] + (np.arange(shape[i] + 1) - 0.5) * found.size) / 1e3 for i in (0, 1)]
    return edges[0], edges[1], at[:, 1], at[:, 0]


def raster(values, where):
    x, y, rows, columns = where
    made = np.full((y.size - 1, x.size - 1), np.nan)
    made[rows, columns] = values
    return made


def frame(axes, found: Placement) -> None:
    style.image_frame(axes)
    axes.set_facecolor(style.PAPER)
    axes.set_aspect("equal", anchor="W")
    across, up = limits(found)
    axes.set_xlim(*across)
    axes.set_ylim(*up)
    axes.set_xlabel("east / km")
    axes.set_ylabel("north / km")
    if found.earth is None or np.isfinite(found.earth[0]).sum() < 10:
        return
    x, y = (found.cell / 1e3).T
    latitude, longitude = found.earth
    good = np.isfinite(latitude) & np.isfinite(longitude)
    fit = [np.linalg.lstsq(np.stack([x**0, x, y, x * y], 1)[good], v[good], rcond=None)[0]
           for v in (longitude, latitude)]
    ends_x, ends_y = np.array(across), np.array(up)
    style.degree_ticks(axes, ends_x, fit[0][0] + fit[0][1] * ends_x + fit[0][2] * up[0] + fit[0][3] * ends_x * up[0],
                       ends_y, fit[1][0] + fit[1][2] * ends_y + fit[1][1] * across[0] + fit[1][3] * ends_y * across[0])


def floor_lines(axes, found: Placement) -> list:
    where = grid(found)
    if where is None:
        return []
    depth = raster(found.floor, where)
    if min(depth.shape) < 2:
        return []
    x, y = (0.5 * (e[1:] + e[:-1]) for e in where[:2])
    return style.depth_lines(axes, x, y, depth, style.depth_levels(depth))


def places(axes, found: Placement) -> list:
    """Where a sensor may be, and where it may not. → handles"""
    handles = []
    for chosen, look, label in ((found.refused == 0, dict(marker="o", ms=3.0, mfc=style.PAPER, mec=style.INK, mew=0.7),
                                 "place where a sensor may be"),
                                (found.refused == 1, dict(marker="x", ms=4.0, mec=style.INK, mew=0.9),
                                 "too shallow for a sensor"),
                                (found.refused == 2, dict(marker="+", ms=5.0, mec=style.INK, mew=0.9),
                                 "place beyond the map")):
        if chosen.any():
            axes.plot(*(found.place[chosen] / 1e3).T, ls="none", zorder=5, **look)
            handles.append(Line2D([], [], ls="none", label=label, **look))
    return handles


def sensors(axes, found: Placement) -> list:
    """The best set, numbered, and the runner-up. → handles"""
    handles = []
    for set_, size, face, edge, label in ((found.other, 15, "none", style.INK, "runner-up"),
                                          (found.best, 9, style.INK, style.PAPER, "best set")):
        for number, (place, option) in enumerate(set_):
            at = found.place[place] / 1e3
            axes.plot(*at, ls="none", marker=marker(option), ms=size, mfc=face, mec=edge, mew=1.2,
                      zorder=8 if face != "none" else 7)
            if face != "none":
                axes.annotate(f"{number + 1}", at, (7, 7), textcoords="offset points", fontsize=9, fontweight="bold",
                              color=style.INK, zorder=9, path_effects=list(style.OVER_MAP))
        used = sorted({int(o) for o in set_[:, 1]})
        for option in used:
            said = f"{label}: {found.options[option]}" if len(found.options) > 1 else label
            handles.append(Line2D([], [], ls="none", marker=marker(option), ms=min(size, 11), mfc=face, mec=edge
                                  if face == "none" else style.PAPER, mew=1.2, label=style.shorten(said, 40)))
    return handles


def answer(found: Placement) -> str:
    text = f"{100.0 * found.shares.mean():.3g} % detected"
    if found.number("judging_draws") >= 2:
        apart = ("it and the runner-up can be told apart" if found.number("told_apart") else
                 "it and the runner-up cannot be told apart")
        return f"{text}, {100.0 * found.shares.std(ddof=1):.2g} % from draw to draw; {apart}"
    return text


def draw_plan(found: Placement, layer: int, axes=None):
    fig, axes = style.figure(PICTURES["placement"], float(np.clip(1.9 + height(found, 7.6), 4.4, 12.5)), axes)
    values = found.detection[layer]
    where = grid(found)
    handles = []
    if where is not None:
        mesh = axes.pcolormesh(where[0], where[1], raster(values, where), cmap=style.MAP, vmin=0.0, vmax=1.0, zorder=1,
                               rasterized=True)
        gone = np.isnan(values)
        if gone.any():
            axes.pcolormesh(where[0], where[1], raster(np.where(gone, 1.0, np.nan), where),
                            cmap=style.flat_map(style.GROUND), vmin=0.0, vmax=1.0, zorder=1, rasterized=True)
            handles.append(Patch(fc=style.GROUND, ec=style.GREY, label="does not count: weight 0, or no water there"))
    else:
        mesh = axes.scatter(*(found.cell / 1e3).T, c=values, cmap=style.MAP, vmin=0.0, vmax=1.0, s=28, zorder=1,
                            edgecolors=style.GREY, linewidths=0.4)
    frame(axes, found)
    handles += floor_lines(axes, found) + places(axes, found) + sensors(axes, found)
    style.colour_bar(fig, mesh, axes, "probability of detection", "neither")
    depth = f"  ·  target at {found.depth[layer]:g} m"
    style.subtitle(axes, f"{found.about()}{depth}  ·  {answer(found)}")
    style.legend_below(axes, handles, ncol=3)
    return fig


def draw_candidates(found: Placement, axes=None):
    count = len(found.options)
    columns = min(count, 3)
    rows = -(-count // columns)
    fig, panels = style.figure(PICTURES["candidates"], 1.2 + rows * float(np.clip(0.8 + height(found, 7.6 / columns), 1.6, 9.0)),
                               axes, rows, columns, squeeze=False)
    top = float(np.max(found.alone, initial=1e-6))
    flat = panels.ravel()
    for option, panel in enumerate(flat[:count]):
        own = found.candidates[:, 1] == option
        at = found.place[found.candidates[own, 0]] / 1e3
        mesh = panel.scatter(*at.T, c=found.alone[own], cmap=style.MAP, vmin=0.0, vmax=top, s=70, marker="s",
                             edgecolors=style.GREY, linewidths=0.5, zorder=4)
        frame(panel, found)
        if count > 1:
            panel.set_title(style.shorten(style.plain(found.options[option]), 40), fontsize=9.5)
        chosen = found.best[found.best[:, 1] == option, 0]
        panel.plot(*(found.place[chosen] / 1e3).T, ls="none", marker="o", ms=13, mfc="none", mec=style.INK, mew=1.4,
                   zorder=6)
    for panel in flat[count:]:
        panel.remove()
    style.colour_bar(fig, mesh, list(flat[:count]), "share of the weight that it detects alone", "neither")
    if count == 1:
        style.subtitle(flat[0], found.about())
    style.legend_below(flat[0], [Line2D([], [], ls="none", marker="o", ms=11, mfc="none", mec=style.INK, mew=1.4,
                                        label="in the best set")])
    return fig


def draw_sensors(found: Placement, axes=None):
    fig, axes = style.figure(PICTURES["sensors"], 4.8, axes)
    count = np.arange(1, found.greedy.size + 1)
    axes.plot(count, found.greedy, "-o", ms=4.5, color=style.colour(0), label="greedy choice")
    best, bound = found.number("share_of_choosing_draws"), found.number("upper_bound")
    axes.plot([count[-1]], [best], ls="none", marker="*", ms=13, color=style.colour(1), label="best set", zorder=5)
    if not found.number("proved"):
        axes.plot([count[-1]], [bound], ls="none", marker="_", ms=16, mew=2.0, color=style.INK,
                  label="no set is better than that")
    axes.set_xticks(count)
    axes.set_ylim(0.0, min(1.0, 1.08 * max(best, found.greedy.max(), 0.0 if found.number("proved") else bound)) or 1.0)
    axes.set_xlabel("sensors")
    axes.set_ylabel("share of the weight that is detected")
    axes.grid(True)
    style.subtitle(axes, found.about())
    style.legend_below(axes)
    return fig


def draw_draws(found: Placement, axes=None):
    fig, axes = style.figure(PICTURES["draws"], 6.2, axes)
    x, y = found.other_shares, found.shares
    low, high = min(x.min(), y.min()), max(x.max(), y.max())
    room = 0.06 * max(high - low, 1e-4)
    ends = np.array([low - room, high + room])
    axes.plot(ends, ends, color=style.GREY, lw=1.0, ls="--", label="both alike")
    axes.plot(x, y, ls="none", marker="o", ms=5, mec=style.PAPER, mew=0.6, color=style.colour(0), label="a draw")
    axes.set_xlim(*ends)
    axes.set_ylim(*ends)
    axes.set_aspect("equal", anchor="W")
    axes.set_xlabel("share that the runner-up detects")
    axes.set_ylabel("share that the best set detects")
    axes.grid(True)
    words = (f"best less runner-up {100.0 * found.number('difference'):.3g} % "
             f"({100.0 * found.number('difference_low'):.3g} to {100.0 * found.number('difference_high'):.3g} % at "
             f"{100.0 * found.number('confidence'):.4g} % confidence)")
    style.subtitle(axes, f"{found.about()}  ·  {words}: "
                         + ("told apart" if found.number("told_apart") else "cannot be told apart"))
    style.legend_below(axes)
    return fig


@style.picture
def draw(found: Placement, name: str, layer: int = 0, axes=None):
    if name == "candidates":
        return draw_candidates(found, axes)
    if name == "sensors":
        return draw_sensors(found, axes)
    if name == "draws":
        return draw_draws(found, axes)
    return draw_plan(found, layer, axes)

"""What a sonar sees of the area around it (docs/formats/area.md): maps over bearing and range, the sea
floor with tracks, the sections that sound was traced through."""
from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from matplotlib.colors import TwoSlopeNorm
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from . import results, source, style
from .data import InputError

KIND = "asdic area"
SURE, NO_PATH, EDGE, NO_WATER = range(4)
ENDED = {1: "the sea floor", 2: "the sound speed", 3: "the seabed or the wind"}    # of beyond_map

@dataclass
class Value:
    """One of the maps."""

    dataset: str
    title: str
    label: str


MAPS = {
    "signal_excess": Value("signal_excess_db", "Signal excess", "signal excess / dB"),
    "detection_probability": Value("detection_probability", "Probability of detection",
                                   "probability of detection"),
    "echo_level": Value("echo_db", "Echo level", "level of the echo / dB re 1 µPa"),
    "reverberation_level": Value("reverberation_db", "Reverberation level in the beam",
                                 "level of reverberation / dB re 1 µPa"),
}
OTHERS = {"sea_floor": "Sea floor and tracks", "sections": "Sections of the sea floor"}
ALL = (*MAPS, *OTHERS)


@dataclass
class Area:
    title: str
    depth: np.ndarray           # [d] of the target [m]
    bearing: np.ndarray         # [b] of the cells' middles, true [deg]
    range: np.ndarray           # [r] from the array [m]
    array: np.ndarray           # [3] east, north, depth: the middle [m]
    source: np.ndarray          # [3]
    values: dict                # dataset → [d, b, r]
    certainty: np.ndarray       # [d, b, r]
    uncertainty: np.ndarray     # [d, b, r] [dB]
    bottom: np.ndarray          # [b, r] [m]
    about: str                  # who listens to whom
    middle: str                 # "the array", and where on the Earth it is
    beyond: str = ""            # what the file warns of maps that end within the reach
    tracks: dict = field(default_factory=dict)   # "platforms", "targets" → (names, [n, instants, 3])
    tags: dict = field(default_factory=dict)
    ends: np.ndarray | None = None      # [b, r] which map has ended before the cell, 0: none
    earth: tuple | None = None          # latitude and longitude of the cells [b, r] [°]

    @property
    def apart(self) -> float:
        """Between transmitter and array [m]"""
        return float(np.hypot(*(self.source - self.array)[:2]))


def read(path) -> Area:
    """Of a file or a dataset. Raises InputError."""
    if isinstance(path, Area):
        return path
    if results.filetype(path) != KIND:
        raise InputError(source.name_of(path), f'filetype "{results.filetype(path)}"', f'"{KIND}"')
    reader = results.Reader(path)
    with reader.file:
        depth, bearing, span = (reader.array(n) for n in ("depth", "bearing", "range"))
        shape = (depth.size, bearing.size, span.size)
        values = {}
        for name in [v.dataset for v in MAPS.values()] + ["certainty", "uncertainty_db"]:
            values[name] = reader.array(name)
            if values[name].shape != shape:
                raise InputError(reader.path, f"{name} of shape {values[name].shape}", f"{shape}")
        tracks = {}
        for kind in ("platforms", "targets"):
            if reader.has(f"{kind}/track"):
                names = [results.text({"n": n}, "n")
                         for n in np.ravel(reader.file[kind].attrs.get("names", []))]
                tracks[kind] = (names, reader.array(f"{kind}/track"))
        attributes = reader.file.attrs
        about = (f"{results.text(attributes, 'array')} hears {results.text(attributes, 'transmitter')}"
                 f", {reader.number('frequency_hz'):g} Hz, target of "
                 f"{reader.number('target_strength_db'):.3g} dB")
        place = style.on_earth(reader.file["array_position"].attrs)
        middle = f"the array ({place})" if place else "the array"
        return Area(reader.title(), depth, bearing, span, reader.array("array_position"),
                    reader.array("source_position"), values, values["certainty"],
                    values["uncertainty_db"], reader.array("bottom_depth"), about, middle,
                    of_the_map(attributes), tracks, reader.tags(),
                    *(per_cell(reader, names, shape[1:]) for names in
                      (("beyond_map",), ("latitude", "longitude"))))


def per_cell(reader, names: tuple, shape: tuple):
    """Datasets over (bearing, range): one by itself, several as a tuple; None without them."""
    if not all(reader.has(name) for name in names):
        return None
    found = tuple(reader.array(name) for name in names)
    for name, values in zip(names, found):
        if values.shape != shape:
            raise InputError(reader.path, f"{name} of shape {values.shape}", f"{shape}")
    return found if len(found) > 1 else found[0]


def of_the_map(attributes) -> str:
    """The warning that the map ends before the sound does; "" without one."""
    told = [results.text({"w": w}, "w") for w in np.ravel(attributes.get("warnings", []))]
    return next((w.split(": ", 1)[1] for w in told
                 if w.startswith("environment.area: ") and "beyond it" in w), "")


def nothing_to_show(area: Area, name: str) -> str | None:
    if name in OTHERS:
        return None if np.isfinite(area.bottom).any() else "the file does not tell the sea floor"
    good = np.isfinite(area.values[MAPS[name].dataset])
    return None if good.any() else "no ray comes anywhere, or nothing scatters"


# ------------------------------------------------------------------------------------ the map


def edges(area: Area):
    """East and north of the corners of the cells, from the array [km]. [b + 1, r + 1] each"""
    turn = 360.0 / area.bearing.size
    bearing = np.radians(np.append(area.bearing - 0.5 * turn, area.bearing[-1] + 0.5 * turn))
    step = area.range[1] - area.range[0] if area.range.size > 1 else 2.0 * area.range[0]
    span = np.append(area.range - 0.5 * step, area.range[-1] + 0.5 * step) / 1e3
    return np.outer(np.sin(bearing), span), np.outer(np.cos(bearing), span)


def middles(area: Area):
    """The same of the cells' middles, closed: the first bearing comes again. [b + 1, r] each"""
    bearing = np.radians(np.append(area.bearing, area.bearing[0]))
    return np.outer(np.sin(bearing), area.range / 1e3), np.outer(np.cos(bearing), area.range / 1e3)


def closed(values):
    return np.concatenate([values, values[:1]])


def square_figure(title: str, axes):
    """About as wide as the map, or the caller's axes."""
    return style.figure(title, 8.8, axes)


def frame(axes, area: Area) -> None:
    """North up, rings of range and the points of the compass."""
    far = edges(area)[1].max()
    style.image_frame(axes)
    axes.set_facecolor(style.PAPER)
    axes.set_aspect("equal", anchor="W")
    style.compass(axes, far)
    axes.set_xlabel(f"east of {area.middle} / km")
    axes.set_ylabel("north of the array / km")
    for ring in axes.get_xticks():
        if 0.0 < ring <= far:
            t = np.linspace(0.0, 2.0 * np.pi, 361)
            axes.plot(ring * np.sin(t), ring * np.cos(t), color=style.GREY, lw=0.6, alpha=0.6,
                      zorder=4)
    graticule(axes, area)


def graticule(axes, area: Area) -> None:
    """Latitudes and longitudes on the frame: those due north and due east of the array."""
    if area.earth is None:
        return
    bearing = np.radians(area.bearing)
    x, y = (np.outer(f(bearing), area.range / 1e3).ravel() for f in (np.sin, np.cos))
    latitude, longitude = (values.ravel() for values in area.earth)
    good = np.isfinite(latitude) & np.isfinite(longitude)
    if good.sum() < 10:
        return
    ends = np.array([-1.0, 1.0]) * area.range[-1] / 1e3
    # meridians converge, parallels bend; both vanish on the axes
    of_x = np.linalg.lstsq(np.stack([x**0, x, x * y], 1)[good], longitude[good], rcond=None)[0]
    of_y = np.linalg.lstsq(np.stack([x**0, y, x * x], 1)[good], latitude[good], rcond=None)[0]
    style.degree_ticks(axes, ends, of_x[0] + of_x[1] * ends, ends, of_y[0] + of_y[1] * ends)


def beyond_the_map(axes, area: Area) -> list:
    """Hatches what lies beyond the maps. → handles"""
    if area.ends is None or not (area.ends > 0).any():
        return []
    gone = area.ends > 0
    names = [word for number, word in ENDED.items() if (area.ends == number).any()]
    return style.hatched(axes, among(area, gone), area.range[-1] / 1e3,
                         f"beyond the map of {' and '.join(names)}", 24, True)


def among(area: Area, cells):
    """(x, y) → whether a place [km from the array] is in one of some cells [b, r]"""
    turn, step = 360.0 / area.bearing.size, area.range[0] / 500.0

    def inside(x, y):
        ring = (np.hypot(x, y) / step).astype(int)
        ray = (np.degrees(np.arctan2(x, y)) % 360.0 / turn).astype(int) % area.bearing.size
        return (ring < area.range.size) & cells[ray, np.minimum(ring, area.range.size - 1)]

    return inside

def contours(axes, area: Area, **relief) -> list:
    """Of the sea floor's depth. → handles"""
    levels = style.depth_levels(area.bottom, **relief)
    return style.depth_lines(axes, *middles(area), closed(area.bottom), levels)


def marks(axes, area: Area) -> list:
    """Who is where, with tracks. → handles"""
    handles = []

    def put(place, label, **look):
        off = (np.asarray(place)[:2] - area.array[:2]) / 1e3
        axes.plot(*off, ls="none", mec=style.PAPER, mew=0.9, zorder=7, **look)
        handles.append(Line2D([], [], ls="none", mec=style.PAPER, label=label, **look))

    for kind, (names, track) in area.tracks.items():
        for k, (name, way) in enumerate(zip(names, track)):
            shade = style.colour(k) if kind == "targets" else style.INK
            off = (way[:, :2] - area.array[:2]) / 1e3
            if np.ptp(way[:, :2], axis=0).max() > 1.0:
                axes.plot(*off.T, color=shade, lw=1.4, zorder=6, path_effects=list(style.OVER_MAP))
            if kind == "targets" and k < 6:
                put(way[0], f"{style.name(name)}: at the start", marker="o", ms=7, mfc=shade)
    put(area.array, "array", marker="^", ms=8, mfc=style.INK)
    if area.apart > 1.0:
        put(area.source, "transmitter", marker="D", ms=7, mfc=style.INK)
    return handles


def limits_of(area: Area, name: str, values):
    """Of colours, by the water's area; in decibels multiples of 5. Of the signal excess 0 is the middle:
    from 10 to 60 dB below it, from 10 to 30 dB above it. Others span 20 to 60 dB: 5 % of the area may
    lie below, and above 2 %, or up to 25 % where only so a quarter of the area lies within.
    """
    if name == "detection_probability":
        return 0.0, 1.0
    weight = np.broadcast_to(area.range, values.shape)
    low, *tops = style.weighted_percentiles(values, weight, (5.0, 75.0, 90.0, 95.0, 98.0))
    low, high = 5.0 * np.floor(low / 5.0), 5.0 * np.ceil(tops[-1] / 5.0)
    if name == "signal_excess":     # fmax and fmin: NaN where there is none
        return float(np.fmax(np.fmin(low, -10.0), -60.0)), float(np.fmin(np.fmax(high, 10.0), 30.0))
    if np.isnan(high):
        return 0.0, 20.0
    known = weight[np.isfinite(values)].sum()
    for top in reversed(tops):
        lower = 5.0 * np.ceil(top / 5.0)
        if weight[(values >= lower - 60.0) & (values <= lower)].sum() >= 0.25 * known:
            high = lower
            break
    return float(np.clip(low, high - 60.0, high - 20.0)), float(high)


def shades_of(name: str, limits) -> dict:
    """Colour map and scale: white is a signal excess of 0, however far the ends are."""
    low, high = limits
    if name == "signal_excess" and low < 0.0 < high:
        return dict(cmap=style.DIVERGING, norm=TwoSlopeNorm(0.0, low, high))
    return dict(cmap=style.DIVERGING if name == "signal_excess" else style.MAP, vmin=low, vmax=high)


def without_value(name: str, values, certainty) -> list:
    """Cells that have no colour: → which, shade, what they are."""
    ground, shadow = certainty == NO_WATER, certainty == NO_PATH
    parts = [(ground, style.GROUND, "sea floor above that depth")]
    if name == "reverberation_level":   # it comes from elsewhere than the target's place
        silent = np.isneginf(values) & ~ground
        parts.append((silent, style.NOTHING, "no reverberation comes then"))
    else:
        silent = shadow & ~ground
        parts.append((silent, style.NOTHING, "shadow: no ray comes"))
    finite = np.isfinite(values)
    return parts + [(~finite & ~ground & ~silent, style.GREY, "no value")]


def draw_map(area: Area, name: str, layer: int = 0, axes=None, limits=None):
    """One of MAPS at one depth of the target."""
    what = MAPS[name]
    fig, axes = square_figure(what.title, axes)
    values = area.values[what.dataset][layer]
    certainty = area.certainty[layer]
    shown = np.where(np.isfinite(values) & (certainty != NO_WATER), values, np.nan)
    limits = limits or limits_of(area, name, shown)
    x, y = edges(area)
    mesh = axes.pcolormesh(x, y, shown, rasterized=True, zorder=1, **shades_of(name, limits))
    frame(axes, area)
    handles = []
    for where, shade, label in without_value(name, values, certainty):
        if not where.any():
            continue
        axes.pcolormesh(x, y, np.where(where, 1.0, np.nan), cmap=style.flat_map(shade), vmin=0.0,
                        vmax=1.0, rasterized=True, zorder=2)
        handles.append(Patch(fc=shade, ec=style.GREY, label=label))
    if name != "reverberation_level":
        handles += hatch_unsure(axes, area, layer)
    if name in ("signal_excess", "detection_probability"):
        handles += half_detected(axes, area, layer)
    handles += beyond_the_map(axes, area) + contours(axes, area) + marks(axes, area)
    style.colour_bar(fig, mesh, axes, what.label, style.beyond(shown, limits))
    style.subtitle(axes, with_warning(area, f"{area.title}  ·  target at {area.depth[layer]:g} m"
                                            f"  ·  {area.about}"))
    style.legend_below(axes, handles, ncol=3)
    return fig


def with_warning(area: Area, text: str) -> str:
    """A subtitle, and that the map ends within the reach."""
    return f"{text}  ·  {area.beyond}" if area.beyond else text


def hatch_unsure(axes, area: Area, layer: int) -> list:
    """At caustics and the edges of shadows, where rays tell little. → handles"""
    unsure = area.certainty[layer] == EDGE
    if not unsure.any():
        return []
    return style.hatched(axes, among(area, unsure), area.range[-1] / 1e3,
                         "edge of a shadow or caustic: uncertain", 90)


def smoothed(values, half: int = 4):
    """Means over some cells of range and three of bearing: a line through single cells is no line."""
    padded = np.pad(values, ((0, 0), (half, half)), mode="edge")
    sums = np.cumsum(np.pad(padded, ((0, 0), (1, 0))), axis=1)
    along = (sums[:, 2 * half + 1:] - sums[:, : -2 * half - 1]) / (2 * half + 1)
    return (np.roll(along, 1, axis=0) + along + np.roll(along, -1, axis=0)) / 3.0


def half_detected(axes, area: Area, layer: int) -> list:
    """The line of a signal excess of 0: detected half of the time. → handles"""
    excess = area.values["signal_excess_db"][layer]
    known = smoothed(np.where(np.isnan(excess), -40.0, np.clip(excess, -40.0, 40.0)))
    if known.min() >= 0.0 or known.max() <= 0.0:
        return []
    axes.contour(*middles(area), closed(known), levels=[0.0], colors=[style.ORANGE], linewidths=1.3,
                 zorder=5)
    return [Line2D([], [], color=style.ORANGE, lw=1.3, label="detected half of the time")]


# ------------------------------------------------------------------------------------ the sea floor


def draw_sea_floor(area: Area, axes=None, limits=None):
    """Its depth with the ways that platforms and targets go."""
    fig, axes = square_figure(OTHERS["sea_floor"], axes)
    low, high = (float(f(area.bottom)) for f in (np.nanmin, np.nanmax))
    limits = limits or ((low, high) if high > low else (low - 1.0, low + 1.0))
    mesh = axes.pcolormesh(*edges(area), area.bottom, cmap=style.LOSS_MAP, vmin=limits[0],
                           vmax=limits[1], rasterized=True, zorder=1)
    frame(axes, area)
    handles = beyond_the_map(axes, area) + contours(axes, area, relief=0.0) + marks(axes, area)
    bar = style.colour_bar(fig, mesh, axes, "depth of the sea floor / m", style.beyond(area.bottom, limits))
    bar.ax.invert_yaxis()   # deep is down
    style.subtitle(axes, with_warning(area, area.title))
    style.legend_below(axes, handles, ncol=3)
    return fig


def draw_sections(area: Area, axes=None, limits=None):
    """The sea floor along eight bearings, with the target's depths."""
    fig, axes = style.figure(OTHERS["sections"], 4.8, axes)
    count = min(8, area.bearing.size)
    shades = style.colours(count)
    deepest = float(np.nanmax(area.bottom))
    for k in range(count):
        row = int(round(k * area.bearing.size / count)) % area.bearing.size
        known = np.full(area.range.size, True) if area.ends is None else area.ends[row] == 0
        axes.plot(area.range / 1e3, np.where(known, area.bottom[row], np.nan), color=shades[k], lw=1.5,
                  label=f"towards {bearing_text(area.bearing[row])}")
        if not known.all():
            axes.plot(area.range / 1e3, np.where(known, np.nan, area.bottom[row]), color=shades[k],
                      lw=1.2, ls=(0, (1, 2)))
    for depth in area.depth:
        axes.axhline(depth, color=style.INK, lw=1.0, ls=(0, (4, 3)))
        axes.annotate(f"target {depth:g} m", (1.0, depth), (-4, 4), xycoords=("axes fraction", "data"),
                      textcoords="offset points", ha="right", fontsize=8, color=style.NOTE)
    axes.plot([0.0], [area.array[2]], marker="^", ms=8, color=style.INK, ls="none", label="array",
              clip_on=False)
    if area.ends is not None and (area.ends > 0).any():
        axes.plot([], [], color=style.GREY, lw=1.2, ls=(0, (1, 2)),
                  label="beyond the map: its edge goes on")
    axes.set_xlim(0.0, area.range[-1] / 1e3)
    axes.set_ylim(1.06 * deepest, 0.0)
    axes.set_xlabel("horizontal range from the array / km")
    axes.set_ylabel("depth / m")
    axes.grid(True)
    style.subtitle(axes, with_warning(area, area.title))
    style.legend_below(axes, ncol=5)
    return fig


def bearing_text(bearing: float) -> str:
    """47°, or 47.5°: with a decimal where it is not whole."""
    return f"{bearing:.0f}°" if abs(bearing - round(bearing)) < 0.05 else f"{bearing:.1f}°"


@style.picture
def draw(area: Area, name: str, layer: int = 0, axes=None, limits=None):
    if name == "sea_floor":
        return draw_sea_floor(area, axes, limits)
    if name == "sections":
        return draw_sections(area, axes, limits)
    return draw_map(area, name, layer, axes, limits)

"""Pictures of a scenario before it runs: the map and a section, the sound speed, the arrays, the
pulse.
"""
from __future__ import annotations

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Wedge

from . import sea as seas
from . import style
from .scene import Floor, Scene

MARKS = {"platforms": "s", "transmitters": "D", "arrays": "^", "targets": "o"}
SIZES = {"platforms": 6, "transmitters": 7, "arrays": 8, "targets": 9}
CALLED = {"platforms": "platform", "transmitters": "transmitter", "arrays": "array"}


def shade(kind: str, k: int) -> str:
    if kind == "targets":
        return style.colour(k)
    return {"platforms": style.GREY, "transmitters": style.INK, "arrays": style.SLATE}[kind]


def mark(kind: str, k: int) -> dict:
    return dict(marker=MARKS[kind], ms=SIZES[kind], mfc=shade(kind, k), mec=style.PAPER, mew=1.0,
                ls="none", clip_on=False)


def handles(scene: Scene) -> list:
    made = []
    for kind, things in scene.things.items():
        if kind == "platforms" and len(things.names) == 1:
            continue    # its transmitter says where it is
        for k, name in list(enumerate(things.names))[:6]:
            word = CALLED.get(kind)
            label = style.name(name) if not word or word in name else f"{word}: {style.name(name)}"
            made.append(Line2D([], [], label=label, **{**mark(kind, k), "clip_on": True}))
    return made


def nothing(scene: Scene):
    return None


# ------------------------------------------------------------------------------------ geometry


def draw_map(axes, scene: Scene) -> list:
    """From above, with the ways that things go until the last record ends. → handles of the sea floor"""
    far = 1.0
    for kind, things in scene.things.items():
        for k, track in enumerate(things.track):
            east, north = track[:, 0] / 1e3, track[:, 1] / 1e3
            if np.ptp(track[:, :2], axis=0).max() > 1.0 and kind != "transmitters":
                axes.plot(east, north, color=shade(kind, k), lw=1.6, alpha=0.6, zorder=3)
            axes.plot(east[:1], north[:1], zorder=5 + (kind == "targets"), **mark(kind, k))
    places = np.concatenate([t.track[..., :2].reshape(-1, 2) for t in scene.things.values()]) / 1e3
    middle = 0.5 * (places.min(axis=0) + places.max(axis=0))
    far = max(0.58 * np.ptp(places, axis=0).max(), 0.2)
    source = scene.start("transmitters")[0][:2] / 1e3
    b = np.radians(scene.bearing)
    reach = 3.0 * far
    axes.plot([source[0], source[0] + reach * np.sin(b)], [source[1], source[1] + reach * np.cos(b)],
              color=style.GREY, lw=0.9, ls=(0, (4, 3)), zorder=2)
    axes.set_xlim(middle[0] - far, middle[0] + far)
    axes.set_ylim(middle[1] - far, middle[1] + far)
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel(style.east_of(scene.origin))
    axes.set_ylabel("north / km")
    axes.grid(True)
    for side in axes.spines.values():
        side.set_visible(True)
    return draw_floor(axes, scene.floor, middle, far)


def draw_floor(axes, floor: Floor | None, middle, far: float) -> list:
    """Depths of the area's map below the tracks, land brown, grey where no map is. → handles"""
    if floor is None:
        return []
    x, y, depth = floor.east / 1e3, floor.north / 1e3, floor.depth
    if floor.longitude is not None and floor.latitude is not None:
        style.degree_ticks(axes, x[[0, -1]], floor.longitude[[0, -1]], y[[0, -1]],
                           floor.latitude[[0, -1]])
    seen = np.ix_(np.abs(y - middle[1]) <= 1.5 * far, np.abs(x - middle[0]) <= 1.5 * far)
    part = depth[seen] if depth[seen].size > 16 else depth
    made = []
    water = np.where(depth >= 0.0, depth, np.nan)
    if np.isfinite(water).any():
        low, high = (float(f(np.where(part >= 0.0, part, np.nan))) if (part >= 0.0).any() else 0.0
                     for f in (np.nanmin, np.nanmax))
        axes.pcolormesh(x, y, water, cmap=style.depth_shades(), vmin=low,
                        vmax=max(high, low + 1.0), rasterized=True, zorder=0.4, shading="nearest")
    land, none = depth < 0.0, np.isnan(depth)
    if land.any():
        axes.pcolormesh(x, y, np.where(land, 1.0, np.nan), cmap=style.flat_map(style.GROUND), vmin=0.0,
                        vmax=1.0, rasterized=True, zorder=0.5, shading="nearest")
        made.append(Patch(fc=style.GROUND, ec=style.GREY, label="land"))
    if none.any():
        made += style.hatched(axes, lambda x, y: floor.ended(1e3 * x, 1e3 * y), 1.5 * far,
                              "beyond the map: its edge goes on", 36, True, middle, 0.6)
    return style.depth_lines(axes, x, y, depth, style.depth_levels(part), 1.5,
                             lambda at: (np.abs(at - middle) <= 1.2 * far).all(axis=1)) + made


def along_section(scene: Scene, places) -> np.ndarray:
    """Horizontal distance from the first transmitter [km]"""
    source = scene.start("transmitters")[0]
    return np.hypot(*(np.asarray(places)[..., :2] - source[:2]).T) / 1e3


def draw_beam(axes, scene: Scene, last: float) -> None:
    """Where the first transmitter's beam sets out, in straight lines."""
    if not scene.elevation.size or not np.isfinite(scene.beamwidth[0]):
        return
    source = scene.start("transmitters")[0]
    half, middle = 0.5 * scene.beamwidth[0], scene.elevation[0]
    reach = 1e3 * last
    lines = [source[2] - reach * np.tan(np.radians(middle + e)) for e in (-half, half)]
    axes.fill([0.0, last, last], [source[2], *lines], color=style.ORANGE, alpha=0.18, lw=0, zorder=2)


def draw_section(axes, scene: Scene) -> None:
    """Everything by its distance from the transmitter, in one plane."""
    known = scene.sea
    last = float(known.boundary_range.max()) / 1e3 if known.boundary_range is not None else 1.0
    depths = [np.concatenate([t.track[..., 2].ravel() for t in scene.things.values()])] \
        if scene.sonar else [scene.source_depth, scene.receivers[0]]
    seas.depth_axis(axes, *seas.extent(known, np.concatenate(depths)))
    axes.set_xlim(0.0, last)
    axes.set_facecolor(style.WATER)
    if scene.sonar:
        draw_beam(axes, scene, last)
        for kind, things in scene.things.items():
            for k, place in enumerate(scene.start(kind)):
                axes.plot(along_section(scene, place[None])[0], place[2],
                          zorder=6 + (kind == "targets"), **mark(kind, k))
        axes.set_xlabel("horizontal range from the transmitter / km")
    else:
        z, r, one_by_one = scene.receivers
        if z.size:
            if one_by_one:
                every = -(-z.size // 2000)
                zz, rr = z[::every], r[::every]
            else:   # whole rows and columns
                every = int(np.ceil(np.sqrt(z.size * r.size / 2500.0)))
                z, r = z[::min(every, z.size)], r[::min(every, r.size)]
                zz, rr = np.repeat(z, r.size), np.tile(r, z.size)
            axes.plot(rr / 1e3, zz, ls="none", marker=".", ms=1.5, color=style.SLATE,
                      zorder=2.5)
        axes.plot(np.zeros(scene.source_depth.size), scene.source_depth, zorder=6,
                  **mark("transmitters", 0))
        axes.set_xlabel("range from the source / km")
    seas.draw_boundaries(axes, known)
    seas.draw_map_end(axes, known)
    axes.grid(True)


@style.picture
def geometry(scene: Scene, axes=None, limits=None):
    """Map and section of a sonar; the section of a run without one."""
    if not scene.sonar:
        fig, axes = style.figure("Geometry", 5.0, axes)
        draw_section(axes, scene)
        style.subtitle(axes, f"{scene.title}  ·  {scene.frequency:g} Hz, "
                             f"{receivers_text(scene)}")
        key = [Line2D([], [], label="source", **{**mark("transmitters", 0), "clip_on": True})]
        if scene.receivers[0].size:
            key.append(Line2D([], [], ls="none", marker=".", ms=4, color=style.SLATE,
                              label="receivers"))
        style.legend_below(axes, key)
        return fig
    fig, (left, right) = style.figure("Geometry", 5.4, axes, ncols=2,
                                      gridspec_kw={"width_ratios": [1.0, 1.25]})
    floor = draw_map(left, scene)
    draw_section(right, scene)
    pings = "1 ping" if scene.pings == 1 else f"{scene.pings} pings"
    style.subtitle(left, f"{scene.title}  ·  {pings} at {scene.frequency:g} Hz, the ways are those "
                         f"until the last record ends, {scene.end:g} s", marks=True)
    right.annotate(f"section along {scene.bearing:.0f}° true (dashed in the map); all things by "
                   "their range", (0.0, 1.0), (0.0, 4.0), "axes fraction", "offset points",
                   fontsize=8.5, color=style.NOTE, annotation_clip=False).set_in_layout(False)
    made = handles(scene)
    if scene.beamwidth.size and np.isfinite(scene.beamwidth[0]):
        made.append(Wedge((0, 0), 1, 0, 1, color=style.ORANGE, alpha=0.3, lw=0,
                          label=f"beam, {scene.beamwidth[0]:.3g}° wide, straight on"))
    style.legend_below(left, made + floor, ncol=5)
    return fig


def receivers_text(scene: Scene) -> str:
    z, r, one_by_one = scene.receivers
    if not z.size:
        return "no receivers"
    return f"{z.size} receivers" if one_by_one else f"receivers at {z.size} depths, {r.size} ranges"


# ------------------------------------------------------------------------------ sound speed


@style.picture
def sound_speed(scene: Scene, axes=None, limits=None):
    """The water column, with the depths at which there is something; of water that varies with range
    each profile.
    """
    fig, axes = style.figure("Sound speed", 6.0, axes)
    known = scene.sea
    seas.draw_profile(axes, known)
    axes.set_xlabel("sound speed / m/s")
    axes.xaxis.set_major_locator(style.ticker.MaxNLocator(8))
    bottom = float(np.nanmax(known.depth))
    axes.set_ylim(1.02 * bottom, min(0.0, float(np.nanmin(known.depth))))
    axes.set_ylabel("depth / m")
    if limits:
        axes.set_xlim(*limits)
    levels = [(kind, k, name, scene.start(kind)[k][2]) for kind, things in scene.things.items()
              for k, name in enumerate(things.names) if kind != "platforms"]
    levels += [("transmitters", 0, "source", z) for z in scene.source_depth[:4]]
    made = []
    for kind, k, name, depth in levels[:8]:
        speed = float(np.interp(depth, known.depth, known.sound_speed))
        axes.axhline(depth, color=shade(kind, k), lw=0.7, ls=(0, (2, 3)), zorder=1)
        look = {**mark(kind, k), "clip_on": False}
        axes.plot(speed, depth, zorder=5, **look)
        made.append(Line2D([], [], **look, label=f"{style.name(name)}: {depth:.4g} m, "
                                                 f"{speed:.1f} m/s"))
    several = len(seas.profiles(known))
    style.subtitle(axes, scene.title + ("  ·  speeds of the marks are those at range 0"
                                        if several > 1 else ""))
    style.legend_below(axes, made, ncol=3)
    return fig


# ------------------------------------------------------------------------------------ arrays


def no_array(scene: Scene):
    if not any(len(p) > 1 for p in scene.phones):
        return "no array of more than one phone"
    return None


@style.picture
def array(scene: Scene, axes=None, limits=None):
    """The phones of each array at the start: from above, and from the side."""
    shown = [k for k, p in enumerate(scene.phones) if len(p) > 1][:3]
    fig, rows = style.figure("Arrays" if len(shown) > 1 else "Array", 1.4 + 3.1 * len(shown), axes,
                             nrows=len(shown), ncols=2, squeeze=False)
    names = scene.things["arrays"].names
    for (above, beside), k in zip(rows, shown):
        phones = scene.phones[k]
        flat = phones[:, :2] - phones[:, :2].mean(axis=0)
        _, size, directions = np.linalg.svd(flat, full_matrices=False)
        axis = directions[0] if size[0] > 1e-6 else np.array([1.0, 0.0])
        axis = axis if axis[1] > 0 or (axis[1] == 0 and axis[0] > 0) else -axis
        bearing = np.degrees(np.arctan2(axis[0], axis[1])) % 360.0
        order = np.arange(len(phones))
        for panel, x, y in ((above, phones[:, 0], phones[:, 1]), (beside, flat @ axis, phones[:, 2])):
            panel.plot(x, y, color=style.GREY, lw=0.6, zorder=2)
            panel.scatter(x, y, c=order, cmap=style.MAP, s=22, zorder=3, lw=0.4,
                          edgecolors=style.INK)
            span = max(np.ptp(phones, axis=0).max(), np.ptp(flat @ axis), 1e-3)
            last = len(phones) - 1
            apart = np.hypot(x[last] - x[0], y[last] - y[0]) > 0.1 * span
            for which, word in ((0, "0"), (last, str(last))) if apart else ((0, f"0 to {last}"),):
                panel.annotate(word, (x[which], y[which]), (4.0, 5.0), textcoords="offset points",
                               fontsize=8, color=style.NOTE)
            panel.grid(True)
            for middle, put in ((0.5 * (x.min() + x.max()), panel.set_xlim),
                                (0.5 * (y.min() + y.max()), panel.set_ylim)):
                put(middle - 0.6 * span, middle + 0.6 * span)
            panel.set_aspect("equal", adjustable="box")
        beside.invert_yaxis()
        above.set_xlabel("east / m")
        above.set_ylabel("north / m")
        beside.set_xlabel(f"along {bearing:.0f}° true / m")
        beside.set_ylabel("down / m")
        space = np.linalg.norm(np.diff(phones, axis=0), axis=1)
        wave = float(np.median(scene.sea.sound_speed)) / scene.frequency
        style.subtitle(above, f"{names[k] if k < len(names) else 'array'}: {len(phones)} phones, "
                              f"{np.median(space):.4g} m from one to the next, "
                              f"{np.median(space) / wave:.2g} wavelengths at {scene.frequency:g} Hz"
                              f"  ·  numbers are the phones'")
    return fig


# ------------------------------------------------------------------------------------ pulse


def no_pulse(scene: Scene):
    return None if scene.pulse else "no pulse without a sonar"


def largest(values, most: int = 4000) -> tuple:
    """Runs of values for a line of a few thousand points. → the middle of each, its largest value"""
    run = max(values.size // most, 1)
    kept = values[: values.size // run * run].reshape(-1, run)
    return np.arange(kept.shape[0]) * run + run // 2, kept.max(axis=1)


@style.picture
def pulse(scene: Scene, axes=None, limits=None):
    """The first transmitter's pulse: its spectrum, and its ambiguity surface."""
    p = scene.pulse
    fig, (above, below) = style.figure("Pulse: spectrum and ambiguity surface", 8.2, axes, nrows=2,
                                       gridspec_kw={"height_ratios": [1.0, 1.7]})
    low, high = limits or (-50.0, 0.0)
    at, power = largest(p.spectrum)
    db = 10.0 * np.log10(np.maximum(power / p.spectrum.max(), 1e-12))
    above.plot(p.frequency[at], db, color=style.colour(0), lw=0.9)
    above.set_xlim(p.frequency[0], p.frequency[-1])
    above.set_ylim(low, high + 3.0)
    above.set_xlabel("frequency / Hz")
    above.set_ylabel("spectrum re its peak / dB")
    above.grid(True)
    window = "no window" if p.window == "none" else f"{p.window.capitalize()} window"
    of = "" if len(scene.things["transmitters"].names) < 2 else f"  ·  of {style.name(p.transmitter)}"
    style.subtitle(above, f"{scene.title}{of}  ·  {p.kind} of {p.duration:g} s about "
                          f"{p.centre:g} Hz, {window}, energy that of {p.energy:.4g} s at its peak")

    db = 10.0 * np.log10(np.maximum(p.ambiguity, 1e-12))
    shift = p.centre * (p.doppler - 1.0)
    mesh = style.image(below, style.cell_edges(p.delay), style.cell_edges(shift), db, (low, high))
    style.image_frame(below)
    below.set_xlabel("delay of the echo over the filter's / s")
    below.set_ylabel("Doppler shift of the echo / Hz")
    style.colour_bar(fig, mesh, below, "answer / dB", extend="min")
    return fig


PICTURES = {"geometry": (geometry, nothing, "Geometry: map and section"),
            "sound_speed": (sound_speed, nothing, "Sound speed"),
            "array": (array, no_array, "The phones of each array"),
            "pulse": (pulse, no_pulse, "The pulse: spectrum and ambiguity surface")}

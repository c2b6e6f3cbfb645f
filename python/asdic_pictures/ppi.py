"""Plan position: the beams of one ping on the map, by true bearing, with what was found and the truth."""
from __future__ import annotations

import numpy as np

from . import bearing_time, processed, scene, signal, style

TITLE = "Plan position, beams on the map"
SECTORS, COLUMNS = 360, 300


def nothing_to_show(data, ping):
    if reason := bearing_time.nothing_to_show(data, ping):
        return reason
    if signal.scan(data.phones(ping)).kind == "vertical":
        return "the array tells no bearing"
    last = data.start + data.valid_samples[ping] / data.sample_rate
    if last < first_range(data, ping) + 2.0 * data.pulse_duration:
        return "the record ends with the pulse"
    return None


def first_range(data, ping) -> float:
    """When the pulse is out and has passed the array: of what is received before nothing tells where it
    was scattered. [s]
    """
    apart = np.hypot(*(data.platform(ping) - data.phones(ping).mean(axis=0))[:2])
    return float(apart) / data.sound_speed(float(data.phones(ping)[:, 2].mean())) + data.pulse_duration


def ranges(times, bearing, apart, towards: float, speed: float):
    """[bearing, time] horizontal range from the array at which sound that comes straight from a bearing
    was scattered: r + |place − source| = c·t. NaN before the direct sound. \\param apart  to the source
    [m] \\param towards  its bearing [rad]
    """
    way = speed * np.asarray(times)[None, :]
    nearer = apart * np.cos(np.asarray(bearing)[:, None] - towards)
    with np.errstate(divide="ignore", invalid="ignore"):
        r = (way ** 2 - apart ** 2) / (2.0 * (way - nearer))
    return np.where(way > apart, r, np.nan)


def together(edges, db):
    """Some columns of a record as one each: as many as a map shows. → time edges, level [beam, column]"""
    some = max(1, db.shape[1] // COLUMNS)
    count = db.shape[1] // some
    power = 10.0 ** (db[:, : count * some].reshape(len(db), count, some) / 10.0)
    return edges[: count * some + 1 : some], 10.0 * np.log10(power.mean(axis=2))


@style.picture
def draw(data, ping, axes=None, limits=None):
    where, edges, db = bearing_time.record(data, ping)
    speed = data.sound_speed(float(data.phones(ping)[:, 2].mean()))
    centre = data.phones(ping).mean(axis=0)
    source = data.platform(ping)
    off = (source - centre)[:2]
    apart, towards = float(np.hypot(*off)), float(np.arctan2(off[0], off[1]))
    first = int(np.searchsorted(edges, max(edges[0], first_range(data, ping))))
    edges, db = together(edges[first:], db[:, first:])
    corner = np.radians(np.linspace(0.0, 360.0, SECTORS + 1))
    middle = 0.5 * (corner[1:] + corner[:-1])
    at = signal.apparent(where, -np.stack([np.sin(middle), np.cos(middle), 0.0 * middle], axis=1))
    beam = np.abs(at[:, None] - where.coordinate[None, :]).argmin(axis=1)
    span = ranges(edges, corner, apart if apart > 1.0 else 0.0, towards, speed) / 1e3
    power = np.ma.masked_invalid(db[beam])
    fig, axes = style.figure(TITLE, 8.8, axes)
    limits = limits or style.colour_limits(db, data.loudest_echo(ping))
    x, y = span * np.sin(corner)[:, None], span * np.cos(corner)[:, None]
    known = np.isfinite(x).all(axis=0)
    x, y, power = x[:, known], y[:, known], power[:, known[1:] & known[:-1]]
    mesh = axes.pcolormesh(x, y, power[:, : x.shape[1] - 1], cmap=style.MAP, vmin=limits[0],
                           vmax=limits[1], rasterized=True, zorder=1)
    frame(axes, float(np.nanmax(np.hypot(x, y))))
    handles = floor(axes, data, centre) + found(axes, data, ping, centre) \
        + truth(axes, data, ping, centre)
    handles += axes.plot([0.0], [0.0], ls="none", marker="^", ms=8, mfc=style.INK, mec=style.PAPER,
                         label="array", zorder=7)
    if apart > 1.0:
        handles += axes.plot(*(off / 1e3), ls="none", marker="D", ms=7, mfc=style.INK,
                             mec=style.PAPER, label="transmitter's platform", zorder=7)
    style.colour_bar(fig, mesh, axes,
                     f"beam level in {data.envelope(ping).width:.0f} Hz / dB re 1 µPa",
                     style.beyond(np.ma.filled(power, np.nan), limits))
    sides = "  ·  a line hears both its sides" if where.kind == "horizontal" else ""
    style.subtitle(axes, f"{data.heading(ping)}  ·  ranges along straight lines at {speed:.0f} m/s{sides}")
    style.legend_below(axes, processed.legend(handles), ncol=3)
    return fig


def frame(axes, far: float) -> None:
    style.image_frame(axes)
    axes.set_facecolor(style.PAPER)
    axes.set_aspect("equal", anchor="W")
    style.compass(axes, far)
    axes.set_xlabel("east of the array / km")
    axes.set_ylabel("north of the array / km")
    t = np.linspace(0.0, 2.0 * np.pi, 361)
    for ring in axes.get_xticks():
        if 0.0 < ring <= far:
            axes.plot(ring * np.sin(t), ring * np.cos(t), color="white", lw=0.5, alpha=0.5, zorder=2)


def floor(axes, data, centre) -> list:
    """Depths of an area's map within the picture, and degrees on the frame. → handles"""
    known = scene.floor_of(data)
    if known is None:
        return []
    x, y = (known.east - centre[0]) / 1e3, (known.north - centre[1]) / 1e3
    if known.longitude is not None:
        style.degree_ticks(axes, x[[0, -1]], known.longitude[[0, -1]], y[[0, -1]],
                           known.latitude[[0, -1]])
    far = abs(axes.get_xlim()[0]) / 1.11
    seen = np.where(np.hypot(x[None, :], y[:, None]) <= far, known.depth, np.nan)
    gone = style.hatched(
        axes, lambda x, y: known.ended(1e3 * x + centre[0], 1e3 * y + centre[1]) & (np.hypot(x, y) <= far),
        far, "beyond the map: its edge goes on", 24, True)
    return style.depth_lines(axes, x, y, seen, style.depth_levels(seen), 4.0) + gone


def found(axes, data, ping, centre) -> list:
    """Detections at their places, those of a line on both sides. → handles"""
    if not processed.there(data):
        return []
    t = processed.detections(data, ping)
    handles: list = []
    for side in ("", "mirror_"):
        x, y = ((t[side + k] - c) / 1e3 for k, c in zip("xy", centre))
        good = np.isfinite(x) & np.isfinite(y)
        if good.any():
            marks = processed.mark(axes, x[good], y[good], {k: v[good] for k, v in t.items()},
                                   data.target_names)
            handles += [h for h in marks if h.get_label() not in [g.get_label() for g in handles]]
    return handles


def truth(axes, data, ping, centre) -> list:
    handles = []
    for index, name, place, present in data.targets(ping):
        if present:
            handles += axes.plot(*((place - centre)[:2] / 1e3), zorder=6,
                                 **style.truth(index, "*", 13, f"{style.name(name)}: true place"))
    return handles

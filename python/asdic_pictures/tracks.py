"""Tracks over the truth: on the map, or range against time where the array tells no bearing."""
from __future__ import annotations

import numpy as np
from matplotlib.lines import Line2D

from . import processed, scene, scene_pictures, style

TITLE = "Tracks and truth"


def nothing_to_show(data, ping):
    if not processed.there(data):
        return "the file is not processed (asdic process)"
    if not processed.tracks(data):
        return "no track began"
    return None


@style.picture
def draw(data, ping, axes=None, limits=None):
    tracks = processed.tracks(data)
    on_map = any(np.isfinite(t["x"]).any() for t in tracks)
    fig, axes = style.figure(TITLE, 7.4 if on_map else 5.6, axes)
    floor = (draw_map if on_map else draw_ranges)(axes, data, tracks) or []
    axes.grid(True)
    hits = sum(int(np.sum(t["detection"] >= 0)) for t in tracks)
    style.subtitle(axes, f"{data.title or data.path}  ·  {len(tracks)} tracks, {hits} detections "
                         f"in them{data.of_array}")
    style.legend_below(axes, legend(data, tracks) + floor, ncol=4)
    return fig


def colour(track) -> str:
    owner = int(track["target"][0])
    return style.colour(owner) if owner >= 0 else style.GREY


def look(track) -> dict:
    mirrored = bool(track["ambiguous"][0]) and int(track["side"][0]) == 1
    return dict(color=colour(track), lw=1.2 if track["target"][0] >= 0 else 0.8,
                ls=(0, (3, 1.5)) if mirrored else "-", marker=".", ms=4, zorder=4)


def true_places(data):
    """[target] → time [ping], place [ping, 3] of those that are there"""
    time = data.read("ping_time")[data.simulated]
    place = data.read("target_position")[data.simulated] if data.target_names else None
    there = data.read("target_present")[data.simulated] if data.target_names else None
    return [(time[there[:, i] > 0], place[there[:, i] > 0, i])
            for i in range(len(data.target_names))]


def draw_map(axes, data, tracks) -> list:
    """→ handles of the sea floor of an area's map"""
    for index, (_, place) in enumerate(true_places(data)):
        axes.plot(place[:, 0] / 1e3, place[:, 1] / 1e3, color=style.colour(index), lw=6, alpha=0.25,
                  solid_capstyle="round", zorder=2)
        axes.plot(*(place[-1:, :2].T / 1e3), **style.truth(index, "*", 12), zorder=5)
    for t in tracks:
        axes.plot(t["x"] / 1e3, t["y"] / 1e3, **look(t))
    own = data.places()
    axes.plot(own[:, 0] / 1e3, own[:, 1] / 1e3, color=style.INK, lw=1.0, marker="^", ms=5, zorder=6,
              markevery=[-1])
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel(style.east_of(style.on_earth(data.file.attrs)))
    axes.set_ylabel("north / km")
    ends = np.array([axes.get_xlim(), axes.get_ylim()])
    axes.set_xlim(*ends[0])
    axes.set_ylim(*ends[1])
    return scene_pictures.draw_floor(axes, scene.floor_of(data), ends.mean(axis=1),
                                     0.5 * float(np.ptp(ends, axis=1).max()))


def draw_ranges(axes, data, tracks):
    own = data.places()
    time = data.read("ping_time")[data.simulated]
    for index, (when, place) in enumerate(true_places(data)):
        mine = own[np.isin(time, when)]
        far = np.hypot(*(place - mine)[:, :2].T)
        axes.plot(when / 60.0, far / 1e3, color=style.colour(index), lw=6, alpha=0.25, zorder=2)
    for t in tracks:
        axes.plot(t["time"] / 60.0, t["range"] / 1e3, **look(t))
    axes.set_xlabel("time since the start of the scenario / min")
    axes.set_ylabel("horizontal range / km")


def legend(data, tracks):
    handles = []
    for index, name in enumerate(data.target_names):
        handles.append(Line2D([], [], color=style.colour(index), lw=6, alpha=0.25,
                              label=f"{style.name(name)}: truth"))
        if any(t["target"][0] == index for t in tracks):
            handles.append(Line2D([], [], color=style.colour(index), lw=1.2, marker=".", ms=4,
                                  label=f"{style.name(name)}: track"))
    if any(t["target"][0] < 0 for t in tracks):
        handles.append(Line2D([], [], color=style.GREY, lw=0.8, marker=".", ms=4,
                              label="tracks of no target"))
    if any(t["ambiguous"][0] for t in tracks):
        handles.append(Line2D([], [], color=style.INK, lw=1.0, ls=(0, (3, 1.5)),
                              label="the other side of the line"))
    return handles

"""What a receiver found in one ping: beams and Doppler filters against time, detections on top."""
from __future__ import annotations

import numpy as np

from . import processed, style

TITLE = "Detections over bearing, Doppler and time"
nothing_to_show = processed.nothing
LIMITS = (0.0, 30.0)  # dB over the background


def draw(data, ping):
    m, t = processed.maps(data, ping), processed.detections(data, ping)
    several = len(m.doppler) > 1
    fig, panels = style.figure(TITLE, 7.6 if several else 4.8, nrows=2 if several else 1,
                               sharex=True, squeeze=False)
    edges = style.cell_edges(m.time)
    beams = panels[0, 0]
    mesh = style.image(beams, edges, style.cell_edges(m.angle), m.beam_db, LIMITS)
    processed.angle_axis(beams, m)
    handles = processed.mark(beams, t["time"], m.angle_of(t), t, data.target_names)
    handles += true_echoes(beams, data, ping, edges, lambda e: m.angle_of_travel(e.direction))
    style.subtitle(beams, f"{data.heading(ping)}  ·  {len(t['time'])} detections")
    style.colour_bar(fig, mesh, panels[:, 0] if several else beams,
                     "power over the background / dB")
    if several:
        doppler = panels[1, 0]
        shift = data.centre_frequency * (m.doppler - 1.0)
        style.image(doppler, edges, style.cell_edges(shift), m.doppler_db, LIMITS)
        processed.mark(doppler, t["time"], data.centre_frequency * (t["doppler_factor"] - 1.0), t)
        true_echoes(doppler, data, ping, edges,
                    lambda e: data.centre_frequency * (e.doppler - 1.0))
        doppler.set_ylabel("Doppler shift / Hz")
        doppler.set_ylim(shift[0], shift[-1])
        style.image_frame(doppler)
    style.image_frame(beams)
    style.time_axis(panels[-1, 0], edges[0], edges[-1])
    style.legend_below(panels[-1, 0], dark(handles), ncol=4, below=0.2)
    return fig


def true_echoes(axes, data, ping, edges, place):
    """Crosses where the strong path pairs of each target are. → handles"""
    handles = []
    for echo in data.echoes(ping):
        strong = echo.strong(edges[0], edges[-1], 6.0)
        if strong.any():
            y = np.asarray(place(echo))[strong]
            handles += axes.plot(echo.delay[strong], y, ls="none", marker="x", ms=6, mew=1.4,
                                 color=style.colour(echo.target), zorder=6,
                                 path_effects=style.OVER_MAP,
                                 label=f"{style.name(echo.name)}: true echo")
    return handles


def dark(handles):
    """White marks cannot be seen in a legend on white."""
    from copy import copy
    shown = []
    for handle in handles:
        new = copy(handle)
        if new.get_markeredgecolor() == "white":
            new.set_markeredgecolor(style.GREY)
        shown.append(new)
    return shown

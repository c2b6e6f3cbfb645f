"""What a receiver found in one ping: beams and Doppler filters against time, detections on top."""
from __future__ import annotations

import numpy as np

from . import bearings, processed, style

TITLE = "Detections over bearing, Doppler and time"
nothing_to_show = processed.nothing


@style.picture
def draw(data, ping, axes=None, limits=None):
    m, t = processed.maps(data, ping), processed.detections(data, ping)
    limits = limits or processed.limits(data, ping, m)
    several = len(m.doppler) > 1
    fig, panels = style.figure(TITLE, 7.6 if several else 4.8, axes, nrows=2 if several else 1,
                               sharex=True, squeeze=False)
    edges = style.cell_edges(m.time)
    beams = panels[0, 0]
    mesh = style.image(beams, edges, style.cell_edges(m.angle), m.beam_db, limits)
    processed.angle_axis(beams, m)
    handles = processed.mark(beams, t["time"], m.angle_of(t), t, data.target_names)
    handles += true_echoes(beams, data, ping, edges, beam_height(data, ping, m),
                           lambda e: m.angle_of_travel(e.direction))
    style.subtitle(beams, f"{data.heading(ping)}  ·  {len(t['time'])} detections")
    if several:
        doppler = panels[1, 0]
        shift = data.centre_frequency * (m.doppler - 1.0)
        style.image(doppler, edges, style.cell_edges(shift), m.doppler_db, limits)
        processed.mark(doppler, t["time"], data.centre_frequency * (t["doppler_factor"] - 1.0), t)
        true_echoes(doppler, data, ping, edges, max(1.0 / data.pulse_duration, 0.06 * np.ptp(shift)),
                    lambda e: data.centre_frequency * (e.doppler - 1.0))
        doppler.set_ylabel("Doppler shift / Hz")
        doppler.set_ylim(shift[0], shift[-1])
        style.image_frame(doppler)
    both = np.concatenate([m.beam_db.ravel(), m.doppler_db.ravel()])
    style.colour_bar(fig, mesh, list(panels[:, 0]) if several else beams,
                     "power over the background / dB", style.beyond(both, limits))
    style.image_frame(beams)
    style.time_axis(panels[-1, 0], edges[0], edges[-1])
    style.legend_below(panels[-1, 0], processed.legend(handles), ncol=4)
    return fig


def beam_height(data, ping, m) -> float:
    phones = data.phones(ping)
    width = bearings.beam_width(phones, data.centre_frequency,
                                data.sound_speed(float(phones[:, 2].mean())))
    if m.kind == "line":
        return max(width, 0.1)
    return max(np.degrees(width), 18.0)


def true_echoes(axes, data, ping, edges, height: float, place) -> list:
    """A box where each target's strong path pairs are in what the filter gave: at the leading edge,
    as wide as the filter resolves. → handles
    """
    handles = []
    column = float(np.median(np.diff(edges)))
    half = 0.5 * max(1.0 / max(data.bandwidth, 1.0 / data.pulse_duration), column)
    for echo in data.echoes(ping):
        strong = echo.strong(edges[0], edges[-1], 6.0)
        if not strong.any():
            continue
        shade, at = style.colour(echo.target), echo.delay[strong]
        for first, last, y in style.together(at - half, at + half, np.asarray(place(echo))[strong],
                                             0.5 * height):
            style.box(axes, first, last, y - 0.5 * height, y + 0.5 * height, shade)
        handles.append(style.box_key(shade, f"{style.name(echo.name)}: true echo"))
    return handles

"""The pulse's ambiguity surface: what its matched filter answers to other delays and Dopplers."""
from __future__ import annotations

import numpy as np

from . import processed, style

TITLE = "Ambiguity surface of the pulse"


def nothing_to_show(data, ping):
    if not processed.there(data):
        return "the file is not processed (asdic process)"
    if not data.has("processed/ambiguity/power"):
        return "it was processed without maps"
    return None


@style.picture
def draw(data, ping, axes=None, limits=None):
    delay = data.read("processed/ambiguity/delay")
    doppler = data.read("processed/ambiguity/doppler_factor")
    power = data.read("processed/ambiguity/power").astype(float)
    db = 10.0 * np.log10(np.maximum(power, 1e-12))
    fig, axes = style.figure(TITLE, 5.6, axes)
    shift = data.centre_frequency * (doppler - 1.0)
    mesh = style.image(axes, style.cell_edges(delay), style.cell_edges(shift), db,
                       limits or (-50.0, 0.0))
    if (db > -3.0).any():
        lines = axes.contour(delay, shift, db, levels=[-20.0, -3.0], colors="white",
                             linewidths=[0.7, 1.2], linestyles="solid")
        axes.clabel(lines, fmt=lambda v: f"{v:.0f} dB".replace("-", "−"), fontsize=8)
    style.image_frame(axes)
    axes.set_xlabel("delay of the echo over the filter's / s")
    axes.set_ylabel("Doppler shift of the echo / Hz")
    style.colour_bar(fig, mesh, axes, "answer / dB", extend="min")
    style.subtitle(axes, f"{data.title or data.path}  ·  {data.pulse_kind} pulse of "
                         f"{data.pulse_duration:g} s at {data.centre_frequency:g} Hz")
    return fig

"""Traced rays or eigenrays over the sea, in the colour of what they met."""
from __future__ import annotations

import numpy as np
from matplotlib.lines import Line2D

from . import sea, style

TITLE = "Rays"


def nothing_to_show(rays) -> str | None:
    return None if rays.launch.size else "the file holds no rays"


def frame(axes, *sets) -> None:
    """Range, depth and boundaries; the sea is that of the first set that knows it."""
    known = next((r.sea for r in sets if r.sea.boundary_range is not None), sets[0].sea)
    depths = np.concatenate([np.append(r.depth.ravel(), r.bottom_depth) for r in sets])
    sea.depth_axis(axes, *sea.extent(known, depths))
    ranges = np.concatenate([r.range.ravel() for r in sets])
    ranges = ranges[np.isfinite(ranges)] / 1e3
    first, last = (ranges.min(), ranges.max()) if ranges.size else (0.0, 1.0)
    axes.set_xlim(first, max(last, first + 1e-3))
    sea.draw_boundaries(axes, known)
    sea.draw_map_end(axes, known)
    axes.set_xlabel("range from the source / km")
    axes.grid(True)


def histories(rays) -> np.ndarray:
    return np.array([sea.history(s, b) for s, b in zip(rays.surface, rays.bottom)], int)


@style.picture
def draw(rays, axes=None, limits=None):
    fig, axes = sea.figure(TITLE, rays.sea, axes=axes)
    met = histories(rays)
    width = 1.1 if rays.launch.size <= 60 else 0.6
    for k in np.argsort(-met, kind="stable"):       # those that met nothing on top
        axes.plot(rays.range[k] / 1e3, rays.depth[k], color=sea.shade(met[k]), lw=width,
                  alpha=0.8, zorder=2.5)
    frame(axes, rays)
    sea.label_depth(fig, axes)
    style.subtitle(axes, f"{rays.title}{'  ·  ' if rays.title else ''}{rays.launch.size} rays, launched at "
                         f"{style.degrees(rays.launch.min())} to "
                         f"{style.degrees(rays.launch.max())}, up positive")
    handles = [Line2D([], [], color=sea.shade(k), lw=1.8,
                      label=f"{sea.met(k)}: {np.sum(met == k)}")
               for k, _ in enumerate(sea.HISTORIES) if np.any(met == k)]
    style.legend_below(axes, handles)
    return fig

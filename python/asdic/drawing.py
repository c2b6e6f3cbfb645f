"""A scenario as a notebook shows it: a drawing of who is where, and its settings."""
from __future__ import annotations

import html as _html
import math

import numpy as np

WIDTH, HEIGHT = 420, 220


def _escaped(text) -> str:
    return _html.escape(str(text))


def _number(value) -> float | None:
    return float(value) if isinstance(value, (int, float)) and not isinstance(value, bool) else None


def _places(scenario) -> list:
    """(name, kind, range from the first platform [m], depth [m]) of all that has a place."""
    found, origin = [], (0.0, 0.0)
    for kind in ("platforms", "targets"):
        for i, one in enumerate(getattr(scenario, kind)):
            told = one.to_dict()
            position = told.get("position")
            if position is None and isinstance(told.get("waypoints"), list) and told["waypoints"]:
                position = told["waypoints"][0].get("position")
            if position is None and "range" in told:
                b = math.radians(told.get("bearing_deg", 0.0))
                position = [origin[0] + told["range"] * math.sin(b),
                            origin[1] + told["range"] * math.cos(b), told.get("depth", 0.0)]
            if not position or len(position) != 3:
                continue
            if kind == "platforms" and i == 0:
                origin = (position[0], position[1])
            name = told.get("name") or (f"{kind[:-1]} {i + 1}")
            found.append((name, kind, math.hypot(position[0] - origin[0], position[1] - origin[1]),
                          float(position[2])))
    source = scenario.run.source.to_dict().get("depth") if not found else None
    for depth in np.atleast_1d([] if source is None or isinstance(source, dict) else source):
        found.append(("source", "platforms", 0.0, float(depth)))
    return found


def _ends(value) -> tuple | None:
    """The first and last of what an axis says: a number, several, or evenly spaced ones."""
    if isinstance(value, dict) and {"first", "last"} <= value.keys():
        return float(value["first"]), float(value["last"])
    values = value if isinstance(value, list) else [value]
    if not values or any(_number(one) is None for one in values):
        return None
    return min(values), max(values)


def _receivers(scenario) -> tuple | None:
    """(ranges, depths) of a run's receivers, first and last of each; None: there are none."""
    if scenario.platforms:
        return None
    told = scenario.run.receivers.to_dict()
    box = _ends(told.get("range")), _ends(told.get("depth"))
    return None if None in box else box


def svg(scenario) -> str:
    """A section of the sea: surface, floor, platforms, targets; or a run's source and receivers."""
    places, receivers = _places(scenario), _receivers(scenario)
    bottom = scenario.environment.bottom
    shape = bottom.shape.to_dict() if not isinstance(bottom.shape, (int, float, type(None))) else {}
    floor = [(0.0, _number(bottom.depth))]
    if isinstance(shape, dict) and shape.get("range") and shape.get("depth"):
        floor = list(zip(shape["range"], shape["depth"]))
    deepest = max([d for _, d in floor if d is not None] + [p[3] for p in places] + [1.0])
    reach = max([p[2] for p in places] + [r for r, _ in floor]
                + list(receivers[0] if receivers else ()))
    furthest = 1.1 * reach if reach > 0.0 else 1.0
    left, top, wide, high = 44, 16, WIDTH - 60, HEIGHT - 44

    def x(distance: float) -> float:
        return left + wide * max(0.0, distance) / furthest

    def y(depth: float) -> float:
        return top + high * depth / (1.05 * deepest)

    line = [(x(r), y(d)) for r, d in floor if d is not None]
    if len(line) == 1:
        line.append((left + wide, line[0][1]))
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" '
             f'viewBox="0 0 {WIDTH} {HEIGHT}" role="img" font-family="sans-serif" font-size="10" '
             'fill="currentColor">',
             f'<rect x="{left}" y="{top}" width="{wide}" height="{high}" fill="#4a90c2" '
             'fill-opacity="0.18"/>']
    if line:
        points = " ".join(f"{a:.1f},{b:.1f}" for a, b in
                          [*line, (left + wide, line[-1][1]), (left + wide, top + high),
                           (left, top + high), (left, line[0][1])])
        parts.append(f'<polygon points="{points}" fill="#8a6d3b" fill-opacity="0.55"/>')
    if receivers:
        (near, far), (upper, lower) = receivers
        parts.append(f'<rect x="{x(near):.1f}" y="{y(upper):.1f}" width="{x(far) - x(near):.1f}" '
                     f'height="{y(lower) - y(upper):.1f}" fill="#c0392b" fill-opacity="0.06" '
                     'stroke="#c0392b" stroke-dasharray="3 2"/>'
                     f'<text x="{x(far) - 4:.1f}" y="{y(upper) + 12:.1f}" text-anchor="end">receivers</text>')
    for name, kind, distance, depth in places:
        colour = "#1b6ca8" if kind == "platforms" else "#c0392b"
        a, b = x(distance), y(depth)
        end = a > left + 0.75 * wide
        parts.append(f'<circle cx="{a:.1f}" cy="{b:.1f}" r="4" fill="{colour}"/>'
                     f'<text x="{a + (-7 if end else 7):.1f}" y="{b + 3.5:.1f}" '
                     f'text-anchor="{"end" if end else "start"}">{_escaped(name)}</text>')
    parts.append(f'<text x="{left - 7}" y="{top + 4}" text-anchor="end">0 m</text>'
                 f'<text x="{left - 7}" y="{y(deepest) + 4:.1f}" text-anchor="end">'
                 f'{deepest:.0f} m</text>'
                 f'<text x="{left}" y="{HEIGHT - 14}">0 km</text>')
    if reach > 0.0:
        parts.append(f'<text x="{x(reach):.1f}" y="{HEIGHT - 14}" text-anchor="middle">'
                     f'{reach / 1000:.3g} km</text>')
    return "".join(parts) + "</svg>"


def html(scenario) -> str:
    """For notebooks: the drawing, and the scenario as a file beside it."""
    title = _escaped(scenario.title or "a scenario")
    return (f'<div><strong>{title}</strong><br>{svg(scenario)}'
            f'<details><summary>as a file</summary><pre>{_escaped(scenario.to_toml())}</pre>'
            '</details></div>')

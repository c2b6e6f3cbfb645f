"""Every picture as a function: of a file, or of a dataset in memory, on axes of one's own or on new
ones. → matplotlib.figure.Figure

The program's `asdic plot` (command.py) and the notebook's `asdic.pictures` call these.
"""
from __future__ import annotations

from contextlib import contextmanager

from . import area as _area
from . import data as _data
from . import results as _results
from . import scene as _scene
from . import source as _source
from . import study_data as _study_data
from . import style as _style
from .data import InputError
from .output import Tags

OF_PINGS = ("rays", "pressure", "bearing_time", "ppi", "levels", "spectrogram", "matched_filter",
            "sweep", "detections", "range_bearing", "ambiguity", "tracks")
PROCESSED = ("detections", "range_bearing", "ambiguity", "tracks")
OF_RESULTS = ("transmission_loss", "arrivals", "rays")
OF_SCENES = ("geometry", "sound_speed", "array", "pulse")
OF_AREAS = _area.ALL
OF_ALL_ARRAYS = ("rays", "levels", "ambiguity")
WITH_LIMITS = ("pressure", "bearing_time", "ppi", "levels", "spectrogram", "matched_filter", "sweep",
               "detections", "range_bearing", "ambiguity", "transmission_loss", "arrivals",
               *_area.MAPS, "sea_floor")


def module(name: str):
    """That draws a picture of a ping or of a result."""
    from importlib import import_module
    return import_module(f"{__package__}.{name}")


def result_module(result):
    """→ name and module of the picture of a field, arrivals or rays"""
    name, of = {_results.Field: ("transmission_loss", "transmission_loss"),
                _results.Arrivals: ("arrivals", "arrival_stems"),
                _results.Rays: ("rays", "ray_paths")}[type(result)]
    return name, module(of)


def tagged(fig, **tags):
    """What a picture says of itself, kept with it until it is written."""
    fig.tags = Tags(**tags)
    return fig


@contextmanager
def opened(source):
    """A ping file that may be open already."""
    if isinstance(source, _data.PingFile):
        yield source
        return
    with _data.PingFile(source) as data:
        yield data


def select(data, name: str, row: int, array) -> str | None:
    """Chooses the array that a picture is of: the one that is asked for, else the first; range over
    bearing the first that tells bearings. → why there is nothing to draw, or None
    """
    draws = module(name)
    number = array if isinstance(array, int) else data.choose_array(array) if array else 0
    data.select_array(number)
    reason = draws.nothing_to_show(data, row)
    if name in ("ppi", "range_bearing") and reason and not array:
        for other in range(1, len(data.array_names)):
            data.select_array(other)
            if not draws.nothing_to_show(data, row):
                return None
        data.select_array(0)
    return reason


def _checked(limits):
    """(low, high) [dB], or None. Raises InputError."""
    if limits is not None and not (len(limits) == 2 and limits[0] < limits[1]):
        raise InputError("limits", f"{limits}", "(low, high) in dB, low below high")
    return limits


def of_ping(name: str, source, axes=None, *, ping=None, array=None, limits=None, theme=None):
    """A picture of a ping by its name. Raises InputError where there is nothing to draw."""
    with opened(source) as data, _style.look(theme):
        row = data.choose_ping(ping)
        reason = select(data, name, row, array)
        if reason:
            raise InputError(data.path, reason, f"something to draw in {name}")
        return tagged(module(name).draw(data, row, axes=axes, limits=_checked(limits)), **data.tags(row))


def of_result(found, wanted: str, axes=None, *, limits=None, theme=None, **options):
    """A picture of a field, arrivals or rays."""
    result = _results.read(found)
    name, draws = result_module(result)
    if name != wanted:
        raise InputError(_source.name_of(found), f"{name}", f"what {wanted} draws")
    if reason := draws.nothing_to_show(result):
        raise InputError(_source.name_of(found), reason, f"something to draw in {name}")
    with _style.look(theme):
        return tagged(draws.draw(result, axes=axes, limits=_checked(limits), **options), **result.tags)


def of_area(name: str, source, axes=None, *, depth=None, limits=None, theme=None):
    """A picture of what a sonar sees of the area. \\param depth  of the target [m]; none: the first"""
    found = _area.read(source)
    if name not in OF_AREAS:
        raise InputError("what", f'"{name}"', "one of " + ", ".join(OF_AREAS))
    layer = 0
    if depth is not None:
        layer = int(abs(found.depth - depth).argmin())
        if abs(found.depth[layer] - depth) > 0.5:
            raise InputError("depth", f"{depth:g} m",
                             "one of " + ", ".join(f"{d:g}" for d in found.depth))
    if reason := _area.nothing_to_show(found, name):
        raise InputError(_source.name_of(source), reason, f"something to draw in {name}")
    with _style.look(theme):
        return tagged(_area.draw(found, name, layer, axes=axes, limits=_checked(limits)), **found.tags)


def of_placement(name: str, source, axes=None, *, depth=None, theme=None):
    """A picture of where sensors are best put. \\param depth  of the target [m]; none: the first"""
    from . import placement
    found = placement.read(source)
    if name not in placement.ALL:
        raise InputError("what", f'"{name}"', "one of " + ", ".join(placement.ALL))
    layer = 0
    if depth is not None:
        layer = int(abs(found.depth - depth).argmin())
        if abs(found.depth[layer] - depth) > 0.5:
            raise InputError("depth", f"{depth:g} m", "one of " + ", ".join(f"{d:g}" for d in found.depth))
    if reason := placement.nothing_to_show(found, name):
        raise InputError(_source.name_of(source), reason, f"something to draw in {name}")
    with _style.look(theme):
        return tagged(placement.draw(found, name, layer, axes=axes), **found.tags)


def of_scene(name: str, source, axes=None, *, limits=None, theme=None):
    from . import scene_pictures
    scene = source if isinstance(source, _scene.Scene) else _scene.read(source)
    draw, nothing, _ = scene_pictures.PICTURES[name]
    if reason := nothing(scene):
        raise InputError(_source.name_of(source), reason, f"something to draw in {name}")
    with _style.look(theme):
        return tagged(draw(scene, axes=axes, limits=_checked(limits)), **scene.tags)


def of_study(source, only=None, axes=None, *, theme=None) -> dict:
    """→ figures by their names. \\param only  names, if not all; with axes one"""
    from . import study_pictures
    study = source if isinstance(source, _study_data.Study) else _study_data.read(source)
    names = [only] if isinstance(only, str) else only
    if axes is not None and (names is None or len(names) != 1):
        raise ValueError("axes: found pictures of a study, expected one of them, only=\"roc\"")
    with _style.look(theme), _style.onto(axes):
        return {name: tagged(fig, **study.tags)
                for name, fig in study_pictures.draw(study, names)}


def of_two(a, b, names=("A", "B"), axes=None, *, floor: float = 120.0, limits=None, theme=None):
    """A against B: two fields, arrivals or rays."""
    from . import comparison
    first, second = _results.read(a), _results.read(b)
    with _style.look(theme):
        return tagged(comparison.draw(first, second, list(names), floor, axes=axes, limits=_checked(limits)),
                      **first.tags)

"""Every picture of asdic's as a function: of a dataset or a file, on axes of one's own or on new ones.

    import asdic
    from asdic import pictures

    ping = asdic.Scenario("deep_ocean.toml").ping()
    pictures.bearing_time(ping)                     # a figure, which a notebook shows
    fig, axes = plt.subplots()
    pictures.levels("deep_ocean.h5", axes, theme="dark", limits=(40, 90))
    pictures.save(pictures.rays(ping), "rays.pdf")

What may be drawn: the dataset of :meth:`Scenario.ping`, of :func:`asdic.open`, or a path; a field, a
table of arrivals or of rays as :class:`Scenario` gives them; a Scenario. All functions return a
``matplotlib.figure.Figure``. They take

``axes``
    matplotlib axes to draw on, as many as the picture has panels; new ones in a figure of its own.
``theme``
    ``"light"`` or ``"dark"``.
``limits``
    (low, high), the ends of colours or of the axis of levels [dB].

and of pings ``ping``, a ping's number, and ``array``, an array's name or index. Raises InputError
where there is nothing to draw. `asdic plot` draws the same. docs/guide/pictures.md
"""
from __future__ import annotations

import os
import tempfile
from contextlib import contextmanager

import numpy as np

try:
    from asdic_pictures import api as _api
    from asdic_pictures import data as _data
    from asdic_pictures import source as _source
    from asdic_pictures import style as _style
except ModuleNotFoundError as error:
    raise ModuleNotFoundError(f"{error.name}: asdic.pictures needs it (Debian: python3-h5py "
                              "python3-matplotlib)", name=error.name) from None
from asdic_pictures.output import Tags as _Tags

from . import _core, datasets, described, files

__all__ = ["ambiguity", "area", "array", "arrivals", "bearing_time", "compare", "detections",
           "geometry", "levels", "matched_filter", "placement", "ppi", "pressure", "pulse", "range_bearing",
           "rays", "save", "sound_speed", "spectrogram", "study", "sweep", "tracks", "transmission_loss"]


class _Over:
    """A ping's file, with arrays of the dataset's own in the place of the file's."""

    def __init__(self, file, own: dict):
        self._file, self._own = file, own
        self.attrs = file.attrs

    def __contains__(self, name):
        return name in self._file

    def __getitem__(self, name):
        return self._own.get(str(name).strip("/")) or self._file[name]

    def close(self):
        self._file.close()


class _Row:
    """One ping's array as the row of a file. Complex numbers are pairs."""

    def __init__(self, values, like):
        real = np.float64 if values.dtype == np.complex128 else np.float32
        pairs = values.view(real).reshape(*values.shape, 2) if np.iscomplexobj(values) else values
        self._values, self.attrs = pairs[None], like.attrs
        self.shape = self._values.shape

    def __getitem__(self, rows):
        return self._values[rows]


@contextmanager
def _ping(source):
    """A ping file open for reading: a dataset of Scenario.ping is written to one for the time."""
    handle = datasets.ping_of(source) if _source.is_dataset(source) else None
    try:
        if handle is None:
            with _api.opened(source) as data:
                yield data
            return
        import h5py

        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "ping.h5")
            _core.write_ping(path, handle.scenario, handle)
            data = _data.PingFile(path)
            values = np.ascontiguousarray(datasets.as_complex(source["pressure"]).values)
            if values.shape == handle.pressure.shape \
                    and not np.may_share_memory(values, handle.pressure):   # it was changed
                data.file = _Over(data.file, {"pressure": _Row(values, h5py.File(path)["pressure"])})
            with data:
                yield data
    except _data.InputError as error:
        raise described.made(*error.words) from None


def _of_ping(name: str, source, axes, options: dict):
    with _ping(source) as data:
        return _api.of_ping(name, data, axes, **options)


@contextmanager
def _told():
    try:
        yield
    except _data.InputError as error:
        raise described.made(*error.words) from None


@contextmanager
def _result(source):
    """What :func:`asdic.open` reads, of BELLHOP's files too."""
    with _told():
        if _source.is_path(source) and str(source).lower().endswith(files.BELLHOP):
            with tempfile.TemporaryDirectory() as folder:
                made = os.path.join(folder, "result.h5")
                _core.convert_result(os.fspath(source), made)
                yield made
        else:
            yield source


@contextmanager
def _scene(scenario):
    """A scenario as a file to draw."""
    from .scenario import Scenario

    with tempfile.TemporaryDirectory() as folder:
        made = os.path.join(folder, "scene.h5")
        read = Scenario(scenario) if _source.is_path(scenario) else scenario
        _core.write_scene(made, read._core)
        try:
            yield made
        except _data.InputError as error:   # of the scenario, not of the file it went through
            where = os.fspath(scenario) if _source.is_path(scenario) else "scenario"
            raise described.made(where, *error.words[1:]) from None


# ------------------------------------------------------------------------------------ pings


def rays(source, axes=None, **options):
    """Rays: of a ping those of the beam and to the targets (two axes: the sound speed, the rays); of
    a file or table of rays, where they go (one axes, or two).
    """
    if _is_result(source):
        with _result(source) as found:
            return _api.of_result(found, "rays", axes, **options)
    return _of_ping("rays", source, axes, options)


def _is_result(source) -> bool:
    from asdic_pictures import results

    if hasattr(source, "columns") or (_source.is_path(source)
                                      and str(source).lower().endswith(files.BELLHOP)):
        return True
    return results.filetype(source) in results.KINDS


def pressure(source, axes=None, **options):
    """Pressure of every phone as a gather; where there is an echo, also its surroundings (two axes)."""
    return _of_ping("pressure", source, axes, options)


def bearing_time(source, axes=None, **options):
    """Level of every beam over time, by true bearing or elevation."""
    return _of_ping("bearing_time", source, axes, options)


def ppi(source, axes=None, **options):
    """The beams on the map, north up, with detections and the truth in true bearing."""
    return _of_ping("ppi", source, axes, options)


def levels(source, axes=None, **options):
    """Level over time: echo, reverberation, noise, and what is measured."""
    return _of_ping("levels", source, axes, options)


def spectrogram(source, axes=None, **options):
    """Frequency over time around the pulse's."""
    return _of_ping("spectrogram", source, axes, options)


def matched_filter(source, axes=None, **options):
    """The record through the pulse's filter; where there is an echo, also near it (two axes)."""
    return _of_ping("matched_filter", source, axes, options)


def sweep(source, axes=None, **options):
    """The pings of a file, one a row (one axes; two where the beam's elevation changes)."""
    return _of_ping("sweep", source, axes, options)


def detections(source, axes=None, **options):
    """What was found in a processed ping, in beams and in Doppler filters (two axes)."""
    return _of_ping("detections", source, axes, options)


def range_bearing(source, axes=None, **options):
    """Beams over range of a processed ping (one axes; two where sender and array are apart)."""
    return _of_ping("range_bearing", source, axes, options)


def ambiguity(source, axes=None, **options):
    """The ambiguity surface of the pulse of a processed file."""
    return _of_ping("ambiguity", source, axes, options)


def tracks(source, axes=None, **options):
    """Tracks of a processed file, over the truth."""
    return _of_ping("tracks", source, axes, options)


# ------------------------------------------------------------------------------------ fields, rays


def transmission_loss(source, axes=None, **options):
    """Transmission loss of a field (one axes, or two with the sound speed). Of several sources
    ``source=`` says which, from 0.
    """
    with _result(source) as found:
        return _api.of_result(found, "transmission_loss", axes, **options)


def arrivals(source, axes=None, **options):
    """Arrivals as stems, at up to three receivers (an axes each)."""
    with _result(source) as found:
        return _api.of_result(found, "arrivals", axes, **options)


def area(source, axes=None, what="signal_excess", **options):
    """A map of what a sonar sees, of :func:`asdic.area` or a file of it. ``what=`` signal_excess,
    detection_probability, echo_level, reverberation_level, sea_floor or sections; ``depth=`` of the
    target [m], where there are several.
    """
    with _told():
        return _api.of_area(what, source, axes, **options)


def placement(source, axes=None, what="placement", **options):
    """Where sensors are best put, of :func:`asdic.place` or a file of it. ``what=`` placement, candidates,
    sensors or draws; ``depth=`` of the target [m], where there are several.
    """
    with _told():
        return _api.of_placement(what, source, axes, **options)


def compare(a, b, names=("A", "B"), axes=None, **options):
    """Two fields, arrivals or rays, A against B, as ``asdic compare --picture``."""
    with _result(a) as first, _result(b) as second:
        return _api.of_two(first, second, names, axes, **options)


def study(source, only=None, axes=None, *, theme=None):
    """Pictures of a study: a dict of figures by their names, or with ``only="roc"`` that figure."""
    with _told():
        made = _api.of_study(getattr(source, "path", source), only, axes, theme=theme)
    if not isinstance(only, str):
        return made
    if only not in made:
        raise described.made("only", f'"{only}"', "one of the study's: "
                             + ", ".join(_api.of_study(getattr(source, "path", source), theme=theme)))
    return made[only]


# ------------------------------------------------------------------------------------ scenarios


def geometry(scenario, axes=None, **options):
    """Who is where, before anything is computed: map and section (two axes; a run's section: one)."""
    with _scene(scenario) as scene:
        return _api.of_scene("geometry", scene, axes, **options)


def sound_speed(scenario, axes=None, **options):
    """Sound speed of a scenario over depth. ``limits`` are in m/s."""
    with _scene(scenario) as scene:
        return _api.of_scene("sound_speed", scene, axes, **options)


def array(scenario, axes=None, **options):
    """The phones of a scenario's arrays, from above and from the side (two axes an array)."""
    with _scene(scenario) as scene:
        return _api.of_scene("array", scene, axes, **options)


def pulse(scenario, axes=None, **options):
    """The pulse of a scenario's first transmitter: spectrum and ambiguity surface (two axes)."""
    with _scene(scenario) as scene:
        return _api.of_scene("pulse", scene, axes, **options)


def save(figure, path, *, dpi=None, force=False) -> None:
    """Writes a picture as PNG, PDF or SVG, by the name's ending, with what it is of inside: program
    version, scenario digest, ping, title. A file that asdic did not write is not written over, but
    for `force`. Raises InputError.
    """
    with _told():
        if os.path.splitext(os.fspath(path))[1].lower() not in (".png", ".pdf", ".svg"):
            raise _data.InputError(path, "an ending of another format", ".png, .pdf or .svg")
        _style.write(figure, path, force, dpi=dpi, tags=getattr(figure, "tags", _Tags()))

"""The command line: reads the file, draws every picture that it can feed, says what was written."""
from __future__ import annotations

import argparse
import os
import sys
import warnings
from pathlib import Path

from . import output
from .data import InputError, PingFile
from .results import KINDS, filetype


def arguments(argv):
    parser = argparse.ArgumentParser(prog="asdic plot",
                                     description="Draws the pictures of a file of asdic's.")
    parser.add_argument("file", metavar="FILE.h5",
                        help="written by `asdic ping`, `field`, `arrivals`, `rays` or `study`")
    parser.add_argument("-o", "--output", metavar="DIR",
                        help="folder for the pictures (default: FILE without .h5); with --against "
                             "the picture")
    parser.add_argument("--ping", metavar="N", type=int, help="ping to draw (default: the first)")
    parser.add_argument("--array", metavar="NAME",
                        help="array to draw (default: the first; range_bearing the first that "
                             "tells bearings)")
    parser.add_argument("--against", metavar="B.h5", help="draw FILE against this reference")
    parser.add_argument("--names", metavar="NAME", nargs="+", default=[],
                        help="what the files are called in the pictures")
    parser.add_argument("--floor", metavar="DB", type=float, default=120.0,
                        help="differences of fields where both losses are below this")
    parser.add_argument("--force", action="store_true",
                        help="write over files even if asdic did not write them")
    return parser.parse_args(argv)


def default_folder(file: str) -> Path:
    path = Path(file)
    return path.with_suffix("") if path.suffix else path.with_name(path.name + "_pictures")


def say(line: str, stream=None) -> None:
    """Prints; a reader that has gone away (`| head`) is no reason to stop."""
    try:
        print(line, file=stream or sys.stdout, flush=True)
    except BrokenPipeError:
        sys.stdout = open(os.devnull, "w")


def complain(line: str) -> None:
    say(f"asdic plot: {line}", sys.stderr)


def draw_all(data: PingFile, ping: int, folder: Path, array: str | None = None,
             force: bool = False) -> None:
    """Draws each picture, or says why it is left out: there is nothing to show.

    A picture of an earlier run that is left out now is removed, if it is ours, so a folder never
    shows two files' pictures. Those of `asdic process` are spoken of only where it has run.
    Without `array`, what the first receives; range over bearing of the first that tells bearings.
    """
    from . import (ambiguity, bearing_time, detections, levels, matched_filter, pressure, processed,
                   range_bearing, rays, spectrogram, style, sweep, tracks)

    chosen = data.choose_array(array) if array else 0
    of_all = (rays, levels, ambiguity)
    received = (detections, range_bearing, ambiguity, tracks)
    for module in (rays, pressure, bearing_time, levels, spectrogram, matched_filter, sweep,
                   *received):
        name = module.__name__.rsplit(".", 1)[1] + ".png"
        data.select_array(chosen)
        if module is range_bearing and not array:
            select_first(data, lambda: module.nothing_to_show(data, ping))
        reason = module.nothing_to_show(data, ping)
        if reason:
            output.remove(folder / name)
            if module not in received or processed.there(data):
                say(f"{folder / name}: left out, {reason}")
            continue
        style.write(module.draw(data, ping), folder / name, force)
        say(f"{folder / name}: {module.TITLE}{'' if module in of_all else data.of_array}")
    if len(data.array_names) > 1 and not array:
        names = ", ".join(f'"{n}"' for n in data.array_names)
        say(f"the file holds {len(data.array_names)} arrays, {names}: --array NAME draws another")


def select_first(data: PingFile, missing) -> None:
    """The first array of which a picture can be drawn; the first of all if there is none."""
    for number in range(len(data.array_names)):
        data.select_array(number)
        if not missing():
            return
    data.select_array(0)


def draw_result(options) -> None:
    """Each picture of a field, arrivals or rays, as draw_all does for pings."""
    from . import arrival_stems, ray_paths, results, style, transmission_loss

    result = results.read(options.file)
    result.title = result.title or short_name((options.names or [options.file])[0])
    folder = Path(options.output) if options.output else default_folder(options.file)
    folder.mkdir(parents=True, exist_ok=True)
    name, module = {results.Field: ("transmission_loss", transmission_loss),
                    results.Arrivals: ("arrivals", arrival_stems),
                    results.Rays: ("rays", ray_paths)}[type(result)]
    if reason := module.nothing_to_show(result):
        output.remove(folder / f"{name}.png")
        say(f"{folder / name}.png: left out, {reason}")
        return
    sources = result.source_depths.size if isinstance(result, results.Field) else 1
    for source in range(sources):
        path = folder / (f"{name}_{source + 1}.png" if sources > 1 else f"{name}.png")
        style.write(module.draw(result, source) if sources > 1 else module.draw(result), path,
                    options.force)
        say(f"{path}: {module.TITLE}")


def draw_study(options) -> None:
    """Every picture that the summary and the table of a study can feed."""
    from . import study_data, study_pictures, style

    study = study_data.read(options.file)
    folder = Path(options.output) if options.output else default_folder(options.file)
    folder.mkdir(parents=True, exist_ok=True)
    for name, figure in study_pictures.draw(study):
        path = folder / f"{name}.png"
        style.write(figure, path, options.force)
        say(f"{path}: {figure._suptitle.get_text()}")


def draw_comparison(options) -> None:
    from . import comparison, results, style

    a, b = results.read(options.file), results.read(options.against)
    names = options.names if len(options.names) == 2 else [options.file, options.against]
    path = Path(options.output or "comparison.png")
    figure = comparison.draw(a, b, [short_name(name) for name in names], options.floor)
    style.write(figure, path, options.force)
    say(f"{path}: A against B", sys.stderr)


def short_name(path: str) -> str:
    """A file's name with the last two folders: cases often differ in them alone."""
    parts = Path(path).parts
    return str(Path(*parts[-3:])) if parts else path


def run(argv=None) -> int:
    options = arguments(argv)
    if options.against:
        draw_comparison(options)
        return 0
    if filetype(options.file) == "asdic study":
        draw_study(options)
        return 0
    if filetype(options.file) in KINDS:
        draw_result(options)
        return 0
    with PingFile(options.file) as data:
        ping = data.choose_ping(options.ping)
        folder = Path(options.output) if options.output else default_folder(options.file)
        folder.mkdir(parents=True, exist_ok=True)
        draw_all(data, ping, folder, options.array, options.force)
        for warning in data.warnings():
            complain(f"{options.file}: {warning}")
    return 0


def main(argv=None) -> int:
    """Runs; a failure becomes one line and an exit code: 2 the input, 130 Ctrl-C, 1 the rest."""
    output.open_standard_streams()
    warnings.simplefilter("ignore")
    try:
        return run(argv)
    except InputError as error:
        complain(str(error))
        return 2
    except KeyboardInterrupt:
        return 130
    except OSError as error:
        complain(f"{error.filename or 'output'}: {error.strerror or error}")
        return 1
    except Exception as error:  # ours: say so in a line that helps to report it
        if os.environ.get("ASDIC_DEBUG"):
            raise
        complain(f"a fault of asdic itself, please report it ({type(error).__name__}: {error}); "
                 "ASDIC_DEBUG=1 shows where")
        return 1

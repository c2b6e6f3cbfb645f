"""The command line: reads the file, draws every picture that it can feed, says what was written."""
from __future__ import annotations

import argparse
import os
import sys
import warnings
from dataclasses import dataclass, field
from pathlib import Path

from . import api, output
from .data import InputError, PingFile
from .results import KINDS, filetype

# Options of `asdic plot` that are checked here: app/plot_command.cpp hands them over as typed.
OPTIONS = [
    ("--array", "NAME", "array to draw (default: the first; range_bearing the first that tells "
                        "bearings)"),
    ("--only", "NAME,...", "these pictures alone"),
    ("--format", "KIND,...", "png, pdf, svg"),
    ("--dpi", "N", "pixels an inch"),
    ("--theme", "NAME", "light or dark"),
    ("--limits", "LOW:HIGH", "ends of colours and levels [dB]; NAME=LOW:HIGH,... of one each"),
]
LEAST_DPI, MOST_DPI = 30.0, 1200.0


def arguments(argv):
    parser = argparse.ArgumentParser(prog="asdic plot", allow_abbrev=False,
                                     description="Draws the pictures of a file of asdic's.")
    parser.add_argument("file", metavar="FILE.h5",
                        help="written by `asdic ping`, `area`, `place`, `field`, `arrivals`, `rays` or `study`")
    parser.add_argument("-o", "--output", metavar="DIR",
                        help="folder for the pictures (default: FILE without .h5); with --against "
                             "the picture")
    parser.add_argument("--ping", metavar="N", type=int, help="ping to draw (default: the first)")
    for name, kind, told in OPTIONS:
        parser.add_argument(name, metavar=kind, help=told)
    parser.add_argument("--against", metavar="B.h5", help="draw FILE against this reference")
    parser.add_argument("--names", metavar="NAME", nargs="+", default=[],
                        help="what the files are called in the pictures")
    parser.add_argument("--floor", metavar="DB", type=float, default=120.0,
                        help="differences of fields where both losses are below this")
    parser.add_argument("--program", metavar="VERSION", default="", help="of the program that asks")
    parser.add_argument("--html", action="store_true",
                        help="one page for a browser in place of pictures; -o names it, NAME.html, or its folder")
    parser.add_argument("--force", action="store_true",
                        help="write over files even if asdic did not write them")
    return parser.parse_args(argv)


@dataclass
class Wishes:
    """How pictures are to be written, and which."""

    folder: Path
    formats: list = field(default_factory=lambda: ["png"])
    dpi: float | None = None
    theme: str | None = None
    only: list | None = None
    limits: tuple | None = None             # of every picture [dB]
    limits_of: dict = field(default_factory=dict)
    force: bool = False
    program: str = ""

    def wants(self, name: str) -> bool:
        return self.only is None or name in self.only

    def limits_for(self, name: str):
        return self.limits_of.get(name, self.limits)

    def check_names(self, known) -> None:
        """That what was asked for by name can be had of this kind of file. \\throws InputError"""
        known = list(dict.fromkeys(known))
        for option, names in (("--only", self.only or []), ("--limits", self.limits_of)):
            for name in names:
                if name not in known:
                    raise InputError(option, f'"{name}"', "one of " + ", ".join(known))

    def write(self, fig, name: str, told: str) -> None:
        """A picture in every format, and a line for each."""
        from . import style

        tags = getattr(fig, "tags", output.Tags())
        tags.version = self.program or tags.version
        self.folder.mkdir(parents=True, exist_ok=True)
        for kind in self.formats:
            path = self.folder / f"{name}.{kind}"
            style.write(fig, path, self.force, dpi=self.dpi, tags=tags)
            say(f"{path}: {told}")

    def leave_out(self, name: str, reason: str | None) -> None:
        """A picture of an earlier run that is left out now is removed, if it is ours, so a folder
        never shows two files' pictures.
        """
        for kind in output.FORMATS:
            output.remove(self.folder / f"{name}.{kind}")
        if reason:
            say(f"{self.folder / name}.{self.formats[0]}: left out, {reason}")


def pair(option: str, word: str) -> tuple:
    """LOW:HIGH"""
    parts = word.split(":")
    try:
        low, high = (float(p) for p in parts)
    except ValueError:
        low = high = float("nan")
    if not low < high or abs(low) == float("inf") or abs(high) == float("inf"):
        raise InputError(option, f'"{word}"', "LOW:HIGH in dB, LOW below HIGH: --limits 40:90")
    return low, high


def wishes(options, folder: Path) -> Wishes:
    """\\throws InputError"""
    made = Wishes(folder, theme=options.theme, force=options.force, program=options.program)
    if options.format:
        made.formats = list(dict.fromkeys(w.strip().lower().lstrip(".")
                                          for w in options.format.split(",")))
        for word in made.formats:
            if word not in output.FORMATS:
                raise InputError("--format", f'"{word}"', "one of " + ", ".join(output.FORMATS))
    if options.dpi:
        try:
            made.dpi = float(options.dpi)
        except ValueError:
            made.dpi = float("nan")
        if not LEAST_DPI <= made.dpi <= MOST_DPI:
            raise InputError("--dpi", f'"{options.dpi}"',
                             f"a number from {LEAST_DPI:g} to {MOST_DPI:g}")
    if options.theme and options.theme not in ("light", "dark"):
        raise InputError("--theme", f'"{options.theme}"', "light or dark")
    if options.only:
        endings = tuple("." + kind for kind in output.FORMATS)
        words = [w.strip() for w in options.only.split(",") if w.strip()]
        made.only = [w.rsplit(".", 1)[0] if w.endswith(endings) else w for w in words]
    for word in (options.limits or "").split(","):
        name, is_one, rest = word.partition("=")
        if is_one:
            made.limits_of[name.strip()] = pair("--limits", rest)
            if name.strip() not in api.WITH_LIMITS:
                raise InputError("--limits", f'"{name.strip()}"',
                                 "one of " + ", ".join(api.WITH_LIMITS))
        elif word:
            made.limits = pair("--limits", word)
    return made


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


def draw_all(data: PingFile, ping: int, wish: Wishes, array: str | None = None) -> None:
    """Draws each picture, or says why it is left out: there is nothing to show.

    Those of `asdic process` are spoken of only where it has run. Without `array`, what the first
    receives; range over bearing of the first that tells bearings.
    """
    from . import processed

    wish.check_names(api.OF_PINGS)
    number = data.numbers[ping]
    if array:
        data.choose_array(array)
    for name in api.OF_PINGS:
        if not wish.wants(name):
            continue
        reason = api.select(data, name, ping, array)
        if reason:
            silent = name in api.PROCESSED and not processed.there(data) and wish.only is None
            wish.leave_out(name, None if silent else reason)
            continue
        fig = api.of_ping(name, data, ping=int(number), array=data.array,
                          limits=wish.limits_for(name), theme=wish.theme)
        of_array = "" if name in api.OF_ALL_ARRAYS else data.of_array
        wish.write(fig, name, api.module(name).TITLE + of_array)
    if len(data.array_names) > 1 and not array:
        names = ", ".join(f'"{n}"' for n in data.array_names)
        say(f"the file holds {len(data.array_names)} arrays, {names}: --array NAME draws another")


def draw_result(options, wish: Wishes) -> None:
    """Each picture of a field, arrivals or rays, as draw_all does for pings."""
    from . import results

    result = results.read(options.file)
    result.title = result.title or short_name((options.names or [options.file])[0])
    name, module = api.result_module(result)
    wish.check_names([name])
    if reason := module.nothing_to_show(result):
        wish.leave_out(name, reason)
        return
    sources = result.source_depths.size if isinstance(result, results.Field) else 1
    for source in range(sources):
        own = dict(source=source) if sources > 1 else {}
        fig = api.of_result(result, name, limits=wish.limits_for(name), theme=wish.theme, **own)
        wish.write(fig, f"{name}_{source + 1}" if sources > 1 else name, module.TITLE)


def draw_area(options, wish: Wishes) -> None:
    """Maps of what a sonar sees, one for each depth of the target; the sea floor."""
    from . import area

    found = area.read(options.file)
    found.title = found.title or short_name((options.names or [options.file])[0])
    wish.check_names(api.OF_AREAS)
    for name in api.OF_AREAS:
        if not wish.wants(name):
            continue
        if reason := area.nothing_to_show(found, name):
            wish.leave_out(name, reason)
            continue
        told = area.MAPS[name].title if name in area.MAPS else area.OTHERS[name]
        several = name in area.MAPS and found.depth.size > 1
        for k, depth in enumerate(found.depth if several else found.depth[:1]):
            fig = api.of_area(name, found, depth=depth, limits=wish.limits_for(name),
                              theme=wish.theme)
            wish.write(fig, f"{name}_{k + 1}" if several else name, told)


def draw_placement(options, wish: Wishes) -> None:
    """Where sensors are best put, a plan for each depth of the target."""
    from . import placement

    found = placement.read(options.file)
    found.title = found.title or short_name((options.names or [options.file])[0])
    wish.check_names(placement.ALL)
    for name, told in placement.PICTURES.items():
        if not wish.wants(name):
            continue
        if reason := placement.nothing_to_show(found, name):
            wish.leave_out(name, reason)
            continue
        several = name == "placement" and found.depth.size > 1
        for k, depth in enumerate(found.depth if several else found.depth[:1]):
            fig = api.of_placement(name, found, depth=depth, theme=wish.theme)
            wish.write(fig, f"{name}_{k + 1}" if several else name, told)


def draw_scene(options, wish: Wishes) -> None:
    """A scenario before it runs."""
    from . import scene, scene_pictures

    found = scene.read(options.file)
    found.title = found.title or short_name((options.names or [options.file])[0])
    wish.check_names(api.OF_SCENES)
    for name, (_, nothing, told) in scene_pictures.PICTURES.items():
        if not wish.wants(name):
            continue
        if reason := nothing(found):
            wish.leave_out(name, reason)
            continue
        wish.write(api.of_scene(name, found, theme=wish.theme), name, told)


def write_page(options) -> None:
    from asdic_page import page

    for name in ("format", "dpi", "theme", "only", "limits"):
        if getattr(options, name):
            raise InputError(f"--{name}", "--html beside it", "one of the two: a page has them all")
    kind = filetype(options.file)
    if kind in ("asdic study", "asdic comparison"):
        from asdic_page import study_report
        path = study_report.write(options.file, page.place(options.file, options.output), kind, options.force)
        say(f"{path}: a report for a browser")
        return
    with PingFile(options.file) as data:
        path = page.write(data, page.place(options.file, options.output), options.ping,
                          options.array, options.force)
        say(f"{path}: a page for a browser")


def draw_study(options, wish: Wishes) -> None:
    """Every picture that the summary and the table of a study can feed."""
    from . import study_data, study_pictures, style

    study = study_data.read(options.file)
    wish.check_names(name for one in study_pictures.ALL
                     for name in study_pictures.names_of(study, one))
    with style.look(wish.theme):
        for name, figure in study_pictures.draw(study, wish.only):
            wish.write(api.tagged(figure, **study.tags), name, figure.name)
    for name, reason in study_pictures.left_out(study).items():
        if wish.wants(name):
            wish.leave_out(name, reason)


def draw_studies(options, wish: Wishes) -> None:
    """What studies differ by."""
    from . import study_comparison, style

    comparison = study_comparison.read(options.file)
    wish.check_names(study_comparison.names_of(comparison))
    with style.look(wish.theme):
        for name, figure in study_comparison.draw(comparison, wish.only):
            wish.write(api.tagged(figure, **comparison.tags), name, figure.name)


def draw_comparison(options) -> None:
    from . import results, style

    names = options.names if len(options.names) == 2 else [options.file, options.against]
    path = Path(options.output or "comparison.png")
    wish = wishes(options, path.parent)
    fig = api.of_two(results.read(options.file), results.read(options.against),
                     [short_name(name) for name in names], floor=options.floor,
                     limits=wish.limits, theme=wish.theme)
    fig.tags.version = wish.program or fig.tags.version
    style.write(fig, path, options.force, dpi=wish.dpi, tags=fig.tags)
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
    wish = wishes(options, Path(options.output) if options.output else default_folder(options.file))
    if options.html:
        write_page(options)
        return 0
    kind = filetype(options.file)
    if kind == "asdic scene":
        draw_scene(options, wish)
        return 0
    if kind == "asdic area":
        draw_area(options, wish)
        return 0
    if kind == "asdic placement":
        draw_placement(options, wish)
        return 0
    if kind == "asdic study":
        draw_study(options, wish)
        return 0
    if kind == "asdic comparison":
        draw_studies(options, wish)
        return 0
    if kind in KINDS:
        draw_result(options, wish)
        return 0
    with PingFile(options.file) as data:
        ping = data.choose_ping(options.ping)
        draw_all(data, ping, wish, options.array)
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

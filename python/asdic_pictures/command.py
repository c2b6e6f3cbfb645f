"""The command line: reads the file, draws every picture that it can feed, says what was written."""
from __future__ import annotations

import argparse
import os
import sys
import warnings
from pathlib import Path

from .data import InputError, PingFile


def arguments(argv):
    parser = argparse.ArgumentParser(prog="asdic plot",
                                     description="Draws the pictures of a ping file.")
    parser.add_argument("file", metavar="FILE.h5", help="a ping file, written by `asdic ping`")
    parser.add_argument("-o", "--output", metavar="DIR",
                        help="folder for the pictures (default: FILE without .h5)")
    parser.add_argument("--ping", metavar="N", type=int, help="ping to draw (default: the first)")
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


def draw_all(data: PingFile, ping: int, folder: Path) -> None:
    """Draws each picture, or says why it is left out: there is nothing to show.

    A picture of an earlier run that is left out now is removed, so a folder never shows two files'
    pictures.
    """
    from . import (bearing_time, levels, matched_filter, pressure, rays, spectrogram, style,
                   sweep)

    for module in (rays, pressure, bearing_time, levels, spectrogram, matched_filter, sweep):
        name = module.__name__.rsplit(".", 1)[1] + ".png"
        reason = module.nothing_to_show(data, ping)
        if reason:
            (folder / name).unlink(missing_ok=True)
            say(f"{folder / name}: left out, {reason}")
            continue
        style.write(module.draw(data, ping), folder / name)
        say(f"{folder / name}: {module.TITLE}")


def run(argv=None) -> int:
    options = arguments(argv)
    with PingFile(options.file) as data:
        ping = data.choose_ping(options.ping)
        folder = Path(options.output) if options.output else default_folder(options.file)
        folder.mkdir(parents=True, exist_ok=True)
        draw_all(data, ping, folder)
        for warning in data.warnings():
            complain(f"{options.file}: {warning}")
    return 0


def main(argv=None) -> int:
    """Runs; a failure becomes one line and an exit code: 2 the input, 130 Ctrl-C, 1 the rest."""
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

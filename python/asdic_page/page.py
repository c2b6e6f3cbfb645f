"""One file that shows a ping file in a browser: style, data and script stand in it."""
from __future__ import annotations

import html
import json
import os
from pathlib import Path

from asdic_pictures import output
from asdic_pictures.data import InputError, PingFile

from .content import content

HERE = Path(__file__).resolve().parent
SCRIPTS = ("state", "words", "cells", "axes", "panel", "image", "levels", "rays", "plan", "chosen",
           "page")     # in this order
MARK = '<meta name="generator" content="asdic'     # pages of ours have it near their beginning
# The browser refuses whatever the page might ask a network for.
POLICY = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:"

PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
{mark}{version}">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<link rel="icon" href="data:,">
<title>{title}</title>
<style>
{css}</style>
</head>
<body>
<header>
<h1><span id="title"></span><small id="file"></small></h1>
<span id="targets" role="group" aria-label="targets"></span>
<label>ping <select id="ping"></select></label>
<label>array <select id="array"></select></label>
<button type="button" id="theme">light or dark</button>
</header>
<noscript><p>This page draws its panels with JavaScript, which is off.</p></noscript>
<main>
<div id="time"></div>
<div id="side">
<div id="space"></div>
<div id="words">
<section class="card"><h2>This ping</h2><dl id="about"></dl><ul id="warnings"></ul>
<p class="keys">Wheel or drag: zoom. Shift and drag: move. Double click: all of it. A click holds
the time or chooses what is under it. Keys: <kbd>Tab</kbd> to a panel, arrows, <kbd>+</kbd>
<kbd>−</kbd> <kbd>0</kbd>, <kbd>Enter</kbd>; <kbd>t</kbd> next target,
<kbd>[</kbd> <kbd>]</kbd> pings, <kbd>Esc</kbd> lets go.</p></section>
<details class="card" id="found" open><summary>Detections</summary><div class="scroll"><table>
<thead><tr><th>time / s</th><th>SNR / dB</th><th>bearing, true</th><th>range / km</th>
<th>Doppler / Hz</th><th>what it is</th></tr></thead>
<tbody></tbody></table></div></details>
<section class="card"><h2>Scenario</h2><pre id="scenario" tabindex="0"></pre></section>
<details class="card" open><summary>What is shown, and what not</summary><ul id="notes"></ul>
</details>
</div>
</div>
</main>
<div id="tip" role="status" hidden></div>
<script type="application/json" id="data">{data}</script>
<script>
{script}</script>
</body>
</html>
"""


def encoded(page: dict) -> str:
    """JSON that can stand in HTML: no text of a scenario ends its element."""
    text = json.dumps(page, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")


def text(data: PingFile, ping: int | None = None, array: str | None = None) -> str:
    """The page of a ping file. \\throws InputError"""
    page = content(data, ping, array)
    return PAGE.format(mark=MARK, version=" " + html.escape(page["version"]), policy=POLICY,
                       title=html.escape(page["title"]) + " · asdic", data=encoded(page),
                       css=(HERE / "page.css").read_text(encoding="utf-8"),
                       script="\n".join((HERE / "script" / f"{name}.js").read_text(encoding="utf-8")
                                        for name in SCRIPTS))


def is_ours(path: Path) -> bool:
    """Whether a page says of itself that asdic has written it."""
    try:
        with open(path, encoding="utf-8", errors="replace") as file:
            return MARK in file.read(400)
    except OSError:
        return False


def place(file, wanted=None) -> Path:
    """Path of the page: beside the file, at `wanted` if that ends in .html, or else in the folder `wanted`, which is
    made if needed. \\throws InputError, OSError
    """
    name = Path(file).with_suffix(".html") if Path(file).suffix else Path(f"{file}.html")
    if not wanted:
        return name
    wanted = Path(wanted)
    if wanted.suffix.lower() in (".html", ".htm") and not wanted.is_dir():
        return wanted
    if wanted.exists() and not wanted.is_dir():
        raise InputError(wanted, "a file", "a folder for the page, or its name, which ends in .html")
    wanted.mkdir(parents=True, exist_ok=True)
    return wanted / name.name


def save(made: str, path: Path) -> None:
    """Writes a page, whole or not at all. \\throws OSError with the path when it cannot be written"""
    part = None
    try:
        part, descriptor = output.new_part(path)
        with open(descriptor, "w", encoding="utf-8") as file:
            file.write(made)
            file.flush()
            os.fsync(file.fileno())
        os.replace(part, path)
        part = None
    except OSError as error:
        error.filename = str(path)
        raise
    finally:
        if part is not None:
            part.unlink(missing_ok=True)


def write(data: PingFile, path, ping: int | None = None, array: str | None = None,
          force: bool = False) -> Path:
    """Writes the page, whole or not at all, never over what asdic did not write.

    \\throws InputError; OSError with the path when it cannot be written
    """
    path = Path(path)
    output.check(path, force or is_ours(path))
    save(text(data, ping, array), path)
    return path


__all__ = ["InputError", "PingFile", "place", "text", "write"]

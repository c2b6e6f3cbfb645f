"""Where pictures go: whole under their name, and never over what asdic did not draw."""
from __future__ import annotations

import os
import re
import secrets
import stat
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

from .data import InputError

SOFTWARE = "asdic"       # what a picture says of its program begins with it
SIGNATURE = b"\x89PNG\r\n\x1a\n"
LETTERS = "0123456789abcdefghijklmnopqrstuvwxyz"
FORMATS = ("png", "pdf", "svg")


@dataclass
class Tags:
    """What a picture says of itself: PNG's tEXt, PDF's information, SVG's metadata."""

    title: str = ""         # of the scenario, the study or the case
    version: str = ""       # of the program that made the numbers
    digest: str = ""        # SHA-256 of the scenario
    ping: int | None = None

    def words(self, picture: str) -> dict[str, str]:
        told = {"Title": picture, "Scenario": self.title, "Scenario-SHA256": self.digest,
                "Ping": "" if self.ping is None else str(self.ping)}
        return {key: value for key, value in told.items() if value}

    def metadata(self, kind: str, picture: str) -> dict:
        """As matplotlib takes it. No dates: the same numbers make the same file."""
        program = f"{SOFTWARE} {self.version}".strip()
        told = self.words(picture)
        rest = {key: value for key, value in told.items() if key != "Title"}
        lines = "; ".join(f"{key}: {value}" for key, value in rest.items())
        if kind == "png":
            return {"Software": program} | {k: latin(v) for k, v in told.items()}
        if kind == "pdf":
            return {"Creator": program, "Title": picture, "Subject": lines, "CreationDate": None}
        return {"Creator": program, "Title": picture, "Description": lines, "Date": None,
                "Keywords": [f"{key}={value}" for key, value in rest.items()]}


def latin(text: str) -> str:
    """PNG's tEXt is Latin-1."""
    return text.replace("–", "-").replace("−", "-").encode("latin-1", "replace").decode("latin-1")


def open_standard_streams() -> None:
    """Descriptors 0 to 2 are open from here on, to /dev/null where they were closed: what a library
    says on standard error would go into the picture that got its number.
    """
    for stream in range(3):
        try:
            os.fstat(stream)
        except OSError:
            os.open(os.devnull, os.O_RDWR)


def is_ours(path: Path) -> bool:
    """Whether a picture says of itself that asdic has drawn it."""
    try:
        if not stat.S_ISREG(os.lstat(path).st_mode):
            return False
        with open(path, "rb") as file:
            head = file.read(8)
            file.seek(0)
            if head == SIGNATURE:
                return is_our_png(file)
            if head.startswith(b"%PDF-"):
                return is_our_pdf(file.read())
            if head.lstrip().startswith(b"<"):
                return is_our_svg(file)
    except (OSError, ElementTree.ParseError, ValueError):
        pass
    return False


def is_our_png(file) -> bool:
    file.seek(len(SIGNATURE))
    while len(head := file.read(8)) == 8:
        size, kind = int.from_bytes(head[:4], "big"), head[4:]
        if kind == b"IDAT":
            return False
        content = file.read(size)
        if kind == b"tEXt" and content.startswith(b"Software\0" + SOFTWARE.encode()):
            return True
        file.seek(4, os.SEEK_CUR)  # the chunk's checksum
    return False


def is_our_pdf(content: bytes) -> bool:
    """By the information of the document itself: a paper that holds one of ours is not ours."""
    ends = content.rfind(b"trailer")
    told = re.search(rb"/Info (\d+) 0 R", content[ends:]) if ends >= 0 else None
    if not told:
        return False
    starts = content.rfind(b"\n" + told[1] + b" 0 obj")
    information = content[starts: content.find(b"endobj", starts)] if starts >= 0 else b""
    return b"/Creator (" + SOFTWARE.encode() in information


def is_our_svg(file) -> bool:
    """By its first metadata. What an editor has been at is the user's."""
    head = file.read(4096)
    if any(editor in head for editor in (b"inkscape", b"sodipodi", b"Illustrator", b"figma")):
        return False
    file.seek(0)
    inside = []
    for event, element in ElementTree.iterparse(file, ("start", "end")):
        word = element.tag.rsplit("}", 1)[-1]
        if event == "start":
            inside.append(word)
            if len(inside) == 2 and word not in ("title", "metadata"):
                return False
        else:
            if word == "title" and "creator" in inside:
                return (element.text or "").startswith(SOFTWARE)
            if word == "metadata":
                return False
            inside.pop()
    return False


def check(path: Path, force: bool) -> None:
    """That a picture may get this name. \\throws InputError"""
    try:
        there = os.lstat(path)
    except OSError:
        return  # nothing there, or the folder will say what is wrong
    if not stat.S_ISREG(there.st_mode):
        raise InputError(path, "something that is no file", "no such file, or a picture of asdic's")
    if not (force or there.st_size == 0 or is_ours(path)):
        raise InputError(path, "a file that asdic did not write",
                         "another folder or name, or --force to write over it")


def remove(path: Path) -> None:
    """A picture of an earlier run, if it is ours."""
    if is_ours(path):
        path.unlink(missing_ok=True)


def write(fig, path: Path, force: bool = False, dpi: float | None = None,
          tags: Tags | None = None) -> None:
    """Draws into a part with a name that nobody had, brings it to the disk, renames it. The name's
    ending tells the format.

    \\throws InputError as check(); OSError with the path when it cannot be written
    """
    path = Path(path)
    check(path, force)
    kind = path.suffix[1:].lower()
    kind = kind if kind in FORMATS else "png"
    told = (tags or Tags()).metadata(kind, getattr(fig, "name", ""))
    part = None
    try:
        part, descriptor = new_part(path)
        with open(descriptor, "wb") as file:
            fig.savefig(file, format=kind, dpi=dpi or "figure", metadata=told)
            file.flush()
            os.fsync(file.fileno())
        os.replace(part, path)
        part = None
        folder = os.open(path.parent, os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)
    except OSError as error:
        error.filename = error.filename or str(path)
        raise
    finally:
        if part is not None:
            part.unlink(missing_ok=True)


def new_part(path: Path) -> tuple[Path, int]:
    """NAME.k3f9.part beside it, and its descriptor."""
    while True:
        mark = "".join(secrets.choice(LETTERS) for _ in range(4))
        part = path.with_name(f"{path.name}.{mark}.part")
        try:
            return part, os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o666)
        except FileExistsError:
            continue

"""Where pictures go: whole under their name, and never over what asdic did not draw."""
from __future__ import annotations

import os
import secrets
import stat
from pathlib import Path

from .data import InputError

SOFTWARE = "asdic"       # PNG, tEXt, Software: ours begin with it
SIGNATURE = b"\x89PNG\r\n\x1a\n"
LETTERS = "0123456789abcdefghijklmnopqrstuvwxyz"


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
            if file.read(8) != SIGNATURE:
                return False
            while len(head := file.read(8)) == 8:
                size, kind = int.from_bytes(head[:4], "big"), head[4:]
                if kind == b"IDAT":
                    return False
                content = file.read(size)
                if kind == b"tEXt" and content.startswith(b"Software\0" + SOFTWARE.encode()):
                    return True
                file.seek(4, os.SEEK_CUR)  # the chunk's checksum
    except OSError:
        pass
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


def write(fig, path: Path, force: bool = False) -> None:
    """Draws into a part with a name that nobody had, brings it to the disk, renames it.

    \\throws InputError as check(); OSError with the path when it cannot be written
    """
    path = Path(path)
    check(path, force)
    part = None
    try:
        part, descriptor = new_part(path)
        with open(descriptor, "wb") as file:
            fig.savefig(file, format="png", metadata={"Software": SOFTWARE})
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

"""The same bits however the work is done."""
import h5py
import numpy as np

from law import copied, expect, law, ping
from program import Folder, run


def compare(a, b, what):
    expect(a.bits == b.bits, f"{what}: other samples")
    for table in ("arrivals", "echoes", "summary", "levels", "patches"):
        for name, values in getattr(a, table).items():
            other = getattr(b, table).get(name)
            expect(other is not None and np.array_equal(values, other, equal_nan=np.asarray(values).dtype.kind == "f"), f"{what}: /{table}/{name} differs")


@law
def same_for_threads(s, p):
    """One thread and three give the same file."""
    from program import Record
    first = ping(s)
    with Folder(s) as folder:
        run(folder, "ping", "s.toml", "-o", "o.h5", "-q", "--threads", "3")
        compare(first, Record(folder / "o.h5"), "three threads")


@law
def same_for_parts(s, p):
    """The first ping of several is that ping alone."""
    s["pings"]["count"] = 3
    s["pings"].pop("continuous", None)
    whole, part = ping(s), ping(s, "--pings", "1")
    expect(np.array_equal(whole.pressure[0], part.pressure[0]), "the first of three pings is another than it is alone")


@law
def same_once_more(s, p):
    """A second run gives the same file."""
    from program import Record
    first = ping(s)
    with Folder(s) as folder:
        run(folder, "ping", "s.toml", "-o", "o.h5", "-q", "--threads", "1")
        compare(first, Record(folder / "o.h5"), "a second run")


@law
def written_scenario(s, p):
    """The scenario as a file holds it makes the same samples."""
    from program import Record
    with Folder(s) as folder:
        run(folder, "ping", "s.toml", "-o", "o.h5", "-q", "--threads", "1")
        with h5py.File(folder / "o.h5") as file:
            text = file["scenario"][()]
        (folder / "again.toml").write_bytes(text if isinstance(text, bytes) else str(text).encode())
        first = Record(folder / "o.h5")
        run(folder, "ping", "again.toml", "-o", "p.h5", "-q", "--threads", "1")
        compare(first, Record(folder / "p.h5"), "the file's own scenario")

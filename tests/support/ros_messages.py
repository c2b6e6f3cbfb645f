"""The classes of ros/asdic_msgs for tests.

generate(folder)   Python modules as ROS 1 has them, by Debian's genpy
strict(folder)     stand-ins for those of ROS 2: fields of the types that the files say, nothing
                   else
"""
import re
import subprocess
import sys
import types
from pathlib import Path

MESSAGES = Path(__file__).resolve().parents[2] / "ros/asdic_msgs/msg"
GENERATOR = Path("/usr/lib/genpy/genmsg_py.py")
# what std_msgs has: the generator reads it, and hashes it
HEADER = "uint32 seq\ntime stamp\nstring frame_id\n"


def generate(folder):
    """folder/asdic_msgs/msg becomes a package of Python"""
    folder = Path(folder)
    std = folder / "std_msgs_sources"
    std.mkdir()
    (std / "Header.msg").write_text(HEADER)
    out = folder / "asdic_msgs/msg"
    out.mkdir(parents=True)
    (folder / "asdic_msgs/__init__.py").write_text("")
    files = sorted(MESSAGES.glob("*.msg"))
    common = [sys.executable, str(GENERATOR)]
    subprocess.run([*common, "-p", "asdic_msgs", "-I", f"asdic_msgs:{MESSAGES}", "-I", f"std_msgs:{std}",
                    "-o", str(out), *map(str, files)], check=True, capture_output=True)
    subprocess.run([*common, "-o", str(out), "--initpy"], check=True, capture_output=True)


def fields_of(text):
    """→ [(type, is array, name)]"""
    found = []
    for line in text.splitlines():
        line = line.split("#")[0].split()
        if line:
            kind, name = line
            assert re.fullmatch("[a-z][a-z0-9_]*", name), f"ROS 2 has no field {name}"
            found.append((kind.removesuffix("[]"), kind.endswith("[]"), name))
    return found


def _check(kind, value):
    if kind in ("float64", "float32"):
        return isinstance(value, float)
    if kind == "uint32":
        return isinstance(value, int) and not isinstance(value, bool) and 0 <= value < 1 << 32
    if kind in ("bool", "string"):
        return isinstance(value, {"bool": bool, "string": str}[kind])
    return type(value).__name__ == kind.split("/")[-1]


def strict(header):
    """→ a module with a class for each message, which refuses what ROS 2's would. header: makes
    one
    """
    module = types.ModuleType("msg")
    starts = {"float64": lambda: 0.0, "float32": lambda: 0.0, "uint32": lambda: 0, "bool": lambda: False,
              "string": lambda: "", "std_msgs/Header": header}

    def make(name, fields):
        kinds = {field: (kind, many) for kind, many, field in fields}

        def begin(self):
            for field, (kind, many) in kinds.items():
                setattr(self, field, [] if many else starts[kind]())

        def put(self, field, value):
            kind, many = kinds[field]
            good = all(_check(kind, one) for one in value) if many else _check(kind, value)
            assert good, f"{name}.{field}: {value!r} is no {kind}"
            object.__setattr__(self, field, value)

        return type(name, (), {"__init__": begin, "__setattr__": put})

    for file in sorted(MESSAGES.glob("*.msg")):
        setattr(module, file.stem, make(file.stem, fields_of(file.read_text())))
    return module

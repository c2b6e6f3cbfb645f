"""Mission files of MOOS (`.moos`): values of the mission, and blocks of its apps.

    ServerHost = localhost        // of the mission
    MOOSTimeWarp = 10

    ProcessConfig = asdic-moos    // of an app
    {
      Scenario = deep_ocean.toml
    }
"""
from pathlib import Path

LARGEST = 1 << 20


class MissionError(ValueError):
    """Where, what was found, what was expected."""


class Block:
    """Values by name, whatever its case. `lines` has where each stands."""

    def __init__(self, where):
        self.where = where
        self.values, self.lines, self.names = {}, {}, {}

    def add(self, name, value, line):
        key = name.lower()
        if key in self.values:
            raise MissionError(f"{self.where}:{line}: found {name} twice, expected it once")
        self.values[key], self.lines[key], self.names[key] = value, line, name

    def get(self, name, default=None):
        return self.values.get(name.lower(), default)

    def place(self, name):
        return f"{self.where}:{self.lines[name.lower()]}: {name}"


def read(path, app):
    """→ the mission's Block, the app's Block (None: there is none). \\throws MissionError,
    OSError
    """
    path = Path(path)
    if path.stat().st_size > LARGEST:
        raise MissionError(f"{path}: found {path.stat().st_size} bytes, expected at most {LARGEST}")
    lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    mission, blocks, block, opened = Block(path), {}, None, True
    for number, line in enumerate(lines, 1):
        line = line.split("//")[0].strip()
        if not line:
            continue
        if line == "{":
            if block is None or opened:
                raise MissionError(f"{path}:{number}: found {{, expected ProcessConfig = NAME "
                                   "before")
            opened = True
        elif line == "}":
            if block is None or not opened:
                raise MissionError(f"{path}:{number}: found }}, expected no end of a block here")
            block = None
        else:
            name, equals, value = (part.strip() for part in line.partition("="))
            if not equals or not name:
                if block is not None and block.app != app:
                    continue  # another app's, by rules of its own
                raise MissionError(f'{path}:{number}: found "{line[:60]}", expected NAME = VALUE')
            if name.lower() == "processconfig" and block is None:
                block, opened = Block(path), False
                block.app = value
                if value == app and value in blocks:
                    raise MissionError(f"{path}:{number}: found a second block of {app}, "
                                       "expected one")
                blocks[value] = block
            elif block is None:
                if name.lower() not in mission.values:
                    mission.add(name, value, number)
            elif block.app == app:
                block.add(name, value, number)
    if block is not None:
        raise MissionError(f"{path}: found no }} of the last block, expected one")
    return mission, blocks.get(app)

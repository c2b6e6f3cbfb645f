"""Factors of a scenario as the program itself describes them: `asdic settings --schema`.

A factor is a setting with a few levels, the simplest first. Words and flags have their own values as levels, numbers
have "absent" and "drawn". A setting that nobody has thought of here is a factor from the day it is described.
"""
import json
import os
import subprocess
import sys
from functools import lru_cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
import json_schema  # noqa: E402

ASDIC = os.environ.get("ASDIC", str(ROOT / "build/release/bin/asdic"))

# Settings that are no factors of their own, and why.
LEFT_OUT = {
    "title": "text", "seed": "drawn with every scenario", "include": "the law `included_file` writes it",
    "environment.origin": "nothing is computed of it but latitudes and longitudes",
    "environment.transect": "the law `shifted_world` moves it",
    "environment.area": "the factor `sea` writes its map",
    "environment.surface.depth": "the factor `sea` moves the surface",
    "run": "runs of the propagation model, which the law `legs_are_waves` makes",
    "reverberation.seabed": "needs a map of classes",
    "reverberation.most_returns": "changes how much is drawn, and the cost",
    "reverberation.scatterers_per_cell": "multiplies the cost",
    "reverberation.azimuths": "multiplies the cost",
    "reverberation.resolve_azimuth": "multiplies the cost",
    "reverberation.ground_spacing": "multiplies the cost",
    "pings.recording_duration": "follows from the distance", "pings.recording_start": "follows from the distance",
    "pings.sample_rate": "follows from the pulse", "pings.carrier": "follows from the pulse",
    "pings.baseband_rate": "follows from the pulse", "pings.interval": "follows from the record",
    "pings.elevations_deg": "beside transmitter.elevation_deg it is refused",
    "target.first_ping": "no echo without it", "target.last_ping": "no echo without it",
    "target.heading_deg": "the factor `target` sets it",
    "transmitter.first_ping_time": "follows from the record", "transmitter.interval": "follows from the record",
    "transmitter.elevations_deg": "beside transmitter.elevation_deg it is refused",
    "transmitter.pulse": "the file's own [pulse] is drawn",
    "interferer.waypoints": "as of platforms", "platform.waypoints": "the factor `motion` sets them",
    "target.waypoints": "the factor `motion` sets them",
}

# Keys that the reader takes beside another alone.
BESIDE = {"correlation_length": "k_shape"}
# Keys of which the reader takes one alone.
APART = [{"coherence_time", "frozen"}, {"sea_state", "wind_speed"}]


@lru_cache(maxsize=None)
def schema():
    said = subprocess.run([ASDIC, "settings", "--schema"], check=True, capture_output=True, text=True).stdout
    return json.loads(said)


def faults(scenario):
    """Where a scenario is not what the schema says."""
    return list(json_schema.faults({k: v for k, v in scenario.items() if not k.startswith("_")}, schema()))


def fits(table, key):
    """Whether the reader takes a key beside those of a table."""
    return key not in table and {BESIDE.get(key)} <= {None, *table} and not any(
        key in one and one & set(table) for one in APART)


def choices(node):
    return node["anyOf"] if "anyOf" in node else [node]


def table_of(node):
    """The table that a setting is, alone or in a list; None of a value."""
    for choice in choices(node):
        if choice.get("type") == "object" and "properties" in choice:
            return choice
        if choice.get("type") == "array" and choice["items"].get("type") == "object":
            return choice["items"]
    return None


def settings(table=None, place=()):
    """(path, schema) of every value and every optional table, paths like ("environment", "surface", "kind")."""
    for key, node in (schema() if table is None else table)["properties"].items():
        path = (*place, key)
        inner = table_of(node)
        if key.endswith("_rad") or any(".".join(path).startswith(name + ".") or ".".join(path) == name
                                       for name in LEFT_OUT):
            continue
        yield path, node
        if inner is not None:
            yield from settings(inner, path)


def words(node):
    return [word for choice in choices(node) for word in choice.get("enum", ())]


def is_flag(node):
    return any(choice.get("type") == "boolean" for choice in choices(node))


def bounds(node):
    """(lowest, highest, default, whole) of a number; None of anything else."""
    for choice in choices(node):
        if choice.get("type") in ("number", "integer"):
            low = choice.get("minimum", choice.get("exclusiveMinimum", float("-inf")))
            return low, choice.get("maximum", float("inf")), node.get("default", choice.get("default")), \
                choice["type"] == "integer"
    return None


def words_at(*path):
    """Words of a setting, its default first."""
    node = schema()
    for key in path:
        node = (table_of(node) if "properties" not in node else node)["properties"][key]
    found = list(dict.fromkeys(words(node)))
    default = node.get("default")
    return ([default] if default in found else []) + [word for word in found if word != default]


def generic_factors(claimed):
    """Factors of all settings that no recipe has claimed: name → levels, the simplest first."""
    made = {}
    for path, node in settings():
        name = ".".join(path)
        if name in claimed or any(one.endswith(".*") and name.startswith(one[:-1]) for one in claimed):
            continue
        if words(node) and bounds(node) is None:
            made[name] = ["absent", *dict.fromkeys(words(node))]
        elif is_flag(node):
            made[name] = ["absent", True, False]
        elif bounds(node) is not None:
            made[name] = ["absent", "drawn"]
        elif table_of(node) is not None and len(path) > 1:
            made[name] = ["absent", "table"]
    return made

"""Settings of asdic on a vehicle by their names, whatever carries them: a `.moos` block, ROS's
parameters.
"""
import math
import shlex
from dataclasses import dataclass, field, fields

from .quantities import Wrong, number, shown
from .tracker import TrackerSettings


@dataclass
class Settings:
    """As the mission file or ROS's parameters have them."""

    scenario: str = ""            # of an own server, and for sound paths
    arguments: list = field(default_factory=list)  # of `asdic serve`, further ones
    program: str = "asdic"
    socket: str = ""              # of a running server, instead
    tcp: int = 0
    token_file: str = ""
    pace: str = "clock"           # "clock": of the middleware; "fast": as soon as results are had
    factor: float = 1.0           # how fast that clock goes
    platform: str = ""            # the first, where there are several
    array: str = ""
    array_follows_heading: bool = False
    # "pings": the record of each; "listen": a stream; "none"; "auto": a stream where there can be one
    delivery: str = "auto"
    receiver: bool = True
    receiver_options: list = field(default_factory=list)
    most_detections: int = 50
    block: float = 1.0            # of samples [s]
    update: float = 1.0           # while listening, between changes [s]
    folder: str = "asdic-data"
    files_kept: int = 100         # pings whose files are kept
    tracker: TrackerSettings = field(default_factory=TrackerSettings)


# name → (field of Settings, kind or (low, high))
NAMES = {
    "Scenario": ("scenario", str), "Arguments": ("arguments", list), "Program": ("program", str),
    "Socket": ("socket", str), "TCP": ("tcp", (1, 65535)), "TokenFile": ("token_file", str),
    "Pace": ("pace", ("clock", "fast")), "Platform": ("platform", str), "Array": ("array", str),
    "ArrayFollowsHeading": ("array_follows_heading", bool),
    "Delivery": ("delivery", ("auto", "pings", "listen", "none")), "Receiver": ("receiver", bool),
    "ReceiverOptions": ("receiver_options", list), "MostDetections": ("most_detections", (1, 1000)),
    "Block": ("block", (0.001, 3600.0)), "Update": ("update", (0.01, 3600.0)),
    "Folder": ("folder", str), "FilesKept": ("files_kept", (1, 1000000)),
}
TRACKER = {
    "TrackHits": ("hits", (1, 20)), "TrackOf": ("of", (1, 20)),
    "TrackMisses": ("misses", (1, 1000)), "TrackAcceleration": ("acceleration", (1e-6, 100.0)),
    "TrackMaxSpeed": ("most_speed", (0.1, 100.0)),
    "TrackRangeSigma": ("range_sigma", (0.1, 1e5)),
    "TrackBearingSigma": ("bearing_sigma_deg", (0.01, 90.0)),
    "TrackRateSigma": ("rate_sigma", (0.001, 1000.0)),
}


def value_of(kind, value, where):
    """\\throws Wrong"""
    if kind is str:
        if not isinstance(value, str) or len(value) > 4096:
            raise Wrong(where, shown(value), "a text")
        return value
    if kind is list:
        try:
            return shlex.split(value) if isinstance(value, str) else [str(v) for v in value]
        except ValueError as error:
            raise Wrong(where, shown(value), f"words as in a shell ({error})") from None
    if kind is bool:
        word = value if isinstance(value, bool) else \
            {"true": True, "yes": True, "false": False, "no": False}.get(str(value).strip().lower())
        if word is None:
            raise Wrong(where, shown(value), "true or false")
        return word
    if isinstance(kind[0], str):
        word = str(value).strip().lower()
        if word not in kind:
            raise Wrong(where, shown(value), "one of " + ", ".join(kind))
        return word
    return number(value, where, *kind)


def settings_of(values, factor, place=lambda name: name):
    """
    values  by the names above, whatever their case
    factor  how fast the middleware's clock goes
    place   where a name stands, for messages
    → Settings, names that are none of these. \\throws Wrong
    """
    made, tracker, rest = Settings(factor=factor), TrackerSettings(), []
    whole = {f.name for of in (Settings, TrackerSettings) for f in fields(of) if f.type is int}
    known = {n.lower(): (made, *v) for n, v in NAMES.items()}
    known |= {n.lower(): (tracker, *v) for n, v in TRACKER.items()}
    for name, value in values.items():
        if name.lower() not in known:
            rest.append(name)
            continue
        of, key, kind = known[name.lower()]
        it = value_of(kind, value, place(name))
        if key in whole:
            if not math.isclose(it, round(it)):
                raise Wrong(place(name), shown(value), "a whole number")
            it = int(round(it))
        setattr(of, key, it)
    made.tracker = tracker
    if not (made.scenario or made.socket or made.tcp):
        raise Wrong("Scenario", "nothing",
                    "a scenario, or the Socket or TCP of a running asdic serve")
    if tracker.hits > tracker.of:
        raise Wrong("TrackHits", str(tracker.hits), f"at most TrackOf, {tracker.of}")
    return made, rest


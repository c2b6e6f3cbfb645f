"""What goes in and out of asdic on a vehicle's middleware: one description of each quantity.

Inputs arrive as text (`name=rock,x=100`), as JSON or as fields of a message. All become a dict of
asdic's own keys here, or are refused in one line: where, what was found, what was expected.
"""
import json
import math
from dataclasses import dataclass

LONGEST_TEXT = 1 << 20
MOST_PHONES = 4096
NAME_LENGTH = 128


class Wrong(ValueError):
    """An input that is refused."""

    def __init__(self, where, found, expected):
        super().__init__(f"{where}: found {found}, expected {expected}")


def shown(value, length=40):
    """A value as a message may quote it: printable, short."""
    text = value if isinstance(value, str) else repr(value)
    text = "".join(c if c.isprintable() else "?" for c in text[:length + 1])
    return f'"{text[:length]}…"' if len(text) > length else f'"{text}"'


@dataclass(frozen=True)
class Quantity:
    """A number with its unit and bounds, or a word.

    name   by which middleware has it
    key    asdic's (docs/formats/serve.md)
    """

    name: str
    key: str
    unit: str = ""
    low: float = -math.inf
    high: float = math.inf
    words: tuple = ()
    also: tuple = ()  # other names
    text: bool = False

    def of(self, value, where):
        """→ float or str. \\throws Wrong"""
        if self.text:
            return name_of(value, where)
        if self.words:
            word = value.strip().lower() if isinstance(value, str) else value
            if word not in self.words:
                raise Wrong(where, shown(value), "one of " + ", ".join(self.words))
            return word
        return number(value, where, self.low, self.high, self.unit)


def number(value, where, low=-math.inf, high=math.inf, unit=""):
    """→ float. \\throws Wrong"""
    try:
        if isinstance(value, bool) or (isinstance(value, str) and "_" in value):
            raise ValueError
        it = float(value)
    except (TypeError, ValueError, OverflowError):
        it = math.nan
    if not low <= it <= high or math.isinf(it):
        unit = f" {unit}" if unit else ""
        bounds = f"a number from {low:g} to {high:g}{unit}"
        if math.isinf(low) or math.isinf(high):
            bounds = f"a finite number{unit}"
        raise Wrong(where, shown(value), bounds)
    return it


def name_of(value, where):
    """→ str. \\throws Wrong"""
    if not isinstance(value, str) or not value or len(value) > NAME_LENGTH or \
            not value.isprintable() or "," in value or "=" in value:
        raise Wrong(where, shown(value), f"a name of 1 to {NAME_LENGTH} printable characters")
    return value


# The vehicle and the targets: x is east, y north [m], depths are positive down, headings true.
FAR = 1e7  # bound of the scenario's coordinates [m]
PLATFORM = (Quantity("NAV_X", "x", "m", -FAR, FAR), Quantity("NAV_Y", "y", "m", -FAR, FAR),
            Quantity("NAV_DEPTH", "depth", "m", -100.0, 12000.0),
            Quantity("NAV_HEADING", "heading_deg", "degrees", -360.0, 360.0),
            Quantity("NAV_SPEED", "speed", "m/s", -100.0, 100.0))
TARGET = (Quantity("name", "name", text=True), Quantity("x", "x", "m", -FAR, FAR),
          Quantity("y", "y", "m", -FAR, FAR), Quantity("depth", "depth", "m", 0.0, 12000.0),
          Quantity("speed", "speed", "m/s", 0.0, 100.0),
          Quantity("heading", "heading_deg", "degrees", -360.0, 360.0, also=("heading_deg",)),
          Quantity("strength", "strength_db", "dB", -200.0, 200.0, also=("strength_db",)),
          Quantity("remove", "remove", words=("true", "false")))
COMMAND = (Quantity("type", "kind", text=True),
           Quantity("centre_frequency", "frequency", "Hz", 0.1, 1e6,
                    also=("center_frequency", "centre", "center", "frequency")),
           Quantity("min_frequency", "start_frequency", "Hz", 0.1, 1e6),
           Quantity("max_frequency", "end_frequency", "Hz", 0.1, 1e6),
           Quantity("duration", "duration", "s", 1e-6, 3600.0),
           Quantity("window", "window", text=True),
           Quantity("sweep", "sweep", words=("up", "down")),
           Quantity("level", "source_level_db", "dB re 1 uPa at 1 m", -300.0, 400.0,
                    also=("source_level_db",)),
           Quantity("elevation", "elevation_deg", "degrees", -90.0, 90.0, also=("elevation_deg",)),
           Quantity("beamwidth", "beamwidth_deg", "degrees", 0.01, 179.0, also=("beamwidth_deg",)),
           Quantity("transmitter", "transmitter", text=True))
PATHS = (Quantity("frequency", "frequency", "Hz", 0.1, 1e6),
         Quantity("source_depth", "source_depth", "m", 0.0, 12000.0),
         Quantity("receiver_depth", "receiver_depth", "m", 0.0, 12000.0),
         Quantity("range", "range", "m", 0.0, FAR),
         Quantity("bearing_deg", "bearing_deg", "degrees", -360.0, 360.0),
         Quantity("bottom_depth", "bottom_depth", "m", 0.1, 12000.0),
         Quantity("from_deg", "from_deg", "degrees", -90.0, 90.0),
         Quantity("to_deg", "to_deg", "degrees", -90.0, 90.0),
         Quantity("count", "count", "", 1.0, 10000.0))
MOST_LEVELS = 1000


def keyed(pairs, quantities, where):
    """Values by the keys of asdic.

    pairs   (name, value) as they came
    → dict. \\throws Wrong for a name that there is none, or twice, or a wrong value
    """
    known = {name: q for q in quantities for name in (q.name, q.key, *q.also)}
    found = {}
    for name, value in pairs:
        quantity = known.get(name.strip().lower() if isinstance(name, str) else name)
        if quantity is None:
            raise Wrong(f"{where}: {shown(name)}", "a key that there is none",
                        "one of " + ", ".join(q.name for q in quantities))
        if quantity.key in found:
            raise Wrong(f"{where}: {quantity.name}", "it twice", "it once")
        found[quantity.key] = quantity.of(value, f"{where}: {quantity.name}")
    return found


def pairs_of(text, where):
    """`a=1, b=word` → [("a", "1"), ("b", "word")]. \\throws Wrong"""
    if len(text) > LONGEST_TEXT:
        raise Wrong(where, f"{len(text)} characters", f"at most {LONGEST_TEXT}")
    pairs = []
    for part in text.split(","):
        if not part.strip():
            continue
        name, equals, value = part.partition("=")
        if not equals:
            raise Wrong(where, shown(part.strip()), "KEY=VALUE,KEY=VALUE")
        pairs.append((name.strip(), value.strip()))
    return pairs


def text_of(fields):
    """{"a": 1.0, "b": "word"} → `a=1,b=word`, as MOOS's apps have it. What is None is left out."""
    def one(value):
        if isinstance(value, bool):
            return "true" if value else "false"
        if isinstance(value, float):  # times since 1970 to the microsecond
            return f"{value:.6f}" if abs(value) >= 1e8 else f"{value:.10g}"
        return str(value).replace(",", ";").replace("=", ":")
    return ",".join(f"{k}={one(v)}" for k, v in fields.items() if v is not None)


def target_of(fields, where):
    """A target as `update` has it, and where it is. → dict of name, x, y, depth, speed,
    heading_deg, strength_db, remove. \\throws Wrong
    """
    if "name" not in fields:
        raise Wrong(where, "no name", "name=…")
    for one, other in (("x", "y"), ("x", "depth"), ("y", "x"), ("depth", "x"),
                       ("speed", "heading_deg")):
        if one in fields and other not in fields:
            raise Wrong(f"{where}: {other}", "nothing", f"it beside {one}")
    return fields


WAVEFORM = ("kind", "frequency", "start_frequency", "end_frequency", "duration", "window", "sweep")


def ping_of(pairs, where):
    """A ping command: type, frequencies, duration, window, level, elevation, beamwidth,
    transmitter; `waveform.KEY` goes to the waveform as it is. → keyword arguments of Client.ping.
    \\throws Wrong
    """
    own = [(n, v) for n, v in pairs if not str(n).lower().startswith("waveform.")]
    fields = keyed(own, COMMAND, where)
    wave = {key: fields.pop(key) for key in WAVEFORM if key in fields}
    for name, value in pairs:
        if not str(name).lower().startswith("waveform."):
            continue
        key = name[len("waveform."):].strip().lower()
        if not key.isidentifier() or len(key) > NAME_LENGTH or not key.isascii() or key in wave:
            raise Wrong(f"{where}: {shown(name)}", "a key that there is none, or that was said",
                        "waveform.KEY, a key of [pulse]")
        try:
            wave[key] = number(value, where)
            if wave[key].is_integer() and isinstance(value, str) and value.lstrip("+-").isdigit():
                wave[key] = int(wave[key])
        except Wrong:
            wave[key] = name_of(value, f"{where}: {shown(name)}")
    if wave:
        fields["waveform"] = waveform_of(wave, where)
    return fields


def waveform_of(wave, where):
    """A waveform by asdic's keys from what the command says of it. \\throws Wrong"""
    kind = wave.get("kind", "").lower()
    if not kind:
        raise Wrong(f"{where}: type", "nothing", "cw, lfm, hfm or another kind of pulse")
    wave["kind"] = kind
    low, high = wave.get("start_frequency"), wave.get("end_frequency")
    if kind in ("lfm", "hfm"):
        if low is None or high is None:
            raise Wrong(f"{where}: {'min' if low is None else 'max'}_frequency", "nothing",
                        f"both ends of a sweep, for type={kind}")
        if not low < high:
            raise Wrong(f"{where}: min_frequency", f"{low:g} Hz",
                        f"less than max_frequency, {high:g} Hz")
        centre = wave.pop("frequency", None)
        if centre is not None and not low <= centre <= high:
            raise Wrong(f"{where}: centre_frequency", f"{centre:g} Hz",
                        f"one from min_frequency to max_frequency, {low:g} to {high:g} Hz")
        if wave.pop("sweep", "up") == "down":
            wave["start_frequency"], wave["end_frequency"] = high, low
    elif kind == "cw":
        if "frequency" not in wave:
            if low is None or low != high:
                raise Wrong(f"{where}: centre_frequency", "nothing",
                            "the tone's frequency, for type=cw")
            wave["frequency"] = low
        for name in ("start_frequency", "end_frequency", "sweep"):
            wave.pop(name, None)
    return wave


def positions_of(value, where):
    """Phones' places in the world: `x,y,z;x,y,z` or `x,y,z:x,y,z`, JSON rows, or an array.
    → list of [x, y, depth]. \\throws Wrong
    """
    if isinstance(value, str):
        text = value.strip()
        if len(text) > LONGEST_TEXT:
            raise Wrong(where, f"{len(text)} characters", f"at most {LONGEST_TEXT}")
        if text.startswith("["):
            rows = json_of(text, where, list)
        else:
            rows = [row.split(",") for row in text.replace(":", ";").split(";") if row.strip()]
    else:
        rows = value
    if not 1 <= len(rows) <= MOST_PHONES:
        raise Wrong(where, f"{len(rows)} phones", f"1 to {MOST_PHONES}")
    places = []
    for k, row in enumerate(rows):
        if not hasattr(row, "__len__") or isinstance(row, (str, dict)) or len(row) != 3:
            raise Wrong(f"{where}: phone {k}", shown(row), "x, y and depth [m]")
        places.append([number(one, f"{where}: phone {k}", -FAR, FAR, "m") for one in row])
    return places


def json_of(text, where, kind):
    """\\throws Wrong"""
    if len(text) > LONGEST_TEXT:
        raise Wrong(where, f"{len(text)} characters", f"at most {LONGEST_TEXT}")
    if max_nesting(text) > 16:
        raise Wrong(where, "JSON of more than 16 levels", "fewer")
    try:
        value = json.loads(text, parse_constant=lambda name: math.nan)
    except (ValueError, RecursionError):
        raise Wrong(where, shown(text), "JSON") from None
    if not isinstance(value, kind):
        raise Wrong(where, shown(text), "a JSON object" if kind is dict else "a JSON array")
    return value


def max_nesting(text):
    depth = deepest = 0
    for c in text:
        if c in "[{":
            depth += 1
            deepest = max(deepest, depth)
        elif c in "]}":
            depth -= 1
    return deepest


def paths_of(text, where):
    """A request of sound paths: JSON with the names of PATHS, and

    id           comes back
    output       "arrivals" (default; "arr") or "rays" ("ray")
    sound_speed  {"depth": […], "speed": […]} in place of the scenario's

    → dict. \\throws Wrong
    """
    asked = json_of(text, where, dict)
    own = {}
    ident = asked.pop("id", None)
    if ident is not None:
        if isinstance(ident, bool) or not isinstance(ident, (int, float, str)) or \
                len(str(ident)) > NAME_LENGTH or ident != ident:
            raise Wrong(f"{where}: id", shown(ident), "a number or a short string")
        own["id"] = ident
    output = asked.pop("output", "arrivals")
    kinds = {"arrivals": "arrivals", "arr": "arrivals", ".arr": "arrivals", "rays": "rays",
             "ray": "rays", ".ray": "rays"}
    if not isinstance(output, str) or output not in kinds:
        raise Wrong(f"{where}: output", shown(output), "arrivals or rays")
    own["output"] = kinds[output]
    profile = asked.pop("sound_speed", None)
    if profile is not None:
        own["sound_speed"] = profile_of(profile, f"{where}: sound_speed")
    own.update(keyed(asked.items(), PATHS, where))
    needed = ("range", "receiver_depth") if own["output"] == "arrivals" else ()
    for name in needed:
        if name not in own:
            raise Wrong(f"{where}: {name}", "nothing", "a receiver's range and depth [m]")
    return own


def profile_of(profile, where):
    """→ {"depth": […], "speed": […]}. \\throws Wrong"""
    if not isinstance(profile, dict) or set(profile) != {"depth", "speed"} or \
            not all(isinstance(column, list) for column in profile.values()):
        raise Wrong(where, shown(profile), '{"depth": […], "speed": […]}')
    depth, speed = profile["depth"], profile["speed"]
    if len(depth) != len(speed) or not 2 <= len(depth) <= MOST_LEVELS:
        raise Wrong(where, f"{len(depth)} depths and {len(speed)} speeds",
                    f"as many of each, 2 to {MOST_LEVELS}")
    depth = [number(z, f"{where}.depth", 0.0, 12000.0, "m") for z in depth]
    speed = [number(c, f"{where}.speed", 1000.0, 2000.0, "m/s") for c in speed]
    if any(not b > a for a, b in zip(depth, depth[1:])):
        raise Wrong(f"{where}.depth", "depths out of order", "increasing ones")
    return {"depth": depth, "speed": speed}


def velocity_of(speed, heading_deg):
    """East and north parts [m/s]; a negative speed goes astern."""
    turn = math.radians(heading_deg)
    return speed * math.sin(turn), speed * math.cos(turn)

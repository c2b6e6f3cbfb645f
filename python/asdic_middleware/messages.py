"""asdic_msgs from and to the quantities of this package. Messages are filled by the names of
their fields, so that ROS 1 and ROS 2 share it; a module `msgs` holds the classes (asdic_msgs.msg of
either).
"""
import json
import math

import numpy as np

from . import quantities

SIDES = ("", "mirror_")


def fill(message, values):
    """Sets the fields that `values` has, as the types that they have. None: NaN. → message"""
    for name, value in values.items():
        if not hasattr(message, name) or name == "header":
            continue
        had = getattr(message, name)
        if isinstance(had, bool):
            value = bool(value)
        elif isinstance(had, int):
            value = int(value or 0)
        elif isinstance(had, float):
            value = math.nan if value is None else float(value)
        elif isinstance(had, str):
            value = "" if value is None else str(value)
        setattr(message, name, value)
    return message


def ping(msgs, what):
    wave = what.get("waveform")
    return fill(msgs.Ping(), {**what, "waveform": json.dumps(wave) if wave else ""})


def audio(msgs, what, floats=list):
    """floats: makes of an array what the field takes."""
    data = what["data"]
    is_complex = bool(np.iscomplexobj(data))
    flat = np.ascontiguousarray(data, "<c8" if is_complex else "<f4").view("<f4").ravel()
    told = {k: v for k, v in what.items() if k not in ("data", "time")}
    message = fill(msgs.AudioBlock(), {**told, "channels": data.shape[0], "samples": data.shape[1],
                                       "is_complex": is_complex})
    message.data = floats(flat)
    if what.get("phones") is not None:
        for k, name in enumerate(("phone_x", "phone_y", "phone_depth")):
            setattr(message, name, [float(one) for one in what["phones"][:, k]])
    return message


def samples_of(message):
    """An AudioBlock's [phones × samples]: float32, or complex64 baseband."""
    data = np.asarray(message.data, "<f4")
    if message.is_complex:
        data = data.view("<c8")
    return data.reshape(message.channels, message.samples)


def detections(msgs, what):
    message = fill(msgs.Detections(), {k: v for k, v in what.items() if k != "detections"})
    for one in what["detections"]:
        values = {**one, "places": len(one["places"])}
        empty = dict.fromkeys(PLACE)
        for side, place in zip(SIDES, [*one["places"], empty, empty]):
            values |= {side + name: place[name] for name in PLACE}
        message.detections.append(fill(msgs.Detection(), values))
    return message


PLACE = ("x", "y", "depth", "range", "bearing_deg", "range_rate")


def tracks(msgs, what):
    message = fill(msgs.Tracks(), {"ping": what["ping"]})
    message.tracks.extend(fill(msgs.Track(), one) for one in what["tracks"])
    return message


def truth(msgs, what):
    message = fill(msgs.Truth(), {"ping": what["ping"]})
    message.truth.extend(fill(msgs.TargetTruth(), {"echo_time": None, **one})
                         for one in what["truth"])
    return message


def done(msgs, what):
    return fill(msgs.PingDone(), {"receiver": None, **what})


# In ---------------------------------------------------------------------------------------------

PLATFORM = tuple(q.key for q in quantities.PLATFORM)


def target_of(message, where):
    """→ fields for Sonar.set_target(). NaN: not said. \\throws Wrong"""
    if message.remove:
        return quantities.keyed([("name", message.name), ("remove", "true")], quantities.TARGET,
                                where)
    values = [("name", message.name)]
    for name in ("x", "y", "depth", "speed", "heading_deg", "strength_db"):
        value = getattr(message, name)
        if not math.isnan(value):
            values.append((name, value))
    return quantities.keyed(values, quantities.TARGET, where)


def phones_of(message, where):
    """→ places for Sonar.set_phones(). \\throws Wrong"""
    columns = (message.x, message.y, message.depth)
    if len({len(column) for column in columns}) != 1:
        raise quantities.Wrong(where, " and ".join(str(len(c)) for c in columns) + " numbers",
                               "as many of x, y and depth")
    return quantities.positions_of([list(row) for row in zip(*columns)], where)


def ping_of(message, where):
    """→ fields for Sonar.ping(). \\throws Wrong"""
    pairs = [(name, getattr(message, name)) for name in
             ("type", "centre_frequency", "min_frequency", "max_frequency", "sweep", "duration",
              "window", "level", "beamwidth", "transmitter") if getattr(message, name)]
    if message.elevation_is_set:
        pairs.append(("elevation", message.elevation))
    for text in message.more:
        pairs += [(n if n.lower().startswith("waveform.") else "waveform." + n, v)
                  for n, v in quantities.pairs_of(text, where)]
    return quantities.ping_of(pairs, where)


def platform_of_odometry(message):
    """nav_msgs/Odometry in a frame of x east, y north, z up (REP 103). → {x, y, depth,
    heading_deg, speed}

    Its twist is in the vehicle's frame, x forward.
    """
    place, turn = message.pose.pose.position, message.pose.pose.orientation
    yaw = math.atan2(2 * (turn.w * turn.z + turn.x * turn.y), 1 - 2 * (turn.y**2 + turn.z**2))
    return {"x": place.x, "y": place.y, "depth": -place.z,
            "heading_deg": (90.0 - math.degrees(yaw)) % 360.0,
            "speed": message.twist.twist.linear.x}

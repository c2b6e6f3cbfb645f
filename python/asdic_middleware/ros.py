"""The node of ROS 1 and ROS 2: topics → sonar → topics. ros1.py and ros2.py say how each of them
does it.
"""
import json

from . import messages, quantities
from .quantities import Wrong
from .settings import NAMES, TRACKER, settings_of
from .sonar import Sonar
from .steady import Steady

# parameters: the names of settings in small letters, with _ between words or without
PARAMETERS = {name.lower(): kind for name, (_, kind) in {**NAMES, **TRACKER}.items()}
PARAMETERS["timefactor"] = (1e-3, 1e4)
#: topic (below the node's name), class, method of Bridge
INPUTS = (("platform", "Platform", "platform"), ("odometry", "Odometry", "odometry"),
          ("target", "Target", "target"), ("array", "ArrayShape", "array"),
          ("command", "PingCommand", "command"), ("paths_request", "String", "paths"))
#: kind of result: topic, class
OUTPUTS = {"ping": ("ping", "Ping"), "samples": ("samples", "AudioBlock"),
           "detections": ("detections", "Detections"), "tracks": ("tracks", "Tracks"),
           "truth": ("truth", "Truth"), "latency": ("latency", "PingDone"),
           "paths": ("paths", "String"),
           "error": ("errors", "String")}


def plain_name(name):
    return name.lower().replace("_", "")


class Bridge:
    """
    ros  of the version of ROS: now() [s], simulated() (whether that is a simulation's time),
         stamp_of(message) [s or None], set_stamp(message, seconds), publish(topic, message),
         log(text), msgs (classes by name), floats (makes an array a field)
    """

    def __init__(self, ros, parameters):
        """parameters: {name: value}. \\throws Wrong"""
        values = {plain_name(n): v for n, v in parameters.items()}
        factor = quantities.number(values.pop("timefactor", 1.0), "time_factor",
                                   *PARAMETERS["timefactor"])
        settings, rest = settings_of(values, factor, lambda name: f"parameter {name}")
        if rest:
            raise Wrong(f"parameter {rest[0]}", "a name that there is none",
                        "a setting of docs/formats/middleware.md")
        self._ros = ros
        followed = ros.simulated()
        clock = Steady(ros.now, factor if followed else 1.0, followed)
        self.sonar = Sonar(settings, clock, self._result)

    # In: called by ROS with each message ---------------------------------------------------------

    def take(self, method, message):
        try:
            getattr(self, "_take_" + method)(message)
        except Wrong as wrong:
            self.sonar.error(str(wrong))

    def _take_platform(self, message):
        self._platform({name: getattr(message, name) for name in messages.PLATFORM}, "platform",
                       self._ros.stamp_of(message))

    def _take_odometry(self, message):
        self._platform(messages.platform_of_odometry(message), "odometry",
                       self._ros.stamp_of(message))

    def _platform(self, values, where, stamp):
        for quantity in quantities.PLATFORM:  # all or none of a fix
            quantity.of(values[quantity.key], f"{where}: {quantity.key}")
        for name, value in values.items():
            self.sonar.set_platform(name, value, f"{where}: {name}", stamp)

    def _take_target(self, message):
        self.sonar.set_target(messages.target_of(message, "target"), "target",
                              self._ros.stamp_of(message))

    def _take_array(self, message):
        self.sonar.set_phones(messages.phones_of(message, "array"), self._ros.stamp_of(message))

    def _take_command(self, message):
        self.sonar.ping(messages.ping_of(message, "command"), "command")

    def _take_paths(self, message):
        self.sonar.request_paths(quantities.paths_of(message.data, "paths_request"),
                                 "paths_request")

    # Out -----------------------------------------------------------------------------------------

    def _result(self, kind, what):
        msgs = self._ros.msgs
        if kind == "ready":
            self._ros.log(f"{what['scenario']}: {what['channels']} phones, "
                          + ("listening" if what["listening"] else "pinging on command"))
            return
        if kind == "files":
            return
        if kind in ("error", "paths"):
            message = msgs.String()
            message.data = what["message"] if kind == "error" else json.dumps(what)
            if kind == "error":
                self._ros.log(what["message"])
        else:
            message = {"ping": messages.ping, "detections": messages.detections,
                       "tracks": messages.tracks, "truth": messages.truth, "latency": messages.done,
                       "samples": lambda m, w: messages.audio(m, w, self._ros.floats)
                       }[kind](msgs, what)
            self._ros.set_stamp(message, what.get("time") or self._ros.now())
        self._ros.publish(OUTPUTS[kind][0], message)

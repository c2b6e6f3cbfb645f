#!/usr/bin/env python3
"""The node of ROS 2 on a stand-in of rclpy, since Debian has no ROS 2: messages refuse whatever
is not of their fields' types, as ROS 2's do. Behind it is `asdic serve`.

    ASDIC=build/ci/bin/asdic ros2_node.py
"""
import array
import math
import os
import sys
import tempfile
import threading
import time
import types
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "tests/support")]
import ros_messages  # noqa: E402
from checks import check  # noqa: E402
from moos_app import SCENARIO  # noqa: E402  the same sea


class Stamp:
    def __init__(self, sec=0, nanosec=0):
        self.sec, self.nanosec = sec, nanosec


class Header:
    def __init__(self):
        self.stamp, self.frame_id = Stamp(), ""


class Time:
    def __init__(self, nanoseconds=0):
        check(isinstance(nanoseconds, int), "whole nanoseconds")
        self.nanoseconds = nanoseconds

    @classmethod
    def from_msg(cls, stamp):
        return cls(stamp.sec * 10**9 + stamp.nanosec)

    def to_msg(self):
        return Stamp(*divmod(self.nanoseconds, 10**9))


class Node:
    """As much of rclpy's as the node uses."""

    given, nodes = {}, []

    def __init__(self, name, allow_undeclared_parameters,
                 automatically_declare_parameters_from_overrides):
        self.name, self.published, self.callbacks, self.said = name, [], {}, []
        self.changed = threading.Condition()
        Node.nodes.append(self)

    def create_publisher(self, kind, topic, queue):
        def publish(message):
            check(type(message) is kind, f"{topic} is of {kind}")
            with self.changed:
                self.published.append((topic, message))
                self.changed.notify_all()
        return types.SimpleNamespace(publish=publish)

    def create_subscription(self, kind, topic, callback, queue):
        self.callbacks[topic] = callback

    def get_clock(self):
        return types.SimpleNamespace(now=lambda: Time(time.time_ns()), ros_time_is_active=False)

    def get_logger(self):
        return types.SimpleNamespace(info=self.said.append, fatal=self.said.append)

    def get_parameters_by_prefix(self, prefix):
        return {n: types.SimpleNamespace(value=v) for n, v in self.given.items()}

    def destroy_node(self):
        pass

    def wait(self, topic, holds=lambda m: True):
        def those():
            return [m for t, m in self.published if t == "~/" + topic and holds(m)]
        with self.changed:
            errors = [m.data for t, m in self.published if t == "~/errors"]
            check(self.changed.wait_for(those, 30), f"{topic} comes; errors: {errors}")
            return those()[0]


class String:
    data = ""


def stand_in():
    """rclpy, std_msgs and asdic_msgs as modules. → the messages"""
    msgs = ros_messages.strict(Header)
    modules = {"rclpy": {"init": lambda: None, "spin": use, "try_shutdown": lambda: None},
               "rclpy.node": {"Node": Node}, "rclpy.time": {"Time": Time},
               "rclpy.executors": {"ExternalShutdownException": type("Shutdown", (Exception,), {})},
               "std_msgs": {}, "std_msgs.msg": {"String": String}, "asdic_msgs": {"msg": msgs}}
    for name, holds in modules.items():
        module = types.ModuleType(name)
        vars(module).update(holds)
        sys.modules[name] = module
        if "." in name:
            setattr(sys.modules[name.split(".")[0]], name.split(".")[1], module)
    sys.modules["asdic_msgs.msg"] = msgs
    sys.modules["nav_msgs"] = None
    return msgs


def use(node):
    """In place of spinning: a vehicle."""
    msgs = sys.modules["asdic_msgs.msg"]
    platform = msgs.Platform()
    platform.x, platform.y, platform.depth, platform.heading_deg = 100.0, 50.0, 240.0, 90.0
    platform.header.stamp = Time(time.time_ns()).to_msg()
    node.callbacks["~/platform"](platform)
    shape = msgs.ArrayShape()
    shape.x, shape.y, shape.depth = [100.0, 101.0], [50.0, 50.0], [250.0, 251.0]
    node.callbacks["~/array"](shape)
    target = msgs.Target()
    target.name, target.x = "rock", math.nan
    target.y = target.depth = target.speed = target.heading_deg = math.nan
    target.strength_db = 25.0
    node.callbacks["~/target"](target)
    command = msgs.PingCommand()
    command.type, command.centre_frequency, command.duration = "cw", 1000.0, 0.2
    command.more = ["loud"]
    node.callbacks["~/command"](command)
    node.wait("errors", lambda m: "KEY=VALUE" in m.data)
    command.more = ["window=hann"]
    node.callbacks["~/command"](command)
    node.wait("latency")
    sent = node.wait("ping")
    check((sent.number, sent.x, sent.depth) == (1, 100.0, 240.0), "from there")
    block = node.wait("samples")
    from asdic_middleware import messages
    samples = messages.samples_of(block)
    check(isinstance(block.data, array.array)
          and samples.shape[0] == 2 and np.iscomplexobj(samples), "samples")
    check(np.abs(np.array([block.phone_x, block.phone_depth]) - [[100, 101], [250, 251]]).max() < 1e-6,
          "the array's geometry")
    at = Time.from_msg(block.header.stamp).nanoseconds / 1e9
    check(abs(at - time.time()) < 60, "a stamp")
    truth = node.wait("truth").truth[0]
    check(truth.target == "rock" and 3 < truth.echo_time < 5, f"{truth}")
    check(node.wait("detections").of >= 0, "detections")
    check(node.wait("tracks").tracks == [], "no track of one ping")


def main():
    stand_in()
    from asdic_middleware import ros2
    with tempfile.TemporaryDirectory(prefix="asdic_ros2_") as folder:
        (Path(folder) / "sea.toml").write_text(SCENARIO)
        Node.given = {"scenario": f"{folder}/sea.toml", "pace": "fast", "program": os.environ["ASDIC"],
                      "folder": f"{folder}/data", "most_detections": 5, "use_sim_time": False}
        check(ros2.main() == 0, "it ends in peace")
        Node.given = {"pace": "slow", "scenario": "x"}
        check(ros2.main() ==
              2 and "one of clock, fast" in Node.nodes[-1].said[-1], "a wrong parameter")
    print("the node of ROS 2 ok, on a stand-in")


if __name__ == "__main__":
    main()

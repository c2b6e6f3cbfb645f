"""The node of ROS 2: rclpy, asdic_msgs, and Odometry where nav_msgs is there. No ROS 2 was at
hand to run it: the tests run it on a stand-in of rclpy.
"""
import array
import types

import rclpy
import std_msgs.msg
from asdic_msgs import msg
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.time import Time

from .quantities import Wrong
from .ros import INPUTS, OUTPUTS, PARAMETERS, Bridge, plain_name

QUEUE = 200


class Ros2(Node):
    def __init__(self):
        super().__init__("asdic", allow_undeclared_parameters=True,
                         automatically_declare_parameters_from_overrides=True)
        self.msgs = types.SimpleNamespace(String=std_msgs.msg.String, **{
            name: getattr(msg, name) for name in dir(msg) if name[0].isupper()})
        try:
            from nav_msgs.msg import Odometry
            self.msgs.Odometry = Odometry
        except ImportError:
            self.log("found no nav_msgs, so there is no topic odometry")
        self._topics = {topic: self.create_publisher(getattr(self.msgs, kind), "~/" + topic, QUEUE)
                        for topic, kind in OUTPUTS.values()}

    @staticmethod
    def floats(values):
        return array.array("f", values.astype("<f4").tobytes())

    def now(self):
        return self.get_clock().now().nanoseconds / 1e9

    def simulated(self):
        return self.get_clock().ros_time_is_active

    def log(self, text):
        self.get_logger().info(text)

    @staticmethod
    def stamp_of(message):
        return Time.from_msg(message.header.stamp).nanoseconds / 1e9 or None

    @staticmethod
    def set_stamp(message, seconds):
        message.header.stamp = Time(nanoseconds=round(seconds * 1e9)).to_msg()

    def publish(self, topic, message):
        self._topics[topic].publish(message)

    def parameters(self):
        """Those that are settings, as they were given."""
        given = {name: getattr(one, "value", one)
                 for name, one in self.get_parameters_by_prefix("").items()}
        return {name: value for name, value in given.items()
                if plain_name(name) in PARAMETERS and value is not None}

    def subscribe(self, bridge):
        for topic, kind, method in INPUTS:
            if hasattr(self.msgs, kind):
                self.create_subscription(getattr(self.msgs, kind), "~/" + topic,
                                         lambda m, method=method: bridge.take(method, m), QUEUE)


def main():
    rclpy.init()
    node = Ros2()
    try:
        bridge = Bridge(node, node.parameters())
    except Wrong as wrong:
        node.get_logger().fatal(str(wrong))
        return 2
    node.subscribe(bridge)
    bridge.sonar.start()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    bridge.sonar.close()
    node.destroy_node()
    rclpy.try_shutdown()
    return 0

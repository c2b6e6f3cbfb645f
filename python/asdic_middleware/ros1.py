"""The node of ROS 1: rospy, asdic_msgs, and Odometry where nav_msgs is there."""
import types

import rospy
import std_msgs.msg
from asdic_msgs import msg

from .quantities import Wrong
from .ros import INPUTS, OUTPUTS, PARAMETERS, Bridge, plain_name

QUEUE = 200


class Ros1:
    floats = staticmethod(lambda array: array.tolist())

    def __init__(self):
        self.msgs = types.SimpleNamespace(String=std_msgs.msg.String, **{
            name: getattr(msg, name) for name in dir(msg) if name[0].isupper()})
        try:
            from nav_msgs.msg import Odometry
            self.msgs.Odometry = Odometry
        except ImportError:
            self.log("found no nav_msgs, so there is no topic odometry")
        self._topics = {topic: rospy.Publisher("~" + topic, getattr(self.msgs, kind),
                                               queue_size=QUEUE)
                        for topic, kind in OUTPUTS.values()}

    now = staticmethod(rospy.get_time)
    simulated = staticmethod(lambda: not rospy.rostime.is_wallclock())
    log = staticmethod(lambda text: rospy.loginfo("%s", text))

    @staticmethod
    def stamp_of(message):
        return message.header.stamp.to_sec() or None

    @staticmethod
    def set_stamp(message, seconds):
        message.header.stamp = rospy.Time.from_sec(seconds)

    def publish(self, topic, message):
        try:
            self._topics[topic].publish(message)
        except rospy.ROSException:
            pass  # the node is being shut down

    def subscribe(self, bridge):
        return [rospy.Subscriber("~" + topic, getattr(self.msgs, kind),
                                 lambda m, method=method: bridge.take(method, m), queue_size=QUEUE)
                for topic, kind, method in INPUTS if hasattr(self.msgs, kind)]


def main():
    rospy.init_node("asdic")
    ros = Ros1()
    given = rospy.get_param("~", {})
    try:
        bridge = Bridge(ros, {n: v for n, v in given.items() if plain_name(n) in PARAMETERS})
    except Wrong as wrong:
        rospy.logfatal("%s", wrong)
        return 2
    subscribers = ros.subscribe(bridge)
    bridge.sonar.start()
    rospy.spin()
    for one in subscribers:
        one.unregister()
    bridge.sonar.close()
    return 0

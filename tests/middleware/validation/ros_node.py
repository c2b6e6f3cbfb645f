#!/usr/bin/env python3
"""The node of ROS 1 between a rosmaster and `asdic serve`; messages of asdic_msgs are generated
for it.

Truth: what a client of `asdic serve` gets by itself, bit for bit; geometry.

    ASDIC=build/ci/bin/asdic ros_node.py
"""
import contextlib
import json
import math
import os
import socket
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "tests/support")]
import ros_messages  # noqa: E402
from asdic_client import Client  # noqa: E402
from checks import check  # noqa: E402
from moos_app import SCENARIO  # noqa: E402  the same sea
from served import ASDIC  # noqa: E402

PACKAGES = "python3-rospy python3-rosmaster python3-genpy python3-nav-msgs python3-geometry-msgs"


@contextlib.contextmanager
def master(folder):
    """A rosmaster of its own, on a free port."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    os.environ |= {"ROS_MASTER_URI": f"http://127.0.0.1:{port}", "ROS_IP": "127.0.0.1",
                   "ROS_LOG_DIR": str(folder / "log"), "ROS_HOME": str(folder),
                   "PYTHONPATH": f"{folder}{os.pathsep}{os.environ.get('PYTHONPATH', '')}"}
    process = subprocess.Popen(["rosmaster", "--core", "-p", str(port)], stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL)
    try:
        end = time.monotonic() + 20
        while True:
            with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port), 1):
                break
            check(time.monotonic() < end and process.poll() is None, "rosmaster runs")
            time.sleep(0.05)
        yield
    finally:
        process.terminate()
        process.wait(timeout=20)


class Ears:
    """What came of each topic."""

    def __init__(self, rospy, kinds):
        self.came, self.changed = {topic: [] for topic in kinds}, threading.Condition()
        self.ends = [rospy.Subscriber("/asdic/" + topic, kind, lambda m, t=topic: self._take(t, m),
                                      queue_size=1000) for topic, kind in kinds.items()]

    def _take(self, topic, message):
        with self.changed:
            self.came[topic].append(message)
            self.changed.notify_all()

    def wait(self, topic, count=1, holds=lambda m: True, seconds=30):
        """The count-th message of a topic that holds."""
        def those():
            return [m for m in self.came[topic] if holds(m)]
        with self.changed:
            came = self.changed.wait_for(lambda: len(those()) >= count, seconds)
            check(came, f"{topic} comes; errors: {[m.data for m in self.came['errors']]}")
            return those()[count - 1]


def run(folder):
    import rospy
    from asdic_msgs import msg
    from nav_msgs.msg import Odometry
    from std_msgs.msg import String

    from asdic_middleware import messages

    (folder / "sea.toml").write_text(SCENARIO)
    words = [sys.executable, ROOT / "ros/asdic_ros/scripts/asdic_node", f"_scenario:={folder}/sea.toml", "_pace:=fast",
             f"_program:={ASDIC}", f"_folder:={folder}/data", "_block:=0.7", "_most_detections:=5"]
    node = subprocess.Popen(words, stdout=subprocess.DEVNULL)
    try:
        rospy.init_node("test", disable_signals=True, disable_rosout=True)
        ears = Ears(rospy, {"ping": msg.Ping, "samples": msg.AudioBlock, "detections": msg.Detections,
                            "tracks": msg.Tracks, "truth": msg.Truth, "latency": msg.PingDone,
                            "errors": String, "paths": String})
        say = {topic: rospy.Publisher("/asdic/" + topic, kind, queue_size=1000) for topic, kind in
               (("platform", msg.Platform), ("odometry", Odometry), ("target", msg.Target),
                ("array", msg.ArrayShape), ("command", msg.PingCommand), ("paths_request", String))}
        end = time.monotonic() + 30
        while any(p.get_num_connections() < 1 for p in (*say.values(), *ears.ends)):
            check(time.monotonic() < end and node.poll() is None, "the node subscribes")
            time.sleep(0.05)
        # a vehicle in ROS's frame: z up, yaw from east; 90 degrees of heading are 0 of yaw
        odometry = Odometry()
        place = odometry.pose.pose.position
        place.x, place.y, place.z = 100.0, 50.0, -240.0
        odometry.pose.pose.orientation.w = 1.0
        say["odometry"].publish(odometry)
        say["target"].publish(msg.Target(name="rock", x=2500.0, y=1000.0, depth=400.0, speed=0.0,
                                         heading_deg=10.0, strength_db=20.0))
        phones = np.array([[100.0, 50.0, 250.0], [101.0, 50.0, 250.0], [102.0, 51.0, 251.0]])
        say["array"].publish(msg.ArrayShape(x=phones[:, 0], y=phones[:, 1], depth=phones[:, 2]))
        say["target"].publish(msg.Target(name="rock", x=math.inf, y=0.0, depth=1.0))
        ears.wait("errors", holds=lambda m: "target: x: found \"inf\"" in m.data)
        time.sleep(0.2)  # topics have no order among each other
        say["command"].publish(msg.PingCommand(
            type="lfm", min_frequency=950.0, max_frequency=1050.0, duration=0.5, window="hann",
            level=210.0, elevation=-5.0, elevation_is_set=True, beamwidth=30.0))
        done = ears.wait("latency")
        check(done.ping == 1 and done.receiver > 0, "the ping is done")
        compare(folder, ears, phones, messages)
        say["paths_request"].publish(
            String(json.dumps({"id": 3, "range": 2000, "receiver_depth": 100})))
        paths = json.loads(ears.wait("paths").data)
        check(paths["ok"] and paths["id"] == 3 and paths["legs"][0]["arrivals"], "sound paths")
        say["platform"].publish(msg.Platform(x=0.0, y=0.0, depth=math.nan))
        ears.wait("errors", holds=lambda m: "platform: depth: found \"nan\"" in m.data)
        say["command"].publish(msg.PingCommand())
        second = ears.wait("ping", 2)
        check((second.number, second.x, second.depth) == (2, 100.0, 240.0), "from where it was")
        check(node.poll() is None, "the node runs")
        rospy.signal_shutdown("the end")
    finally:
        node.terminate()
        code = node.wait(timeout=20)
    check(code == 0, f"the node ends in peace: {code}")


def compare(folder, ears, phones, messages):
    """What came against what a client of `asdic serve` gets."""
    with Client.start(folder / "sea.toml", program=ASDIC) as direct:
        direct.update(platform={"position": [100, 50, 240], "heading_deg": 90, "speed": 0})
        direct.update(array={"positions": phones - [100, 50, 240], "offset": [0, 0, 0]})
        direct.update(targets=[{"name": "rock", "position": [2500, 1000, 400], "speed": 0.0,
                                "heading_deg": 10.0, "strength_db": 20}])
        ping = direct.ping(waveform={"kind": "lfm", "start_frequency": 950.0, "end_frequency": 1050.0,
                                     "duration": 0.5, "window": "hann"}, source_level_db=210.0,
                           elevation_deg=-5.0, beamwidth_deg=30.0, deliver="samples")
    count = ping.samples.shape[1]
    rate = ping.answer["samples"]["sample_rate"]
    blocks = [ears.wait("samples", k + 1) for k in range(math.ceil(count / round(0.7 * rate)))]
    got = np.concatenate([messages.samples_of(b) for b in blocks], axis=1)
    check(got.tobytes() == ping.samples.tobytes(), "bits of samples")
    sent = ears.wait("ping")
    check((sent.elevation_deg, sent.x, json.loads(sent.waveform)
          ["kind"]) == (-5.0, 100.0, "lfm"), f"{sent}")
    at = 0
    for block in blocks:
        late = block.header.stamp.to_sec() - sent.header.stamp.to_sec() - at / rate
        check(abs(late) < 1e-5, f"a block's stamp is {late} s off")
        at += block.samples
        shape = np.array([block.phone_x, block.phone_y, block.phone_depth]).T
        check(np.abs(shape - phones).max() < 1e-6, "the geometry of the array")
        check((block.ping, block.channels, block.carrier, block.is_complex)
              == (1, 3, 1000.0, True), "its words")
    truth, = ears.wait("truth").truth
    distance = np.linalg.norm([2400, 950, 160])
    check(truth.target == "rock" and abs(truth.echo_time - 2 * distance / 1500) < 0.01, f"{truth}")
    found = ears.wait("detections")
    check(len(found.detections) <= 5 and found.of >= len(found.detections), "the loudest")
    # straight there and back, or by the surface on one of the ways: its image
    # is 640 m, not 160 m, away
    ways = [2 * distance, distance + np.linalg.norm([2400, 950, 640])]
    near = [d for d in found.detections if min(abs(d.time - way / 1500) for way in ways) < 0.02]
    check(near, f"the echo is found: {[d.time for d in found.detections]}")
    check(abs(near[0].range - distance) < 300 or math.isnan(near[0].range), f"{near[0]}")
    check(ears.wait("tracks").tracks == [], "no track of one ping")


def main():
    try:
        import nav_msgs.msg  # noqa: F401
        import rospy  # noqa: F401
    except ImportError:
        print(f"skipped: no ROS 1 here (Debian: {PACKAGES})")
        return 77
    with tempfile.TemporaryDirectory(prefix="asdic_ros_") as name:
        folder = Path(name)
        ros_messages.generate(folder)
        sys.path.insert(0, name)
        with master(folder):
            run(folder)
    print("the node of ROS 1 ok")
    return 0


if __name__ == "__main__":
    sys.exit(main())

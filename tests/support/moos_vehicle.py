#!/usr/bin/env python3
"""A vehicle for tests: moos_vehicle.py PORT WARP PINGS. It says where it is and pings. When
a track comes it turns, and has the next ping look there.
"""
import math
import queue
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python"))
from asdic_middleware.moosdb import Clock, MoosDB  # noqa: E402

port, warp, pings = int(sys.argv[1]), float(sys.argv[2]), int(sys.argv[3])
mail, clock = queue.Queue(), Clock(warp)
db = MoosDB("localhost", port, "vehicle", clock, {"ACTIVE_SONAR_LATENCY": 0, "ACTIVE_SONAR_TRACK": 0},
            mail.put, print)
db.start()
x, y, depth, heading, speed, begun = 0.0, 0.0, 4500.0, 0.0, 2.0, clock()
db.notify("SIM_TARGET", "name=target,x=20000,y=6000,depth=125,speed=4,heading=270,strength=30")
elevation, tracks = 5.0, 0
for number in range(1, pings + 1):
    now = clock()
    x += speed * math.sin(math.radians(heading)) * (now - begun)
    y += speed * math.cos(math.radians(heading)) * (now - begun)
    begun = now
    for name, value in (("X", x), ("Y", y), ("DEPTH", depth),
                        ("HEADING", heading), ("SPEED", speed)):
        db.notify("NAV_" + name, value)
    db.notify("ACTIVE_SONAR_COMMAND", f"elevation={elevation:g},type=cw,centre_frequency=4000,"
              "duration=1,window=hann,level=230,beamwidth=8")
    done, loudest = False, None
    while not done:  # the record is received after its 40 s; then the tracks come, and the next ping
        message = mail.get(timeout=60)
        fields = dict(part.split("=") for part in message.str_value.split(","))
        done = message.key == "ACTIVE_SONAR_LATENCY" and int(fields["ping"]) >= number
        if message.key == "ACTIVE_SONAR_TRACK" and fields["ended"] == "false":
            tracks += 1
            if loudest is None or float(fields["snr_db"]) > float(loudest["snr_db"]):
                loudest = fields
    if loudest is not None:
        heading = 40.0  # a line of phones hears right and left alike; a turn tells which it is
        look = math.atan2(depth - 125.0, float(loudest["range"]))
        elevation = math.degrees(look) - 4.5  # rays bend
db.notify("VEHICLE_DONE", float(tracks))
time.sleep(1)
db.close()

#!/usr/bin/env python3
"""How late the blocks of `listen` come, as docs/performance.md has it: one client by a pipe, by the clock, one thread.

    ASDIC=build/ci/bin/asdic /usr/bin/python3 scripts/listen_lateness.py [SECONDS]        120 by default

16 phones under way in the deep ocean, a sweep of 400 Hz about 4 kHz, complex baseband, reverberation, noise, three
targets; a ping each 20 s and a new array shape each second, told ahead of their time or when they happen.
"""
import os
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "python"))
from asdic_client import Client  # noqa: E402

SETTINGS = ["pings={samples='baseband', recording_duration=40.0}", "platform.velocity=[0.0, 2.5, 0.0]",
            "pulse={kind='lfm', start_frequency=3800.0, end_frequency=4200.0, duration=1.0, window='tukey'}",
            "target=[{name='a', position=[20000.0, 8000.0, 125.0], velocity=[-4.0, 0.0, 0.0], strength_db=20.0},"
            "{name='b', position=[9000.0, 8000.0, 3000.0], velocity=[0.0, 3.0, 0.0], strength_db=20.0},"
            "{name='c', position=[-4000.0, 5000.0, 4300.0], velocity=[1.0, -2.0, 0.0], strength_db=20.0}]"]


def lateness(seconds, ahead):
    """→ [blocks] how long after its last sample each came [s]; without `ahead` [s], what happens is told then"""
    words = [word for setting in SETTINGS for word in ("--set", setting)]
    late, ping, shape = [], 3.0, 5.0
    with Client.start(ROOT / "scenarios" / "deep_ocean.toml", "--pace", "real", "--threads", "1", *words,
                      program=os.environ["ASDIC"]) as sonar:
        sonar.listen(block=0.02, seconds=seconds)
        for block in sonar.blocks():
            late.append(block.behind)
            if block.time >= ping - (ahead or 0.0):
                sonar.ping(**({"time": ping} if ahead else {}))
                ping += 20.0
            if block.time >= shape - (ahead or 0.0):
                sonar.update(array={"heading_deg": 3.0 * shape % 180.0}, **({"time": shape} if ahead else {}))
                shape += 1.0
    return np.array(late)


def main():
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 120.0
    print("| told | median | 99 % | 99.9 % | longest | blocks more than one late |\n|---|---|---|---|---|---|")
    for what, ahead in (("2.5 s ahead", 2.5), ("when it happens", None)):
        late = lateness(seconds, ahead)
        figures = " | ".join(f"{1e3 * value:.1f} ms" for value in np.percentile(late, [50, 99, 99.9, 100]))
        print(f"| {what} | {figures} | {100.0 * np.mean(late > 0.02):.1f} % |", flush=True)


main()

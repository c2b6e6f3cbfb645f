#!/usr/bin/env python3
"""Latencies of `asdic serve` as docs/performance.md has them: one client by a pipe, one thread.

    ASDIC=build/ci/bin/asdic /usr/bin/python3 scripts/serve_latency.py [PINGS]        1000 by default
"""
import os
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "python"))
from asdic_client import Client  # noqa: E402

PINGS = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
WARM = 20
QUIET = ("--set", "reverberation={enabled=false}")
RECORD = ("--set", 'pings={samples="baseband", recording_duration=60.0, baseband_rate=400.0}')


def still(sonar, ping):
    """The scenario's target goes away in an hour of pings: here it stays."""
    if ping == 0:
        sonar.update(targets={"velocity": [0.0, 0.0, 0.0]})


def target_moves(sonar, ping):
    sonar.update(targets={"position": [25e3 - 3.0 * ping, 2.0 * ping, 125.0]})


def all_move(sonar, ping):
    """A vehicle under way, and a target too: echoes' delays are curves while the pulse lasts."""
    sonar.update(platform={"position": [1.5 * ping, 0.7 * ping, 4500.0], "heading_deg": 65.0,
                           "speed": 1.7},
                 array={"heading_deg": 65.0 + 0.1 * (ping % 100)},
                 targets={"position": [25e3 - 3.0 * ping, 2.0 * ping, 125.0],
                          "velocity": [-3.0, 2.0, 0.0]})


def measure(what, move, *options, pings=PINGS, deliver="samples"):
    """Least, p50 and p99 of the answers' `latency` [ms]."""
    program = os.environ.get("ASDIC", "asdic")
    took = []
    with Client.start(ROOT / "scenarios/deep_ocean.toml", *RECORD, *options, "--threads", "1",
                      program=program) as sonar:
        for ping in range(WARM + pings):
            move(sonar, ping)
            took.append(1e3 * sonar.ping(deliver=deliver).answer["latency"])
    took = np.array(took[WARM:])
    print(f"| {what} | {took.min():.1f} ms | {np.percentile(took, 50):.1f} ms "
          f"| {np.percentile(took, 99):.1f} ms |", flush=True)


if __name__ == "__main__":
    print("load", *os.getloadavg())
    measure("nothing moves, propagation known", still, *QUIET)
    measure("the target moves", target_moves, *QUIET)
    measure("vehicle and target are under way", all_move, *QUIET)
    measure("the same with reverberation", all_move, pings=PINGS // 5)
    with tempfile.TemporaryDirectory() as folder:
        measure("nothing moves, a file a ping", still, *QUIET, "--output-dir", folder,
                pings=PINGS // 5, deliver="file")
    print("load", *os.getloadavg())

#!/usr/bin/env python3
"""The tracker of asdic-moos and of ROS's nodes: its errors are those that it tells.

Truth: targets drawn from the tracker's own model, received with the errors that it is told. Then
the squared error over the told variance is chi-square distributed: two numbers of place have the
mean 2, four of the state
the mean 4. A tracker that is told a third of the errors must fail.
"""
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "tests/support")]
from asdic_middleware.tracker import Tracker, TrackerSettings  # noqa: E402
from checks import check  # noqa: E402
from deep import DEEP  # noqa: E402

INTERVAL, PINGS, SOUND = 40.0, 12, 1500.0
OWN = np.array([3.0, -1.0])  # the sonar's velocity [m/s]
RUNS = 400 if DEEP else 60


def received(rng, settings, state, time, own, mirror):
    """A detection of the target: where the sound struck it, with errors; the other side of a line
    east-west.
    """
    away = state[:2] - own
    delay = 2 * np.hypot(*away) / SOUND
    struck = state[:2] + state[2:] * delay / 2
    away = struck - own
    distance = np.hypot(*away)
    u = away / distance
    side = np.array([-u[1], u[0]])
    place = struck + u * rng.normal(0, settings.range_sigma) + \
        side * rng.normal(0, distance * np.radians(settings.bearing_sigma_deg))
    rate = u @ (state[2:] - OWN) + rng.normal(0, settings.rate_sigma)
    one = {"x": place[0], "y": place[1], "range_rate": rate}
    other = {"x": place[0], "y": 2 * own[1] - place[1], "range_rate": rate}
    return {"time": delay, "snr_db": 20.0, "places": [one, other] if mirror else [one]}


def run(rng, settings, truth_settings, mirror=False, alarms=0):
    """→ normalised squared errors of place and of state at the end of a track (None: there is
    none), tracks
    """
    tracker = Tracker(settings)
    state = np.array([rng.uniform(-5e3, 5e3), rng.uniform(1e4, 2e4), *rng.uniform(-5, 5, 2)])
    q = truth_settings.acceleration
    root = np.linalg.cholesky(
        np.array([[INTERVAL**3 / 3, INTERVAL**2 / 2], [INTERVAL**2 / 2, INTERVAL]]))
    for ping in range(PINGS):
        time, own = ping * INTERVAL, OWN * ping * INTERVAL
        if ping:
            state[:2] += state[2:] * INTERVAL
            for k in (0, 1):
                push = q * root @ rng.normal(size=2)
                state[k] += push[0]
                state[2 + k] += push[1]
        found = [received(rng, truth_settings, state, time, own, mirror)]
        for _ in range(alarms):
            x, y = rng.uniform(-2e4, 2e4, 2)
            found.append({"time": 2 * np.hypot(x, y) / SOUND, "snr_db": 13.0, "places": [
                {"x": x, "y": y, "range_rate": rng.uniform(-15, 15)}]})
        told = tracker.update(time, found, own, OWN)
    best = [t for t in told if np.hypot(*(t.state[:2] - state[:2])) < 5e3 and not t.missed]
    if not best:
        return None, len(told)
    track = max(best, key=lambda t: t.hits)
    off = track.state - state
    at, whole = track.covariance[:2, :2], track.covariance
    return (off[:2] @ np.linalg.solve(at, off[:2]), off @ np.linalg.solve(whole, off)), len(told)


def mean_errors(settings, truth, runs=RUNS, **more):
    rng = np.random.default_rng(20130601)
    ends = [run(rng, settings, truth, **more) for _ in range(runs)]
    good = [e for e, _ in ends if e is not None]
    return np.mean(good, axis=0), len(good), [count for _, count in ends]


def test_told_errors():
    truth = TrackerSettings()
    (place, state), count, _ = mean_errors(TrackerSettings(), truth)
    # the mean of n chi-square numbers of k degrees has the deviation √(2k/n); 4.9 of them are 10⁻⁶.
    # Gates leave out one measurement of 1000, whose errors would be largest: 0.1 below at most
    check(count >= 0.95 * RUNS, f"{count} tracks of {RUNS}")
    check(abs(place - 2) < 4.9 * np.sqrt(4 / count) + 0.1, f"place: {place}, not 2")
    check(abs(state - 4) < 4.9 * np.sqrt(8 / count) + 0.1, f"state: {state}, not 4")
    bold = TrackerSettings(range_sigma=truth.range_sigma / 3,
                           bearing_sigma_deg=truth.bearing_sigma_deg / 3)
    (place, _), count, _ = mean_errors(bold, truth)
    check(place > 2 + 4.9 * np.sqrt(4 / max(count, 1)) + 0.1, f"a wrong model passes: {place}")


def test_false_alarms():
    """Twenty false alarms a ping, anywhere in 1600 km², begin twenty tracks; hardly one of them
    has three hits in four pings, and the target's is there.
    """
    _, count, tracks = mean_errors(TrackerSettings(), TrackerSettings(), RUNS // 3, alarms=20)
    check(count >= 0.8 * (RUNS // 3), f"{count} tracks of {RUNS // 3}")
    check(np.mean(tracks) < 1.5, f"{np.mean(tracks)} tracks of one target")


def test_mirror():
    """Both sides are tracked while the line lies still; both are told."""
    _, count, tracks = mean_errors(TrackerSettings(), TrackerSettings(), mirror=True)
    check(count >= 0.9 * RUNS and 1.5 < np.mean(tracks) < 2.5, f"{count}, {np.mean(tracks)}")


def main():
    for name, test in list(globals().items()):
        if name.startswith("test_"):
            test()
            print(f"{name} ok")


if __name__ == "__main__":
    main()

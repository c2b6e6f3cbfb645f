"""Tracks of what a receiver finds from ping to ping.

A track is a Kalman filter of place and velocity (x, y, vx, vy) in the plane, moved by white noise
of acceleration (Bar-Shalom, Li, Kirubarajan, Estimation with Applications to Tracking and
Navigation, 2001, section 6.2.2). A detection measures its place, with errors along and across the
line of sight,
and the rate of its range, which Doppler shows. Each side of an array that hears right and left
alike is tracked; a turn tells which is real.

A track is believed after `hits` in its first `of` pings, and ends after `misses` pings without one.
"""
from dataclasses import dataclass, field

import numpy as np

MOST_TRACKS = 500
GATE = 16.3  # of three measured numbers: 1 in 1000 of the true ones falls outside (chi-square)


@dataclass
class TrackerSettings:
    hits: int = 3
    of: int = 4
    misses: int = 4
    acceleration: float = 0.02   # root of its density [m/s² √s]
    most_speed: float = 15.0     # of targets [m/s]
    range_sigma: float = 50.0    # of a place, along the line of sight [m]
    bearing_sigma_deg: float = 1.0
    rate_sigma: float = 0.5      # of the range's rate [m/s]


@dataclass
class Track:
    """number [from 1], state [x, y, vx, vy], covariance [4 × 4], time [s] of the state."""

    number: int
    state: np.ndarray
    covariance: np.ndarray
    time: float
    hits: int = 1
    pings: int = 1
    missed: int = 0
    confirmed: bool = False
    ended: bool = False
    snr_db: float = 0.0
    seen: list = field(default_factory=list)  # numbers of pings with a hit

    @property
    def position_sigma(self):
        return float(np.sqrt(max(np.trace(self.covariance[:2, :2]), 0.0)))


class Tracker:
    def __init__(self, settings=None):
        self.settings = settings or TrackerSettings()
        self.tracks, self._count = [], 0

    def update(self, time, detections, own_position, own_velocity):
        """One ping.

        time          of the ping [s]
        detections    as receiver.process() has them
        own_position  [x, y] of the sonar then; own_velocity likewise
        → tracks that are believed, and those that end with this ping
        """
        own, moving = np.asarray(own_position, float), np.asarray(own_velocity, float)
        measured = [m for d in detections for p in d["places"]
                    for m in [self._measured(time, d, p, own, moving)] if m is not None]
        for track in self.tracks:
            self._predict(track, time)
        free = self._assign(measured)
        for track in self.tracks:
            if track.pings <= self.settings.of and not track.confirmed:
                track.confirmed = track.hits >= self.settings.hits
            track.ended = (track.missed >= self.settings.misses
                           or not track.confirmed and track.pings >= self.settings.of
                           or np.hypot(*track.state[2:]) > 2 * self.settings.most_speed)
        told = [t for t in self.tracks if t.confirmed]
        self.tracks = [t for t in self.tracks if not t.ended]
        for m in free[:max(0, MOST_TRACKS - len(self.tracks))]:
            self._begin(m)
        return told

    def _measured(self, time, detection, place, own, moving):
        """→ (time, z = [x, y, range rate], u, R, snr) or None without a place"""
        if place["x"] is None or place["y"] is None:
            return None
        s = self.settings
        away = np.array([place["x"], place["y"]]) - own
        distance = float(np.hypot(*away))
        if not distance > 0:
            return None
        u = away / distance
        side = np.array([-u[1], u[0]])
        across = max(distance * np.radians(s.bearing_sigma_deg), 1.0)
        noise = np.zeros((3, 3))
        noise[:2, :2] = s.range_sigma**2 * np.outer(u, u) + across**2 * np.outer(side, side)
        rate = place.get("range_rate")
        noise[2, 2] = s.rate_sigma**2 if rate is not None else 1e12
        z = np.array([place["x"], place["y"], (rate or 0.0) + float(u @ moving)])
        return time + detection["time"] / 2, z, u, noise, detection["snr_db"]

    def _predict(self, track, time):
        """x ← F x, P ← F P Fᵀ + Q over the time since its state."""
        dt = max(time - track.time, 0.0)
        move = np.eye(4)
        move[0, 2] = move[1, 3] = dt
        q = self.settings.acceleration**2
        grown = np.kron(np.array([[dt**3 / 3, dt**2 / 2], [dt**2 / 2, dt]]), np.eye(2)) * q
        track.state = move @ track.state
        track.covariance = move @ track.covariance @ move.T + grown
        track.time = max(time, track.time)

    def _assign(self, measured):
        """The nearest first, each track and each measurement once. → measurements without a
        track
        """
        pairs = []
        places = np.array([m[1][:2] for m in measured]).reshape(-1, 2)
        ahead = np.array([m[0] for m in measured])
        spreads = np.array([m[3][0, 0] + m[3][1, 1] for m in measured])
        for i, track in enumerate(self.tracks):
            # what lies beyond √gate of the largest spread that it may have is not looked at
            later = (ahead - track.time)[:, None]
            off = places - track.state[:2] - later * track.state[2:]
            most = (track.position_sigma + np.abs(later[:, 0]) * np.sqrt(
                track.covariance[2, 2] + track.covariance[3, 3]))**2 + spreads
            for j in np.flatnonzero((off**2).sum(axis=1) <= GATE * most):
                when, z, u, noise, _ = measured[j]
                innovation, spread, _ = self._innovation(track, when, z, u, noise)
                distance = float(innovation @ np.linalg.solve(spread, innovation))
                if distance < GATE:
                    pairs.append((distance + float(np.linalg.slogdet(spread)[1]), i, j))
        tracks, used = set(), set()
        for _, i, j in sorted(pairs):
            if i in tracks or j in used:
                continue
            tracks.add(i)
            used.add(j)
            self._correct(self.tracks[i], *measured[j])
        for i, track in enumerate(self.tracks):
            track.pings += 1
            if i not in tracks:
                track.missed += 1
        return [m for j, m in enumerate(measured) if j not in used]

    @staticmethod
    def _innovation(track, when, z, u, noise):
        """The place is that of the strike, `ahead` after the ping: H = [I ahead·I; 0 uᵀ]."""
        ahead = when - track.time
        h = np.zeros((3, 4))
        h[:2, :2] = np.eye(2)
        h[:2, 2:] = ahead * np.eye(2)
        h[2, 2:] = u
        return z - h @ track.state, h @ track.covariance @ h.T + noise, h

    def _correct(self, track, when, z, u, noise, snr):
        innovation, spread, h = self._innovation(track, when, z, u, noise)
        gain = np.linalg.solve(spread, h @ track.covariance).T
        keep = np.eye(4) - gain @ h
        track.state = track.state + gain @ innovation
        track.covariance = keep @ track.covariance @ keep.T + gain @ noise @ gain.T  # Joseph's form
        track.hits += 1
        track.missed = 0
        track.snr_db = snr

    def _begin(self, measured):
        """Its velocity is known along the line of sight; across it, it is anybody's guess."""
        when, z, u, noise, snr = measured
        side = np.array([-u[1], u[0]])
        covariance = np.zeros((4, 4))
        covariance[:2, :2] = noise[:2, :2]
        along = min(noise[2, 2], self.settings.most_speed**2 / 3)
        covariance[2:, 2:] = along * np.outer(u, u) + \
            self.settings.most_speed**2 / 3 * np.outer(side, side)
        self._count += 1
        self.tracks.append(Track(self._count, np.concatenate([z[:2], z[2] * u]), covariance, when,
                                 snr_db=snr))

"""What is known of vehicle, targets and array, and how `asdic serve` is told of it."""
import math
import threading

import numpy as np

from . import quantities
from .quantities import Wrong, shown

MOST_TARGETS = 64
SLEW = 10.0                  # to a place off the way that was told, while listening [m/s]


class World:
    """Inputs may come from any thread, the rest from that which speaks with the server.

    clock   Steady, the middleware's time [s]
    errors  Errors
    """

    def __init__(self, settings, clock, errors):
        self.settings, self._clock, self._errors = settings, clock, errors
        self._lock = threading.Lock()
        self._platform, self._targets = {}, {}  # as they were told, and taken
        self._changes = {}           # of targets, not yet told to the server
        self._phones = None          # (places, time)
        self._fresh = {"platform": False, "phones": False}
        self._origin, self._tell = 0.0, None
        self.listening = False       # then nothing jumps
        self.velocity, self.place = (0.0, 0.0), None

    def begin(self, state, origin, tell):
        """A new session, which knows nothing.
        state   of the server, its answer
        origin  the middleware's time when the scenario's began [s]
        tell    called with (what, t, **change) → whether it was taken; None: it came too late
        """
        self._origin, self._tell, self.listening = origin, tell, False
        self._platform_now = named(state["platforms"], self.settings.platform, "platform")
        self._array_now = named(state["arrays"], self.settings.array, "array")
        self._several = {what: len(state[what]) > 1 for what in ("platforms", "arrays", "targets")}
        self._known_targets = {t["name"] for t in state["targets"]}
        self.place, self._place_time = list(self._platform_now["position"]), state["time"]
        self.velocity = tuple(self._platform_now["velocity"][:2])
        self._known_place = True
        with self._lock:
            self._fresh = {"platform": bool(self._platform), "phones": self._phones is not None}
            for name, target in self._targets.items():
                self._changes[name] = {**target, **self._changes.get(name, {}), "before": target}
            self._targets.clear()

    def has_a_place(self):
        """Whether all of one was told."""
        return {"x", "y", "depth"} <= set(self._platform)

    def depth(self):
        with self._lock:
            return self._platform.get("depth", (None,))[0]

    def geometry(self):
        place = self.place
        return {"x": place[0], "y": place[1], "depth": place[2]}

    # Inputs ---------------------------------------------------------------------------------------

    def set_platform(self, name, value, where, stamp=None):
        """name: x, y, depth, heading_deg, speed. \\throws Wrong"""
        quantity = next(q for q in quantities.PLATFORM if q.key == name)
        value = quantity.of(value, where)
        with self._lock:
            self._platform[name] = (value, self._clock.of(stamp))
            self._fresh["platform"] = True

    def set_target(self, fields, where, stamp=None):
        """fields: as quantities.keyed() has them of TARGET. \\throws Wrong"""
        fields = quantities.target_of(fields, where)
        name = fields["name"]
        with self._lock:
            if name not in self._targets and \
                    len(self._targets) + len(self._changes) >= MOST_TARGETS:
                raise Wrong(f"{where}: {shown(name)}", f"one more than {MOST_TARGETS} targets",
                            "fewer; remove=true takes one out")
            before = self._changes.get(name, {})
            anew = fields.get("remove") == "true" or "remove" in before
            change = {**({} if anew else before), **fields, "where": where, "before": before}
            if "x" in fields:
                change["time"] = self._clock.of(stamp)
            before.pop("before", None)
            self._changes[name] = change

    def set_phones(self, places, stamp=None):
        """places: as quantities.positions_of() has them"""
        with self._lock:
            self._phones = (places, self._clock.of(stamp))
            self._fresh["phones"] = True

    # Changes --------------------------------------------------------------------------------------

    def update(self, t):
        """Tells the server what has come. Each thing by itself: one that is refused is told and
        forgotten. → whether the platform is where the vehicle is
        """
        with self._lock:
            fresh, self._fresh = self._fresh, {"platform": False, "phones": False}
            platform, phones = dict(self._platform), self._phones
            changes, self._changes = self._changes, {}
        if self.listening:
            # told a little ahead, so that what it changes has not sounded yet
            t += max(self.settings.block, 0.5 * self.settings.update)
            if t - self._place_time < 0.5 * self.settings.update:
                with self._lock:
                    for what in fresh:
                        self._fresh[what] |= fresh[what]
                for name, change in changes.items():
                    self._put_back(name, change)
                return self._known_place
        ahead, self._place_time = t - self._place_time, t
        self._step = ahead
        self.place = [self.place[0] + self.velocity[0] * ahead,
                      self.place[1] + self.velocity[1] * ahead, self.place[2]]
        if fresh["platform"]:
            before = list(self.place), self.velocity
            change = {"platform": self._platform_fields(platform, t)}
            if self.settings.array_follows_heading and "heading_deg" in platform and phones is None:
                change["array"] = self._one("array", {"heading_deg": platform["heading_deg"][0]})
            told = self._tell("NAV", t, **change)
            if told is not None:
                self._known_place = told
            if not told:  # pings must not go from elsewhere
                self.place, self.velocity = before
            if told is None:
                with self._lock:
                    self._fresh["platform"] = True
        if fresh["phones"] and \
                self._tell("the array", t, array=self._phone_fields(*phones)) is None:
            with self._lock:
                self._fresh["phones"] = True
        for name, change in changes.items():
            self._update_target(name, change, t)
        return self._known_place

    def _put_back(self, name, change):
        """A target's change for later, before what came since."""
        with self._lock:
            self._changes[name] = {**change, **self._changes.get(name, {})}

    def _one(self, what, fields):
        """With its name, where there are several."""
        if self._several[what + "s"]:
            fields["name"] = (self._platform_now if what == "platform" else self._array_now)["name"]
        return fields

    def _platform_fields(self, known, t):
        """The place now, by the latest fix and how it moves."""
        place, velocity = list(self.place), self.velocity
        fields = {}
        if "speed" in known or "heading_deg" in known:
            speed = known.get("speed", (math.hypot(*velocity), 0))[0]
            heading = known.get("heading_deg", (math.degrees(math.atan2(*velocity)), 0))[0]
            velocity = quantities.velocity_of(speed, heading)
            if speed >= 0:
                fields = {"speed": speed, "heading_deg": heading}
            else:  # astern
                fields = {"velocity": [*velocity, 0.0]}
        for k, name in enumerate(("x", "y", "depth")):
            if name in known:
                value, stamp = known[name]
                place[k] = value + (velocity[k] * (t - self._since(stamp)) if k < 2 else 0.0)
        place, late = self._slewed(self.place, place)
        if late:
            self._errors.warn("the vehicle is not where it was going while it listens: it goes "
                              f"there at {SLEW:g} m/s")
            with self._lock:
                self._fresh["platform"] = True
        self.place, self.velocity = place, velocity
        fields["position"] = list(place)
        return self._one("platform", fields)

    def _slewed(self, expected, wanted):
        """While listening nothing jumps: → the place on the way from where it was going to where it
        is said to be, and whether that is not reached.
        """
        if not self.listening:
            return wanted, False
        off = np.subtract(wanted, expected)
        reach = SLEW * min(self._step, max(self.settings.block, 0.5 * self.settings.update))
        distance = float(np.linalg.norm(off))
        if distance <= reach:
            return wanted, False
        return [float(e + o * reach / distance) for e, o in zip(expected, off)], True

    def _since(self, stamp):
        return stamp - self._origin

    def _phone_fields(self, places, stamp):
        """The world's places → from the platform, where it was then."""
        with self._lock:
            known = dict(self._platform)
        fix = list(self.place)
        for k, name in enumerate(("x", "y")):
            if name in known:
                fix[k] = known[name][0] + self.velocity[k] * (stamp - known[name][1])
        if "depth" in known:
            fix[2] = known["depth"][0]
        rows = [[one - at for one, at in zip(row, fix)] for row in places]
        return self._one("array", {"positions": rows, "offset": [0.0, 0.0, 0.0]})

    def _update_target(self, name, change, t):
        """Tells what is said of a target. If that is refused the latest message is forgotten."""
        before = change.pop("before", None)
        where = f"{change['where']}: {name}"
        if change.get("remove") == "true":
            if name in self._known_targets and \
                    self._tell(where, t, targets=[{"name": name, "remove": True}]):
                self._known_targets.discard(name)
            with self._lock:
                self._targets.pop(name, None)
            return
        known = self._carried_on(name, t)
        whole = {**known, **change}
        fields = {"name": name}
        if "strength_db" in change:
            fields["strength_db"] = change["strength_db"]
        if "heading_deg" in change:
            fields["heading_deg"] = change["heading_deg"]
            if "speed" in whole:
                fields["speed"] = whole["speed"]
        if "x" in change:
            east, north = self._velocity_of(whole)
            ahead = t - self._since(change["time"])
            place = [change["x"] + east * ahead, change["y"] + north * ahead, change["depth"]]
            if "x" in known:
                place, late = self._slewed([known["x"], known["y"], known["depth"]], place)
                if late:
                    self._errors.warn(f"{where}: it is not where it was going while it is "
                                      f"listened to: it goes there at {SLEW:g} m/s")
                    self._put_back(name, {**change, "before": {}})
            whole |= dict(zip(("x", "y", "depth"), place))
            fields["position"] = place
        whole["time"] = self._origin + t
        told = self._tell(where, t, targets=[fields])
        if told:
            self._known_targets.add(name)
            with self._lock:
                self._targets[name] = whole
            return
        if told is None:
            self._put_back(name, change)
            return
        if known:
            with self._lock:
                self._targets[name] = known
        if before:
            self._update_target(name, before, t)

    @staticmethod
    def _velocity_of(target):
        return quantities.velocity_of(target.get("speed", 0.0), target.get("heading_deg", 0.0))

    def _carried_on(self, name, t):
        """What is known of a target, where it is at t."""
        with self._lock:
            known = dict(self._targets.get(name, {}))
        if "x" in known:
            east, north = self._velocity_of(known)
            ahead = t - self._since(known["time"])
            known |= {"x": known["x"] + east * ahead, "y": known["y"] + north * ahead,
                      "time": self._origin + t}
        return known


def named(known, name, what):
    for one in known:
        if not name or one["name"] == name:
            return one
    raise ValueError(f"{what}: found {shown(name)}, expected one of "
                     + ", ".join(one["name"] for one in known))

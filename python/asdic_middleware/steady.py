"""Time of the middleware without the steps of its clock."""
import time

MOST_SKEW = 10.0   # largest skew of a stamp against the clock [s]; beyond it the stamp counts as now
LEAST_STEP = 1.0   # smallest step of the clock that is reported [s]


class Steady:
    """Time that begins with the middleware's clock [s] and then follows a clock that nobody can set, so that
    results are due, and published times continue, without the steps of the machine's clock.

    clock     function that returns the middleware's time [s]
    factor    its speed
    followed  whether the clock is that of a simulation, which may stop, and is therefore always followed
    """

    def __init__(self, clock, factor=1.0, followed=False):
        self._clock, self._factor, self._followed = clock, factor, followed
        self._near = max(factor, 1.0)
        self._ahead = None  # offset of the even clock [s]; None before the beginning
        self._known = 0.0   # reported steps of the clock, their sum [s]

    def begin(self):
        """Begins the even time, once the middleware's clock is known."""
        if not self._followed and self._ahead is None:
            self._ahead = self._clock() - self._even()

    def _even(self):
        return self._factor * time.monotonic()

    def __call__(self):
        return self._clock() if self._ahead is None else self._ahead + self._even()

    def stepped(self):
        """Sum of the clock's steps since the beginning [s], once after each step; otherwise 0."""
        off = self._clock() - self()
        if abs(off - self._known) <= LEAST_STEP * self._near:
            return 0.0
        self._known = off
        return off

    def of(self, stamp):
        """Even time of an event stamped by the middleware's clock [s]; None: now."""
        age = 0.0 if stamp is None else self._clock() - stamp
        return self() - (age if abs(age) <= MOST_SKEW * self._near else 0.0)

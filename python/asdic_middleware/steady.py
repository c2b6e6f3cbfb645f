"""The middleware's time as it goes on evenly."""
import time

MOST_SKEW = 10.0   # largest skew of a stamp against the clock [s]; beyond it the stamp counts as now
LEAST_STEP = 1.0   # smallest step of the clock that is reported [s]


class Steady:
    """Time that begins with the middleware's clock [s] and then goes by a clock that nobody sets. What
    waits for its time, and every time that is published, does not follow a step of the machine's clock.

    clock     the middleware's [s], a function
    factor    how fast it goes
    followed  the middleware's clock is that of a simulation, which may stop: it is followed as it goes
    """

    def __init__(self, clock, factor=1.0, followed=False):
        self._clock, self._factor, self._followed = clock, factor, followed
        self._near = max(factor, 1.0)
        self._ahead = None  # offset of the even clock [s]; None before the beginning
        self._known = 0.0   # reported steps of the clock, their sum [s]

    def begin(self):
        """From now on, once the middleware's clock is known."""
        if not self._followed and self._ahead is None:
            self._ahead = self._clock() - self._even()

    def _even(self):
        return self._factor * time.monotonic()

    def __call__(self):
        return self._clock() if self._ahead is None else self._ahead + self._even()

    def stepped(self):
        """How far the middleware's clock was set since the beginning [s], once after each step; else 0."""
        off = self._clock() - self()
        if abs(off - self._known) <= LEAST_STEP * self._near:
            return 0.0
        self._known = off
        return off

    def of(self, stamp):
        """When something was that the middleware's clock stamps; None: now."""
        age = 0.0 if stamp is None else self._clock() - stamp
        return self() - (age if abs(age) <= MOST_SKEW * self._near else 0.0)

"""Results that wait for their time."""
import heapq
import itertools
import threading

MOST_HELD_BYTES = 512 << 20  # of samples that are not due


class Due:
    """Lets results go when they are due by a clock, in a thread of its own.

    clock  [s], a function; it goes `factor` times as fast as time does. None: all are due at once
    emit   called with (kind, dict)
    error  called with a line
    """

    def __init__(self, clock, factor, emit, error):
        self._clock, self._factor, self._emit, self._error = clock, factor, emit, error
        self._held, self._held_bytes, self._count = [], 0, itertools.count()
        self._due, self._stopped = threading.Condition(), False

    def stop(self):
        with self._due:
            self._stopped = True
            self._due.notify_all()

    def hold(self, due, kind, what):
        """Lets a result go at `due`; at once where there is no clock."""
        if self._clock is None:
            self._emit(kind, what)
            return
        size = what["data"].nbytes if kind == "samples" else 0
        with self._due:
            if self._held_bytes + size > MOST_HELD_BYTES:
                full = True
            else:
                full = False
                self._held_bytes += size
                heapq.heappush(self._held, (due, next(self._count), kind, what))
                self._due.notify()
        if full:
            self._error(f"ping {what['ping']}: a block of samples is lost: more than "
                        f"{MOST_HELD_BYTES} bytes wait for their time")

    def let_go(self):
        while True:
            with self._due:
                if self._stopped:
                    return
                if not self._held:
                    self._due.wait(0.5)
                    continue
                late = self._clock() - self._held[0][0]
                if late < 0:
                    self._due.wait(min(-late / max(self._factor, 1e-9), 0.5))
                    continue
                _, _, kind, what = heapq.heappop(self._held)
                if kind == "samples":
                    self._held_bytes -= what["data"].nbytes
            self._emit(kind, what)

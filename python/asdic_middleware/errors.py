"""Errors, as they are told: a line each, and no flood of them."""
import threading
import time

ERRORS_PER_SECOND = 20
MOST_WARNINGS = 100


class Errors:
    """emit  called with ("error", {"message"})"""

    def __init__(self, emit):
        self._emit, self._lock = emit, threading.Lock()
        self._errors = [0.0, 0, 0]   # second, told in it, held back
        self._warned = ()

    def tell(self, text):
        """One line; of more than so many a second their number alone is told."""
        now = time.monotonic()
        with self._lock:
            if now - self._errors[0] >= 1.0:
                held, self._errors = self._errors[2], [now, 0, 0]
            else:
                held = 0
            self._errors[1] += 1
            over = self._errors[1] > ERRORS_PER_SECOND
            self._errors[2] += over
        if held:
            self._emit("error", {"message": f"{held} more errors came within a second; they are "
                                            "not told one by one"})
        if not over:
            self._emit("error", {"message": " ".join(text.split())[:500]})

    def warn(self, line):
        """Once each."""
        if line not in self._warned and len(self._warned) < MOST_WARNINGS:
            self._warned = (*self._warned, line)
            self.tell(f"warning: {line}")

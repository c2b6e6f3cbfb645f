"""Requests of sound paths, answered one after the other."""
import queue

from . import paths
from .quantities import Wrong

MOST_REQUESTS_WAITING = 16


class PathRequests:
    """
    depth  a function: the vehicle's [m], None while it is not known
    emit   called with ("paths", dict)
    error  called with a line
    """

    def __init__(self, settings, depth, emit, error):
        self._settings, self._depth, self._emit, self._error = settings, depth, emit, error
        self._requests = queue.Queue(MOST_REQUESTS_WAITING)

    def put(self, asked, where):
        """asked: as quantities.paths_of() has it. \\throws Wrong"""
        try:
            self._requests.put_nowait((asked, where))
        except queue.Full:
            raise Wrong(where, f"{MOST_REQUESTS_WAITING} requests that wait",
                        "fewer; it is not answered") from None

    def answer(self, stop):
        """Until an event."""
        while not stop.is_set():
            try:
                asked, where = self._requests.get(timeout=0.2)
            except queue.Empty:
                continue
            ident = {"id": asked["id"]} if "id" in asked else {}
            try:
                if not self._settings.scenario:
                    raise paths.PathsError("found no scenario in the settings, expected one")
                found = paths.answer(self._settings.program, asked, self._settings.scenario,
                                     self._depth(), self._settings.arguments)
            except (paths.PathsError, OSError) as error:
                self._error(f"{where}: {error}")
                found = {"ok": False, **ident, "message": str(error)}
            self._emit("paths", found)

"""One connection to `asdic serve` whose answers and blocks of sound may come in any order."""
import threading

from asdic_client import Client, Ping, Refused

TIME_LIMIT = 600  # of a command [s]


class Link:
    """call() may come from any thread. on_block(answer, samples) is called in the reader's
    thread.
    """

    def __init__(self, client, on_block):
        self.client, self._on_block = client, on_block
        self.greeting = client.greeting
        self._lock, self._answers = threading.Condition(), {}
        self._waiting = set()
        self.broken = None
        threading.Thread(target=self._read, name="asdic serve", daemon=True).start()

    def call(self, command, **fields):
        """→ answer, samples. \\throws Refused, ConnectionError"""
        with self._lock:
            if self.broken:
                raise ConnectionError(self.broken)
            sent = self.client.send(command, **fields)
            self._waiting.add(sent)
            done = self._lock.wait_for(lambda: sent in self._answers or self.broken, TIME_LIMIT)
            self._waiting.discard(sent)
            if sent in self._answers:
                answer, samples = self._answers.pop(sent)
            elif done:
                raise ConnectionError(self.broken)
            else:
                raise ConnectionError(f"{command}: no answer within {TIME_LIMIT} s")
        if not answer["ok"]:
            raise Refused(answer["error"])
        return answer, samples

    def ping(self, **fields):
        return Ping(*self.call("ping", **fields))

    def _read(self):
        try:
            while True:
                answer, samples = self.client.receive()
                if "block" in answer and "ok" not in answer:
                    self._on_block(answer, samples)
                    continue
                with self._lock:
                    if answer.get("id") in self._waiting:
                        self._answers[answer["id"]] = (answer, samples)
                    elif answer.get("id") is None and not answer.get("ok", True):
                        self.broken = str(answer.get("error", {}).get("message"))
                    self._lock.notify_all()
        except (OSError, ValueError, KeyError) as error:
            with self._lock:
                self.broken = self.broken or f"asdic serve: {error}"
                self._lock.notify_all()

    def close(self):
        with self._lock:
            self.broken = self.broken or "closed"
            self._lock.notify_all()
        process = getattr(self.client, "process", None)
        if process is not None:
            process.terminate()
        self.client.close()


__all__ = ["Client", "Link", "Refused"]

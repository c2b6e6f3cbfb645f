#!/usr/bin/env python3
"""What a session that listens leaves, its log and its scenario, gives what it heard again.

Truth: what the clients had. A replay at once has the same blocks, bit for bit, whatever the clock did while the session
was live: pings, turns, targets and winds that change, commands that are called off. A server of a saved scenario has
the sound of the session that saved it.

    ASDIC=build/ci/bin/asdic replay.py
"""
import hashlib
import io
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "tests/support")]
from asdic_client import Block, Client  # noqa: E402
from checks import check  # noqa: E402
from served import ASDIC, sea  # noqa: E402

SEA = sea(platform="""position = [0.0, 0.0, 200.0]
velocity = [0.0, 2.0, 0.0]""", target="""name = "rock"
position = [1500.0, 0.0, 300.0]
strength_db = 30.0""", pings="""interval = 2.0
recording_duration = 5.0
samples = "baseband"
baseband_rate = 200.0""")


class Heard:
    """The blocks of a session, and the digest of all their samples after one another."""

    def __init__(self):
        self.blocks, self._digest = [], hashlib.sha256()

    def add(self, block):
        self.blocks.append((block.number, block.time, block.samples.shape))
        self._digest.update(block.samples.tobytes())

    def take(self, client, until=None):
        """The next blocks: to the end, or up to one that ends after a time."""
        for block in client.blocks():
            self.add(block)
            if until is not None and block.time >= until:
                return

    def until_answered(self, client, *ids):
        """The blocks that come before commands are answered; to the end of the connection without any."""
        missing, answers = set(ids), {}
        while client._heard:  # that came while another answer was waited for
            self.add(client._heard.popleft())
        while missing or not ids:
            try:
                line, samples = client.receive()
            except ConnectionError:
                check(not ids, f"no answer to {missing}")
                return answers
            if "block" in line:
                self.add(Block(line, samples))
            elif line.get("id") in missing:
                missing.remove(line["id"])
                answers[line["id"]] = line
        return answers

    def digest(self):
        return self._digest.hexdigest()


class Printed(Client):
    """What a replay prints, as a client reads it."""

    def __init__(self, printed):
        self._reader = io.BytesIO(printed)

    def sessions(self):
        """The blocks of each greeting's session; those of several come in the order of the log."""
        heard, told = [], []
        while self._reader.tell() < len(self._reader.getbuffer()):
            line, samples = self.receive()
            if "asdic" in line:
                heard.append(Heard())
            elif "block" in line:
                heard[-1].add(Block(line, samples))
            else:
                told.append(line)
        return heard, told


def run(log, *more):
    return subprocess.run([ASDIC, "serve", "sea.toml", "--replay", log, *more], capture_output=True)


def replayed(log, *more):
    done = run(log, *more)
    check(done.returncode == 0, done.stderr)
    return Printed(done.stdout).sessions()


def same(live, again, what):
    check(len(live.blocks) == len(again.blocks), f"{what}: {len(live.blocks)} blocks, {len(again.blocks)} replayed")
    for one, other in zip(live.blocks, again.blocks):
        check(one == other, f"{what}: a block is {one}, replayed {other}")
    check(live.digest() == again.digest(), f"{what}: a replay has other bits")


def lines(log):
    return [json.loads(line) for line in Path(log).read_text().splitlines()]


def by_the_clock():
    """Nothing has a time of its own, or has one ahead: when it acted is in the log alone."""
    heard, began = Heard(), time.monotonic()
    with Client.start("sea.toml", "--pace", "20", "--log", "clock.jsonl", program=ASDIC) as client:
        now = client.listen(block=0.05)["time"]
        heard.take(client, now + 2.0)
        sent = [client.ping().answer["time"]]
        heard.take(client, sent[0] + 1.0)
        client.update(platform={"heading_deg": 70, "speed": 4}, array={"heading_deg": 20})
        sent.append(client.ping(elevation_deg=3).answer["time"])
        heard.take(client, sent[1] + 0.5)
        client.update(targets={"position": [1499, 2, 300], "velocity": [-6, 2, 0]})
        client.update(wind_speed=14)
        soon = client.state()["time"] + 3.0
        several = [client.send("ping", time=soon + n) for n in range(3)]
        heard.until_answered(client, *several, client.cancel(several[1]), client.cancel())
        heard.take(client, client.state()["time"] + 3.0)
        client.listen(stop=True)
        heard.take(client)
        client.update(platform={"heading_deg": 200, "speed": 3})  # while nobody listens
        client.ping()
        client.listen(block=0.3, seconds=12.0, schedule=True)
        heard.take(client, client.state()["time"] + 2.0)
        client.ping()  # the schedule goes on from it
        client.update(array={"spacing": 0.7}, targets={"name": "rock", "strength_db": 35})
        client.ping(time=client.state()["time"] + 4.0)
        heard.take(client)
        check(len(client.scheduled) >= 3, f"pings of the schedule: {len(client.scheduled)}")
        client.listen(block=0.1)
        heard.take(client, client.state()["time"] + 1.0)
        heard.until_answered(client, client.send("quit"))
        heard.until_answered(client)
    (again,), told = replayed("clock.jsonl")
    check(sum(line.get("listening") is False for line in told) == 2, "the ends of two are told")
    check(sum("scheduled" in line for line in told) == len(client.scheduled), "pings of the schedule are told")
    same(heard, again, "by the clock")
    # What the log says is what makes it so: with another time of a turn there are other bits.
    changed = lines("clock.jsonl")
    turn = next(line for line in changed if "platform" in line.get("command", {}))
    turn["acts"] += 0.25
    Path("other.jsonl").write_text("".join(json.dumps(line) + "\n" for line in changed))
    (other,), _ = replayed("other.jsonl")
    check(other.blocks == heard.blocks and other.digest() != heard.digest(), "a turn at another time has the same bits")
    print(f"by the clock: {len(heard.blocks)} blocks, {sum(shape[1] for _, _, shape in heard.blocks) / 200.0:.0f} s of "
          f"sound in {time.monotonic() - began:.1f} s; the replay has digest {again.digest()[:12]}, too")


def at_once():
    """With --pace fast; one that was called off ends where it did."""
    heard = Heard()
    with Client.start("sea.toml", "--log", "fast.jsonl", program=ASDIC) as client:
        client.listen(block=0.25, seconds=3.1, schedule=True)
        heard.take(client)
        client.update(platform={"heading_deg": 70, "speed": 4})
        client.ping()
        long = client.listen(block=0.02, seconds=1e6)["id"]
        heard.take(client, 6.0)
        said = heard.until_answered(client, client.cancel(long), long)
        check(said[long]["error"]["code"] == "cancelled", said)
        client.update(wind_speed=3, targets={"strength_db": 35})
        client.ping(time=client.state()["time"] + 0.5)
        client.listen(block=1.0, seconds=4.0)
        heard.take(client)
        client.quit()
    (again,), _ = replayed("fast.jsonl")
    same(heard, again, "as fast as it can")
    print(f"as fast as it can: {len(heard.blocks)} blocks, the same")


def killed():
    """A server that was killed has logged what it began: the replay goes on to the end of that."""
    heard = Heard()
    with Client.start("sea.toml", "--log", "killed.jsonl", program=ASDIC) as client:
        client.listen(block=0.25, seconds=20.0, schedule=True)
        heard.take(client, 8.0)
        client.process.kill()
    (again,), _ = replayed("killed.jsonl")
    check(again.blocks[:len(heard.blocks)] == heard.blocks, "what was delivered is in the replay")
    check(len(again.blocks) == 80, f"{len(again.blocks)} blocks of 20 s")


def refused():
    """A log that does not fit itself is none."""
    right = lines("fast.jsonl")
    place = next(i for i, line in enumerate(right) if "platform" in line.get("command", {}))
    for key, value, said in (("heard", 17, "found heard: 17, expected 400, as far as it is heard here"),
                             ("heard", None, "found no heard")):
        wrong = [dict(line) for line in right]
        wrong[place].update({key: value})
        Path("wrong.jsonl").write_text("".join(json.dumps(line) + "\n" for line in wrong))
        done = run("wrong.jsonl")
        check(done.returncode == 2 and f"wrong.jsonl:{place + 1}: {said}" in done.stderr.decode(), done.stderr)
    wrong = [dict(line) for line in right]
    next(line for line in wrong if "scheduled" in line)["scheduled"] = 9
    Path("wrong.jsonl").write_text("".join(json.dumps(line) + "\n" for line in wrong))
    check(b"found scheduled: 9, expected 1, the next ping here" in run("wrong.jsonl").stderr, "another ping")


def saved():
    """`asdic serve` of what was saved: the same pings, and the same sound."""
    changes = {"wind_speed": 12, "targets": {"strength_db": 40}, "platform": {"heading_deg": 30, "speed": 3}}
    os.mkdir("saves")
    with Client.start("sea.toml", "--output-dir", "saves", program=ASDIC) as client:
        client.ping()
        client.update(**changes)
        client.ping()
        file = client.save()
        check((file["ping"], file["time"]) == (3, 4.0), file)
        mine = [client.ping(deliver="samples") for _ in range(3)]
    with Client.start(file["file"], program=ASDIC) as client:
        for _ in range(2):
            client.ping()
        for one in mine:
            again = client.ping(deliver="samples")
            check(all(again.answer[key] == one.answer[key] for key in ("ping", "time", "targets")), again.answer)
            check(again.samples.tobytes() == one.samples.tobytes(), "a ping of what was saved has other bits")

    def listened(client, seconds):
        client.listen(block=0.5, seconds=seconds, schedule=True)
        return list(client.blocks())

    # By 7 s pings have left up to that of 6 s. What was struck before the changes sounds as that: up to 10 s. What
    # left before them, and sounds on, was made again from there: up to 8 s it has the roundings of other sums.
    with Client.start("sea.toml", "--output-dir", "saves", program=ASDIC) as client:
        listened(client, 3.0)
        client.update(platform=changes["platform"])
        listened(client, 4.0)
        file = client.save()
        check((file["ping"], file["time"]) == (5, 8.0), file)
        mine = listened(client, 8.0)
    with Client.start(file["file"], program=ASDIC) as client:
        listened(client, 7.0)
        again = listened(client, 8.0)
        check(client.scheduled[-1]["ping"] == 8, "eight pings in 15 s")
    for one, other in zip(mine, again):
        check(one.time == other.time, "the same times")
        if one.time < 8.0:
            apart = abs(one.samples - other.samples).max() / abs(one.samples).max()
            check(apart < 1e-4, f"{apart} at {one.time} s")
        else:
            check(one.samples.tobytes() == other.samples.tobytes(), f"other bits at {one.time} s")

    # A ping without a time leaves when it is heard, not when a schedule that nobody follows has it.
    with Client.start("sea.toml", "--output-dir", "saves", program=ASDIC) as client:
        client.listen(block=1.0, seconds=1.0)
        client.ping(time=1.0)
        list(client.blocks())
        client.listen(block=1.0, seconds=4.0)
        list(client.blocks())
        file = client.save()
        check((file["ping"], file["time"]) == (2, 5.0), file)
        mine = client.ping().answer
    with Client.start(file["file"], program=ASDIC) as client:
        client.ping()
        again = client.ping().answer
    for one, other in zip(mine["targets"], again["targets"]):
        check((mine["ping"], mine["time"]) == (again["ping"], again["time"]) == (2, 5.0) and
              all(one[key] == other[key] for key in ("echo_time", "echo_level_db")), f"{mine}, {again}")
    print("saved: the same pings, and the same sound")


def main():
    with tempfile.TemporaryDirectory(prefix="asdic_replay_") as folder:
        os.chdir(folder)
        Path("sea.toml").write_text(SEA)
        by_the_clock()
        at_once()
        killed()
        refused()
        saved()
        os.chdir("/")
    print("replayed: all as it was heard")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""`listen` of `asdic serve`, as a vehicle's software meets it: by the clock, for hours, by a client that is killed.

Truth: what comes by the clock has the bits of what comes as fast as it can with the same times; blocks follow each
other without a gap; memory stays what it is after the first pings.

    ASDIC=build/ci/bin/asdic listening.py [SECONDS]      of the long run; default 60, ASDIC_DEEP=1: 86400
"""
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "tests/support")]
from asdic_client import Client, Refused  # noqa: E402
from checks import check  # noqa: E402
from deep import DEEP  # noqa: E402
from served import ASDIC, resident, sea, server  # noqa: E402

SMALL = sea('title = "two pings overlap"\nseed = 5', pings="""interval = 2.0
recording_duration = 5.0
samples = "baseband"
baseband_rate = 200.0""")


def joined(blocks):
    times = [block.time for block in blocks]
    ends = [block.time + block.samples.shape[1] / 200.0 for block in blocks]
    check(np.allclose(times[1:], ends[:-1], atol=1e-9), "blocks follow each other")
    return np.concatenate([block.samples for block in blocks], axis=1)


def commands(client, begin):
    """What happens, each at its own time."""
    client.ping(time=begin)
    client.ping(time=begin + 1.5)
    client.update(time=begin + 2.0, platform={"heading_deg": 90, "speed": 3})
    client.update(time=begin + 2.75, array={"heading_deg": 45}, wind_speed=3)
    client.ping(time=begin + 3.5)
    client.update(time=begin + 4.5, targets={"strength_db": 20})


def by_the_clock(scenario):
    with Client.start(scenario, "--pace", "4", program=ASDIC) as client:
        begin = np.ceil(4.0 * client.listen(block=0.125, seconds=20.0)["time"]) / 4.0 + 12.0
        commands(client, begin)
        blocks = list(client.blocks())
        sound = joined(blocks)
        state = client.state()
    with Client.start(scenario, program=ASDIC) as client:
        client.listen(seconds=blocks[0].time + 1e-9) if blocks[0].time > 0 else None
        before = list(client.blocks()) if blocks[0].time > 0 else []
        client.listen(block=0.02, seconds=1e-6)
        list(client.blocks())
        commands(client, begin)
        client.listen(block=1.0, seconds=20.0)
        fast = joined(list(client.blocks()))
        skipped = sum(block.samples.shape[1] for block in before)
        check(skipped == round(blocks[0].time * 200.0), "the same first sample")
    check(np.array_equal(sound, fast), "by the clock and at once: the same bits")
    check(state["time"] >= 20.0, f"the clock goes on: {state['time']}")
    print(f"by the clock: {len(blocks)} blocks, {1e3 * max(block.behind for block in blocks):.0f} ms behind at most")


def commands_without_a_time(scenario):
    """What comes now acts from now on; nothing that was handed out changes."""
    with Client.start(scenario, "--pace", "2", program=ASDIC) as client:
        client.listen(block=0.05)
        heard, sent = [], None
        for block in client.blocks():
            heard.append(block)
            if len(heard) == 10:
                sent = client.ping().answer["time"]
                check(sent >= block.time, "a ping leaves after what is heard")
            if len(heard) == 30:
                try:
                    client.ping(time=0.1)
                    check(False, "a ping before what is heard")
                except Refused as refused:
                    check(refused.code == "value" and "was handed out" in str(refused), str(refused))
                client.listen(stop=True)
        sound = joined(heard)
        first = round((sent - heard[0].time) * 200.0)
        loud = np.abs(sound).max(axis=0)
        check(loud[:max(first - 12, 1)].max() < 0.1 * loud[first:first + 80].max(), "silence before the ping")
    print(f"now: a ping at {sent:.3f} s")


def for_long(scenario, seconds):
    """A continuous sonar under way that turns every ten seconds."""
    with Client.start(scenario, program=ASDIC) as client:
        after, heard, begun = None, 0.0, time.monotonic()
        while heard < seconds:
            client.listen(block=1.0, seconds=10.0, schedule=True)
            for _ in client.blocks():
                pass
            heard += 10.0
            client.update(platform={"heading_deg": heard % 360.0, "speed": 2.0}, array={"heading_deg": heard % 180.0})
            if after is None and heard >= min(60.0, seconds / 2.0):
                after = resident(client.process)
        grown = resident(client.process) - after
        check(grown < 8192 + 0.1 * after, f"{grown} kB more after {heard} s")
        check(len(client.scheduled) >= min(1000, int(seconds / 2.0)), "pings of the schedule are told")
        print(f"{heard:.0f} s, {heard / (time.monotonic() - begun):.0f} times as fast as the clock: {after} kB after a "
              f"minute, {grown} kB more at the end")


def turns():
    """A sea that is received as streams of noise does not change because an array turns in it: a little turn
    changes the sound by little, 20 dB less for a tenth of it.
    """
    def heard(heading):
        with Client.start(ROOT / "scenarios" / "deep_ocean.toml", "--set", "platform.velocity=[0.0, 2.5, 0.0]",
                          "--set", "noise.spectral_level_db=-60", "--set", "target.0.strength_db=-50", "--set",
                          "pings={samples='baseband', recording_duration=16.0}", program=ASDIC) as client:
            client.listen(block=1.0, seconds=12.0)
            before = list(client.blocks())
            client.ping(time=12.0)
            client.listen(block=1.0, seconds=10.0)
            before += list(client.blocks())
            if heading:
                client.update(array={"heading_deg": heading})
            client.listen(block=1.0, seconds=5.0)
            return [np.concatenate([block.samples for block in part], axis=1)
                    for part in (before, list(client.blocks()))]
    before, straight = heard(0.0)
    levels = []
    for heading in (0.1, 1.0):
        same, turned = heard(heading)
        check(np.array_equal(before, same), "nothing before the turn")
        levels.append(20.0 * np.log10(np.linalg.norm(turned - straight) / np.linalg.norm(straight)))
    check(levels[0] < -30.0 and levels[1] < -10.0, f"a turn changes {levels} dB")
    print(f"turns of 0.1 and 1 degree change the sound by {levels[0]:.0f} and {levels[1]:.0f} dB of itself")


def killed(scenario, folder):
    """Whoever is killed, what was delivered is whole."""
    socket = folder / "s.sock"
    with Client.start(scenario, program=ASDIC) as reference:
        reference.listen(block=0.25, seconds=0.5, schedule=True)
        list(reference.blocks())
        reference.listen(block=0.25, seconds=30.0, schedule=True)
        truth = [block.samples for block in reference.blocks()]
    with Client.start(scenario, program=ASDIC) as client:
        client.listen(block=0.25, seconds=0.5, schedule=True)
        list(client.blocks())
        client.send("listen", block=0.25, seconds=1e6, schedule=True)
        client.receive()
        taken = []
        try:
            for block in client.blocks():
                taken.append(block.samples)
                if len(taken) == 20:
                    client.process.kill()
        except ConnectionError:
            pass
    check(len(taken) >= 20, "blocks before the end")
    for mine, right in zip(taken, truth):
        check(np.array_equal(mine, right), "what was delivered is whole")
    check(not socket.exists(), "no socket is left")
    print(f"killed: {len(taken)} blocks were whole")


def slow_readers(folder):
    """What listeners do not take is bounded, of each and of all; whoever reads is served, and who reads again has
    missed nothing. By the clock it is told how late it comes.
    """
    scenario, socket = folder / "many.toml", folder / "many.sock"
    scenario.write_text(sea(array='kind = "horizontal"\nphones = 64\nspacing = 0.75', target="",
                            pings='samples = "baseband"\nbaseband_rate = 1000.0\nrecording_duration = 1.0',
                            more="[reverberation]\nenabled = false"))
    limits = ("--limit", "answer_bytes=4000000", "--limit", "total_answer_bytes=8000000")
    with server("--socket", str(socket), *limits, scenario=scenario) as (process, _):
        deaf = [Client.unix(socket) for _ in range(4)]
        for client in deaf:
            client.listen(block=0.1, seconds=0.1)
            list(client.blocks())
        before = resident(process)
        for client in deaf:
            client.listen(block=0.1, seconds=300.0)  # 150 MB each
        with Client.unix(socket) as other:
            other.listen(block=0.1, seconds=10.1)
            truth = np.concatenate([block.samples for block in other.blocks()], axis=1)
        time.sleep(0.5)
        grown = resident(process) - before
        check(grown < 8000 + 40000, f"{grown} kB more for 8 MB of answers; 600 MB are asked for")
        heard = [block for _, block in zip(range(200), deaf[0].blocks())]  # 10 MB: more than waited
        check(np.array_equal(truth[:, 100:], np.concatenate([b.samples for b in heard[:100]], axis=1)), "the same bits")
        check([b.number for b in heard] == list(range(1, 201)), "no block is missing")
        for client in deaf:
            client.close()
    with Client.start(scenario, "--pace", "20", *limits, program=ASDIC) as client:
        client.listen(block=0.1)
        time.sleep(1.5)  # 15 MB
        heard = []
        for block in client.blocks():
            heard.append(block)
            if len(heard) == 400:
                break
    check([b.number for b in heard] == list(range(400)), "no block is missing")
    late = max(b.behind for b in heard)
    check(late > 0.5, f"{late} s late at most, though nobody read for 1.5 s")
    print(f"slow readers: {grown} kB more with four that do not read; by the clock {late:.1f} s late, and told")


def main():
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else (86400.0 if DEEP else 60.0)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        scenario = folder / "small.toml"
        scenario.write_text(SMALL)
        by_the_clock(scenario)
        commands_without_a_time(scenario)
        for_long(scenario, seconds)
        killed(scenario, folder)
        slow_readers(folder)
    turns()
    print("listened to: all as it should be")


main()

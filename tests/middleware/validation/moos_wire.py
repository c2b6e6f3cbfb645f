#!/usr/bin/env python3
"""MOOS's wire, mission files and values: what asdic-moos reads before it does anything.

Truth: a recorded session of MOOSDB with its own client (tests/data/moos), a second description of
the packets (tests/support/moosdb.py). Whatever bytes or texts come, they are taken or refused in
one line.
"""
import math
import random
import sys
import tempfile
import threading
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "tests/support")]
import moosdb as small  # noqa: E402
from asdic_middleware import mission, packets, quantities  # noqa: E402
from asdic_middleware.due import Due  # noqa: E402
from asdic_middleware.moos_app import App  # noqa: E402
from asdic_middleware.packets import Malformed  # noqa: E402
from asdic_middleware.quantities import Wrong  # noqa: E402
from asdic_middleware.steady import Steady  # noqa: E402
from checks import check  # noqa: E402
from deep import DEEP  # noqa: E402

SESSION = [line.split() for line in (ROOT / "tests/data/moos/session.txt").read_text().splitlines()
           if not line.startswith("#")]


def recorded(way):
    return [bytes.fromhex(data) for to, data in SESSION if to == way]


def test_session():
    """What the recorder took is read whole, and written again it is the same bytes."""
    first, *_ = recorded(">")
    check(first[:32] == packets.GREETING, "the greeting")
    hello = packets.unpacked(first[32:])
    check(packets.packed([packets.hello("alpha", hello[0].time)]) == first[32:], "the handshake")
    kinds = set()
    for data in [*recorded(">"), *recorded("<")]:
        data = data.removeprefix(packets.GREETING)
        found = packets.unpacked(data)
        check(packets.packed(found) == data, "written as it was read")
        theirs = small.messages(data)
        for one, other in zip(found, theirs, strict=True):
            for a, b in (("type", "kind"), ("key", "key"), ("data", "data"), ("value", "value"),
                         ("text", "bytes"), ("source", "source"), ("community", "community"),
                         ("time", "time"), ("id", "id")):
                check(getattr(one, a) == other[b], f"both descriptions of {a}")
        kinds |= {(one.type, one.data) for one in found}
    check({("i", "S"), ("W", "D"), ("K", "S"), ("R", "D"), ("*", "S"), ("T", "D"), ("N", "D"),
           ("N", "B")} <= kinds, f"every kind of message, {kinds}")


def test_ours_as_theirs():
    """Registrations, numbers and bytes as the database's own client sends them, bit for bit."""
    for data in recorded(">")[1:]:
        for one in packets.unpacked(data):
            if one.type == "R":
                ours = packets.register(one.key)
            elif one.type == "N" and one.data in "DB":
                ours = packets.notify(one.key, one.value if one.data == "D" else one.text, one.time)
            elif one.type == "T":
                ours = packets.timing(one.time)
            else:
                continue
            ours.source, ours.id, ours.time = one.source, one.id, one.time
            check(packets.packed([ours]) == packets.packed([one]), f"{one.type} {one.key}")


def test_hostile_packets():
    """100 000 packets (a million in the full form) that are none, or nearly: each is read or
    refused, none hurts, in seconds.
    """
    count = 1_000_000 if DEEP else 100_000
    rng = random.Random(20130601)
    seeds = [data.removeprefix(packets.GREETING) for data in [*recorded(">"), *recorded("<")]]
    begun = time.process_time()
    taken = refused = 0
    edges = [b"\xff\xff\xff\xff", b"\x00\x00\x00\x00", b"\xff\xff\xff\x7f", b"\x00\x00\x00\x80",
             b"\x01\x00\x00\x00"]
    for _ in range(count):
        data = bytearray(rng.choice(seeds))
        for _ in range(rng.randrange(1, 4)):
            at = rng.randrange(len(data))
            how = rng.randrange(4)
            if how == 0:
                data[at] = rng.randrange(256)
            elif how == 1:
                data[at:at + 4] = rng.choice(edges)
            elif how == 2:
                del data[at:at + rng.randrange(1, 9)]
            else:
                data[at:at] = rng.randbytes(rng.randrange(1, 9))
            if not data:
                data = bytearray(b"\0")
        if rng.randrange(2):
            data[:4] = len(data).to_bytes(4, "little")  # a whole packet, wrong inside
        try:
            packets.unpacked(bytes(data))
            taken += 1
        except Malformed as error:
            refused += 1
            check(len(str(error)) < 100, "a short reason")
    took = time.process_time() - begun
    check(refused > count / 2 and taken > count / 1000,
     f"some of each: {taken} taken, {refused} refused")
    check(took < count / 5000, f"within seconds: {took}")
    for length in (-1, 0, 8, (64 << 20) + 1, 0x7FFFFFFF):  # before any of it is read
        try:
            packets.length_of(length.to_bytes(4, "little", signed=True) + bytes(5))
            raise AssertionError(f"a packet of {length} bytes was begun")
        except Malformed:
            pass


def refused(function, *words):
    """→ the message of a refusal"""
    try:
        function(*words)
    except (Wrong, mission.MissionError) as wrong:
        return str(wrong)
    raise AssertionError(f"{words} was taken")


def ping(text):
    return quantities.ping_of(quantities.pairs_of(text, "C"), "C")


def test_commands():
    check(ping("") == {}, "a ping as the scenario has it")
    check(ping("type=cw, centre_frequency=4000, duration=1, window=hann, level=230, elevation=-5,"
               "beamwidth=6") ==
          {"source_level_db": 230.0, "elevation_deg": -5.0, "beamwidth_deg": 6.0,
           "waveform": {"kind": "cw", "frequency": 4000.0, "duration": 1.0, "window": "hann"}},
          "a tone")
    up = ping("type=LFM,centre=4000,min_frequency=3900,max_frequency=4100,duration=2")["waveform"]
    check(up == {"kind": "lfm", "start_frequency": 3900.0, "end_frequency": 4100.0, "duration": 2.0},
          "a sweep")
    down = ping("type=lfm,min_frequency=3900,max_frequency=4100,sweep=down")["waveform"]
    check((down["start_frequency"], down["end_frequency"]) == (4100.0, 3900.0), "a sweep down")
    other = ping("type=costas,centre_frequency=4000,waveform.chips=10,waveform.chip_seconds=0.1,"
                 "waveform.order=welch")["waveform"]
    check(other == {"kind": "costas", "frequency": 4000.0, "chips": 10, "chip_seconds": 0.1,
                    "order": "welch"}, "a pulse of another kind, by the keys of the scenario")
    for text, said in (
            ("elevation=100", "C: elevation: found \"100\", expected a number from -90 to 90 degrees"),
            ("elevation=nan", "a number from -90"), ("elevation=1_0", "a number from -90"),
            ("elevation=1,elevation=2", "C: elevation: found it twice"), ("loud", "KEY=VALUE"),
            ("colour=red", "one of type, centre_frequency"), ("duration=1", "C: type: found nothing"),
            ("type=lfm,min_frequency=1", "C: max_frequency: found nothing"),
            ("type=lfm,min_frequency=2,max_frequency=1", "less than max_frequency"),
            ("type=lfm,centre=9,min_frequency=1,max_frequency=2", "1 to 2 Hz"),
            ("type=cw,duration=1", "the tone's frequency"), ("level=1e999", "dB re 1 uPa"),
            ("type=cw,waveform.a b=1,centre=1", "waveform.KEY"), ("x=" + "9" * (1 << 20), "characters")):
        check(said in refused(ping, text), f"{text[:60]}: {refused(ping, text)}")


def test_targets_and_phones():
    def target(text):
        return quantities.target_of(quantities.keyed(quantities.pairs_of(text, "T"),
                                                     quantities.TARGET, "T"), "T")

    check(target("NAME=rock,X=1,Y=2,depth=3,speed=4,heading=5,strength=6") ==
          {"name": "rock", "x": 1.0, "y": 2.0, "depth": 3.0, "speed": 4.0, "heading_deg": 5.0,
           "strength_db": 6.0}, "a target")
    for text, said in (("x=1,y=2,depth=3", "no name"), ("name=r,x=1", "T: y: found nothing"),
                       ("name=r,x=inf,y=0", "a number from"), ("name=,x=1", "a name of 1 to"),
                       ("name=r,depth=-1,x=1,y=1", "0 to 12000 m"), ("name=r,speed=3", "beside speed")):
        check(said in refused(target, text), f"{text}: {refused(target, text)}")
    places = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]
    for text in ("1,2,3;4,5,6", "1,2,3:4,5,6", "[[1,2,3],[4,5,6]]"):
        check(quantities.positions_of(text, "P") == places, text)
    for text, said in (("1,2", "x, y and depth"), ("", "1 to 4096"), ("[1]", "x, y and depth"),
                       ("[[1,2,NaN]]", "phone 0"), ("[" * 50, "16 levels"), ("[[1,2,3]", "JSON"),
                       ('[{"a":1,"b":2,"c":3}]', "x, y and depth")):
        check(said in refused(quantities.positions_of, text, "P"), text)


def test_requests():
    asked = quantities.paths_of('{"id": 7, "range": 2e4, "receiver_depth": 100, "frequency": 4000, '
                                '"sound_speed": {"depth": [0, 100], "speed": [1500, 1510]}}', "B")
    check(asked["output"] == "arrivals" and asked["range"] == 2e4 and asked["id"] == 7, "a request")
    check(quantities.paths_of('{"output": "ray", "count": 5}', "B")["output"] == "rays", "of rays")
    for text, said in (('{"range": 1}', "B: receiver_depth"), ("[]", "a JSON object"),
                       ('{"output": ".shd"}',
                        "arrivals or rays"), ('{"id": [1]}', "a short string"),
                       ('{"range": 1e999, "receiver_depth": 1}', "a number from"),
                       ('{"range": "--force", "receiver_depth": 1}', "a number from"),
                       ('{"sound_speed": {"depth": [1, 0], "speed": [1500, 1500]}}', "increasing"),
                       ('{"a": 1}', "one of frequency")):
        check(said in refused(quantities.paths_of, text, "B"), f"{text}: {said}")


def test_hostile_values():
    """Whatever a text holds, it is taken or refused, in one line that does not repeat all of it."""
    rng = random.Random(7)
    words = ["name", "x", "y", "=", ",", ";", ":", "nan", "-1e308", "1e999", "[", "]", "{", "}", '"', "\0",
             "type", "lfm", "elevation", "\u202e", "é", "\ud800", "A" * 300, " ", "waveform.", "0x10",
             "range", "receiver_depth", "null", "true", "[[1,2,3]]"]
    readers = (ping, lambda t: quantities.positions_of(t, "P"), lambda t: quantities.paths_of(t, "B"),
               lambda t: quantities.target_of(quantities.keyed(quantities.pairs_of(t, "T"),
                                                               quantities.TARGET, "T"), "T"))
    for _ in range(20_000):
        text = "".join(rng.choices(words, k=rng.randrange(12)))
        try:
            rng.choice(readers)(text)
        except Wrong as wrong:
            check(len(str(wrong)) < 600 and "\n" not in str(wrong), str(wrong))
            check(str(wrong).isprintable(), repr(str(wrong)))
    for value in (math.inf, math.nan, "", None, [], True, "1e5000", 10**400):
        check("expected" in refused(quantities.PLATFORM[0].of, value, "NAV_X"), repr(value))


def test_missions():
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.moos"

        def app(text, head="ServerPort = 9000"):
            path.write_text(f"{head}\nProcessConfig = pOther\n{{\nany thing\n  a = b = c\n}}\n"
                            f"ProcessConfig = asdic-moos\n{{\n{text}\n}}\n")
            return App(path)

        made = app("scenario = x.toml // here\n Nav_X = NODE_X\nAppTick = 4\nPace = fast\n"
                   "Arguments = --set 'pings={samples=\"baseband\"}'", "MOOSTimeWarp = 10")
        check(made.names["NAV_X"] == "NODE_X" and made.clock.warp == 10, "names are in any case")
        check(made.settings.arguments == ["--set", 'pings={samples="baseband"}'],
              "words as in a shell")
        check("NODE_X" in made.db.variables and "NAV_X" not in made.db.variables, "registered by that")
        check("NODE_X (NAV_X)" in made.told(), made.told())
        for text, said in (
                ("", "found nothing, expected a scenario"), ("Scenario = a\nScenario = b", "twice"),
                ("Scenario = a\nColour = red", "a.moos:10: Colour"), ("Scenario a", "NAME = VALUE"),
                ("Scenario = a\nBlock = 0", "a.moos:10: Block: found \"0\", expected a number from 0.001"),
                ("Scenario = a\nFilesKept = 1.5", "a whole number"),
                ("Scenario = a\nReceiver = maybe", "true or false"),
                ("Scenario = a\nArguments = '", "words as in a shell"),
                ("Scenario = a\nPace = slow", "one of clock, fast"),
                ("Scenario = a\nNAV_X = a b", "the name of a variable"),
                ("Scenario = a\nNAV_X = NAV_Y", "a name for each"),
                ("Scenario = a\nTrackHits = 5", "at most TrackOf")):
            check(said in refused(app, text), f"{text!r}: {refused(app, text)}")
        check("ServerPort" in refused(app, "Scenario = a", "ServerPort = 70000"), "a port")
        for text, said in (("ProcessConfig = asdic-moos\n{\nScenario = a", "no } of the last block"),
                           ("{", "expected ProcessConfig"), ("}", "no end of a block"),
                           ("a = b", "expected ProcessConfig = asdic-moos")):
            path.write_text(text)
            check(said in refused(App, path), text)


def test_set_clock():
    """The machine's clock is set back by 600 s, then ahead by 1200 s, while a result waits for its
    time. It comes when it is due, because the time of results follows a clock that nobody sets. The
    step is reported once. A message counts by its age on the clock that stamped it.
    """
    for warp in (1.0, 20.0):
        wall = [0.0]  # step of the clock [s]
        clock = Steady(lambda: warp * (time.monotonic() + wall[0]), warp)
        clock.begin()
        came, errors = [], []
        due = Due(clock, warp, lambda kind, what: came.append((what["due"], clock())), errors.append)
        letting_go = threading.Thread(target=due.let_go)
        letting_go.start()
        for step in (-600.0, 1200.0):
            at = clock() + 0.3 * warp
            due.hold(at, "ping", {"due": at})
            check(clock.stepped() == 0.0, "not yet")
            wall[0] += step
            check(abs(clock.stepped() - warp * wall[0]) < 1.0, "in all")
            check(clock.stepped() == 0.0, "once")
            stamp = warp * (time.monotonic() + wall[0]) - 0.5 * warp
            check(abs(clock.of(stamp) - (clock() - 0.5 * warp)) < 0.1 * warp, "half a second ago")
            check(abs(clock.of(stamp - warp * step) - clock()) < 0.1 * warp, "of a clock that was set: now")
            patience = time.monotonic() + 30
            while not came and time.monotonic() < patience:
                time.sleep(0.01)
            check(len(came) == 1, "it comes")
            what, when = came.pop()
            check(0 <= when - what, "not before its time")
        due.stop()
        letting_go.join()
        check(not errors, f"{errors}")
    paused = Steady(lambda: 5.0, 1.0, followed=True)  # clock of a simulation
    paused.begin()
    time.sleep(0.01)
    check(paused() == 5.0 and paused.stepped() == 0.0, "it stands")


def main():
    for name, test in list(globals().items()):
        if name.startswith("test_"):
            test()
            print(f"{name} ok")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""`asdic serve` as its clients meet it: by standard input, a Unix socket and TCP.

Truth: samples are bit for bit those of `asdic ping`; every command is answered once; memory does
not grow with the number of pings.

    ASDIC=build/ci/bin/asdic serve.py [PINGS]        default 150; scripts/deep_check.sh takes 10000
"""
import contextlib
import io
import json
import os
import re
import signal
import socket
import stat
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "tests/support")]
from asdic_client import Client, Refused  # noqa: E402
from checks import check  # noqa: E402
from served import ASDIC, refused, resident, sea, server  # noqa: E402

SCENARIO = sea("""title = "SECRET"
seed = 5""", """[reverberation]
azimuths = 8
[propagation]
max_surface_bounces = 1
max_bottom_bounces = 1""", transmitter="""source_level_db = 200.0
elevations_deg = [0.0, 3.0]
beamwidth_deg = 20.0""", target="""name = "rock"
position = [3000.0, 0.0, 500.0]
velocity = [-3.0, 1.0, 0.0]
strength_db = 10.0""")


def reference():
    """Samples of `asdic ping` → [3 × channels × samples] complex"""
    subprocess.run([ASDIC, "ping", "sea.toml", "-q", "-o", "reference.h5"], check=True)
    with h5py.File("reference.h5") as file:
        return file["pressure"][...].view("<c8")[..., 0]


def raw(end, data):
    """Everything that is answered to some bytes."""
    end.settimeout(30)
    with contextlib.suppress(BrokenPipeError, ConnectionResetError):  # closed before all was sent
        end.sendall(data)
        end.shutdown(socket.SHUT_WR)
    said = b""
    with contextlib.suppress(ConnectionResetError):
        while piece := end.recv(65536):
            said += piece
    end.close()
    return said.decode()


def dialled(address):
    end = socket.socket(socket.AF_UNIX if isinstance(address, str) else socket.AF_INET)
    end.connect(address)
    return end


def patiently():
    """A client, as soon as others that have gone make room."""
    for _ in range(100):
        with contextlib.suppress(Refused):
            return Client.unix("sonar.sock")
        time.sleep(0.1)
    raise AssertionError("clients that are gone still count")


def same_bits(client, pings):
    for number, samples in enumerate(pings, 1):
        ping = client.ping(deliver="samples")
        check(ping.answer["ping"] == number, ping.answer)
        check(ping.samples.tobytes() == samples.tobytes(), f"ping {number} has other bits")


def by_standard_streams(pings):
    os.mkdir("pings")
    with Client.start("sea.toml", "--output-dir", "pings", program=ASDIC) as client:
        same_bits(client, pings)
        with_pulse = client.ping(deliver="samples", replica=True)
        answer = client.ping(time=0.0, elevation_deg=2.0).answer
        with h5py.File(answer["file"]) as file:
            pulse = file["replica"][()].astype("<f4")
            check(with_pulse.replica.tobytes() == pulse.tobytes(), "another replica")
            check(with_pulse.samples.shape == pings[0].shape, with_pulse.answer["samples"])
            check(list(file["ping"]) == [5] and file["ping_time"][0] == 0.0, answer)
            check(file[answer["dataset"]].shape[1:] == tuple(answer["samples"]["shape"]), answer)
            check(file.attrs["complete"] == 1, "not complete")
        check(client.quit()["pings"] == 5, "five pings")
        check(client.process.returncode == 0, "exit status")

    # A file of commands: all of them are carried out, also a last one without the end of its line.
    lines = ['{"asdic": 1, "when_full": "wait"}'] + [
        json.dumps({"id": i, "command": "ping"}) for i in range(30)]
    Path("commands.jsonl").write_text("\n".join(lines))
    with open("commands.jsonl") as commands:
        done = subprocess.run([ASDIC, "serve", "sea.toml"], stdin=commands, capture_output=True,
                              text=True, check=True)
    answers = [json.loads(line) for line in done.stdout.splitlines()]
    check([a.get("id") for a in answers[1:]] == list(range(30)), "every command, in order")
    check(all(a["ok"] for a in answers), "all done")

    for first in ("GET / HTTP/1.1", '{"command": "quit"}', "", "x" * 100000):
        done = subprocess.run([ASDIC, "serve", "sea.toml"], input=f"{first}\n" + lines[1],
                              capture_output=True, text=True)
        check(done.returncode == 2 and done.stdout.count("\n") == 1, done)
        check(done.stderr == 'asdic: standard input: first line: found another, expected {"asdic": 1},'
              ' the handshake (docs/formats/serve.md)\n', done)
        check(json.loads(done.stdout)["error"]["code"] == "handshake", done.stdout)
        check(len(done.stdout) < 200, "the input is not quoted")


def by_unix_socket(pings):
    with server("--socket", "sonar.sock") as (process, _):
        mode = os.stat("sonar.sock").st_mode
        check(stat.S_ISSOCK(mode) and stat.S_IMODE(mode) == 0o600, oct(mode))
        with Client.unix("sonar.sock") as one, Client.unix("sonar.sock") as two:
            two.update(seed=99)  # sessions know nothing of one another
            same_bits(one, pings)
            refused("value", lambda: one.update(platform={"position": [1, 2]}))
            refused("scenario", lambda: one.update(platform={"position": [0, 0, 5000]}))
            refused("file", lambda: one.update(sound_speed={"file": "sea.toml"}))

        # More commands than may wait: the rest is told so at once, and each has its answer.
        with Client.unix("sonar.sock") as client:
            sent = [client.send("ping") for _ in range(60)]
            answers = [client.receive()[0] for _ in sent]
            check(sorted(a["id"] for a in answers) == sent, "every command is answered once")
            done = [a["ping"] for a in answers if a["ok"]]
            check(done == list(range(1, len(done) + 1)), "pings in order")
            codes = {a["error"]["code"] for a in answers if not a["ok"]}
            check(codes == {"busy"}, f"{len(done)} of 60 done, refusals {codes}")
        with Client.unix("sonar.sock", when_full="wait") as client:
            sent = [client.send("ping") for _ in range(60)]
            check([client.receive()[0]["ping"] for _ in sent] == list(range(1, 61)), "all, in order")

        # Lines that are none, pieces of lines, bytes that are no text: refused, and it goes on.
        hello = b'{"asdic": 1}\n'
        said = raw(dialled("sonar.sock"), hello + b'{"id": 1, "command": "st\xff"}\n' + b"[" * 5000 +
                   b'\n{"id": 2, "command": "ping", "time": 1e999}\n\n{"id": 3, "comm')
        codes = [json.loads(line).get("error", {}).get("code") for line in said.splitlines()]
        check(codes == [None, "json", "limit", "json", "json", "json"], said)
        end = dialled("sonar.sock")
        for byte in hello + b'{"id": 1, "command": "state"}\n':
            end.send(bytes([byte]))
        check(json.loads(raw(end, b"").splitlines()[1])["id"] == 1, "byte by byte")
        long = raw(dialled("sonar.sock"), hello + b"x" * 3_000_000 + b'\n{"command": "quit"}\n')
        check([json.loads(line)["ok"] for line in long.splitlines()] == [True, False, True], long)

        # More clients than may be.
        clients = [patiently() for _ in range(8)]  # those before are counted until they are seen to go
        refused("limit", lambda: Client.unix("sonar.sock"))
        for client in clients:
            client.close()

        # A client that is gone in the middle of it leaves the others alone.
        gone = patiently()
        for _ in range(4):
            gone.send("ping", deliver="samples")
        gone.close()
        with patiently() as client:
            same_bits(client, pings)

        second = subprocess.run([ASDIC, "serve", "sea.toml", "--socket", "sonar.sock"],
                                capture_output=True, text=True)
        check(second.returncode == 2 and "a server that listens there" in second.stderr, second)
        check(process.poll() is None, "the first goes on")
    check(not os.path.exists("sonar.sock"), "the socket goes with its server")

    Path("precious").write_text("kept")
    wrong = subprocess.run([ASDIC, "serve", "sea.toml", "--socket", "precious"],
                           capture_output=True, text=True)
    check(wrong.returncode == 2 and Path("precious").read_text() == "kept", wrong)


def by_tcp(pings):
    with server("--tcp", "0") as (_, said):
        port = int(re.search(r"127\.0\.0\.1:(\d+)", said).group(1))
        token = re.search(r"token ([0-9a-f]{64})", said).group(1)
        for wrong in ("", "SECRET", token[:-1], token + "0", "0" * 64):
            refused("token", lambda: Client.tcp(port, wrong))
        refused("token", lambda: Client.tcp(port, None))
        said = raw(dialled(("127.0.0.1", port)), b"POST / HTTP/1.1\r\nHost: localhost\r\n\r\n")
        check(json.loads(said)["error"]["code"] == "handshake" and "HTTP" not in said, said)
        silent = [dialled(("127.0.0.1", port)) for _ in range(50)]  # they keep nobody out
        with Client.tcp(port, token) as client:
            same_bits(client, pings)
        for one in silent:
            one.close()
        with contextlib.suppress(OSError):  # loopback alone
            other = socket.gethostbyname(socket.gethostname())
            if not other.startswith("127."):
                dialled((other, port))
                raise AssertionError(f"listens on {other}")

    Path("token").write_text("a token of one's own\n")
    os.chmod("token", 0o600)
    with server("--tcp", "0", "--token-file", "token") as (_, said):
        port = int(re.search(r"127\.0\.0\.1:(\d+)", said).group(1))
        check("token" not in said, "a token that is known is not printed")
        Client.tcp(port, "a token of one's own").quit()
    with server("--tcp", "0", "--socket", "s", listens=2,
                ASDIC_TOKEN="0123456789abcdef") as (_, said):
        Client.tcp(int(re.search(r"127\.0\.0\.1:(\d+)", said).group(1)), "0123456789abcdef").quit()
        Client.unix("s").quit()


def in_time():
    """By the clock: pings at their times, data long before the echo."""
    with Client.start("sea.toml", "--pace", "10", program=ASDIC) as client:
        begin = time.monotonic()
        answer = client.ping(time=20.0).answer
        took = time.monotonic() - begin
        check(1.9 < took < 30, f"a ping 20 s ahead took {took} s at ten times the pace")
        check(answer["time"] == 20.0, answer)
        now = client.ping().answer["time"]
        check(20.0 <= now, now)
        check(client.ping(time=1.0).answer["behind"] > 1.0, "its time was over")
    check(answer["first_echo"] > 3.0, "the rock is 3 km away")


def ends():
    """Ctrl-C finishes the ping in hand; those that wait are told."""
    with server("--socket", "sonar.sock") as (process, _):
        client = Client.unix("sonar.sock")
        sent = [client.send("ping") for _ in range(6)]
        first, _ = client.receive()
        process.send_signal(signal.SIGINT)
        answers = [first] + [client.receive()[0] for _ in sent[1:]]
        check([a["id"] for a in answers] == sent, "every command is answered")
        check({a["error"]["code"] for a in answers if not a["ok"]} <= {"closing"}, answers)
        process.wait(timeout=30)
        check(process.returncode == 0, process.returncode)
        client.close()
    with server("--socket", "sonar.sock", "--limit", "idle_seconds=1", "--limit",
                "handshake_seconds=1") as (_, _):
        silent = dialled("sonar.sock")
        check(json.loads(silent.makefile().readline())["error"]["code"] == "handshake", "no word")
        client = Client.unix("sonar.sock")
        check(client.receive()[0]["error"]["code"] == "idle", "silent after that")
        # A reader that does not read is not waited for, and holds up nobody else.
        deaf = Client.unix("sonar.sock", when_full="wait")
        stop = threading.Event()

        def shout():
            with contextlib.suppress(OSError):
                while not stop.is_set():
                    deaf.send("ping", deliver="samples")

        thread = threading.Thread(target=shout)
        thread.start()
        with Client.unix("sonar.sock") as other:
            for _ in range(5):
                other.ping()
        stop.set()
        deaf._close[0].shutdown(socket.SHUT_RDWR)
        thread.join()


HEAVY = ["--set", "reverberation.azimuths=3600", "--set", 'reverberation.synthesis="scatterers"',
         "--set", "propagation.max_surface_bounces=6", "--set", "propagation.max_bottom_bounces=6",
         "--set", "array.phones=64"]  # a ping takes minutes


def good_manners():
    """Calling off, by a command, by going and by the clock; turns."""
    with server("--socket", "sonar.sock", "--tcp", "0", *HEAVY, listens=2,
                ASDIC_TOKEN="0123456789abcdef") as (_, said):
        port = int(re.search(r"127\.0\.0\.1:(\d+)", said).group(1))
        ways = {"Unix": lambda: Client.unix("sonar.sock"),
                "TCP": lambda: Client.tcp(port, "0123456789abcdef")}
        light = {"time": 0.0, "noise": {"spectral_level_db": 41}}
        took = {}
        for name, join in ways.items():
            gone = join()  # killed in the middle of a ping: the next one is served at once
            gone.send("ping")
            time.sleep(0.3)
            other = join()
            begin = time.monotonic()
            gone._close[0].close()
            gone.close()
            other.update(**light)
            took[name] = time.monotonic() - begin
            check(took[name] < 10, f"a client that is gone holds up others for {took[name]} s")

            # One that has ended its half waits for its answers, and is served.
            half = join()
            half.send("ping")
            half.send("update", **light)
            half._close[0].shutdown(socket.SHUT_WR)
            time.sleep(0.7)
            begin = time.monotonic()
            other.send("update", **light)
            check(other._close[0] is not None, "it waits")
            half._close[0].settimeout(0.5)
            with contextlib.suppress(TimeoutError):
                check(not half._reader.readline(), "a heavy ping is done too soon")
                raise AssertionError("one that has ended its half is not served any more")
            half._close[0].close()
            half.close()
            check(other.receive()[0]["ok"], "after that the other has its turn")
            took[name + " after its half"] = time.monotonic() - begin

            sent = other.send("ping")
            time.sleep(0.2)
            begin = time.monotonic()
            other.cancel(sent)
            said = [other.receive()[0] for _ in range(2)]
            check({a["id"]: a.get("error", {}).get("code") for a in said} ==
                  {sent: "cancelled", sent + 1: None}, said)
            took["cancel by " + name] = time.monotonic() - begin
            check(took["cancel by " + name] < 5, took)
            other.quit()
    print("called off after", {name: round(seconds, 2) for name, seconds in took.items()}, "s")

    # One that floods the server does not keep another waiting for more than a turn or so.
    with server("--socket", "sonar.sock") as (_, _):
        greedy, other = Client.unix("sonar.sock", when_full="wait"), Client.unix("sonar.sock")
        count = 300
        for _ in range(count):
            greedy.send("ping")
        greedy.receive()
        for _ in range(10):
            other.ping()
        greedy._close[0].settimeout(0.0)
        left = count - 1
        with contextlib.suppress(BlockingIOError):
            while greedy._reader.readline():
                left -= 1
        check(left > count // 2, f"ten pings of another waited for {count - left} of one")


def asked(*words):
    """What a command of asdic's prints as JSON, without what a server does not tell."""
    done = subprocess.run([ASDIC, *words, "--json"], capture_output=True, text=True, check=True)
    return without(json.loads(done.stdout))


def without(told):
    for key in ("filetype", "scenario", "output", "id", "ok", "time", "warnings"):
        told.pop(key, None)
    return told


def the_model_by_itself():
    """Eigenrays, rays, fields and levels: the numbers of the commands of asdic's, and of a file."""
    run = {"frequency": 500.0, "receivers": {"depth": {"first": 50.0, "last": 900.0, "count": 8},
                                             "range": {"first": 100.0, "last": 4000.0, "count": 9}}}
    table = ("{frequency=500.0, receivers={depth={first=50.0, last=900.0, count=8}, "
             "range={first=100.0, last=4000.0, count=9}}}")
    with Client.start("sea.toml", program=ASDIC) as client:
        for ping in (1, 2):
            told = client.arrivals()
            check(told["time"] == 10.0 * (ping - 1), told["time"])
            check(without(told) == asked("arrivals", "sea.toml", "--ping", str(ping)), "other paths")
            client.ping(deliver="none")
        check(without(client.arrivals(time=0.0, leg="array", target="rock"))["legs"] ==
              asked("arrivals", "sea.toml", "--leg", "array")["legs"], "legs back")
        receiver = client.arrivals(time=0.0, range=2000.0, receiver_depth=300.0, source_depth=20.0,
                                   bearing_deg=40.0, frequency=700.0)
        check(without(receiver)["legs"] == asked(
            "arrivals", "sea.toml", "--range", "2000", "--receiver-depth", "300", "--source-depth",
            "20", "--bearing", "40", "--frequency", "700")["legs"], "paths to a receiver")
        check(without(client.rays()) == asked("rays", "sea.toml"), "other rays")
        check(without(client.rays(from_deg=-3.3, to_deg=7.1, count=5, range=9000.0, bounces=2,
                                  source_depth=70.0)) ==
              asked("rays", "sea.toml", "--from", "-3.3", "--to", "7.1", "--count", "5", "--range",
                    "9000", "--bounces", "2", "--source-depth", "70"), "another fan")
        check(without(client.rays(elevations_deg=[1.1, -4.0]))["rays"] ==
              asked("rays", "sea.toml", "--elevations", "1.1,-4.0")["rays"], "listed elevations")
        answer, pressure = client.field(run=run)
        told = asked("field", "sea.toml", "--set", f"run={table}", "-o", "field.h5")
        check({key: answer[key] for key in told} == told, "another summary")
        with h5py.File("field.h5") as file:
            check(pressure.tobytes() == file["pressure"][...].tobytes(), "another field")
            check(answer["depth"] == list(file["depth"][...]), "depths")

        # A platform that goes on: from where it is.
        client.update(time=20.0, platform={"position": [0.0, 0.0, 400.0], "velocity": [1, 0, 0]})
        check(client.rays()["source_depth"] == 400.0, "where the platform is")
        check(client.field(run=run)[1].tobytes() == client.field(
            run={**run, "source": {"depth": 400.0}})[1].tobytes(), "a field from there")

        for code, work in {
                "limit": [lambda: client.rays(count=2001), lambda: client.field(run={
                    **run, "receivers": {"depth": {"first": 1, "last": 900, "count": 2000},
                                         "range": {"first": 1, "last": 900, "count": 2000}}})],
                "scenario": [lambda: client.rays(source_depth=1000.5),
                             lambda: client.arrivals(range=100.0, receiver_depth=1001.0)],
                "value": [lambda: client.rays(from_deg=90), lambda: client.rays(to=3),
                          lambda: client.rays(range=-1), lambda: client.arrivals(range=100.0),
                          lambda: client.arrivals(target="x"), lambda: client.arrivals(leg="up"),
                          lambda: client.field(run=3), lambda: client.field(runs=run),
                          lambda: client.field(run={**run, "task": "rays"}),
                          lambda: client.field(run={"frequency": -1.0}),
                          lambda: client.levels(deliver="none")]}.items():
            for one in work:
                refused(code, one)
        refused("scenario", client.field)  # the scenario has no run

    with Client.start("sea.toml", program=ASDIC) as client:
        for ping in range(3):
            answer, levels = client.levels()
            with h5py.File("reference.h5") as file:
                for row, name in enumerate(answer["levels"]["rows"]):
                    check(levels[row].tobytes() == file[f"levels/{name}"][ping].tobytes(), name)
                check(answer["levels"]["time_step"] == file["levels/echo"].attrs["time_step"], answer)
                check(answer["levels"]["time_start"] == file["levels/echo"].attrs["time_start"], answer)
            check(client.ping(deliver="none").answer["ping"] == ping + 1, "it is not counted")


def slow_readers():
    """What readers do not take is bounded, in all; and so are files."""
    large = ["--set", "reverberation.enabled=false", "--set", "array.phones=64", "--set", "pings.recording_duration=30.0", "--limit",
             "answer_bytes=20000000", "--limit", "total_answer_bytes=30000000"]
    with server("--socket", "sonar.sock", *large) as (process, _):
        with Client.unix("sonar.sock") as client:
            ping = client.ping(deliver="samples")
            one = ping.samples.nbytes
            check(5e6 < one < 20e6, one)
        before = resident(process)
        deaf = [Client.unix("sonar.sock", when_full="wait") for _ in range(6)]
        for client in deaf:
            for _ in range(8):
                client.send("ping", deliver="samples")
        with Client.unix("sonar.sock") as other:  # told so; what needs no room is done
            until = time.monotonic() + 30
            code = None
            while code != "busy" and time.monotonic() < until:
                other.ping(deliver="none")
                try:
                    other.ping(deliver="samples")
                except Refused as no:
                    code = no.code
            check(code == "busy", "answers of 48 pings of 8 MB are kept")
        time.sleep(1.0)
        after = resident(process)
        check(after - before < 110000, f"{before} kB, then {after} kB for at most 30 MB of answers")
        for client in deaf[1:]:
            client.close()
        for _ in range(8):  # then there is room again
            check(deaf[0].receive()[1].nbytes == one, "samples")
        deaf[0].close()
    print(f"slow readers: {before} kB before, {after} kB with 48 pings of {one} bytes not taken")

    os.mkdir("quota")
    with Client.start("sea.toml", "--output-dir", "quota", "--limit", "output_bytes=5000000",
                      program=ASDIC) as client:
        files = []
        with contextlib.suppress(Refused):
            for _ in range(100):
                files.append(client.ping().answer["file"])
        refused("limit", client.ping)
        check(client.ping(deliver="none").answer["ping"] == len(files) + 1, "it was not begun")
    sizes = [os.path.getsize(file) for file in Path("quota").rglob("*.h5")]
    check(len(sizes) == len(files) > 3 and sum(sizes) <= 5e6, sizes)


class Told(Client):
    """What a replay prints, as a client would have had it."""

    def __init__(self, printed):
        self._reader = io.BytesIO(printed)

    def all(self):
        while self._reader.tell() < len(self._reader.getbuffer()):
            yield self.receive()


def replayed(log, *more):
    done = subprocess.run([ASDIC, "serve", "sea.toml", "--replay", log, *more], capture_output=True)
    check(done.returncode == 0, done.stderr)
    return [samples.tobytes() for _, samples in Told(done.stdout).all() if samples is not None]


def saved_and_replayed():
    """A saved scenario has the next ping's bits, and a log those of all of them."""
    os.mkdir("saves")

    def check_save(client, saved, **ping):
        samples = client.ping(deliver="samples", **ping)
        number = samples.answer["ping"]
        check(saved["ping"] == number and saved["time"] == samples.answer["time"], saved)
        subprocess.run([ASDIC, "ping", saved["file"], "-q", "--force", "-o", "saved.h5"], check=True)
        with h5py.File("saved.h5") as file:
            check(file["ping_time"][number - 1] == saved["time"], "another time")
            check(file["pressure"][number - 1].tobytes() == samples.samples.tobytes(),
                  f"ping {number} of what was saved has other bits")
        return samples.samples

    heard = []
    with Client.start("sea.toml", "--output-dir", "saves", "--tell-scenario", "--log", "log.jsonl",
                      program=ASDIC) as client:
        heard.append(check_save(client, client.save()))
        client.update(wind_speed=12, targets={"strength_db": 20}, array={"spacing": 0.7})
        heard.append(check_save(client, client.save()))
        client.update(platform={"position": [10.0, 5.0, 250.0], "heading_deg": 30, "speed": 3.1})
        for _ in range(3):  # beyond the file's schedule
            heard.append(check_save(client, client.save()))
        refused("value", lambda: client.update(wind_speed=-1))
        client.ping(time=47.3)
        heard.append(check_save(client, client.save()))  # not of the schedule any more
        text = client.save(deliver="text")
        Path("text.toml").write_text(text["toml"])
        heard.append(check_save(client, {**text, "file": "text.toml"}))
        refused("value", lambda: client.save(deliver="samples"))
        client.quit()
    with Client.start("sea.toml", program=ASDIC) as client:
        refused("value", client.save)  # it has no place, and may not be told
    check(replayed("log.jsonl", "--output-dir", "saves", "--tell-scenario") ==
          [one.tobytes() for one in heard], "a replay has other bits")
    lines = [json.loads(line) for line in Path("log.jsonl").read_text().splitlines()]
    check(lines[0]["asdic_log"] == 1 and lines[0]["pace"] == "fast", lines[0])
    check([line["ok"] for line in lines[1:]].count(False) == 2, "refused ones are told as that")
    check(all(0 <= line["received"] <= line["begun"] <= line["done"] for line in lines[1:]), lines)

    # By the clock, several clients, one of them called off: a replay at once has the same bits.
    heard = []
    with server("--socket", "sonar.sock", "--pace", "20", "--log", "clock.jsonl") as (_, _):
        with Client.unix("sonar.sock") as one, Client.unix("sonar.sock") as two:
            for step in range(3):
                for client in (one, two):
                    client.update(platform={"heading_deg": 40 * step, "speed": 4})
                    heard.append(client.ping(deliver="samples").samples.tobytes())
                    time.sleep(0.02)
            waits = one.send("ping", time=5000.0)
            one.cancel(waits)
            for _ in range(2):
                one.receive()
            heard.append(one.ping(deliver="samples", time=one.state()["time"] + 2.0).samples.tobytes())
    check(replayed("clock.jsonl") == heard, "a replay of a session by the clock has other bits")
    with open("clock.jsonl", "a") as log:
        log.write('{"session": 1, "ok": tr')  # torn by a kill
    check(replayed("clock.jsonl") == heard, "a torn line")
    for arguments, said in (
            (["--log", "clock.jsonl"], "which is there, expected a new file"),
            (["--replay", "sea.toml"], "sea.toml:1: found another line"),
            (["--replay", "nothing"], "found no such file"),
            (["--replay", "log.jsonl", "--set", "seed=3"], "another scenario (overrides)"),
            (["--replay", "log.jsonl", "--pace", "real"], "expected none of them")):
        done = subprocess.run([ASDIC, "serve", "sea.toml", *arguments], stdin=subprocess.DEVNULL,
                              capture_output=True, text=True)
        check(done.returncode == 2 and said in done.stderr, done)


def does_not_grow(count):
    """Updates and pings, as a vehicle sends them."""
    with server("--socket", "sonar.sock", "--limit", "kept_bytes=1000000") as (process, _):
        with Client.unix("sonar.sock") as client:
            def step(i):
                now = 10.0 * i
                client.update(time=now, platform={"position": [0.3 * i, 0, 200 + i % 7],
                                                  "heading_deg": i % 360, "speed": 2},
                              array={"heading_deg": i % 180})
                ping = client.ping(time=now, deliver="samples", elevation_deg=i % 5,
                                   source_level_db=190 + i % 3)
                check(ping.answer["ping"] == i + 1 and np.isfinite(ping.samples).all(), i)

            warm = max(50, count // 10)
            for i in range(warm):
                step(i)
            before = resident(process)
            for i in range(warm, warm + count):
                step(i)
            after = resident(process)
            last = client.quit()
        check(last["pings"] == warm + count, "no command is lost")
        # What the allocator keeps varies by some MB; a leak of 1 kB a ping is 10 MB in deep_check.
        check(after <= before * 1.05 + 6000, f"{before} kB before, {after} kB after {count} pings")
        print(f"{count} updates and pings: {before} kB before, {after} kB after; "
              f"p50 {1e3 * last['latency']['p50']:.1f} ms, p99 {1e3 * last['latency']['p99']:.1f} ms")


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 150
    with tempfile.TemporaryDirectory(prefix="asdic_serve_") as folder:
        os.chdir(folder)
        Path("sea.toml").write_text(SCENARIO)
        pings = reference()
        for work in (lambda: by_standard_streams(pings), lambda: by_unix_socket(pings),
                     lambda: by_tcp(pings), in_time, ends, good_manners,
                     the_model_by_itself, slow_readers, saved_and_replayed, lambda: does_not_grow(count)):
            work()
        os.chdir("/")
    print("served by standard streams, Unix socket and TCP: all as asked")


if __name__ == "__main__":
    main()

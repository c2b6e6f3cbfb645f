#!/usr/bin/env python3
"""The block stream of `asdic serve` by UDP, as its receivers meet it.

Truth: the samples have the bits that a client gets by "deliver": "samples"; what a proxy throws away is
told, block by block; what it mixes up or sends again changes nothing.

    ASDIC=build/ci/bin/asdic stream.py
"""
import contextlib
import json
import os
import random
import signal
import socket
import struct
import subprocess
import stat
import sys
import tempfile
import threading
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "tests/support")]
from asdic_client import Client  # noqa: E402
from asdic_stream import HEADER, Assembler, Ring, Stream  # noqa: E402
from checks import check  # noqa: E402
from deep import DEEP  # noqa: E402
from served import ASDIC, free_port, refused, sea, server  # noqa: E402

SCENARIO = sea("seed = 5", """[[array]]
kind = "horizontal"
name = "bow"
phones = 2
spacing = 0.75
[[array]]
kind = "horizontal"
name = "flank"
offset = [0.0, -20.0, 2.0]
phones = 3
spacing = 0.75
[reverberation]
azimuths = 8
[propagation]
max_surface_bounces = 1
max_bottom_bounces = 1""", array="", platform="""position = [0.0, 0.0, 200.0]
velocity = [2.0, 1.0, 0.0]""", target="""name = "rock"
position = [1500.0, 0.0, 500.0]
strength_db = 10.0""", pings="""count = 1
interval = 10.0
recording_duration = 6.0
SAMPLES""")
BLOCK, SECONDS = 0.25, 3  # so little that it waits in a socket's buffer whole


def listen(client, **deliver):
    """Two streams of a session, with a ping and a turn between. → lines and samples of blocks"""
    heard = []
    for seconds in (0.5, SECONDS):
        client.listen(seconds=seconds, block=BLOCK, **deliver)
        heard += list(client.blocks())
        client.ping()
        client.update(array={"name": "bow", "heading_deg": 40})
    return heard


class Receiver(threading.Thread):
    """Takes the streams of a session."""

    def __init__(self, *place, streams=2, **options):
        super().__init__(daemon=True)
        self.stream = Stream(*place, timeout=20, **options)
        self.streams, self.blocks, self.fault = streams, [], None
        self.start()

    def run(self):
        try:
            for _ in range(self.streams):
                self.blocks += list(self.stream)
        except Exception as fault:  # noqa: BLE001: told by the test's own thread
            self.fault = fault

    def result(self):
        self.join(30)
        self.stream.close()
        if self.fault:
            raise self.fault
        return self.blocks


def same_bits(received, truth):
    check([b.number for b in received] == [b.number for b in truth], "every block, in order")
    for one, other in zip(received, truth):
        check(one.samples.dtype == other.samples.dtype and one.samples.shape == other.samples.shape, "shape")
        check(one.samples.tobytes() == other.samples.tobytes(), f"block {one.number} has other bits")
        check(abs(one.time - other.time) < 1e-9, f"block {one.number} at {one.time}, not {other.time}")
        check(one.lost == 0, "nothing is lost")


def by_udp(truth):
    port = free_port()
    receiver = Receiver("127.0.0.1", port)
    with Client.start("sea.toml", "--udp", f"127.0.0.1:{port}", program=ASDIC) as client:
        lines = listen(client, deliver="udp")
        check(all(line.samples is None for line in lines), "the client gets lines alone")
        check([line.time for line in lines] == [b.time for b in truth], "times")
        client.quit()
    received = receiver.result()
    same_bits(received, truth)
    about = receiver.stream.about
    check([(a["name"], a["phones"]) for a in about["arrays"]] == [("bow", 2), ("flank", 3)], about)
    at, times = np.array(about["positions"]), about["time"]
    check(times == 0.5 + SECONDS - 1, f"told each second: {times}")
    middle = np.array([2.0 * times, 1.0 * times, 200.0])
    check(np.allclose(at[:2].mean(0), middle) and np.allclose(at[2:].mean(0), middle + [0, -20, 2]), at)
    turned = (at[1] - at[0])[:2] / 0.75  # its heading was changed to 40 degrees
    check(np.allclose(np.abs(turned), [np.sin(np.radians(40)), np.cos(np.radians(40))]), turned)
    first = received[0].about["positions"]
    check(not np.allclose(np.subtract(first[1], first[0]), at[1] - at[0]), "what it was before is told, too")


def by_multicast(truth):
    group, port = "239.255.71.11", free_port()
    try:
        receivers = [Receiver(group, port, interface="127.0.0.1") for _ in range(2)]
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:  # whether this machine can do it at all
            probe.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton("127.0.0.1"))
            probe.sendto(b"is there a way?", (group, port))
        time.sleep(0.2)
        heard = [r.stream.assembler.foreign for r in receivers]
    except OSError as error:
        heard = [0]
        print(f"multicast on the loopback interface: {error}")
    if not all(heard):
        print("multicast on the loopback interface does not work here: not tested")
        return
    with Client.start("sea.toml", "--udp", f"{group}:{port}", "--udp-interface", "127.0.0.1", program=ASDIC) as client:
        listen(client, deliver="udp")
        client.quit()
    for receiver in receivers:
        same_bits(receiver.result(), truth)


def with_loss(truth):
    """A proxy drops, repeats and swaps packets, and keeps count."""
    ends = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(2)]
    ends[0].bind(("127.0.0.1", 0))
    ends[0].setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 22)
    ends[0].settimeout(20)
    port = free_port()
    receiver = Receiver("127.0.0.1", port)
    lot, broken, dropped = random.Random(4), set(), 0

    def forward():
        nonlocal dropped
        held, ended = None, 0
        while ended < 2 * 3:  # each stream says three times that it has
            packet = ends[0].recv(65536)
            _, _, kind, _, block, *_ = HEADER.unpack_from(packet)
            ended += b'"ended":true' in packet
            if kind == 1 and lot.random() < 0.08:
                dropped += 1
                broken.add(block)
                continue
            for one in ([packet, packet] if lot.random() < 0.1 else [packet]):
                if kind == 1 and held is None and lot.random() < 0.2:
                    held = one
                    continue
                ends[1].sendto(one, ("127.0.0.1", port))
                if held is not None:
                    ends[1].sendto(held, ("127.0.0.1", port))
                    held = None

    proxy = threading.Thread(target=forward, daemon=True)
    proxy.start()
    with Client.start("sea.toml", "--udp", f"127.0.0.1:{ends[0].getsockname()[1]}", program=ASDIC) as client:
        listen(client, deliver="udp")
        client.quit()
    received = receiver.result()
    told = receiver.stream.assembler
    check(0 < len(broken) < len(truth), f"{len(broken)} of {len(truth)} blocks are lost: it shows something")
    check(told.lost == dropped, f"{dropped} packets are lost, {told.lost} are told")
    check(told.lost_blocks == len(broken), f"{len(broken)} blocks are lost, {told.lost_blocks} are told")
    check(told.duplicates > 0 and told.reordered > 0, "repeated and swapped")
    whole = [b for b in truth if b.number not in broken]
    check([b.number for b in received] == [b.number for b in whole], "all others come")
    check(all(a.samples.tobytes() == b.samples.tobytes() for a, b in zip(received, whole)), "with their bits")
    for end in ends:
        end.close()


def wav(data):
    """Of a whole file or a pipe. → rate, samples"""
    check(data[:4] == b"RIFF" and data[8:16] == b"WAVEfmt ", data[:16])
    code, channels, rate = struct.unpack_from("<HHI", data, 20)
    check(channels == 1, "one channel")
    begin = data.index(b"data") + 8
    return rate, np.frombuffer(data[begin:], {1: "<i2", 3: "<f4"}[code])


@contextlib.contextmanager
def listening(place, *arguments, **options):
    process = subprocess.Popen([ASDIC, "listen", "--udp", place, *arguments], stderr=subprocess.PIPE, text=True,
                               **options)
    process.said = process.stderr.readline()
    check("waiting for a stream" in process.said, process.said)
    yield process
    process.said += process.stderr.read()
    process.wait(30)
    process.stderr.close()


def by_listen_command(truth, baseband):
    """One phone as WAV: by a file, and by a pipe."""
    one_stream = [b for b in truth if b.number < 2]  # the first stream of the session
    rows = np.concatenate([b.samples for b in one_stream], axis=1)
    port = free_port()
    place = f"127.0.0.1:{port}"
    scale = [] if baseband else ["--full-scale", "1"]
    with listening(place, "--phone", "4", "--wav", "phone.wav", "--force", *scale) as process:
        with Client.start("sea.toml", "--udp", place, program=ASDIC) as client:
            listen(client, deliver="udp")
            client.quit()
    check(process.returncode == 0 and "none of 2 blocks lost" in process.said, process.said)
    rate, heard = wav(Path("phone.wav").read_bytes())
    about = json.loads(Path("phone.wav.json").read_text())
    check(round(about["sample_rate_hz"]) == rate and about["samples"] == heard.size, about)
    if baseband:  # back by way of the spectrum: the positive frequencies, down by the tone
        up = heard.size // rows.shape[1]
        check(heard.size == up * rows.shape[1] and "as a tone of 1000 Hz" in process.said, process.said)
        spectrum = np.fft.fft(heard * about["pascal_per_unit"])
        spectrum[heard.size // 2:] = 0
        times = np.arange(heard.size) / about["sample_rate_hz"]
        back = (2 * np.fft.ifft(spectrum) * np.exp(-2j * np.pi * 1000 * times))[::up]
        inside = slice(8, -8)
        off = np.linalg.norm((back - rows[3])[inside]) / np.linalg.norm(rows[3][inside])
        check(off < 0.2, f"off by {off}")  # the outermost twelfth of noise in the whole band
    else:
        check(heard.tobytes() == rows[3].tobytes(), "the bits of the phone, in Pa")
        info = subprocess.run([ASDIC, "info", "phone.wav"], capture_output=True, text=True, check=True).stdout
        check("2500" in info, info)
    with listening(place, "--phone", "4", "--wav", "-", "--format", "16", "--seconds", "0.3",
                   stdout=open("pipe.wav", "wb")) as process:
        with Client.start("sea.toml", "--udp", place, program=ASDIC) as client:
            listen(client, deliver="udp")
            client.quit()
    rate, piped = wav(Path("pipe.wav").read_bytes())
    check(process.returncode == 0 and abs(piped.size / rate - 0.3) < 0.01, f"{piped.size} at {rate}: {process.said}")
    check(3200 < np.abs(piped).max() < 3300, "a tenth of full scale, by the first second")
    for arguments, said in ((["--phone", "9"], "--phone: found 9, expected a phone from 1 to 5"),
                            (["--tone", "20"], "--tone: found ")):
        with listening(place, "--wav", "no.wav", *arguments) as process:
            with Client.start("sea.toml", "--udp", place, program=ASDIC) as client:
                client.listen(seconds=0.5, block=BLOCK, deliver="udp")
                client.quit()
        check(process.returncode == 2 and said in process.said and not os.path.exists("no.wav"), process.said)


def listen_ends():
    place = f"127.0.0.1:{free_port()}"
    with listening(place, "--wav", "never.wav") as process:
        process.send_signal(signal.SIGINT)
    check(process.returncode == 1 and "no block came" in process.said, process.said)
    check(not os.path.exists("never.wav"), "nothing was heard")
    with Client.start("sea.toml", "--pace", "real", "--udp", place, program=ASDIC) as client:
        with listening(place, "--wav", "some.wav") as process:
            client.listen(block=0.02, deliver="udp")
            for _, _ in zip(range(10), client.blocks()):
                pass
            process.send_signal(signal.SIGINT)  # in the middle of it: the file is whole
    check(process.returncode == 0 and wav(Path("some.wav").read_bytes())[1].size > 0, process.said)
    Path("mine.wav").write_bytes(b"RIFF of another")
    with listening(place, "--wav", "mine.wav") as process:
        with Client.start("sea.toml", "--udp", place, program=ASDIC) as client:
            client.listen(seconds=0.5, deliver="udp")
    check(process.returncode == 2 and Path("mine.wav").read_bytes() == b"RIFF of another", process.said)


def one_at_a_time():
    port = free_port()
    receiver = Receiver("127.0.0.1", port, streams=2)
    with server("--socket", "sonar.sock", "--pace", "real", "--udp", f"127.0.0.1:{port}"), \
            Client.unix("sonar.sock") as one, Client.unix("sonar.sock") as two:
        one.listen(block=0.05, deliver="udp")
        refused("value", lambda: two.listen(block=0.05, deliver="udp"), "another session")
        for _, block in zip(range(4), one.blocks()):
            check(block.samples is None, "lines alone")
        one.listen(stop=True)
        list(one.blocks())
        two.listen(block=0.05, seconds=0.2, deliver="udp")
        check(len(list(two.blocks())) == 4, "the other's turn")
    check([b.number for b in receiver.result()][-4:] == [0, 1, 2, 3], "another stream, from its beginning")
    with Client.start("sea.toml", program=ASDIC) as client:  # a client does not choose where it sends
        refused("value", lambda: client.listen(seconds=1, deliver="udp"), "the server has no --udp")
    for wrong in ("4711", "127.0.0.1:0", "nowhere.invalid.:1"):
        done = subprocess.run([ASDIC, "serve", "sea.toml", "--udp", wrong], capture_output=True, text=True,
                              stdin=subprocess.DEVNULL)
        check(done.returncode == 2 and done.stderr.startswith("asdic: --udp: found "), done)


def by_ring(truth):
    with Client.start("sea.toml", "--ring", "ring", "--ring-size", "1", program=ASDIC) as client:
        mode = os.stat("ring").st_mode
        check(stat.S_ISREG(mode) and stat.S_IMODE(mode) == 0o600 and os.stat("ring").st_size == 1_000_000, oct(mode))
        received, reader = [], Ring("ring", timeout=20)
        for seconds in (0.5, SECONDS):
            taker = threading.Thread(target=lambda: received.extend(reader), daemon=True)
            taker.start()
            client.listen(seconds=seconds, block=BLOCK, deliver="ring")
            check(all(b.samples is None for b in client.blocks()), "lines alone")
            taker.join(30)
            client.ping()
            client.update(array={"name": "bow", "heading_deg": 40})
        same_bits(received, truth)
        check(len(reader.about["positions"]) == 5 and reader.about["block"] > 2, reader.about)
        left = list(Ring("ring", oldest=True, timeout=20))  # what is still there
        same_bits(left, [b for b in truth if b.number >= 2])
        for wrong in (20, 60):
            refused("limit", lambda: client.listen(seconds=1, block=wrong, deliver="ring"), "at most")
        client.quit()
    check(not os.path.exists("ring"), "it goes with its server")
    check(list(reader) == [], "and its readers know")


def overtaken(truth):
    """A reader that is slow, and one that reads while it is overtaken again and again."""
    rows = np.concatenate([b.samples for b in truth if b.number >= 2], axis=1)
    rate, begin = 2500, truth[2].time
    with Client.start("sea.toml", "--ring", "ring", "--ring-size", "0.2", program=ASDIC) as client:
        def again(seconds, **how):
            client.listen(seconds=seconds, deliver="ring", **how)
            return client.blocks()
        list(again(0.5, block=BLOCK))
        client.ping()
        client.update(array={"name": "bow", "heading_deg": 40})
        slow, fast = (Ring("ring", timeout=20) for _ in range(2))
        received = []
        taker = threading.Thread(target=lambda: received.extend(fast), daemon=True)
        taker.start()
        blocks = again(SECONDS, block=0.0012)  # 3 samples: 2500 blocks
        while not slow._map[32:40].strip(b"\0"):
            time.sleep(0.001)
        first = next(slow)
        lines = list(blocks)
        slots = slow.HEADER.unpack_from(slow._map)[5]
        taker.join(30)
        rest = list(slow)
        client.quit()
    number = lines[0].number
    check(slots < len(lines), f"{len(lines)} blocks are more than {slots} slots")
    for heard in ([first] + rest, received):
        told = sum(b.lost for b in heard)
        check(told + len(heard) == len(lines), f"{told} lost, {len(heard)} heard of {len(lines)}")
        for block in heard:
            at = round((block.time - begin) * rate)
            check(np.array_equal(block.samples, rows[:, at:at + block.samples.shape[1]]), "bits of the truth")
        check([b.number for b in heard] == sorted(b.number for b in heard) and heard[0].number >= number, "in order")
    check(sum(b.lost for b in [first, *rest]) > 0, "it was overtaken, and knows")


def keeps_what_is_not_its_own():
    def served(path):
        return subprocess.run([ASDIC, "serve", "sea.toml", "--ring", path], capture_output=True, text=True,
                              stdin=subprocess.DEVNULL)
    Path("precious").write_text("kept")
    os.symlink("precious", "link")
    os.mkdir("folder")
    for path in ("precious", "link", "folder"):
        done = served(path)
        check(done.returncode == 2 and f"--ring {Path(path).absolute()}: found " in done.stderr, done)
    check(Path("precious").read_text() == "kept", "it is not touched")
    with Client.start("sea.toml", "--ring", "ring", program=ASDIC) as client:
        done = served("ring")
        check(done.returncode == 2 and "another server" in done.stderr, done)
        reader = Ring("ring")
        client.process.kill()
        client.process.wait()
    check(os.path.exists("ring"), "a killed server leaves it")
    with Client.start("sea.toml", "--ring", "ring", program=ASDIC) as client:
        check(list(reader) == [], "whoever had mapped it knows that its server has gone")
        client.quit()


def described(stream, block=0, **more):
    return json.dumps({"stream": f"{stream:016x}", "block": block, "time": 0, "sample_rate": 100, "channels": 1,
                       "block_samples": 1000, "type": "float32", "arrays": [{"name": "a", "phones": 1}],
                       "positions": [[0, 0, 0]], **more}).encode()


def packet(kind, sequence, block, content, stream=7, fragment=0, fragments=1):
    return HEADER.pack(b"AS", 2, kind, sequence % 2**32, block, fragment, fragments, stream) + content


def is_bound_to_its_sender():
    """Packets of a stranger, whatever numbers they guess, neither give nor stop a block. After a long gap
    the reader continues at a descriptor; it takes another sender when this one is silent.
    """
    loud, quiet = np.full(250, 1e6, "<f4").tobytes(), bytes(1000)
    reader = Assembler()
    reader.take(packet(0, 0, 0, described(7)), "A", 0.0)
    got = []
    for n in range(40):  # three packets a block
        for i in range(3):
            got += reader.take(packet(1, 1 + 3 * n + i, n, bytes(1408 if i < 2 else 1184), 7, i, 3), "A", 0.1 * n)
        for sequence in range(0, 2**32, 2**26):  # blind, also from its own address without its number
            for sender, stream in (("B", 7), ("B", 8), ("A", 8)):
                got += reader.take(packet(1, sequence + 4, n + 1, loud, stream), sender, 0.1 * n)
            got += reader.take(packet(0, sequence, n, described(9, n), 9), "B", 0.1 * n)
    check([b.number for b in got] == list(range(40)) and not any(b.samples.any() for b in got), "its blocks alone")
    check(reader.lost == reader.lost_blocks == reader.reordered == 0 and reader.others > 5000, "and the rest counted")
    # Numbers that the descriptor does not allow: a block too far ahead for so few packets, more bytes than a block has,
    # a part of a sample.
    for sequence, block, content, fragments in ((200, 70, quiet, 1), (201, 41, bytes(1408), 4),
                                                (202, 41, bytes(1001), 1)):
        before = reader.foreign
        check(not reader.take(packet(1, sequence, block, content, 7, 0, fragments), "A", 4.0), "no block")
        check(reader.foreign == before + 1, (block, len(content), fragments))
    # After 200 000 packets the receiver reports the loss and continues.
    check(not reader.take(packet(1, 200_001, 1000, quiet), "A", 9.0), "not before it is known where")
    reader.take(packet(0, 200_002, 1001, described(7, 1001)), "A", 9.0)
    (block,) = reader.take(packet(1, 200_003, 1001, quiet), "A", 9.0)
    check(block.number == 1001 and block.lost == 961 and reader.lost_blocks == 961, f"{block.lost} lost")
    check(not reader.take(packet(0, 5, 0, described(8), 8), "B", 13.9), "it is not silent so long")
    check(reader.sender == "A", "it is kept")
    reader.take(packet(0, 5, 0, described(8), 8), "B", 14.1)
    check(reader.sender == "B" and len(reader.take(packet(1, 6, 0, quiet, 8), "B", 14.1)) == 1, "now it is")
    # An end is sent three times and ends one stream; the next one may have any sender.
    for i in range(3):
        reader.take(packet(0, 7 + i, 1, described(8, 1, ended=True), 8), "B", 15.0)
        check(reader.ended == (i == 0), "once")
        reader.ended = False
    reader.take(packet(0, 99, 0, described(7)), "A", 15.1)
    check(reader.sender == "A", "at once")


def stands_hostile_packets():
    lot = random.Random(9)
    assembler, about = Assembler(), described(7)
    assembler.take(packet(0, 0, 0, about))
    for i in range(200_000 if DEEP else 20_000):
        number = lot.choice((7, 7, 7, lot.randrange(1 << 64)))
        sequence, block = (lot.randrange(1 << lot.randrange(1, 33)) for _ in range(2))
        pieces = (lot.randrange(1 << lot.randrange(1, 17)) for _ in range(2))
        one = packet(lot.randrange(2), sequence, block, lot.randbytes(lot.choice((1408, 1408, 5, 0))), number, *pieces)
        if i % 4 == 0:
            wrong = about.replace(bytes([lot.choice(about)]), bytes([lot.randrange(256)]), 1)
            one = packet(0, i % 4096, 0, wrong, number)
        for block in assembler.take(one):
            check(block.samples.nbytes <= 4000, "no longer than a block")
    check(len(assembler._own) + len(assembler._strange) <= 10, "what is not whole is bounded")
    assembler.take(packet(0, 0xA0000000, 7, described(8, 7), 8), "B", 10.0)
    ((block),) = assembler.take(packet(1, 0xA0000001, 7, bytes(400), 8), "B", 10.0)
    check(block.number == 7 and block.lost == 0 and block.samples.shape == (1, 100), "a stream after it is whole")


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for samples in ('samples = "baseband"', "sample_rate = 2500.0"):
            Path("sea.toml").write_text(SCENARIO.replace("SAMPLES", samples))
            with Client.start("sea.toml", program=ASDIC) as client:
                truth = listen(client)
            by_udp(truth)
            by_ring(truth)
            by_listen_command(truth, "baseband" in samples)
            if samples != 'samples = "baseband"':
                by_multicast(truth)
                with_loss(truth)
                overtaken(truth)
        listen_ends()
        one_at_a_time()
        keeps_what_is_not_its_own()
        is_bound_to_its_sender()
        stands_hostile_packets()
        os.chdir("/")


main()

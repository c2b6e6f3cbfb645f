"""The server, streams and records tell one sea."""
import os
import sys

import numpy as np

from law import Silent, alike, copied, duration, expect, law, loudness, norm, ping, plain
from program import Folder, Refused, Violation
from schema import ASDIC, ROOT

sys.path.insert(0, str(ROOT / "python"))


def served(s, *arguments):
    """A client of a server of its own, in a folder of its own."""
    import contextlib
    import asdic_client

    @contextlib.contextmanager
    def client():
        with Folder(s) as folder:
            here = os.getcwd()
            os.chdir(folder)
            try:
                sonar = asdic_client.Client.start("s.toml", "--pace", "fast", "--threads", "1", program=ASDIC)
            finally:
                os.chdir(here)
            with sonar:
                yield sonar
    return client()


@law
def served_is_pinged(s, p):
    """A ping of `asdic serve` has the bits of `asdic ping`; so has the same ping once more (docs/formats/serve.md)."""
    s["pings"].pop("continuous", None)
    s["pings"]["count"] = 2
    record = ping(s)
    with served(s) as sonar:
        for k in range(2):
            got = np.asarray(sonar.ping(deliver="samples").samples)
            want = record.pressure[k].astype(np.complex64 if record.carrier is not None else np.float32)
            expect(got.shape == want.shape, f"ping {k + 1}: {got.shape} samples, {want.shape} in the file")
            expect(np.array_equal(got, want), f"ping {k + 1}: samples differ by {norm(got - want) / max(norm(want), 1e-300):.1e} of their norm")


@law
def listened_is_pinged(s, p):
    """What `listen` hands out is the record of the ping, sample by sample: -60 dB, since a stream's filter is another."""
    s = plain(s)
    s["pings"].pop("recording_start", None)
    record = ping(s)
    seconds = s["pings"]["recording_duration"]
    heard = []
    with served(s) as sonar:
        answer = sonar.listen(seconds=seconds, schedule=True, block=min(max(seconds / 8, 0.001), 60.0))
        if abs(answer["sample_rate"] - record.rate) > 1e-6 * record.rate:
            raise Silent("another rate")
        for block in sonar.blocks():
            heard.append(np.asarray(block.samples))
    got = np.concatenate(heard, axis=1)
    n = min(got.shape[1], record.pressure.shape[2])
    off = norm(got[:, :n] - record.pressure[0][:, :n]) / loudness(record, s)
    expect(off <= 2e-3, f"listen and ping differ by {off:.1e} of all paths")


@law
def later_record(s, p):
    """A record that begins later holds the same samples. Synthesis leaves out -80 dB of the loudest: 1e-3 with both edges.

    No band reaches below 0 Hz, and its edges lie on the record's bins, 1/D apart. There the spectrum of a pulse of
    duration T whose envelope jumps is 1/(pi f) of a sample's height, so two records differ by 2/(pi f D).
    """
    s = plain(s)
    first = ping(s)
    n = first.pressure.shape[-1]
    skip = int(n * p("share", [0.25, 0.01, 0.6]))
    s2 = copied(s)
    s2["pings"]["recording_start"] = s["pings"].get("recording_start", 0.0) + skip / first.rate
    s2["pings"]["recording_duration"] = (n - skip) / first.rate
    if s2["pings"]["recording_duration"] < 1.05 * duration(s):
        raise Silent("shorter than the pulse")
    second = ping(s2)
    m = min(second.pressure.shape[-1], n - skip)
    off = norm(first.pressure[..., skip:skip + m] - second.pressure[..., :m]) / loudness(first, s)
    edges = 2 / (np.pi * s["_hz"] * s2["pings"]["recording_duration"])
    expect(off <= (0.01 if "auto" in s["propagation"].values() else 2e-3 + edges), f"a record {skip} samples later differs by {off:.1e} of all paths")


@law
def longer_record(s, p):
    """A longer record begins with the same samples. "auto" may follow more bounces: 0.05 dB.

    Where reflection depends on frequency, legs are sampled over the band to 1.2e-2 (sonar/echoes/leg_response.h).
    """
    s = plain(s)
    first = ping(s)
    s2 = copied(s)
    s2["pings"]["recording_duration"] = s["pings"]["recording_duration"] * p("factor", [1.5, 1.1, 2.0])
    second = ping(s2)
    n = first.pressure.shape[-1]
    off = norm(first.pressure - second.pressure[..., :n]) / loudness(first, s)
    expect(off <= (0.01 if "auto" in s["propagation"].values() else 4e-3), f"a longer record differs by {off:.1e} of all paths")


@law
def later_reverberation(s, p):
    """Reverberation does not depend on where the record begins: as `later_record`, of the samples' own norm.

    Beside it -90 dB of the record: a pulse with sharp edges rings on in a band that is limited, with 1/(pi*B*t) of
    its amplitude, and the tail of a record may be fainter still.
    """
    r = s["reverberation"]
    if not r.get("enabled", True):
        raise Silent("no reverberation")
    s = plain(s)
    s["reverberation"] = r
    s["propagation"] |= {"direct_blast": False}
    first = ping(s)
    n = first.pressure.shape[-1]
    skip = int(n * p("share", [0.25, 0.05, 0.6]))
    s2 = copied(s)
    s2["pings"]["recording_start"] = s["pings"].get("recording_start", 0.0) + skip / first.rate
    s2["pings"]["recording_duration"] = (n - skip) / first.rate
    if s2["pings"]["recording_duration"] < 1.05 * duration(s):
        raise Silent("shorter than the pulse")
    second = ping(s2)
    m = min(second.pressure.shape[-1], n - skip)
    whole = norm(first.pressure[..., skip:skip + m])
    if whole == 0.0:
        raise Silent("nothing is received")
    off = (norm(first.pressure[..., skip:skip + m] - second.pressure[..., :m]) - 3e-5 * norm(first.pressure)) / whole
    expect(off <= 0.01, f"reverberation in a record {skip} samples later differs by {off:.1e}")


@law
def stream_is_its_records(s, p):
    """A continuous record is the sum of its pings' own, each where it was sent: 1e-3, as `later_record`.

    Pressure at one rate, since baseband's phase counts from another moment. Pings leave at whole samples.
    """
    s = plain(s)
    hz = s["_hz"]
    s["propagation"] |= {k: 2 for k in ("max_surface_bounces", "max_bottom_bounces") if s["propagation"].get(k) == "auto"}
    rate = float(f"{2.5 * (1.2 * hz + 45.0 / duration(s)):.6g}")
    span = s["_span"] + duration(s)
    if span * rate > 4e5:
        raise Silent("long")
    s["pings"] = {"count": 2, "samples": "pressure", "sample_rate": rate, "recording_duration": round(span * rate) / rate,
                  "interval": round(0.5 * span * rate) / rate}
    s["pings"]["interval"] = max(s["pings"]["interval"], (int(1.2 * duration(s) * rate) + 1) / rate)
    apart = ping(s)
    stream = ping(s | {"pings": s["pings"] | {"continuous": True}})
    whole = np.concatenate([stream.pressure[k][:, :int(stream.valid[k])] for k in range(2)], axis=1)
    step = round((stream.ping_time[1] - stream.ping_time[0]) * rate)
    total = np.zeros((whole.shape[0], step + apart.pressure.shape[-1]))
    for k in range(2):
        total[:, k * step:k * step + apart.pressure.shape[-1]] += apart.pressure[k]
    n = min(whole.shape[1], total.shape[1])
    off = norm(whole[:, :n] - total[:, :n]) / loudness(apart, s)
    expect(off <= 2e-3, f"the stream differs from its pings' records by {off:.1e} of all paths")

#!/usr/bin/env python3
"""A study is the same file by 1 thread, 2 or 7, in 3 parts, by mpirun, interrupted, and killed again
and again; what a kill leaves is never a file that is not whole, and nothing completed is lost.

    ASDIC=build/ci/bin/asdic study_runs.py [KILLS]        kills of each kind, 3 by default
"""
import os
import random
import re
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests/support"))
from deep import DEEP  # noqa: E402
from same_study import differences  # noqa: E402

import h5py  # noqa: E402
import numpy as np  # noqa: E402

ASDIC = Path(os.environ["ASDIC"]).resolve()
ASDIC_MPI = ASDIC.with_name("asdic-mpi")
KILLS = int(sys.argv[1]) if len(sys.argv) > 1 else 3
COUNT = 480  # realisations: time to interrupt them
FEW = 480 if DEEP else 120  # where nothing is to be interrupted

STUDY = """
[study]
title = "to be interrupted"
realisations = COUNT
seed = 7
[vary]
"target.0.range" = { law = "uniform", low = 20e3, high = 40e3 }
[measure]
echo_level = true
series_level = true     # all samples of all phones, milliseconds a realisation: time to interrupt them
[environment.sound_speed]
kind = "isovelocity"
speed = 1500.0
[environment.bottom]
depth = 5400.0
kind = "rigid"
[platform]
position = [0.0, 0.0, 4500.0]
[transmitter]
source_level_db = 200.0
taper = "omnidirectional"
[pulse]
kind = "cw"
frequency = 1000.0
duration = 0.1
[array]
kind = "horizontal"
phones = 1
spacing = 1.0
[[target]]
position = [30e3, 0.0, 4500.0]
strength_db = 30.0
[noise]
spectral_level_db = 32.0
[reverberation]
enabled = false
[propagation]
max_surface_bounces = 0
max_bottom_bounces = 0
[pings]
samples = "baseband"
baseband_rate = 4000.0
recording_start = 20.0
recording_duration = 40.0
"""


def check(good, what):
    if not good:
        sys.exit(f"FAILED: {what}")


def command(*words, program=ASDIC):
    return [str(program), *map(str, words)]


def run(*words, status=0):
    done = subprocess.run(command(*words), capture_output=True, text=True)
    check(done.returncode == status, f"{words}: status {done.returncode}: {done.stderr}")
    return done


def same(path, how, whole="whole.h5"):
    different = differences(whole, path)
    check(not different, f"{how}: {different} differ")
    check(not list(Path(".").glob(f"{path}*journal*")), f"{how}: a journal was left")
    print(f"{how}: the same bits")


def rows_in(pattern):
    """Rows of the journals, as SQLite sees them."""
    total = 0
    for path in Path(".").glob(pattern):
        with sqlite3.connect(path) as journal:
            total += journal.execute("SELECT COUNT(*) FROM row").fetchone()[0]
        journal.close()
    return total


def wait_for_journal(pattern, run):
    """Until a row has been committed: on a loaded machine the tables are there long before it. A study
    keeps its journal to itself; a copy of the files is what a kill would leave."""
    for _ in range(6000):
        try:
            Path("copy").mkdir(exist_ok=True)
            for path in (p for p in Path(".").glob(pattern + "*") if not p.name.endswith("-shm")):
                shutil.copy(path, "copy")
            if rows_in("copy/" + pattern) > 0:
                return
        except (sqlite3.Error, FileNotFoundError):  # being made
            pass
        finally:
            shutil.rmtree("copy")
        if run.poll() is not None:
            return
        time.sleep(0.01)
    sys.exit("FAILED: no row in the journal after 60 s")


def start(*words):
    """Not in the way of a shell's job control: it hears of SIGINT."""
    return subprocess.Popen(command(*words), stderr=subprocess.PIPE, text=True,
                            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler))


def threads_and_parts():
    run("study", "few.toml", "-o", "few.h5", "-q", "--threads", 1)
    for threads in (2, 7):
        run("study", "few.toml", "-o", "t.h5", "-q", "--threads", threads)
        same("t.h5", f"{threads} threads", "few.h5")
        Path("t.h5").unlink()
    for part in (1, 2, 3):
        run("study", "few.toml", "-o", f"part{part}.h5", "-q", "--shard", f"{part}/3")
    parts = ["part2.h5", "part3.h5", "part1.h5"]
    run("merge", *parts, "-o", "merged.h5")
    same("merged.h5", "3 parts, a catalogue", "few.h5")
    run("merge", *parts, "-o", "copied.h5", "--copy")
    same("copied.h5", "3 parts, copied", "few.h5")
    said = run("merge", *parts[:2], "-o", "no.h5", status=2).stderr
    third = FEW // 3
    check(f"found no part with {third} of {FEW} realisations: 0:{third}" in said, f"a gap: {said}")


def memory():
    """Samples over many geometries: no more memory for 1500 realisations than for 300, but what is
    remembered of them, some 5 MB. With malloc's own heap it was 69 kB each, 83 MB."""
    def peak(count):
        words = command("study", ROOT / "scenarios/studies/known_answer.toml", "-o", "known.h5", "--fresh",
                        "-q", "--threads", 1, "--set", f"study.realisations={count}")
        job = subprocess.Popen(words)
        _, status, usage = os.wait4(job.pid, 0)
        check(status == 0, f"known_answer: status {status}")
        return usage.ru_maxrss / 1024
    few, many = peak(300), peak(1500)
    check(many - few < 20, f"memory grows: {few:.0f} MB for 300 realisations, {many:.0f} for 1500")
    print(f"{few:.0f} MB for 300 realisations, {many:.0f} for 1500")


def time_series():
    """Read as anybody would: out of the file alone. Rates differ; the echo lies where its time says."""
    run("study", "study.toml", "-o", "s.h5", "-q", "--set", "study.realisations=4",
        "--set", 'vary."pings.baseband_rate"={law="list", values=[3000.0, 4000.0]}',
        "--set", 'measure={echo_time=true, time_series="all"}',
        "--set", "transmitter.source_level_db=260")
    with h5py.File("s.h5") as f:
        series = f["time_series"]
        for k, index in enumerate(series["index"][:]):
            samples = series["pressure"][k, 0, :series["valid_samples"][k]]
            p = np.hypot(samples[:, 0], samples[:, 1])
            t = series["start"][k] + np.arange(len(p)) / series["sample_rate"][k]
            into = t - f["table/echo_time"][index]
            # A pulse of 0.1 s, 46 dB over the noise; its flanks ring for some 1/rate.
            quiet = p[(into < -0.02) | (into > 0.12)].max()
            check(p[(into > 0.01) & (into < 0.09)].min() > 5 * quiet, f"time series {index}: no echo")
            check(series["carrier"][k] > 0, "time series: no carrier")
        check(len(set(series["sample_rate"][:])) == 2, "time series: one rate")
        rate = [f["table/baseband_rate"].attrs[key].decode() for key in ("units", "long_name")]  # of the description
        check(rate == ["Hz", "pings.baseband_rate: sample rate of complex samples"], f"a drawn column: {rate}")
        check(f["run/reuse/legs_searched"].shape == (4,), "run/reuse: not a value a row")
    print("time series: found in the file")


def interrupted():
    run_ = start("study", "study.toml", "-o", "i.h5", "--threads", 2)
    wait_for_journal("i.h5.journal", run_)
    run_.send_signal(signal.SIGINT)
    said = run_.communicate()[1]
    check(run_.returncode == 1, f"SIGINT: status {run_.returncode}: {said}")
    check("i.h5.journal holds them, and the same command goes on" in said, f"SIGINT: said {said}")
    check(not Path("i.h5").exists(), "SIGINT: a file under the final name")
    run("study", "study.toml", "-o", "i.h5", "--assemble", "-q")
    check("not complete" in run("info", "i.h5").stdout, "a file of what is there: info")
    run("study", "study.toml", "-o", "i.h5", "-q")
    same("i.h5", "interrupted and continued")


def killed():
    """Rows that were committed a second before a kill are there after it.

    --retry: a kill from outside, twice while the same row is made, looks like a row that kills.
    """
    kept = 0
    for k in range(KILLS):
        run_ = start("study", "study.toml", "-o", "k.h5", "--threads", 1 + k % 3, "--retry", "-q")
        wait_for_journal("k.h5.journal", run_)
        time.sleep(random.uniform(0.0, 1.0 / KILLS))
        run_.kill()
        run_.communicate()
        if Path("k.h5").exists():  # it had been done
            break
        now = rows_in("k.h5.journal")
        check(now >= kept, f"kill {k}: {kept} rows had been there, now {now}")
        kept = now
    run("study", "study.toml", "-o", "k.h5", "--retry", "-q")
    same("k.h5", f"killed {KILLS} times, {kept} rows kept")


def by_mpi():
    if not ASDIC_MPI.exists():
        print("no asdic-mpi: left out")
        return
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")

    def mpirun(ranks, *more, study="study.toml"):
        words = ["mpirun", "--oversubscribe", "-n", str(ranks),
                 *command("study", study, "-o", "m.h5", "-q", *more, program=ASDIC_MPI)]
        return subprocess.Popen(words, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
                                env=environment)
    for ranks in (2, 4):
        job = mpirun(ranks, study="few.toml")
        said = job.communicate()
        check(job.returncode == 0, f"mpirun -n {ranks}: {said}")
        same("m.h5", f"mpirun -n {ranks}", "few.h5")
        Path("m.h5").unlink()
    enough_by_mpi(environment)
    stopped_by_mpi(mpirun)
    silent_rank(mpirun)
    job = mpirun(3)
    wait_for_journal("m.h5.rank1.journal", job)
    ranks = ranks_of(job)
    check(len(ranks) == 3, f"ranks of mpirun: {ranks}")
    os.kill(ranks[-1], signal.SIGKILL)
    said = job.communicate()
    check(job.returncode != 0, "a dead rank: status 0")
    check("exited on signal 9" in said[1] + said[0], f"a dead rank: said {said}")
    check(not Path("m.h5").exists(), "a dead rank: a file under the final name")
    kept = rows_in("m.h5.rank*.journal")
    check(kept > 0, "a dead rank: nothing was kept")
    job = mpirun(2)
    check(job.wait() == 0, f"after a dead rank: {job.communicate()}")
    same("m.h5", f"mpirun -n 3, a rank killed, {kept} rows kept, then -n 2")


def enough_by_mpi(environment):
    """A wanted width is looked at after the same realisations by ranks and by threads."""
    Path("enough.toml").write_text(STUDY.replace("series_level = true", "").replace("COUNT", "5000"))
    words = ["study", "enough.toml", "--until", 0.3, "-q", "-o"]
    run(*words, "one.h5")
    ranks = ["mpirun", "--oversubscribe", "-n", "3", *command(*words, "ranks.h5", program=ASDIC_MPI)]
    job = subprocess.run(ranks, capture_output=True, text=True, env=environment)
    check(job.returncode == 0, f"--until by mpirun: {job.stderr}")
    with h5py.File("one.h5") as one:
        check(100 <= len(one["index"]) < 5000, f"--until: {len(one['index'])} realisations")
    different = differences("one.h5", "ranks.h5")
    check(not different, f"--until by mpirun: {different} differ")
    print("--until by mpirun -n 3: the same bits")


def stopped_by_mpi(mpirun):
    """All ranks are told to end: the message names the journals that are there."""
    job = mpirun(3)
    wait_for_journal("m.h5.rank1.journal", job)
    for rank in ranks_of(job):
        os.kill(rank, signal.SIGTERM)
    said = job.communicate()[1]
    check(job.returncode != 0, "ranks told to end: status 0")
    check("; m.h5.rank*.journal hold what was made, and the same command goes on" in said,
          f"ranks told to end: said {said}")
    check("m.h5.journal" not in said, f"ranks told to end: a journal that is not there: {said}")
    check(rows_in("m.h5.rank*.journal") > 0, "ranks told to end: nothing was kept")
    for journal in Path(".").glob("m.h5.rank*.journal*"):
        journal.unlink()


def silent_rank(mpirun):
    """A rank that hangs: the others do not wait for it for ever."""
    job = mpirun(3, "--silence", 2)
    wait_for_journal("m.h5.rank2.journal", job)
    os.kill(ranks_of(job)[-1], signal.SIGSTOP)
    said = job.communicate(timeout=120)[1]
    check(job.returncode != 0, "a silent rank: status 0")
    check(re.search(r"rank \d has not reported for 2 s: it is taken for dead", said),
          f"a silent rank: said {said}")
    check(rows_in("m.h5.rank*.journal") > 0, "a silent rank: nothing was kept")
    job = mpirun(2)
    check(job.wait() == 0, f"after a silent rank: {job.communicate()}")
    same("m.h5", "mpirun -n 3, a rank stopped, then -n 2")
    Path("m.h5").unlink()


def ranks_of(job):
    """The processes of mpirun, the highest last."""
    pids = subprocess.run(["pgrep", "-P", str(job.pid)], capture_output=True, text=True).stdout
    return [int(pid) for pid in pids.split()]


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        Path("few.toml").write_text(STUDY.replace("COUNT", str(FEW)))
        Path("study.toml").write_text(STUDY.replace("COUNT", str(COUNT)))
        run("study", "study.toml", "-o", "whole.h5", "-q")
        threads_and_parts()
        time_series()
        memory()
        interrupted()
        killed()
        by_mpi()
        os.chdir("/")

#!/usr/bin/env python3
"""How much time processes lose that make one study together, measured on this machine: rows sleep instead of computing
(sleep.c beside this), so that 64 processes find 64 cores. Beside each figure stands the model's (model.py).

    scripts/cluster/measure.py [--asdic build/release/bin/asdic] [--processes 1,8,64] [--rows 60] [--seconds 0.05]
"""
import argparse
import os
import subprocess
import tempfile
import time
from pathlib import Path

import model

ROOT = Path(__file__).resolve().parents[2]


def files(folder, count=2000):
    """→ seconds of a step of the board (make a file under another name, link, unlink it, and rename), of a commit"""
    begin = time.perf_counter()
    for k in range(count):
        part, taken, done = (folder / f"{k}.{what}" for what in ("part", "taken", "done"))
        part.write_text("1")
        os.link(part, taken)
        part.unlink()
        taken.rename(done)
    step = (time.perf_counter() - begin) / count
    begin = time.perf_counter()
    with open(folder / "journal", "wb") as journal:
        for _ in range(20):
            journal.write(bytes(4096))
            journal.flush()
            os.fsync(journal.fileno())
    return step, (time.perf_counter() - begin) / 20


def run(words, environment, folder, processes, mpi):
    begin = time.monotonic()
    if mpi:
        jobs = [subprocess.Popen(["mpirun", "--oversubscribe", "--allow-run-as-root", "-n", str(processes), *words],
                                 env=environment, cwd=folder, stdout=subprocess.DEVNULL)]
    else:
        jobs = [subprocess.Popen(words, env=environment, cwd=folder, stdout=subprocess.DEVNULL)
                for _ in range(processes)]
    states = [job.wait() for job in jobs]
    if any(states):
        raise SystemExit(f"{words[0]}: exit status {states}")
    return time.monotonic() - begin


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--asdic", default=str(ROOT / "build/release/bin/asdic"))
    parser.add_argument("--processes", default="1,8,64")
    parser.add_argument("--rows", type=int, default=60, help="of each process")
    parser.add_argument("--seconds", type=float, default=0.05, help="of a row")
    options = parser.parse_args()
    program = Path(options.asdic).resolve()
    environment = dict(os.environ, ASDIC_ROW_SECONDS=str(options.seconds), OMPI_MCA_mpi_yield_when_idle="1")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        shim = folder / "sleep.so"
        subprocess.run(["cc", "-O2", "-shared", "-fPIC", "-o", shim, Path(__file__).with_name("sleep.c"), "-ldl"],
                       check=True)
        (folder / "steps").mkdir()
        step, commit = files(folder / "steps")
        print(f"step of the board {1e6 * step:.0f} us, commit {1e3 * commit:.1f} ms")
        environment["LD_PRELOAD"] = str(shim)
        study = [str(ROOT / "scenarios/studies/known_answer.toml"), "--threads", "1", "--quiet"]
        print("way    processes   rows/s   of all, measured   of all, by the model")
        for mpi in (False, True):
            tool = program.with_name("asdic-mpi") if mpi else program
            if not tool.exists():
                continue
            for count in map(int, options.processes.split(",")):
                rows = options.rows * count
                words = [str(tool), "study", *study, "--set", f"study.realisations={rows}", "-o",
                         f"{tool.name}{count}.h5", *([] if mpi else ["--join"])]
                # what a process takes to begin and to end is not of the model
                few = [w.replace(f"realisations={rows}", f"realisations={count}").replace(".h5", "few.h5")
                       for w in words]
                empty = run(few, environment, folder, count, mpi) - options.seconds
                took = run(words, environment, folder, count, mpi) - empty
                share = rows * options.seconds / count / took
                told = model.efficiency("mpi" if mpi else "join", count, rows, options.seconds, step=step,
                                        commit=commit)
                print(f"{'MPI' if mpi else '--join':7}{count:9}{rows / took:9.0f}{share:19.3f}{told:23.3f}", flush=True)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""A model of many processes that make one study: how much of their time they spend on rows.

Two ways. `join`: processes take blocks in a folder; the folder does one step at a time. `mpi`: rank 0 deals blocks and
takes rows; it does one message at a time, and takes part in the work. Each process makes its rows one after the other
(with k threads a row takes a k-th); rows take a random time (log-normal, of deviation `spread` of its mean). The
simulation is by events: a process comes for a block, waits for its turn, works, comes again.

    scripts/cluster/model.py            the table of docs/guide/cluster.md
"""
import argparse
import heapq
import math
import random

STEP = 60e-6      # of the folder, for a block: make, link, unlink, rename. A local disk [s]
MESSAGE = 5e-6    # of rank 0: to receive, unpack and answer [s]
ROW = 1e-6        # of rank 0, to take a row's answer [s]
TELL = 0.2        # ranks send their rows so often [s]
LARGEST = 256     # rows of a block that rank 0 deals
PAUSE = 1e-3      # between two looks of a rank at its messages [s]
ASSEMBLY = 30e-6  # for one process alone to make the file of all rows and their summary, a row [s]


def block_of_join(rows):
    """Rows of a block in the folder, as BlockBoard::block_size"""
    blocks = min(max(rows // 64, 4096), 65536)
    return max(1, -(-rows // blocks))


def least_block(processes, seconds, deal=MESSAGE * 2, load=0.0):
    """The block, in rows, from which on whoever deals does not limit: λt < 1, λ = P/(B t_row)"""
    return max(1.0, processes * deal / (seconds * max(1e-9, 1.0 - load)))


def load_of_dealer(processes, seconds):
    """The share of rank 0's time that goes to rows' messages and rows, whatever the blocks"""
    return processes * (MESSAGE / TELL + ROW / seconds)


def duration(rows, seconds, spread, chance):
    """Of so many rows one after the other: a gamma law of their sum's mean and deviation"""
    if spread <= 0.0:
        return rows * seconds
    shape = rows / spread ** 2
    return chance.gammavariate(shape, rows * seconds / shape)


def of_commits(processes, commit, every=0.5):
    """The share of time that is left beside commits of journals, one disk doing one at a time: no process commits
    sooner than half a second after its last, and all of them no sooner than the disk can"""
    return min(every / (every + commit), every / max(1e-12, processes * commit))


def efficiency(way, processes, rows, seconds, spread=0.0, step=STEP, message=MESSAGE, commit=0.0, seed=1):
    """→ the time of all rows over the time of all processes until the last one has ended"""
    chance = random.Random(seed)
    left, free = rows, 0.0              # rows that nobody has; when whoever deals is free again
    load = load_of_dealer(processes, seconds) if way == "mpi" else 0.0
    if load >= 1.0:                     # it cannot keep up: rows pile up, and all wait for it
        return 1.0 / load
    serve = step if way == "join" else 2.0 * message / (1.0 - load)
    coming = [(chance.random() * PAUSE, k) for k in range(processes)]
    heapq.heapify(coming)
    end = 0.0
    size = block_of_join(rows)
    while coming:
        now, who = heapq.heappop(coming)
        if left == 0:
            continue
        take = size if way == "join" else min(max(left // (8 * processes), 1), LARGEST)
        take = min(take, left)
        left -= take
        free = max(free, now) + serve
        # a rank asks before it has run out, and sees the answer at its next look
        begin = free if way == "join" else max(now, free + PAUSE * chance.random() - 4 * seconds)
        done = begin + duration(take, seconds, spread, chance)
        end = max(end, done)
        heapq.heappush(coming, (done, who))
    waits = of_commits(processes, commit) if way == "join" else 1.0  # ranks commit beside their work
    return rows * seconds / (processes * end) * waits


def main():
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    print("| rows | a row takes | processes | rows take | `--join` | MPI | least block (MPI) | the file takes |")
    print("|---|---|---|---|---|---|---|---|")
    for rows, seconds in ((10 ** 6, 0.1), (10 ** 6, 1.0), (10 ** 7, 0.1), (10 ** 7, 1.0)):
        for processes in (64, 1000, 10000):
            join, mpi = (efficiency(way, processes, rows, seconds, spread=1.0) for way in ("join", "mpi"))
            load = load_of_dealer(processes, seconds)
            block = math.ceil(least_block(processes, seconds, load=load)) if load < 1.0 else "none"
            print(f"| 10^{len(str(rows)) - 1} | {seconds:g} s | {processes} | {rows * seconds / processes:.0f} s | "
                  f"{100 * join:.0f} % | {100 * mpi:.0f} % | {block} | {rows * ASSEMBLY:.0f} s |")


if __name__ == "__main__":
    main()

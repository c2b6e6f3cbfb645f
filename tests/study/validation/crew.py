#!/usr/bin/env python3
"""`asdic study --join`: processes that come, go, are killed and stand still make one study. And a Slurm job array
whose tasks are taken away and queued again, by a stand-in of `sbatch`.

Truth: the file of one process. Everything outside of /run is the same, to the last bit.

    ASDIC=build/ci/bin/asdic crew.py
"""
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[3]
ASDIC = str(Path(os.environ["ASDIC"]).resolve())
STUDY = ROOT / "scenarios" / "studies" / "known_answer.toml"
ROWS = 3000
COMMAND = [ASDIC, "study", str(STUDY), "--set", f"study.realisations={ROWS}", "--threads", "1"]


def check(passed, what):
    if not passed:
        raise SystemExit(f"crew.py: {what}")


def contents(path):
    """→ {dataset: bytes} outside of /run, and the attributes of the root"""
    found = {}
    with h5py.File(path) as f:
        def note(name, thing):
            if isinstance(thing, h5py.Dataset) and not name.startswith("run"):
                value = thing[()]
                found[name] = value.tobytes() if isinstance(value, np.ndarray) else value
        f.visititems(note)
        found["identity"], found["complete"] = f.attrs["identity"], f.attrs["complete"]
    return found


def join(folder, **options):
    return subprocess.Popen([*COMMAND, "-o", "study.h5", "--join", "--silence", "3"], cwd=folder, text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)


def rows_done(folder):
    return len(list(folder.glob("study.h5.crew/*.done")))


def wait_for(folder, blocks):
    end = time.monotonic() + 120.0
    while rows_done(folder) < blocks and (folder / "study.h5.crew").exists():
        check(time.monotonic() < end, f"{rows_done(folder)} blocks after two minutes")
        time.sleep(0.02)


def they_come_and_go(folder, truth):
    first = join(folder)
    wait_for(folder, 20)
    killed, told, stopped = join(folder), join(folder), join(folder)
    wait_for(folder, 400)
    killed.send_signal(signal.SIGKILL)
    told.send_signal(signal.SIGTERM)
    stopped.send_signal(signal.SIGSTOP)  # it seems to be gone, and comes back
    wait_for(folder, 800)
    late = join(folder)
    wait_for(folder, 1000)
    stopped.send_signal(signal.SIGCONT)
    said = [one.communicate(timeout=300) for one in (first, late, stopped)]
    check([one.returncode for one in (first, late, stopped)] == [0, 0, 0], said)
    check(killed.wait() == -signal.SIGKILL and told.wait() != 0, "killed and told to end")
    check("another process" in "".join(out for out, _ in said), f"one makes the file: {said}")
    check(contents(folder / "study.h5") == truth, "the bits of one process")
    check(not list(folder.glob("study.h5.*")), f"nothing is left: {list(folder.iterdir())}")
    again = subprocess.run([*COMMAND, "-o", "study.h5", "--join"], cwd=folder, capture_output=True, text=True)
    check(again.returncode == 0 and "complete already" in again.stdout, again)


def the_last_one_dies(folder, truth):
    """All are killed; whoever comes later goes on with what they have made."""
    crew = [join(folder), join(folder)]
    wait_for(folder, 300)
    for one in crew:
        one.kill()
        one.communicate()
    made = rows_done(folder)
    last = join(folder)
    out, err = last.communicate(timeout=300)
    check(last.returncode == 0, err)
    check(contents(folder / "study.h5") == truth, "the bits of one process")
    own = next(int(line.split()[0]) for line in out.splitlines() if "realisations in" in line)
    check(own <= ROWS - made, f"{own} made again, {made} blocks were done")


SBATCH = """#!/bin/bash
# A stand-in for Slurm's: the tasks of --array=FIRST-LAST, three at a time; one that is taken away (exit status
# 137) is queued again, as --requeue has it.
for word; do case "$word" in --array=*) range=${word#--array=};; *.sh) script=$word;; esac; done
task() {
  export SLURM_ARRAY_TASK_ID=$1 SLURM_ARRAY_TASK_MIN=${range%-*} SLURM_ARRAY_TASK_COUNT=$((${range#*-} - ${range%-*} + 1))
  bash "$script"
  while [ $? = 137 ]; do bash "$script"; done
}
for ((i = ${range%-*}; i <= ${range#*-}; ++i)); do
  task "$i" &
  while [ "$(jobs -rp | wc -l)" -ge 3 ]; do wait -n; done
done
wait
"""


def by_slurm(folder, truth):
    (folder / "sbatch").write_text(SBATCH)
    (folder / "sbatch").chmod(0o755)
    # The second task is taken away at its first try, after half a second.
    words = " ".join(f"'{word}'" for word in COMMAND)
    (folder / "job.sh").write_text(f"""#!/bin/bash
#SBATCH --requeue
if [ "$SLURM_ARRAY_TASK_ID" = 2 ] && [ ! -e taken ]; then
  touch taken
  exec timeout -s KILL 0.5 {words} -o study.h5 --join --silence 3
fi
exec {words} -o study.h5 --join --silence 3
""")
    done = subprocess.run(["./sbatch", "--array=1-4", "job.sh"], cwd=folder, capture_output=True, text=True, timeout=300)
    check(done.returncode == 0, done)
    check((folder / "taken").exists(), "a task was taken away")
    check(contents(folder / "study.h5") == truth, f"the bits of one process\n{done.stdout}{done.stderr}")


def started(folder, _):
    return subprocess.run([*COMMAND, "-o", "study.h5", "--join", "--quiet"], cwd=folder, check=True).returncode


def by_dask(folder, truth):
    """As docs/guide/cluster.md has it: workers of a cluster of Dask start them."""
    from dask.distributed import Client, LocalCluster
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
        futures = client.map(started, [str(folder)] * 4, range(4), pure=False)
        check(client.gather(futures) == [0] * 4, "all end well")
    check(contents(folder / "study.h5") == truth, "the bits of one process")


def main():
    with tempfile.TemporaryDirectory() as name:
        home = Path(name)
        subprocess.run([*COMMAND, "-o", "truth.h5", "--quiet"], cwd=home, check=True)
        truth = contents(home / "truth.h5")
        for part in (they_come_and_go, the_last_one_dies, by_slurm, by_dask):
            folder = home / part.__name__
            folder.mkdir()
            begun = time.monotonic()
            part(folder, truth)
            print(f"{part.__name__}: as one process, {time.monotonic() - begun:.1f} s", file=sys.stderr)
    print("crew: all as it should be")


if __name__ == "__main__":  # workers of Dask import this
    main()

# Shared by tests/app/validation/cli_interrupt.sh and scripts/deep_check.sh: what an interrupted run may leave behind.
# Wants $ASDIC, the program. Sourced, not run.

fail() { echo "FAILED: $*" >&2; exit 1; }

# A sequence of pings, each long enough to be interrupted. interrupt_scenario FILE
interrupt_scenario() {
  cat >"$1" <<'TOML'
title = "a sequence to interrupt"
[environment.sound_speed]
kind = "munk"
[environment.bottom]
depth = 5000.0
kind = "rigid"
[platform]
position = [0.0, 0.0, 1000.0]
velocity = [2.0, 0.0, 0.0]
[transmitter]
source_level_db = 210.0
taper = "omnidirectional"
[pulse]
kind = "cw"
frequency = 2000.0
duration = 0.5
[array]
kind = "horizontal"
phones = 8
spacing = 0.375
[[target]]
position = [20000.0, 0.0, 200.0]
velocity = [-2.0, 0.0, 0.0]
strength_db = 20.0
[noise]
spectral_level_db = 40.0
[reverberation]
enabled = false
[propagation]
max_surface_bounces = 1
max_bottom_bounces = 1
[pings]
count = 2000
interval = 40.0
recording_duration = 30.0
sample_rate = 8000.0
TOML
}

# A program in the background; its id in $run. (A job of a script ignores SIGINT unless told otherwise.) start WORDS
start() {
  /usr/bin/python3 -c 'import os, signal, sys
signal.signal(signal.SIGINT, signal.SIG_DFL)
os.execv(sys.argv[1], sys.argv[1:])' "$@" &
  run=$!
}

# Waits for a state of the program $run, not for a time: for ever, but for a minute. wait_until WHAT CONDITION…
wait_until() {
  local what=$1 end=$((SECONDS + 60))
  shift
  until "$@"; do
    kill -0 "$run" 2>/dev/null || fail "the program ended before $what"
    [ $SECONDS -lt $end ] || fail "not after a minute: $what"
    sleep 0.002
  done
}

# The part of RESULT that is being written, or was left; "" if there is none. part_of RESULT
part_of() {
  local part
  for part in "$1".????.part; do
    [ -e "$part" ] && echo "$part"
  done
  return 0
}

# Waits until the part of RESULT counts a ping, as a reader finds it while the program $run writes: for ever, but for a minute.
# wait_for_ping RESULT
wait_for_ping() {
  HDF5_USE_FILE_LOCKING=FALSE /usr/bin/python3 - "$1" "$run" <<'PY' || fail "no ping in $1: the program ended, or a minute is over"
import glob
import os
import sys
import time
import h5py
end = time.monotonic() + 60.0
while time.monotonic() < end:
    os.kill(int(sys.argv[2]), 0)  # fails when it is gone
    try:
        for part in glob.glob(glob.escape(sys.argv[1]) + ".????.part"):
            with h5py.File(part, "r") as f:
                if f["ping"].shape[0] > 0:
                    sys.exit(0)
    except (OSError, KeyError, RuntimeError):
        pass  # not there yet, or in the middle of a change
    time.sleep(0.002)
sys.exit(1)
PY
}

# The program $run has taken the SIGINT that it was sent: its handler is gone, or it is gone itself. A second one sent
# before that would be one with the first.
sigint_was_taken() {
  local caught
  caught=$(sed -n 's/^SigCgt:\t//p' "/proc/$run/status" 2>/dev/null) || return 0
  [ -z "$caught" ] || [ $((16#$caught & 2)) = 0 ]
}

# The file opens elsewhere too, and every ping that it counts is whole. h5py_reads FILE
h5py_reads() {
  /usr/bin/python3 - "$1" <<'PY'
import sys
import h5py
import numpy as np
with h5py.File(sys.argv[1], "r") as f:
    n = f["ping"].shape[0]
    assert (f["ping"][:] == np.arange(1, n + 1)).all(), "pings are not 1, 2, ..."
    for name in ("pressure", "valid_samples", "ping_time", "summary/paths", "levels/echo"):
        assert n == 0 or f[name].shape[0] >= n, f"{name} has fewer rows than there are pings"
    for i in {0, n - 1} if n else ():
        assert np.isfinite(f["pressure"][i]).all() and (f["pressure"][i] != 0).any(), "an empty ping"
    print(n)
PY
}

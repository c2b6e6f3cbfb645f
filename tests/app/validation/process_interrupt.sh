#!/usr/bin/env bash
# What a stop in the middle of `asdic process` leaves behind: the ping file, whole, with its data as they were.
#   ASDIC=path/to/asdic tests/app/validation/process_interrupt.sh
set -euo pipefail
: "${ASDIC:?the program to test}"
source "$(dirname "$0")/../../support/interrupt.sh"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cp scenarios/two_targets.toml "$folder"
cd "$folder"
"$ASDIC" ping two_targets.toml -o a.h5 -q --set pings.count=6 --set pings.recording_duration=5

# Everything but /processed, as one number.
digest() {
  /usr/bin/python3 - "$1" <<'PY'
import hashlib, sys, h5py
total = hashlib.sha256()
with h5py.File(sys.argv[1]) as f:
    def add(name, item):
        if isinstance(item, h5py.Dataset) and not name.startswith("processed"):
            total.update(name.encode() + str(item[()].tobytes() if item.shape != () else item[()]).encode())
    f.visititems(add)
print(total.hexdigest())
PY
}
before=$(digest a.h5)

# process: a run in the background; its id in $run.
process() { start "$ASDIC" process a.h5 --target-depth 125m >out 2>err; }

# Ctrl-C: one line, status 1, the file as it was.
process
sleep 0.15
kill -INT "$run" 2>/dev/null || true
status=0
wait "$run" || status=$?
if [ "$status" != 0 ]; then
  [ "$status" = 1 ] || [ "$status" = 130 ] || fail "SIGINT: exit status $status"
  [ "$status" = 130 ] || grep -q "interrupted; a.h5 is as it was" err || fail "SIGINT: said $(cat err)"
fi
[ "$(digest a.h5)" = "$before" ] || fail "SIGINT changed the data"

# Killed at any moment: the data are the same, and what is there of results is whole.
delays="0.05 0.25 0.6"
[ "${ASDIC_DEEP:-}" != 1 ] || delays="0.05 0.15 0.25 0.35 0.45 0.6"
for delay in $delays; do
  process
  sleep "$delay"
  kill -KILL "$run" 2>/dev/null || true
  wait "$run" 2>/dev/null || true
  [ "$(digest a.h5)" = "$before" ] || fail "SIGKILL after $delay s changed the data"
done

# And after all that it still works; what kills left of the copies stays, and nothing is added.
rm -f a.h5.????.part
"$ASDIC" process a.h5 --target-depth 125m -q || fail "it does not run any more"
[ "$(digest a.h5)" = "$before" ] || fail "processing changed the data"
[ -z "$(part_of a.h5)" ] || fail "$(part_of a.h5) was left"

# A full disk (a limit on the size of files): told, and nothing is lost.
if (ulimit -f 1000; "$ASDIC" process a.h5 --target-depth 125m -q) 2>err; then fail "a full disk was not noticed"; fi
grep -q "a.h5.....\.part" err || fail "a full disk: said $(cat err)"
[ "$(digest a.h5)" = "$before" ] || fail "a full disk changed the data"
[ -z "$(part_of a.h5)" ] || fail "a full disk left $(part_of a.h5)"
echo "interrupted, killed and out of space: the data survive"

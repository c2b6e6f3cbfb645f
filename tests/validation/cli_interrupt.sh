#!/usr/bin/env bash
# What Ctrl-C and a kill leave behind: a file under its final name is always readable and says whether it is complete.
#   ASDIC=path/to/asdic tests/validation/cli_interrupt.sh
set -euo pipefail
: "${ASDIC:?the program to test}"
source "$(dirname "$0")/../support/interrupt.sh"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
interrupt_scenario run.toml

# start NAME: a run in the background; its id in $run. (A job of a script ignores SIGINT unless told otherwise.)
start() {
  /usr/bin/python3 -c 'import os, signal, sys
signal.signal(signal.SIGINT, signal.SIG_DFL)
os.execv(sys.argv[1], sys.argv[1:])' "$ASDIC" ping run.toml -o "$1.h5" >"$1.out" 2>"$1.err" &
  run=$!
}

# Ctrl-C, and SIGTERM: the pings in hand are finished, the file gets its name, the status is 1.
for signal in INT TERM; do
  start "$signal"
  wait_for_ping "$signal.h5.part"
  kill -"$signal" "$run"
  status=0
  wait "$run" || status=$?
  [ "$status" = 1 ] || fail "SIG$signal: exit status $status, expected 1"
  [ ! -e "$signal.h5.part" ] || fail "SIG$signal left $signal.h5.part"
  pings=$(h5py_reads "$signal.h5")
  [ "$pings" -ge 1 ] || fail "SIG$signal: no ping in the file"
  grep -qx "asdic: interrupted after $pings of 2000 pings; $signal.h5 holds them, marked as not complete" "$signal.err" ||
    fail "SIG$signal: said $(cat "$signal.err")"
  "$ASDIC" info "$signal.h5" | grep -q "not complete: $pings of 2000 pings" || fail "info does not tell"
  echo "SIG$signal: $pings pings kept, and said so"
done

# A second Ctrl-C ends the program at once; what was done stays in NAME.part.
start twice
wait_for_ping twice.h5.part
kill -INT "$run"
sleep 0.04
kill -INT "$run" 2>/dev/null || true
status=0
wait "$run" || status=$?
if [ "$status" = 130 ]; then
  [ ! -e twice.h5 ] || fail "the second Ctrl-C left twice.h5"
  echo "second SIGINT: ended at once, $(h5py_reads twice.h5.part) pings in twice.h5.part"
else # the pings in hand were done within those 0.04 s
  [ "$status" = 1 ] || fail "two signals: exit status $status"
  h5py_reads twice.h5 >/dev/null
  echo "second SIGINT: came after the end"
fi

# kill -9: nothing under the final name; NAME.part can be read.
for delay in 0.0 0.13 0.29; do
  rm -f killed.h5.part
  start killed
  wait_for_ping killed.h5.part
  sleep "$delay"
  kill -KILL "$run"
  wait "$run" 2>/dev/null || true
  [ ! -e killed.h5 ] || fail "kill -9 left killed.h5"
  pings=$(h5py_reads killed.h5.part)
  [ "$pings" -ge 1 ] || fail "kill -9: the pings that were written cannot be read"
  "$ASDIC" info killed.h5.part >info.out || fail "asdic info cannot read killed.h5.part"
  echo "kill -9 after $delay s more: $pings pings in killed.h5.part"
done

# Ctrl-C as soon as the file is there: the pings in hand, or no file at all.
sed -e 's/phones = 8/phones = 64/' run.toml >slow.toml
mv slow.toml run.toml
start early
for ((i = 0; i < 200; ++i)); do
  [ -e early.h5.part ] && break
  sleep 0.005
done
kill -INT "$run"
status=0
wait "$run" || status=$?
[ "$status" = 1 ] || fail "early SIGINT: exit status $status, expected 1"
[ "$(wc -l <early.err)" = 1 ] || fail "early SIGINT: said $(cat early.err)"
[ ! -e early.h5.part ] || fail "early SIGINT left early.h5.part"
echo "early SIGINT: $(cat early.err)"

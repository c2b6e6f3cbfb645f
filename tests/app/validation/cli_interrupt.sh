#!/usr/bin/env bash
# What Ctrl-C and a kill leave behind: a file under its final name is always readable and says whether it is complete.
#   ASDIC=path/to/asdic tests/app/validation/cli_interrupt.sh
set -euo pipefail
: "${ASDIC:?the program to test}"
source "$(dirname "$0")/../../support/interrupt.sh"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
interrupt_scenario run.toml

# ping NAME: a run in the background; its id in $run.
ping() { start "$ASDIC" ping run.toml -o "$1.h5" >"$1.out" 2>"$1.err"; }

# Ctrl-C, and SIGTERM: what is done is kept, the file gets its name, the status is 1.
for signal in INT TERM; do
  ping "$signal"
  wait_for_ping "$signal.h5"
  kill -"$signal" "$run"
  status=0
  wait "$run" || status=$?
  [ "$status" = 1 ] || fail "SIG$signal: exit status $status, expected 1"
  [ -z "$(part_of "$signal.h5")" ] || fail "SIG$signal left $(part_of "$signal.h5")"
  pings=$(h5py_reads "$signal.h5")
  [ "$pings" -ge 1 ] || fail "SIG$signal: no ping in the file"
  grep -qx "asdic: interrupted after $pings of 2000 pings; $signal.h5 holds them, marked as not complete" "$signal.err" ||
    fail "SIG$signal: said $(cat "$signal.err")"
  "$ASDIC" info "$signal.h5" | grep -q "not complete: $pings of 2000 pings" || fail "info does not tell"
  echo "SIG$signal: $pings pings kept, and said so"
done

# A second Ctrl-C ends the program at once; what was done stays in its part, unless that had just got its name.
ping twice
wait_for_ping twice.h5
kill -INT "$run"
until sigint_was_taken; do :; done
kill -INT "$run" 2>/dev/null || true
status=0
wait "$run" || status=$?
left=$(ls twice.h5 2>/dev/null || part_of twice.h5)
[ "$left" = twice.h5 ] || [ "$left" = "$(part_of twice.h5)" ] || fail "two signals left \"$left\""
if [ "$status" = 130 ]; then
  echo "second SIGINT: ended at once, $(h5py_reads "$left") pings in $left"
else # the pings in hand were done before it came
  [ "$status" = 1 ] || fail "two signals: exit status $status"
  [ "$left" = twice.h5 ] || fail "two signals left $left"
  h5py_reads twice.h5 >/dev/null
  echo "second SIGINT: came after the end"
fi

# kill -9: nothing under the final name; its part can be read.
for delay in 0.0 0.13 0.29; do
  rm -f killed.h5.????.part
  ping killed
  wait_for_ping killed.h5
  sleep "$delay"
  kill -KILL "$run"
  wait "$run" 2>/dev/null || true
  [ ! -e killed.h5 ] || fail "kill -9 left killed.h5"
  part=$(part_of killed.h5)
  pings=$(h5py_reads "$part")
  [ "$pings" -ge 1 ] || fail "kill -9: the pings that were written cannot be read"
  "$ASDIC" info "$part" >info.out || fail "asdic info cannot read $part"
  echo "kill -9 after $delay s more: $pings pings in $part"
done

# Ctrl-C as soon as the file is there: the pings that are done, or no file at all.
sed -e 's/phones = 8/phones = 64/' run.toml >slow.toml
mv slow.toml run.toml
ping early
wait_until "its file was there" eval '[ -n "$(part_of early.h5)" ]'
kill -INT "$run"
status=0
wait "$run" || status=$?
[ "$status" = 1 ] || fail "early SIGINT: exit status $status, expected 1"
[ "$(grep -vc "^asdic: \(stopping\|warning:\) " early.err)" = 1 ] || fail "early SIGINT: said $(cat early.err)"
[ -z "$(part_of early.h5)" ] || fail "early SIGINT left $(part_of early.h5)"
echo "early SIGINT: $(cat early.err)"

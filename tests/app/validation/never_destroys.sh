#!/usr/bin/env bash
# What asdic does to files that are not its own: nothing. Real processes, racing, killed, with closed descriptors, and as
# root on a device made for it.
#   ASDIC=path/to/asdic tests/app/validation/never_destroys.sh
set -euo pipefail
: "${ASDIC:?the program to test}"
tests=$(cd "$(dirname "$0")/../.." && pwd)
source "$tests/support/interrupt.sh"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

# refused WORDS… — STATUS and what was said in $said. The command must fail with status 2.
refused() {
  local status=0
  said=$("$ASDIC" "$@" 2>&1 >/dev/null) || status=$?
  [ "$status" = 2 ] || fail "asdic $*: status $status, said: $said"
}
says() { grep -qF -- "$1" <<<"$said" || fail "expected \"$1\", said: $said"; }
same() { [ "$(sha256sum <"$1")" = "$2" ] || fail "$1 was changed by $3"; }

cat >small.toml <<'TOML'
title = "small sea"
[environment.sound_speed]
kind = "table"
file = "cast.csv"
[environment.bottom]
depth = 1000.0
kind = "rigid"
[platform]
position = [0.0, 0.0, 200.0]
[transmitter]
source_level_db = 200.0
taper = "omnidirectional"
[pulse]
kind = "cw"
frequency = 1000.0
duration = 0.1
[array]
kind = "horizontal"
phones = 2
spacing = 0.75
[[target]]
position = [3000.0, 0.0, 500.0]
strength_db = 10.0
[noise]
spectral_level_db = 40.0
[reverberation]
enabled = false
[propagation]
max_surface_bounces = 1
max_bottom_bounces = 1
[pings]
count = 2
interval = 10.0
recording_duration = 5.0
sample_rate = 4000.0
[run]
task = "field"
source = { depth = 100.0 }
receivers = { depth = [100.0, 200.0], range = [500.0, 1000.0] }
TOML
printf 'depth,speed\n0,1500\n1000,1510\n' >cast.csv
cp cast.csv cast.keep

# 1. An input of the run, under any name, is no output, even by force.
before=$(sha256sum <cast.csv)
ln cast.csv hard.csv
for output in cast.csv ./cast.csv hard.csv small.toml; do
  for command in ping field "arrivals --set run.task=arrivals"; do
    refused $command small.toml -o "$output" --force
    says "the input itself"
  done
done
same cast.csv "$before" "an output of that name"
echo "inputs: whole"

# 2. Links, FIFOs and devices are refused; a device of our own making stands for /dev/null.
echo "mine" >outside
ln -s outside link.h5
mkfifo fifo.h5
for output in link.h5 fifo.h5; do
  refused ping small.toml -o "$output" --force
  says "asdic replaces nothing else"
done
[ "$(cat outside)" = mine ] || fail "the file behind a link was changed"
if mknod null c 1 3 2>/dev/null; then
  for words in "ping small.toml" "field small.toml" "rays small.toml --from 0 --to 5 --count 2" "export ping.h5 --wav"; do
    [ "$words" = "export ping.h5 --wav" ] || refused $words -o null --force
  done
  [ -c null ] || fail "the device was replaced"
  echo "links, FIFOs, devices: refused"
else
  echo "links, FIFOs: refused (devices: not as this user)"
fi

# 3. What asdic did not write is written over by force alone; what it wrote, without a word.
"$ASDIC" ping small.toml -o ping.h5 -q
"$ASDIC" ping small.toml -o ping.h5 -q
# foreign FILE WORDS…: the command writes FILE.
foreign() {
  local file=$1 before
  shift
  mkdir -p "$(dirname "$file")"
  rm -f "$file"
  echo "a letter, not a result" >"$file"
  before=$(sha256sum <"$file")
  refused "$@"
  says "which asdic did not write"
  same "$file" "$before" "asdic $*"
  "$ASDIC" "$@" --force >/dev/null || fail "asdic $* --force"
  [ "$(sha256sum <"$file")" != "$before" ] || fail "asdic $* --force wrote nothing"
  "$ASDIC" "$@" >/dev/null || fail "asdic $*: its own $file is not known again"
}
foreign a.h5 ping small.toml -o a.h5 -q
foreign f.h5 field small.toml -o f.h5 -q
foreign f.shd field small.toml -o f.shd -q
foreign r.ray rays small.toml --from 0 --to 5 --count 2 -o r.ray
foreign r.h5 rays small.toml --from 0 --to 5 --count 2 -o r.h5
foreign e.h5 arrivals small.toml -o e.h5
foreign tables/ping_tracks.csv process ping.h5 --csv tables --no-file -q
foreign tables/ping_detections.csv process ping.h5 --csv tables --no-file -q
foreign p.h5 process ping.h5 -o p.h5 -q
foreign sounds/ping_ping001.wav export ping.h5 --wav -o sounds
foreign sounds/ping_ping001.wav.json export ping.h5 --wav -o sounds
foreign c.h5 convert f.shd c.h5 -q
foreign c.shd convert f.h5 c.shd -q
cp "$tests/data/bellhop/munk-coherent-hat/case.env" munk.env
sed -i 's/^ *51 /11 /' munk.env
foreign munk.toml convert munk.env munk.toml -q
foreign back.env convert munk.toml back.env -q
foreign munk.shd bellhop munk -q
foreign munk.prt bellhop munk -q
echo "what asdic did not write: kept"

# 4. Closed descriptors: nothing that is said gets into a file.
for closed in '2>&-' '>&-' '2>&- >&-' '<&- >&- 2>&-'; do
  rm -f closed.h5
  bash -c "exec '$ASDIC' ping small.toml -o closed.h5 $closed" >spoken 2>&1 || fail "with $closed: status $?"
  "$ASDIC" info closed.h5 --check >/dev/null || fail "with $closed the file is damaged"
  [ "$(h5py_reads closed.h5)" = 2 ] || fail "with $closed the pings cannot be read"
done
echo "closed descriptors: files whole"

# 5. A run that was killed: the next keeps its salvage, and recover makes a file of it.
interrupt_scenario run.toml
start "$ASDIC" ping run.toml -o run.h5 -q
wait_for_ping run.h5
kill -KILL "$run"
wait "$run" 2>/dev/null || true
part=$(part_of run.h5)
before=$(sha256sum <"$part")
pings=$(h5py_reads "$part")
"$ASDIC" ping small.toml -o run.h5 2>note >/dev/null || fail "the run after a crash"
grep -qF "$part is of a run that did not end" note || fail "the salvage is not told: $(cat note)"
same "$part" "$before" "the run after a crash"
refused recover "$part"
says "there already"
"$ASDIC" recover "$part" -o saved.h5 >recovered || fail "recover"
grep -q "^saved.h5: $pings of 2000 pings, marked as not complete" recovered || fail "recover said $(cat recovered)"
[ "$(h5py_reads saved.h5)" = "$pings" ] || fail "recover lost pings"
"$ASDIC" info saved.h5 --check >/dev/null || fail "what was recovered is damaged"
same "$part" "$before" "recover"
/usr/bin/python3 - saved.h5 <<'PY' || fail "rows of a ping that is not whole were left"
import sys, h5py
with h5py.File(sys.argv[1]) as f:
    n = f["ping"].shape[0]
    assert f["pressure"].shape[0] == n and f["run/time_write"].shape[0] == n
    assert f["echoes/ping"][:].max() <= n and f["echoes/delay"].shape == f["echoes/ping"].shape
    assert f.attrs["complete"] == 0 and f.attrs["recovered"] == 1
PY
echo "killed: $pings pings recovered"

# 6. Two at work on one output: the second says who is there, and the first is not disturbed.
cat >study.toml <<'TOML'
[study]
realisations = 200
seed = 7
[vary]
"target.0.range" = { law = "uniform", low = 1e3, high = 3e3 }
[measure]
echo_level = true
TOML
sed -e '/^\[run\]/,$d' -e '/^title/d' -e 's/^count = .*/count = 1/' small.toml >>study.toml
# second WORDS…: while $run is at work on an output.
second() {
  local status=0
  said=$("$ASDIC" "$@" 2>&1 >/dev/null) || status=$?
  [ "$status" = 1 ] || fail "asdic $* beside another: status $status, said: $said"
  says "another asdic is at work on it: process $run on host $(hostname) since 20"
  kill -0 "$run" || fail "the first was disturbed by asdic $*"
}
end_first() {
  kill -KILL "$run" 2>/dev/null || true
  wait "$run" 2>/dev/null || true
}
# The program begins on an output, and is held there: its id in $run. hold OUTPUT WORDS…
hold() {
  local output=$1 tries
  shift
  for ((tries = 0; tries < 50; ++tries)); do
    start "$ASDIC" "$@" >first.out 2>first.err
    while kill -0 "$run" 2>/dev/null && [ ! -s "$output.lock" ]; do :; done
    kill -STOP "$run" 2>/dev/null && [ -s "$output.lock" ] && return 0
    wait "$run" || fail "asdic $*: $(cat first.err)"
  done
  fail "asdic $*: never seen at work"
}
# Let go on, it ends as if nothing had been.
let_go() {
  kill -CONT "$run"
  wait "$run" || fail "the first: $(cat first.err)"
}
for locks in TRUE FALSE; do
  export HDF5_USE_FILE_LOCKING=$locks
  rm -f two.h5*
  start "$ASDIC" ping run.toml -o two.h5 -q
  wait_for_ping two.h5
  kill -STOP "$run"  # at work, though not on our processor
  second ping run.toml -o two.h5 -q
  second ping small.toml -o two.h5 -q --force
  second recover "$(part_of two.h5)"
  second recover "$(part_of two.h5)" -o elsewhere.h5
  [ "$(h5py_reads "$(part_of two.h5)" 2>/dev/null || echo 1)" -ge 1 ] || fail "the first one's part was damaged"
  end_first

  cp ping.h5 both.h5
  hold both.h5 process both.h5 -q
  second process both.h5 -q
  let_go
  "$ASDIC" info both.h5 --check >/dev/null || fail "two process left a damaged file"

  rm -f st.h5* half?.h5 all.h5
  hold st.h5 study study.toml -o st.h5 -q
  second study study.toml -o st.h5 -q
  second study study.toml -o st.h5 -q --fresh
  let_go
  "$ASDIC" info st.h5 --check | grep -q "matches the manifest" || fail "two studies left a damaged file"
  for half in 1 2; do "$ASDIC" study study.toml --shard "$half/2" -o "half$half.h5" -q; done
  hold all.h5 merge half1.h5 half2.h5 -o all.h5 -q
  second merge half1.h5 half2.h5 -o all.h5 -q
  let_go
  "$ASDIC" info all.h5 --check >/dev/null || fail "two merges left a damaged file"
done
unset HDF5_USE_FILE_LOCKING
echo "two at work: the second is told"
foreign st.h5 study study.toml -o st.h5 -q --fresh
foreign all.h5 merge half1.h5 half2.h5 -o all.h5 -q

# 7. A bit that was changed on the disk is found, and where.
cp ping.h5 bad.h5
/usr/bin/python3 - bad.h5 <<'PY'
import sys, h5py
with h5py.File(sys.argv[1]) as f:
    chunk = f["pressure"].id.get_chunk_info_by_coord((1, 0, 0))
with open(sys.argv[1], "r+b") as f:
    f.seek(chunk.byte_offset + 1000)
    byte = f.read(1)[0]
    f.seek(chunk.byte_offset + 1000)
    f.write(bytes([byte ^ 4]))
PY
"$ASDIC" info ping.h5 --check | grep -q "match their checksums" || fail "a whole file does not pass"
refused info bad.h5 --check
says "bad.h5: /pressure[1, 0]: found damaged data"
echo "damage: found"

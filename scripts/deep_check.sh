#!/usr/bin/env bash
# What takes too long for every day: sanitizers, tests' full forms, kills at random moments,
# a long run's memory. A line with a verdict for each.
#   scripts/deep_check.sh [--no-asan]       ASDIC=path/to/asdic to test another than build/ci's
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD
source tests/support/interrupt.sh
failures=0
verdict() { # verdict NAME good|FAILED DETAILS
  printf '%-12s %-6s %s\n' "$1" "$2" "$3"
  [ "$2" = good ] || failures=$((failures + 1))
}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

if [ "${1:-}" != --no-asan ]; then
  cmake --preset asan >/dev/null
  if cmake --build --preset asan >"$folder/asan.log" 2>&1 &&
    ctest --preset asan -L 'unit|property' -j "$(nproc)" >>"$folder/asan.log" 2>&1; then
    verdict sanitizers good "$(grep 'tests passed' "$folder/asan.log")"
  else
    verdict sanitizers FAILED "$(tail -n 5 "$folder/asan.log" | tr '\n' ' ')"
  fi
fi

if [ "${1:-}" != --no-asan ]; then
  runs=${ASDIC_FUZZ_RUNS:-1000000}
  if said=$(scripts/fuzz.sh "$runs" 2>&1); then
    verdict fuzz good "$(grep -c good <<<"$said") readers, $runs runs each"
  else
    verdict fuzz FAILED "$(grep -v good <<<"$said" | tr '\n' ' ')"
  fi
fi

# The tests' full forms, of which the suite runs one of each kind: fans of 200 000 rays, all readers of all files, every
# picture of every kind of file. And the programs that compute, whole, at the lowest instruction level.
cmake --preset ci >/dev/null && cmake --build --preset ci >/dev/null
if ASDIC_DEEP=1 ctest --preset ci -L 'property|validation' -j "$(nproc)" >"$folder/full.log" 2>&1; then
  verdict full-forms good "$(grep 'tests passed' "$folder/full.log")"
else
  verdict full-forms FAILED "$(grep '(Failed)\|(Timeout)' "$folder/full.log" | tr -s ' \n' ' ')"
fi
wrong=''
for program in build/ci/tests/{unit,property}_{core,raytrace,reverb,sonar,processing}; do
  [ -x "$program" ] || continue
  ASDIC_LEVEL=x86-64-v2 RC_PARAMS=seed=20130601 "$program" --gtest_brief=1 >"$folder/lowest.log" 2>&1 || wrong+=" ${program##*/}"
done
if [ -z "$wrong" ]; then verdict lowest good "all that computes, at x86-64-v2"; else verdict lowest FAILED "$wrong"; fi

# Damaged HDF5 and netCDF: the libraries are nobody's to instrument, so a run of the plain build.
cmake --preset ci >/dev/null && cmake --build --preset ci --target fuzz_damaged_files >/dev/null
for library in hdf5 netcdf; do
  if said=$(build/ci/tests/fuzz/fuzz_damaged_files "$library" "${ASDIC_FILE_RUNS:-100000}" 2>&1); then
    verdict "$library" good "${said#*: }"
  else
    verdict "$library" FAILED "$(tail -n 1 <<<"$said")"
  fi
done

# Instructions of the kernels: what noise cannot disturb.
if said=$(scripts/bench.sh --check 2>&1); then
  verdict kernels good "$(grep -c ' %' <<<"$said") kernels within their counts"
else
  verdict kernels FAILED "$(tail -n 1 <<<"$said")"
fi

if [ -z "${ASDIC:-}" ]; then
  cmake --preset ci >/dev/null && cmake --build --preset ci --target asdic_app >/dev/null
  ASDIC=$root/build/ci/bin/asdic
fi
export ASDIC

if said=$(bash tests/app/validation/cli_interrupt.sh 2>&1); then
  verdict interrupt good "$(grep -c . <<<"$said") checks of Ctrl-C, SIGTERM and kill -9"
else
  verdict interrupt FAILED "$(tail -n 1 <<<"$said")"
fi

# kill -9 at random moments after the first ping: nothing under the final name, every ping that was written readable.
cd "$folder"
interrupt_scenario kill.toml
kills=20 bad=0 pings=0
for ((i = 0; i < kills; ++i)); do
  rm -f kill.h5 kill.h5.????.part
  "$ASDIC" ping kill.toml -q --set pings.recording_duration=15 --set target.0.position=[9000.0,0.0,200.0] -o kill.h5 &
  run=$!
  wait_for_ping kill.h5
  sleep "0.$(printf '%03d' $((RANDOM % 1000)))"
  kill -KILL "$run"
  wait "$run" 2>/dev/null || true
  part=$(part_of kill.h5)
  if [ -e kill.h5 ] || ! n=$(h5py_reads "$part" 2>/dev/null) || ! "$ASDIC" info "$part" >/dev/null 2>&1; then
    bad=$((bad + 1))
  else
    pings=$((pings + n))
  fi
done
rm -f kill.h5 kill.h5.????.part
if [ "$bad" = 0 ]; then verdict kills good "$kills kills, $pings pings, all readable"; else verdict kills FAILED "$bad of $kills left a file that is not as it should be"; fi

# Soak: the most memory ever used (VmHWM) after many small pings is that after some, within a tenth and 10 MB. What a ping of a
# sequence under way has found is kept for 64 pings.
interrupt_scenario soak.toml
small=(--set array.phones=2 --set pings.recording_duration=3 --set pings.sample_rate=4000 --set pulse.frequency=1000.0
  --set target.0.position=[1500.0,0.0,500.0] --set target.0.velocity=[0.0,0.0,0.0] --set pings.interval=5)
peak() { # peak PINGS: kB
  /usr/bin/python3 - "$ASDIC" ping soak.toml -q -o soak.h5 "${small[@]}" --pings "$1" <<'PY'
import os, sys
child = os.spawnv(os.P_NOWAIT, sys.argv[1], sys.argv[1:])
_, status, usage = os.wait4(child, 0)
print(usage.ru_maxrss if status == 0 else f"failed with {status}")
PY
}
few=$(peak 400) many=$(peak 1600)
if [[ "$few$many" =~ ^[0-9]+$ ]] && [ "$many" -le $((few * 11 / 10 + 10000)) ]; then
  verdict soak good "at most $few kB over 400 pings, $many kB over 1600"
else
  verdict soak FAILED "at most $few kB over 400 pings, $many kB over 1600"
fi

# The physics suite, whole: asdic against wave theory, images and closed forms.
cd "$root"
if said=$(/usr/bin/python3 scripts/validate_physics.py --asdic "$ASDIC" 2>&1); then
  verdict physics good "$(tail -n 1 <<<"$said")"
else
  verdict physics FAILED "$(tail -n 1 <<<"$said")"
fi

# Studies: the same bits by threads, parts and ranks, with 20 kills; memory flat over 10⁵ realisations.
cd "$root"
if said=$(/usr/bin/python3 tests/study/validation/study_runs.py 20 2>&1); then
  verdict studies good "$(grep killed <<<"$said" | head -n 1)"
else
  verdict studies FAILED "$(tail -n 1 <<<"$said")"
fi
if [ -x build/ci/tests/property_study ]; then
  if said=$(ASDIC_SOAK=100000 build/ci/tests/property_study --gtest_filter='Soak.*' 2>&1); then
    verdict study-soak good "100000 realisations in memory that stays the same"
  else
    verdict study-soak FAILED "$(grep kB <<<"$said" | head -n 1)"
  fi
fi

# Studies of very many rows in bounded memory; Slurm itself on this machine, where it can be had.
if [ -x build/ci/tests/property_study ]; then
  if said=$(ASDIC_SCALE=3000000 build/ci/tests/property_study --gtest_filter='Scale.*' 2>&1); then
    verdict study-scale good "3000000 rows in bounded memory"
  else
    verdict study-scale FAILED "$(grep -m 1 Failure <<<"$said")"
  fi
fi
apt-get install -y --no-install-recommends slurm-wlm munge >/dev/null 2>&1 || true
status=0
said=$(tests/study/deep/slurm.sh 2>&1) || status=$?
case $status in
  0) verdict slurm good "$(tail -n 1 <<<"$said")" ;;
  77) verdict slurm good "$(tail -n 1 <<<"$said")" ;;
  *) verdict slurm FAILED "$(grep -m 1 slurm.sh <<<"$said")" ;;
esac

# 10 000 served updates and pings: none lost, no more memory after them.
cd "$root"
if said=$(/usr/bin/python3 tests/serve/validation/serve.py "${ASDIC_SERVED_PINGS:-10000}" 2>&1); then
  verdict serve good "$(head -n 1 <<<"$said")"
else
  verdict serve FAILED "$(tail -n 1 <<<"$said")"
fi

# A million lines that no client should send.
if said=$(/usr/bin/python3 tests/serve/validation/hostile.py 1000000 2>&1); then
  verdict hostile good "$(head -n 1 <<<"$said")"
else
  verdict hostile FAILED "$(tail -n 1 <<<"$said")"
fi

# 24 hours of a continuous sonar that turns all the time, as fast as it goes: no more memory after them.
if said=$(/usr/bin/python3 tests/serve/validation/listening.py 86400 2>&1); then
  verdict listening good "$(grep 'times as fast' <<<"$said")"
else
  verdict listening FAILED "$(tail -n 1 <<<"$said")"
fi

# Debian packages: what lintian says of them, and a clean Debian in which they are installed and used.
cd "$root"
if said=$(scripts/packages.sh "$folder/packages" 2>&1); then
  if ! command -v lintian >/dev/null; then
    printf '%-12s %s\n' lintian "skipped: not installed (scripts/setup.sh develop)"
  elif complaints=$(lintian --fail-on error,warning "$folder"/packages/*.deb 2>/dev/null); then
    verdict lintian good "no errors, no warnings"
  else
    verdict lintian FAILED "$(head -n 1 <<<"$complaints")"
  fi
  status=0
  said=$(bash tests/install/clean_root.sh "$folder/packages" 2>&1) || status=$?
  case $status in
    0) verdict packages good "$(tr '\n' ';' <<<"$said")" ;;
    77) printf '%-12s %s\n' packages "$(tail -n 1 <<<"$said")" ;;
    *) verdict packages FAILED "$(tail -n 1 <<<"$said")" ;;
  esac
else
  verdict packages FAILED "$(tail -n 1 <<<"$said")"
fi

[ "$failures" = 0 ] && echo "deep check: all good" || { echo "deep check: $failures failed"; exit 1; }

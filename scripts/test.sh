#!/usr/bin/env bash
# Proves that asdic is right: sets up, builds the tests beside the program of run.sh, runs the whole suite.
#   scripts/test.sh [ctest options, e.g. -L unit]
# In CI (the variable CI is set) warnings are errors, and the benchmarks are built too.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/setup.sh
asdic_setup test
asdic_configure release -DASDIC_TESTS=ON -DASDIC_MPI=ON "-DASDIC_BENCHMARKS=$([ -n "${CI:-}" ] && echo ON || echo OFF)"
cmake --build --preset release
ctest --preset release -j "$(nproc)" "$@" || {
  failed=$?
  log=build/release/Testing/Temporary
  while IFS=: read -r _ name; do  # what each failed test printed last, where a long log ends
    echo "== $name"
    sed -n "\\|^\"$name\" start time|,/^<end of output>/p" $log/LastTest.log | tail -n 40
  done < $log/LastTestsFailed.log
  exit "$failed"
}

#!/usr/bin/env bash
# Proves that asdic is right: sets up, builds with warnings as errors, runs the whole test suite.
#   scripts/test.sh [ctest options, e.g. -L unit]
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/setup.sh
asdic_setup --climatology
cmake --preset ci -DASDIC_BENCHMARKS=ON >/dev/null
cmake --build --preset ci
ctest --preset ci -j "$(nproc)" "$@"

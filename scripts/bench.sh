#!/usr/bin/env bash
# Measures the stages of a ping with Google Benchmark and writes JSON, one file a program.
#   scripts/bench.sh [FILTER] [-o DIR]      FILTER: a regular expression of benchmark names; DIR: out/bench
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/setup.sh
filter=. directory=out/bench
while [ $# -gt 0 ]; do
  case "$1" in
    -o) directory=$2; shift ;;
    -h | --help) sed -n '2,3s/^# \{0,1\}//p' "$0"; exit 0 ;;
    -*) echo "bench.sh: unknown option $1; see --help" >&2; exit 2 ;;
    *) filter=$1 ;;
  esac
  shift
done
asdic_setup
cmake --preset bench -DASDIC_TESTS=OFF >/dev/null
cmake --build --preset bench
mkdir -p "$directory"
for program in build/bench/tests/bench/bench_*; do
  "$program" --benchmark_filter="$filter" --benchmark_out="$directory/$(basename "$program").json" --benchmark_out_format=json
done
echo "results: $directory/*.json"

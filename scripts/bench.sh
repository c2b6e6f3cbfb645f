#!/usr/bin/env bash
# Measures the stages of a ping with Google Benchmark and writes JSON, one file a program; or counts the kernels' instructions.
#   scripts/bench.sh [FILTER] [-o DIR]      FILTER: a regular expression of benchmark names; DIR: out/bench
#   scripts/bench.sh --check [FILTER]       fails when a kernel takes 5 % more instructions than tests/bench/counts.json says
#   scripts/bench.sh --update [FILTER]      writes them there
#   scripts/bench.sh --linear               prints instructions of the synthesis against scatterers and phones
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/setup.sh
filter=. directory=out/bench counts=
while [ $# -gt 0 ]; do
  case "$1" in
    -o) directory=$2; shift ;;
    --check) counts=check ;;
    --update) counts=update ;;
    --linear) counts=linear ;;
    -h | --help) sed -n '2,6s/^# \{0,1\}//p' "$0"; exit 0 ;;
    -*) echo "bench.sh: unknown option $1; see --help" >&2; exit 2 ;;
    *) filter=$1 ;;
  esac
  shift
done
asdic_setup test
if [ -n "$counts" ]; then
  asdic_setup develop
  cmake --preset portable -DASDIC_TESTS=OFF -DASDIC_BENCHMARKS=ON >/dev/null
  cmake --build --preset portable --target count_kernels >/dev/null
  if [ "$counts" = linear ]; then
    for sizes in 10000:4 20000:4 40000:4 80000:4 10000:8 10000:16 10000:32; do
      said=$(valgrind --tool=callgrind --toggle-collect=asdic_counted --callgrind-out-file=/dev/null \
        build/portable/tests/bench/count_kernels "scatterers:$sizes" 2>&1)
      echo "scatterers:phones $sizes  instructions $(sed -n 's/.*Collected : //p' <<<"$said")"
    done
    exit 0
  fi
  options=(--only "$filter")
  [ "$counts" = check ] || options+=(--update)
  exec /usr/bin/python3 tests/bench/check_counts.py build/portable/tests/bench/count_kernels "${options[@]}"
fi
cmake --preset bench -DASDIC_TESTS=OFF >/dev/null
cmake --build --preset bench
mkdir -p "$directory"
for program in build/bench/tests/bench/bench_*; do
  "$program" --benchmark_filter="$filter" --benchmark_out="$directory/$(basename "$program").json" --benchmark_out_format=json
done
echo "results: $directory/*.json"

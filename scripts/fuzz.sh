#!/usr/bin/env bash
# Hunts for input that breaks a reader: libFuzzer with address and undefined-behaviour sanitizers, from the seeds in tests/fuzz/seeds.
#   scripts/fuzz.sh [RUNS [TARGET...]]      default: 1000000 runs of every target; what breaks one is left in build/fuzz/found
set -euo pipefail
cd "$(dirname "$0")/.."
runs=${1:-1000000}
shift || true
targets=("$@")
[ "${#targets[@]}" -gt 0 ] || targets=(env bty ssp brc sbp shd arr ray toml include csv wav study journal serve)
cmake --preset fuzz -DASDIC_BENCHMARKS=OFF >/dev/null
cmake --build --preset fuzz --target "${targets[@]/#/fuzz_}" >/dev/null
mkdir -p build/fuzz/found
failures=0
for target in "${targets[@]}"; do
  corpus=$(mktemp -d)
  if build/fuzz/tests/fuzz/fuzz_"$target" -runs="$runs" -seed=1 -timeout=20 -rss_limit_mb=4096 -max_len=8192 -verbosity=0 -print_final_stats=1 \
    -artifact_prefix=build/fuzz/found/"$target"- "$corpus" tests/fuzz/seeds/"$target" >build/fuzz/"$target".log 2>&1; then
    printf '%-7s good    %s runs\n' "$target" "$(awk '/number_of_executed_units/ {print $2}' build/fuzz/"$target".log)"
  else
    printf '%-7s FAILED  see build/fuzz/%s.log\n' "$target" "$target"
    failures=$((failures + 1))
  fi
  rm -rf "$corpus"
done
[ "$failures" = 0 ]

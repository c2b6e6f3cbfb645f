#!/usr/bin/env bash
# One command from a bare Debian 12 to a ping and its pictures. Safe to repeat, quick the second time.
#   scripts/run.sh [--climatology] [SCENARIO]
# --climatology  install measured climatologies too (Debian's ferret-datasets, 27 MB), for `asdic ocean`
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/setup.sh

climatology="" scenario=scenarios/deep_ocean.toml
for argument in "$@"; do
  case "$argument" in
    --climatology) climatology=--climatology ;;
    -h | --help) sed -n '2,4s/^# \{0,1\}//p' "$0"; exit 0 ;;
    -*) echo "run.sh: unknown option $argument; see --help" >&2; exit 2 ;;
    *) scenario=$argument ;;
  esac
done

asdic_setup run $climatology
asdic_configure release -DASDIC_TESTS=OFF -DASDIC_MPI=OFF -DASDIC_BENCHMARKS=OFF
cmake --build --preset release --target asdic_app
mkdir -p out
result=out/$(basename "$scenario" .toml).h5
build/release/bin/asdic ping "$scenario" -o "$result"
build/release/bin/asdic plot "$result" -o "${result%.h5}"

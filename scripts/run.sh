#!/usr/bin/env bash
# One command from a bare Debian 12 to a ping and its pictures. Safe to repeat, quick the second time.
#   scripts/run.sh [--portable] [--climatology] [SCENARIO]
# --portable     build for any x86-64-v2 machine rather than for this one
# --climatology  install measured climatologies too (Debian's ferret-datasets, 27 MB), for `asdic ocean`
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/setup.sh

preset=release climatology="" scenario=scenarios/deep_ocean.toml
for argument in "$@"; do
  case "$argument" in
    --portable) preset=portable ;;
    --climatology) climatology=--climatology ;;
    -h | --help) sed -n '2,5s/^# \{0,1\}//p' "$0"; exit 0 ;;
    -*) echo "run.sh: unknown option $argument; see --help" >&2; exit 2 ;;
    *) scenario=$argument ;;
  esac
done

asdic_setup $climatology
cmake --preset "$preset" -DASDIC_TESTS=OFF >/dev/null
cmake --build --preset "$preset"
mkdir -p out
result=out/$(basename "$scenario" .toml).h5
"build/$preset/bin/asdic" ping "$scenario" -o "$result"
"build/$preset/bin/asdic" plot "$result" -o "${result%.h5}"

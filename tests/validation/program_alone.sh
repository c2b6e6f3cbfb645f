#!/usr/bin/env bash
# The program is one file: a copy of it, in a folder of its own, runs a case, checks a scenario and pings.
#   ASDIC=path/to/asdic tests/validation/program_alone.sh
set -euo pipefail
: "${ASDIC:?the program to test}"
root=$(cd "$(dirname "$0")/../.." && pwd)
source "$root/tests/support/interrupt.sh"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cp "$ASDIC" "$folder/asdic"
cd "$folder"
./asdic --version
./asdic bellhop "$root/tests/data/bellhop/rays-upslope/case" -q -o fan
[ -s fan.ray ]
interrupt_scenario sea.toml
./asdic ping sea.toml -q -o sea.h5 --pings 1
./asdic info sea.h5

#!/usr/bin/env bash
# The program is one file: a copy of it, in a folder of its own, runs a case, checks a scenario and pings.
#   ASDIC=path/to/asdic tests/install/validation/program_alone.sh
set -euo pipefail
: "${ASDIC:?the program to test}"
root=$(cd "$(dirname "$0")/../../.." && pwd)
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
# It starts quickly: HDF5, netCDF (with sixty other libraries), sound files and the like are loaded at their first call.
if [ "$(uname -m)" = x86_64 ] && ! readelf -d asdic | grep -q 'libasan\|libtsan'; then
  LD_DEBUG=files ./asdic bellhop "$root/tests/data/bellhop/rays-upslope/case" -q -o fan 2>loaded
  grep -q 'calling init.*libtbb' loaded || fail "the dynamic linker told nothing"
  if grep 'calling init.*\(hdf5\|netcdf\|sndfile\|crypto\|sqlite\|fftw\|muparser\)' loaded; then fail "bellhop loads what it does not call"; fi
  # Without one of them the other commands work, and those that need it say so.
  sed 's/libhdf5\([a-z_]*\)\.so/libhdf0\1.so/g' asdic >poor
  chmod +x poor
  ./poor bellhop "$root/tests/data/bellhop/rays-upslope/case" -q -o fan
  status=0
  ./poor info sea.h5 2>said || status=$?
  [ "$status" = 1 ] && grep -q '^asdic: .*libhdf0.*cannot open shared object file' said || fail "status $status: $(cat said)"
fi

#!/usr/bin/env bash
# Debian packages of asdic: the program, asdic-mpi, the C++ library, the Python package. Builds in build/package, writes
# into build/package/packages and says what is in there.
#   scripts/packages.sh [OUTPUT_FOLDER]
# ASDIC_MAINTAINER="NAME <MAIL>" names who distributes them.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/setup.sh

case "${1:-}" in
  -h | --help) sed -n '2,5s/^# \{0,1\}//p' "$0"; exit 0 ;;
  -*) echo "packages.sh: unknown option $1; see --help" >&2; exit 2 ;;
esac
asdic_setup run
mapfile -t missing < <(asdic_missing_packages libopenmpi-dev pybind11-dev python3-dev)
if [ "${#missing[@]}" -gt 0 ]; then
  echo "packages.sh: without ${missing[*]} not all packages are made; scripts/setup.sh test installs them" >&2
fi
# the same sources make the same packages
if [ -z "${SOURCE_DATE_EPOCH:-}" ] && git rev-parse HEAD >/dev/null 2>&1; then
  SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
  export SOURCE_DATE_EPOCH
fi
asdic_configure package ${ASDIC_MAINTAINER:+"-DASDIC_MAINTAINER=$ASDIC_MAINTAINER"}
cmake --build --preset package
rm -rf build/package/packages
(umask 022 && cd build/package && cpack -G DEB) | grep -v '^CPack: - \(Run\|Install\)' || exit 1
folder=build/package/packages
rm -rf "$folder/_CPack_Packages"
if [ -n "${1:-}" ]; then
  mkdir -p "$1"
  cp "$folder"/*.deb "$1"
  folder=$1
fi
ls -l "$folder"

#!/usr/bin/env bash
# Installs the Debian packages that are missing, and says so. Sourced by other scripts; harmless to repeat.
#   scripts/setup.sh [run|test|develop] [--climatology]
# run (default): to build, ping and draw; test: to test as well; develop: everything (scripts/packages/*.txt)
# --climatology: ferret-datasets too, the measured climatologies for `asdic ocean`; test has them
set -euo pipefail

asdic_missing_packages() {
  local package
  for package in "$@"; do
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)" = installed ] || echo "$package"
  done
}

asdic_setup() {
  local root argument list lists=(run) wanted missing as_root=() more=()
  root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
  for argument in "$@"; do
    case "$argument" in
      run) ;;
      test) lists=(run test) ;;
      develop) lists=(run test develop) ;;
      --climatology) more=(ferret-datasets) ;;
      *) echo "setup.sh: found \"$argument\", expected run, test, develop or --climatology" >&2; return 2 ;;
    esac
  done
  command -v dpkg-query >/dev/null ||
    { echo "asdic: found no dpkg-query, expected a Debian; install what scripts/packages/ lists, then use cmake --preset release" >&2; return 1; }
  mapfile -t wanted < <(for list in "${lists[@]}"; do grep -v '^#' "$root/scripts/packages/$list.txt"; done)
  mapfile -t missing < <(asdic_missing_packages "${wanted[@]}" "${more[@]}")
  [ "${#missing[@]}" -eq 0 ] && return 0
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "asdic: as root, please: apt-get install ${missing[*]}" >&2; return 1; }
    as_root=(sudo)
    echo "asdic: using sudo to install packages"
  fi
  echo "asdic: installing ${#missing[@]} Debian packages: ${missing[*]}"
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}

# asdic_configure PRESET OPTIONS...: the same flags whoever asks, so that run.sh and test.sh share build/release. In CI (the variable
# CI is set) warnings are errors.
asdic_configure() {
  local preset=$1
  shift
  cmake --preset "$preset" "-DASDIC_WERROR=$([ -n "${CI:-}" ] && echo ON || echo OFF)" "$@" >/dev/null
}

if [ "${BASH_SOURCE[0]}" = "$0" ]; then asdic_setup "$@"; fi

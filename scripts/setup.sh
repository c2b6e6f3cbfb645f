#!/usr/bin/env bash
# Installs the Debian packages that are missing, and says so. Sourced by run.sh and test.sh; harmless to repeat.
#   scripts/setup.sh [--climatology]     the option adds ferret-datasets, the measured climatologies for `asdic ocean`
set -euo pipefail

asdic_missing_packages() {
  local package
  for package in "$@"; do
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)" = installed ] || echo "$package"
  done
}

asdic_setup() {
  local root wanted missing as_root=()
  root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
  mapfile -t wanted < <(grep -v '^#' "$root/scripts/packages.txt")
  [ "${1:-}" = --climatology ] && wanted+=(ferret-datasets)
  mapfile -t missing < <(asdic_missing_packages "${wanted[@]}")
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

if [ "${BASH_SOURCE[0]}" = "$0" ]; then asdic_setup "$@"; fi

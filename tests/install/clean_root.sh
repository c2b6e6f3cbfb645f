#!/usr/bin/env bash
# The packages of scripts/packages.sh in a clean Debian: apt installs them with what they need, and they are used. Tells how
# long it takes from apt to the first ping and the first picture. Part of scripts/deep_check.sh.
#   tests/install/clean_root.sh FOLDER_OF_PACKAGES
# Skipped, with the reason and status 77, where there is no root, no mmdebstrap or no apt source that answers.
set -euo pipefail
packages=$(cd "${1:?the folder of the packages}" && pwd)
fail() { echo "FAILED: $*"; exit 1; }
skip() { echo "skipped: $*"; exit 77; }
[ "$(id -u)" = 0 ] || skip "a clean root needs root, and this is $(id -un)"
command -v mmdebstrap >/dev/null || skip "found no mmdebstrap (scripts/setup.sh develop)"
ls "$packages"/asdic_*.deb >/dev/null 2>&1 || fail "no asdic_*.deb in $packages: run scripts/packages.sh"

folder=$(mktemp -d)
root=$folder/root
leave() {
  for place in proc dev; do
    if mountpoint -q "$root/$place"; then umount -l "$root/$place"; fi
  done
  rm -rf --one-file-system "$folder"
}
trap leave EXIT

# The sources that this machine's apt has, with its settings, in a small Debian.
sources=()
for file in /etc/apt/sources.list /etc/apt/sources.list.d/*.list /etc/apt/sources.list.d/*.sources; do
  if grep -qs '^deb \|^URIs' "$file"; then sources+=("$file"); fi
done
[ "${#sources[@]}" -gt 0 ] || skip "apt has no sources"
settings=()
for file in /etc/apt/apt.conf /etc/apt/apt.conf.d/*; do
  if grep -qs 'Acquire' "$file" && ! grep -q 'Languages\|IndexTargets' "$file"; then settings+=("--aptopt=$file"); fi
done
release=$(. /etc/os-release && echo "${VERSION_CODENAME:-}")
mmdebstrap --quiet --mode=root --variant=minbase "${settings[@]}" "$release" "$folder/clean.tar" "${sources[@]}" \
  >"$folder/log" 2>&1 || skip "no clean root from apt's sources: $(tail -n 2 "$folder/log" | tr '\n' ' ')"

new_root() {
  leave_root
  mkdir "$root"
  tar -xf "$folder/clean.tar" -C "$root" --exclude='./dev/*'
  mount -t proc proc "$root/proc" 2>/dev/null || mount --bind /proc "$root/proc" || skip "no proc in a clean root"
  mount --bind /dev "$root/dev" || skip "no dev in a clean root"
  cp /etc/resolv.conf "$root/etc/resolv.conf"
  printf '#!/bin/sh\nexit 101\n' >"$root/usr/sbin/policy-rc.d"  # no services
  chmod +x "$root/usr/sbin/policy-rc.d"
  mkdir "$root/packages"
  cp "$packages"/*.deb "$root/packages"
  inside 'apt-get update -qq' >"$folder/log" 2>&1 || skip "apt's sources do not answer: $(tail -n 2 "$folder/log")"
}
leave_root() {
  for place in proc dev; do
    if mountpoint -q "$root/$place"; then umount -l "$root/$place"; fi
  done
  rm -rf --one-file-system "$root"
}
inside() { # inside COMMANDS, in /root of the clean root
  chroot "$root" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
    OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 bash -euc "cd /root; $1"
}
install() { # install WORDS: packages, options
  inside "apt-get install -y -qq $* >/tmp/log 2>&1" || fail "apt-get install $*: $(inside 'tail -n 5 /tmp/log')"
}
seconds() { # seconds COMMANDS...
  local begin=$EPOCHREALTIME
  "$@" >"$folder/said" 2>&1 || fail "$*: $(tail -n 5 "$folder/said")"
  awk -v a="$begin" -v b="$EPOCHREALTIME" 'BEGIN { printf "%.1f", b - a }'
}
scenario=/usr/share/asdic/scenarios/deep_ocean.toml

# The program alone.
new_root
before=$(inside 'dpkg-query -W | wc -l')
apt=$(seconds install --no-install-recommends /packages/asdic_*.deb)
ping=$(seconds inside "asdic ping $scenario -o ping.h5")
now=$(inside 'dpkg-query -W | wc -l')
echo "without recommended packages: apt $apt s ($((now - before)) packages), first ping $ping s after it"
inside 'asdic info ping.h5 --check >/dev/null; asdic arrivals '"$scenario"' >/dev/null 2>&1; asdic ping --help >/dev/null'
inside 'asdic | grep -q "asdic ping /usr/share/asdic/scenarios/deep_ocean.toml"' || fail "bare asdic: how to begin"
inside 'ldd /usr/bin/asdic | grep -i "mpi\|not found"' && fail "asdic is linked with MPI, or lacks a library"
inside 'readelf -d /usr/bin/asdic 2>/dev/null | grep -i "r.*path"' && fail "asdic looks for libraries in a place of its own"
said=$(inside 'asdic plot ping.h5 || echo "status $?"' 2>&1)
grep -q 'python3' <<<"$said" && grep -q 'status 1' <<<"$said" || fail "asdic plot without Python: $said"
echo "asdic plot without Python: ${said%%$'\n'*}"
# every library that is loaded late is there: a file of each kind
inside 'asdic export ping.h5 --wav -o sounds >/dev/null; ls sounds/*.wav >/dev/null
  asdic study /usr/share/asdic/scenarios/studies/known_answer.toml -q -o study.h5 --set study.realisations=20
  cp /usr/share/asdic/scenarios/bellhop/munk.env .; asdic bellhop munk -q; asdic convert munk.env munk.toml -q'

more=$(seconds install --no-install-recommends python3-h5py python3-matplotlib)
plot=$(seconds inside 'asdic plot ping.h5 -o pictures')
echo "with python3-h5py and python3-matplotlib, nothing else: apt $more s, pictures $plot s:" \
  "$(awk "BEGIN { print $apt + $ping + $more + $plot }") s from apt to the first pictures"

# As a user has it, with what is recommended.
new_root
apt=$(seconds install /packages/asdic_*.deb)
ping=$(seconds inside "asdic ping $scenario -o ping.h5")
plot=$(seconds inside 'asdic plot ping.h5 -o pictures')
now=$(inside 'dpkg-query -W | wc -l')
echo "with all that is recommended: apt $apt s ($((now - before)) packages), first ping $ping s, pictures $plot s: $(awk "BEGIN { print $apt + $ping + $plot }") s together"
for picture in rays pressure bearing_time levels; do
  inside "test -s pictures/$picture.png" || fail "no picture $picture"
done

# Manual pages and completions.
install --no-install-recommends man-db bash-completion ferret-datasets
inside 'for page in /usr/share/man/man1/asdic*.1.gz; do man --warnings -l "$page" 2>&1 >/dev/null | grep . && exit 1; done; true' ||
  fail "man warns"
inside 'man -P cat asdic-ping | grep -q time-axis && man -P cat asdic | grep -q "asdic-study"' || fail "man asdic-ping"
inside 'source /usr/share/bash-completion/bash_completion; _completion_loader asdic || [ $? = 124 ]; complete -p asdic >/dev/null
  COMP_WORDS=(asdic pi) COMP_CWORD=1; _asdic; [ "${COMPREPLY[*]}" = ping ]' || fail "bash completes no asdic pi"
inside 'asdic ocean --latitude 30.5 --longitude -60.5 --month 3 -o ocean.toml' || fail "asdic ocean"
echo "manual pages, completion, asdic ocean: good"

# Python.
library=$(cd "$packages" && ls libasdic0*.deb)
install "/packages/$library" /packages/python3-asdic_*.deb
inside "python3 - <<'PY'
import asdic
s = asdic.Scenario('$scenario')
assert len(s.arrivals()) > 2
ping = s.ping()
assert ping.pressure.shape[0] == 16, ping
print('import asdic:', ping.pressure.shape, 'samples;', len(asdic.open('ping.h5').data_vars), 'variables of ping.h5')
PY"

# C++: a project that finds the library.
install --no-install-recommends cmake make g++ "/packages/$library" /packages/libasdic-dev_*.deb
mkdir "$root/root/mine"
cat >"$root/root/mine/CMakeLists.txt" <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
project(mine LANGUAGES CXX)
find_package(asdic 0.1 REQUIRED)
add_executable(mine mine.cpp)
target_link_libraries(mine PRIVATE asdic::asdic)
CMAKE
cat >"$root/root/mine/mine.cpp" <<'CPP'
#include <asdic/asdic.h>

#include <iostream>

int main(int, char** words) {
  const asdic::Scenario scenario = asdic::Scenario::read(words[1]);
  std::cout << "find_package(asdic): " << asdic::ping(scenario).channels() << " phones\n";
}
CPP
inside "cmake -S mine -B build >/dev/null && cmake --build build >/dev/null && build/mine $scenario"

# MPI.
if ls "$packages"/asdic-mpi_*.deb >/dev/null 2>&1; then
  install /packages/asdic-mpi_*.deb
  inside 'mpirun --oversubscribe -n 2 asdic-mpi study /usr/share/asdic/scenarios/studies/known_answer.toml -q -o mpi.h5 \
    --set study.realisations=20 && asdic info mpi.h5 >/dev/null' || fail "asdic-mpi"
  echo "asdic-mpi: good"
fi

# Gone without a trace.
inside 'apt-get purge -y -qq asdic asdic-mpi "libasdic*" python3-asdic >/tmp/log 2>&1'
for place in share/asdic share/doc/asdic lib/python3/dist-packages/asdic include/asdic; do
  [ ! -e "$root/usr/$place" ] || fail "left after apt-get purge: $(find "$root/usr/$place" | head -n 5)"
done
echo "purged: nothing is left"

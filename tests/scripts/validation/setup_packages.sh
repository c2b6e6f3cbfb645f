#!/usr/bin/env bash
# Who only pings installs no compiler of another kind, no MPI, no test library; each list adds to those before it.
set -euo pipefail
cd "$(dirname "$0")/../../.."
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() { echo "FAILED: $*" >&2; exit 1; }
# A machine on which nothing is installed, and an apt-get that does nothing.
printf '#!/bin/sh\nexit 1\n' >"$folder/dpkg-query"
printf '#!/bin/sh\nexit 0\n' >"$folder/apt-get"
printf '#!/bin/sh\nexec "$@"\n' >"$folder/sudo"
chmod +x "$folder"/*
wanted() { PATH="$folder:$PATH" scripts/setup.sh "$@" | sed -n 's/^asdic: installing [0-9]* Debian packages: //p' | tr ' ' '\n' | sort; }
wanted run >"$folder/run"
wanted test >"$folder/test"
wanted develop >"$folder/develop"
[ "$(wanted)" = "$(cat "$folder/run")" ] || fail "setup.sh without a word is not setup.sh run"
if grep -E '^clang|llvm|valgrind|mpi|gtest|gmock|rapidcheck|benchmark|ferret|xarray' "$folder/run"; then fail "run.txt: not needed to ping"; fi
if grep -E '^clang$|clang-tidy|valgrind' "$folder/test"; then fail "test.txt: not needed to test"; fi
for list in run test develop; do
  [ -s "$folder/$list" ] || fail "$list: nothing"
  [ -z "$(uniq -d "$folder/$list")" ] || fail "$list: twice: $(uniq -d "$folder/$list")"
done
[ -z "$(comm -23 "$folder/run" "$folder/test")$(comm -23 "$folder/test" "$folder/develop")" ] || fail "a list lacks packages of the one before"
wanted run --climatology | grep -qx ferret-datasets || fail "--climatology: no ferret-datasets"
status=0
said=$(scripts/setup.sh everything 2>&1) || status=$?
[ "$status" = 2 ] && grep -q 'found "everything", expected run, test, develop' <<<"$said" || fail "an unknown list: status $status, $said"
wc -l "$folder"/{run,test,develop} | sed "s|$folder/||"

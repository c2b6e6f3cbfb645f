#!/usr/bin/env bash
# Which law finds which deliberate fault: tests/laws/mutations/faults.patch puts faults into a copy of the tree, each
# behind its name in the variable ASDIC_FAULT, so that one build serves all. Production sources know nothing of it.
#   scripts/laws_mutations.sh COPY [NAME...]
# COPY is a folder for the copy with its build, made if it is not there (an hour of one core); NAMEs are faults, by
# default all of tests/laws/mutations/faults.txt. A line each: the fault, the law, the number of draws until it was found.
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD
[ $# -ge 1 ] || { echo "laws_mutations.sh: found no folder, expected one for a copy of the tree" >&2; exit 2; }
copy=$1
shift
if [ ! -e "$copy" ]; then
  git clone -q "$root" "$copy"
  git -C "$copy" apply "$root/tests/laws/mutations/faults.patch"
  (cd "$copy" && cmake --preset release -DASDIC_TESTS=OFF >/dev/null && cmake --build --preset release --target asdic_app)
fi
export ASDIC=${ASDIC:-$copy/build/release/bin/asdic}
exec /usr/bin/python3 tests/laws/run.py --draws 60 --seed 1 --faults "$@"

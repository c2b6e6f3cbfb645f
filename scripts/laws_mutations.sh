#!/usr/bin/env bash
# Which law finds which deliberate fault: tests/laws/mutations/faults.patch puts some thirty faults into a copy of the tree,
# each behind its name in the variable ASDIC_FAULT, so that one build serves all. Production sources know nothing of it.
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
wrong=0
while read -r fault law; do
  [ $# -eq 0 ] || [[ " $* " == *" $fault "* ]] || continue
  if said=$(ASDIC_FAULT=$fault /usr/bin/python3 tests/laws/run.py --no-replay --until-found --draws 40 --seed 1 --law "$law" --shrink 1 \
            --keep "$(mktemp -d)" 2>&1); then
    printf '%-22s %-28s NOT FOUND in 40 draws\n' "$fault" "$law"
    wrong=1
  else
    printf '%-22s %-28s %s\n' "$fault" "$law" "$(grep -o 'found after [0-9]* draws' <<<"$said" || tail -n 1 <<<"$said")"
  fi
done < <(grep -v '^#' tests/laws/mutations/faults.txt)
exit $wrong

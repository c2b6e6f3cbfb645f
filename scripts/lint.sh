#!/usr/bin/env bash
# clang-tidy over every source file; any finding is an error. Slow (an hour of one processor): run before a release.
#   scripts/lint.sh [FILES]       ASDIC_JOBS: processes at a time (all processors)
set -euo pipefail
cd "$(dirname "$0")/.."
command -v clang-tidy >/dev/null || { echo "lint.sh: needs clang-tidy: scripts/setup.sh develop" >&2; exit 1; }
cmake --preset ci -DCMAKE_EXPORT_COMPILE_COMMANDS=ON >/dev/null
# Sources of the command belong to up to three programs: each file is read once.
mkdir -p build/lint
/usr/bin/python3 - build/ci/compile_commands.json build/lint/compile_commands.json <<'PY'
import json, sys
commands = {entry["file"]: entry for entry in json.load(open(sys.argv[1]))}
json.dump(list(commands.values()), open(sys.argv[2], "w"), indent=1)
PY
if [ $# -eq 0 ]; then mapfile -t files < <(git ls-files 'core/*.cpp' 'raytrace/*.cpp' 'reverb/*.cpp' 'sonar/*.cpp' 'processing/*.cpp' 'io/*.cpp' 'study/*.cpp' 'serve/*.cpp' 'app/*.cpp'); else files=("$@"); fi
# Asserts stay in (-UNDEBUG): what they rule out is not looked at.
printf '%s\n' "${files[@]}" | xargs -P "${ASDIC_JOBS:-$(nproc)}" -n 1 clang-tidy -p build/lint --quiet --extra-arg=-Wno-unknown-warning-option --extra-arg=-UNDEBUG 2> >(grep -v 'warnings generated\|Suppressed\|Use -header-filter' >&2)

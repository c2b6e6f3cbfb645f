#!/usr/bin/env bash
# clang-tidy over every source file; any finding is an error. Slow (minutes): run before a release, and by scripts/deep_check.sh.
#   scripts/lint.sh [FILES]
set -euo pipefail
cd "$(dirname "$0")/.."
command -v clang-tidy >/dev/null || { echo "lint.sh: needs Debian's clang-tidy" >&2; exit 1; }
cmake --preset ci -DCMAKE_EXPORT_COMPILE_COMMANDS=ON >/dev/null
if [ $# -eq 0 ]; then mapfile -t files < <(git ls-files 'core/*.cpp' 'raytrace/*.cpp' 'reverb/*.cpp' 'sonar/*.cpp' 'io/*.cpp' 'study/*.cpp' 'serve/*.cpp' 'app/*.cpp'); else files=("$@"); fi
printf '%s\n' "${files[@]}" | xargs -P "$(nproc)" -n 1 clang-tidy -p build/ci --quiet --extra-arg=-Wno-unknown-warning-option 2> >(grep -v 'warnings generated\|Suppressed\|Use -header-filter' >&2)

#!/usr/bin/env bash
# The 16 reference cases of BELLHOP (tests/data/bellhop) run by asdic, and how far everything is from everything, as Markdown.
#   ASDIC=path/to/asdic scripts/compare_bellhop.sh [CASE ...]
#   ASDIC=path/to/asdic scripts/compare_bellhop.sh --emulation
#   ASDIC=path/to/asdic [BELLHOP=path/to/bellhop] scripts/compare_bellhop.sh --cost [CASE ...]
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
: "${ASDIC:=$root/build/release/bin/asdic}"
[ -x "$ASDIC" ] || { echo "compare_bellhop.sh: no $ASDIC; build asdic or set ASDIC" >&2; exit 2; }
ASDIC=$ASDIC exec "${ASDIC_PYTHON:-/usr/bin/python3}" "$root/scripts/compare_bellhop.py" "$@"

#!/usr/bin/env bash
# The table of docs/guide/from-bellhop.md comes out of one command; here for two of its cases.
#   ASDIC=path/to/asdic tests/scripts/validation/compare_bellhop_script.sh
set -euo pipefail
: "${ASDIC:?the program to test}"
root=$(cd "$(dirname "$0")/../../.." && pwd)
table=$("$root/scripts/compare_bellhop.sh" deep-source-arrivals rays-upslope)
for line in "| \`deep-source-arrivals\` | BELLHOP's default against its converged | 99.2 (99.3) |" \
  "| \`rays-upslope\` | BELLHOP's default against its converged | 21 of 21 | 5.9 / 12 |" \
  "|  | asdic against BELLHOP's converged | 21 of 21 |" "|  | like BELLHOP against its default | 21 of 21 |"; do
  grep -qF "$line" <<<"$table" || { echo "not in the table: $line"; echo "$table"; exit 1; }
done
cost=$("$root/scripts/compare_bellhop.sh" --cost munk-coherent-hat rays-upslope)
for line in "| case | own rule, s | beams | as written, s | beams | BELLHOP, s |" "| \`munk-coherent-hat\` | 0." \
  "| 1920 | – |" "| \`rays-upslope\` | 0."; do
  grep -qF "$line" <<<"$cost" || { echo "not in the table of costs: $line"; echo "$cost"; exit 1; }
done
status=0
"$root/scripts/compare_bellhop.sh" no-such-case 2>/dev/null || status=$?
[ "$status" = 2 ] || { echo "an unknown case: exit status $status, expected 2"; exit 1; }
echo "two cases compared"

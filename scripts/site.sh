#!/usr/bin/env bash
# Makes the pages a site that needs no network: README, docs/, the C++ and the Python reference.
#   scripts/site.sh [FOLDER] [options of sphinx-build]     FOLDER: build/site if not given
# Open FOLDER/html/index.html. Packages: scripts/packages/test.txt. A warning is an error.
set -euo pipefail
case "${1:-}" in
  -h | --help) sed -n '2,4s/^# \{0,1\}//p' "$0"; exit 0 ;;
esac
folder=$(cd "$(dirname "$0")/.." && pwd)/build/site
if [ $# -gt 0 ] && [[ "$1" != -* ]]; then folder=$(realpath -m "$1"); shift; fi
cd "$(dirname "$0")/.."
for program in doxygen sphinx-build; do
  command -v "$program" >/dev/null ||
    { echo "site.sh: found no $program, expected the packages of scripts/packages/test.txt: scripts/setup.sh test" >&2; exit 1; }
done
mkdir -p "$folder"
rm -rf "$folder/xml"
(cat docs/site/Doxyfile; echo "INPUT = include/asdic"; echo "OUTPUT_DIRECTORY = \"$folder\"") | doxygen -
ASDIC_SITE_XML=$folder/xml sphinx-build -q -W --keep-going -b html -c docs/site -d "$folder/pages" "$@" . "$folder/html"
echo "$folder/html/index.html"

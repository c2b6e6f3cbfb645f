#!/usr/bin/env bash
# Holds scenarios drawn out of the settings' schema to laws, for as long as you like (docs/develop/laws.md).
#   scripts/laws.sh --minutes N [--seed S] [--law NAME] [--jobs J]      ASDIC=path/to/asdic to test another than build/release's
# What fails is shrunk and kept in tests/laws/found/; counts by law stand at the end. --help tells the rest.
set -euo pipefail
cd "$(dirname "$0")/.."
export ASDIC=${ASDIC:-$PWD/build/release/bin/asdic}
exec /usr/bin/python3 tests/laws/run.py "$@"

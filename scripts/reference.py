#!/usr/bin/env python3
"""Tables of settings in docs/, made by `asdic settings --markdown SECTION` of the program that $ASDIC names.

A page has them between <!-- settings: SECTION --> and <!-- end -->.
--check: exit 1 where a page is not what the program says, or scenarios/ are not what its JSON Schema says;
--update: write what it says.
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tomllib

import json_schema

ROOT = pathlib.Path(__file__).resolve().parent.parent
TABLE = re.compile(r"(<!-- settings: (\S+) -->\n)(.*?)(<!-- end -->)", re.DOTALL)


def settings(*words):
    return subprocess.run([os.environ["ASDIC"], "settings", *words], check=True, capture_output=True, text=True).stdout


def table(section):
    return settings("--markdown", section)


def faults_of_scenarios():
    schema = json.loads(settings("--schema"))
    for scenario in sorted((ROOT / "scenarios").glob("*.toml")):
        for place, fault in json_schema.faults(tomllib.loads(scenario.read_text()), schema):
            yield f"scenarios/{scenario.name}: {place} {fault}, says `asdic settings --schema`"


def main():
    update = sys.argv[1:] == ["--update"]
    if not update and sys.argv[1:] != ["--check"]:
        sys.exit(__doc__)
    found, stale = 0, []
    for page in sorted((ROOT / "docs").rglob("*.md")):
        text = page.read_text()
        made = TABLE.sub(lambda m: m[1] + table(m[2]) + m[4], text)
        found += len(TABLE.findall(text))
        if made == text:
            continue
        stale.append(str(page.relative_to(ROOT)))
        if update:
            page.write_text(made)
    if found == 0:
        sys.exit("no page has a table of settings")
    for page in stale:
        print(page + (": written" if update else ": its tables of settings are not the program's; see scripts/reference.py --update"))
    wrong = [] if update else list(faults_of_scenarios())
    print(*wrong, sep="\n", end="\n" if wrong else "")
    if (stale or wrong) and not update:
        sys.exit(1)


main()

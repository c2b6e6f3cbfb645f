#!/usr/bin/env python3
"""Tables of settings in docs/, made by `asdic settings --markdown SECTION` of the program that $ASDIC names.

A page has them between <!-- settings: SECTION --> and <!-- end -->.
--check: exit 1 where a page is not what the program says, or scenarios/ have a key that its JSON Schema does not know;
--update: write what it says.
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
TABLE = re.compile(r"(<!-- settings: (\S+) -->\n)(.*?)(<!-- end -->)", re.DOTALL)


def settings(*words):
    return subprocess.run([os.environ["ASDIC"], "settings", *words], check=True, capture_output=True, text=True).stdout


def table(section):
    return settings("--markdown", section)


def unknown_keys(value, schema, path):
    """Keys of a TOML value that its schema does not name; a schema without properties names none to hold it against."""
    if isinstance(value, list):
        for item in value:
            yield from unknown_keys(item, schema.get("items", schema), path)
    elif isinstance(value, dict):
        known = schema.get("properties") or schema.get("items", {}).get("properties")
        for key, inner in value.items() if known else ():
            if key in known:
                yield from unknown_keys(inner, known[key], f"{path}.{key}")
            else:
                yield f"{path}.{key}"


def keys_without_a_setting():
    schema = json.loads(settings("--schema"))
    for scenario in sorted((ROOT / "scenarios").glob("*.toml")):
        tables = tomllib.loads(scenario.read_text())
        for name in tables.keys() & schema["properties"].keys():
            for key in unknown_keys(tables[name], schema["properties"][name], name):
                yield f"scenarios/{scenario.name}: {key} is no setting that `asdic settings --schema` knows"


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
    unknown = [] if update else list(keys_without_a_setting())
    print(*unknown, sep="\n", end="\n" if unknown else "")
    if (stale or unknown) and not update:
        sys.exit(1)


main()

#!/usr/bin/env python3
"""A header with one type more in one of its lists: what a recipe of docs/develop/recipes.md asks for.

    one_more.py HEADER LIST TYPE INCLUDED OUT

HEADER is the file with `using LIST = std::variant<…>`, INCLUDED the header that has TYPE.
"""
import os
import re
import sys

header, name, added, included, out = sys.argv[1:]
with open(header) as file:
    text = file.read()
text, count = re.subn(rf"(using {name} = std::variant<[^>]*)>", rf"\1, {added}>", text)
if count != 1:
    sys.exit(f"{header}: found {count} lists {name}, expected one")
text = text.replace("#pragma once\n", f'#pragma once\n#include "{included}"\n', 1)
os.makedirs(os.path.dirname(out), exist_ok=True)
with open(out, "w") as file:
    file.write(text)

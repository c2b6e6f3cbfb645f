#!/usr/bin/env python3
"""Prints a C++ file that holds size and alignment of every class that headers define.

  type_sizes.py INCLUDE_DIR [--names]

Compiled with different flags and compared byte for byte it tells whether a type's place in memory depends on them.
--names prints the classes instead, in the same order.
"""
import pathlib
import re
import sys

OPENS = re.compile(r"^(inline )?namespace ([\w:]+) \{$")
CLOSES = re.compile(r"^\}  // namespace")
CLASS = re.compile(r"^(?:struct|class) (?:alignas\(\d+\) |ASDIC_API )?(\w+)(?: final)?(?: : [^{;]*)?(?: \{|$)")


def classes(header):
    """Names of the classes at namespace level that a header of ours defines; templates are left out."""
    spaces, before = [], ""
    for line in header.read_text().splitlines():
        if opened := OPENS.match(line):
            spaces.append(opened[2])
        elif CLOSES.match(line) or (line == "}" and spaces and not spaces[0].startswith("asdic")):
            spaces.pop()  # what is declared of a library's is closed without a comment
        elif (found := CLASS.match(line)) and not before.startswith("template"):
            yield "::".join([*spaces, found[1]])
        before = line


def main():
    root = pathlib.Path(sys.argv[1])
    headers = sorted(root.rglob("*.h"))
    names = sorted({name for header in headers for name in classes(header)})
    if "--names" in sys.argv:
        print("\n".join(names))
        return
    for header in headers:
        print(f'#include "{header.relative_to(root)}"')
    print("extern const unsigned long type_sizes[];\nconst unsigned long type_sizes[] = {")
    for name in names:
        print(f"    sizeof({name}), alignof({name}),")
    print("};")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Writes tests of the examples that stand at the top of the public headers: header_examples.py INCLUDE_DIR OUTPUT.cpp

Each header's first ```cpp block becomes the body of a test, which runs in a folder of its own beside copies of the scenarios."""
import pathlib
import re
import sys

root, output = map(pathlib.Path, sys.argv[1:])
HEAD = """// Written by tests/support/header_examples.py.
#include <gtest/gtest.h>

#include <filesystem>
#include <iostream>

#include "asdic/asdic.h"
#include "support/example_folder.h"
"""
DATA = "/usr/share/ferret-vis/data/etopo5.cdf"
parts = [HEAD]
for header in sorted(root.glob("*.h")):
    text = header.read_text()
    found = re.search(r"^/// ```cpp\n((?:///.*\n)*?)/// ```$", text, re.MULTILINE)
    if header.stem == "export":
        continue
    if not found:
        sys.exit(f"{header.name}: no example")
    lines = [line[4:] for line in found[1].splitlines()]
    if not 3 <= len(lines) <= 16:
        sys.exit(f"{header.name}: an example of {len(lines)} lines, expected about ten")
    body = "\n".join("  " + line if line else "" for line in lines)
    if header.stem == "ocean":
        body = f'  if (!std::filesystem::exists("{DATA}")) GTEST_SKIP() << "no ferret-datasets here";\n' + body
    parts.append(f"TEST(HeaderExample, {header.stem}) {{\n  const asdic::detail::support::ExampleFolder here;\n{body}\n}}\n")
text = "\n".join(parts)
if not output.exists() or output.read_text() != text:
    output.write_text(text)

"""The C++ reference: a section for each public header, with the words at its top, then what it
declares, in its order. Doxygen has read the headers (docs/site/Doxyfile), breathe shows them.
"""
import re
import xml.etree.ElementTree as xml
from pathlib import Path


def headers(include):
    """→ names, in the order of asdic.h; it comes first itself"""
    text = (include / "asdic.h").read_text()
    return ["asdic.h", *re.findall(r'#include "asdic/(\w+\.h)"', text)]


def words_at_top(text):
    """What stands after \\file, as reStructuredText: paragraphs and examples."""
    comment = re.search(r"/// \\file\n((?:///.*\n)+)", text)
    lines = [line[4:] for line in comment.group(1).splitlines()] if comment else []
    shown, code = [], False
    for line in lines:
        if line.startswith("```"):
            code = not code
            shown += ["", ".. code-block:: cpp", ""] if code else [""]
        else:
            shown.append("   " + line if code else re.sub(r"`([^`]+)`", r"``\1``", line))
    return re.sub(r"docs/(\w+/[\w-]+)\.md", r":doc:`/docs/\1`", "\n".join(shown))


def declared(xml_folder, header):
    """→ [(line, directive)] of classes, and of functions, types and constants outside of them"""
    found = []
    of_file = xml.parse(xml_folder / f"{header[:-2]}_8h.xml")
    for inner in of_file.iter("innerclass"):
        if inner.get("prot") == "public" and inner.text.count("::") == 1:
            compound = xml.parse(xml_folder / f"{inner.get('refid')}.xml").find("compounddef")
            line = int(compound.find("location").get("line"))
            kind = compound.get("kind")  # class or struct
            found.append((line, f".. doxygen{kind}:: {inner.text}\n   :members:\n"
                                "   :undoc-members:\n"))
    for member in xml.parse(xml_folder / "namespaceasdic.xml").iter("memberdef"):
        where = member.find("location")
        if Path(where.get("file")).name != header:
            continue
        name, kind = f"asdic::{member.findtext('name')}", member.get("kind")
        if kind == "function":
            name += re.sub(r"\s*=\s*[^,)]+", "", member.findtext("argsstring"))
        found.append((int(where.get("line")), f".. doxygen{kind}:: {name}\n"))
    return sorted(found)


def page(include, xml_folder):
    """→ the page as reStructuredText"""
    parts = []
    for header in headers(include):
        title = f"asdic/{header}"
        parts += [f"{title}\n{'-' * len(title)}\n", words_at_top((include / header).read_text())]
        parts += [directive for _, directive in declared(xml_folder, header)]
    return "\n".join(parts) + "\n"

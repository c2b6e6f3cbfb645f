#!/usr/bin/env python3
"""What the pages name exists: README.md, CONTRIBUTING.md and every page under docs/.

- `folder/file.h`, `file.{h,cpp}`, `tests/io/unit/*.cpp` in backticks: a file or folder of the tree.
  A name without its folder, or with the last of its folders, is enough.
- `--option` in backticks: a word of the program's or a script's text.
- `function()`, `Type::member`, `CamelCase`, `snake_case` in backticks: a word of the sources, the
  scenarios or the tests, or a file's name without its ending.
- A link to a file, and to a heading of a page.
- Lines of prose of at most 120 columns.
- The parts of a page of docs/theory, in their order (CONTRIBUTING.md): it ends in code and evidence.

Placeholders are in capitals (`PROBLEM/truth.py`). Blocks of code are not looked at.

    names_in_docs.py [PAGE.md ...]
"""
import fnmatch
import os
import re
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
SOURCES = (".h", ".cpp", ".py", ".sh", ".cmake", ".in", ".toml", ".json", ".txt", ".csv")
# The only endings by which a word is a file of the tree, not one of the user's (`ping.h5`).
ENDINGS = (".h", ".cpp", ".py", ".sh", ".cmake")
NOT_OURS = {"build", "__pycache__"}
# Words of other programs: cmake, GNU parallel, mpirun, BELLHOP's manual.
ELSEWHERE = {"--workflow", "--sshlogin", "--allow-run-as-root", "alphaP", "alphaS"}
# arlpy's own, on the page for those who come from it.
ELSEWHERE |= {"bottom_soundspeed", "tx_depth", "rx_depth", "rx_range", "min_angle", "max_angle",
              "tx_directionality", "time_of_arrival", "arrival_amplitude", "angle_of_departure",
              "angle_of_arrival", "arrival_number", "tx_depth_ndx", "rx_depth_ndx", "rx_range_ndx"}
# What the program puts together: units of angles, numbers of transmitters, parameters of a law,
# sides of a section, programs of the tests.
PUT_TOGETHER = re.compile(r"_(deg|rad|\d+)$|^(scattering|surface|bottom|unit|property)_")
COLUMNS = 120
PARTS = ["Assumptions and validity", "Parameters", "In the code", "Evidence"]
RESULTS = {"validation.md"}  # a page of results, not of a method


class Tree:
    """The files of a folder, and every word in its sources."""

    def __init__(self, root):
        self.root = root
        self.paths, words = set(), set()
        for folder, below, files in os.walk(root):
            below[:] = [b for b in below if b not in NOT_OURS and not b.startswith(".")]
            here = Path(folder).relative_to(root)
            self.paths.update(str(here / name) for name in [*below, *files])
            words.update(Path(name).stem for name in files)
            for name in files:
                if name.endswith(SOURCES) and Path(name) != Path(__file__).name:
                    text = (Path(folder) / name).read_text(errors="replace")
                    words.update(re.findall(r"\w+|--[a-z][\w-]*", text))
        self.words = words
        self.top = {p for p in self.paths if "/" not in p and (root / p).is_dir()}
        self.tails = {tail for path in self.paths for tail in tails_of(path)}

    def has_path(self, name):
        """As a path from the top or the tail of one; `*` stands for anything."""
        name = name.rstrip("/")
        if "*" in name:
            return any(fnmatch.fnmatchcase(tail, name) for tail in self.tails)
        return name in self.tails


def tails_of(path):
    parts = path.split("/")
    return {"/".join(parts[k:]) for k in range(len(parts))}


def braces(name):
    """`a.{h,cpp}` → [`a.h`, `a.cpp`]"""
    found = re.search(r"\{([^{}]*)\}", name)
    if not found:
        return [name]
    return [whole for one in found.group(1).split(",")
            for whole in braces(name[: found.start()] + one + name[found.end():])]


def is_path(name, tree):
    if re.search(r"(^|/)[A-Z_]{2,}(/|\.\w+$|$)", name) and not tree.has_path(name):
        return False
    if "/" in name and name.split("/")[0] in tree.top:
        return True
    return name.endswith(ENDINGS) and not name.startswith(".")


def prose(text):
    """→ [(line number, line)] outside of blocks of code and displayed formulae."""
    code = formula = False
    for number, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith("```"):
            code = not code
        elif line.strip() == "$$" and not code:
            formula = not formula
        elif not code and not formula:
            yield number, line


def faults_of_word(word, tree):
    if word.startswith("--"):
        option = re.match(r"--[a-z][\w-]*", word)
        known = not option or {option.group(), option.group()[2:].replace("-", "_")} & tree.words
        return [] if known or word in ELSEWHERE else [f"no option {option.group()}"]
    if is_path(word, tree):
        return [f"no file {name}" for name in braces(word) if not tree.has_path(name)]
    called = re.fullmatch(r"([A-Za-z_][\w:]*)(\(.*\))?", word)
    if not called:
        return []
    name = called.group(1)
    is_name = (called.group(2) or "::" in name or "_" in name.strip("_")
               or re.search(r"[a-z][A-Z]", name))
    if not is_name or name in ELSEWHERE or re.search(r"(^|_)[A-Z]+(_|$)", name):
        return []
    return [f"no {part} in the sources" for part in name.strip(":").split("::")
            if not {part, PUT_TOGETHER.sub("", part)} & tree.words]


def anchor(heading):
    """The anchor that GitHub gives a heading."""
    plain = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading).replace("`", "")
    return re.sub(r"[^\w\- ]", "", plain.strip().lower()).replace(" ", "-")


def anchors(page):
    return {anchor(line.lstrip("#")) for _, line in prose(page.read_text()) if line.startswith("#")}


def faults_of_link(page, target):
    if re.match(r"\w+:", target):
        return []
    path, _, heading = target.partition("#")
    to = (page.parent / path).resolve() if path else page
    if not to.exists():
        return [f"no {target}"]
    if heading and to.suffix == ".md" and heading not in anchors(to):
        return [f"no heading {target}"]
    return []


def faults_of_parts(headings):
    """Of a page of theory: code and evidence are its last parts, none comes before its turn."""
    order = [PARTS.index(h) for h in headings if h in PARTS]
    missing = [f"no part \"{part}\"" for part in PARTS[2:] if part not in headings]
    turned = ["parts out of order"] if order != sorted(order) or headings[-1:] != PARTS[-1:] else []
    return missing or turned


def faults(page, tree):
    found = []
    text = page.read_text()
    shown = os.path.relpath(page, tree.root)
    for number, line in prose(text):
        said = []
        for word in re.findall(r"`([^`\n]+)`", line):
            for part in word.split():
                said += faults_of_word(part.rstrip(",;"), tree)
        if len(line) > COLUMNS and not re.match(r" {4}|\s*(\||!?\[)", line) and " " in line.strip():
            said.append(f"{len(line)} columns")
        found += [f"{shown}:{number}: {fault}" for fault in said]
    whole = "\n".join(line if line else "" for _, line in prose(text))
    for target in re.findall(r"\]\(([^)\s]+)\)", whole):
        found += [f"{shown}: {fault}" for fault in faults_of_link(page, target)]
    if page.parent.name == "theory" and page.name not in RESULTS:
        headings = [line[3:].strip() for _, line in prose(text) if line.startswith("## ")]
        found += [f"{shown}: {fault}" for fault in faults_of_parts(headings)]
    return found


def proves_itself():
    """What is there passes, and each kind of fault is found."""
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        (root / "core").mkdir()
        (root / "core" / "angle.h").write_text('double to_degrees(double); // "--quiet"\n')
        (root / "core" / "angle.cpp").write_text("struct AngleTable {};\n")
        page = root / "page.md"
        page.write_text("# One heading\n")
        tree = Tree(root)
        cases = [
            ("`core/angle.h`", 0), ("`angle.h`", 0), ("`core/angle.{h,cpp}`", 0), ("`core/*.h`", 0),
            ("`core/`", 0), ("`core/missing.h`", 1), ("`missing.h`", 1), ("`core/angle.{h,py}`", 1),
            ("`core/*.py`", 1), ("`core/elsewhere`", 1), ("`PLACE/angle.h`", 0), ("`ping.h5`", 0),
            ("`to_degrees()`", 0), ("`to_radians()`", 1), ("`AngleTable`", 0), ("`RangeTable`", 1),
            ("`AngleTable::none_such`", 1), ("`--quiet`", 0), ("`--loud`", 1),
            ("[a](core/angle.h)", 0), ("[a](core/none.h)", 1), ("[a](#one-heading)", 0),
            ("[a](#another)", 1), ("word " * 30, 1), ("```\n`core/missing.h`\n```", 0),
        ]
        for text, count in cases:
            page.write_text(f"# One heading\n{text}\n")
            got = faults(page, tree)
            if len(got) != count:
                print(f"this test is wrong about {text}: {got}")
                return False
    for headings, count in [
        (["Model", "Parameters", "In the code", "Evidence"], 0), (["In the code", "Evidence"], 0),
        (["Evidence", "In the code"], 1), (["Model", "Evidence"], 1),
        (["In the code", "Evidence", "Cost"], 1), (["Parameters", "Assumptions and validity",
                                                    "In the code", "Evidence"], 1),
    ]:
        if len(faults_of_parts(headings)) != count:
            print(f"this test is wrong about the parts {headings}")
            return False
    return True


def main():
    if not proves_itself():
        return 1
    known = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
    pages = [Path(p).resolve() for p in sys.argv[1:]] or known
    tree = Tree(ROOT)
    found = [fault for page in pages for fault in faults(page, tree)]
    print("\n".join(found))
    print(f"{len(pages)} pages, {len(found)} faults")
    return 1 if found or not pages else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""The pages as a site (scripts/site.sh): Sphinx, doxygen and breathe make it without a warning; every
page and public name is in it; every link within it leads somewhere, to a heading if it says so;
nothing in it is fetched from a network; the search knows its words.

Every day with a plain theme, which is quick. ASDIC_DEEP=1: as users get it, and Chromium, where it is
installed, opens pages from the disk: formulae are set, the search finds.

    site.py [HTML]      HTML: a site that is there already
"""
import ast
import os
import re
import shutil
import subprocess
import sys
import tempfile
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests/support"))
from deep import DEEP  # noqa: E402

FETCHED = {"script": "src", "img": "src", "link": "href", "iframe": "src", "source": "src"}


class Page(HTMLParser):
    """Links, anchors and what the page fetches."""

    def __init__(self, text):
        super().__init__()
        self.links, self.ids, self.fetched = [], set(), []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        self.ids.update(attrs[key] for key in ("id", "name") if attrs.get(key))
        if tag == "a" and attrs.get("href"):
            self.links.append(attrs["href"])
        if tag in FETCHED and attrs.get(FETCHED[tag]):
            self.fetched.append(attrs[FETCHED[tag]])


def faults_of_links(html):
    """Every link of every page that does not leave the site."""
    pages = {path: Page(path.read_text()) for path in sorted(html.rglob("*.html"))}
    found = []
    for path, page in pages.items():
        for link in page.links + page.fetched:
            parts = urlsplit(link)
            shown = f"{path.relative_to(html)}: {link}"
            if parts.scheme or parts.netloc:
                if link in page.fetched and parts.scheme != "data":
                    found.append(f"{shown}: is fetched from elsewhere")
                continue
            to = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            if not to.is_file():
                found.append(f"{shown}: no such file")
            elif parts.fragment and to in pages and unquote(parts.fragment) not in pages[to].ids:
                found.append(f"{shown}: no such place")
    return found


def proves_itself():
    """Links that lead nowhere are found, others are not."""
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder).resolve()
        (folder / "b.html").write_text('<h1 id="here">b</h1>')
        for text, count in [
            ('<a href="b.html#here">', 0), ('<a href="b.html#there">', 1), ('<a href="c.html">', 1),
            ('<a href="#none">', 1), ('<a href="https://x.org/y">', 0), ('<img src="b.png">', 1),
            ('<script src="https://x.org/y.js">', 1), ('<img src="data:image/png;base64,A">', 0),
        ]:
            (folder / "a.html").write_text(text)
            found = faults_of_links(folder)
            if len(found) != count:
                print(f"this test is wrong about {text}: {found}")
                return False
    return True


def faults_of_contents(html):
    """Every page of docs/, every public header and name of the package is in it."""
    found = []
    pages = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md",
             *(ROOT / "docs").rglob("*.md")]
    for page in pages:
        if not (html / page.relative_to(ROOT)).with_suffix(".html").is_file():
            found.append(f"{page.relative_to(ROOT)} is not in the site")
    cpp = (html / "docs/site/cpp.html").read_text()
    for header in (ROOT / "include/asdic").glob("*.h"):
        declared = re.findall(r"^(?:struct|class)(?: ASDIC_API)? (\w+) .*\{", header.read_text(), re.M)
        found += [f"{header.name}: {name} is not in the C++ reference" for name in declared
                  if f'id="_CPPv4N5asdic{len(name)}{name}E"' not in cpp]
    python = (html / "docs/site/python.html").read_text()
    module = ast.parse((ROOT / "python/asdic/__init__.py").read_text())
    names = next(ast.literal_eval(line.value) for line in module.body
                 if isinstance(line, ast.Assign) and line.targets[0].id == "__all__")
    modules = {path.stem for path in (ROOT / "python/asdic").glob("*.py")} - {"channel"}
    found += [f"asdic.{name} is not in the Python reference" for name in names
              if f'id="asdic.{name}"' not in python and name not in modules - {"open"}]
    index = (html / "searchindex.js").read_text()
    found += [f"the search does not know {word}" for word in ("reverber", "eigenray")
              if word not in index]
    return found


def shown(page, query=""):
    """A page as Chromium makes it, opened from the disk."""
    with tempfile.TemporaryDirectory() as profile:
        return subprocess.run(
            ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic",
             "--no-first-run", "--disable-background-networking", "--disable-component-update",
             "--disable-sync", f"--user-data-dir={profile}", "--virtual-time-budget=20000",
             "--dump-dom", page.as_uri() + query],
            capture_output=True, text=True, timeout=120, check=True).stdout


def faults_of_browser(html):
    found = []
    for name in ("docs/theory/waves.html", "docs/theory/rays.html", "docs/formats/compare.html"):
        there = (html / name).read_text().count('class="math notranslate')
        dom = shown(html / name)
        if dom.count("MathJax_SVG_Display") + dom.count('class="MathJax_SVG"') < there:
            found.append(f"{name}: {there} formulae, not all are set")
        if "merror" in re.sub(r"<style.*?</style>|<script.*?</script>", "", dom, flags=re.S):
            found.append(f"{name}: a formula is in error")
    results = shown(html / "search.html", "?q=reverberation")
    if not re.search(r'class="search"[\s\S]*theory/reverberation', results):
        found.append("the search does not find the page on reverberation")
    return found


def main():
    if not proves_itself():
        return 1
    if not all(shutil.which(name, path="/usr/bin") for name in ("sphinx-build", "doxygen")):
        print("skipped: no sphinx-build or doxygen (scripts/packages/test.txt)")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        html = Path(folder).resolve() / "html"
        if len(sys.argv) > 1:
            html = Path(sys.argv[1]).resolve()
        else:
            environment = dict(os.environ, PATH=f"/usr/bin:{os.environ['PATH']}")
            quick = [] if DEEP else ["-D", "html_theme=basic"]
            made = subprocess.run([ROOT / "scripts/site.sh", folder, *quick], env=environment,
                                  capture_output=True, text=True)
            if made.returncode != 0:
                print(made.stdout + made.stderr)
                return 1
        found = faults_of_links(html) + faults_of_contents(html)
        browser = DEEP and shutil.which("chromium") is not None
        if browser:
            found += faults_of_browser(html)
        pages = len(list(html.rglob("*.html")))
    print("\n".join(found))
    print(f"{pages} pages, {len(found)} faults" + (", seen in Chromium" if browser else ""))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""The page of a study and of a comparison: whole HTML that asks no network for anything, with the numbers of the
file, and with nothing of the study's own words as markup.

    ASDIC=build/ci/bin/asdic report.py
"""
import os
import subprocess
import sys
import tempfile
from html.parser import HTMLParser
from pathlib import Path

import h5py

ROOT = Path(__file__).resolve().parents[3]
ASDIC = str(Path(os.environ["ASDIC"]).resolve())
VOID = {"meta", "link", "img", "br"}


def check(passed, what):
    if not passed:
        raise SystemExit(f"report.py: {what}")


class Page(HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.open, self.words, self.tags, self.sources = [], [], {}, []
        self.feed(text)
        self.close()
        check(not self.open, f"elements that are not closed: {self.open}")

    def handle_starttag(self, tag, attributes):
        self.tags[tag] = self.tags.get(tag, 0) + 1
        self.sources += [value for key, value in attributes if key in ("src", "href")]
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        check(self.open and self.open.pop() == tag, f"</{tag}> closes another element")

    def handle_data(self, words):
        self.words.append(words)


def page(path):
    made = Page(path.read_text(encoding="utf-8"))
    check("script" not in made.tags, "no script")
    check(all(source.startswith("data:") for source in made.sources), made.sources)
    check(made.tags["img"] >= 3, "pictures")
    return " ".join(made.words)


def run(*words):
    done = subprocess.run([ASDIC, *words], capture_output=True, text=True)
    check(done.returncode == 0, done.stdout + done.stderr)


def main():
    os.chdir(tempfile.mkdtemp())
    text = (ROOT / "scenarios" / "studies" / "known_answer.toml").read_text()
    hostile = "<script>alert(1)</script> & more"
    text = text.replace("Pd of a Swerling 1 target in white noise against its closed form", hostile)
    Path("one.toml").write_text(text)
    Path("two.toml").write_text(text.replace("duration = 0.25", "duration = 0.5"))
    rows = ["--set", "study.realisations=200"]
    run("study", "one.toml", *rows, "--report")
    words = page(Path("one.html"))
    with h5py.File("one.h5") as f:
        pd = f["summary/convergence/pd"][-1]
        check(f"{pd:.4g}" in words, "the answer")
        check(f.attrs["identity"].decode() in words, "the identity")
    for told in (hostile, "uniform: low 20000.0, high 40000.0", "0.0001", "SHA-256 of"):
        check(told in words, f"{told} is told")
    run("study", "--compare", "one.toml", "two.toml", *rows, "--report")
    words = page(Path("one_and_two.html"))
    check("two less one" in words or "one_to_two" in words, "the difference")
    again = subprocess.run([ASDIC, "plot", "one.h5", "--html"], capture_output=True, text=True)
    check(again.returncode == 0, "a page of ours may be written again")
    Path("one.html").write_text("mine")
    kept = subprocess.run([ASDIC, "plot", "one.h5", "--html"], capture_output=True, text=True)
    check(kept.returncode == 2 and Path("one.html").read_text() == "mine", "nobody else's page is written over")
    print("report: all as it should be")


main()

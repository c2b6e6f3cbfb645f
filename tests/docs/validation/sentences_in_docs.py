#!/usr/bin/env python3
"""A sentence carries one thought and ends: none in the pages has more than 40 words.

Pages are README.md, CONTRIBUTING.md and every page under docs/. Prose is looked at: no code,
tables, headings or lists of literature. A name in backticks and a formula are one word each, a link
is the words of its text. Numbers, units and signs that stand alone are no words. A list's items are
sentences of their own.

    sentences_in_docs.py [--longer-than N] [PAGE.md ...]
"""
import argparse
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
MOST_WORDS = 40
# Ends with a point, and no sentence ends there.
SHORT = (r"(?:\b(?:e\.g|i\.e|cf|al|approx|vs)|(?<!\S)[A-Z])\."
         r"|\b(?:chs?|eqs?|figs?|nos?|pp?|vol)\.(?=\s+\d)")
ITEM = re.compile(r"\s*(?:[-*+]|\d+\.)\s+")
LITERATURE = re.compile(r"\s*\[\d+\] ")


def with_formulae_in_line(text):
    """Displayed formulae become one word; the sentence goes on behind it in lower case."""
    def word(found):
        lines = found.group().count("\n")
        goes_on = re.match(r"[a-z(]", text[found.end():])
        return " formula" + ("\0" * lines if goes_on else "\n" * lines)

    return re.sub(r"\n\s*\$\$\n.*?\n[ \t]*\$\$\n\s*", word, text + "\n", flags=re.DOTALL)


def paragraphs(text):
    """→ [(first line's number, text)] of prose; each item of a list is one."""
    code = comment = False
    number, first, lines = 1, 0, []

    def ended():
        nonlocal lines
        whole, lines = " ".join(lines), []
        return [(first, whole)] if whole and not LITERATURE.match(whole) else []

    for line in [*with_formulae_in_line(text).split("\n"), ""]:
        bare = line.replace("\0", " ").strip()
        fence = bare.startswith("```")
        code ^= fence
        comment = (comment or bare.startswith("<!--")) and "-->" not in bare
        indented = not lines and line.startswith("    ")
        other = bare.startswith(("#", "|", "![", "<"))
        if code or fence or comment or indented or other or not bare:
            yield from ended()
        else:
            item = ITEM.match(line)
            if item:
                yield from ended()
            first = first if lines else number
            lines.append(bare[len(item.group().lstrip()):] if item else bare)
        number += 1 + line.count("\0")
    yield from ended()


def plain(text):
    """As it is read: names and formulae are one word each, a link is its text."""
    text = re.sub(r"``[^`]+``|`[^`]+`", "Name", text)
    text = re.sub(r"\$[^$]+\$", "Formula", text)
    text = re.sub(r"!?\[([^]]*)\]\([^)]*\)", r"\1", text)
    return re.sub(r"[*_]{1,3}(?=\S)|(?<=\S)[*_]{1,3}", "", text)


def sentences(text):
    """→ the sentences of a paragraph of plain text."""
    held = re.sub(SHORT, lambda m: m.group().replace(".", "\0"), text)
    parts = re.split(r"(?<=[.!?])[)\"”]*\s+", held)
    return [part.replace("\0", ".") for part in parts]


def words(sentence):
    return sum(1 for word in sentence.split() if re.search(r"[^\W\d_]{2}|\b[aAI]\b", word))


def long_sentences(text, most):
    """→ [(line, words, sentence)]"""
    return [(number, words(one), one) for number, whole in paragraphs(text)
            for one in sentences(plain(whole)) if words(one) > most]


def proves_itself():
    """Each way to be long is found, each way to be no sentence is not."""
    word = "word "
    for text, most in [
        (word * 39 + "end.", 40), ("A `" + word * 9 + "` name.", 3),
        ("In $" + word * 9 + "$ too.", 3),
        ("```\n" + word * 50 + "\n```", 0), ("| " + word * 50 + "|", 0), ("## " + word * 50, 0),
        ("So:\n\n$$\n" + word * 50 + "\n$$", 2), ("- one item\n- another item", 2),
        ("One thought. Another thought.", 2), ("Jensen et al. Wrote it.", 5),
        ("The sum\n\n$$\nx\n$$\n\nis right.", 5), ("One\nline of three.", 4),
        ("Ends here:\n\n$$\nx\n$$\n\nThen more.", 3), ("[1] A. Author, a very long title.", 0),
        ("See [two words](a-long-address.md).", 3), ("2 < 3 · 4 m/s holds.", 1),
        ("Ends. (Another one.) A third.", 2), ("See ch. 3 of it.", 4),
        ("She says no. He does not.", 3),
    ]:
        counts = [words(one) for _, whole in paragraphs(text) for one in sentences(plain(whole))]
        if max(counts, default=0) != most:
            print(f"this check counts {counts} in {text[:60]!r}, expected {most}")
            return False
        if (most and not long_sentences(text, most - 1)) or long_sentences(text, most):
            print(f"this check is wrong about {text[:60]!r}")
            return False
    return True


def main():
    options = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    options.add_argument("--longer-than", type=int, default=MOST_WORDS, metavar="N")
    options.add_argument("pages", nargs="*", type=Path)
    options = options.parse_args()
    if not proves_itself():
        return 1
    known = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
    found = 0
    for page in options.pages or known:
        for number, count, sentence in long_sentences(page.read_text(), options.longer_than):
            shown = page.relative_to(ROOT) if page.is_relative_to(ROOT) else page
            print(f"{shown}:{number}: {count} words: {sentence}")
            found += 1
    print(f"{found} sentences of more than {options.longer_than} words")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())

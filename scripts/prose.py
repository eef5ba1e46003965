#!/usr/bin/python3
"""Count constructions that make prose hard to read, per 1000 words of comments and documents.

    scripts/prose.py [FILE...]     default: src/*/*.[ch], include/*.h, README.md, doc/*.md; the largest counts first

Columns: words; free relatives used as nouns ("what ...", "where ...", "who ..."); pronouns (it, they, them, its,
their); "that of" and "those of"; blank lines inside C functions in per cent of all lines. The total should stay below 2,
11 and 0.2.
"""

import glob
import re
import sys

FREE = re.compile(r"(?<!\w)(?:what|whatever|whoever|whose|who)(?!\w)|(?<!\w)where(?= (?:it|they|one|none|nothing|there|that|the|a)\b)",
                  re.IGNORECASE)
PRONOUN = re.compile(r"(?<!\w)(?:it|they|them|its|their)(?!\w)", re.IGNORECASE)
THAT_OF = re.compile(r"(?<!\w)(?:that|those) of(?!\w)", re.IGNORECASE)
WORD = re.compile(r"[A-Za-z][A-Za-z'-]*")


def comments(text):
    """The comments of a C file, and its string literals."""
    pattern = r'/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*"'
    return "\n".join(re.findall(pattern, re.sub(r'#\s*include\s*"[^"]*"', "", text), re.DOTALL))


def prose(path, text):
    """The prose of a file: comments and messages of C, documents without code and tables."""
    if path.endswith((".c", ".h")):
        return comments(text)
    text = re.sub(r"```.*?```", "", text, flags=re.DOTALL)
    return "\n".join(line for line in text.split("\n") if not line.startswith(("    ", "|", "!")))


def blank_lines(text):
    """Blank lines inside functions, and all lines inside functions."""
    blank = lines = 0
    inside = False
    for line in text.split("\n"):
        if line.startswith("}"):
            inside = False
        if inside:
            lines += 1
            blank += not line.strip()
        if re.match(r"[a-z].*\) \{$", line):
            inside = True
    return blank, lines


def count(path):
    with open(path, encoding="utf-8") as file:
        text = file.read()
    words = prose(path, text)
    blank, lines = blank_lines(text) if path.endswith(".c") else (0, 0)
    return [len(WORD.findall(words)), len(FREE.findall(words)), len(PRONOUN.findall(words)), len(THAT_OF.findall(words)),
            blank, lines]


def row(name, counts):
    n_words, *found, blank, lines = counts
    rates = "".join(f"{1000 * n / max(n_words, 1):9.1f}" for n in found)
    share = f"{100 * blank / lines:9.1f}" if lines else ""
    return f"{name:45s}{n_words:8d}{rates}{share}"


def main():
    paths = sys.argv[1:] or sorted(glob.glob("src/*/*.[ch]") + glob.glob("include/*.h") + ["README.md"] + glob.glob("doc/*.md"))
    counts = {path: count(path) for path in paths}
    print(f"{'file':45s}{'words':>8s}{'what':>9s}{'it':>9s}{'that of':>9s}{'blank %':>9s}")
    for path in sorted(paths, key=lambda p: -sum(counts[p][1:4])):
        print(row(path, counts[path]))
    print(row("all", [sum(column) for column in zip(*counts.values())]))


if __name__ == "__main__":
    main()

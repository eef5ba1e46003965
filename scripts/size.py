#!/usr/bin/python3
"""Print the size of the program: lines, files, functions, tests, words of the documents, and lines per folder.

Functions are counted by the layout of clang-format: from a head at the begin of a line to a closing brace there. A
static function is lonely if its file names it once beside the definition. Printed as a table of Markdown for
doc/architecture.md, section 6.
"""

import re
import signal
import statistics
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parent.parent
FOLDERS = re.search(r"^rooms += (.*)", (TOP / "Makefile").read_text(), re.M).group(1).split()


def n_lines(paths):
    return sum(len(path.read_text().splitlines()) for path in paths)


def sources(folder):
    """All C files and headers below a folder."""
    return sorted(path for path in (TOP / folder).rglob("*.[ch]"))


def functions(path):
    """Of each function in a file: the name, the number of lines, and whether it is a static function used once."""
    text = path.read_text()
    code = re.sub(r'//[^\n]*|/\*.*?\*/|"(\\.|[^"\\])*"', "", text, flags=re.S)
    lines = text.split("\n")
    start = None
    for i, line in enumerate(lines):
        if start is None and line.endswith(") {"):
            # the head may take several lines
            first = i
            while lines[first][:1].isspace():
                first -= 1
            is_data = re.match(r"(struct|enum|union)?\s*\w+ = |#|typedef", lines[first])
            if re.match(r"[A-Za-z]", lines[first]) and "(" in lines[first] and not is_data:
                start = first
        elif line == "}" and start is not None:
            name = re.search(r"(\w+)\s*\(", " ".join(lines[start : start + 4])).group(1)
            n_uses = len(re.findall(rf"\b{name}\b", code))
            yield name, i - start + 1, lines[start].startswith("static") and n_uses == 2
            start = None


def main():
    source, header = sources("src"), sources("include")
    every = [function for path in source if path.suffix == ".c" for function in functions(path)]
    sizes = [size for _, size, _ in every]
    low, median, high = statistics.quantiles(sizes, n=4)
    tests = [path for path in (TOP / "tests").rglob("*") if path.suffix in (".c", ".h", ".sh", ".py", ".txt", ".tsv")]
    documents = [TOP / "README.md", TOP / "CONTRIBUTING.md", TOP / "CHANGES.md", *sorted((TOP / "doc").glob("*.md"))]
    words = sum(len(path.read_text().split()) for path in documents)
    print("| what | number |\n|---|--:|")
    for what, number in (
        ("lines of src and include", n_lines(source + header)),
        ("files", len(source + header)),
        ("functions", len(sizes)),
        ("lines of a function: quartiles", f"{low:.0f}, {median:.0f}, {high:.0f}"),
        ("static functions used once", sum(is_lonely for _, _, is_lonely in every)),
        ("lines of tests", n_lines(tests)),
        ("words of the documents", words),
    ):
        print(f"| {what} | {number:,} |" if isinstance(number, int) else f"| {what} | {number} |")

    print("\n| folder | lines | files | functions | used once |\n|---|--:|--:|--:|--:|")
    for folder in FOLDERS:
        here = sources(f"src/{folder}")
        found = [function for path in here if path.suffix == ".c" for function in functions(path)]
        lonely = sum(is_lonely for _, _, is_lonely in found)
        print(f"| {folder} | {n_lines(here):,} | {len(here)} | {len(found)} | {lonely} |")


if __name__ == "__main__":
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # size.py | head
    sys.exit(main())

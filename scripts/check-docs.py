#!/usr/bin/python3
"""Check that everything that documents and comments name exists.

    scripts/check-docs.py

In doc/*.md, README.md and CONTRIBUTING.md these are files and folders, links and their anchors, names with a low line or
brackets (functions, keys, variables; in doc/model.md only those in backticks), tests of `make test TEST=...`, tables of
`scripts/measure/DOCUMENT.py NAME`, and sections of `build/verify/verify NAME`. In the comments of src, include and tests
they are files and sections of documents. The script also checks that no two tests have the same name, that fenced blocks
state their language, and that a block of output follows the block of its command (scripts/documents.py). The exit code is
1 if anything is missing.
"""

import glob
import os
import re
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
FOLDERS = "src|tests|scripts|cases|doc"

# A part of a path or of a name that stands for any.
ANY = re.compile(r"(^|[/_.])(x|x_more|NAME|ROOM|Q)([/_.]|$)")


def read(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


def files(*patterns):
    return sorted(os.path.relpath(p, ROOT) for pattern in patterns for p in glob.glob(os.path.join(ROOT, pattern)))


def exists(path):
    return bool(glob.glob(os.path.join(ROOT, path)))


def code_words():
    """Every word of the sources, and every word between quotes or colons in them: functions, fields, keys, variables."""
    text = "".join(read(path) for path in files("src/*/*", "include/*", "scripts/*", "scripts/*/*.py", "tests/*.[ch]", "tests/*/*", "Makefile",
                                                "cases/*.yaml", "cases/*/*.yaml", "doc/examples/*") if "." in path or "Makefile" in path)
    return set(re.findall(r"\w+", text))


def anchor_of(heading):
    """As GitHub makes it."""
    words = re.sub(r"[`*]", "", heading.strip().lower())
    return re.sub(r"[^\w\- ]", "", words).replace(" ", "-")


def headings(path):
    return re.findall(r"^#+ +(.*)$", re.sub(r"^```.*?^```", "", read(path), flags=re.M | re.S), re.M)


def test_names():
    return [re.sub(r"^test_|\.(c|sh)$", "", os.path.basename(p)) for p in files("tests/*/test_*.c", "tests/*/test_*.sh")]


def missing_paths(text):
    """What looks like a path from the top of the tree, and is none."""
    for path in re.findall(rf"(?<![\w/.$-])((?:{FOLDERS})/(?:[\w/*-]|\.(?=\w)|\[ch\])*)", text):
        if not ANY.search(path) and not exists(path) and not exists(path + "*"):
            yield path


def is_known(name, words):
    """Whether a name is a word of the sources, or one of them is its beginning up to a low line: "order_%s"."""
    beginnings = [name[: i + 1] for i, character in enumerate(name) if character == "_"]
    if name.endswith("_") and any(word.startswith(name) for word in words):
        return True  # a prefix
    return name in words or ANY.search(name) or any(beginning in words for beginning in beginnings)


def faults_of_document(path, words, tests, tables, sections):
    text = read(path)
    folder = os.path.dirname(path)
    for name in missing_paths(re.sub(r"\]\([^)]*\)", "]", text)):
        yield f"there is no {name}"
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        if re.match(r"[a-z]+:", target):
            continue
        file, _, anchor = target.partition("#")
        file = os.path.normpath(os.path.join(folder, file)) if file else path
        if not exists(file):
            yield f"a link to {target}, which is not there"
        elif anchor and file.endswith(".md") and anchor not in [anchor_of(h) for h in headings(file)]:
            yield f"a link to {target}: {file} has no such heading"
    blocks = re.findall(r"^```([^\n]*)\n.*?^```$", text, re.M | re.S)
    for before, block in zip([""] + blocks, blocks):
        if not re.fullmatch(r"(sh|python)( minutes)?|yaml|c|console|output", block):
            yield f"a block of '{block}': scripts/documents.py lists the languages"
        if block == "output" and before.partition(" ")[0] not in ("sh", "python"):
            yield "a block of output without a block of commands above"
    inline = re.sub(r"^```.*?^```", "", text, flags=re.M | re.S)
    for name in re.findall(r"`([a-z]\w*_\w*|[a-z]\w*\(\))`", inline):
        if not is_known(name.removesuffix("()"), words):
            yield f"`{name}` is nowhere in the sources"
    # names in diagrams and blocks of code too; in doc/model.md a low line is a subscript
    bare = [] if path == "doc/model.md" else re.findall(r"(?<![\w/.$-])([a-z]\w*_\w+)(?![\w/.-])", text)
    for name in bare:
        if not is_known(name, words) and name not in tests:
            yield f"{name} is nowhere in the sources"
    for names in re.findall(r'make (?:test|valgrind|mutants)[^`\n]*? TEST=("[^"]*"|[\w]+)', text):
        for name in names.strip('"').split():
            if name not in tests:
                yield f"there is no test called {name}"
    for script, name in re.findall(r"scripts/measure/(\w+)\.py\s([a-z]\w*)", text):
        if name not in tables.get(script, []):
            yield f"scripts/measure/{script}.py has no table {name}"
    for name in re.findall(r"verify/verify ([a-z]\w*)", text):
        if name not in sections:
            yield f"verify has no section {name}"


def faults_of_source(path):
    for comment in re.findall(r"/\*.*?\*/|//[^\n]*|^#[^\n]*", read(path), re.S | re.M):
        comment = re.sub(r"\n[ *#]*", " ", comment)
        for name in missing_paths(comment):
            yield f"there is no {name}"
        for document, numbers in re.findall(r"doc/(\w+)\.md, sections? ((?:\d+(?:, | and )?)+)", comment):
            if not exists(f"doc/{document}.md"):
                continue  # told above
            for number in re.findall(r"\d+", numbers):
                if not re.search(rf"^## {number}\.", read(f"doc/{document}.md"), re.M):
                    yield f"doc/{document}.md has no section {number}"


def main():
    words, tests = code_words(), test_names()
    tables = {os.path.basename(p)[:-3]: re.findall(r"^@table.*?^def (\w+)", read(p), re.M | re.S) for p in files("scripts/measure/*.py")}
    sections = set(re.findall(r"\w+", "".join(read(p) for p in files("tests/verify/*.c"))))
    faults = [(path, fault) for path in files("doc/*.md", "README.md", "CONTRIBUTING.md")
              for fault in faults_of_document(path, words, tests, tables, sections)]
    sources = files("src/*/*.[ch]", "include/*.h", "tests/*.[ch]", "tests/*.sh", "tests/*/*.[ch]", "tests/*/*.sh", "scripts/*.sh")
    faults += [(path, fault) for path in sources for fault in faults_of_source(path)]
    faults += [("tests", f"{tests.count(name)} tests are called {name}") for name in sorted(set(tests)) if tests.count(name) > 1]
    for path, fault in dict.fromkeys(faults):
        print(f"{path}: error: {fault}", file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())

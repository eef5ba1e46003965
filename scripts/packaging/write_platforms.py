#!/usr/bin/python3
"""write_platforms.py DOCUMENT FOLDER NAME...: put the rows FOLDER/NAME.row into the table of platforms of a document."""

import pathlib
import sys

document, work, names = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3:]
lines = document.read_text().split("\n")
first = lines.index("`make test-platforms`") + 4  # an empty line, heads, rule
last = first
while lines[last].startswith("|"):
    last += 1
rows = {line.split()[1]: line for line in lines[first:last]}
for name in names:
    rows.pop(name, None)
    row = (work / f"{name}.row").read_text().rstrip("\n")
    if row:
        rows[name] = row
lines[first:last] = [rows[name] for name in sorted(rows)]
document.write_text("\n".join(lines))

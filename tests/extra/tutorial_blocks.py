"""tutorial_blocks.py ROOT: writes the blocks of doc/tutorial.md as files into this folder."""

import sys

sys.path.insert(0, f"{sys.argv[1]}/scripts")
import documents

scripts = ""
for number, block in enumerate(documents.blocks_of(open(f"{sys.argv[1]}/doc/tutorial.md", encoding="utf-8").read())):
    if block.kind == "output":
        continue
    scripts += block.text if block.kind == "python" else ""
    with open(block.file or f"{number:02}-{block.kind}", "w", encoding="utf-8") as file:
        file.write(scripts if block.kind == "python" else block.text)

#!/usr/bin/python3
"""Run the notebook doc/shoal.ipynb and write its outputs into it, so that a reader sees them without running it.

    scripts/notebook.py            run all cells and replace the outputs
    scripts/notebook.py --check    check that they print what the notebook shows

The exit code is 0, 1 if with --check a cell prints something else, and 2 for a wrong command line. The script needs nbconvert
and ipykernel (Debian: jupyter-nbconvert, python3-ipykernel).
"""

import argparse
import os
import sys
import tempfile

import nbformat
from documents import is_same_line
from nbconvert.preprocessors import ExecutePreprocessor

HERE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
NOTEBOOK = os.path.join(HERE, "doc", "shoal.ipynb")


def run(notebook):
    """Run all cells in a folder of their own; remove what differs from run to run."""
    os.environ["PYTHONPATH"] = os.path.join(HERE, "scripts")
    with tempfile.TemporaryDirectory() as folder:
        ExecutePreprocessor(timeout=600, kernel_name="python3").preprocess(notebook, {"metadata": {"path": folder}})
    for cell in notebook.cells:
        cell.metadata.pop("execution", None)
        if cell.cell_type == "code":
            cell.outputs = [output for output in cell.outputs if output.get("name") != "stderr"]


def printed(notebook):
    """The lines that the cells print."""
    return [line for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs
            if output.output_type == "stream" for line in output.text.splitlines()]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="compare what the cells print instead of replacing it")
    options = parser.parse_args()
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    shown = printed(notebook)
    run(notebook)
    if not options.check:
        nbformat.write(notebook, NOTEBOOK)
        return
    now = printed(notebook)
    same = len(shown) == len(now) and all(is_same_line(*lines) for lines in zip(shown, now))
    if not shown or not same:
        sys.exit("notebook.py: doc/shoal.ipynb shows\n" + "\n".join(shown) + "\nand its cells print\n" + "\n".join(now))


if __name__ == "__main__":
    main()

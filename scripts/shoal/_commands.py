"""The commands of a wheel: shoal, the program itself; shoal-plot and shoal-animate, the scripts plot.py and animate.py."""

import importlib
import os
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent


def shoal():
    """Become the program, which draws with this Python."""
    os.environ["SHOAL_PYTHON"] = sys.executable
    program = str(HERE / "bin/shoal")
    os.execv(program, [program, *sys.argv[1:]])


def _script(name):
    """Import a script, which may import another one, and run it under the name of the command."""
    sys.path.insert(0, str(HERE / "scripts"))
    sys.exit(importlib.import_module(name).main(sys.argv[1:]))


def plot():
    """Run plot.py."""
    _script("plot")


def animate():
    """Run animate.py."""
    _script("animate")

"""Which interpreter of Python has a module: for the message where the module is missing. Imports no other package."""

import glob
import os
import subprocess
import sys


def _has(interpreter, module):
    try:
        command = [interpreter, "-c", f"import {module}"]
        return subprocess.run(command, capture_output=True, timeout=30, check=False).returncode == 0
    except (OSError, subprocess.TimeoutExpired):
        return False


def advice(module):
    """The sentence with the first interpreter that has the module: the system's, or one on PATH."""
    folders = ["/usr/bin", *os.get_exec_path()]
    found = [path for folder in folders for path in sorted(glob.glob(os.path.join(folder, "python3*")))
             if os.path.basename(path).lstrip("python3").strip(".0123456789") == "" and os.access(path, os.X_OK)]
    other = next((path for path in dict.fromkeys(found) if _has(path, module)), None)
    remedy = f"{other} has it" if other else f"install it with {sys.executable} -m pip install {module}"
    return f"shoal needs {module}, which {sys.executable} does not have; {remedy}"

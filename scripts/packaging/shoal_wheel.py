"""Build a wheel: the backend of `pip install .` and `pip wheel .` (PEP 517), named in pyproject.toml.

make builds libshoal and the program; setuptools packs them with the Python package in a folder of their own:

    pyproject.toml README.md LICENSE VERSION
    shoal/         scripts/shoal, libshoal.so.0, bin/shoal

The wheel needs the shared libraries of SUNDIALS, SuiteSparse, LAPACK, NetCDF, libyaml and zlib that it was built with: it is
for this system and its like.
"""

import os
import pathlib
import re
import shutil
import subprocess
import tempfile

import setuptools

TOP = pathlib.Path(__file__).resolve().parents[2]


class Binary(setuptools.Distribution):
    """A distribution for one platform."""

    def has_ext_modules(self):
        return True


def stage(folder):
    """Lay out what goes into the wheel."""
    subprocess.run(["make", f"-j{os.cpu_count()}", "build/shoal", "build/libshoal.so.0"], cwd=TOP, check=True)
    for name in "pyproject.toml", "README.md", "LICENSE":
        shutil.copy(TOP / name, folder)
    version = re.search(r"^VERSION *= *(\S+)", (TOP / "Makefile").read_text(), re.M)[1]
    (folder / "VERSION").write_text(version)

    package = folder / "shoal"
    shutil.copytree(TOP / "scripts/shoal", package, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(TOP / "build/libshoal.so.0", package)
    (package / "bin").mkdir()
    shutil.copy(TOP / "build/shoal", package / "bin")


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """Write the wheel into a folder; returns its name."""
    target = pathlib.Path(wheel_directory).resolve()
    with tempfile.TemporaryDirectory(prefix="shoal-wheel-") as name:
        folder = pathlib.Path(name)
        stage(folder)
        before = os.getcwd()
        os.chdir(folder)
        try:
            setuptools.setup(distclass=Binary, script_args=["--quiet", "bdist_wheel", "--dist-dir", str(target)])
        finally:
            os.chdir(before)
    return max(target.glob("shoal-*.whl"), key=os.path.getmtime).name

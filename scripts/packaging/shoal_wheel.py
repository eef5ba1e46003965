"""Build a wheel: the backend of `pip install .` and `pip wheel .` (PEP 517), named in pyproject.toml.

make builds libshoal and the program; setuptools packs them with the Python package in a folder of their own:

    pyproject.toml README.md LICENSE VERSION
    shoal/         scripts/shoal, libshoal.so.0
    shoal/bin      shoal
    shoal/cases    the cases, for `shoal demo` and as examples
    shoal/scripts  plot.py and animate.py, which the commands shoal-plot and shoal-animate run
    shoal/libs     with libraries=inside: the shared libraries that libshoal and the program need

The wheel needs the shared libraries of SUNDIALS, SuiteSparse, LAPACK, NetCDF, libyaml and zlib with which it was built, and
works only on systems like this one. `pip wheel . --config-settings libraries=inside` packs them, under names that no other
package uses, as auditwheel does; the wheel then runs with the C library of this system or a later one.
"""

import hashlib
import os
import pathlib
import platform
import re
import shutil
import subprocess
import sys
import tempfile

import setuptools
from wheel.bdist_wheel import bdist_wheel

TOP = pathlib.Path(__file__).resolve().parents[2]

# libraries that a manylinux system has: PEP 600, and the loader
OF_EVERY_SYSTEM = re.compile(r"(lib(c|m|dl|rt|pthread|util|resolv|gcc_s|stdc\+\+)|ld-linux.*|linux-vdso)\.so\.\d+$")


class Binary(setuptools.Distribution):
    """A distribution for one platform."""

    def has_ext_modules(self):
        return True


def wheel_of(platform_tag):
    """The command that packs a wheel for any Python 3 on a platform: the modules load libshoal by ctypes."""

    class Wheel(bdist_wheel):
        def get_tag(self):
            return "py3", "none", platform_tag or super().get_tag()[2]

    return Wheel


def stage(folder):
    """Lay out what goes into the wheel."""
    subprocess.run(["make", f"-j{os.cpu_count()}", "build/shoal", "build/libshoal.so.0"], cwd=TOP, check=True)
    for name in "pyproject.toml", "README.md", "LICENSE":
        shutil.copy(TOP / name, folder)
    version = re.search(r"^VERSION *= *(\S+)", (TOP / "Makefile").read_text(), re.M)[1]
    (folder / "VERSION").write_text(version)

    package = folder / "shoal"
    shutil.copytree(TOP / "scripts/shoal", package, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copytree(TOP / "cases", package / "cases")
    shutil.copy(TOP / "build/libshoal.so.0", package)
    for name, source in ("bin", "build/shoal"), ("scripts", "scripts/plot.py"), ("scripts", "scripts/animate.py"):
        (package / name).mkdir(exist_ok=True)
        shutil.copy(TOP / source, package / name)


# ---- the libraries


def needs_of(path):
    """Names and files of all libraries that a program or library needs, directly or not."""
    printed = subprocess.run(["ldd", path], check=True, capture_output=True, text=True).stdout
    if "not found" in printed:
        sys.exit(f"shoal_wheel: a library of {path} is missing:\n{printed}")
    return {name: pathlib.Path(file).resolve() for name, file in re.findall(r"^\s*(\S+) => (/\S+)", printed, re.M)}


def patch(binary, *arguments):
    """Change names in a binary, those of one option at a time: patchelf 0.14 mixes up the names of several options."""
    subprocess.run(["patchelf", *arguments, str(binary)], check=True)


def take_libraries_inside(package):
    """Copy the libraries into the package; a hash in the names keeps them apart from those of other packages, which a
    process may have loaded before."""
    if not shutil.which("patchelf"):
        sys.exit("shoal_wheel: libraries=inside needs patchelf: apt-get install patchelf")
    users = {package / "libshoal.so.0": "$ORIGIN/libs", package / "bin/shoal": "$ORIGIN/../libs"}
    found = {}
    for user in users:
        found.update({name: file for name, file in needs_of(user).items() if not OF_EVERY_SYSTEM.match(name)})

    # shoal/libs/libklu-1a2b3c4d.so.1
    names = {}
    (package / "libs").mkdir()
    for name, file in found.items():
        base, rest = name.split(".so", 1)
        names[name] = f"{base}-{hashlib.sha256(file.read_bytes()).hexdigest()[:8]}.so{rest}"
        copied = package / "libs" / names[name]
        shutil.copy(file, copied)
        copied.chmod(0o644)
        users[copied] = "$ORIGIN"
    for user, path in users.items():
        direct = subprocess.run(["patchelf", "--print-needed", user], check=True, capture_output=True, text=True).stdout
        replaced = [word for name in direct.split() if name in names for word in ("--replace-needed", name, names[name])]
        if replaced:
            patch(user, *replaced)
        patch(user, "--set-rpath", path)
        if user.parent.name == "libs":
            patch(user, "--set-soname", user.name)


# ---- the hook


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """Write the wheel into a folder; returns its name."""
    target = pathlib.Path(wheel_directory).resolve()
    inside = (config_settings or {}).get("libraries")
    if inside not in (None, "inside"):
        sys.exit(f"shoal_wheel: libraries={inside}: only libraries=inside is known")
    with tempfile.TemporaryDirectory(prefix="shoal-wheel-") as name:
        folder = pathlib.Path(name)
        stage(folder)
        tag = None
        if inside:
            take_libraries_inside(folder / "shoal")
            tag = f"manylinux_{platform.libc_ver()[1].replace('.', '_')}_{platform.machine()}"
        before = os.getcwd()
        os.chdir(folder)
        try:
            setuptools.setup(distclass=Binary, cmdclass={"bdist_wheel": wheel_of(tag)},
                             script_args=["--quiet", "bdist_wheel", "--dist-dir", str(target)])
        finally:
            os.chdir(before)
    return max(target.glob("shoal-*.whl"), key=os.path.getmtime).name

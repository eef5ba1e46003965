"""shoal: run cases, read results, and train swimmers from Python. doc/python.md is the guide.

    import shoal
    run = shoal.Run("case.yaml", {"fish[0].wave.frequency": 1.2})
    run.step()
    run["x"]                         # positions of all nodes, m: (fish, node, xy)
    data = shoal.open(shoal.run("case.yaml"))

These functions do what the commands of the program do:

    run(case)       simulate, write a result      resume(result)     continue a run that was stopped or killed
    steady(case)    steady state, stability       study(case)        all members of a sweep; gather(folder)
    error(case, of) numbers with error bars       compare(case)      integration methods by error and cost
    threshold(case, key, first, last)             value of a key at which the state becomes unstable
    branch(case, key, first, last)                steady states while a key changes, through folds
    optimize(case, quantity, over)                numbers of a case that make a quantity least or largest
    check(case)     errors and cost of a case     keys(word)         keys of cases, variables of results
    view(result)    a page for a browser          animate(result)    a movie
    field(result)   the fluid on a grid           export(result, folder)  files of VTK

open(result) reads a result as an xarray.Dataset, periods cuts it into beats, and grid gives the axes of a sweep dimensions of
their own. Run and load keep a run in memory, where a program can steer it. shoal.plot draws. SwimEnv, SwimVectorEnv and
SchoolEnv are environments for learning.

The package needs NumPy and the library libshoal, which it finds beside itself, in build/ of the sources, or by the environment
variable SHOAL_LIBRARY. All functions in the table but run call the program shoal (SHOAL_PROGRAM). open needs xarray and netCDF4,
plot needs matplotlib, and Gymnasium is optional.
"""

import re as _re

try:
    import numpy as _numpy  # noqa: F401
except ImportError as error:
    if error.name != "numpy":
        raise
    from ._interpreter import advice as _advice

    raise ImportError(_advice("numpy"), name="numpy") from None

from . import _library
from ._environments import SchoolEnv, SwimEnv, SwimVectorEnv
from ._library import CaseError, Error, FileError, SolverError, version
from ._program import (
    CaseWarning, Check, Estimate, Page, Steady, Threshold, animate, branch, check, compare, error, export, field, gather, keys, resume,
    steady, study, threshold, view,
)
from ._optimize import Optimum, optimize
from ._results import grid, open, periods  # noqa: A004 - shoal.open, as gzip.open
from ._run import Run, Variable, load, run, variables

# Not __all__: help(shoal) would then print all classes with what they inherit, thousands of lines.
_PUBLIC = ["run", "resume", "steady", "threshold", "branch", "study", "gather", "error", "optimize", "compare", "check", "keys", "view", "animate",
           "field", "export", "open", "grid", "periods", "load", "variables", "version", "Run", "Variable", "Check", "Steady",
           "Threshold", "Estimate", "Optimum", "Page", "SwimEnv", "SwimVectorEnv", "SchoolEnv", "Error", "CaseError", "FileError", "SolverError",
           "CaseWarning", "__version__"]


def _version():
    try:
        return _re.search(r"\d+(\.\w+)+", version()).group()
    except ImportError:  # there is no library
        return "unknown"


__version__ = _version()


def __getattr__(name):
    """shoal.plot is loaded at first use, because plot needs matplotlib."""
    if name == "plot":
        import importlib

        return importlib.import_module(".plot", __name__)
    raise AttributeError(f"module 'shoal' has no attribute {name!r}")


def __dir__():
    return sorted([*_PUBLIC, "plot"])

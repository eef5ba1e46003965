"""Functions of Python that call the program: check, steady, study, error, view. The library runs cases; the program searches,
sweeps and draws pages."""

from __future__ import annotations

import csv
import html
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import warnings
from typing import Mapping, NamedTuple

import numpy as np

from . import _library as lib
from ._library import CaseError, Error, FileError, SolverError, kind, number_of, text_of
from ._progress import somebody_looks
from ._run import strings_of, text_of_case


class CaseWarning(UserWarning):
    """A warning of the program about a case or a result."""


# exit codes of the program: 3 is an expectation that is not met, 75 a signal
_ERRORS = {1: SolverError, 2: CaseError, 4: FileError}


def find_program() -> str:
    """SHOAL_PROGRAM; beside the modules (a wheel); build/ of the sources; bin/ beside lib/; PATH."""
    library = getattr(lib.library, "_name", "")
    folder = os.path.dirname(os.path.abspath(library)) if os.path.dirname(library) else str(lib.HERE)
    places = [os.environ.get("SHOAL_PROGRAM"), lib.HERE / "bin/shoal", lib.HERE.parents[1] / "build/shoal",
              os.path.join(folder, "shoal"), os.path.join(os.path.dirname(folder), "bin/shoal")]
    for place in places:
        if place and os.path.isfile(place) and os.access(place, os.X_OK):
            return str(place)
    found = shutil.which("shoal")
    if not found:
        raise FileError("the program shoal is not found: build it with `make`, or name it in SHOAL_PROGRAM")
    return found


def _absolute(include, folder):
    names = [include] if isinstance(include, (str, os.PathLike)) else list(include)
    return [os.path.join(os.path.abspath(folder or os.getcwd()), name) for name in names]


class _CaseFile:
    """The path of a case: of a case file, or of a temporary file during a call."""

    def __init__(self, case, folder):
        self._case, self._folder, self._temporary = case, folder, None
        self.shown = None  # in messages, in place of the path
        if not isinstance(case, (str, bytes, os.PathLike, Mapping)):
            raise TypeError(f"a case is the path of a case file or a dict, not {kind(case)}")

    def __enter__(self):
        if not isinstance(self._case, Mapping):
            self.path = os.fsdecode(text_of(self._case, "a case"))
            return self
        self._temporary = tempfile.TemporaryDirectory()
        case = dict(self._case)
        if "include" in case:
            case["include"] = _absolute(case["include"], self._folder)
        self.path, self.shown = os.path.join(self._temporary.name, "case.yaml"), "case"
        with open(self.path, "w", encoding="utf-8") as file:
            file.write(text_of_case(case))
        return self

    def __exit__(self, *_):
        if self._temporary:
            self._temporary.cleanup()


def _words(command, arguments, assignments):
    words = [find_program(), command, *arguments]
    for assignment in strings_of(assignments):
        words += ["--set", os.fsdecode(text_of(assignment, "an assignment"))]
    return words


def _call(words, path, progress=False, shown=None) -> str:
    """Run the program; returns its output. Warnings become Python's, errors exceptions; shown: the path in messages."""
    said, complaints = [], []
    with subprocess.Popen([*words, path], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          errors="surrogateescape") as process:
        try:
            for line in process.stderr:
                if "warning: " in line:
                    said.append(line.strip())
                elif progress and not re.search("error: ", line):
                    sys.stderr.write(line.replace(path, shown or path))
                else:
                    complaints.append(line.rstrip("\n"))
            output = process.stdout.read()
        except BaseException:
            process.terminate()
            raise
    for line in said:
        warnings.warn(line.split("warning: ", 1)[1], CaseWarning, stacklevel=4)
    if process.returncode == 0:
        return output
    text = "\n".join(line for line in complaints if line).replace(path, shown or path) or output
    text = re.sub(r"^shoal: (error: )?", "", text, flags=re.M)
    raise _ERRORS.get(process.returncode, Error)(text or f"shoal ended with exit code {process.returncode}")


def _shows(progress) -> bool:
    if progress is None:
        return somebody_looks()
    if not isinstance(progress, bool):
        raise TypeError(f"progress is True, False or None, not {progress!r}: the program reports in lines of its own")
    return progress


# ---- check


class Check(NamedTuple):
    """Result of shoal.check for a valid case."""

    summary: str  #: size of the problem, expected time and memory
    warnings: list[str]  #: doubtful values


def check(case, assignments=None, folder=None) -> Check:
    """Check a case. A case with errors raises a CaseError with all errors and places.

    case, assignments, folder: as for shoal.Run; a case may hold a sweep.
    """
    with _CaseFile(case, folder) as file, warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        output = _call(_words("check", [], assignments), file.path, shown=file.shown)
        return Check(output.replace(file.path, file.shown or file.path).strip(), [str(one.message) for one in said])


# ---- steady


class Steady:
    """The steady state of a case: values of `shoal steady`, and the result file.

    Attributes are the variables steady_* of the file without the prefix, one value per fish for variables of a fish:
    speed [m s-1], cost_of_transport [m s-2], efficiency, towed_efficiency, thrust [N], strouhal, actuation_power [W], ...
    """

    def __init__(self, values: dict):
        self.path: str = values["file"]  #: the result file, with the rows of the last beats
        self.names: list[str] = values["fish"]  #: of the fish
        self._values = {name[len("steady_"):]: np.array(value, dtype=float) if value is not None else np.nan
                        for name, value in values.items() if name.startswith("steady_")}

    def __getattr__(self, name):
        values = self.__dict__.get("_values", {})
        if name in values:
            return values[name]
        raise AttributeError(f"{name!r} is none of {', '.join(values)}")

    def __dir__(self):
        return [*super().__dir__(), *self._values]

    @property
    def multipliers(self) -> np.ndarray:
        """Factors by which small disturbances change in one beat, complex, the largest first."""
        return self._values["multiplier"] @ [1, 1j]

    @property
    def is_stable(self) -> bool:
        """Whether the slowest disturbance decays: the growth rate, s-1, is negative."""
        return bool(self._values["growth"] < 0)

    def open(self):
        """The result file as an xarray.Dataset."""
        from ._results import open as open_result

        return open_result(self.path)

    def __repr__(self):
        speeds = ", ".join(f"{name} {speed:.4g} m/s" for name, speed in zip(self.names, np.atleast_1d(self.speed)))
        growth = float(self._values["growth"])
        state = "stability unknown" if np.isnan(growth) else f"{'stable' if growth < 0 else 'unstable'} ({growth:.3g} 1/s)"
        return f"<shoal.Steady of {self.path}: {speeds}; {state}>"

    def _repr_html_(self):
        return view(self.path)._repr_html_()


def steady(case, assignments=None, path=None, overwrite: bool = False, start=None, progress: bool | None = None,
           folder=None) -> Steady:
    """Find the steady swimming state of a case and its stability by `shoal steady`.

    path: of the result file. overwrite: replace an existing result; otherwise an existing result is a FileError.
    start: the result of another steady state as the initial state. A search without convergence is a SolverError.
    """
    arguments = ["--json"] + ([] if _shows(progress) else ["-q"]) + (["--force"] if overwrite else [])
    for word, value in (("-o", path), ("--from", start)):
        arguments += [] if value is None else [word, os.fsdecode(text_of(value, word))]
    with _CaseFile(case, folder) as file:
        return Steady(json.loads(_call(_words("steady", arguments, assignments), file.path, _shows(progress), file.shown)))


# ---- study


def _run_study(command, case, assignments, path, overwrite, processes, progress, folder, options=()) -> str:
    """Let the program run many members; returns the path of their folder."""
    if path is None:
        name = case.get("name", "run") if isinstance(case, Mapping) else os.path.splitext(os.path.basename(os.fspath(case)))[0]
        path = f"{name}-{command}"
    arguments = ["-o", os.fsdecode(text_of(path, "path")), *options] + (["--force"] if overwrite else [])
    arguments += [] if _shows(progress) else ["-q"]
    if processes is not None:
        if isinstance(processes, bool) or not isinstance(processes, (int, np.integer)) or processes < 1:
            raise CaseError(f"{command}: processes is an integer from 1, not {processes!r}")
        arguments += ["-j", str(processes)]
    with _CaseFile(case, folder) as file:
        _call(_words(command, arguments, assignments), file.path, _shows(progress), file.shown)
    return os.fsdecode(text_of(path, "path"))


def study(case, assignments=None, path=None, overwrite: bool = False, processes: int | None = None,
          progress: bool | None = None, folder=None):
    """Run all members of a case with a sweep (doc/studies.md); returns study.nc as an xarray.Dataset, in which the swept
    keys are coordinates: data.speed.plot(x="body_modulus"). shoal.grid gives each axis of the sweep a dimension.

    path: of the folder of the study (None: the name of the case with -study). overwrite: replace a study that exists;
    else members that are complete are kept. processes: members at once. The path of study.nc is in attrs["path"].
    """
    path = _run_study("study", case, assignments, path, overwrite, processes, progress, folder)
    from ._results import open as open_result

    data = open_result(os.path.join(path, "study.nc"))
    data.attrs["path"] = os.path.join(path, "study.nc")
    return data


# ---- error bars


class Estimate(NamedTuple):
    """A number with its error bar (doc/studies.md, "Error bars")."""

    fish: str  #: name of the fish
    quantity: str  #: as in of
    value: float  #: in unit
    error: float  #: in unit; NaN if a member failed
    unit: str  #: for example "m s-1"
    flags: list[str]  #: per flagged key, why the levels of the key are not accepted
    models: tuple[float, float] | None = None  #: lowest and highest value with other choices of the model
    at: Mapping = {}  #: along a sweep, the swept keys with their values at this point; numbers where they are numbers

    def __str__(self):
        digits = max(0, 1 - int(np.floor(np.log10(self.error)))) if 0 < self.error < np.inf else 6
        number = f"{self.value:.{digits}f} ± {self.error:.{digits}f} {self.unit}"
        others = f"; other models: {self.models[0]:.4g} to {self.models[1]:.4g}" if self.models else ""
        where = "".join(f", {key} {value:g}" if isinstance(value, float) else f", {key} {value}" for key, value in self.at.items())
        return f"{self.quantity}{' of ' + self.fish if self.fish else ''}{where}: {number}{' (flagged)' if self.flags else ''}{others}"


def _number_or_text(text: str):
    try:
        return float(text)
    except ValueError:
        return text


def error(case, of, within: float | None = None, models: bool = False, against=None, assignments=None, path=None,
          overwrite: bool = False, processes: int | None = None, progress: bool | None = None, folder=None) -> list[Estimate]:
    """Vary every numerical key of a case by `shoal error`; returns quantities with their error bars, per fish and, of a case
    with a sweep, per point of the sweep, whose swept values are in `at`.

    of: a quantity or a list of quantities, as "steady_speed". within: refine until the relative errors are smaller.
    models: repeat the numbers with other choices of the model. against: the path of another case, "FISH=FISH", or along
    a sweep "first" or another value of the swept key: adds the quantities ``ratio_...`` and ``change_...``, whose errors are those
    of the comparison: what both share cancels.
    path: of the folder of the members, study.nc and error.csv (None: the name of the case with -error). An error that
    cannot be made smaller than within is a shoal.Error.
    """
    options = [word for quantity in ([of] if isinstance(of, str) else of) for word in ("--of", text_of(quantity, "of"))]
    options += [] if within is None else ["--within", repr(number_of(within, "within"))]
    options += ["--models"] if models else []
    options += [] if against is None else ["--against", os.fsdecode(text_of(against, "against"))]
    path = _run_study("error", case, assignments, path, overwrite, processes, progress, folder, options)
    found: dict = {}
    with open(os.path.join(path, "error.csv"), encoding="utf-8", newline="") as file:
        rows = csv.DictReader(file)
        swept = rows.fieldnames[rows.fieldnames.index("verdict") + 1:]
        for row in rows:
            at = {key: _number_or_text(row[key]) for key in swept}
            place = row["fish"], row["quantity"], *at.values()
            if row["key"] == "sum":
                found[place] = Estimate(*place[:2], float(row["value"]), float(row["error"]), row["unit"], [], at=at)
            elif row["key"] in ("lowest", "highest"):
                found[place] = found[place]._replace(models=(found[place].models or ()) + (float(row["value"]),))
            elif row["verdict"] not in ("accepted", "differences are below the noise",
                                        "a choice of the model, not in the sum"):
                found[place].flags.append(f"{row['key']}: {row['verdict']}")
    return list(found.values())


# ---- pages


class Page:
    """A page of a run: displayed in a notebook, opened in a browser by show()."""

    def __init__(self, path: str):
        self.path = path

    def __fspath__(self):
        return self.path

    def __repr__(self):
        return f"<shoal.Page {self.path}: show() opens it in a browser>"

    def show(self):
        """Open the page in a browser."""
        import webbrowser

        webbrowser.open("file://" + os.path.abspath(self.path))

    def _repr_html_(self):
        with open(self.path, encoding="utf-8") as file:
            return frame_of(file.read())


def frame_of(page: str) -> str:
    """A page as an element of another one."""
    return f'<iframe srcdoc="{html.escape(page)}" style="width: 100%; height: 560px; border: 0"></iframe>'


def view(path, page=None, overwrite: bool = True) -> Page:
    """The page of a result file (doc/output.md): bodies, wakes and curves, in one html file.

    page: of the html file (None: the name of the run with .html, beside it). overwrite: replace a page that exists.
    """
    path = os.fsdecode(text_of(path, "path"))
    page = os.path.splitext(path)[0] + ".html" if page is None else os.fsdecode(text_of(page, "page"))
    _call(_words("view", ["-q", "-o", page] + (["--force"] if overwrite else []), None), path)
    return Page(page)


def page_of_file(path: str) -> str:
    """The page of a result file as an element of another one; no file is left."""
    with tempfile.TemporaryDirectory() as folder:
        return view(path, os.path.join(folder, "page.html"))._repr_html_()

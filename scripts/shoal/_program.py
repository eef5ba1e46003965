"""Functions of Python that call the program: check, steady, study, error, view. The library runs cases; the program searches,
sweeps and draws pages."""

from __future__ import annotations

import csv
import html
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import warnings
from typing import Iterable, Mapping, NamedTuple

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


# the arguments of Python for the options that messages of the program name
_ARGUMENTS = {"--force": "overwrite=True", "-o": "path", "--from": "start", "--set": "assignments", "-j": "processes",
              "--within": "within", "--against": "against", "--of": "of", "--models": "models=True", "--sweep": "sweep",
              "--sensitivity": "sensitivity", "--uncertain": "uncertain",
              "--end": "end", "--at": "at", "--grid": "grid", "--box": "box", "--methods": "methods", "--rtol": "rtol",
              "--steps": "steps", "--limit": "limit", "--vtk": "folder"}


def _in_python(text: str) -> str:
    """A message of the program with the names of the arguments of these functions in place of its options."""
    return re.sub(r"(?<![\w-])-{1,2}[a-z]+(?![\w-])", lambda found: _ARGUMENTS.get(found[0], found[0]), text)


def _path(value, name: str) -> str:
    return os.fsdecode(text_of(value, name))


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
    text = _in_python(re.sub(r"^shoal: (error: )?", "", text, flags=re.M))
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
        return self._values["multiplier"].reshape(-1, 2) @ [1, 1j]

    @property
    def is_stable(self) -> bool:
        """Whether every small disturbance decays, also with the error of the largest multiplier; of bodies without a beat
        whether the growth rate, s-1, is negative."""
        if len(self.multipliers) > 0:
            return bool(abs(self.multipliers[0]) + self._values["multiplier_error"][0] < 1)
        return bool(self._values["growth"] < 0)

    def to_xarray(self):
        """The values as an xarray.Dataset: per fish over `fish`, multipliers over `multiplier`."""
        from ._results import _xarray

        xarray, n = _xarray(), len(self.names)
        data = {"multiplier": ("multiplier_number", self.multipliers),
                "multiplier_error": ("multiplier_number", self._values["multiplier_error"])}
        for name, value in self._values.items():
            if np.ndim(value) == 0:
                data[name] = ((), value)
            elif name not in (*data, "mode", "exponent") and np.shape(value)[0] == n:
                data[name] = (("fish", *(f"{name}_{i}" for i in range(1, np.ndim(value)))), value)
        return xarray.Dataset(data, coords={"fish": self.names}, attrs={"path": self.path})

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
    for word, value, name in (("-o", path, "path"), ("--from", start, "start")):
        arguments += [] if value is None else [word, _path(value, name)]
    with _CaseFile(case, folder) as file:
        return Steady(json.loads(_call(_words("steady", arguments, assignments), file.path, _shows(progress), file.shown)))


class Threshold(NamedTuple):
    """The value of a key at which a steady state becomes unstable (doc/steady.md, Thresholds). The unit is that of the key."""

    key: str
    value: float
    bar: float  #: error of the value: the sum of the parts below, without those that are NaN
    by_error: float  #: error of the multiplier over slope
    by_secant: float  #: length of the last secant
    by_state: float  #: what a tenth of steady.tolerance changes at the nearest state
    unstable: str  #: "above" or "below" it; at a fold the side without states
    kind: str  #: "fold", "multiplier +1", "period doubling", "Neimark-Sacker"; without a beat "divergence", "flutter"
    period: float  #: of the oscillation that grows, beats, without a beat s; 0: none
    points: list  #: of the branch: a dict of value, multiplier (or growth), error, period, label and file each
    path: str  #: of study.nc
    by_interval: float = float("nan")  #: what half the shedding interval changes; NaN: unknown, as at a fold
    by_bodies: float = float("nan")  #: what twice as many edges and panels of the sheets change; NaN: unknown, as at a fold
    slope: float = float("nan")  #: of the modulus of the largest multiplier over the key, without a beat of the growth rate, s-1; NaN: at a fold

    def __float__(self):
        return self.value

    def __str__(self):
        return f"{self.key} = {self.value:.6g} \N{PLUS-MINUS SIGN} {self.bar:.2g}: unstable {self.unstable} it ({self.kind})"


def threshold(case, key: str, first: float, last: float, assignments=None, path=None, overwrite: bool = False, start=None,
              progress: bool | None = None, folder=None) -> Threshold:
    """Find the value of a key at which the steady state becomes unstable, on the way from first to last, by
    `shoal steady --threshold`.

    path: of the folder (None: the name of the case with -threshold). overwrite: replace another threshold. start: the result
    of a steady state to start from. Without a threshold there is a SolverError, whose message says how far the branch came.
    """
    way = f"{os.fsdecode(text_of(key, 'key'))}={number_of(first, 'first')!r}:{number_of(last, 'last')!r}"
    arguments = ["--json", "--threshold", way] + ([] if _shows(progress) else ["-q"]) + (["--force"] if overwrite else [])
    for word, value, name in (("-o", path, "path"), ("--from", start, "start")):
        arguments += [] if value is None else [word, _path(value, name)]
    with _CaseFile(case, folder) as file:
        found = json.loads(_call(_words("steady", arguments, assignments), file.path, _shows(progress), file.shown))
    found["value"], found["path"] = found.pop("threshold"), found.pop("file")
    return Threshold(**found)


def branch(case, key: str, first: float, last: float, assignments=None, path=None, overwrite: bool = False, start=None,
           progress: bool | None = None, folder=None):
    """Follow the steady states of a case while a key goes from first to last, through folds, by `shoal steady --continue`.

    Returns study.nc as an xarray.Dataset, whose members are the states in the order of the branch: the swept key is a
    coordinate, label names folds and losses of stability, and file the results of the states (doc/steady.md, Branches).

    path: of the folder (None: the name of the case with -branch). overwrite: replace another branch. start: the result of a
    steady state to start from.
    """
    way = f"{os.fsdecode(text_of(key, 'key'))}={number_of(first, 'first')!r}:{number_of(last, 'last')!r}"
    if path is None:
        name = case.get("name", "run") if isinstance(case, Mapping) else os.path.splitext(os.path.basename(os.fspath(case)))[0]
        path = f"{name}-branch"
    arguments = ["--continue", way, "-o", _path(path, "path")] + ([] if _shows(progress) else ["-q"]) + (["--force"] if overwrite else [])
    arguments += [] if start is None else ["--from", _path(start, "start")]
    with _CaseFile(case, folder) as file:
        _call(_words("steady", arguments, assignments), file.path, _shows(progress), file.shown)
    return _open_study(_path(path, "path"))


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


def _swept(sweep, relative_to=None) -> list[str]:
    """The assignment of a sweep, {key: values, ...}, as a full grid; none for None. relative_to: of the first key."""
    if sweep is None and relative_to is not None:
        raise CaseError("study: relative_to is of the argument sweep; in a case each axis of its sweep has the key")
    if sweep is None:
        return []
    if not isinstance(sweep, Mapping) or not sweep:
        raise TypeError(f"sweep is a dict of keys with their values, not {kind(sweep)}")
    for key, values in sweep.items():
        if isinstance(values, str) or not isinstance(values, Iterable):
            raise TypeError(f"sweep: the values of {key} are a list, not {kind(values)}")
    axes = [{"key": str(key), "values": list(values)} for key, values in sweep.items()]
    axes[0] |= {} if relative_to is None else {"relative_to": relative_to}
    return ["sweep=" + json.dumps(axes, default=lambda value: value.item())]


def study(case, assignments=None, path=None, overwrite: bool = False, processes: int | None = None,
          progress: bool | None = None, folder=None, sweep: Mapping | None = None, relative_to=None):
    """Run all members of a case with a sweep (doc/studies.md).

    Returns study.nc as an xarray.Dataset, in which the swept keys are coordinates: data.speed.plot(x="body_modulus").
    shoal.grid gives each axis of the sweep a dimension. The path of study.nc is in attrs["path"].

    * path: the folder of the study (None: the name of the case with -study).
    * overwrite: replace a study that exists; otherwise its complete members are kept.
    * processes: how many members run at once.
    * sweep: {key: values, ...}, a full grid in place of the sweep of the case.
    * relative_to: "first" or another value of the first key of sweep; adds the results over those at this value, as
      ``ratio_speed`` and so on.
    """
    path = _run_study("study", case, [*strings_of(assignments), *_swept(sweep, relative_to)], path, overwrite, processes, progress, folder)
    return _open_study(path)


def _open_study(path: str):
    from ._results import open as open_result

    data = open_result(os.path.join(path, "study.nc"))
    data.attrs["path"] = os.path.join(path, "study.nc")
    return data


def gather(path):
    """Write study.nc of the folder of a study again from the files of its members; returns it as shoal.study does."""
    _call([find_program(), "gather", "-q"], _path(path, "path"))
    return _open_study(_path(path, "path"))


def compare(case, methods=None, rtol=None, steps=None, assignments=None, path="compare.nc", overwrite: bool = False,
            limit: float | None = None, progress: bool | None = None, folder=None):
    """Compare integration methods by error and cost (doc/performance.md); returns the file as an xarray.Dataset.

    methods: names, such as ["ida", "rk4"]. rtol: tolerances. steps: fixed steps, s, in place of tolerances. limit: wall
    time of a run, s. None: as the program.
    """
    arguments = ["-o", _path(path, "path")] + (["--force"] if overwrite else []) + ([] if _shows(progress) else ["-q"])
    for word, values in (("--methods", methods), ("--rtol", rtol), ("--steps", steps)):
        arguments += [] if values is None else [word, ",".join(str(value) for value in ([values] if isinstance(values, str) else values))]
    arguments += [] if limit is None else ["--limit", repr(number_of(limit, "limit"))]
    with _CaseFile(case, folder) as file:
        _call(_words("compare", arguments, assignments), file.path, _shows(progress), file.shown)
    from ._results import open as open_result

    return open_result(_path(path, "path"))


# ---- what follows a run


def resume(path, end: float | None = None, progress: bool | None = None) -> str:
    """Continue a run that was stopped or killed (doc/reliability.md); returns the path of its result.

    path: of the result, or of a checkpoint. end: a later end of the run, s, also of a complete one.
    """
    arguments = ([] if _shows(progress) else ["-q"]) + ([] if end is None else ["--end", repr(number_of(end, "end"))])
    path = _path(path, "path")
    _call([find_program(), "resume", *arguments], path, _shows(progress))
    return re.sub(r"\.ckpt$", ".nc", path)


def field(path, at: float | None = None, grid=None, box=None, file=None, overwrite: bool = False):
    """Velocity and vorticity of the fluid on a grid, at a row of a result; returns the file as an xarray.Dataset.

    path: of the result. at: time of a row, s (None: the last row with a wake). grid: numbers of points in x and y. box: its
    corners, (x0, y0, x1, y1), m. file: of the field (None: the name of the result with -field.nc).
    """
    path = _path(path, "path")
    file = re.sub(r"\.nc$", "", path) + "-field.nc" if file is None else _path(file, "file")
    arguments = ["-q", "-o", file] + (["--force"] if overwrite else [])
    arguments += [] if at is None else ["--at", repr(number_of(at, "at"))]
    for word, values in (("--grid", grid), ("--box", box)):
        arguments += [] if values is None else [word, ",".join(f"{value!r}" if isinstance(value, int) else repr(float(value)) for value in values)]
    _call([find_program(), "field", *arguments], path)
    from ._results import open as open_result

    return open_result(file)


def export(path, folder, overwrite: bool = False) -> str:
    """Convert a result to files of VTK for ParaView in a folder (doc/output.md); returns the folder."""
    folder = _path(folder, "folder")
    _call([find_program(), "export", "-q", "--vtk", folder] + (["--force"] if overwrite else []), _path(path, "path"))
    return folder


def animate(path, movie=None) -> str:
    """Make a movie of a result, .mp4 or .gif by its ending (None: the name of the result with .mp4); returns its path."""
    path = _path(path, "path")
    movie = re.sub(r"\.nc$", "", path) + ".mp4" if movie is None else _path(movie, "movie")
    # in a wheel, in the sources, installed by make
    share = pathlib.Path(find_program()).resolve().parent.parent / "share/shoal"
    places = [folder / "animate.py" for folder in (lib.HERE / "scripts", lib.HERE.parent, share / "scripts")]
    script = next((place for place in places if place.is_file()), None)
    if script is None:
        raise FileError("the script animate.py is in none of " + ", ".join(str(place.parent) for place in places))
    done = subprocess.run([sys.executable, str(script), path, movie], capture_output=True, text=True, check=False)
    if done.returncode:
        raise _ERRORS.get(done.returncode, Error)(re.sub(r"^animate\.py: ", "", done.stderr.strip()))
    return movie


def keys(word: str | None = None, output: bool = False) -> list[dict]:
    """The keys of cases, or with output the variables of results: those with a word in name or meaning, or all."""
    words = [find_program(), "keys", "--json"] + (["--output"] if output else [])
    return json.loads(_call(words, "" if word is None else text_of(word, "word")))


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
    sensitivity: Mapping = {}  #: d ln Q/d ln p and its error by the paths of the inputs p: {"fish.body.modulus": (-0.29, 0.001)}
    at: Mapping = {}  #: along a sweep, the swept keys with their values at this point; numbers where they are numbers

    def __float__(self):
        return float(self.value)

    def __str__(self):
        if np.isnan(self.error) and self.sensitivity:
            return f"{self.quantity}{' of ' + self.fish if self.fish else ''}: {self.value:.5g} {self.unit}; d ln Q/d ln p by " + ", ".join(
                f"{key} {value:+.4g} ± {error:.1g}" for key, (value, error) in
                sorted(self.sensitivity.items(), key=lambda one: -abs(one[1][0])))
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
          overwrite: bool = False, processes: int | None = None, progress: bool | None = None, folder=None,
          sensitivity=None, uncertain: Mapping | None = None, start=None) -> list[Estimate]:
    """Vary every numerical key of a case by `shoal error`, and return quantities with their error bars.

    There is an estimate for each quantity of each fish and, of a case with a sweep, for each point of the sweep, whose swept
    values are in its attribute `at`. If an error cannot be made smaller than within, a shoal.Error is raised.

    * of: a quantity or a list of quantities, as "steady_speed".
    * within: refine until the relative errors are smaller.
    * models: repeat the numbers with other choices of the model.
    * against: the path of another case, "FISH=FISH", or along a sweep "first" or another value of the swept key. Adds the
      quantities ``ratio_...`` and ``change_...``, in whose errors that which both values share cancels.
    * sensitivity: True, or a list of keys such as "body.modulus". The estimates then have the derivatives d ln Q/d ln p with
      respect to these numbers in `sensitivity`, in place of errors, which are NaN.
    * uncertain: {key: part}, as {"modulus": 0.1} or "10%"; adds the uncertainty of these numbers to the errors.
    * start: the result of a steady state from which the first search starts.
    * path: the folder of the members, study.nc and error.csv (None: the name of the case with -error).
    """
    options = [word for quantity in ([of] if isinstance(of, str) else of) for word in ("--of", text_of(quantity, "of"))]
    options += [] if within is None else ["--within", repr(number_of(within, "within"))]
    options += ["--models"] if models else []
    options += [] if against is None else ["--against", os.fsdecode(text_of(against, "against"))]
    if sensitivity is not None and sensitivity is not False:
        keys = [] if sensitivity is True else [sensitivity] if isinstance(sensitivity, str) else list(sensitivity)
        if sensitivity is not True and not keys:
            raise CaseError("error: sensitivity is True, a key or a list of keys, not an empty list")
        options += ["--sensitivity" + "".join(f"{',' if i else '='}{_path(key, 'sensitivity')}" for i, key in enumerate(keys))]
    if uncertain is not None and not isinstance(uncertain, Mapping):
        raise TypeError(f"uncertain is a dict of keys with the uncertain part of each, not {kind(uncertain)}")
    for key, part in (uncertain or {}).items():
        options += ["--uncertain", f"{_path(key, 'uncertain')}={part if isinstance(part, str) else repr(number_of(part, 'uncertain'))}"]
    options += [] if start is None else ["--from", _path(start, "start")]
    path = _run_study("error", case, assignments, path, overwrite, processes, progress, folder, options)
    found: dict = {}
    with open(os.path.join(path, "error.csv"), encoding="utf-8", newline="") as file:
        rows = csv.DictReader(file)
        swept = rows.fieldnames[rows.fieldnames.index("verdict") + 1:]
        for row in rows:
            at = {key: _number_or_text(row[key]) for key in swept}
            place = row["fish"], row["quantity"], *at.values()
            if row["quantity"].startswith("sensitivity_"):
                of_quantity = found[(row["fish"], row["quantity"].removeprefix("sensitivity_"), *at.values())]
                of_quantity.sensitivity[row["key"]] = float(row["value"]), float(row["error"])
            elif row["key"] == "sum":
                found[place] = Estimate(*place[:2], float(row["value"]), float(row["error"]), row["unit"], [], sensitivity={}, at=at)
            elif row["key"] in ("lowest", "highest"):
                found[place] = found[place]._replace(models=(found[place].models or ()) + (float(row["value"]),))
            elif row["verdict"] not in ("accepted", "differences are below the noise",
                                        "a choice of the model, not in the sum", "an input, in quadrature"):
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

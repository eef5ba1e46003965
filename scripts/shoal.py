"""shoal: run cases, read results, and train swimmers from Python. doc/python.md is the guide.

    import shoal
    run = shoal.Run("case.yaml", {"fish[0].wave.frequency": 1.2})
    run.step()
    run["x"]                         # a view of the positions of all nodes: (fish, node, xy)
    data = shoal.open(shoal.simulate("case.yaml"))

Needs NumPy, and the library libshoal: beside an installed module, in build/ beside the sources, or named by the
environment variable SHOAL_LIBRARY. shoal.open needs xarray and netCDF4; nothing else does. Gymnasium is used where it
is installed.
"""

import ctypes
import importlib.util
import json
import os
import pathlib

import numpy as np

__all__ = ["Run", "simulate", "open", "periods", "SwimEnv", "SchoolEnv", "Error", "CaseError", "FileError",
           "SolverError", "version"]

# ---- errors: the message is that of the program


class Error(Exception):
    """A call of the library has failed."""


class CaseError(Error, ValueError):
    """A wrong case or a wrong argument."""


class FileError(Error, OSError):
    """A file cannot be read or written."""


class SolverError(Error, RuntimeError):
    """The integration has failed."""


_ERRORS = {-1: CaseError, -2: FileError, -3: MemoryError, -4: SolverError}

# ---- the library


class _Array(ctypes.Structure):  # struct shoal_array
    _fields_ = [
        ("values", ctypes.c_void_p),
        ("type", ctypes.c_int),
        ("n_dimensions", ctypes.c_int),
        ("shape", ctypes.c_size_t * 4),
        ("dimension", ctypes.c_char_p * 4),
        ("unit", ctypes.c_char_p),
        ("long_name", ctypes.c_char_p),
    ]


_TYPES = [np.dtype(t) for t in (ctypes.c_double, ctypes.c_int, ctypes.c_long, "S1")]  # enum shoal_type

_run, _int, _double, _text = ctypes.c_void_p, ctypes.c_int, ctypes.c_double, ctypes.c_char_p
_SIGNATURES = {  # name: result, arguments
    "shoal_open": (_int, ctypes.POINTER(_run), _text, _int, ctypes.POINTER(_text)),
    "shoal_open_text": (_int, ctypes.POINTER(_run), _text, _text, _int, ctypes.POINTER(_text)),
    "shoal_close": (None, _run),
    "shoal_step": (_int, _run),
    "shoal_advance": (_int, _run, _double),
    "shoal_time": (_double, _run),
    "shoal_end": (_double, _run),
    "shoal_interval": (_double, _run),
    "shoal_read": (_int, _run, _text, ctypes.POINTER(_Array)),
    "shoal_variable": (_text, _int),
    "shoal_flow": (_int, _run, _int, _run, _run, _run),
    "shoal_n_fish": (_int, _run),
    "shoal_write": (_int, _run, _text, _int),
    "shoal_write_end": (_int, _run),
    "shoal_result_path": (_text, _run),
    "shoal_message": (_text,),
    "shoal_version": (_text,),
}


def _find_library():
    here = pathlib.Path(__file__).resolve().parent
    name = "libshoal.so.0"
    places = [os.environ.get("SHOAL_LIBRARY"), here.parent / "build" / name, here.parents[1] / name,
              here.parents[2] / name]
    for place in places:
        if place and os.path.isfile(place):
            return str(place)
    return name  # where the system looks


def _load():
    try:
        library = ctypes.CDLL(_find_library())
    except OSError as error:
        raise ImportError(f"{error}: build it with `make`, or name it in SHOAL_LIBRARY") from error
    for name, (result, *arguments) in _SIGNATURES.items():
        function = getattr(library, name)
        function.restype, function.argtypes = result, arguments
    return library


_library = _load()


def _check(code):
    if code < 0:
        raise _ERRORS.get(code, Error)(_library.shoal_message().decode(errors="replace"))
    return code


def version():
    """The version of the library with its commit."""
    return _library.shoal_version().decode()


# ---- cases


def _plain(value):
    """NumPy's numbers and arrays as JSON has them."""
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise TypeError(f"{value!r} cannot stand in a case")


def _yaml(value):
    """A value as a case file has it: JSON is YAML."""
    return json.dumps(value, default=_plain, allow_nan=False)


def _assignments(assignments):
    """ "key=value" of a dict; a list of such strings stays as it is."""
    if assignments is None:
        return []
    if isinstance(assignments, dict):
        return [f"{key}={_yaml(value)}" for key, value in assignments.items()]
    return list(assignments)


# ---- a run


class _Handle:
    """The run of the library. It is closed when neither a Run nor a view of its arrays needs it any more."""

    def __init__(self, pointer):
        self.pointer = pointer

    def __del__(self, close=_library.shoal_close):
        close(self.pointer)


class _Memory:
    """What NumPy makes a view of; it keeps the run that owns the memory."""

    def __init__(self, handle, address, shape, dtype):
        self.handle = handle
        self.__array_interface__ = {"data": (address, True), "shape": shape, "typestr": dtype.str, "version": 3}


class View(np.ndarray):
    """A read-only view of a variable of a run, with dims, unit and long_name. A part or a result has none of them."""

    dims = unit = long_name = None


class Run:
    """A case in memory, at its last event.

    case: the path of a case file, or a dict with what a case file would hold. assignments: {"fish[0].nodes": 9}, which
    change the case. Errors are shoal.CaseError and others, with the message of the program.
    """

    def __init__(self, case, assignments=None, folder=None):
        strings = [text.encode() for text in _assignments(assignments)]
        array = (ctypes.c_char_p * len(strings))(*strings)
        pointer = ctypes.c_void_p()
        if isinstance(case, dict):
            text, place = _yaml({"format": 1, "name": "run", **case}).encode(), os.fsencode(folder) if folder else None
            _check(_library.shoal_open_text(pointer, text, place, len(strings), array))
        else:
            _check(_library.shoal_open(pointer, os.fsencode(case), len(strings), array))
        self._take(pointer.value)

    def _take(self, pointer):
        self._handle = _Handle(pointer)
        self._pointer = pointer
        self._cache = {}

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        """Release the run, once no view of it is used any more."""
        self._handle, self._pointer = None, None

    # -- time

    time = property(lambda self: _library.shoal_time(self._pointer), doc="of the last event, s")
    end = property(lambda self: _library.shoal_end(self._pointer), doc="of the case, s")
    interval = property(lambda self: _library.shoal_interval(self._pointer), doc="between two events, s")

    def step(self):
        """Go on to the next event."""
        code = _library.shoal_step(self._pointer)
        if code:
            _check(code)

    def advance(self, time):
        """Go on to the first event at or after a time, s."""
        _check(_library.shoal_advance(self._pointer, time))

    # -- what is there at the last event

    @property
    def names(self):
        """The names of the fish."""
        return [name.tobytes().rstrip(b"\0").decode() for name in self["fish_name"]]

    def keys(self):
        """The names of all variables."""
        names = []
        while name := _library.shoal_variable(len(names)):
            names.append(name.decode())
        return names

    def __contains__(self, name):
        return name in self.keys()

    def __getitem__(self, name):
        """A view of a variable, without copying. It holds until the next step; copy() what is to stay."""
        array = _Array()
        code = _library.shoal_read(self._pointer, name.encode(), array)
        if code:
            _check(code)
        shape = tuple(array.shape[: array.n_dimensions])
        key = (array.values, shape)
        view = self._cache.get(name)
        if view is None or view[0] != key:
            made = np.asarray(_Memory(self._handle, array.values, shape, _TYPES[array.type])).view(View)
            made.dims = tuple(array.dimension[d].decode() for d in range(array.n_dimensions))
            made.unit, made.long_name = array.unit.decode(), array.long_name.decode()
            self._cache[name] = view = (key, made)
        return view[1]

    def flow(self, points):
        """Velocity (..., 2), m/s, and vorticity (...), 1/s, of the fluid at points (..., 2), m."""
        points = np.ascontiguousarray(points, dtype=float)
        if points.ndim == 0 or points.shape[-1] != 2:
            raise CaseError(f"flow: points have the shape (..., 2), not {points.shape}")
        velocity, vorticity = np.empty(points.shape), np.empty(points.shape[:-1])
        _check(_library.shoal_flow(self._pointer, vorticity.size, points.ctypes.data, velocity.ctypes.data,
                                   vorticity.ctypes.data))
        return velocity, vorticity

    # -- files

    def write(self, path=None, overwrite=False):
        """Write a result file from now on, until the end or write_end(); returns its path. None: as the program would
        name it."""
        path = _library.shoal_result_path(self._pointer) if path is None else os.fsencode(path)
        _check(_library.shoal_write(self._pointer, path, overwrite))
        return os.fsdecode(path)

    def write_end(self):
        """Close the result file."""
        _check(_library.shoal_write_end(self._pointer))


def simulate(case, assignments=None, path=None, overwrite=True):
    """Run a case to its end and return the path of its result file: that of `shoal run`."""
    with Run(case, assignments) as run:
        path = run.write(path, overwrite)
        run.advance(run.end)
        run.write_end()
    return path


# ---- results


def _with_names(data):
    """The dataset with the coordinates fish and xy."""
    if "fish" not in data.coords:
        names = [name.decode() if isinstance(name, bytes) else str(name) for name in data["fish_name"].values]
        data = data.assign_coords(fish=names)
    return data if "xy" in data.coords else data.assign_coords(xy=["x", "y"])


def _wake_table(data):
    """The dataset with all free vortices of all rows as one long table, without empty slots."""
    used = np.isfinite(data["wake_circulation"].transpose("time", "fish", "vortex").values)
    row, fish, _ = np.nonzero(used)
    table = {
        "wake_time": ("wake", data["time"].values[row]),
        "wake_fish": ("wake", data["fish"].values[fish]),
        "wake_x": (("wake", "xy"), data["wake_x"].values[used], data["wake_x"].attrs),
        "wake_circulation": ("wake", data["wake_circulation"].values[used], data["wake_circulation"].attrs),
        "wake_birth": ("wake", data["wake_birth"].values[used], data["wake_birth"].attrs),
    }
    table["wake_age"] = ("wake", table["wake_time"][1] - table["wake_birth"][1], {"units": "s"})
    return data.drop_vars(["wake_x", "wake_circulation", "wake_birth"]).assign(table)


def open(path):  # noqa: A001 - shoal.open, as gzip.open
    """A result file as an xarray.Dataset: coordinates fish (names) and xy; the wake as one long table, a row for each
    vortex at each time: wake_time, wake_fish, wake_x, wake_circulation, wake_birth, wake_age on the dimension wake."""
    import xarray

    if not os.path.isfile(path):
        raise FileError(f"{path}: no such file")
    try:
        data = xarray.open_dataset(path, engine="netcdf4")
    except Exception as error:  # what a damaged file raises depends on the versions of two libraries
        raise FileError(f"{path}: not a result file of shoal ({error})") from error
    with data:
        if "shoal_schema" not in data.attrs:
            raise FileError(f"{path}: a NetCDF file, but not one of shoal")
        return _wake_table(_with_names(data.load()))


def periods(data, fish=0):
    """The rows of a result cut into the beats of a fish (number or name): what has the dimension time gets (period,
    phase) in its place, phase from 0 to 1; what is left over after the last whole period is cut off."""
    chosen = data.isel(fish=fish) if isinstance(fish, int) else data.sel(fish=fish)
    frequency, time = float(chosen["frequency"]), data["time"].values
    if not frequency > 0 or time.size < 2:
        raise CaseError("periods: this fish does not beat, or there are no two rows")
    rows = 1 / (frequency * (time[1] - time[0]))  # of one period
    n_rows = round(rows)
    if abs(rows - n_rows) > 1e-6 * rows:
        raise CaseError(f"periods: a period has {rows:g} rows: choose time.output_interval so that they are an integer")
    n_periods = (time.size - 1) // n_rows
    cut = data.drop_dims("wake", errors="ignore").isel(time=slice(0, n_periods * n_rows))
    index = [np.repeat(np.arange(n_periods), n_rows), np.tile(np.arange(n_rows) / n_rows, n_periods)]
    cut = cut.assign_coords(start=("time", cut["time"].values), period=("time", index[0]), phase=("time", index[1]))
    return cut.drop_vars("time").set_index(time=["period", "phase"]).unstack("time").rename(start="time")

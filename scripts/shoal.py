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
import operator
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
    "shoal_set": (_int, _run, _int, _text, _int, ctypes.POINTER(_double)),
    "shoal_clone": (_int, ctypes.POINTER(_run), _run),
    "shoal_restore": (_int, _run, _run),
    "shoal_time": (_double, _run),
    "shoal_end": (_double, _run),
    "shoal_interval": (_double, _run),
    "shoal_read": (_int, _run, _text, ctypes.POINTER(_Array)),
    "shoal_variable": (_text, _int),
    "shoal_flow": (_int, _run, _int, _run, _run, _run),
    "shoal_n_fish": (_int, _run),
    "shoal_write": (_int, _run, _text, _int),
    "shoal_write_end": (_int, _run),
    "shoal_checkpoint": (_int, _run),
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
    # SUNDIALS 7 of Debian loads MPI, which would catch SIGHUP and crashes in a process that only imports shoal
    for name, value in (("UCX_HANDLE_ERRORS", "none"), ("UCX_DEBUG_SIGNO", "0")):
        os.environ.setdefault(name, value)
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


def _c_text(text):
    """A string for the library, which would take its first zero byte for its end."""
    encoded = os.fsencode(text)
    if b"\0" in encoded:
        raise CaseError(f"{text!r} has a zero byte in it")
    return encoded


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
        strings = [_c_text(text) for text in _assignments(assignments)]
        array = (ctypes.c_char_p * len(strings))(*strings)
        pointer = ctypes.c_void_p()
        if isinstance(case, dict):
            text, place = _c_text(_yaml({"format": 1, "name": "run", **case})), _c_text(folder) if folder else None
            _check(_library.shoal_open_text(pointer, text, place, len(strings), array))
        else:
            _check(_library.shoal_open(pointer, _c_text(case), len(strings), array))
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
        """Advance to the first event at or after a time, s, which must not be before the last event."""
        _check(_library.shoal_advance(self._pointer, time))

    @property
    def at_end(self):
        """Whether there is no further event."""
        return self.time >= self.end

    # -- from outside

    def set(self, fish, key, value):
        """Set wave.amplitude, wave.frequency, control.bias, control.desired_heading (degree) or control.waypoints (a
        list of pairs) of a fish, by number or name. The change is made within control.ramp."""
        if isinstance(fish, str):
            names = self.names
            if fish not in names:
                raise CaseError(f"set: there is no fish '{fish}': the names are {', '.join(names)}")
            fish = names.index(fish)
        n_fish = _check(_library.shoal_n_fish(self._pointer))
        if not 0 <= operator.index(fish) < n_fish:  # before ctypes cuts it to an int
            raise CaseError(f"set: there is no fish {fish}: this run has {n_fish}, numbered from 0")
        values = np.ascontiguousarray(value, dtype=float)
        pointer = values.ctypes.data_as(ctypes.POINTER(ctypes.c_double))
        _check(_library.shoal_set(self._pointer, fish, _c_text(key), values.size, pointer))

    def clone(self):
        """A copy at the last event. Run and copy go on with the same bits, each by itself."""
        pointer = ctypes.c_void_p()
        _check(_library.shoal_clone(pointer, self._pointer))
        copy = object.__new__(type(self))
        copy._take(pointer.value)
        return copy

    def restore(self, other):
        """Go back, or forward, to where a copy is, or the run that this is a copy of."""
        _check(_library.shoal_restore(self._pointer, other._pointer))

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
        code = _library.shoal_read(self._pointer, _c_text(name), array)
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
        if vorticity.size > 2**31 - 1:
            raise CaseError(f"flow: {vorticity.size} points are too many")
        _check(_library.shoal_flow(self._pointer, vorticity.size, points.ctypes.data, velocity.ctypes.data,
                                   vorticity.ctypes.data))
        return velocity, vorticity

    # -- files

    def write(self, path=None, overwrite=False):
        """Write a result file from now on, until the end or write_end(); returns its path. None: as the program would
        name it."""
        path = _library.shoal_result_path(self._pointer) if path is None else _c_text(path)
        _check(_library.shoal_write(self._pointer, path, bool(overwrite)))
        return os.fsdecode(path)

    def checkpoint(self):
        """Write a checkpoint beside the result file, RESULT.ckpt, from which `shoal resume` goes on."""
        _check(_library.shoal_checkpoint(self._pointer))

    def write_end(self):
        """Close the result file."""
        _check(_library.shoal_write_end(self._pointer))


def simulate(case, assignments=None, path=None, overwrite=False):
    """Run a case to its end and return the path of its result file: that of `shoal run`. overwrite: replace a result
    that exists, as --force does; else that is a FileError."""
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
    cut = {}
    for name, variable in data.drop_dims("wake", errors="ignore").variables.items():
        if "time" not in variable.dims:
            cut[name] = variable
            continue
        first = variable.transpose("time", ...)
        values = first.values[: n_periods * n_rows].reshape(n_periods, n_rows, *first.shape[1:])
        cut[name] = (("period", "phase", *first.dims[1:]), values, variable.attrs)
    coordinates = {**{name: cut.pop(name) for name in data.coords if name in cut},
                   "period": np.arange(n_periods), "phase": np.arange(n_rows) / n_rows}
    return type(data)(cut, coordinates, data.attrs)


# ---- learning: the protocols of Gymnasium and PettingZoo


def _from(module, name, otherwise):
    """A name of a module where that is installed."""
    if importlib.util.find_spec(module.split(".")[0]) is None:
        return otherwise
    return getattr(importlib.import_module(module), name)


class _Box:
    """gymnasium.spaces.Box, as far as it is needed here, where Gymnasium is not installed."""

    def __init__(self, low, high, dtype=np.float32):
        self.low, self.high = np.asarray(low, dtype), np.asarray(high, dtype)
        self.shape, self.dtype = self.low.shape, np.dtype(dtype)
        self._random = np.random.default_rng()

    def seed(self, seed=None):
        self._random = np.random.default_rng(seed)
        return [seed]

    def sample(self):
        return self._random.uniform(self.low, self.high).astype(self.dtype)

    def contains(self, x):
        x = np.asarray(x)
        return x.shape == self.shape and bool(np.all(x >= self.low) and np.all(x <= self.high))

    __contains__ = contains

    def __repr__(self):
        return f"Box({self.low.min(initial=0):g}, {self.high.max(initial=0):g}, {self.shape}, {self.dtype})"


_make_box = _from("gymnasium.spaces", "Box", _Box)

_KEYS = {"bias": "control.bias", "amplitude": "wave.amplitude", "frequency": "wave.frequency"}


class _Swimmer:
    """One fish of a run that is led: what it does, sees and earns. Vectors that it sees are in its own frame, forwards
    and to the left, in body lengths."""

    def __init__(self, run, fish, actions, observations, reward, goal, course, sensors):
        self.run, self.fish = run, fish
        self.length, self.mass = float(run["body_length"][fish]), float(run["body_mass"][fish])
        self.n_joints, self.n_fish = int(run["n_joints"][fish]), len(run["n_joints"])
        frequency = float(run["frequency"][fish])
        usual = {"bias": (-0.5, 0.5), "amplitude": (0.2, 0.6), "frequency": (0.5 * frequency, 1.5 * frequency)}
        self.actions = actions if isinstance(actions, dict) else {name: usual.get(name) for name in actions}
        self.observations, self.reward_of = list(observations), reward
        self.goal, self.course, self.sensors = goal, course, np.asarray(sensors, float).reshape(-1, 2)
        for names, known in ((self.actions, _KEYS), (self.observations, self._SEEN)):
            unknown = [name for name in names if name not in known]
            if unknown:
                raise CaseError(f"{unknown[0]!r} is none of {', '.join(known)}")
        if not callable(reward):
            unknown = [name for name in reward if name not in self._EARNED]
            if unknown:
                raise CaseError(f"{unknown[0]!r} is none of {', '.join(self._EARNED)}")
        for name in [*self.observations, *(() if callable(reward) else reward)]:
            if goal is None and name in ("goal", "closing"):
                raise CaseError(f"{name!r} needs a goal: (x, y), or (fish, (x, y)) for a place beside a fish")

    # -- spaces

    def action_space(self):
        low, high = np.array(list(self.actions.values()), float).reshape(-1, 2).T
        return _make_box(low.astype(np.float32), high.astype(np.float32), dtype=np.float32)

    def observation_space(self):
        bounds = np.concatenate([np.full(self._size(name), self._SEEN[name][1]) for name in self.observations])
        return _make_box(-bounds.astype(np.float32), bounds.astype(np.float32), dtype=np.float32)

    def _size(self, name):
        sizes = {"curvature": self.n_joints, "muscle": self.n_joints, "flow": self.sensors.size, "goal": 3,
                 "neighbours": 4 * (self.n_fish - 1), "action": len(self.actions)}
        return sizes.get(name, 2)

    # -- what it does

    def begin(self, run):
        self.run, self.action = run, np.zeros(len(self.actions))
        self._mark()

    def act(self, action):
        self.action = np.asarray(action, float).reshape(-1)
        if self.action.size != len(self.actions) or not np.all(np.isfinite(self.action)):
            raise CaseError(f"an action is {len(self.actions)} numbers: {', '.join(self.actions)}; got {action!r}")
        for (name, (low, high)), value in zip(self.actions.items(), self.action):
            self.run.set(self.fish, _KEYS[name], min(max(float(value), low), high))
        self._mark()

    def _mark(self):
        self._before = self.run.time, np.array(self.com), float(self.run["actuation_work"][self.fish])
        self._goal_before = None if self.goal is None else self.to_goal()

    # -- what it sees

    com = property(lambda self: self.run["com"][self.fish], doc="the centre of mass, m")

    def _own(self, vectors):
        angle = np.radians(float(self.run["heading"][self.fish]))
        c, s = np.cos(angle), np.sin(angle)
        return np.asarray(vectors) @ np.array([[c, -s], [s, c]]) / self.length

    def place(self):
        """Where the goal is now, m."""
        if np.ndim(self.goal[0]) == 0 and not isinstance(self.goal[0], str) and np.ndim(self.goal[1]) == 0:
            return np.asarray(self.goal, float)
        other, offset = self.goal
        other = self.run.names.index(other) if isinstance(other, str) else other
        return np.asarray(self.run["com"][other]) + np.asarray(offset, float)

    def to_goal(self):
        """From the centre of mass to the goal, m."""
        return self.place() - self.com

    def _see_goal(self):
        own = self._own(self.to_goal())
        return [*own, np.hypot(*own)]

    def _see_closing(self):
        time = self.run.time - self._before[0]
        return self._own((self._goal_before - self.to_goal()) / time) if time > 0 else (0.0, 0.0)

    def _see_heading(self):
        angle = np.radians(float(self.run["heading"][self.fish]))
        return np.cos(angle), np.sin(angle)

    def _see_flow(self):
        nose = self.run["x"][self.fish, 0]
        angle = np.radians(float(self.run["heading"][self.fish]))
        c, s = np.cos(angle), np.sin(angle)
        places = nose + self.length * self.sensors @ np.array([[c, s], [-s, c]])
        return self._own(self.run.flow(places)[0]).ravel()

    def _see_neighbours(self):
        others = [f for f in range(self.n_fish) if f != self.fish]
        com, velocity = self.run["com"], self.run["com_velocity"]
        return np.hstack([self._own(com[others] - com[self.fish]),
                          self._own(velocity[others] - velocity[self.fish])]).ravel()

    _SEEN = {  # name: (what it is, bound)
        "velocity": (lambda self: self._own(self.run["com_velocity"][self.fish]), 20),
        "heading": (_see_heading, 1),
        "curvature": (lambda self: self.run["curvature"][self.fish, : self.n_joints], 20),
        "muscle": (lambda self: self.run["natural_curvature"][self.fish, : self.n_joints], 20),
        "flow": (_see_flow, 20),
        "goal": (_see_goal, 1000),
        "closing": (_see_closing, 20),
        "neighbours": (_see_neighbours, 1000),
        "action": (lambda self: self.action, 20),
    }

    def see(self):
        seen = [np.clip(np.asarray(self._SEEN[name][0](self), float), -self._SEEN[name][1], self._SEEN[name][1])
                for name in self.observations]
        return np.concatenate(seen).astype(np.float32)

    # -- what it earns

    def _moved(self):
        time, com, work = self._before
        return self.run.time - time, self.com - com, float(self.run["actuation_work"][self.fish]) - work

    def _earn_speed(self):
        time, way, _ = self._moved()
        return np.hypot(*way) / (time * self.length) if time > 0 else 0.0

    def _earn_cost(self):
        _, way, work = self._moved()
        return -work / (self.mass * max(np.hypot(*way), 0.01 * self.length))

    def _earn_course(self):
        _, way, _ = self._moved()
        aim = self.to_goal() if self.goal is not None else [np.cos(np.radians(self.course)), np.sin(np.radians(self.course))]
        angle = np.arctan2(way[1], way[0]) - np.arctan2(aim[1], aim[0])
        return -abs((angle + np.pi) % (2 * np.pi) - np.pi) / np.pi

    _EARNED = {
        "speed": _earn_speed,
        "cost_of_transport": _earn_cost,
        "course": _earn_course,
        "goal": lambda self: -float(np.hypot(*self.to_goal())) / self.length,
    }

    def earn(self):
        if callable(self.reward_of):
            return float(self.reward_of(self))
        return float(sum(weight * self._EARNED[name](self) for name, weight in self.reward_of.items()))


class _Swim:
    """What both environments share: a run that is begun again and again, and its swimmers."""

    def __init__(self, case, assignments, act_every, vary, far):
        self._case, self._assignments = case, dict(assignments or {})
        self._vary, self._far, self._kept = dict(vary or {}), far, None
        self.run = Run(case, self._assignments)
        self._n_steps = 1 if act_every is None else max(1, round(act_every / self.run.interval))
        self._random = np.random.default_rng()

    def _begin(self, seed, options):
        if seed is not None:
            self._random = np.random.default_rng(seed)
        changes = dict((options or {}).get("assignments", {}))
        for key, (low, high) in self._vary.items():
            changes[key] = self._random.uniform(low, high)
        if changes:
            self.run = Run(self._case, {**self._assignments, **changes})
            return
        if self._kept is None:
            self._kept = Run(self._case, self._assignments)
            self.run = self._kept.clone()
        else:
            self.run.restore(self._kept)

    def _advance(self):
        """One action long, or to the end; returns whether the solver has failed."""
        try:
            for _ in range(self._n_steps):
                if self.run.at_end:
                    break
                self.run.step()
        except SolverError:
            return True
        return False

    def _is_lost(self, swimmer):
        if self._far is None or swimmer.goal is None:
            return False
        return bool(np.hypot(*swimmer.to_goal()) > self._far * swimmer.length)


_SENSORS = ((0.5, 0.0), (0.0, 0.3), (0.0, -0.3))


class SwimEnv(_Swim, _from("gymnasium", "Env", object)):
    """One fish that learns, by the protocol of Gymnasium.

    case, assignments: as for Run; the episode ends (is truncated) with time.end. fish: the one that learns, by number
    or name. actions: names of bias, amplitude, frequency, or a dict with bounds {"bias": (-0.3, 0.3)}. observations:
    names of velocity, heading, curvature, muscle, flow, goal, closing, neighbours, action. reward: weights of speed,
    cost_of_transport, course, goal, or a function of the swimmer. goal: a point (x, y), m, or ("leader", (1.2, 0)), a
    place beside a fish. course: desired course, degree. act_every: time between actions, s. vary: bounds of
    assignments that are drawn at each reset, {"fish[1].start.heading": (170, 190)}. far: distance from the goal, in
    lengths, at which an episode is over (terminated); it is too when the integration fails.
    """

    metadata = {"render_modes": []}
    render_mode = None
    spec = None

    def __init__(self, case, assignments=None, fish=0, actions=("bias",), observations=("velocity", "heading"),
                 reward=None, goal=None, course=180.0, sensors=_SENSORS, act_every=None, vary=None, far=None):
        _Swim.__init__(self, case, assignments, act_every, vary, far)
        fish = self.run.names.index(fish) if isinstance(fish, str) else fish
        self.swimmer = _Swimmer(self.run, fish, actions, observations, reward or {"speed": 1.0}, goal, course, sensors)
        self.action_space, self.observation_space = self.swimmer.action_space(), self.swimmer.observation_space()

    @property
    def unwrapped(self):
        return self

    def reset(self, *, seed=None, options=None):
        """Begin an episode; returns observation and info."""
        self._begin(seed, options)
        self.swimmer.begin(self.run)
        self._last = self.swimmer.see()
        return self._last, {"time": self.run.time}

    def step(self, action):
        """Act, and go on to the next action; returns observation, reward, terminated, truncated, info."""
        self.swimmer.act(action)
        info, failed = {}, self._advance()
        if failed:
            info["failure"] = _library.shoal_message().decode()
        else:
            self._last = self.swimmer.see()
        info["time"] = self.run.time
        reward = 0.0 if failed else self.swimmer.earn()
        return self._last, reward, failed or self._is_lost(self.swimmer), self.run.at_end, info

    def render(self):
        """There is nothing to see here: run.write() makes a file for plot.py and `shoal view`."""

    def close(self):
        self.run = self._kept = None


class SchoolEnv(_Swim, _from("pettingzoo", "ParallelEnv", object)):
    """A school of fish that learn together, by the protocol of PettingZoo's parallel environments.

    Arguments as for SwimEnv; fish: the names of those that learn, None: all. goal: one for all, or a dict by name.
    """

    metadata = {"render_modes": [], "name": "shoal_v0"}
    render_mode = None

    def __init__(self, case, assignments=None, fish=None, actions=("bias",),
                 observations=("velocity", "heading", "neighbours"), reward=None, goal=None, course=180.0,
                 sensors=_SENSORS, act_every=None, vary=None, far=None):
        _Swim.__init__(self, case, assignments, act_every, vary, far)
        names = self.run.names
        self.possible_agents = list(fish or names)
        self.agents = []
        self.swimmers = {}
        for name in self.possible_agents:
            own_goal = goal.get(name) if isinstance(goal, dict) else goal
            self.swimmers[name] = _Swimmer(self.run, names.index(name), actions, observations, reward or {"speed": 1.0},
                                           own_goal, course, sensors)
        self.action_spaces = {name: swimmer.action_space() for name, swimmer in self.swimmers.items()}
        self.observation_spaces = {name: swimmer.observation_space() for name, swimmer in self.swimmers.items()}

    num_agents = property(lambda self: len(self.agents))
    max_num_agents = property(lambda self: len(self.possible_agents))

    @property
    def unwrapped(self):
        return self

    def action_space(self, agent):
        return self.action_spaces[agent]

    def observation_space(self, agent):
        return self.observation_spaces[agent]

    def reset(self, seed=None, options=None):
        """Begin an episode; returns observations and infos by name."""
        self._begin(seed, options)
        self.agents = list(self.possible_agents)
        for swimmer in self.swimmers.values():
            swimmer.begin(self.run)
        self._last = {name: self.swimmers[name].see() for name in self.agents}
        return dict(self._last), {name: {} for name in self.agents}

    def step(self, actions):
        """All act at once; returns observations, rewards, terminations, truncations, infos by name. The school stays
        together: when the episode is over for one, it is for all."""
        agents = self.agents
        for name in agents:
            self.swimmers[name].act(actions[name])
        failed = self._advance()
        if not failed:
            self._last = {name: self.swimmers[name].see() for name in agents}
        rewards = {name: 0.0 if failed else self.swimmers[name].earn() for name in agents}
        over = failed or any(self._is_lost(self.swimmers[name]) for name in agents)
        ended = self.run.at_end
        infos = {name: {"failure": _library.shoal_message().decode()} if failed else {} for name in agents}
        if over or ended:
            self.agents = []
        return (dict(self._last), rewards, dict.fromkeys(agents, over), dict.fromkeys(agents, ended), infos)

    def state(self):
        """What all together see."""
        return np.concatenate([self._last[name] for name in self.possible_agents])

    def render(self):
        """There is nothing to see here: run.write() makes a file for plot.py and `shoal view`."""

    def close(self):
        self.run = self._kept = None

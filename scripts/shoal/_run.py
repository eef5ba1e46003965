"""Runs in memory: shoal.Run."""

from __future__ import annotations

import ctypes
import difflib
import html
import json
import os
import tempfile
import threading
import weakref
from typing import Callable, Iterable, Mapping, Sequence

import numpy as np

from . import _library as lib
from ._library import CaseError, Error, SolverError, check, index_of, kind, number_of, numbers_of, text_of
from ._progress import report

Case = "str | os.PathLike | Mapping"
Assignments = "Mapping[str, object] | Iterable[str] | None"

# keys of Run.set
KEYS = ("wave.amplitude", "wave.frequency", "control.bias", "motion.heave", "control.desired_heading", "control.offset",
        "control.waypoints")

# ---- cases


def _plain(value):
    """NumPy's numbers and arrays as JSON."""
    if np.ma.is_masked(value):
        raise ValueError("a value is masked: fill it first")
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise TypeError(f"{kind(value)} cannot stand in a case")


def yaml_of(value) -> str:
    """A value in the syntax of a case file: JSON is YAML."""
    try:
        return json.dumps(value, default=_plain, allow_nan=False)
    except ValueError as error:
        raise CaseError(f"a case cannot hold {kind(value)}: {error}") from error
    except RecursionError:
        raise CaseError(f"a case cannot hold {kind(value)}: nested too deep") from None


def text_of_case(case: Mapping) -> str:
    """A dict as the text of a case file."""
    return yaml_of({"format": 1, "name": "run", **case})


def strings_of(assignments) -> list[str]:
    """ "key=value" of a dict; a list of such strings stays as it is."""
    if assignments is None:
        return []
    if isinstance(assignments, Mapping):
        return [f"{key}={yaml_of(value)}" for key, value in assignments.items()]
    if isinstance(assignments, (str, bytes)) or not isinstance(assignments, Iterable):
        raise TypeError(f'assignments are a dict {{"time.end": 2}} or a list ["time.end=2"], not {kind(assignments)}')
    return list(assignments)


# ---- the run of the library


class _Handle:
    """The run of the library with a lock. The run is closed when neither a Run nor a view of an array refers to it."""

    def __init__(self, pointer: int):
        self.pointer = pointer
        self.lock = threading.RLock()
        self.is_torn = False
        _handles.add(self)

    def __del__(self, close=lib.library.shoal_close if not isinstance(lib.library, lib._Missing) else None):
        if not self.is_torn:
            close(self.pointer)


_handles: weakref.WeakSet[_Handle] = weakref.WeakSet()


def _begin_child():
    """After a fork: the other threads and their locks are gone. A run in a step of another thread is torn: the memory is
    between two events."""
    for handle in list(_handles):
        if not handle.lock.acquire(blocking=False) or lib.worker is not None and handle.pointer in lib.worker.arguments:
            handle.is_torn = True
        handle.lock = threading.RLock()
    lib.forget_worker()


os.register_at_fork(after_in_child=_begin_child)


class _Memory:
    """The base of a NumPy view, with a reference to the run that owns the memory."""

    def __init__(self, handle, address, shape, dtype):
        self.handle = handle
        self.__array_interface__ = {"data": (address, True), "shape": shape, "typestr": dtype.str, "version": 3}


class Variable(np.ndarray):
    """The values of a variable at one event, with dims, unit and long_name. Slices and results of arithmetic have none."""

    dims: tuple[str, ...] | None = None
    unit: str | None = None
    long_name: str | None = None


def variables() -> list[str]:
    """The names of all variables of doc/output.md."""
    if not _variables:
        while name := lib.library.shoal_variable(len(_variables)):
            _variables.append(name.decode())
    return _variables


_variables: list[str] = []


def _refuse_name(name):
    if not isinstance(name, str):
        raise TypeError(f"a variable is named by a string, not {kind(name)}: run.keys() lists the names")
    near = difflib.get_close_matches(name, variables(), 3, 0.5)
    hint = f"did you mean {', '.join(near)}? " if near else ""
    raise CaseError(f"there is no variable {name!r}: {hint}run.keys() lists the names")


class _Using:
    """The pointer of a run, with its lock, in a with statement."""

    __slots__ = ("run", "lock")

    def __init__(self, run):
        self.run = run

    def __enter__(self):
        self.lock = (self.run._handle or self.run._open()).lock
        self.lock.acquire()
        try:
            return self.run._locked()
        except BaseException:
            self.lock.release()
            raise

    def __exit__(self, *_):
        self.lock.release()


class Run:
    """A case in memory, at the last event.

    case: the path of a case file, or a dict with the content of a case file. assignments: {"fish[0].nodes": 9}, changes
    of the case. folder: the folder for the includes of a dict (None: the working directory).

    A run is locked during a call; a second thread waits. copy.copy and copy.deepcopy clone; pickle contains a checkpoint.
    After a fork the child has a separate run. Errors are shoal.CaseError and others, with the message of the program.
    """

    def __init__(self, case: Case, assignments: Assignments = None, folder: str | os.PathLike | None = None):
        strings = [text_of(text, "an assignment") for text in strings_of(assignments)]
        array = (ctypes.c_char_p * len(strings))(*strings)
        if isinstance(case, Mapping):
            text, place = text_of(text_of_case(case), "a case"), None if folder is None else text_of(folder, "folder")
            pointer = lib.open_run(lib.library.shoal_open_text, text, place, len(strings), array)
        elif isinstance(case, (str, bytes, os.PathLike)):
            pointer = lib.open_run(lib.library.shoal_open, text_of(case, "a case"), len(strings), array)
        else:
            raise TypeError(f"a case is the path of a case file or a dict, not {kind(case)}")
        self._take(pointer.value)

    def _take(self, pointer):
        self._handle: _Handle | None = _Handle(pointer)
        self._names: list[str] | None = None
        self._views: dict[str, tuple] = {}
        self.path: str | None = None  #: the result file that write() began

    def _using(self) -> _Using:
        return _Using(self)

    def _open(self) -> _Handle:
        handle = self._handle
        if handle is None:
            raise CaseError("the run is closed: open it again with shoal.Run")
        if handle.is_torn:
            raise SolverError("another thread was in this run when the process forked: open the run in the child, or "
                              "fork while no thread is in it")
        return handle

    def _locked(self) -> int:
        """The pointer, with the lock of the run."""
        pointer = self._open().pointer  # the run may have been closed meanwhile
        if lib.worker is not None and pointer in lib.worker.arguments:
            raise SolverError("a signal handler cannot use a run between two of its events: set a flag there instead")
        return pointer

    def __enter__(self) -> Run:
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        """Close the result file, if open, and release the run. Views of variables stay valid."""
        if self._handle is None:
            return
        if not self._handle.is_torn:
            with self._using() as pointer:
                lib.library.shoal_write_end(pointer)
        self._handle, self._views = None, {}

    @property
    def closed(self) -> bool:
        """Whether the run is closed."""
        return self._handle is None

    # -- copies

    def clone(self) -> Run:
        """A copy at the last event, without the result file. Run and copy continue with the same bits, each by itself."""
        with self._using() as own:
            return self._adopt(lib.open_run(lib.library.shoal_clone, own).value)

    @classmethod
    def _adopt(cls, pointer):
        run = object.__new__(cls)
        run._take(pointer)
        return run

    def __copy__(self):
        return self.clone()

    def __deepcopy__(self, memo):
        return self.clone()

    def restore(self, other: Run):
        """Return to the state of a copy, or of the run from which this run was copied."""
        if not isinstance(other, Run):
            raise TypeError(f"restore: a Run, not {kind(other)}")
        first, second = sorted((self._open(), other._open()), key=id)
        with first.lock, second.lock, self._using() as own, other._using() as its:
            check(lib.library.shoal_restore(own, its))

    def save(self, path: str | os.PathLike):
        """Write a checkpoint with the case and the state at the last event, from which shoal.load continues with the
        same bits. A checkpoint at path is replaced; another file is a FileError."""
        with self._using() as pointer:
            check(lib.library.shoal_save(pointer, text_of(path, "path")))

    def __reduce__(self):
        try:
            with tempfile.TemporaryDirectory() as folder:
                path = os.path.join(folder, "run.ckpt")
                self.save(path)
                with open(path, "rb") as file:
                    return _unpickle, (type(self), file.read())
        except Error as error:
            raise TypeError(f"this run cannot be pickled: {error}. Pickle the case and its assignments, and open the run "
                            "there") from error

    # -- time

    def _time(self, function) -> float:
        with self._using() as pointer:
            return function(pointer)

    @property
    def time(self) -> float:
        """Time of the last event, s."""
        return self._time(lib.library.shoal_time)

    @property
    def end(self) -> float:
        """Time of the last event of the case, s."""
        return self._time(lib.library.shoal_end)

    @property
    def interval(self) -> float:
        """Time between two events, s."""
        return self._time(lib.library.shoal_interval)

    @property
    def at_end(self) -> bool:
        """Whether there is no further event."""
        with self._using() as pointer:
            return bool(lib.library.shoal_time(pointer) >= lib.library.shoal_end(pointer))

    def step(self, n: int = 1):
        """Advance by n events, each one shedding interval later."""
        if type(n) is not int or n < 0:
            number = number_of(n, "step: a number of events")
            n = int(number)
            if n != number:
                raise CaseError(f"step: {number} events: the number is whole")
            if n < 0:
                raise CaseError(f"step: {n} events: the number cannot be negative")
        with (self._handle or self._open()).lock:
            pointer = self._locked()
            for _ in range(n):
                lib.call(lib.library.shoal_step, pointer)

    def advance(self, time: float, progress: Callable[[float, float], None] | bool | None = False):
        """Advance to the first event at or after a time, s, which must not be before the last event.

        progress: a function of (time, time to reach), called several times a second; True: a bar on standard error or
        in a notebook; None: a bar on a terminal or in a notebook. Ctrl-C stops at the next event, or during a long event
        at the last one; the run can continue.
        """
        target = number_of(time, "advance: a time, s,")
        with report(progress) as show, self._using() as pointer:
            first, interval = lib.library.shoal_time(pointer), lib.library.shoal_interval(pointer)
            end = lib.library.shoal_end(pointer)

            # event by event: Python looks for signals between two calls
            while (now := lib.library.shoal_time(pointer)) + interval < target <= end * (1 + 1e-9):
                show(now - first, target - first, now, target)
                lib.call(lib.library.shoal_advance, pointer, now + interval)

            lib.call(lib.library.shoal_advance, pointer, target)
            show(1, 1, lib.library.shoal_time(pointer), target, is_due=True)

    # -- from outside

    def set(self, fish: int | str, key: str, value: float | Sequence):
        """Set, at the last event, a key of a fish, given by number or name: wave.amplitude, wave.frequency (Hz),
        control.bias, motion.heave (m), control.desired_heading (degree), each one number, control.offset, (x, y) in m, or
        control.waypoints, pairs (n, 2) in m. The change is made within control.ramp."""
        number = index_of(fish, self.names, "set")
        if not isinstance(key, str):
            raise TypeError(f"set: a key is one of {', '.join(KEYS)}, not {kind(key)}")
        values = numbers_of(value, f"set: {key}", 2**20)
        pointer = values.ctypes.data_as(ctypes.POINTER(ctypes.c_double))
        with self._using() as run:
            check(lib.library.shoal_set(run, number, text_of(key, "set: a key"), values.size, pointer))

    def state(self, fish: int | str = 0) -> tuple[np.ndarray, np.ndarray]:
        """Positions (nodes, 2), m, and velocities (nodes, 2), m s-1, of the nodes of a fish, nose to tail."""
        number = index_of(fish, self.names, "state")
        with self._using() as pointer:
            n = check(lib.library.shoal_n_nodes(pointer, number))
            position, velocity = np.empty((n, 2)), np.empty((n, 2))
            check(lib.library.shoal_state(pointer, number, position.ctypes.data, velocity.ctypes.data))
        return position, velocity

    def set_state(self, fish: int | str = 0, position=None, velocity=None):
        """Set positions (nodes, 2), m, and velocities (nodes, 2), m s-1, of the nodes of a fish; None: unchanged.

        Bound sheets and forces follow; the added energy and momentum count as external work and impulse. The wake of a
        moved fish continues at the new tail, which requires wake.spare_vortices of 1 or more (with wake.shedding: sheet).
        """
        number = index_of(fish, self.names, "set_state")
        with self._using() as pointer:
            n = check(lib.library.shoal_n_nodes(pointer, number))
            addresses, kept = [], []
            for what, value in (("position", position), ("velocity", velocity)):
                array = None if value is None else numbers_of(value, f"set_state: {what}")
                if array is not None and array.shape != (n, 2):
                    raise CaseError(f"set_state: {what} of {self.names[number]} has the shape ({n}, 2), not {array.shape}")
                kept.append(array)
                addresses.append(None if array is None else array.ctypes.data)
            check(lib.library.shoal_set_state(pointer, number, *addresses))

    def add_vortex(self, x: float, y: float, circulation: float, fish: int | str = 0):
        """Add a free vortex at (x, y), m, of a circulation, m2 s-1, positive counter-clockwise.

        The vortex belongs to the wake of a fish, and moves, decays and is removed like a vortex shed now. A vortex of
        opposite circulation is infinitely far away. Each vortex needs 3 of the case's wake.spare_vortices with
        wake.shedding: sheet, else 1.
        """
        number = index_of(fish, self.names, "add_vortex")
        values = [number_of(value, f"add_vortex: {name}") for name, value in
                  (("x", x), ("y", y), ("circulation", circulation))]
        with self._using() as pointer:
            check(lib.library.shoal_add_vortex(pointer, number, *values))

    # -- values at the last event

    @property
    def names(self) -> list[str]:
        """The names of the fish."""
        if self._names is None:
            self._names = [name.tobytes().rstrip(b"\0").decode() for name in self["fish"]]
        self._open()
        return list(self._names)

    def keys(self) -> list[str]:
        """The names of all variables: doc/output.md."""
        return list(variables())

    def _ipython_key_completions_(self) -> list[str]:
        return self.keys()

    def __iter__(self):
        return iter(self.keys())

    def __len__(self) -> int:
        return len(variables())

    def __bool__(self) -> bool:
        return True

    def __contains__(self, name) -> bool:
        return name in variables()

    def _view(self, name, pointer) -> Variable:
        array = lib.Array()
        if name not in self._views and name not in variables():
            _refuse_name(name)
        code = lib.library.shoal_read(pointer, name.encode(), array)
        if code:
            check(code)
        shape = tuple(array.shape[: array.n_dimensions])
        known = self._views.get(name)
        if known is None or known[0] != array.values or known[1] != shape:
            memory = _Memory(self._handle, array.values, shape, lib.TYPES[array.type])
            view = np.asarray(memory).view(Variable)
            view.dims = tuple(array.dimension[d].decode() for d in range(array.n_dimensions))
            view.unit, view.long_name = array.unit.decode(), array.long_name.decode()
            self._views[name] = known = array.values, shape, view
        return known[2]

    def __getitem__(self, name: str) -> Variable:
        """A copy of a variable at the last event, in C order, with dims, unit and long_name; NaN beyond the nodes or
        vortices of a fish."""
        if not isinstance(name, str):
            _refuse_name(name)
        with self._using() as pointer:
            view = self._view(name, pointer)
            copy = view.copy()
        copy.dims, copy.unit, copy.long_name = view.dims, view.unit, view.long_name
        return copy

    def view(self, name: str) -> Variable:
        """A read-only view of a variable, without copying. The view shows the event of the last call of view(), and stays
        valid after the run is closed. After a step call view() again."""
        if not isinstance(name, str):
            _refuse_name(name)
        with _Using(self) as pointer:
            return self._view(name, pointer)

    def flow(self, points) -> tuple[np.ndarray, np.ndarray]:
        """Velocity (..., 2), m s-1, and vorticity (...), s-1, of the fluid at points (..., 2), m."""
        points = numbers_of(points, "flow: points")
        if points.ndim == 0 or points.shape[-1] != 2:
            raise CaseError(f"flow: points have the shape (..., 2), not {points.shape}")
        with self._using() as pointer:
            velocity, vorticity = np.empty(points.shape), np.empty(points.shape[:-1])
            check(lib.library.shoal_flow(pointer, vorticity.size, points.ctypes.data, velocity.ctypes.data,
                                         vorticity.ctypes.data))
        return velocity, vorticity

    def to_xarray(self):
        """All variables at the last event as an xarray.Dataset with the coordinates fish, xy and time."""
        from ._results import dataset_of

        return dataset_of(self)

    # -- files

    def write(self, path: str | os.PathLike | None = None, overwrite: bool = False) -> str:
        """Write a result file from now on, until the end or write_end(); returns the path. None: the default path of the
        program. overwrite: replace an existing result; otherwise an existing result is a FileError."""
        encoded = None if path is None else text_of(path, "path")
        with self._using() as pointer:
            if encoded is None:
                encoded = lib.library.shoal_result_path(pointer)
            check(lib.library.shoal_write(pointer, encoded, bool(overwrite)))
            self.path = os.fsdecode(encoded)
        return self.path

    def checkpoint(self):
        """Write a checkpoint beside the result file, RESULT.ckpt, from which `shoal resume` continues."""
        with self._using() as pointer:
            check(lib.library.shoal_checkpoint(pointer))

    def write_end(self):
        """Close the result file; a run that is not at its end is marked "stopped". No-op without a file."""
        with self._using() as pointer:
            check(lib.library.shoal_write_end(pointer))

    # -- in a terminal and in a notebook

    def __repr__(self) -> str:
        if self._handle is None:
            return "<shoal.Run, closed>"
        if self._handle.is_torn:
            return "<shoal.Run, torn by a fork>"
        names = self.names
        shown = ", ".join(names[:4]) + (", ..." if len(names) > 4 else "")
        return f"<shoal.Run of {len(names)} fish ({shown}) at t = {self.time:.6g} of {self.end:.6g} s>"

    def _repr_html_(self) -> str:
        """The page of the result file with the rows so far; without a result file the current bodies and wakes."""
        from ._draw import snapshot_of
        from ._program import page_of_file

        if self._handle is None or self._handle.is_torn:
            return f"<p>{html.escape(repr(self))}</p>"
        try:
            return page_of_file(self.path) if self.path else snapshot_of(self)
        except (Error, OSError):  # no program, or a file that is gone
            return snapshot_of(self)


def _unpickle(cls, content: bytes) -> Run:
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "run.ckpt")
        with open(path, "wb") as file:
            file.write(content)
        try:
            return _load(cls, path)
        except lib.FileError as error:
            raise TypeError(f"this run cannot be restored: {str(error).replace(path, 'the pickle')}") from error


def _load(cls, path):
    return cls._adopt(lib.open_run(lib.library.shoal_load, text_of(path, "path")).value)


def load(path: str | os.PathLike) -> Run:
    """A run from a checkpoint of Run.save, Run.checkpoint or the program, without a result file."""
    return _load(Run, path)


def run(case: Case, assignments: Assignments = None, path: str | os.PathLike | None = None, overwrite: bool = False,
        progress: Callable[[float, float], None] | bool | None = None, folder: str | os.PathLike | None = None) -> str:
    """Run a case to the end and return the path of the result file, the same file as of `shoal run`.

    path: of the result (None: output.file of the case, or the name of the case with .nc). overwrite: replace an existing
    result, like --force; otherwise an existing result is a FileError. progress: as in Run.advance.
    """
    with Run(case, assignments, folder) as this:
        path = this.write(path, overwrite)
        this.advance(this.end, progress)
        this.write_end()
    return path

"""The library libshoal through ctypes: loading, errors, and the checks of every argument before ctypes sees it."""

from __future__ import annotations

import contextlib
import ctypes
import difflib
import math
import operator
import os
import pathlib
import threading

import numpy as np


class Error(Exception):
    """A call of the library has failed."""


class CaseError(Error, ValueError):
    """A wrong case or a wrong argument."""


class FileError(Error, OSError):
    """A file cannot be read or written."""


class SolverError(Error, RuntimeError):
    """The integration has failed."""


ERRORS = {-1: CaseError, -2: FileError, -3: MemoryError, -4: SolverError}

# ---- loading


class Array(ctypes.Structure):
    """struct shoal_array"""

    _fields_ = [
        ("values", ctypes.c_void_p),
        ("type", ctypes.c_int),
        ("n_dimensions", ctypes.c_int),
        ("shape", ctypes.c_size_t * 4),
        ("dimension", ctypes.c_char_p * 4),
        ("unit", ctypes.c_char_p),
        ("long_name", ctypes.c_char_p),
    ]


TYPES = [np.dtype(t) for t in (ctypes.c_double, ctypes.c_int, ctypes.c_long, "S1")]  # enum shoal_type

_run, _int, _double, _text = ctypes.c_void_p, ctypes.c_int, ctypes.c_double, ctypes.c_char_p
_array = ctypes.c_void_p  # the address of doubles
SIGNATURES = {  # name: result, arguments
    "shoal_open": (_int, ctypes.POINTER(_run), _text, _int, ctypes.POINTER(_text)),
    "shoal_open_text": (_int, ctypes.POINTER(_run), _text, _text, _int, ctypes.POINTER(_text)),
    "shoal_listen": (None, ctypes.POINTER(_int)),
    "shoal_close": (None, _run),
    "shoal_step": (_int, _run),
    "shoal_advance": (_int, _run, _double),
    "shoal_set": (_int, _run, _int, _text, _int, ctypes.POINTER(_double)),
    "shoal_clone": (_int, ctypes.POINTER(_run), _run),
    "shoal_restore": (_int, _run, _run),
    "shoal_n_nodes": (_int, _run, _int),
    "shoal_state": (_int, _run, _int, _array, _array),
    "shoal_set_state": (_int, _run, _int, _array, _array),
    "shoal_add_vortex": (_int, _run, _int, _double, _double, _double),
    "shoal_save": (_int, _run, _text),
    "shoal_load": (_int, ctypes.POINTER(_run), _text),
    "shoal_time": (_double, _run),
    "shoal_end": (_double, _run),
    "shoal_interval": (_double, _run),
    "shoal_read": (_int, _run, _text, ctypes.POINTER(Array)),
    "shoal_variable": (_text, _int),
    "shoal_flow": (_int, _run, _int, _array, _array, _array),
    "shoal_n_fish": (_int, _run),
    "shoal_write": (_int, _run, _text, _int),
    "shoal_write_end": (_int, _run),
    "shoal_checkpoint": (_int, _run),
    "shoal_result_path": (_text, _run),
    "shoal_message": (_text,),
    "shoal_version": (_text,),
}
NAME = "libshoal.so.0"
HERE = pathlib.Path(__file__).resolve().parent


def _find():
    """SHOAL_LIBRARY; beside the modules (a wheel); build/ of the sources; lib/ above dist-packages or site-packages."""
    places = [os.environ.get("SHOAL_LIBRARY"), HERE / NAME, HERE / "../../build" / NAME, HERE / "../../.." / NAME,
              HERE / "../../../.." / NAME]  # ".." of / is /
    return next((str(place) for place in places if place and os.path.isfile(place)), NAME)


class _Missing:
    """In place of a library that cannot be loaded: results can still be read and drawn."""

    def __init__(self, error):
        self._error = error

    def __getattr__(self, name):
        raise ImportError(f"{self._error}: build it with `make`, or name it in SHOAL_LIBRARY")


def _load():
    # SUNDIALS 7 of Debian loads MPI, which would catch SIGHUP and crashes in a process that only imports shoal
    for name, value in (("UCX_HANDLE_ERRORS", "none"), ("UCX_DEBUG_SIGNO", "0")):
        os.environ.setdefault(name, value)
    try:
        library = ctypes.CDLL(_find())
    except OSError as error:
        return _Missing(error)
    for name, (result, *arguments) in SIGNATURES.items():
        function = getattr(library, name)
        function.restype, function.argtypes = result, arguments
    return library


library = _load()


def message() -> str:
    """The message of the last failure in this thread."""
    return library.shoal_message().decode(errors="replace")


def check(code: int) -> int:
    """Raise the exception of a negative status."""
    if code < 0:
        raise ERRORS.get(code, Error)(message())
    return code


class _Worker:
    """A thread for calls of the main thread that can take long. Python handles signals in the main thread, between two
    lines, so the call runs in this thread, which listens to a flag, while the main thread waits."""

    def __init__(self):
        self.stop = ctypes.c_int(0)
        self.begin, self.done = threading.Lock(), threading.Lock()
        self.begin.acquire()
        self.done.acquire()
        self.function, self.arguments = None, ()  # () between two calls
        threading.Thread(target=self._serve, name="shoal", daemon=True).start()

    def _serve(self):
        library.shoal_listen(self.stop)
        while True:
            self.begin.acquire()
            self.code = self.function(*self.arguments)
            self.message = message() if self.code < 0 else ""
            self.arguments = ()
            with contextlib.suppress(RuntimeError):  # already released, because a signal came while the main thread waited
                self.done.release()

    def wait(self, raised):
        """After an exception of a signal handler: stop a call that does not end within half a second."""
        patience = 0.5
        while self.arguments:
            try:
                self.stop.value = not self.done.acquire(timeout=patience)
                patience = -1
            except BaseException as error:
                raised = error
        self.stop.value = 0
        raise raised


worker: _Worker | None = None
_main = threading.main_thread().ident


def forget_worker():
    """In the child of a fork there is one thread, and no worker."""
    global worker, _main
    worker, _main = None, threading.get_ident()


def call(function, *arguments) -> int:
    """Call a function that can take long and raise the exception of a negative status. Ctrl-C stops the call, also during
    a long event; a run is then at the last event and can continue."""
    global worker
    if threading.get_ident() != _main or worker is not None and worker.arguments:
        return check(function(*arguments))
    if worker is None:
        worker = _Worker()
    try:
        worker.function, worker.arguments = function, arguments
        worker.begin.release()
        worker.done.acquire()
    except BaseException as error:
        worker.wait(error)
    while worker.arguments:  # an earlier release, which a signal has left
        worker.done.acquire()
    if worker.code < 0:
        raise ERRORS.get(worker.code, Error)(worker.message)
    return worker.code


def open_run(function, *arguments) -> ctypes.c_void_p:
    """The run that a function of the library opens."""
    pointer = ctypes.c_void_p()
    try:
        call(function, pointer, *arguments)
    except BaseException:
        library.shoal_close(pointer)
        raise
    return pointer


def version() -> str:
    """The version of the library with its commit: "shoal 0.2.0 (commit ...)"."""
    return library.shoal_version().decode()


# ---- arguments


def kind(value) -> str:
    """What a message says of a value of a wrong type."""
    name = type(value).__name__
    try:
        shown = repr(value)
    except RecursionError:  # nested too deep
        return name
    return f"{name} {shown}" if len(shown) < 60 else name


def text_of(value, what: str) -> bytes:
    """A string or path for the library, which would take its first zero byte for its end."""
    if not isinstance(value, (str, bytes, os.PathLike)):
        raise TypeError(f"{what} is a string or a path, not {kind(value)}")
    try:
        encoded = os.fsencode(value)
    except UnicodeEncodeError as error:
        raise CaseError(f"{what}: {value!r} has a surrogate in it, which is no character") from error
    if b"\0" in encoded:
        raise CaseError(f"{what}: {value!r} has a zero byte in it")
    return encoded


def netcdf_path(path):
    """A path for netCDF4 and xarray, which take names in UTF-8 only."""
    try:
        os.fspath(path).encode()
    except UnicodeEncodeError as error:
        raise FileError(f"{os.fspath(path)!r}: the name is not UTF-8: rename the file or its folder") from error
    except AttributeError:  # bytes
        return netcdf_path(os.fsdecode(path))
    return path


def refuse_masked(value, what: str):
    """NumPy hands over what is behind a mask, or NaN."""
    if np.ma.is_masked(value):
        raise CaseError(f"{what}: a value is masked: fill it first")


def number_of(value, what: str) -> float:
    """A finite number for the library."""
    refuse_masked(value, what)
    if isinstance(value, (str, bytes)) or np.ndim(value) != 0:
        raise TypeError(f"{what} is one number, not {kind(value)}")
    try:
        number = float(value)
    except (TypeError, OverflowError) as error:
        raise TypeError(f"{what} is one number, not {kind(value)}") from error
    if not math.isfinite(number):
        raise CaseError(f"{what}: {number} is not finite")
    return number


def numbers_of(value, what: str, most: int = 2**28) -> np.ndarray:
    """At most as many numbers for the library, in C order; more are refused before they are copied."""
    refuse_masked(value, what)
    try:
        array = np.asarray(value)
    except ValueError as error:  # lists of different lengths
        raise CaseError(f"{what}: {error}") from error
    if array.dtype.kind not in "fiub":
        raise TypeError(f"{what}: numbers, not {kind(value)}")
    if array.size > most:
        raise CaseError(f"{what}: {array.size} numbers are too many")
    return np.ascontiguousarray(array, dtype=float)


def index_of(value, names: list, what: str) -> int:
    """The number of a fish, from 0, given by number or name."""
    known = f"this run has {len(names)}, numbered from 0: {', '.join(names)}"
    if isinstance(value, str):
        if value in names:
            return names.index(value)
        raise CaseError(f"{what}: there is no fish '{value}': {known}")
    try:
        number = operator.index(value)
    except TypeError as error:
        raise TypeError(f"{what}: a fish is a number or a name, not {kind(value)}: {known}") from error
    if not 0 <= number < len(names):
        raise CaseError(f"{what}: there is no fish {number}: {known}")
    return number


def choice_of(value, known, what: str):
    """One of the known words; the message suggests the nearest and lists all."""
    if isinstance(value, str) and value in known:
        return value
    if not isinstance(value, str):
        raise TypeError(f"{what} is one of {', '.join(known)}, not {kind(value)}")
    near = difflib.get_close_matches(value, known, 1)
    hint = f"; did you mean '{near[0]}'?" if near else ""
    raise CaseError(f"{what}: {value!r} is none of {', '.join(known)}{hint}")

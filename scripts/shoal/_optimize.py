"""shoal.optimize: the numbers of a case for which a quantity of its steady state is least."""

from __future__ import annotations

import csv
import os
import re
import shutil
import sys
from typing import Mapping

import numpy as np

from ._library import CaseError, Error, FileError, SolverError, kind, number_of
from ._program import _path, _shows, error, keys, steady
from ._run import strings_of

FACTOR = 2.0  # a number without bounds stays within this factor of its start
FAILED = 1.5  # what a point without a steady state counts as, over the largest value so far: the search turns back


def _steady_name(quantity: str) -> str:
    if not isinstance(quantity, str):
        raise TypeError(f"optimize: a quantity is a name such as 'cost_of_transport', not {kind(quantity)}")
    return quantity if quantity.startswith("steady_") else f"steady_{quantity}"


class Optimum:
    """The result of shoal.optimize.

    values: the numbers that were found, by the paths of the keys. assignments: the same for shoal.steady, shoal.error and shoal.run.
    value, start: the quantity there and at the start. reached: the quantities of subject_to. success, message: of the minimiser.
    path: of the last steady state. history: a dict for each steady state of the search, in order: its keys are the paths, the
    quantities, and "is_failed".
    """

    def __init__(self, quantity, wanted, history, values, assignments, path, success, message, fish):
        self.quantity: str = quantity
        self.history: list[dict] = history
        self.values: dict[str, float] = values
        self.assignments: dict[str, float] = assignments
        self.path: str = path
        self.success: bool = success
        self.message: str = message
        self._wanted, self._fish = wanted, fish
        last = next(row for row in reversed(history) if all(row[key] == value for key, value in values.items()))
        self.start: float = history[0][quantity]  #: at the start
        self.value: float = last[quantity]  #: at the optimum
        self.reached: dict[str, float] = {name: last[name] for name in wanted}

    def __repr__(self):
        numbers = ", ".join(f"{key} {value:.4g}" for key, value in self.values.items())
        others = "".join(f", {name} {value:.4g}" for name, value in self.reached.items())
        state = "" if self.success else f"; not converged: {self.message}"
        return (f"<shoal.Optimum: {self.quantity} {self.value:.5g}, {self.value / self.start:.4g} of the start{others}, at {numbers}; "
                f"{len(self.history)} steady states{state}>")

    def plot(self):
        """The quantities and the numbers over the steady states of the search, as matplotlib axes."""
        from ._plot_style import matplotlib, unit_text  # noqa: F401 - says what is missing
        import matplotlib.pyplot as pyplot

        units = {row["path"]: row["unit"] for row in keys()} | {row["name"]: row["unit"] for row in keys(output=True)}
        names = [self.quantity, *self._wanted, *self.values]
        figure, stack = pyplot.subplots(len(names), 1, sharex=True, squeeze=False, layout="constrained",
                                        figsize=(3.4, 0.6 + 0.9 * len(names)))
        at = np.arange(len(self.history))
        for axes, name in zip(stack[:, 0], names):
            values = np.array([row[name] for row in self.history])
            axes.plot(at, values, color="black", lw=0.8, marker="o", ms=3)
            if np.nanmin(values) > 0 and np.nanmax(values) > 30 * np.nanmin(values):
                axes.set_yscale("log")
            for bound in np.atleast_1d(np.asarray(self._wanted.get(name, []), dtype=float)):
                axes.axhline(bound, color="#d55e00", lw=0.8, ls="--")
            words, unit = re.sub(r"^(fish\.\w+\.|steady_)", "", name).replace("_", " "), units.get(name, "1")
            axes.set_ylabel(words if unit == "1" else f"{words}\n[{unit_text(unit)}]", size=7)
            axes.grid(lw=0.3, color="#dddddd")
        stack[-1, 0].set_xlabel("steady states")
        return stack[:, 0]


class _Search:
    """The states of a search: values and derivatives at the logarithms of the numbers over their starts."""

    def __init__(self, case, quantities, over, assignments, folder, path, processes, progress, fish):
        self.case, self.quantities, self.given, self.folder = case, quantities, strings_of(assignments), folder
        self.path, self.processes, self.progress, self.fish = path, processes, progress, fish
        self.history: list[dict] = []
        self.known: dict[tuple, dict | None] = {}  # None: no steady state
        self.slopes: dict[tuple, dict] = {}
        self.last = None  # path of the last steady state
        self.keys: list[str] = []
        self.first: np.ndarray = np.array([])
        self.times: dict[str, float] = {}
        self.begin(over)

    def assignments(self, x) -> dict:
        """The numbers at x, and the times of the case as parts of the beat."""
        numbers = self.first * np.exp(x)
        found = {re.sub(r"^fish\.", "fish[*].", key): float(number) for key, number in zip(self.keys, numbers)}
        for key, number in zip(self.keys, numbers):
            if key.endswith(".frequency"):
                part = self.first[self.keys.index(key)] / number
                found |= {name: time * part for name, time in self.times.items()}
        return found

    def _all(self, x):
        return [*self.given, *(f"{key}={value!r}" for key, value in self.assignments(x).items())]

    def _derive(self, x, keys, start):
        """The estimates of all quantities with the derivatives by the keys."""
        where = os.path.join(self.path, "derivatives")
        given = self._all(x) if self.keys else self.given
        found = error(self.case, self.quantities, assignments=[*given, "steady.multipliers=false"], path=where, overwrite=True,
                      processes=self.processes, progress=False, folder=self.folder, sensitivity=keys, start=start)
        return {one.quantity: one for one in found if one.fish in ("", self.name_of(found))}, where

    def name_of(self, found) -> str:
        names = list(dict.fromkeys(one.fish for one in found if one.fish))
        if isinstance(self.fish, str):
            if self.fish not in names:
                raise CaseError(f"optimize: fish {self.fish!r} is none of {', '.join(names)}")
            return self.fish
        if not -len(names) <= self.fish < len(names):
            raise CaseError(f"optimize: fish {self.fish} is not in the school of {len(names)}")
        return names[self.fish] if names else ""

    def begin(self, over):
        """The starts of the numbers, and the first state."""
        from ._results import open as open_result

        found, where = self._derive(None, over, None)
        data = open_result(os.path.join(where, "study.nc"))
        one = found[self.quantities[0]]
        stated = data["key_stated"].values.reshape(-1, data.sizes["key"])[0]
        value = data["key_value"].values.reshape(-1, data.sizes["key"], data.sizes["key_level"])[0]
        starts = {str(name): float(value[k, stated[k]]) for k, name in enumerate(data["key_name"].values)}
        self.keys = list(one.sensitivity)
        if len(self.keys) < len(over):
            raise CaseError(f"optimize: a number of {', '.join(over)} cannot be changed by 4 %: see error.csv in {where}")
        self.first = np.array([starts[key] for key in self.keys])
        for name in ("time.shedding_interval", "time.end", "time.output_interval", "time.checkpoint_interval",
                     "output.wake_interval", "solver.step"):
            variable = "member_" + name.replace(".", "_")  # there with a frequency only
            if variable in data.coords:
                self.times[name] = float(data[variable].values[0])
        x = tuple(np.zeros(len(self.keys)))
        self.keep(x, {name: float(estimate.value) for name, estimate in found.items()}, os.path.join(where, "member-0000.nc"))
        self.slopes[x] = self.matrix(found)

    def matrix(self, found):
        return {name: np.array([estimate.value * estimate.sensitivity[key][0] for key in self.keys]) for name, estimate in found.items()}

    def keep(self, x, values, state):
        """Record a state; keep the file of the last one."""
        numbers = {key: float(number) for key, number in zip(self.keys, self.first * np.exp(x))}
        is_failed = values is None
        row = {**numbers, **(dict.fromkeys(self.quantities, np.nan) if is_failed else values), "is_failed": is_failed}
        self.history.append(row)
        self.known[x] = values
        if not is_failed:
            self.last = os.path.join(self.path, f"state-{len(self.history) - 1:04}.nc")
            if state != self.last:
                shutil.move(state, self.last)
        with open(os.path.join(self.path, "history.csv"), "w", encoding="utf-8", newline="") as file:
            table = csv.DictWriter(file, list(row))
            table.writeheader()
            table.writerows(self.history)
        if self.progress:
            said = ", ".join(f"{key.rsplit('.', 1)[-1].removeprefix('steady_')} {value:.5g}" for key, value in row.items()
                             if key != "is_failed")
            print(f"{len(self.history)}: {said}{': no steady state' if is_failed else ''}", file=sys.stderr, flush=True)

    def values(self, x):
        """The quantities at x; None: no steady state."""
        x = tuple(float(one) for one in x)
        if x not in self.known:
            state = os.path.join(self.path, f"state-{len(self.history):04}.nc")
            try:
                found = steady(self.case, [*self._all(np.array(x)), "steady.multipliers=false"], path=state, overwrite=True,
                               start=self.last, progress=False, folder=self.folder)
            except SolverError:
                self.keep(x, None, None)
                return None
            number = found.names.index(self.fish) if isinstance(self.fish, str) else self.fish
            self.keep(x, {name: float(np.atleast_1d(getattr(found, name.removeprefix("steady_")))[number])
                          for name in self.quantities}, state)
        return self.known[x]

    def slope(self, x, name):
        """The derivatives of a quantity by the logarithms of the numbers."""
        x = tuple(float(one) for one in x)
        if x not in self.slopes:
            if self.values(x) is None:
                raise SolverError("optimize: the minimiser asks for derivatives at numbers without a steady state: give "
                                  f"narrower bounds; {self.path}/history.csv has the numbers")
            self.slopes[x] = self.matrix(self._derive(np.array(x), self.keys, self.last)[0])
        return self.slopes[x][name]


def _pair(value, what: str) -> tuple:
    """(least, most), each a number or None."""
    if not isinstance(value, (tuple, list, np.ndarray)) or len(value) != 2:
        raise CaseError(f"{what}: expects (least, most), not {value!r}")
    return tuple(None if one is None else number_of(one, what) for one in value)


def _asked(value, what: str):
    """The value of subject_to: a number, or (least, most) of which one may be None."""
    if value is not None and np.ndim(value) == 0:
        return number_of(value, what)
    least, most = _pair(value, what)
    if (least is None and most is None) or None not in (least, most) and not least < most:
        raise CaseError(f"{what}: expects a value or (least, most), not {value!r}")
    return least, most


def _limits(bounds, keys, names, first):
    """Bounds of the logarithms of the numbers over their starts."""
    if bounds is None:
        bounds = {}
    if not isinstance(bounds, Mapping):
        if not isinstance(bounds, (tuple, list, np.ndarray)):
            raise TypeError(f"optimize: bounds is a dict of (least, most), or a list of them, not {kind(bounds)}")
        if len(bounds) != len(keys):
            raise CaseError(f"optimize: {len(bounds)} bounds for {len(keys)} numbers: give (least, most) for each, or a dict")
        bounds = dict(zip(names, bounds))
    unknown = [name for name in bounds if name not in names]
    if unknown:
        raise CaseError(f"optimize: bounds of {', '.join(map(str, unknown))}, which is not in over: {', '.join(names)}")
    limits = []
    for key, name, start in zip(keys, names, first):
        low, high = _pair(bounds.get(name, sorted((start / FACTOR, start * FACTOR))), f"optimize: bounds of {name}")
        if low is None or high is None or not (low / start > 0 and high / start > 0 and low < high):
            raise CaseError(f"optimize: bounds of {name}: expects (least, most) of the sign of its start, {start:g}")
        ends = sorted(np.log([low / start, high / start]))
        if not ends[0] <= 0 <= ends[1]:
            raise CaseError(f"optimize: the start of {name}, {start:g}, is not within its bounds, {low:g} and {high:g}")
        limits.append(tuple(ends))
    return limits


def optimize(case, quantity: str, over, bounds=None, subject_to: Mapping | None = None, assignments=None, path=None,
             overwrite: bool = False, maximum: bool = False, method: str = "SLSQP", tolerance: float = 1e-4, most: int = 30,
             fish: int | str = 0, processes: int | None = None, progress: bool | None = None, folder=None) -> Optimum:
    """Find numbers of a case for which a quantity of its steady state is least, by a minimiser of scipy.

        best = shoal.optimize("swim.yaml", "cost_of_transport", over=["wave.frequency", "body.modulus"],
                              bounds={"wave.frequency": (0.5, 2)}, subject_to={"speed": 0.8})
        shoal.error("swim.yaml", "steady_cost_of_transport", assignments=best.assignments, against="swim.yaml")

    quantity: as "cost_of_transport" or "efficiency", of a fish (name or number). over: numbers of the case as for the argument
    sensitivity of shoal.error, which start from their values in the case; all fish get the same. bounds: {key: (least, most)}, or a list in
    the order of over (None: half and twice the start). subject_to: {quantity: value}, or {quantity: (least, most)} with None
    for no bound. maximum: find the largest value. method: SLSQP or trust-constr of scipy.optimize.minimize. tolerance: of the
    quantity, relative. most: iterations.

    Every search for a steady state starts from the last one, and derivatives are those of shoal.error, with respect to the
    logarithms of the numbers. At numbers without a steady state the search turns back. path: of the folder with the states and
    history.csv, which is whole after Ctrl-C (None: the name of the case with -optimum). A folder that exists is a FileError
    unless overwrite. progress: a line per steady state.
    """
    try:
        from scipy import optimize as minimisers
    except ImportError as wrong:
        raise ImportError("shoal.optimize needs scipy: apt install python3-scipy, or pip install scipy") from wrong
    over = [over] if isinstance(over, str) else over
    if not isinstance(over, (tuple, list)) or not over:
        raise CaseError("optimize: over is a list of at least one number of the case, such as ['wave.frequency']")
    if method not in ("SLSQP", "trust-constr"):
        raise CaseError(f"optimize: method is SLSQP or trust-constr, not {method!r}")
    if subject_to is not None and not isinstance(subject_to, Mapping):
        raise TypeError(f"subject_to is a dict of quantities with their values, not {kind(subject_to)}")
    wanted = {_steady_name(name): _asked(value, f"optimize: subject_to of {name}") for name, value in (subject_to or {}).items()}
    if not number_of(tolerance, "optimize: tolerance") > 0:
        raise CaseError(f"optimize: tolerance is above 0, not {tolerance}")
    if type(most) is not int or most < 1:
        raise CaseError(f"optimize: most is a whole number of iterations above 0, not {most!r}")
    target = _steady_name(quantity)
    if target in wanted:
        raise CaseError(f"optimize: {quantity} is the quantity itself: it cannot be in subject_to")
    if path is None:
        name = case.get("name", "run") if isinstance(case, Mapping) else os.path.splitext(os.path.basename(os.fspath(case)))[0]
        path = f"{name}-optimum"
    path = _path(path, "path")
    if os.path.lexists(path) and not overwrite:
        raise FileError(f"{path}: exists: give another path, or overwrite=True")
    try:
        os.makedirs(path, exist_ok=True)
    except OSError as wrong:
        raise FileError(f"{path}: cannot create this folder ({wrong.strerror}): give another path") from wrong
    for name in os.listdir(path):
        if re.fullmatch(r"state-\d+\.nc|history\.csv", name):
            os.remove(os.path.join(path, name))

    search = _Search(case, [target, *wanted], over, assignments, folder, path, processes, _shows(progress), fish)
    limits = _limits(bounds, search.keys, over, search.first)
    start = search.history[0]
    sign, unit = (-1 if maximum else 1), abs(start[target])
    if not unit > 0:
        raise CaseError(f"optimize: {quantity} is {start[target]:g} at the start, so it has no relative change: start from other numbers")

    def value(x):
        found = search.values(x)
        if found is not None:
            return sign * found[target] / unit
        worst = max(sign * row[target] / unit for row in search.history if not row["is_failed"])
        return worst + (FAILED - 1) * max(1, abs(worst))

    conditions = []
    for name, asked in wanted.items():
        is_range = isinstance(asked, tuple)
        for which, one in enumerate(asked if is_range else [asked]):
            if one is None:
                continue
            scale, side = abs(one) or abs(start[name]) or 1.0, (-1 if is_range and which == 1 else 1)

            def far(x, name=name, one=one, scale=scale, side=side):
                found = search.values(x)
                return side * ((start if found is None else found)[name] - one) / scale

            def slope(x, name=name, scale=scale, side=side):
                return side * search.slope(x, name) / scale

            conditions.append({"type": "ineq" if is_range else "eq", "fun": far, "jac": slope})
    options = {"ftol": tolerance, "maxiter": most} if method == "SLSQP" else {"xtol": tolerance, "gtol": tolerance, "maxiter": most}
    result = minimisers.minimize(value, np.zeros(len(search.keys)), jac=lambda x: sign * search.slope(x, target) / unit, method=method,
                                 bounds=limits, constraints=conditions, options=options)
    x = tuple(float(one) for one in result.x)
    if search.values(x) is None:
        raise Error(f"optimize: the search ended at numbers without a steady state ({result.message}); {path}/history.csv has all")
    numbers = {key: float(number) for key, number in zip(search.keys, search.first * np.exp(x))}
    shutil.rmtree(os.path.join(path, "derivatives"), ignore_errors=True)
    row = next(n for n, row in enumerate(search.history) if all(row[key] == number for key, number in numbers.items()))
    return Optimum(target, wanted, search.history, numbers, search.assignments(np.array(x)),
                   os.path.join(path, f"state-{row:04}.nc"), bool(result.success), str(result.message), fish)

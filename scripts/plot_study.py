#!/usr/bin/python3
"""Pictures of studies and comparisons: study.nc of `shoal study`, and the file of `shoal compare`. Used by plot.py.

    a refined axis                  errors against resolution, with triangles of slope 1 and 2
    solver.method as an axis        cost against the other axis, a line per method
    a position as the only axis     a map of the places, a number at each
    two axes of numbers             a map over both
    anything else                   speed, cost of transport and Strouhal number over the first axis
    a comparison of methods         error against wall time and evaluations
"""

import ast

from shoal_results import FileError, netCDF4, np

# In black and white every line has its own mark and its own dashes.
MARKS = ["o", "s", "^", "D", "v", "P", "X", "*"]
DASHES = ["-", "--", "-.", ":", (0, (5, 1)), (0, (3, 1, 1, 1)), (0, (1, 1)), (0, (8, 2))]
COLOURS = ["#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#666666"]
NAMES = {"modulus": "Young's modulus", "rtol": "relative tolerance"}


class Study:
    """A study.nc or the file of a comparison, with its axes."""

    def __init__(self, path):
        self.path = path
        try:
            self.data = netCDF4.Dataset(path)
        except OSError as error:
            raise FileError(f"{path}: cannot be read ({error.strerror or error})") from error
        self.is_comparison = hasattr(self.data, "shoal_compare")
        if not self.is_comparison and not hasattr(self.data, "shoal_study"):
            raise FileError(f"{path}: neither a study.nc nor the file of a comparison")
        keys = [v for v in self.data.variables.values() if hasattr(v, "axis")]
        self.axes = [[v for v in keys if v.axis == a] for a in sorted({v.axis for v in keys})]
        self.complete = self["status"] == "complete"

    def __getitem__(self, name):
        return np.ma.filled(self.data.variables[name][:], np.nan) if self.is_number(name) else self.data[name][:]

    def is_number(self, name):
        return self.data.variables[name].dtype.kind in "fi"

    def label(self, name):
        """The last word of a key or the name of a quantity, with its unit."""
        variable = self.data.variables[name]
        word = variable.long_name.split(".")[-1] if hasattr(variable, "axis") else name
        unit = getattr(variable, "units", "1")
        return NAMES.get(word, word.replace("_", " ")) + (f" [{unit}]" if unit != "1" else "")


def style(i):
    """Mark, dashes and colour of line i."""
    return {
        "marker": MARKS[i % 8],
        "ls": DASHES[i % 8],
        "color": COLOURS[i % 8],
        "lw": 1,
        "ms": 4.5,
        "mfc": "white" if i % 2 else COLOURS[i % 8],
    }


def slope_triangle(axes, x, y, order):
    """A triangle of a slope in a double logarithmic panel: from (x, y) a factor of two to the right."""
    right, top = 2 * x, y * 2.0**order
    axes.plot([x, right, right, x], [y, y, top, y], color="#666666", lw=0.8)
    axes.annotate(f"{abs(order):g}", (right, np.sqrt(y * top)), (3, 0), textcoords="offset points", va="center", size=8)


def plot_convergence(study, refined, figure):
    """Errors of nose, tail, centre of mass and circulation against the finest level, one panel per fish."""
    size = study[refined.name]
    others = np.array([study[v.name] for axis in study.axes for v in axis if v.axis != refined.axis])
    group = np.unique(others, axis=1, return_inverse=True)[1].ravel() if others.size else np.zeros(size.size, int)
    falls = refined.long_name.endswith(("nodes", "sheet_points"))  # more points, less error
    names = list(study["fish_name"])
    all_axes = figure.subplots(1, len(names), squeeze=False, sharey=True)[0]
    for f, axes in enumerate(all_axes):
        errors, i = [], 0
        for g in range(group.max() + 1):
            of_group = np.flatnonzero((group == g) & study.complete)
            order = of_group[np.argsort(size[of_group] if falls else -size[of_group])]
            for name in ["nose", "tail", "com", "shed_circulation"]:
                values = study[name][order, f].reshape(order.size, -1)
                error = np.linalg.norm(values - values[-1], axis=1)[:-1]
                label = {"com": "centre of mass [m]", "shed_circulation": "shed circulation [m2 s-1]"}.get(name)
                axes.loglog(size[order][:-1], error, label=label or f"{name} [m]", **style(i))
                errors.append((size[order][:-1], error))
                i += 1
        x, y = errors[1] if len(errors) > 1 else errors[0]
        if x.size > 1:
            left, low = min(x), np.min(y) / 6
            for k, slope in enumerate([1, 2]):
                sign = -slope if falls else slope
                slope_triangle(axes, left * 3**k, low * (2.0**slope if falls else 1), sign)
        axes.set_xlabel(study.label(refined.name))
        if len(names) > 1:
            axes.set_title(names[f], size=9)
        axes.grid(which="major", lw=0.3, color="#cccccc")
    all_axes[0].set_ylabel("difference from the finest level")
    all_axes[0].legend()


def plot_methods(study, over, figure):
    """Wall time and evaluations against a key, a line per method."""
    method, x = study["solver_method"], study[over]
    panels = figure.subplots(1, 2)
    for axes, (name, label) in zip(
        panels, [("wall_time", "wall time [s]"), ("residual_evaluations", "evaluations of the equations")]
    ):
        for i, word in enumerate(dict.fromkeys(method)):
            rows = (method == word) & study.complete
            axes.loglog(x[rows], study[name][rows], label={"ida": "implicit (ida)"}.get(word, word), **style(i))
        y = study[name][(method != "ida") & study.complete]
        if y.size:
            right = x.max() / 30
            low = np.median(y)
            axes.plot([right / 30, right], [low / 2, low / 2 * 30**0.5], color="#666666", lw=0.8)
            axes.annotate("slope 1/2", (right, low / 2 * 30**0.5), (2, -4), textcoords="offset points", va="top", size=8)
        axes.set_xlabel(study.label(over))
        axes.set_ylabel(label)
        axes.grid(which="major", lw=0.3, color="#cccccc")
    panels[0].legend()


def annotate_values(axes, x, y, values):
    """A number at each place."""
    for at_x, at_y, value in zip(x, y, values):
        axes.annotate(f"{value:.5g}", (at_x, at_y), (0, 7), textcoords="offset points", ha="center", size=7)


def plot_map(study, x, y, labels, quantity, figure):
    """One panel per fish: a mark per member, as dark as its value, and the value."""
    names = list(study["fish_name"])
    all_axes = figure.subplots(1, len(names), squeeze=False, sharey=True)[0]
    for f, axes in enumerate(all_axes):
        values = study[quantity][:, f]
        marks = axes.scatter(x, y, c=values, cmap="Greys", edgecolors="black", s=50, lw=0.7)
        annotate_values(axes, x, y, values)
        axes.margins(0.2)
        axes.set_xlabel(labels[0])
        if len(names) > 1:
            axes.set_title(names[f], size=9)
        figure.colorbar(marks, ax=axes, label=study.label(quantity))
    all_axes[0].set_ylabel(labels[1])


def plot_lines(study, figure):
    """Speed, cost of transport and Strouhal number over the first axis; a line per fish and per value of the rest."""
    first = study.axes[0][0]
    x = study[first.name] if study.is_number(first.name) else np.arange(study.complete.size)
    rest = [[str(study[v.name][m]) for axis in study.axes[1:] for v in axis] for m in range(x.size)]
    names = list(study["fish_name"])
    stack = figure.subplots(3, 1, sharex=True)
    for axes, quantity in zip(stack, ["speed", "cost_of_transport", "strouhal"]):
        i = 0
        for words in dict.fromkeys(map(tuple, rest)):
            rows = np.array([tuple(r) == words for r in rest]) & study.complete
            for f, name in enumerate(names):
                label = ", ".join([*words, *([name] if len(names) > 1 else [])])
                axes.plot(x[rows], study[quantity][rows, f], label=label or None, **style(i))
                i += 1
        axes.set_ylabel(study.label(quantity).replace(" [", "\n["))
        axes.grid(lw=0.3, color="#cccccc")
    stack[-1].set_xlabel(study.label(first.name))
    if i > 1:
        stack[0].legend(loc="lower left", bbox_to_anchor=(0, 1), ncol=2)


def plot_comparison(study, figure):
    """Work and precision: the error of the tail against wall time and evaluations, a line per method."""
    method = study["method"]
    for axes, name in zip(figure.subplots(1, 2, sharey=True), ["wall_time", "evaluations"]):
        for i, word in enumerate(dict.fromkeys(method)):
            rows = (method == word) & study.complete
            axes.loglog(study[name][rows], study["tail_error"][rows], label=word, **style(i))
        axes.set_xlabel({"wall_time": "wall time [s]"}.get(name, "evaluations of the equations"))
        axes.grid(which="major", lw=0.3, color="#cccccc")
        if name == "wall_time":
            axes.set_ylabel("error of the tail [body lengths]")
            axes.legend(loc="lower left", bbox_to_anchor=(0, 1), ncol=6)


def draw(path, figure):
    """Draw what a file calls for on an empty figure."""
    study = Study(path)
    if study.is_comparison:
        return plot_comparison(study, figure)
    if not study.axes:
        raise FileError(f"{path}: a study without a sweep has nothing to draw")
    if not study.complete.any():
        raise FileError(f"{path}: no member of the study is complete")
    keys = [v for axis in study.axes for v in axis]
    refined = [v for v in keys if hasattr(v, "refine")]
    if refined:
        return plot_convergence(study, refined[0], figure)
    numbers = [v.name for v in keys if study.is_number(v.name)]
    if "solver_method" in study.data.variables and study.is_number(keys[0].name):
        return plot_methods(study, keys[0].name, figure)
    if len(study.axes) == 1 and keys[0].name.endswith("position"):
        x, y = np.array([ast.literal_eval(text) for text in study[keys[0].name]]).T
        return plot_map(study, x, y, ["x of the nose at the start [m]", "y of the nose [m]"], "speed", figure)
    if len(study.axes) == 2 and len(numbers) == len(keys) == 2:
        labels = [study.label(name) for name in numbers]
        return plot_map(study, study[numbers[0]], study[numbers[1]], labels, "speed", figure)
    return plot_lines(study, figure)

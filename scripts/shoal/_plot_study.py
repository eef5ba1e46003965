"""Pictures of studies: study.nc of `shoal study`, and the file of `shoal compare`, which is one. Used by shoal.plot.

    the errors of a case            what each key has in them, and the values at its levels
    the sensitivities of a case     a bar for each number of the case
    errors along a sweep            values with error bars over the first swept number, and the errors in per cent
    a refined axis                  the error of each level by Richardson with the next finer one, over the grid spacing, with a
                                    triangle of the design slope and the orders that are accepted; with another axis of three
                                    numbers or more values with error bars over that, and the errors in per cent
    solver.method as an axis        cost against the first axis, a line per method; where there are several settings of a
                                    method the cheapest that is accurate, also as a table
    a position as the only axis     a map of the places; lines where the places are in a row
    two axes of numbers             a map over both: cells with their values, contours where there are many
    anything else                   speed, cost of transport and Strouhal number over the first axis; of fish that are held
                                    thrust, power and efficiency; of bodies that a heave drives the efficiency in place of the
                                    Strouhal number; of bodies without a beat drag, lift and deflection; with
                                    relative_to the same over the reference beside it
    a branch of steady states       speed, and the places behind the first fish, and the largest multiplier over the key: solid
                                    where stable, dashed where unstable, dotted where undecided, with folds and losses of
                                    stability
    a comparison of methods         error against wall time and evaluations
"""

import ast
import csv
import os

from ._plot_style import (
    DASHES, GRID, MARKS, add_legend, calm, colour_bar, few_ticks, matplotlib, number_text, scale_of, unit_text, with_unit,
)
from ._files import FileError, Results, netCDF4, np
from ._library import CaseError, netcdf_path

COLOURS = ["#000000", "#0072b2", "#d55e00", "#009e73", "#aa4499", "#b06000", "#3366aa", "#666666"]  # all dark
NAMES = {
    "modulus": "Young's modulus",
    "rtol": "relative tolerance",
    "com": "centre of mass",
    "strouhal": "Strouhal number",
    "depth": "depth / body length",
}


# Quantities of the school in lines over a key: where the stability changes, and the error.
STABILITY = {"steady_multiplier": (1, "steady_multiplier_error"), "steady_growth": (0, None)}

# What a comparison of methods sets: its one axis, first the reference and how good that is, then each round of repeats.
COMPARISON = ["solver_method", "solver_order", "solver_rtol", "solver_step"]
N_REFERENCES = 2


class Study:
    """A study.nc, with its axes."""

    def __init__(self, path):
        self.path = path
        try:
            self.data = netCDF4.Dataset(netcdf_path(path))
        except FileError:
            raise
        except OSError as error:
            raise FileError(f"{path}: cannot be read ({error.strerror or error})") from error
        if not hasattr(self.data, "shoal_study"):
            raise FileError(f"{path}: not the file of a study or of a comparison")
        keys = [v for v in self.data.variables.values() if hasattr(v, "axis")]
        self.axes = [[v for v in keys if v.axis == a] for a in sorted({v.axis for v in keys})]
        self.is_comparison = [[v.name for v in axis] for axis in self.axes] == [COMPARISON]
        self.complete = self["status"] == "complete"

    def __getitem__(self, name):
        return np.ma.filled(self.data.variables[name][:], np.nan) if self.is_number(name) else self.data[name][:]

    def is_number(self, name):
        return self.data.variables[name].dtype.kind in "fi"

    def label(self, name):
        """The last word of a key or the name of a quantity, with its unit."""
        variable = self.data.variables[name if name in self.data.variables else f"stated_{name}"]
        word = variable.long_name.split(".")[-1] if hasattr(variable, "axis") else name
        kind, _, rest = word.partition("_")
        word = rest if kind in ("ratio", "change") else word
        of = word.removeprefix("steady_")
        word = ("steady " if of != word else "") + NAMES.get(of, of.replace("_", " "))
        word += "\nover the other" if kind == "ratio" else ""
        return with_unit(("change of " if kind == "change" else "") + word, getattr(variable, "units", "1"))


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


def legend_above(axes, n_columns, side="left"):
    """A legend above a panel of the lines with a label, if there are any."""
    handles, _ = axes.get_legend_handles_labels()
    if handles:
        add_legend(axes, handles, 14 if axes.get_title() else 0, min(n_columns, len(handles)), side)


def case_of(study, member, refined):
    """What the axes that are not refined set in a member, as text."""
    others = [v for axis in study.axes for v in axis if v.axis != refined.axis]
    texts = [f"{study[v.name][member]:g}" if study.is_number(v.name) else study[v.name][member] for v in others]
    return ", ".join(f"{v.long_name.split('.')[-1]} {text}" for v, text in zip(others, texts))


LEAST_PART, MOST_ABOVE = 0.5, 0.5  # accepted orders, over and above the design order: src/study/convergence.c


def draw_design(axes, size, drawn, design):
    """The orders that are accepted, as slopes from the coarsest level, and a triangle of the design order below all lines.

    size: grid spacing of the levels that are drawn, falling; drawn: the lines, (line, level), 1 at the first.
    """
    if not np.isfinite(design) or size.size < 2:
        return
    low, high = LEAST_PART * design, design + MOST_ABOVE
    ends = size[[0, -1]]
    words = f"accepted orders, {low:g} to {high:g}"
    axes.fill_between(ends, (ends / size[0]) ** low, (ends / size[0]) ** high, color="#e8e8e8", zorder=0, label=words)

    # the triangle: from 0.45 to 0.9 of the way to the coarsest level, with the legs 1 and the order
    left, right = size[-1] * (size[0] / size[-1]) ** np.array([0.45, 0.9])
    lines = np.array([np.interp(np.log([left, right]), np.log(size[::-1]), np.log(line[::-1])) for line in drawn])
    lowest = np.minimum(np.exp(np.nanmin(lines, axis=0)), (np.array([left, right]) / size[0]) ** high)
    rise = (right / left) ** design
    foot = 0.7 * min(lowest[0], lowest[1] / rise)
    axes.fill([left, right, right], [foot, foot, foot * rise], fc="white", ec="black", lw=0.8, label="_triangle")
    place = {"textcoords": "offset points", "size": 8}
    axes.annotate("1", (np.sqrt(left * right), foot), (0, -2), ha="center", va="top", **place)
    axes.annotate(f"order {design:g}", (right, foot * np.sqrt(rise)), (3, 0), va="center", **place)
    axes.set_ylim(min(foot / 2, np.nanmin(drawn) / 1.3), None)


def quantities_of(study):
    """What is drawn of a refinement: positions, speed and cost of a run; speed and costs of steady states."""
    names = ["nose", "tail", "com", "shed_circulation", "speed", "cost_of_transport"]
    if f"error_{names[0]}" not in study.data.variables:
        names = ["steady_speed", "steady_cost_of_transport", "steady_strouhal", "steady_drag", "steady_lift"]
    return [name for name in names if np.isfinite(study[f"error_{name}"]).any()]


def level_errors(study, name, design):
    """The error of each level but the finest (group, fish, level): the difference from the next finer level over 1 - r^p, with
    the ratio r of their grid spacings and the design order p; where a reference is given, the distance from it."""
    known = study[f"difference_{name}"]
    if np.isfinite(known[..., -1]).any():
        return known
    size, first = study["level_size"], study["group_member"]
    keys = [v.name for axis in study.axes for v in axis]
    refined = [v.name for axis in study.axes for v in axis if hasattr(v, "refine")]
    others = [key for key in keys if study.data[key].axis != study.data[refined[0]].axis]
    settings = [tuple(str(study[key][m]) for key in others) for m in range(study.complete.size)]
    values = study[name]
    errors = np.full(known.shape, np.nan)
    for g, member in enumerate(first):
        at = [
            next((m for m in range(study.complete.size) if settings[m] == settings[member] and study[refined[0]][m] == value), None)
            for value in study["level_value"]
        ]
        for k in range(len(at) - 1):
            if at[k] is None or at[k + 1] is None or not study.complete[[at[k], at[k + 1]]].all():
                continue
            apart = values[at[k]] - values[at[k + 1]]
            apart = np.hypot(*apart.T) if apart.ndim == 2 else np.abs(apart)
            share = 1 - (size[k + 1] / size[k]) ** design if np.isfinite(design) else 1
            errors[g, :, k] = apart / share
    return errors


def plot_convergence(study, refined, figure, asked=None):
    """The errors of the levels of some quantities, or of the one that is asked for, over that of the coarsest one; one panel
    per fish."""
    level, size, first = study["level_value"], study["level_size"], study["group_member"]
    design = float(study["group_design_order"][0])
    names = list(study["fish"])
    all_axes = figure.subplots(1, len(names), squeeze=False, sharey=True)[0]
    errors = {name: level_errors(study, name, design) for name in ([asked] if asked else quantities_of(study))}
    known = np.concatenate([np.zeros(0), *(e[np.isfinite(e) & (e > 0)] for e in errors.values())])
    if known.size == 0:
        raise FileError(f"{study.path}: no errors to draw: all levels are equal, or too few are complete")
    # the finest level has an error only where a reference is given
    is_known = np.any([np.isfinite(e).any(axis=(0, 1)) for e in errors.values()], axis=0)
    drawn = size[is_known]
    for f, axes in enumerate(all_axes):
        lines = []
        for g, member in enumerate(first):
            for name, error in errors.items():
                line, bound = error[g, f, is_known], study[f"error_{name}"][g, f]
                if not line[0] > 0:
                    continue
                flag = "flagged" if str(study.data[f"objection_{name}"][g, f]).strip("\0") else ""
                unit = study.data.variables[f"error_{name}"].units
                words = [study.label(name).split(" [")[0], case_of(study, member, refined)]
                words += [f"error {number_text(bound)} {unit_text(unit) if unit != '1' else ''}".strip(), flag]
                axes.loglog(drawn, line / line[0], label=", ".join(filter(None, words)), **style(len(lines)))
                lines.append(np.where(line > 0, line / line[0], np.nan))
        if lines:
            draw_design(axes, drawn, np.array(lines), design)
        axes.set_xlabel(study.label(refined.name))
        axes.set_xticks(drawn, [f"{x:g}" for x in level[is_known]])
        if level[0] < level[-1]:  # numbers of points rise from left to right
            axes.invert_xaxis()
        axes.minorticks_off()
        few_ticks(axes.yaxis)
        if len(names) > 1:
            axes.set_title(names[f], size=9)
        axes.grid(lw=0.3, color=GRID)
    all_axes[0].set_ylabel("error of the level,\nover that of the coarsest")
    legend_above(all_axes[0], 2)


def draw_bars(study, parameter, figure, quantities, lines_of):
    """Values with their errors over a parameter, and on the right the errors in per cent, since most bars are shorter than a
    mark. lines_of(quantity): for each line the label, the values of the parameter, value, bar, the places of flags, and the
    lowest and highest values of other models, NaN where none was run."""
    figure.set_figheight(1.4 + 1.4 * len(quantities))
    stack = figure.subplots(len(quantities), 2, sharex=True, squeeze=False, width_ratios=[3, 2])
    for (axes, right), quantity in zip(stack, quantities):
        lines = lines_of(quantity)
        for i, (label, at, value, bar, doubtful, low, high) in enumerate(lines):
            line = style(i)
            draw_models(axes, at, low, high, line["color"], with_label=i == 0)
            axes.errorbar(at, value, bar, label=label or None, capsize=3, elinewidth=0.8, **line)
            percent = 100 * bar / np.abs(value)
            right.plot(at, percent, **line)
            # a ring where the levels state no order, so that the bar is a largest difference
            for panel, y in ((axes, value), (right, percent)):
                panel.plot(at[doubtful], y[doubtful], ls="", marker="o", ms=9, mfc="none", color=line["color"], mew=0.8)
        axes.set_ylabel(study.label(quantity).replace(" [", "\n["))
        right.set_ylabel("error [%]")
        right.set_ylim(0, 1.1 * right.dataLim.y1)
        for panel in (axes, right):
            panel.grid(lw=0.3, color=GRID)
    stack[-1, 0].set_xscale(scale_of(study[parameter.name]))
    for panel in stack[-1]:
        panel.set_xlabel(study.label(parameter.name))
    if any(len(doubtful) for *_, doubtful, _, _ in lines):
        stack[0, 0].plot([], [], ls="", marker="o", ms=9, mfc="none", color="black", mew=0.8, label="flagged error")
    legend_above(stack[0, 0], 2)


def draw_models(axes, at, low, high, colour, with_label):
    """The range of other models: a band where they were run at every point, else a bar at each point with them."""
    known = np.isfinite(low) & np.isfinite(high)
    words = "other models" if known.all() else f"other models, run at {known.sum()} of {known.size} points"
    label = words if with_label and known.any() else None
    if known.all() and known.size > 1:
        axes.fill_between(at, low, high, color=colour, alpha=0.15, lw=0, zorder=0, label=label)
    elif known.any():
        axes.vlines(at[known], low[known], high[known], color=colour, alpha=0.25, lw=5, zorder=0, label=label)


def plot_values(study, refined, parameter, figure, asked=None):
    """Values of the finest level, or of the quantity that is asked for, with their errors over a parameter; a line per fish
    and per value of the rest."""
    first, x = study["group_member"], study[parameter.name]
    finest = study[refined.name] == study["level_value"][-1]
    others = [v.name for axis in study.axes for v in axis if v.axis != refined.axis]
    settings = [tuple(str(study[name][m]) for name in others) for m in range(x.size)]
    steady = ["steady_speed", "steady_cost_of_transport", "steady_strouhal", "steady_drag", "steady_lift", "steady_deflection"]
    run = ["speed", "cost_of_transport", "mean_actuation_power"]
    known = [asked] if asked else steady if f"error_{steady[0]}" in study.data.variables else run
    known = [q for q in known if np.isfinite(study[f"error_{q}"]).any()][:3]
    if not known:
        raise FileError(f"{study.path}: no errors to draw: too few levels are complete")
    members = [next(m for m in np.flatnonzero(finest) if settings[m] == settings[g]) for g in first]
    words = [", ".join(f"{n} {study[n][m]}" for n in others if n != parameter.name) for m in members]
    names = list(study["fish"])

    def lines_of(quantity):
        flagged, lines = study.data[f"objection_{quantity}"][:], []
        for word in dict.fromkeys(words):
            for f, name in enumerate(names):
                rows = sorted((g for g in range(first.size) if words[g] == word), key=lambda g: x[members[g]])
                of = [members[g] for g in rows]
                doubtful = [k for k, g in enumerate(rows) if str(flagged[g][f]).strip("\0")]
                label = ", ".join(filter(None, [word, name if len(names) > 1 else ""]))
                none = np.full(len(of), np.nan)  # a refined axis has no other models
                lines.append((label, x[of], study[quantity][of, f], study[f"error_{quantity}"][rows, f], doubtful, none, none))
        return lines

    draw_bars(study, parameter, figure, known, lines_of)


def plot_points(study, figure, asked=None):
    """The stated values of a sweep with errors over the first swept number; a line per fish and per value of the rest."""
    swept = [v for axis in study.axes for v in axis if hasattr(v, "swept")]
    numbers = [v for v in swept if study.is_number(v.name) and np.unique(study[v.name]).size > 1]
    if not numbers:
        raise FileError(f"{study.path}: no swept key has several numbers: there is nothing to draw errors over")
    parameter, members = numbers[0], study["point_member"].astype(int)
    x, names = study[parameter.name][members], list(study["fish"])
    words = [", ".join(f"{v.long_name.split('.')[-1]} {study[v.name][m]}" for v in swept if v is not parameter) for m in members]
    known = [name[len("bar_") :] for name in study.data.variables if name.startswith("bar_") and "_change_" not in name]
    if asked and asked not in known:
        raise FileError(f"{study.path}: no error of {asked}: the file has those of {', '.join(known)}")
    known = [q for q in ([asked] if asked else known) if np.isfinite(study[f"bar_{q}"]).any()]
    if not known:
        raise FileError(f"{study.path}: no errors to draw: too few levels are complete")

    def lines_of(quantity):
        value, bar, part, low, high = (study[f"{kind}_{quantity}"] for kind in ("stated", "bar", "part", "lowest", "highest"))
        flags, lines = study.data[f"key_flag_{quantity}"][:], []
        for word in dict.fromkeys(words):
            for f, name in enumerate(names):
                if f > 0 and not np.isfinite(bar[:, f]).any():
                    continue
                rows = sorted((p for p in range(x.size) if words[p] == word), key=lambda p: x[p])
                doubtful = [
                    i for i, p in enumerate(rows)
                    if any(str(flags[p][k][f]).strip("\0") and part[p, k, f] > 0.1 * bar[p, f] for k in range(part.shape[1]))
                ]
                label = ", ".join(filter(None, [word, name if len(names) > 1 else ""]))
                lines.append((label, x[rows], value[rows, f], bar[rows, f], doubtful, low[rows, f], high[rows, f]))
        return lines

    draw_bars(study, parameter, figure, known, lines_of)


def plot_budget(study, figure):
    """The errors of a case, a row per quantity, and per ratio to another case: the value with its error and the range of other models; the part of each key
    in the error; and what the levels of each key differ by."""
    asked = [name[len("bar_") :] for name in study.data.variables if name.startswith("bar_") and "_change_" not in name]
    keys = [k for k in range(study["key_levels"].size) if not study["key_is_choice"][k] and study["key_levels"][k] > 1]
    names = [str(study.data["key_name"][k]).strip("\0").split(".")[-1].replace("_", " ") for k in keys]
    fish = 0  # the others look alike, and are in error.csv
    figure.set_figheight(0.6 + 4 * len(asked))
    grid = figure.add_gridspec(2 * len(asked), 2, width_ratios=[1, 3])
    for row, quantity in enumerate(asked):
        left, middle = (figure.add_subplot(grid[2 * row, column]) for column in range(2))
        right = figure.add_subplot(grid[2 * row + 1, :])
        value, bar = study[f"stated_{quantity}"][fish], study[f"bar_{quantity}"][fish]
        if not np.isfinite(bar):
            raise FileError(f"{study.path}: the error of {quantity} is unknown")
        draw_range(left, value, bar, study[f"lowest_{quantity}"][fish], study[f"highest_{quantity}"][fish])
        left.set_ylabel(study.label(quantity).replace(" [", "\n["))
        part = 100 / abs(value) * study[f"part_{quantity}"][keys, fish]
        is_flagged = [bool(str(study.data[f"key_flag_{quantity}"][k, fish]).strip("\0")) for k in keys]
        for i in range(len(keys)):
            middle.barh(-i, part[i], color=COLOURS[(i + 1) % 8], hatch="//" if is_flagged[i] else None, edgecolor="white", lw=0)
        middle.set_yticks(-np.arange(len(keys)), names, size=7)
        middle.set_xlim(0, None)
        middle.xaxis.set_major_locator(matplotlib.ticker.MaxNLocator(5))
        middle.set_xlabel("part of the error [% of the value]" + (", hatched: flagged" if any(is_flagged) else ""))
        draw_levels(right, study, quantity, keys, part, fish)
        right.set_xlabel("levels of each key")
        legend_above(right, 3)


def plot_sensitivity(study, figure):
    """d ln Q/d ln p of each quantity by each input, with the errors, a panel per quantity: the inputs as those of the first
    fall in size."""
    asked = [name[len("stated_") :] for name in study.data.variables if name.startswith("stated_") and "_change_" not in name]
    inputs = np.flatnonzero((study["key_is_choice"] == 2) & (study["key_levels"] > 1))
    fish = 0  # the others are in error.csv
    size = np.abs(study[f"sensitivity_{asked[0]}"][inputs, fish])
    inputs = inputs[np.argsort(-np.nan_to_num(size))]
    names = [str(study.data["key_name"][k]).strip("\0").removeprefix("fish.") for k in inputs]
    figure.set_figheight(0.9 + 0.2 * len(inputs))
    panels = figure.subplots(1, len(asked), sharey=True, squeeze=False)[0]
    for axes, quantity in zip(panels, asked):
        value, error = (study[f"{kind}_{quantity}"][inputs, fish] for kind in ("sensitivity", "sensitivity_error"))
        colours = ["#0072b2" if one > 0 else "#d55e00" for one in value]
        axes.barh(-np.arange(len(inputs)), value, xerr=error, color=colours, error_kw={"lw": 0.8, "capsize": 2})
        axes.axvline(0, color="black", lw=0.8)
        axes.set_xlabel(f"change of {study.label(quantity).split(' [')[0]}\n[% for 1 %]")
        axes.grid(axis="x", lw=0.3, color=GRID)
    panels[0].set_yticks(-np.arange(len(inputs)), names, size=7)


def draw_range(axes, value, bar, low, high):
    """A value with its error, and beside it the range of other models."""
    axes.errorbar([0], [value], [bar], color="black", marker="o", ms=4.5, capsize=3, elinewidth=0.8)
    ticks, words = [0], ["error"]
    if np.isfinite([low, high]).all():
        axes.vlines([1], low, high, color="black", alpha=0.25, lw=7)
        ticks, words = [0, 1], ["error", "other\nmodels"]
    axes.set_xticks(ticks, words, size=7)
    axes.set_xlim(-0.6, len(ticks) - 0.4)
    axes.ticklabel_format(axis="y", useOffset=False)
    axes.grid(axis="y", lw=0.3, color=GRID)


def draw_levels(axes, study, quantity, keys, part, fish):
    """What each level of each key differs by from the finest one, and the error of the level: that and the error of the
    finest. Marks on a logarithmic axis, one group per key; part: of the keys, in per cent of the stated value."""
    percent = 100 / abs(study[f"stated_{quantity}"][fish])
    ticks, drawn, at = [], [], 0.0
    for i, k in enumerate(keys):
        n, stated = int(study["key_levels"][k]), int(study["key_stated"][k])
        values = study[f"level_{quantity}"][k, :n, fish]
        differences = np.abs(values - values[0]) * percent
        errors = differences + max(part[i] - differences[stated], 0)
        differences, errors = (np.where(some > 0, some, np.nan) for some in (differences, errors))  # the axis has no 0
        x, colour = at + np.arange(n)[::-1], COLOURS[(i + 1) % 8]
        axes.plot(x[1:], differences[1:], ls="", marker="_", ms=9, mew=2, color=colour, label="difference from the finest level" if i == 0 else None)
        axes.plot(x, errors, ls="-", lw=0.6, marker="o", ms=4.5, mfc="white", color=colour, label="error of the level" if i == 0 else None)
        axes.plot(x[stated], errors[stated], ls="", marker="s", ms=10, mfc="none", mec="black", mew=0.8,
                  label="stated value" if i == 0 else None)
        ticks += zip(x, (f"{study['key_value'][k, level]:.3g}" for level in range(n)))
        drawn += [*differences[1:], *errors]
        if i > 0:
            axes.axvline(at - 0.9, color=GRID, lw=0.6)
        at += n + 0.8
    axes.set_xticks([x for x, _ in ticks], [text for _, text in ticks], rotation=60, size=7)
    known = [y for y in drawn if np.isfinite(y)]
    if known:
        axes.set_yscale("log")
        axes.set_ylim(max(min(known), max(known) * 1e-5) / 2, max(known) * 2)
    axes.set_ylabel("[% of the value]")
    axes.grid(axis="y", lw=0.3, color=GRID)


ACCURATE, SAME_WORK = 1e-4, 1e-3  # errors at which methods are compared: of nose and tail [m], and relative of the work


def reference_errors(study, x):
    """How far nose or tail [m], and the work of the muscle, relative, are from those of the most accurate implicit member with
    the same x. Both (member); the reference has infinite errors."""
    places, works = np.full(x.size, np.nan), np.zeros(x.size)
    rtol = np.where((study["solver_method"] == "ida") & study.complete, study["solver_rtol"], np.inf)
    work = np.asarray(study["actuation_work"])
    for value in np.unique(x):
        rows = np.flatnonzero(x == value)
        best = rows[np.argmin(rtol[rows])]
        for end in ("nose", "tail"):
            off = np.linalg.norm(study[end][rows] - study[end][best], axis=2).max(axis=1)
            places[rows] = np.fmax(places[rows], off)
        if (work[best] != 0).all():
            works[rows] = np.abs(work[rows] / work[best] - 1).max(axis=1)
        places[best] = np.inf  # the reference itself does not compete
    return places, works


def cheapest(study, over, errors):
    """Of each method, at each x, the accurate member with the fewest evaluations; printed as a table."""
    x, method, (places, works) = study[over], study["solver_method"], errors
    wall, evaluations = study["wall_time"], study["residual_evaluations"]
    accurate = np.flatnonzero(study.complete & (places <= ACCURATE) & (works <= SAME_WORK))
    chosen = []
    print(f"| {study.label(over)} | method | setting | error [m] | of the work | evaluations | wall time [s] |")
    print("|" + 7 * "--:|")
    for value in np.unique(x):
        for word in dict.fromkeys(method):
            rows = [m for m in accurate if x[m] == value and method[m] == word]
            if not rows:
                print(f"| {value:g} | {word} | none within {ACCURATE:g} m and {SAME_WORK:g} | | | | |")
                continue
            m = min(rows, key=lambda row: evaluations[row])
            step, rtol = study["solver_step"][m], study["solver_rtol"][m]
            setting = f"step {step:g}" if step > 0 else f"rtol {rtol:g}"
            print(f"| {value:g} | {word} | {setting} | {places[m]:.1e} | {works[m]:.1e} | {evaluations[m]:.0f} | {wall[m]:.2g} |")
            chosen.append(m)
    return np.isin(np.arange(x.size), chosen)


def plot_methods(study, over, figure):
    """Wall time and evaluations against a key, a line per method."""
    method, x = study["solver_method"], study[over]
    shown = study.complete
    if "solver_step" in study.data.variables:
        shown = cheapest(study, over, reference_errors(study, x))
    panels = figure.subplots(1, 2)
    for axes, (name, label) in zip(
        panels, [("wall_time", "wall time [s]"), ("residual_evaluations", "evaluations of the equations")]
    ):
        for i, word in enumerate(dict.fromkeys(method)):
            rows = (method == word) & shown
            if not rows.any():
                continue
            axes.loglog(x[rows], study[name][rows], label={"ida": "implicit (ida)", "imex": "splitting (imex)"}.get(word, word), **style(i))
        axes.set_xlabel(study.label(over))
        axes.set_ylabel(label)
        few_ticks(axes.yaxis)
        axes.grid(which="major", lw=0.3, color=GRID)
    legend_above(panels[0], 5)


def digits_for(values):
    """How many digits after the point distinguish the values."""
    spread = np.ptp(values)
    return int(np.clip(2 - np.floor(np.log10(spread)), 0, 12)) if spread > 0 else 4


CONTOURS = 6  # so many values on both axes of a map are drawn as contours, fewer as cells
SPECIAL = 0.98  # part of the places of a map that its colours tell apart
SAME = 1e-6  # relative range of values of members that is noise of the solver


def edges_between(at, scale):
    """Edges of cells around values, halfway between them on the scale of the axis."""
    at = np.log(at) if scale == "log" else np.asarray(at, float)
    middle = (at[1:] + at[:-1]) / 2
    edges = np.concatenate([[at[0] - (middle[0] - at[0])], middle, [at[-1] + (at[-1] - middle[-1])]]) if at.size > 1 else (
        np.array([at[0] - 0.5, at[0] + 0.5]))
    return np.exp(edges) if scale == "log" else edges


def grid_of(x, y):
    """The values of both axes, and the row and column of each member, where members fill a grid for the most part."""
    (xs, i), (ys, j) = np.unique(x, return_inverse=True), np.unique(y, return_inverse=True)
    fits = xs.size > 1 and ys.size > 1 and 2 * x.size > xs.size * ys.size
    return (xs, ys, i, j) if fits else None


def draw_cells(axes, grid, values, digits, norm, scales):
    """A cell per member with its value; cells without a member are hatched."""
    xs, ys, i, j = grid
    table = np.full((ys.size, xs.size), np.nan)
    table[j, i] = values
    edges = edges_between(xs, scales[0]), edges_between(ys, scales[1])
    if np.isnan(table).any():
        whole = {"transform": axes.transAxes, "fc": "#eeeeee", "ec": "#bbbbbb", "hatch": "////", "lw": 0, "zorder": 0}
        axes.add_artist(matplotlib.patches.Rectangle((0, 0), 1, 1, **whole))
    mesh = axes.pcolormesh(*edges, np.ma.masked_invalid(table), cmap="cividis", norm=norm, edgecolors="white", lw=0.5)
    if table.size <= 80:
        for row, column in np.argwhere(np.isfinite(table)):
            value = table[row, column]
            colour = "white" if norm(value) < 0.55 else "black"
            size = 7 if xs.size < 8 else 5.5
            axes.annotate(f"{value:.{digits}f}", (xs[column], ys[row]), ha="center", va="center", size=size, color=colour)
    axes.set(xlim=edges[0][[0, -1]], ylim=edges[1][[0, -1]])
    axes.set_xticks(xs if xs.size <= 9 else xs[:: -(-xs.size // 9)])
    axes.set_yticks(ys if ys.size <= 12 else ys[:: -(-ys.size // 12)])
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter("{x:g}")
        axis.set_minor_locator(matplotlib.ticker.NullLocator())
    axes.tick_params(length=0)  # beside the number of a cell a tick looks like a sign
    return mesh


def draw_contours(axes, x, y, values, digits, norm):
    """Filled contours through the members, whose places are marked, and the value at each line."""
    levels = matplotlib.ticker.MaxNLocator(9).tick_values(norm.vmin, norm.vmax)
    drawn = axes.tricontourf(x, y, values, levels, cmap="cividis", norm=norm, extend="both")
    colours = ["white" if norm(level) < 0.55 else "black" for level in levels]
    lines = axes.tricontour(x, y, values, levels, colors=colours, linewidths=0.6)
    axes.clabel(lines, fmt=lambda value: f"{value:.{max(digits - 1, 0)}f}", fontsize=7)
    axes.plot(x, y, ls="", marker=".", ms=2, color="black")
    return drawn


def plot_map(study, x, y, labels, quantity, figure):
    """One panel per fish: cells with their values, or contours through many places."""
    names = list(study["fish"])
    x, y = x[study.complete], y[study.complete]
    values = study[quantity][study.complete]
    known = values[np.isfinite(values)]
    if known.size == 0:
        raise FileError(f"{study.path}: {quantity} has no value in any member: are the runs shorter than a beat?")
    all_axes = figure.subplots(1, len(names), squeeze=False, sharex=True, sharey=True)[0]
    scales, grid = (scale_of(x), scale_of(y)), grid_of(x, y)
    is_fine = grid is None or min(grid[0].size, grid[1].size) >= CONTOURS and x.size == grid[0].size * grid[1].size
    # the same scale for all fish
    digits, norm = digits_for(known), matplotlib.colors.Normalize(known.min(), known.max())
    is_same = np.ptp(known) <= SAME * np.abs(known).max()
    if is_same:  # colours would show the noise
        digits, norm = 6, matplotlib.colors.Normalize(known.min() - 1, known.max() + 1)
    for f, axes in enumerate(all_axes):
        axes.set(xscale=scales[0], yscale=scales[1])
        here = np.isfinite(values[:, f])
        if is_fine and not is_same:
            drawn = draw_contours(axes, x[here], y[here], values[here, f], digits, norm)
        elif grid:
            drawn = draw_cells(axes, grid, values[:, f], digits, norm, scales)
        else:
            drawn = axes.scatter(x, y, c=values[:, f], norm=norm, cmap="cividis", s=20)
        if len(names) > 1:
            axes.set_title(names[f], size=9)
    figure.supxlabel(labels[0], size=9)
    all_axes[0].set_ylabel(labels[1])
    if is_same:
        all_axes[0].annotate(f"{quantity.replace('_', ' ')} is constant: {known.mean():.6g}", (0, 1), (0, 14), size=8,
                             xycoords="axes fraction", textcoords="offset points")
        return
    colour_bar(figure, matplotlib.cm.ScalarMappable(norm, "cividis"), all_axes, study.label(quantity))


def plot_relative(study, x, y, labels, quantity, figure):
    """A panel per fish but the first: the quantity over that of the first fish in per cent; gains are blue, losses red, and
    a line shows where there is neither."""
    names, values = list(study["fish"]), study[quantity][study.complete]
    if len(names) < 2:
        raise CaseError("--relative: compares with the first fish, and there is one fish")
    x, y = x[study.complete], y[study.complete]
    values = 100 * (values / values[:, :1] - 1)
    known = np.abs(values[:, 1:][np.isfinite(values[:, 1:])])
    most = np.quantile(known, SPECIAL)  # one extreme place would make all others pale
    grid = grid_of(x, y)
    colours = "RdBu_r" if any(word in quantity for word in ("cost", "power")) else "RdBu"
    norm = matplotlib.colors.Normalize(-most, most)
    all_axes = figure.subplots(len(names) - 1, 1, squeeze=False, sharex=True, sharey=True)[:, 0]
    for f, axes in enumerate(all_axes, start=1):
        here, levels = np.isfinite(values[:, f]), np.linspace(-most, most, 22)
        if grid:  # places that are left out stay white
            table = np.ma.masked_all((grid[1].size, grid[0].size))
            table[grid[3][here], grid[2][here]] = values[here, f]
            axes.contourf(grid[0], grid[1], table, levels, cmap=colours, norm=norm, extend="both")
            axes.contour(grid[0], grid[1], table, [0], colors="black", linewidths=1)
        else:
            axes.tricontourf(x[here], y[here], values[here, f], levels, cmap=colours, norm=norm, extend="both")
            axes.tricontour(x[here], y[here], values[here, f], [0], colors="black", linewidths=1)
        axes.plot(x, y, ls="", marker=".", ms=1.5, color="black")
        axes.set(aspect="equal", ylabel=labels[1], title=names[f])
    all_axes[-1].set_xlabel(labels[0])
    words = study.label(quantity).split(" [")[0]
    colour_bar(figure, matplotlib.cm.ScalarMappable(norm, colours), all_axes, f"{words}\nover {names[0]} [%]")


def mark_states(figure, names, paths):
    """The places of the fish in results of `shoal steady` (steady.formation) on a map over places with a panel per fish but the
    first: filled marks for stable states, open ones for those that are unstable or undecided."""
    panels = {axes.get_title(): axes for axes in figure.axes}
    for path in paths:
        state = Results(path)
        place = state["steady_place"] if "steady_place" in state.data.variables else np.full((1, 2), np.nan)
        if len(place) < 2 or not np.isfinite(place).all():
            raise FileError(f"{path}: no formation in it: `shoal steady` with steady.formation finds one")
        way = state["com"][-1, 0] - state["com"][0, 0]
        ahead = (way[0] + 1j * way[1]) / np.hypot(*way)
        is_known = "steady_multiplier" in state.data.variables and len(state["steady_multiplier"]) > 0
        is_stable = is_known and np.hypot(*state["steady_multiplier"][0]) + state["steady_multiplier_error"][0] < 1
        for name, (x, y) in list(zip(state.names, place))[1:]:
            if name not in names:
                raise CaseError(f"{path}: {name} is not a fish of the study")
            at = (x + 1j * y) * ahead
            panels[name].plot(at.real, at.imag, ls="", marker="o", ms=6, mec="black", clip_on=False,
                              mfc="gold" if is_stable else "none")


def is_known(study, name):
    """True if all complete members have a value of this name."""
    return name in study.data.variables and np.isfinite(study[name][study.complete]).all()


def panels_of(study, first):
    """What is drawn over an axis: speed, cost and Strouhal number; of bodies that a heave drives the efficiency; of held ones the forces, power and efficiency; of bodies at rest what the stream does to them."""
    if is_known(study, "steady_drag"):
        return ["steady_drag", "steady_lift", "steady_deflection"]
    speed = study["speed"][study.complete]
    given = study[first.name][study.complete] if study.is_number(first.name) else np.full(speed.shape[0], np.nan)
    is_given = first.long_name.endswith(".speed") and np.allclose(speed, given[:, None], rtol=1e-3)
    is_driven = is_known(study, "mean_power") and is_known(study, "mean_actuation_power") and bool(np.all(
        np.abs(study["mean_actuation_power"][study.complete]) < 1e-6 * np.abs(study["mean_power"][study.complete])))
    # a free body finds another speed in every member, and has no mean thrust
    is_same = len(speed) > 1 and np.all(speed > 0) and np.all(np.ptp(speed, axis=0) <= 1e-3 * speed.max(axis=0))
    is_same = is_same and is_known(study, "mean_thrust") and bool(np.any(
        np.abs(study["mean_thrust"] * study["speed"])[study.complete] > 0.01 * np.abs(study["mean_power"][study.complete])))
    if is_given or is_driven and is_same:
        return ["mean_thrust", "mean_power", "efficiency"]
    return ["speed", "cost_of_transport", "efficiency" if is_driven and is_known(study, "efficiency") else "strouhal"]


def reference_of(path, key):
    """A table of other values over a key: their source, the values of the key, and the columns by quantity."""
    if not os.path.exists(path):
        raise FileError(f"{path}: no such file")
    with open(path, encoding="utf-8") as file:
        lines = file.read().splitlines()
    if not lines or not lines[0].startswith("#"):
        raise FileError(f"{path}: the first line has to be a comment with the source of the values: # linear theory")
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    try:
        columns = {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}
        return lines[0].lstrip("# "), columns.pop(key), columns
    except (IndexError, KeyError, TypeError, ValueError) as error:
        raise FileError(f"{path}: a table of numbers with a column {key} is needed") from error


def relative_words(study):
    """What the reference of the ratios has on the axis with `relative_to`: "modulus 1e+06"."""
    member, chosen = study["relative_member"].astype(int), None
    for axis in study.axes:
        values = study[axis[0].name]
        if (values[member] == values[member[0]]).all() and (chosen is None or not (values == values[member]).all()):
            chosen = axis[0]
    value = study[chosen.name][member[0]]
    return f"{chosen.long_name.split('.')[-1]} {value:g}" if study.is_number(chosen.name) else f"{chosen.long_name.split('.')[-1]} {value}"


def plot_lines(study, figure, asked=None, x=None, label=None, reference=None):
    """Three quantities, or the one that is asked for, over the first axis, or over x with a label; a line per fish and per
    value of the rest, and the values of a reference."""
    first = study.axes[0][0]
    is_number = x is not None or study.is_number(first.name)
    if x is None:
        x = study[first.name] if is_number else np.arange(study.complete.size)
    rest = [[case_of(study, m, first)] if study.axes[1:] else [] for m in range(x.size)]
    names = list(study["fish"])
    quantities = [asked] if asked else panels_of(study, first)
    source, other_x, others = reference_of(reference, first.long_name) if reference else (None, None, {})
    is_relative = "relative_member" in study.data.variables
    ratios = [f"ratio_{quantity}" for quantity in quantities] if is_relative and not (asked or "").startswith("ratio_") else []
    figure.set_figheight(1.2 + 1.2 * len(quantities))
    panels = figure.subplots(len(quantities), 2 if ratios else 1, sharex=True, squeeze=False)
    stack = panels[:, 0]
    for axes, quantity in zip(panels.T.ravel(), [*quantities, *ratios]):
        value, title = study[quantity], study.label(quantity)
        owners = [""] if value.ndim == 1 else names  # the school as a whole, or each fish
        value = value.reshape(x.size, -1)
        limit, error = STABILITY.get(quantity, (None, None))
        i = 0
        for words in dict.fromkeys(map(tuple, rest)):
            rows = np.flatnonzero(np.array([tuple(r) == words for r in rest]) & study.complete)
            rows = rows[np.argsort(x[rows], kind="stable")]
            for f, name in enumerate(owners):
                who = ", ".join([*words, *([name] if len(owners) > 1 else [])])
                axes.plot(x[rows], value[rows, f], label=who or ("this program" if reference else None), **style(i))
                if error:
                    axes.errorbar(x[rows], value[rows, f], study[error][rows], ls="", color=COLOURS[i % 8], capsize=3, elinewidth=0.8)
                i += 1
        if limit is not None:
            axes.axhline(limit, color="#888888", lw=0.8, zorder=1)
        if quantity in others:
            axes.plot(other_x, others[quantity], color="#888888", ls="--", lw=1.2, zorder=1)
        axes.set_yscale("linear" if quantity in ratios or quantity in STABILITY else scale_of(value[study.complete]))
        calm([axes], rounding=SAME)
        if quantity == "efficiency" and np.nanmin(value[study.complete]) < 0 < np.nanmax(value[study.complete]):
            axes.set_ylim(0, None)  # a body that brakes has none
        axes.set_ylabel(title.replace(" [", "\n["))
        axes.grid(lw=0.3, color=GRID)
    for axes in panels[-1]:
        axes.set_xscale(scale_of(x) if is_number else "linear")
        if not is_number:
            axes.set_xticks(x, study[first.name])
        axes.set_xlabel(label or study.label(first.name))
    if ratios:
        panels[0, 1].set_title(f"over the values at {relative_words(study)}", size=8)
    if reference:
        stack[0].plot([], [], color="#888888", ls="--", lw=1.2, label=source)
    if i > 1 or reference:
        legend_above(stack[0], 2)


# Verdicts on stability: whether |multiplier| - 1 exceeds its error, and the lines of branches.
VERDICTS = {-1: ("stable", "-"), 0: ("undecided", ":"), 1: ("unstable", "--")}


def plot_branch(study, figure, asked=None):
    """The points of `shoal steady --continue` in their order: a quantity of the fish, the places of followers, the largest
    multiplier; the line of a step is that of the less stable of its ends."""
    try:
        from scipy.interpolate import PchipInterpolator
    except ImportError as wrong:
        raise ImportError("the picture of a branch needs scipy: apt install python3-scipy, or pip install scipy") from wrong

    # monotone cubics of the arclength between the points: at a fold the key turns smoothly
    key, arclength = study.axes[0][0], study["arclength"]
    x, names = study[key.name], list(study["fish"])

    def between(values, i):
        at = np.linspace(*arclength[i:i + 2], 20)
        return PchipInterpolator(arclength, values)(at) if np.isfinite(values).all() else np.full(at.shape, np.nan)

    # an equilibrium has a growth rate instead of a multiplier
    has_beat = np.isfinite(study["steady_multiplier"]).any()
    size = study["steady_multiplier"] if has_beat else study["steady_growth"]
    error = study["steady_multiplier_error"] if has_beat else np.zeros(x.size)
    limit = 1 if has_beat else 0
    verdict = np.where(np.abs(size - limit) <= error, 0, np.sign(size - limit)).astype(int)
    quantity = asked or ("steady_speed" if has_beat else "steady_deflection")
    rows = [(quantity, study[quantity])] if quantity not in STABILITY and np.isfinite(study[quantity]).any() else []
    if not asked and len(names) > 1 and np.isfinite(study["steady_place"][:, 1:]).all():
        behind = -study["steady_place"][:, :, 0]
        behind[:, 0] = np.nan
        rows.append(("distance behind [m]", behind))
    figure.set_figheight(1.4 + 1.3 * (len(rows) + 1))
    *stack, last = np.atleast_1d(figure.subplots(len(rows) + 1, 1, sharex=True))
    top = [*stack, last][0]
    for axes, (quantity, values) in zip(stack, rows):
        is_place = quantity.startswith("distance")
        for f, name in enumerate(names):
            for i in range(x.size - 1):
                ends = sorted(verdict[i:i + 2])
                dashes = VERDICTS[ends[0] if ends[0] == ends[1] or ends[0] < 0 < ends[1] else 0][1]
                axes.plot(between(x, i), between(values[:, f], i), ls=dashes, color=COLOURS[f % 8], lw=1.3)
            if len(names) > 1 and not is_place:
                axes.plot([], [], color=COLOURS[f % 8], lw=1.3, label=name)
        axes.set_ylabel((quantity if is_place else study.label(quantity)).replace(" [", "\n["))
    last.errorbar(x, size, error, color="black", ls="", marker="o", ms=3, capsize=2, elinewidth=0.8)
    for i in range(x.size - 1):
        last.plot(between(x, i), between(size, i), color="black", lw=0.8)
    last.axhline(limit, color="#888888", lw=0.8)
    last.set_ylabel("largest\nmultiplier" if has_beat else "growth\n[s$^{-1}$]")
    for axes in (*stack, last):
        axes.grid(lw=0.3, color=GRID)
    last.set_xlabel(study.label(key.name))

    marks = {}
    for i, label in enumerate(str(text).strip("\0") for text in study["label"]):
        if not label:
            continue
        marks.setdefault(label, MARKS[len(marks) % 8])
        for axes, (_, values) in zip(stack, rows):
            axes.plot(np.full(len(names), x[i]), values[i], ls="", marker=marks[label], ms=6, mfc="gold", mec="black", zorder=4)
        last.plot(x[i], size[i], ls="", marker=marks[label], ms=6, mfc="gold", mec="black", zorder=4)
    for value in sorted(set(verdict)):
        top.plot([], [], ls=VERDICTS[value][1], color="#444444", lw=1.3, label=VERDICTS[value][0])
    for label, mark in marks.items():
        top.plot([], [], ls="", marker=mark, ms=6, mfc="gold", mec="black", label=label)
    legend_above(top, 3)


def plot_comparison(study, figure):
    """Work and precision: the error of the tail against wall time and evaluations, a line per method."""
    repeats = {}  # of each setting, in the order of the first round
    for m in range(N_REFERENCES, study.complete.size):
        repeats.setdefault(tuple(study[name][m] for name in COMPARISON), []).append(m)
    lines, failed = {}, {}
    for (word, order, rtol, step), members in repeats.items():
        label = f"ida{order:.0f}" if word == "ida" else word
        if study.complete[members].all():
            lines.setdefault(label, {}).setdefault(step > 0, []).append(members)
        else:
            failed.setdefault(label, []).append(f"step {step:g}" if step > 0 else f"rtol {rtol:g}")
    error = np.max(study["tail_error"], axis=1)
    panels = figure.subplots(1, 2, sharey=True)
    for axes, name in zip(panels, ["wall_time", "residual_evaluations"]):
        for i, (label, by_step) in enumerate(lines.items()):
            # fixed and adaptive steps of a method are two lines that look alike
            for points in by_step.values():
                cost = [np.median(study[name][members]) for members in points]
                axes.loglog(cost, [error[members[0]] for members in points], label=label, **style(i))
                label = None
        for label, settings in failed.items():
            axes.plot([], [], ls="", label=f"{label} failed: {', '.join(settings)}")
        # what is below the error of the reference itself says nothing
        axes.axhspan(0, error[N_REFERENCES - 1], color="#eeeeee", zorder=0)
        axes.axhline(error[N_REFERENCES - 1], color="#888888", lw=0.8, zorder=1)
        axes.set_xlabel({"wall_time": "wall time [s]"}.get(name, "evaluations of the equations"))
        few_ticks(axes.xaxis)
        axes.grid(which="major", lw=0.3, color=GRID)
        if name == "wall_time":
            axes.set_ylabel("error of the tail [body lengths]")
            axes.annotate(
                "error of the reference",
                (0.98, error[N_REFERENCES - 1]),
                (0, 2),
                xycoords=("axes fraction", "data"),
                textcoords="offset points",
                ha="right",
                size=7,
                color="#666666",
            )
    legend_above(panels[0], 6 if not failed else 2)


PLACE = ["x of the nose at the start [m]", "y of the nose at the start [m]"]


def is_place(keys):
    """True if the only swept key is a position."""
    return len(keys) == 1 and keys[0].name.endswith("position")


def places(study, key):
    """Positions as two arrays of numbers."""
    return np.array([ast.literal_eval(text) for text in study[key.name]], dtype=float).T


def map_axes(study):
    """x, y and their labels where members are places in a plane or pairs of numbers; None for any other study."""
    keys = [v for axis in study.axes for v in axis]
    if study.is_comparison or "key_name" in study.data.variables or any(hasattr(v, "refine") for v in keys):
        return None
    if not study.complete.any() or "solver_method" in study.data.variables:
        return None
    if is_place(keys):
        x, y = places(study, keys[0])
        is_row = np.linalg.matrix_rank(np.array([x - x[0], y - y[0]])) < 2
        return None if is_row else (x, y, PLACE)
    if len(study.axes) == len(keys) == 2 and all(study.is_number(v.name) for v in keys):
        if min(np.unique(study[v.name]).size for v in keys) > 1:
            return study[keys[0].name], study[keys[1].name], [study.label(v.name) for v in keys]
    return None


def own_words(study):
    """What a study is drawn as that has its quantities given."""
    return "an error budget" if "key_name" in study.data.variables else "a comparison of methods"


def draw(path, figure, asked=None, relative=False, states=(), reference=None):
    """Draw what a file calls for on an empty figure; asked: the quantity of a map, or of lines over an axis; relative: a map
    over the first fish; states: files of steady formations to mark in it; reference: a table of other values, for lines."""
    study, quantity = Study(path), asked or "speed"
    drawn = study.data.variables.get(quantity)
    over = map_axes(study)
    is_line = not over and "level_value" not in study.data.variables and "key_name" not in study.data.variables
    is_drawn = drawn is not None and (drawn.dimensions[1:] == ("fish",) or is_line and quantity in STABILITY)
    if not is_drawn or not study.is_number(quantity):
        raise FileError(f"{path}: {quantity} is not a quantity of the fish in it, such as speed or cost_of_transport")
    if reference and (over or study.is_comparison or not study.axes or any(hasattr(v, "refine") for axis in study.axes for v in axis)):
        raise CaseError(f"--reference: only lines over a swept key take it, and {path} is not drawn so")
    if relative and not over:
        raise CaseError(f"--relative: only maps take it, and {path} has no two axes of numbers or places")
    if states and not (over and over[2] is PLACE):
        raise CaseError(f"--states: only maps over the places of a fish take it, and {path} is none")
    if over:
        (plot_relative if relative else plot_map)(study, *over, quantity, figure)
        return mark_states(figure, list(study["fish"]), states)
    has_own = study.is_comparison or any(name in study.data.variables for name in ("key_name", "solver_method"))
    if asked and has_own:
        raise CaseError(f"--of: only maps, curves and refined axes take it, and {path} is drawn as {own_words(study)}")
    if asked and "level_value" in study.data.variables and f"error_{asked}" not in study.data.variables:
        raise CaseError(f"--of: {path} has no errors of {asked}: see {', '.join(quantities_of(study))}")
    if study.is_comparison:
        return plot_comparison(study, figure)
    if "point_member" in study.data.variables:
        return plot_points(study, figure, asked)
    if "key_name" in study.data.variables:
        is_input = study["key_is_choice"] == 2
        return (plot_sensitivity if is_input.all() else plot_budget)(study, figure)
    if not study.axes:
        raise FileError(f"{path}: a study without a sweep has nothing to draw")
    if not study.complete.any():
        raise FileError(f"{path}: no member of the study is complete")
    keys = [v for axis in study.axes for v in axis]
    refined = [v for v in keys if hasattr(v, "refine")]
    if refined:
        others = [axis[0] for axis in study.axes if axis[0].axis != refined[0].axis]
        if len(others) == 1 and study.is_number(others[0].name) and np.unique(study[others[0].name]).size >= 3:
            return plot_values(study, refined[0], others[0], figure, asked)
        return plot_convergence(study, refined[0], figure, asked)
    if "solver_method" in study.data.variables and study.is_number(keys[0].name):
        return plot_methods(study, keys[0].name, figure)
    if "label" in study.data.variables:
        return plot_branch(study, figure, asked)
    if is_place(keys):
        x, y = places(study, keys[0])
        return plot_lines(study, figure, asked, *((x, PLACE[0]) if np.ptp(x) >= np.ptp(y) else (y, PLACE[1])))
    return plot_lines(study, figure, asked, reference=reference)

"""Pictures of studies: study.nc of `shoal study`, and the file of `shoal compare`, which is one. Used by shoal.plot.

    the errors of a case            what each key has in them, and the values at its levels
    a refined axis                  differences from the finest level, with the design slope and the range of orders that is
                                    accepted; with another axis of three numbers or more values with error bars over that
    solver.method as an axis        cost against the first axis, a line per method; where there are several settings of a
                                    method the cheapest that is accurate, also as a table
    a position as the only axis     a map of the places, a number at each
    two axes of numbers             a map over both
    anything else                   speed, cost of transport and Strouhal number over the first axis; of fish that are held
                                    at a speed thrust and power over it; of bodies without a beat drag, lift and deflection
    a comparison of methods         error against wall time and evaluations
"""

import ast

from ._plot_style import DASHES, GRID, MARKS, few_ticks, scale_of
from ._files import FileError, netCDF4, np

COLOURS = ["#000000", "#0072b2", "#d55e00", "#009e73", "#aa4499", "#b06000", "#3366aa", "#666666"]  # all dark
NAMES = {
    "modulus": "Young's modulus",
    "rtol": "relative tolerance",
    "com": "centre of mass",
    "strouhal": "Strouhal number",
}


# What a comparison of methods sets: its one axis, first the reference and how good that is, then each round of repeats.
COMPARISON = ["solver_method", "solver_order", "solver_rtol", "solver_step"]
N_REFERENCES = 2


class Study:
    """A study.nc, with its axes."""

    def __init__(self, path):
        self.path = path
        try:
            self.data = netCDF4.Dataset(path)
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


def legend_above(axes, figure, n_columns):
    """A legend above a panel, as wide as it needs to be."""
    n_rows = -(-len(axes.get_legend_handles_labels()[1]) // n_columns)
    if n_rows == 0:
        return
    above = 1.12 if axes.get_title() else 1.01
    axes.legend(loc="lower left", bbox_to_anchor=(0, above), ncol=n_columns).set_in_layout(False)
    figure.get_layout_engine().set(rect=(0, 0, 1, 1 - 0.29 * n_rows / figure.get_figheight()))


def case_of(study, member, refined):
    """What the axes that are not refined set in a member, as text."""
    others = [v for axis in study.axes for v in axis if v.axis != refined.axis]
    texts = [f"{study[v.name][member]:g}" if study.is_number(v.name) else study[v.name][member] for v in others]
    return ", ".join(f"{v.long_name.split('.')[-1]} {text}" for v, text in zip(others, texts))


SLACK, FAR_ABOVE = 1, 1.5  # orders that are accepted, below and above the design order: src/study/error_budget.c


def draw_design(axes, x, size, finest, design):
    """What differences from the finest level do by the design order, over that of the coarsest level, and the orders that
    are accepted; size: grid spacing of each level, finest: that of the finest one, 0 where the limit is given."""
    if not np.isfinite(design) or size.size < 2:
        return
    fine = np.geomspace(size[0], size[-1], 50)
    at = np.interp(np.log(fine), np.log(size[::-1]), np.log(x[::-1]))
    low, middle, high = (
        (fine**p - finest**p) / (size[0] ** p - finest**p) if p > 0 else np.log(fine / finest) / np.log(size[0] / finest)
        for p in (design - SLACK, design, design + FAR_ABOVE)
    )
    words = f"accepted orders, {design - SLACK:g} and more" if design > SLACK else "accepted orders, above 0"
    axes.fill_between(np.exp(at), low, high, color="#e4e4e4", zorder=0, label=words)
    axes.plot(np.exp(at), middle, color="#888888", lw=0.8, zorder=1, label=f"design order {design:g}")


def quantities_of(study):
    """What is drawn of a refinement: positions of a run; speed and costs of steady states."""
    names = ["nose", "tail", "com", "shed_circulation"]
    if f"error_{names[0]}" not in study.data.variables:
        names = ["steady_speed", "steady_cost_of_transport", "steady_strouhal", "steady_drag", "steady_lift"]
    return [name for name in names if np.isfinite(study[f"error_{name}"]).any()]


def plot_convergence(study, refined, figure):
    """Differences of some quantities from the finest level, over those of the coarsest one; one panel per fish."""
    level, size, first = study["level_value"], study["level_size"], study["group_member"]
    names = list(study["fish_name"])
    all_axes = figure.subplots(1, len(names), squeeze=False, sharey=True)[0]
    quantities = quantities_of(study)
    errors = {name: study[f"difference_{name}"] for name in quantities}
    known = np.concatenate([np.zeros(0), *(e[np.isfinite(e) & (e > 0)] for e in errors.values())])
    if known.size == 0:
        raise FileError(f"{study.path}: no errors to draw: all levels are equal, or too few are complete")
    # the finest level has no difference but where a reference is given
    is_known = np.any([np.isfinite(e).any(axis=(0, 1)) for e in errors.values()], axis=0)
    drawn = level[is_known]
    for f, axes in enumerate(all_axes):
        i = 0
        for g, member in enumerate(first):
            for name in quantities:
                difference, bound = errors[name][g, f, is_known], study[f"error_{name}"][g, f]
                if not difference[0] > 0:
                    continue
                flag = "flagged" if str(study.data[f"objection_{name}"][g, f]).strip("\0") else ""
                unit = study.data.variables[f"error_{name}"].units
                words = [study.label(name).split(" [")[0], case_of(study, member, refined)]
                words += [f"error {bound:.1e} {unit if unit != '1' else ''}".strip(), flag]
                axes.loglog(drawn, difference / difference[0], label=", ".join(filter(None, words)), **style(i))
                i += 1
        draw_design(axes, drawn, size[is_known], 0 if is_known.all() else size[-1], study["group_design_order"][0])
        axes.set_xlabel(study.label(refined.name))
        axes.set_xticks(drawn, [f"{x:g}" for x in drawn])
        axes.minorticks_off()
        if len(names) > 1:
            axes.set_title(names[f], size=9)
        axes.grid(lw=0.3, color=GRID)
    what = "error" if is_known.all() else "difference from the finest level"
    all_axes[0].set_ylabel(f"{what},\nover that of the coarsest")
    legend_above(all_axes[0], figure, 2)


def plot_values(study, refined, parameter, figure):
    """Values of the finest level with their errors over a parameter; a line per fish and per value of the rest."""
    first, x = study["group_member"], study[parameter.name]
    finest = study[refined.name] == study["level_value"][-1]
    others = [v.name for axis in study.axes for v in axis if v.axis != refined.axis]
    settings = [tuple(str(study[name][m]) for name in others) for m in range(x.size)]
    steady = ["steady_speed", "steady_cost_of_transport", "steady_strouhal", "steady_drag", "steady_lift", "steady_deflection"]
    run = ["speed", "cost_of_transport", "mean_actuation_power"]
    known = [q for q in (steady if f"error_{steady[0]}" in study.data.variables else run)]
    known = [q for q in known if np.isfinite(study[f"error_{q}"]).any()][:3]
    if not known:
        raise FileError(f"{study.path}: no errors to draw: too few levels are complete")
    members = [next(m for m in np.flatnonzero(finest) if settings[m] == settings[g]) for g in first]
    words = [", ".join(f"{n} {study[n][m]}" for n in others if n != parameter.name) for m in members]
    names = list(study["fish_name"])
    figure.set_figheight(1.2 + 1.4 * len(known))
    stack = figure.subplots(len(known), 1, sharex=True, squeeze=False)[:, 0]
    for axes, quantity in zip(stack, known):
        i = 0
        flagged = study.data[f"objection_{quantity}"][:]
        for word in dict.fromkeys(words):
            for f, name in enumerate(names):
                rows = sorted((g for g in range(first.size) if words[g] == word), key=lambda g: x[members[g]])
                at = x[[members[g] for g in rows]]
                value = study[quantity][[members[g] for g in rows], f]
                bar = study[f"error_{quantity}"][rows, f]
                label = ", ".join(filter(None, [word, name if len(names) > 1 else ""]))
                line = style(i)
                axes.errorbar(at, value, bar, label=label or None, capsize=3, elinewidth=0.8, **line)
                # hollow where the levels state no order, so that the bar is a largest difference
                doubtful = [k for k, g in enumerate(rows) if str(flagged[g][f]).strip("\0")]
                axes.plot(at[doubtful], value[doubtful], ls="", marker="o", ms=9, mfc="none", color=line["color"], mew=0.8)
                i += 1
        axes.set_ylabel(study.label(quantity).replace(" [", "\n["))
        axes.grid(lw=0.3, color=GRID)
    stack[-1].set_xscale(scale_of(x))
    stack[-1].set_xlabel(f"{study.label(parameter.name)}   (ring: flagged, the bar is the largest difference)")
    if i > 1:
        legend_above(stack[0], figure, 2)


def plot_budget(study, figure):
    """The errors of a case. For each quantity: on the left what each key has in the sum; on the right the error at each
    level of each key: the difference from its finest level, and on top the error of that."""
    asked = [name[len("bar_") :] for name in study.data.variables if name.startswith("bar_")]
    keys = [k for k in range(study["key_levels"].size) if not study["key_is_choice"][k] and study["key_levels"][k] > 1]
    names = [str(study.data["key_name"][k]).strip("\0").split(".")[-1].split("_")[-1] for k in keys]
    names = [{"points": "sheet points"}.get(name, name) for name in names]
    fish = 0  # the others look alike, and are in error.csv
    figure.set_figheight(0.6 + 2.3 * len(asked))
    panels = figure.subplots(len(asked), 2, width_ratios=[1, 4], squeeze=False)
    for (left, right), quantity in zip(panels, asked):
        value, bar = study[f"stated_{quantity}"][fish], study[f"bar_{quantity}"][fish]
        part = study[f"part_{quantity}"][:, fish]
        if not np.isfinite(bar):
            raise FileError(f"{study.path}: the error of {quantity} is unknown")
        percent = 100 / abs(value)
        bottom = 0
        for i, k in enumerate(keys):
            is_flagged = bool(str(study.data["key_reason"][k]).strip("\0"))
            left.bar(0, part[k] * percent, bottom=bottom, color=COLOURS[(i + 1) % 8], width=0.6, hatch="//" if is_flagged else None,
                     edgecolor="white", lw=0)
            if part[k] > 0.06 * bar:
                left.annotate(names[i], (0, (bottom + part[k] * percent / 2)), ha="center", va="center", size=7,
                              bbox={"fc": "white", "ec": "none", "pad": 0.6, "alpha": 0.85})
            bottom += part[k] * percent
        left.set_xticks([])
        left.set_xlim(-0.5, 0.5)
        left.set_ylabel(f"error of {NAMES.get(quantity, quantity.replace('_', ' '))}\n[% of the value]")
        ticks, floor = [], []
        at, all_values = 0.0, study[quantity]
        for i, k in enumerate(keys):
            n, stated = int(study["key_levels"][k]), int(study["key_stated"][k])
            members = study["key_member"][k, :n].astype(int)
            values = all_values[members, fish]
            differences = np.abs(values - values[0]) * percent
            of_finest = max(part[k] * percent - differences[stated], 0)
            is_flagged = bool(str(study.data["key_reason"][k]).strip("\0"))
            for level in reversed(range(n)):
                mark = {"edgecolor": "black", "lw": 1} if level == stated else {"edgecolor": "white", "lw": 0}
                right.bar(at, differences[level] + of_finest, color=COLOURS[(i + 1) % 8], alpha=0.35, width=0.8,
                          hatch="//" if is_flagged else None, **mark)
                right.bar(at, differences[level], color=COLOURS[(i + 1) % 8], width=0.8, hatch="//" if is_flagged else None, **mark)
                ticks.append((at, f"{study['key_value'][k, level]:.3g}"))
                floor.append(differences[level] + of_finest)
                at += 1
            right.annotate(names[i], (at - n / 2 - 0.5, 1.01), xycoords=("data", "axes fraction"), ha="center", size=8)
            at += 0.8
        right.set_xticks([x for x, _ in ticks], [text for _, text in ticks], rotation=60, size=7)
        floor = [x for x in floor if x > 0]
        right.set_yscale("log")
        right.set_ylim(max(min(floor), max(floor) * 1e-5) / 2, max(floor) * 2)
        right.grid(axis="y", lw=0.3, color=GRID)
    panels[-1][1].set_xlabel(
        "levels of each key (framed: of the stated value)\n"
        "dark: difference from the finest level; light: error of that level; hatched: flagged", size=8
    )


ACCURATE = 1e-4  # error of nose and tail at which methods are compared [m]


def reference_errors(study, x):
    """How far nose or tail are from those of the most accurate implicit member with the same x [m]."""
    errors = np.full(x.size, np.nan)
    rtol = np.where((study["solver_method"] == "ida") & study.complete, study["solver_rtol"], np.inf)
    for value in np.unique(x):
        rows = np.flatnonzero(x == value)
        best = rows[np.argmin(rtol[rows])]
        for end in ("nose", "tail"):
            off = np.linalg.norm(study[end][rows] - study[end][best], axis=2).max(axis=1)
            errors[rows] = np.fmax(errors[rows], off)
        errors[best] = np.inf  # the reference itself does not compete
    return errors


def cheapest(study, over, errors):
    """Of each method, at each x, the accurate member with the fewest evaluations; printed as a table."""
    x, method = study[over], study["solver_method"]
    wall, evaluations = study["wall_time"], study["residual_evaluations"]
    accurate = np.flatnonzero(study.complete & (errors <= ACCURATE))
    chosen = []
    print(f"| {study.label(over)} | method | setting | error [m] | evaluations | wall time [s] |")
    print("|" + 6 * "--:|")
    for value in np.unique(x):
        for word in dict.fromkeys(method):
            rows = [m for m in accurate if x[m] == value and method[m] == word]
            if not rows:
                print(f"| {value:g} | {word} | none within {ACCURATE:g} m | | | |")
                continue
            m = min(rows, key=lambda row: evaluations[row])
            step, rtol = study["solver_step"][m], study["solver_rtol"][m]
            setting = f"step {step:g}" if step > 0 else f"rtol {rtol:g}"
            print(f"| {value:g} | {word} | {setting} | {errors[m]:.1e} | {evaluations[m]:.0f} | {wall[m]:.2g} |")
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
            axes.loglog(x[rows], study[name][rows], label={"ida": "implicit (ida)"}.get(word, word), **style(i))
        y = study[name][(method != "ida") & shown]
        if y.size:
            right = x.max() / 30
            low = np.median(y)
            axes.plot([right / 30, right], [low / 2, low / 2 * 30**0.5], color="#666666", lw=0.8)
            axes.annotate("slope 1/2", (right, low / 2 * 30**0.5), (2, -4), textcoords="offset points", va="top", size=8)
        axes.set_xlabel(study.label(over))
        axes.set_ylabel(label)
        few_ticks(axes.yaxis)
        axes.grid(which="major", lw=0.3, color=GRID)
    legend_above(panels[0], figure, 5)


def digits_for(values):
    """How many digits after the point distinguish the values."""
    spread = np.ptp(values)
    return int(np.clip(2 - np.floor(np.log10(spread)), 0, 12)) if spread > 0 else 4


def plot_map(study, x, y, labels, quantity, figure):
    """One panel per fish: a mark per member, as dark as its value, and the value."""
    names = list(study["fish_name"])
    x, y = x[study.complete], y[study.complete]
    all_axes = figure.subplots(1, len(names), squeeze=False, sharey=True)[0]
    known = study[quantity][study.complete]
    known = known[np.isfinite(known)]
    if known.size == 0:
        raise FileError(f"{study.path}: {quantity} has no value in any member: are the runs shorter than a beat?")
    digits, ends = digits_for(known), {"vmin": known.min(), "vmax": known.max()}  # the same for all fish
    for f, axes in enumerate(all_axes):
        values = study[quantity][study.complete, f]
        axes.set_xscale(scale_of(x))
        axes.set_yscale(scale_of(y))
        marks = axes.scatter(x, y, c=values, cmap="Greys", edgecolors="black", s=110, lw=0.7, **ends)
        for at_x, at_y, value in zip(x, y, values):
            text = f"{value:.{digits}f}"
            axes.annotate(text, (at_x, at_y), (0, 8), textcoords="offset points", ha="center", size=7)
        axes.margins(0.2)
        axes.set_xlabel(labels[0])
        if len(names) > 1:
            axes.set_title(names[f], size=9)
    all_axes[0].set_ylabel(labels[1])
    bar = figure.colorbar(marks, ax=all_axes, label=study.label(quantity))
    bar.formatter.set_useOffset(False)


def panels_of(study, first):
    """What is drawn over an axis: speed and cost; of fish that are held at the speeds of the axis what that takes; of
    bodies at rest what the stream does to them."""
    if "steady_drag" in study.data.variables and np.isfinite(study["steady_drag"][study.complete]).all():
        return ["steady_drag", "steady_lift", "steady_deflection"]
    speed, given = study["speed"][study.complete], study[first.name][study.complete]
    if first.long_name.endswith(".speed") and np.allclose(speed, given[:, None], rtol=1e-3):
        return ["mean_thrust", "mean_power", "efficiency"]
    return ["speed", "cost_of_transport", "strouhal"]


def plot_lines(study, figure):
    """Three quantities over the first axis; a line per fish and per value of the rest."""
    first = study.axes[0][0]
    x = study[first.name] if study.is_number(first.name) else np.arange(study.complete.size)
    rest = [[case_of(study, m, first)] if study.axes[1:] else [] for m in range(x.size)]
    names = list(study["fish_name"])
    figure.set_figheight(4.8)
    stack = figure.subplots(3, 1, sharex=True)
    for axes, quantity in zip(stack, panels_of(study, first)):
        i = 0
        for words in dict.fromkeys(map(tuple, rest)):
            rows = np.array([tuple(r) == words for r in rest]) & study.complete
            for f, name in enumerate(names):
                label = ", ".join([*words, *([name] if len(names) > 1 else [])])
                axes.plot(x[rows], study[quantity][rows, f], label=label or None, **style(i))
                i += 1
        axes.set_yscale(scale_of(study[quantity][study.complete]))
        axes.set_ylabel(study.label(quantity).replace(" [", "\n["))
        axes.grid(lw=0.3, color=GRID)
    stack[-1].set_xscale(scale_of(x) if study.is_number(first.name) else "linear")
    if not study.is_number(first.name):
        stack[-1].set_xticks(x, study[first.name])
    stack[-1].set_xlabel(study.label(first.name))
    if i > 1:
        legend_above(stack[0], figure, 2)


def plot_comparison(study, figure):
    """Work and precision: the error of the tail against wall time and evaluations, a line per method."""
    repeats = {}  # of each setting, in the order of the first round
    for m in range(N_REFERENCES, study.complete.size):
        repeats.setdefault(tuple(study[name][m] for name in COMPARISON), []).append(m)
    lines = {}
    for (word, order, _, step), members in repeats.items():
        if study.complete[members].all():
            label = f"ida{order:.0f}" if word == "ida" else word
            lines.setdefault(label, {}).setdefault(step > 0, []).append(members)
    error = np.max(study["tail_error"], axis=1)
    panels = figure.subplots(1, 2, sharey=True)
    for axes, name in zip(panels, ["wall_time", "residual_evaluations"]):
        for i, (label, by_step) in enumerate(lines.items()):
            # fixed and adaptive steps of a method are two lines that look alike
            for points in by_step.values():
                cost = [np.median(study[name][members]) for members in points]
                axes.loglog(cost, [error[members[0]] for members in points], label=label, **style(i))
                label = None
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
    legend_above(panels[0], figure, 6)


def draw(path, figure, quantity="speed"):
    """Draw what a file calls for on an empty figure; quantity: what a map is of."""
    study = Study(path)
    drawn = study.data.variables.get(quantity)
    if drawn is None or drawn.dimensions[1:] != ("fish",) or not study.is_number(quantity):
        raise FileError(f"{path}: {quantity} is not a quantity of the fish in it, such as speed or cost_of_transport")
    if study.is_comparison:
        return plot_comparison(study, figure)
    if "key_name" in study.data.variables:
        return plot_budget(study, figure)
    if not study.axes:
        raise FileError(f"{path}: a study without a sweep has nothing to draw")
    if not study.complete.any():
        raise FileError(f"{path}: no member of the study is complete")
    keys = [v for axis in study.axes for v in axis]
    refined = [v for v in keys if hasattr(v, "refine")]
    if refined:
        others = [axis[0] for axis in study.axes if axis[0].axis != refined[0].axis]
        if len(others) == 1 and study.is_number(others[0].name) and np.unique(study[others[0].name]).size >= 3:
            return plot_values(study, refined[0], others[0], figure)
        return plot_convergence(study, refined[0], figure)
    numbers = [v.name for v in keys if study.is_number(v.name)]
    if "solver_method" in study.data.variables and study.is_number(keys[0].name):
        return plot_methods(study, keys[0].name, figure)
    if len(study.axes) == 1 and keys[0].name.endswith("position"):
        x, y = np.array([ast.literal_eval(text) for text in study[keys[0].name]]).T
        return plot_map(study, x, y, ["x of the nose at the start [m]", "y of the nose [m]"], quantity, figure)
    if len(study.axes) == 2 and len(numbers) == len(keys) == 2:
        labels = [study.label(name) for name in numbers]
        return plot_map(study, study[numbers[0]], study[numbers[1]], labels, quantity, figure)
    return plot_lines(study, figure)

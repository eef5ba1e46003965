"""Pictures of result files: every function draws a figure and returns its matplotlib axes, in the order of its panels.

    axes = shoal.plot.time("pair.nc", fish=["follower"], beats=4)
    axes[0].figure.savefig("pair.pdf")

The first argument is the path of a file of shoal, or a result that knows its path: shoal.Steady, a dataset of shoal.study,
a run that writes a file. scripts/plot.py is the same on the command line. shoal.plot.STYLE is the look, for
matplotlib.rc_context.
"""

from __future__ import annotations

import argparse
import math
import os

import numpy as np

from . import _plot_field as plot_field_module
from . import _plot_modes as plot_modes_module
from . import _plot_school as plot_school_module
from . import _plot_study as plot_study_module
from ._files import Results, kind_of
from ._library import CaseError, FileError, kind as kind_of_value
from ._plot_style import (
    BLUE, BODY, BODY_EDGE, DASHES, GRID, LINES, MANY, NARROW, PATH, PHASES, RED, STYLE, WIDTH, Wall, add_legend, calm,
    colour_bar, draw_bands, fit, matplotlib, paper, unit_text, with_unit,
)

from matplotlib import pyplot
from matplotlib.collections import PolyCollection
from matplotlib.lines import Line2D

__all__ = ["swim", "gait", "time", "forces", "pressure", "school", "modes", "field", "study"]



def __dir__():
    return sorted(__all__)


NAMED = 30  # the names of more fish than these would hide the fish
MOST_PANELS = 24  # of a picture with a panel per fish


class UsageError(CaseError):
    """An option does not fit the file; the text says why."""


class Snapshot:
    """Bodies, wakes and paths of one row, drawn on axes; show() moves everything to another row.

    With a unit [m] lengths are drawn relative to it, from the middle of the school.
    """

    def __init__(self, axes, results, dot=9.0, unit=None):
        self.results, self.dot, self.unit = results, dot, unit
        self.strongest = strongest_vortex(results)
        self.com = results["com"]
        self.wake = axes.scatter([], [], linewidths=0, zorder=2)
        self.paths = [axes.plot([], [], color=PATH, lw=0.8, dashes=(5, 3), zorder=1)[0] for _ in results.names]
        self.bodies = PolyCollection([], facecolors=BODY, edgecolors=BODY_EDGE, linewidths=0.7, zorder=3)
        axes.add_collection(self.bodies)
        self.walls = [Wall(axes, *wall) for wall in results.walls]
        self.clock = axes.annotate("", (1, 1), (-5, -5), "axes fraction", "offset points", ha="right", va="top")
        self.labels = [axes.text(0, 0, name, size=7, ha="center", va="bottom", zorder=4) for name in names(results)]
        axes.set_aspect("equal")
        axes.set_xlabel("x [m]" if unit is None else "x from the middle [lengths]")
        axes.set_ylabel("y [m]" if unit is None else "y [lengths]")

    def place(self, points, row):
        """Positions as they are drawn in a row."""
        return points if self.unit is None else (points - self.com[row].mean(axis=0)) / self.unit

    def show(self, row):
        """Draw the state of a row."""
        outlines = [self.place(self.results.outline(row, f), row) for f in range(self.results.n_fish)]
        self.bodies.set_verts(outlines)
        for wall, (y, _) in zip(self.walls, self.results.walls):
            wall.move(self.place(np.array([[0, y]]), row)[0, 1])
        # the name of a fish that swims below the others stands below it, so that the names of neighbours do not meet
        heights = np.array([outline[:, 1].mean() for outline in outlines])
        for label, outline, height in zip(self.labels, outlines, heights - heights.mean()):
            length = np.ptp(outline, axis=0).max()
            is_below = height < -0.1 * length
            label.set_verticalalignment("top" if is_below else "bottom")
            edge = outline[:, 1].min() - 0.03 * length if is_below else outline[:, 1].max() + 0.03 * length
            label.set_position((outline[:, 0].mean(), edge))
        for f, path in enumerate(self.paths):
            path.set_data(*self.place(self.com[: row + 1, f], row).T)
        position, circulation = self.results.wake(row)
        position = self.place(position, row)
        share = np.minimum(np.abs(circulation) / self.strongest, 1)
        self.wake.set_offsets(position)
        self.wake.set_sizes(self.dot * (0.15 + 0.85 * share))
        self.wake.set_facecolors(wake_colours(circulation, share))
        self.clock.set_text(f"$t$ = {self.results.time[row]:.2f} s")


def names(results):
    """The names of the fish as a picture needs them: none where there is one fish only, or too many to read."""
    return results.names if 1 < results.n_fish <= NAMED else [""] * results.n_fish


def strongest_vortex(results):
    """What the size of a dot is relative to: all but the strongest hundredth of the vortices are weaker."""
    circulation = np.abs(results["wake_circulation"])
    circulation = circulation[np.isfinite(circulation)]
    return max(np.quantile(circulation, 0.99) if circulation.size else 0.0, 1e-300)


def wake_colours(circulation, share):
    """Red for counter-clockwise and blue for clockwise vortices; weak ones are lighter."""
    colours = np.empty((circulation.size, 4))
    colours[:] = matplotlib.colors.to_rgba(BLUE)
    colours[circulation > 0] = matplotlib.colors.to_rgba(RED)
    colours[:, 3] = 0.25 + 0.75 * share
    return colours


def limits(results, rows, with_paths=True, margin=0.4):
    """The window that holds bodies and wakes of some rows, the paths up to them, and walls: x0, x1, y0, y1."""
    points = [results.wake(row)[0] for row in rows]
    points += [results.outline(row, f) for row in rows for f in range(results.n_fish)]
    if with_paths:
        points.append(results["com"][: max(rows) + 1].reshape(-1, 2))
    points = np.concatenate(points)
    margin *= float(np.nanmax(results["body_length"]))
    (x0, y0), (x1, y1) = np.nanmin(points, axis=0), np.nanmax(points, axis=0)
    heights = [y0, y1, *(y for y, _ in results.walls)]
    return x0 - margin, x1 + margin, min(heights) - margin, max(heights) + margin


def swim_handles():
    """What is drawn in a snapshot, for its legend."""
    dot = {"ls": "", "marker": "o", "ms": 4, "mew": 0}
    return [
        Line2D([], [], color=RED, label="counter-clockwise vortex", **dot),
        Line2D([], [], color=BLUE, label="clockwise vortex", **dot),
        Line2D([], [], color=PATH, lw=0.8, dashes=(5, 3), label="path of the centre of mass"),
    ]


def panel_grid(n, window):
    """Panels for n pictures of one window: rows, columns, and the height of one in inches."""
    shape = (window[3] - window[2]) / (window[1] - window[0])
    n_columns = 1 if shape < 0.4 else min(n, 2 if shape < 1.2 else 3)
    return math.ceil(n / n_columns), n_columns, min((WIDTH - 0.6) / n_columns * shape, 8)


def panels(n, n_rows, n_columns, height):
    """A figure with n panels that share their axes."""
    figure, grid = pyplot.subplots(
        n_rows,
        n_columns,
        sharex=True,
        sharey=True,
        squeeze=False,
        layout="compressed",
        figsize=(WIDTH, n_rows * (height + 0.1) + 0.5),
    )
    for axes in grid.flat[n:]:
        axes.set_visible(False)
    for axes in grid.flat[max(n - n_columns, 0) : n]:  # the lowest of their columns
        axes.tick_params(labelbottom=True)
    return figure, list(grid.flat[:n])


def label_panels(all_axes, n_columns, x, y):
    """The labels of panels that share their axes: x below the lowest of each column, y left of the middle row."""
    n_rows = math.ceil(len(all_axes) / n_columns)
    for axes in all_axes[(n_rows - 1) * n_columns :]:
        axes.set_xlabel(x)
    middle = all_axes[(n_rows - 1) // 2 * n_columns]  # of an even number of rows at its foot
    middle.set_ylabel(y, **({} if n_rows % 2 else {"y": -0.15, "ha": "center"}))


def following_limits(results, rows):
    """The window around the middle of the school that holds all bodies and the wakes near them, in metres from there."""
    length = float(np.nanmax(results["body_length"]))
    low, high = np.full(2, np.inf), np.full(2, -np.inf)
    for row in rows:
        com, wake = results["com"][row], results.wake(row)[0]
        bodies = [results.outline(row, f) for f in range(results.n_fish)]
        near = [wake[np.hypot(*(wake - place).T) < 3 * length] for place in com]
        points = np.concatenate([*bodies, *near]) - com.mean(axis=0)
        low, high = np.minimum(low, points.min(axis=0)), np.maximum(high, points.max(axis=0))
    low, high = low - 0.3 * length, high + 0.3 * length
    return low[0], high[0], low[1], high[1]


def wants_following(results, rows, window):
    """True if the fish would be tiny in the window: it is far wider or higher than the school."""
    close = following_limits(results, rows)
    return window[1] - window[0] > 2.5 * (close[1] - close[0]) or window[3] - window[2] > 2.5 * (close[3] - close[2])


def rows_at(results, times):
    """The rows with a wake nearest to some times, which must be within the run; the last one without times."""
    first, last = results.time[0], results.time[-1]
    outside = [t for t in times or [] if not first - 1e-9 <= t <= last + 1e-9]
    if outside:
        raise UsageError(f"--times {outside[0]:g}: the run covers {first:g} to {last:g} s")
    with_wake = results.rows_with_wake()
    return [results.nearest(t, with_wake) for t in times or [last]]


def plot_swim(results, options):
    """Bodies, wakes and paths: one panel per time."""
    if options.limits and options.follow:
        raise UsageError("--limits: not together with --follow, whose windows move")
    rows = rows_at(results, options.times)
    window, unit = options.limits or limits(results, rows), None
    if options.follow or (options.follow is None and not options.limits and wants_following(results, rows, window)):
        unit = float(np.nanmax(results["body_length"]))
        window = np.array(following_limits(results, rows)) / unit
    figure, all_axes = panels(len(rows), *panel_grid(len(rows), window))
    for axes, row in zip(all_axes, rows):
        snapshot = Snapshot(axes, results, unit=unit)
        snapshot.show(row)
        snapshot.clock.set(position=(0, 2), va="bottom", size=8)  # above the panel, where nothing swims
        axes.axis(window)
        axes.label_outer()
    add_legend(all_axes[0], swim_handles(), above=12)
    return figure


def reference_shape(natural_curvature):
    """Midline of length 1 with the natural curvature of the joints, the nose at 0, swimming towards -x."""
    turning = 2 * np.arctan(natural_curvature / (natural_curvature.size + 1) / 2)
    angle = np.concatenate([[0], np.cumsum(turning)])
    edges = np.column_stack([np.cos(angle), np.sin(angle)]) / angle.size
    return np.concatenate([[[0, 0]], np.cumsum(edges, axis=0)])


def beat_rows(results, fish, n):
    """About n rows that share the last beat of a fish out evenly."""
    frequency = results["frequency"][fish]
    if not frequency > 0:
        raise FileError(f"{results.path}: {results.names[fish]} does not beat (wave.frequency is 0)")
    rows = np.flatnonzero(results.time > results.time[-1] - (1 - 1e-6) / frequency)
    if rows.size < 6:
        raise FileError(f"{results.path}: {rows.size} rows per beat are too few: make time.output_interval smaller")
    return rows[:: max(1, round(rows.size / n))]


def chosen(results, options, most=None):
    """The fish that --fish names, all without it; most: more than these are too many for one picture."""
    unknown = [name for name in options.fish or [] if name not in results.names]
    if unknown:
        raise UsageError(f"--fish {unknown[0]}: there is {', '.join(results.names)}")
    fish = [results.names.index(name) for name in options.fish or results.names]
    if most and len(fish) > most:
        raise UsageError(f"{len(fish)} fish are too many for this picture: choose up to {most} with --fish")
    return fish


def panel_per_fish(of, options):
    """The fish that get a panel of a grid, a few of many, shared out evenly; and the columns that leave the fewest gaps, two
    in a column of a journal."""
    shown = [of[i] for i in np.unique(np.linspace(0, len(of) - 1, min(len(of), MOST_PANELS)).round().astype(int))]
    n_columns = 2 if len(shown) == 4 else min(len(shown), 3)
    if len(shown) > 6:
        n_columns = min((4, 5, 3, 6), key=lambda n: -len(shown) % n)
    is_narrow = (getattr(options, "width", None) or NARROW) < NARROW
    return shown, min(n_columns, 2) if is_narrow else n_columns


def legend_above_titles(all_axes, shown, of, handles=()):
    """A legend above a grid, which also says so where panels of a few of the fish only are shown."""
    handles = list(handles)
    if len(shown) < len(of):
        handles.append(Line2D([], [], ls="", label=f"{len(shown)} of {len(of)} fish (--fish chooses others)"))
    if handles:
        add_legend(all_axes[0], handles, above=16)


def plot_gait(results, options):
    """The reference shapes of each fish over its last beat, a grid with one panel per fish."""
    of = chosen(results, options)
    shown, n_columns = panel_per_fish(of, options)
    shapes, curvatures = {}, results["natural_curvature"]
    for fish in shown:
        rows = beat_rows(results, fish, options.shapes)
        phases = (results.time[rows] - results.time[rows[0]]) * results["frequency"][fish]
        curvature = curvatures[rows, fish, : results.n_nodes[fish] - 2] * results["body_length"][fish]
        shapes[fish] = list(zip(phases, map(reference_shape, curvature)))
    points = np.concatenate([shape for of_fish in shapes.values() for _, shape in of_fish])
    y = 1.1 * np.abs(points[:, 1]).max()
    n_rows = math.ceil(len(shown) / n_columns)
    height = (WIDTH - 1.2) / n_columns * 2 * max(y, 0.1) / 1.1
    figure, all_axes = panels(len(shown), n_rows, n_columns, height + 0.2)
    for fish, axes in zip(shown, all_axes):
        for phase, shape in shapes[fish]:
            axes.plot(*shape.T, color=PHASES(phase), lw=1, marker="o", ms=1.8 if n_columns < 4 else 1)
        axes.set_title(results.names[fish], size=9 if n_columns < 4 else 8, pad=3)
        axes.set_aspect("equal")
        axes.grid(lw=0.3, color=GRID)
    all_axes[0].set(xlim=(-0.05, 1.05), ylim=(-max(y, 0.1), max(y, 0.1)))
    label_panels(all_axes, n_columns, "x / body length", "y / body length")
    legend_above_titles(all_axes, shown, of)
    scale = matplotlib.cm.ScalarMappable(matplotlib.colors.Normalize(0, 1), PHASES)
    colour_bar(figure, scale, all_axes, "time / period")
    return figure


# The forces on a body and their lines; what a prescribed motion takes is drawn where there is one.
FORCES = {
    "resistive_force": ":",
    "reactive_force": "--",
    "pressure_force": (0, (5, 1)),
    "suction_force": (0, (3, 1, 1, 1)),
    "constraint_force": "-.",
}


def last_beats(results, asked, usual=0):
    """The rows of the last beats of the slowest fish, as many as asked for, else as usual; all of 0, or where nothing beats."""
    frequency = results["frequency"]
    beating = frequency[frequency > 0]
    n = usual if asked is None else asked
    if asked and beating.size == 0:
        raise UsageError(f"--beats {asked}: no fish of this run beats")
    if n < 0:
        raise UsageError(f"--beats {n}: a number of beats, 0 for the whole run")
    if n == 0 or beating.size == 0:
        return np.arange(results.time.size)
    return np.flatnonzero(results.time >= results.time[-1] - (n + 1e-6) / beating.min())


def present(results, names, rows, fish):
    """Those of the named variables that are in the file and not zero all the time, for some rows of one fish."""
    values = {name: results[name][rows, fish] for name in names if name in results.data.variables}
    return {name: value for name, value in values.items() if np.any(np.nan_to_num(value))}


def draw_forces(axes, results, fish, rows):
    """The forces on a fish by name along its heading, their sum without the constraint (thrust) as full line."""
    time, angle = results.time[rows], np.radians(results["heading"][rows, fish])
    lines = {"thrust": axes.plot(time, results["thrust"][rows, fish], color="black", lw=1)[0]}
    for name, force in present(results, FORCES, rows, fish).items():
        along = np.cos(angle) * force[:, 0] + np.sin(angle) * force[:, 1]
        lines[name] = axes.plot(time, along, color="black", lw=0.7, ls=FORCES[name])[0]
    for name, line in lines.items():
        line.set_label(name.removesuffix("_force"))
    return list(lines.values())


def natural_scale(results, name):
    """The size of an ordinary value of a variable, by its unit: that of the largest fish with a beat of its frequency."""
    length, mass = np.nanmax(results["body_length"]), np.nanmax(results["body_mass"])
    frequency = max(float(np.nanmax(results["frequency"])), 1.0)
    speed = length * frequency
    force = mass * speed**2 / length
    scales = {"m": length, "m s-1": speed, "degree": 180, "N": force, "W": force * speed, "J": force * length}
    return float(scales.get(getattr(results.data.variables.get(name), "units", ""), 0))


def draw_lines(axes, time, values, labels):
    """A line per fish: of its own colour and dashes; of many fish the median, the quartiles and the range."""
    if len(labels) > MANY:
        return draw_bands(axes, time, values)
    return [
        axes.plot(time, one, color=LINES[f], ls=DASHES[f], lw=1, label=labels[f])[0] for f, one in enumerate(values.T)
    ]


def unwrapped(heading):
    """Headings without jumps, (time, fish): continuous in time, and at the first time within half a turn of their mean."""
    values = np.array(heading, dtype=float)
    for column in values.T:
        known = np.isfinite(column)
        column[known] = np.unwrap(column[known], period=360)
    first = np.array([column[np.isfinite(column)][0] if np.isfinite(column).any() else np.nan for column in values.T])
    angle = np.radians(first[np.isfinite(first)])
    mean = np.degrees(np.arctan2(np.sin(angle).sum(), np.cos(angle).sum()))
    mean += 360 * (mean < -90)  # 180 degrees, the heading of a start, is not -180
    return values + 360 * np.round((mean - first) / 360)


def desired(results, rows, of, heading):
    """Desired headings next to the headings (time, fish) that are drawn, without jumps."""
    values = results["desired_heading"][rows][:, of].astype(float)
    for column, drawn in zip(values.T, heading.T):
        known = np.isfinite(column)
        if known.any():
            column[known] = np.unwrap(column[known], period=360)
            at = np.flatnonzero(known)[0]
            column += 360 * np.round((drawn[at] - column[at]) / 360)
    return values


def plot_each(results, options):
    """One variable over time, a panel per fish: its line in black before those of the others in grey."""
    if options.balance:
        raise UsageError("--balance: not together with --each")
    of, values, drawn = chosen(results, options), results[options.each], last_beats(results, options.beats)
    if values.shape != (results.time.size, results.n_fish):
        raise UsageError(f"--each {options.each}: not one number per fish and time, such as speed or heading")
    time, values = results.time[drawn], values[drawn]
    if options.each.endswith("heading"):
        values = unwrapped(values)
    shown, n_columns = panel_per_fish(of, options)
    n_rows = math.ceil(len(shown) / n_columns)
    figure, all_axes = panels(len(shown), n_rows, n_columns, 1.4 if n_rows > 1 else 2.5)
    for fish, axes in zip(shown, all_axes):
        others = [f for f in of if f != fish]
        if len(of) > MANY:
            axes.fill_between(time, *np.nanquantile(values[:, others], [0.25, 0.75], axis=1), color="#cccccc", lw=0)
        else:
            axes.plot(time, values[:, others], color="#bbbbbb", lw=0.5)
        axes.plot(time, values[:, fish], color="black", lw=1.1)
        axes.set_title(results.names[fish], size=9 if n_columns < 4 else 8, pad=3)
        axes.grid(lw=0.3, color=GRID)
        axes.margins(x=0)
    others = [matplotlib.patches.Patch(color="#cccccc", label="half of the other fish")] if len(of) > MANY else []
    legend_above_titles(all_axes, shown, of, others)
    calm(all_axes, natural_scale(results, options.each))
    unit = getattr(results.data.variables[options.each], "units", "1")
    label_panels(all_axes, n_columns, "time [s]", with_unit(options.each.replace("_", " "), unit))
    return figure


def draw_desired(axes, time, values):
    """Desired headings in grey: once where all fish have the same, of many fish their median; returns the handle."""
    if not np.isfinite(values).any():
        return []
    label = "desired heading"
    if np.allclose(values, values[:, :1], atol=1e-6, equal_nan=True):
        values = values[:, :1]
    elif values.shape[1] > MANY:
        values, label = np.nanmedian(values, axis=1, keepdims=True), "median of the desired headings"
    axes.plot(time, values, color="#888888", lw=0.8, zorder=1)
    return [Line2D([], [], color="#888888", lw=0.8, label=label)]


def over_work(results, balance, of):
    """The energy balance in per cent of the work of muscle and drive on each body until the end, with its label and unit; in
    joule where a body takes none."""
    driven = np.trapz(np.nan_to_num(results["constraint_power"][:, of]), results.time, axis=0)
    work = np.abs(results["actuation_work"][-1, of]) + np.abs(driven)
    if np.all(work > 0):
        return 100 * balance / work, "energy balance / work", "%"
    return balance, "energy balance", "J"


def plot_time(results, options):
    """Speed, heading, power and forces over time in stacked panels, one line per fish."""
    if options.each:
        return plot_each(results, options)
    of, drawn = chosen(results, options), last_beats(results, options.beats)
    time, labels = results.time[drawn], [results.names[fish] for fish in of]
    rows = [("speed", "speed"), ("heading", "heading"), ("actuation_power", "muscle power")]
    if options.balance:
        rows.append(("energy_balance", "energy balance"))
    rows.append(("thrust", "thrust" if len(of) > 1 else "force ahead"))
    figure, stack = pyplot.subplots(
        len(rows), 1, sharex=True, layout="constrained", figsize=(WIDTH, 0.5 + 1.5 * len(rows))
    )
    forces, heading = [], unwrapped(results["heading"][drawn][:, of])
    for axes, (variable, label) in zip(stack, rows):
        unit = results.data.variables[variable].units
        if variable == "thrust" and len(of) == 1:
            forces = draw_forces(axes, results, of[0], drawn)
        else:
            values = heading if variable == "heading" else results[variable][drawn][:, of]
            if variable == "energy_balance":
                values, label, unit = over_work(results, values, of)
            fish = draw_lines(axes, time, values, labels)
        axes.set_ylabel(with_unit(label, unit))
        axes.grid(lw=0.3, color=GRID)
        axes.margins(x=0)
    asked = draw_desired(stack[1], time, desired(results, drawn, of, heading))
    for axes, (variable, _) in zip(stack, rows):
        calm([axes], natural_scale(results, variable))
    stack[-1].set_xlabel("time [s]")
    figure.align_ylabels(stack)
    if len(of) > 1 or asked:
        add_legend(stack[0], [*(fish if len(of) > 1 else []), *asked])
    if forces:
        add_legend(stack[-1], forces)
    return figure


# The axis of the pressure leaves out what is nearer to the nose, in body lengths: there the jump has no bound.
NEAR_NOSE = 0.03

# The powers on a body and their lines.
POWERS = {
    "actuation_power": "-",
    "drag_power": ":",
    "added_mass_power": "--",
    "pressure_power": (0, (5, 1)),
    "suction_power": (0, (3, 1, 1, 1)),
    "wake_power": (0, (5, 1, 1, 1, 1, 1)),
    "damping_power": (0, (1, 2)),
    "constraint_power": "-.",
}


def plot_forces(results, options):
    """Forces ahead and to the left, and powers, by name over the last beats, one column per fish."""
    of = chosen(results, options, most=4)
    rows = last_beats(results, options.beats, usual=4)
    time = results.time[rows]
    labels = ["force ahead [N]", "force to the left [N]", "power [W]"]
    figure, grid = pyplot.subplots(
        3, len(of), squeeze=False, sharex=True, sharey="row", layout="constrained", figsize=(WIDTH, 6)
    )
    lines = {}  # the same line for the same name in all columns
    colour = {name: LINES[i % len(LINES)] for table in (FORCES, POWERS) for i, name in enumerate(table)}
    for fish, column in zip(of, grid.T):
        angle = np.radians(results["heading"][rows, fish])
        axis = [(np.cos(angle), np.sin(angle)), (-np.sin(angle), np.cos(angle))]
        for axes, (x, y) in zip(column, axis):
            for name, force in present(results, FORCES, rows, fish).items():
                along = x * force[:, 0] + y * force[:, 1]
                lines[name] = axes.plot(time, along, color=colour[name], lw=0.9, ls=FORCES[name])[0]
        for name, power in present(results, POWERS, rows, fish).items():
            lines[name] = column[2].plot(time, power, color=colour[name], lw=0.9, ls=POWERS[name])[0]
        column[0].set_title(names(results)[fish], size=9)
        column[2].set_xlabel("time [s]")
    for axes, label in zip(grid[:, 0], labels):
        axes.set_ylabel(label)
    for axes in grid.flat:
        axes.grid(lw=0.3, color=GRID)
        axes.margins(x=0)
    for panels_of_row, variable in zip(grid, ("thrust", "thrust", "actuation_power")):
        calm(panels_of_row, natural_scale(results, variable))
    figure.align_ylabels(grid[:, 0])
    above = 14 if len(of) > 1 else 0  # the titles
    for row, table in ((0, FORCES), (2, POWERS)):
        handles = [lines[name] for name in table if name in lines]
        for handle, name in zip(handles, (name for name in table if name in lines)):
            handle.set_label(name.removesuffix("_force").removesuffix("_power").replace("_", " "))
        if handles:
            add_legend(grid[row, 0], handles, above if row == 0 else 0)
    return figure


def plot_pressure(results, options):
    """The jump of the pressure along each body at some times of its last beat, one panel per fish."""
    of = chosen(results, options)
    shown, n_columns = panel_per_fish(of, options)
    n_rows = math.ceil(len(shown) / n_columns)
    figure, all_axes = panels(len(shown), n_rows, n_columns, 6 / (n_columns + 1) if n_columns < 3 else 1.6)
    jump, arc = results["pressure"], results["control_arc"]
    if not np.isfinite(jump).any():
        raise FileError(f"{results.path}: no fish has force: pressure")
    drawn = []
    for fish, axes in zip(shown, all_axes):
        rows = beat_rows(results, fish, options.shapes)
        along = arc[fish] / results["body_length"][fish]
        for row in rows:
            phase = (results.time[row] - results.time[rows[0]]) * results["frequency"][fish]
            axes.plot(along, jump[row, fish], color=PHASES(phase), lw=0.9)
        drawn.append(np.abs(jump[rows, fish][:, along > NEAR_NOSE]))
        axes.set_title(names(results)[fish], size=9)
        axes.set_xlim(0, 1)
        axes.grid(lw=0.3, color=GRID)
    label_panels(all_axes, n_columns, "distance from the nose / body length", "pressure, right less left [Pa]")
    most = 1.1 * max(np.nanmax(values) for values in drawn)
    all_axes[0].set_ylim(-most, most)
    legend_above_titles(all_axes, shown, of)
    scale = matplotlib.cm.ScalarMappable(matplotlib.colors.Normalize(0, 1), PHASES)
    colour_bar(figure, scale, all_axes, "time / period")
    return figure


def plot_field(path, options):
    """Vorticity or speed on the grid of a field, with bodies and, if asked for, streamlines."""
    figure = pyplot.figure(figsize=(WIDTH, 4.2), layout="constrained")
    plot_field_module.draw(path, figure, options.speed, options.streamlines)
    return figure


def plot_modes(results, options):
    """The multipliers of a steady state and the largest mode."""
    figure = pyplot.figure(figsize=(WIDTH, 2.9), layout="constrained")
    plot_modes_module.draw(results, figure)
    return figure


def plot_school(results, options):
    """Polarisation, nearest neighbours and contacts of a school over time."""
    if results.n_fish < 2:
        raise FileError(f"{options.results}: one fish is no school")
    figure = pyplot.figure(figsize=(WIDTH, 6), layout="constrained")
    plot_school_module.draw(results, figure, lambda name: natural_scale(results, name))
    return figure


def plot_study(path, options):
    """Errors, costs or maps of a study.nc, or of a comparison of methods."""
    figure = pyplot.figure(figsize=(WIDTH, 3.4), layout="constrained")
    plot_study_module.draw(path, figure, options.of, options.relative, options.states or (), options.reference)
    return figure


# ---- for Python

OWN_FILES = ("field", "study")  # kinds of pictures that are not of the result of a run
KIND_OF_FILE = {"run": "swim", "study": "study", "field": "field"}  # what is drawn where nothing is said


def check_kind(picture, path):
    """Raise FileError where the file is of another kind than the picture, and say which picture there is of it."""
    kind = kind_of(path)
    wanted = picture if picture in OWN_FILES else "run"
    if kind and kind != wanted:
        raise FileError(f"{path}: the file of a {kind}, not of a {wanted}: use plot.py {KIND_OF_FILE[kind]} {path}")


def figure_of(picture, path, options):
    """The figure of a kind of picture; options: a namespace with all options of that kind."""
    check_kind(picture, path)
    source = path if picture in OWN_FILES else Results(path)
    return fit(globals()[f"plot_{picture}"](source, options))


def path_of(source):
    """The path of a file, or of the file of a result."""
    if hasattr(source, "attrs") and "path" in source.attrs:  # a dataset of shoal.study
        source = source.attrs["path"]
    source = getattr(source, "path", source)
    if not isinstance(source, (str, os.PathLike)):
        raise TypeError(f"a picture is of the path of a result file, not of {kind_of_value(source)}: let the run write() one")
    return os.fspath(source)


def _axes(picture, source, **options):
    path = path_of(source)
    with matplotlib.rc_context(STYLE):
        figure = figure_of(picture, path, argparse.Namespace(results=path, **options))
    return np.array([axes for axes in figure.axes if axes.get_visible()])


def swim(source, times=None, limits=None, follow: bool | None = None):
    """Bodies, wakes and paths. times: one panel for each, s (None: the end). limits: (x0, x1, y0, y1), m. follow: windows
    that move with the school, in body lengths (None: where the fish would be tiny otherwise)."""
    return _axes("swim", source, times=times, limits=limits, follow=follow)


def gait(source, fish=None, shapes: int = 12):
    """The shapes that the muscle asks for over the last beat, a panel per fish. fish: names (None: all)."""
    return _axes("gait", source, fish=fish, shapes=shapes)


def time(source, fish=None, beats: int | None = None, each: str | None = None, balance: bool = False):
    """Speed, m s-1, heading, degree, power of the muscle, W, and forces, N, over time. beats: the last ones (None: all). each:
    a panel per fish of this variable. balance: the energy balance, J, too."""
    return _axes("time", source, fish=fish, beats=beats, each=each, balance=balance)


def forces(source, fish=None, beats: int | None = None):
    """Forces, N, and powers, W, by name over the last beats (None: 4, 0: all), a column per fish."""
    return _axes("forces", source, fish=fish, beats=beats)


def pressure(source, fish=None, shapes: int = 12):
    """The jump of the pressure, Pa, along the bodies over the last beat (force: pressure)."""
    return _axes("pressure", source, fish=fish, shapes=shapes)


def school(source):
    """Polarisation, distances to the nearest neighbour, m, and contacts over time."""
    return _axes("school", source)


def modes(source):
    """The Floquet multipliers of a steady state, and the fish that move in the mode of the largest one."""
    return _axes("modes", source)


def field(source, speed: bool = False, streamlines: bool = False):
    """Vorticity, s-1, or speed, m s-1, with or without streamlines, from a file of `shoal field`."""
    return _axes("field", source, speed=speed, streamlines=streamlines)


def study(source, of: str | None = None, relative: bool = False, states=(), reference: str | None = None):
    """What a study or a comparison of methods calls for: orders, costs, curves, or a map of a quantity (None: the speed);
    relative: over the values of the first fish, in per cent; states: paths of steady formations, marked in a map over places
    (filled: stable); reference: the path of a table of other values, drawn as dashed lines: its first line is a comment with
    their source, its columns have the names of the swept key and of quantities."""
    return _axes("study", source, of=of, relative=relative, states=states, reference=reference)

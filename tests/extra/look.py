"""look.py SCRIPTS: Facts on what is drawn, where a picture does not tell."""
import argparse, re, sys
import netCDF4
import numpy as np
sys.path.insert(0, sys.argv[1])
from shoal import _files as shoal_results, _plot_style as plot_style, plot
plot.matplotlib.rcParams["figure.max_open_warning"] = 0

results = shoal_results.Results("seven.nc")
options = argparse.Namespace(times=None, limits=None, follow=None)
assert plot.plot_swim(results, options).axes[0].get_xlabel().endswith("[lengths]"), "a long way is followed"
options.follow = False
assert plot.plot_swim(results, options).axes[0].get_xlabel() == "x [m]", "unless told otherwise"
over_time = argparse.Namespace(balance=False, fish=None, each=None, beats=0)
heading = plot.time("seven.nc")[1]
assert any("constant" in text.get_text() for text in heading.texts), "rounding is not drawn as if it were a course"
speed = plot.plot_time(results, over_time).axes[0]
assert len(speed.lines) == 3 and len(speed.collections) == 1, "many fish are a band"
assert np.allclose(speed.lines[2].get_ydata(), np.median(results["speed"], axis=1)), "with their median"
band = speed.collections[0].get_paths()[0].vertices
quartiles = np.quantile(results["speed"], [0.25, 0.75], axis=1)
assert np.isclose(band[:, 1].min(), quartiles[0].min()) and np.isclose(band[:, 1].max(), quartiles[1].max()), "and quartiles"
over_time.fish = ["number 2", "number 5"]
lines = plot.plot_time(results, over_time).axes[0].lines
assert len(lines) == 2 and len({line.get_linestyle() for line in lines}) == 2, "lines are told apart without colour"
over_time.fish, over_time.each = None, "speed"
titles = [axes.get_title() for axes in plot.plot_time(results, over_time).axes if axes.get_visible()]
assert titles == results.names, "a panel per fish"

# headings on both sides of 180 degrees are next to each other, and a turn goes on
assert np.allclose(plot.unwrapped([[-178, 179], [178, 184], [170, 190]]), [[182, 179], [178, 184], [170, 190]])
turned = plot.time("turned.nc", fish=["number 1", "number 2"])[1]
assert np.ptp([np.mean(line.get_ydata()) for line in turned.lines]) < 3, "182 and 180 degrees are near"

# rounding errors are constant, also around 0
speed = plot.time("run.nc")[0]
assert [text.get_text() for text in speed.texts if text.get_alpha() != 0] == ["constant: 0"], "rounding of a speed"
assert all(np.all(line.get_ydata() == 0) for line in speed.lines)

# a formation of fish that swim towards -x, whose multiplier, 0.996 +- 0.008, leaves its stability undecided: its mark is open,
# and where the follower is
ahead, left = shoal_results.Results("formation.nc")["steady_place"][1]
mark = plot.study("places/study.nc", of="shed_circulation", relative=True, states=["formation.nc"])[0].lines[-1]
assert np.allclose([mark.get_xdata()[0], mark.get_ydata()[0]], [-ahead, -left], atol=1e-3) and ahead < -1, (ahead, left)
assert mark.get_markerfacecolor() == "none", mark.get_markerfacecolor()

# a reference is a dashed line with its source
line = plot.study("line/study.nc", of="shed_circulation", reference="theory.csv")[0]
assert np.allclose(line.lines[1].get_xydata(), [[0.2, 0.1], [0.4, 0.2]]), line.lines[1].get_xydata()
assert [text.get_text() for text in line.get_legend().get_texts()] == ["this program", "a theory"]

# every unit has raised exponents
shown = [plot.time("run.nc", balance=True), plot.forces("run.nc"), plot.field("run-field.nc"), plot.study("map/study.nc"),
         plot.field("run-field.nc", speed=True), plot.pressure("pressure.nc"), plot.study("refine/study.nc"),
         plot.time("run.nc", each="speed"), plot.school("seven.nc")]
for axes in shown:
    for text in axes[0].figure.findobj(plot.matplotlib.text.Text):
        assert not re.search(r"[a-zA-Z]-?[0-9]|/s", re.sub(r"number [0-9]|[$][^$]*[$]", "", text.get_text())), text.get_text()
assert "m s$^{-1}$" in shown[0][0].get_ylabel(), shown[0][0].get_ylabel()

# a colour bar is as high as the panels
for axes in (plot.gait("run.nc"), plot.gait("seven.nc"), plot.field("run-field.nc"), plot.study("map/study.nc")):
    figure = axes[0].figure
    figure.canvas.draw()
    bars, panels = ([a for a in axes if (a.get_label() == "<colorbar>") == is_bar] for is_bar in (True, False))
    box = plot.matplotlib.transforms.Bbox.union([a.get_window_extent() for a in panels])
    bar = bars[0].get_tightbbox(figure.canvas.get_renderer()) if "vorticity" in bars[0].get_ylabel() else bars[0].get_window_extent()
    assert len(bars) == 1 and abs(bar.height - box.height) < 0.02 * box.height, (bar, box)

# the gaits of seven fish are a grid with equal scales
panels = plot.gait("seven.nc")[:-1]
assert len(panels) == 7 and len({tuple(a.get_xlim() + a.get_ylim()) for a in panels}) == 1
columns = {round(a.get_subplotspec().colspan.start) for a in panels}
assert columns == {0, 1, 2, 3} and max(a.get_subplotspec().rowspan.start for a in panels) == 1

# a school has panels of existing variables only
for axes in plot.school("seven.nc"):
    assert "contact" not in axes.get_ylabel() and any(np.isfinite(line.get_ydata()).any() for line in axes.lines)

# a slope triangle below all lines of three levels, inside the axes, with the design order as slope
axes = plot.study("refine/study.nc")[0]
corner = next(patch.get_xy() for patch in axes.patches if patch.get_label() == "_triangle")[:3]
order = float(netCDF4.Dataset("refine/study.nc")["group_design_order"][0])
(left, foot), (right, _), (_, top) = corner
assert np.isclose(np.log(top / foot) / np.log(right / left), order), (corner, order)
assert axes.get_ylim()[0] < foot and axes.get_xlim()[0] < left < right < axes.get_xlim()[1]
assert any(text.get_text() == f"order {order:g}" for text in axes.texts)
for line in axes.lines:
    x, y = (np.log(np.array(value, float)[::-1]) for value in line.get_data())
    assert x.size == 2 and np.interp(np.log(right), x, y) > np.log(top) and np.interp(np.log(left), x, y) > np.log(foot)
# and the lines are straight for the design order, at any ratios of the levels
from shoal._plot_study import Study, edges_between, level_errors
study = Study("refine/study.nc")
size, speed = study["level_size"], study["speed"][:, 0]
wanted = np.abs(np.diff(speed)) / (1 - (size[1:] / size[:-1]) ** order)
assert np.allclose(level_errors(study, "speed", order)[0, 0, :-1], wanted, rtol=1e-9)

# numbers of nodes rise from left to right; speed and cost are drawn, or the quantity that is asked for
axes = plot.study("nodes/study.nc")[0]
at = [axes.transData.transform((x, 1))[0] for x in axes.get_xticks()]
assert at == sorted(at) or at == sorted(at, reverse=True), at
nodes = [float(text.get_text()) for _, text in sorted(zip(at, axes.get_xticklabels()), key=lambda pair: pair[0])]
assert nodes == sorted(nodes), nodes
drawn = [text.get_text().split(",")[0] for text in axes.get_legend().get_texts()]
assert {"speed", "cost of transport"} <= set(drawn), drawn
drawn = [text.get_text().split(",")[0] for text in plot.study("nodes/study.nc", of="speed")[0].get_legend().get_texts()]
assert drawn[0] == "speed" and "nose" not in drawn, drawn
# a method that failed is listed in the figure of a comparison
drawn = [text.get_text() for text in plot.study("stiff.nc")[0].get_legend().get_texts()]
assert drawn == ["ida2", "euler failed: rtol 0.01"], drawn

# values of a refined axis over another one: on the right the errors in per cent, which no mark hides; a depth has its unit
left, right = plot.study("bars/study.nc")[0:2]
study = Study("bars/study.nc")
finest = study["time_shedding_interval"] == 0.01
wanted = 100 * study["error_speed"][:, 0] / study["speed"][finest, 0]
assert np.isfinite(wanted).all() and np.allclose(right.lines[0].get_ydata(), wanted, rtol=1e-9), wanted
assert right.get_ylabel() == "error [%]" and right.get_ylim()[0] == 0 and right.get_ylim()[1] > wanted.max()
assert any("depth / body length" in axes.get_xlabel() for axes in left.figure.axes)

# a map of few members has cells with values at the positions, a map of many members has contours
axes = plot.study("map/study.nc", of="shed_circulation")[0]
mesh = axes.collections[0]
assert isinstance(mesh, plot.matplotlib.collections.QuadMesh) and len(axes.collections) == 1, "cells, no dots"
written = sorted(float(text.get_text()) for text in axes.texts)
values = np.sort(Study("map/study.nc")["shed_circulation"].ravel())
assert len(written) == 6 and np.allclose(written, values, atol=0.02 * np.ptp(values)), (written, values)
# contours through many members; a quantity without differences says so and has no colour bar
from shoal import _plot_study
class Members:
    """A study of two axes of seven and six numbers, of one fish."""
    path, x, y = "members", *(a.ravel() for a in np.meshgrid(np.linspace(1, 2, 7), np.linspace(3, 5, 6)))
    complete = np.ones(42, dtype=bool)
    def __init__(self, values):
        self.values = values
    def __getitem__(self, name):
        return np.array(["one"]) if name == "fish" else self.values[:, None]
    def label(self, name):
        return name
class Pair(Members):
    """The same of two fish: the second is 30 % below to 30 % above the first."""
    def __getitem__(self, name):
        return np.array(["one", "two"]) if name == "fish" else np.column_stack([2 + 0 * self.values, 2 + 0.6 * self.values])
for name in ("cost_of_transport", "speed"):
    figure = plot.pyplot.figure(layout="constrained")
    _plot_study.plot_relative(Pair(2 * Members.x - 3), Members.x, Members.y, ["x", "y"], name, figure)
    panel, bar = figure.axes
    assert panel.get_title() == "two" and bar.get_ylabel().endswith("over one [%]"), bar.get_ylabel()
    red, _, blue, _ = panel.collections[0].get_facecolor()[0]  # of the lowest values
    assert np.allclose(bar.get_ylim(), (-30, 30)) and (blue > red) == (name != "speed"), (bar.get_ylim(), red, blue)
    zero = np.concatenate([path.vertices for path in panel.collections[-1].get_paths()])
    assert np.allclose(zero[:, 0], 1.5), "the line without gain and loss"
for values, n_axes in ((Members.x * Members.y, 2), (1 + 1e-9 * Members.x, 1)):
    figure = plot.pyplot.figure(layout="constrained")
    _plot_study.plot_map(Members(values), Members.x, Members.y, ["x", "y"], "speed", figure)
    figure.canvas.draw()
    assert len(figure.axes) == n_axes, "a colour bar where there are colours"
    said = [text.get_text() for text in figure.axes[0].texts]
    if n_axes == 1:
        assert "speed is constant: 1" in said, said
    else:
        isolines = [float(text) for text in said]
        assert len(isolines) > 3 and all(3 <= value <= 10 for value in isolines), said
        assert not any(isinstance(c, plot.matplotlib.collections.QuadMesh) for c in figure.axes[0].collections)
assert np.allclose(edges_between(np.array([1.0, 2, 4]), "linear"), [0.5, 1.5, 3, 5])
assert np.allclose(edges_between(np.array([1.0, 4, 16]), "log"), [0.5, 2, 8, 32])

# walls are in the window, hatched on the side without fluid, at the correct height in every moving window
results = shoal_results.Results("channel.nc")
assert results.walls == [(0, 1), (2, -1)], results.walls
window = plot.limits(results, [0])
assert window[2] < 0 and window[3] > 2, window
for unit, shift in ((None, 0), (0.5, -results["com"][0, 0, 1])):
    snapshot = plot.Snapshot(plot.pyplot.subplots()[1], results, unit=unit)
    snapshot.show(0)
    for wall, (y, inward) in zip(snapshot.walls, results.walls):
        drawn = (y + shift) / (unit or 1)
        assert np.allclose(wall.line.get_ydata(), drawn), (unit, wall.line.get_ydata())
        solid = np.sort([wall.solid.get_y(), wall.solid.get_y() + wall.solid.get_height()])
        assert np.isclose(solid[1 if inward > 0 else 0], drawn), (unit, solid)
assert shoal_results.Results("seven.nc").walls == []

# bodies are drawn along the curve of the bound sheet
for name in ("seven.nc", "swim.nc"):
    results = shoal_results.Results(name)
    n, sheet = results.n_nodes[0], results["sheet_arc"][0]
    weights = shoal_results.smooth_weights(n, sheet / results["body_length"][0] * (n - 1))
    off = np.abs(weights @ results.nodes(-1, 0) - results["sheet_x"][-1, 0]).max()
    assert off < 1e-9, (name, off)
# and a nose as of an ellipse, for both definitions of the thickness of an edge, up to the tail; there they may end bluntly
at = (1 - np.cos(np.linspace(0, np.pi, 9))) / 2
k = np.arccos(np.linspace(1, 0, 7))
ends = 0.1 * (np.sin(k[:-1]) + np.sin(k[1:]))
means = 0.1 * (np.diff(k) - np.diff(np.sin(2 * k)) / 2) / -np.diff(np.cos(k))
for thickness, is_mean in ((ends, False), (means, True)):
    off = np.abs(shoal_results.half_thickness(thickness, at, is_mean) - 0.1 * np.sqrt(at * (2 - at))).max()
    assert off < 1e-12, (is_mean, off)

# between rows bodies and wakes of a movie are near those of finer rows; on rows they are the rows
import animate
frames, fine = animate.Frames("rows_0.1.nc", 25, 1), shoal_results.Results("rows_0.02.nc")
assert not frames.is_exact and np.allclose(np.diff(frames.time), 0.04) and frames.time.size == 31
length = fine["body_length"][0]
for i, t in enumerate(frames.time):
    row = fine.nearest(t)
    off = np.abs(frames.nodes(i, 0) - fine.nodes(row, 0)).max()
    assert off < (1e-12 if abs(t * 10 - round(t * 10)) < 1e-9 else 1e-3) * length, (t, off)
    (place, strength), (wanted, other) = frames.wake(i), fine.wake(row)
    # on rows the newest vortex still grows; between rows a marker that will be dropped fades, and its neighbours grow
    if abs(t * 10 - round(t * 10)) < 1e-9:
        assert place.shape == wanted.shape and np.allclose(strength[:-1], other[:-1], atol=1e-12), t
        assert np.abs(place - wanted).max(initial=0) < 1e-12 * length, (t, np.abs(place - wanted).max())
    else:
        apart = np.linalg.norm(place[:, None] - wanted, axis=2).min(axis=0, initial=np.inf)
        assert 0 <= len(place) - len(wanted) <= 5 and apart.max(initial=0) < 0.02 * length, (t, len(place), len(wanted), apart)
        off = abs(strength[:-1].sum() - other[:-1].sum())
        assert off < 1e-6 + 0.02 * np.abs(other).max(initial=0), (t, off, np.abs(other).max())
    assert np.abs(frames["com"][i] - fine["com"][row]).max() < 1e-4 * length
assert animate.Frames("rows_0.02.nc", 25, 1).how == "every 2nd row of the file"
# the camera holds the bodies and does not beat with them: its path bends less than that of the fish
window, size, follow = animate.choose_window(frames, True)
windows = np.array([window(i) for i in range(frames.time.size)])
assert follow and np.allclose(np.ptp(windows[:, :2], axis=1), size[0])
for i in range(frames.time.size):
    (x0, y0), (x1, y1) = frames.outline(i, 0).min(axis=0), frames.outline(i, 0).max(axis=0)
    assert windows[i, 0] < x0 and x1 < windows[i, 1] and windows[i, 2] < y0 and y1 < windows[i, 3], i
bends = [np.abs(np.diff(y, 2)).max() for y in (windows[:, 2:].mean(axis=1), frames["com"][:, 0, 1])]
assert bends[0] < 0.5 * bends[1], bends
far = animate.Frames("seven.nc", 25, 1)
assert animate.choose_window(far, None)[2] and not animate.choose_window(far, False)[2], "a long way is followed"

assert plot_style.scale_of([1e4, 1e10]) == "log" and plot_style.scale_of([1, 30]) == "linear"
assert plot_style.scale_of([-1, 1e3]) == "linear"
first, last = plot_style.PHASES(0.0), plot_style.PHASES(1.0)
assert first == last, "a phase comes round"

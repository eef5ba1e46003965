#!/usr/bin/env bash
# The scripts that draw: each makes a picture from a short run, and refuses wrong input with the right exit code.
#
#   tests/extra/test_scripts.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

export MPLCONFIGDIR=$folder/matplotlib

# The scripts in one process, which reads names and arguments between tabs and writes the exit codes: loading
# matplotlib takes most of the time of a call.
cat >serve.py <<'end'
import contextlib, importlib, sys, traceback

sys.path.insert(0, sys.argv[1])
for line in sys.stdin:
    name, *arguments = line.rstrip("\n").split("\t")
    sys.argv = [name, *arguments]
    with open("out", "w") as out, open("err", "w") as err:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = 0
            try:
                importlib.import_module(name.removesuffix(".py")).main(arguments)
            except SystemExit as end:
                code = end.code or 0
            except BaseException:
                traceback.print_exc()
                code = 1
    if "matplotlib.pyplot" in sys.modules:
        sys.modules["matplotlib.pyplot"].close("all")
    print(code, flush=True)
end
coproc scripts { /usr/bin/python3 serve.py "$root/scripts" 2>serve.err; }

# Run a script with arguments; leaves out, err and $code.
script() {
    local IFS=$'\t'
    code=died
    echo "$*" >&"${scripts[1]}"
    read -r -t "$time_limit" code <&"${scripts[0]}"
}

# A script makes a figure: name and arguments, the last argument is the figure.
draws() {
    local picture=${*: -1}
    script "$@"
    check "$1 ${picture}: exit 0" test "$code" = 0
    check "$1 ${picture} is a picture" test -s "$picture" -a "$(stat -c %s "$picture" 2>/dev/null || echo 0)" -gt 5000
    check "$1 ${picture} is named on standard output" grep -qx "$picture" out
}

# A script refuses arguments: exit code, text of the message, script and arguments.
refuses() {
    local want=$1 text=$2
    shift 2
    script "$@"
    check "$*: exit $want" test "$code" = "$want"
    check "$*: says $text" grep -qF -- "$text" err
    check "$*: no stack of python" test -z "$(grep Traceback err)"
}

code=0
: >err
"$program" run "$root/cases/article/figure5.yaml" -q -o run.nc --set time.output_interval=0.05 --set wake.decay=0.2 \
    --set "fish[*].start.speed=0" 2>err || code=$?
check "a short run" test "$code" = 0

# the remaining strength of a vortex over age, as in the program (tests/wake/test_wake.c): all, half, nothing
code=0
PYTHONPATH=$root/scripts /usr/bin/python3 - >out 2>err <<'END' || code=$?
from shoal._files import Results, np
run = Results("run.nc")
lifetime, decay, interval = (float(run[name]) for name in ("wake_lifetime", "wake_decay", "shedding_interval"))
ages = lifetime - interval / 2 - decay * np.array([1.1, 1, 0.5, 0])
assert np.allclose(run.remaining(ages), [1, 1, 0.5, 0], atol=1e-12), run.remaining(ages)
END
check "a vortex decays as in the program" test "$code" = 0

/usr/bin/python3 "$root/scripts/plot.py" run.nc >out 2>err || fail "plot.py as a command" "$(head -c 300 err)"
check "plot.py as a command" grep -qx run.png out
/usr/bin/python3 "$root/scripts/animate.py" nothing.nc >out 2>err
check "animate.py as a command" grep -qx "animate.py: nothing.nc: no such file" err
draws plot.py swim run.nc --limits -1 2 -3 3 --times 1 2 -- swim.png
draws plot.py gait run.nc gait.svg
draws plot.py time run.nc --balance time.pdf
draws plot.py run.nc default.png
draws plot.py forces run.nc --beats 1 forces.png
draws plot.py time run.nc --style paper -- two_columns.png
draws plot.py forces run.nc --style paper --width 85 -- one_column.png
check "a figure of a paper has its width" eval '/usr/bin/python3 -c "
from matplotlib import image
widths = [image.imread(name).shape[1] / 200 * 25.4 for name in (\"two_columns.png\", \"one_column.png\")]
assert abs(widths[0] - 170) < 0.5 and abs(widths[1] - 85) < 0.5, widths"'
cat >narrow.py <<'end'
import sys

sys.path.insert(0, sys.argv[1])
from matplotlib import pyplot
from shoal import plot
from shoal._plot_style import add_legend

with pyplot.rc_context(plot.STYLE):
    figure, (left, right) = pyplot.subplots(1, 2, layout="constrained", figsize=(plot.WIDTH, 3))
    for axes in (left, right):
        axes.plot([0, 1], label="a rather long name")
        axes.plot([1, 0], label="another long name")
    left.set(aspect="equal", xlabel="a label of the left panel")
    right.set(xlabel="a long label of the right panel, in words")
    add_legend(left, left.get_legend_handles_labels()[0])
    plot.paper(figure, 85)
    figure.draw_without_rendering()
    legend = left.get_legend().get_window_extent()
    for one in (right.get_window_extent(), *(text.get_window_extent() for text in right.texts)):
        assert not legend.overlaps(one), (legend, one)
    assert right.xaxis.label.get_window_extent().x1 <= figure.bbox.x1 + 1, right.get_xlabel()
end
check "in one column of a paper legends and labels keep clear of other panels" /usr/bin/python3 narrow.py "$root/scripts"
refuses 2 "--width: from 40 to 400 mm, with --style paper" plot.py time run.nc --width 85 -- no.png
"$program" field run.nc --grid 60,40 -q
"$program" run "$root/cases/demo.yaml" -q -o pressure.nc --set time.end=1 --set "fish[0].force=pressure"
draws plot.py pressure pressure.nc along.png
refuses 4 "no fish has force: pressure" plot.py pressure run.nc no.png
draws plot.py field run-field.nc field.png
draws plot.py field run-field.nc --speed --streamlines speed.png
draws plot.py run-field.nc of_its_own_kind.png
"$program" run "$root/cases/channel.yaml" -q -o channel.nc --set time.end=0.2
"$program" field channel.nc --grid 40,40 -q
draws plot.py channel-field.nc beyond_walls_is_nothing.png
draws plot.py channel.nc channel.png
refuses 4 "the file of a run, not of a field: use plot.py swim run.nc" plot.py field run.nc no.png
refuses 4 "the file of a field, not of a run: use plot.py field run-field.nc" plot.py swim run-field.nc no.png
if command -v ffmpeg >/dev/null; then
    draws animate.py run.nc --dpi 60 movie.mp4
    # two seconds of rows 0.05 s apart
    check "it says what its pictures are" grep -qx "51 pictures, 25 a second: interpolated between rows 0.05 s apart" out
    if command -v ffprobe >/dev/null; then
        ffprobe -v error -select_streams v -show_entries stream=avg_frame_rate,nb_frames -of csv=p=0 movie.mp4 >out
        check "it has 25 pictures a second" grep -qx "25/1,51" out
    fi
else
    skip "animate.py movie.mp4" "there is no ffmpeg"
fi
draws animate.py run.nc --fps 10 --dpi 40 --follow movie.gif
check "it says so of whole rows" grep -qx "21 pictures, 10 a second: every 2nd row of the file; the camera follows the school" out
refuses 2 "--fps: has to be positive" animate.py run.nc --fps 0

# ---- several fish of 7 nodes, far from the start

{ printf 'format: 1\ntime: {end: 1, shedding_interval: 0.05, output_interval: 0.1}\nfluid: {density: 0}\n'
  printf 'defaults: {fish: {nodes: 7, motion: {prescribed: all, speed: 30}}}\nfish:\n'
  for i in 0 1 2 3 4 5 6; do echo "  - {name: number $i, start: {position: [0, $i]}}"; done; } >seven.yaml
"$program" run seven.yaml -q -o seven.nc
draws plot.py time seven.nc many.png
draws plot.py school seven.nc school.png
refuses 4 "one fish is no school" plot.py school pressure.nc no.png
draws plot.py time seven.nc --each heading small.png
draws plot.py time seven.nc --fish "number 2" "number 5" -- two.png
draws plot.py forces seven.nc --fish "number 2" -- one.png
refuses 2 "7 fish are too many for this picture: choose up to 4 with --fish" plot.py forces seven.nc no.png
refuses 2 "--fish nobody: there is number 0, number 1" plot.py gait seven.nc --fish nobody -- no.png
refuses 2 "--each com: not one number per fish and time" plot.py time seven.nc --each com no.png
draws plot.py seven.nc --times 0.5 1 -- follow.png
refuses 2 "--times 100: the run covers 0 to 1 s" plot.py seven.nc --times 0.5 100 -- no.png
"$program" run "$root/cases/demo.yaml" -q -o swim.nc --set time.end=0.2 --set "fish[0].nodes=7"
for interval in 0.1 0.02; do
    "$program" run "$root/cases/demo.yaml" -q -o rows_$interval.nc --set time.end=1.2 --set time.shedding_interval=0.02 \
        --set "time.output_interval=$interval" --set "fish[0].nodes=9" --set "fish[0].force=reactive" 2>/dev/null
done
"$program" run seven.yaml -q -o turned.nc --set "fish[2].start.heading=-178"
cat >refine.yaml <<'end'
format: 1
time: {end: 0.4, shedding_interval: 0.04}
fish: [{force: reactive, nodes: 5, sheet_points: 9, start: {speed: 0.5}}]
sweep: [{key: time.shedding_interval, values: [0.04, 0.02, 0.01], refine: true}]
end
"$program" study refine.yaml -q -o refine >/dev/null 2>&1
"$program" study refine.yaml -q -o bars --set 'sweep=[{key: "fish[*].body.depth", values: [0.2, 0.3, 0.4]}, {key: time.shedding_interval, values: [0.04, 0.02, 0.01], refine: true}]' \
    --set 'fish[0].wave.frequency=5' >/dev/null 2>&1
cat >map.yaml <<'end'
format: 1
time: {end: 0.1, shedding_interval: 0.05, output_interval: 0.05}
fish: [{force: reactive, nodes: 5, sheet_points: 9}]
sweep: [{key: "fish[0].wave.amplitude", values: [0.2, 0.3, 0.4]}, {key: "fish[0].wave.frequency", values: [1, 2]}]
end
"$program" study map.yaml -q -o map >/dev/null 2>&1
draws plot.py study map/study.nc --of shed_circulation -- map.png
refuses 2 "--of: refine/study.nc has no errors of energy_balance: see nose, tail" plot.py study refine/study.nc --of energy_balance -- no.png
draws plot.py study refine/study.nc --of speed -- refine_speed.png
draws plot.py study refine/study.nc refine.png
refuses 2 "--relative: only maps take it" plot.py study refine/study.nc --relative -- no.png
"$program" steady "$root/cases/formation.yaml" -q --set 'fish[*].nodes=7' --set 'fish[*].sheet_points=13' -o formation.nc 2>/dev/null
"$program" study map.yaml -q -o line --set 'sweep=[{key: "fish[0].wave.amplitude", values: [0.2, 0.3, 0.4]}]' >/dev/null 2>&1
printf '%s\n' '# a theory' 'fish[0].wave.amplitude,shed_circulation' 0.2,0.1 0.4,0.2 >theory.csv
tail -n +2 theory.csv >nameless.csv
draws plot.py study line/study.nc --of shed_circulation --reference theory.csv -- line.png
"$program" steady "$root/cases/flag.yaml" -q --threshold 'fish[*].body.modulus=50000:100000' --set 'fish[*].nodes=9' -o crossing \
    >/dev/null 2>&1
draws plot.py study crossing/study.nc --of steady_growth -- crossing.png
draws plot.py swim crossing/state-000.nc equilibrium.png
draws plot.py time formation.nc steady.png
check "xarray opens a steady state" /usr/bin/python3 -c \
    'import xarray; data = xarray.open_dataset("formation.nc"); data.steady_speed.sel(fish=data.fish[0]).item()'
refuses 4 "steady_growth is not a quantity of the fish" plot.py study map/study.nc --of steady_growth -- no.png
refuses 4 "nameless.csv: the first line has to be a comment with the source" plot.py study line/study.nc --reference nameless.csv -- no.png
refuses 2 "--reference: only lines over a swept key take it" plot.py study map/study.nc --reference theory.csv -- no.png
"$program" study "$root/cases/formation.yaml" -q --set 'fish[*].nodes=5' --set 'fish[*].sheet_points=9' --set time.end=0.2 -o places \
    --set 'sweep=[{key: "fish[1].start.position", values: [[1.2, 0], [1.5, 0], [1.2, 0.3]]}]' >/dev/null 2>&1
draws plot.py study places/study.nc --of shed_circulation --relative --states formation.nc -- places.png
refuses 2 "--states: only maps over the places of a fish" plot.py study map/study.nc --states formation.nc -- no.png
refuses 4 "run.nc: no formation in it" plot.py study places/study.nc --of shed_circulation --states run.nc -- no.png
"$program" study refine.yaml -q -o nodes --set 'sweep=[{key: "fish[*].nodes", values: [5, 6, 7, 9], refine: true}]' \
    --set 'fish[0].sheet_points=17' >/dev/null 2>&1
"$program" compare refine.yaml -q -o stiff.nc --set 'sweep=[]' --set solver.max_steps=60 --set 'fish[0].body.modulus=1e9' \
    --methods euler,ida2 --rtol 1e-2 --repeats 1 >/dev/null 2>&1
cat >look.py <<'end'
"""Facts on what is drawn, where a picture does not tell."""
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
end
code=0
timeout "$time_limit" /usr/bin/python3 look.py "$root/scripts" >out 2>err || code=$?
check "facts on pictures" test "$code" = 0

# ---- xarray

cat >open.py <<'end'
"""A result in plain xarray: the names of fish and axes are coordinates."""
import numpy as np
import xarray

run = xarray.open_dataset("seven.nc")
assert list(run.fish.values) == [f"number {i}" for i in range(7)] and list(run.xy.values) == ["x", "y"], run.coords
np.testing.assert_array_equal(run.com.sel(fish="number 3", xy="y"), run.com[:, 3, 1])
np.testing.assert_array_equal(run.x.sel(fish="number 6", xy="x").isel(node=0), run.x[:, 6, 0, 0])
assert run.speed.sel(fish=["number 1", "number 2"]).shape == (run.time.size, 2)
assert {"fish", "xy", "time"} <= set(run.indexes), run.indexes
end
code=0
timeout "$time_limit" /usr/bin/python3 open.py >out 2>err || code=$?
check "names are coordinates in xarray" test "$code" = 0

# ---- files without a figure

# a copy of a file with some bytes replaced
damaged() {  # from, place
    cp "$1" damaged.nc
    printf '\377\177\377\377' | dd of=damaged.nc bs=1 seek="$2" conv=notrunc 2>dd.err
}
for place in 40 1300; do
    damaged run.nc $place
    script plot.py time damaged.nc damaged.png
    check "bytes $place damaged: a picture or a message" test -z "$(grep Traceback err)" -a "$code" != 1
done

cat >sweep.yaml <<'end'
format: 1
time: {end: 0.1, shedding_interval: 0.05, output_interval: 0.05}
fish: [{force: reactive, nodes: 5, sheet_points: 9}]
sweep:
  - {key: "fish[0].wave.amplitude", values: [0.2, 0.3]}
  - {key: "fish[0].wave.frequency", values: [1, 2]}
end
"$program" study sweep.yaml -q -o sweep >/dev/null 2>&1
cat >craft.py <<'end'
"""craft.py FILE NAME: put text in the place of a variable."""
import sys
import netCDF4

data, name = netCDF4.Dataset(sys.argv[1], "a"), sys.argv[2]
old = data[name]
words = {key: old.getncattr(key) for key in old.ncattrs() if key != "_FillValue"}
data.renameVariable(name, "no_" + name)
new = data.createVariable(name, "S1", old.dimensions)
new.setncatts(words)
new[...] = "x"
end
for name in speed fish0_wave_amplitude fish0_wave_frequency; do
    cp sweep/study.nc text_study.nc
    /usr/bin/python3 craft.py text_study.nc $name
    script plot.py study text_study.nc text.png
    check "a study with text as its $name: a picture or a message" test -z "$(grep Traceback err)" -a "$code" != 1
done
for name in speed time wake_count; do
    cp run.nc text_run.nc
    /usr/bin/python3 craft.py text_run.nc $name
    script plot.py time text_run.nc text.png
    check "a run with text as its $name: a picture or a message" test -z "$(grep Traceback err)" -a "$code" != 1
done

echo text >text.nc
ncgen -o other.nc <<<'netcdf other { dimensions: x = 1; }'
refuses 4 "no such file" plot.py nothing.nc
refuses 4 "not a result file" plot.py text.nc
refuses 4 "not one of a run of shoal" plot.py other.nc
head -c -100 run.nc >cut.nc
refuses 4 "the end of the file is missing" plot.py cut.nc
refuses 4 "no folder" plot.py run.nc no/such.png
refuses 2 "such" plot.py run.nc picture.such
refuses 2 "required" plot.py gait
refuses 2 "--colour: unrecognized option of swim" plot.py run.nc --colour
refuses 2 "--shapse: unrecognized option of gait: did you mean --shapes?" plot.py gait run.nc --shapse 3
refuses 2 "swin: neither a figure nor a file: did you mean swim?" plot.py swin run.nc
refuses 2 "heads: neither a figure nor a file: figures are swim, gait, time" plot.py heads

# an option that a figure ignores is refused, in one line
ignored() {  # message, arguments...
    refuses 2 "$@"
    check "$*: one line" test "$(wc -l <err)" = 1
}
ignored "--balance: gait does not take it, time does" plot.py gait run.nc --balance
ignored "--shapes: swim does not take it, gait and pressure do" plot.py run.nc --shapes=3
ignored "--of: time does not take it, study does" plot.py time run.nc --of speed
ignored "--balance: not together with --each" plot.py time run.nc --each speed --balance
ignored "--limits: not together with --follow" plot.py swim run.nc --follow --limits 0 1 0 1
"$program" run seven.yaml -q -o still.nc --set "fish[*].wave.frequency=0"
ignored "--beats 2: no fish of this run beats" plot.py time still.nc --beats 2
refuses 4 "no such file" animate.py nothing.nc
refuses 2 ".mp4 or .gif" animate.py run.nc movie.png

finish

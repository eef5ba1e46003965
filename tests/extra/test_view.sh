#!/usr/bin/env bash
# The numbers of the page of a run equal the result, and a browser draws the page without an error.
#
#   tests/extra/test_view.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

export MPLCONFIGDIR=$folder/matplotlib

# ---- the page

cat >pair.yaml <<'end'
format: 1
name: two <fish> & "one" page
time: {end: 1.5, shedding_interval: 0.02, output_interval: 0.1}
wake: {lifetime: 0.8, decay: 0.08}
output: {wake_interval: 0.2}
defaults: {fish: {nodes: 9, wave: {ramp: 0.5}}}
fish:
  - {name: leader, start: {heading: 90}}
  - {name: </script>, length: 0.7, nodes: 7, start: {position: [0.4, -1.4], heading: 90}}
end
run run pair.yaml -q -o pair.nc
check a_short_run test "$code" = 0
run view pair.nc
check a_page_is_written test "$code" = 0 -a -s pair.html
check its_name_is_printed grep -qx pair.html out
check nothing_is_loaded test -z "$(grep -oE '(src|href|url|import|fetch)[ =(]*["'\''(]?(https?:)?//' pair.html)"
refused an_existing_page_is_kept 4 'exists' view pair.nc
run view pair.nc --force -q -o other.html
check force_replaces_it test "$code" = 0 -a ! -s out -a -s other.html
refused no_result 4 'nothing.nc' view nothing.nc
refused no_file 2 'RUN.nc is missing' view

# ---- numbers of the page

cat >compare.py <<'end'
"""Compare the numbers in a page with those of the result that it is made of."""
import base64, json, re, sys
import netCDF4, numpy as np

text = open(sys.argv[1], encoding="utf-8").read()
run = json.loads(re.search(r'<script type="application/json" id="run">(.*?)</script>', text, re.S).group(1))
file = netCDF4.Dataset(sys.argv[2])
file.set_auto_mask(False)

def array(part, kind):
    return np.frombuffer(base64.b64decode(part), kind)

def near(name, got, want, atol):
    if got.shape != want.shape or not np.allclose(got, want, rtol=0, atol=atol, equal_nan=True):
        sys.exit(f"{name}: {got} is not {want}")

def places(rows, n):
    box = array(rows["box"], "f8").reshape(-1, 3)
    return box, array(rows["place"], "u2").reshape(n, 2)

names = ["leader", "</script>"]
assert run["title"] == 'two <fish> & "one" page' and [fish["name"] for fish in run["fish"]] == names, run["title"]
assert run["thinned"] == "" and run["rows"] == file["time"].size and len(run["shapes"]) == 2

rows = file["time"].size
box, place = places(run["bodies"], rows * 16)
got = box[:, None, :2] + place.reshape(rows, 16, 2) * box[:, None, 2:]
want = np.concatenate([file["x"][:, 0], file["x"][:, 1, :7]], axis=1)
# rounded to the nearest of the steps of each box
near("bodies", got / box[:, None, 2:], want / box[:, None, 2:], 0.5 + 1e-9)
near("time", array(run["bodies"]["time"], "f8"), file["time"][:], 0)

wakes = run["wakes"]
with_wake = np.flatnonzero((file["wake_count"][:].sum(axis=1) == 0) | np.isfinite(file["wake_circulation"][:, 0, 0]))
assert wakes["n"] == with_wake.size < rows, (wakes["n"], with_wake)
number, count = array(wakes["number"], "i4"), array(wakes["count"], "i4").reshape(-1, 2)
box, place = places(wakes, count.sum())
strength, at = array(wakes["strength"], "i2") * wakes["unit"], 0
assert np.abs(array(wakes["strength"], "i2")).max() == 32767, "all 16 bits"
for i, row in enumerate(with_wake):
    for f in range(2):
        n = file["wake_count"][row, f]
        assert count[i, f] == n, (count[i, f], n)
        near("wake", box[i, :2] + place[at : at + n] * box[i, 2], file["wake_x"][row, f, :n], 0.5001 * box[i, 2] or 1e-12)
        birth = file["wake_birth"][row, f, :n]
        near("births", number[at : at + n] * wakes["interval"], birth, 1e-9)
        young = file["time"][row] - birth < 0.6  # older ones decay
        near("strength", strength[at : at + n][young], file["wake_circulation"][row, f, :n][young], 0.5001 * wakes["unit"])
        assert np.all(np.abs(strength[at : at + n]) <= np.abs(file["wake_circulation"][row, f, :n]) + wakes["unit"])
        at += n
for name in ("speed", "heading", "actuation_power"):
    near(name, array(run["series"][name], "f4").reshape(2, -1).T, file[name][:].astype("f4"), 0)
end
numbers_are() { /usr/bin/python3 compare.py "$@"; }
check numbers_are_those_of_the_result numbers_are pair.html pair.nc

check no_walls_where_there_are_none grep -q '"walls":\[\],' pair.html
cat >wall.yaml <<'end'
format: 1
time: {end: 0.04, shedding_interval: 0.02}
fluid: {walls: [0.75]}
fish: [{nodes: 5}]
end
run run wall.yaml -q -o wall.nc
run view wall.nc -q
check walls_and_where_the_fluid_is grep -qF '"walls":[{"y":0.75,"inward":-1}],' wall.html
cat >above.yaml <<'end'
format: 1
time: {end: 0.04, shedding_interval: 0.02}
fluid: {walls: [0.75]}
defaults: {fish: {nodes: 5}}
fish: [{start: {position: [0, 2]}}, {start: {position: [0, 4]}, body: {thickness: 0.15}}, {start: {position: [0, 6]}}]
end
run run above.yaml -q -o above.nc
run view above.nc -q
check a_fish_above_a_wall grep -qF '"walls":[{"y":0.75,"inward":1}],' above.html
check each_shape_is_there_once test "$(grep -o '"shape":[0-9]' above.html | tr -d '\n')" = '"shape":0"shape":1"shape":0'

# a long run is thinned, and says so
cat >long.yaml <<'end'
format: 1
time: {end: 59.9, shedding_interval: 0.1, output_interval: 0.1}
wake: {lifetime: 40, tolerance: 1e-3}
fluid: {density: 0}
defaults: {fish: {force: reactive, nodes: 5, sheet_points: 5, wave: {amplitude: 0.001}}}
fish: [{}, {start: {position: [0, 5]}}, {start: {position: [0, 10]}}, {start: {position: [0, 15]}}, {start: {position: [0, 20]}}, {start: {position: [0, 25]}}, {start: {position: [0, 30]}}]
end
run run long.yaml -q -o long.nc
run view long.nc -q
check a_long_run_is_below_8_MB test "$(stat -c %s long.html)" -lt 8000000
cat >thinned.py <<'end'
"""The rows that are left in a thinned page: one of so many, and the last one."""
import base64, json, re
import netCDF4, numpy as np

text = open("long.html", encoding="utf-8").read()
run = json.loads(re.search(r'<script type="application/json" id="run">(.*?)</script>', text, re.S).group(1))
time = netCDF4.Dataset("long.nc")["time"][:].filled()
stride = int(re.search(r"wakes: one of (\d+) rows", run["thinned"])[1])
assert (time.size - 1) % stride != 0, "the last row is one of them anyway"
got = np.frombuffer(base64.b64decode(run["wakes"]["time"]), "f8")
assert got.size == run["wakes"]["n"]
assert np.array_equal(got, np.append(time[::stride], time[-1])), got
# vortices that are left have the births of the result
stride = int(re.search(r"vortices: one of (\d+) vortices", run["thinned"])[1])
number, count = (np.frombuffer(base64.b64decode(run["wakes"][key]), "i4") for key in ("number", "count"))
count = count.reshape(-1, 7)[-1]
for f in range(7):
    birth = netCDF4.Dataset("long.nc")["wake_birth"][-1, f].compressed()
    at = number.size - count[f:].sum()
    left = number[at : at + count[f]] * run["wakes"]["interval"]
    kept = birth[np.round(birth / 0.1).astype(int) % stride == 0]
    assert stride > 1 and kept.size == count[f] and np.allclose(left, kept, rtol=0, atol=1e-9), left
end
check the_last_row_is_always_there /usr/bin/python3 thinned.py
check what_is_left_out_is_said grep -q '"thinned":"[^"]*wakes: one of ' long.html

# 200 fish, with headings on both sides of 180 degrees, without fluid: one fish jerks
{ printf 'format: 1\ntime: {end: 1, shedding_interval: 0.1, output_interval: 0.1}\nfluid: {density: 0}\nwake: {lifetime: 0.3}\n'
  printf 'defaults: {fish: {force: reactive, nodes: 5, sheet_points: 5}}\nfish:\n'
  for i in {0..199}; do
      printf '  - {start: {position: [%d, %d], heading: %d}, wave: {phase: %d}}\n' $((i / 20 * 2)) $((i % 20)) $((175 + i % 11)) $((i * 37 % 360))
  done; } >crowd.yaml
run run crowd.yaml -q -o crowd.nc
run view crowd.nc -q
cat >bands.py <<'end'
"""What the page says of its traces in its elements: bands are quantiles of the result, headings have no jump."""
import re
import netCDF4, numpy as np

page, data = open("browser.out", encoding="utf-8").read(), netCDF4.Dataset("crowd.nc")
def element(name, key):
    canvas = re.search(rf'<canvas[^>]*data-name="{name}"[^>]*>', page)[0]
    return re.search(rf'data-{key}="([^"]*)"', canvas)[1]
power = np.quantile(data["actuation_power"][-1], [0, 0.25, 0.5, 0.75, 1])
got = np.array(element("actuation_power", "bands").split(), float)
assert np.allclose(got, power, rtol=1e-5, atol=1e-5 * np.ptp(power)), (got, power)
low, high = float(element("heading", "low")), float(element("heading", "high"))
assert high - low < 60, (low, high)
assert element("speed", "constant") == "true", "a speed of rounding is constant"
assert 'data-overview="200"' in page, "the school is in the corner"
assert re.search(r'id="scale"[^>]*>heading \[degree\]', page), "a scale of colours"
end

# a steady state: the speed changes in the sixth digit
cat >steady.yaml <<'end'
format: 1
time: {end: 1, shedding_interval: 0.04, output_interval: 0.2}
steady: {tolerance: 1e-4, multipliers: false, output_beats: 2}
fish: [{force: reactive, nodes: 9, sheet_points: 21}]
end
run steady steady.yaml -q -o steady.nc
run view steady.nc -q
cat >axes.py <<'end'
"""Ticks of the traces: texts differ, and with the base of the axis each one is in the range; colours cover the range."""
import html, re, sys

page = html.unescape(open("browser.out", encoding="utf-8").read())
for canvas in re.findall(r"<canvas[^>]*data-name=[^>]*>", page):
    ticks, base, low, high = (re.search(rf'data-{key}="([^"]*)"', canvas)[1] for key in ("ticks", "base", "low", "high"))
    ticks, base, low, high = ticks.split(), float(base or 0), float(low), float(high)
    at, room = [base + float(text) for text in ticks], 0.07 * (high - low)
    assert 2 <= len(ticks) == len(set(ticks)) and max(map(len, ticks)) <= 8, ticks
    assert low - room <= min(at) and max(at) <= high + room, (low, at, high)
    steps = [b - a for a, b in zip(at, at[1:])]
    assert max(steps) - min(steps) < 1e-3 * max(steps), ticks
    if sys.argv[1:] == [re.search(r'data-name="([^"]*)"', canvas)[1]]:
        ends = re.search(r'id="scale"[^>]*>[^<]*\] ([^ <]*)<i [^>]*></i>([^<]*)<', page).groups()
        assert [abs(float(a) - b) < 6e-3 * (high - low) for a, b in zip(ends, (low, high))] == [True, True], (ends, low, high)
end

# ---- in a browser

# Open a page for some seconds of browser time; leaves the console in browser.err.
browse() {  # page#options, options of the browser...
    local page=$1
    shift
    timeout "$time_limit" chromium --headless=new --no-sandbox --disable-gpu --hide-scrollbars --enable-logging=stderr \
        --user-data-dir="$folder/browser" "$@" "file://$folder/$page" >browser.out 2>browser.err </dev/null
}
console() { grep -a ':CONSOLE' browser.err; }

# Count the pixels of a picture that are clearly red, blue, grey like a body, and all but the most frequent.
cat >pixels.py <<'end'
import sys
import numpy as np
from matplotlib import image

picture = image.imread(sys.argv[1])[:, :, :3]
height = int(float(sys.argv[2]) * picture.shape[0])
r, g, b = np.moveaxis(picture[:height], 2, 0)
print((r - b > 0.25).sum(), (b - r > 0.25).sum(), picture.shape[1], picture.mean() > 0.5)
end
# A screenshot has one dark line over the full width, and strokes above the line but not below.
cat >wall.py <<'end'
import numpy as np
from matplotlib import image

picture = image.imread("wall.png")[:, :, :3].mean(axis=2)
height, width = picture.shape
rows = picture[: int(0.55 * height), int(0.1 * width) : int(0.8 * width)]
wall = np.flatnonzero((rows < 0.7).all(axis=1))
assert 1 <= wall.size <= 4 and np.ptp(wall) < 4, wall
above, below = rows[wall[0] - 7 : wall[0] - 2], rows[wall[-1] + 3 : wall[-1] + 8]
assert (above < 0.8).mean() > 0.05 > (below < 0.8).mean(), (above.mean(), below.mean())
end
# A screenshot has at least so many red and blue pixels of wakes, is so wide, and light or dark.
shows() {  # picture, red, blue, width, light
    local red blue width light
    read -r red blue width light < <(/usr/bin/python3 pixels.py "$1" 0.6)
    echo "$1: $red red, $blue blue, $width wide, light $light"
    ((red >= $2 && blue >= $3 && width == $4)) && [[ $light == "$5" ]]
}

if ! command -v chromium >/dev/null; then
    fail a_browser "there is no chromium: scripts/install-deps.sh chromium"
else
    browse 'pair.html#t=1.2&theme=light' --window-size=1280,1000 --virtual-time-budget=500 --screenshot=light.png
    check no_error_in_the_console test -z "$(console)"
    check fish_and_wakes_are_drawn shows light.png 150 150 1280 True
    browse 'pair.html#t=1.2&theme=dark&follow=1' --window-size=390,844 --virtual-time-budget=500 --screenshot=dark.png
    check on_a_phone_in_the_dark shows dark.png 60 60 390 False
    check no_error_on_a_phone test -z "$(console)"
    # a busy machine draws fewer frames in a second
    for budget in 1500 6000 24000 96000; do
        browse 'pair.html#t=0.5&play=1' --virtual-time-budget=$budget --dump-dom
        frames=$(grep -oE 'data-frames="[0-9]+"' browser.out | grep -oE "[0-9]+")
        ((${frames:-0} > 3)) && break
    done
    check frames_are_drawn test "${frames:-0}" -gt 3
    # the page starts again at the end, so any time except the start is correct
    check and_time_goes_on grep -qE 'data-time="[0-9.]+"' <(grep -v 'data-time="0.50*"' browser.out)
    browse 'wall.html#t=0.04&theme=light' --window-size=1280,1000 --virtual-time-budget=500 --screenshot=wall.png
    check no_error_beside_a_wall test -z "$(console)"
    check a_wall_is_drawn /usr/bin/python3 wall.py
    browse 'crowd.html#t=0.5&theme=light&follow=77&colour=heading' --virtual-time-budget=500 --dump-dom
    check no_error_in_a_crowd test -z "$(console)"
    check a_crowd_has_bands_and_an_overview /usr/bin/python3 bands.py
    browse 'crowd.html#t=0.5&theme=light' --virtual-time-budget=500 --dump-dom
    check no_overview_beside_the_whole_school grep -q 'data-overview="0"' browser.out
    browse 'crowd.html#t=0.5&theme=light&colour=heading' --window-size=1280,1100 --virtual-time-budget=500 --screenshot=crowd.png
    check fish_have_the_colours_of_their_headings shows crowd.png 1000 1000 1280 True
    browse 'steady.html' --virtual-time-budget=500 --dump-dom
    check ticks_of_a_steady_state_differ /usr/bin/python3 axes.py
    check its_time_does_not_begin_at_0 grep -qE '1 fish, [0-9.]+ to [0-9.]+ s' browser.out
    browse 'pair.html#colour=actuation_power' --virtual-time-budget=500 --dump-dom
    check colours_cover_the_range_of_the_curve /usr/bin/python3 axes.py actuation_power
    # the console is heard
    sed 's/^const run = .*/const run = nothing_of_this_name;/' pair.html >broken.html
    browse broken.html --virtual-time-budget=100 --dump-dom
    check a_broken_page_is_noticed grep -q nothing_of_this_name <(console)
fi

finish

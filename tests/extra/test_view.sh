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

numbers_are() { /usr/bin/python3 "$root/tests/extra/page_numbers.py" "$@"; }
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
check the_last_row_is_always_there /usr/bin/python3 "$root/tests/extra/page_thinned.py"
check what_is_left_out_is_said grep -q '"thinned":"[^"]*wakes: one of ' long.html

# 200 fish, with headings on both sides of 180 degrees, without fluid: one fish jerks
{ printf 'format: 1\ntime: {end: 1, shedding_interval: 0.1, output_interval: 0.1}\nfluid: {density: 0}\nwake: {lifetime: 0.3}\n'
  printf 'defaults: {fish: {force: reactive, nodes: 5, sheet_points: 5}}\nfish:\n'
  for i in {0..199}; do
      printf '  - {start: {position: [%d, %d], heading: %d}, wave: {phase: %d}}\n' $((i / 20 * 2)) $((i % 20)) $((175 + i % 11)) $((i * 37 % 360))
  done; } >crowd.yaml
run run crowd.yaml -q -o crowd.nc
run view crowd.nc -q

# a steady state: the speed changes in the sixth digit
cat >steady.yaml <<'end'
format: 1
time: {end: 1, shedding_interval: 0.04, output_interval: 0.2}
steady: {tolerance: 1e-4, multipliers: false, output_beats: 2}
fish: [{force: reactive, nodes: 9, sheet_points: 21}]
end
run steady steady.yaml -q -o steady.nc
run view steady.nc -q

# ---- in a browser

# Open a page for some seconds of browser time; leaves the console in browser.err.
browse() {  # page#options, options of the browser...
    local page=$1
    shift
    timeout "$time_limit" chromium --headless=new --no-sandbox --disable-gpu --hide-scrollbars --enable-logging=stderr \
        --user-data-dir="$folder/browser" "$@" "file://$folder/$page" >browser.out 2>browser.err </dev/null
}
console() { grep -a ':CONSOLE' browser.err; }

# A screenshot has at least so many red and blue pixels of wakes, is so wide, and light or dark.
shows() {  # picture, red, blue, width, light
    local red blue width light
    read -r red blue width light < <(/usr/bin/python3 "$root/tests/extra/count_pixels.py" "$1" 0.6)
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
    check a_wall_is_drawn /usr/bin/python3 "$root/tests/extra/page_wall.py"
    browse 'crowd.html#t=0.5&theme=light&follow=77&colour=heading' --virtual-time-budget=500 --dump-dom
    check no_error_in_a_crowd test -z "$(console)"
    check a_crowd_has_bands_and_an_overview /usr/bin/python3 "$root/tests/extra/page_bands.py"
    browse 'crowd.html#t=0.5&theme=light' --virtual-time-budget=500 --dump-dom
    check no_overview_beside_the_whole_school grep -q 'data-overview="0"' browser.out
    browse 'crowd.html#t=0.5&theme=light&colour=heading' --window-size=1280,1100 --virtual-time-budget=500 --screenshot=crowd.png
    check fish_have_the_colours_of_their_headings shows crowd.png 1000 1000 1280 True
    browse 'steady.html' --virtual-time-budget=500 --dump-dom
    check ticks_of_a_steady_state_differ /usr/bin/python3 "$root/tests/extra/page_axes.py"
    check its_time_does_not_begin_at_0 grep -qE '1 fish, [0-9.]+ to [0-9.]+ s' browser.out
    browse 'pair.html#colour=actuation_power' --virtual-time-budget=500 --dump-dom
    check colours_cover_the_range_of_the_curve /usr/bin/python3 "$root/tests/extra/page_axes.py" actuation_power
    # the console is heard
    sed 's/^const run = .*/const run = nothing_of_this_name;/' pair.html >broken.html
    browse broken.html --virtual-time-budget=100 --dump-dom
    check a_broken_page_is_noticed grep -q nothing_of_this_name <(console)
fi

finish

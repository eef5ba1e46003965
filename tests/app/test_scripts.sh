#!/usr/bin/env bash
# The scripts that draw: each makes a picture from a short run, and refuses wrong input with the right exit code.
#
#   tests/app/test_scripts.sh PROGRAM
set -uo pipefail
export LC_ALL=C.UTF-8

program=$(realpath "${1:?usage: tests/app/test_scripts.sh PROGRAM}")
root=$(realpath "$(dirname "$0")/../..")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 2
export MPLCONFIGDIR=$folder/matplotlib

# shellcheck source=tests/checks.sh
. "$root/tests/checks.sh"

# Run a script with arguments; leaves out, err and $code.
script() {
    local name=$1
    shift
    code=0
    timeout 60 /usr/bin/python3 "$root/scripts/$name" "$@" >out 2>err </dev/null || code=$?
}

# A script makes a picture: its name and arguments, the last of them the picture.
draws() {
    local picture=${*: -1}
    script "$@"
    check "$1 ${picture}: exit 0" test "$code" = 0
    check "$1 ${picture} is a picture" test -s "$picture" -a "$(stat -c %s "$picture" 2>/dev/null || echo 0)" -gt 5000
    check "$1 ${picture} is named on standard output" grep -qx "$picture" out
}

# A script refuses its arguments: exit code, text of the message, script and arguments.
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
"$program" run "$root/cases/gait.yaml" -q -o run.nc 2>err || code=$?
check "a short run" test "$code" = 0

draws plot.py swim run.nc --limits -1 2 -3 3 --times 1 2 -- swim.png
draws plot.py gait run.nc gait.svg
draws plot.py time run.nc --audit time.pdf
draws plot.py run.nc default.png
draws plot.py forces run.nc --beats 1 forces.png
"$program" field run.nc --grid 60,40 -q
draws plot.py field run-field.nc field.png
draws plot.py field run-field.nc --speed --no-streamlines speed.png
refuses 4 "not one of shoal field" plot.py field run.nc no.png
refuses 4 "not one of shoal run" plot.py swim run-field.nc no.png
if command -v ffmpeg >/dev/null; then
    draws animate.py run.nc --fps 10 --dpi 60 movie.mp4
else
    skip "animate.py movie.mp4" "there is no ffmpeg"
fi
draws animate.py run.nc --fps 10 --dpi 40 --follow movie.gif

echo text >text.nc
ncgen -o other.nc <<<'netcdf other { dimensions: x = 1; }'
refuses 4 "no such file" plot.py nothing.nc
refuses 4 "not a result file" plot.py text.nc
refuses 4 "not one of shoal" plot.py other.nc
head -c -100 run.nc >cut.nc
refuses 4 "the end of the file is missing" plot.py cut.nc
refuses 4 "no folder" plot.py run.nc no/such.png
refuses 2 "such" plot.py run.nc picture.such
refuses 2 "required" plot.py gait
refuses 2 "unrecognized" plot.py run.nc --colour
refuses 4 "no such file" animate.py nothing.nc
refuses 2 ".mp4 or .gif" animate.py run.nc movie.png

echo "$n_passed passed, $n_failed failed, $n_skipped skipped"
((n_failed == 0))

#!/usr/bin/env bash
# The scripts that draw: each makes a picture from a short run, and refuses wrong input with the right exit code.
#
#   tests/extra/test_scripts.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

export MPLCONFIGDIR=$folder/matplotlib
start_python

# The scripts in one process, which reads names and arguments between tabs and writes the exit codes: loading
# matplotlib takes most of the time of a call.
coproc scripts { /usr/bin/python3 "$root/tests/extra/serve_scripts.py" "$root/scripts" 2>serve.err; }

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

check "a vortex decays as in the program" python "$root/tests/extra/remaining.py" "$root/scripts" run.nc

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
check "a figure of a paper has its width" python "$root/tests/extra/widths.py"
check "in one column of a paper legends and labels keep clear of other panels" python "$root/tests/extra/narrow.py" "$root/scripts"
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
check "xarray opens a steady state" python "$root/tests/extra/open_steady.py"
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
check "facts on pictures" python "$root/tests/extra/look.py" "$root/scripts"

# ---- xarray

check "names are coordinates in xarray" python "$root/tests/extra/open_xarray.py"

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
for name in speed fish0_wave_amplitude fish0_wave_frequency; do
    cp sweep/study.nc text_study.nc
    python "$root/tests/extra/craft.py" text_study.nc $name
    script plot.py study text_study.nc text.png
    check "a study with text as its $name: a picture or a message" test -z "$(grep Traceback err)" -a "$code" != 1
done
for name in speed time wake_count; do
    cp run.nc text_run.nc
    python "$root/tests/extra/craft.py" text_run.nc $name
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

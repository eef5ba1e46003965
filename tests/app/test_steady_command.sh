#!/usr/bin/env bash
# The steady state of a case, and the equilibrium of a case without a beat, have the same values on the screen and in
# the file, and failures have messages.
#
#   tests/app/test_steady_command.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"
start_python

cat >swim.yaml <<'end'
format: 1
time: {end: 3, shedding_interval: 0.05, output_interval: 0.1}
fish: [{name: a fish, force: reactive, nodes: 17, sheet_points: 17}]
end

# ---- the file

run steady swim.yaml -q
check a_search_succeeds test "$code" = 0 -a ! -s out -a ! -s err -a -s swim.nc
refused an_existing_file_is_kept 4 'exists' steady swim.yaml
run info swim.nc
check info_knows_it_is_steady has out 'steady state after'
check one_fish_has_no_place test -z "$(grep '^place' out)"
check and_its_multipliers grep -qE '^    0[.][0-9]{4} [+]- 0[.]0[0-9]{3}: speed 1.00' out
check and_whether_it_is_stable has out '  stable'
run run swim.yaml -q -o run.nc --set time.end=0.1
check the_file_says_what_is_printed python "$root/tests/app/steady_file.py"
run steady swim.yaml -o other.nc --set steady.output_beats=1 --set steady.multipliers=false
check a_search_prints_its_file_and_answer test "$code" = 0 -a "$(head -1 out)" = other.nc -a -n "$(grep 'Strouhal' out)"
check without_multipliers_there_are_none test -z "$(grep multipliers out)"
progress='^beat +[0-9]+  residual [0-9.]+e[-+]0[0-9], target 1e-05  [0-9.]+ s  speed +0[.][0-9]{4} m/s$'
check progress_goes_to_stderr test "$(grep -cE "$progress" err)" -gt 1 -a "$(grep '^beat ' err | grep -cvE "$progress")" = 0 \
    -a "$(grep -o '^beat *[0-9]*' err | grep -vc '[05]$')" = 0

# ---- a fish with a slowly decaying oscillation: the end of a swing is not a steady state

for start in 0 1.5; do
    run steady "$root/cases/stiff.yaml" -q -o "from$start.nc" --set time.shedding_interval=0.02 \
        --set time.output_interval=0.1 --set output.wake_interval=0.1 --set steady.tolerance=1e-4 \
        --set "fish[0].start.speed=$start"
done
check the_speed_does_not_depend_on_the_start python "$root/tests/app/steady_starts.py"

run steady "$root/cases/single_free.yaml" -q -o swings.nc --set time.shedding_interval=0.02 \
    --set time.output_interval=0.1 --set output.wake_interval=0.1 --set steady.tolerance=1e-4
check a_swing_is_left_for_a_steady_state test "$code" = 0
# it was 0.1 lengths per beat from the fixed point, at the end of a swing, once
error=$(python "$root/tests/value.py" swings.nc steady_error)
check and_that_is_near awk -v error="$error" 'BEGIN { exit !(error != "" && error + 0 < 3e-3) }'

# ---- as JSON

run steady swim.yaml -o json.nc --json -q --set "fish[0].name='a \"fish\"'"
check json_is_what_is_in_the_file python "$root/tests/app/steady_json.py" 3
check and_quiet_progress test ! -s err
run steady swim.yaml -o json.nc --json --force --set "fish[0].name='a \"fish\"'" --set steady.multipliers=false
check json_of_a_state_without_multipliers python "$root/tests/app/steady_json.py" 0
check json_knows_progress_goes_to_stderr grep -q '^beat ' err

# ---- from another one, and as an axis of a study

run steady swim.yaml -q -o again.nc --from swim.nc --set steady.multipliers=false
check a_search_starts_from_another_one test "$code" = 0
beats() { python "$root/tests/value.py" "$1" steady_beats; }
check and_is_shorter test "$(beats again.nc)" -lt "$(beats swim.nc)"
refused a_run_is_no_start 4 'does not contain a steady state of 1 fish' steady swim.yaml -o no.nc --from run.nc
sed 's/0.1}/0.1}\nsteady: {tolerance: 1e-3, multipliers: false, output_beats: 1}/' swim.yaml >axis.yaml
cat >>axis.yaml <<'end'
sweep:
  - keys: ["fish[*].wave.amplitude", steady.beats]
    values: [[0.4, 99], [0.42, 99], [0.43, 3], [0.44, 99]]
    steady: true
end
run study axis.yaml -q -j 2
check a_member_that_fails_is_no_end_of_the_study test "$code" = 1 -a -e axis-study/member-0003.nc
check members_are_steady_states test "$(beats axis-study/member-0000.nc)" -gt "$(beats axis-study/member-0001.nc)"
check the_next_one_starts_as_the_case_says test "$(beats axis-study/member-0003.nc)" -gt "$(beats axis-study/member-0001.nc)"

# a plate of 2 lengths a beat, whose changes the noise of the integrator must not hide
run steady "$root/cases/heaving_plate.yaml" -q -o heaving.nc --set steady.beats=40 --set steady.multipliers=false
check the_shipped_plate_finds_its_speed_within_40_beats test "$code" = 0

# ---- without a beat: an equilibrium

cat >plate.yaml <<'end'
format: 1
time: {end: 1, shedding_interval: 0.02}
fluid: {density: 1, velocity: [1, 0], viscosity: 0}
fish:
  - {name: plate, force: pressure, pressure: {span: infinite}, wave: {amplitude: 0, frequency: 0},
     body: {profile: uniform, thickness: 0.05, depth: 1, density: 25, modulus: 8e4},
     start: {heading: 174, speed: 0}, motion: {prescribed: head}}
end
run steady plate.yaml
check an_equilibrium_is_found test "$code" = 0 -a "$(grep -cE "error|warning" err)" = 0
check and_said grep -q 'equilibrium: forces are in balance to [0-9.]*e-1' out
check whether_it_diverges grep -qE 'static stiffness over that at rest: 1\.[0-9]*: does not diverge' out
check what_has_no_meaning_is_not_shown test -z "$(grep -E 'muscle|Strouhal|turn' out)"
check the_file_of_an_equilibrium python "$root/tests/app/equilibrium_file.py"
run steady plate.yaml -q -o other.nc --force --from plate.nc --set 'fluid.velocity=[1.1,0]'
check an_equilibrium_starts_from_another test "$code" = 0
sed '/^fish:/i sweep: [{key: fluid.velocity, values: [[0.5, 0], [1, 0], [2, 0]], steady: true}]' plate.yaml >grow.yaml
run study grow.yaml -q -j 2
check an_axis_can_be_the_stream test "$code" = 0
check an_equilibrium_does_not_depend_on_its_start python "$root/tests/app/equilibrium_starts.py"
refused nothing_holds_it 2 'neither beats nor is held' steady plate.yaml -q -o none.nc \
    --set fish[0].motion.prescribed=none
refused a_load_that_crushes_it 1 'the branch from rest ends at 0' steady plate.yaml -q -o crushed.nc \
    --set 'fish[0].load.tip=[-1e4, 0]'
run info crushed.nc
check the_file_says_where_the_branch_ends has out 'failed: no equilibrium in this stream'

# ---- bodies that touch

cat >touch.yaml <<'end'
format: 1
time: {end: 1, shedding_interval: 0.05, output_interval: 0.1}
contact: {action: warn}
steady: {tolerance: 1e-2}
fluid: {velocity: [1, 0]}
defaults: {fish: {force: reactive, nodes: 7, sheet_points: 17, body: {thickness: 0.2}, wave: {amplitude: 0}, motion: {prescribed: all, speed: 0, heave: 0.05, frequency: 1}}}
fish: [{name: upper, start: {position: [0, 0.16]}}, {name: lower, start: {position: [0, -0.16]}, motion: {phase: 180}}]
end
run steady touch.yaml -q --strict
check bodies_that_touch_are_warned_of_as_in_a_run test "$code" = 3
check with_their_names has err 'the bodies of upper and lower touch or cross at t ='
python "$root/tests/value.py" touch.nc warnings >said
check in_the_file_too has said 'upper and lower touch'

# ---- a shallow fish without cross-flow drag is unstable in yaw

run steady swim.yaml -q -o shallow.nc --force --set time.shedding_interval=0.1 --set wake.lifetime=1 --set steady.tolerance=1e-3 \
    --set 'fish[0]={nodes: 9, sheet_points: 51, force: pressure, body: {thickness: 0.2, depth: 0.1, modulus: 1e6}, drag: {normal: 0}, start: {speed: 0.4, heading: 170}}'
check an_unstable_state_is_warned_of grep -qE 'state is unstable: a disturbance grows by the factor 1[.](0[5-9]|1)' err
check and_so_is_a_circle grep -q 'swims in a circle: it turns by 0.[5-9][0-9]* degrees a beat (limit 0.5)' err
mapfile -t said < <(python "$root/tests/value.py" shallow.nc warnings)
check the_file_says_so eval '((${#said[@]} == 3)) && [[ ${said[0]} == *"is unstable"* && ${said[1]} == *"in a circle"* &&
    ${said[2]} == *"10 events"* ]]'
run steady swim.yaml -q -o turning.nc --set 'fish[0].control.bias=0.1' --set 'fish[0].nodes=9' --set time.shedding_interval=0.1 \
    --set steady.multipliers=false
check a_circle_is_no_surprise_with_a_bias eval '! grep circle err && [[ $(ncdump -v steady_turn turning.nc) == *"steady_turn = -"[1-9]* ]]'
run steady swim.yaml -q -o deep.nc --force --set time.shedding_interval=0.1 --set wake.lifetime=1 --set steady.tolerance=1e-3 \
    --set 'fish[0]={nodes: 9, sheet_points: 25, force: pressure, body: {thickness: 0.2, depth: 0.3, modulus: 1e6}, drag: {normal: 0}, start: {speed: 0.7}}'
check a_stable_state_is_not test "$code" = 0 -a "$(grep -cE 'unstable|circle' err)" = 0

# ---- less than the errors of the integrator

run steady swim.yaml -q -o least.nc --set "fish[0].nodes=5" --set steady.tolerance=1e-8 --set steady.beats=1000 --set time.shedding_interval=0.1 \
    --set "wake={lifetime: 3 beats, decay: 2.25 beats}"
check what_the_rows_do_not_keep_is_warned_of test "$code" = 0
check with_the_remedy grep -q 'more than steady.tolerance, 1e-08: .* lower solver.rtol$' err

# ---- no steady state

refused too_few_beats 1 'no steady state in 4 beats (steady.beats)' steady swim.yaml -q -o few.nc --set steady.beats=4
run info few.nc
check the_file_says_why has out 'failed: no steady state in 4 beats'
refused a_beat_without_whole_events 2 'set time.shedding_interval to 0.0495' \
    steady swim.yaml -o none.nc --set fish[0].wave.frequency=1.01
check leaves_no_file test ! -e none.nc
refused a_gust_that_travels 2 'a gust that travels past the fish has no steady state' steady swim.yaml -o none.nc \
    --set fish[0].force=published --set 'fluid.gust={profile: sine, amplitude: 0.1, wavelength: 1, speed: 1}'
printf '%s\n' 'format: 1' 'time: {end: 1}' 'fluid: {velocity: [1, 0]}' 'defaults: {fish: {nodes: 9, sheet_points: 33,' \
    '  wave: {frequency: 0}, motion: {prescribed: head, speed: 0}}}' 'fish: [{}, {start: {position: [9e5, 1]}}]' >far.yaml
refused fish_too_far_apart_for_a_wake_to_infinity 2 'a steady wake has at most 100000' steady far.yaml -q -o none.nc
refused a_sweep_is_a_study 2 'shoal study' steady swim.yaml --set 'sweep=[{key: solver.rtol, values: [1e-4]}]'
refused a_case_is_needed 2 'CASE is missing' steady
run_until TERM "has err 'beat '" steady swim.yaml -o stopped.nc --set steady.tolerance=1e-12 --set steady.beats=100000 \
    --set time.shedding_interval=0.01
check a_signal_stops_it test "$code" = 75
check and_it_says_so has err 'stopped by a signal in beat'

finish

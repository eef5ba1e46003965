#!/usr/bin/env bash
# shoal steady --threshold finds where the stability changes, keeps what it finds on disk, and says why it finds nothing.
#
#   tests/app/test_threshold_command.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"
start_python

key='fish[*].body.modulus'
cat >flag.yaml <<'end'
format: 1
time: {end: 1, shedding_interval: 0.05, output_interval: 0.1}
fluid: {density: 1, velocity: [1, 0], viscosity: 0}
wake: {lifetime: 10}
fish:
  - name: flag
    nodes: 9
    sheet_points: 17
    force: pressure
    pressure: {span: infinite}
    start: {speed: 0, heading: 180}
    wave: {amplitude: 0, frequency: 0}
    body: {profile: uniform, thickness: 0.02, depth: 1, density: 63.662, modulus: 39788}
    motion: {prescribed: head}
end

# a rigid plate that heaves beside a wall, which it meets if it heaves too far
cat >plate.yaml <<'end'
format: 1
time: {end: 2, shedding_interval: 0.05, output_interval: 0.1}
fluid: {density: 1, viscosity: 2e-3, walls: [-0.4]}
wake: {lifetime: 2}
steady: {tolerance: 1e-3}
fish:
  - name: plate
    nodes: 5
    sheet_points: 13
    force: pressure
    pressure: {span: infinite, suction_limit: 0}
    drag: {skin: laminar}
    start: {speed: 3.8}
    wave: {amplitude: 0, frequency: 0}
    body: {profile: uniform, thickness: 0.05, depth: 1, density: 20, modulus: 1e6}
    motion: {prescribed: all, surge: free, heave: 0.15, frequency: 1}
end

# ---- the threshold is where the growth changes its sign

run steady flag.yaml --threshold "$key=40000:120000" --json -o flag
check a_threshold_is_found test "$code" = 0
cp out flag.json
check every_state_is_reported test "$(grep -c '^fish.*body.modulus = .*growth' err)" = "$(grep -c '"value"' flag.json)"
check the_file_has_every_point python "$root/tests/app/threshold_file.py" study
read -r below above < <(python "$root/tests/app/threshold_file.py" ends)
run steady flag.yaml -q --json -o below.nc --set "$key=$below"
check it_is_unstable_below grep -qE '"steady_growth": [0-9]' out
run steady flag.yaml -q --json -o above.nc --set "$key=$above"
check it_is_stable_above grep -qE '"steady_growth": -[0-9]' out

# ---- with a beat: a course control with too much gain oscillates, and runs decay and grow on the two sides

cat >course.yaml <<'end'
format: 1
time: {end: 60, shedding_interval: 0.05, output_interval: 0.1}
steady: {tolerance: 1e-4}
fish:
  - {name: a fish, force: reactive, nodes: 17, sheet_points: 17, start: {heading: 3},
     control: {law: course, desired_heading: 0}}
end
run steady course.yaml --threshold 'fish[*].control.gain=3:5' --json -o course -q
cp out course.json
for gain in 3.4 3.6; do run run course.yaml -q -o "run$gain.nc" --set "fish[*].control.gain=$gain"; done
check runs_decay_and_grow_on_the_two_sides python "$root/tests/app/threshold_runs.py"

# ---- a result is kept, and what cannot be found leaves what was found before

run steady flag.yaml --threshold time.shedding_interval=0.01:0.05 -o interval -q
check what_was_found_follows_the_errors_of_a_case grep -q '^1 steady state was found, at time.shedding_interval = 0.01 with the growth ' err

refused another_result_is_kept 4 'flag/study.nc exists: replace it with --force' \
    steady flag.yaml --threshold "$key=50000:120000" -o flag
run steady flag.yaml --threshold "$key=50000:120000" -o flag -q --force
check force_replaces_it test "$code" = 0
refused stable_at_both_ends 1 'no threshold between the ends: the state is stable at both; ' \
    steady flag.yaml --threshold "$key=110000:120000" -o both -q
check its_message_says_how_far_it_came grep -qE 'up to .* = 120000 with the growth -.* s-1: both/study.nc$' err
check and_the_file_has_the_states test -s both/study.nc -a -s both/state-001.nc
refused no_effect 1 'the key has no effect' steady flag.yaml --threshold 'solver.rtol=1e-5:1e-6' -o none -q
refused contact_on_the_way 1 'with the largest multiplier 0.' steady plate.yaml --threshold 'fish[*].motion.heave=0.37:0.5' -o way
check its_steps_are_halved test "$(grep -c 'the step is halved' err)" -ge 2
check and_are_in_the_file test -s way/study.nc
run_until INT 'test -s stopped/study.nc' steady plate.yaml --threshold 'fish[*].motion.heave=0.1:0.2' -o stopped
check a_signal_stops_it test "$code" = 75
check its_message_has_the_remedy has err '--from stopped/state-000.nc goes on from the last state'

# ---- wrong use

for way in fish "$key" "$key=1:" "$key=:2" "$key=1" "$key=1:1" "$key=nan:1" "$key=1:inf" "$key=1:2:3" "=1:2"; do
    refused "the_way_is_wrong:$way" 2 'expects KEY=FROM:TO with two different numbers' steady flag.yaml --threshold "$way"
done
refused an_unknown_key 2 '--set fish[*].body.modulos=10000: error: fish[*].body.modulos: unknown key' steady flag.yaml --threshold 'fish[*].body.modulos=1e4:1e5'
refused an_integer 2 'is an integer, which has no values in between' steady flag.yaml --threshold 'fish[*].nodes=7:13'
refused a_word 2 'expects one of' steady flag.yaml --threshold 'fish[*].force=1:2'
refused out_of_range 2 'body.modulus' steady flag.yaml --threshold "$key=-1:2"
refused without_multipliers 2 'set steady.multipliers to true' \
    steady flag.yaml --threshold "$key=1e4:1e5" --set steady.multipliers=false
refused nothing_is_free 2 'nothing in this case can be unstable' \
    steady plate.yaml -q --threshold 'fish[*].motion.heave=0.1:0.2' -o held --set 'fish[*].motion.surge=given'
refused a_trace 2 'leave out --threshold' steady flag.yaml --threshold "$key=1e4:1e5" --trace trace.csv
touch file
refused not_a_folder 4 'choose another folder with -o' steady flag.yaml --threshold "$key=1e4:1e5" -o file

finish

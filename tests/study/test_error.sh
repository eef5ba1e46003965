#!/usr/bin/env bash
# `shoal error` plans its members, prints the budget of an error bar, refines, and gathers the same from the files of
# the members.
#
#   tests/study/test_error.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"
start_python

# ---- an equilibrium: the lift of a foil that bends

cat >foil.yaml <<'end'
format: 1
time: {end: 1, shedding_interval: 0.05}
fluid: {velocity: [1, 0], density: 1, viscosity: 0}
fish:
  - {name: foil, force: pressure, pressure: {span: infinite}, wave: {amplitude: 0, frequency: 0}, start: {heading: 174}, motion: {prescribed: head},
     nodes: 17, body: {profile: uniform, thickness: 0.05, depth: 1, density: 25.465, modulus: 81487}}
end
run error foil.yaml --of steady_lift --plan
check a_plan_ends_with_0 test "$code" = 0
check it_lists_keys_and_levels grep -qE '^fish.nodes +11 \[17\] 24 34 +' out
check it_counts_members_and_states_their_time grep -qE '^[0-9]+ members, \[the case\] among them; about .* with [0-9]+ at once' out
check nothing_is_run test ! -e foil-error
check and_no_folder_is_named grep -qE '^key +levels' <(head -n 1 out)
run error foil.yaml --of steady_lift --of steady_deflection
check errors_end_with_0 test "$code" = 0
check the_plan_comes_first grep -qE '^key +levels +members' out
check a_value_has_its_error grep -qE '^steady_lift of foil: [0-9.]+ \+- [0-9.]+ N \([0-9.]+ %\)$' out
check each_key_has_its_share grep -qE '^fish.nodes +11 \[17\] 24 34 +(flagged|[0-9.]+\*?) +[0-9.]+ +[0-9.]+ +[0-9]+ .* 4 levels' out
check the_next_key_is_named grep -qE '<- spend here: [a-z_]+ [0-9]+, (CPU x [0-9.]+, )?(to find an order of )?(lift|deflection)' out
check the_sum_is_the_last_row grep -qE '^sum +[0-9.]+ +[0-9.]+' out
check an_equilibrium_needs_no_interval eval '! grep -q shedding_interval out'
check there_is_a_table_for_other_programs grep -q '^"foil",steady_lift,N,[0-9.]*,sum,' foil-error/error.csv
sed -n '/^steady_lift/,$p' out >table
run gather foil-error
check the_members_are_enough cmp out table
run info foil-error/study.nc
check the_file_of_the_study_is_enough cmp <(sed -n '/^steady_lift/,$p' out) table
before=$(stat -c %y foil-error/member-0001.nc)
run error foil.yaml --of steady_lift --of steady_deflection
check finished_members_are_not_run_again test "$(stat -c %y foil-error/member-0001.nc)" = "$before"
check the_budget_is_the_same cmp <(sed -n '/^steady_lift/,$p' out) table
run error foil.yaml --of steady_lift --of steady_deflection -q
check quiet_prints_nothing test "$code" = 0 -a ! -s out -a ! -s err
refused another_question_is_another_study 4 'is a result of another study' error foil.yaml --of steady_lift

# ---- a folder with fewer members, and with another study

cp -r foil-error fewer
rm fewer/member-0001.nc
refused an_incomplete_folder_names_the_command 1 'members in fewer are not complete; repeat `shoal error` with the same options' \
    gather fewer
run study foil.yaml -q --force -o fewer --set 'sweep=[{key: "fish[*].body.modulus", values: [8e4, 9e4]}]' --set time.end=0.1
check another_study_replaces_the_whole_folder test "$code" = 0 -a "$(cd fewer && echo *)" = \
    'member-0000.nc member-0001.nc study.nc'

# ---- within a bound

run error foil.yaml --of steady_lift --within 1e-4 -o within
sed -i '1,/^steady_lift/{/^steady_lift/!d}' out
check refinement_ends_with_0 test "$code" = 0
check the_error_is_within_the_bound awk '/^steady_lift/ { sub(/.*\(/, ""); exit !($1 <= 0.01) }' out
check the_stated_value_has_moved eval '! grep -qE "^fish.nodes .* \[17\] " out'
check its_cost_is_said grep -q 'the stated value takes .* times the time of the case' out
cp out table
run gather within
check gather_takes_the_same_steps cmp out table
cp -r within warned
python "$root/tests/study/warn.py" warned/member-0000.nc 'too few nodes'
run gather warned --strict
check warnings_of_the_case_are_not_those_of_the_stated_value test "$code" = 0 -a -z "$(grep 'too few nodes' out)"
# member that states the value with one warning, as --strict counts it
stated=$(python "$root/tests/study/stated.py" warned)
python "$root/tests/study/warn.py" "$stated" 'too few nodes'
refused one_warning_of_the_stated_value_is_enough_for_strict 3 '1 warning about the stated value, with --strict' \
    gather warned --strict
run info within/study.nc
check info_takes_them_too cmp <(sed -n '/^steady_lift/,$p' out) table
run error foil.yaml --of steady_lift --within 1e-4 -o within
check the_same_command_runs_nothing cmp <(sed -n '/^steady_lift/,$p' out) table
rm "$(ls within/member-*.nc | tail -n 1)"
run gather within
check steps_without_members_are_not_taken eval '! cmp -s out table && test "$(grep -c missing out)" = 0'
refused what_is_too_dear_gives_exit_code_3 3 'the errors are not within 0.001 % of the values; ' \
    error foil.yaml -q -o dear --set 'error={of: steady_lift, within: 1e-5, most: 1.5}'
check the_budget_is_printed_all_the_same grep -q '^sum ' err
check a_case_can_ask_itself eval 'grep -q "levels: 3 levels" out || test -s dear/study.nc'
run study foil.yaml -o asked --set 'error={of: steady_lift, confirm: false, keys: {nodes: [9, 11]}}'
check study_states_errors_too grep -qE '^fish.nodes +9 11 \[17\] .* 3 levels' out
check only_the_keys_that_are_named eval '! grep -q sheet_points out'
run show foil.yaml --set 'error={of: steady_lift, confirm: false, keys: {nodes: [9, 11]}}'
check show_prints_it grep -qx 'error: {of: \[steady_lift\], confirm: false, keys: {nodes: \[9, 11\]}}' out
run run foil.yaml -q --set 'error={of: steady_lift}' -o single.nc
check a_run_is_one_run test "$code" = 0 -a -s single.nc

# ---- a swimmer: the steady speed, and the final state of a run

cat >swimmer.yaml <<'end'
format: 1
time: {end: 0.5, shedding_interval: 0.05}
steady: {tolerance: 1e-4}
fish: [{name: fish, force: reactive, nodes: 9, sheet_points: 17, body: {profile: uniform, modulus: 1e7, thickness: 0.1}}]
error: {of: [steady_speed, steady_cost_of_transport], keys: [nodes, shedding_interval, rtol, smoothing]}
end
run study swimmer.yaml -j 2
check a_steady_speed_has_its_error grep -qE '^steady_speed of fish: [0-9.]+ \+- [0-9.]+ m s-1 \([0-9.]+ %\)$' out
check choices_are_listed_apart grep -qE '^choices, not in the sum: wake.smoothing \(\[0\.1\] 0\.05\) ' out
check the_noise_is_stated grep -qE '^noise of a value, of integrator and search: ' out
check only_the_case_has_multipliers test "$(ncdump -v steady_error swimmer-study/study.nc | sed -n '/^data/,$p' | tr -d ' \n;}' |
    sed 's/.*=//' | tr , '\n' | grep -c '^[0-9]')" = 1
# each search waits for the one that it starts from, and takes 7 to 9 beats instead of 12
for file in swimmer-study/member-*.nc; do python "$root/tests/value.py" "$file" steady_beats; done >beats
check every_search_starts_from_another_state eval 'read -r first <beats &&
    test "$(tail -n +2 beats | sort -n | tail -n 1)" -lt "$first"'
run error swimmer.yaml -j 2 -o multiplier \
    --set 'error={of: steady_multiplier, confirm: false, keys: [nodes, rtol]}'
check a_multiplier_has_its_error_and_a_verdict grep -qE '^steady_multiplier: 0[.][0-9]+ [+]- 0[.]0[0-9]+ [(][0-9.]+ %[)]: stable' out
run error swimmer.yaml --of speed --models -j 2 -o models --set 'fish[*].sheet_points=33'
check other_models_have_a_second_line grep -qE '^other models: from [0-9.]+ m s-1 \([a-z_.]+ [a-z0-9.+]+\) to [0-9.]+ m s-1 \(' out
check each_choice_is_listed grep -qE '^choices.*fish.force \(pressure \[reactive\]\) [0-9.]+ %; fish.drag.normal \(2 \[1\] 0\)' out
check the_table_has_the_range test "$(grep -cE ',(lowest|highest),[a-z_.]+ [a-z0-9.+]+,nan,' models/error.csv)" = 2
check so_has_the_file test "$(ncdump -v lowest_speed models/study.nc | sed -n 's/^ lowest_speed = \(.*\) ;/\1/p' | cut -c 1-6)" = \
    "$(sed -n 's/^"fish",speed,m s-1,\([0-9.]*\),lowest.*/\1/p' models/error.csv | cut -c 1-6)"
refused strict_counts_warnings 3 '1 warning about the stated value, with --strict' error swimmer.yaml --of speed --no-confirm --strict
refused and_quietly 3 '1 warning about the stated value, with --strict' error swimmer.yaml --of speed --no-confirm --strict -q
run error swimmer.yaml --of speed --no-confirm
check a_run_has_its_error grep -qE '^speed of fish: [0-9.]+ \+- [0-9.]+ m s-1' out
check levels_are_fewer_without_confirm grep -qE '^fish.nodes +5 6 \[9\] .* 3 levels' out
run error swimmer.yaml --of speed --no-confirm -o few --sweep solver.order=3,5 --set 'expect=[{of: speed, least: 0}]'
check a_sweep_may_have_expectations_and_fewer_points_than_keys eval 'test "$code-$(grep -cE "^ +[01] +[35] |^  met  " out)" = 0-3'
run error swimmer.yaml --of speed --no-confirm -o numerical --sweep time.shedding_interval=0.025,0.05 --sweep time.end=0.5,1
check a_swept_numerical_key_is_named_as_missing_from_the_errors grep -qx \
    'time.shedding_interval is swept: the errors do not include it' out
check a_swept_key_may_be_one_that_the_levels_set test "$code" = 0 -a -s numerical/study.nc -a -s numerical/error.csv

sed '/^error/d' swimmer.yaml >soft.yaml

# ---- comparisons: with another case, along a sweep, with another fish

sed '/^error/d; s/name: fish/name: stiff/; s/modulus: 1e7/modulus: 2e7/' swimmer.yaml >stiff.yaml
run error stiff.yaml --of speed --against soft.yaml --models -o compared
check a_comparison_ends_with_0 test "$code" = 0
check the_ratio_comes_first eval "sed -n '/ members, .the case. among/{n;p}' out |
    grep -qE '^speed of stiff over that of soft: [0-9.]+ \+- [0-9.]+ \([+-][0-9.]+ \+- [0-9.]+ %\)\$'"
check so_does_its_range grep -qE '^other models: from [+-][0-9.e-]+ % \([a-z_.]+ [a-z0-9.+]+\) to [+-]' out
check the_difference_has_a_unit grep -qE '^difference: -?[0-9.]+ \+- [0-9.]+ m s-1$' out
check both_values_follow eval 'grep -qE "^speed of soft: [0-9.]+ \+- " out && grep -qE "^speed of stiff: [0-9.]+ \+- " out'
sed -n '/over that of/,$p' out >table
run gather compared
check gather_needs_the_members_only cmp out table
run info compared/study.nc
check the_file_is_enough_for_the_comparison cmp <(sed -n '/over that of/,$p' out) <(grep -v '^member .* warning: ' table)
check the_ratio_of_the_file_is_that_of_the_members python "$root/tests/study/compared.py"
run error soft.yaml --of speed --no-confirm -o from_first --sweep 'fish[*].body.modulus=1e7,2e7' --against first
check along_a_sweep_ratios_have_a_table eval "grep -qx 'Ratios to point 0:' out && grep -qx 'Differences from point 0:' out"
one=$(python "$root/tests/value.py" compared/study.nc stated_ratio_speed)
check the_ratio_along_a_sweep_is_that_of_the_cases test "$(python "$root/tests/value.py" from_first/study.nc stated_ratio_speed)" = \
    "1.0 $one"
refused a_case_or_a_point_or_a_fish 2 '--against 2e7: expects the file of a case, FISH=FISH' error soft.yaml --of speed --against 2e7
refused no_such_point 2 'error.against: 3e7 is neither `first` nor a value of fish[*].body.modulus' \
    error soft.yaml --of speed --sweep 'fish[*].body.modulus=1e7,2e7' --against 3e7
refused no_such_case 4 'none.yaml: error: the case file cannot be read' error soft.yaml --of speed --against none.yaml
printf 'format: 1\ntime: {end: 1}\nfish: [{nodes: 2}]\n' >wrong.yaml
refused a_wrong_case_has_a_place 2 'wrong.yaml:3:16: error: fish[0].nodes: must be' error soft.yaml --of speed --against wrong.yaml
{ cat soft.yaml; echo 'sweep: [{key: solver.order, values: [2, 3]}]'; } >swept.yaml
refused one_case_not_a_sweep 2 'swept.yaml has a sweep: name one case' error soft.yaml --of speed --against swept.yaml
mkdir parts
run study swimmer.yaml --members 0-1 -o parts
check a_part_of_the_members test -e parts/member-0001.nc -a ! -e parts/member-0002.nc -a ! -e parts/study.nc
check scripts_of_slurm "$program" study swimmer.yaml --slurm -o cluster
check they_run_all_members has cluster/array.sbatch "--array=0-$(($(ls swimmer-study/member-*.nc | wc -l) - 1))"

# a member that fails leaves the sum unknown
run study swimmer.yaml -o failing --set steady.beats=4 --set 'error={of: steady_speed, keys: [nodes]}'
check members_that_fail_are_reported_once eval 'grep -qE "^[0-9]+ members \(0-[-0-9, ]+\): failed: no steady state in 4 beats" out &&
    test "$(grep -c "no steady state in 4 beats" out)" = 1'
check then_the_error_is_unknown eval 'test "$code" != 0 && grep -qE "^sum +unknown" out'

# ---- sensitivities: dimensional analysis knows sums of them

# the shape in a stream without viscosity depends on modulus over density times the square of the speed; the lift is also
# proportional to the density and, with the length, to its square
run error foil.yaml --of steady_lift --sensitivity=modulus,fluid.density,length -o lift
check sensitivities_end_with_0 test "$code" = 0
check a_number_has_its_steps_and_its_error grep -qE '^fish.body.modulus +8.149e\+04 Pa +\+-4, 8 % +\+0\.[0-9]+ +0\.0*[0-9]+ *$' out
check no_numerical_key_is_varied eval '! grep -q "fish.nodes" out'
check the_value_has_no_error_bar grep -qE '^steady_lift of foil: [0-9.]+ N$' out
check density_and_modulus_make_1 python "$root/tests/study/sums.py" lift steady_lift 1 fish.body.modulus=1 fluid.density=1
check length_makes_2 python "$root/tests/study/sums.py" lift steady_lift 2 fish.length=1
# the plan measures members before it forks them: with threads of its own they would wait for these forever
timeout -s KILL 100 "$program" error swimmer.yaml --of steady_speed --sensitivity=modulus -o threaded --set error=none --set solver.threads=2 >/dev/null 2>&1
check members_with_threads_run_after_their_estimate test "$?" = 0
# the reactive swimmer has no viscosity: times scale with the beat, also the interval that it is tied to
run error swimmer.yaml --of steady_speed --of steady_cost_of_transport --sensitivity=wave.frequency,modulus,length,suction \
    -o swims --set error=none
check what_has_no_effect_is_refused has err 'error.sensitivity: fish.pressure.suction changes nothing in this case'
run error swimmer.yaml --of steady_speed --of steady_cost_of_transport --sensitivity=wave.frequency,modulus,length -o swims \
    --set error=none -j 2
check times_make_the_speed python "$root/tests/study/sums.py" swims steady_speed 1 fish.wave.frequency=1 fish.body.modulus=2
check times_make_the_cost python "$root/tests/study/sums.py" swims steady_cost_of_transport 2 fish.wave.frequency=1 fish.body.modulus=2
check lengths_make_the_speed python "$root/tests/study/sums.py" swims steady_speed 1 fish.length=1 fish.body.modulus=2
sed -n '/^steady_speed/,$p' out >table
# a search that starts from the whole state of a neighbour has no wake to grow: from speeds and places it takes 8 to 15 beats
beats() { run info "$1" && sed -n 's/.*steady state after \([0-9]*\) beats.*/\1/p' out; }
are_short() {
    for member in swims/member-*.nc; do
        test "$member" = swims/member-0000.nc || test "$(beats "$member")" -le 6 || return 1
    done
}
check searches_from_whole_states_are_short are_short
run gather swims
check gather_has_the_sensitivities cmp out table
run info swims/study.nc
check info_has_them_too cmp <(sed -n "/^steady_speed/,\$p" out) <(grep -v "^member .* warning: " table)
# a number at its bound, of a fish that does not beat with it
run error foil.yaml --of steady_lift --sensitivity=suction -o bound
check a_bound_has_steps_on_one_side grep -qE '^fish.pressure.suction +1 +-4, 8, 16 % ' out
# uncertain numbers of the case: linear, in quadrature with each other and the rest
run error foil.yaml --of steady_lift -o uncertain --uncertain modulus=10% --uncertain fluid.density=0.05 --set 'error={of: steady_lift, keys: [nodes]}'
check an_uncertain_number_is_in_the_table grep -qE '^fish.body.modulus +8.149e\+04 \+- 10 % +[0-9.]+ +input +' out
check errors_add_in_quadrature python "$root/tests/study/quadrature.py"
touch taken-error
refused a_file_is_no_folder 4 'shoal: error: taken-error: cannot create this folder' error foil.yaml --of steady_lift -o taken-error
refused no_state_to_start_from 4 '--from none.nc: cannot be read' error swimmer.yaml --of steady_speed --from none.nc -o none
refused a_run_has_no_search 2 '--from table: starts a search' error swimmer.yaml --of speed --from table -o none
run error swimmer.yaml --of steady_speed --of steady_cost_of_transport --sensitivity=wave.frequency,modulus,length -o serial \
    --set error=none -j 1
check the_number_of_processes_changes_nothing cmp swims/error.csv serial/error.csv
rm serial/member-0000.state serial/member-0001.nc
run error swimmer.yaml --of steady_speed --of steady_cost_of_transport --sensitivity=wave.frequency,modulus,length -o serial \
    --set error=none -j 1
check without_the_state_a_search_starts_from_speeds_and_places eval 'test "$code" = 0 && test "$(beats serial/member-0001.nc)" -gt 6'
run error swimmer.yaml --of steady_speed --sensitivity=modulus --from swims/member-0000.nc --set error=none -o again
check a_start_changes_no_more_than_the_errors python "$root/tests/study/started.py"
# numbers of one fish: the changes by those of each fish add to that by those of all
cat >two.yaml <<'end'
format: 1
time: {end: 2, shedding_interval: 0.05}
defaults: {fish: {force: reactive, nodes: 9, sheet_points: 17, start: {speed: 0.7}}}
fish: [{name: one}, {name: two, start: {position: [1.2, 0.1]}, wave: {amplitude: 0.35}}]
end
run error two.yaml --of cost_of_transport --sensitivity='wave.amplitude,fish[one].wave.amplitude,fish[1].wave.amplitude' -o apart
for fish in one two; do
    check "the_fish_of_a_school_add_up_for_$fish" python "$root/tests/study/sums.py" apart "$fish/cost_of_transport" 0 \
        fish.wave.amplitude=1 'fish[one].wave.amplitude=-1' 'fish[two].wave.amplitude=-1'
done
check a_fish_keeps_its_own_value eval 'grep -q "^fish\[two\].wave.amplitude  *0.35 rad " out'
refused one_frequency_of_a_beat 2 'fish[two].wave.frequency: a steady state needs one frequency: vary that of all fish' \
    error two.yaml --of steady_speed '--sensitivity=fish[two].wave.frequency' --set steady.formation=true
refused the_same_fish_twice 2 "'fish[two].body.modulus' is there twice" \
    error two.yaml --of speed '--sensitivity=fish[1].modulus,fish[two].body.modulus'
refused no_such_number 2 "error.sensitivity: 'nodes' is no such number; these are: length, " error foil.yaml --of steady_lift --sensitivity=nodes
refused no_such_fish 2 "'fish[1].length': there is no such fish" error foil.yaml --of steady_lift '--sensitivity=fish[1].length'
refused several_keys_end_so 2 "'smoothing' is the end of several keys: wake.smoothing and sheet.smoothing" error foil.yaml --of steady_lift --sensitivity=smoothing
refused part_of_nothing 2 'fish.wave.amplitude is 0 or not given' error foil.yaml --of steady_lift --sensitivity=amplitude
refused one_or_the_other 2 'sensitivity gives no error bar: remove one' error foil.yaml --of steady_lift --sensitivity --uncertain modulus=5%
refused no_part 2 '--uncertain modulus=-5%: expects KEY=PART' error foil.yaml --of steady_lift --uncertain modulus=-5%
refused twice 2 "the key 'modulus' is here twice" error foil.yaml --of steady_lift --uncertain modulus=5% --uncertain modulus=4%

# ---- wrong input

refused no_quantity 2 'has no `error`: give --of QUANTITY' error foil.yaml
refused half_a_node 2 "error.keys: levels of 'fish.nodes' are integers" \
    study foil.yaml --set 'error={of: steady_lift, keys: {nodes: [4.5, 5, 6, 9]}}'
refused too_many_levels 2 "error.keys: more than 9 levels of 'fish.nodes'" \
    study foil.yaml --set 'error={of: steady_lift, keys: {nodes: [5, 6, 7, 8, 9, 10, 11, 12, 13, 14]}}'
refused an_unknown_quantity 2 "error.of: 'lift' is no number of a result" error foil.yaml --of lift
# shellcheck disable=SC2046 # words
refused seventeen_quantities 2 'error.of: more than 16 quantities' error foil.yaml --plan $(printf -- '--of %s ' \
    speed heading mean_heading shed_circulation cost_of_transport mean_actuation_power strouhal lateral_drift efficiency \
    towed_efficiency mean_thrust mean_power energy_balance steps newton_iterations residual_evaluations time)
refused two_kinds 2 'speed is of a run and steady_lift of a steady state' error foil.yaml --of steady_lift --of speed
refused a_bound_of_words 2 '--within few: expects a number above 0' error foil.yaml --of steady_lift --within few
for pair in '--plan --members 0' '--slurm --members 0' '--plan --slurm'; do
    # shellcheck disable=SC2086 # options
    refused "$pair" 2 'exclude each other' study swimmer.yaml $pair -o planned
done
refused a_bundle_without_slurm 2 '--bundle 2: members of a task of Slurm: add --slurm' study swimmer.yaml --bundle 2
refused a_plan_of_a_sweep 2 '--plan: the case has no `error`' study foil.yaml --plan --set 'sweep=[]'
refused a_bound_with_a_sweep 2 'error.within: refines one case' study foil.yaml \
    --set 'sweep=[{key: solver.rtol, values: [1e-4, 1e-5]}]' --set 'error={of: steady_lift, within: 0.1}'
refused a_refined_axis_with_errors 2 'error: replaces the refined axis sweep[0]' study foil.yaml \
    --set 'sweep=[{key: solver.rtol, values: [1e-3, 1e-4, 1e-5], refine: true}]' --set 'error={of: steady_lift}'
run check swimmer.yaml
check check_takes_it test "$code" = 0

# ---- a sweep: an error at every point

run error foil.yaml -o along --of steady_lift --models --sweep 'fish[*].body.modulus=1e5,3e5,1e6,3e6' --set 'fish[*].nodes=5'
check errors_along_a_sweep test "$code" = 0
check a_row_for_each_point test "$(grep -cE '^ +[0-3]\*? +[13]e[56] +[0-9.]+ +[0-9.]+ +[0-9.]+' out)" = 4
check the_models_of_full_points_are_around_the_value test "$(awk '$7 == "to" && $1 ~ /^[013]$/ &&
    $6 < $8 && $6 < 1.001 * $3 && $3 < 1.001 * $8' out | wc -l)-$(grep -c ' to [0-9]' out)" = 3-3
check points_between_share_errors grep -q '^  *2\*  *1e6 ' out
check ends_and_middle_have_all_keys grep -q '^   *1  *3e5 ' out
check the_shares_of_all_points test "$(grep -c 'steady_lift,N,.*,sum,.*,[13]e[56]$' along/error.csv)" = 4
run info along/study.nc
check info_has_the_points test "$(grep -cE '^ +[0-3]\*? +[13]e[56] ' out)" = 4
run gather along
check gather_has_the_points test "$(grep -cE '^ +[0-3]\*? +[13]e[56] ' out)" = 4
refused a_sweep_without_values 2 '--sweep nodes: expects KEY=VALUE,VALUE' error foil.yaml --of steady_lift --sweep nodes
run error foil.yaml --of steady_lift --plan --sweep 'fish[*].start.position=[0, 0],[0, 1]'
check a_value_of_a_sweep_may_be_a_point grep -q '^1 .*sheet_points' out

# five fish at four points: a table shows four of them; expectations choose points by the keys of both axes

cat >five.yaml <<'end'
format: 1
time: {end: 0.1, shedding_interval: 0.05, output_interval: 0.05}
fluid: {density: 0}
defaults: {fish: {nodes: 7, motion: {prescribed: all, speed: 1}, wave: {amplitude: 0.3}}}
fish: [{name: a}, {name: b, start: {position: [0, 2]}}, {name: c, start: {position: [0, 4]}},
       {name: d, start: {position: [0, 6]}}, {name: 'e "5", last', start: {position: [0, 8]}}]
sweep: [{key: "fish[*].motion.speed", values: [1, 2]}, {key: "fish[*].wave.frequency", values: [1, 2]}]
expect:
  - {of: speed, where: ["fish[*].wave.frequency=2"], most: 1.9}
  - {of: speed, fish: 'e "5", last', where: ["fish[*].motion.speed=2", "fish[*].wave.frequency=1"], least: 1.999}
error: {of: [speed, steps], confirm: false, keys: {nodes: [9, 13], rtol: [1e-4, 1e-5]}}
end
# more processes than members: the time of the longest, of which the table prints two digits
run error five.yaml --plan -j 64 --set time.end=100 --set 'sweep=[]' --set 'expect=[]'
check members_at_once_take_the_time_of_the_longest awk '/^(fish|solver)/ { for (i = NF - 2; i <= NF; i++) if ($i > most) most = $i }
    /^together/ && $NF > most { most = $NF }
    / at once/ { ok = $13 == most && $14 == "s" && $16 == 64 } END { exit !ok }' out
run study five.yaml -q -o five
check a_missed_expectation_at_points_gives_exit_code_3 test "$code" = 3
check a_single_one_has_no_others has err "expect[0]: speed: expectation not met: see the output"
run gather five
check each_row_has_values_of_its_point test "$(awk '$1 ~ /^[0-3]$/ && $5 == $2 && $2 == int($1 / 2) + 1 &&
    $3 == $1 % 2 + 1 && $4 ~ /^[a-d]$/ && $6 < 1e-4 && $7 < 1e-2 && $8 > 3 && $NF == "rtol"' out | wc -l)" = 16
check the_other_fish_are_in_the_files has out 'The first 4 of 5 fish; error.csv and study.nc have all.'
check a_point_of_one_key_is_found eval 'has out "speed, 10 values" && has out "MISSED   the largest is 2, expected at most 1.9"'
check a_point_of_two_keys_is_found eval 'has out "speed of e \"5\", last, 1 value" && has out "met      the smallest is 2"'
run study five.yaml -o tabled --set error=none
check a_study_shows_four_fish_too eval 'has out "The first 4 of 5 fish; study.nc has all." && grep -qE "^ +3 +2 +2 +d " out'
# with given thicknesses no other number of nodes is a case
run error five.yaml -o one --of speed --of steps --set 'sweep=[]' --set 'expect=[]' --set 'error={of: speed, keys: [nodes, rtol]}' --set \
    'fish[*].body={profile: table, thickness_table: [.1, .1, .1, .1, .1, .1], depth_table: [.2, .2, .2, .2, .2, .2]}'
check a_key_without_a_level_is_not_varied grep -qE '^fish.nodes +\[7\] +not varied +not varied$' out
check the_reason_is_said has out "not varied: fish.nodes: no other level is a valid case: fish[0].body.thickness_table: 'profile: table' needs pairs"
check the_headline_says_what_is_missing grep -qE '^speed of a: .*%\), without nodes$' out
check the_table_has_a_row_for_it grep -qE '^"a",speed,.*,fish.nodes,\[7\],nan,nan,nan,"not varied: no other' one/error.csv
check so_does_one_case has out 'The first 4 of 5 fish; error.csv and study.nc have all.'
check a_number_of_the_run_is_not_of_a_fish test "$(grep -c '^steps: ' out)-$(grep -c '^speed of ' out)" = 1-4

# ---- the two tables of a study

for study in foil-error swimmer-study models along five one few; do
    check "error.csv and study.nc say the same: $study" python "$root/tests/study/budget.py" "$study"
done

finish

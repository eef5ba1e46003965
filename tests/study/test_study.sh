#!/usr/bin/env bash
# A study runs its members, skips those that are finished and repeats those that are not, also after a crash.
#
#   tests/study/test_study.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

article=$root/cases/include/article.yaml

# The time of the last change of a file, with all digits.
changed() {
    stat -c %y "$1"
}

# ---- a search for a steady state needs beats of whole events

cat >beats.yaml <<'end'
format: 1
time: {end: 1, shedding_interval: 0.05}
fish: [{force: reactive, nodes: 9}]
sweep: [{key: "fish[*].wave.frequency", values: [1, 1.1, 2, 1.3], steady: true}]
end
run check beats.yaml
check members_without_a_steady_state_are_found_before_a_run eval 'test "$code" = 2 &&
    has err "beats: 2 of 4 members cannot run; member 1 (fish[*].wave.frequency=1.1): a beat of 0.9090909091 s has 18.1818 events"'
run study beats.yaml
check a_study_of_them_starts_none eval 'test "$code" = 2 -a ! -e beats-study && has err "beats: 2 of 4 members cannot run"'
run check beats.yaml --set 'sweep=[{key: "fish[*].wave.frequency", values: [1, 2], steady: true}]'
check all_others_can_run test "$code" = 0
refused fish_that_part_are_found_before_a_run 2 '2 of 2 fish swim at independent speeds' study beats.yaml \
    --set 'sweep=[{key: "fish[*].wave.frequency", values: [1, 2], steady: true}]' \
    --set 'fish=[{force: reactive, nodes: 9}, {force: reactive, nodes: 9, start: {position: [0, 3]}}]'
check and_no_member_starts test ! -e beats-study

# ---- members whose times do not fit are counted, and the first of them is named

cat >times.yaml <<'end'
format: 1
time: {end: 2, shedding_interval: 0.02}
fish: [{force: reactive, nodes: 9}]
sweep:
  - {key: time.shedding_interval, values: [0.02, 0.04, 0.05]}
  - {key: time.end, values: [2, 1.1, 1.06, 1.02]}
end
for command in check study "error --of speed"; do
    # shellcheck disable=SC2086
    run $command times.yaml
    check "members_with_wrong_times_are_counted_by_${command%% *}" eval 'test "$code" = 2 &&
        has err "times: 5 of 12 members cannot run; member 5 (time.shedding_interval=0.04, time.end=1.1):" &&
        has err "error: time.end: 1.1 s is not an integer multiple of time.shedding_interval, 0.04 s" &&
        ! has err "member 6"'
done

# ---- a study from begin to end

cat >swimmer.yaml <<'end'
format: 1
time: {end: 0.2, shedding_interval: 0.02}
fish: [{force: reactive, nodes: 9, body: {relaxation_time: 0.001}}]
sweep:
  - {key: "fish[*].wave.amplitude", values: [0.2, 0.3]}
  - {keys: [solver.method, solver.max_steps], values: [[ida, 1000], [rk4, 1000], [euler, 2]]}
end
run study swimmer.yaml -j 2
check failed_members_give_exit_code_1 test "$code" = 1
check failures_are_counted has err '2 of 6 members in swimmer-study are not complete'
check the_reason_is_printed_once eval 'grep -q "^2 members (2, 5) failed: limited by solver.max_steps at t = " out &&
    test "$(grep -c "failed: limited" out)" = 1'
check the_reason_is_kept has swimmer-study/member-0002.failed 'limited by solver.max_steps at t = '
check members_are_numbered_from_0 test -e swimmer-study/member-0000.nc -a -e swimmer-study/member-0005.nc -a \
    ! -e swimmer-study/member-0006.nc
check progress_counts_members has err '4 of 6 members done  100 %  0 s left  2 failed  0 running'
check quantities_of_steady_states_are_not_in_the_table_of_runs eval '! grep -q growth out'
check a_line_per_member test "$(grep -cE '^ +[0-5] +0\.[23] ' out)" = 6
check results_are_gathered test -s swimmer-study/study.nc
run study "$root/cases/demo.yaml" -o one --set time.end=10 --set 'sweep=[{key: solver.rtol, values: [1e-5]}]'
check progress_counts_the_part_of_a_running_member grep -qE '^0 of 1 members done +[1-8][0-9] %.* 1 running$' err
run info --case swimmer-study/member-0004.nc
check the_last_axis_is_fastest has out 'amplitude: 0.3'
check zipped_keys_change_together has out 'method: rk4'

# results over those at one value; a member that failed has none

run study swimmer.yaml -o relative --set 'sweep=[{key: "fish[*].wave.amplitude", values: [0.2, 0.3], relative_to: 0.3},
    {keys: [solver.method, solver.max_steps], values: [[ida, 1000], [euler, 2]]}]'
check ratios_have_a_table has out 'Over the values at amplitude 0.3:'
sed -n '/^Over/,$p' out >table
check the_reference_itself_is_1 grep -qE '^ +2 +0.3 +ida +1000 +1.00000 ' table
run gather relative
check gather_has_the_ratios cmp <(sed -n '/^Over/,$p' out) table
check the_file_has_the_ratios /usr/bin/python3 "$root/tests/study/ratios.py" relative/study.nc

finished=$(changed swimmer-study/member-0001.nc) failed=$(changed swimmer-study/member-0002.nc)
run study swimmer.yaml
check finished_members_are_passed_over test "$(changed swimmer-study/member-0001.nc)" = "$finished"
check failed_members_run_again test "$(changed swimmer-study/member-0002.nc)" != "$failed"

# the same text of the case, but other defaults: a member of another version of the program
sed -i 's/modulus: 1500000 /modulus: 2000000 /' swimmer-study/member-0001.nc
finished=$(changed swimmer-study/member-0001.nc)
run study swimmer.yaml
check a_member_of_other_defaults_runs_again test "$(changed swimmer-study/member-0001.nc)" != "$finished"
finished=$(changed swimmer-study/member-0001.nc)

sed 1d out >table
run info swimmer-study/study.nc
check info_lists_the_axes has out '  axis 1      3 values of solver.method, solver.max_steps'
check info_counts_members has out '  members     6, 4 of them complete'
check info_prints_the_table_of_the_study cmp <(sed 1,9d out) table
run info --case swimmer-study/study.nc
check info_prints_the_case_of_the_study grep -q '^sweep: ' out
mkdir alone
cp swimmer-study/member* alone
run gather alone
check the_files_of_the_members_are_enough cmp <(sed 's/ swimmer-study/ alone/' table) out
check gather_writes_study_nc test -s alone/study.nc
for other in "0 3" "3 0"; do
    rm -rf mixed && cp -r alone mixed
    cp "alone/member-000${other% *}.nc" "mixed/member-000${other#* }.nc"
    refused "a_member_under_another_number_is_refused ${other/ / as }" 4 'is a result of another study' gather mixed
done
rm alone/member-0003.nc
echo 'not a result' >alone/member-0000.nc
run gather alone
check a_missing_member_is_reported grep -qE '^ +3 .* missing$' out
check an_unreadable_member_is_reported has out 'member 0 failed: ./alone/member-0000.nc: cannot be read'

# a study that pauses takes longer, and at its end nothing is left
"$program" study swimmer.yaml -o paused -j 1 >out 2>err </dev/null &
study=$!
wait_for test -e paused
kill -STOP "$study"
pause 1.5
kill -CONT "$study"
wait "$study"
check at_the_end_no_second_is_left has err ' 100 %  0 s left'

mkdir parts
run study swimmer.yaml -o parts --members 0-1
check a_part_ends_with_0 test "$code" = 0 -a ! -s out
check a_part_runs_its_members_only test -e parts/member-0001.nc -a ! -e parts/member-0002.nc -a ! -e parts/study.nc
refused a_part_counts_its_own_failures 1 '2 of 4 members failed: see parts/member-*.failed' study swimmer.yaml -o parts --members 2-5
refused and_its_own_members 1 '1 of 1 members failed: see parts/member-*.failed' study swimmer.yaml -o parts --members 5-5

# ---- other ways to run the members

if command -v parallel >/dev/null; then
    seq 0 5 | parallel --will-cite -j 2 "$program" study swimmer.yaml -o many --members {} -q 2>err
    run gather many
    check gnu_parallel_runs_them_too cmp <(grep -o '^ *[0-5] .*-[0-9.]*e-' table) <(grep -o '^ *[0-5] .*-[0-9.]*e-' out)
else
    skip gnu_parallel 'parallel is missing'
fi
run study swimmer.yaml --slurm --bundle 4 -o cluster
run study swimmer.yaml --slurm --bundle 4 -o cluster --threads 2
check slurm_scripts_are_written_and_replaced grep -qx '6 members in 2 tasks; start them with cluster/submit.sh' out
check a_task_has_a_bundle eval 'has cluster/array.sbatch "--array=0-1" && has cluster/array.sbatch "--cpus-per-task=2"'
printf '#!/bin/sh\necho "$*" >>jobs; wc -l <jobs\n' >sbatch && chmod +x sbatch
check the_results_wait_for_the_members eval 'grep -qE "members: job 1; results: job 2, .*/cluster/study.txt and study.nc" \
    <(PATH=.:$PATH sh cluster/submit.sh -p few) && grep -q "^--parsable -p few .*/array.sbatch" jobs && has jobs =afterany:1'
mkdir others && echo mine >others/array.sbatch
refused scripts_of_others_are_kept 4 'was not written by shoal study --slurm' study swimmer.yaml --slurm -o others
# the actions of a task, without Slurm
SLURM_ARRAY_TASK_ID=0 sh cluster/array.sbatch >/dev/null 2>&1
check a_task_runs_the_members_of_its_bundle test -e cluster/member-0003.nc -a ! -e cluster/member-0004.nc
SLURM_ARRAY_TASK_ID=1 sh cluster/array.sbatch >/dev/null 2>&1
check the_tasks_run_all_members test -e cluster/member-0003.nc -a -e cluster/member-0005.nc -a ! -e cluster/member-0006.nc
sh cluster/gather.sbatch >out 2>err
check their_results_are_those_of_the_study grep -q '2 of 6 members in .*/cluster' err
refused no_quotes_in_scripts 2 'must not contain quotes' study swimmer.yaml --slurm -o "it's"
refused no_backslashes_in_scripts 2 'backslashes' study swimmer.yaml --slurm -o 'a\b'
run study swimmer.yaml --slurm -o '50%a' --limit 30 --strict --force -j 2 --threads 3
check the_tasks_take_the_options test "$(grep -c -- '--members $first-$last -j 2 --limit 30 --force &' 50%a/array.sbatch)" = 1
check each_task_has_processors_for_its_processes has 50%a/array.sbatch '--cpus-per-task=6'
check the_results_are_judged_strictly grep -qE "^exec .* gather '.*/50%a' --strict$" 50%a/gather.sbatch
check a_percent_sign_is_no_pattern eval 'grep -qE "output=.*/50%%a/task-%a.log.$" 50%a/array.sbatch &&
    grep -qE "output=.*/50%%a/study.txt.$" 50%a/gather.sbatch'
refused what_has_no_meaning_in_a_task_is_refused 2 '--max-wall 01:00:00: a task of Slurm stops a minute before its time limit' \
    study swimmer.yaml --slurm -o cluster --max-wall 01:00:00
refused no_script_beside_members_of_another_study 4 'is a result of another study' \
    study swimmer.yaml --set fish[0].nodes=13 --slurm -o swimmer-study
check nor_any_script test ! -e swimmer-study/array.sbatch
refused bundles_of_nothing 2 '--bundle 0: expects an integer above 0' study swimmer.yaml --slurm --bundle 0 -o cluster
refused bundles_of_words 2 '--bundle few: expects an integer' study swimmer.yaml --slurm --bundle few -o cluster

# ---- folders with something else

refused another_study_is_refused 4 'swimmer-study/member-0000.nc is a result of another study' \
    study swimmer.yaml --set fish[0].nodes=13 -o swimmer-study
check nothing_was_changed test "$(changed swimmer-study/member-0001.nc)" = "$finished"
sed 's/0.2, 0.3/0.2/' swimmer.yaml >shorter.yaml
mkdir surplus
cp swimmer-study/member-0003.nc surplus
refused a_member_of_no_study_is_refused 4 'choose another folder with -o, or remove the file with --force' \
    study shorter.yaml -q -o surplus
run study shorter.yaml -o swimmer-study --force
check force_replaces_it has out 'euler'
check force_removes_the_rest test ! -e swimmer-study/member-0003.nc

# members beyond the last, with a gap in their numbers, and what belongs to them
mkdir gap
cp alone/member-0004.nc gap/member-0007.nc
touch gap/member-0002.failed gap/member-0009.failed gap/member-0009.txt
refused members_beyond_a_gap_are_refused 4 'gap/member-0007.nc is a result of another study' study shorter.yaml -q -o gap
run study shorter.yaml -o gap -q --force
check force_removes_members_beyond_a_gap test "$(cd gap && ls | sort | xargs)" = \
    'member-0000.nc member-0001.nc member-0002.failed member-0002.nc member-0009.txt study.nc'
cp alone/member-0001.nc swimmer-study/
refused gather_of_two_studies 4 'is a result of another study' gather swimmer-study
mkdir gathered
cp alone/study.nc gathered
refused the_table_of_another_study_is_refused 4 './gathered/study.nc was gathered from another study' \
    study shorter.yaml -o gathered -q
run study shorter.yaml -o gathered --force
check force_replaces_it_too test -e gathered/member-0000.nc
mkdir empty
refused gather_of_nothing 4 'empty contains no readable member of a study' gather empty
refused gather_of_no_folder 4 'nowhere: cannot be read: No such file or directory' gather nowhere
refused folder_is_a_file 4 'swimmer.yaml: cannot create this folder' study swimmer.yaml -o swimmer.yaml
refused folder_in_no_folder 4 'no/where: cannot create this folder' study swimmer.yaml -o no/where

# ---- a long sweep

seq -s, 100000 107999 >values
{ sed '/^sweep/,$d' swimmer.yaml; echo "sweep: [{key: \"fish[*].body.modulus\", values: [$(<values)]}]"; } >long.yaml
run check long.yaml
check check_takes_a_sample_of_a_long_sweep grep -qE '; 8000 members, of which a sample of [0-9]{1,4} is checked$' out
counts_members() { [[ -s err && $(<err) =~ [0-9]+\ of\ 8000\ members\ (read|checked) ]]; }
for command in study 'error --of speed --no-confirm'; do
    # the signal waits for what this command says, not the one before
    rm -f err
    run_until TERM counts_members $command long.yaml -o long
    check "the members that are checked are counted: $command" counts_members
    check "a signal ends the checks: $command" eval 'test "$code" = 75 && grep -qE "while the members were (read|checked|planned): none of them has run" err'
    check "before anything runs: $command" test ! -e long
done
run study swimmer.yaml -o heads --set time.end=0.02 \
    --set 'sweep=[{key: wake.smoothing, values: [0.1, 0.05]}, {key: sheet.smoothing, values: [0.1, 0.05]}]'
check two_keys_of_the_same_word_have_two_heads grep -qE '^member +wake.smoothing +sheet.smoothing +t ' out

# ---- wrong input

refused a_wrong_member_is_named 2 'member 1 (wake.lifetime=0.003):' study swimmer.yaml -o wrong \
    --set 'sweep=[{key: wake.lifetime, values: [0.02, 0.003]}]'
check before_anything_ran test ! -e wrong
refused check_names_it_too 2 'member 1 (wake.lifetime=0.003):' check swimmer.yaml \
    --set 'sweep=[{key: wake.lifetime, values: [0.02, 0.003]}]'
run check swimmer.yaml
check check_counts_members has out '; 6 members'
# forty values, of which number 37 is wrong: by itself, or with the rest of the case
forty=$(seq -s, 5 41),3,43,44
refused a_value_out_of_range_in_member_37 2 'sweep[0].values[37] (fish.nodes): must be from 4 to 10000, got 3' \
    study swimmer.yaml -o wrong --set "sweep=[{key: \"fish[*].nodes\", values: [$forty]}]"
forty=$(seq -f '0.%02.0f' -s, 10 46),0.003,0.48,0.49
refused a_value_that_does_not_fit_in_member_37 2 'member 37 (wake.lifetime=0.003):' \
    study swimmer.yaml -o wrong --set "sweep=[{key: wake.lifetime, values: [$forty]}]"
refused members_beyond_the_study 2 '--members 4-6: the study has members 0 to 5' study swimmer.yaml -o parts --members 4-6
refused members_backwards 2 '--members 3-1: expects the number of a member' study swimmer.yaml -o parts --members 3-1
refused members_of_words 2 '--members all: expects' study swimmer.yaml -o parts --members all
refused no_process 2 '-j 0: expects an integer above 0' study swimmer.yaml -o parts -j 0
refused processes_of_words 2 '-j two: expects an integer' study swimmer.yaml -o parts -j two
refused run_refuses_a_sweep 2 'use `shoal study`' run swimmer.yaml -o never.nc
run study swimmer.yaml --limit 0.4 -o slow --set time.end=2000 --set 'sweep=[{key: solver.rtol, values: [1e-5]}]'
check a_member_that_takes_too_long_has_failed eval 'test "$code" = 1 && has out "member 0 failed: too slow: at t = "'
refused max_wall_stops_a_study 75 'stopped after --max-wall: 0 of 1 members are finished; repeat the command to continue' \
    study swimmer.yaml --max-wall 0:00:01 -o timed --set time.end=2000 --set 'sweep=[{key: solver.rtol, values: [1e-5]}]'
refused limit_of_nothing 2 '--limit 0: expects a number above 0' study swimmer.yaml --limit 0
run study swimmer.yaml --set 'sweep=[]' -o single
check without_a_sweep_there_is_one_member test "$code" = 0 -a -e single/member-0000.nc -a ! -e single/member-0001.nc

# ---- convergence

cat >refined.yaml <<end
format: 1
include: ["$article"]
time: {end: 1.6}
solver: {rtol: 1e-8}
fish: [{body: {modulus: 1e5}}]
sweep:
  - {key: time.shedding_interval, values: [0.01, 0.04, 0.02], refine: true, expect: {order: 2, within: 0.6}}
end
run study refined.yaml
check the_expected_order_gives_exit_code_0 test "$code" = 0
check orders_are_printed grep -qE '^ +nose +fish1 +m +[0-9.e-]+ +[0-9.e-]+ +- +- +[12]\.[0-9]+ ' out
check a_flag_is_in_the_row_of_its_quantity grep -qE "^ +nose .* (flagged|3 levels)$" out
check levels_are_sorted_from_coarse_to_fine grep -qE 'unit +0\.04 +0\.02 +0\.01 ' out
refused another_order_gives_exit_code_3 3 \
    'in time.shedding_interval, expected 3 +- 0.1' study refined.yaml -o third -q \
    --set 'sweep=[{key: time.shedding_interval, values: [0.04, 0.02, 0.01], refine: true,
                   expect: {order: 3, within: 0.1}}]'
check then_everything_is_written_all_the_same test -s third/study.nc
# a speed not reached by any level: all errors are equal to the distance, and there is no order
run study refined.yaml -o given --set 'sweep=[{key: time.shedding_interval, values: [0.04, 0.02, 0.01], refine: true, reference: {speed: 100}}]'
check errors_are_against_the_reference grep -qE '^ +speed\* +fish1 +m s-1 +9\.9.e\+01 +9\.9.e\+01 +9\.9.e\+01 +-?0\.00 ' out
check other_errors_are_against_the_finest grep -qE '^ +nose +fish1 +m +[0-9.e-]+ +[0-9.e-]+ +- ' out
check the_head_says_so has out "from the finest level (*: from the reference of the case)"
run info given/study.nc
check info_prints_orders_too grep -qE '^ +speed\* +fish1 ' out
refused the_order_of_any_quantity_can_be_expected 3 'speed of fish1: observed order' \
    study refined.yaml -o given -q --force \
    --set 'sweep=[{key: time.shedding_interval, values: [0.04, 0.02, 0.01], refine: true, reference: {speed: 100},
                   expect: {order: 2, within: 0.6, of: speed}}]'
run info given/study.nc
check info_prints_what_was_missed eval 'test "$code" = 0 && has out "missed: speed of fish1: observed order"'
run study refined.yaml -o groups --set time.end=0.08 \
    --set 'sweep=[{key: solver.rtol, values: [1e-4, 1e-5, 1e-6], refine: true}, {key: solver.order, values: [1, 2]}]'
check other_axes_make_groups has out 'Refinement of solver.rtol, from member 1 (solver.rtol=1e-4, solver.order=2) on'

run study refined.yaml -o swimming --set solver.rtol=1e-5 --set time.shedding_interval=0.05 \
    --set steady.multipliers=false --set steady.tolerance=1e-4 --set 'sweep=[{
    keys: [time.shedding_interval, wake.smoothing, "fish[*].sheet_points"], steady: true, refine: true,
    values: [[0.1, 0.2, 17], [0.05, 0.14, 25], [0.025, 0.1, 33], [0.0125, 0.07, 47]],
    expect: {order: 1, within: 20}}]'
check steady_states_are_refined eval 'test "$code" = 0 && grep -qE "^ +steady_speed +fish1 .* (4 levels|flagged)$" out'
check several_keys_are_refined_together has out 'of time.shedding_interval with wake.smoothing with fish[*].sheet_points'
check quantities_without_values_are_left_out eval '! grep -qE "^ +(nose|steady_drag)" out'
check the_order_of_the_steady_speed_is_expected grep -qE '^met: order of steady_speed of fish1 is ' out

cat >flag.yaml <<end
format: 1
include: ["$root/cases/flag.yaml"]
sweep: [{key: "fish[*].body.modulus", values: [5e4, 1e5], steady: true}]
end
run study flag.yaml -o flag --set 'fish[*].nodes=13' --set 'fish[*].sheet_points=33'
check the_growth_rate_of_equilibria_is_in_the_table eval 'grep -qE "^member +modulus .* growth +drift " out &&
    grep -qE "^ +0 +5e4 .* \+0\.[0-9]{4} " out && grep -qE "^ +1 +1e5 .* -0\.[0-9]{4} " out'

# ---- expectations of members

cat >stated.yaml <<end
format: 1
include: ["$article"]
time: {end: 0.2, shedding_interval: 0.02}
fish: [{name: one, force: reactive, nodes: 9}, {name: two, force: reactive, nodes: 9, start: {position: [0, 3]}}]
sweep:
  - {key: "fish[*].wave.amplitude", values: [0.2, 0.3]}
  - {key: solver.method, values: [ida, rk4]}
expect:
  - {of: speed, least: 0.9, most: 1.1}
  - {of: [nose, tail], fish: two, where: ["fish[*].wave.amplitude=0.30"], spread: 1e-3}
  - {of: steps, where: [solver.method=rk4], ratio: 3}
end
run study stated.yaml
check statements_that_hold_give_exit_code_0 test "$code" = 0
check each_is_printed grep -qx 'nose of two, 2 values' out
check with_what_is_and_what_should_be grep -qE '^  met      the smallest is 0\.9[0-9]*, expected at least 0\.9$' out
check values_of_all_members_and_fish_count grep -qx 'speed, 8 values' out
check the_same_number_is_the_same_value grep -qx 'tail of two, 2 values' out
refused a_statement_that_does_not_hold_gives_exit_code_3 3 'expect[0]: speed: expectation not met' \
    study stated.yaml -q -o unstated --set 'expect=[{of: speed, most: 0.5}, {of: nose, fish: one, spread: 0}]'
check what_is_missed_is_printed grep -qE '^  MISSED   the largest is [01]\.[0-9]*, expected at most 0\.5$' err
check all_expectations_are_tested grep -qE '^  MISSED   the spread is [0-9.e-]+, expected at most 0$' err
refused a_quantity_that_is_missing_misses 3 'expect[0]: tail_error: expectation not met' \
    study stated.yaml -q -o unstated --force --set 'expect=[{of: tail_error, most: 1}]'
check that_it_is_missing_is_printed has err '  MISSED   member 3 has no such value'
run info unstated/study.nc
check info_reports_it_too eval 'test "$code" = 0 && has out "missed: expect[0]"'
refused a_member_that_is_not_complete_misses 3 'expect[0]: speed: expectation not met: see the output' \
    study swimmer.yaml -q -o failing --set 'sweep=[{key: solver.max_steps, values: [1000, 2]}]' \
    --set solver.method=euler --set 'expect=[{of: speed, least: 0}]'
check which_member_it_is_is_printed has err '  MISSED   member 1 is not complete'
run study swimmer.yaml -o doomed --set 'expect=[{fails: limited by, where: [solver.method=euler]},
    {of: speed, least: 0, where: [solver.method=ida, solver.method=rk4]}]'
check failures_that_are_expected_give_exit_code_0 eval 'test "$code" = 0 && grep -q "^2 members (2, 5) failed" out'
check they_are_counted grep -qx 'failures, 2 members' out
check several_values_of_a_key_are_alternatives grep -qx 'speed, 4 values' out
refused a_failure_that_does_not_come_misses 3 'expect[0]: failures: expectation not met' study swimmer.yaml -o doomed --force \
    --set 'expect=[{fails: limited by, where: [solver.method=euler, solver.method=rk4]}]'
check which_member_does_not_fail_is_printed has out "  MISSED   member 4 has not failed with 'limited by'"
refused other_words_of_the_reason_miss_too 3 'expect[0]: failures: expectation not met' study swimmer.yaml -o doomed --force \
    --set 'expect=[{fails: out of memory, where: [solver.method=euler]}]'
run study stated.yaml -o plain --set 'sweep=[]'
check without_a_sweep_nothing_is_expected eval 'test "$code" = 0 && ! grep -q Expected out'

# ---- deaths

# four members that take long; the one with number 0 is short
cat >long.yaml <<'end'
format: 1
time: {end: 60, shedding_interval: 0.02}
fish: [{force: reactive, nodes: 9}]
sweep:
  - {keys: [time.end, time.shedding_interval], values: [[0.2, 0.02], [60, 0.02], [60.02, 0.02], [60.04, 0.02]]}
end

# Start the study in the background and wait for member 0 to be finished and two others to run.
start_long() {  # folder
    env --default-signal=INT "$program" study long.yaml -j 2 -o "$1" >out 2>err </dev/null &
    study=$!
    wait_for test -e "$1/member-0002.nc" || echo "the study does not start: $(<err)"
}

wait_for_end_of() {  # processes...
    local process
    for process in "$@"; do
        wait_for eval '! kill -0 "$process"' || return 1
    done
}

start_long stopped
kill -INT "$study"
code=0
wait "$study" || code=$?
check a_signal_stops_a_study test "$code" = 75
check it_says_what_is_finished has err 'stopped by a signal: 1 of 4 members are finished; repeat the command to continue'
run info stopped/member-0001.nc
check its_members_stop_cleanly has out 'stopped'

# a signal to the process group reaches each member twice: the study forwards the signal too
set -m
"$program" study long.yaml -j 2 -o grouped -q --set "fish[*].nodes=101" --set "fish[*].sheet_points=201" \
    >out 2>err </dev/null &
study=$!
set +m
wait_for test -s grouped/member-0001.nc
kill -TERM -- "-$study"
code=0
wait "$study" || code=$?
check a_signal_to_the_group_stops_a_study test "$code" = 75
run info grouped/member-0001.nc
check its_members_end_at_an_event has out '  status      stopped'
check no_member_has_failed_by_it test ! -e grouped/member-0000.failed -a ! -e grouped/member-0001.failed

# the parent of the program may ignore SIGCHLD
code=0
env --ignore-signal=CHLD "$program" study swimmer.yaml -o ignored -q >out 2>err </dev/null || code=$?
check a_study_sees_its_members_end_all_the_same eval 'test "$code" = 1 && has err "2 of 6 members in ignored"'

# a processor for each thread of each member, of the processors that the program may use
running() {  # arguments: the most members that run at once
    run study long.yaml --force --set 'sweep=[{key: time.end, values: [4, 8, 12]}]' "$@"
    sed -n 's/.* failed  \([0-9]*\) running$/\1/p' err | sort -n | tail -1
}
processor=$(taskset -cp $$ | sed 's/.*: \([0-9]*\).*/\1/')
taskset -p $$ >mask
taskset -cp "$processor" $$ >/dev/null
check one_processor_runs_one_member test "$(running -o one)" = 1
taskset -p "$(sed 's/.* //' mask)" $$ >/dev/null
if (($(nproc) > 1)); then
    check more_processors_run_more_members test "$(running -o more)" -gt 1
    check members_of_many_threads_share_them test "$(running -o threads --threads "$(nproc)")" = 1
    check the_command_line_decides test "$(running -o many --threads "$(nproc)" -j 2)" = 2
else
    skip processors 'there is one only'
fi

start_long killed
read -ra members <"/proc/$study/task/$study/children"
kill -KILL "$study"
wait "$study" 2>/dev/null
check members_end_with_a_killed_study wait_for_end_of "${members[@]}"
before=$(changed killed/member-0000.nc)
run study long.yaml -o killed --members 0
check what_a_killed_study_finished_stays test "$code" = 0 -a "$(changed killed/member-0000.nc)" = "$before"

start_long shot
read -ra members <"/proc/$study/task/$study/children"
kill -KILL "${members[0]}"
wait_for test -e shot/member-0003.nc  # the next one has its turn
kill -INT "$study"
wait "$study" 2>/dev/null
check a_killed_member_is_reported grep -q 'killed by signal 9 (Killed)' shot/member-000[123].failed
check the_others_carry_on test -e shot/member-0003.nc
run gather shot
check gather_reports_it_too has out 'failed: killed by signal 9 (Killed)'

# a limit of the size of files is a full disk for the largest member only
cat >disk.yaml <<'end'
format: 1
time: {end: 0.2, shedding_interval: 0.02, output_interval: 0.02}
fish: [{force: reactive, nodes: 9}]
sweep:
  - {keys: ["fish[*].nodes", "fish[*].sheet_points"], values: [[7, 21], [25, 81], [8, 21]]}
end
run study disk.yaml -o roomy
largest=$(stat -c %s roomy/member-0001.nc) other=$(stat -c %s roomy/member-0002.nc)
(
    ulimit -f $(((largest + other) / 2 / 1024))
    "$program" study disk.yaml -o disk >out 2>err </dev/null
    echo $? >code
)
check a_full_disk_is_a_failed_member test "$(<code)" = 1
check it_says_what_could_not_be_written has out 'member 1 failed: ./disk/member-0001.nc: cannot be written at t = '
check the_other_members_are_complete test "$(grep -c ' complete$' out)" = 2
run study disk.yaml -o disk
check with_room_the_next_call_completes_it test "$code" = 0

finish

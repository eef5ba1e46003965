#!/usr/bin/env bash
# `shoal compare` prints what each method cost and how wrong it was, goes on when a run ends early, and refuses wrong
# input.
#
#   tests/study/test_compare_command.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"
start_python

article=$root/cases/include/article.yaml
export TMPDIR=$folder  # where comparisons run

# The value in a column of the row of a method and a tolerance or step.
value() {  # method, value, column, file
    awk -v method="$1" -v value="$2" -v column="$3" \
        '$1 == method && ($2 == value || $3 == value) { print $column }' "${4-out}"
}

below() {  # a, b
    awk -v a="$1" -v b="$2" 'BEGIN { exit !(a != "" && b != "" && a != "-" && b != "-" && a + 0 < b + 0) }' ||
        { echo "$1 is not below $2"; return 1; }
}

cat >case.yaml <<end
format: 1
include: ["$article"]
time: {end: 0.4, shedding_interval: 0.02}
fish: [{body: {modulus: 1e4}}]
end

run compare case.yaml --methods ida2,ida5,euler,rk4,dormand_prince --rtol 1e-3,1e-6 --repeats 2 -o compare.nc
check all_methods_have_three_errors test "$code" = 0 -a "$(awk '/ complete$/ && $4 != $5 && $5 != $6' out | wc -l)" = 10
"$program" keys --json >keys.json
"$program" compare --help >help
for method in $(python "$root/tests/study/words_of_key.py" keys.json solver.method); do
    check "help names $method" grep -qE "[ (]$method([ ,;]|$)" help
done
check the_error_of_the_reference_is_printed has out 'Reference: ida5, rtol 1e-09; difference of ida5, rtol 1e-08: '
# dormand_prince is as exact as the reference with either tolerance
for method in ida2 ida5 euler rk4; do
    check "${method}_is_more_exact_with_less_tolerance" below "$(value $method 1e-6 5)" "$(value $method 1e-3 5)"
done
check implicit_methods_count_newton_and_jacobians below 0 "$(value ida2 1e-3 12)"
check explicit_methods_need_no_newton test "$(value rk4 1e-3 11)" = 0
check repeats_and_references_are_counted has err '22 of 22 members done  100 %  0 s left  0 failed'
check the_file_is_written test -s compare.nc
cp out printed
run info compare.nc
check info_prints_the_same_table cmp <(sed 1,8d out) printed
check info_says_what_it_is_of has out '  case        case'
run info --case compare.nc
check info_prints_its_case test "$code" = 0 -a "$(grep -c 'modulus: 1e4' out)" = 1
refused the_file_is_not_overwritten 4 'compare.nc exists' compare case.yaml -o compare.nc
run compare case.yaml --methods euler --rtol 1e-3 --repeats 1 -o compare.nc --force -q
check with_force_it_is test "$code" = 0 -a ! -s err -a ! -s out


# the default method has the order of the case
run compare case.yaml --methods ida,ida2 --set solver.order=4 --rtol 1e-4 --repeats 1
check ida_is_the_default_method test "$(value ida4 1e-4 14)" = complete -a "$(value ida2 1e-4 14)" = complete
run compare case.yaml --rtol 1e-3 --repeats 1 --set time.end=0.1
check ida_is_compared_by_default test "$(value ida2 1e-3 14)" = complete -a "$(value ida5 1e-3 14)" = complete

run compare case.yaml --methods ida2,rk4,euler --steps 0.01,0.0025 --rtol 1e-4 --repeats 1
check fixed_steps_count_their_stages test "$(value rk4 0.0025 9)" = 160
check steps_are_for_explicit_methods_only test "$(value ida2 1e-4 14)" = complete -a "$(value ida2 0.01 14)" = ''
run compare case.yaml --methods implicit_euler,trapezoid --steps 0.005
check settings_are_repeated_three_times_by_default has err '8 of 8 members done'
check implicit_methods_take_fixed_steps_too test "$(value trapezoid 0.005 9)" = 80
check they_count_newton_and_jacobians below 0 "$(value trapezoid 0.005 12)"
check the_trapezoid_is_more_exact below "$(value trapezoid 0.005 5)" "$(value implicit_euler 0.005 5)"
run compare case.yaml --set 'fish[0].body.modulus=1e9' --methods rk4,ida2 --steps 0.01 --rtol 1e-4 --repeats 2
check a_step_too_large_is_unstable grep -q '^rk4, step 0.01 failed: unstable at t = ' out
check its_row_says_so test "$(value rk4 0.01 14)" = failed
run compare case.yaml --set 'fish[0].body.modulus=1e8' --set solver.max_steps=150 --methods euler,ida2 --rtol 1e-2 \
    --repeats 1 --reference-rtol 1e-6 -o failed.nc
check ten_times_the_tolerance_of_the_reference has out 'ida5, rtol 1e-06; difference of ida5, rtol 1e-05: '
check a_limit_of_steps_is_no_instability grep -q '^euler, rtol 1e-2 failed: limited by solver.max_steps at t = ' out
check that_is_no_failure_of_the_comparison test "$code" = 0
run compare case.yaml --set time.end=40 --set 'fish[0].body.modulus=1e8' --methods euler --rtol 1e-3 --repeats 1 \
    --reference-rtol 1e-5 --limit 0.4 -q
check what_is_too_slow_fails test "$code" = 1
check which_may_be_the_reference has err 'the reference, member 0 failed: too slow: at t = '
check then_nothing_else_runs test ! -s out


# rk4 takes a million steps at this stiffness, the references some hundred
run compare case.yaml --set time.end=2 --set 'fish[0].body.modulus=1e12' --methods ida,rk4 --rtol 1e-3 --repeats 1 \
    --reference-rtol 1e-4 --limit 2 -o late.nc
check a_method_beyond_the_limit_is_no_failure_of_the_comparison test "$code" = 0
check what_it_did_is_said grep -qE \
    '^rk4, rtol 1e-3 failed: too slow: at t = [0-9.e-]+ s after [0-9.]+ s, [1-9][0-9]* steps and [1-9][0-9]* evaluations$' out
check its_cost_to_the_end_is_marked grep -qE '^ +rk4 +1e-3 .* ~[0-9.e+]+ +- +~[0-9.e+]+ +~[0-9.e+]+ +0 +0 .* failed$' out
check the_mark_is_explained has out '~: extrapolated to the end, t = 2 s, from what was done within --limit.'
check python_reads_both python "$root/tests/study/late.py" late.nc
cp out printed
run info late.nc
check info_prints_it_too cmp <(sed 1,8d out) printed

refused unknown_method 2 "--methods: 'adams' is unknown" compare case.yaml --methods ida2,adams
refused tolerance_out_of_range 2 'error: --rtol -1: solver.rtol must be from 1e-14 to 0.1' compare case.yaml --rtol 1e-3,-1
refused implicit_methods_without_steps 2 '--methods: trapezoid takes fixed steps only: give them with --steps' \
    compare case.yaml --methods trapezoid
refused a_step_below_0 2 'error: --steps -1: solver.step must be at least 0' compare case.yaml --methods rk4 --steps -1
refused tolerance_of_words 2 "--rtol: 'small' is not a number" compare case.yaml --rtol 1e-3,small
refused step_that_is_no_part 2 'solver.step' compare case.yaml --methods rk4 --steps 0.013
refused empty_list 2 'nothing to compare' compare case.yaml --methods ''
TMPDIR=/no/where refused no_folder_for_temporary_files 4 'set TMPDIR to another folder' compare case.yaml
refused repeats_of_words 2 '--repeats two: expects an integer' compare case.yaml --repeats two
refused no_repeats 2 '--repeats 0: expects an integer above 0' compare case.yaml --repeats 0
refused too_many_repeats 2 '--repeats: expects 1 to 99' compare case.yaml --repeats 100
refused limit_of_nothing 2 '--limit 0: expects a number above 0' compare case.yaml --limit 0
refused a_sweep 2 'this case has a sweep of 1 axis' compare case.yaml --set 'sweep=[{key: solver.rtol, values: [1e-3]}]'

run_until INT 'sleep 0.3' compare case.yaml --set time.end=40 --repeats 9
check a_signal_stops_a_comparison test "$code" = 75

check its_folder_is_removed test ! -e "$(echo "$TMPDIR"/shoal-compare-*)"

finish

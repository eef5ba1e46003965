#!/usr/bin/env bash
# After a power cut, a result without its last rows can be read and resumed. A sample of states after a cut at any time
# is tried; `make soak` tries 1000 cuts.
#
#   tests/extra/test_power.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

# ---- a header that counts rows that are not there

cat >case.yaml <<'end'
format: 1
name: x
time: {end: 6, shedding_interval: 0.05, output_interval: 0.05, checkpoint_interval: 1}
wake: {lifetime: 3 beats}
fish: [{force: reactive, nodes: 7, sheet_points: 9, body: {tail_thickness: 0.3}}]
end
same() { /usr/bin/python3 "$root/tests/run/same_result.py" "$@"; }
run run case.yaml -q -o whole.nc
# the bytes of a row, and of the whole result: a run that was killed within a row is run again
size() { stat -c %s "$1"; }
for end in 5 6; do run run case.yaml -q --set time.end=$end -o $end.nc; done
per_row=$((($(size 6.nc) - $(size 5.nc)) / 20))
run run case.yaml -q
full=$(size x.nc)
for ((try = 0; try < 20; try++)); do
    rm -f x.*
    "$program" run case.yaml -q >out 2>err </dev/null &
    pid=$!
    wait_for eval 'test -e x.ckpt.previous || ! kill -0 $pid'
    kill -KILL $pid
    wait $pid 2>/dev/null
    pid=
    [[ $("$program" info x.nc | sed -n 's/^  status *//p') == running ]] && (((full - $(size x.nc)) % per_row == 0)) && break
done
n=$("$program" info x.nc | awk '$1 == "rows" { print $2 + 0 }')
truncate -s -100 x.nc
mkdir kept
cp x.* kept
run info x.nc
check info_has_the_whole_rows_and_says_what_is_missing eval 'has out "rows        $((n - 1)), from" &&
    has out "missing     1 of $n rows: the file was cut off"'
for command in "view x.nc -q" "export x.nc -q --vtk vtk"; do
    # shellcheck disable=SC2086 # several arguments
    run $command
    check "${command%% *}: exit code 0" test "$code" = 0
    check "${command%% *}: says what is missing" has err "note: x.nc: the last 1 of $n rows are missing"
done
check a_page_has_the_whole_rows has x.html "\"rows\":$((n - 1)),"
check vtk_has_the_whole_rows test "$(find vtk -name '*bodies*' | wc -l)" = $((n - 1))
run field x.nc -q --grid 3,3
check field_takes_the_last_whole_row test "$code" = 0
refused a_run_that_can_go_on_says_so 4 "continue from t = " run case.yaml -q
run resume x.ckpt -q
check it_is_resumed_to_the_same_bits eval '((code == 0)) && same x.nc whole.nc'

# with fewer rows than the newest checkpoint counts the previous checkpoint serves; with fewer than both no checkpoint serves
cp kept/* .
"$program" info x.ckpt >out
rows=$(sed -n 's/.*with \([0-9]*\) rows up to this time/\1/p' out)
truncate -s "-$((per_row * (n - rows)))" x.nc
run resume x.ckpt -q
check the_one_before_it_serves eval '((code == 0)) && has err "; resuming from x.ckpt.previous" && same x.nc whole.nc'
cp kept/* .
truncate -s $(($(size x.nc) - per_row * (n - 1))) x.nc
refused rows_that_both_count_are_missing 4 "the checkpoint requires $rows" resume x.ckpt
run info x.nc
check info_still_reads_it test "$code" = 0
truncate -s -$((2 * per_row)) x.nc
refused a_file_without_its_constants_is_damaged 4 'the end of the file is missing' info x.nc

# a truncated member of a study, for example after a copy, is not complete
mkdir study
cat case.yaml >study.yaml
echo 'sweep: [{key: "fish[0].wave.amplitude", values: [0.2, 0.3]}]' >>study.yaml
run study study.yaml -q -o study --set time.end=0.2
truncate -s -100 study/member-0001.nc
run gather study
check a_member_without_its_end_is_not_complete eval '((code == 1)) && has out "member 1 failed" && has out "the end of the file is missing"'
run study study.yaml -q -o study --set time.end=0.2
check it_runs_again test "$code" = 0
printf '\0\0\0\x79\0\0\0\0' | dd of=study/member-0000.nc bs=1 seek=4 conv=notrunc status=none
run gather study
check nor_is_one_whose_header_counts_too_many_rows eval '((code == 1)) && has out "member 0 failed"'
run study study.yaml -q -o study --set time.end=0.2
check that_one_runs_again_too test "$code" = 0

# ---- cuts at any time

sample=$(/usr/bin/python3 "$root/tests/soak/power.py" "$program" 40)
check "a sample of power cuts: no run is lost" \
    grep -q '^[1-9][0-9]* passed, 0 failed, 0 skipped$' <(echo "$sample" | tee sample.out | tail -n 1)
((n_failed == 0)) || cat sample.out

finish

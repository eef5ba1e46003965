#!/usr/bin/env bash
# test_resume.sh PROGRAM: runs that are stopped or killed and resumed have the bits of the uninterrupted run.
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

start_python
same() { python "$root/tests/run/same_result.py" "$@"; }
places() { python "$root/tests/value.py" "$1" checkpoint_at; }

cat >swimmer.yaml <<'CASE'
format: 1
time: {end: 1, shedding_interval: 0.01, output_interval: 0.02}
output: {wake_interval: 0.1}
defaults: {fish: {body: {thickness: 0.2, depth: 0.25, modulus: 1e6}}}
fish:
  - {name: a, force: reactive, nodes: 7, sheet_points: 21}
  - {name: b, force: reactive, nodes: 9, sheet_points: 21, start: {position: [0.2, 1.5]}, control: {law: heading, desired_heading: 170}}
CASE

# Start a run in the background, and wait for the first rows.
start() {  # arguments of the program
    env --default-signal=INT,TERM,HUP,USR1 "$program" "$@" -q >out 2>err </dev/null &
    pid=$!
    local before
    wait_for test -s run.nc
    before=$(stat -c %s run.nc)
    wait_for eval '(($(stat -c %s run.nc) > before + 6000)) || ! kill -0 "$pid"'
}

# Send a signal to the run, wait for the end and set $code.
end() {  # signal
    kill "-$1" "$pid"
    code=0
    wait "$pid" || code=$?
    pid=
}

# Start a run and send a signal during the run; start again if the run ends before the signal.
attempt() {  # signal, arguments of the program
    local try
    rm -rf before
    mkdir before
    cp ./*.nc ./*.ckpt* before 2>/dev/null
    for ((try = 0; try < 4; try++)); do
        start "${@:2}"
        end "$1"
        ((code != 0)) && return
        rm -f ./*.nc ./*.ckpt*
        cp before/* . 2>/dev/null
    done
}

# ---- stopped repeatedly; the reference has checkpoints at the same times

stopped() {  # name, signals, arguments of run...
    local name=$1 signals=$2 signal command round codes
    shift 2
    # a run that was stopped near the end leaves no time for another signal: start again
    for ((round = 0; round < 20; round++)); do
        rm -f ./*.nc ./*.ckpt*
        command=(run "$@" -o run.nc)
        codes=
        for signal in $signals; do
            attempt "$signal" "${command[@]}"
            codes+=" $code"
            command=(resume run.ckpt)
            ((code != 0)) || continue 2
        done
        break
    done
    # shellcheck disable=SC2086 # one word for each signal
    check "$name: $signals: exit code 75" test "$codes" = "$(printf ' 75%.0s' $signals)"
    check "$name: it says what to do" has err "continue with 'shoal resume run.ckpt'"
    run resume run.ckpt -q
    check "$name: resumed to the end" test "$code" = 0
    check "$name: no part stays" test ! -e run.nc.part
    run run "$@" -q -o reference.nc --checkpoint-at "$(places run.nc)"
    check "$name: the bits of the run with the same checkpoints" same run.nc reference.nc
}
stopped sheet 'TERM HUP' swimmer.yaml --set time.end=4
stopped two_threads USR1 swimmer.yaml --threads 2 --set output.precision=single
stopped impulsive INT swimmer.yaml --set wake.shedding=impulsive --set time.shedding_interval=0.02
stopped finite_span TERM swimmer.yaml --set 'fish[*].force=pressure' --set 'fish[*].pressure.span=finite'
stopped pressure TERM swimmer.yaml --set 'fish[*].force=pressure' --set 'fish[*].pressure.span=infinite' --set 'fish[*].pressure.suction_limit=0.01'
stopped dropped TERM swimmer.yaml --set 'fish[*].start.speed=2' --set time.end=1.6
for left in $(python "$root/tests/value.py" run.nc wake_count); do
    check "dropped: a third of the 161 markers of a fish is gone" test "$left" -gt 50 -a "$left" -lt 107
done
stopped explicit TERM swimmer.yaml --set solver.method=dormand_prince --set 'fish[*].body.modulus=1e5' --set time.checkpoint_interval=0.25

# ---- complete and incomplete results

refused complete 2 'run.nc is complete: give a later --end to extend the result' resume run.ckpt
refused and_so_with_threads 2 'run.nc is complete: give a later --end to extend the result' resume run.ckpt --threads 2
refused end_before_the_checkpoint 2 '--end 0.5: the checkpoint is at t = 1 s already' resume run.ckpt --end 0.5
refused no_end 2 'time.end: 2.003 s is not an integer multiple' resume run.ckpt --end 2.003
run resume run.ckpt -q --end 1.2
check extended test "$code" = 0
run run swimmer.yaml --set solver.method=dormand_prince --set 'fish[*].body.modulus=1e5' --set time.checkpoint_interval=0.25 --set time.end=1.2 -q \
    -o reference.nc --checkpoint-at "$(places run.nc)" --force
check an_extended_run_is_the_longer_run same run.nc reference.nc
# a checkpoint between two rows, behind a row with a wake
# and a checkpoint at the end, whose row has a wake only because the row is the last
for at in 0.05 0.06; do
    between=(--force -q --set time.checkpoint_interval=$at --set output.wake_interval=$([[ $at = 0.05 ]] && echo 0.02 || echo 0.1))
    run run swimmer.yaml "${between[@]}" -o between.nc --set time.end=0.06
    run resume between.ckpt -q --end 0.12
    run run swimmer.yaml "${between[@]}" -o reference.nc --set time.end=0.12
    check "the wakes of the longer run, with a checkpoint at $at s" same between.nc reference.nc
done
# a fish that holds a place, after the first beat, without which its law does nothing
sed 's/{law: heading, desired_heading: 170}/{law: place, of: a, offset: [0.3, 1.4]}/' swimmer.yaml >place.yaml
beats=(--force -q --set time.checkpoint_interval=0.6 --set time.shedding_interval=0.02)
run run place.yaml "${beats[@]}" -o beats.nc --set time.end=1.2
run resume beats.ckpt -q --end 1.4
run run place.yaml "${beats[@]}" -o reference.nc --set time.end=1.4
check "a place that is held, with a checkpoint at 1.2 s" same beats.nc reference.nc
# a fish that crosses a faded wake before the checkpoint: the warning survives, and is that of the longer run
cat >crossing.yaml <<'CASE'
format: 1
time: {end: 4, shedding_interval: 0.02, output_interval: 1}
wake: {lifetime: 3, decay: 2.25}
defaults: {fish: {force: reactive, nodes: 9, start: {speed: 0.8}}}
fish: [{name: leader}, {name: crossing, start: {position: [0.3, -1.5], heading: 90}}]
CASE
faded() { python "$root/tests/value.py" "$1" warnings | grep 'crossing lies in the decaying part of another wake'; }
run run crossing.yaml --force -q --checkpoint-at 4
run resume crossing.ckpt -q --end 4.6
run run crossing.yaml --force -q --checkpoint-at 4 --set time.end=4.6 -o reference.nc
check "a faded wake before the checkpoint" same crossing.nc reference.nc
check "the warning about it" test "$(faded crossing.nc)" -a "$(faded crossing.nc)" = "$(faded reference.nc)"
run run swimmer.yaml -q -o placed.nc --set time.checkpoint_interval=0 --set time.end=0.06 --checkpoint-at 0.04
run resume placed.ckpt -q --end 0.12
check a_place_is_noted_once test "$(places placed.nc)" = 0.04
refused no_checkpoint 4 'nothing.ckpt: cannot be read' resume nothing.ckpt
refused a_case_file 4 'swimmer.yaml: cannot be used: not a checkpoint of shoal' resume swimmer.yaml
refused a_complete_result 2 'run.nc is complete: give a later --end to extend the result' resume run.nc
refused no_event 2 "--checkpoint-at: '0.333' is not the time of an event" run swimmer.yaml --checkpoint-at 0.3,0.333
refused no_time 2 '--max-wall 5: expects HH:MM:SS' run swimmer.yaml --max-wall 5
printf '%s\n' '#include <stdio.h>' 'unsigned alarm(unsigned n) { fprintf(stderr, "alarm %u", n); return 0; }' >alarm.c
if ${CC:-cc} -shared -fPIC -o alarm.so alarm.c 2>/dev/null; then
    LD_PRELOAD=./alarm.so ASAN_OPTIONS=verify_asan_link_order=0 run run swimmer.yaml -q -o timed.nc --max-wall 2:03:04
    check hours_minutes_and_seconds has err "alarm $((2 * 3600 + 3 * 60 + 4))"
else
    skip hours_minutes_and_seconds "no C compiler"
fi
refused no_multiple 2 'time.checkpoint_interval: 0.015 s is not an integer multiple' check swimmer.yaml \
    --set time.checkpoint_interval=0.015
run info -v run.ckpt
check info_tells_of_a_checkpoint eval 'has out "a run at t = 1 s; the result is run.nc" && has out balance.power'
run info --case run.ckpt
cp out case.yaml
check the_case_of_a_checkpoint_is_a_case "$program" check case.yaml -q

# ---- killed: the last checkpoint and the previous checkpoint

rm -f ./*.nc ./*.ckpt*
regular=(swimmer.yaml --set time.checkpoint_interval=0.1)
run run "${regular[@]}" -q -o reference.nc
# a run that ends before the signal starts again
for ((try = 0; try < 20; try++)); do
    rm -f run.nc run.ckpt*
    start run "${regular[@]}" -o run.nc
    wait_for test -e run.ckpt.previous
    end KILL
    ((code != 0)) && break
done
check killed test "$code" = 137
# a run killed between the two renames leaves only the previous checkpoint; this test needs both
[[ -e run.ckpt ]] || cp run.ckpt.previous run.ckpt
mkdir kept
cp run.nc run.ckpt run.ckpt.previous kept
refused unfinished 4 "run.nc is an unfinished result of this case: continue from t = " run "${regular[@]}" -o run.nc
check unfinished_says_the_command has err "'shoal resume run.ckpt', or start again with --force"
refused of_another_case 4 'run.nc exists: choose another name' run "${regular[@]}" -o run.nc --set fish[0].wave.frequency=2
run resume run.ckpt -q --threads 2
check a_killed_run_goes_on same run.nc reference.nc

restore() { cp kept/* .; }

# Change a byte, whatever it is.
damage() {  # file, place
    local byte
    byte=$(od -An -tu1 -j "$2" -N 1 "$1")
    # shellcheck disable=SC2059 # the byte is an escape of the format
    printf "\\x$(printf %x $((255 - byte)))" | dd of="$1" bs=1 seek="$2" conv=notrunc status=none
}

restore
damage run.ckpt 3000
run resume run.ckpt -q
check a_damaged_checkpoint_falls_back eval 'has err "run.ckpt: cannot be used: damaged behind byte" &&
    has err "; resuming from run.ckpt.previous" && same run.nc reference.nc'
for field in y wake.circulation balance.work closest.before; do
    restore
    python "$root/tests/run/nan.py" run.ckpt $field
    refused "a checkpoint with NaN in $field" 4 "the checkpoint of run.nc cannot be used: value" resume run.ckpt -q
    check "it says where: $field" has err "of '$field' is nan"
done
restore
python "$root/tests/run/nan.py" run.ckpt processor ' of 1971'
run resume run.ckpt -v
check another_processor_is_a_note has err " of 1971: last bits may differ"
cp out summary
run info run.nc
check verbose_prints_the_summary_of_info cmp out summary
restore
python "$root/tests/run/nan.py" run.ckpt processor ' of 1971'
run resume run.ckpt -q
check quiet_prints_no_note eval 'test "$code" = 0 -a ! -s out -a -z "$(grep note: err)"'
restore
rm run.ckpt
run resume run.ckpt -q
check a_missing_checkpoint_falls_back same run.nc reference.nc
restore
truncate -s 3000 run.ckpt run.ckpt.previous
refused two_damaged_checkpoints 4 '3000 bytes instead of' resume run.ckpt
restore
damage run.nc $(($(stat -c %s run.nc) * 2 / 3))
rm run.ckpt.previous
refused changed_rows 4 'the rows do not match the checkpoint' resume run.ckpt
restore
cp reference.nc run.nc
refused rows_of_another_run 4 'the rows do not match the checkpoint' resume run.ckpt
rm run.nc
refused a_missing_result 4 'run.nc: cannot be read' resume run.ckpt
restore
run run "${regular[@]}" -q -o run.nc --set time.checkpoint_interval=0 --force
check a_new_run_removes_old_checkpoints test "$code" = 0 -a ! -e run.ckpt -a ! -e run.ckpt.previous
echo mine >run.ckpt
refused a_file_of_another_program 4 'run.ckpt exists and is no checkpoint of shoal' run "${regular[@]}" -q -o run.nc --force

# ---- killed between checkpoints of the wall time, and resumed by the name of the result

rm -f ./*.nc ./*.ckpt*
wall=(swimmer.yaml --set time.end=1.6 --set time.checkpoint_wall=1e-3 --set output.wake_interval=0.4)
run run "${wall[@]}" -q -o walls.nc
check wall_time_leaves_no_checkpoint_at_the_end test "$code" = 0 -a ! -e walls.ckpt -a ! -e walls.ckpt.previous
run run "${wall[@]}" -q -o none.nc --set time.checkpoint_wall=0
check wall_time_changes_no_bit same walls.nc none.nc
check and_no_place_is_noted test -z "$(places walls.nc)"
for ((try = 0; try < 20; try++)); do
    start run "${wall[@]}" -o run.nc
    wait_for eval '[[ -s run.ckpt ]] || ! kill -0 "$pid"'
    end KILL
    [[ -s run.ckpt ]] && break
    rm -f run.*
done
cp run.ckpt kept.ckpt
cp run.nc kept.nc
run info run.ckpt
check a_checkpoint_has_five_lines test "$(grep -cv '^places' out)" = 5
run info run.ckpt -v
check and_the_state_with_v grep -q '^  wake.circulation ' out
run resume run.nc
check the_result_is_resumed_by_its_name test "$code" = 0
check and_says_what_it_has grep -qE 'run.nc continues from t = [0-9.]+ s, .* of wall time after its start .run.ckpt.' err
check a_resumed_run_removes_its_checkpoints test ! -e run.ckpt -o -n "$(find . -name run.ckpt -newer kept.nc)"
at=$(places run.nc)
check the_place_is_noted test -n "$at"
run run "${wall[@]}" -q -o placed.nc --checkpoint-at "$at"
check a_run_with_this_place_has_the_same_bits same run.nc placed.nc
run resume placed.nc --end 1.7 -q
check a_complete_run_is_extended_by_its_name test "$code" = 0
refused a_complete_run_without_checkpoint 4 'walls.nc is complete, and has no checkpoint to go on from: run it again' \
    resume walls.nc --end 4
cp kept.nc lonely.nc
refused a_killed_run_without_checkpoint 4 "s, but no checkpoint (lonely.ckpt) to continue from: start again with '$program run swimmer.yaml" \
    resume lonely.nc
rm -f ./*.nc ./*.ckpt*

# ---- one run at a time, signals that are ignored, and a signal within a long event

rm -f ./*.nc ./*.ckpt*
start run swimmer.yaml --set time.end=100 --set time.checkpoint_interval=0.2 -o run.nc
wait_for test -s run.ckpt
refused locked 4 "run.nc: another run writes this result: wait until" run swimmer.yaml -o run.nc --force
mkdir beside
ln run.nc beside/run.nc
wait_for cp run.ckpt beside/run.ckpt  # which the run replaces all the time
refused a_hard_link_has_the_same_lock 4 "beside/run.nc: another run writes this result" resume beside/run.ckpt --end 200
refused for_a_new_run_too 4 "beside/run.nc: another run writes this result" run swimmer.yaml -o beside/run.nc --force
ln -sf ../run.nc beside/run.nc
refused a_link_is_not_resumed 4 "beside/run.nc is a link" resume beside/run.ckpt --end 200
check nothing_is_left_beside test "$(ls beside)" = "$(printf 'run.ckpt\nrun.nc')"
rm -r beside
end TERM
check a_run_leaves_no_part test ! -e run.nc.part
rm -f ./*.nc ./*.ckpt*
(trap '' HUP && exec "$program" run swimmer.yaml -q --set time.end=100 -o run.nc >out 2>err </dev/null) &
pid=$!
wait_for test -s run.nc
kill -HUP "$pid"
sleep 0.3
check an_ignored_signal_stays_ignored kill -0 "$pid"
end TERM
check the_others_do_not test "$code" = 75
rm -f ./*.nc ./*.ckpt*
mkdir "it's a folder"
run run swimmer.yaml -q --max-wall 0:00:01 --set time.end=1000 -o "it's a folder/run.nc"
check max_wall eval 'test "$code" = 75 && has err "stopped after --max-wall at t = "'

# the command in a message is one for a shell
sed -n "s/.*continue with '\(.*\)'\$/\1/p" err >command.sh
echo "$(<command.sh) -q --max-wall 0:00:01" >again.sh
shoal() { run "$@"; }
code=0
# shellcheck source=/dev/null
. ./again.sh
check and_is_one_for_a_shell test "$code" = 75
run run swimmer.yaml -q --set time.end=1000 -o "it's a folder/run.nc"
check the_other_message_too has err "with 'shoal resume 'it'\\''s a folder/run.ckpt'', or"

for method in "ida --set solver.rtol=1e-12 --set solver.max_steps=1000000000" "rk4 --set solver.step=1e-8"; do
    rm -f ./*.nc ./*.ckpt*
    # shellcheck disable=SC2086  # the method has options
    run_until TERM 'test -s run.nc' run swimmer.yaml -q --set time.shedding_interval=10 --set time.end=20 \
        --set time.output_interval=10 --set output.wake_interval=10 --set wake.lifetime=20 --set solver.max_steps=1000000000 \
        --set solver.method=$method -o run.nc
    check "a_long_event_is_left: ${method%% *}" eval '((code == 75)) && has err "stopped by a signal at t = 0 s"'
done

# a start that takes many seconds: there is no earlier event to return to
rm -f ./*.nc ./*.ckpt*
sed 's/nodes: [79], sheet_points: 21/nodes: 900, sheet_points: 900/' swimmer.yaml >large.yaml
run_until TERM 'sleep 0.2' run large.yaml -q -o run.nc
check a_long_start_is_left eval '((code == 75)) && has err "stopped by a signal during the event at t = 0" &&
    test ! -e run.nc -a ! -e run.ckpt'

# ---- members of a study

cat >study.yaml <<'CASE'
format: 1
time: {end: 4, shedding_interval: 0.01, output_interval: 0.02}
fish: [{}]
sweep: [{key: "fish[0].wave.amplitude", values: [0.2, 0.3]}]
CASE
run study study.yaml -j 1 -o whole
run_until TERM 'test -s parts/member-0000.nc' study study.yaml -q -j 1 -o parts
check a_study_is_stopped test "$code" = 75 -a -e parts/member-0000.ckpt
run study study.yaml -j 1 -o parts
check the_study_goes_on test "$code" = 0
place=$(places parts/member-0000.nc)
check a_stopped_member_is_resumed test -n "$place"
"$program" show study.yaml | sed '/^sweep:/,$d' >member.yaml
run run member.yaml -q --set "fish[0].wave.amplitude=0.2" --checkpoint-at "$place" -o member.nc
check its_bits_are_the_bits_of_the_run_with_the_same_checkpoint same parts/member-0000.nc member.nc
check the_other_member_has_the_same_bits same parts/member-0001.nc whole/member-0001.nc
run study study.yaml -q --members 1 -o longer --set time.end=0.1 --set time.checkpoint_interval=0.1
run resume longer/member-0001.ckpt -q --end 0.2
check a_member_with_another_end_keeps_its_number eval '((code == 0)) && ncdump -h longer/member-0001.nc | grep ":study_member = 1 ;"'

finish

#!/usr/bin/env bash
# Two studies in one folder may run different members at the same time, but never the same member.
#
#   tests/study/test_study_lock.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

cat >study.yaml <<'end'
format: 1
name: slow
time: {end: 1000, shedding_interval: 0.02, output_interval: 1}
fish: [{force: reactive, nodes: 7, sheet_points: 9}]
sweep: [{key: "fish[0].wave.amplitude", values: [0.2, 0.25, 0.3]}]
end

# Start a long study, and wait for the start.
start() {  # folder, options...
    env --default-signal=TERM "$program" study study.yaml -q -o "$@" >"$1.out" 2>"$1.err" </dev/null &
    pid=$!
    wait_for compgen -G "$1/member-*.nc"
}
end() {
    kill -TERM $pid
    code=0
    wait $pid || code=$?
    pid=
}

start all -j 1
refused a_second_study_is_refused_at_once 4 "all: another study runs some of the same members" \
    study study.yaml -q -o all --set time.end=0.1
for members in 0 1-2; do
    refused "and so is one of its members $members" 4 'another study runs some of the same members' study study.yaml -q -o all --members $members
done
check nothing_is_said_of_a_member_that_runs test -z "$(ls all/*.failed 2>/dev/null)"
end
check the_first_one_has_been_stopped_and_not_failed test "$code" = 75 -a ! -e all/study.lock
run study study.yaml -q -o all --members 1 --force --set time.end=0.1
check then_it_may_be_run test "$code" = 0

start part --members 1 -j 1
env --default-signal=TERM "$program" study study.yaml -q -o part --members 2 -j 1 >out 2>err </dev/null &
other=$!
wait_for test -s part/member-0002.nc
check other_members_may_run_at_the_same_time kill -0 $other
kill -TERM $other
wait $other
check the_lock_stays_for_the_first test -e part/study.lock
refused which_still_has_its_member 4 'another study runs some of the same members' study study.yaml -q -o part
end
check the_last_one_removes_the_lock test "$code" = 75 -a ! -e part/study.lock

# a killed study leaves the lock file, which has no effect after the members have stopped
start killed -j 1
kill -KILL $pid
wait $pid 2>/dev/null
pid=
free() {
    run study study.yaml -q -o killed --force --set time.end=0.1
    ((code != 4))
}
wait_for free
check a_killed_study_locks_nothing test "$code" = 0 -a ! -e killed/study.lock

refused no_folder_is_made_for_a_wrong_range 2 'the study has members 0 to 2' study study.yaml -q -o new --members 3
check and_there_is_none test ! -e new

finish

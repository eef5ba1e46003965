#!/usr/bin/env bash
# However the program ends, by a signal, a limit or an exit inside a library, it prints one message; names with control
# characters are printed safely.
#
#   tests/app/test_exits.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

cat >swimmer.yaml <<'end'
format: 1
name: swimmer
time: {end: 0.1, shedding_interval: 0.02, output_interval: 0.02}
fish: [{force: reactive, nodes: 7, sheet_points: 9}]
end
cat >steady.yaml <<'end'
format: 1
name: steady
time: {end: 1, shedding_interval: 0.02}
fish: [{force: reactive, nodes: 9, sheet_points: 17, wave: {frequency: 1}}]
steady: {tolerance: 1.0e-10, beats: 5000}
end
ended() { ((code == $1)); }

# ---- a limit on CPU time

code=0
(ulimit -St 1 && exec "$program" run swimmer.yaml -q --set time.end=100000 --set time.output_interval=10) >out 2>err \
    </dev/null || code=$?
check the_soft_limit_of_CPU_time_stops_a_run ended 75
check it_says_how_to_go_on has err "continue with 'shoal resume swimmer.ckpt'"
run info swimmer.ckpt
check there_is_a_checkpoint ended 0

# ---- a closed pipe for messages ends no command, a closed pipe for output the usual way

sed 's/nodes: 7/nodes: 5/' swimmer.yaml >warned.yaml
code=0
{ "$program" check warned.yaml 2> >(exec true) >out; } || code=$?
check warnings_to_a_closed_pipe_end_no_check ended 0
check warnings_to_a_closed_pipe_end_no_estimate has out "warned.yaml: ok"
for command in keys "show swimmer.yaml"; do
    code=0
    # shellcheck disable=SC2086 # words
    (sleep 0.3 && exec "$program" $command) > >(exec true) 2>err || code=$?
    check "output to a closed pipe: SIGPIPE ($command)" ended 141
done
code=0
(sleep 0.3 && exec "$program" run swimmer.yaml --force -o piped.nc) > >(exec true) 2>err || code=$?
check the_result_of_a_run_with_a_closed_output_is_there test -s piped.nc
check a_run_with_a_closed_output_says_so ended 4

# ---- a search for a steady state cannot be resumed, and the message says so at every stage

for how in '' '--set steady.tolerance=0.001' "--set solver.rtol=1e-7"; do
    # shellcheck disable=SC2086 # options
    run_until TERM 'sleep 0.2' steady steady.yaml -q -o steady.nc --force $how
    ended 0 || check "a search that is stopped ($how)" eval \
        'ended 75 && grep -q "stopped by a signal in beat [0-9]* of the search\(, at a speed of .*\)\?; a search cannot be resumed: start the search again" err'
done
run steady steady.yaml -q -o steady.nc --force --max-wall 0:00:01
check max_wall_stops_a_search eval 'ended 75 && has err "stopped after --max-wall in beat "'
# some ten seconds of set-up
run_until TERM 'sleep 0.2' steady steady.yaml -q -o steady.nc --force --set 'fish[0].nodes=999' --set 'fish[0].sheet_points=1997'
check a_search_is_stopped_during_its_set_up eval 'ended 75 && has err "stopped by a signal before the search: start the search again"'
run steady --help
check help_promises_no_resumption_of_a_search test -z "$(grep 'resume goes on' out)"

# ---- a library that ends the program

if grep -q __asan_init "$program"; then
    skip a_library_that_ends_the_program "the address sanitizer has a malloc of its own"
elif ldd "$program" | grep libomp >/dev/null; then
    skip a_library_that_ends_the_program "the library of clang dies of a signal"
else
    shim=$(dirname "$program")/memory.so
    with_threads() {  # the first thread that cannot be started, arguments
        code=0
        LD_PRELOAD=$shim THREAD_AT=$1 "$program" "${@:2}" >out 2>err </dev/null || code=$?
    }
    cat >many.yaml <<'end'
format: 1
time: {end: 0.04, shedding_interval: 0.02, output_interval: 0.02}
fish: [{}, {start: {position: [0, 1]}}, {start: {position: [0, 2]}}, {start: {position: [0, 3]}}]
end
    # the program tries three threads, and then the library of OpenMP starts three
    for at in 1 4 5; do
        with_threads $at run many.yaml -q -o many.nc --force --threads 4
        check "threads from $at on cannot be started: exit code 4" ended 4
        check "it says so ($at)" eval 'grep -q "shoal: error: .*threads" err'
        check "no part stays ($at)" test ! -e many.nc.part
    done
    with_threads 7 run many.yaml -q -o many.nc --force --threads 4
    check enough_threads ended 0
    { cat many.yaml && echo 'solver: {threads: 4}' && echo 'sweep: [{key: "fish[0].wave.amplitude", values: [0.2, 0.3]}]'; } \
        >study.yaml
    with_threads 4 study study.yaml -q -j 1 -o study
    check a_member_that_a_library_ends_has_a_reason eval 'ended 1 && has study/member-0000.failed "fewer threads"'
    check its_part_is_gone test ! -e study/member-0000.nc.part
fi

# ---- names with control characters

odd=$'odd\e[31m\a.nc'
clean() { ! LC_ALL=C grep -q $'[\e\a\r\x7f]' out err; }
cp swimmer.yaml $'case\e[31m.yaml'
run run $'case\e[31m.yaml' -o "$odd"
check a_path_is_printed_without_control_characters eval 'ended 0 && clean && has out "odd\\x1b[31m\\x07.nc"'
for arguments in "info" "view" "export --vtk vtk" "field --grid 3,3" "run" "resume" "steady" "study" "check" "show" "compare"; do
    # shellcheck disable=SC2086 # options
    run $arguments "$odd"
    check "$arguments prints none either" clean
done
run gather $'no\e[31m'
check a_message_has_none eval 'ended 4 && clean && has err "no\x1b[31m"'
printf 'format: 1\nname: a\e[31m\n' >raw.yaml
run check raw.yaml
check a_line_of_a_case_has_none eval 'ended 2 && clean'
# the content of a file may be arbitrary
sed 's/^name: swimmer/name: TITLES/' swimmer.yaml >title.yaml
run run title.yaml -q -o title.nc
LC_ALL=C sed -i $'s/TITLES/\e[31m!/' title.nc
run info title.nc
check the_title_of_a_result_has_none eval 'ended 0 && clean && has out "\x1b[31m!"'

finish

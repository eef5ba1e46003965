#!/usr/bin/env bash
# The program survives faults of the system around it: a sample of failing calls (`make soak` tries all of them), closed
# standard files, closed pipes, ignored signals, and threads and memory that are not there.
#
#   tests/extra/test_faults.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

cat >swimmer.yaml <<'end'
format: 1
name: swimmer
time: {end: 0.2, shedding_interval: 0.01, output_interval: 0.02}
fish: [{force: reactive, nodes: 9, sheet_points: 17, body: {tail_thickness: 0.3}}]
end
ended() { ((code == $1)); }
# the attribute of a file that holds whole rows
complete() { [[ $(ncdump -h "$1" | sed -n 's/.*:run_status = "\(.*\)" ;/\1/p') == complete ]]; }

# ---- failing calls

# All must pass.
sample() {  # name, script of tests/soak, arguments
    /usr/bin/python3 "$root/tests/soak/$2" "$program" "${@:3}" >sample.out 2>&1
    check "$1" grep -q '^[1-9][0-9]* passed, 0 failed, 0 skipped$' <(tail -n 1 sample.out)
    ((n_failed == 0)) || cat sample.out
}
sample "a sample of failing calls: whole rows, one message, exit code 0 or 4" faults.py 89

# the flush of the note that a run is complete
said=
for ((i = 1; i < 20; i++)); do
    code=0
    ASAN_OPTIONS=verify_asan_link_order=0:detect_leaks=0 LD_PRELOAD=$(dirname "$program")/files.so FAULT_PATH=last.nc \
        FAULT_CALL=fsync FAULT_AT=$i FAULT_HOW=EIO "$program" run swimmer.yaml -q --force -o last.nc >out 2>err || code=$?
    ! grep -q 'last.nc: cannot be closed (Input/output error): the last rows may be missing' err ||
        said+="$code $(ncdump -h last.nc | sed -n 's/.*:run_status = "\(.*\)" ;/\1/p')"
done
check "a result that cannot be closed says so" test "$said" = "4 failed: the last rows could not be written"

# ---- standard files

for closed in '<&-' '>&-' '2>&-' '<&- >&- 2>&-'; do
    code=0
    eval "\"\$program\" run swimmer.yaml --force -o closed.nc $closed" || code=$?
    # failing output is an error, after the result is complete
    if [[ $closed == *' >&-'* || $closed == '>&-' ]]; then want=4; else want=0; fi
    check "closed $closed: exit code $want" ended $want
    check "closed $closed: the result is complete and nothing else is in it" complete closed.nc
    check "closed $closed: it can be read" "$program" info closed.nc
done 2>/dev/null
code=0
{ "$program" run swimmer.yaml --force -o pipe.nc 2> >(exec true) >out; } || code=$?
check "a closed pipe for progress: exit 0" ended 0
check "a closed pipe for progress: complete" complete pipe.nc

# ---- signals

code=0
(trap '' INT HUP && exec "$program" run swimmer.yaml -q --force -o ignored.nc --set time.end=1) >out 2>err &
pid=$!
for signal in INT HUP INT; do
    sleep 0.1
    kill -$signal $pid 2>/dev/null
done
wait $pid || code=$?
check "signals that are ignored: exit 0" ended 0
check "signals that are ignored stay so" complete ignored.nc

# ---- threads and memory

if grep -q __asan_init "$program"; then
    skip "little memory" "the address sanitizer needs all of it"
else
    sample "every command without one of its allocations, or with little memory: exit code 0, or 4 and one message" \
        memory.py 401 9000
    limited() {  # kilobytes, arguments
        code=0
        (ulimit -v "$1" && exec timeout "$time_limit" "$program" "${@:2}") >out 2>err </dev/null || code=$?
    }
    limited 300000 run swimmer.yaml -q --force -o threads.nc --threads 64
    check "threads that cannot be started: exit 4" ended 4
    check "threads that cannot be started: says so" grep -q 'of 64 threads can be started' err
fi

finish

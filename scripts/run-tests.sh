#!/usr/bin/env bash
# Run test programs and print a report.
#
#   scripts/run-tests.sh PROGRAM TEST...
#
# A TEST with the suffix .sh or .py is a script, which gets PROGRAM as its argument and ends with the line "N passed, N failed,
# N skipped". Any other TEST is a cmocka program. The tests begin in the order given, and one more runs at a time than there
# are processors, because some of them wait. The report has the whole output of what failed. A test that crashes, exits
# early, runs longer than the limit or tests nothing has failed. The limit grows with the load of the machine.
# Each test has a line with its wall and CPU time, and the ten that take most are named at the end.
# The last line printed is the sum: "N passed, N failed, N skipped".
set -euo pipefail

readonly time_limit=${TIME_LIMIT:-300}  # seconds for one test on a machine that does nothing else
readonly at_once=$(($(nproc) + 1))

if (($# < 1)); then
    echo "usage: scripts/run-tests.sh PROGRAM TEST..." >&2
    exit 2
fi
program=$1
shift
tests=("$@")

folder=$(mktemp -d)
stop() {
    local pids
    mapfile -t pids < <(jobs -p)
    ((${#pids[@]} == 0)) || kill "${pids[@]}" 2>/dev/null || true
    rm -rf "$folder"
}
trap stop EXIT
trap 'exit 130' INT TERM

# the test programs share the processors: waiting threads sleep after microseconds, as in the program (src/app/main.c)
export GOMP_SPINCOUNT=${GOMP_SPINCOUNT-4000}
export PYTHONDONTWRITEBYTECODE=1
# the sanitizers, when built in: show the stack, also where cmocka would catch the signal
export UBSAN_OPTIONS=print_stacktrace=1 ASAN_OPTIONS=handle_segv=2:handle_sigfpe=2
# memory kept by clang's OpenMP for its threads is not a leak of shoal
echo 'leak:libomp.so' >"$folder/leaks"
export LSAN_OPTIONS=suppressions=$folder/leaks:print_suppressions=0
# that for threads: libraries that are not built for it are not watched; Archer tells it what OpenMP does (Debian keeps it
# where nobody looks)
export TSAN_OPTIONS=ignore_noninstrumented_modules=1
archer=$(printf '%s\n' /usr/lib/llvm-*/lib/libarcher.so | tail -n 1)
[[ ! -e $archer ]] || export OMP_TOOL_LIBRARIES=$archer

# Sums of a cmocka program: "passed failed skipped". An announced test that neither passed nor was skipped has failed.
count_cmocka() {
    awk '/^\[==========\] .*Running [0-9]+ test/ { announced += $(NF - 1); running = 1 }
         /^\[==========\] .*[0-9]+ test\(s\) run/ { running = 0 }
         running && /\[       OK \]/ { passed++ }
         running && /\[  SKIPPED \]/ { skipped++ }
         END { print passed + 0, announced - passed - skipped, skipped + 0 }' "$1"
}

# Sums of a script: the last line.
count_script() {
    local counts
    counts=$(tail -n 1 "$1" | sed -n 's/^\([0-9]\+\) passed, \([0-9]\+\) failed, \([0-9]\+\) skipped$/\1 \2 \3/p')
    echo "${counts:-0 0 0}"
}

# Start test number $1 in the background; standard input is empty, so that nothing can wait for an answer.
start() {
    local command=("${tests[$1]}")
    [[ ${tests[$1]} != *.sh ]] || command=(bash "${tests[$1]}" "$program")
    [[ ${tests[$1]} != *.py ]] || command=(/usr/bin/python3 "${tests[$1]}" "$program")
    local load
    read -r load _ </proc/loadavg
    limits[$1]=$((time_limit * (at_once + ${load%.*}) / at_once))
    started[$1]=$EPOCHREALTIME
    (
        trap 'kill "$child" 2>/dev/null' TERM
        TIME_LIMIT=${limits[$1]} timeout --kill-after=10 "${limits[$1]}" "${command[@]}" >"$folder/$1" 2>&1 </dev/null &
        child=$! code=0
        wait "$child" || code=$?
        times >"$folder/$1.times"
        exit "$code"
    ) &
    number_of[$!]=$1
}

# CPU seconds, user and system, of test number $1 with all its processes: the second line of the shell's `times`.
cpu_seconds() {
    awk 'NR == 2 { gsub("s", ""); for (i = 1; i <= NF; i++) { split($i, t, "m"); sum += 60 * t[1] + t[2] } }
         END { printf "%.1f", sum }' "$folder/$1.times" 2>/dev/null || echo 0
}

# Print the line of test number $1, and the output of a failed test; add to the sums.
report() {
    local name=${tests[$1]} code=${exit_code[$1]} passed failed skipped note=''
    case $name in
        *.sh | *.py) read -r passed failed skipped < <(count_script "$folder/$1") ;;
        *) read -r passed failed skipped < <(count_cmocka "$folder/$1") ;;
    esac
    if ((code == 124 || code == 137)); then
        note="stopped after ${limits[$1]} s"
    elif ((code > 128)); then
        note="died of signal $((code - 128))"
    elif ((passed + failed + skipped == 0)); then
        note="ran no test (exit code $code)"
    elif ((code != 0 && failed == 0)); then
        note="exit code $code"
    fi
    if [[ -n $note ]] && ((failed == 0)); then failed=1; fi

    ((failed == 0)) || sed 's/^/    /' "$folder/$1"
    cpu[$1]=$(cpu_seconds "$1")
    printf '%-34s %4d passed %3d failed %3d skipped %7s s %7s s CPU%s\n' "${name##*/}" "$passed" "$failed" "$skipped" \
        "${seconds[$1]}" "${cpu[$1]}" "${note:+  $note}"
    all_passed=$((all_passed + passed))
    all_failed=$((all_failed + failed))
    all_skipped=$((all_skipped + skipped))
}

declare -A number_of
limits=() started=() exit_code=() seconds=() cpu=()
all_passed=0 all_failed=0 all_skipped=0
next=0 shown=0 running=0
while ((shown < ${#tests[@]})); do
    while ((running < at_once && next < ${#tests[@]})); do
        start "$next"
        next=$((next + 1))
        running=$((running + 1))
    done

    code=0
    wait -n -p pid 2>/dev/null || code=$?  # the shell's own words on a crash are not needed
    i=${number_of[$pid]}
    exit_code[i]=$code
    microseconds=$((${EPOCHREALTIME/[.,]/} - ${started[i]/[.,]/}))
    seconds[i]=$((microseconds / 1000000)).$((microseconds / 100000 % 10))
    running=$((running - 1))

    while ((shown < ${#tests[@]})) && [[ -n ${exit_code[shown]-} ]]; do
        report "$shown"
        shown=$((shown + 1))
    done
done

if ((${#tests[@]} > 10)); then
    for i in "${!tests[@]}"; do echo "${cpu[i]} ${tests[i]##*/}"; done | sort -rn |
        awk -v n="${#tests[@]}" '{ sum += $1; if (NR <= 10) slowest = slowest (NR > 1 ? ", " : "") $2 " " $1 }
            END { printf "CPU seconds: %.0f for %d programs, most for %s\n", sum, n, slowest }'
fi
if ((all_passed + all_failed + all_skipped == 0)); then
    echo "no test was found" >&2
    all_failed=1
fi
echo "$all_passed passed, $all_failed failed, $all_skipped skipped"
((all_failed == 0))

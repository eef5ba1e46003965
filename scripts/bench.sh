#!/usr/bin/env bash
# Measure the program: inner loops and trees, phases of runs, schools, whole processes.
#
#   scripts/bench.sh BUILD      BUILD: the folder with shoal and bench/
#
# The exit code is 3 if a limit is missed. doc/performance.md explains the numbers. The machine should be idle.
set -euo pipefail

build=$(realpath "${1:?usage: scripts/bench.sh BUILD}")
program=$build/shoal
root=$(realpath "$(dirname "$0")/..")
cases=$root/cases
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

# Run a program of tests/bench with the thread settings of shoal (src/base/parallel.h).
bench() {
    local name=$1
    shift
    GOMP_SPINCOUNT=4000 OMP_PROC_BIND=true "$build/bench/$name" "$@"
}

# Print the heading of a table.
heading() {
    printf '\n== %s\n\n' "$1"
}

# Run a command; print wall seconds, CPU seconds and peak memory in MB.
measured() {
    /usr/bin/python3 "$root/tests/bench/measured.py" "$@"
}

# A count per event by `shoal info` of the result run.nc: steps, newton_iterations or jacobian_evaluations.
per_event() {
    "$program" info run.nc | awk -v name="$1" '$1 == name { print $3 }'
}

# Compare a number with its limit: what, number, limit. Limits are ratios within this run: seconds are those of one
# machine.
check_limit() {
    local result=ok
    if awk "BEGIN { exit !($2 > $3) }"; then
        result=MISSED
        missed=1
    fi
    printf '%-58s %10s %10s  %s\n' "$1" "$2" "$3" "$result"
}

# Run a case and print one line: name, file, threads. Leaves the wall clock in $wall.
whole_run() {
    local name=$1 case=$2 threads=$3 cpu memory simulated
    read -r wall cpu memory < <(measured "$program" run "$case" -q --force --threads "$threads" -o run.nc)
    [[ -n ${memory-} ]] || exit 1
    simulated=$("$program" info run.nc | sed -n 's/.* to \([0-9.]*\) s;.*/\1/p')
    printf '%-12s %7s %8s %8s %8.2f %7s %7s %7s %7s\n' "$name" "$threads" "$wall" "$cpu" \
        "$(awk "BEGIN { print $simulated / $wall }")" "$memory" "$(per_event steps)" \
        "$(per_event newton_iterations)" "$(per_event jacobian_evaluations)"
}

# Stop the run of a case in the middle of a long event or a long start: name, arguments of run. Leaves the seconds that it
# takes to end in $seconds.
stopped_run() {
    local name=$1 pid started code=0
    shift
    env --default-signal=TERM "$program" run "$@" -q --force -o stopped.nc 2>/dev/null </dev/null &
    pid=$!
    sleep 2
    started=$EPOCHREALTIME
    kill -TERM "$pid"
    wait "$pid" || code=$?
    seconds=$(awk "BEGIN { printf \"%.2f\", $EPOCHREALTIME - $started }")
    ((code == 75)) || { echo "$name: exit code $code, not 75" >&2; exit 1; }
    printf '%-58s %10s\n' "$name" "$seconds"
}

# A number of phases.txt: name, threads, column.
column() {
    awk -v name="$1" -v threads="$2" -v n="$3" '$1 == name && $2 == threads { print $n }' phases.txt
}

missed=0
heading 'Inner loops (tests/bench/kernels.c)'
bench kernels
heading 'Where the time goes (tests/bench/phases.c)'
bench phases "$cases" | tee phases.txt
heading 'Schools with full wakes (tests/bench/phases.c)'
bench phases "$cases" --schools | tee schools.txt

heading 'Tables of doc/performance.md'
"$root/scripts/measure/performance.py" --program "$program" real_time growth peers

heading 'Whole processes with their output'
printf '%-12s %7s %8s %8s %8s %7s %7s %7s %7s\n' '' threads 'wall s' 'cpu s' 'x real' MB steps Newton Jacob.
whole_run single_free "$cases/single_free.yaml" 1
whole_run diamond "$cases/diamond.yaml" 1
one=$wall
whole_run diamond "$cases/diamond.yaml" 2
two=$wall
whole_run school "$cases/school.yaml" 1
whole_run school "$cases/school.yaml" 2

heading 'Two threads where a busy loop takes one of two cores: wall s'
mapfile -t cores < <(taskset -cp $$ | sed 's/.*: //' | tr ',' '\n' | awk -F- '{ for (i = $1; i <= $NF; i++) print i }')
beside=0
printf '%-12s %12s %12s %12s\n' '' 'one thread' 'two threads' 'two/one'
if ((${#cores[@]} > 1)); then
    taskset -c "${cores[0]}" bash -c 'while :; do :; done' &
    busy=$!
    trap 'kill "$busy" 2>/dev/null; rm -rf "$folder"' EXIT
    for fish in 16 64; do
        {
            printf '%s\n' 'format: 1' "name: school$fish" "time: {end: $((fish == 16 ? 4 : 2)), shedding_interval: 0.01, output_interval: 1}" fish:
            for ((f = 0; f < fish; f++)); do
                printf '  - {start: {position: [%d, %d]}, wave: {phase: %d}}\n' $((3 * (f % 4))) $((f / 4)) $((f / 4 % 2 * 180))
            done
        } >"school$fish.yaml"
        for threads in 1 2; do
            read -r wall _ < <(measured taskset -c "${cores[0]},${cores[1]}" "$program" run "school$fish.yaml" -q --force \
                --threads $threads -o run.nc)
            ((threads > 1)) || one_thread=$wall
        done
        ratio=$(awk "BEGIN { printf \"%.2f\", $wall / $one_thread }")
        printf '%-12s %12s %12s %12s\n' "$fish fish" "$one_thread" "$wall" "$ratio"
        beside=$(printf '%s\n' "$beside" "$ratio" | sort -g | tail -1)
    done
    kill "$busy"
else
    echo 'this machine has one core'
fi

heading 'Stiffness: one fish, 2 s, published second moment, 100 events per second'
printf '%-12s %8s %7s %7s %7s\n' 'modulus Pa' 'wall s' steps Newton Jacob.
for modulus in 1e4 1e6 1e8 1e10; do
    read -r wall _ < <(measured "$program" run "$cases/demo.yaml" -q --force -o run.nc --set time.end=2 \
        --set "fish[0].body.second_moment=published" --set "fish[0].body.modulus=$modulus")
    printf '%-12s %8s %7s %7s %7s\n' "$modulus" "$wall" "$(per_event steps)" "$(per_event newton_iterations)" \
        "$(per_event jacobian_evaluations)"
done

heading 'Stopped by a signal: seconds to the end'
long_event=(--set time.shedding_interval=10 --set time.end=20 --set time.output_interval=10 --set output.wake_interval=10
    --set wake.lifetime=20 --set solver.max_steps=1000000000)
stopped_run 'in an event of hours, ida' "$cases/demo.yaml" "${long_event[@]}" --set solver.rtol=1e-12
slowest=$seconds
stopped_run 'in an event of hours, rk4' "$cases/demo.yaml" "${long_event[@]}" --set solver.method=rk4 --set solver.step=1e-8
slowest+=" $seconds"
stopped_run 'in a start of seconds, 600 nodes and points a fish' "$cases/pair.yaml" --set 'fish[0].nodes=600' \
    --set 'fish[0].sheet_points=600' --set 'fish[1].nodes=600' --set 'fish[1].sheet_points=600'
slowest=$(printf '%s\n' $slowest "$seconds" | sort -g | tail -1)

heading 'Checks before a run: CPU s'
slowest_check=0
check_of() {  # name, arguments of check
    local name=$1 wall cpu
    shift
    read -r wall cpu _ < <(measured "$program" check -q "$@")
    printf '%-58s %10s\n' "$name" "$cpu"
    slowest_check=$(printf '%s\n' "$slowest_check" "$cpu" | sort -g | tail -1)
}
printf '%s\n' 'format: 1' 'time: {end: 2000, shedding_interval: 0.01}' 'wake: {lifetime: 2000}' 'fish: [{}]' >long.yaml
awk 'BEGIN { print "format: 1\ntime: {end: 10}\nfish:"
             for (i = 0; i < 150; i++) printf "  - {start: {position: [%g, %g]}}\n", i % 10 * 2, int(i / 10) / 2 }' >many.yaml
check_of '200,000 vortices' long.yaml
check_of '200,000 vortices in a channel' long.yaml --set 'fluid.walls=[-1, 1]'
check_of '200,000 vortices without a tree' long.yaml --set wake.tolerance=0
check_of '150 fish' many.yaml
check_of 'a study of 88 members, of which some take long' "$cases/studies/stiffness.yaml"

heading 'Learning from Python (tests/bench/actions.py)'
/usr/bin/python3 "$root/tests/bench/actions.py" "$build/bench/actions" "$build/libshoal.so.0" | tee actions.txt

heading 'Limits'
printf '%-58s %10s %10s\n' '' here limit
check_limit 'single_free: CPU time over the lower bound' "$(column single_free 1 7)" 5
check_limit 'diamond: CPU time over the lower bound' "$(column diamond 1 7)" 3
check_limit 'diamond, 2 threads: CPU time over the lower bound' "$(column diamond 2 7)" 3
check_limit 'diamond: wall clock with 2 threads over that with 1' \
    "$(awk "BEGIN { printf \"%.2f\", $two / $one }")" 0.556
check_limit 'beside a busy loop: wall clock with 2 threads over that with 1' "$beside" 1.1
check_limit 'diamond: output, % of the CPU time' "$(column diamond 1 14)" 3
check_limit 'an action in Python: CPU time over that in C' "$(sed -n 's/.* ratio //p' actions.txt | head -1)" 1.2
check_limit 'environments: 1 thread over 2, actions a second' \
    "$(sed -n 's/.*with two (ratio \([0-9.]*\)).*/\1/p' actions.txt | awk '{ printf "%.2f", 1 / $1 }')" 0.556
check_limit 'seconds from a signal to the end' "$slowest" 10
check_limit 'CPU seconds of shoal check' "$slowest_check" 0.5
check_limit '256 fish: CPU time per event over that of 64' "$(awk '/^256 fish take/ { print $4 }' schools.txt)" 6
check_limit '64 to 1024 fish: power of the CPU time per event' "$(awk '/^(256|1024) fish take/ { growth += $NF / 2 }
    END { print growth }' schools.txt)" 1.15
for n in 16 64 256 1024; do
    check_limit "$n fish: wall clock with 2 threads over that with 1" \
        "$(awk -v n=$n '$1 == n && /times as fast/ { printf "%.2f", 1 / $4 }' schools.txt)" 0.588
done
exit $((missed ? 3 : 0))

#!/usr/bin/env bash
# Measure whole runs of a program on one core: time, memory, work of the solver.
#
#   scripts/bench.sh PROGRAM
#
# Exit code 3 if a limit is missed.
set -euo pipefail

program=$(realpath "${1:?usage: scripts/bench.sh PROGRAM}")
cases=$(realpath "$(dirname "$0")/../cases")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

# Run a command; print wall seconds, processor seconds and peak memory in MB.
measured() {
    /usr/bin/python3 - "$@" <<'EOF'
import resource, subprocess, sys, time
start = time.perf_counter()
code = subprocess.run(sys.argv[1:], stdin=subprocess.DEVNULL).returncode
wall = time.perf_counter() - start
used = resource.getrusage(resource.RUSAGE_CHILDREN)
if code:
    sys.exit(f"exit code {code}: {' '.join(sys.argv[1:])}")
print(f"{wall:.2f} {used.ru_utime + used.ru_stime:.2f} {used.ru_maxrss / 1024:.0f}")
EOF
}

# What `shoal info` says per event of the result run.nc: steps, newton_iterations or jacobian_evaluations.
per_event() {
    "$program" info run.nc | awk -v name="$1" '$1 == name { print $3 }'
}

# Run a case and print its line of the first table: name, limits in seconds and in MB.
whole_run() {
    local name=$1 most_seconds=$2 most_memory=$3 wall processor memory verdict=ok
    read -r wall processor memory < <(measured "$program" run "$cases/$name.yaml" -q --force -o run.nc)
    [[ -n ${memory-} ]] || exit 1
    if awk "BEGIN { exit !($wall > $most_seconds || $memory > $most_memory) }"; then
        verdict=MISSED
        missed=1
    fi
    local simulated
    simulated=$("$program" info run.nc | sed -n 's/.* to \([0-9.]*\) s;.*/\1/p')
    printf '%-12s %7s %7s %7.1f %7s %7s %7s %7s %6s %6s  %s\n' "$name" "$wall" "$processor" \
        "$(awk "BEGIN { print $simulated / $wall }")" "$memory" "$(per_event steps)" "$(per_event newton_iterations)" \
        "$(per_event jacobian_evaluations)" "$most_seconds" "$most_memory" "$verdict"
}

missed=0
printf '%-12s %7s %7s %7s %7s %7s %7s %7s %6s %6s\n' \
    '' 'wall' 'cpu' 'x real' 'memory' 'steps' 'Newton' 'Jacob.' 'limit' 'limit' \
    'case' 's' 's' 'time' 'MB' '/event' '/event' '/event' 's' 'MB'
whole_run single_free 4 150
whole_run diamond 20 150

printf '\nStiffness: one fish, 2 s, published second moment, 100 events per second\n'
printf '%-12s %7s %7s %7s %7s\n' 'modulus Pa' 'wall s' 'steps' 'Newton' 'Jacob.'
for modulus in 1e4 1e6 1e8 1e10; do
    read -r wall _ < <(measured "$program" run "$cases/demo.yaml" -q --force -o run.nc --set time.end=2 \
        --set "fish[0].body.second_moment=published" --set "fish[0].body.modulus=$modulus")
    printf '%-12s %7s %7s %7s %7s\n' "$modulus" "$wall" "$(per_event steps)" "$(per_event newton_iterations)" \
        "$(per_event jacobian_evaluations)"
done

if ((missed)); then
    echo 'a limit was missed' >&2
    exit 3
fi

#!/usr/bin/env bash
# Run test programs in C, and a run that is stopped and resumed, under valgrind. Every report counts as an error.
#
#   scripts/valgrind.sh PROGRAM TEST...
set -euo pipefail
program=$(realpath "$1")
shift
# reachable blocks belong to libraries
watch=(valgrind -q --error-exitcode=99 --leak-check=full --show-leak-kinds=definite --errors-for-leak-kinds=definite
    --child-silent-after-fork=yes)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
bad=0
report() {  # name, exit code, file
    if (($2 == 0)); then echo "$1: clean"; else echo "$1: exit code $2"; bad=1; cat "$3"; fi
}
for test in "$@"; do
    [[ $test != *.sh ]] || continue
    code=0
    "${watch[@]}" "$test" >"$folder/out" 2>&1 </dev/null || code=$?
    report "${test##*/}" $code "$folder/out"
done
cd "$folder"
cat >small.yaml <<'end'
format: 1
time: {end: 0.1, shedding_interval: 0.01, output_interval: 0.02}
fish: [{force: reactive, nodes: 7, sheet_points: 13}, {nodes: 7, sheet_points: 13, start: {position: [0, 1]}}]
end
printf 'sweep: [{key: solver.rtol, values: [1e-4, 1e-5]}]\n' | cat small.yaml - >study.yaml
for command in "check small.yaml" "run small.yaml -q --checkpoint-at 0.06" "info small.nc" "info small.ckpt" \
    "resume small.ckpt --end 0.2 -q" "field small.nc --at 0.1 --grid 4,4 -q -o field.nc" "view small.nc -q -o small.html" \
    "export small.nc -q --vtk vtk" "study study.yaml -q -j 1 -o study" "gather study"; do
    code=0
    # shellcheck disable=SC2086  # the command has options
    "${watch[@]}" "$program" $command >"$folder/out" 2>&1 </dev/null || code=$?
    report "shoal ${command%% *}" $code "$folder/out"
done
exit $bad

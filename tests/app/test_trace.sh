#!/usr/bin/env bash
# `shoal run --trace` and `shoal steady --trace` write a line for each attempted step, and the lines agree with the
# totals of the result.
#
#   tests/app/test_trace.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"
start_python

cat >pair.yaml <<'CASE'
format: 1
time: {end: 0.4, shedding_interval: 0.02}
fish: [{name: 'one, "two"', nodes: 9}, {name: three, nodes: 9, start: {position: [0, 0.3]}}]
CASE

run run pair.yaml -q -o run.nc --trace trace.csv
check "run --trace: exit 0" test "$code" = 0
check "the trace agrees with the totals of the result" python "$root/tests/app/trace_totals.py" trace.csv run.nc
cp run.nc traced.nc
run run pair.yaml -q -o run.nc --force
check "a trace changes no bit" python "$root/tests/run/same_result.py" run.nc traced.nc
refused "an existing file is kept" 4 'the file exists: replace it with --force' run pair.yaml -q -o other.nc --trace trace.csv
run run pair.yaml -q -o run.nc --trace trace.csv --force
check "run --trace --force: exit 0" test "$code" = 0
refused "no folder" 4 'No such file or directory' run pair.yaml -q -o other.nc --trace nothing/trace.csv
refused "another method" 2 'only ida is traced, and solver.method is trapezoid' run pair.yaml -q -o other.nc \
    --trace other.csv --set solver.method=trapezoid --set solver.step=0.01
refused "a full disk" 4 'No space left on device' run pair.yaml -q -o other.nc --trace /dev/full --force

run steady "$root/cases/demo.yaml" -q -o steady.nc --trace steady.csv --set steady.tolerance=0.05 \
    --set steady.multipliers=false --set "fish[*].nodes=9" --set time.shedding_interval=0.05
check "steady --trace: exit 0" test "$code" = 0
check "steady --trace: a line for each step" grep -q '^20,.*,accepted,' steady.csv

# a run that fails ends with the attempts of its last step
cat >turn.yaml <<'CASE'
format: 1
preset: published
time: {end: 1, shedding_interval: 0.01}
wake: {removed_circulation: dropped}
fish: [{name: fish, start: {heading: 45, speed: 2}, wave: {ramp: 0}, drag: {normal: 0.5},
        control: {law: heading, desired_heading: 135, filter: 1}}]
CASE
run run turn.yaml -q -o failed.nc --trace failed.csv
check "a failing run: exit 1" test "$code" = 1
check "a failing run: its last attempts are in the trace" bash -c 'tail -n 1 failed.csv | grep -qE "newton,.*gamma\[3\]"'
finish

#!/usr/bin/env bash
# `shoal check` prints one verdict with everything that is known before the first step, and does so without a whole run.
#
#   tests/app/test_check.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

cases=$root/cases
readonly demo="$cases/demo.yaml"

ended() { ((code == $1)); }
silent() { [[ ! -s out && ! -s err ]]; }

# The number before a unit in the estimate of the last check.
estimated() {  # UNIT
    awk -v unit="$1" '/ on this machine/ { for (i = 2; i <= NF; i++) if ($i == unit) { print $(i - 1); exit } }' out
}

is_below() { awk -v value="$1" -v limit="$2" 'BEGIN { print value, limit; exit !(value > 0 && value < limit) }'; }

estimates() {
    run check "$demo"
    check "time and memory are estimated" \
        grep -qE '^    the run takes about [0-9.e+]+ (s|min|h) and ([0-9]\.[0-9]|[1-9][0-9]+) MB on this machine: estimated from a few events, often within a factor of two$' out
    local of_one
    of_one=$(estimated MB)
    run check "$cases/studies/phase.yaml" --set time.end=1
    check "the runs of a study add up" grep -q '^    the runs take about .* on this machine, one after the other' out
    # 12 members of two fish; sanitizers keep the freed memory of the members that the estimate examines
    check "which run one after the other in the memory of one" is_below "$(estimated MB)" $((5 * ${of_one%.*}))
}

one_verdict() {
    run check "$demo" --set solver.max_steps=1
    check "a case whose integration fails is not ok" ended 1
    check "which is all that is said" test ! -s out
    check "with the message of the run" grep -q 'solver.max_steps' err
    run check "$demo" --set solver.max_steps=1 -q
    check "nor is it with -q" ended 1
    run check "$demo" --set 'sweep=[{key: solver.max_steps, values: [1, 2]}]'
    check "without a member that does not fail there is no estimate" has out "no estimate of the run time: all estimated members failed"
    # member 10 of 11 goes wrong at once: a result of the study
    run check "$cases/studies/vibration.yaml"
    check "members that fail are results of a study" ended 0
    check "and are told" grep -q '^    1 of [0-9]* members fails in the first events; member 10: unstable' out
}

before_the_first_step() {
    run check "$demo" --set time.shedding_interval=0.3 --set time.output_interval=0.3
    check "few events in a beat: no error" ended 0
    check "few events in a beat: a warning" has err "shoal: warning: a beat of fish has only 3.33 events"
    run check "$demo" --set 'fish[0].body.modulus=1e5'
    check "slow bending modes" has err "shoal: warning: the slowest bending mode of fish has"
    run check "$demo" --set 'fish[0].wave.frequency=0' --set 'fish[0].motion.prescribed=all' --set 'fish[0].motion.speed=1' \
        --set 'fish[0].sheet_points=49' --set 'time.shedding_interval=0.001'
    check "few sheet points for a given speed" has err "shoal: warning: fish swims"
    printf '%s\n' 'format: 1' 'time: {end: 1}' 'contact: {action: warn}' \
        'fish: [{body: {profile: uniform, thickness: 0.1}}, {body: {profile: uniform, thickness: 0.1},' \
        '  start: {position: [0, 0.115]}}]' >near.yaml
    run check near.yaml
    check "bodies that begin near each other" has err "shoal: warning: fish1 and fish2 come within"

    run run "$demo" --set time.end=0.1 -o demo.nc -q
    # few members of few nodes, so that a slow machine examines all members
    run check "$demo" --set 'fish[0].nodes=9' --set 'sweep=[{key: "fish[0].body.modulus", values: [1e5, 9e4, 1e7]}]'
    check "a study says which members" has err "shoal: warning: member 0 and 1 other: the slowest bending mode"
    check "and nothing of a result that is there" eval '! has err "demo.nc"'
    run check "$demo" -q --set 'fish[0].start.heading=3.14159'
    check "-q says nothing: no verdict, no note" silent
    run check "$demo"
    check "a result that is there: no error" ended 0
    check "a result that is there: a note" has err "shoal: note: demo.nc"
    run check "$demo" --set solver.threads=900 --set output.file=x/y.nc
    check "a folder that is not there: exit 4" ended 4
}

# A run of these takes hours. How many seconds a check takes is measured by `make bench`.
seconds_only() {
    printf '%s\n' 'format: 1' 'time: {end: 2000, shedding_interval: 0.01}' 'wake: {lifetime: 2000}' 'fish: [{}]' >long.yaml
    run check long.yaml
    check "200,000 vortices: hours of a run" grep -qE 'the run takes about [0-9.]+ (h|days) and [0-9.e+]+ MB' out
    run check "$cases/studies/stiffness.yaml"
    check "a study of 88 members, of which some take long: says of how many it knows" \
        grep -q 'estimated from a few events of [0-9]* members\?' out
}

# Lattices of default fish.
lattice() {  # N, FILE
    { printf '%s\n' 'format: 1' 'time: {end: 1}' 'fish:'
      awk -v n="$1" 'BEGIN { m = int(sqrt(n)); for (i = 0; i < n; i++)
          printf "  - {start: {position: [%g, %g]}}\n", 1.5 * (i % m), 0.6 * int(i / m) }'; } >"$2"
}

any_number_of_fish() {
    lattice 400 fish400.yaml
    run check fish400.yaml
    check "400 fish: ok" has out "fish400.yaml: ok: 400 fish"
    lattice 10000 fish10000.yaml
    run check fish10000.yaml
    check "10000 fish: ok" has out "fish10000.yaml: ok: 10000 fish"
    sed -i '$s/.*/  - {start: {position: [0.1, 0.01]}}/' fish10000.yaml
    run check fish10000.yaml
    check "10000 fish, of which two overlap" has err "fish[0] (fish1) and fish[9999] (fish10000) overlap at the start"
    run check "$demo" --set 'fish[0].nodes=5000'
    check "5000 nodes: no estimate" has out "no estimate of the run time: the first evaluation takes too long"
}

# At 1500 nodes the set-up takes over ten seconds. A signal ends the loops of the set-up.
signals_in_the_set_up() {
    run_until TERM 'sleep 0.2' run "$demo" --set 'fish[0].nodes=1500' -o slow.nc -q
    check "a run that is stopped in its set-up: exit 75" ended 75
    check "without a result" test ! -e slow.nc
}

estimates
any_number_of_fish
signals_in_the_set_up
one_verdict
before_the_first_step
seconds_only
finish

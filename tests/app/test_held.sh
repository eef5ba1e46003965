#!/usr/bin/env bash
# Thrust, power and efficiency of a held body have one definition in the file of a run, in its summary, in a steady
# state, in a study and in the table of the study.
#
#   tests/app/test_held.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"
start_python

# a thin plate that heaves at the reduced frequency omega c/(2 U) = 1, without friction
cat >plate.yaml <<'end'
format: 1
time: {end: 8, shedding_interval: 0.02, output_interval: 0.1}
fluid: {density: 1000, viscosity: 0}
steady: {multipliers: false, tolerance: 1e-4}
fish:
  - name: plate
    force: pressure
    sheet_points: 65
    pressure: {span: infinite, suction_limit: 0}
    start: {speed: 6.283185307179586}
    wave: {amplitude: 0, frequency: 0}
    body: {profile: uniform, thickness: 0.01, depth: 1}
    motion: {prescribed: all, heave: 0.02, frequency: 2}
end
# a foil that pitches too, so that heading and direction of travel differ, at rest in a stream
cat >foil.yaml <<'end'
format: 1
time: {end: 8, shedding_interval: 0.04, output_interval: 0.2}
fluid: {density: 1000, viscosity: 1e-6, velocity: [1.2, 0.9]}
steady: {multipliers: false, tolerance: 1e-5}
fish:
  - name: foil
    force: pressure
    pressure: {span: infinite}
    start: {heading: -143.13010235415598}
    wave: {amplitude: 0, frequency: 0}
    body: {profile: uniform, thickness: 0.12, depth: 1}
    motion: {prescribed: all, speed: 0, heave: 0.2, pitch: 20, pitch_phase: 90, frequency: 1}
end
for case in plate foil; do
    run run $case.yaml -q -o $case.nc
    run info $case.nc
    cp out $case.info
    run steady $case.yaml -q -o steady-$case.nc
    check "a_steady_${case}_is_found" test "$code" = 0
    run info steady-$case.nc
    cp out steady-$case.info
    { cat $case.yaml; echo 'sweep: [{key: solver.rtol, values: [1e-4]}]'; } >study-$case.yaml
    run study study-$case.yaml -o study-$case
    cp out study-$case.table
    { cat $case.yaml; echo 'sweep: [{key: solver.rtol, values: [1e-4], steady: true}]'; } >swept-$case.yaml
    run study swept-$case.yaml -o swept-$case
    cp out swept-$case.table
done

# Garrick (1936): |C|^2/Re C with Theodorsen's C(1) = 0.5394 - 0.1003 i; after 16 beats the wake is 16 beats long
check a_plate_has_one_thrust_power_and_efficiency python "$root/tests/app/held.py" plate 0.01 0.5580
check a_foil_in_a_stream_has_one_thrust_power_and_efficiency python "$root/tests/app/held.py" foil 0.005
check a_fish_that_swims_has_no_such_columns eval \
    'run run "$root/cases/swim.yaml" -q --set time.end=0.1 -o swim.nc; run info swim.nc; ! has out thrust'

finish

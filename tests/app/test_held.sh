#!/usr/bin/env bash
# Thrust, power and efficiency of a held body have one definition in the file of a run, in its summary, in a steady
# state, in a study and in the table of the study.
#
#   tests/app/test_held.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

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

cat >same.py <<'end'
"""The three numbers of a case in every place where they are shown, relative to those of the run; and in theory."""
import re
import sys
import netCDF4

def last(path, *names):
    data = netCDF4.Dataset(path)
    return [float(data[name][:].reshape(-1)[-1]) for name in names]

def columns(path, *heads):
    """Of the last row of the first table with these heads: numbers are right-aligned below their heads."""
    lines = open(path).read().splitlines()
    at = next(i for i, line in enumerate(lines) if all(re.search(rf"\b{head}\b", line) for head in heads))
    return [float(lines[at + 2][:re.search(rf"\b{head}\b", lines[at]).end()].split()[-1]) for head in heads]

def rows(path, *names):
    text = open(path).read()
    return [float(re.search(rf"^ *{name} +(\S+)", text, re.M)[1]) for name in names]

case, tolerance, theory = sys.argv[1], float(sys.argv[2]), sys.argv[3:]
true = ["mean_thrust", "mean_power", "efficiency"]
steady, shown = ["steady_thrust", "steady_power", "steady_efficiency"], ["thrust", "power", "efficiency"]
expected = last(f"{case}.nc", *true)
found = {
    "info": columns(f"{case}.info", *shown),
    "study.nc": last(f"study-{case}/study.nc", *true),
    "table of the study": columns(f"study-{case}.table", *shown),
    "steady": last(f"steady-{case}.nc", *steady),
    "rows of the steady state": last(f"steady-{case}.nc", *true),
    "steady, printed": rows(f"steady-{case}.info", "thrust", "power of muscle and drive", "efficiency"),
    "study of steady states": last(f"swept-{case}/study.nc", *steady),
    "its table": columns(f"swept-{case}.table", *shown),
}
problems = [f"{place}: {values}, not {expected}" for place, values in found.items()
            if any(abs(v / e - 1) > tolerance for v, e in zip(values, expected))]
speed = last(f"{case}.nc", "speed")[0]
if abs(expected[0] * speed / expected[1] / expected[2] - 1) > 1e-9:
    problems.append("efficiency is not thrust times speed over power")
data = netCDF4.Dataset(f"{case}.nc")
thrust = data["thrust"][-round(1 / data["time"][1]) - 1:, 0]
if abs((thrust[:-1].sum() + thrust[1:].sum()) / 2 / (len(thrust) - 1) / expected[0] - 1) > 0.05:
    problems.append("the mean of the thrust of the instant is another one")
if theory and abs(expected[2] / float(theory[0]) - 1) > 0.01:
    problems.append(f"efficiency {expected[2]}, in theory {theory[0]}")
sys.exit("; ".join(problems) or 0)
end
# Garrick (1936): |C|^2/Re C with Theodorsen's C(1) = 0.5394 - 0.1003 i; after 16 beats the wake is 16 beats long
check a_plate_has_one_thrust_power_and_efficiency /usr/bin/python3 same.py plate 0.01 0.5580
check a_foil_in_a_stream_has_one_thrust_power_and_efficiency /usr/bin/python3 same.py foil 0.005
check a_fish_that_swims_has_no_such_columns eval \
    'run run "$root/cases/swim.yaml" -q --set time.end=0.1 -o swim.nc; run info swim.nc; ! has out thrust'

finish

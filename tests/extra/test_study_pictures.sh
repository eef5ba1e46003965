#!/usr/bin/env bash
# Pictures of studies, of error budgets and of comparisons: `plot.py study` draws each kind, chooses the quantities of its
# panels, and refuses what has nothing to draw.
#
#   tests/extra/test_study_pictures.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

if ! /usr/bin/python3 -c 'import netCDF4, matplotlib' 2>err; then
    skip pictures 'python3-netcdf4 or python3-matplotlib is missing'
    finish
    exit
fi
start_python

draws() {  # file
    rm -f picture.png
    python "$root/scripts/plot.py" study "$1" picture.png >drawn && test -s picture.png
}

# ---- studies

cat >swimmer.yaml <<'end'
format: 1
time: {end: 0.2, shedding_interval: 0.02}
fish: [{force: reactive, nodes: 9, body: {relaxation_time: 0.001}}]
end
cat >refined.yaml <<end
format: 1
include: ["$root/cases/include/article.yaml"]
time: {end: 0.08}
solver: {rtol: 1e-8}
fish: [{body: {modulus: 1e5}}]
end
run study refined.yaml -o orders --set time.end=0.4 \
    --set 'sweep=[{key: time.shedding_interval, values: [0.01, 0.04, 0.02], refine: true}]'
check a_picture_of_orders draws orders/study.nc
run study refined.yaml -o groups \
    --set 'sweep=[{key: solver.rtol, values: [1e-4, 1e-5, 1e-6], refine: true}, {key: solver.order, values: [1, 2]}]'
check a_picture_of_groups draws groups/study.nc
run study swimmer.yaml -o methods --set 'sweep=[{key: "fish[*].wave.amplitude", values: [0.2, 0.3]},
    {keys: [solver.method, solver.max_steps], values: [[ida, 1000], [rk4, 1000], [euler, 2]]}]'
check a_picture_of_methods_of_which_one_failed draws methods/study.nc
run study swimmer.yaml -o map --set time.end=0.04 --set \
    'sweep=[{key: "fish[*].body.modulus", values: [1e4, 1e6]}, {key: "fish[*].wave.frequency", values: [1, 2]}]'
check a_map_over_two_axes draws map/study.nc
run study refined.yaml -o places --set time.end=0.04 --set time.shedding_interval=0.02 --set \
    'fish=[{name: one, force: reactive, nodes: 9}, {name: two, force: reactive, nodes: 9, start: {position: [0, 3]}}]' \
    --set 'sweep=[{key: "fish[1].start.position", values: [[1, 0.5], [2, 0.5]]}]'
check a_map_of_places draws places/study.nc

cat >held.yaml <<'end'
format: 1
time: {end: 3, shedding_interval: 0.05}
defaults: {fish: {force: reactive, nodes: 5, sheet_points: 11}}
fish: [{motion: {prescribed: head}}]
sweep: [{key: "fish[*].start.speed", values: [0.5, 1]}]
end
panels() { python "$root/tests/extra/panels.py" "$@"; }
run study held.yaml -o held
check a_picture_of_a_held_fish draws held/study.nc
check it_shows_what_holding_takes panels held/study.nc mean_thrust mean_power efficiency
run study held.yaml -o free --set 'fish[0].motion.prescribed=none'
check a_free_fish_that_starts_at_a_speed_is_not_held panels free/study.nc speed cost_of_transport strouhal
run study held.yaml -o heaving --set 'fish[0].wave={amplitude: 0, frequency: 0}' --set \
    'fish[0].motion={prescribed: head, surge: free, heave: 0.1, frequency: 1}'
check a_heaving_fish_has_cost_and_efficiency_of_its_heave panels heaving/study.nc speed cost_of_transport efficiency
run study held.yaml -q -o foil --set 'fish[0].wave={amplitude: 0, frequency: 0}' --set 'fluid.velocity=[1, 0]' --set \
    'fish[0].motion={prescribed: head, speed: 0, heave: 0.1, frequency: 1}' --set \
    'sweep=[{key: "fish[*].body.modulus", values: [1e5, 1e6]}]'
check a_foil_held_in_a_stream_has_thrust_and_efficiency panels foil/study.nc mean_thrust mean_power efficiency

# two of three levels need more steps than permitted
run study refined.yaml -o lonely --set time.end=0.04 --set time.shedding_interval=0.02 --set solver.method=rk4 \
    --set solver.max_steps=3 --set 'sweep=[{key: solver.step, values: [0.01, 0.005, 0.0025], refine: true}]'
check no_picture_without_errors eval '! draws lonely/study.nc && has drawn "no errors to draw"'
run study refined.yaml -o costs --set time.shedding_interval=0.01 --set 'fish[0].wave.ramp=0' --set 'sweep=[{
    keys: ["fish[*].body.modulus", solver.method, solver.step, solver.rtol],
    values: [[1e5, ida, 0, 1e-8], [1e5, ida, 0, 1e-5], [1e5, rk4, 1e-3, 1e-5], [1e5, euler, 1e-2, 1e-5]]}]'
check a_picture_of_costs draws costs/study.nc
check the_reference_does_not_compete has drawn '| 100000 | ida | rtol 1e-05 |'
check a_fixed_step_is_a_setting has drawn '| 100000 | rk4 | step 0.001 |'
check a_method_without_an_accurate_member_is_named has drawn '| 100000 | euler | none within 0.0001 m and 0.001 |'
run compare refined.yaml --repeats 1 -o compare.nc
check a_picture_of_a_comparison draws compare.nc
run run swimmer.yaml -q -o single.nc
check no_picture_of_one_run eval '! draws single.nc && has drawn "the file of a run, not of a study"'

# ---- errors

run error swimmer.yaml --of speed -o budget --set 'error={of: speed, keys: [nodes, rtol, smoothing]}'
check a_picture_of_the_budget draws budget/study.nc
run error swimmer.yaml --of speed -o along --sweep 'fish[*].body.modulus=1e6,2e6,3e6' \
    --set 'error={of: speed, confirm: false, keys: [nodes, rtol]}'
check a_picture_of_errors_along_a_sweep draws along/study.nc
sed 's/relaxation_time: 0.001/relaxation_time: 0.002/' swimmer.yaml >other.yaml
run error swimmer.yaml --of speed -o compared --against other.yaml --set 'error={of: speed, confirm: false, keys: [nodes, rtol]}'
check a_picture_of_another_case_beside draws compared/study.nc
run error swimmer.yaml --of speed -o sensitivities --sensitivity=modulus,length
check a_picture_of_sensitivities draws sensitivities/study.nc

# ---- a branch of steady states

cat >plate.yaml <<'end'
format: 1
time: {end: 5, shedding_interval: 0.05}
fluid: {density: 1, viscosity: 2e-3}
wake: {lifetime: 3, smoothing: 0.2}
steady: {tolerance: 1e-3}
fish:
  - name: plate
    nodes: 4
    sheet_points: 13
    force: pressure
    pressure: {span: infinite, suction_limit: 0}
    drag: {skin: laminar}
    start: {speed: 3.8}
    wave: {amplitude: 0, frequency: 0}
    body: {profile: uniform, thickness: 0.05, depth: 1, density: 20, modulus: 1e6}
    motion: {prescribed: all, surge: free, heave: 0.15, frequency: 1}
end
run steady plate.yaml --continue 'fish[*].motion.heave=0.15:0.14' -o branch
check_with "import scipy" a_picture_of_a_branch draws branch/study.nc

finish

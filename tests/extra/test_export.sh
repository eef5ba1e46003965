#!/usr/bin/env bash
# VTK reads the files that are written for other programs, and finds the numbers of the result in them.
#
#   tests/extra/test_export.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

cat >pair.yaml <<'end'
format: 1
time: {end: 0.6, shedding_interval: 0.02, output_interval: 0.1}
wake: {lifetime: 0.4, decay: 0.04}
output: {wake_interval: 0.2}
defaults: {fish: {wave: {ramp: 0.2}}}
fish: [{force: reactive, nodes: 9, sheet_points: 41}, {force: pressure, pressure: {span: infinite}, length: 0.7, nodes: 7, sheet_points: 33, start: {position: [1.4, 0.4]}}]
end
run run pair.yaml -q -o 'a <pair>.nc'
run export 'a <pair>.nc' --vtk out_of_it
check files_are_written test "$code" = 0
check the_list_is_named grep -qxF 'out_of_it/a _pair_.pvd' out
check there_is_a_file_of_bodies_for_each_row test "$(ls out_of_it | grep -c bodies)" = 7
check and_one_of_wakes_where_there_is_one test "$(ls out_of_it | grep -c wakes)" = 4
check and_none_of_walls test "$(ls out_of_it | grep -c walls)" = 0
refused existing_files_are_kept 4 'choose another folder with --vtk or replace it with --force' export 'a <pair>.nc' --vtk out_of_it
run export 'a <pair>.nc' --vtk out_of_it --force -q
check force_replaces_them test "$code" = 0 -a ! -s out
refused no_result 4 'nothing.nc' export nothing.nc --vtk out_of_it
refused no_format 2 'choose a format: --vtk FOLDER' export 'a <pair>.nc'
refused no_folder 4 'cannot make this folder: No such file' export 'a <pair>.nc' --vtk no/such
refused a_file_as_folder 4 'cannot make this folder: File exists: choose another name with --vtk' export 'a <pair>.nc' --vtk pair.yaml

check_with 'import vtkmodules' vtk_reads_the_numbers_of_the_result timeout "$time_limit" /usr/bin/python3 "$root/tests/extra/exported_numbers.py" 'a <pair>.nc'

# ---- names that look like keys

for name in plain 'section: nodes' 'force: pressure'; do
    cat >named.yaml <<end
format: 1
time: {end: 0.1, shedding_interval: 0.02, output_interval: 0.1}
fish: [{name: "$name", nodes: 5}, {name: other, nodes: 5, body: {section: nodes}, start: {position: [0, 1]}}]
end
    run run named.yaml -q -o named.nc --force
    run export named.nc -q --vtk named --force
    run view named.nc -q --force
    sed 's/"name":"[^"]*"//g' named.html >"$name.html"
    cat named/named-bodies-*.vtp >"$name.vtp"
    check "a fish with the name $name has its outline in files of VTK" cmp plain.vtp "$name.vtp"
    check "a fish with the name $name has its outline in the page" cmp plain.html "$name.html"
    check "a fish with the name $name has its outline in pictures" /usr/bin/python3 "$root/tests/extra/named_section.py" "$root"
done

# ---- walls

cat >channel.yaml <<'end'
format: 1
time: {end: 0.1, shedding_interval: 0.02, output_interval: 0.1}
fluid: {walls: [-0.5, 1.5]}
fish: [{nodes: 5, length: 0.5, start: {position: [10, 0]}}, {nodes: 5, length: 0.25, start: {position: [10.1, 1]}}]
end
run run channel.yaml -q -o channel.nc
run export channel.nc --vtk channel
check_with 'import vtkmodules' walls_are_lines timeout "$time_limit" /usr/bin/python3 "$root/tests/extra/exported_walls.py"

finish

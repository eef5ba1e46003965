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

cat >compare.py <<'end'
"""Compare what VTK reads with the result."""
import sys, xml.etree.ElementTree as tree
import netCDF4, numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

file = netCDF4.Dataset(sys.argv[1])
file.set_auto_mask(False)
listed = [one.attrib for one in tree.parse("out_of_it/a _pair_.pvd").iter("DataSet")]

def read(name):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName("out_of_it/" + name)
    reader.Update()
    return reader.GetOutput()

def array(data, name):
    return vtk_to_numpy(data.GetArray(name))

def same(name, got, want, atol=0):
    if got.shape != want.shape or not np.allclose(got, want, rtol=0, atol=atol):
        sys.exit(f"{name}: {got} is not {want}")

times = file["time"][:]
bodies = [one for one in listed if one["name"] == "bodies"]
wakes = [one for one in listed if one["name"] == "wakes"]
same("times", np.array([float(one["timestep"]) for one in bodies]), times, 1e-9)
for row, one in enumerate(bodies):
    data = read(one["file"])
    points = vtk_to_numpy(data.GetPoints().GetData())
    assert (data.GetNumberOfLines(), data.GetNumberOfPolys(), data.GetNumberOfPoints()) == (2, 2, 41 + 33 + 2 * 94)
    sheet = np.concatenate([file["sheet_x"][row, 0, :41], file["sheet_x"][row, 1, :33]])
    same("sheets", points[:74, :2], sheet)
    strength = np.concatenate([file["sheet_strength"][row, 0, :41], file["sheet_strength"][row, 1, :33]])
    same("strengths", array(data.GetPointData(), "sheet_strength")[:74], strength)
    # outlines begin in the nose, and have the tail half way
    for f, n in enumerate((9, 7)):
        outline = points[74 + 94 * f : 74 + 94 * (f + 1), :2]
        same("nose", outline[0], file["x"][row, f, 0], 1e-12)
        same("tail", outline[47], file["x"][row, f, n - 1], 1e-12)
        on_outline = array(data.GetPointData(), "sheet_strength")[74 + 94 * f : 74 + 94 * (f + 1)]
        inside = strength[:41] if f == 0 else strength[41:]
        # cosine points along the body, there and back
        arc = file["sheet_arc"][f, : inside.size]
        along = (1 - np.cos(np.pi * np.minimum(np.arange(94), 94 - np.arange(94)) / 47)) / 2 * arc[-1]
        same("strength of the outline", on_outline, np.interp(along, arc, inside), 1e-12)
    pressure, jump = array(data.GetPointData(), "pressure"), file["pressure"][row, 1]
    jump = jump[np.isfinite(jump)]
    assert np.isnan(pressure[:41]).all() and np.isnan(pressure[74:168]).all(), "a fish without pressure"
    on_body = np.concatenate([pressure[41:74], pressure[168:]])
    assert jump.min() <= on_body.min() and on_body.max() <= jump.max() and (row == 0 or np.ptp(on_body) > 0)
    arc = file["control_arc"][1][: jump.size]
    same("pressure", pressure[41:74], np.interp(file["sheet_arc"][1, :33], arc, jump), 1e-9)
    same("pressure of the outline", pressure[168:], np.interp(along, arc, jump), 1e-9)
    same("fish", array(data.GetCellData(), "fish"), np.array([0, 1, 0, 1]))
    same("kind", array(data.GetCellData(), "outline"), np.array([0, 0, 1, 1]))
    same("heading", array(data.GetCellData(), "heading"), np.tile(file["heading"][row], 2))
    # the cells are closed over the points of the cell
    cell = data.GetCell(3)
    assert [cell.GetPointId(i) for i in (0, 93)] == [74 + 94, 74 + 187], "cells"
for one in wakes:
    data, row = read(one["file"]), int(np.argmin(abs(times - float(one["timestep"]))))
    count = file["wake_count"][row]
    points = vtk_to_numpy(data.GetPoints().GetData()) if data.GetNumberOfPoints() else np.zeros((0, 3))
    want = np.concatenate([file["wake_x"][row, f, : count[f]] for f in range(2)])
    same("wake", points[:, :2], want)
    assert data.GetNumberOfVerts() == count.sum()
    if count.sum() == 0:
        continue
    age = times[row] - np.concatenate([file["wake_birth"][row, f, : count[f]] for f in range(2)])
    same("age", array(data.GetPointData(), "age"), age, 1e-12)
    circulation = np.concatenate([file["wake_circulation"][row, f, : count[f]] for f in range(2)])
    got = array(data.GetPointData(), "circulation")
    same("circulation", got[age < 0.3], circulation[age < 0.3])  # older ones decay
    assert np.all(abs(got) <= abs(circulation)) and (row < 5 or np.any(abs(got) < 0.9 * abs(circulation)))
    same("owner", array(data.GetPointData(), "fish"), np.repeat([0, 1], count))
assert len(wakes) == 4
end
check_with 'import vtkmodules' vtk_reads_the_numbers_of_the_result timeout "$time_limit" /usr/bin/python3 compare.py 'a <pair>.nc'

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
    cat >sections.py <<'end'
import sys
sys.path.insert(0, sys.argv[1] + "/scripts")
from shoal._files import Results
assert [bool(mean) for mean in Results("named.nc").mean_section] == [True, False]
end
    check "a fish with the name $name has its outline in pictures" /usr/bin/python3 sections.py "$root"
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
cat >walls.py <<'end'
"""The walls are two lines at their height, two lengths of the longest body beyond the nodes, and there at all times."""
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

reader = vtkXMLPolyDataReader()
reader.SetFileName("channel/channel-walls-0000.vtp")
reader.Update()
data = reader.GetOutput()
points = vtk_to_numpy(data.GetPoints().GetData())
assert data.GetNumberOfLines() == 2 and points.shape == (4, 3), points
assert [data.GetCell(i).GetNumberOfPoints() for i in (0, 1)] == [2, 2]
assert points[:, 1].tolist() == [-0.5, -0.5, 1.5, 1.5], points
assert (abs(points[[0, 2], 0] - 9) < 0.1).all() and (abs(points[[1, 3], 0] - 11.5) < 0.1).all(), points
assert open("channel/channel.pvd").read().count("channel-walls-0000.vtp") == 2
end
check_with 'import vtkmodules' walls_are_lines timeout "$time_limit" /usr/bin/python3 walls.py

finish

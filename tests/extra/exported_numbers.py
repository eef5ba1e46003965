"""Compare what VTK reads with the result."""
import sys
import xml.etree.ElementTree as tree
import netCDF4
import numpy as np
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

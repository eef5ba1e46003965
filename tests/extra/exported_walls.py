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

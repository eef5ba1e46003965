"""craft.py FILE NAME: put text in the place of a variable."""
import sys
import netCDF4

data, name = netCDF4.Dataset(sys.argv[1], "a"), sys.argv[2]
old = data[name]
words = {key: old.getncattr(key) for key in old.ncattrs() if key != "_FillValue"}
data.renameVariable(name, "no_" + name)
new = data.createVariable(name, "S1", old.dimensions)
new.setncatts(words)
new[...] = "x"

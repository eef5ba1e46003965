"""value.py FILE NAME: print an attribute of a NetCDF file, or the values of a variable, in the last row if it has rows."""

import sys

import netCDF4

data = netCDF4.Dataset(sys.argv[1])
if sys.argv[2] in data.ncattrs():
    print(data.getncattr(sys.argv[2]).strip("\0"))
else:
    variable = data[sys.argv[2]]
    print(*(variable[-1] if "time" in variable.dimensions else variable[...]).ravel())

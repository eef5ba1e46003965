"""stated.py FOLDER: print the path of the member that states the lift of a study."""

import glob
import sys

import netCDF4

folder = sys.argv[1]
value = float(netCDF4.Dataset(f"{folder}/study.nc")["stated_steady_lift"][0])
print(min(glob.glob(f"{folder}/member-*.nc"), key=lambda path: abs(float(netCDF4.Dataset(path)["steady_lift"][0]) - value)))

"""An equilibrium has the same lift from rest, as a member of a study, and in the file of the study."""
import sys
import netCDF4

lift = [float(netCDF4.Dataset(f)["steady_lift"][0]) for f in ("plate.nc", "grow-study/member-0001.nc")]
lift.append(float(netCDF4.Dataset("grow-study/study.nc")["steady_lift"][1, 0]))
sys.exit(0 if max(lift) / min(lift) - 1 < 1e-8 else str(lift))

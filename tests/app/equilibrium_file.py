"""What is in the file of an equilibrium: one row, no wake, lift and no drag, in balance with what the clamp takes."""
import sys
import netCDF4, numpy as np

data = netCDF4.Dataset("plate.nc")
data.set_auto_mask(False)
force, lift = data["steady_force"][0], data["steady_lift"][0]
problems = []
def demand(name, good):
    if not good:
        problems.append(name)
demand("complete", data.run_status == "complete" and len(data["time"]) == 1)
demand("the force of the row", np.allclose(data["pressure_force"][0, 0] + data["suction_force"][0, 0], force))
demand("the clamp takes it", np.allclose(data["constraint_force"][0, 0], -force, atol=1e-9))
demand("no drag", abs(data["steady_drag"][0]) < 1e-3 * lift and np.isclose(lift, force[1]))
demand("Kutta and Joukowski", np.isclose(lift, data["shed_circulation"][0, 0], rtol=2e-3))
demand("no wake", data["wake_count"][0, 0] == 0)
demand("no beats", data["steady_beats"][...] == 0 and np.isnan(data["steady_multiplier"][:]).all())
sys.exit("; ".join(problems) or 0)

"""What is in the file of a steady state: its rows are the last two beats, its values those of the last."""
import sys
import netCDF4, numpy as np

data = netCDF4.Dataset("swim.nc")
data.set_auto_mask(False)
time, beats = data["time"][:], int(data["steady_beats"][...])
problems = []
def demand(name, good):
    if not good:
        problems.append(name)
demand("complete", data.run_status == "complete")
demand("a row every 0.1 s for two beats", len(time) == 21 and np.allclose(np.diff(time), 0.1))
demand("from the end of the search on", np.isclose(time[0], beats))
demand("speed of the last beat", data["steady_speed"][0] == data["speed"][-1, 0])
demand("the speed stays", abs(data["speed"][-1, 0] / data["speed"][0, 0] - 1) < 1e-4)
demand("no thrust on the whole", abs(data["steady_force"][0]).max() < 1e-2 * np.abs(data["reactive_force"][:]).max())
powers = [data["steady_" + name][0] for name in ("actuation_power", "damping_power", "fluid_power")]
demand("the muscle pays for damping and fluid", abs(powers[0] + powers[1] - powers[2]) < 1e-3 * powers[0])
demand("cost of transport", np.isclose(data["steady_cost_of_transport"][0], powers[0] / data["body_mass"][0]
                                       / data["steady_speed"][0], rtol=1e-6))
demand("three multipliers of six slots", np.isfinite(data["steady_multiplier"][:, 0]).sum() == 3)
demand("the energy balance is that of the rows", abs(data["energy_balance"][-1, 0]) < 1e-3 * powers[0])
demand("an ordinary run has none of this", "steady_speed" not in netCDF4.Dataset("run.nc").variables)
sys.exit("; ".join(problems) or 0)

"""open_xarray.py: A result in plain xarray: the names of fish and axes are coordinates."""
import numpy as np
import xarray

run = xarray.open_dataset("seven.nc")
assert list(run.fish.values) == [f"number {i}" for i in range(7)] and list(run.xy.values) == ["x", "y"], run.coords
np.testing.assert_array_equal(run.com.sel(fish="number 3", xy="y"), run.com[:, 3, 1])
np.testing.assert_array_equal(run.x.sel(fish="number 6", xy="x").isel(node=0), run.x[:, 6, 0, 0])
assert run.speed.sel(fish=["number 1", "number 2"]).shape == (run.time.size, 2)
assert {"fish", "xy", "time"} <= set(run.indexes), run.indexes

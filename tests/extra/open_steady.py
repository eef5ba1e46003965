"""open_steady.py: xarray opens a steady state."""

import xarray

data = xarray.open_dataset("formation.nc")
data.steady_speed.sel(fish=data.fish[0]).item()

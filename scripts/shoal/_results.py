"""Result files as xarray: shoal.open, shoal.periods; a run in memory as a dataset."""

from __future__ import annotations

import os

import numpy as np

from ._library import CaseError, FileError, index_of, kind, netcdf_path


def _xarray():
    try:
        import xarray
    except ImportError as error:
        raise ImportError("this needs xarray and netCDF4: apt install python3-xarray python3-netcdf4, or pip install "
                          "xarray netCDF4") from error
    return xarray


def _with_names(data):
    """The dataset with the coordinate xy."""
    return data if "xy" in data.coords or "xy" not in data.dims else data.assign_coords(xy=["x", "y"])


def _wake_table(data):
    """The dataset with all free vortices of all rows as one long table, without empty slots."""
    used = np.isfinite(data["wake_circulation"].transpose("time", "fish", "vortex").values)
    row, fish, _ = np.nonzero(used)
    table = {
        "wake_time": ("wake", data["time"].values[row]),
        "wake_fish": ("wake", data["fish"].values[fish]),
        "wake_x": (("wake", "xy"), data["wake_x"].values[used], data["wake_x"].attrs),
        "wake_circulation": ("wake", data["wake_circulation"].values[used], data["wake_circulation"].attrs),
        "wake_birth": ("wake", data["wake_birth"].values[used], data["wake_birth"].attrs),
    }
    table["wake_age"] = ("wake", table["wake_time"][1] - table["wake_birth"][1], {"units": "s"})
    return data.drop_vars(["wake_x", "wake_circulation", "wake_birth"]).assign(table)


def open(path: str | os.PathLike):  # noqa: A001 - shoal.open, as gzip.open
    """A file of shoal as an xarray.Dataset: of a run, of a steady state, of a study or of a field.

    Coordinates are fish (names) and xy. The wake of a run is one long table, a row for each vortex at each time:
    wake_time, wake_fish, wake_x, wake_circulation, wake_birth, wake_age on the dimension wake.
    """
    if not isinstance(path, (str, os.PathLike)):
        raise TypeError(f"open: the path of a result file, not {kind(path)}")
    xarray = _xarray()
    if not os.path.isfile(path):
        raise FileError(f"{os.fspath(path)}: no such file")
    path = netcdf_path(path)
    try:
        data = xarray.open_dataset(path, engine="netcdf4")
    except Exception as error:  # the exception of a damaged file depends on the versions of two libraries
        raise FileError(f"{os.fspath(path)}: not a result file of shoal ({error})") from error
    with data:
        if not {"shoal_schema", "shoal_study", "shoal_field"} & set(data.attrs):
            raise FileError(f"{os.fspath(path)}: a NetCDF file, but not one of shoal")
        data = _with_names(data.load())
        return _wake_table(data) if "wake_circulation" in data and "time" in data.dims else data


def dataset_of(run):
    """All variables of a run at the last event."""
    xarray = _xarray()
    variables = {}
    for name in run.keys():
        values = run.view(name)
        dims, content = list(values.dims), np.array(values)
        if dims[-1:] == ["name"]:  # characters
            dims.pop()
            content = np.array([row.tobytes().rstrip(b"\0").decode() for row in content.reshape(-1, content.shape[-1])])
            content = content.reshape(values.shape[:-1])
        variables[name] = dims, content, {"units": values.unit, "long_name": values.long_name}
    data = xarray.Dataset(variables, attrs={"time": run.time})
    return _with_names(data.assign_coords(time=run.time))


def periods(data, fish: int | str = 0):
    """The rows of a result cut into the beats of a fish (number or name).

    The dimension time of every variable becomes (period, phase), phase from 0 to 1; rows after the last whole period
    are cut off.
    """
    number = index_of(fish, [str(name) for name in data["fish"].values], "periods")
    frequency, time = float(data["frequency"].isel(fish=number)), data["time"].values
    if not frequency > 0 or time.size < 2:
        raise CaseError("periods: this fish does not beat, or there are no two rows")
    rows = 1 / (frequency * (time[1] - time[0]))  # of one period
    n_rows = round(rows)
    if abs(rows - n_rows) > 1e-6 * rows:
        raise CaseError(f"periods: a period has {rows:g} rows: choose time.output_interval so that they are an integer")
    n_periods = (time.size - 1) // n_rows
    cut = {}
    for name, variable in data.drop_dims("wake", errors="ignore").variables.items():
        if "time" not in variable.dims:
            cut[name] = variable
            continue
        first = variable.transpose("time", ...)
        values = first.values[: n_periods * n_rows].reshape(n_periods, n_rows, *first.shape[1:])
        cut[name] = (("period", "phase", *first.dims[1:]), values, variable.attrs)
    coordinates = {**{name: cut.pop(name) for name in data.coords if name in cut},
                   "period": np.arange(n_periods), "phase": np.arange(n_rows) / n_rows}
    return type(data)(cut, coordinates, data.attrs)

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


OF_POINTS = ("stated_", "bar_", "lowest_", "highest_", "part_", "shift_", "spread_", "key_")  # beginnings of the names
OF_KEYS = ("key_name", "key_is_choice", "key_design_order")  # the same at all points


def _with_swept(data):
    """A study with its swept keys as coordinates: body_modulus for fish[*].body.modulus, fish1_wave_phase for
    fish[1].wave.phase.

    They belong to the members. An error study has the dimension point, also with one point, and its swept keys belong to
    the points; what the members set is member_..., as member_nodes.
    """
    is_error = "key_name" in data
    keys = {}
    for name, variable in data.data_vars.items():
        if "axis" not in variable.attrs:
            continue
        short = name.removeprefix("fish_")
        keys[name] = f"member_{short}" if is_error else name if short != name and short in data.variables else short
    swept = [keys[name] for name in keys if "swept" in data[name].attrs]
    data = data.rename({name: new for name, new in keys.items() if name != new}).set_coords([*keys.values(), "member"])
    if not is_error:
        return data

    if "point" not in data.dims:
        of_points = [name for name in data.data_vars if name.startswith(OF_POINTS) and name not in OF_KEYS]
        data = data.assign({name: data[name].expand_dims("point") for name in of_points})
        levels = data["key_member"].values[0, 0]
        data["point_member"] = ("point",), levels[data["key_stated"].values[0, :1]], {"units": "1"}
    at = data["point_member"].values
    return data.assign_coords({name.removeprefix("member_"): ("point", data[name].values[at], data[name].attrs)
                               for name in swept})


def grid(data):
    """The result of a study over the full grid of its sweep: a dimension for each axis in place of the members, or, of an
    error study, of the points.

    Each dimension is named like a swept key, with its values in the order of the case; swept keys that follow another one
    are coordinates along its dimension.
    """
    of = "point" if "point" in getattr(data, "dims", ()) else "member"
    keys = [name for name, variable in getattr(data, "coords", {}).items()
            if variable.dims == (of,) and "axis" in variable.attrs]
    if not keys:
        raise CaseError("grid: the dataset has no swept keys: give the result of shoal.study or shoal.open of a study.nc")

    # a key that tells members apart which the keys before do not, or the first key of an axis of one value
    values = {name: data[name].values.tolist() for name in keys}
    chosen, n_apart, axes = [], 1, set()
    for name in keys:
        n = len(set(zip(*(values[key] for key in [*chosen, name]))))
        axis = int(data[name].attrs["axis"])
        if n > n_apart or axis not in axes and of == "member" or not chosen:
            chosen, n_apart = [*chosen, name], n
            axes.add(axis)
    along = [list(dict.fromkeys(values[name])) for name in chosen]
    shape, n_members = [len(one) for one in along], data.sizes[of]
    if n_apart != n_members or int(np.prod(shape)) != n_members:
        raise CaseError(f"grid: the {n_members} {of}s are no full grid of {', '.join(chosen)}")

    # the member at each place of the grid
    place = [np.array([one.index(value) for value in values[name]]) for name, one in zip(chosen, along)]
    order = np.argsort(np.ravel_multi_index(place, shape))
    variables = {}
    for name, variable in data.variables.items():
        if name in chosen or of not in variable.dims:
            if name not in chosen:
                variables[name] = variable
            continue
        first = variable.transpose(of, ...)
        content = first.values[order].reshape(*shape, *first.shape[1:])
        variables[name] = (*chosen, *first.dims[1:]), content, variable.attrs

    # a coordinate that changes along one dimension only is one along it
    for name in set(keys) - set(chosen):
        content = variables[name][1]
        for d, dim in enumerate(chosen):
            line = np.moveaxis(content, d, -1).reshape(-1, shape[d])
            if (line == line[0]).all():
                variables[name] = (dim,), line[0], variables[name][2]
                break
    for name, one in zip(chosen, along):
        variables[name] = (name,), np.array(one), data[name].attrs
    coordinates = {name: variables.pop(name) for name in [*chosen, *data.coords] if name in variables}
    return type(data)(variables, coordinates, data.attrs)


def open(path: str | os.PathLike):  # noqa: A001 - shoal.open, as gzip.open
    """A file of shoal as an xarray.Dataset: of a run, of a steady state, of a study or of a field.

    Coordinates are fish (names) and xy, and of a study the swept keys, so that data.speed.plot(x="body_modulus") is a
    curve; shoal.grid has a dimension for each axis. An error study has a dimension point, also without a sweep. The wake
    of a run is one long table, a row for each vortex at each time: wake_time, wake_fish, wake_x, wake_circulation,
    wake_birth, wake_age on the dimension wake.
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
        if "shoal_study" in data.attrs:
            data = _with_swept(data)
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

"""Read a result file of shoal: bodies, wakes and time series as numpy arrays. Used by shoal.plot and the scripts.

    from shoal._files import Results
    results = Results("demo.nc")
    results.time, results["speed"], results.outline(row=-1, fish=0)
"""

import os

from ._library import FileError, netcdf_path

try:
    import netCDF4
    import numpy as np
except ImportError as missing:
    raise ImportError(f"{missing}: apt install python3-netcdf4 python3-matplotlib, and run this with /usr/bin/python3") from missing


# Exceptions of reading a damaged file.
DAMAGE = (OSError, RuntimeError, ValueError, LookupError, AttributeError, TypeError, ArithmeticError, SyntaxError, MemoryError)


class Results:
    """A result file. Indexing with the name of a variable reads all of it, NaN where a slot is unused."""

    def __init__(self, path):
        self.path = path
        self.data = open_dataset(path)
        self.time = self["time"]
        if self.time.size == 0:
            raise FileError(f"{path}: the run has not written a row yet")
        # a missing end of a file reads as zero; this variable is the last value of a row and never zero
        if self.read("wall_time", -1) == 0:
            raise FileError(f"{path}: the end of the file is missing: was it copied completely?")
        self.n_fish = self.data.dimensions["fish"].size
        self.names = list(self["fish"])
        self.n_nodes = self["n_nodes"].astype(int)
        self.thickness = self["edge_thickness"]
        self.mean_section = self["mean_section"] == 1
        self.walls = walls(self.data, self.read("x", 0)[0, 0, 1])
        self.title = getattr(self.data, "title", "")

    def __getitem__(self, name):
        return self.read(name)

    def read(self, name, row=slice(None)):
        """A variable, or the given rows of it."""
        if name not in self.data.variables:
            raise FileError(f"{self.path}: there is no variable {name} in it")
        return np.ma.filled(self.data.variables[name][row], np.nan)

    def nearest(self, time, rows=None):
        """The row nearest to a time, among the given rows."""
        rows = np.arange(self.time.size) if rows is None else np.asarray(rows)
        return int(rows[np.argmin(np.abs(self.time[rows] - time))])

    def nodes(self, row, fish):
        """Positions of the nodes of one fish (n_nodes, 2)."""
        return self.read("x", row)[fish, : self.n_nodes[fish]]

    def outline(self, row, fish):
        """The outline of one fish as a closed polygon (n, 2)."""
        thickness = self.thickness[fish, : self.n_nodes[fish] - 1]
        return outline(self.nodes(row, fish), thickness, self.mean_section[fish])

    def wake(self, row):
        """All free vortices of a row: positions (n, 2) and circulations (n), decayed as they act on the flow."""
        circulation = self.read("wake_circulation", row).ravel()
        birth = self.read("wake_birth", row).ravel()
        position = self.read("wake_x", row).reshape(-1, 2)
        used = np.isfinite(circulation)
        aged = np.repeat(self.aged(), circulation.size // self.n_fish)
        return position[used], circulation[used] * self.remaining(self.time[row] - birth[used] + aged[used])

    def aged(self):
        """By so much a vortex of each fish counts as older than it is (n_fish): fish.wake_lifetime."""
        part = self["wake_part"] if "wake_part" in self.data.variables else np.ones(self.n_fish)
        return (1 - part) * float(self["wake_lifetime"])

    def remaining(self, age):
        """The part of its circulation that a vortex of some age still has: doc/model.md, section 8."""
        lifetime, decay = float(self["wake_lifetime"]), float(self["wake_decay"])
        if decay == 0:  # it keeps all of it up to its last interval
            return np.ones_like(age)
        return 1 - ramp_step((age + float(self["shedding_interval"]) / 2 - (lifetime - decay)) / decay)

    def rows_with_wake(self):
        """The rows in which the wake was written, or has nothing to write."""
        first = self.read("wake_circulation", (slice(None), slice(None), 0))
        return np.flatnonzero(((self["wake_count"] == 0) | np.isfinite(first)).all(axis=1))


KINDS = {"shoal_schema": "run", "shoal_study": "study", "shoal_field": "field"}


def kind_of(path):
    """What a file of shoal is of: run, study or field; None where it is no file of shoal."""
    try:
        with netCDF4.Dataset(netcdf_path(path)) as data:
            return next((kind for name, kind in KINDS.items() if hasattr(data, name)), None)
    except (OSError, RuntimeError):
        return None


def walls(data, inside):
    """The walls as pairs of their y and the side of the fluid: 1 above, -1 below; inside: the y of a point of the fluid."""
    return [(float(y), 1 if inside > y else -1) for y in (data["wall_y"][:] if "wall_y" in data.variables else [])]


def open_dataset(path, kind="shoal_schema"):
    """The open NetCDF file, checked to be one of shoal; kind: the attribute that says of what."""
    if not os.path.exists(path):
        raise FileError(f"{path}: no such file")
    if os.path.isdir(path):
        raise FileError(f"{path}: a folder, not a result file")
    try:
        data = netCDF4.Dataset(netcdf_path(path))
    except FileError:
        raise
    except OSError as error:
        raise FileError(f"{path}: not a result file of shoal ({error.strerror or error})") from error
    if not hasattr(data, kind):
        raise FileError(f"{path}: a NetCDF file, but not one of a {KINDS[kind]} of shoal")
    return data


def ramp_step(q):
    """0 below 0, 1 above 1, three times continuously differentiable."""
    q = np.clip(q, 0, 1)
    return q**4 * (35 - 84 * q + 70 * q**2 - 20 * q**3)


def hermite(knots, values, slopes, at):
    """The piecewise cubic through values with the given slopes at the knots (n) or (n, 2)."""
    k = np.clip(np.searchsorted(knots, at, side="right") - 1, 0, knots.size - 2)
    length = knots[k + 1] - knots[k]
    q = (at - knots[k]) / length
    if values.ndim == 2:
        q, length = q[:, None], length[:, None]
    return (
        (1 + 2 * q) * (1 - q) ** 2 * values[k]
        + q * (1 - q) ** 2 * length * slopes[k]
        + q**2 * (3 - 2 * q) * values[k + 1]
        - q**2 * (1 - q) * length * slopes[k + 1]
    )


def smooth_weights(n, at):
    """Weights of n nodes at points u from 0 to n - 1 of the curve that carries the bound sheet: doc/model.md, section 6."""
    binomial = np.array([1, 3, 3, 1])
    sums = [sum(binomial[k - j] for j in range(max(0, k - 3), min(k, n - 4) + 1)) for k in range(n)]
    signed = np.array(sums) * (-1.0) ** np.arange(n)
    apart = at[:, None] - np.arange(n)
    on_node = np.abs(apart) < 1e-12
    weights = signed / np.where(on_node, 1, apart)
    weights /= weights.sum(axis=1, keepdims=True)
    weights[on_node.any(axis=1)] = on_node[on_node.any(axis=1)]
    return weights


def centreline(nodes, at):
    """Points and unit normals of that curve, at arc coordinates from 0 to 1."""
    u = at * (len(nodes) - 1)
    points = smooth_weights(len(nodes), u) @ nodes
    step = 1e-5 * (len(nodes) - 1)
    ahead, behind = np.minimum(u + step, len(nodes) - 1), np.maximum(u - step, 0)
    tangent = (smooth_weights(len(nodes), ahead) - smooth_weights(len(nodes), behind)) @ nodes
    tangent /= np.maximum(np.hypot(*tangent.T), 1e-300)[:, None]
    return points, np.column_stack([-tangent[:, 1], tangent[:, 0]])


def half_thickness(thickness, at, is_mean):
    """Half the thickness at arc coordinates from 0 to 1, from that of the edges: the mean of an edge, or the sum of the half
    thicknesses at its nodes.

    Near a blunt nose the square of the thickness grows in proportion to the distance, as on a quarter of an ellipse that
    rises from the nose to the tail: sin(angle) with cos(angle) = 1 - s. What is interpolated over the angle is the square of
    the ratio of both. It is even about the nose; at the tail, which may be blunt, pointed or round, it is continued in
    proportion to s. The same as src/view/outline.c.
    """
    at_nodes = np.arccos(np.linspace(1, 0, thickness.size + 1))
    start, end = at_nodes[:-1], at_nodes[1:]
    angle = np.arccos((np.cos(start) + np.cos(end)) / 2)
    of_sine = np.sin(start) + np.sin(end)
    if is_mean:
        of_sine = (end - np.sin(2 * end) / 2 - start + np.sin(2 * start) / 2) / (np.cos(start) - np.cos(end))
    ratio = (thickness / of_sine) ** 2
    s = 1 - np.cos(angle[-2:])
    tail = max(ratio[-1] + (ratio[-1] - ratio[-2]) / (s[1] - s[0]) * (1 - s[1]), 0)
    knots = np.concatenate([[-angle[0]], angle, [np.pi / 2, np.pi - angle[-1]]])
    values = np.concatenate([[ratio[0]], ratio, [tail, 2 * tail - ratio[-1]]])
    slopes = np.gradient(values, knots)
    where = np.arccos(1 - at)
    return np.sin(where) * np.sqrt(np.maximum(hermite(knots, values, slopes, where), 0))


def outline(nodes, thickness, is_mean, n=80):
    """The outline of a body as a closed polygon: a smooth curve through the nodes, as thick as the edges are."""
    at = (1 - np.cos(np.linspace(0, np.pi, n))) / 2  # dense at nose and tail
    points, normals = centreline(nodes, at)
    half = half_thickness(thickness, at, is_mean)[:, None]
    return np.concatenate([points + half * normals, (points - half * normals)[:0:-1]])

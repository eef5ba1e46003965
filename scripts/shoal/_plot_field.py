"""Draw the file of `shoal field` on a figure: vorticity or speed, bodies, and streamlines if asked for. Used by shoal.plot."""

from ._plot_style import BODY, BODY_EDGE, STREAMLINES, Wall, colour_bar, matplotlib, with_unit
from ._files import FileError, np, open_dataset, outline, walls

SPECIAL = 0.995  # share of the points below the end of the scale: bound sheets are much stronger than wakes


class Field:
    """Velocity and vorticity on a grid, and the bodies in it."""

    def __init__(self, path):
        data = open_dataset(path, "shoal_field")
        for name in ("time", "x", "y", "u", "v", "vorticity", "body_x", "edge_thickness", "n_nodes"):
            if name not in data.variables:
                raise FileError(f"{path}: there is no variable {name} in it")
        self.x, self.y = (np.ma.filled(data[name][:], np.nan) for name in ("x", "y"))
        self.u, self.v, self.vorticity = (np.ma.filled(data[name][0], np.nan) for name in ("u", "v", "vorticity"))
        self.time = float(data["time"][0])
        self.walls = walls(data, data["body_x"][0, 0, 0, 1])
        nodes, thickness = (np.ma.filled(data[name][:], np.nan) for name in ("body_x", "edge_thickness"))
        counts = np.asarray(data["n_nodes"][:], dtype=int)
        means = data["mean_section"][:] == 1
        self.outlines = [outline(nodes[0, f, :n], thickness[f, : n - 1], means[f]) for f, n in enumerate(counts)]


def end_of_scale(values):
    """The value that all but a few points stay below; never 0."""
    return max(float(np.nanquantile(np.abs(values), SPECIAL)), 1e-300)


def draw(path, figure, with_speed=False, with_streamlines=False):
    """Fill an empty figure."""
    field = Field(path)
    axes = figure.add_subplot()
    if with_speed:
        values, label = np.hypot(field.u, field.v), with_unit("speed of the fluid", "m s-1")
        scale = {"cmap": "cividis", "vmin": 0, "vmax": end_of_scale(values)}
    else:
        values, label = field.vorticity, with_unit("vorticity", "s-1") + ", red counter-clockwise"
        end = end_of_scale(values)
        scale = {"cmap": "RdBu_r", "vmin": -end, "vmax": end}
    mesh = axes.pcolormesh(field.x, field.y, values, shading="gouraud", rasterized=True, **scale)
    if with_streamlines:
        colour = "white" if with_speed else "#444444"
        lines = axes.streamplot(field.x, field.y, field.u, field.v, color=colour, linewidth=0.5, arrowsize=0.6, density=1.4).lines
        for one in (lines, *axes.patches):
            one.set_gid(STREAMLINES)
    bodies = matplotlib.collections.PolyCollection(
        field.outlines, facecolors=BODY, edgecolors=BODY_EDGE, linewidths=0.7, zorder=3
    )
    axes.add_collection(bodies)
    for wall in field.walls:
        Wall(axes, *wall)
    axes.set_aspect("equal")
    axes.set(xlim=field.x[[0, -1]], ylim=field.y[[0, -1]], xlabel="x [m]", ylabel="y [m]")
    axes.set_title(f"$t$ = {field.time:.4g} s", size=9, loc="right")
    colour_bar(figure, mesh, [axes], label, extend="max" if with_speed else "both")

"""Draw polarisation, distances to the nearest neighbour and contacts of a school over time. Used by shoal.plot."""

from ._plot_style import DASHES, GRID, LINES, MANY, add_legend, calm, draw_bands, matplotlib
from ._files import np


def nearest(places):
    """Of every fish and row the distance to the nearest other one; places: (time, fish, xy)."""
    distances = np.empty(places.shape[:2])
    for row, com in enumerate(places):
        between = np.hypot(*(com[:, None] - com[None]).T)
        np.fill_diagonal(between, np.inf)
        distances[row] = between.min(axis=0)
    return distances


def draw_nearest(axes, results):
    """Distances between centres of mass: of a pair one line, of a few fish one each, of many their bands."""
    distances = nearest(results["com"])
    if results.n_fish == 2:
        axes.plot(results.time, distances[:, 0], color="black", lw=1)
        axes.set_ylabel("between\ncentres [m]")
        return
    if results.n_fish > MANY:
        handles = draw_bands(axes, results.time, distances)
    else:
        handles = [
            axes.plot(results.time, one, color=LINES[f], ls=DASHES[f], lw=1, label=results.names[f])[0]
            for f, one in enumerate(distances.T)
        ]
    axes.set_ylabel("to the nearest\ncentre [m]")
    add_legend(axes, handles)


def draw(results, figure, scale_of_variable):
    """Fill an empty figure: panels of what there is only."""
    touching = (results["contact_energy"] > 0).sum(axis=1)
    least = results["least_distance"]
    names = ["polarisation", "nearest"]
    names += ["least"] if np.isfinite(least).any() else []
    names += ["touching"] if touching.any() else []
    stack = dict(zip(names, np.atleast_1d(figure.subplots(len(names), sharex=True))))
    figure.set_figheight(1.4 * len(names) + 0.5)
    time = results.time

    stack["polarisation"].plot(time, results["polarisation"], color="black", lw=1)
    stack["polarisation"].set_ylabel("polarisation")
    calm([stack["polarisation"]], 1.0, rounding=1e-6)

    draw_nearest(stack["nearest"], results)
    calm([stack["nearest"]], scale_of_variable("com"))

    if "least" in stack:
        axes = stack["least"]
        axes.plot(time, least, color="black", lw=1)
        axes.set_ylabel("least between\noutlines [m]")
        if np.nanmin(least) < 0.3 * np.nanmax(least):
            axes.set_ylim(0, None)
        if not calm([axes], scale_of_variable("com")) and "touching" not in stack:
            axes.annotate("no contact", (0.99, 0.9), xycoords="axes fraction", ha="right", va="top", size=7)
    if "touching" in stack:
        axes = stack["touching"]
        axes.step(time, touching, color="black", lw=1, where="mid")
        axes.set(ylabel="fish in\ncontact", ylim=(0, None))
        axes.yaxis.set_major_locator(matplotlib.ticker.MaxNLocator(integer=True))

    for axes in figure.axes:
        axes.grid(lw=0.3, color=GRID)
        axes.margins(x=0)
    figure.axes[-1].set_xlabel("time [s]")
    figure.align_ylabels()

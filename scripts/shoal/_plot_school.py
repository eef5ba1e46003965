"""Draw polarisation, distances to the nearest neighbour and contacts of a school over time. Used by shoal.plot."""

from ._plot_style import GRID, matplotlib
from ._files import np


def nearest(places):
    """Of every fish and row the distance to the nearest other one; places: (time, fish, xy)."""
    distances = np.empty(places.shape[:2])
    for row, com in enumerate(places):
        between = np.hypot(*(com[:, None] - com[None]).T)
        np.fill_diagonal(between, np.inf)
        distances[row] = between.min(axis=0)
    return distances


def draw(results, figure):
    """Fill an empty figure."""
    time = results.time
    polarisation, near, least, touching = figure.subplots(4, sharex=True)
    polarisation.plot(time, results["polarisation"], color="black", lw=1)
    polarisation.set_ylabel("polarisation")

    distances = nearest(results["com"])
    low, median, high = np.quantile(distances, [0.1, 0.5, 0.9], axis=1)
    near.fill_between(time, low, high, color=GRID, lw=0, label="8 of 10 fish")
    near.plot(time, median, color="black", lw=1, label="median")
    near.plot(time, distances.min(axis=1), color="black", lw=0.8, ls="--", label="nearest two")
    near.set_ylabel("to the nearest\nneighbour [m]")
    near.legend(ncols=3, loc="lower right", bbox_to_anchor=(1, 1), frameon=False, borderpad=0)

    least.plot(time, results["least_distance"], color="black", lw=1)
    least.set(ylabel="least between\noutlines [m]", ylim=(0, None))
    touching.step(time, (results["contact_energy"] > 0).sum(axis=1), color="black", lw=1, where="mid")
    touching.set(ylabel="fish in\ncontact", xlabel="time [s]", ylim=(0, None))
    touching.yaxis.set_major_locator(matplotlib.ticker.MaxNLocator(integer=True))
    for axes in figure.axes:
        axes.grid(lw=0.3, color=GRID)
        axes.margins(x=0)
    figure.align_ylabels()

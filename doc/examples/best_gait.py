#!/usr/bin/python3
"""The gait of least cost at a given speed, with scipy.optimize, and how smooth differences of the cost are.

    doc/examples/best_gait.py [--speed 0.6] [--figure best_gait.png]

Amplitude, frequency and the speed of the start are free. In the last beat the fish is to go at the given speed, and no
slower than in the beat before: what counts is swimming, not coasting. The cost is the work of the muscle in these two
beats over mass and way. Gradients are differences: a run is deterministic, so its result is a smooth function of the
gait, but for what the steps of the integrator choose.
"""

import argparse
import pathlib
import sys

import numpy as np
from scipy import optimize

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))  # not needed once installed
import shoal  # noqa: E402

BEATS, EVENTS = 6, 25  # beats that are swum, events in a beat
STEADY = 0.01  # a gait whose speed changes by more in the last beat, m/s, coasts or accelerates: its cost is not comparable
START = np.array([0.4, 1.0, 0.6])  # amplitude, frequency (Hz), speed of the start (m/s)


def swim(gait, rtol=1e-6):
    """Cost of transport in the last two beats (m s-2), mean speed in the last beat and its gain in it (m/s)."""
    amplitude, frequency, speed = gait
    interval = 1 / (EVENTS * frequency)
    run = shoal.Run(
        {
            "time": {"end": BEATS * EVENTS * interval, "shedding_interval": interval},
            "solver": {"rtol": rtol},
            "fish": [{"force": "reactive", "nodes": 9, "sheet_points": 33, "start": {"speed": speed},
                      "wave": {"amplitude": amplitude, "frequency": frequency}}],
        }
    )
    places, work = [], []
    for beat in (BEATS - 2, BEATS - 1, BEATS):
        run.advance(beat * EVENTS * interval)
        places.append(run["com"][0].copy())
        work.append(float(run["actuation_work"][0]))
    ways = np.hypot(*np.diff(places, axis=0).T)
    cost = (work[2] - work[0]) / (float(run["body_mass"][0]) * ways.sum())
    return cost, ways[1] * frequency, (ways[1] - ways[0]) * frequency


def slopes(rtol, widths):
    """Slope of the cost with the amplitude by central differences of these widths."""
    step = np.array([1.0, 0, 0])
    return [(swim(START + h * step, rtol)[0] - swim(START - h * step, rtol)[0]) / (2 * h) for h in widths]


def find(speed):
    """The best gait, and all gaits that were tried."""
    kept = {}

    def result(gait):
        key = tuple(gait)
        if key not in kept:
            kept[key] = np.array(swim(gait))
        return kept[key]

    def slope(gait):  # of cost, speed and gain, by forward differences
        return np.array([(result(gait + 1e-4 * step) - result(gait)) / 1e-4 for step in np.eye(3)]).T

    found = optimize.minimize(
        lambda gait: 10 * result(gait)[0],
        START,
        method="SLSQP",
        jac=lambda gait: 10 * slope(gait)[0],
        bounds=[(0.02, 0.7), (0.4, 5.0), (0.1, 1.5)],
        constraints={
            "type": "eq",
            "fun": lambda gait: 10 * (result(gait)[1:] - [speed, 0]),
            "jac": lambda gait: 10 * slope(gait)[1:],
        },
        options={"ftol": 1e-5, "maxiter": 20},
    )
    return found, kept


def draw(path, speed, widths, slope, found, kept):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, (left, right) = pyplot.subplots(1, 2, figsize=(9, 3.5), layout="constrained")
    best = slope[min(slope)][np.argmin(np.abs(widths - 1e-4))]
    for (rtol, values), style in zip(slope.items(), ("C1s--", "C0o-")):
        error = np.abs(np.array(values) - best)
        left.loglog(widths, np.where(error > 0, error, np.nan), style, mfc="none", label=f"solver.rtol {rtol:g}")
    left.set(xlabel="width of the difference in amplitude", ylabel="error of the slope of the cost (m s$^{-2}$)",
             title=f"slope {best:.7g} by differences")
    left.legend(frameon=False)
    gaits, results = np.array(list(kept)), np.array(list(kept.values()))
    is_steady = np.abs(results[:, 2]) <= STEADY
    right.plot(*results[~is_steady, 1::-1].T, "x", color="0.6", markersize=5, label=f"speed changes by more than {STEADY:g} m/s a beat")
    points = right.scatter(*results[is_steady, 1::-1].T, c=gaits[is_steady, 1], s=18, cmap="viridis", label="steady")
    right.set_ylim(top=1.2 * results[:, 0].max())  # room for the legend
    right.legend(frameon=False, fontsize=8)
    cost, reached, _ = swim(found.x)
    right.plot(reached, cost, "r*", markersize=12)
    right.axvline(speed, color="0.7", linewidth=1)
    right.set(xlabel="speed (m/s)", ylabel="cost of transport (m s$^{-2}$)", 
              title=f"gaits tried; star, the best: A = {found.x[0]:.3f}, f = {found.x[1]:.2f} Hz")
    figure.colorbar(points, label="frequency (Hz)")
    figure.savefig(path, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--speed", type=float, default=0.6)
    parser.add_argument("--figure", default="best_gait.png")
    options = parser.parse_args()
    assert swim(START) == swim(START)  # to the bit
    widths = np.logspace(-8, -1, 8)
    slope = {rtol: slopes(rtol, widths) for rtol in (1e-5, 1e-8)}
    for rtol, values in slope.items():
        print(f"rtol {rtol:g}: slope of the cost by differences of {widths[0]:.0e} to {widths[-1]:.0e}:",
              " ".join(f"{value:.4g}" for value in values))
    found, kept = find(options.speed)
    for name, gait in (("start", START), ("best", found.x)):
        cost, reached, gain = swim(gait)
        print(f"{name}: cost {cost:.4f} m s-2 at {reached:.4f} m/s (gain {gain:.1e} in a beat), amplitude {gait[0]:.4f}, "
              f"frequency {gait[1]:.4f} Hz")
    print(f"{len(kept)} gaits were tried; {found.message}")
    draw(options.figure, options.speed, widths, slope, found, kept)
    print(options.figure)


if __name__ == "__main__":
    main()

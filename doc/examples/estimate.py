#!/usr/bin/python3
"""Where is the leader? A follower finds it from the pressure along its own body, by an ensemble smoother.

    doc/examples/estimate.py [--twins 50] [--members 40] [--seed 1] [--processes 2] [--figure estimate.png]

A leader swims somewhere ahead and beats at some phase. The follower records the pressure on both sides of its body for one
beat, with noise. What it believes about offset and phase is an ensemble of schools. Each of four steps simulates all of
them and moves them by the regression of what they are on what they would have measured (the ensemble smoother with
multiple data assimilation of Emerick and Reynolds, Computers & Geosciences 55, 2013). Twins are schools drawn from the
same prior whose truth is known: in how many of them does the interval of 90 % contain it?
"""

import argparse
import functools
import multiprocessing
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))  # not needed once installed
import shoal  # noqa: E402

BEAT, INTERVAL, BEATS = 1.0, 0.04, 4  # s, s, how long a school swims before the last beat is taken
SENSORS = [0.1, 0.2, 0.35, 0.5, 0.65, 0.8]  # lengths from the nose
NOISE = 2.5  # standard deviation of a measurement, Pa: a tenth of the follower's own pressure
N_STEPS = 4
# Unknown are the offset of the follower, in lengths behind and beside the leader, and two normal numbers whose direction is
# the phase, so that all phases are equally likely.
MEAN, DEVIATION = np.array([1.8, 0.3, 0, 0]), np.array([0.15, 0.1, 1, 1])
NAMES = ("behind, lengths", "beside, lengths", "phase, degrees")
FISH = {"nodes": 7, "pressure": {"span": "infinite"}, "start": {"speed": 0.8}, "control": {"law": "course"}}


def phase(school):
    return np.degrees(np.arctan2(school[..., 3], school[..., 2]))


def pressures(school):
    """The pressure at the sensors of the follower over the last beat, Pa: (time, side * sensor)."""
    case = {
        "time": {"end": BEATS * BEAT, "shedding_interval": INTERVAL},
        "solver": {"rtol": 1e-4},
        "defaults": {"fish": FISH},
        "fish": [
            {"name": "leader", "wave": {"phase": float(phase(school))}},
            {"name": "follower", "start": {"position": school[:2].tolist()}, "sensors": SENSORS},
        ],
    }
    seen = []
    with shoal.Run(case) as run:
        run.advance((BEATS - 1) * BEAT)
        while not run.at_end:
            run.advance(run.time + run.interval)
            seen.append(np.concatenate([run["sensor_pressure_left"][1], run["sensor_pressure_right"][1]]))
    return np.array(seen)


def measured(school):
    """What the smoother sees of a school: mean and three harmonics of each sensor, orthonormal, so that noise stays white."""
    seen = pressures(school)
    n = len(seen)
    angle = 2 * np.pi * np.arange(n) / n
    waves = [np.full(n, 0.5**0.5)] + [wave(k * angle) for k in (1, 2, 3) for wave in (np.cos, np.sin)]
    return (2 / n) ** 0.5 * (np.array(waves) @ seen).ravel()


def smooth(simulate, data, random, n_members):
    """The ensembles before and after each step, (N_STEPS + 1, n_members, 4), given data with white noise of NOISE."""
    ensemble = MEAN + DEVIATION * random.standard_normal((n_members, len(MEAN)))
    ensembles = [ensemble]
    for _ in range(N_STEPS):
        predicted = np.array(simulate(ensemble))
        # every step takes the data with N_STEPS times their variance, so that all steps together take them once
        noise = N_STEPS**0.5 * NOISE
        disturbed = data + noise * random.standard_normal(predicted.shape)
        of_school, of_data = ensemble - ensemble.mean(axis=0), predicted - predicted.mean(axis=0)
        # the gain C_sd (C_dd + noise^2)^-1 from the singular values of the predicted deviations
        left, values, right = np.linalg.svd(of_data, full_matrices=False)
        gain = right.T * (values / (values**2 + (n_members - 1) * noise**2)) @ left.T @ of_school
        ensemble = ensemble + (disturbed - predicted) @ gain
        ensemble[:, 0] = np.maximum(ensemble[:, 0], 1.2)  # bodies do not overlap
        ensembles.append(ensemble)
    return np.array(ensembles)


def errors(ensemble, truth):
    """Of each member, (n_members, 3): offsets minus the true ones, in lengths, and phase minus the true one, degrees."""
    turned = (phase(ensemble) - phase(truth) + 180) % 360 - 180
    return np.column_stack([ensemble[:, :2] - truth[:2], turned])


def twin(number, seed, simulate, n_members):
    """Truth and ensembles of a twin."""
    random = np.random.default_rng([seed, number])
    truth = MEAN + DEVIATION * random.standard_normal(len(MEAN))
    data = np.array(simulate([truth])[0])
    return truth, smooth(simulate, data + NOISE * random.standard_normal(data.shape), random, n_members)


def draw(path, twins):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(1, 3, figsize=(10, 3.4), layout="constrained")
    truth, ensembles = twins[0]
    for ensemble, color, label in (ensembles[0], "0.7", "before"), (ensembles[-1], "C0", "after"):
        axes[0].plot(ensemble[:, 0], ensemble[:, 1], ".", color=color, label=f"ensemble {label}")
    axes[0].plot(*truth[:2], "C3x", ms=9, mew=2, label="truth")
    axes[0].set(xlabel="behind the leader / length", ylabel="beside / length", title="one twin")
    axes[0].legend(frameon=False, fontsize="small")
    for i, axis, what, unit in (0, axes[1], "distance behind", " / length"), (2, axes[2], "phase", " (degrees)"):
        for number, (truth, ensembles) in enumerate(twins, 1):
            off = errors(ensembles[-1], truth)[:, i]
            low, high = np.percentile(off, [5, 95])
            axis.plot([number, number], [low, high], color="C0" if low <= 0 <= high else "C3", lw=1.5)
        axis.axhline(0, color="k", lw=0.7)
        axis.set(xlabel="twin", ylabel=f"estimate minus truth{unit}", title=f"{what}: intervals of 90 %")
    figure.savefig(path, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--twins", type=int, default=50)
    parser.add_argument("--members", type=int, default=40, help="of an ensemble")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--figure", default="estimate.png")
    options = parser.parse_args()
    twins = []
    with multiprocessing.Pool(options.processes) as pool:
        simulate = functools.partial(pool.map, measured)
        for number in range(options.twins):
            twins.append(twin(number, options.seed, simulate, options.members))
            off = errors(twins[-1][1][-1], twins[-1][0]).mean(axis=0)
            print(f"twin {number + 1:3d}: off by {off[0]:+.3f} and {off[1]:+.3f} lengths, {off[2]:+.1f} degrees", flush=True)
    for i, name in enumerate(NAMES):
        before, after = (np.array([errors(ensembles[k], truth)[:, i] for truth, ensembles in twins]) for k in (0, -1))
        low, high = np.percentile(after, [5, 95], axis=1)
        print(f"{name}: {np.sum((low <= 0) & (0 <= high))} of {len(twins)} intervals of 90 % contain the truth; median error "
              f"of the mean {np.median(np.abs(before.mean(axis=1))):.3g} before, {np.median(np.abs(after.mean(axis=1))):.3g} after")
    draw(options.figure, twins)
    print(options.figure)


if __name__ == "__main__":
    main()

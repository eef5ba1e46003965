#!/usr/bin/python3
"""Hold a pair of plates at a place that it would leave by itself: the follower changes the amplitude of its heave.

    doc/examples/keep_together.py [--figure keep_together.png]

Two plates that heave in line have stable places about one wavelength (the distance covered in a beat) apart, and unstable
ones between them. `shoal steady` finds the unstable place and its largest Floquet multiplier: a small disturbance more than
doubles in every beat, so a school that starts there comes apart. Twice a beat, a law sets the amplitude of the follower
by how far it is from the place and by how fast that changes: a plate too far behind beats harder.
"""

import argparse
import os
import pathlib
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))  # not needed once installed
import shoal  # noqa: E402

HEAVE, BOUNDS = 0.15, (0.05, 0.25)  # m
ACT_EVERY = 0.5  # s, half a beat
DISPLACED = 0.05  # m: the follower starts so far behind its place
GAIN, DAMPING = 0.2, 0.15  # m of heave per metre, and per metre a second
PLATE = {
    "nodes": 5, "force": "pressure", "pressure": {"span": "infinite", "suction_limit": 0}, "drag": {"skin": "laminar"},
    "start": {"speed": 3.8}, "wave": {"amplitude": 0, "frequency": 0}, "control": {"ramp": 0.25},
    "body": {"profile": "uniform", "thickness": 0.05, "depth": 1, "density": 20, "modulus": 1e6},
    "motion": {"prescribed": "all", "surge": "free", "heave": HEAVE, "frequency": 1},
}
CASE = {  # the plates of cases/tandem_plates.yaml
    "name": "keep_together",
    "time": {"end": 30, "shedding_interval": 0.02, "output_interval": 0.1},
    "fluid": {"density": 1, "viscosity": 2e-3},
    "wake": {"lifetime": 6, "smoothing": 0.2},
    "steady": {"formation": True, "tolerance": 1e-3},
    "defaults": {"fish": PLATE},
    "fish": [{"name": "leader"}, {"name": "follower", "start": {"position": [6.4, 0]}}],
}


def find_place():
    """Speed, m s-1, and distance, m, of the unstable steady state, and its largest multiplier with the error."""
    with tempfile.TemporaryDirectory() as folder:
        state = shoal.steady(CASE, path=os.path.join(folder, "state.nc"))
    return state.speed[0], -state.place[1, 0], abs(state.multipliers[0]), state.multiplier_error[0]


def swim(speed, distance, is_controlled):
    """Distances from the place, m, and amplitudes of the follower, m, at the times of all actions."""
    run = shoal.Run(CASE, {"fish[*].start.speed": float(speed), "fish[1].start.position": [float(distance + DISPLACED), 0]})
    times, away, heave, before = [], [], [], None
    while run.time < CASE["time"]["end"] - 1e-9:
        com = run["com"][:, 0]
        now = com[1] - com[0] - distance  # the plates swim along -x
        rate = 0.0 if before is None else (now - before) / ACT_EVERY
        before = now
        wish = float(np.clip(HEAVE + GAIN * now + DAMPING * rate, *BOUNDS)) if is_controlled else HEAVE
        run.set("follower", "motion.heave", wish)
        times.append(run.time)
        away.append(now)
        heave.append(wish)
        run.advance(run.time + ACT_EVERY)
    return np.array(times), np.array(away), np.array(heave)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--figure", metavar="PICTURE", help="draw both runs")
    options = parser.parse_args()
    speed, distance, multiplier, error = find_place()
    print(f"unstable place {distance:.3f} m behind; multiplier {multiplier:.2f} +- {error:.2f} a beat")
    alone, held = swim(speed, distance, False), swim(speed, distance, True)
    for name, (_, away, _) in (("without control", alone), ("with control", held)):
        print(f"{name}: {abs(away[-1]):.3f} m from the place after {CASE['time']['end']} beats")
    if not options.figure:
        return

    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    with matplotlib.rc_context(shoal.plot.STYLE):
        figure, (top, bottom) = pyplot.subplots(2, 1, sharex=True, figsize=(7, 3.6), layout="constrained")
        for (times, away, heave), name, colour in ((alone, "without control", "#d55e00"), (held, "with control", "#0072b2")):
            top.plot(times, away, color=colour, label=name)
            bottom.plot(times, heave, color=colour)
        top.set_ylabel("from the place [m]")
        top.legend(loc="upper left")
        bottom.set(xlabel="time [s], beats of 1 s", ylabel="heave of the\nfollower [m]")
        for axes in (top, bottom):
            axes.grid(lw=0.3)
            axes.margins(x=0)
        figure.savefig(options.figure)
    print(options.figure)


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""The gait and the stiffness of least cost at the speed of the default fish, and how certain the saving is.

    doc/examples/best_gait.py [--case cases/swim.yaml] [--speed 0.8134] [--figure best_gait.png]

Frequency, amplitude and modulus are free. shoal.optimize finds the steady state of least cost of transport among those of the given speed;
shoal.error then compares it with the case that it started from, level by level, and with other choices of the model.
"""

import argparse
import json
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))  # not needed once installed
import shoal  # noqa: E402

BOUNDS = {"wave.frequency": (0.5, 2), "wave.amplitude": (0.1, 0.8), "body.modulus": (1e5, 1e9)}


def main(case, speed, figure, bounds, models=True):
    """Find the gait, print it and the ratio of its cost to that of the case, and draw the search."""
    best = shoal.optimize(case, "cost_of_transport", over=list(bounds), bounds=bounds, subject_to={"speed": speed},
                          path="best_gait", overwrite=True, progress=True)
    print(best)
    start = case if isinstance(case, (str, pathlib.Path)) else "best_gait/start.yaml"
    if start != case:
        pathlib.Path(start).write_text(json.dumps({"format": 1, **case}), encoding="utf-8")  # JSON is YAML
    for one in shoal.error(case, "steady_cost_of_transport", against=start, models=models, assignments=best.assignments,
                           path="best_gait-error", overwrite=True):
        print(one)
    if figure:
        best.plot()[0].figure.savefig(figure, dpi=200)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--case", default=ROOT / "cases/swim.yaml")
    parser.add_argument("--speed", type=float, default=0.8134)
    parser.add_argument("--figure")
    asked = parser.parse_args()
    main(asked.case, asked.speed, asked.figure, BOUNDS)

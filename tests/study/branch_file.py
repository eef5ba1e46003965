"""branch_file.py: what is in the file of the branch of plates with its fold."""

import sys

import netCDF4
import numpy as np

data = netCDF4.Dataset("plates-branch/study.nc")
key, size = data["fish1_motion_heave"][:], data["steady_multiplier"][:]
label, place = data["label"][:], data["steady_place"][:, 1, 0]
fold = list(label).index("fold")
way = np.diff(data["arclength"][:])
angle = [float(netCDF4.Dataset(f"plates-branch/{name}")["steady_multiplier"][0, 1]) for name in data["file"][:]]
checks = {
    "both ends are at FROM": abs(key[0] - 0.081) < 1e-12 and abs(key[-1] - 0.081) < 1e-12,
    "the fold has the least value": key[fold] <= key.min() + 0.001 * 0.035,
    "the fold is where it was found with twice the events": abs(key[fold] - 0.0785) < 0.002,
    "before the fold the states are stable": (size[:fold] < 1).all(),
    "beyond it they are not": (size[fold + 1 :] > 1).all(),
    # the whole bar, .03: two real multipliers have just met here, and such a pair is sensitive to the noise
    "the multiplier of a fold is 1": abs(size[fold] - 1) <= data["steady_multiplier_error"][fold],
    "before the fold disturbances oscillate, beyond it they do not": angle[0] != 0 and angle[-1] == 0,
    "the follower falls back all the way, within steady.tolerance": (np.diff(place) < 1e-3).all(),
    "the arclength grows": (way > 0).all(),
    "every state is a file": all(netCDF4.Dataset(f"plates-branch/{name}").run_status == "complete" for name in data["file"][:]),
}
for words, holds in checks.items():
    if not holds:
        print(words, key, size, place, label, file=sys.stderr)
sys.exit(not all(checks.values()))

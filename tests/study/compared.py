"""compared.py: the speed of the stiff over that of the soft fish in study.nc and error.csv of the folder compared."""

import csv

import netCDF4
import numpy as np

study = netCDF4.Dataset("compared/study.nc")
ratio = float(study["stated_ratio_speed"][0])
names = {getattr(netCDF4.Dataset(f"compared/member-{m:04}.nc"), "title"): m for m in range(2)}
own, other = (float(study["speed"][names[name], 0]) for name in ("stiff", "soft"))
assert abs(ratio - own / other) < 1e-12 * ratio, (ratio, own, other)
rows = [row for row in csv.DictReader(open("compared/error.csv")) if row["key"] == "sum"]
# all levels of the nodes have the finest sheet, those of the other keys the value of the case among them
level, n = study["level_ratio_speed"][..., 0], study["key_levels"][:]
assert all(np.isfinite(level[k]).sum() == n[k] and (k == 0 or ratio in level[k]) for k in np.flatnonzero(n > 1)), level
assert [row["quantity"] for row in rows] == ["speed", "ratio_speed", "change_speed"], rows
assert abs(float(rows[1]["error"]) / float(study["bar_ratio_speed"][0]) - 1) < 1e-2

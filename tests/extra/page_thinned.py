"""The rows that are left in a thinned page: one of so many, and the last one."""
import base64
import json
import re
import netCDF4
import numpy as np

text = open("long.html", encoding="utf-8").read()
run = json.loads(re.search(r'<script type="application/json" id="run">(.*?)</script>', text, re.S).group(1))
time = netCDF4.Dataset("long.nc")["time"][:].filled()
stride = int(re.search(r"wakes: one of (\d+) rows", run["thinned"])[1])
assert (time.size - 1) % stride != 0, "the last row is one of them anyway"
got = np.frombuffer(base64.b64decode(run["wakes"]["time"]), "f8")
assert got.size == run["wakes"]["n"]
assert np.array_equal(got, np.append(time[::stride], time[-1])), got
# vortices that are left have the births of the result
stride = int(re.search(r"vortices: one of (\d+) vortices", run["thinned"])[1])
number, count = (np.frombuffer(base64.b64decode(run["wakes"][key]), "i4") for key in ("number", "count"))
count = count.reshape(-1, 7)[-1]
for f in range(7):
    birth = netCDF4.Dataset("long.nc")["wake_birth"][-1, f].compressed()
    at = number.size - count[f:].sum()
    left = number[at : at + count[f]] * run["wakes"]["interval"]
    kept = birth[np.round(birth / 0.1).astype(int) % stride == 0]
    assert stride > 1 and kept.size == count[f] and np.allclose(left, kept, rtol=0, atol=1e-9), left

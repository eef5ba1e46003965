"""Compare the numbers in a page with those of the result that it is made of."""
import base64
import json
import re
import sys
import netCDF4
import numpy as np

text = open(sys.argv[1], encoding="utf-8").read()
run = json.loads(re.search(r'<script type="application/json" id="run">(.*?)</script>', text, re.S).group(1))
file = netCDF4.Dataset(sys.argv[2])
file.set_auto_mask(False)

def array(part, kind):
    return np.frombuffer(base64.b64decode(part), kind)

def near(name, got, want, atol):
    if got.shape != want.shape or not np.allclose(got, want, rtol=0, atol=atol, equal_nan=True):
        sys.exit(f"{name}: {got} is not {want}")

def places(rows, n):
    box = array(rows["box"], "f8").reshape(-1, 3)
    return box, array(rows["place"], "u2").reshape(n, 2)

names = ["leader", "</script>"]
assert run["title"] == 'two <fish> & "one" page' and [fish["name"] for fish in run["fish"]] == names, run["title"]
assert run["thinned"] == "" and run["rows"] == file["time"].size and len(run["shapes"]) == 2

rows = file["time"].size
box, place = places(run["bodies"], rows * 16)
got = box[:, None, :2] + place.reshape(rows, 16, 2) * box[:, None, 2:]
want = np.concatenate([file["x"][:, 0], file["x"][:, 1, :7]], axis=1)
# rounded to the nearest of the steps of each box
near("bodies", got / box[:, None, 2:], want / box[:, None, 2:], 0.5 + 1e-9)
near("time", array(run["bodies"]["time"], "f8"), file["time"][:], 0)

wakes = run["wakes"]
with_wake = np.flatnonzero((file["wake_count"][:].sum(axis=1) == 0) | np.isfinite(file["wake_circulation"][:, 0, 0]))
assert wakes["n"] == with_wake.size < rows, (wakes["n"], with_wake)
number, count = array(wakes["number"], "i4"), array(wakes["count"], "i4").reshape(-1, 2)
box, place = places(wakes, count.sum())
strength, at = array(wakes["strength"], "i2") * wakes["unit"], 0
assert np.abs(array(wakes["strength"], "i2")).max() == 32767, "all 16 bits"
for i, row in enumerate(with_wake):
    for f in range(2):
        n = file["wake_count"][row, f]
        assert count[i, f] == n, (count[i, f], n)
        near("wake", box[i, :2] + place[at : at + n] * box[i, 2], file["wake_x"][row, f, :n], 0.5001 * box[i, 2] or 1e-12)
        birth = file["wake_birth"][row, f, :n]
        near("births", number[at : at + n] * wakes["interval"], birth, 1e-9)
        young = file["time"][row] - birth < 0.6  # older ones decay
        near("strength", strength[at : at + n][young], file["wake_circulation"][row, f, :n][young], 0.5001 * wakes["unit"])
        assert np.all(np.abs(strength[at : at + n]) <= np.abs(file["wake_circulation"][row, f, :n]) + wakes["unit"])
        at += n
for name in ("speed", "heading", "actuation_power"):
    near(name, array(run["series"][name], "f4").reshape(2, -1).T, file[name][:].astype("f4"), 0)

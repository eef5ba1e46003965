"""What is printed is what is in the file."""
import json
import sys
import netCDF4, numpy as np

found, data = json.load(open("out")), netCDF4.Dataset("json.nc")
data.set_auto_mask(False)
names = [name for name in data.variables if name.startswith("steady_")]
assert sorted(found) == sorted(names + ["file", "fish"]), sorted(found)
assert found["file"] == "json.nc" and found["fish"] == ["a \"fish\""], found
for name in names:
    values = np.array(data[name][...], float)
    if data[name].dimensions[:1] == ("multiplier",):
        values = values[np.isfinite(values.reshape(len(values), -1)).any(axis=1)]
    assert len(values.shape) == 0 or len(found[name]) == len(values), name
    assert np.array_equal(np.ravel(np.array(found[name], float)), np.ravel(values), equal_nan=True), name
assert len(found["steady_multiplier"]) == int(sys.argv[1])

"""json_summary.py: run.json and study.json, of `shoal info --json`, say what is in summary.nc and other-study/study.nc."""

import json, netCDF4, numpy as np
run, data = json.load(open("run.json")), netCDF4.Dataset("summary.nc")
data.set_auto_mask(False)
assert run["kind"] == "run" and run["status"] == "complete" and run["rows"] == len(data["time"]) and len(run["warnings"]) == 1
assert run["warnings"][0].startswith("the run has 0.3 beats of fish: means and powers are not those of a cycle")
assert run["fish"] == ["fish"] and run["case"] == "demo"
for name, variable in data.variables.items():
    if {"node", "edge", "joint", "sheet", "control", "vortex"} & set(variable.dimensions):
        assert name not in run, name
    elif variable.dtype != "S1":
        values = variable[-1] if variable.dimensions[:1] == ("time",) else variable[...]
        assert np.array_equal(np.array(run[name], float), np.array(values, float), equal_nan=True), name
study, data = json.load(open("study.json")), netCDF4.Dataset("other-study/study.nc")
assert study["kind"] == "study" and study["status"] == ["complete"] * 2
assert study["fish_wave_amplitude"] == [0.3, 0.4] and {"speed", "nose", "steps", "fish_wave_amplitude"} <= {*study}
for name in {*data.variables} & {*study}:
    if data[name].dtype != "S1":
        assert np.array_equal(np.array(study[name], float), np.ma.filled(data[name][...], np.nan), equal_nan=True), name

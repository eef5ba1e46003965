#!/usr/bin/python3
"""budget.py FOLDER...: error.csv and study.nc say the same, and the units of study.nc are those of its quantities."""

import csv
import sys

import netCDF4
import numpy as np


def text(values):
    return [b"".join(row).rstrip(b"\0").decode() for row in np.ma.getdata(values)]


def near(got, want, rtol, what):
    assert np.isclose(float(got), float(want), rtol=rtol, atol=1e-12, equal_nan=True), (what, got, want)


for folder in sys.argv[1:]:
    data = netCDF4.Dataset(f"{folder}/study.nc")
    data.set_auto_mask(False)
    data.set_auto_chartostring(False)
    for name, variable in data.variables.items():
        prefix, _, quantity = name.partition("_")
        if variable.dtype == "S1" or name.startswith("key_value"):
            continue
        unit = data[quantity].units if prefix in ("stated", "bar", "expected", "noise", "lowest", "highest", "part", "shift", "spread") else None
        assert variable.units == (unit or ("1" if prefix in ("key", "point", "member") else variable.units)), name

    keys, fish, points = text(data["key_name"][:]), text(data["fish"][:]), []
    n_rows = 0
    for row in csv.DictReader(open(f"{folder}/error.csv")):
        swept = list(row.values())[10:]
        if swept not in points:
            points.append(swept)
        quantity, p, f = row["quantity"], len(points) - 1, fish.index(row["fish"]) if row["fish"] else 0

        def of(name, k=0, quantity=f"_{quantity}", place={"point": p, "fish": f}):
            variable = data[name + quantity]
            return variable[tuple({**place, "key": k}[d] for d in variable.dimensions)]

        model = row["key"] if row["key"] in ("lowest", "highest") else "stated"
        value, error = of("stated"), row["error"]
        near(row["value"], of(model), 1e-8, row)
        near(row["percent"], 100 * float(error) / abs(value), 1e-2, row)
        n_rows += 1
        if row["key"] == "sum":
            near(error, of("bar"), 1e-2, row)
            spread = [of("spread", k) for k in range(len(keys)) if not data["key_is_choice"][k]]
            bar = abs(of("expected") - value) + np.sqrt(np.nansum(np.square(spread))) + of("noise")
            assert points != [[]] or np.isclose(bar, of("bar")), row
        elif model != "stated":
            near(error, abs(of(model) - value), 1e-2, row)
        else:
            k = keys.index(row["key"])
            near(error, of("part", k), 1e-2, row)
            near(row["order"], of("key_order", k), 1e-2, row)
            assert data["key_is_choice"][k] == row["verdict"].startswith("a choice of the model"), row
            levels = row["levels"].split()
            stated = [level[0] == "[" for level in reversed(levels)].index(True)
            assert len(levels) == of("key_levels", k, "") and stated == of("key_stated", k, ""), row
    assert n_rows > 0 and len(points) == (len(data.dimensions["point"]) if "point" in data.dimensions else 1)

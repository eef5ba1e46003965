#!/usr/bin/python3
"""trace_totals.py TRACE RESULT: whether the lines of a trace add up to the totals of the result."""

import csv
import sys

import netCDF4

rows = list(csv.DictReader(open(sys.argv[1], newline="", encoding="utf-8")))
data = netCDF4.Dataset(sys.argv[2])
total = {name: int(data[name][-1]) for name in ("steps", "error_test_failures", "newton_iterations", "gmres_iterations")}
results = [row["result"] for row in rows]
assert results.count("accepted") == total["steps"], (results.count("accepted"), total)
assert results.count("error_test") == total["error_test_failures"] > 0, total
assert sum(int(row["iterations"]) for row in rows) == total["newton_iterations"]
assert sum(int(row["gmres"]) for row in rows) == total["gmres_iterations"] > 0
for row in rows:
    n = int(row["iterations"])
    assert all(len(row[name].replace("|", " ").split()) == n for name in ("norms", "differential_norms", "rates")), row
    assert row["fish"] in ('one, "two"', "three"), row
    assert (int(row["age"]) == 0) == (int(row["jacobians"]) > 0 and "|" not in row["norms"]) or "|" in row["norms"], row

# accepted steps end at the events, and their orders are those of the result
accepted = [row for row in rows if row["result"] == "accepted"]
assert abs(float(accepted[-1]["t"]) - 0.4) < 1e-9 and int(accepted[-1]["event"]) == 20
orders = [sum(int(row["order"]) == order for row in accepted) for order in range(1, 6)]
assert orders == data["steps_of_order"][-1].tolist(), orders

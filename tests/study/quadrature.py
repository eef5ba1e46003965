"""quadrature.py: the errors of nodes and of uncertain numbers in uncertain/error.csv add in quadrature, each by its slope."""

import csv

rows = list(csv.DictReader(open("uncertain/error.csv")))
of = {(row["quantity"], row["key"]): row for row in rows}
number = lambda key, column: float(of["steady_lift", key][column])
parts = [number(key, "error") for key in ("fish.nodes", "fish.body.modulus", "fluid.density")]
assert abs(number("sum", "error") / sum(part**2 for part in parts) ** 0.5 - 1) < 1e-2, parts
slope = float(of["sensitivity_steady_lift", "fish.body.modulus"]["value"])
assert abs(parts[1] / (0.1 * slope * number("sum", "value")) - 1) < 1e-2, (parts, slope)

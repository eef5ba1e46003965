"""started.py: a search that starts from another state has the sensitivity of the other, within the errors of both."""

import csv

one, two = ([row for row in csv.DictReader(open(f"{name}/error.csv")) if row["key"] == "fish.body.modulus" and
             row["quantity"] == "sensitivity_steady_speed"][0] for name in ("swims", "again"))
assert abs(float(one["value"]) - float(two["value"])) <= float(one["error"]) + float(two["error"]), (one, two)

#!/usr/bin/python3
"""sums.py FOLDER [FISH/]QUANTITY SUM KEY=FACTOR...: a sum of sensitivities is as theory has it, within its errors."""

import csv
import sys

folder, quantity, want, *terms = sys.argv[1:]
fish, _, quantity = quantity.rpartition("/")
table = [row for row in csv.DictReader(open(f"{folder}/error.csv")) if row["quantity"] == f"sensitivity_{quantity}"]
rows = {row["key"]: row for row in table if row["fish"] == (fish or row["fish"])}
terms = [(rows[key], float(factor)) for key, factor in (term.split("=") for term in terms)]
got = sum(factor * float(row["value"]) for row, factor in terms)
error = sum(abs(factor) * float(row["error"]) for row, factor in terms)
assert abs(got - float(want)) <= error < 0.05, (got, want, error)

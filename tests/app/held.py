"""The three numbers of a case in every place where they are shown, relative to those of the run; and in theory."""
import re
import sys
import netCDF4

def last(path, *names):
    data = netCDF4.Dataset(path)
    return [float(data[name][:].reshape(-1)[-1]) for name in names]

def columns(path, *heads):
    """Of the last row of the first table with these heads: numbers are right-aligned below their heads."""
    lines = open(path).read().splitlines()
    at = next(i for i, line in enumerate(lines) if all(re.search(rf"\b{head}\b", line) for head in heads))
    return [float(lines[at + 2][:re.search(rf"\b{head}\b", lines[at]).end()].split()[-1]) for head in heads]

def rows(path, *names):
    text = open(path).read()
    return [float(re.search(rf"^ *{name} +(\S+)", text, re.M)[1]) for name in names]

case, tolerance, theory = sys.argv[1], float(sys.argv[2]), sys.argv[3:]
true = ["mean_thrust", "mean_power", "efficiency"]
steady, shown = ["steady_thrust", "steady_power", "steady_efficiency"], ["thrust", "power", "efficiency"]
expected = last(f"{case}.nc", *true)
found = {
    "info": columns(f"{case}.info", *shown),
    "study.nc": last(f"study-{case}/study.nc", *true),
    "table of the study": columns(f"study-{case}.table", *shown),
    "steady": last(f"steady-{case}.nc", *steady),
    "rows of the steady state": last(f"steady-{case}.nc", *true),
    "steady, printed": rows(f"steady-{case}.info", "thrust", "power of muscle and drive", "efficiency"),
    "study of steady states": last(f"swept-{case}/study.nc", *steady),
    "its table": columns(f"swept-{case}.table", *shown),
}
problems = [f"{place}: {values}, not {expected}" for place, values in found.items()
            if any(abs(v / e - 1) > tolerance for v, e in zip(values, expected))]
speed = last(f"{case}.nc", "speed")[0]
if abs(expected[0] * speed / expected[1] / expected[2] - 1) > 1e-9:
    problems.append("efficiency is not thrust times speed over power")
data = netCDF4.Dataset(f"{case}.nc")
thrust = data["thrust"][-round(1 / data["time"][1]) - 1:, 0]
if abs((thrust[:-1].sum() + thrust[1:].sum()) / 2 / (len(thrust) - 1) / expected[0] - 1) > 0.05:
    problems.append("the mean of the thrust of the instant is another one")
if theory and abs(expected[2] / float(theory[0]) - 1) > 0.01:
    problems.append(f"efficiency {expected[2]}, in theory {theory[0]}")
sys.exit("; ".join(problems) or 0)

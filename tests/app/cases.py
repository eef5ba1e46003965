"""Run the cases or the studies of cases/, and compare with what they state.

    tests/app/cases.py PROGRAM CASES TABLE cases|studies|long

cases: every case gives the numbers of TABLE, and its line "# Expected" states them. With WRITE=1 in the environment the
numbers of this program go into both. studies: those of less than 5 s meet what they expect; long: the others.
"""
import glob
import math
import os
import re
import subprocess
import sys

import netCDF4
import numpy as np

program, cases, table, which = sys.argv[1:]
counts = {"ok": 0, "FAILED": 0, "skipped": 0}
LONG = ["depth", "start_speed", "stiffness", "stiffness_cost", "added_mass", "plate_stiffness", "steady_resonance",
        "stiffness_elastic", "step_response", "follower_spacing", "feedback", "school_stability"]  # 5 s to 30 min


def check(name, good, words=""):
    """Count and print one check."""
    word = "ok" if good else "FAILED"
    counts[word] += 1
    print(f"{word:7s} {name}{': ' if words else ''}{words}", flush=True)


def run(case, end):
    """Run a case, up to a time, or find its equilibrium; the open result, or None."""
    path = f"{case}-{end}.nc"
    shorter = [] if end in ("-", "steady") else ["--set", f"time.end={end}"]
    done = subprocess.run(
        [program, "steady" if end == "steady" else "run", f"{cases}/{case}.yaml", "-q", "-o", path, *shorter],
        stdin=subprocess.DEVNULL, capture_output=True, text=True,
    )
    # the comment of a case names its warnings, except for an unsteady speed and few beats of a shortened run
    announced = "warning" in open(f"{cases}/{case}.yaml").read().lower()
    short = ("shoal: warning: the speed of ", "shoal: warning: the run has ")
    expected = "shoal: warning: " if announced else short if shorter else None
    others = [line for line in done.stderr.splitlines() if not (expected and line.startswith(expected))]
    if done.returncode or done.stdout or others:
        check(f"{case} runs", False, f"exit code {done.returncode}: {done.stderr[:500]}")
        return None
    data = netCDF4.Dataset(path)
    check(f"{case} runs", data.run_status == "complete", data.run_status)
    # an iteration that fails with an old Jacobian is repeated with a new one: rare, and no error
    failures, n_events = int(data["convergence_failures"][-1]), data["time"][-1] / data["shedding_interval"][...]
    check(f"{case} convergence failures", failures <= 2 + 0.01 * n_events, f"{failures} in {n_events:.0f} events")
    circulation = np.abs(data["total_circulation"][:]).max()
    check(f"{case} total circulation", circulation < 1e-10, f"{circulation:.1e}")
    return data


def quantity(data, name, fish):
    """The number that a line of the table asks for."""
    time = data["time"][:]
    # the rows of the last beat: all cases beat once a second; an equilibrium has one row
    beat = slice(-round(1 / (time[1] - time[0])), None) if len(time) > 1 else slice(None)
    if name == "steps":
        return data["steps"][-1] * data["shedding_interval"][...] / time[-1]
    if name == "tail":
        return np.ptp(data["x"][beat, fish, -1, 1])
    if name == "turning":
        return np.degrees(2 * np.arctan(data["natural_curvature"][beat, fish] * data["edge_length"][fish] / 2)).sum(axis=1).mean()
    how, _, variable = name.rpartition(":")
    values = np.ma.filled(data[variable][:], np.nan)
    if variable.startswith("steady_"):
        return values[fish]  # over the fish only
    values = values if fish is None else values[:, fish]
    return {"": lambda v: v[-1], "beat": lambda v: v[beat].mean(), "least": np.nanmin, "most": np.nanmax}[how](values)


PHRASES = {  # of a quantity in the line "# Expected" of a case
    "speed": "speed {} m/s", "ground_speed": "speed over ground {} m/s", "beat:heading": "mean heading {} degrees",
    "least:least_distance": "least distance {} m",
    "tail": "sweep of the tail {} m", "turning": "sum of the turning angles {} degrees", "steps": "{} steps per event",
    "efficiency": "efficiency {}", "most:leading_edge_a0": "largest A_0 {}", "beat:thrust": "mean thrust {} N",
    "most:contact_energy": "largest contact energy {} J", "kinetic_energy": "kinetic energy {} J",
    "polarisation": "polarisation {}", "steady_drag": "drag {} N", "steady_lift": "lift {} N",
    "steady_deflection": "deflection of the tail {} m", "mean_thrust": "mean thrust over the last period {} N",
    "mean_power": "mean power over the last period {} W",
    "separation_share": "part of the last period with separation {}",
}


def expected(case):
    """The line "# Expected" of a case, from the table."""
    parts = []
    for name, end, quantity, fish, value, _ in rows:
        if name == case:
            several = sum(1 for row in rows if row[0] == case and row[3] != fish) > 0 and fish != "-"
            phrase = PHRASES.get(quantity, quantity.replace("_", " ") + " {}")
            parts.append(phrase.format(value) + (f" (fish[{fish}])" if several else ""))
    when = {"-": "at the end", "steady": "in equilibrium"}.get(next(row[1] for row in rows if row[0] == case))
    when = when or f"after {next(row[1] for row in rows if row[0] == case)} s"
    return f"# Expected {when}: {', '.join(parts)}."


def write_expected(case):
    """Put the line "# Expected" into a case, above its commands."""
    path = f"{cases}/{case}.yaml"
    lines = [line for line in open(path).read().split("\n") if not line.startswith("# Expected ")]
    command = next((i for i, line in enumerate(lines) if line.startswith("#   ")), None)
    lines.insert(command - 1 if command else 1, expected(case))
    open(path, "w").write("\n".join(lines))


rows = [line.split() for line in open(table) if line.strip() and not line.startswith("#") and which == "cases"]
results = {}
written = {}
for case, end, name, fish, value, tolerance in rows:
    if (case, end) not in results:
        results[case, end] = run(case, end)
    if results[case, end] is not None:
        got = quantity(results[case, end], name, None if fish == "-" else int(fish))
        if os.environ.get("WRITE"):
            value = f"{got:.{max(0, math.ceil(-math.log10(float(tolerance))))}f}"
            written[case, end, name, fish] = value
        good = abs(got - float(value)) <= float(tolerance)
        check(f"{case} {name} {fish}", good, f"{got:.5f}, expected {value} within {tolerance}")
if os.environ.get("WRITE"):
    lines = open(table).read().split("\n")
    for i, line in enumerate(lines):
        words = line.split()
        if line.startswith("#") or tuple(words[:4]) not in written:
            continue
        lines[i] = re.sub(r"^((?:\S+\s+){4})(\S+)(\s+)(\S+)$", lambda m: m[1] + written[tuple(words[:4])].ljust(10) + m[4], line)
    open(table, "w").write("\n".join(lines))
    rows = [line.split() for line in lines if line.strip() and not line.startswith("#")]
    for case in dict.fromkeys(row[0] for row in rows):
        write_expected(case)
for case in dict.fromkeys(row[0] for row in rows):
    check(f"{case} states what is expected", expected(case) in open(f"{cases}/{case}.yaml").read().split("\n"))
for path in sorted(glob.glob(f"{cases}/*.yaml")):
    case = os.path.basename(path)[:-5]
    if which == "cases" and case not in (row[0] for row in rows):
        check(f"{case} has an expected result", False, f"there is none in {table}")


def study(path):
    """Run a study: it ends with exit code 0 only if it meets what it expects."""
    name = os.path.basename(path)[:-5]
    shown = subprocess.run([program, "show", path], stdin=subprocess.DEVNULL, capture_output=True, text=True)
    check(f"study {name} states what it expects", "expect:" in shown.stdout, shown.stderr[:500])
    done = subprocess.run(
        [program, "study", path, "-q", "-o", name], stdin=subprocess.DEVNULL, capture_output=True, text=True
    )
    check(f"study {name} meets it", done.returncode == 0, f"exit code {done.returncode} {done.stderr[:500]}")


for path in sorted(glob.glob(f"{cases}/studies/*.yaml")):
    is_long = os.path.basename(path)[:-5] in LONG
    if which == ("long" if is_long else "studies"):
        study(path)

print(f"{counts['ok']} passed, {counts['FAILED']} failed, {counts['skipped']} skipped")
sys.exit(counts["FAILED"] > 0)

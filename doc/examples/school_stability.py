#!/usr/bin/python3
"""Chart when plates in line hold together: the amplitude of the heave below which a school falls apart.

    doc/examples/school_stability.py [--plates 2 3 4 5 6] [--table school_stability.csv] [--figure school_stability.png]
                                     [--wake 1 3] [--set KEY=VALUE]

Plates that heave in line keep places about one wavelength (the distance covered in a beat) apart. For each amplitude the
program searches for the steady state of two plates, then for that of three, and so on: a further plate starts as far behind
the last one as this is behind its leader. The largest Floquet multiplier of each state, with its error, says whether a
disturbance grows. The table has a row for each state; a state that it has already is not computed again.

On the way from large amplitudes, the threshold of a school is where its multiplier passes 1, by the line of least squares through
the states around it, over the logarithm of the amplitude and weighted by their errors. A school whose multiplier does
not pass 1 has only a bound.
"""

import argparse
import csv
import os
import pathlib
import resource
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))  # not needed once installed
import shoal  # noqa: E402

CASE = str(pathlib.Path(__file__).resolve().parents[2] / "cases" / "studies" / "school_stability.yaml")
HEAVES = [0.2, 0.18, 0.17, 0.165, 0.16, 0.1575, 0.155, 0.1525, 0.15, 0.145, 0.14, 0.135, 0.13, 0.125, 0.12, 0.11, 0.1, 0.09, 0.075]  # m
LENGTH = 1.0  # m
WITHIN = 1.12  # states whose amplitude differs by less than this factor from a crossing count for the threshold
LEAST_ERROR = 1e-3  # of a multiplier: two states without noise are no better known
WAKE = 1.0, 3.0  # beats for which all wakes keep their strength behind the last plate, and in which they then lose it
SPEED, EXPONENT = 3.87, 1.55  # m s-1 at a heave of 0.15 m, and how it grows with the heave: a start of the search
COLUMNS = ["plates", "heave", "speed", "multiplier", "error", "period", "cpu", "places"]


def case_of(heave, speed, places, wake=WAKE):
    """A school in line: places in m, negative behind the first plate."""
    # the wakes of all plates end at the same place: what they do to each other far behind the last plate grows in a chaotic
    # way, and would disturb the multipliers
    lives = (np.array(places) - places[-1]) / speed + sum(wake)  # beats of 1 s
    fish = [{"name": chr(ord("a") + i), "start": {"position": [float(-place), 0]}, "wake_lifetime": float(life / lives[0])}
            for i, (place, life) in enumerate(zip(places, lives))]
    return {
        "format": 1, "include": [CASE], "name": "school", "sweep": [], "expect": [], "fish": fish,
        "wake": {"lifetime": float(lives[0]), "decay": float(wake[1])},
        "defaults": {"fish": {"start": {"speed": float(speed)}, "motion": {"heave": float(heave)}}},
    }


def cpu_seconds():
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime


def state_of(heave, before, wake=WAKE, assignments=()):
    """The steady state of one plate more than in the row of another state, as a row of the table; without a multiplier if
    there is none."""
    places = np.array(before["places"])
    gap = places[-2] - places[-1] if len(places) > 1 else LENGTH + 1.03 * before["speed"]
    start, began = np.append(places, places[-1] - gap), cpu_seconds()
    row = {"plates": len(start), "heave": heave, "speed": before["speed"], "multiplier": np.nan, "error": np.nan,
           "period": np.nan, "places": list(start)}
    with tempfile.TemporaryDirectory() as folder:
        try:
            case = case_of(heave, before["speed"], start, wake)
            state = shoal.steady(case, assignments, path=os.path.join(folder, "state.nc"), progress=False)
            largest = state.multipliers[0]
            row.update(speed=float(state.speed[0]), multiplier=abs(largest), error=float(state.multiplier_error[0]),
                       places=[float(place) for place in state.place[:, 0]])
            row["period"] = 2 * np.pi / abs(np.angle(largest)) if largest.imag else np.inf
        except shoal.SolverError as wrong:
            print(f"{len(start)} plates, heave {heave} m: {wrong}", file=sys.stderr)
    row["cpu"] = cpu_seconds() - began
    return row


def verdict(row):
    """Stable, unstable or undecided, as `shoal steady` says it."""
    if not np.isfinite(row["multiplier"]):
        return "none"
    excess = row["multiplier"] - 1
    return "undecided" if abs(excess) <= row["error"] else "unstable" if excess > 0 else "stable"


def read_table(path):
    if not os.path.exists(path):
        return []
    with open(path, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    return [{"plates": int(row["plates"]), **{name: float(row[name]) for name in COLUMNS[1:-1]},
             "places": [float(place) for place in row["places"].split()]} for row in rows]


def write_table(path, rows):
    with open(path + ".new", "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(COLUMNS)
        for row in sorted(rows, key=lambda row: (row["plates"], row["heave"])):
            writer.writerow([row["plates"], *(f"{row[name]:.6g}" for name in COLUMNS[1:-1]),
                             " ".join(f"{place:.5f}" for place in row["places"])])
    os.replace(path + ".new", path)


def threshold_of(rows):
    """Of the states of one number of plates: the amplitude at which the multiplier passes 1, on the way from large amplitudes,
    and its bar, m; None if it does not pass 1. As large as the errors of the multipliers, the bar is twice the standard
    deviation."""
    rows = sorted((row for row in rows if np.isfinite(row["multiplier"])), key=lambda row: -row["heave"])
    sizes = [row["multiplier"] for row in rows]
    first = next((i for i in range(1, len(rows)) if sizes[i - 1] < 1 <= sizes[i]), None)
    if first is None:
        return None
    middle = np.sqrt(rows[first - 1]["heave"] * rows[first]["heave"])
    near = [row for i, row in enumerate(rows) if first - 1 <= i <= first or 1 / WITHIN < row["heave"] / middle < WITHIN]
    excess = np.array([row["multiplier"] - 1 for row in near])
    error = np.array([max(row["error"], LEAST_ERROR) for row in near])
    way = np.log([row["heave"] for row in near])
    matrix = np.column_stack([np.ones_like(way), way]) / error[:, None]
    covariance = np.linalg.inv(matrix.T @ matrix)
    line = covariance @ matrix.T @ (excess / error)
    if len(near) > 2:  # errors are twice the standard deviations; states that scatter more widen the bar
        covariance *= max(1.0, np.sum((2 * (excess / error - matrix @ line)) ** 2) / (len(near) - 2))
    crossing = -line[0] / line[1]
    gradient = np.array([1, crossing]) / line[1]
    return np.exp(crossing), np.exp(crossing) * np.sqrt(gradient @ covariance @ gradient)


def bound_of(rows):
    """The smallest amplitude at which, and above which, all states are stable; None if the largest is not."""
    bound = None
    for row in sorted(rows, key=lambda row: -row["heave"]):
        if verdict(row) != "stable":
            break
        bound = row["heave"]
    return bound


def fill(rows, plates, heaves, path, wake=WAKE, assignments=()):
    """Compute the states that the table does not have."""
    for heave in heaves:
        at = {row["plates"]: row for row in rows if abs(row["heave"] - heave) < 1e-9}
        before = {"plates": 1, "speed": SPEED * (heave / 0.15) ** EXPONENT, "places": [0.0]}
        for n in range(2, max(plates) + 1):
            if n not in at:
                row = at[n] = state_of(heave, before, wake, assignments)
                rows.append(row)
                write_table(path, rows)
                print(f"{n} plates, heave {heave:5.3f} m: {row['multiplier']:.4f} +- {row['error']:.4f}, period {row['period']:.2f} "
                      f"beats, {verdict(row)}, {row['cpu']:.0f} s", flush=True)
            before = at[n]
            # a further plate needs the places of those before it, and does not calm them
            if verdict(before) in ("none", "unstable"):
                break
    return rows


def report(rows):
    """A line for each number of plates."""
    for n in sorted({row["plates"] for row in rows}):
        of_n = [row for row in rows if row["plates"] == n]
        found, bound = threshold_of(of_n), bound_of(of_n)
        is_none = all(verdict(row) == "none" for row in of_n)
        words = f"threshold {found[0]:.3f} +- {found[1]:.3f} m" if found else f"stable down to {bound:g} m" if bound else "undecided"
        words = "no steady state was found" if is_none else words
        yield f"{n} plates: {words} ({np.nanmean([row['cpu'] for row in of_n]):.0f} s of CPU time a state)"


def draw(path, rows):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    marks = {"stable": ("o", "#0072b2"), "undecided": ("D", "#999999"), "unstable": ("s", "#d55e00"), "none": ("x", "#444444")}
    with matplotlib.rc_context(shoal.plot.STYLE):
        figure, (left, right) = pyplot.subplots(1, 2, figsize=(7, 3.6), layout="constrained")
        for kind, (mark, colour) in marks.items():
            some = [row for row in rows if verdict(row) == kind]
            left.plot([row["plates"] for row in some], [row["heave"] for row in some], mark, color=colour, ms=4, ls="",
                      label="no steady state found" if kind == "none" else kind)
        schools = {n: sorted((row for row in rows if row["plates"] == n), key=lambda row: row["heave"])
                   for n in sorted({row["plates"] for row in rows})}
        found = [(n + 0.25, *threshold_of(some)) for n, some in schools.items() if threshold_of(some)]
        bounds = [(n + 0.25, bound_of(some)) for n, some in schools.items() if not threshold_of(some) and bound_of(some)]
        if found:
            left.errorbar(*np.transpose(found), fmt="_", color="black", ms=9, capsize=3, lw=1, label="threshold")
        if bounds:
            left.plot(*np.transpose(bounds), "v", color="black", ms=4, ls="", label="stable down to here")
        for n, some in schools.items():
            some = [row for row in some if np.isfinite(row["multiplier"])]
            if not some:
                continue
            right.errorbar([row["heave"] for row in some], [row["multiplier"] for row in some], [row["error"] for row in some],
                           fmt="o-", ms=2.5, lw=0.8, capsize=2, color=pyplot.get_cmap("viridis")((n - 2) / 6.5), label=str(n))
        left.set(xlabel="plates in line", ylabel="amplitude of the heave [m]", xticks=list(schools))
        right.axhline(1, color="black", lw=0.6)
        right.set(xlabel="amplitude of the heave [m]", ylabel="largest multiplier")
        for axes, title in ((left, None), (right, "plates")):
            axes.grid(lw=0.3)
            axes.legend(fontsize="small", title=title, ncols=2 if axes is left else 4, loc="lower center", bbox_to_anchor=(0.5, 1),
                        frameon=False)
        figure.savefig(path)
    print(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--plates", type=int, nargs="+", default=[2, 3, 4, 5, 6, 7, 8], metavar="N", help="numbers of plates (2 to 8)")
    parser.add_argument("--heaves", type=float, nargs="+", default=HEAVES, metavar="HEAVE", help="amplitudes, m (0.2 to 0.075)")
    parser.add_argument("--table", default="school_stability.csv", metavar="FILE", help="of all states; it may have some already (school_stability.csv)")
    parser.add_argument("--figure", metavar="PICTURE", help="draw the chart")
    parser.add_argument("--wake", type=float, nargs=2, default=WAKE, metavar=("WHOLE", "DECAY"),
                        help="beats for which all wakes keep their strength behind the last plate, and in which they then lose it (1 3)")
    parser.add_argument("--set", nargs="+", default=[], metavar="KEY=VALUE", help="other values of keys of the case")
    options = parser.parse_args()
    rows = fill(read_table(options.table), options.plates, options.heaves, options.table, options.wake, options.set)
    for line in report(rows):
        print(line)
    if options.figure:
        draw(options.figure, rows)


if __name__ == "__main__":
    main()

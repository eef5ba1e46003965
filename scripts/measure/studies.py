#!/usr/bin/python3
"""Measure the tables of doc/studies.md: are the true errors below the bars of `shoal error`?

How to call it: scripts/measure/tables.py.
"""

import os
import shutil

import numpy as np
from tables import main, open_study, strings, table

DEFAULTS = {
    "swim": ("swim", []),
    "swim, modulus 1e7": ("swim", ["fish[*].body.modulus=1e7"]),
    "swim, frequency 2": ("swim", ["fish[*].wave.frequency=2"]),
    "swim, force reactive": ("swim", ["fish[*].force=reactive"]),
    "foil_static": ("foil_static", []),
}


def finest(study):
    """Assignments of one run that is finer in all keys of an error study together than its finest level in each of them."""
    sets = []
    for k, key in enumerate(strings(study["key_name"])):
        if study["key_levels"][k] < 2:
            continue
        level = float(study["key_value"][k, 0])
        is_grid = key.startswith("fish.") or key == "time.shedding_interval"
        sets += finer(key, level if is_grid else level / 2 if key == "wake.lifetime" else level * 10)
    return sets


def true_values(bench, path, of, sets):
    """Quantities of all fish in one run, or in one steady state."""
    is_steady = of[0].startswith("steady_")
    true = os.path.join(bench.folder, "true.nc")
    words = [word for one in sets + ["steady.multipliers=false"] * is_steady for word in ("--set", one)]
    bench.call("steady" if is_steady else "run", path, "-q", "--force", "-o", true, *words)
    result = open_study(true)
    last = {quantity: result[quantity][:] if is_steady else result[quantity][-1] for quantity in of if quantity in result.variables}
    return {quantity: np.atleast_1d(value) for quantity, value in last.items()}


def bar_cells(value, bar, true):
    """Value, bar, true error and their ratio, as cells of a table; and the ratio."""
    error = abs(true - value)
    return [f"{value:.5g}", f"{bar / abs(value):.2e}", f"{error / abs(value):.2e}", f"{bar / error:.2f}"], bar / error


def inside(ratios):
    """The last row of a table of bars."""
    return f"{sum(ratio >= 1 for ratio in ratios)} of {len(ratios)} inside", "", "", "", "median", f"{np.median(ratios):.2f}"


@table("case", "quantity", "value", "bar / value", "error / value", "bar over error")
def bars_of_defaults(bench):
    """bars of 18 numbers against runs with all numerical keys refined together (10 minutes)"""
    ratios = []
    for name, (case, sets) in DEFAULTS.items():
        of = ["steady_lift", "steady_deflection"] if case == "foil_static" else STEADY
        path, folder = bench.case(case), os.path.join(bench.folder, "defaults")
        words = [word for one in sets for word in ("--set", one)]
        bench.call("error", path, "-q", "--force", "-o", folder, *words, *[word for q in of for word in ("--of", q)])
        study = open_study(os.path.join(folder, "study.nc"))
        true = true_values(bench, path, of, sets + finest(study))
        for quantity in of:
            cells, ratio = bar_cells(*(float(study[f"{what}_{quantity}"][0]) for what in ("stated", "bar")), true[quantity][0])
            ratios.append(ratio)
            yield name, quantity.removeprefix("steady_"), *cells
    yield inside(ratios)


def pairs():
    """Pairs that studies ask for: name, quantity, text of the case, and of the other case or FISH=FISH."""

    def swim(fish, body="control: {law: course}"):
        return ("format: 1\ntime: {end: 4, shedding_interval: 0.02, output_interval: 0.1}\n"
                f"defaults: {{fish: {{nodes: 17, start: {{speed: 0.8}}, {body}}}}}\nfish: [{fish}]\n")

    def steady(body):
        return f"format: 1\ntime: {{end: 20, shedding_interval: 0.02}}\nfish: [{{name: fish, nodes: 17, {body}}}]\n"

    def plates(gap):
        return ("format: 1\ntime: {end: 3, shedding_interval: 0.02, output_interval: 0.1}\nfluid: {density: 1, viscosity: 2e-3}\n"
                "defaults:\n  fish: {nodes: 9, force: pressure, pressure: {span: infinite, suction_limit: 0}, start: {speed: 2}, "
                f"{STILL}, body: {{profile: uniform, thickness: 0.05, depth: 1, density: 20, modulus: 1e6}}, "
                "motion: {prescribed: all, heave: 0.1, frequency: 1}}\n"
                f"fish: [{{name: leader}}, {{name: follower, start: {{position: [{1 + gap:g}, 0]}}}}]\n")

    def foil(modulus):
        return ("format: 1\ntime: {end: 20, shedding_interval: 0.02, output_interval: 0.1}\n"
                "fluid: {density: 1, velocity: [1, 0], viscosity: 0}\nwake: {lifetime: 20}\n"
                "fish: [{name: foil, force: pressure, pressure: {span: infinite, suction_limit: 0}, start: {heading: 174, speed: 0}, "
                f"{STILL}, body: {{profile: uniform, thickness: 0.05, depth: 1, density: 25.465, modulus: {modulus:g}}}, "
                "motion: {prescribed: head}}]\n")

    cost, alone = "cost_of_transport", swim("{name: alone}")
    behind = "{name: leader}, {name: follower, start: {position: [1.4, 0.3]}}"
    beside = "{name: right}, {name: left, start: {position: [0, 0.5]}, wave: {phase: PHASE}}"
    in_phase, opposite = (swim(beside.replace("PHASE", phase)) for phase in ("0", "180"))
    yield "follower, alone", cost, swim(behind), alone
    yield "follower, leader", cost, swim(behind), "follower=leader"
    yield "antiphase, in phase", cost, opposite, in_phase
    yield "side by side, alone", cost, in_phase, alone
    yield "with control, without", cost, swim(behind), swim(behind, "control: {}")
    yield "plates, gap 1 and 1.5", "mean_thrust", plates(1), plates(1.5)
    yield "modulus 3e6, 1.5e6", f"steady_{cost}", steady("body: {modulus: 3e6}"), steady("body: {}")
    yield "frequency 2, 1", "steady_speed", steady("wave: {frequency: 2}"), steady("body: {}")
    yield "amplitude 0.5, 0.4", "steady_efficiency", steady("wave: {amplitude: 0.5}"), steady("body: {}")
    yield "foil, modulus 5e4, 1e5", "steady_lift", foil(5e4), foil(1e5)


@table("pair", "quantity", "ratio", "bar / ratio", "error / ratio", "bar over error", "the same of the difference")
def bars_of_pairs(bench):
    """bars of the ratios of ten pairs against runs of both cases with all numerical keys refined together (10 minutes)"""
    ratios, changes, known = [], [], {}

    def true_value(path, text, quantity, sets):
        """The quantity of the last fish and of the first; a case that is in several pairs runs once."""
        key = (text, *sets)
        if key not in known:
            known[key] = true_values(bench, path, STEADY if quantity in STEADY else [quantity], sets)
        return known[key][quantity][-1], known[key][quantity][0]

    for number, (name, quantity, text, other) in enumerate(pairs()):
        case, against = (os.path.join(bench.folder, f"{number}-{what}.yaml") for what in ("case", "against"))
        is_school = "\n" not in other
        for path, words in ((case, text), (against, other))[:1 if is_school else 2]:
            with open(path, "w", encoding="utf-8") as file:
                file.write(words)
        folder = os.path.join(bench.folder, f"{number}-pair")
        bench.call("error", case, "-q", "-o", folder, "--of", quantity, "--against", other if is_school else against)
        study = open_study(os.path.join(folder, "study.nc"))
        sets = finest(study)
        true, leader = true_value(case, text, quantity, sets)
        compared = leader if is_school else true_value(against, other, quantity, sets)[0]
        stated = {f"{what}_{of}": float(np.ravel(study[f"{what}_{of}_{quantity}"])[-1])
                  for what in ("stated", "bar") for of in ("ratio", "change")}
        cells, ratio = bar_cells(stated["stated_ratio"], stated["bar_ratio"], true / compared)
        change = bar_cells(stated["stated_change"], stated["bar_change"], true - compared)[1]
        ratios.append(ratio)
        changes.append(change)
        yield name, quantity.removeprefix("steady_"), *cells, f"{change:.2f}"
    yield (*inside(ratios), f"{np.median(changes):.2f}")


# Quantities of cases outside the choice of the rule; quantities of runs include the judges of an error study.
STEADY = ["steady_speed", "steady_cost_of_transport", "steady_strouhal", "steady_efficiency"]
RUN = ["speed", "cost_of_transport", "lateral_drift", "mean_heading"]
HEAVE = ["mean_thrust", "mean_power", "efficiency", "shed_circulation"]
STILL = "wave: {amplitude: 0, frequency: 0}"
ONE = "[{name: fish}]"
OTHERS = "[sheet_points, shedding_interval, rtol, tolerance, lifetime]"


def coverage_cases():
    """Kind, quantities, varied keys, and text of each case; nodes with a sheet for all levels of the nodes."""

    def text(nodes, sheet, body, fish=ONE, end=4, more=""):
        return (f"format: 1\ntime: {{end: {end:g}, shedding_interval: 0.02, output_interval: 0.1}}\n{more}"
                f"defaults: {{fish: {{nodes: {nodes}, sheet_points: {sheet}, {body}}}}}\nfish: {fish}\n")

    for body in ("body: {profile: uniform, modulus: 1e6}", "body: {modulus: 1e7}", "wave: {frequency: 2}",
                 "wave: {amplitude: 1.5}, body: {modulus: 3e6}", "body: {tail_thickness: 0.1, modulus: 5e5}",
                 "wave: {frequency: 0.5}", "body: {profile: uniform, modulus: 1e8}"):
        yield "reactive fish", STEADY, "[nodes]", text(25, 69, f"force: reactive, {body}")
    for body in ("body: {profile: uniform, modulus: 1e6}", "body: {modulus: 1e7}", "body: {}",
                 "wave: {frequency: 2}, body: {depth: 0.5, modulus: 5e6}"):
        yield "fish with pressure", STEADY, "[nodes]", text(13, 97, f"force: pressure, pressure: {{span: infinite}}, {body}")
        yield "fish with pressure", STEADY, OTHERS, text(13, 33, f"force: pressure, pressure: {{span: infinite}}, {body}")
    stream = "fluid: {density: 1, velocity: [1, 0], viscosity: 0}\n"
    for heading, modulus in ((170, 2e5), (160, 4e5), (176, 8e5), (172, 1.5e5), (165, 6e5), (178, 1.2e5), (150, 1e6), (174, 3e5)):
        body = (f"force: pressure, pressure: {{span: infinite}}, start: {{heading: {heading}, speed: 0}}, {STILL}, motion: {{prescribed: head}}, "
                f"body: {{profile: uniform, thickness: 0.05, depth: 1, density: 25.465, modulus: {modulus:g}}}")
        yield "foil", ["steady_lift", "steady_deflection"], "[nodes]", text(13, 97, body, more=stream)
        yield "foil", ["steady_lift", "steady_deflection"], "[sheet_points]", text(13, 33, body, more=stream)
    body = (f"force: pressure, pressure: {{span: infinite}}, start: {{speed: 1}}, {STILL}, motion: {{prescribed: head, heave: 0.05, frequency: 0.5}}, "
            "body: {profile: uniform, thickness: 0.05, depth: 1, density: 25.465, modulus: 814873, relaxation_time: 0.001}")
    for nodes, sheet, keys in ((13, 97, "[nodes]"), (13, 33, OTHERS)):
        yield ("foil", ["steady_thrust", "steady_fluid_power"], keys,
               text(nodes, sheet, body, more="fluid: {density: 1, viscosity: 0}\n"))
    for heave, frequency in ((0.175, 1), (0.05, 2)):
        body = (f"force: pressure, pressure: {{span: infinite}}, start: {{speed: 1.25}}, {STILL}, body: {{profile: uniform, thickness: 0.12, depth: 1}}, "
                f"motion: {{prescribed: all, heave: {heave}, frequency: {frequency}}}")
        yield "foil", HEAVE, OTHERS, text(13, 33, body, end=3 / frequency, more="fluid: {density: 1, viscosity: 1.25e-3}\n")
    for place, phase, body in (("[0, 0.5]", 90, "body: {}"), ("[1.4, 0.2]", 0, "body: {modulus: 1e7}")):
        fish = ("[{name: right, start: {position: [0, 0], speed: 0.8}}, "
                f"{{name: left, start: {{position: {place}, speed: 0.8}}, wave: {{phase: {phase}}}}}]")
        yield "two fish", RUN, "[nodes]", text(25, 69, f"force: reactive, {body}", fish, 3)
        yield "two fish", RUN, OTHERS, text(25, 49, f"force: reactive, {body}", fish, 3)
    for force, nodes, sheet in (("force: reactive", 25, 49), ("force: pressure, pressure: {span: infinite}", 13, 33)):
        body = f"{force}, start: {{speed: 0.8}}, control: {{bias: 0.3}}"
        yield "turn", RUN, "[nodes]", text(nodes, 97, body, end=3)
        yield "turn", RUN, OTHERS, text(nodes, sheet, body, end=3)


def finer(key, finest):
    """Assignments of a level twice as fine as the finest one."""
    if key.startswith("fish."):
        return [f"fish[*].{key[5:]}={2 * round(finest) - 1}"]
    if key != "wake.lifetime":
        return [f"{key}={finest / (2 if key == 'time.shedding_interval' else 10):.17g}"]
    return [f"wake.lifetime={2 * finest:.17g} beats", f"wake.decay={1.5 * finest:.17g} beats"]


def coverage_of(bench, number, of, keys, text):
    """Bars and true errors, both over the value, and whether the levels are flagged: of each key, quantity and fish."""
    path = bench.case(text)
    plain = os.path.join(bench.folder, f"plain-{number}.yaml")
    shutil.copy(path, plain)
    path = bench.case(f"{text}error: {{of: [{', '.join(of)}], keys: {keys}}}\n")
    folder = os.path.join(bench.folder, f"coverage-{number}")
    bench.call("study", path, "-q", "-o", folder)
    study = open_study(os.path.join(folder, "study.nc"))
    for k, key in enumerate(strings(study["key_name"])):
        if study["key_levels"][k] < 2:
            continue
        true = true_values(bench, plain, of, finer(key, float(study["key_value"][k, 0])))
        base = int(study["key_member"][k, study["key_stated"][k]])
        # a study computes some quantities, which a result does not state
        for quantity, last in true.items():
            values, flags = study[quantity][base], study[f"key_flag_{quantity}"][k]
            for f, value in enumerate(np.atleast_1d(values)):
                yield (float(study[f"part_{quantity}"][k, f]) / abs(value), abs(float(last[f]) - value) / abs(value),
                       bytes(flags[f]).strip(b"\0 ") != b"")


def share(covered):
    """63 of 64 (98 %)"""
    return f"{sum(covered)} of {len(covered)} ({100 * sum(covered) / len(covered):.0f} %)" if covered else "none"


@table("cases", "inside", "not flagged", "bar over error, median", "error over bar, largest", "flagged", "median", "largest",
       "below 1e-4, not counted")
def error_coverage(bench):
    """how many true errors are within their bars, on cases that were not used to choose the rule (15 minutes)"""
    kinds = {}
    for number, (kind, *case) in enumerate(coverage_cases()):
        kinds.setdefault(kind, []).extend(coverage_of(bench, number, *case))
    kinds["all"] = [one for kind in kinds.values() for one in kind]
    for kind, found in kinds.items():
        counted = [one for one in found if max(one[:2]) > 1e-4]
        cells = []
        for is_flagged in (False, True):
            part = [one[:2] for one in counted if one[2] == is_flagged]
            ratios = [bar / error for bar, error in part if error > 0]
            cells += [share([error <= bar for bar, error in part]), f"{np.median(ratios):.1f}" if ratios else "",
                      f"{1 / min(ratios):.2f}" if ratios else ""]
        yield kind, share([error <= bar for bar, error, _ in counted]), *cells, len(found) - len(counted)


if __name__ == "__main__":
    main("doc/studies.md")

#!/usr/bin/python3
"""Measure the tables of doc/validation.md that compare pairs with publications.

How to call it: scripts/measure/tables.py.
"""

import csv
import os

import numpy as np
from tables import CASES, HERE, main, table

# Two rigid foils of tests/verify/data/school_navier_stokes.csv: chord 1, period 1, Re 1000.
FOILS = """\
format: 1
time: {{end: 6, shedding_interval: 0.01, output_interval: 1}}
fluid: {{density: 1, viscosity: 1.25e-3}}
{}
defaults:
  fish:
    nodes: 9
    force: pressure
    pressure: {{span: infinite}}
    start: {{speed: 1.25}}
    wave: {{amplitude: 0, frequency: 0}}
    body: {{profile: uniform, thickness: 0.08, depth: 1}}
    motion: {{prescribed: all, heave: 0.125, pitch: 10, pitch_phase: 90, pivot: 0.33333333, frequency: 1}}
fish:
  - {{name: first}}
{}"""

BRIEF = "wake: {lifetime: 3 beats, decay: 2.25 beats}"


def reference(name):
    """The rows of a table of tests/verify/data."""
    with open(os.path.join(HERE, "tests/verify/data", name), encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def power_and_thrust(bench, wake, second=""):
    """Coefficients of power and thrust of every foil, mean of the last two periods."""
    run = bench.run(FOILS.format(wake, second))
    return (np.mean(run["mean_power"][-2:], axis=0) / (0.5 * 1.25**3),
            np.mean(run["mean_thrust"][-2:], axis=0) / (0.5 * 1.25**2))


@table("foil 2", "phase", "CP ratio of foil 1: NS", "3 beats", "default", "CP ratio of foil 2: NS", "3 beats", "default",
       "change of CP of foil 2: NS", "3 beats", "default", "change of CT of foil 2: NS", "3 beats", "default")
def pairs_of_foils(bench):
    """two foils beside a Navier-Stokes solution, with a wake of 3 beats and the default one (a minute)"""
    wakes = (BRIEF, "")
    alone = [power_and_thrust(bench, wake) for wake in wakes]
    for row in reference("school_navier_stokes.csv"):
        distance, phase = float(row["distance"]), int(row["phase"])
        place = (1 + distance, 0) if row["place"] == "in line" else (0, distance)
        second = f"  - {{name: second, start: {{position: [{place[0]}, {place[1]}]}}, motion: {{phase: {phase}}}}}\n"
        of = [power_and_thrust(bench, wake, second) for wake in wakes]
        ratio = [[power[i] / single[0][0] for (power, _), single in zip(of, alone)] for i in (0, 1)]
        power = [of[k][0][1] - alone[k][0][0] for k in (0, 1)]
        thrust = [of[k][1][1] - alone[k][1][0] for k in (0, 1)]
        yield (f"{row['place']}, {distance:g}", phase, row["power1"], *(f"{value:.2f}" for value in ratio[0]),
               row["power2"], *(f"{value:.2f}" for value in ratio[1]),
               f"{0.610 * (float(row['power2']) - 1):+.2f}", *(f"{value:+.2f}" for value in power),
               f"{float(row['thrust2']):+.2f}", *(f"{value:+.2f}" for value in thrust))


@table("gap [L]", "NS: power ratio", "place [L]", "3 beats", "place [L]", "default", "place [L]")
def pairs_of_swimmers(bench):
    """a swimmer that follows another one beside a Navier-Stokes solution of its midlines (a minute)"""
    with open(os.path.join(CASES, "swimmer_navier_stokes.yaml"), encoding="utf-8") as file:
        text = file.read()
    head, fish = text.split("fish:\n  - name: swimmer\n")
    body = "".join(f"  {line}\n" for line in fish.rstrip("\n").split("\n"))
    begin = head.replace("end: 12", "end: 6")
    pair = (f"defaults:\n  fish:\n{body}fish:\n  - {{name: first, start: {{speed: 0.634}}}}\n"
            "  - {name: second, start: {position: [%g, 0], speed: 0.634}}\n")
    for row in reference("swimmers_navier_stokes.csv"):
        cells = []
        for wake in (BRIEF + "\n", ""):
            run = bench.run(begin + wake + pair % (1 + float(row["gap"])))
            n = int(round(1 / (run.time[-1] - run.time[-2])))
            behind = np.mean(run["x"][-n:, 1, 0] - run["x"][-n:, 0, 0], axis=0)
            power = run["mean_power"][-1]
            cells += [f"{power[1] / power[0]:.2f}", f"{behind[0]:.2f}, {abs(behind[1]):.2f}"]
        yield row["gap"], f"{row['power']} ({row['wake']})", f"{row['along']}, {row['beside']}", *cells


# Pairs of publications whose fish differ from ours: what carries over is a sign, a slope or a ratio.
DEFAULT_PAIR = """\
format: 1
time: {end: 4, shedding_interval: 0.02, output_interval: 0.1}
%s
defaults: {fish: {nodes: 17, start: {speed: 0.8}, control: {law: course}}}
fish: [{name: leader}, {name: follower, start: {position: [%g, 0.31]}, wave: {phase: %d}}]
"""

PITCHING = """\
format: 1
time: {end: 30, shedding_interval: 0.02, output_interval: 0.1}
fluid: {density: 1, viscosity: 1e-3}
%s
defaults:
  fish:
    nodes: 5
    force: pressure
    pressure: {span: infinite}
    start: {speed: 1}
    wave: {amplitude: 0, frequency: 0}
    body: {profile: uniform, thickness: 0.05, depth: 1, density: 20, modulus: 1e6}
    motion: {prescribed: all, surge: free, pitch: 15, frequency: 1}
fish:
  - {name: first}
"""


def slope_of_least_power(bench, wake):
    """Change of the phase at which a follower of the default fish needs the least power, degrees per wavelength U/f."""
    phases, places, least = np.arange(0, 360, 45), [], []
    for distance in (1.2, 1.4, 1.6, 1.8, 2.0):
        ratio = []
        for phase in phases:
            run = bench.run(DEFAULT_PAIR % (wake, distance, phase))
            n = int(round(1 / (run.time[-1] - run.time[-2])))
            places.append(np.mean(run["x"][-n:, 1, 0, 0] - run["x"][-n:, 0, 0, 0]))
            ratio.append(run["mean_power"][-1][1] / run["mean_power"][-1][0])
        least.append(np.angle(-np.mean(np.array(ratio) * np.exp(1j * np.radians(phases)))))
    places = np.mean(np.reshape(places, (-1, len(phases))), axis=1)
    return np.degrees(np.polyfit(places, np.unwrap(least), 1)[0]) * run["speed"][-1][0]


def best_efficiency(bench, wake):
    """Efficiency of a follower of the swimmer at Re 5000 one length behind over that alone, U^2.5/power for a drag of a
    laminar boundary layer: the best of six phases in line, and of those 0.2 and 0.4 lengths beside."""
    with open(os.path.join(CASES, "swimmer_navier_stokes.yaml"), encoding="utf-8") as file:
        head, fish = file.read().split("fish:\n  - name: swimmer\n")
    body = "".join(f"  {line}\n" for line in fish.rstrip("\n").split("\n"))
    text = (f"{head.replace('end: 12', 'end: 6').replace('rtol: 1e-6', 'rtol: 1e-4')}{wake}\ndefaults:\n  fish:\n{body}"
            "      control: {law: course}\nfish:\n  - {name: first, start: {speed: 0.634}}\n")

    def efficiency(more=""):
        run = bench.run(text + more)
        return run["speed"][-1][-1] ** 2.5 / run["mean_power"][-1][-1]

    alone = efficiency()
    best = [max(efficiency(f"  - {{name: second, start: {{position: [2, {beside}], speed: 0.634}}, wave: {{phase: {phase}}}}}\n")
                for phase in range(0, 360, 60)) / alone for beside in (0, 0.2, 0.4)]
    return best[0], max(best[1:])


def changes_of_cost(bench, wake):
    """Change of the cost of transport of pitching foils that swim freely, %, from that alone."""
    def costs(more=""):
        run = bench.run(PITCHING % wake + more)
        return run["mean_power"][-1] / run["speed"][-1]

    alone = costs()[0]
    for keys in ("position: [0, 0.6]}", "position: [0, 0.6]}, motion: {phase: 180}", "position: [1.8, 0]}",
                 "position: [1.8, 0]}, motion: {phase: 90}", "position: [1.5, 0.5]}"):
        both = costs(f"  - {{name: second, start: {{{keys}}}\n") / alone - 1
        yield 100 * (np.mean(both) if "[0, " in keys else both[1])


@table("publication", "pair", "there", "3 beats", "default")
def published_pairs(bench):
    """signs, slopes and ratios of three publications on pairs, which have other bodies (two minutes)"""
    def of_both(function):
        return zip(*(function(bench, wake) for wake in (BRIEF, "")))

    slopes = [slope_of_least_power(bench, wake) for wake in (BRIEF, "")]
    yield ("Li et al. (2020), robots", "phase of the follower's least power over its place, degrees a wavelength", "-360",
           *(f"{slope:.0f}" for slope in slopes))
    for pair, there, here in zip(("in line, one length apart", "offset"), ("1.16", "1.42"), of_both(best_efficiency)):
        yield ("Maertens et al. (2017), Navier-Stokes in two dimensions, Re 5000",
               f"efficiency of the follower over that alone, best phase, {pair}", there, *(f"{value:.2f}" for value in here))
    pairs = ("side by side, in phase: both", "side by side, in antiphase: both", "in line, in phase: follower",
             "in line, a quarter ahead: follower", "diagonal, in phase: follower")
    for pair, there, here in zip(pairs, ("less", "more", "less", "less", "less"), of_both(changes_of_cost)):
        yield ("Heydari et al. (2024), pitching foils, Re 1645", f"cost of transport, {pair}", there,
               *(f"{value:+.0f} %" for value in here))


if __name__ == "__main__":
    main("doc/validation.md")

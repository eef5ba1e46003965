#!/usr/bin/python3
"""Measure the tables and numbers of doc/model.md: control, depth, impacts, the impulse of legs.

How to call it: scripts/measure/tables.py.
"""

import math
import os

import netCDF4
import numpy as np
from tables import main, power, short, strings, table


def turn_of(path, begin):
    """Settling time [beats] of the course within 5 degrees, and overshoot [degrees], of a member with a turn to 90 degrees."""
    member = netCDF4.Dataset(path)
    time, place, beat = member["time"][:], member["com"][:, 0], 1 / float(member["frequency"][0])
    n = round(beat / (time[1] - time[0]))
    way = place[n:] - place[:-n]
    error, time = np.degrees(np.unwrap(np.arctan2(way[:, 1], way[:, 0]))) % 360 - 90, time[n:]
    return (time[np.abs(error) > 5].max() - begin) / beat, max(0, -error[time > begin].min())


@table("modulus [Pa]", "beats per s, amplitude", "gain 2, damping 1", "1, 1", "1.5, 1", "1.5, 1.5", "1.25, 0.75")
def step_response(bench):
    """settling time and overshoot of turns of 90 degrees (a quarter of an hour)"""
    folder, study = bench.study("step_response")
    for first in range(0, study["member"].size, 5):
        turns = [turn_of(os.path.join(folder, f"member-{first + i:04d}.nc"), 4.1) for i in range(5)]
        yield (power(study["fish_body_modulus"][first]),
               f"{study['fish_wave_frequency'][first]:g}, {study['fish_wave_amplitude'][first]:g}",
               *(f"{settling:.1f}, {overshoot:.0f}" for settling, overshoot in turns))


@table("modulus [Pa]", "work [J], 0.04 s", "0.02", "0.01", "0.005", "settling, most [beats]", "overshoot [degree]",
       "evaluations, 0.04 s", "0.02", "0.01", "0.005")
def feedback(bench):
    """course control over modulus and interval: work, a turn of 90 degrees, effort (a minute)"""
    folder, study = bench.study("feedback")
    for first in range(0, study["member"].size, 4):
        turns = [turn_of(os.path.join(folder, f"member-{first + i:04d}.nc"), 8.1) for i in range(4)]
        of = slice(first, first + 4)
        yield (power(study["fish_body_modulus"][first]), *(f"{work:.2f}" for work in study["actuation_work"][of, 0]),
               *(f"{max(values):.1f}" for values in zip(*turns)),
               *(int(count) for count in study["residual_evaluations"][of]))


@table("depth [L]", "force", "span", "speed [m/s]", "cost [m/s2]", "largest multiplier")
def depth(bench):
    """steady speed, cost and stability over the depth of a stiff body, three forces (a minute)"""
    _, study = bench.study("depth")
    names = strings(study["fish_force"]), strings(study["fish_pressure_span"])
    for i in range(study["member"].size):
        yield (f"{study['fish_body_depth'][i]:g}", names[0][i], "" if names[0][i] == "reactive" else names[1][i],
               f"{study['steady_speed'][i, 0]:.4f}", f"{study['steady_cost_of_transport'][i, 0]:.4f}",
               f"{math.exp(study['steady_growth'][i]):.3f}")


@table("speed [m/s]", "steps, most in 10 ms", "median after that", "closest [mm]", "balance over energy", "rtol 1e-6",
       "energy [J]", "of it stretching", "shortest body [L]", "shortest edge")
def impact(bench):
    """two fish that meet head on (seconds)"""
    for speed in (1, 5, 15):
        keys = ("time.end=0.2", f"fish[*].start.speed={speed}")
        run, finer = bench.run("head_on", *keys), bench.run("head_on", *keys, "solver.rtol=1e-6")
        energy = run["kinetic_energy"][0, 0]
        balances = [short(float(np.abs(one["energy_balance"]).max() / energy)) for one in (run, finer)]
        steps = np.diff(np.asarray(run["steps"]))
        most = int(np.argmax(steps))
        closest = float(run.data.closest_approach.split()[0])
        close_up = bench.run("head_on", *keys, "time.shedding_interval=0.001", "time.output_interval=0.001")
        edges = np.linalg.norm(np.diff(np.asarray(close_up["x"])[:, 0], axis=1), axis=2)
        stretching = float(np.max(close_up["stretching_energy"])) / energy
        yield (speed, int(steps[most]), f"{np.median(steps[most + 1:]):.0f}", f"{1000 * closest:.1f}" if closest > 0 else "< 0.05", *balances,
               f"{energy:.4g}", f"{stretching:.2f}", f"{edges.sum(axis=1).min():.2f}",
               f"{edges.min() * edges.shape[1]:.2f}")


# Swims for the table leg_impulse: a case or a text, and keys.
TWO = """\
format: 1
time: {{end: 12, shedding_interval: 0.02, output_interval: 0.1}}
defaults: {{fish: {{start: {{speed: 0.8}}, control: {{law: course}}}}}}
fish:
  - {{name: first}}
  - {{name: second, {}}}
"""

LEG_CASES = (
    ("one fish ([swim](../cases/swim.yaml))", "swim", ()),
    ("depth 0.1 L", "swim", ("fish[0].body.depth=0.1",)),
    ("depth 0.5 L", "swim", ("fish[0].body.depth=0.5",)),
    ("a pair in antiphase, 0.4 L apart", TWO.format("start: {position: [0, 0.4]}, wave: {phase: 180}"), ()),
    ("a leader, and a follower 1.5 L behind", TWO.format("start: {position: [1.5, 0.1]}"), ()),
)


@table("case", "drag [N s]", "`leg_impulse` [N s]", "over drag", "balance over drag")
def leg_impulse(bench):
    """momentum that the growing lengths of legs take in a beat, along the course"""
    for name, case, keys in LEG_CASES:
        run = bench.run(case, *keys)
        first = run.nearest(run.time[-1] - 1)
        ahead = run["com"][-1] - run["com"][first]
        ahead /= np.linalg.norm(ahead, axis=1)[:, None]
        drag, legs = (abs(float(np.sum((run[key][-1] - run[key][first]) * ahead))) for key in ("external_impulse", "leg_impulse"))
        balance = float(np.linalg.norm(run["momentum_balance"][-1] - run["momentum_balance"][first]))
        yield name, f"{drag:.3f}", f"{legs:.3f}", f"{legs / drag:.2f}", short(balance / drag)


if __name__ == "__main__":
    main("doc/model.md")

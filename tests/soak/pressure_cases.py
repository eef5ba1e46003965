#!/usr/bin/python3
"""pressure_cases.py PROGRAM [CASES [FIRST [BEATS]]]: fish with the force of the pressure in contact, then random legal
schools; with an argument the schools only. Each run must end well, with finite numbers and no circulation in total. Half an hour.

Swimmers: 60 schools of one to three fish with the default force and control of the course, of 1e6 to 1e10 Pa, .1 to .5
lengths deep, for four beats: the momentum balance is below 1 % of the impulse that the fluid exchanges with the fish, the
energy balance below 2 % of the work. Of 60 cases 52 are below .5 %, with solver.rtol 1e-6 59: one step per event is coarse for
the power of stiff bodies.

Contact: 60 schools side by side, 20 fish sent into a wall at 2 and 4 m/s, 20 pairs head on, all from soft to stiff, each
with infinite and with finite span.

Schools: CASES of them (500), numbers FIRST on, for BEATS beats (1.5): plates that are driven and fish that swim, 1 to 4 of
them in a school, side by side, some with the reactive force; from soft to stiff (EI/(rho U^2 L^3) of 0.05 to 1e6) and from
light to heavy (mass over rho L w of 0.01 to 10; those heavier than the fluid that they move are not limp)."""

import math
import random
import sys

import netCDF4
import numpy as np

from common import argument, finish, judge, shoal, write

n_cases, first, beats = argument(2, 500), argument(3, 1000), argument(4, 1.5)
MAX_CIRCULATION = 1e-10  # of all sheets and wakes, over length^2 times frequency


def bending_modulus(over_fluid, density, speed, length, thickness):
    """Young's modulus of an ellipse with EI/(rho U^2 L^3) per metre of depth."""
    return over_fluid * density * speed**2 * length**3 / (math.pi * (thickness * length) ** 3 / 64)


def draw_fish(draw, number, length, rate, density):
    """One fish as keys of a case file."""
    nodes = draw.choice([5, 9, 13, 17])
    points = draw.choice([2 * nodes - 1, 2 * nodes + 3, max(33, 2 * nodes - 1)])
    speed = length * rate
    thickness, mass = draw.uniform(0.02, 0.2), 10 ** draw.uniform(-2, 1)
    stiffness = 10 ** draw.uniform(math.log10(0.05), 6)
    force = draw.choice(["pressure", "pressure", "pressure", "reactive"])
    prescribed = draw.choice(["none", "none", "head", "all"])
    start = [draw.uniform(-0.2, 0.2) * length, number * 0.5 * length]
    heading, start_speed = draw.uniform(170, 190), draw.choice([0, 0.5, 1]) * speed
    profile, width = draw.choice(["joukowski", "uniform"]), draw.choice([0.2, 1])
    relaxation = draw.choice([0.001, 0.002, 0.01]) / rate
    if force == "reactive" or mass > math.pi / 4:
        # without pressure, or heavier than the fluid that it moves, a limp one folds over itself: its slowest mode, 3.6
        # sqrt(EI/(m L^4)) or, with a held head, 0.56 of that root, is not below its beat
        stiffness = max(stiffness, mass * (3.2 if prescribed == "head" else 0.08))
    modulus = bending_modulus(stiffness, density, speed, length, thickness)
    keys = [f"name: f{number}", f"length: {length}", f"nodes: {nodes}", f"sheet_points: {points}", f"force: {force}", "pressure: {span: infinite}",
            f"start: {{position: [{start[0]:.4f}, {start[1]:.4f}], heading: {heading:.3f}, speed: {start_speed}}}",
            f"body: {{profile: {profile}, thickness: {thickness:.4f}, depth: {width}, density: "
            f"{mass * density / (math.pi / 4 * thickness):.6g}, modulus: {modulus:.6g}, relaxation_time: {relaxation}}}"]
    if prescribed == "none":
        keys.append(f"wave: {{frequency: {rate}, amplitude: {draw.uniform(0.1, 0.6):.3f}, "
                    f"number: {draw.uniform(-8, -4):.3f}, ramp: {draw.choice([0.3, 1]) / rate}}}")
    else:
        keys += ["wave: {amplitude: 0, frequency: 0}",
                 f"motion: {{prescribed: {prescribed}, heave: {draw.uniform(0, 0.2) * length:.4f}, "
                 f"pitch: {draw.uniform(0, 20):.3f}, frequency: {rate}, speed: {draw.choice([0.3, 1]) * speed}}}"]
    if force == "pressure" and draw.random() < 0.3:
        keys.append("drag: {normal: 1}")
    return "  - " + "\n    ".join(keys) + "\n", force


def draw_case(number):
    """The text of a case, its length and its rate."""
    draw = random.Random(number)
    n_fish = draw.choice([1, 1, 1, 2, 3, 4])
    length, rate, density = draw.choice([0.3, 1, 1, 2]), draw.choice([0.5, 1, 1, 2]), draw.choice([1, 1000])
    fish = [draw_fish(draw, k, length, rate, density) for k in range(n_fish)]
    has_skin = any(force == "pressure" for _, force in fish)
    viscosity = f", viscosity: {1e-4 * length**2 * rate:.6g}" if has_skin else ""
    interval = draw.choice([0.01, 0.02]) / rate
    text = (f"format: 1\ntime: {{end: {beats / rate}, shedding_interval: {interval}, "
            f"output_interval: {0.1 / rate}}}\nfluid: {{density: {density}{viscosity}}}\n"
            + ("" if has_skin else "wake: {shedding: sheet}\n") + "fish:\n" + "".join(text for text, _ in fish))
    return text, length, rate


def draw_dense_school(draw):
    """Two to six fish 0.3 lengths apart that swim, in open water or in a channel."""
    n_fish = draw.choice([2, 2, 3, 4, 6])
    walls = draw.choice(["", "", "", f", walls: [-0.45, {0.5 * n_fish + 0.2:.2f}]"])
    nodes, fish = draw.choice([9, 13, 17, 17]), []
    for k in range(n_fish):
        heading = draw.uniform(160, 200) if walls or draw.random() < 0.8 else draw.uniform(0, 360)
        fish.append(f"  - {{start: {{position: [{draw.uniform(-0.4, 0.4):.4f}, {0.3 * k + draw.uniform(-0.08, 0.08):.4f}], "
                    f"heading: {heading:.2f}, speed: {draw.choice([0, 0.5, 1, 2])}}},\n"
                    f"     wave: {{phase: {draw.uniform(0, 360):.1f}, amplitude: {draw.uniform(0.2, 0.5):.3f}, "
                    f"ramp: {draw.choice([0.3, 1])}}}, body: {{modulus: {10 ** draw.uniform(5, 7.5):.4g}}}}}\n")
    return (f"time: {{end: 2, shedding_interval: {draw.choice([0.01, 0.02])}, output_interval: 0.1}}\n"
            f"fluid: {{viscosity: {draw.choice([1e-6, 1e-4])}{walls}}}\n"
            f"defaults: {{fish: {{nodes: {nodes}, force: pressure, pressure: {{span: infinite}}}}}}\nfish:\n" + "".join(fish))


def draw_wall(draw):
    """A fish that is sent into a wall."""
    return (f"time: {{end: 1.2, shedding_interval: {draw.choice([0.01, 0.02])}, output_interval: 0.1}}\n"
            f"fluid: {{walls: [{-draw.uniform(0.3, 0.8):.4f}]}}\n"
            f"fish: [{{force: pressure, pressure: {{span: infinite}}, nodes: {draw.choice([9, 13, 17, 25])}, "
            f"body: {{modulus: {10 ** draw.uniform(5.5, 7):.4g}}},\n"
            f"        start: {{heading: {180 + draw.uniform(10, 90):.2f}, speed: {draw.choice([2, 4])}}}, "
            f"wave: {{phase: {draw.uniform(0, 360):.1f}}}}}]\n")


def draw_head_on(draw):
    """Two fish nose to nose; some beat, some are as long as each other."""
    speed = draw.choice([0.5, 1, 2, 4])
    return (f"time: {{end: 1, shedding_interval: {draw.choice([0.005, 0.01, 0.02])}, output_interval: 0.1}}\n"
            f"defaults: {{fish: {{force: pressure, pressure: {{span: infinite}}, nodes: {draw.choice([9, 9, 13, 17, 25])}, "
            f"body: {{modulus: {10 ** draw.uniform(5.5, 7.5):.4g}}}, wave: {{amplitude: {draw.choice([0, 0, 0.4])}}}}}}}\n"
            f"fish: [{{start: {{position: [-0.15, {draw.uniform(-0.03, 0.03):.4f}], heading: 0, speed: {speed}}}}},\n"
            f"       {{start: {{position: [0.15, 0], heading: {180 + draw.uniform(-15, 15):.2f}, "
            f"speed: {draw.choice([0, speed])}}}, length: {draw.choice([1, 0.7])}}}]\n")


def draw_swimmers(draw):
    """One to three fish half a length apart, from rest or at speed."""
    rate, fish = draw.choice([0.5, 1, 1, 2]), []
    for k in range(draw.choice([1, 1, 2, 3])):
        start = f"position: [{draw.uniform(-0.3, 0.3):.4f}, {0.5 * k:.4f}], heading: {draw.uniform(170, 190):.2f}"
        fish.append(f"  - {{start: {{{start}, speed: {draw.choice([0, 0.8]) * rate}}}, control: {{law: course}},\n"
                    f"     wave: {{frequency: {rate}, amplitude: {draw.uniform(0.2, 0.5):.3f}, phase: {draw.uniform(0, 360):.1f}}},\n"
                    f"     body: {{depth: {draw.uniform(0.1, 0.5):.3f}, thickness: {draw.uniform(0.08, 0.2):.3f}, "
                    f"modulus: {rate**2 * 10 ** draw.uniform(6, 10):.4g}}}}}\n")
    return f"time: {{end: {4 / rate}, shedding_interval: {0.01 / rate}, output_interval: {0.1 / rate}}}\nfish:\n" + "".join(fish)


def cases():
    """The number of each case, its text, its length and its rate."""
    contact = ((draw_dense_school, 60), (draw_wall, 20), (draw_head_on, 20)) if len(sys.argv) == 2 else ()
    for drawn, count in contact:
        number = 0
        while count > 0:
            text = "format: 1\n" + drawn(random.Random(number))
            write("case.yaml", text)
            if "overlap at the start" not in shoal("check", "case.yaml").stderr:
                count -= 1
                for span in ("infinite", "finite"):
                    chosen = text.replace("span: infinite", f"span: {span}")
                    yield f"{number} of {drawn.__name__[5:]}, {span}", chosen, 1, 1
            number += 1
    for number in range(60 if contact else 0):
        yield f"{number} of swimmers", "format: 1\n" + draw_swimmers(random.Random(number)), 1, 1
    for number in range(first, first + n_cases):
        yield (number, *draw_case(number))


def fault_of(path, length, rate):
    """What is wrong with a result, or nothing; and its steps, iterations and Jacobians per event."""
    with netCDF4.Dataset(path) as data:
        data.set_auto_mask(False)
        events = round(float(data["time"][-1]) / float(data["shedding_interval"][...]))
        counts = [data[name][-1] / events for name in ("steps", "newton_iterations", "jacobian_evaluations")]
        for name in ("com", "kinetic_energy", "shed_circulation", "energy_balance"):
            if not np.isfinite(data[name][...]).all():
                return f"{name} is not finite", counts
        if "law: course" in data.case_text:
            work = np.abs(data["actuation_work"][-1]).sum()
            energy = np.abs(data["energy_balance"][-1]).max() / work
            impulse = np.abs(data["fluid_impulse"][...] - data["fluid_impulse"][0]).sum(axis=(1, 2)).max()
            momentum = np.abs(data["momentum_balance"][...]).max() / impulse
            print(f"energy {energy:.1e} of the work, momentum {momentum:.1e} of the exchange")
            if energy > 2e-2 or momentum > 1e-2:
                return "a balance is open", counts
        circulation = np.abs(data["total_circulation"][...]).max() / (length**2 * rate)
    return f"a total circulation of {circulation:.1e}" if circulation > MAX_CIRCULATION else None, counts


most = np.zeros(3)
for number, text, length, rate in cases():
    write("case.yaml", text)
    done = shoal("run", "case.yaml", "-q", "--force", "-o", "case.nc")
    fault, used = (done.stderr, [0, 0, 0]) if done.returncode else fault_of("case.nc", length, rate)
    most = np.maximum(most, used)
    judge(f"case {number}", fault and f"{fault}\n{text}")
print("most of one case: %.1f steps, %.1f Newton iterations, %.2f Jacobians an event" % tuple(most))
finish()

#!/usr/bin/python3
"""Draw the figures of README.md and doc/*.md that are older than their inputs, and write doc/gallery.md.

    scripts/figures.py [NAME...]     draw those of all figures, or of these, that are older than their inputs
    scripts/figures.py --list        say which figures are older than which of their inputs, and what they cost
    scripts/figures.py --all         draw all
    scripts/figures.py --page        print doc/gallery.md

The commands of one row of a table below make a figure. Its inputs are the *case* (the commands, and every key of the case
with its value), the *script* that draws, and the *results* of the program (tests/data/results.tsv, to three digits).
doc/figures/inputs.tsv has a checksum of each, and the CPU seconds of the commands. Result files are kept in a folder (--data,
by default build/figures) as long as case and results stay the same. Pictures have few colours; those of the gallery have at
most 60 kB, a moving one at most 3 MB.

The exit code is 0, or 1 if with --list a figure is older than its inputs.
"""

import argparse
import ast
import csv
import hashlib
import os
import re
import resource
import shlex
import shutil
import subprocess
import sys

HERE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PROGRAM = os.path.join(HERE, "build", "shoal")
FOLDER = os.path.join(HERE, "doc", "figures")
GALLERY_BYTES, MOVING_BYTES = 60_000, 3_000_000
INPUTS = ["case", "script", "results"]

# Cases that the gallery writes itself.
CASES = {
    "gaits.yaml": """\
format: 1
time: {end: 2, shedding_interval: 0.02, output_interval: 0.04}
fluid: {density: 0}
defaults: {fish: {force: reactive, nodes: 13, sheet_points: 13}}
fish:
  - {name: default}
  - {name: half a wave, start: {position: [0, 1]}, wave: {number: -3.1}}
  - {name: two waves, start: {position: [0, 2]}, wave: {number: -12.6}}
  - {name: bias 0.5, start: {position: [0, 3]}, control: {bias: 0.5}}
  - {name: bias -0.5, start: {position: [0, 4]}, control: {bias: -0.5}}
  - {name: amplitude 0.2, start: {position: [0, 5]}, wave: {amplitude: 0.2}}
  - {name: tail only, start: {position: [0, 6]}, wave: {constant: 0, linear: 0, quadratic: 1}}
  - {name: whole body, start: {position: [0, 7]}, wave: {constant: 1, linear: 0, quadratic: 0}}
""",
    "levels.yaml": """\
format: 1
time: {end: 1, shedding_interval: 0.04, output_interval: 0.2}
solver: {method: trapezoid, step: 0.02}
fish: [{nodes: 7, sheet_points: 21, force: reactive}]
sweep: [{key: solver.step, values: [0.02, 0.01, 0.005, 0.0025, 0.00125], refine: true}]
""",
    "bars.yaml": """\
format: 1
time: {end: 3, shedding_interval: 0.02, output_interval: 0.2}
fish: [{nodes: 9, start: {speed: 0.8}}]
sweep:
  - {key: "fish[*].wave.amplitude", values: [0.15, 0.2, 0.25, 0.3]}
  - {key: time.shedding_interval, values: [0.1, 0.05, 0.025, 0.0125], refine: true}
""",
    "fine.yaml": """\
format: 1
time: {end: 4, shedding_interval: 0.02, output_interval: 0.1}
fish: [{force: reactive, nodes: 9, sheet_points: 17, start: {speed: 0.8}}]
sweep:
  - {key: "fish[*].wave.amplitude", values: [0.14, 0.18, 0.22, 0.26, 0.3, 0.34, 0.38]}
  - {key: "fish[*].wave.frequency", values: [0.8, 1, 1.2, 1.4, 1.6, 1.8]}
""",
}

# Chapters: a heading, a sentence, and figures: name, a sentence, commands of which the last one draws it.
PAIR = "shoal run cases/pair.yaml -q -o pair.nc --set time.end=8 --set time.output_interval=0.04"
CROWD = "shoal run cases/crowd.yaml -q -o crowd.nc"
CHAPTERS = [
    ("A run", "`plot.py KIND RUN.nc PICTURE` draws the file of a run. Without a kind it draws `swim`.", [
        ("swim", "Bodies, vortices (red counter-clockwise, blue clockwise) and paths, one panel per time.",
         [PAIR, "plot.py swim pair.nc --times 2 8 -- swim.png"]),
        ("swim_follow", "A window that moves with a school, in body lengths.",
         ["shoal run cases/turn.yaml -q -o turn.nc", "plot.py swim turn.nc --follow --times 3 4 5 7 -- swim_follow.png"]),
        ("swim_many", "A dense school.", [CROWD, "plot.py swim crowd.nc --limits -1 7 -0.5 4 -- swim_many.png"]),
        ("gait", "The natural shapes over a beat, in a grid of fish.",
         ["shoal run gaits.yaml -q -o gaits.nc", "plot.py gait gaits.nc gait.png"]),
        ("time", "Speed, heading, power and thrust over time.", [PAIR, "plot.py time pair.nc time.png"]),
        ("time_one", "The forces of one fish, and with `--balance` the energy balance.",
         [PAIR, "plot.py time pair.nc --fish upper --beats 4 --balance -- time_one.png"]),
        ("time_many", "The median, the quartiles and the range of more than six fish.",
         [CROWD, "plot.py time crowd.nc time_many.png"]),
        ("time_each", "One variable, a panel per fish.",
         ["shoal run cases/diamond.yaml -q -o diamond.nc --set time.end=6", "plot.py time diamond.nc --each heading -- time_each.png"]),
        ("forces", "Forces and powers by name over the last beats, a column per fish.",
         [PAIR, "plot.py forces pair.nc --beats 2 -- forces.png"]),
        ("pressure", "The jump of the pressure along the body over a beat (`force: pressure`).",
         ["shoal run cases/fish_pressure.yaml -q -o fish_pressure.nc", "plot.py pressure fish_pressure.nc pressure.png"]),
        ("school", "Polarisation, distances and contacts; a panel without content is left out.",
         [CROWD, "plot.py school crowd.nc school.png"]),
        ("modes", "The Floquet multipliers of a steady state, with their errors, and the fish that move in the mode of the largest.",
         ["shoal steady cases/tandem_plates.yaml -q -o tandem.nc", "plot.py modes tandem.nc modes.png"]),
    ]),
    ("A field", "`shoal field` computes the flow on a grid.", [
        ("field", "Vorticity.", [PAIR, "shoal field pair.nc --grid 240,120 -q -o field.nc", "plot.py field field.nc field.png"]),
        ("field_speed", "The speed of the fluid, with streamlines.",
         [PAIR, "shoal field pair.nc --grid 240,120 -q -o field.nc", "plot.py field field.nc --speed --streamlines -- field_speed.png"]),
    ]),
    ("A study", "`plot.py study STUDY.nc PICTURE` chooses the figure by the axes of the study ([studies.md](studies.md)).", [
        ("curves", "Any axis: speed, cost of transport and Strouhal number, a line per fish and value of the other axes.",
         ["shoal study cases/studies/phase.yaml -q -o phase", "plot.py study phase/study.nc curves.png"]),
        ("held", "Held bodies: thrust, power and efficiency.",
         ["shoal study cases/studies/foil_stiffness.yaml -q -o foil", "plot.py study foil/study.nc held.png"]),
        ("equilibrium", "Equilibria in a stream: drag, lift and deflection.",
         ["shoal study cases/studies/reconfiguration.yaml -q -o strips", "plot.py study strips/study.nc equilibrium.png"]),
        ("map", "Places, or two axes of numbers: cells with the values of the members.",
         ["shoal study cases/studies/school_spacing.yaml -q -o spacing",
          "plot.py study spacing/study.nc --of cost_of_transport -- map.png"]),
        ("contours", "Contours where both axes have six values or more.",
         ["shoal study fine.yaml -q -o fine", "plot.py study fine/study.nc contours.png"]),
        ("refine", "A refined axis: Richardson's error of each level, the accepted orders, and a triangle of the design order.",
         ["shoal study levels.yaml -q -o levels", "plot.py study levels/study.nc refine.png"]),
        ("bars", "A refined axis and another axis: values with their error bars, and the errors in per cent.",
         ["shoal study bars.yaml -q -o bars", "plot.py study bars/study.nc bars.png"]),
        ("budget", "The errors of a case: the value with its error and with `--models` the range of other models, the part of each "
         "key, and the levels of each key.",
         ["shoal error cases/foil_static.yaml --of steady_lift --models -q -o budget", "plot.py study budget/study.nc budget.png"]),
        ("matter", "Sensitivities: the change of a result in per cent for one per cent of each number of the case.",
         ["shoal error cases/foil_static.yaml --of steady_lift --sensitivity -q -o matter", "plot.py study matter/study.nc matter.png"]),
        ("best_gait", "The history of `shoal.optimize`: the gait and the stiffness of least cost at a given speed ([python.md](python.md)).",
         ["doc/examples/best_gait.py --figure best_gait.png"]),
        ("methods", "Integration methods as an axis of a comparison: error over cost.",
         ["shoal study cases/studies/methods.yaml -q -o methods", "plot.py study methods/study.nc methods.png"]),
    ]),
]

# Figures of README.md and the other documents: name, commands of which the last one draws it.
STUDY = "cases/studies/"
FIGURES = {
    **{f"model_{name}": [f"scripts/drawings.py {name} model_{name}.png"] for name in ("rod", "curvature", "outline", "sheet", "ring")},
    # the figure that README.md begins with: a picture for each row
    "moving": ["shoal run cases/article/figure8.yaml -q -o moving.nc --set time.end=7 --set time.output_interval=0.05 "
               "--set output.wake_interval=0.05", "scripts/animate.py moving.nc moving.gif --no-axes --follow --fps 20 --dpi 100"],
    "demo": ["shoal run cases/demo.yaml -q -o demo.nc", "plot.py swim demo.nc demo.png"],
    # the case in README.md
    "case": ["shoal run case.yaml -q -o case.nc", "plot.py swim case.nc --follow -- case.png"],
    "figure5": ["shoal run cases/article/figure5.yaml -q -o figure5.nc", "plot.py gait figure5.nc figure5.png --shapes 20"],
    **{name: [f"shoal run cases/article/{name}.yaml -q -o {name}.nc", f"plot.py swim {name}.nc --no-follow --times {times} -- {name}.png"]
       for name, times in (("figure6_free", "2 10 20"), ("figure6_turn", "2 5 10 20"), ("figure7_free", "2 10 20"),
                           ("figure7_control", "2 10 20"), ("figure8", "2 10 25"))},
    "school": ["shoal run cases/school.yaml -q -o school.nc", "plot.py swim school.nc --times 2 10 30 -- school.png"],
    "crowd": [CROWD, "plot.py swim crowd.nc --times 3 -- crowd.png"],
    "crowd_distances": [CROWD, "plot.py school crowd.nc crowd_distances.png"],
    **{f"steady_{axis}": [f"shoal study {STUDY}steady_{axis}.yaml -q -o {axis}", f"plot.py study {axis}/study.nc steady_{axis}.png"]
       for axis in ("frequency", "amplitude", "thrust")},
    "steady_resonance": [f"shoal study {STUDY}steady_resonance.yaml -q -o resonance",
                         f"plot.py study resonance/study.nc --reference {STUDY}steady_resonance.csv -- steady_resonance.png"],
    "branch": ["shoal steady cases/tandem_plates.yaml --continue fish[1].motion.heave=0.15:0.05 -q -o branch",
               "plot.py study branch/study.nc branch.png"],
    "depth": [f"shoal study {STUDY}depth.yaml -q -o depth", "plot.py study depth/study.nc depth.png"],
    # one run at a time: its axis is time
    "stiffness": [f"shoal study {STUDY}stiffness.yaml -q -j 1 -o stiffness", "plot.py study stiffness/study.nc stiffness.png"],
    "follower_map": [f"shoal study {STUDY}follower_map.yaml -q -o follower_map",
                     *(f"shoal steady {STUDY}follower_map.yaml -q --set sweep=[] --set fish[1].start.position=[{place}] -o {name}.nc"
                       for name, place in (("aside", "0.93,0.3"), ("near", "1.5,0"), ("far", "2.1,0"))),
                     "plot.py study follower_map/study.nc --of cost_of_transport --relative --states aside.nc near.nc far.nc "
                     "-- follower_map.png"],
    "validation": ["scripts/validation.py validation.png"],
    "real_time": ["scripts/measure/performance.py --picture real_time.png"],
    "keep_together": ["doc/examples/keep_together.py --figure keep_together.png"],
    "hold_place": ["doc/examples/hold_place.py --figure hold_place.png"],
    "school_stability": ["doc/examples/school_stability.py --table cases/studies/school_stability.csv --figure school_stability.png"],
    "estimate": ["doc/examples/estimate.py --figure estimate.png"],
}
# paths in doc/figures without their ending
TABLE = {**FIGURES, **{f"gallery/{name}": commands for _, _, some in CHAPTERS for name, _, commands in some}}


def command_line(command):
    """A command as a reader types it in the top folder."""
    return command.replace("plot.py", "scripts/plot.py", 1).replace("shoal ", "build/shoal ", 1)


def file_of(name):
    """The path of a figure in doc/figures."""
    return name + (".gif" if f"{os.path.basename(name)}.gif" in TABLE[name][-1].split() else ".png")


def checksum(text):
    return hashlib.sha256(text.encode()).hexdigest()[:12]


def read(*path):
    with open(os.path.join(HERE, *path), encoding="utf-8") as file:
        return file.read()


def script_of(command):
    """The syntax trees of the scripts that a command runs, without comments."""
    words = command.split()
    if words[0] != "plot.py":
        return ast.dump(ast.parse(read(words[0])))
    own = {"study": ["_plot_study.py"], "field": ["_plot_field.py"], "school": ["_plot_school.py", "plot.py"], "modes": ["_plot_modes.py"]}.get(words[1], ["plot.py", "_draw.py"])
    return "".join(ast.dump(ast.parse(read("scripts", "shoal", name))) for name in [*own, "_plot_style.py", "_files.py"])


def results():
    """The frozen results of the program, to three digits."""
    rows = [line.split() for line in read("tests", "data", "results.tsv").splitlines() if not line.startswith("#")]
    return "".join(f"{group} {name} {float(value):.2e}\n" for group, name, value, _ in rows)


def call(command, folder, may_fail=False):
    """Run a command in the folder; exit codes 1 and 3 of a study with failed members or missed expectations are no error.
    Returns its CPU seconds; None after a permitted failure."""
    words = shlex.split(command)
    is_program = words[0] == "shoal"
    words[0] = PROGRAM if is_program else os.path.join(HERE, "scripts" if words[0] == "plot.py" else "", words[0])
    print(command, file=sys.stderr, flush=True)
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run(words if is_program else [sys.executable, *words], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode not in ((0, 1, 3) if words[1] in ("study", "error") else (0,)):
        if may_fail:
            return None
        sys.exit(f"figures.py: {command} failed:\n{done.stderr}")
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def case_of(command, folder):
    """Every key of the case of a command with its value."""
    words = shlex.split(command)
    cases = [word for word in words if word.endswith(".yaml")]
    if words[0] != "shoal" or not cases:
        return ""
    sets = [part for flag, value in zip(words, words[1:]) if flag == "--set" for part in (flag, value)]
    done = subprocess.run([PROGRAM, "show", cases[0], *sets], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"figures.py: shoal show {cases[0]} failed:\n{done.stderr}")
    return done.stdout


def inputs_of(name, folder):
    """Checksums of the inputs of a figure."""
    commands = TABLE[name]
    case = "".join(command + case_of(command, folder) for command in commands)
    return {"case": checksum(case), "script": checksum(script_of(commands[-1])), "results": checksum(results())}


def recorded():
    """The rows of doc/figures/inputs.tsv by figure."""
    try:
        with open(os.path.join(FOLDER, "inputs.tsv"), encoding="utf-8", newline="") as file:
            return {row["figure"]: row for row in csv.DictReader(file, delimiter="\t")}
    except FileNotFoundError:
        return {}


def record(name, row):
    """Write the row of a figure into doc/figures/inputs.tsv."""
    rows = {**recorded(), name: {"figure": name, **row}}
    with open(os.path.join(FOLDER, "inputs.tsv"), "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, ["figure", *INPUTS, "seconds"], delimiter="\t", lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows[figure] for figure in TABLE if figure in rows)


def shrink(source, target, is_gallery):
    """Write a picture in few colours; refuse a picture of the gallery that is too large."""
    from PIL import Image

    with Image.open(source) as image:
        for width, colours in ((1000, 96), (900, 64), (800, 64), (720, 64), (640, 48), (560, 48)) if is_gallery else ((image.width, 64),):
            small = image.convert("RGB").resize((width, round(width * image.height / image.width)), Image.Resampling.LANCZOS)
            small.quantize(colours, kmeans=2, dither=Image.Dither.NONE).save(target, optimize=True)
            if not is_gallery or os.path.getsize(target) <= GALLERY_BYTES:
                return
    sys.exit(f"figures.py: {target} has {os.path.getsize(target)} bytes, more than {GALLERY_BYTES}")


def draw(name, folder):
    """Make the results of a figure that are missing or older than their case, and draw it. Returns the CPU seconds of its
    commands, with those of results that were there already."""
    *commands, last = TABLE[name]
    made, seconds, kept = results(), 0.0, []
    for command in commands:
        made += command + case_of(command, folder)
        target = os.path.join(folder, re.search(r"-o (\S+)", command)[1])
        stamp = os.path.join(folder, f"{os.path.basename(target)}.made")
        was = open(stamp, encoding="utf-8").read().split() if os.path.exists(stamp) else [""]
        if was[0] != checksum(made) or not os.path.exists(target):
            was = [checksum(made), f"{call(command + ' --force', folder):.1f}"]
            with open(stamp, "w", encoding="utf-8") as file:
                file.write(" ".join(was))
        else:
            kept.append(stamp)
        seconds += float(was[1])
    drawing = call(last, folder, may_fail=bool(kept))
    if drawing is None:  # the format of the kept results may be another one
        for stamp in kept:
            os.remove(stamp)
        return draw(name, folder)
    source, target = os.path.join(folder, os.path.basename(file_of(name))), os.path.join(FOLDER, file_of(name))
    if target.endswith(".gif"):
        if os.path.getsize(source) > MOVING_BYTES:
            sys.exit(f"figures.py: {source} has {os.path.getsize(source)} bytes, more than {MOVING_BYTES}")
        shutil.copyfile(source, target)
    else:
        shrink(source, target, name.startswith("gallery/"))
    return seconds + drawing


def page():
    """The text of doc/gallery.md."""
    lines = [
        "# Figures", "",
        "This page shows every kind of figure together with the commands that draw it. Run them in this order in the top folder,",
        "after `make`. If the name of a picture ends in .pdf or .svg, the figure is made for print. `plot.py KIND --help` lists the",
        "options of a kind, and in Python `shoal.plot` has the same figures as functions ([python.md](python.md)). `make figures`",
        "draws the figures of all documents and writes this page.", "",
    ]
    shown = set()
    for heading, words, figures in CHAPTERS:
        lines += [f"## {heading}", "", words, ""]
        for name, sentence, commands in figures:
            lines += [f"### {name.replace('_', ' ')}", "", sentence, ""]
            written = [case for case in CASES if any(case in command for command in commands)]
            for case in written:
                lines += [f"`{case}`:", "", "```yaml", CASES[case].rstrip("\n"), "```", ""]
            new = [command for command in map(command_line, commands) if command not in shown]
            shown.update(new)
            lines += ["```sh", *new, "```", "", f"![{name}](figures/gallery/{name}.png)", ""]
    lines += [
        "## Movies and pages", "",
        "`scripts/animate.py RUN.nc MOVIE.mp4` makes a movie in real time with 25 pictures a second, which are interpolated where",
        "the rows of the file are further apart. The camera follows a school that swims far (`--follow`, `--no-follow`), and",
        "`--rate 0.5` gives slow motion.", "",
        "`build/shoal view RUN.nc` writes a page for the browser that plays the motion of bodies and wakes. Bodies are coloured by",
        "speed, heading or power, and traces show quantities over time, for many fish as median, quartiles and range.",
    ]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="figures, such as demo or gallery/swim (all)")
    parser.add_argument("--list", action="store_true", help="draw nothing")
    parser.add_argument("--all", action="store_true", help="also figures that are not older than their inputs")
    parser.add_argument("--page", action="store_true", help="print the page, draw nothing")
    parser.add_argument("--data", default=os.path.join(HERE, "build", "figures"), metavar="FOLDER", help="where results are kept")
    options = parser.parse_args()
    if options.page:
        print(page(), end="")
        return 0
    unknown = [name for name in options.names if name not in TABLE]
    if unknown:
        parser.error(f"there is no figure {unknown[0]}: {', '.join(TABLE)}")

    # the folder of the results, with the cases of the gallery
    os.makedirs(options.data, exist_ok=True)
    if not os.path.exists(os.path.join(options.data, "cases")):
        os.symlink(os.path.join(HERE, "cases"), os.path.join(options.data, "cases"))
    cases = {**CASES, "case.yaml": re.search(r"```yaml\n(.*?)```", read("README.md"), re.S)[1]}
    for name, text in cases.items():
        with open(os.path.join(options.data, name), "w", encoding="utf-8") as file:
            file.write(text)

    n_older, rows = 0, recorded()
    for name in options.names or TABLE:
        inputs, row = inputs_of(name, options.data), rows.get(name)
        older = [key for key in INPUTS if not row or row[key] != inputs[key]]
        if older:
            n_older += 1
            print(f"{name}: older than {', '.join(older)}; {row['seconds'] + ' s of CPU time' if row else 'cost unknown'}", flush=True)
        if not options.list and (older or options.all):
            record(name, {**inputs, "seconds": f"{draw(name, options.data):.0f}"})
    if not options.list:
        with open(os.path.join(HERE, "doc", "gallery.md"), "w", encoding="utf-8") as file:
            file.write(page())
    return 1 if options.list and n_older else 0


if __name__ == "__main__":
    sys.exit(main())

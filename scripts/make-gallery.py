#!/usr/bin/python3
"""Draw every kind of figure by the commands of the gallery, and write doc/gallery.md with them.

    scripts/make-gallery.py [--data FOLDER] [NAME...]

Runs build/shoal and the scripts in FOLDER (build/gallery), in which results are kept: a figure whose results are there is
only drawn again. NAME: only these figures are drawn, by default all; the page is always written whole. The pictures go to
doc/figures/gallery, in few colours so that each is below 60 kB.
"""

import argparse
import os
import re
import subprocess
import sys

HERE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PROGRAM = os.path.join(HERE, "build", "shoal")
PICTURES = os.path.join("doc", "figures", "gallery")
MOST_BYTES = 60_000

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
  - {name: amplitude 0.4, start: {position: [0, 5]}, wave: {amplitude: 0.4}}
  - {name: tail only, start: {position: [0, 6]}, wave: {constant: 0, linear: 0, quadratic: 1}}
  - {name: whole body, start: {position: [0, 7]}, wave: {constant: 1, linear: 0, quadratic: 0}}
""",
    "levels.yaml": """\
format: 1
time: {end: 1.6, shedding_interval: 0.02, output_interval: 0.2}
solver: {rtol: 1e-8}
fish: [{nodes: 7, sheet_points: 65, force: pressure, pressure: {span: infinite}, start: {speed: 1}}]
sweep: [{key: time.shedding_interval, values: [0.04, 0.02, 0.01], refine: true}]
""",
    "bars.yaml": """\
format: 1
time: {end: 3, shedding_interval: 0.02, output_interval: 0.2}
fish: [{nodes: 9, start: {speed: 0.8}}]
sweep:
  - {key: "fish[*].wave.amplitude", values: [0.15, 0.2, 0.25, 0.3]}
  - {key: time.shedding_interval, values: [0.04, 0.02, 0.01], refine: true}
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
PAIR = "shoal run CASES/pair.yaml -q -o pair.nc --set time.end=8 --set time.output_interval=0.04"
CROWD = "shoal run CASES/crowd.yaml -q -o crowd.nc"
CHAPTERS = [
    ("A run", "`plot.py KIND RUN.nc PICTURE` draws the file of a run. Without a kind it draws `swim`.", [
        ("swim", "Bodies, vortices (red counter-clockwise, blue clockwise) and paths, one panel per time.",
         [PAIR, "plot.py swim pair.nc --times 2 8 -- swim.png"]),
        ("swim_follow", "A window that moves with the school, in body lengths, where the fish would be tiny otherwise.",
         ["shoal run CASES/turn.yaml -q -o turn.nc", "plot.py swim turn.nc --follow --times 3 4 5 7 -- swim_follow.png"]),
        ("swim_many", "A dense school.", [CROWD, "plot.py swim crowd.nc --limits -1 7 -0.5 4 -- swim_many.png"]),
        ("gait", "The shapes that the muscle asks for over a beat, a grid of fish.",
         ["shoal run gaits.yaml -q -o gaits.nc", "plot.py gait gaits.nc gait.png"]),
        ("time", "Speed, heading, power and thrust over time.", [PAIR, "plot.py time pair.nc time.png"]),
        ("time_one", "Of one fish the forces, and with `--balance` the energy balance.",
         [PAIR, "plot.py time pair.nc --fish upper --beats 4 --balance -- time_one.png"]),
        ("time_many", "Of more than six fish the median, the quartiles and the range.",
         [CROWD, "plot.py time crowd.nc time_many.png"]),
        ("time_each", "One variable, a panel per fish.",
         ["shoal run CASES/diamond.yaml -q -o diamond.nc --set time.end=6", "plot.py time diamond.nc --each heading -- time_each.png"]),
        ("forces", "Forces and powers by name over the last beats, a column per fish.",
         [PAIR, "plot.py forces pair.nc --beats 2 -- forces.png"]),
        ("pressure", "The jump of the pressure along the body over a beat (`force: pressure`).",
         ["shoal run CASES/fish_pressure.yaml -q -o fish_pressure.nc", "plot.py pressure fish_pressure.nc pressure.png"]),
        ("school", "Polarisation, distances and contacts; a panel without content is left out.",
         [CROWD, "plot.py school crowd.nc school.png"]),
    ]),
    ("A field", "`shoal field` computes the flow on a grid.", [
        ("field", "Vorticity and streamlines.", [PAIR, "shoal field pair.nc --grid 240,120 -q -o field.nc", "plot.py field field.nc field.png"]),
        ("field_speed", "The speed of the fluid.",
         [PAIR, "shoal field pair.nc --grid 240,120 -q -o field.nc", "plot.py field field.nc --speed --no-streamlines -- field_speed.png"]),
    ]),
    ("A study", "`plot.py study STUDY.nc PICTURE` chooses the figure by the axes of the study ([studies.md](studies.md)).", [
        ("curves", "Any axis: speed, cost of transport and Strouhal number, a line per fish and value of the other axes.",
         ["shoal study CASES/studies/phase.yaml -q -o phase", "plot.py study phase/study.nc curves.png"]),
        ("held", "Held bodies: thrust, power and efficiency.",
         ["shoal study CASES/studies/foil_stiffness.yaml -q -o foil", "plot.py study foil/study.nc held.png"]),
        ("equilibrium", "Equilibria in a stream: drag, lift and deflection.",
         ["shoal study CASES/studies/reconfiguration.yaml -q -o strips", "plot.py study strips/study.nc equilibrium.png"]),
        ("map", "Places, or two axes of numbers: cells with the values of the members.",
         ["shoal study CASES/studies/school_spacing.yaml -q -o spacing",
          "plot.py study spacing/study.nc --of cost_of_transport -- map.png"]),
        ("contours", "Contours where both axes have six values or more.",
         ["shoal study fine.yaml -q -o fine", "plot.py study fine/study.nc contours.png"]),
        ("refine", "A refined axis: the error of each level by Richardson with the next finer one, the orders that are accepted, and "
         "a triangle of the design order.",
         ["shoal study levels.yaml -q -o levels", "plot.py study levels/study.nc refine.png"]),
        ("bars", "A refined axis and another axis: values with their error bars.",
         ["shoal study bars.yaml -q -o bars", "plot.py study bars/study.nc bars.png"]),
        ("budget", "The errors of a case: the part of each key, and the levels of each key.",
         ["shoal error CASES/foil_static.yaml --of steady_lift -q -o budget", "plot.py study budget/study.nc budget.png"]),
        ("methods", "Integration methods as an axis of a comparison: error over cost.",
         ["shoal study CASES/studies/methods.yaml -q -o methods", "plot.py study methods/study.nc methods.png"]),
    ]),
]


def command_line(command):
    """A command as a reader types it in the top folder."""
    return re.sub(r"\bCASES/", "cases/", command).replace("plot.py", "scripts/plot.py", 1).replace("shoal ", "build/shoal ", 1)


def result_of(command):
    """The file or folder that a command of shoal makes."""
    return re.search(r"-o (\S+)", command)[1]


def call(command, folder):
    """Run a command of the gallery; an exit code of a study with flags or failed members is no error."""
    words = command.replace("CASES/", os.path.join(HERE, "cases") + os.sep).split()
    program = words[0] == "shoal"
    words[0] = PROGRAM if program else os.path.join(HERE, "scripts", "plot.py")
    print(command, file=sys.stderr, flush=True)
    done = subprocess.run(words if program else [sys.executable, *words], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode not in ((0, 1, 3) if words[1] in ("study", "error") else (0,)):
        sys.exit(f"make-gallery.py: {command} failed:\n{done.stderr}")


def shrink(source, target):
    """Write a picture in few colours; refuse one that is too large for the repository."""
    from PIL import Image

    with Image.open(source) as image:
        for width, colours in ((1000, 96), (900, 64), (800, 64), (720, 64), (640, 48), (560, 48)):
            small = image.convert("RGB").resize((width, round(width * image.height / image.width)), Image.Resampling.LANCZOS)
            small.quantize(colours, kmeans=2, dither=Image.Dither.NONE).save(target, optimize=True)
            if os.path.getsize(target) <= MOST_BYTES:
                return
    sys.exit(f"make-gallery.py: {target} has {os.path.getsize(target)} bytes, more than {MOST_BYTES}")


def draw(name, commands, folder):
    """Make the results of a figure that are not there yet, and draw it."""
    for command in commands[:-1]:
        if not os.path.exists(os.path.join(folder, result_of(command))):
            call(command, folder)
    call(commands[-1], folder)
    shrink(os.path.join(folder, f"{name}.png"), os.path.join(HERE, PICTURES, f"{name}.png"))


def page():
    """The text of doc/gallery.md."""
    lines = [
        "# Figures", "",
        "Every kind of figure with the commands that draw it, run in this order in the top folder after `make`. `make gallery`",
        "draws all figures and writes this page (scripts/make-gallery.py). `shoal.plot` has the same figures as functions",
        "([python.md](python.md)). A name that ends in .pdf or .svg gives a figure for print. Options of a kind: `plot.py KIND",
        "--help`.", "",
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
        "`scripts/animate.py RUN.nc MOVIE.mp4` makes a movie in real time with 25 pictures a second, interpolated between coarse",
        "rows. The camera follows a school that swims far (`--follow`, `--no-follow`); `--rate 0.5` is slow motion.", "",
        "`build/shoal view RUN.nc` writes a page for the browser: bodies and wakes in motion, traces, of many fish median,",
        "quartiles and range, bodies coloured by speed, heading or power.",
    ]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="figures to draw (all)")
    parser.add_argument("--data", default=os.path.join(HERE, "build", "gallery"), metavar="FOLDER", help="where results are kept")
    parser.add_argument("--page", action="store_true", help="print the page, draw nothing")
    options = parser.parse_args()
    if options.page:
        print(page(), end="")
        return
    figures = {name: commands for _, _, some in CHAPTERS for name, _, commands in some}
    unknown = [name for name in options.names if name not in figures]
    if unknown:
        parser.error(f"there is no figure {unknown[0]}: {', '.join(figures)}")
    os.makedirs(options.data, exist_ok=True)
    os.makedirs(os.path.join(HERE, PICTURES), exist_ok=True)
    for name, text in CASES.items():
        with open(os.path.join(options.data, name), "w", encoding="utf-8") as file:
            file.write(text)
    for name in options.names or figures:
        draw(name, figures[name], options.data)
    with open(os.path.join(HERE, "doc", "gallery.md"), "w", encoding="utf-8") as file:
        file.write(page())


if __name__ == "__main__":
    main()

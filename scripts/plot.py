#!/usr/bin/python3
"""Make a figure from a result file of shoal. The suffix of the figure selects the format: .png .svg .pdf

    plot.py [swim] RUN.nc [PICTURE]    bodies, wakes and the paths of the fish, at the end or at --times 1 2 3
    plot.py gait   RUN.nc [PICTURE]    the natural shapes of the muscle, over the last beat
    plot.py study  STUDY.nc [PICTURE]  the figure of a study or a comparison of methods: orders, costs, maps
    plot.py time   RUN.nc [PICTURE]    speed, heading, power and forces over time; with --balance the energy balance too;
                                       --each speed: a panel per fish
    plot.py forces RUN.nc [PICTURE]    forces and powers by name over time, one column per fish
    plot.py pressure RUN.nc [PICTURE]  the jump of the pressure along the bodies over the last beat (force: pressure)
    plot.py school RUN.nc [PICTURE]    polarisation, distances to the nearest neighbour and contacts over time
    plot.py modes  STEADY.nc [PICTURE] the Floquet multipliers of a steady state, and the fish that move in the largest mode
    plot.py field  FIELD.nc [PICTURE]  vorticity (--speed: speed; --streamlines), from a file of `shoal field`

For a journal --style paper adds letters to the panels and makes the figure 170 mm wide, or --width 85.
"""

import argparse
import difflib
import os
import re
import sys

EXIT_USAGE, EXIT_FILE = 2, 4  # as the program itself: doc/cases.md
sys.stdout.reconfigure(errors="surrogateescape")  # the name of a file may have any bytes


def stop(message, code):
    """End with one message on stderr."""
    print(f"{os.path.basename(sys.argv[0])}: {message}", file=sys.stderr)
    sys.exit(code)


try:
    import matplotlib

    matplotlib.use("Agg")
    from shoal import CaseError, FileError, plot
    from shoal._files import DAMAGE, kind_of
except ImportError as missing:
    stop(missing, EXIT_FILE)

# Permitted first words of the command line, with a line of help.
PICTURES = {
    "swim": "bodies, wakes and paths (the default)",
    "gait": "the shapes that the muscle asks for, over one beat",
    "time": "speed, heading, power and forces over time",
    "forces": "forces and powers by name over time",
    "pressure": "the jump of the pressure along the bodies over one beat",
    "school": "polarisation, nearest neighbours and contacts over time",
    "modes": "the multipliers of a steady state and the largest mode",
    "field": "the flow on a grid, from a file of shoal field",
    "study": "a study or a comparison of methods",
}


def implied_kind(arguments):
    """The kind of picture that the file among the arguments calls for."""
    files = [word for word in arguments if os.path.isfile(word)]
    return plot.KIND_OF_FILE.get(kind_of(files[0]) if files else None, "swim")


class Parser(argparse.ArgumentParser):
    """A parser with errors of one line."""

    def error(self, message):
        stop(message, EXIT_USAGE)


def similar(word, words):
    """The question for a similar word, empty without a similar word."""
    near = difflib.get_close_matches(word, words, 1, 0.5)
    return f": did you mean {near[0]}?" if near else ""


def check_kind(word):
    """Refuse a first word that is neither a figure nor a file."""
    if not re.search(r"[./]", word) and not word.startswith("-") and not os.path.exists(word):
        stop(f"{word}: neither a figure nor a file{similar(word, PICTURES) or ': figures are ' + ', '.join(PICTURES)}", EXIT_USAGE)


def check_options(kind, options, arguments):
    """Refuse options that a figure ignores, and name the figures with these options."""
    flags = {name: {flag for action in one._actions for flag in action.option_strings} for name, one in options.items()}
    for word in arguments[: arguments.index("--") if "--" in arguments else None]:
        flag = word.split("=")[0]
        if not flag.startswith("--") or any(known.startswith(flag) for known in flags[kind]):
            continue
        takers = [name for name in options if flag in flags[name]]
        if takers:
            stop(f"{flag}: {kind} does not take it, {' and '.join(takers)} {'do' if takers[1:] else 'does'}", EXIT_USAGE)
        stop(f"{flag}: unrecognized option of {kind}{similar(flag, sorted(flags[kind]))}", EXIT_USAGE)


def parse(arguments):
    """The options of the command line; without a kind of picture the file decides."""
    parser = Parser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    kinds = parser.add_subparsers(dest="kind", metavar="KIND", required=True)
    options = {}
    for kind, words in PICTURES.items():
        options[kind] = kinds.add_parser(kind, help=words)
        options[kind].add_argument("results", metavar="RUN.nc")
        options[kind].add_argument("picture", metavar="PICTURE", nargs="?", help="default: RUN.png in this folder")
        options[kind].add_argument("--style", choices=("screen", "paper"), default="screen", help="paper: letters on the panels")
        options[kind].add_argument("--width", type=float, metavar="MM", help="of --style paper: one column 85, two 170 (170)")
    options["swim"].add_argument("--times", type=float, nargs="+", metavar="T", help="one panel per time [s]")
    options["swim"].add_argument(
        "--limits", type=float, nargs=4, metavar=("X0", "X1", "Y0", "Y1"), help="the window shown [m]"
    )
    options["swim"].add_argument(
        "--follow",
        action=argparse.BooleanOptionalAction,
        help="windows that move with the school, in body lengths (default: where the fish would be tiny otherwise)",
    )
    for kind, what in (("gait", "shapes"), ("pressure", "times")):
        options[kind].add_argument("--shapes", type=int, default=12, help=f"how many {what} to draw (12)")
    for kind, n in (("time", 0), ("forces", 4)):
        options[kind].add_argument("--beats", type=int, help=f"the last beats, 0: the whole run ({n})")
    options["field"].add_argument("--speed", action="store_true", help="draw the speed, not the vorticity")
    options["field"].add_argument("--streamlines", action="store_true", help="draw streamlines, too")
    options["study"].add_argument("--of", metavar="QUANTITY", help="of a map (speed), or the only one of curves and refined axes")
    options["study"].add_argument("--relative", action="store_true", help="a map over the values of the first fish, in per cent")
    options["study"].add_argument("--states", nargs="+", metavar="STEADY.nc",
                                  help="mark steady formations in a map over places: filled if stable, else open")
    options["study"].add_argument("--reference", metavar="TABLE.csv",
                                  help="other values over the same key, as dashed lines: a comment with their source, then columns")
    options["time"].add_argument(
        "--each", nargs="?", const="speed", metavar="VARIABLE", help="a panel per fish, of one variable (speed)"
    )
    for kind in ("gait", "time", "forces", "pressure"):
        options[kind].add_argument("--fish", nargs="+", metavar="NAME", help="only these fish (default: all)")
    options["time"].add_argument("--balance", action="store_true", help="add the energy balance")
    if arguments and arguments[0] not in (*PICTURES, "-h", "--help"):
        check_kind(arguments[0])
        arguments = [implied_kind(arguments), *arguments]
    if not arguments or arguments[0] not in PICTURES:
        parser.parse_args(arguments)  # prints help or what is missing, and ends
    check_options(arguments[0], options, arguments[1:])
    chosen = options[arguments[0]].parse_intermixed_args(arguments[1:])  # options and names in any order
    if chosen.width is not None and (chosen.style != "paper" or not 40 <= chosen.width <= 400):
        stop("--width: from 40 to 400 mm, with --style paper", EXIT_USAGE)
    return argparse.Namespace(kind=arguments[0], **vars(chosen))


def check_folder(path):
    """Refuse a picture or movie in a folder that does not exist, before any work is done."""
    folder = os.path.dirname(path) or "."
    if not os.path.isdir(folder):
        stop(f"{path}: there is no folder {folder}", EXIT_FILE)


def save(figure, path):
    """Write the figure; print a message if writing fails."""
    legends = [axes.get_legend() for axes in figure.axes if axes.get_legend()]
    # this mark identifies figures of shoal for `shoal demo --force`
    mark = {"metadata": {"Source": "shoal plot.py"}} if path.lower().endswith(".png") else {}
    try:
        figure.savefig(path, bbox_extra_artists=[*figure.get_default_bbox_extra_artists(), *legends], **mark)
    except ValueError as error:  # an unknown ending
        stop(f"{path}: {error}", EXIT_USAGE)
    except OSError as error:
        stop(f"{path}: cannot be written: {error.strerror}", EXIT_FILE)


def main(arguments):
    options = parse(arguments)
    picture = options.picture or os.path.splitext(os.path.basename(options.results))[0] + ".png"
    check_folder(picture)
    with matplotlib.rc_context(plot.STYLE):
        try:
            figure = plot.figure_of(options.kind, options.results, options)
        except FileError as error:
            stop(error, EXIT_FILE)
        except CaseError as error:
            stop(error, EXIT_USAGE)
        except DAMAGE as error:
            stop(f"{options.results}: cannot be drawn, it may be damaged ({type(error).__name__}: {error})", EXIT_FILE)
        if options.style == "paper":
            plot.paper(figure, options.width or 170)
        save(figure, picture)
    print(picture)


if __name__ == "__main__":
    main(sys.argv[1:])

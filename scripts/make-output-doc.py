#!/usr/bin/python3
"""Write doc/output.md: `shoal keys --output --json | scripts/make-output-doc.py > doc/output.md`, or `make docs`."""

import json
import re
import sys

INTRODUCTION = """\
# The result file

<!-- Written by `make docs` from the tables in src/result/result_table.c and src/school/warnings.c and the text in scripts/make-output-doc.py. -->

`shoal run CASE` writes one NetCDF file in the classic format with 64-bit sizes (CDF-5), which every NetCDF library
since 4.4 reads. Most questions need one of ten variables:

| variable | what it is | unit |
|---|---|---|
| `com` | position of the centre of mass of each fish | m |
| `x` | positions of the nodes of each body, from the nose to the tail | m |
| `speed` | mean speed through the water over the last beat | m s-1 |
| `heading` | direction in which the fish points, from the x axis towards the y axis | degree |
| `thrust` | force of the water along the heading | N |
| `actuation_power` | power of the muscle | W |
| `cost_of_transport` | mean power over mass and speed, over the last beat | m s-2 |
| `strouhal` | frequency times width of the tail beat over speed | 1 |
| `least_distance` | smallest distance between two bodies | m |
| `wake_x`, `wake_circulation` | the vortices of the wakes: positions, and circulation | m, m2 s-1 |

`run.speed.plot.line(x="time")` draws one of them (see below), and `scripts/plot.py time demo.nc` draws several. The tables
at the end of this page list all variables; before them you find how to open a file, what its dimensions mean, and how to
repeat the run that wrote it.

## Opening

    shoal info demo.nc                 # a summary: status, fish, last values, work of the solver
    shoal info demo.nc --json          # for programs: the last row, without nodes and vortices
    ncdump -v speed,heading demo.nc    # ncdump -h: dimensions, variables and attributes

Python (`apt install python3-xarray python3-netcdf4`):

    import xarray
    run = xarray.open_dataset("demo.nc")
    run.speed.plot.line(x="time")                       # one line per fish
    nose = run.x.isel(fish=0, node=0)                   # (time, xy)
    run.com.sel(fish="leader", xy="x")                  # by the name of the fish

Octave (`pkg load netcdf`) and MATLAB list the dimensions in the opposite order:

    x = ncread("demo.nc", "x");                         % (xy, node, fish, time)
    plot(squeeze(x(1, 1, 1, :)), squeeze(x(2, 1, 1, :)))  % path of the nose of the first fish

`shoal view demo.nc` writes a page that plays bodies and wakes in any browser, and `shoal export demo.nc --vtk demo` writes
files for ParaView. [gallery.md](gallery.md) shows figures and films.

## Dimensions

| dimension | length |
|---|---|
| `time` | number of rows: one per `time.output_interval`, the first at t = 0 |
| `fish` | fish, in the order of the case |
| `node`, `edge`, `joint` | N, N - 1, N - 2, for the largest number N of nodes of a fish; node 0 is the nose |
| `sheet`, `control` | largest number of bound vortices and of control points of a fish |
| `vortex` | slots for free vortices: the largest possible number of a fish |
| `xy` | 2: x, then y |
| `name` | bytes of the longest fish name |
| `wall` | 1, or 2 for a channel; only with `fluid.walls`, like `wall_y` |
| `multiplier` | six for each fish; only in files of `shoal steady`, like the variables `steady_...` ([steady.md](steady.md)) |

A fish with fewer points than the largest one uses the first `n_nodes`, `n_edges`, `n_joints`, `n_sheet` slots. All other
slots are NaN, the `_FillValue`, and so are quantities that are not defined, such as a mean in the first beat.

*Wake.* The free vortices of a fish, `wake_count` of them, stand in the first slots, oldest first, and `wake_birth`
identifies a vortex from row to row. Rows between two records of the wake (`output.wake_interval`) have NaN there. The
vortex that grows at the tail has no slot before it is released.

`output.precision: single` stores the variables marked *single* below as float, which halves the file.

## Reading during a run

You can open the file at any time during a run, and open it again to see new rows. If the run is killed, all rows stay.
The attribute `run_status` tells the state of the run:

| `run_status` | meaning |
|---|---|
| `running` | the run continues, or was killed: `shoal resume RUN.nc` continues from its checkpoint |
| `complete` | the run reached `time.end` |
| `stopped` | stopped by a signal or `--max-wall`; `shoal resume` continues ([reliability.md](reliability.md)) |
| `failed: ...` | the integration or the writing failed, or bodies met with `contact.action: stop`; the rows are valid |

The attribute `warnings` has one line for each defect of the result and names the fish that it affects most. `shoal run`,
`shoal info` and `shoal gather` print these warnings, and with `--strict` they then end with exit code 3. The attribute
`closest_approach` has the least distance of two bodies, with the fish and the time.

@WARNINGS@

Every command and script refuses a truncated file, and a study runs such a member again.

## Repeating a run

A result contains all that is needed to repeat its run:

    shoal info --case demo.nc > again.yaml
    shoal run again.yaml

reproduces the numbers. With the same program it reproduces every bit except `wall_time` and `history`. A run that was
stopped and resumed also needs `--checkpoint-at` with the times in the attribute `checkpoint_at`, which are those of the
checkpoints besides `time.checkpoint_interval`.

The attribute `case_effective` is the complete case, after includes, preset and `--set`, and `case_text` is the original
file. `source` names the program, the commit and the libraries, `history` the time and the command, and `method` the
method of integration.

## Attributes

Besides the attributes above a file has `Conventions` (CF-1.10), `title` (the name of the case) and
`shoal_schema` (1; a program with another number cannot read the file). Every variable has `long_name` and, except
strings, `units`. `fish`, `xy`, `node_arc`, `edge_arc`, `joint_arc`, `sheet_arc` and `control_arc` are coordinates.
"""

# Title of a section, and the test on the dimensions of its variables.
SECTIONS = [
    ("Constants", lambda dimensions: "time" not in dimensions),
    ("Bodies, sheets and wakes", lambda dimensions: {"node", "joint", "sheet", "control", "vortex"} & set(dimensions)),
    ("Each fish", lambda dimensions: "fish" in dimensions),
    ("The school and the solver", lambda dimensions: True),
]


# The text before the variables of the other files.
OTHERS = {
    "study": """
## The file of a study

`shoal study` and `shoal gather` make `study.nc` from the files of the members. It has the last row of every variable over
(time), (time, fish) or (time, fish, xy), with `member` in place of `time`, and for steady states also `steady_...`. Each
swept key is a variable over `member`, named like the key with `_` for `.` and without brackets. Its attribute `long_name`
is the path of the key, `axis` the number of the axis, and `refine` is 1 on a refined axis. The attribute `study_case` of
the file is the case with the sweep, and `shoal_study` is 1.

*A refined axis* adds the variables over `level` and `group` (members that differ in the refined key only), for each
quantity Q that has orders ([cases.md](cases.md)); the order of the nose, for example, is `order_nose`.

*Error bars.* `error` adds the variables over `key`, and `stated_Q` and `bar_Q`. With `error.against` the file has the
members of the other case too, and three quantities for each one requested: Q, `ratio_Q` (Q over that of the other case)
and `change_Q` (the difference of both).

*A comparison.* `shoal compare -o FILE` writes one axis, which sets `solver.method`, `solver.order`, `solver.rtol` and
`solver.step`, with `nose_error`, `tail_error`, `power_error`, `evaluations_to_end` and `wall_time_to_end`. Member 0 is the
reference, member 1 measures the error of the reference, and members with equal values are repeats. If a member exceeded
the time limit, `time` and the counts are those that it reached, the last two variables are extrapolated to the end in
proportion to time, and `status` says so.
""",
    "field": """
## The file of a field

    shoal field demo.nc                                      # the last row, around bodies and wakes: demo-field.nc
    shoal field demo.nc --at 2.5 --grid 600,400 --box -2,-1,2,1 -o field.nc
    scripts/plot.py field field.nc                           # vorticity (--speed: speed), streamlines, bodies: field.png

`shoal field` writes the velocity and the vorticity of the fluid on a grid, at the time of one row. They are the sum of the
external flow, every bound sheet and every wake, as another body at that position would feel it (doc/model.md, section 8),
with an error of 1e-7 of the sum of absolute values. Bodies are lines in the model, so the field does not show their
thickness. A row without a wake (`output.wake_interval`) has no field.

The attribute `run` names the file of the run, `case_effective` is the case, and `shoal_field` is 1.
""",
}


def section_of(variable):
    """The title of the first section that takes the variable."""
    return next(title for title, takes in SECTIONS if takes(variable["dimensions"]))


TYPES = {"double or float": " *(single)*"}

# Variables with the same dimensions have their own table from this number on.
LARGE = 5


def row(variable, *dimensions):
    meaning = variable["meaning"] + TYPES.get(variable["type"], "")
    return "| " + " | ".join([f"`{variable['name']}`", *dimensions, variable["unit"], meaning]) + " |"


def table(variables):
    """The rows of a table with a column for the dimensions."""
    yield "| variable | dimensions | unit | meaning |"
    yield "|---|---|---|---|"
    for variable in variables:
        yield row(variable, ", ".join(variable["dimensions"]))


def tables(variables):
    """One table for each large group of variables with the same dimensions, and one table for all others."""
    groups, others = {}, []
    for variable in variables:
        groups.setdefault(", ".join(variable["dimensions"]) or "scalars", []).append(variable)
    for dimensions, group in groups.items():
        if len(group) < LARGE:
            others += group
            continue
        yield f"| {dimensions} | unit | meaning |"
        yield "|---|---|---|"
        yield from map(row, group)
        yield ""
    if others:
        yield from table(others)


def warnings(rows):
    """The rows of the table of warnings, with keys and file names as code."""
    yield "| warning | when |"
    yield "|---|---|"
    for row in rows:
        yield f"| {row['name']} | {code(row['meaning'])} |"


def code(text):
    """Format quoted text and names with a dot or an underscore as code."""
    return re.sub(r"'([^']+)'|\b([a-z]+[_.][a-z_]+)\b", lambda match: f"`{match[1] or match[2]}`", text)


def main():
    variables = json.load(sys.stdin)
    print(INTRODUCTION.replace("@WARNINGS@", "\n".join(warnings(v for v in variables if v["file"] == "warning"))))
    print("## Variables")
    for title, _ in SECTIONS:
        print(f"\n### {title}\n")
        print("\n".join(tables(v for v in variables if v["file"] == "run" and section_of(v) == title)).rstrip())
    for name, words in OTHERS.items():
        print(words)
        print("\n".join(table(v for v in variables if v["file"] == name)))


if __name__ == "__main__":
    main()

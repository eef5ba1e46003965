#!/usr/bin/python3
"""Write doc/output.md: reads what `shoal keys --output --json` prints on stdin, writes markdown on stdout."""

import json
import re
import sys

INTRODUCTION = """\
# The result file

<!-- Written by `make docs` from the tables in src/result/result_table.c and src/school/warnings.c and the words in scripts/make-output-doc.py. -->

`shoal run CASE` writes one NetCDF file, in the classic format with 64-bit sizes (CDF-5): every NetCDF library since
4.4 reads it, and a run that is killed or fills the disk loses none of the rows written before. The file contains all
that a picture needs and the case itself.

## Opening it

    shoal info demo.nc                 # a summary: status, fish, last values, work of the solver
    shoal info demo-study/study.nc     # of a study: axes, members, orders of convergence; of a comparison: its table
    shoal info demo-field.nc           # of a field: time, grid
    ncdump -h demo.nc                  # everything that is in the file
    ncdump -v speed,heading demo.nc

Python (`apt install python3-xarray python3-netcdf4`):

    import xarray
    run = xarray.open_dataset("demo.nc")
    run.speed.plot.line(x="time")                       # one line per fish
    nose = run.x.isel(fish=0, node=0)                   # (time, xy)
    run.speed.sel(fish="leader")                        # by the name of the fish
    run.com.sel(fish="leader", xy="x")

Octave (`pkg load netcdf`) and MATLAB; both list the dimensions in the opposite order:

    t = ncread("demo.nc", "time");
    x = ncread("demo.nc", "x");                         % (xy, node, fish, time)
    plot(squeeze(x(1, 1, 1, :)), squeeze(x(2, 1, 1, :)))  % path of the first fish's nose

To look at a run: `shoal view demo.nc` writes demo.html, one page with bodies, wakes and traces that plays in any
browser and needs no network; `shoal export demo.nc --vtk demo` writes files for ParaView. Pictures: `scripts/plot.py demo.nc`, `scripts/plot.py time demo.nc`, `scripts/plot.py forces demo.nc`, `scripts/animate.py demo.nc demo.mp4`.

## Shapes

| dimension | length |
|---|---|
| `time` | rows written so far: one per `time.output_interval`, the first at t = 0 |
| `fish` | fish, in the order of the case |
| `node`, `edge`, `joint` | N, N - 1, N - 2, for the N nodes of the fish that has most; node 0 is the nose |
| `sheet` | bound vortices of the fish that has most |
| `control` | control points of the sheet of the fish that has most |
| `vortex` | slots for free vortices: the largest number that one fish can have |
| `xy` | 2: x, then y |
| `name` | bytes of the longest fish name |
| `wall` | 1, or 2 for a channel; in the files of cases with `fluid.walls` only, as is `wall_y` |
| `multiplier` | six for each fish; in the files of `shoal steady` only, as are the variables `steady_...` ([steady.md](steady.md)) |

A shorter fish uses the first slots only, `n_nodes`, `n_edges`, `n_joints`, `n_sheet` of them. All other slots hold NaN,
which is also the `_FillValue`; a derived quantity that is not defined yet (a mean over a beat in the first beat, the
distance between the bodies of one fish) is NaN as well.

The wake: `wake_count` says how many free vortices a fish has; they are in the first slots, oldest first. A vortex
moves up when an older one is removed, so a slot is not a vortex; `wake_birth` tells them apart. With
`output.wake_interval` longer than `time.output_interval` the rows between hold NaN in `wake_x`, `wake_circulation` and
`wake_birth`; `wake_count` is always right. `wake_circulation` is what was shed; what acts on the flow decays over the
last `wake_decay` seconds of `wake_lifetime` (doc/model.md, section 8). The vortex that grows at the tail has no slot
until it is released.

`output.precision: single` stores the variables marked "double or float" as float, which halves the file; time and
derived quantities stay double.

## While it is being written

Each row shows up when it is complete: the file can be opened at any time, also by several readers. A reader that keeps
it open sees new rows when it opens it again. The attribute `run_status` says how far the run is:

| `run_status` | meaning |
|---|---|
| `running` | the run goes on, or was killed: `shoal resume` goes on where there is a checkpoint |
| `complete` | the run reached `time.end` |
| `stopped` | a signal or `--max-wall` stopped it; the rows are good, and `shoal resume` goes on ([reliability.md](reliability.md)) |
| `failed: ...` | the integration or the writing failed, or bodies met with `contact.action: stop`; the rows are good |

The attribute `warnings` is written at the end: one line for each thing that is wrong with the result although the
integration succeeded, about the fish for which it is worst. They are printed at the end of a run, by `shoal info` and by
`shoal gather`; with `--strict` they end with exit code 3.

@WARNINGS@

A file whose end is missing, for instance because it was cut while it was copied, is refused by every command and script;
a study runs such a member again.

## Repeating a run

Attribute `case_effective` is the whole case with every key, its includes, preset and `--set` worked in; `case_text` is
the case file as it was written. `source` names the program, its commit and its libraries, `history` the command.

    shoal info --case demo.nc > again.yaml
    shoal run again.yaml

gives the same numbers, bit for bit with the same program (only `wall_time` and `history` differ). A run that was stopped and
resumed needs its places, too: `--checkpoint-at` with the attribute `checkpoint_at`.

## Attributes

| attribute | contents |
|---|---|
| `Conventions` | CF-1.10 |
| `title` | name of the case |
| `history` | when the file was made, by which command |
| `source` | program, commit, versions of the libraries |
| `shoal_schema` | 1; a program that expects another number cannot read the file |
| `run_status`, `warnings`, `closest_approach`, `merged_vortices`, `case_text`, `case_effective` | see above |
| `checkpoint_at` | times of checkpoints besides those of `time.checkpoint_interval`, as `--checkpoint-at` takes them: `0.3,1.25` |

Every variable has `long_name` and, unless it is a string, `units`. `fish`, `xy`, `fish_name`, `node_arc`, `sheet_arc` and `control_arc` are coordinates.
"""

# Title of a section, and which variables belong to it, by their dimensions.
SECTIONS = [
    ("Constants", lambda dimensions: "time" not in dimensions),
    ("Bodies, sheets and wakes", lambda dimensions: {"node", "joint", "sheet", "control", "vortex"} & set(dimensions)),
    ("Each fish", lambda dimensions: "fish" in dimensions),
    ("The school and the solver", lambda dimensions: True),
]


# The words before the variables of the other files.
OTHERS = {
    "study": """
## The file of a study

`shoal study` and `shoal gather` make `study.nc` from the files of the members. Attribute `study_case` is the case with
its sweep, `shoal_study` is 1. For each swept key there is a variable over `member`, named like the key with `_` for `.`
and without brackets; its `long_name` is the path, its `axis` the number of its axis, and `refine` is 1 where that is
refined. Every variable over (time), (time, fish) or (time, fish, xy) of a result file is there with its last row, over
(member), (member, fish) or (member, fish, xy); where members are steady states, so are the numbers `steady_...` of
these. It also has the variables below; a member without rows has NaN.

With a refined axis, there are `level_value` and what follows it; each of the six kinds from `difference_Q` on has one variable for each of the quantities Q: `nose`, `tail`, `com`,
`speed`, `mean_heading`, `shed_circulation`, `cost_of_transport`, `mean_actuation_power`; where members are steady
states, `steady_speed` and what else [cases.md](cases.md) lists. The order of the nose is `order_nose`. A group is a set of members that differ in the refined key only.

Where the case has `error`, there are `key_name` and what follows it, and `stated_Q`, `bar_Q`, `part_Q`, `key_order_Q` for
each quantity Q that is asked for.

`shoal compare -o FILE` writes the same file: its one axis sets `solver.method`, `solver.order`, `solver.rtol` and
`solver.step`. Member 0 is the reference, member 1 shows how good that is, and of the others those with equal values are
repeats. Only such a study has `nose_error`, `tail_error` and `power_error`.
""",
    "field": """
## The file of a field

    shoal field demo.nc                                      # the last row, around bodies and wakes: demo-field.nc
    shoal field demo.nc --at 2.5 --grid 600,400 --box -2,-1,2,1 -o field.nc
    scripts/plot.py field field.nc                           # vorticity (--speed: speed), streamlines, bodies: field.png

`shoal field` writes the velocity and the vorticity of the fluid on a grid, at the time of one row. It sums what is in
the row, by the tree where there is much of it (then to 1e-7 of the sum of absolute values): the external flow, every
bound sheet and every wake with the smoothing with which another body sees them. It is what a body at that place would
feel, to rounding, or to seven digits with `output.precision: single`.

It leaves out: the flow around the thickness of bodies, which the model has as lines; and that a body sees its own
newest wake more sharply (doc/model.md, section 8). The vorticity is that of the smoothed sheets and wakes, and minus
the shear of the stream. A row without its wake (`output.wake_interval`) has no field.

Attribute `run` names the file of the run, `case_effective` is its case, `shoal_field` is 1.
""",
}


def section_of(variable):
    """The title of the first section that takes the variable."""
    return next(title for title, takes in SECTIONS if takes(variable["dimensions"]))


def table(variables):
    """The rows of a markdown table."""
    yield "| variable | dimensions | unit | type | meaning |"
    yield "|---|---|---|---|---|"
    for variable in variables:
        cells = [variable[key] for key in ("unit", "type", "meaning")]
        yield "| " + " | ".join([f"`{variable['name']}`", ", ".join(variable["dimensions"]), *cells]) + " |"


def warnings(rows):
    """The rows of the table of warnings: words of cases and of files as code."""
    yield "| warning | when |"
    yield "|---|---|"
    for row in rows:
        yield f"| {row['name']} | {code(row['meaning'])} |"


def code(text):
    """What stands in quotes, and what is a name with a dot or a low line in it, as code."""
    return re.sub(r"'([^']+)'|\b([a-z]+[_.][a-z_]+)\b", lambda match: f"`{match[1] or match[2]}`", text)


def main():
    variables = json.load(sys.stdin)
    print(INTRODUCTION.replace("@WARNINGS@", "\n".join(warnings(v for v in variables if v["file"] == "warning"))))
    print("## Variables")
    for title, _ in SECTIONS:
        print(f"\n### {title}\n")
        print("\n".join(table(v for v in variables if v["file"] == "run" and section_of(v) == title)))
    for name, words in OTHERS.items():
        print(words)
        print("\n".join(table(v for v in variables if v["file"] == name)))


if __name__ == "__main__":
    main()

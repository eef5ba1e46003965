#!/usr/bin/python3
"""Let every allocation of the program fail that a command makes, one at a time; then run the command with little memory,
from what the program alone needs to what is enough.

    memory.py PROGRAM [EVERY [STEP [COMMAND...]]]

EVERY: 1 tries all allocations, n every n-th; STEP: kB between two limits, 0 for none; COMMAND: one of those below, by
default all of them.

The command ends with exit code 0, where it can do without, or 4 and one message with the words memory or threads, or 1: a
study whose members fail, and whose table says so. It leaves no part. A result that the command would replace is there
byte for byte, or, once a run has begun to write rows, the new one is there and can be read; a run that is resumed can be
resumed again."""
import os, resource, shutil, subprocess, sys
from common import argument, build, counts, finish, judge, parts, program, same, shoal, succeed, write

every, step = argument(2, 1), argument(3, 200)
ENOUGH = 4  # commands in a row that succeed: more memory changes nothing
FISH = "{{force: reactive, nodes: {0}, sheet_points: {1}, body: {{tail_thickness: 0.4}}, start: {{position: [0, {2:.1f}]}}{3}}}"
SCHOOL = """format: 1
name: {}
time: {{end: 0.04, shedding_interval: {}, output_interval: 0.02, checkpoint_interval: 0.02}}
fish: [{}]
"""
STEADY = """format: 1
name: steady
time: {{end: 1, shedding_interval: 0.1}}
fish: [{{force: reactive, nodes: {}, sheet_points: {}, body: {{tail_thickness: 0.4}}, wave: {{frequency: 1}}}}]
steady: {{tolerance: 0.03, multipliers: false}}
"""
AXIS = "sweep=[{key: 'fish[0].wave.amplitude', values: [0.2, 0.3]}]"
RUN = ["new.nc", "new.ckpt", "new.ckpt.previous"]
REPLACE = ["run", "school.yaml", "-q", "-o", "new.nc", "--force", "--set", "fish[0].wave.amplitude=0.2"]
PRESSURE = ["--set", "fish[*].force=pressure", "--set", "fish[*].pressure.span=infinite"]
# what each command is, and the files that it replaces
COMMANDS = {
    "check": (["check", "school.yaml"], []),
    "show": (["show", "school.yaml"], []),
    "run": (["run", "school.yaml", "-q", "-o", "made.nc"], []),
    "run --force": (REPLACE, RUN),
    "run with pressure": (REPLACE + PRESSURE, RUN),
    "run with threads": (REPLACE + ["--threads", "2"], RUN),
    "resume": (["resume", "new.ckpt", "--end", "0.06", "-q"], RUN),
    "steady": (["steady", "steady.yaml", "-q", "-o", "steady.nc", "--force"], ["steady.nc"]),
    "study": (["study", "school.yaml", "-q", "-j", "1", "-o", "made", "--set", AXIS], []),
    "gather": (["gather", "study"], ["study/study.nc"]),
    "compare": (["compare", "school.yaml", "-q", "--methods", "ida3", "--rtol", "1e-3", "--reference-rtol", "1e-5",
                 "--repeats", "1", "--set", "time.checkpoint_interval=0", "-o", "compare.nc", "--force"], ["compare.nc"]),
    "info": (["info", "old.nc"], []),
    "info of a checkpoint": (["info", "old.ckpt"], []),
    "field": (["field", "old.nc", "-q", "--at", "0.04", "--grid", "4,4", "-o", "field.nc", "--force"], ["field.nc"]),
    "view": (["view", "old.nc", "-q", "-o", "new.html", "--force"], ["new.html"]),
    "export": (["export", "old.nc", "-q", "--vtk", "vtk", "--force"], ["vtk/old.pvd"]),
}
# the OpenMP library of clang ends the process when a thread cannot be started
has_libomp = "libomp" in subprocess.run(["ldd", program], capture_output=True, text=True).stdout


def lost(name, files):
    """What is wrong with the files that a command has not replaced, or None."""
    for file in files:
        if same(file, "kept/" + file):
            continue
        if not name.startswith(("run", "resume")):
            return f"{file} is not what it was"
        if file == "new.nc":
            said = shoal("info", file)
            if said.returncode != 0 or "none yet" in said.stdout:
                return f"{file} is neither what it was nor a result: {said.stderr}"
    again = shoal(*COMMANDS[name][0]) if name == "resume" else None
    return f"it cannot be resumed again: {again.stderr}" if again and again.returncode else None


def attempt(name, kind, **options):
    """Run a command without memory and judge its end; whether it succeeded."""
    command, files = COMMANDS[name]
    subprocess.run("rm -rf made made.* vtk", shell=True, check=True)
    for file in files:
        os.makedirs(os.path.dirname(file) or ".", exist_ok=True)
        shutil.copy("kept/" + file, file)
    done = shoal(*command, **options)
    code, said = done.returncode, done.stderr + (done.stdout if done.returncode == 1 else "")
    if code == 0:
        wrong = None
    elif has_libomp and "--threads" in command and code in (-6, -11):
        wrong = lost(name, files)
    elif code != 4 and not (code == 1 and name in ("study", "compare", "gather")):
        wrong = f"exit code {code}: {said}"
    elif not ("memory" in said or "threads" in said) or "Traceback" in said:
        wrong = f"exit code {code} with the message {said!r}"
    else:
        wrong = f"it leaves {parts()}" if parts() else lost(name, files)
    judge(f"{name}, {kind}", wrong)
    return code == 0


def prepare(n_fish, nodes, points, interval):
    """The results that the commands read and replace, of a school of this size."""
    subprocess.run("rm -rf *", shell=True, check=True)
    steers = ", control: {law: heading, desired_heading: 170}"
    write("school.yaml", SCHOOL.format("school", interval, ", ".join(
        FISH.format(nodes, points, 0.7 * i, steers if i == 1 else "") for i in range(n_fish))))
    write("steady.yaml", STEADY.format(nodes, points))
    for name in ("old.nc", "new.nc"):
        succeed("run", "school.yaml", "-q", "-o", name)
    succeed("view", "old.nc", "-q", "-o", "new.html")
    succeed("study", "school.yaml", "-q", "-o", "study", "--set", AXIS)
    for name in ("steady", "compare", "field", "export"):
        succeed(*COMMANDS[name][0])
    subprocess.run("mkdir -p kept/study && mv new.* steady.nc field.nc compare.nc vtk kept && cp study/study.nc kept/study",
                   shell=True, check=True)


chosen = sys.argv[4:] or list(COMMANDS)
prepare(2, 5, 9, 0.01)
tried = 0
for name in chosen:
    if os.path.exists("counted"):
        os.remove("counted")
    shim = {"LD_PRELOAD": build + "/memory.so", "OMP_NUM_THREADS": "1"}
    assert attempt(name, "all memory", MEMORY_COUNT=os.path.abspath("counted"), **shim), name
    with open("counted") as lines:
        n = max(map(int, lines))
    found = 0
    for at in range(2, n + 1):  # the first belongs to OpenMP, before main
        tried += 1
        found += tried % every == 0 and not attempt(name, f"allocation {at} of {n}", MEMORY_AT=str(at), **shim)
    print(f"{name}: {n} allocations, {found} of those tried end with a message", flush=True)

if step == 0:
    finish()
prepare(15, 21, 41, 0.02)
least = 20000
while shoal("--version", limits=[(resource.RLIMIT_AS, 1024 * least)]).returncode:
    least += step
for name in chosen:
    kilobytes, n_enough, n_short = least, 0, 0
    while n_enough < ENOUGH:
        is_enough = attempt(name, f"{kilobytes} kB", limits=[(resource.RLIMIT_AS, 1024 * kilobytes), (resource.RLIMIT_CORE, 0)])
        n_enough = n_enough + 1 if is_enough else 0
        n_short += not is_enough
        kilobytes += step
    print(f"{name}: {n_short} limits from {least} kB on were too low, the last one below {kilobytes - ENOUGH * step} kB", flush=True)
finish()

#!/usr/bin/python3
"""Run every command with little memory: from what the program alone needs to what is enough, in steps.

    limits.py PROGRAM STEP      STEP: kB between two limits

The command ends with exit code 0, or with 4 and one message with the word memory, or threads, or with 1 where members of
a study failed for that reason. A result that it would replace is there byte for byte, or, once a run has begun to write
rows, the new one is there and can be read; a run that is resumed can be resumed again. Prints a line for what is wrong, and
as the last one how many passed and failed.
"""
import os, resource, shutil, subprocess, sys, tempfile

program, step = os.path.abspath(sys.argv[1]), int(sys.argv[2])
ENOUGH = 4  # commands in a row that succeed: more memory changes nothing
SCHOOL = """format: 1
name: school
time: {end: 0.04, shedding_interval: 0.02, output_interval: 0.02, checkpoint_interval: 0.02}
fish:
""" + "".join(f"  - {{force: reactive, nodes: 21, sheet_points: 41, start: {{position: [0, {0.7 * i:.1f}]}}}}\n" for i in range(15))
STEADY = """format: 1
name: steady
time: {end: 1, shedding_interval: 0.05}
fish: [{force: reactive, nodes: 41, sheet_points: 65, wave: {frequency: 1}}]
steady: {tolerance: 0.03, multipliers: false}
"""
AXIS = "sweep=[{key: 'fish[0].wave.amplitude', values: [0.2, 0.3]}]"
RUN = ["new.nc", "new.ckpt", "new.ckpt.previous"]
# what each command is, and the files that it would replace
COMMANDS = {
    "run": (["run", "school.yaml", "-o", "new.nc", "--force"], RUN),
    "run with pressure": (["run", "school.yaml", "-o", "new.nc", "--force", "--set", "fish[*].force=pressure", "--set", "fish[*].pressure.span=infinite"], RUN),
    "run with threads": (["run", "school.yaml", "-o", "new.nc", "--force", "--threads", "4"], RUN),
    "resume": (["resume", "new.ckpt", "--end", "0.06"], RUN),
    "steady": (["steady", "steady.yaml", "-o", "steady.nc", "--force"], ["steady.nc"]),
    "study": (["study", "school.yaml", "-j", "1", "-o", "new", "--set", AXIS], []),
    "compare": (["compare", "school.yaml", "--methods", "ida3", "--rtol", "1e-3", "--reference-rtol", "1e-5", "--repeats", "1",
                 "--set", "time.checkpoint_interval=0", "-o", "compare.nc", "--force"], ["compare.nc"]),
    "gather": (["gather", "study"], ["study/study.nc"]),
    "info": (["info", "old.nc"], []),
    "field": (["field", "old.nc", "--grid", "200,200", "-o", "field.nc", "--force"], ["field.nc"]),
    "view": (["view", "old.nc", "-o", "new.html", "--force"], ["new.html"]),
    "export": (["export", "old.nc", "--vtk", "vtk", "--force"], ["vtk/old.pvd"]),
    "check": (["check", "school.yaml"], []),
}
QUIET = {"run", "resume", "steady", "study", "compare", "field", "view", "export", "check"}
counts = {"passed": 0, "failed": 0}
# the OpenMP library of clang ends the process when a thread cannot be started
has_libomp = "libomp" in subprocess.run(["ldd", program], capture_output=True, text=True).stdout


def run(command, kilobytes=None):
    def lower():
        if kilobytes:
            resource.setrlimit(resource.RLIMIT_AS, (1024 * kilobytes, 1024 * kilobytes))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    quiet = ["-q"] if command[0] in QUIET else []
    return subprocess.run([program, *command, *quiet], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          errors="replace", timeout=300, preexec_fn=lower)


def prepare(files):
    """What the command finds."""
    subprocess.run("rm -rf new new.* vtk", shell=True, check=True)
    for file in files:
        os.makedirs(os.path.dirname(file) or ".", exist_ok=True)
        shutil.copy("kept/" + file, file)


def same(one, other):
    with open(one, "rb") as a, open(other, "rb") as b:
        return a.read() == b.read()


def lost(name, files):
    """What is wrong with the results that have not been replaced, or None."""
    for file in files:
        if os.path.exists(file) and same(file, "kept/" + file):
            continue
        if file == "new.nc":
            said = run(["info", file])
            if said.returncode != 0 or "none yet" in said.stdout:
                return f"{file} is neither what it was nor a result: {said.stderr}"
        elif name != "resume" and not name.startswith("run"):
            return f"{file} is not what it was"
    if name == "resume":
        again = run(COMMANDS[name][0])
        return f"it cannot be resumed again: {again.stderr}" if again.returncode else None
    return None


def wrong(name, done, files):
    """What is wrong with the end of a command, or None."""
    code, said = done.returncode, done.stderr + (done.stdout if done.returncode == 1 else "")
    if code == 0:
        return None
    if has_libomp and "--threads" in COMMANDS[name][0] and code in (-6, -11):
        return lost(name, files)
    if code not in (1, 4) or (code == 1 and name not in ("study", "compare", "gather")):
        return f"exit code {code}: {said}"
    if not ("memory" in said or "threads" in said) or "Traceback" in said:
        return f"exit code {code} with the message {said!r}"
    left = [file for file in os.listdir(".") if ".part" in file]
    return f"it leaves {left}" if left else lost(name, files)


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    open("school.yaml", "w").write(SCHOOL)
    open("steady.yaml", "w").write(STEADY)
    for command in (["run", "school.yaml", "-o", "old.nc"], ["run", "school.yaml", "-o", "new.nc"],
                    ["steady", "steady.yaml", "-o", "steady.nc"], ["study", "school.yaml", "-o", "study", "--set", AXIS],
                    ["field", "old.nc", "--grid", "3,3", "-o", "field.nc"], ["view", "old.nc", "-o", "new.html"],
                    ["export", "old.nc", "--vtk", "vtk"], COMMANDS["compare"][0]):
        run(command).check_returncode()
    os.makedirs("kept/study")
    subprocess.run("mv new.* steady.nc field.nc compare.nc vtk kept && cp study/study.nc kept/study", shell=True, check=True)
    least = 20000
    while run(["--version"], least).returncode:
        least += 1000
    for name, (command, files) in COMMANDS.items():
        prepare(files)
        assert run(command).returncode == 0, name
        n_enough = n_short = 0
        kilobytes = least
        while n_enough < ENOUGH:
            prepare(files)
            done = run(command, kilobytes)
            bad = wrong(name, done, files)
            counts["failed" if bad else "passed"] += 1
            if bad:
                print(f"FAILED  {name} with {kilobytes} kB: {bad.strip()}", flush=True)
            n_short += done.returncode != 0
            n_enough = n_enough + 1 if done.returncode == 0 else 0
            kilobytes += step
        print(f"{name}: {n_short} limits from {least} kB on were too low, the last one below {kilobytes - ENOUGH * step} kB",
              flush=True)
    os.chdir("/")
print(f"{counts['passed']} passed, {counts['failed']} failed, 0 skipped")
sys.exit(counts["failed"] > 0)

#!/usr/bin/python3
"""Let every allocation of the program fail that a command makes, one at a time.

    memory.py PROGRAM SHIM EVERY      EVERY: 1 tries all of them, n every n-th

The command ends with exit code 0, where it can do without, or 4 and one message with the word memory, or 1: a study
whose members fail, and whose table says so. It leaves no half of a file. A result that the command would replace is there
byte for byte, or, once a run has begun to write rows, the new one is there and can be read.
Prints a line for what is wrong, and as the last one how many passed and failed.
"""
import os, shutil, subprocess, sys, tempfile

program, shim, every = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2]), int(sys.argv[3])
CASE = """format: 1
name: small
time: {end: 0.04, shedding_interval: 0.01, output_interval: 0.02, checkpoint_interval: 0.02}
fish:
  - {force: reactive, nodes: 5, sheet_points: 9, body: {tail_thickness: 0.4}}
  - {force: reactive, nodes: 5, sheet_points: 9, body: {tail_thickness: 0.4}, start: {position: [0, 0.7]}, control: {law: heading, desired_heading: 170}}
"""
AXIS = "sweep=[{key: 'fish[0].wave.amplitude', values: [0.2, 0.3]}]"
STEADY = """format: 1
name: steady
time: {end: 1, shedding_interval: 0.1}
fish: [{force: reactive, nodes: 5, sheet_points: 9, body: {tail_thickness: 0.4}, wave: {frequency: 1}}]
steady: {tolerance: 0.01, multipliers: false}
"""
# what each command is, and what it makes; what it replaces is in the folder kept
COMMANDS = {
    "check": (["check", "small.yaml"], []),
    "show": (["show", "small.yaml"], []),
    "run": (["run", "small.yaml", "-q", "-o", "new.nc"], ["new.nc", "new.ckpt", "new.ckpt.previous"]),
    "run --force": (["run", "small.yaml", "-q", "-o", "new.nc", "--force", "--set", "fish[0].wave.amplitude=0.2"],
                    ["new.nc", "new.ckpt", "new.ckpt.previous"]),
    "run with pressure": (["run", "small.yaml", "-q", "-o", "new.nc", "--force", "--set", "fish[*].force=pressure", "--set", "fish[*].pressure.span=infinite"],
                          ["new.nc", "new.ckpt", "new.ckpt.previous"]),
    "run with threads": (["run", "small.yaml", "-q", "-o", "new.nc", "--force", "--threads", "2"],
                         ["new.nc", "new.ckpt", "new.ckpt.previous"]),
    "steady": (["steady", "steady.yaml", "-q", "-o", "steady.nc", "--force"], ["steady.nc"]),
    "resume": (["resume", "new.ckpt", "--end", "0.06", "-q"], ["new.nc", "new.ckpt", "new.ckpt.previous"]),
    "study": (["study", "small.yaml", "-q", "-j", "1", "-o", "new", "--set", AXIS], ["new"]),
    "gather": (["gather", "study"], []),
    "compare": (["compare", "small.yaml", "-q", "--methods", "ida3", "--rtol", "1e-3", "--repeats", "1", "-o", "new.nc"],
                ["new.nc"]),
    "info": (["info", "old.nc"], []),
    "info of a checkpoint": (["info", "old.ckpt"], []),
    "field": (["field", "old.nc", "-q", "--at", "0.04", "--grid", "4,4", "-o", "field.nc", "--force"], ["field.nc"]),
    "view": (["view", "old.nc", "-q", "-o", "new.html", "--force"], ["new.html"]),
    "export": (["export", "old.nc", "-q", "--vtk", "new"], ["new"]),
}
# those that find what they replace
REPLACING = ["resume", "run --force", "run with pressure", "run with threads", "steady", "field", "view"]
counts = {"passed": 0, "failed": 0}


def run(command, **settings):
    environment = dict(os.environ, LD_PRELOAD=shim, OMP_NUM_THREADS="1", **{f"MEMORY_{k}": v for k, v in settings.items()})
    return subprocess.run([program, *command], env=environment, timeout=300, stdin=subprocess.DEVNULL, capture_output=True,
                          text=True, errors="replace")


def prepare(name, made):
    """Remove what the command makes; what is resumed or replaced is as it was."""
    subprocess.run(["rm", "-rf", *made], check=True)
    for file in made if name in REPLACING else []:
        shutil.copy("kept/" + file, file)


def lost(name, made):
    """What is wrong with the results that a command has not replaced, or None."""
    for file in made:
        with open("kept/" + file, "rb") as kept:
            if os.path.exists(file) and open(file, "rb").read() == kept.read():
                continue
        if not name.startswith(("run", "resume")):
            return f"{file} is not what it was"
        if file == "new.nc":
            said = subprocess.run([program, "info", file], capture_output=True, text=True)
            if said.returncode != 0 or "none yet" in said.stdout:
                return f"{file} is neither what it was nor a result: {said.stderr}"
        elif name == "resume" and not os.path.exists(file):
            return f"{file} is gone"
    return None


def wrong(done):
    """What is wrong with the end of a command, or None."""
    if done.returncode == 0:
        return None
    if done.returncode not in (1, 4):
        return f"exit code {done.returncode}: {done.stderr}"
    said = done.stderr + (done.stdout if done.returncode == 1 else "")
    if "memory" not in said or "Traceback" in done.stderr:
        return f"message: {said!r}"
    left = [name for name in os.listdir(".") if ".part" in name]
    return f"it leaves {left}" if left else None


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    open("small.yaml", "w").write(CASE)
    for name in ("old", "new"):
        run(["run", "small.yaml", "-q", "-o", name + ".nc"]).check_returncode()
    open("steady.yaml", "w").write(STEADY)
    run(["steady", "steady.yaml", "-q"]).check_returncode()
    run(["field", "old.nc", "-q", "--grid", "3,3", "-o", "field.nc"]).check_returncode()
    run(["view", "old.nc", "-q", "-o", "new.html"]).check_returncode()
    subprocess.run("mkdir kept && mv new.* steady.nc field.nc kept", shell=True, check=True)
    run(["study", "small.yaml", "-q", "-o", "study", "--set", AXIS]).check_returncode()
    tried = 0
    for name, (command, made) in COMMANDS.items():
        prepare(name, made)
        if os.path.exists("counted"):
            os.remove("counted")
        done = run(command, COUNT="counted")
        assert done.returncode == 0, f"{name}: {done.stderr}"
        n = max(int(line) for line in open("counted"))
        found = 0
        for at in range(1, n + 1):
            tried += 1
            if tried % every:
                continue
            prepare(name, made)
            bad = wrong(done := run(command, AT=str(at)))
            if not bad and done.returncode != 0 and name in REPLACING:
                bad = lost(name, made)
            found += done.returncode != 0
            counts["failed" if bad else "passed"] += 1
            if bad:
                print(f"FAILED  {name}, allocation {at} of {n}: {bad.strip()}", flush=True)
        print(f"{name}: {n} allocations, {found} of those tried end with a message", flush=True)
    os.chdir("/")
print(f"{counts['passed']} passed, {counts['failed']} failed, 0 skipped")
sys.exit(counts["failed"] > 0)

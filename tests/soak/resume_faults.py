#!/usr/bin/python3
"""resume_faults.py PROGRAM SHIM: let calls of the system about a result and its checkpoints fail, one at a time
(tests/faults/shim.c), or kill the run there: what is left can be resumed, to the bits of the undisturbed run."""

import os
import subprocess
import sys
import tempfile

import netCDF4

program, shim = (os.path.abspath(path) for path in sys.argv[1:3])
CASE = """format: 1
time: {end: 0.3, shedding_interval: 0.02, output_interval: 0.04, checkpoint_interval: 0.04}
fish: [{force: reactive, nodes: 7, sheet_points: 21}]
"""
RUN = ["run", "case.yaml", "-o", "victim.nc"]
# how a call fails, and whether all later ones do; or the program is killed before or after it
WAYS = [("ENOSPC", "0"), ("EIO", "1"), ("before", "0"), ("after", "0")]
KILLED = (-9, 137)


def run(arguments, **settings):
    environment = dict(os.environ)
    if settings:
        environment.update(LD_PRELOAD=shim, FAULT_PATH="victim", **{f"FAULT_{k}": v for k, v in settings.items()})
    done = subprocess.run([program, *arguments, "-q"], env=environment, stdin=subprocess.DEVNULL, capture_output=True,
                          text=True, timeout=300)
    return done.returncode, done.stderr


def variables(path):
    with netCDF4.Dataset(path) as data:
        data.set_auto_mask(False)
        values = {name: data[name][...].tobytes() for name in data.variables if name != "wall_time"}
        return values, data.run_status.strip("\0")


def attempt(whole, **fault):
    """One run with a fault; what is wrong, or None."""
    for name in os.listdir("."):
        if name.startswith("victim"):
            os.unlink(name)
    code, message = run(RUN, **fault)
    if code not in (0, 4, *KILLED) or (code == 4 and message.count("shoal: error:") != 1):
        return f"exit code {code}: {message!r}"
    if not any(os.path.exists(name) for name in ("victim.ckpt", "victim.ckpt.previous")):
        return None if code != 0 else "exit code 0 without a checkpoint"
    if variables("victim.nc")[1] != "complete":
        code, message = run(["resume", "victim.ckpt"])
        if code != 0:
            return f"it cannot be resumed: exit code {code}: {message!r}"
    return None if variables("victim.nc")[0] == whole else "other bits"


counts = {True: 0, False: 0}
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    open("case.yaml", "w").write(CASE)
    code, message = run(RUN, AT="0", COUNT="counted")
    assert code == 0, message
    whole = variables("victim.nc")[0]
    numbers = [line.split() for line in open("counted")]
    for call, number in numbers:
        for at in range(1, int(number) + 1):
            for how, ever in WAYS:
                wrong = attempt(whole, CALL=call, AT=str(at), HOW=how, EVER=ever)
                counts[wrong is None] += 1
                if wrong:
                    print(f"FAILED  {call} {at} {how} ever={ever}: {wrong}", flush=True)
    os.chdir("/")
print(f"{counts[True]} passed, {counts[False]} failed, 0 skipped")
sys.exit(counts[False] > 0)

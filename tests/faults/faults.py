#!/usr/bin/python3
"""Let every call of the system fail that a run makes about its files, one at a time, and look at what is left.

    faults.py PROGRAM SHIM EVERY      EVERY: 1 tries all of them, n every n-th

Every other run finds the result of an earlier one, with its checkpoints, and has --force. After each fault the exit
code is 0 or 4 (killed: -9); on standard error is one message, with the path and the reason; the result is the earlier
one, byte for byte and with its checkpoints, or it has rows that are to the bit those of an undisturbed run, the first
one at least, and `shoal info` reads it. Where there is a checkpoint of the run, `shoal resume` ends in the bits of the
undisturbed run; a checkpoint of the earlier result beside the new one is refused.
Prints a line for what is wrong, and as the last one how many passed and failed.
"""
import os, resource, shutil, subprocess, sys, tempfile
import netCDF4
import numpy as np

program, shim, every = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2]), int(sys.argv[3])
CASE = """format: 1
name: victim
time: {end: 0.1, shedding_interval: 0.01, output_interval: 0.01, checkpoint_interval: 0.03}
fish: [{force: reactive, nodes: 9, sheet_points: 17, body: {tail_thickness: 0.3}}]
"""
CALLS = ["open", "read", "write", "pwrite", "lseek", "fsync", "ftruncate", "rename", "close"]
REASONS = {
    "ENOSPC": "No space left", "EIO": "Input/output error", "EDQUOT": "quota", "EINTR": "Interrupted", "limit": "too large"
}
counts = {"passed": 0, "failed": 0, "resumed": 0, "kept": 0}
EARLIER = ["victim.nc", "victim.ckpt", "victim.ckpt.previous"]


def run(extra=(), limit=None, **settings):
    """One run with a fault; exit code and what it printed."""
    def lower():
        if limit is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
    environment = dict(os.environ, LD_PRELOAD=shim, FAULT_PATH="victim.", **{f"FAULT_{k}": v for k, v in settings.items()})
    environment["ASAN_OPTIONS"] = "verify_asan_link_order=0:detect_leaks=0"
    done = subprocess.run(
        [program, "run", "case.yaml", "-q", *extra, "-o", "victim.nc"], env=environment, timeout=300,
        stdin=subprocess.DEVNULL, capture_output=True, text=True, preexec_fn=lower,
    )
    # every run of this case is shorter than two beats
    short = [line for line in done.stderr.splitlines(True) if "means and powers are not those of a cycle" not in line]
    return done.returncode, "".join(short)


def rows(path):
    """All variables with time, and the status."""
    with netCDF4.Dataset(path) as data:
        data.set_auto_mask(False)
        names = [name for name in data.variables if "time" in data[name].dimensions and name != "wall_time"]
        return data.run_status, {name: data[name][...] for name in names}


def same_bytes(one, other):
    with open(one, "rb") as a, open(other, "rb") as b:
        return a.read() == b.read()


def is_earlier():
    """Whether the result is the one that was there before, with its checkpoints."""
    if not os.path.exists("victim.nc") or not same_bytes("victim.nc", "earlier/victim.nc"):
        return False
    return all(os.path.exists(name) and same_bytes(name, "earlier/" + name) for name in EARLIER)


def wrong_with_file(code, least=0):
    """What is wrong with the result, which must have so many rows at least, or None."""
    status, found = rows("victim.nc")
    n = len(found["time"])
    if n < least:
        return f"{status} with {n} rows"
    if code == 0 and (status != "complete" or n != len(whole["time"])):
        return f"exit code 0, but {status} with {n} rows"
    if code != 0 and status == "complete" and n != len(whole["time"]):
        return f"complete with {n} rows"
    for name, values in whole.items():
        if found[name].shape[1:] != values.shape[1:] or found[name].tobytes() != values[:n].tobytes():
            return f"{name} is not that of an undisturbed run in {n} rows"
    read = subprocess.run([program, "info", "victim.nc"], stdin=subprocess.DEVNULL, capture_output=True, text=True)
    return None if read.returncode == 0 else f"info: {read.stderr}"


def wrong_with_resumption():
    """What is wrong after going on from the checkpoint, or None: there may be none yet, or nothing left to do."""
    if not any(os.path.exists(name) for name in ("victim.ckpt", "victim.ckpt.previous")):
        return None
    if os.path.exists("victim.nc") and rows("victim.nc")[0] == "complete":
        return None
    # killed after the new result has the name, before the checkpoints of the earlier one are gone: they are refused
    is_stale = all(not os.path.exists(name) or same_bytes(name, "earlier/" + name) for name in EARLIER[1:])
    done = subprocess.run(
        [program, "resume", "victim.ckpt", "-q"], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=300
    )
    if is_stale:
        if done.returncode != 4 or "another case than the checkpoint" not in done.stderr:
            return f"resume from a checkpoint of the earlier result: exit code {done.returncode}: {done.stderr}"
        return wrong_with_file(4)
    counts["resumed"] += 1
    return wrong_with_file(0) if done.returncode == 0 else f"resume: exit code {done.returncode}: {done.stderr}"


def check(name, reason, killed=False, **settings):
    """A run with a fault, and all that must hold after it."""
    for left in [name for name in os.listdir(".") if name.startswith("victim.")]:
        os.remove(left)
    finds_one = n % 2 == 0
    if finds_one:
        for left in EARLIER:
            shutil.copy("earlier/" + left, left)
    try:
        code, message = run(["--force"] if finds_one else [], **settings)
    except subprocess.TimeoutExpired:
        code, message = "none: it hangs", ""
    wrong = None
    if killed and code not in (-9, 0):
        wrong = f"exit code {code}"
    elif not killed and code not in (0, 4):
        wrong = f"exit code {code}: {message}"
    elif code == 4 and (message.count("\n") != 1 or "victim." not in message or reason not in message):
        wrong = f"message: {message!r}"
    elif code == 0 and message:
        wrong = f"exit code 0 with a message: {message!r}"
    elif finds_one and is_earlier():
        counts["kept"] += 1
        wrong = "exit code 0, but the result is the earlier one" if code == 0 else None
    elif os.path.exists("victim.nc"):
        wrong = wrong_with_file(code, 1 if finds_one else 0)
    elif finds_one:
        wrong = "the earlier result is gone"
    if not wrong and code != 0 and not (finds_one and is_earlier()):
        wrong = wrong_with_resumption()
    counts["failed" if wrong else "passed"] += 1
    if wrong:
        print(f"FAILED  {name}: {wrong.strip()}", flush=True)
    # a run that has not been killed leaves no half of a file
    if not killed and any(".part" in part for part in os.listdir(".")):
        counts["failed"] += 1
        print(f"FAILED  {name}: it leaves a file .part", flush=True)


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    open("case.yaml", "w").write(CASE)
    for extra in ([], ["--force"]):
        code, message = run(extra, AT="0", COUNT="counted")
        assert code == 0, message
        os.rename("victim.nc", "whole.nc")
        for left in [name for name in os.listdir(".") if name.startswith("victim.")]:
            os.remove(left)
    whole = rows("whole.nc")[1]
    # the result of another case, so that it cannot be taken for the new one
    os.mkdir("earlier")
    subprocess.run([program, "run", "case.yaml", "-q", "-o", "earlier/victim.nc", "--set", "fish[0].wave.amplitude=0.2"],
                   check=True)
    size = os.path.getsize("whole.nc")
    numbers = {}
    for call, number in (line.split() for line in open("counted")):
        numbers[call] = max(int(number), numbers.get(call, 0))
    n = 0
    for call in CALLS:
        ways = ["before", "after", *(w for w in REASONS if w != "limit"), *(["short"] if call in ("write", "pwrite") else [])]
        for at in range(1, numbers[call] + 1):
            for how in ways:
                # what is interrupted for ever is tried again for ever
                for ever in ("0",) if how in ("before", "after", "EINTR") else ("0", "1"):
                    n += 1
                    if n % every == 0:
                        check(f"{call} {at} {how} ever={ever}", REASONS.get(how, ""), how in ("before", "after"),
                              CALL=call, AT=str(at), HOW=how, EVER=ever)
    for limit in range(0, size, 257):
        n += 1
        if n % every == 0:
            check(f"files of at most {limit} bytes", REASONS["limit"], limit=limit)
    print("calls of a run:", ", ".join(f"{numbers[call]} {call}" for call in CALLS))
    print(f"{counts['resumed']} runs went on from a checkpoint; the earlier result was kept {counts['kept']} times")
    os.chdir("/")
print(f"{counts['passed']} passed, {counts['failed']} failed, 0 skipped")
sys.exit(counts["failed"] > 0)

#!/usr/bin/python3
"""Let every call of the system fail that a run makes about its files, one at a time, and look at what is left.

    faults.py PROGRAM [EVERY]      EVERY: 1 tries all of them (2100 runs), n every n-th

Every other run finds the result of an earlier one, with its checkpoints, and has --force. After each fault the exit
code is 0 or 4 (killed: -9); on standard error is one message, with the path and the reason; the result is the earlier
one, byte for byte and with its checkpoints, or it has rows that are to the bit those of an undisturbed run, the first
one at least, and `shoal info` reads it. Where there is a checkpoint of the run, `shoal resume` ends in the bits of the
undisturbed run; a checkpoint of the earlier result beside the new one is refused. A run that has not been killed leaves
no part."""
import os, resource, shutil, subprocess
from common import argument, build, counts, different, finish, judge, parts, same, shoal, succeed, values, write

every = argument(2, 1)
CASE = """format: 1
name: victim
time: {end: 0.1, shedding_interval: 0.01, output_interval: 0.01, checkpoint_interval: 0.03}
fish: [{force: reactive, nodes: 9, sheet_points: 17, body: {tail_thickness: 0.3}}]
"""
CALLS = ["open", "read", "write", "pwrite", "lseek", "fsync", "ftruncate", "rename", "close"]
REASONS = {"ENOSPC": "No space left", "EIO": "Input/output error", "EDQUOT": "quota", "EINTR": "Interrupted"}
EARLIER = ["victim.nc", "victim.ckpt", "victim.ckpt.previous"]


def run(*extra, limits=(), **settings):
    done = shoal("run", "case.yaml", "-q", *extra, "-o", "victim.nc", limits=limits, LD_PRELOAD=build + "/files.so",
                 FAULT_PATH="victim.", **{f"FAULT_{k}": v for k, v in settings.items()})
    # every run of this case is shorter than two beats
    short = [line for line in done.stderr.splitlines(True) if "means and powers are not those of a cycle" not in line]
    return done.returncode, "".join(short)


def remove_all():
    for left in [name for name in os.listdir(".") if name.startswith("victim.")]:
        os.remove(left)


def wrong_with_file(code, least=0):
    """What is wrong with the result, which must have so many rows at least, or None."""
    status, found = values("victim.nc")
    n = len(found["time"])
    is_whole = n == len(whole["time"])
    if n < least or code == 0 and (status != "complete" or not is_whole) or status == "complete" and not is_whole:
        return f"exit code {code}, {status} with {n} rows"
    names = different("victim.nc", whole, rows=True)
    return f"other bits in {', '.join(names)}" if names else shoal("info", "victim.nc").stderr


def wrong_with_resumption():
    """What is wrong after going on from the checkpoint, or None: there may be none yet, or nothing left to do."""
    if not any(os.path.exists(name) for name in EARLIER[1:]):
        return None
    if os.path.exists("victim.nc") and values("victim.nc")[0] == "complete":
        return None
    # killed after the new result has the name, before the checkpoints of the earlier one are gone: they are refused
    is_stale = all(not os.path.exists(name) or same(name, "earlier/" + name) for name in EARLIER[1:])
    done = shoal("resume", "victim.ckpt", "-q")
    if is_stale and done.returncode == 4 and "another case than the checkpoint" in done.stderr:
        return wrong_with_file(4)
    if is_stale or done.returncode != 0:
        return f"resume from {'the earlier' if is_stale else 'its'} checkpoint: exit code {done.returncode}: {done.stderr}"
    counts["resumed"] += 1
    return wrong_with_file(0)


def wrong_after(finds_one, reason, killed, **fault):
    """What is wrong after a run with a fault, or None."""
    try:
        code, message = run(*(["--force"] if finds_one else []), **fault)
    except subprocess.TimeoutExpired:
        return "it hangs"
    if code not in (0, -9 if killed else 4):
        return f"exit code {code}: {message}"
    if code == 0 and message or code == 4 and (message.count("\n") != 1 or "victim." not in message or reason not in message):
        return f"exit code {code}, message: {message!r}"
    if not killed and parts():
        return f"it leaves {parts()}"
    if finds_one and all(same(name, "earlier/" + name) for name in EARLIER):
        counts["kept"] += 1
        return "exit code 0, but the result is the earlier one" if code == 0 else None
    if finds_one and not os.path.exists("victim.nc"):
        return "the earlier result is gone"
    wrong = wrong_with_file(code, 1 if finds_one else 0) if os.path.exists("victim.nc") else None
    return wrong or (wrong_with_resumption() if code != 0 else None)


def faults(numbers, size):
    """Name, reason and settings of each fault."""
    for call in CALLS:
        ways = ["before", "after", *REASONS, *(["short"] if call in ("write", "pwrite") else [])]
        for at in range(1, numbers[call] + 1):
            for how in ways:
                # what is interrupted for ever is tried again for ever
                for ever in ("0",) if how in ("before", "after", "EINTR") else ("0", "1"):
                    yield f"{call} {at} {how} ever={ever}", REASONS.get(how, ""), {"CALL": call, "AT": str(at), "HOW": how, "EVER": ever}
    for limit in range(0, size, 257):
        yield f"files of at most {limit} bytes", "too large", {"limits": [(resource.RLIMIT_FSIZE, limit)]}


write("case.yaml", CASE)
for extra in ([], ["--force"]):
    assert run(*extra, AT="0", COUNT=os.path.abspath("counted")) == (0, "")
    os.rename("victim.nc", "whole.nc")
    remove_all()
whole = values("whole.nc")[1]
numbers = {}
with open("counted") as lines:
    for call, number in map(str.split, lines):
        numbers[call] = max(int(number), numbers.get(call, 0))
# the result of another case, so that it cannot be taken for the new one
os.mkdir("earlier")
succeed("run", "case.yaml", "-q", "-o", "earlier/victim.nc", "--set", "fish[0].wave.amplitude=0.2")
for n, (name, reason, fault) in enumerate(faults(numbers, os.path.getsize("whole.nc")), 1):
    if n % every:
        continue
    remove_all()
    if n % 2 == 0:
        for left in EARLIER:
            shutil.copy("earlier/" + left, left)
    judge(name, wrong_after(n % 2 == 0, reason, fault.get("HOW") in ("before", "after"), **fault))
print("calls of a run:", ", ".join(f"{numbers[call]} {call}" for call in CALLS))
print(f"{counts['resumed']} runs went on from a checkpoint; the earlier result was kept {counts['kept']} times")
finish()

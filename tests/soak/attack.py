#!/usr/bin/python3
"""attack.py PROGRAM [SEED]: hostile case files, crafted results and checkpoints, and kills of every command. Each must end
within its limits of CPU time, memory and file size, with a documented exit code; a refusal has one message; a kill leaves
neither half of a file nor a changed input. Prints a line for each failure, and as the last one how many passed and failed."""

import os
import random
import resource
import shutil
import signal
import subprocess
import time

from common import argument, finish, judge, program, read, shoal, succeed, write

random.seed(argument(2, 1))
CODES = {0, 1, 2, 3, 4, 75}
CPU, MEMORY = 20, 1 << 30  # seconds and bytes of one command

FISH = "fish: [{name: a}]\n"
CASE = "format: 1\ntime: {end: 0.1, shedding_interval: 0.01, output_interval: 0.02, checkpoint_interval: 0.05}\n" + FISH


def attack(name, *arguments):
    """Run a command on hostile input and judge its end."""
    done = shoal(*arguments, limits=[(resource.RLIMIT_CPU, CPU), (resource.RLIMIT_AS, MEMORY)], OMP_NUM_THREADS="1")
    message, wrong = done.stderr, None
    if done.returncode not in CODES or done.returncode not in (0, 75) and not message.strip():
        wrong = f"exit code {done.returncode}: {message}"
    elif "out of memory" in message:
        wrong = f"a case that fits no memory passed the checks: {message}"
    elif "nan" in message.lower().split() and done.returncode == 0:
        wrong = f"nan in a message of success: {message}"
    judge(name, wrong)


# ---- case files

# every number of a case, and values that no size, ratio or loop may follow blindly
NUMBERS = ["time.end", "time.shedding_interval", "time.output_interval", "time.checkpoint_interval", "solver.rtol",
           "solver.max_steps", "wake.lifetime", "wake.smoothing", "fluid.density", "fluid.viscosity", "fish[0].nodes",
           "fish[0].sheet_points", "fish[0].length", "fish[0].body.depth", "fish[0].body.thickness", "fish[0].body.modulus",
           "fish[0].body.density", "fish[0].wave.frequency", "fish[0].wave.amplitude", "fish[0].start.speed",
           "fluid.shear", "fluid.gust.amplitude", "wake.decay", "fish[0].body.relaxation_time"]
VALUES = ["0", "-1", "1e-300", "1e300", ".inf", "-.inf", ".nan", "1e-6", "2147483648", "4.5"]

TEXTS = {
    "nothing": b"", "a comment": b"# format: 1\n", "100,000 documents": 100000 * b"---\n",
    "a byte of zero": b"format: 1\n\0" + FISH.encode(), "a mark of UTF-8": b"\xef\xbb\xbf" + CASE.encode(),
    "UTF-16": CASE.encode("utf-16"), "broken UTF-8": b"format: 1\nname: \xff\xfe\n" + FISH.encode(),
    "carriage returns": CASE.replace("\n", "\r\n").encode(), "tabs": CASE.replace("time: {", "time:\t{").encode(),
    "control characters": b"format: 1\nname: \"\\e[31m\\a\"\n" + FISH.encode(), "a scalar": b"format", "a list": b"- format: 1\n",
    "two documents": (CASE + "---\n" + CASE).encode(), "an open bracket": b"format: 1\nfish: [",
    "an open quote": b"format: 1\nname: \"a", "an anchor without a node": b"format: *x\n",
    "an anchor in itself": b"format: 1\nfish: &x [*x]\n", "a tag": b"format: !!python/object 1\n" + FISH.encode(),
    "a key twice": b"format: 1\nformat: 1\n" + FISH.encode(), "a key of a map": b"{{a: 1}: 2}: 3\n",
    "an empty key": b"format: 1\n'': 1\n" + FISH.encode(), "a merge key": b"format: 1\n<<: {format: 1}\n" + FISH.encode(),
    "no fish": b"format: 1\nfish: []\n", "a fish of no map": b"format: 1\nfish: [1, [], null]\n",
    "another format": b"format: 99\n" + FISH.encode(), "a format that is text": b"format: one\n" + FISH.encode(),
    "itself": b"format: 1\ninclude: [case.yaml]\n", "a folder": b"format: 1\ninclude: [/]\n",
    "a device": b"format: 1\ninclude: [/dev/zero]\n", "a file that is not there": b"format: 1\ninclude: [none.yaml]\n",
    "10,000 levels of lists": b"format: 1\nfish: " + 10000 * b"[" + 10000 * b"]", "10,000 levels of maps": 10000 * b"{a: ",
    "a thousand million by anchors": b"format: 1\na: &a [x,x,x,x,x,x,x,x,x,x]\n" +
    b"".join(b"%c: &%c [*%c,*%c,*%c,*%c,*%c,*%c,*%c,*%c,*%c,*%c]\n" % ((98 + i, 98 + i) + 10 * (97 + i,)) for i in range(9)),
    "a name of a million letters": b"format: 1\nname: " + 1000000 * b"a" + b"\n" + FISH.encode(),
    "a key of a million letters": b"format: 1\n" + 1000000 * b"a" + b": 1\n" + FISH.encode(),
    "a path of ten thousand letters": b"format: 1\noutput: {file: " + 10000 * b"a" + b".nc}\n" + FISH.encode(),
    "a path upwards": b"format: 1\noutput: {file: ../../../../../none/there.nc}\n" + FISH.encode(),
    "a formula of the format": b"format: 1\nname: '%s%n%s'\n" + FISH.encode(),
    "a number of a million digits": b"format: 1\ntime: {end: " + 1000000 * b"9" + b"}\n" + FISH.encode(),
    "100,000 fish of nothing": b"format: 1\nfish: [" + 100000 * b"{}," + b"]\n",
    "100,000 waypoints": b"format: 1\nfish: [{control: {law: course, waypoints: [" + 100000 * b"[1,1]," + b"]}}]\n",
    "a sweep of a thousand million": CASE.encode() + b"sweep: [" + b",".join(
        b"{key: 'fish[0].wave.phase', values: [" + b",".join(b"%d" % i for i in range(1000)) + b"]}" for _ in range(3)) + b"]\n",
    "a sweep of 6000 values": CASE.encode() + b"sweep: [{key: 'fish[0].wave.phase', values: %s}]\n" % str([*range(6000)]).encode(),
    "a sweep of nothing": CASE.encode() + b"sweep: [{key: 'fish[0].nodes', values: []}]\n",
    "a sweep of a sweep": CASE.encode() + b"sweep: [{key: sweep, values: [1]}]\n",
    "a fish too many": CASE.encode() + b"sweep: [{key: 'fish[7].nodes', values: [5, 7]}]\n",
    "an expectation of nothing": CASE.encode() + b"expect: [{of: nothing, most: 1}]\n",
}


def attack_cases():
    for name, text in TEXTS.items():
        write("case.yaml", text)
        attack(f"check of {name}", "check", "case.yaml")
        attack(f"run of {name}", "run", "case.yaml", "-q", "--force", "-o", "text.nc", "--max-wall", "5")
    write("case.yaml", CASE)
    for change in [f"--set={key}={value}" for key in NUMBERS for value in VALUES]:
        attack(f"check with {change}", "check", "case.yaml", change)
        attack(f"run with {change}", "run", "case.yaml", "-q", "--force", "-o", "text.nc", "--max-wall", "5", change)
    print(f"{len(TEXTS) + len(NUMBERS) * len(VALUES)} cases")


# ---- results and checkpoints

def crafted(bytes_of_file, i):
    """A file with flipped bits, a size of its header, a cut or an insertion."""
    data = bytearray(bytes_of_file)
    way = i % 6
    if way == 0:
        for _ in range(random.randint(1, 40)):
            data[random.randrange(len(data))] ^= 1 << random.randrange(8)
    elif way == 1:
        at = 4 * random.randrange(min(len(data), 4096) // 4)
        data[at:at + 4] = random.choice([b"\xff\xff\xff\xff", b"\x7f\xff\xff\xff", b"\0\0\0\0", b"\x80\0\0\0"])
    elif way == 2:
        del data[random.randrange(len(data)):]
    elif way == 3:
        at = random.randrange(len(data))
        data[at:at] = os.urandom(random.randint(1, 64))
    elif way == 4:
        at = 8 * random.randrange(min(len(data), 4096) // 8)
        data[at:at + 8] = random.getrandbits(64).to_bytes(8, "big")
    else:
        at = random.randrange(len(data))
        data[at:at + 256] = bytes(len(data[at:at + 256]))
    return bytes(data)


def attack_files():
    succeed("run", "case.yaml", "-q", "--force", "-o", "good.nc")
    reading = [["info"], ["info", "--json"], ["view", "-q", "--force", "-o", "x.html"],
               ["export", "-q", "--force", "--vtk", "vtk"], ["field", "-q", "--force", "--at", "0.04", "--grid", "4,4"]]
    kept = {name: read(name) for name in ("good.nc", "good.ckpt")}
    for i in range(150):
        write("bad.nc", crafted(kept["good.nc"], i))
        command, *options = reading[i % len(reading)]
        attack(f"crafted result {i}: {command}", command, "bad.nc", *options)
    for i in range(81):
        shutil.rmtree("twin", ignore_errors=True)
        os.mkdir("twin")
        name = "good.ckpt" if i % 3 else "good.nc"
        for other, data in kept.items():
            write("twin/" + other, crafted(data, i) if other == name else data)
        attack(f"crafted {name} {i}: resume", "resume", "twin/good.ckpt", "-q", "--end", "0.12")
        judge("files beside the attacked folder", [name for name, data in kept.items() if read(name) != data])


# ---- kills

def attack_by_signals():
    """Signals at random times; the case makes every command take seconds."""
    write("long.yaml", CASE.replace("end: 0.1", "end: 20").replace("checkpoint_interval: 0.05", "checkpoint_interval: 1"))
    write("many.yaml", CASE + "sweep: [{key: 'fish[0].wave.phase', values: [0, 40, 80, 120]}]\n")
    write("fine.yaml", "format: 1\ntime: {end: 1}\nfish: [{nodes: 199}]\n")
    commands = [["run", "long.yaml", "-o", "long.nc", "--force"], ["study", "many.yaml", "-o", "many", "--force"],
                ["steady", "case.yaml", "-o", "steady.nc", "--force"], ["run", "fine.yaml", "-o", "fine.nc", "--force"],
                ["check", "fine.yaml"], ["error", "case.yaml", "--of", "speed", "-o", "bars", "--force"]]
    for i in range(42):
        command, number = commands[i % len(commands)], random.choice([signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
        process = subprocess.Popen([program, *command, "-q"], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE, start_new_session=True)
        time.sleep(random.uniform(0.2, 2))  # the program listens after some milliseconds
        process.send_signal(number)
        begun = time.monotonic()
        try:
            message = process.communicate(timeout=60)[1].decode(errors="replace")
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            message = process.communicate()[1].decode(errors="replace") + "still running 60 s after the signal"
        codes = CODES | {-number} if number == signal.SIGKILL or command[0] in ("check", "error", "study") else CODES
        wrong = process.returncode not in codes or "still running" in message
        judge(f"{command} with {number.name}", wrong and
              f"{time.monotonic() - begun:.1f} s after the signal: {process.returncode} {message}")
        if os.path.exists("long.nc"):
            attack(f"info after {number.name}", "info", "long.nc")


attack_cases()
attack_files()
attack_by_signals()
finish()

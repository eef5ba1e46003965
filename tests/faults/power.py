#!/usr/bin/python3
"""Cut the power at random places of runs with checkpoints, and look whether a run is lost.

    power.py PROGRAM RECORDER CUTS [SEED]

The recorder (tests/faults/power.c) logs every change of the files of a run. A power cut leaves what was synchronised
before it. Of the rest it leaves any part: each write is kept, dropped or torn at the border of a sector, whatever became of
the writes before it; each change of a name is kept or dropped. The scenarios are a run, a run that is resumed, one that is
extended, and one that replaces the result of another case.

After each cut `shoal info` reads the result or refuses it with a message. If a checkpoint had been completed, the run is
resumed to the bits of the run that was not interrupted. A run that replaces another one leaves one of them. Prints a line
for what is wrong, and as the last one how many passed and failed.
"""
import collections, os, random, shutil, struct, subprocess, sys, tempfile
import netCDF4

program, recorder, n_cuts = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2]), int(sys.argv[3])
random.seed(int(sys.argv[4]) if len(sys.argv) > 4 else 1)
SECTOR = 512
CASE = """format: 1
name: victim
time: {end: 0.16, shedding_interval: 0.01, output_interval: 0.01, checkpoint_interval: 0.04}
fish: [{force: reactive, nodes: 9, sheet_points: 17, body: {tail_thickness: 0.3}}]
"""
KINDS = ["create", "write", "truncate", "sync", "sync folder", "rename", "unlink"]
Entry = collections.namedtuple("Entry", "kind inode offset length name other data")
LEFT = ["victim.nc", "victim.ckpt", "victim.ckpt.previous"]


def shoal(*arguments, **environment):
    # the address sanitizer accepts a preloaded library in front of it
    environment["ASAN_OPTIONS"] = "verify_asan_link_order=0:detect_leaks=0"
    done = subprocess.run([program, *arguments], env={**os.environ, **environment}, stdin=subprocess.DEVNULL,
                          capture_output=True, text=True, errors="replace", timeout=300)
    return done.returncode, done.stderr


def read_log(path):
    entries = []
    with open(path, "rb") as log:
        while head := log.read(32 + 256):
            kind, inode, offset, length = struct.unpack("4Q", head[:32])
            name, other = (head[at : at + 128].split(b"\0")[0].decode() for at in (32, 160))
            data = log.read(length) if KINDS[kind] == "write" else b""
            entries.append(Entry(KINDS[kind], inode, offset, length, name, other, data))
    return entries


# ---- a disk


class File:
    """What is safe of a file, and the changes after that."""

    def __init__(self, data=b""):
        self.safe, self.pending = bytearray(data), []

    def change(self, data, entry):
        if entry.kind == "truncate":
            del data[entry.offset :]
            data.extend(bytes(entry.offset - len(data)))
            return
        end = entry.offset + len(entry.data)
        data.extend(bytes(max(0, end - len(data))))
        data[entry.offset : end] = entry.data

    def sync(self):
        for entry in self.pending:
            self.change(self.safe, entry)
        self.pending = []

    def after_cut(self, chance):
        """The bytes that are there after a power cut."""
        data = bytearray(self.safe)
        for entry in self.pending:
            if random.random() < chance:
                self.change(data, entry)
            elif entry.kind == "write" and random.random() < 0.5:
                self.tear(data, entry, chance)
        return bytes(data)

    def tear(self, data, entry, chance):
        """Keep some of the sectors of a write."""
        at = entry.offset
        end = at + len(entry.data)
        while at < end:
            border = min(end, (at // SECTOR + 1) * SECTOR)
            if random.random() < chance:
                part = entry.data[at - entry.offset : border - entry.offset]
                self.change(data, entry._replace(offset=at, data=part))
            at = border


class Disk:
    """A folder: the names that are safe, and the changes of names after that."""

    def __init__(self, files):
        self.files = {-1 - i: File(data) for i, data in enumerate(files.values())}
        self.names = dict(zip(files, self.files))
        self.now = dict(self.names)
        self.pending = []
        self.inodes = {}

    def number(self, inode, name=None):
        """The file of an inode: a number that is not used again; a file that was there before has a name."""
        if inode not in self.inodes:
            self.inodes[inode] = self.now[name]
        return self.inodes[inode]

    def do(self, entry, inode_of):
        if entry.kind == "create":
            number = len(self.files) + 1
            self.files[number] = File()
            self.inodes[entry.inode] = number
            self.rename((None, entry.name, number))
        elif entry.kind in ("write", "truncate", "sync"):
            file = self.files[self.number(entry.inode, inode_of.get(entry.inode))]
            file.sync() if entry.kind == "sync" else file.pending.append(entry)
        elif entry.kind == "sync folder":
            self.names, self.pending = dict(self.now), []
        elif entry.kind == "unlink":
            self.rename((entry.name, None, None))
        else:
            self.rename((entry.name if entry.kind == "rename" else None, entry.other, self.now[entry.name]))

    @staticmethod
    def apply(names, change):
        away, name, number = change
        if away:
            names.pop(away, None)
        if name:
            names[name] = number

    def rename(self, change):
        self.apply(self.now, change)
        self.pending.append(change)

    def after_cut(self):
        """What is there after a power cut: {name: bytes}."""
        chance = random.choice([0, 0.2, 0.5, 0.8, 1])
        names = dict(self.names)
        for change in self.pending:
            if random.random() < chance:
                self.apply(names, change)
        return {name: self.files[number].after_cut(chance) for name, number in names.items()}


# ---- checks


def values(path):
    with netCDF4.Dataset(path) as data:
        data.set_auto_mask(False)
        return data.run_status.strip("\0"), {name: data[name][...].tobytes() for name in data.variables if name != "wall_time"}


def same(name):
    with open(name, "rb") as one, open("../earlier/" + name, "rb") as other:
        return one.read() == other.read()


def is_earlier():
    return all(os.path.exists(name) and same(name) for name in LEFT)


def continue_with(command, whole):
    """What is wrong with a run that is resumed, or None."""
    code, message = shoal(*command, "-q")
    if code == 2 and "--end 0.24: the checkpoint is at t = 0.24 s already" in message:
        code, message = shoal("resume", "victim.ckpt", "-q")
    if code == 2 and "is complete" in message:
        code = 0
    if code != 0:
        return f"it cannot be resumed: exit code {code}: {message}"
    status, found = values("victim.nc")
    wrong = [name for name in whole if whole[name] != found.get(name)]
    return f"{status}, other bits in {', '.join(wrong)}" if wrong or status != "complete" else None


def wrong(scenario, has_checkpoint):
    """What is wrong with the files of the folder after a cut, or None."""
    if os.path.exists("victim.nc"):
        code, message = shoal("info", "victim.nc")
        if code not in (0, 4) or (code == 4) != bool(message):
            return f"info: exit code {code}: {message}"
        if code == 4:
            return f"the result cannot be read: {message}"
    if scenario.replaces:
        if is_earlier():
            return None
        if not os.path.exists("victim.nc"):
            return "neither the earlier result is there nor the new one"
        if same("victim.nc"):
            return "the earlier result has lost its checkpoints"
    if has_checkpoint:
        return continue_with(scenario.again, scenario.whole)
    code, message = shoal(*scenario.command, *([] if "--force" in scenario.command else ["--force"]), "-q")
    return f"it cannot begin again: exit code {code}: {message}" if code != 0 else None


# ---- scenarios

Scenario = collections.namedtuple("Scenario", "name before command again whole replaces entries inode_of needs")


def record(name, prepare, command, again, replaces=False):
    """Run a command on what prepare makes, and log it."""
    for file in os.listdir("."):
        os.unlink(file)
    shutil.copy("../case.yaml", "case.yaml")
    prepare()
    files = [file for file in sorted(os.listdir(".")) if file != "case.yaml"]
    before = {file: open(file, "rb").read() for file in files}
    inode_of = {os.stat(file).st_ino: file for file in files}
    shutil.rmtree("../earlier", ignore_errors=True)
    shutil.copytree(".", "../earlier")
    if os.path.exists("../log"):
        os.unlink("../log")
    code, message = shoal(*command, "-q", LD_PRELOAD=recorder, POWER_LOG=os.path.abspath("../log"), POWER_PATH="victim")
    assert code == 0, message
    entries = read_log("../log")
    # a checkpoint is there once its name is safe, or before the command begins
    renames = [i for i, entry in enumerate(entries) if entry.kind == "rename" and entry.other == "victim.ckpt"]
    needs = 0 if before and not replaces else next(
        i for i, entry in enumerate(entries) if entry.kind == "sync folder" and i > renames[0]) + 1
    return Scenario(name, before, command, again, values("victim.nc")[1], replaces, entries, inode_of, needs)


def stopped():
    """A run as a kill leaves it: without its last rows, and with two checkpoints."""
    assert shoal("run", "case.yaml", "-q", "--set", "time.end=0.12")[0] == 0
    for name in "victim.ckpt", "victim.ckpt.previous":
        shutil.copy(name, "../" + name)
    os.unlink("victim.nc")
    for name in "victim.ckpt", "victim.ckpt.previous":
        os.unlink(name)
    assert shoal("run", "case.yaml", "-q")[0] == 0
    # the checkpoint at 0.12 s is the one before the last
    os.rename("victim.ckpt.previous", "victim.ckpt")
    with open("victim.nc", "r+b") as file:
        file.truncate(os.path.getsize("victim.nc") - 100)


def complete():
    assert shoal("run", "case.yaml", "-q")[0] == 0


def other_case():
    assert shoal("run", "case.yaml", "-q", "--set", "fish[0].wave.amplitude=0.2")[0] == 0


SCENARIOS = [
    ("run", lambda: None, ["run", "case.yaml"], ["resume", "victim.ckpt"]),
    ("resume", stopped, ["resume", "victim.ckpt"], ["resume", "victim.ckpt"]),
    ("extend", complete, ["resume", "victim.ckpt", "--end", "0.24"], ["resume", "victim.ckpt", "--end", "0.24"]),
    ("replace", other_case, ["run", "case.yaml", "--force"], ["resume", "victim.ckpt"], True),
]
counts = {"passed": 0, "failed": 0}
with tempfile.TemporaryDirectory() as folder:
    os.makedirs(folder + "/here")
    open(folder + "/case.yaml", "w").write(CASE)
    os.chdir(folder + "/here")
    for arguments in SCENARIOS:
        scenario = record(*arguments)
        n_resumed = 0
        for i in range(n_cuts // len(SCENARIOS)):
            cut = random.randrange(len(scenario.entries) + 1)
            disk = Disk(scenario.before)
            for entry in scenario.entries[:cut]:
                disk.do(entry, scenario.inode_of)
            for file in os.listdir("."):
                os.unlink(file)
            shutil.copy("../case.yaml", "case.yaml")
            for name, data in disk.after_cut().items():
                open(name, "wb").write(data)
            n_resumed += cut >= scenario.needs
            bad = wrong(scenario, cut >= scenario.needs)
            if not bad and not (scenario.replaces and is_earlier()) and [name for name in os.listdir(".") if name.endswith(".part")]:
                bad = f"{os.listdir('.')} are left"
            counts["failed" if bad else "passed"] += 1
            if bad:
                print(f"FAILED  {scenario.name}, cut {i} behind {cut} of {len(scenario.entries)} changes: {bad.strip()}",
                      flush=True)
        print(f"{scenario.name}: {len(scenario.entries)} changes of files; {n_cuts // len(SCENARIOS)} cuts, {n_resumed} of "
              "them with a checkpoint", flush=True)
    os.chdir("/")
print(f"{counts['passed']} passed, {counts['failed']} failed, 0 skipped")
sys.exit(counts["failed"] > 0)

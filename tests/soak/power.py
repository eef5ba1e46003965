#!/usr/bin/python3
"""Cut the power at random places of runs with checkpoints, and look whether a run is lost.

    power.py PROGRAM [CUTS [SEED]]

The log of tests/faults/files.c has every change of the files of a run. A power cut leaves what was synchronised before
it. Of the rest it leaves any part: each write is kept, dropped or torn at the border of a sector, whatever became of the
writes before it; each change of a name is kept or dropped. The scenarios are a run, a run that is resumed, one that is
extended, and one that replaces the result of another case.

After each cut `shoal info` reads the result or refuses it with a message. If a checkpoint had been completed, the run is
resumed to the bits of the run that was not interrupted. A run that replaces another one leaves one of them."""
import collections, os, random, shutil, struct
from common import argument, build, different, finish, judge, parts, read, same, shoal, succeed, values, write

n_cuts = argument(2, 1000)
random.seed(argument(3, 1))
SECTOR = 512
CASE = """format: 1
name: victim
time: {end: 0.16, shedding_interval: 0.01, output_interval: 0.01, checkpoint_interval: 0.04}
fish: [{force: reactive, nodes: 9, sheet_points: 17, body: {tail_thickness: 0.3}}]
"""
KINDS = ["create", "write", "truncate", "sync", "sync folder", "rename", "unlink"]
Entry = collections.namedtuple("Entry", "kind inode offset length name other data")
LEFT = ["victim.nc", "victim.ckpt", "victim.ckpt.previous"]


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


def is_earlier():
    return all(same(name, "../earlier/" + name) for name in LEFT)


def continue_with(command, whole):
    """What is wrong with a run that is resumed, or None."""
    done = shoal(*command, "-q")
    if done.returncode == 2 and "--end 0.24: the checkpoint is at t = 0.24 s already" in done.stderr:
        done = shoal("resume", "victim.ckpt", "-q")
    if done.returncode != 0 and not (done.returncode == 2 and "is complete" in done.stderr):
        return f"it cannot be resumed: exit code {done.returncode}: {done.stderr}"
    names, status = different("victim.nc", whole), values("victim.nc")[0]
    return f"{status}, other bits in {', '.join(names)}" if names or status != "complete" else None


def wrong(scenario, has_checkpoint):
    """What is wrong with the files of the folder after a cut, or None."""
    if os.path.exists("victim.nc") and (done := shoal("info", "victim.nc")).returncode != 0:
        return f"info: exit code {done.returncode}: {done.stderr}"
    if scenario.replaces:
        if is_earlier():
            return None
        if not os.path.exists("victim.nc"):
            return "neither the earlier result is there nor the new one"
        if same("victim.nc", "../earlier/victim.nc"):
            return "the earlier result has lost its checkpoints"
    if has_checkpoint:
        bad = continue_with(scenario.again, scenario.whole)
    else:
        done = shoal(*scenario.command, *([] if "--force" in scenario.command else ["--force"]), "-q")
        bad = f"it cannot begin again: exit code {done.returncode}: {done.stderr}" if done.returncode else None
    return bad or (f"{parts()} are left" if parts() else None)


# ---- scenarios

Scenario = collections.namedtuple("Scenario", "name before command again whole replaces entries inode_of needs")


def renew(files):
    """Let the folder have the case and these files."""
    for name in os.listdir("."):
        os.unlink(name)
    for name, data in {"case.yaml": CASE, **files}.items():
        write(name, data)


def record(name, prepare, command, again, replaces=False):
    """Run a command on what prepare makes, and log it."""
    renew({})
    prepare()
    before = {file: read(file) for file in sorted(os.listdir(".")) if file != "case.yaml"}
    inode_of = {os.stat(file).st_ino: file for file in before}
    shutil.rmtree("../earlier", ignore_errors=True)
    shutil.copytree(".", "../earlier")
    if os.path.exists("../log"):
        os.unlink("../log")
    succeed(*command, "-q", LD_PRELOAD=build + "/files.so", FAULT_LOG=os.path.abspath("../log"), FAULT_PATH="victim")
    entries = read_log("../log")
    # a checkpoint is there once its name is safe, or before the command begins
    renames = [i for i, entry in enumerate(entries) if entry.kind == "rename" and entry.other == "victim.ckpt"]
    needs = 0 if before and not replaces else next(
        i for i, entry in enumerate(entries) if entry.kind == "sync folder" and i > renames[0]) + 1
    return Scenario(name, before, command, again, values("victim.nc")[1], replaces, entries, inode_of, needs)


def stopped():
    """A run as a kill leaves it: without its last rows, and with its checkpoint at 0.12 s, the one before the last."""
    succeed("run", "case.yaml", "-q")
    os.rename("victim.ckpt.previous", "victim.ckpt")
    os.truncate("victim.nc", os.path.getsize("victim.nc") - 100)


RESUME, EXTEND = ["resume", "victim.ckpt"], ["resume", "victim.ckpt", "--end", "0.24"]
SCENARIOS = [
    ("run", lambda: None, ["run", "case.yaml"], RESUME),
    ("resume", stopped, RESUME, RESUME),
    ("extend", lambda: succeed("run", "case.yaml", "-q"), EXTEND, EXTEND),
    ("replace", lambda: succeed("run", "case.yaml", "-q", "--set", "fish[0].wave.amplitude=0.2"),
     ["run", "case.yaml", "--force"], RESUME, True),
]
os.mkdir("here")
os.chdir("here")
for arguments in SCENARIOS:
    scenario, n_resumed, n = record(*arguments), 0, n_cuts // len(SCENARIOS)
    for i in range(n):
        cut = random.randrange(len(scenario.entries) + 1)
        disk = Disk(scenario.before)
        for entry in scenario.entries[:cut]:
            disk.do(entry, scenario.inode_of)
        renew(disk.after_cut())
        n_resumed += cut >= scenario.needs
        judge(f"{scenario.name}, cut {i} behind {cut} of {len(scenario.entries)} changes", wrong(scenario, cut >= scenario.needs))
    print(f"{scenario.name}: {len(scenario.entries)} changes of files; {n} cuts, {n_resumed} of them with a checkpoint", flush=True)
os.chdir("..")
finish()

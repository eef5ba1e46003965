#!/usr/bin/python3
"""Run the commands of tests/data/outputs.txt and compare the whole outputs.

    tests/app/outputs.py PROGRAM [--write]

The table has cases ("== NAME", then the text of the file) and commands ("$ ARGUMENTS" of the program, "$ sums FILE or
FOLDER", "$ text FILE", "$ cut FILE BYTES" at its end, then the output; lines of standard error start with "! ", a last line "= N" is an exit code other than 0).
Numbers agree to one and a half units of the last digit and to 1e-3, small differences to 0.3. --write replaces the outputs. The commands run in the
current folder.
"""

import base64
import json
import os
import re
import shlex
import struct
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
TABLE = os.path.join(ROOT, "tests/data/outputs.txt")
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*(?:e[-+]?\d+)?|nan|inf)(?![A-Za-z_])")

# Parts of lines that depend on the machine, on the version or on the time; and counts of the steps of an integrator,
# which depend on rounding. Both are compared without numbers.
FREE = (
    r"^! (?!t ).* s left .*",  # progress of a study: the number of lines too
    r"(?<=%)  .* steps/event",
    r"^! beat .*",
    r"about [^:]* on this machine|about .* at once",
    r"(?<= )[\d.]+ +[\d.-]+ +\d+ +\d+ +\d+ +\d+ +[\d.]+(?=  (complete|failed))",  # of a setting of a comparison
    r"(?<= )[-+\d.e]+ +\d+ +\d+ +[\d.]+(?=  (complete|failed|missing))",  # balance, counts and wall time of a member
    r"(?<= )\d+ +\d+ +[\d.]+ +[\d.-]+(?=  (between|at most))",  # cost of a method
    r" [-+]?\d\.\de-\d\d$",  # energy balance of a fish
    r"(?<=^! )(shoal: warning: )?(.* cannot be unstable|.* steps of).*",
    r"^  (total circulation|momentum balance|size|program|history|wall_time|steps|\w+_(evaluations|iterations|failures)) .*",
    r"(?<=\]) +[\d. ]+$| <- spend here.*|\+- \S+ times|CPU x [\d.]+",  # times of a plan
    r"^made by .*|^           SUNDIALS .*|^on  .*|^so far .*|(?<=\d)  [0-9a-f]{8}$",  # of a checkpoint
    r"unstable at t = \S+ s?.*|(?<=after )\d+ steps.*",
    r"^(wall_time|beat_time|steps|\w+_evaluations|\w+_iterations|\w+_failures|step_size|order|energy_balance) .*",
    r"^  \"(program|history|wall_time|beat_time|steps|\w+_evaluations|\w+_iterations|\w+_failures|step_size|energy_\w+)\": .*",
)

# the last column of a plan: times
PLAN = re.compile(r"^([a-z]+\.[a-z_]+ .*\[.*\S)  +[\d. ]+$")

# quotients of small differences
LOOSE = re.compile(r"multiplier|growth|exponent|order|residual|steady_error|fixed point|extrapolat|levels|beats")


def masked(line):
    line = PLAN.sub(r"\1 @", line)
    for pattern in FREE:
        line = re.sub(pattern, "@", line)
    return line


def same(got, want):
    """Do two lines agree?"""
    got, want = masked(got), masked(want)
    if [part.split() for part in NUMBER.split(got)] != [part.split() for part in NUMBER.split(want)]:
        return False
    for a, b in zip(NUMBER.findall(got), NUMBER.findall(want)):
        if a == b:
            continue
        x, y = float(a), float(b)
        mantissa, _, exponent = b.partition("e")
        unit = 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))
        if re.fullmatch(r"[-+]?\d+", b):  # a count; of beats it depends on rounding
            if abs(x - y) > (1 + 0.1 * y if "beats" in want else 0):
                return False
            continue
        part = 0.02 if LOOSE.search(want) else 1e-3
        size = abs(y)
        if "values, " in want:
            size = float(want.split()[-1])
        if exponent and abs(y) < 1e-3:
            part = 0.3
            size = max(size, 1e-7)
        if not abs(x - y) <= max(1.5 * unit, part * size):
            return False
    return True


# ---- files


def summed(values):
    """The number of values, their sum with weights, and the sum of their magnitudes."""
    values = [value for value in values if value == value]
    total = sum(value * (1 + (i * 7919 % 101) / 100) for i, value in enumerate(values))
    return f"{len(values)} values, {total:.5g}, {sum(map(abs, values)):.5g}"


def unpacked(text, code):
    data = base64.b64decode(text)
    size = struct.calcsize(code)
    return struct.unpack(f"<{len(data) // size}{code}", data[: len(data) // size * size])


CODES = {"time": "d", "box": "d", "place": "H", "first": "i", "count": "i", "strength": "h"}


def sums_of_page(path):
    with open(path, encoding="utf-8") as file:
        text = file.read()
    start = text.index('{"title"')
    data, _ = json.JSONDecoder().raw_decode(text[start:])

    def walk(name, value):
        if isinstance(value, dict):
            for key in value:
                yield from walk(f"{name}.{key}", value[key])
        elif isinstance(value, list):
            for i, item in enumerate(value):
                yield from walk(f"{name}[{i}]", item)
        elif isinstance(value, str) and len(value) > 40 and " " not in value:
            yield f"{name}: {summed(unpacked(value, CODES.get(name.split('.')[-1], 'f')))}"
        elif name != ".program":
            yield f"{name}: {value:.5g}" if isinstance(value, float) else f"{name}: {value}"

    return list(walk("", data))


def sums_of_vtk(folder):
    for name in sorted(os.listdir(folder)):
        yield name
        with open(os.path.join(folder, name), encoding="utf-8") as file:
            for line in file:
                found = re.fullmatch(r"(<DataArray .*?>)(.*)</DataArray>\n", line)
                if not found:
                    yield line.rstrip("\n")
                    continue
                raw = base64.b64decode(found[2])[8:]
                code = "d" if "Float64" in found[1] else "q"
                yield f"{found[1]} {summed(struct.unpack(f'<{len(raw) // 8}{code}', raw))}"


def sums_of_netcdf(path):
    import netCDF4  # pylint: disable=import-outside-toplevel
    import numpy as np  # pylint: disable=import-outside-toplevel

    with netCDF4.Dataset(path) as data:
        data.set_auto_mask(False)
        data.set_auto_chartostring(False)
        yield "attributes " + " ".join(sorted(data.ncattrs()))
        for name, variable in sorted(data.variables.items()):
            kinds = " ".join(f"{key} {getattr(variable, key)}" for key in variable.ncattrs() if key != "long_name")
            if kinds != "units 1":
                yield f"{name}: {kinds}"
            values = np.atleast_1d(variable[...])
            shape = ", ".join(f"{d} {n}" for d, n in zip(variable.dimensions, values.shape))
            if values.dtype.kind in "SU":
                yield f"{name} ({shape}) {b'|'.join(values.astype('S').ravel().tolist()).decode(errors='replace')[:60]}"
            else:
                yield f"{name} ({shape}) {summed(values.astype(float).ravel().tolist())}"


def output_of(program, command):
    words = shlex.split(command)
    if words[0] == "sums":
        path = words[1]
        return list(
            sums_of_page(path)
            if path.endswith(".html")
            else sums_of_netcdf(path) if path.endswith(".nc") else sums_of_vtk(path)
        )
    if words[0] == "cut":
        os.truncate(words[1], os.path.getsize(words[1]) - int(words[2]))
        return []
    if words[0] == "text":
        with open(words[1], encoding="utf-8") as file:
            return [line.rstrip("\n").replace(os.getcwd(), "FOLDER").replace(program, "SHOAL") for line in file]
    ended = subprocess.run([program, *words], capture_output=True, text=True, errors="replace", check=False)
    lines = ended.stdout.splitlines() + ["! " + line for line in ended.stderr.splitlines()]
    lines = [line.replace(os.getcwd(), "FOLDER").replace(program, "SHOAL") for line in lines if not re.match(FREE[0], line)]
    return lines + ([f"= {ended.returncode}"] if ended.returncode else [])


# ---- the table


def main():
    program, write = os.path.realpath(sys.argv[1]), "--write" in sys.argv
    with open(TABLE, encoding="utf-8") as file:
        table = file.read().split("\n")
    parts, i = [], 0
    for line in table:
        if line[:2] in ("$ ", "==") or not parts:
            parts.append([line])
        else:
            parts[-1].append(line)
    n_wrong = 0
    for part in parts:
        head, want = part[0], [line for line in part[1:] if line]
        if head.startswith("== "):
            with open(head[3:], "w", encoding="utf-8") as file:
                file.write("\n".join(part[1:]) + "\n")
        if not head.startswith("$ "):
            continue
        try:
            got = [line for line in output_of(program, head[2:]) if line.strip()]
        except (OSError, ValueError) as error:
            got = [f"unreadable: {error}"]
        if write:
            got = [line[:400].rstrip() for line in got]
            kept = [b if same(a, b) else a for a, b in zip(got, want)]  # a change shows the changed lines only
            part[1:] = kept + got[len(kept) :] + [""]
            continue
        got = [line[:400].rstrip() for line in got]
        wrong = [(a, b) for a, b in zip(got, want) if not same(a, b)]
        wrong += [(line, "") for line in got[len(want) :]] + [("", line) for line in want[len(got) :]]
        for a, b in wrong[:5]:
            print(f"    got    {a}\n    not    {b}")
        print("FAILED" if wrong else "ok", head[2:])
        n_wrong += bool(wrong)
        i += 1
    if write:
        with open(TABLE, "w", encoding="utf-8") as file:
            file.write("\n".join("\n".join(part) for part in parts))
    sys.exit(n_wrong > 0)


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""Run the commands of tests/data/outputs.txt and look for the lines that must occur in their outputs.

    tests/app/outputs.py PROGRAM

The table has cases ("== NAME", then the text of the file) and commands ("$ ARGUMENTS" of the program, "$ sums FILE or
FOLDER", "$ text FILE", "$ cut FILE BYTES" at its end, then lines that must occur in this order, whole or in part; "..."
stands for any text). Lines of standard error start with "! "; "= N" is an exit code other than 0. A number with a point
or an exponent agrees to one and a half units of its last digit, any other number exactly. The commands run in the
current folder.
"""

import base64
import difflib
import json
import os
import re
import shlex
import struct
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
TABLE = os.path.join(ROOT, "tests/data/outputs.txt")
NUMBER = r"(?<![\d.])[-+]?(?:\d+\.?\d*(?:e[-+]?\d+)?|nan|inf)"


def is_near(got, want):
    """Do the texts of two numbers agree?"""
    if got == want or re.fullmatch(r"[-+]?\d+", want):
        return got == want
    mantissa, _, exponent = want.partition("e")
    unit = 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))
    return abs(float(got) - float(want)) <= 1.5 * unit


def occurs(want, line):
    """Does a line contain these words and numbers?"""
    text = [r"\s+".join(map(re.escape, re.split(r"\s+", part))) for part in re.split(NUMBER, want)]
    text = [re.sub(r"(\\s\+)?\\\.\\\.\\\.", ".*?", part) for part in text]
    found = re.search(f"({NUMBER})".join(text), line)
    return found and all(map(is_near, found.groups(), re.findall(NUMBER, want)))


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


CODES = {"time": "d", "box": "d", "place": "H", "number": "i", "count": "i", "strength": "h"}


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
            is_text = values.dtype.kind in "SU"
            needed = {"long_name"} if is_text else {"long_name", "units"}
            if values.dtype.kind == "f" and "axis" not in variable.ncattrs():
                needed.add("_FillValue")
            if not needed <= {*variable.ncattrs()}:
                raise ValueError(f"{name} has not all of {needed}")
            shape = ", ".join(f"{d} {n}" for d, n in zip(variable.dimensions, values.shape))
            if is_text:
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
    lines = [line.replace(os.getcwd(), "FOLDER").replace(program, "SHOAL") for line in lines]
    return lines + [f"= {ended.returncode}"]


# ---- the table


def main():
    program = os.path.realpath(sys.argv[1])
    with open(TABLE, encoding="utf-8") as file:
        parts = re.split(r"^(?=\$ |== )", file.read(), flags=re.M)[1:]
    n_wrong = 0
    for part in parts:
        head, *wants = [line for line in part.splitlines() if line.strip()]
        if head.startswith("== "):
            with open(head[3:], "w", encoding="utf-8") as file:
                file.write("\n".join(wants) + "\n")
            continue
        try:
            got = output_of(program, head[2:])
        except (OSError, ValueError) as error:
            got = [f"unreadable: {error}"]
        if got and got[-1].startswith("= ") and not (wants and wants[-1].startswith("= ")):
            wants.append("= 0")

        # look for each line behind the one before
        missing, at = [], 0
        for want in wants:
            found = next((i for i in range(at, len(got)) if occurs(want, got[i])), None)
            if found is None:
                missing.append(want)
            else:
                at = found + 1
        for want in missing:
            print(f"    missing   {want}")
            for near in difflib.get_close_matches(want, got, 2, 0.4):
                print(f"    there is  {near}")
        print("FAILED" if missing else "ok", head[2:])
        n_wrong += bool(missing)
    sys.exit(n_wrong > 0)


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""Write a page of the manual from the tables of the program.

    shoal --describe            | scripts/make-man.py shoal.1        > shoal.1
    shoal keys --json           | scripts/make-man.py shoal-case.5   > shoal-case.5
    shoal keys --output --json  | scripts/make-man.py shoal-output.5 > shoal-output.5
"""

import json
import os
import re
import sys
import time

SEE_ALSO = {
    "shoal.1": "shoal-case(5), shoal-output(5)",
    "shoal-case.5": "shoal(1), shoal-output(5)",
    "shoal-output.5": "shoal(1), shoal-case(5), ncdump(1)",
}


def text(words):
    """Text in roff syntax."""
    words = words.replace("\\", "\\e").replace("-", "\\-").replace("'", "\\(aq").replace("`", "\\(ga")
    return re.sub(r"(?m)^(?=[.])", r"\\&", words)


def bold(words):
    """A word in bold."""
    return f"\\fB{text(words)}\\fR"


def head(page, summary):
    name, section = page.split(".")
    made = time.gmtime(float(os.environ.get("SOURCE_DATE_EPOCH", time.time())))
    return [f'.TH {name.upper()} {section} {time.strftime("%Y-%m-%d", made)} shoal', ".SH NAME", f"{text(name)} \\- {text(summary)}"]


def tail(page):
    pages = ", ".join(f"\\fB{text(word[:-3])}\\fR{word[-3:]}" for word in SEE_ALSO[page].split(", "))
    return [".SH SEE ALSO", pages]


def option_lines(option):
    """One option of a command: names and meaning."""
    names = [bold("-" + option["letter"])] if option["letter"] else []
    argument = option["argument"] or ""
    blank = " " if argument and not argument.startswith("[") else ""
    names.append(bold("--" + option["name"]) + (f"{blank}\\fI{text(argument)}\\fR" if argument else ""))
    return [".TP", ", ".join(names), text(option["meaning"])]


def program_page(page, about):
    """shoal(1)."""
    lines = head(page, about["summary"])
    lines += [".SH SYNOPSIS", f"{bold('shoal')} \\fICOMMAND\\fR [\\fIOPTIONS\\fR] [\\fIFILE\\fR]"]
    lines += [".SH DESCRIPTION", text("A case file in, a result file and pictures out: an implicit simulator of fish that")]
    lines += [text("bend, swim and shed vortices, alone or in schools. Results go to files, short answers to standard")]
    lines += [text("output, progress and messages to standard error. No file is overwritten without --force.")]
    lines += [".SH COMMANDS"]
    for command in about["commands"]:
        lines += [f".SS {text(command['name'])} {text(command['positional'] or '')}".rstrip()]
        lines += [text(command["summary"][0].upper() + command["summary"][1:] + ".")]
        for option in command["options"]:
            lines += option_lines(option)
    lines += [".SH EXIT STATUS"]
    for item in re.split(r",\s+", about["exit_codes"].rstrip(".")):
        code, meaning = item.split(" ", 1)
        lines += [".TP", bold(code), text(meaning)]
    lines += [".SH ENVIRONMENT", ".TP", bold("OMP_WAIT_POLICY, GOMP_SPINCOUNT")]
    lines += [text("these variables take precedence over the program's choice of waiting threads")]
    lines += [".SH EXAMPLES", ".EX"]
    lines += [
        text(line)
        for line in (
            "shoal check swim.yaml",
            "shoal run swim.yaml --set fish[0].wave.frequency=1.2 -o faster.nc",
            "shoal info faster.nc",
            "shoal view faster.nc",
        )
    ]
    return lines + [".EE"]


def key_lines(key):
    """One key of a case."""
    path = key["path"].replace("fish.", "fish[i].", 1) if key["path"].startswith("fish.") else key["path"]
    facts = [key["type"] + (f" [{key['unit']}]" if key["unit"] else "")]
    if key["range"]:
        facts.append(key["range"])
    facts.append(f"default: {key['derived'] or key['default'] or 'none, it is required'}")
    if key["published"]:
        facts.append(f"preset published: {key['published']}")
    lines = [".TP", bold(path), text(key["meaning"] + "."), ".br", text("; ".join(facts) + ".")]
    for word, meaning in key.get("words", {}).items():
        lines += [".br", f"{bold(word)}: {text(meaning)}"]
    return lines


def case_page(page, keys):
    """shoal-case(5)."""
    lines = head(page, "cases of shoal: what is simulated, and how")
    lines += [".SH DESCRIPTION"]
    lines += [text("A case is a file of YAML: keys with values, in SI units, angles in degrees. Every key has a default")]
    lines += [text("but format, time.end and fish. What all fish share stands under defaults.fish. The same keys, as")]
    lines += [text("paths, are what --set takes: fish[0].wave.frequency=1.2 for one fish, fish[*].nodes=13 for all.")]
    lines += [".SH EXAMPLE", ".EX", "format: 1", "time: {end: 3}", "fish:", text("  - {name: first, wave: {frequency: 1.5}}")]
    lines += [text("  - {name: second, start: {position: [1.5, 0]}}"), ".EE", ".SH KEYS"]
    section = None
    for key in keys:
        of = key["path"].rsplit(".", 1)[0] if "." in key["path"] else "The case"
        if of != section:
            lines += [f".SS {text(of)}"]
            section = of
        lines += key_lines(key)
    return lines


def output_page(page, variables):
    """shoal-output(5)."""
    lines = head(page, "files that shoal writes: variables of runs, studies and fields")
    lines += [".SH DESCRIPTION"]
    lines += [text("The file of a run is NetCDF in the classic format with 64-bit sizes (CDF-5). Its first dimension is")]
    lines += [text("time; slots that a shorter fish or wake does not use hold NaN. The attribute case_effective is the")]
    lines += [text("complete case that made the file.")]
    file = None
    for variable in variables:
        if variable["file"] != file:
            file = variable["file"]
            lines += [".SH WARNINGS" if file == "warning" else f".SH VARIABLES OF A {file.upper()}"]
        if file == "warning":
            lines += [".TP", bold(variable["name"]), text(variable["meaning"] + ".")]
            continue
        unit = f" [{variable['unit']}]" if variable["unit"] else ""
        dimensions = f"({', '.join(variable['dimensions'])})"
        lines += [".TP", f"{bold(variable['name'])} {text(dimensions + unit)}", text(variable["meaning"] + ".")]
    return lines


PAGES = {"shoal.1": program_page, "shoal-case.5": case_page, "shoal-output.5": output_page}

if __name__ == "__main__":
    if sys.argv[1:2] and sys.argv[1] in PAGES:
        print("\n".join(PAGES[sys.argv[1]](sys.argv[1], json.load(sys.stdin)) + tail(sys.argv[1])))
    else:
        sys.exit(__doc__)

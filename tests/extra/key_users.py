"""Every key is set by a case or a study in cases/, or the last section of doc/cases.md says who sets it; not both.

    tests/extra/key_users.py ROOT <KEYS    KEYS: the output of `shoal keys --json`
"""
import glob
import json
import re
import sys

import yaml


def paths_of(value, path):
    """The path of a value and of all values inside, without the numbers of fish."""
    yield path
    if isinstance(value, dict):
        for key, inside in value.items():
            yield from paths_of(inside, f"{path}.{key}" if path else key)
    elif path == "fish":
        for one in value:
            yield from paths_of(one, path)


root = sys.argv[1]
known = {re.sub(r"\[i\]", "", key["path"]) for key in json.load(sys.stdin)}
used = set()
for name in glob.glob(f"{root}/cases/**/*.yaml", recursive=True):
    case = yaml.safe_load(open(name))
    defaults = case.get("defaults", {}).get("fish", {})
    used |= {*paths_of(case, ""), *paths_of([defaults], "fish")}
    for axis in case.get("sweep", []):
        used |= {re.sub(r"\[[^]]*\]", "", key) for key in axis.get("keys", [axis.get("key")])}
section = open(f"{root}/doc/cases.md").read().split("## Keys that no case sets")[1]
explained = {path for row in re.findall(r"^\| (`[^|]*) \|", section, re.M) for path in re.findall(r"`([^`]+)`", row)}

wrong = {
    "set by no case and not explained": known - used - explained,
    "explained, but set by a case": explained & used,
    "explained, but no key": explained - known,
}
for reason, paths in wrong.items():
    for path in sorted(paths):
        print(f"{path}: {reason}")
sys.exit(any(wrong.values()))

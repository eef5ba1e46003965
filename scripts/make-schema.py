#!/usr/bin/python3
"""Write doc/case.schema.json, a JSON schema (draft 7) with which editors check and complete cases:
`shoal keys --json | scripts/make-schema.py > doc/case.schema.json`, or `make docs`."""

import json
import re
import sys

BOUNDS = [
    (r"above (\S+)", ["exclusiveMinimum"]),
    (r"at least (\S+)", ["minimum"]),
    (r"between (\S+) and (\S+)", ["exclusiveMinimum", "exclusiveMaximum"]),
    (r"from (\S+) to below (\S+)", ["minimum", "exclusiveMaximum"]),
    (r"from (\S+) to (\S+)", ["minimum", "maximum"]),
]
BOOLEAN, STRING, LIST, OBJECT = ({"type": name} for name in ("boolean", "string", "array", "object"))
POSITIVE = {"type": "number", "exclusiveMinimum": 0}
ONE_OR_MORE = {"type": ["string", "array"], "items": STRING}


def section(properties):
    return {"type": "object", "additionalProperties": False, "properties": properties}


AXIS = section({"key": STRING, "keys": {**LIST, "items": STRING}, "values": {**LIST, "minItems": 1}, "refine": BOOLEAN,
                "steady": BOOLEAN, "expect": OBJECT, "reference": OBJECT, "relative_to": {}}) | {"required": ["values"]}
FISH = {"$ref": "#/definitions/fish"}
NESTED = {
    "list of files": ONE_OR_MORE,
    "list of axes": {**LIST, "items": AXIS},
    "list of expectations": {**LIST, "items": OBJECT},
    "defaults": section({"fish": FISH}),
    "error": section({"of": ONE_OR_MORE, "within": POSITIVE, "most": POSITIVE, "confirm": BOOLEAN, "models": BOOLEAN,
                      "keys": {"type": ["string", "array", "object"]}, "against": {"type": ["string", "number"]},
                      "sensitivity": {"type": ["boolean", "string", "array"]}, "uncertain": OBJECT}),
}


def number(text):
    value = float(text)
    return int(value) if value == int(value) else value


def bounds(key):
    """The range of a number as properties of the schema."""
    for pattern, names in BOUNDS:
        if match := re.fullmatch(pattern, key["range"]):
            return dict(zip(names, map(number, match.groups())))
    value = number(key["range"]) if key["range"] else None
    return {} if value is None else {"minimum": value, "maximum": value}


def form(key):
    """The schema of a value, by its type in the table of keys."""
    kind = key["type"]
    if kind == "word":
        # true and false without quotes are no strings to a reader of YAML
        words = key["range"].split(", ")
        return {"enum": words + [word == "true" for word in words if word in ("true", "false")]}
    if kind == "string":
        return {"type": ["string", "number"]}
    if kind in NESTED or kind == "map":
        return NESTED[key["path"] if kind == "map" else kind]

    one = {"type": "integer" if kind == "integer" else "number", **bounds(key)}
    pair = {**LIST, "minItems": 2, "maxItems": 2}
    return {
        "number": one,
        "integer": one,
        # bounds concern numbers and patterns strings: an editor then names the bound
        "time": {**one, "type": [one["type"], "string"], "pattern": "^[0-9.eE+-]+(/[0-9.eE+-]+)? beats?$"},
        "[x, y]": {**pair, "items": one},
        "list of numbers": {**LIST, "items": one},
        "list of [x, y]": {**LIST, "items": {**pair, "items": one}},
        "list of [distance, number], or of numbers": {
            "anyOf": [{**LIST, "items": {**pair, "items": [{"type": "number"}, one]}}, {**LIST, "items": one}]},
        "list of rows of numbers": {**LIST, "items": {**LIST, "items": one}},
        # the bounds apply to the angle, not to the time
        "number or list of [time, angle]": {
            "anyOf": [one, {**LIST, "items": {**pair, "items": [{"type": "number"}, one]}}]},
    }[kind]


def main():
    top, fish = {}, {}
    for key in json.load(sys.stdin):
        *sections, name = key["path"].split(".")
        place = top
        if sections[:1] == ["fish"]:
            place, sections = fish, sections[1:]
        for word in sections:
            place = place.setdefault(word, section({}))["properties"]
        unit = f" [{key['unit']}]" if key["unit"] else ""
        standard = key["derived"] or key["default"] or "none: it is required"
        place[name] = {"description": f"{key['meaning']}{unit}; default: {standard}", **form(key)}
    top["fish"] = {"description": "the fish of the school", **LIST, "items": FISH}

    # one line for each key: an editor shows the line, and a change of a key is one line of a diff
    def lines(node, indent):
        if "properties" not in node or node.get("description"):
            return json.dumps(node)
        rest = ", ".join(f"{json.dumps(k)}: {json.dumps(v)}" for k, v in node.items() if k != "properties")
        inner = ",".join(f"\n{indent}{json.dumps(k)}: {lines(v, indent + '  ')}" for k, v in node["properties"].items())
        return f'{{{rest}, "properties": {{{inner}}}}}'

    print(f'{{"$schema": "http://json-schema.org/draft-07/schema#", "title": "a case of shoal",\n'
          f'"definitions": {{"fish": {lines(section(fish), "  ")}}},\n"allOf": [{lines(section(top), "  ")}]}}')


if __name__ == "__main__":
    main()

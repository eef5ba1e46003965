"""Validate cases by the schema as an editor does; the words of what is wrong with each."""
import json
import re
import sys
import jsonschema
import yaml

class Loader(yaml.SafeLoader):
    """Numbers as in YAML 1.2."""

Loader.add_implicit_resolver(
    "tag:yaml.org,2002:float", re.compile(r"^[-+]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][-+]?[0-9]+)?$"), list("-+0123456789.")
)
schema = json.load(open("schema.json"))
jsonschema.Draft7Validator.check_schema(schema)
validator = jsonschema.Draft7Validator(schema)
for path in sys.argv[1:]:
    for error in validator.iter_errors(yaml.load(open(path, encoding="utf-8"), Loader)):
        print(f"{path}: {'.'.join(map(str, error.absolute_path))}: {error.message}")

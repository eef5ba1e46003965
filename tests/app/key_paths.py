"""key_paths.py FILE PATH...: whether a file of `shoal keys --json` has these keys and no others."""

import json
import sys

paths = [key["path"] for key in json.load(open(sys.argv[1]))]
sys.exit(0 if paths == sys.argv[2:] else str(paths))

"""words_of_key.py FILE PATH: print the words that a key may have, from a file of `shoal keys --json`."""

import json
import sys

print(*next(key["words"] for key in json.load(open(sys.argv[1])) if key["path"] == sys.argv[2]))

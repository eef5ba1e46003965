"""branch_json.py: what `shoal steady --continue --json` prints of a plate that heaves less and less is its branch."""

import json

found = json.load(open("out"))
assert found["key"] == "fish[0].motion.heave" and len(found["points"]) >= 2
assert (found["points"][0]["value"], found["points"][-1]["value"]) == (0.15, 0.12), found
assert all(point["multiplier"] < 1 for point in found["points"]), found

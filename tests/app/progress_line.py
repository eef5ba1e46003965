"""progress_line.py: whether the last line of progress, in the file last, has steps and vortices of the result, in the file out."""

import json
import re

run = json.load(open("out"))
got = re.fullmatch(
    r"t +0.300 s +100 % +0 s left .* x real time +(.*) steps/event +(\d+) vortices", open("last").read().strip()
)
assert abs(float(got[1]) - run["steps"] * run["shedding_interval"] / 0.3) < 0.06 and int(got[2]) == run["wake_count"][0]

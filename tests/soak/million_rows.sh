#!/usr/bin/env bash
# A run writes and resumes a result of a million rows (1.3 GB), and every reader reads the file. This takes ten minutes.
#
#   tests/soak/million_rows.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

cat >long.yaml <<'end'
format: 1
name: long
time: {end: 10000, shedding_interval: 0.01, output_interval: 0.01, checkpoint_interval: 2500}
output: {wake_interval: 10000}
fluid: {density: 0}
wake: {lifetime: 0.02, decay: 0}
fish: [{force: reactive, nodes: 4, sheet_points: 5, body: {tail_thickness: 0.4}}]
end
run run long.yaml -q
check "a run writes a million rows" test "$code" = 0
run info long.nc
check "info counts them" has out "rows        1000001, from t = 0 s to 10000 s"
run resume long.ckpt -q --end 10000.1
check "the run is resumed after a million rows" test "$code" = 0
run info long.nc
check "info counts the rows of the resumption" has out "rows        1000011, from t = 0 s to 10000.1 s"
run view long.nc -q
check "view makes a page" test "$code" = 0
check "the page is no larger than one of a thousand rows by ten times" test "$(stat -c %s long.html)" -lt 20000000
run field long.nc -q --at 10000 --grid 5,5
check "field finds the last event" test "$code" = 0
check "plot.py draws it" "$root/scripts/plot.py" long.nc
truncate -s -1000 long.nc
run info long.nc
check "info counts the rows of a file that was cut off" has out "missing     1 of 1000011 rows"

finish

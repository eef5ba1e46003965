#!/usr/bin/env bash
# 1000 power cuts of runs with checkpoints (tests/faults/power.py): none loses a run.
#
#   tests/soak/power.sh PROGRAM
set -euo pipefail
program=$(realpath "${1:?usage: tests/soak/power.sh PROGRAM}")
exec /usr/bin/python3 "$(dirname "$0")/../faults/power.py" "$program" "$(dirname "$program")/power.so" 1000

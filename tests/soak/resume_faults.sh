#!/usr/bin/env bash
# All failing calls of runs with checkpoints, one at a time, and resuming from the remaining files (tests/soak/resume_faults.py).
#
#   tests/soak/resume_faults.sh PROGRAM
set -euo pipefail
program=$(realpath "${1:?usage: tests/soak/resume_faults.sh PROGRAM}")
exec /usr/bin/python3 "$(dirname "$0")/resume_faults.py" "$program" "$(dirname "$program")/faults.so"

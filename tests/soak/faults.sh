#!/usr/bin/env bash
# All failing calls of the system, one at a time (tests/faults/faults.py): about 2100 runs.
#
#   tests/soak/faults.sh PROGRAM
set -euo pipefail
program=$(realpath "${1:?usage: tests/soak/faults.sh PROGRAM}")
exec /usr/bin/python3 "$(dirname "$0")/../faults/faults.py" "$program" "$(dirname "$program")/faults.so" 1

#!/usr/bin/env bash
# All failing allocations of all commands, one at a time (tests/faults/memory.py): about 18,000 runs.
#
#   tests/soak/memory.sh PROGRAM
set -euo pipefail
program=$(realpath "${1:?usage: tests/soak/memory.sh PROGRAM}")
exec /usr/bin/python3 "$(dirname "$0")/../faults/memory.py" "$program" "$(dirname "$program")/memory.so" 1

#!/usr/bin/env bash
# Little memory for every command, in steps of 200 kB (tests/faults/limits.py): about 1200 runs.
#
#   tests/soak/limits.sh PROGRAM
set -euo pipefail
exec /usr/bin/python3 "$(dirname "$0")/../faults/limits.py" "${1:?usage: tests/soak/limits.sh PROGRAM}" 200

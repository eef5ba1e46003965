#!/usr/bin/env bash
# 36 random schools with the force of the pressure run for a fifth of a beat each, and none fails. `make soak` runs 500
# schools.
#
#   tests/run/test_pressure_cases.sh PROGRAM
set -euo pipefail
program=${1:?usage: tests/run/test_pressure_cases.sh PROGRAM}
exec /usr/bin/python3 "$(dirname "$0")/../soak/pressure_cases.py" "$program" 36 1000 0.2

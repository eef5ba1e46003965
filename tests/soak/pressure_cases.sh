#!/usr/bin/env bash
# 500 random schools with the force of the pressure (tests/soak/pressure_cases.py), each for 1.5 beats.
#
#   tests/soak/pressure_cases.sh PROGRAM
set -euo pipefail
exec /usr/bin/python3 "$(dirname "$0")/pressure_cases.py" "${1:?usage: tests/soak/pressure_cases.sh PROGRAM}" 500

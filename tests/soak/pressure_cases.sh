#!/usr/bin/env bash
# Random fish with the force of the pressure (tests/soak/pressure_cases.py): 100 cases of contact, each with infinite and
# with finite span, then 500 schools, each for 1.5 beats.
#
#   tests/soak/pressure_cases.sh PROGRAM
set -euo pipefail
program=${1:?usage: tests/soak/pressure_cases.sh PROGRAM}
/usr/bin/python3 "$(dirname "$0")/pressure_cases.py" "$program" contact
exec /usr/bin/python3 "$(dirname "$0")/pressure_cases.py" "$program" 500

#!/usr/bin/env bash
# Whole runs against the results of an independent program (RK4, written by others from the same equations), for one fish
# and for two: single1 and pair1 use the published model, single3 and pair3 the reactive force and free sheets, single4 and
# pair4 pressure of finite span, single5 and pair5 in addition cross-flow drag and the law course of slow motion. Each
# tests/data/NAME.yaml runs at a tight tolerance and is compared with tests/data/NAME.json; at the default tolerance the
# positions agree to 0.2 mm. Forces, energies and powers are compared at the end; reactive_force includes
# the tail flux.
#
#   tests/run/test_reference.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

/usr/bin/python3 "$root/tests/run/reference.py" "$program" "$root/tests/data"

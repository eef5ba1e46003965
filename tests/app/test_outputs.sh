#!/usr/bin/env bash
# Whole outputs: every printed line and every file of the commands in tests/data/outputs.txt stays. Other tests verify the values; this test
# notices every change of an output. After an intended change: tests/app/outputs.py PROGRAM --write
#
#   tests/app/test_outputs.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

/usr/bin/python3 "$root/tests/app/outputs.py" "$program" >same 2>&1
while IFS= read -r line; do
    case $line in
        'ok '*) pass "${line#ok }" ;;
        'FAILED '*) fail "${line#FAILED }" 'differs from tests/data/outputs.txt' ;;
        *) echo "$line" ;;
    esac
done <same
check all_commands_were_compared test "$n_passed" -gt 30

finish

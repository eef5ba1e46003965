#!/usr/bin/env bash
# The outputs of every command have the messages, heads and key values of tests/data/outputs.txt.
#
#   tests/extra/test_outputs.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

/usr/bin/python3 "$root/tests/app/outputs.py" "$program" >same 2>&1
while IFS= read -r line; do
    case $line in
        'ok '*) pass "${line#ok }" ;;
        'FAILED '*) fail "${line#FAILED }" 'lines of tests/data/outputs.txt are missing' ;;
        *) echo "$line" ;;
    esac
done <same
check all_commands_were_compared test "$n_passed" -gt 30

finish

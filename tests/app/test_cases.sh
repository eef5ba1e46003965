#!/usr/bin/env bash
# Every case in cases/ runs, and gives the numbers of tests/data/cases.tsv, which its line "# Expected" states too. WRITE=1
# writes the numbers of this program into the table and into the cases (then read the difference!).
#
#   tests/app/test_cases.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

/usr/bin/python3 "$root/tests/app/cases.py" "$program" "$root/cases" "$root/tests/data/cases.tsv" cases

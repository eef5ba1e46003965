#!/usr/bin/env bash
# Every study in cases/studies/ says what it expects, and meets it. Those of less than 5 s run, or with "long" the
# others.
#
#   tests/extra/test_studies.sh PROGRAM [long]
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

/usr/bin/python3 "$root/tests/app/cases.py" "$program" "$root/cases" "$root/tests/data/cases.tsv" "${2-studies}"

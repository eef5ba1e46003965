#!/usr/bin/env bash
# The studies of cases/studies that take 10 s to half an hour: each states what it expects, and meets it.
#
#   tests/soak/studies.sh PROGRAM
exec "$(dirname "$0")/../app/test_cases.sh" "$1" long

#!/usr/bin/env bash
# The studies of cases/studies that take 10 s to half an hour: each study meets the stated expectations.
#
#   tests/soak/studies.sh PROGRAM
exec "$(dirname "$0")/../extra/test_studies.sh" "$1" long

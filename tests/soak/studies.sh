#!/usr/bin/env bash
# The studies of cases/studies that take 10 s to half an hour meet what they expect.
#
#   tests/soak/studies.sh PROGRAM
exec "$(dirname "$0")/../extra/test_studies.sh" "$1" long

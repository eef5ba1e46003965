#!/usr/bin/env bash
# A thousand mutated cases and a thousand mutated files of runs, studies and fields: always the same ones. More of them,
# and others: make fuzz.
#
#   tests/faults/test_fuzz.sh PROGRAM
set -uo pipefail
export LC_ALL=C

program=$(realpath "${1:?usage: tests/faults/test_fuzz.sh PROGRAM}")
tests=$(realpath "$(dirname "$0")/..")
targets=$(dirname "$program")/fuzz
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 2

# shellcheck source=tests/checks.sh
. "$tests/checks.sh"

"$tests/fuzz/seeds.sh" "$program" seeds
check the_seeds_are_good "$targets/fuzz_result" 4 - seeds/results/*
check a_thousand_cases timeout 100 "$targets/fuzz_case" 1000 1 seeds/cases/*
check a_thousand_results timeout 100 "$targets/fuzz_result" 1000 1 seeds/results/*

echo "$n_passed passed, $n_failed failed, $n_skipped skipped"
((n_failed == 0))

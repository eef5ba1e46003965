#!/usr/bin/env bash
# A thousand mutated cases, a thousand mutated files of runs, studies and fields, and a thousand mutated checkpoints:
# always the same ones. More of them, and others: make fuzz.
#
#   tests/faults/test_fuzz.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

targets=$(dirname "$program")/fuzz

"$root/tests/fuzz/seeds.sh" "$program" seeds
check the_results_are_good "$targets/fuzz_result" 4 - seeds/results/*
check the_checkpoints_are_good "$targets/fuzz_checkpoint" 6 - seeds/checkpoints/*
check a_thousand_cases timeout "$time_limit" "$targets/fuzz_case" 1000 1 seeds/cases/*
check a_thousand_results timeout "$time_limit" "$targets/fuzz_result" 1000 1 seeds/results/*
check a_thousand_checkpoints timeout "$time_limit" "$targets/fuzz_checkpoint" 1000 1 seeds/checkpoints/*

finish

#!/usr/bin/env bash
# A thousand mutated cases, a thousand mutated files of runs, studies and fields, and a thousand mutated checkpoints,
# all from a fixed seed, do no harm. `make fuzz` tries more and new ones.
#
#   tests/extra/test_fuzz.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

targets=$(dirname "$program")/fuzz

"$root/tests/fuzz/seeds.sh" "$program" seeds
check the_results_are_good "$targets/fuzz_result" 4 - seeds/results/*
check the_checkpoints_are_good "$targets/fuzz_checkpoint" 6 - seeds/checkpoints/*
check a_thousand_cases timeout "$time_limit" "$targets/fuzz_case" 1000 1 seeds/cases/*
check a_thousand_results timeout "$time_limit" "$targets/fuzz_result" 1000 1 seeds/results/*
check a_thousand_checkpoints timeout "$time_limit" "$targets/fuzz_checkpoint" 1000 1 seeds/checkpoints/*

# scripts/fuzz.sh recognises libFuzzer by a help text of any length: always the same answer
mkdir -p tree/scripts tree/tests/fuzz tree/build-sanitize/fuzz
ln -s build-sanitize tree/build-fuzzer
printf 'fuzz-programs:\n' >tree/Makefile
cp "$root/scripts/fuzz.sh" tree/scripts
printf '#!/bin/sh\nmkdir -p "$2"\n' >tree/tests/fuzz/seeds.sh
for target in fuzz_case fuzz_result fuzz_checkpoint; do
    cat >tree/build-sanitize/fuzz/$target <<'end'
#!/bin/sh
case $1 in
    -help=1) echo "Usage of libFuzzer:" && seq 100000 ;;
    -*) echo "stat::number_of_executed_units: 7" ;;
    *) sleep 1 ;;
esac
end
done
chmod +x tree/tests/fuzz/seeds.sh tree/build-sanitize/fuzz/*
: >answers
for ((i = 0; i < 10; i++)); do tree/scripts/fuzz.sh 1 >>answers 2>&1; done
check the_fuzzer_is_recognised_thirty_times_of_thirty test "$(grep -c ': 7 inputs in 1 s$' answers)" = 30

finish

#!/usr/bin/env bash
# Fuzz all targets at once for a given time, with the sanitizers. libFuzzer does it if clang is installed, else the driver
# of tests/fuzz with one seed after the other. The script stops at the first bad input and keeps it.
#
#   scripts/fuzz.sh SECONDS
set -euo pipefail
seconds=$1
cd "$(dirname "$0")/.."
if [[ $(command -v clang) ]]; then
    # all for libFuzzer, whose main replaces that of the driver
    build=build-fuzzer
    settings=(CC=clang B=$build fuzz_driver= fuzz_flags=-fsanitize=fuzzer "sanitize=-fsanitize=address,undefined,fuzzer-no-link
        -fno-sanitize-recover=all -fno-omit-frame-pointer -fno-sanitize=pointer-overflow")
else
    build=build-sanitize settings=()
fi
make --no-print-directory -j"$(nproc)" SANITIZE=1 "${settings[@]//$'\n'/ }" fuzz-programs
build=$(realpath "$build")
folder=$build/fuzz/run
mkdir -p "$folder"
tests/fuzz/seeds.sh "$build/shoal" "$folder/seeds"

# One target until the time is over; prints the number of inputs.
fuzz() {  # target, seeds
    mkdir -p "$folder/$1" && cd "$folder/$1"
    local end=$((SECONDS + seconds)) seed n=0 each=2000 help
    # the driver of tests/fuzz takes -help=1 for a wrong number; a pipe that is closed early would fail with pipefail
    help=$("$build/fuzz/$1" -help=1 2>&1) || true
    if [[ $help == *libFuzzer* ]]; then
        mkdir -p corpus
        "$build/fuzz/$1" -max_total_time="$seconds" -timeout=60 -rss_limit_mb=4096 -max_len=65536 -print_final_stats=1 \
            corpus "$2" >log 2>&1 || { tail -n 40 log; return 1; }
        n=$(sed -n 's/stat::number_of_executed_units: *//p' log)
    else
        for ((seed = $(date +%s); SECONDS < end; seed++)); do
            "$build/fuzz/$1" $each $seed "$2"/* >log 2>&1 || {
                tail -n 40 log
                echo "$1: seed $seed; the input is $PWD/fuzz-input"
                return 1
            }
            n=$((n + each))
        done
    fi
    echo "$1: $n inputs in $seconds s"
}

fuzz fuzz_case "$folder/seeds/cases" & one=$!
fuzz fuzz_result "$folder/seeds/results" & two=$!
fuzz fuzz_checkpoint "$folder/seeds/checkpoints" & three=$!
code=0
for one in $one $two $three; do wait "$one" || code=1; done
exit $code

#!/usr/bin/env bash
# test_memory.sh PROGRAM: a run, a study and a resumed run end with one message and exit code 4 when one of their
# allocations fails, every 811th in turn, and what is on the disk is whole. `make soak` lets each allocation of every
# command fail.
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

if grep -q __asan_init "$program"; then
    skip "failing allocations" "the address sanitizer has an allocator of its own"
else
    /usr/bin/python3 "$root/tests/soak/memory.py" "$program" 811 0 "run --force" "run with pressure" resume study >out 2>&1
    check "each has a message, leaves no part, and keeps or completes the result" \
        grep -q '^[1-9][0-9]* passed, 0 failed, 0 skipped$' <(tail -n 1 out)
    ((n_failed == 0)) || cat out
fi
finish

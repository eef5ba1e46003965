#!/usr/bin/env bash
# Runs the fast part of the checks against classical results, which takes seconds. `make verify` runs all checks.
#
#   tests/extra/test_verify.sh PROGRAM
#
# PROGRAM is build/shoal; the program of the checks is verify/verify in the same folder.
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

verify=$(dirname "$program")/verify/verify
cd "$root" || exit 2  # some checks run the cases of the tree

for section in theory rod force sheet wake plate school interval symmetry start energy momentum fish control pressure \
    depth encounters skin elastic coupled steady static tandem growth walls validation; do
    code=0
    : >"$folder/table"
    "$verify" "$section" --fast -o "$folder/table" >"$folder/out" 2>&1 </dev/null || code=$?
    # the last field of a row is the verdict; a row without a verdict is not a check
    passed=$(awk -F '\t' '$1 == "row" && $NF == "ok"' "$folder/table" | wc -l)
    missed=$(awk -F '\t' '$1 == "row" && $NF == "MISSED"' "$folder/table" | wc -l)
    if ((code != 0 && code != 3)); then
        echo "FAILED  $section: exit code $code"
        missed=$((missed + 1))
    elif ((passed + missed == 0)); then
        echo "skipped $section: no check of it is fast"
        n_skipped=$((n_skipped + 1))
    elif (((code == 3) != (missed > 0))); then
        echo "FAILED  $section: exit code $code with $missed checks missed"
        missed=$((missed + 1))
    fi
    ((missed == 0)) || cat "$folder/out"
    n_passed=$((n_passed + passed))
    n_failed=$((n_failed + missed))
done
finish

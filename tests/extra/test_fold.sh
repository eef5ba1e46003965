#!/usr/bin/env bash
# shoal steady --threshold at a fold: a follower falls back as it heaves less, until its place is gone. The way of the search
# through a fold is in tests/study/test_branch_walk.c, and the same fold in tests/study/test_branch.sh.
#
#   tests/extra/test_fold.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

run steady "$root/tests/data/falling_back.yaml" --threshold 'fish[1].motion.heave=0.083:0.07' -o fold
check a_fold_is_named has out 'a fold: the steady states of this branch end there'
check it_has_a_bar grep -qE 'heave = 0[.]078[0-9]* \+- 0[.]00[23]' out
check which_has_the_scatter_of_the_states grep -qE 'by the secant, [1-9].* by the state' out

# at half the interval the fold is at 0.07763 m, lower by 0.00093 m: half of an error of first order
check and_what_the_interval_changes awk '/by the interval/ { for (i = 2; i <= NF; i++)
    if ($i == "by" && $(i + 2) ~ /^interval/) part = $(i - 1) } END { exit !(part > 0.0015 && part < 0.0022) }' out
check and_the_bodies grep -qE ', 0[.]00[0-9]* by the nodes and sheets' out
finish

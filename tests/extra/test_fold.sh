#!/usr/bin/env bash
# shoal steady --threshold at a fold: a follower falls back as it heaves less, until its place is gone. The way of the search
# through a fold is in tests/study/test_branch_walk.c, and the same fold in tests/study/test_branch.sh.
#
#   tests/extra/test_fold.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

run steady "$root/tests/data/falling_back.yaml" --threshold 'fish[1].motion.heave=0.083:0.07' -o fold
check a_fold_is_named has out 'a fold: the steady states of this branch end there'
check the_states_end_below_it grep -qF 'it does not say what a shorter interval or finer bodies change' out
check it_has_a_bar grep -qE 'heave = 0[.]078[0-9]* \+- 0[.]0000' out
check which_has_the_scatter_of_the_states grep -qE 'by the secant, [1-9].* by the state' out
finish

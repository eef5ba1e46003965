#!/usr/bin/env bash
# shoal steady --continue follows a branch through a fold, keeps what it finds on disk, and says where it ends.
#
#   tests/study/test_branch.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"
start_python

# A follower that heaves less and less falls back, until at a fold its place is gone. Beyond the fold the branch returns: a
# place farther behind, from which the follower leaves.
key='fish[1].motion.heave'
cp "$root/tests/data/falling_back.yaml" plates.yaml

# ---- the branch

run steady plates.yaml --continue "$key=0.081:0.05"
check the_branch_ends_where_it_began_beyond_a_fold test "$code" = 0
check the_table_names_the_fold test "$(grep -c ', fold$' out)" = 1
check every_state_is_told_when_it_is_found grep -qF "$key = 0.081: largest multiplier 0.9" err
check the_branch_has_its_fold_and_its_stability python "$root/tests/study/branch_file.py"

# the state on the unstable side is the one that a search from there finds
last=$(sed -n 's/.*\(state-[0-9]*\.nc\).*/\1/p' <<<"$(ncdump -v file plates-branch/study.nc)" | tail -n 1)
run steady plates.yaml --from "plates-branch/$last" --set "$key=0.081" -o again.nc --force
check a_search_finds_the_unstable_state_too test "$code" = 0
check and_finds_it_at_the_same_place python "$root/tests/study/same_place.py" "plates-branch/$last" again.nc

refused a_branch_does_not_remove_the_state_it_starts_from 4 "$last is the file that is read: choose another name with -o" \
    steady plates.yaml --from "plates-branch/$last" --continue "$key=0.081:0.09" --force
refused nor_do_wrong_starts 4 'none.nc: cannot be read' steady plates.yaml --from none.nc --continue "$key=0.081:0.09" --force
check nor_the_others test -e "plates-branch/$last" -a -e plates-branch/state-000.nc -a -e plates-branch/study.nc

run info plates-branch/study.nc
check info_summarises_a_branch grep -qF "$key" out
# of one plate, which has no place
sed '/follower/d; s/formation: true, //' plates.yaml >plate.yaml
run steady plate.yaml --continue 'fish[0].motion.heave=0.15:0.12' --json -q -o json
check json_is_written test "$code" = 0
check json_has_the_points python "$root/tests/study/branch_json.py"

# ---- an end before the end

refused a_branch_is_not_overwritten 4 'plates-branch/study.nc exists: replace it with --force' \
    steady plates.yaml --continue "$key=0.085:0.05"
run steady plates.yaml --continue "$key=0.085:0.09" --force --max-wall 00:00:01
check a_limit_ends_it_with_what_was_found eval 'test "$code" = 75 && has err "stopped after --max-wall"'

# a beat of another length has no whole number of events
run steady plate.yaml --continue 'fish[*].motion.frequency=1:0.1' -o slow
check an_end_without_a_state_says_how_far_it_came eval 'test "$code" = 2 && has err "events" &&
    has err "; 1 steady state was found, at fish[*].motion.frequency = 1 with" && test -s slow/study.nc'

# ---- bad input

refused the_ends_differ 2 'expects KEY=FROM:TO with two different numbers' steady plates.yaml --continue "$key=0.1:0.1"
refused an_end_is_a_number 2 'expects KEY=FROM:TO with two different numbers' steady plates.yaml --continue "$key=0.1:nan"
refused both_ends_are_given 2 'expects KEY=FROM:TO with two different numbers' steady plates.yaml --continue "$key=0.1"
refused the_key_exists 2 'fish[1].motion.haeve' steady plates.yaml --continue 'fish[1].motion.haeve=0.1:0.2'
refused both_ends_are_allowed 2 'length' steady plates.yaml --continue 'fish[1].length=1:-1'
refused a_key_has_values_in_between 2 'fish[*].nodes is an integer, which has no values in between' steady plates.yaml \
    --continue 'fish[*].nodes=4:5'
refused a_name_is_no_number 2 'name is not a number' steady plates.yaml --continue 'name=1:2'
refused multipliers_are_needed 2 'set steady.multipliers to true' steady plates.yaml --continue "$key=0.085:0.05" \
    --set steady.multipliers=false -o none
refused a_branch_is_no_threshold 2 'exclude each other' steady plates.yaml --continue "$key=0.085:0.05" \
    --threshold "$key=0.085:0.05"
refused a_trace_is_of_one_search 2 '--trace' steady plates.yaml --continue "$key=0.085:0.05" --trace t.csv

finish

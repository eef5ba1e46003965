#!/usr/bin/env bash
# Every case, command and script of doc/tutorial.md works, in order, in an empty folder. The runs are shortened.
#
#   tests/extra/test_tutorial.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

export MPLCONFIGDIR=$folder/matplotlib

# the blocks of the tutorial as files: 01-sh, 02-python, ..., and the cases by the names in the text; a script begins with
# the scripts above, whose variables it uses
/usr/bin/python3 "$root/tests/extra/tutorial_blocks.py" "$root"

shoal() {
    local short=()
    case $1 in
        run | study) short=(-q --set time.end=1.2 --set 'fish[*].nodes=7' --set 'fish[*].sheet_points=31') ;;
        steady) short=(-q --set 'fish[*].nodes=13' --set 'fish[*].sheet_points=31' --set time.shedding_interval=0.02) ;;
    esac
    timeout "$time_limit" "$program" "$@" "${short[@]}"
}
plot.py() { timeout "$time_limit" /usr/bin/python3 "$root/scripts/plot.py" "${@//[246]/1}"; }

# a command as written in the tutorial; times of figures are within the shorter run
command_works() { eval "$1"; }

n_blocks=0
for block in [0-9][0-9]-sh [0-9][0-9]-python; do [[ ! -e $block ]] || n_blocks=$((n_blocks + 1)); done
check the_tutorial_has_commands test "$n_blocks" -ge 1
for block in [0-9][0-9]-*; do
    if [[ $block == *-python ]]; then
        prints() { timeout "$time_limit" /usr/bin/python3 "$block" >printed && [[ -s printed ]]; }
        check "$block" prints
        continue
    fi
    while IFS= read -r line; do
        check "$line" command_works "$line"
    done <"$block"
done
for made in alone.html pair.png steady.nc fine.nc longer.nc reactive.nc follower.png follower-study/study.nc; do
    check "$made is there" test -s "$made"
done
members() { [[ $(find follower-study -name 'member-*.nc' | wc -l) == 5 ]]; }
check the_study_has_five_members members

finish

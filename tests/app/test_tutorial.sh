#!/usr/bin/env bash
# Every case, command and script of doc/tutorial.md works, in order, in an empty folder. Runs are shortened.
#
#   tests/app/test_tutorial.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

export MPLCONFIGDIR=$folder/matplotlib

# the blocks of the tutorial as files: 01-sh, 02-python, ..., and the cases by the names in the text
/usr/bin/python3 - "$root/doc/tutorial.md" <<'end'
import re, sys

text, number = open(sys.argv[1], encoding="utf-8").read(), 0
for block in re.finditer(r"```(\w+)\n(.*?)```", text, re.S):
    kind, inside = block.groups()
    number += 1
    name = f"{number:02}-{kind}"
    if kind == "yaml":
        name = re.findall(r"Write `([^`]+)`", text[: block.start()])[-1]
    open(name, "w", encoding="utf-8").write(inside)
end

shoal() {
    local short=()
    case $1 in
        run | study) short=(-q --set time.end=1.2 --set 'fish[*].nodes=7' --set 'fish[*].sheet_points=11') ;;
        steady) short=(-q --set 'fish[*].nodes=11' --set 'fish[*].sheet_points=31' --set time.shedding_interval=0.04
            --set time.output_interval=0.2 --set steady.tolerance=5e-3) ;;
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
for made in alone.html pair.png steady.nc long.nc fine.nc longer.nc follower.png follower-study/study.nc; do
    check "$made is there" test -s "$made"
done
members() { [[ $(find follower-study -name 'member-*.nc' | wc -l) == 5 ]]; }
check the_study_has_five_members members

finish

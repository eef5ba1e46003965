#!/usr/bin/env bash
# Run the checks against classical results; write a report with figures and the summary in doc/verification.md.
#
#   scripts/verify.sh PROGRAM FOLDER [DOCUMENT]
#
# PROGRAM is build/verify/verify. Each section writes its table FOLDER/SECTION.tsv; two sections run at a time, and
# their rows are printed in the order of the report, FOLDER/report.md. DOCUMENT receives the summary. Run it from the top
# of the tree, because some sections read cases/. The exit code is 0, 3 if a bound is missed, and 1 if a section or the
# report fails.
set -euo pipefail
export LC_ALL=C

readonly sections=(theory rod force sheet wake plate school interval symmetry start energy momentum fish control pressure
    depth encounters skin elastic coupled steady static tandem growth walls validation)
readonly at_once=2

if (($# < 2 || $# > 3)); then
    echo "usage: scripts/verify.sh PROGRAM FOLDER [DOCUMENT]" >&2
    exit 2
fi
program=$1 folder=$2
scripts=$(dirname "$0")
mkdir -p "$folder"

stop() {
    local pids
    mapfile -t pids < <(jobs -p)
    ((${#pids[@]} == 0)) || kill "${pids[@]}" 2>/dev/null || true
}
trap stop EXIT
trap 'exit 130' INT TERM

declare -A section_of exit_code
next=0 shown=0 running=0 missed=0 failed=0
while ((shown < ${#sections[@]})); do
    while ((running < at_once && next < ${#sections[@]})); do
        section=${sections[next]}
        rm -f "$folder/$section.tsv"
        "$program" "$section" -o "$folder/$section.tsv" >"$folder/$section.out" 2>&1 </dev/null &
        section_of[$!]=$section
        next=$((next + 1)) running=$((running + 1))
    done

    code=0
    wait -n -p pid 2>/dev/null || code=$?
    exit_code[${section_of[$pid]}]=$code
    running=$((running - 1))

    while ((shown < ${#sections[@]})) && [[ -n ${exit_code[${sections[shown]}]-} ]]; do
        section=${sections[shown]}
        cat "$folder/$section.out"
        case ${exit_code[$section]} in
            0) ;;
            3) missed=1 ;;
            *)
                echo "scripts/verify.sh: section $section ended with exit code ${exit_code[$section]}" >&2
                failed=1
                ;;
        esac
        shown=$((shown + 1))
    done
done

# a section that failed must not vanish from the report
((failed == 0)) || exit 1
/usr/bin/python3 "$scripts/verify.py" "$folder" ${3+"$3"}
if ((missed)); then
    echo "a bound was missed: see the rows marked MISSED above" >&2
    exit 3
fi

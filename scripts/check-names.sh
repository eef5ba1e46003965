#!/usr/bin/env bash
# Check the names and the text of the sources.
#
#   scripts/check-names.sh [BUILD]      BUILD: the folder with the objects, build by default
#
# - shared names of src/*/x.c and src/*/x_more.c begin with x_, or with a prefix that is listed for the module;
# - libshoal.a has no global name without shoal_;
# - tests do not use cmocka's assert_float_equal, which compares in single precision: NEAR of tests/near.h does not;
# - lines of C have at most 120 characters;
# - no tabs (but in the Makefile) and no blanks at the end of a line.
set -euo pipefail

cd "$(dirname "$0")/.."
build=${1:-build}

n_errors=0
complain() {
    echo "$1" >&2
    n_errors=$((n_errors + 1))
}

# Modules of several subjects, and the prefixes of the names
declare -A beginnings=(
    [mathematics]='angle_|ramp_|quadrature_|box_' [parallel]='parallel_|clock_' [shape]='curve_|profile_' [rod]='rod_|edge_|actuation_'
    [reactive]='reactive_|tail_flux_' [clearance]='clearance_|neighbours_|self_crossing' [control]='control_|lead_' [durable]='durable_|plain_file_'
)

# Names with a dot or two leading underscores are the compiler's own. One nm reads all objects: "OBJECT: NAME TYPE ...".
objects=()
for source in src/*/*.c; do
    object=$build/${source#src/}
    object=${object%.c}.o
    if [[ -e $object ]]; then objects+=("$object"); else complain "$source: error: there is no $object: run 'make' first"; fi
done
while read -r object name; do
    source=src/${object#"$build"/}
    source=${source%.o:}.c
    stem=${source##*/}
    stem=${stem%.c}
    prefix=${stem%%_*}_
    [[ $stem != main ]] || prefix=main
    [[ $name =~ ^(${beginnings[$stem]-$prefix}) ]] ||
        complain "$source: error: '$name' is shared and does not begin with '$prefix': rename it or make it static"
done < <(nm -A --defined-only --extern-only --format=posix "${objects[@]}" | awk '$2 !~ /\.|^__/ { print $1, $2 }')

while read -r name; do
    complain "$build/libshoal.a: error: '$name' is global and does not begin with shoal_"
done < <(nm --defined-only --extern-only --format=posix "$build/libshoal.a" | awk 'NF > 1 && $1 !~ /^shoal_/ { print $1 }')

# complain of each line of the files that matches
refuse() {  # pattern, message, files
    local pattern=$1 remedy=$2 place
    shift 2
    while read -r place; do
        complain "$place: error: $remedy"
    done < <(grep -noP -- "$pattern" "$@" /dev/null | cut -d: -f1,2)
}

shopt -s nullglob
refuse 'assert_float_(not_)?equal' 'this compares in single precision: use NEAR' tests/*/*.c
text=(src/*/*.[ch] include/*.h tests/*.[ch] tests/*/*.[ch] tests/*.sh tests/*/*.sh scripts/*.sh scripts/*.py cases/*.yaml doc/*.md README.md .ci/run)
existing=()
for file in "${text[@]}" Makefile; do [[ ! -e $file ]] || existing+=("$file"); done
refuse '[ \t]+$' 'blank at the end of the line' "${existing[@]}"
refuse '\t' 'tab: use spaces' "${existing[@]/#Makefile//dev/null}"

# lines of at most 120 characters; tables in a program keep the columns
sources=(src/*/*.[ch] include/*.h tests/*.[ch] tests/*/*.[ch])
while read -r place; do
    complain "$place: error: longer than 120 characters"
done < <(LC_ALL=C.UTF-8 grep -nE '^.{121,}$' "${sources[@]}" | grep -v '^src/base/methods.c:' | cut -d: -f1,2)

((n_errors == 0)) || { echo "names: $n_errors errors" >&2; exit 1; }

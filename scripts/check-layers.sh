#!/usr/bin/env bash
# Check the layers of src/. Every name that a file uses, by #include or as a symbol of its object, must lie in the same
# folder or in one further up the list, and files of a folder must not depend on each other in a circle.
#
#   scripts/check-layers.sh [BUILD]      BUILD: the folder with the objects, build by default
#
# Headers and functions of external libraries may only be used in the folders named below.
set -euo pipefail

# Lowest first. doc/architecture.md states the subject of each folder.
readonly rooms=(base fish body wake control state flow force contact school case solver result view run steady study library app)

# Headers (first folder, or name without .h), the beginnings of the functions they declare, and the folders that may use
# them. base/version asks every library for its version, and calls nothing else of it.
readonly outside='
sundials|ida|kinsol|arkode|nvector|sunmatrix|sunlinsol|sunnonlinsol : IDA KIN ARK ERK N_V SUN : solver
klu|amd|colamd|btf|SuiteSparse_config|lapacke|cblas : klu_ LAPACKE_ cblas_ : solver
netcdf : nc_ : result
yaml : yaml_parser_ yaml_event_ : case
'

readonly asks_for_versions=' SUNDIALSGetVersion LAPACKE_ilaver nc_inq_libvers '

cd "$(dirname "$0")/.."
build=${1:-build}

n_errors=0
complain() {
    echo "$1" >&2
    n_errors=$((n_errors + 1))
}

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

declare -A level_of
for i in "${!rooms[@]}"; do level_of[${rooms[i]}]=$i; done

for source in src/*/*.c; do
    module=${source#src/}
    [[ -n ${level_of[${module%%/*}]-} ]] || complain "$source: error: its folder is not in the list of rooms"
    [[ -e $build/${module%.c}.o ]] || complain "$source: error: it has no object in $build: run 'make' first"
done

# ---- dependencies: "from to", both as room/module

# by includes
grep -noE '^[[:space:]]*#[[:space:]]*include[[:space:]]*"[^"]+"' src/*/*.[ch] >"$folder/headers"
sed -E 's/^src\/([^:]*)\.[ch]:([0-9]+):.*"([^"]+)\.h"/\1 \3 src\/\1/' "$folder/headers" >"$folder/includes"
# by symbols: definitions and uses
# shellcheck disable=SC2046 # one pattern for each room
nm -A --extern-only --format=posix $(printf "$build/%s/*.o " "${rooms[@]}") |
    awk -v build="$build/" '{ sub(/\.o:$/, "", $1); print substr($1, length(build) + 1), $2, $3 }' >"$folder/symbols"
awk '$3 != "U" && $3 != "w" { print $2, $1 }' "$folder/symbols" >"$folder/defined"
awk 'NR == FNR { owner[$1] = $2; next } $3 == "U" && ($2 in owner) { print $1, owner[$2], $2 }' \
    "$folder/defined" "$folder/symbols" >"$folder/uses"

cat "$folder/includes" "$folder/uses" | while read -r from to how; do
    [[ $to == shoal ]] && continue  # include/shoal.h
    [[ $from == "$to" ]] && continue
    echo "$from $to $how"
done >"$folder/edges"

while read -r from to how; do
    from_level=${level_of[${from%%/*}]} to_level=${level_of[${to%%/*}]-}
    if [[ -z $to_level ]]; then
        complain "src/$from: error: it includes \"$to.h\", which is in no room"
    elif ((to_level > from_level)); then
        complain "src/$from: error: it needs src/$to ($how): ${to%%/*} stands below ${from%%/*} in the list of rooms"
    fi
done < <(sort -u -k1,2 "$folder/edges")

# ---- no circles: of the calls between the sources of a folder, of the includes between the headers of a folder
for room in "${rooms[@]}"; do
    {
        awk '{ print $1, $2 }' "$folder/uses"
        sed -nE 's/^src\/([^:]*)\.h:[0-9]+:.*"([^"]+)"/\1.h \2/p' "$folder/headers"
    } | awk -v room="$room/" 'index($1, room) == 1 && index($2, room) == 1 && $1 != $2' | sort -u >"$folder/room"
    if ! tsort "$folder/room" >/dev/null 2>"$folder/circle"; then
        complain "src/$room: error: files need each other in a circle: $(sed -n 's/^tsort: \([a-z]*\/\)/\1/p' \
            "$folder/circle" | tr '\n' ' ')"
    fi
done

# ---- outside libraries
while IFS=: read -r headers functions users; do
    [[ -n ${headers// /} ]] || continue
    allowed=" $users "
    while IFS=: read -r file line _; do
        room=$(cut -d/ -f2 <<<"$file")
        [[ $allowed == *" $room "* || $file == src/base/version.c ]] ||
            complain "$file:$line: error: only${users% } may include this library"
    done < <(grep -nE "^[[:space:]]*#[[:space:]]*include[[:space:]]*<(${headers// /})[./]" src/*/*.[ch] || true)
    for function in $functions; do
        while read -r module name _; do
            [[ $module != base/version || $asks_for_versions != *" $name "* ]] || continue
            [[ $allowed == *" ${module%%/*} "* ]] ||
                complain "src/$module.c: error: it calls $name, which only$users may"
        done < <(awk -v name="$function" '$3 == "U" && index($2, name) == 1' "$folder/symbols")
    done
done <<<"$outside"

((n_errors == 0)) || { echo "layers: $n_errors errors" >&2; exit 1; }

#!/usr/bin/env bash
# Prove that each #include in src/ goes to a lower layer, and that outside libraries stay where they belong.
#
# A module is src/x.c and src/x.h; src/x_more.c and src/x_more.h belong to x too. A new module is entered here, in the
# lowest layer above all that it includes. doc/architecture.md says what each module is for.
set -euo pipefail

readonly layers='
 1  status version
 2  yaml kernel sparse smooth
 3  settings vortices tree
 4  fish mutual summation
 5  rod actuation wake control carry
 6  state
 7  forecast
 8  flow
 9  sheet drag jacobian
10  residual
11  measure linear
12  bridge store checkpoint
13  consistent direct newton
14  integrator event
15  implicit explicit fixed
16  simulate
17  study compare view
18  progress shoal
19  main
'

# Includes inside one layer that are allowed, as "from>to".
readonly same_layer=''

# Outside headers (their first folder, or their name without .h) and the modules that may include them.
readonly solver_users='linear bridge consistent direct newton implicit explicit'
readonly outside="
sundials ida kinsol arkode nvector sunmatrix sunlinsol sunnonlinsol : $solver_users
klu amd colamd btf SuiteSparse_config : $solver_users
netcdf : store checkpoint
yaml : yaml
"

# Who may ask the libraries for their versions, and the headers that this takes.
readonly version_users='main version store'
readonly version_headers='sundials/sundials_version.h sundials/sundials_config.h klu.h netcdf.h yaml.h zlib.h'

cd "$(dirname "$0")/.."

declare -A layer_of users_of
while read -r number modules; do
    for module in $modules; do layer_of[$module]=$number; done
done <<<"$layers"
while IFS=: read -r headers users; do
    for header in $headers; do users_of[$header]=$users; done
done <<<"$outside"

n_errors=0
complain() {
    echo "$1" >&2
    n_errors=$((n_errors + 1))
}

has_word() {  # word, list of words
    [[ " $2 " == *" $1 "* ]]
}

# The module that a file belongs to: wake.c -> wake, settings_table.c -> settings. The result is in $module.
find_module() {
    module=$(basename "${1%.[ch]}")
    [[ -n ${layer_of[$module]-} ]] || module=${module%%_*}
}

check_own() {  # place, module, included file
    local from=$2
    find_module "$3"
    if [[ -z ${layer_of[$module]-} ]]; then
        complain "$1: error: no layer is known for \"$3\": enter '$module' in scripts/check-layers.sh"
    elif [[ $module == "$from" ]] || has_word "$from>$module" "$same_layer"; then
        return
    elif ((layer_of[$module] >= layer_of[$from])); then
        complain "$1: error: $from (layer ${layer_of[$from]}) includes $module (layer ${layer_of[$module]}): only a\
 lower layer may be included"
    fi
}

check_outside() {  # place, module, included header
    local library=${3%%/*}
    local users=${users_of[${library%.h}]-}
    if [[ -z $users ]] || has_word "$2" "$users"; then return; fi
    if has_word "$2" "$version_users" && has_word "$3" "$version_headers"; then return; fi
    complain "$1: error: $2 includes <$3>, which only${users% } may"
}

for file in src/*.[ch] include/*.h; do
    [[ -e $file ]] || continue
    find_module "$file"
    owner=$module
    if [[ -z ${layer_of[$owner]-} ]]; then
        complain "$file: error: no layer is known for '$owner': enter it in scripts/check-layers.sh"
        continue
    fi
    while IFS=: read -r line text; do
        if [[ $text =~ \"([^\"]+)\" ]]; then
            check_own "$file:$line" "$owner" "${BASH_REMATCH[1]}"
        elif [[ $text =~ \<([^>]+)\> ]]; then
            check_outside "$file:$line" "$owner" "${BASH_REMATCH[1]}"
        fi
    done < <(grep -nE '^[[:space:]]*#[[:space:]]*include' "$file" || true)
done

((n_errors == 0)) || { echo "layers: $n_errors errors" >&2; exit 1; }

#!/usr/bin/env bash
# The documents that are made from the tables of the program (manual pages, completion, the schema of cases) agree with
# these tables.
#
#   tests/extra/test_manual.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

run --describe
check the_program_describes_itself /usr/bin/python3 -m json.tool out
cp out about.json
"$program" keys --json >keys.json
"$program" keys --output --json >variables.json

# ---- pages of the manual

page() { /usr/bin/python3 "$root/scripts/make-man.py" "$1" <"$2" >"$1"; }
check page_of_the_program page shoal.1 about.json
check page_of_cases page shoal-case.5 keys.json
check page_of_results page shoal-output.5 variables.json
# roff accepts the page with all warnings enabled
no_warnings() { groff -man -Tutf8 -ww -z "$1" >warnings 2>&1 && [[ ! -s warnings ]] || { cat warnings; false; }; }
no_complaints() { mandoc -T lint -W warning "$1" >warnings 2>&1 && [[ ! -s warnings ]] || { cat warnings; false; }; }
for name in shoal.1 shoal-case.5 shoal-output.5; do
    check_with groff "no_warnings_of_groff $name" no_warnings $name
    check_with mandoc "no_warnings_of_mandoc $name" no_complaints $name
done
# without colours, which col keeps
shown() { GROFF_NO_SGR=1 man --warnings -E UTF-8 -l "$1" 2>errors | col -b >"$1.txt" && [[ ! -s errors ]]; }
check_with man man_shows_the_page shown shoal.1
check_with man with_commands_and_options grep -qE -- '--members A-B' shoal.1.txt
# man justifies lines with blanks
check_with man with_exit_codes grep -qE '^ +75 +stopped +by +a +signal' shoal.1.txt
check every_command_is_there test "$(grep -c '^\.SS' shoal.1)" = "$("$program" --help | grep -E "^  [a-z]" | grep -cv "^  shoal")"
check every_key_is_there test "$(grep -cE '^\.TP' shoal-case.5)" = "$(grep -c '"path"' keys.json)"
check every_variable_is_there test "$(grep -cE '^\.TP' shoal-output.5)" = "$(grep -c '"name"' variables.json)"
check keys_are_those_that_set_takes grep -qF 'fish[i].wave.frequency' shoal-case.5
: >nothing.json
check nothing_is_no_page test ! "$(page shoal.1 nothing.json 2>errors && echo made)"

# ---- the documents in doc/

documents_match() { diff <("$root/scripts/$1" <"$2") "$root/doc/$3"; }
check the_keys_are_those_of_the_document documents_match make-cases-doc.py keys.json cases.md
check the_variables_are_those_of_the_document documents_match make-output-doc.py variables.json output.md
check the_schema_is_the_one_of_the_document documents_match make-schema.py keys.json case.schema.json

# ---- completion

/usr/bin/python3 "$root/scripts/make-completion.py" about.json keys.json >completion
touch swim.yaml swim.nc swim.txt
mkdir swimming
# The completions of a line, sorted, in one line.
complete_line() {
    bash --norc -c '
        . ./completion
        COMP_LINE=$1 COMP_POINT=${#1}
        read -ra COMP_WORDS <<<"${1//=/ = }"
        [[ $1 != *" " && $1 != *= ]] || COMP_WORDS+=("")
        COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
        _shoal 2>errors
        printf "%s\n" "${COMPREPLY[@]}" | sort | tr "\n" " "' bash "$1"
}
completes() {  # line, completions
    local got
    got=$(complete_line "$1")
    [[ $got == "$2 " ]] || { echo "'$1' is completed to '$got'"; false; }
}
check commands_are_completed completes 'shoal ch' 'check'
check commands_are_completed_for_help completes 'shoal help st' 'steady study'
check options_are_completed completes 'shoal study --s' '--set --slurm --strict'
check options_of_this_command_only completes 'shoal info --s' ''
check cases_are_completed completes 'shoal run swim' 'swim.yaml swimming/'
check results_are_completed completes 'shoal view swim' 'swim.nc swimming/'
check keys_are_completed completes 'shoal run swim.yaml --set time.e' 'time.end='
check keys_of_fish_are_completed completes 'shoal run --set fish[0].drag.l' 'fish[0].drag.law= fish[0].drag.linear_speed='
check words_of_keys_are_completed completes 'shoal run --set fish[0].drag.law=q' 'quadratic'
check folders_are_completed completes 'shoal export swim.nc --vtk swi' 'swimming'
check numbers_are_not completes 'shoal study -j ' ''

# ---- the schema

run keys --json
"$root/scripts/make-schema.py" <out >schema.json
check the_schema_is_that_of_doc diff schema.json "$root/doc/case.schema.json"
validate() { timeout "$time_limit" /usr/bin/python3 "$root/tests/extra/validate_cases.py" "$@" >wrong 2>&1 && [[ ! -s wrong ]] || { cat wrong; false; }; }
check_with 'import jsonschema' all_cases_are_valid validate "$root"/cases/*.yaml "$root"/cases/*/*.yaml
cat >wrong.yaml <<'end'
format: 1
time: {end: -1}
fluid: {densty: 1000}
sheet: {kutta: none}
fish: [{nodes: 3.5, wave: {frequency: fast}, start: {position: [1]}}]
end
validate wrong.yaml >/dev/null
for error in "time.end: -1 is less than or equal to the minimum of 0" "'densty' was unexpected" "'none' is not one of" \
    "fish.0.nodes: 3.5 is not" "frequency: 'fast' is not of type" "[1] is too short"; do
    check_with 'import jsonschema' "the_schema_finds: $error" grep -qF -- "$error" wrong
done
# editors find the schema by the first line of a case
names_schema() {
    local case path
    for case in "$root"/cases/*.yaml "$root"/cases/*/*.yaml; do
        path=$(sed -n '1s/^# yaml-language-server: \$schema=//p' "$case")
        [[ -n $path && $(realpath "$(dirname "$case")/$path") == "$root/doc/case.schema.json" ]] || { echo "$case"; return 1; }
    done
}
check every_case_names_the_schema names_schema

finish

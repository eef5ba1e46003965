#!/usr/bin/env bash
# Wrong files and wrong assignments lead to the message and the exit code that they should, and to nothing else. The many
# wrong cases that are lines of text are in test_bad_cases.c.
#
#   tests/case/test_bad.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

# Run `check` with the arguments; sets $code, and leaves the files out and err.
run() {
    code=0
    "$program" check "$@" >out 2>err </dev/null || code=$?
}

# Complain unless the last run ended with a code and printed nothing on standard output.
ended_with() {  # name, code
    if ((code != $2)); then
        fail "$1" "exit code $code instead of $2: $(head -c 600 err)"
    elif [[ -s out ]]; then
        fail "$1" "printed on standard output: $(head -c 300 out)"
    else
        return 0
    fi
    return 1
}

# One case: name, exit code, text that must be in the message, arguments of check.
expect() {
    local name=$1 want_code=$2 text=$3
    shift 3
    run "$@"
    ended_with "$name" "$want_code" || return
    check "$name" has err "$text"
}

# ---- files

printf 'format: 1\ntime: {end: 1}\nfish:\n  - {name: a}\n  - {name: b, start: {position: [0, 2]}}\n' >good.yaml
repeat() {  # text, count
    yes -- "$1" 2>/dev/null | head -n "$2" | tr -d '\n'
}
repeat_line() {  # text, count
    yes -- "$1" 2>/dev/null | head -n "$2"
}

run good.yaml
if ((code == 0)) && [[ ! -s err ]]; then pass good_case; else fail good_case "exit code $code: $(<err)"; fi

printf 'format: 1\ntime: {end: 1, dt: 2}\nfish: [{nodes: 2}]\n' >two.yaml
run two.yaml
if ended_with two_errors 2; then
    check two_errors cmp err - <<'end'
two.yaml:2:16: error: time.dt: unknown key; did you mean 'shedding_interval'?
time: {end: 1, dt: 2}
               ^
two.yaml:3:16: error: fish[0].nodes: must be from 4 to 10000, got 2
fish: [{nodes: 2}]
               ^
end
fi
cat >on_top.yaml <<'end'
format: 1
time: {end: 1}
fish:
  - {name: a}
  - {name: b, control: {law: place, of: a, offset: [1.4, 0.3]}, start: {position: [1.4, 0.3]}}
  - {name: c, control: {law: place, of: b, offset: [-1.3, -0.3]}, start: {position: [0, 2]}}
end
expect a_place_on_top_of_a_fish 2 'error: fish[2] (c) would hold its place on top of fish[0] (a): change control.offset' on_top.yaml
expect missing_file 4 'no_such.yaml: error: the case file cannot be read: No such file or directory' no_such.yaml
expect missing_folder 4 'the case file cannot be read' no_such_folder/good.yaml
expect file_as_folder 4 'the case file cannot be read: Not a directory' good.yaml/case.yaml
expect folder 4 '.: error: the case file is a folder, not a case file' .

cp good.yaml locked.yaml
chmod 000 locked.yaml
printf 'include: [locked.yaml]\nformat: 1\n' >include_locked.yaml
if [[ -r locked.yaml ]]; then
    skip unreadable_file 'this user may read everything'
    skip unreadable_include 'this user may read everything'
else
    expect unreadable_file 4 'locked.yaml: error: the case file cannot be read: Permission denied' locked.yaml
    expect unreadable_include 2 'include: locked.yaml: cannot be read: Permission denied' include_locked.yaml
fi

: >empty.yaml
expect empty_file 2 'empty.yaml:1:1: error: the file is empty; a case needs at least format, time and fish' empty.yaml
expect no_bytes_ever 2 'the file is empty' /dev/null
printf 'include: [/proc/kmsg]\nformat: 1\n' >include_kernel.yaml
expect a_file_of_the_kernel_is_not_waited_for 2 '/proc/kmsg' include_kernel.yaml
printf 'format: 1\nname: "\0\1\2"\n' >binary.yaml
expect binary_file 2 'binary.yaml:2:8: error: not a text file (control character 0x00); is this a case file?' binary.yaml
printf 'format: 1\nname: caf\351\n' >latin1.yaml
expect latin1_file 2 'latin1.yaml:2:10: error: not valid UTF-8 (byte 0xE9)' latin1.yaml
printf '\377\376f\0o\0' >utf16.yaml
expect utf16_file 2 'utf16.yaml:1:1: error: not valid UTF-8 (byte 0xFF)' utf16.yaml
printf 'name: \355\240\200\n' >surrogate.yaml
expect surrogate_in_utf8 2 'surrogate.yaml:1:7: error: not valid UTF-8' surrogate.yaml
printf 'format: 1\r\ntime:\r\n  end: 1\r\n  ned: 2\r\n' >crlf.yaml
expect lines_that_end_in_crlf 2 "crlf.yaml:4:3: error: time.ned: unknown key; did you mean 'end'?" crlf.yaml
printf '\357\273\277formt: 1\n' >mark.yaml
expect byte_order_mark 2 "mark.yaml:1:1: error: formt: unknown key; did you mean 'format'?" mark.yaml

repeat_line '# a comment of 32 bytes in total' 160000 >large.yaml
expect file_of_5_mib 2 'large.yaml:1:1: error: larger than 4 MiB; is this a case file?' large.yaml
repeat '[' 4000000 >brackets.yaml
expect brackets_without_end 2 'brackets.yaml:1:33: error: nested deeper than 32 levels' brackets.yaml
repeat '{' 4000000 >braces.yaml
expect braces_without_end 2 'a key must be a plain word' braces.yaml
repeat '- ' 2000000 >dashes.yaml
expect dashes_without_end 2 'dashes.yaml:1:65: error: nested deeper than 32 levels' dashes.yaml
for ((i = 0; i < 100; i++)); do printf '%*sa:\n' "$i" ''; done >deep.yaml
expect a_hundred_levels 2 'deep.yaml:33:33: error: nested deeper than 32 levels' deep.yaml
seq -f 'key%.0f: 1' 300 >keys.yaml
expect three_hundred_keys 2 'keys.yaml:257:1: error: more than 256 keys in one map' keys.yaml
{ cat good.yaml; repeat_line '  - {}' 20000; } >school.yaml
expect twenty_thousand_fish 2 'fish: more than 10000 fish' school.yaml
{ cat good.yaml; printf '    control: {law: heading, waypoints: ['; repeat '[1, 2], ' 20000; echo ']}'; } |
    sed 's/  - {name: b.*/  - name: b/' >waypoints.yaml
{ cat good.yaml; printf '  - wave: {table: ['; repeat '[1, 2, 3, 4], ' 2501; echo ']}'; } >table.yaml
expect ten_thousand_and_four_numbers 2 'fish[2].wave.table: more than 10000 values' table.yaml
expect twenty_thousand_waypoints 2 'fish[1].control.waypoints: more than 10000 values' waypoints.yaml
{ echo 'format: 1'; echo 'time: {end: 1}'; echo 'fish: [{}]'; echo 'sweep:'
  for key in solver.order solver.max_steps; do echo "  - {key: $key, values: [$(repeat '1,' 50000)]}"; done
  echo 'expect: [{of: speed, least: 0, where: [solver.order=1]}]'; } >members.yaml
expect members_beyond_integers 2 'members.yaml:5:3: error: sweep: 2500000000 members or more; the maximum is 100000' members.yaml
if [[ $(grep -c error: err) == 1 ]]; then pass only_their_number_is_wrong; else fail only_their_number_is_wrong "$(cut -c1-200 err)"; fi
{ cat good.yaml; printf 'name: '; repeat x 300; echo; } >name.yaml
expect name_of_300_bytes 2 'name.yaml:6:7: error: name: longer than 200 bytes' name.yaml

for ((i = 0; i < 12; i++)); do echo "include: [chain$((i + 1)).yaml]" >"chain$i.yaml"; done
expect includes_too_deep 2 'include: more than 64 files, or nested more than 8 deep' chain0.yaml
printf 'include: [two.yaml, two.yaml]\n' >one.yaml
printf 'include: [one.yaml]\n' >two.yaml
expect includes_in_a_circle 2 'two.yaml:1:11: error: include: one.yaml includes itself' one.yaml
{ printf 'include: ['; repeat 'good.yaml, ' 100; echo ']'; } >many.yaml
expect a_hundred_includes 2 'include: more than 64 files' many.yaml

# ---- the command line

set_fails() {  # name, text, assignment...
    local name=$1 text=$2 arguments=()
    shift 2
    for assignment in "$@"; do arguments+=(--set "$assignment"); done
    expect "$name" 2 "$text" good.yaml "${arguments[@]}"
}

set_fails set_unknown_key \
    "--set fish[0].stifness=3: error: fish[0].stifness: unknown key; did you mean 'modulus'? The key belongs to fish[0].body" \
    'fish[0].stifness=3'
set_fails set_unknown_section "--set tiem.end=3: error: tiem.end: unknown key; did you mean 'time'?" tiem.end=3
set_fails set_no_equals_sign '--set time.end: error: expects PATH=VALUE, as in --set time.end=3' time.end
set_fails set_nothing '--set : error: expects PATH=VALUE' ''
set_fails set_no_path '--set =3: error: : unknown key; known keys: format, name' =3
set_fails set_index_out_of_range 'fish[2]: there is no such fish; the case has 2, the last is fish[1]' 'fish[2].nodes=7'
set_fails set_index_huge 'fish[99999999999999999999]: there is no such fish' 'fish[99999999999999999999999].nodes=7'
set_fails set_index_negative 'fish[-1]: there is no fish of this name; write the number of a fish' 'fish[-1].nodes=7'
set_fails set_name_unknown 'fish[leadr]: there is no fish of this name; did you mean fish[leader]?' 'fish[1].name=leader' 'fish[leadr].nodes=7'
set_fails set_name_empty 'fish[].nodes: expects the number or the name of a fish' 'fish[].nodes=7'
set_fails sweep_key_of_a_name 'sweep[1].key: sweep[0] has this key too' 'fish[1].name=leader' \
    'sweep=[{key: "fish[leader].wave.phase", values: [0, 90]}, {key: "fish[1].wave.phase", values: [0, 90]}]'
set_fails set_index_missing 'fish.nodes: write fish[0].nodes for one fish, or fish[*].nodes for every fish' fish.nodes=7
set_fails set_index_after_a_dot '--set fish.0.length=2: error: fish.0.length: write fish[0].length' fish.0.length=2
set_fails set_index_for_a_key '--set fish.0=2: error: fish.0: write fish[0]' fish.0=2
if grep -q 'for one fish' err; then fail set_index_needs_no_other "$(<err)"; else pass set_index_needs_no_other; fi
set_fails set_star_after_a_dot 'fish.*.wave.phase: write fish[*].wave.phase' 'fish.*.wave.phase=2'
set_fails set_in_another_section 'unknown key here; the key belongs to fish[0].wave or fish[0].motion' 'fish[0].body.frequency=2'
set_fails set_in_one_other_section 'unknown key here; the key belongs to fish[0].body' 'fish[0].wave.modulus=2'
set_fails set_viscosity "has no effect: all fish have 'drag.skin: quadratic' with the coefficient drag.tangential" 'fish[*].force=reactive' fluid.viscosity=1e-3
set_fails set_reynolds 'the friction is set by drag.tangential of a fish, or by fluid.viscosity with' fluid.reynolds=1000
set_fails set_a_letter_beside_mu 'fluid.u: unknown key; known keys: density' fluid.u=1
for open in 0 '*'; do set_fails "set_index_open $open" 'expects the number or the name of a fish, as in fish[0]' "fish[$open=7"; done
set_fails set_no_dot_after_index "fish[0]nodes: expects a '.' after the ']'" 'fish[0]nodes=7'
set_fails set_below_a_value 'time.end.x: time.end is a value and has no keys' time.end.x=3
set_fails set_mistyped '--set time.end=soon: error: time.end: expects a number in s, or beats as in '"'20 beats' or '1/50 beat', got 'soon'" time.end=soon
set_fails set_out_of_range '--set fish[*].nodes=3: error: fish[1].nodes: must be from 4 to 10000, got 3' 'fish[*].nodes=3'
set_fails set_empty "--set time.end=: error: time.end: expects a number in s, or beats as in '20 beats' or '1/50 beat', got nothing" time.end=
set_fails set_blank "--set time.end= : error: time.end: expects a number in s, or beats as in '20 beats' or '1/50 beat', got nothing" 'time.end= '
set_fails set_bad_yaml "needs ',' between values and ends with ']'" 'fish[0].start.position=[1'
set_fails set_only_a_comment "expects a value after the '='" 'name=# eel'
set_fails set_unknown_key_in_map "fish[0].wave.amplitud: unknown key; did you mean 'amplitude'?" 'fish[0].wave={amplitud: 1}'
set_fails set_include '--set include=[a.yaml]: error: include: is allowed in case files only' 'include=[a.yaml]'
set_fails set_inconsistent '--set wake.decay=9: error: wake.decay: 9 s is longer than wake.lifetime, 8 s' wake.decay=9
set_fails set_twice_the_last_counts 'time.end: expects a number in s, or beats as in '"'20 beats' or '1/50 beat', got 'b'" time.end=1 time.end=b
set_fails set_section_to_a_value "--set wake=3: error: wake: expects a section with keys, got '3'" wake=3
expect set_and_bad_file 2 "time.ned: unknown key" crlf.yaml --set nmae=3

# ---- out of memory

# enough for a small case, but not for the tree of four megabytes of values
{ echo 'a: ['; repeat 'a,' 2000000; echo ']'; } >values.yaml
if grep -q __asan_init "$program"; then
    skip out_of_memory 'the address sanitizer needs all addresses'
elif ! (ulimit -v 240000 && "$program" check good.yaml) >out 2>err; then
    skip out_of_memory 'even a small case needs more'
else
    code=0
    (ulimit -v 240000 && exec "$program" check values.yaml) >out 2>err || code=$?
    if ended_with out_of_memory 4; then
        if grep -q 'out of memory' err; then pass out_of_memory; else fail out_of_memory "$(<err)"; fi
    fi
fi

finish

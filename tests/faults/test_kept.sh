#!/usr/bin/env bash
# What is there stays. No command replaces its input or a file of another program, and what shoal wrote is replaced with
# --force only, and only once the new file is whole.
#
#   tests/faults/test_kept.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

cat >swimmer.yaml <<'end'
format: 1
name: swimmer
time: {end: 0.1, shedding_interval: 0.02, output_interval: 0.02}
fish: [{force: reactive, nodes: 7, sheet_points: 9, body: {tail_thickness: 0.3}}]
end
cat >still.yaml <<'end'
format: 1
name: still
time: {end: 1, shedding_interval: 0.1}
fish: [{force: reactive, nodes: 7, sheet_points: 9, body: {tail_thickness: 0.3}, wave: {frequency: 1}}]
steady: {beats: 3}
end
run run swimmer.yaml -q -o good.nc
cp good.nc kept.nc

unchanged() { cmp -s "$1" "$2"; }

# ---- an input is never an output

cp swimmer.yaml case.yaml
refused run_does_not_replace_its_case 4 'case.yaml exists and is no NetCDF file of shoal' run case.yaml -q -o case.yaml --force
check the_case_stays unchanged case.yaml swimmer.yaml
for command in view field; do
    refused "$command does not replace its run" 4 'good.nc is the file that is read' $command good.nc -q -o good.nc --force
    check "the run stays ($command)" unchanged good.nc kept.nc
done
ln good.nc second.nc
refused field_does_not_replace_its_run_under_another_name 4 'is the file that is read' field good.nc -o second.nc --force
run steady still.yaml -q -o from.nc --set steady.beats=300
cp from.nc from.kept
refused steady_does_not_replace_the_state_that_it_starts_from 4 'from.nc is the file that is read' steady still.yaml -q \
    --from from.nc -o from.nc --force
check the_state_stays unchanged from.nc from.kept

# ---- files of others

texts=('mine' 'CDF of another program' '<!DOCTYPE html> of another program' '<?xml version="1.0"?> of another program')
for text in "${texts[@]}"; do
    echo "$text" >foreign
    cp foreign foreign.kept
    refused "run does not replace '$text'" 4 'no option replaces the file' run swimmer.yaml -q -o foreign --force
    refused "field does not replace '$text'" 4 'no option replaces the file' field good.nc -q -o foreign --force
    refused "view does not replace '$text'" 4 'no option replaces the file' view good.nc -q -o foreign --force
    refused "steady does not replace '$text'" 4 'no option replaces the file' steady still.yaml -q -o foreign --force
    refused "compare does not replace '$text'" 4 'no option replaces the file' compare swimmer.yaml -q -o foreign --force
    check "the file stays ('$text')" unchanged foreign foreign.kept
done
refused a_page_does_not_replace_a_run 4 'kept.nc exists and is no page of shoal' view good.nc -q -o kept.nc --force
check the_other_run_stays unchanged good.nc kept.nc
mkdir vtk
echo mine | tee vtk/good-bodies-0002.vtp >vtk.kept
refused export_replaces_no_foreign_file 4 'vtk/good-bodies-0002.vtp exists and is no file of VTK' export good.nc -q --vtk vtk \
    --force
check the_foreign_file_stays unchanged vtk/good-bodies-0002.vtp vtk.kept
: >empty.nc
run run swimmer.yaml -q -o empty.nc --force
check an_empty_file_is_replaced test "$code" = 0 -a -s empty.nc
for again in run view field; do
    case $again in
        run) arguments=(run swimmer.yaml -q -o again.nc) ;;
        view) arguments=(view good.nc -q -o again.html) ;;
        field) arguments=(field good.nc -q --grid 3,3 -o again-field.nc) ;;
    esac
    run "${arguments[@]}"
    run "${arguments[@]}" --force
    check "$again --force replaces its own file" test "$code" = 0
done
run export good.nc -q --vtk own
run export good.nc -q --vtk own --force
check export_replaces_its_own_files test "$code" = 0

# ---- files with the name under which another file is made

echo precious >precious
cp precious precious.kept
for arguments in 'view good.nc -q -o page.html' 'field good.nc -q --grid 3,3 -o page.html' 'run swimmer.yaml -q -o page.html'; do
    for kind in link file; do
        rm -f page.html.part
        if [[ $kind == link ]]; then ln -s precious page.html.part; else cp precious page.html.part; fi
        # shellcheck disable=SC2086 # several arguments
        refused "a $kind is no part: $arguments" 4 'page.html.part exists and is no file of shoal' $arguments
        check "nothing is written through a link: $arguments" unchanged precious precious.kept
        check "the $kind stays: $arguments" unchanged page.html.part precious.kept
        check "and no other file: $arguments" test ! -e page.html
    done
done
rm page.html.part

# ---- the demonstration

here=$(dirname "$program")/..
if [[ -e $here/cases/demo.yaml ]]; then
    for file in demo.nc demo.png demo.html; do
        mkdir demo && (cd demo && cp ../precious "$file" && ! "$program" demo -q >../out 2>../err)
        code=$?
        check "demo does not replace $file" eval '((code == 0)) && unchanged demo/$file precious && (($(ls demo | wc -l) == 1))'
        (cd demo && ! "$program" demo -q --force >../out 2>../err)
        code=$?
        check "nor with --force" eval '((code == 0)) && unchanged demo/$file precious && (($(ls demo | wc -l) == 1))'
        rm -r demo
    done
    (mkdir demo && cd demo && "$program" demo -q >../out 2>../err)
    check demo_works_in_an_empty_folder_and_quietly test $? = 0 -a ! -s out -a -s demo/demo.html
    (cd demo && ! "$program" demo -q >../out 2>../err)
    check demo_does_not_replace_its_own_files_unless_told test $? = 0
    # a Python of another place before the system's in PATH, such as that of conda or pyenv
    library=$(/usr/bin/python3 "$root/tests/faults/place_of_os.py")
    mkdir -p other/bin "$(dirname "other/${library#/usr/}")"
    cp "$library" "other/${library#/usr/}"
    cp /bin/true other/bin/python3
    (cd demo && PATH="$folder/other/bin:$PATH" "$program" demo -q --force >../out 2>../err)
    check demo_replaces_its_own_files_when_told_with_the_python_of_the_system_whatever_the_path test $? = 0 -a demo/demo.png -nt other
fi

# ---- parts of runs that died

cp good.nc late.nc.part
run run swimmer.yaml -q -o late.nc
check the_part_of_a_run_that_died_is_used_again test "$code" = 0 -a -s late.nc -a ! -e late.nc.part
cp good.nc late.nc.part
refused a_run_that_is_refused_leaves_no_part 4 'late.nc exists' run swimmer.yaml -q -o late.nc
check nor_the_part_of_a_run_that_died test ! -e late.nc.part

# ---- an old result stays until there is a new one

run steady still.yaml -q -o steady.nc --force --set steady.beats=300
cp steady.nc steady.kept
run steady still.yaml -q -o steady.nc --force --set steady.beats=3
check a_search_that_fails_leaves_the_state_that_is_there eval '((code == 1)) && unchanged steady.nc steady.kept'
run steady still.yaml -q -o none.nc --set steady.beats=3
check where_there_is_none_the_file_says_why eval '((code == 1)) && has <("$program" info none.nc) "failed: "'
"$program" steady still.yaml -q -o steady.nc --force --set steady.beats=10000 --set steady.tolerance=1e-10 >out 2>err \
    </dev/null &
pid=$!
wait_for eval 'ls steady.nc.part || ! kill -0 $pid'
kill -KILL $pid
wait $pid 2>/dev/null
check a_search_that_is_killed_leaves_a_part test -e steady.nc.part
pid=
check a_search_that_is_killed_leaves_the_state_that_is_there unchanged steady.nc steady.kept
run steady still.yaml -q -o steady.nc --force --set steady.beats=300
check the_next_search_removes_what_that_one_left eval '((code == 0)) && test ! -e steady.nc.part'

# ---- two results have two checkpoints

run run swimmer.yaml -q -o a.nc --checkpoint-at 0.04
run run swimmer.yaml -q -o a --checkpoint-at 0.06
check a_result_without_an_ending_leaves_the_checkpoint_of_the_other has <("$program" info a.ckpt) 'the result is a.nc'
run resume a.ckpt -q --end 0.12
check the_first_is_resumed test "$code" = 0
run resume a.checkpoint -q --end 0.14
check the_second_is_resumed test "$code" = 0
cp a.ckpt good.ckpt
refused a_checkpoint_of_another_result_stays 4 'good.ckpt is a checkpoint of a.nc' run swimmer.yaml -q -o good.nc --force
check its_bytes_stay eval 'unchanged a.ckpt good.ckpt && unchanged good.nc kept.nc'

finish

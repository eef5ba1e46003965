#!/usr/bin/env bash
# The program writes only regular files of its own and touches nothing else, whatever names and links it meets, and
# executes no name as a command.
#
#   tests/extra/test_names.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

cat >swimmer.yaml <<'end'
format: 1
name: swimmer
time: {end: 0.04, shedding_interval: 0.02, output_interval: 0.02}
fish: [{}]
end
{ cat swimmer.yaml && echo 'sweep: [{key: "fish[*].wave.amplitude", values: [0.2, 0.3]}]'; } >study.yaml
mkdir study && mv study.yaml study/case.yaml
precious() { [[ $(<precious) == precious ]]; }
echo precious >precious

# ---- run -o

ln -s precious link.nc
ln -s nowhere dangling.nc
mkfifo fifo.nc
for name in link dangling; do
    for force in '' --force; do
        # shellcheck disable=SC2086 # no option if the variable is empty
        refused "run $force does not replace a link ($name)" 4 'is a link' run swimmer.yaml -q $force -o $name.nc
    done
    check "the link stays ($name)" test -L $name.nc
done
check what_a_link_points_to_is_untouched precious
refused run_refuses_a_fifo 4 'is not an ordinary file' run swimmer.yaml -q --force -o fifo.nc
refused info_refuses_a_fifo 4 'not an ordinary file' info fifo.nc
refused run_does_not_wait_for_a_case_from_a_fifo 2 'fifo.nc' run fifo.nc
run run <(cat swimmer.yaml) -q -o pipe.nc
check a_case_comes_from_a_pipe test "$code" = 0 -a -s pipe.nc
if ((EUID == 0)) && mknod device c 1 3 2>/dev/null; then
    refused run_refuses_a_device 4 'is not an ordinary file' run swimmer.yaml -q --force -o device
    refused compare_refuses_a_device 4 'is not an ordinary file' compare swimmer.yaml -q --force -o device
    check the_device_stays test -c device
else
    skip a_device 'only root makes one'
fi
refused compare_finds_a_missing_folder_first 4 'there is no folder no/such' compare swimmer.yaml -o no/such/x.nc
check and_has_not_begun test ! -s out

# the name under which a result is made
ln -s precious part.nc.part
refused run_refuses_a_link_as_part 4 'part.nc.part exists and is no file of shoal' run swimmer.yaml -q -o part.nc
check nothing_is_written_through_a_part precious
check the_link_stays test -L part.nc.part
rm part.nc.part && ln precious part.nc.part
refused run_refuses_a_second_name_as_part 4 'part.nc.part exists and is no file of shoal' run swimmer.yaml -q -o part.nc
check nothing_is_written_to_another_name_of_a_part precious
rm part.nc.part && mkfifo part.nc.part
refused run_refuses_a_fifo_as_part 4 'part.nc.part exists and is no file of shoal' run swimmer.yaml -q -o part.nc
rm part.nc.part

# ---- studies

mkdir linked
ln -s ../precious linked/member-0000.failed
ln -s ../precious linked/member-0001.failed
run study study/case.yaml -o linked --set solver.max_steps=1
check reasons_are_not_written_through_links precious
check reasons_are_written grep -q 'limited by solver.max_steps' linked/member-0001.failed
rm linked/member-0000.failed && mkfifo linked/member-0000.failed
run gather linked
check gather_does_not_wait_for_a_fifo test "$code" = 1

for foreign in text netcdf; do
    rm -rf foreign && mkdir foreign
    case $foreign in
        text) cp precious foreign/member-0000.nc ;;
        netcdf) ncgen -o foreign/member-0000.nc - <<<'netcdf x { dimensions: a = 3 ; }' ;;
    esac
    cp foreign/member-0000.nc before
    refused "a foreign member stays ($foreign)" 4 'is no NetCDF file of shoal' study study/case.yaml -q -o foreign
    check "it is untouched ($foreign)" cmp before foreign/member-0000.nc
    refused "nor does --force replace it ($foreign)" 4 'is no NetCDF file of shoal' study study/case.yaml -q -o foreign --force
    check "it is still untouched ($foreign)" cmp before foreign/member-0000.nc
    rm foreign/member-0000.nc && cp before foreign/member-0002.nc
    refused "one behind the last member stays ($foreign)" 4 'is a result of another study' study study/case.yaml -q \
        -o foreign --force
    check "it too is untouched ($foreign)" cmp before foreign/member-0002.nc
    rm foreign/member-0002.nc && cp before foreign/study.nc
    refused "a foreign study.nc stays ($foreign)" 4 'no option replaces the file' study study/case.yaml -q -o foreign --force
    check "that is found before a member runs ($foreign)" test ! -e foreign/member-0000.nc
    rm foreign/study.nc
done
run study study/case.yaml -o foreign
truncate -s -100 foreign/member-0000.nc
run study study/case.yaml -o foreign
check a_cut_member_runs_again test "$code" = 0
mkdir gathers && ln -s ../precious gathers/study.nc
refused study_nc_that_is_a_link 4 'is a link' study study/case.yaml -o gathers
check and_its_target_stays precious

# ---- scripts of Slurm

mkdir -p own && cp study/case.yaml own/study.yaml
refused a_study_yaml_of_the_user 4 'was not written by shoal' study own/study.yaml --slurm -o own
check it_is_untouched cmp study/case.yaml own/study.yaml
mkdir scripts
ln -s ../precious scripts/submit.sh
refused slurm_follows_no_link 4 'was not written by shoal' study study/case.yaml --slurm -o scripts
check and_writes_through_none precious
run study study/case.yaml --slurm -o again
run study study/case.yaml --slurm -o again
check its_own_scripts_are_replaced test "$code" = 0
# shellcheck disable=SC2016 # this is the name
odd='x$(touch PWNED)`touch PWNED`;touch PWNED'
run study study/case.yaml --slurm -o "$odd"
mkdir bin && printf '#!/bin/sh\necho 1\n' >bin/sbatch && chmod +x bin/sbatch
PATH=$PWD/bin:$PATH "$odd/submit.sh" >out 2>err
check submit_sh_works has out "$odd/study.txt"
SLURM_ARRAY_TASK_ID=0 sh "$odd/array.sbatch" >out 2>err
check the_task_works test -s "$odd/member-0000.nc"
sh "$odd/gather.sbatch" >out 2>err
check a_name_is_no_command test ! -e PWNED -a ! -e "$odd/PWNED"

finish

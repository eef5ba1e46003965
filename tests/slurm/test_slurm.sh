#!/usr/bin/env bash
# A study as a real array job: this script starts munge and Slurm on this machine alone and stops both again.
#
#   tests/slurm/test_slurm.sh PROGRAM        as root; needs the packages slurm-wlm and munge
set -uo pipefail
export LC_ALL=C

program=$(realpath "${1:?usage: tests/slurm/test_slurm.sh PROGRAM}")
for tool in slurmctld slurmd sbatch munged setpriv; do
    if ! PATH=$PATH:/usr/sbin command -v "$tool" >/dev/null; then
        echo "skipped slurm: there is no $tool: apt-get install slurm-wlm munge"
        echo '0 passed, 0 failed, 1 skipped'
        exit 0
    fi
done
folder=$(mktemp -d)
chmod 755 "$folder"
cd "$folder" || exit 2
n_passed=0 n_failed=0
started=()  # processes to stop at the end

stop() {
    local process
    for process in "${started[@]}"; do kill "$process" 2>/dev/null; done
    for ((i = 0; i < 50; i++)); do
        kill -0 "${started[@]}" 2>/dev/null || break
        sleep 0.1
    done
    cd / && rm -rf "$folder"
}
trap stop EXIT
trap 'exit 130' INT TERM

check() {  # name, command...
    local name=$1
    shift
    if "$@" >check.out 2>&1; then
        echo "ok      $name"
        n_passed=$((n_passed + 1))
    else
        echo "FAILED  $name: $* : $(head -c 600 check.out) $(tail -n 5 log/*.log 2>/dev/null | head -c 1500)"
        n_failed=$((n_failed + 1))
    fi
}

# Wait until a command succeeds.
wait_for() {  # seconds, command...
    local tenths=$((10 * $1))
    shift
    for ((; tenths > 0; tenths--)); do
        "$@" >/dev/null 2>&1 && return 0
        sleep 0.1
    done
    return 1
}

# ---- a cluster of one machine

if ! munge -n >/dev/null 2>&1; then
    install -d -o munge -g munge -m 755 /run/munge
    setpriv --reuid=munge --regid=munge --clear-groups /usr/sbin/munged --force >munged.out 2>&1
    wait_for 5 test -s /run/munge/munged.pid && started+=("$(</run/munge/munged.pid)")
fi
host=$(hostname -s)
cat >slurm.conf <<end
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
CredType=cred/munge
SlurmctldPort=16817
SlurmdPort=16818
StateSaveLocation=$folder/ctld
SlurmdSpoolDir=$folder/d
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/log/slurmctld.log
SlurmdLogFile=$folder/log/slurmd.log
SwitchType=switch/none
MpiDefault=none
ProctrackType=proctrack/pgid
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
SchedulerParameters=sched_interval=1,bf_interval=1
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 RealMemory=1000 State=UNKNOWN
PartitionName=main Nodes=$host Default=YES MaxTime=01:00:00 State=UP
end
export SLURM_CONF=$folder/slurm.conf PATH=$PATH:/usr/sbin
mkdir ctld d log
slurmctld -D >ctld.out 2>&1 &
started=("$!" "${started[@]}")
slurmd -D >d.out 2>&1 &
started=("$!" "${started[@]}")
check the_cluster_is_up wait_for 30 sh -c 'sinfo -h -o %T | grep -q idle'

# ---- a study with Slurm

cat >case.yaml <<'end'
format: 1
time: {end: 0.2, shedding_interval: 0.02}
fish: [{}]
sweep:
  - {key: "fish[*].wave.amplitude", values: [0.2, 0.3, 0.4]}
  - {keys: [solver.method, solver.max_steps], values: [[ida, 1000], [euler, 2]]}
end
check the_scripts_are_written "$program" study case.yaml --slurm --bundle 4 -o array
check nothing_has_run test ! -e array/member-0000.nc
check it_is_submitted array/submit.sh
check the_results_are_gathered_after_the_last_member wait_for 60 grep -q 'members in .* are not complete' array/study.txt
check the_complete_members_are_there test "$(grep -c ' complete$' array/study.txt)" = 3
check failed_members_are_reported grep -q '^3 members (1, 3, 5) failed: limited by solver.max_steps at t = ' array/study.txt
check a_bundle_goes_on_after_a_failure test -e array/member-0003.nc -a -e array/member-0005.nc
check study_nc_is_there test -s array/study.nc
"$program" study array/study.yaml -o array -q >again 2>&1
check the_same_study_goes_on_by_hand cmp <(grep ' complete$' again) <(grep ' complete$' array/study.txt)

# ---- a task that is stopped, as before the time limit, returns to the queue and continues

cat >long.yaml <<'end'
format: 1
time: {end: 100, shedding_interval: 0.005, output_interval: 0.5}
fish: [{}]
sweep: [{key: "fish[*].wave.amplitude", values: [0.2]}]
end
"$program" study long.yaml --slurm -o long >long.out
long/submit.sh >>long.out
check a_long_task_runs wait_for 60 test -s long/member-0000.nc
sleep 1
job=$(squeue -h -t running -o %A | head -1)
scancel --signal=TERM --batch "$job"
check a_stopped_task_is_requeued wait_for 30 sh -c "scontrol show job $job | grep -q Restarts=1"
check its_member_has_a_checkpoint test -s long/member-0000.ckpt
# Slurm delays a requeued task by two minutes; in the second of the stop the node would refuse the task
wait_for 30 scontrol update jobid="$job" starttime=now+3
check it_goes_on wait_for 400 sh -c 'ncdump -h long/member-0000.nc | grep -q "run_status = .complete"'
check from_its_checkpoint sh -c 'ncdump -h long/member-0000.nc | grep -q "checkpoint_at = .[0-9]"'

echo "$n_passed passed, $n_failed failed, 0 skipped"
((n_failed == 0))

#!/usr/bin/env bash
# A farm on a real Slurm, whose daemons are stopped and started again and whose tasks are killed at random, makes the
# same files as one render, to the byte. Needs Debian's slurm-wlm and munge, and root: the daemons run out of one
# folder, on 127.0.0.1, beside whatever the machine has.
# Usage: farm_slurm.sh VIRGA [KILLS]
for program in slurmctld slurmd munged sbatch; do
    PATH=$PATH:/usr/sbin command -v $program >/dev/null || { echo "skipped: $program is not installed"; exit 77; }
done
[ "$(id -u)" = 0 ] || { echo "skipped: Slurm's daemons need root"; exit 77; }
PATH=$PATH:/usr/sbin
kills=${2:-3}
. "$(dirname "$0")/farm_common.sh"
slurm=$work/slurm
mkdir -p "$slurm/state" "$slurm/spool"
chmod 755 "$work" "$slurm"

stop_daemons() {
    for daemon in slurmd slurmctld; do
        [ -s "$slurm/$daemon.pid" ] && kill "$(cat "$slurm/$daemon.pid")" 2>/dev/null
    done
    sleep 0.5
}
clean_up() {
    scancel -u root 2>/dev/null
    stop_daemons
    [ -s "$slurm/munged.pid" ] && kill "$(cat "$slurm/munged.pid")"
    sleep 0.5
    rm -rf "$work"
}
trap clean_up EXIT
trap 'exit 1' TERM INT

name=$(hostname -s)
port=$((20000 + $$ % 10000 * 2)) # of its own, for runs at the same time
export SLURM_CONF=$slurm/slurm.conf
cat >"$SLURM_CONF" <<CONF
ClusterName=virga
SlurmctldHost=$name(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$slurm/munge.socket
CredType=cred/munge
StateSaveLocation=$slurm/state
SlurmdSpoolDir=$slurm/spool
SlurmctldPidFile=$slurm/slurmctld.pid
SlurmdPidFile=$slurm/slurmd.pid
SlurmctldLogFile=$slurm/slurmctld.log
SlurmdLogFile=$slurm/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
ReturnToService=2
SchedulerParameters=bf_interval=1,sched_interval=1,batch_sched_delay=0
KillWait=2
NodeName=$name NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=$name Default=YES MaxTime=INFINITE State=UP
CONF

start_daemons() {
    slurmctld -f "$SLURM_CONF" && slurmd -f "$SLURM_CONF"
    for _ in $(seq 150); do
        sinfo -h -o %T 2>/dev/null | grep -qE '^(idle|mixed|allocated)$' && return 0
        sleep 0.2
    done
    return 1
}
dd if=/dev/urandom of="$slurm/munge.key" bs=32 count=1 status=none
chmod 400 "$slurm/munge.key"
if ! munged --force --key-file="$slurm/munge.key" --socket="$slurm/munge.socket" --pid-file="$slurm/munged.pid" \
    --seed-file="$slurm/munge.seed" --log-file="$slurm/munged.log" || ! start_daemons; then
    echo "skipped: Slurm does not start here: $(tail -n 1 "$slurm/slurmctld.log" "$slurm/slurmd.log" 2>&1)"
    exit 77
fi

"$virga" farm "$work/scene.yaml" -o "$work/farm" --slurm --tasks 4 --partition all --time 10 \
    --retries $((kills / 2)) -- "${options[@]}" >"$work/out" 2>&1 ||
    { fail "the farm was not submitted"; cat "$work/out"; }

# jobs: how many are in the queue.
jobs_left() {
    squeue -h -r 2>/dev/null | wc -l
}

# Half of the kills take the whole task, the other half the render in it.
killed=0 restarted=false
for _ in $(seq 1200); do
    if [ "$killed" -lt "$kills" ]; then
        if [ $((killed % 2)) = 0 ]; then
            pkill -9 -o -f "$work/farm .*(--claim|--simulate)" && killed=$((killed + 1))
        else
            pkill -9 -o -f "slurm_script" && killed=$((killed + 1))
        fi
        if [ "$killed" = $((kills / 2)) ] && ! $restarted; then # once: no task starts while they do
            restarted=true
            stop_daemons
            start_daemons || fail "Slurm does not start again"
        fi
        sleep 0.$((RANDOM % 9 + 1))
    else
        sleep 0.5
    fi
    [ "$(squeue -h -r 2>/dev/null; echo $?)" = 0 ] && [ "$(jobs_left)" = 0 ] && break
done
[ "$(jobs_left)" = 0 ] || { fail "jobs are left after ten minutes"; squeue -r; }
echo "$killed tasks killed"
"$virga" farm --status "$work/farm" >"$work/status"
grep -q "12 of 12 frames are done" "$work/status" || { fail "the end"; cat "$work/status" "$work/farm/farm"/*.log; }
same farm

[ "$failures" = 0 ] && echo "all as expected"
exit $((failures > 0))

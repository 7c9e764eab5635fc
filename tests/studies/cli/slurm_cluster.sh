#!/usr/bin/env bash
# The example's Slurm array on a real Slurm of one machine: munged, slurmctld and slurmd on the loopback address, in a
# folder of their own. One task is killed in the middle and requeued; the curves must be those of the same sweep without
# Slurm, to the bit. As root, with the packages slurm-wlm and munge. Usage: slurm_cluster.sh FINGERTIP EXAMPLES
set -euo pipefail

folder=$(mktemp -d -p "$PWD")
cd "$folder"
export FINGERTIP=$1 SWEEP=$PWD/sweep.toml RESULTS=$PWD/results XDG_CACHE_HOME=$PWD/cache SLURM_CONF=$PWD/slurm.conf
script=$2/slurm_array.sh
skip() { echo "$1"; exit 77; }
((EUID == 0)) || skip "Slurm's daemons need root"
for program in munged slurmctld slurmd sbatch; do
  PATH=$PATH:/usr/sbin command -v $program >/dev/null || skip "$program is not installed (packages slurm-wlm, munge)"
done
export PATH=$PATH:/usr/sbin

# Points that take long enough to be killed.
sed -e 's|"tip_radius/4", "tip_radius/5", "tip_radius/6"|"tip_radius/8", "tip_radius/9", "tip_radius/10"|' \
  "$2/sweep.toml" >"$SWEEP"

cat >slurm.conf <<EOF
ClusterName=fingertip
SlurmctldHost=$(hostname -s)(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$PWD/munge.socket
CredType=cred/munge
SlurmctldPort=16817
SlurmdPort=16818
StateSaveLocation=$PWD/state
SlurmdSpoolDir=$PWD/spool
SlurmctldPidFile=$PWD/slurmctld.pid
SlurmdPidFile=$PWD/slurmd.pid
SlurmctldLogFile=$PWD/slurmctld.log
SlurmdLogFile=$PWD/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SchedulerParameters=sched_interval=1
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
MpiDefault=none
NodeName=$(hostname -s) NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
EOF
mkdir -p state spool
dd if=/dev/urandom of=munge.key bs=1 count=128 status=none
chmod 600 munge.key
daemons=()
cleanup() {
  scancel --full --quiet --user=root 2>/dev/null || true
  for daemon in "${daemons[@]}"; do kill "$daemon" 2>/dev/null || true; done
  wait 2>/dev/null || true
  rm -rf "$folder"
}
trap cleanup EXIT
munged --foreground --force --key-file="$PWD/munge.key" --socket="$PWD/munge.socket" --pid-file="$PWD/munged.pid" \
  --seed-file="$PWD/munged.seed" --log-file="$PWD/munged.log" &
daemons+=($!)
slurmctld -D -i &
daemons+=($!)
slurmd -D -N "$(hostname -s)" &
daemons+=($!)

# What must come true within a minute or two.
until_true() {
  local what=$1
  shift
  for _ in $(seq 600); do
    if "$@" >/dev/null 2>&1; then return; fi
    sleep 0.2
  done
  echo "in vain: $what"
  tail -n 20 ./*.log
  exit 1
}
is_idle() { sinfo -h -o %T | grep -qx idle; }
until_true "a node that is idle" is_idle

job=$(sbatch --parsable --cpus-per-task=1 --requeue --output="$PWD/task_%a.log" "$script")
is_running() { [[ $(squeue -h -j "${job}_3" -o %T) == RUNNING ]]; }
has_begun() { is_running && ls "$RESULTS"/points/*/response.csv; }
until_true "a task that has begun" has_begun
# The node's process of the task and the program are lost, as when a node fails.
id=$(squeue -h -j "${job}_3" -o %A)
step=$(pgrep -f "slurmstepd: \[$id.batch\]" | head -n 1)
kill -KILL $(pgrep -P "$step") "$step"
scontrol requeue "${job}_3"
was_restarted() { scontrol show job "${job}_3" | grep -q 'Restarts=1'; }
until_true "the task's second start" was_restarted
is_done() { [[ -z $(squeue -h -j "$job") ]]; }
until_true "the end of the array" is_done

"$FINGERTIP" sweep --collect --out "$RESULTS" | tail -n 2
XDG_CACHE_HOME=$PWD/other "$FINGERTIP" sweep --config "$SWEEP" --out alone --progress off | tail -n 2
cmp results/curves.csv alone/curves.csv
[[ $(wc -l <results/table.csv) == 13 ]]
echo "the array's curves are those of one machine, to the bit"

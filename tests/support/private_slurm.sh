#!/bin/sh
# A Slurm of one node for a test: munged, slurmctld and slurmd of Debian's slurm-wlm, all in one folder and on ports of
# their own, so that no other Slurm is touched.
#   private_slurm.sh start FOLDER    starts it; prints the path for SLURM_CONF. Exit code 77: it cannot run here
#   private_slurm.sh stop FOLDER     stops what was started there
set -eu
action=$1 folder=$2
user=$(id -un)

# wait_for SECONDS COMMAND…
wait_for() {
  tries=$(($1 * 10))
  shift
  while ! "$@" >/dev/null 2>&1; do
    tries=$((tries - 1))
    [ $tries -gt 0 ] || return 1
    sleep 0.1
  done
}

# Each has ended, or had ten seconds for it, before the next is told: slurmctld still writes its state as it ends.
stop() {
  for name in slurmd slurmctld munged; do
    [ -s "$folder/$name.pid" ] || continue
    pid=$(cat "$folder/$name.pid")
    kill "$pid" 2>/dev/null || continue
    wait_for 10 sh -c "! grep -qs . /proc/$pid/cmdline" || :
  done
}

skip() {
  echo "no private Slurm: $1" >&2
  stop
  exit 77
}

# Two ports that nothing listens on.
free_ports() {
  python3 - <<'EOF'
import socket
sockets = [socket.socket() for _ in range(2)]
for s in sockets: s.bind(("127.0.0.1", 0))
print(*(s.getsockname()[1] for s in sockets))
EOF
}

start() {
  for program in munged slurmctld slurmd sbatch python3; do
    PATH=$PATH:/usr/sbin command -v $program >/dev/null || skip "$program is not installed (slurm-wlm, munge, python3)"
  done
  PATH=$PATH:/usr/sbin
  mkdir -p "$folder/state" "$folder/spool"
  chmod 700 "$folder"
  dd if=/dev/urandom of="$folder/munge.key" bs=128 count=1 2>/dev/null
  chmod 600 "$folder/munge.key"
  munged --force --key-file="$folder/munge.key" --socket="$folder/munge.socket" --pid-file="$folder/munged.pid" \
    --log-file="$folder/munged.log" --seed-file="$folder/munge.seed" >/dev/null 2>&1 || skip "munged does not start"
  # shellcheck disable=SC2046
  set -- $(free_ports)
  host=$(hostname -s)
  cat >"$folder/slurm.conf" <<EOF
ClusterName=gnomon
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$1
SlurmdPort=$2
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket
CredType=cred/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SchedulerType=sched/backfill
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
ReturnToService=2
SwitchType=switch/none
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
EOF
  export SLURM_CONF="$folder/slurm.conf"
  slurmctld >/dev/null 2>&1 || skip "slurmctld does not start: $(tail -1 "$folder/slurmctld.log" 2>/dev/null)"
  slurmd >/dev/null 2>&1 || skip "slurmd does not start: $(tail -1 "$folder/slurmd.log" 2>/dev/null)"
  wait_for 30 sh -c 'sinfo -h -o %t | grep -q "^idle"' || skip "the node does not come up: $(sinfo -h -o "%t %E" 2>&1)"
  echo "$SLURM_CONF"
}

"$action"

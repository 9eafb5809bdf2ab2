#!/usr/bin/env bash
# Runs one command with Slurm on this computer only. Starts munged, slurmctld and slurmd, runs the command and stops them:
#   scripts/slurm_here.sh DIR COMMAND...        DIR receives state and logs
# Needs root, because slurmd starts jobs as their users. This Slurm has its own ports, key and socket and does not use
# /etc/slurm. Without cgroups, it also works in a container; CPU affinity limits a job to its cores.
set -euo pipefail
here=$(dirname "$(realpath "$0")")
[ $# -ge 2 ] || { sed -n '2,5s/^# \{0,1\}//p' "$0" >&2; exit 2; }
[ "$(id -u)" -eq 0 ] || { echo "slurm_here.sh: run this script as root, because Slurm's daemon starts each job as the user of the job" >&2; exit 1; }
bash "$here/packages.sh" workflows slurm

dir=$(realpath -m "$1")
shift
rm -rf "$dir"
mkdir -p "$dir/state" "$dir/spool"
chmod 755 "$dir"
# munged refuses a key file that other users can read, and a folder in which other users can write.
install -d -o munge -g munge -m 711 "$dir/munge"
dd if=/dev/urandom of="$dir/munge/key" bs=128 count=1 status=none
chown munge:munge "$dir/munge/key"
chmod 400 "$dir/munge/key"

host=$(hostname -s)
# Requests two free ports from the kernel.
read -r ctld_port slurmd_port < <(python3 -c '
import socket
held = [socket.create_server(("127.0.0.1", 0)) for _ in range(2)]
print(*(s.getsockname()[1] for s in held))')
cores=$(nproc)
memory_mb=$(awk '/^MemTotal/ {print int($2 / 1024)}' /proc/meminfo)
cat >"$dir/slurm.conf" <<END
ClusterName=here
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$ctld_port
SlurmdPort=$slurmd_port
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$dir/munge/socket
CredType=cred/munge
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool
SlurmctldPidFile=$dir/slurmctld.pid
SlurmdPidFile=$dir/slurmd.pid
SlurmctldLogFile=$dir/slurmctld.log
SlurmdLogFile=$dir/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/affinity
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_min_interval=0,batch_sched_delay=0
MpiDefault=none
ReturnToService=2
MinJobAge=60
NodeName=$host NodeAddr=127.0.0.1 CPUs=$cores RealMemory=$memory_mb State=UNKNOWN
PartitionName=here Nodes=$host Default=YES MaxTime=INFINITE State=UP OverSubscribe=NO
END
# Slurm 22.05 (Debian 12) needs a cgroup version. Therefore version 1 is set, although no plugin uses it.
case $(slurmd -V) in
  *\ 2[0-2].*) cgroups=cgroup/v1 ;;
  *) cgroups=disabled ;;
esac
printf 'CgroupPlugin=%s\n' "$cgroups" >"$dir/cgroup.conf"
export SLURM_CONF=$dir/slurm.conf

started=()
end() {
  for pid in "${started[@]}"; do kill "$pid" 2>/dev/null || true; done
  for pid in "${started[@]}"; do wait "$pid" 2>/dev/null || true; done
}
trap end EXIT
failed() { echo "slurm_here.sh: $1; see $dir" >&2; exit 1; }

setpriv --reuid munge --regid munge --clear-groups munged --foreground --force --key-file "$dir/munge/key" \
  --socket "$dir/munge/socket" --pid-file "$dir/munge/pid" --log-file "$dir/munge/log" --seed-file "$dir/munge/seed" \
  2>"$dir/munged.err" &
started+=($!)
for _ in $(seq 100); do [ -S "$dir/munge/socket" ] && break; sleep 0.1; done
[ -S "$dir/munge/socket" ] || failed "munged does not respond"
slurmctld -D -f "$SLURM_CONF" 2>"$dir/slurmctld.err" &
started+=($!)
slurmd -D -f "$SLURM_CONF" -N "$host" 2>"$dir/slurmd.err" &
started+=($!)
for _ in $(seq 150); do
  [ "$(sinfo -h -o %T 2>/dev/null || true)" = idle ] && break
  sleep 0.2
done
[ "$(sinfo -h -o %T)" = idle ] || failed "the machine did not become ready"
"$@"

# SPDX-License-Identifier: MIT
#
# Slurm on this machine alone, without systemd, for root: start_slurm, await_jobs, stop_slurm. $WORK is a scratch folder.

has_slurm() { command -v slurmctld >/dev/null && command -v munged >/dev/null && [ "$(id -u)" = 0 ]; }

# Two ports of the loopback that nobody has.
free_ports() {
	python3 -c 'import socket
sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(2)]
print(*(s.getsockname()[1] for s in sockets))'
}

# A cluster of this machine alone: $slurm has its configuration, logs and process ids.
start_slurm() {
	local host
	host=$(hostname -s)
	# shellcheck disable=SC2046
	set -- $(free_ports)
	slurm=$WORK/slurm
	mkdir -p "$slurm/state" "$slurm/spool"
	cat >"$slurm/slurm.conf" <<END
ClusterName=one
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$1
SlurmdPort=$2
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$slurm/munge.socket
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
ReturnToService=2
SelectType=select/cons_tres
StateSaveLocation=$slurm/state
SlurmdSpoolDir=$slurm/spool
SlurmctldPidFile=$slurm/slurmctld.pid
SlurmdPidFile=$slurm/slurmd.pid
SlurmctldLogFile=$slurm/slurmctld.log
SlurmdLogFile=$slurm/slurmd.log
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 RealMemory=1000
PartitionName=all Nodes=ALL Default=YES
END
	head -c 128 /dev/urandom >"$slurm/munge.key"
	chmod 400 "$slurm/munge.key"
	munged --force --key-file="$slurm/munge.key" --socket="$slurm/munge.socket" --pid-file="$slurm/munged.pid" \
		--log-file="$slurm/munged.log" --seed-file="$slurm/munge.seed" 2>/dev/null || return
	export SLURM_CONF=$slurm/slurm.conf
	slurmctld -c && slurmd -N "$host" || return
	for _ in $(seq 200); do
		[ "$(sinfo -h -o %t 2>/dev/null)" = idle ] && return
		sleep 0.1
	done
	return 1
}
stop_slurm() {
	local daemon
	for daemon in slurmd slurmctld munged; do
		[ ! -f "$slurm/$daemon.pid" ] || kill "$(cat "$slurm/$daemon.pid")"
	done
}

# Until no job is left, ten minutes at most.
await_jobs() {
	for _ in $(seq 6000); do
		[ -n "$(squeue -h)" ] || return 0
		sleep 0.1
	done
	return 1
}

#!/bin/bash
# SPDX-License-Identifier: MIT
#
# tests/soak/farm.sh BUILD_DIR...: the recipes of data/farm for engines that nobody installs for a test, with the first
# build: hosts by ssh (openssh-server, which starts a service), Slurm (slurm-wlm and munge, as root), Snakemake.
cd "$(dirname "$0")/../.." || exit 1
ROOT=$PWD BUILD=$PWD/$1 NMTAN=$PWD/$1/nmtan WORK=$(mktemp -d)
trap 'cd / && rm -rf "$WORK"' EXIT
export ROOT BUILD NMTAN WORK PATH=$PATH:/usr/sbin
. "$ROOT/tests/support/cli.sh"
. "$ROOT/tests/support/farm.sh"
. "$ROOT/tests/support/slurm.sh"

# Two hosts on this one: sshd on ports of the loopback, with keys and configuration of their own.
start_sshd() {
	local port=$1
	cat >"ssh/$port.conf" <<END
Port $port
ListenAddress 127.0.0.1
HostKey $PWD/ssh/host
AuthorizedKeysFile $PWD/ssh/key.pub
PidFile $PWD/ssh/$port.pid
StrictModes no
PasswordAuthentication no
UsePAM no
END
	# of root it wants a folder of the system's
	[ "$(id -u)" != 0 ] || mkdir -p /run/sshd
	"$(command -v sshd)" -f "$PWD/ssh/$port.conf" -E "$PWD/ssh/$port.log"
}

scene "GNU parallel: two hosts by ssh"
if ! command -v sshd >/dev/null; then
	skip_case "sshd is not installed (openssh-server)"
else
	take_hard
	clean
	mkdir -m 700 ssh
	ssh-keygen -q -t ed25519 -N '' -f ssh/host
	ssh-keygen -q -t ed25519 -N '' -f ssh/key
	ports=$(free_ports)
	for port in $ports; do
		start_sshd "$port" || wrong "sshd does not start: $(cat "ssh/$port.log")"
		echo "1/ssh -p $port -i $PWD/ssh/key -o StrictHostKeyChecking=no -o UserKnownHostsFile=/dev/null -o LogLevel=ERROR $(id -un)@127.0.0.1"
	done >hosts
	prepare 6
	recipe "$farm/parallel.sh" "my work" --sshloginfile hosts
	exits 0
	is_clean
	for port in $ports; do
		grep -q 'Accepted publickey' "ssh/$port.log" || wrong "nothing came to the host at $port: $(tail -3 "ssh/$port.log")"
		kill "$(cat "ssh/$port.pid")"
	done
fi

if ! has_slurm; then
	scene "Slurm: an array job over chunks, and one that merges"
	skip_case "Slurm is not installed (slurm-wlm, munge), or this is not root"
else
	scene "Slurm: an array job over chunks, and one that merges after it"
	start_slurm || wrong "Slurm does not start: $(tail -5 "$slurm"/*.log)"
	take_hard
	clean
	prepare 5
	recipe "$farm/slurm.sh" "my work" --time=5
	exits 0
	await_jobs || wrong "jobs are left: $(squeue)"
	is_clean
	is "$(ls "my work" | grep -c '\.1\.jsonl')" 5

	scene "Slurm: a task that is requeued goes on where it was"
	take_many
	clean
	prepare 2 --threads=1
	stopping
	TOOL=$NMTAN NMTAN=$PWD/stopping.sh recipe "$farm/slurm.sh" "my work"
	exits 0
	await_stop
	scontrol requeue "$(squeue -h -r -t running -o '%i' | grep '_2$')"
	# begun anew only after some two minutes, unless it is released
	for _ in $(seq 600); do
		for task in $(squeue -h -r -t pending -o '%F_%K %j' | sed -n 's/ nmtan$//p'); do
			scontrol update job="$task" StartTime=now 2>/dev/null
		done
		[ -n "$(squeue -h)" ] || break
		sleep 0.1
	done
	await_jobs || wrong "jobs are left: $(squeue)"
	is_clean
	is "$(ls "my work" | grep '\.2\.jsonl')" 2.2.jsonl
	is "$(cat "my work"/2.*.jsonl | grep -c '"status":"done"')" "$(tr -dc '\0' <"my work/2.list0" | wc -c)"
	stop_slurm
fi

scene "Snakemake: outputs are made again when what they were made of changes"
if ! command -v snakemake >/dev/null; then
	skip_case "Snakemake is not installed (snakemake)"
else
	take_hard
	# names with a line feed, or that are no UTF-8, are none of Snakemake's
	rm "as sets/-sub dir/"{$'line\nfeed',$'\xff\xfe'}.obj "as sets/plates.gltf"
	clean
	make_all() { snakemake -q -s "$farm/Snakefile" -c2 --rerun-triggers mtime --config in="as sets" out="o ut" nmtan="$NMTAN" >"$WORK/err.txt" 2>&1; }
	made() { find "o ut" -name '*.glb' -newer before | wc -l; }
	touch before
	make_all || wrong "exit code $?"
	(cd "o ut" && find . -name '*.glb' -exec cmp {} ../clean/{} \;) >difference
	[ ! -s difference ] || wrong "$(cat difference)"
	is "$(made)" "$(find clean -name '*.glb' | wc -l)"
	sleep 1
	touch before
	make_all
	is "$(made)" 0
	sleep 1
	echo "# changed" >>"as sets/mirrored_cube.mtl"
	make_all
	is "$(made)" 1

	scene "Snakemake notices what the page says, and makes nothing twice"
	snake() { snakemake -q -s "$farm/Snakefile" -c1 --rerun-triggers mtime --config in=in out=out nmtan=./program; }
	notices 5 snake
fi

done_testing

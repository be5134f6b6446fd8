#!/bin/sh
# SPDX-License-Identifier: MIT
#
# slurm.sh WORK [OPTION of sbatch...]: an array job over what "nmtan-farm prepare WORK" has cut into chunks, and a job
# after its end that merges what came of each input into WORK/manifest.jsonl. A task that is requeued, because its node
# failed or somebody else came first, goes on where it was: what is done is up to date. So does slurm.sh when it is
# started again. Slurm allows 1001 tasks unless MaxArraySize says more. Prints the number of the merging job.
set -eu
farm=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)/nmtan-farm
work=$(CDPATH= cd -- "$1" && pwd)
shift
count=$("$farm" chunks "$work" | wc -l)
log=$(printf '%s\n' "$work" | sed 's/%/%%/g')
export NMTAN="${NMTAN:-nmtan}"
array=$(sbatch --parsable --job-name=nmtan --array="1-$count" --requeue --open-mode=append --output="$log/%a.log" "$@" \
	"$farm" run "$work")
sbatch --parsable --job-name=nmtan-merge --dependency="afterany:${array%%;*}" --output="$log/merge.log" \
	"$farm" merge "$work"

#!/bin/sh
# SPDX-License-Identifier: MIT
#
# store.sh SOURCE TARGET SCRATCH [OPTION of nmtan...]: fetches the meshes of an object store, and what the last run made of
# them, converts what has changed, and puts what is new. SOURCE and TARGET are what rclone takes (bucket:meshes); SCRATCH is
# a folder of this machine, which need not last: times mean nothing after a fetch, so that files are compared by content,
# and the record of outputs is beside them in the store. RCLONE names another program that knows "sync" and "copy".
set -u
source=$1 target=$2 scratch=$3
shift 3
rclone=${RCLONE:-rclone}
mkdir -p "$scratch/in" "$scratch/out" || exit 2
"$rclone" sync "$source" "$scratch/in" && "$rclone" copy "$target" "$scratch/out" || exit 2
(cd "$scratch" && exec "${NMTAN:-nmtan}" --update=content -r -d out --keep-tree=in --manifest=manifest.jsonl "$@" in)
status=$?
"$rclone" copy "$scratch/out" "$target" || exit 2
exit $status

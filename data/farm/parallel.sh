#!/bin/sh
# SPDX-License-Identifier: MIT
#
# parallel.sh WORK [OPTION of parallel...]: runs what "nmtan-farm prepare WORK" has cut into chunks with GNU parallel,
# here or on the hosts of --sshloginfile=FILE, which see the same folders under the same names. If something was
# killed before all inputs were tried, the next start runs the chunks that have not ended well. After that every start
# runs all chunks: what is up to date is not made again. WORK/manifest.jsonl has the result of each input.
set -u
farm=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)/nmtan-farm
work=$(CDPATH= cd -- "$1" && pwd) || exit 2
shift
"$farm" chunks "$work" >/dev/null || exit
# --env: what is set here is not set on other hosts. -q: nothing in these words is for a shell.
export NMTAN="${NMTAN:-nmtan}"
"$farm" chunks "$work" |
	parallel --will-cite --joblog "$work/joblog" --resume-failed --env NMTAN "$@" -q "$farm" run "$work" {}
"$farm" merge "$work"
status=$?
# the log of a finished run would keep the next one from looking at what has changed since
[ $status -gt 1 ] || rm -f "$work/joblog"
exit $status

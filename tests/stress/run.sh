#!/bin/sh
# SPDX-License-Identifier: MIT
#
# run.sh PROGRAM FOLDER: the stress program, the fractions, and PNGs where rsvg-convert is installed.
program=$1 folder=$2
mkdir -p "$folder" || exit 2
status=0
"$program" "$folder" || status=1
if command -v python3 >/dev/null; then
	python3 tests/stress/check_fractions.py "$folder/samples.txt" || status=1
else
	echo "stress: no python3, fractions skipped"
fi
sh tests/support/charts.sh "$folder" stress
echo "stress: tables and charts are in $folder"
exit $status
